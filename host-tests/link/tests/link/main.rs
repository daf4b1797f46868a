//! The host's end of the line against the boards' own loop, over a line that loses and spoils what it is told to.

mod alive;
mod keeping;
mod line;
mod lost;
mod orders;
mod page;
mod strangers;
mod uploads;
