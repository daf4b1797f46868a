//! A device in this very program: the boards' loop over a scene of two capped boxes side by side, at a servo rate of
//! 4 kHz, with a simulated arm, and a hand at it. [`Simulated`] is a [`palpate_link::Line`] to it; its time is its own.

mod board;
mod device;
mod hand;

pub use board::{AtPins, CLOCK_HZ, NoWatchdog, Pins, SimulatedBench, SimulatedBoard, Ticks, Wire};
pub use device::{Kind, Simulated, capped_box};
pub use hand::Hand;

/// The code in the documents: compiled with the doctests.
#[cfg(doctest)]
mod documents {
    #[doc = include_str!("../../../../docs/howto/link.md")]
    struct Link;
}
