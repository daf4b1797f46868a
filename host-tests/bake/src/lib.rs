#![doc = include_str!("../README.md")]
//!
//! # How it works
//!
//! Stages of a patch: [`Model`] (the file, checked, in metres and `f64`) → [`spline`] (its polynomial spans, rounded
//! once to `f32`) → [`bounds`] and [`shape`] (bounds that are proved for these `f32` numbers) → [`BakedPatch`] →
//! [`source`] (Rust). [`survey`] reports which properties of a patch are proved and which are not.

mod baked;
mod bernstein;
pub mod body;
pub mod bounds;
mod build_script;
mod cell;
pub mod certificate;
mod check;
mod convexity;
mod error;
pub mod file;
pub mod flaws;
mod form;
pub mod graph;
mod jet;
pub mod locator;
mod model;
pub mod modes;
pub mod parallel;
mod patch;
mod random;
pub mod ritz;
pub mod shape;
pub mod sides;
pub mod source;
pub mod spline;
pub mod split;
pub mod survey;
pub mod topology;

pub use baked::BakedPatch;
pub use body::{BakedBody, LocatorTable};
pub use build_script::{Bake, BakeError};
pub use error::{ModelError, PatchFault};
pub use model::{Model, Unit};
pub use patch::Axis;
pub use patch::NurbsPatch;
pub use random::Random;
pub use spline::BakedCoefficients;
