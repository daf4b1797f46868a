//! A lab's own device, as a `device.toml` describes it: read and checked, turned into the library's constant,
//! simulated, and written. Apart from the tool, for whoever runs a loop against a device.

mod constant;
mod plant;
pub mod preset;
mod read;
mod schema;
mod shipped;
mod table;

pub use constant::{settings_source, source};
pub use preset::Preset;
pub use read::{DeviceFileError, OwnDevice};
pub use schema::{
    BridgeEntry, DeviceFile, EncoderEntry, HomingEntry, JointEntry, LimitsEntry, LinkageEntry, MassEntry,
    MechanismEntry, MotorEntry,
};
pub use shipped::{file_of, protection_of};
pub use table::{DEVICES, ShippedDevice, named, own_device};
