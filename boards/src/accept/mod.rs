//! A board that is being accepted: it shows that it computes the very bits, how long that takes, how evenly its ticks
//! come and how well its sensors answer. No motor is driven.
//!
//! An image of its own, in the place of [`crate::Bench`], not a mode of it: absent code cannot be entered by
//! mistake. [`Acceptance`] is the tick, of a board that is [`crate::Passive`]: it has no way to a motor but to let go.
//! [`Examiner`] runs below it, and answers [`palpate::wire::acceptance::Request`]s.

mod examiner;
mod tick;

pub use examiner::{Chip, Examiner, Stopwatch};
pub use tick::Acceptance;
