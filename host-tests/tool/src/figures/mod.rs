//! The paper's figures, recomputed: first the numbers, then the drawings.

pub mod attraction;
mod attraction_plot;
pub mod invariance;
mod page;
pub mod rate;
mod shape;
mod sheets;
mod subject;
pub mod tour;
pub mod tracking;

pub use shape::draw_shape;
pub use sheets::{Options, Sheet, Stage, body_sheet, sheets};
pub use subject::Subject;
