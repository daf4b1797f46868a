//! A body as one binary file, as [`palpate::body::Body::from_bytes`] takes it, with notes for the host.
//!
//! The file holds the tables and nothing but them; what else the host knows of a model, its names and its unit, where
//! each face is from and how smooth its knots leave it, is in the notes. From both [`BakedFile::read`] makes what
//! baking the model makes: but its surfaces in double precision are those of the stored numbers.

mod notes;
mod read;
mod write;

pub use notes::FileFault;
pub use notes::{FaceNotes, Notes};
pub use read::BakedFile;
pub use write::write;
