//! The servo loop: one tick from encoder counts to motor duty.
//!
//! [`Servo`] is the configuration and lives in flash; [`ServoState`] is everything that changes and is `Copy`;
//! [`Servo::tick`] is a function of the two and the tick's [`Input`]. Follow a tick in `tick.rs` from top to bottom. It cannot fail: it
//! returns duties, and in its state says what it thinks of them ([`Phase`], [`Fault`]).

mod gate;
mod phase;
mod sense;
mod settings;
mod state;
mod tick;

pub use phase::{Fault, Phase};
pub use settings::{Settings, SettingsError};
pub use state::ServoState;
pub use tick::{Input, Servo};
