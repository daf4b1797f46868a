//! Devices and scenes as plain numbers: a recording carries them beside the counts, so that its replay needs no list of
//! devices and reads no file.
//!
//! Each type has one description, a walk over its numbers in order, which either writes or reads them: so the two
//! cannot drift apart. The walk computes nothing; the numbers are bit for bit those of the loop.

mod device;
mod mechanism;
mod scene;
mod walk;

pub use device::{Recorded, with_mechanism};
pub use mechanism::Mechanism;
pub use scene::{Entry, Movement, SceneNumbers, Turn};
