//! Devices as commands name them: one that ships, one's own by its file, or the knob.

use anyhow::{Context, ensure};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
pub use palpate_sim::devices::{DEVICES, Preset, ShippedDevice, named, own_device};
use palpate_sim::devices::{DeviceFileError, OwnDevice};
use std::ffi::OsStr;
use std::path::Path;

/// A device of the command line: one that feels surfaces, or the knob, which has one joint and feels by itself.
#[derive(Clone, Copy, Debug)]
pub enum Chosen {
    /// One of [`DEVICES`], or one's own.
    Arm(&'static ShippedDevice),
    /// The knob ([`crate::knob`]).
    Knob,
}

/// Devices of the command line that feel surfaces: each that ships, or one of them or one's own.
#[derive(Clone, Copy, Debug)]
pub enum Arms {
    /// All of [`DEVICES`].
    All,
    /// One of them, or one's own.
    One(&'static ShippedDevice),
}

impl Arms {
    /// Each of them.
    pub fn each(self) -> Vec<&'static ShippedDevice> {
        match self {
            Self::All => DEVICES.iter().collect(),
            Self::One(device) => vec![device],
        }
    }
}

/// Takes a device from the command line: by its name, or one's own from its file; or the knob.
pub fn parser() -> impl TypedValueParser<Value = Chosen> {
    NameOrFile { other: ["knob", "A knob on a motor with three phases: one joint, demo only"] }
        .map(|device| device.map_or(Chosen::Knob, Chosen::Arm))
}

/// Takes a device from the command line: by its name, or one's own from its file; or all that ship.
pub fn arms_parser() -> impl TypedValueParser<Value = Arms> {
    NameOrFile { other: ["all", "Each of these"] }.map(|device| device.map_or(Arms::All, Arms::One))
}

/// A name of [`DEVICES`], or the path of a device file, which ends in `.toml`, or one more name, which stands for
/// `None`, with its description.
#[derive(Clone, Copy, Debug)]
struct NameOrFile {
    other: [&'static str; 2],
}

impl NameOrFile {
    /// The names on the command line, and what they stand for.
    fn names(self) -> impl Iterator<Item = PossibleValue> {
        let arms = DEVICES.iter().map(|device| PossibleValue::new(device.name).help(device.about));
        arms.chain([PossibleValue::new(self.other[0]).help(self.other[1])])
    }
}

impl TypedValueParser for NameOrFile {
    type Value = Option<&'static ShippedDevice>;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, clap::Error> {
        let path = Path::new(value);
        if path.extension().is_some_and(|extension| extension == "toml") {
            let own = OwnDevice::read(path).map_err(|error| {
                clap::Error::raw(clap::error::ErrorKind::ValueValidation, format!("{error}\n")).with_cmd(command)
            })?;
            return Ok(Some(own_device(&own, &path.display().to_string())));
        }
        let is_path = path.extension().is_some() || path.components().count() > 1;
        if is_path && named(&value.to_string_lossy()).is_none() {
            let what = DeviceFileError::Kind(path.display().to_string());
            return Err(
                clap::Error::raw(clap::error::ErrorKind::ValueValidation, format!("{what}\n")).with_cmd(command)
            );
        }
        // Every other name is the table's.
        PossibleValuesParser::new(self.names()).map(|name| named(&name)).parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.names()))
    }
}

/// The file of a device with three joints: one's own by its path, or that of a shipped device by its name.
///
/// # Errors
/// The refused entry, or a shipped device of fewer joints.
pub fn own(device: &Path) -> anyhow::Result<OwnDevice> {
    let name = device.to_string_lossy();
    ensure!(name != "knob", "knob has no device file: its numbers are in boards/src/knob.rs (docs/howto/knob.md)");
    Ok(match named(&name) {
        Some(shipped) => {
            let file = shipped.file().with_context(|| {
                format!("{name} has fewer than three joints, and so no device file; `palpate device {name} --out device.rs` writes its constant")
            })?;
            OwnDevice::new(file, &name)?
        }
        None => OwnDevice::read(device)?,
    })
}
