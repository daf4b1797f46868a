//! A lab's own device, as a `device.toml` describes it: read and checked, turned into the library's constant,
//! simulated, and written.

mod constant;
mod plant;
mod preset;
mod read;
mod schema;

pub use constant::{settings_source, source};
pub use preset::{file_of, protection_of};
pub use read::{DeviceFileError, OwnDevice};
pub use schema::{
    BridgeEntry, DeviceFile, EncoderEntry, JointEntry, LimitsEntry, LinkageEntry, MassEntry, MechanismEntry, MotorEntry,
};
