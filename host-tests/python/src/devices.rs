//! The devices that ship with three joints: what the loop knows of each, and what stands in for it in simulation.

use crate::refusal::Refusal;
use crate::simulate::{Run, Wishes, run};
use palpate::body::Body;
use palpate::device::presets;
use palpate_plant::PlantSettings;
use pyo3::prelude::*;

/// Their names on the command line of `palpate sim`, too.
const NAMES: [&str; 4] = ["woodenhaptics-2016", "polhem-v2", "phantom-premium", "falcon"];

/// The devices that ship.
#[pyfunction]
pub fn devices() -> Vec<&'static str> {
    NAMES.to_vec()
}

/// Runs the loop on the device of this name.
///
/// # Errors
/// That there is none, or what is wrong with what is wished.
pub fn run_on(name: &str, body: &'static Body<'static>, wishes: &Wishes) -> Result<Run, Refusal> {
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
