//! Z-width: how stiff and how damped a virtual wall may be on a device, at a rate and behind a delay.
//!
//! A device is taken along the wall's normal, as a [`Slice`] of one mass; the wall is the library's own
//! [`palpate::render::Penalty`] on the library's own velocity. [`collide`] hits the wall once, [`max_stiffness`]
//! finds the limit, and [`sweep`] makes the table with the passive bound ([`palpate::render::bounds`]).

mod collide;
mod slice;
mod soft;
mod sweep;

pub use collide::{Collision, Loop, Swing, Wall, collide};
pub use slice::Slice;
pub use soft::SoftWall;
pub use sweep::{DAMPINGS, DELAYS, Limit, RATES, in_words, max_stiffness, max_stiffness_on, sweep};
