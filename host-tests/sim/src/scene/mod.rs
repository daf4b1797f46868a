//! Scene files: bodies with position, motion and material.
//!
//! [`SceneFile`] is the content of the file; [`SceneFile::parts`] combines it with the bodies' tables into the parts of
//! a [`palpate::scene::Scene`], and [`source`] writes the same as Rust for an image: every number reads back as the
//! same `f32`.

mod file;
mod parts;
mod source;

pub use file::{
    BodyEntry, Free, FrictionEntry, JointEntry, MAX_BODIES, MagnetEntry, SceneFile, SceneFileError, Spring, Sway,
    TextureEntry, Turn, Turned, ViscosityEntry,
};
pub use parts::Shape;
pub use source::source;
