//! The line of a board over its own USB plug: a serial device (CDC) whose packets carry the frames that a UART carries
//! byte by byte.
//!
//! | type | is |
//! |---|---|
//! | [`Cdc`] | the plug, as a [`crate::Port`] |
//! | [`Either`] | plug and UART as one line: the host at the plug while it has the port open, else the UART |
//! | [`Chip`] | what a chip's bus wants beyond what every bus does |
//! | [`Bytes`] | what lies between bytes and packets |
//!
//! # What keeps a thumb safe
//!
//! - Nothing here reaches a motor. A host's commands go the way of all frames, through the checks of
//!   [`crate::Idle`] and of the tick.
//! - No interrupt of the bus is unmasked: main asks it, turn by turn, and the tick preempts that as it preempts all of
//!   main. A bus that hangs main starves the watchdog.
//! - Nothing waits for a host. One that does not read fills a buffer of a packet; then the line takes no more, and
//!   records are dropped, as they are with a slow UART.
//! - A bus that is reset, suspended, or unplugged is a line on which nothing comes: the link is lost by its timeout.
//!   Bytes on their way are discarded, so that no half of a frame meets another half.

mod bytes;
mod cdc;
mod either;

pub use bytes::Bytes;
pub use cdc::{Cdc, Chip, PACKET, Plain, TURNS};
pub use either::{Either, Plug};
