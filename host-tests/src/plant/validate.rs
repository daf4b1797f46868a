//! Numbers no device has are refused by name before anything is simulated.

use super::hand::HandSettings;
use super::settings::PlantSettings;
use super::vector::Vector;

/// Why a plant cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// A number that must be finite and above zero is not.
    #[error("{field} must be finite and greater than zero, not {value}")]
    NotPositive {
        /// The number's name.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// A number that must be finite and not below zero is not.
    #[error("{field} must be finite and not negative, not {value}")]
    Negative {
        /// The number's name.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// A number is not finite.
    #[error("{field} must be finite, not {value}")]
    NotFinite {
        /// The number's name.
        field: &'static str,
        /// What was given.
        value: f64,
    },
    /// The hand's path starts where the arm cannot reach.
    #[error("the hand's path starts at {position:?} m, out of the arm's reach")]
    OutOfReach {
        /// Where it starts, m from the workspace centre.
        position: Vector,
    },
}

fn positive(field: &'static str, value: f64) -> Result<(), PlantError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(PlantError::NotPositive { field, value }) }
}

fn not_negative(field: &'static str, value: f64) -> Result<(), PlantError> {
    if value.is_finite() && value >= 0.0 { Ok(()) } else { Err(PlantError::Negative { field, value }) }
}

fn finite(field: &'static str, value: f64) -> Result<(), PlantError> {
    if value.is_finite() { Ok(()) } else { Err(PlantError::NotFinite { field, value }) }
}

/// Checks every number, in the order they are declared.
pub(super) fn validate(plant: &PlantSettings, hand: &HandSettings, rate_hz: f64) -> Result<(), PlantError> {
    positive("rate_hz", rate_hz)?;
    not_negative("base_height", plant.base_height)?;
    for (link, [length, mass, centre, inertia]) in [
        (&plant.first_link, ["first_link.length", "first_link.mass", "first_link.centre", "first_link.inertia"]),
        (&plant.second_link, ["second_link.length", "second_link.mass", "second_link.centre", "second_link.inertia"]),
    ] {
        positive(length, link.length)?;
        not_negative(mass, link.mass)?;
        finite(centre, link.centre)?;
        not_negative(inertia, link.inertia)?;
    }
    for entry in plant.workspace_centre {
        finite("workspace_centre", entry)?;
    }
    not_negative("turntable_inertia", plant.turntable_inertia)?;
    finite("gravity", plant.gravity)?;
    for joint in &plant.joints {
        positive("ratio", joint.ratio)?;
        positive("counts_per_turn", joint.counts_per_turn)?;
        not_negative("torque_constant", joint.torque_constant)?;
        not_negative("current_at_full", joint.current_at_full)?;
        not_negative("current_limit", joint.current_limit)?;
        // Above zero, so that the mass matrix has an inverse whatever the links weigh.
        positive("rotor_inertia", joint.rotor_inertia)?;
        not_negative("viscous_friction", joint.viscous_friction)?;
        not_negative("coulomb_friction", joint.coulomb_friction)?;
    }
    not_negative("current_time_constant", plant.current_time_constant)?;
    not_negative("delay_periods", plant.delay_periods)?;
    positive("sub_steps", f64::from(plant.sub_steps))?;
    not_negative("hand.stiffness", hand.stiffness)?;
    not_negative("hand.damping", hand.damping)?;
    not_negative("hand.mass", hand.mass)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the check says of the preset, changed.
    fn verdict(change: impl FnOnce(&mut PlantSettings, &mut HandSettings, &mut f64)) -> Result<(), PlantError> {
        let (mut plant, mut hand, mut rate) = (PlantSettings::wooden_haptics_2016(), HandSettings::default(), 4_000.0);
        change(&mut plant, &mut hand, &mut rate);
        validate(&plant, &hand, rate)
    }

    #[test]
    fn the_preset_is_valid() {
        assert_eq!(verdict(|_, _, _| ()), Ok(()));
    }

    #[test]
    fn the_offending_number_is_named() {
        let names = [
            verdict(|_, _, rate| *rate = 0.0),
            verdict(|plant, _, _| plant.first_link.mass = -0.1),
            verdict(|plant, _, _| plant.second_link.inertia = f64::NAN),
            verdict(|plant, _, _| plant.second_link.length = 0.0),
            verdict(|plant, _, _| plant.workspace_centre[2] = f64::INFINITY),
            verdict(|plant, _, _| plant.gravity = f64::NAN),
            verdict(|plant, _, _| plant.joints[1].rotor_inertia = 0.0),
            verdict(|plant, _, _| plant.joints[2].coulomb_friction = -1.0),
            verdict(|plant, _, _| plant.delay_periods = -0.5),
            verdict(|plant, _, _| plant.sub_steps = 0),
            verdict(|_, hand, _| hand.stiffness = f64::NAN),
            verdict(|_, hand, _| hand.mass = -1.0),
        ]
        .map(|verdict| verdict.unwrap_err().to_string().split(' ').next().unwrap().to_owned());
        let expected = [
            "rate_hz",
            "first_link.mass",
            "second_link.inertia",
            "second_link.length",
            "workspace_centre",
            "gravity",
            "rotor_inertia",
            "coulomb_friction",
            "delay_periods",
            "sub_steps",
            "hand.stiffness",
            "hand.mass",
        ];
        assert_eq!(names, expected);
    }
}
