//! Scene files: which bodies, where they are, how they move and feel.
//!
//! [`SceneFile`] is what is written; [`SceneFile::parts`] makes of it, with the bodies' tables, what a
//! [`palpate::scene::Scene`] is made of, and [`source`] writes the same as Rust for an image: every number reads back
//! as the same `f32`.

mod file;
mod parts;
mod source;

pub use file::{
    BodyEntry, Free, FrictionEntry, JointEntry, MAX_BODIES, SceneFile, SceneFileError, Spring, Sway, Turn, Turned,
};
pub use parts::Shape;
pub use source::source;
