//! Devices and scenes as plain numbers: what a recording carries beside the counts, so that whoever replays it needs
//! no list of devices and reads no file.
//!
//! Each thing has one description, a walk over its numbers in an order, which either takes them down or fills them in:
//! what is written and what is read cannot drift apart. Nothing is computed on the way; the numbers are those of the
//! loop, in every bit.

mod device;
mod mechanism;
mod scene;
mod walk;

pub use device::Recorded;
pub use mechanism::Mechanism;
pub use scene::{Entry, Movement, SceneNumbers, Turn};
