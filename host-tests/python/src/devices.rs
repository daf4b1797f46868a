//! The devices that ship with three joints, and one's own: what the loop knows of each, and what stands in for it in
//! simulation.

use crate::refusal::Refusal;
use palpate::device::{Device, Kinematics, Protection};
use palpate::servo::recommended::{self, Recommended};
use palpate::servo::{ConfigError, Settings, SettingsError};
use palpate_sim::devices::{DEVICES, DeviceFileError, OwnDevice, Preset};
use palpate_sim::plant::PlantSettings;
use pyo3::prelude::*;
use std::fs;
use std::path::Path;

/// Their names on the command line of `palpate sim`, too.
const NAMES: [&str; 4] = ["woodenhaptics-2016", "polhem-v2", "phantom-premium", "falcon"];

/// The devices that ship.
#[pyfunction]
pub fn devices() -> Vec<&'static str> {
    NAMES.to_vec()
}

/// Something done with a device of any mechanism.
pub trait OnDevice {
    /// Its result.
    type Made;

    /// Does it with the device, its protection, what stands in for it in simulation, and its recommended settings.
    ///
    /// # Errors
    /// A request that the device refuses.
    fn on<K: Kinematics<3> + Copy + Sync + 'static>(
        self,
        device: &'static Device<K, 3>,
        protection: Protection<3>,
        plant: &PlantSettings,
        recommended: Recommended,
    ) -> Result<Self::Made, Refusal>;
}

/// A refused setting by its argument, with its number and the device's limit.
pub fn refused<K>(error: ConfigError, settings: &Settings, device: &Device<K, 3>) -> Refusal {
    let bounded = |name: &str, number: f32, most: f32, unit: &str| {
        format!("{name} = {number}: this device takes 0 to {most} {unit}")
    };
    let number = match error {
        ConfigError::Settings(SettingsError::Rate) => ("rate", settings.rate_hz),
        ConfigError::Settings(SettingsError::MaxForce) => ("max_force", settings.max_force_n),
        ConfigError::Settings(SettingsError::VelocityCorner) => ("velocity_corner", settings.velocity_corner_hz),
        ConfigError::Settings(SettingsError::SoftStart) => ("soft_start", settings.soft_start_s),
        ConfigError::Settings(SettingsError::Stiffness) => {
            let Settings { stiffness_n_per_m: stiffness, .. } = *settings;
            return Refusal::Settings(bounded("stiffness", stiffness, device.max_stiffness_n_per_m, "N/m"));
        }
        ConfigError::Settings(SettingsError::Damping) => {
            let Settings { damping_n_s_per_m: damping, .. } = *settings;
            return Refusal::Settings(bounded("damping", damping, device.max_damping_n_s_per_m, "N·s/m"));
        }
        other => return Refusal::Settings(other.to_string()),
    };
    Refusal::Settings(format!("{} = {}: {error}", number.0, number.1))
}

/// Does it with one's own device, from its file, or with the one of this name: a name that ends in `.toml` is a file, as
/// on the command line.
///
/// # Errors
/// No such device, or a fault of it or of the request.
pub fn on_device<V: OnDevice>(device: &Path, what: V) -> Result<V::Made, Refusal> {
    let label = device.display().to_string();
    let (preset, protection, plant, shipped) = if device.extension().is_some_and(|extension| extension == "toml") {
        let text = fs::read_to_string(device).map_err(|cause| Refusal::Path(label.clone(), cause))?;
        let own = OwnDevice::parse(&text, &label).map_err(|error| Refusal::Settings(error.to_string()))?;
        (own.preset, own.protection, own.plant, None)
    } else {
        let none = || {
            Refusal::Settings(match device.extension() {
                Some(_) => DeviceFileError::Kind(label.clone()).to_string(),
                None => format!("there is no device {label:?}; there are {}", NAMES.join(", ")),
            })
        };
        let known = DEVICES.iter().find(|known| known.name == label && NAMES.contains(&known.name));
        let known = known.ok_or_else(none)?;
        (known.preset, known.protection(), known.plant, Some(known.recommended()))
    };
    match preset {
        Preset::SerialArm(device) => {
            what.on(device, protection, &plant, shipped.unwrap_or_else(|| recommended::of(device)))
        }
        Preset::LinkageArm(device) => {
            what.on(device, protection, &plant, shipped.unwrap_or_else(|| recommended::of(device)))
        }
        Preset::Delta(device) => {
            what.on(device, protection, &plant, shipped.unwrap_or_else(|| recommended::of(device)))
        }
        // No file describes one.
        Preset::FiveBar(_) | Preset::Paddle(_) => {
            Err(Refusal::Settings(format!("{label}: a device with fewer than three joints feels no body")))
        }
    }
}
