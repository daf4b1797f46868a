//! A lab's own device, described by a `device.toml`: read and checked, turned into the library's constant, simulated,
//! and written. A crate apart from the tool, so that other programs can run a loop against a device.

mod c_header;
mod constant;
mod plant;
pub mod preset;
mod read;
mod schema;
mod shipped;
mod table;

pub use c_header::{c_header, c_preset};
pub use constant::{settings_source, source};
pub use preset::Preset;
pub use read::{DeviceFileError, OwnDevice};
pub use schema::{
    BridgeEntry, DeviceFile, EncoderEntry, HomingEntry, JointEntry, LimitsEntry, LinkageEntry, MassEntry,
    MechanismEntry, MotorEntry,
};
pub use shipped::{file_of, protection_of};
pub use table::{DEVICES, ShippedDevice, named, own_device};
