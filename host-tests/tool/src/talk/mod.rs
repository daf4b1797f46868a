//! Talking with a device: a console over [`palpate_link`], with a device at a port or a simulated one.
//!
//! ```text
//!  Console ── Asked: a line, understood ── palpate_link::Device ── Line: a serial port │ Emulated │
//! palpate_sim::simulated::Simulated
//! ```

mod asked;
mod console;
mod emulated;
mod log;

pub use asked::{Asked, Misunderstood};
pub use console::{Button, Console, Press, Step};
pub use emulated::{Emulated, at_knob};
pub use log::Log;
