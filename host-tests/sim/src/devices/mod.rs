//! A lab's own device, described by a `device.toml`: read and checked, turned into the library's constant, simulated,
//! and written. A crate apart from the tool, so that other programs can run a loop against a device.

#[cfg(feature = "std")]
mod c_header;
#[cfg(feature = "std")]
mod constant;
#[cfg(feature = "std")]
mod plant;
pub mod preset;
mod read;
mod schema;
#[cfg(feature = "std")]
mod shipped;
#[cfg(feature = "std")]
mod table;

#[cfg(feature = "std")]
pub use c_header::{c_header, c_preset};
#[cfg(feature = "std")]
pub use constant::{rust_preset, settings_source, source};
pub use preset::Preset;
pub use read::{DeviceFileError, OwnDevice};
pub use schema::{
    BridgeEntry, DeviceFile, EncoderEntry, HomingEntry, JointEntry, LimitsEntry, LinkageEntry, MassEntry,
    MechanismEntry, MotorEntry,
};
#[cfg(feature = "std")]
pub use shipped::{file_of, protection_of};
#[cfg(feature = "std")]
pub use table::{DEVICES, ShippedDevice, named, own_device};
