//! Devices as commands name them: one that ships, one's own by its file, or the knob.

use anyhow::Context;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use palpate_sim::devices::OwnDevice;
pub use palpate_sim::devices::{DEVICES, Preset, ShippedDevice, named, own_device};
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

/// The knob's name on the command line.
const KNOB: &str = "knob";

/// Takes a device from the command line: by its name, or one's own from its file.
pub fn parser() -> impl TypedValueParser<Value = Chosen> {
    NameOrFile
}

/// A name of [`DEVICES`], or the path of a device file, which ends in `.toml`.
#[derive(Clone, Copy, Debug)]
struct NameOrFile;

impl TypedValueParser for NameOrFile {
    type Value = Chosen;

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
            return Ok(Chosen::Arm(own_device(&own, &path.display().to_string())));
        }
        // The names are the table's: each is found.
        let chosen = |name: String| {
            if name == KNOB { Ok(Chosen::Knob) } else { named(&name).map(Chosen::Arm).ok_or("no such device") }
        };
        let known = PossibleValuesParser::new(names()).try_map(chosen);
        known.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(names()))
    }
}

/// The file of a device with three joints: one's own by its path, or that of a shipped device by its name.
///
/// # Errors
/// The refused entry, or a shipped device of fewer joints.
pub fn own(device: &Path) -> anyhow::Result<OwnDevice> {
    let name = device.to_string_lossy();
    Ok(match named(&name) {
        Some(shipped) => {
            let file = shipped.file().with_context(|| format!("{name} has less than three joints"))?;
            OwnDevice::new(file, &name)?
        }
        None => OwnDevice::read(device)?,
    })
}

/// The names on the command line, and what they stand for.
fn names() -> impl Iterator<Item = PossibleValue> {
    let arms = DEVICES.iter().map(|device| PossibleValue::new(device.name).help(device.about));
    arms.chain([PossibleValue::new(KNOB).help("A knob on a motor with three phases: one joint, demo only")])
}
