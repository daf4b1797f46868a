//! The devices that ship with three joints, and one's own: what the loop knows of each, and what stands in for it in
//! simulation.

use crate::refusal::Refusal;
use crate::simulate::{Run, Wishes, run};
use palpate::body::Body;
use palpate::device::presets;
use palpate_sim::devices::{OwnDevice, Preset};
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

/// Runs the loop on one's own device, from its file, or on the one of this name: a name that ends in `.toml` is a file,
/// as on the command line.
///
/// # Errors
/// No such device, or a fault of it or of the request.
pub fn run_on(device: &Path, body: &'static Body<'static>, wishes: &Wishes) -> Result<Run, Refusal> {
    if device.extension().is_none_or(|extension| extension != "toml") {
        return run_named(&device.to_string_lossy(), body, wishes);
    }
    let label = device.display().to_string();
    let text = fs::read_to_string(device).map_err(|cause| Refusal::Path(label.clone(), cause))?;
    let own = OwnDevice::parse(&text, &label).map_err(|error| Refusal::Settings(error.to_string()))?;
    let OwnDevice { protection, plant, .. } = own;
    match own.preset {
        Preset::SerialArm(device) => run(device, protection, &plant, body, wishes),
        Preset::LinkageArm(device) => run(device, protection, &plant, body, wishes),
        Preset::Delta(device) => run(device, protection, &plant, body, wishes),
        // No file describes one.
        Preset::FiveBar(_) | Preset::Paddle(_) => {
            Err(Refusal::Settings(format!("{label}: a device with fewer than three joints feels no body")))
        }
    }
}

fn run_named(name: &str, body: &'static Body<'static>, wishes: &Wishes) -> Result<Run, Refusal> {
    match name {
        "woodenhaptics-2016" => run(
            &presets::WOODEN_HAPTICS_2016,
            presets::WOODEN_HAPTICS_2016_PROTECTION,
            &PlantSettings::wooden_haptics_2016(),
            body,
            wishes,
        ),
        "polhem-v2" => {
            run(&presets::POLHEM_V2, presets::POLHEM_V2_PROTECTION, &PlantSettings::polhem_v2(), body, wishes)
        }
        "phantom-premium" => run(
            &presets::PHANTOM_PREMIUM,
            presets::PHANTOM_PREMIUM_PROTECTION,
            &PlantSettings::phantom_premium(),
            body,
            wishes,
        ),
        "falcon" => run(
            &presets::NOVINT_FALCON,
            presets::NOVINT_FALCON_PROTECTION,
            &PlantSettings::novint_falcon(),
            body,
            wishes,
        ),
        _ => Err(Refusal::Settings(format!("there is no device {name:?}; there are {}", NAMES.join(", ")))),
    }
}
