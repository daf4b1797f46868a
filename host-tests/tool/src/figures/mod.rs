//! The paper's figures, computed anew: the numbers first, then what draws them.

pub mod attraction;
mod attraction_plot;
mod compact;
pub mod comparison;
pub mod invariance;
mod invariance_plot;
mod page;
pub mod rate;
mod rate_plot;
mod shape;
mod sheets;
mod subject;
pub mod tour;
mod tour_plot;
pub mod tracking;
mod tracking_plot;

pub use shape::draw_shape;
pub use sheets::{Options, Sheet, Stage, body_sheet, sheets};
pub use subject::Subject;
