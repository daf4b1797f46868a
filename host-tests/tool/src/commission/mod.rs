//! Commissioning: from a roughly correct device file to a measured one.
//!
//! ```text
//!  find ── Lab ─┬─ Device ── Line: a serial port │ an emulated board │ the loop of the boards on the host
//!               └─ Hands: the person at it       │ World: the simulated device and its planted faults
//! ```
//!
//! The device's side is the loop of every board (`boards/src`). [`find`] gets its data from the [`Lab`] and writes the
//! results into the file. A motor moves only while the [`Key`] is held.

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

pub(crate) use device::said;
pub use device::{Device, Key, KeyHeld, Line, NoKey};
pub use emulated::EmulatedLine;
pub use encoders::{GIVE, angle, begin_within};
pub use find::calibration;
pub use find::{find, find_mounting};
pub use keyboard::Keyboard;
pub use keyboard::Person;
pub use lab::Finding;
pub use lab::Hands;
pub use lab::{Lab, RATE, Zero};
pub use motors::MOVED;
pub use on_host::HostLine;
pub use port::PortLine;
pub use torques::Weights;
pub use world::{Planted, PlantedFault};
pub use world::{SimulatedHands, World};
