//! From a model file to tables in flash.
//!
//! The way of a patch: [`Model`] (the file, checked, in metres and `f64`) → [`spline`] (its polynomial spans, rounded
//! once to `f32`) → [`bounds`] and [`shape`] (what is proved of those very `f32` numbers) → [`BakedPatch`] → [`source`] (Rust).
//! [`survey`] says what is known of a patch and what is not.

mod baked;
mod bernstein;
pub mod bounds;
mod cell;
pub mod certificate;
mod error;
mod form;
mod knots;
pub mod locator;
mod model;
mod patch;
pub mod shape;
pub mod source;
pub mod spline;
pub mod survey;
mod tracked;

pub use baked::{BakedCoefficients, BakedPatch};
pub use error::{Fault, ModelError};
pub use model::{Model, Unit};
pub use patch::{Axis, NurbsPatch};
