//! Commissioning: from a device file that is only nearly right to one that was measured.
//!
//! ```text
//!  find ── Lab ─┬─ Device ── Line: a serial port │ an emulated board │ the loop of the boards on the host
//!               └─ Hands: whoever stands at it   │ World: the simulated device, and what was planted in it
//! ```
//!
//! The device's side is the loop of every board (`boards/src`), wherever it runs. [`find`] asks the [`Lab`] for what
//! it needs and writes what it finds into the file. A motor moves only while the [`Key`] is held.

pub(crate) mod device;
mod emulated;
mod encoders;
mod find;
mod keyboard;
mod lab;
mod motors;
mod on_host;
mod port;
mod torques;
mod world;

pub use device::{Device, Key, KeyHeld, Line, NoKey};
pub use emulated::EmulatedLine;
pub use encoders::{angle, begin_within};
pub use find::calibration;
pub use find::{find, find_mounting};
pub use keyboard::Keyboard;
pub use keyboard::Person;
pub use lab::Finding;
pub use lab::Hands;
pub use lab::{Lab, RATE, Zero};
pub use on_host::HostLine;
pub use port::PortLine;
pub use world::{Planted, PlantedFault};
pub use world::{SimulatedHands, World};
