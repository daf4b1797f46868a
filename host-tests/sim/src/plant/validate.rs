//! Numbers no device has are refused by name before anything is simulated.

use super::five_bar::FiveBarSettings;
use super::hand::HandSettings;
use super::motor::Amplifier;
use super::settings::{ArmSettings, MechanismSettings, PlantSettings};
use super::vector::Vector;

/// Why a plant cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// A number that must be finite and above zero is not.
    #[error("{field} must be finite and greater than zero, not {value}")]
    NotPositive {
        /// The number's name.
        field: &'static str,
        /// The given value.
        value: f64,
    },
    /// A number that must be finite and not below zero is not.
    #[error("{field} must be finite and not negative, not {value}")]
    Negative {
        /// The number's name.
        field: &'static str,
        /// The given value.
        value: f64,
    },
    /// A number is not finite.
    #[error("{field} must be finite, not {value}")]
    NotFinite {
        /// The number's name.
        field: &'static str,
        /// The given value.
        value: f64,
    },
    /// The hand's path starts where the device cannot reach.
    #[error("the hand's path starts at {position:?} m, out of the device's reach")]
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
    validate_mechanism(&plant.mechanism)?;
    finite("gravity", plant.gravity)?;
    for joint in &plant.joints {
        positive("ratio", joint.ratio)?;
        positive("counts_per_turn", joint.counts_per_turn)?;
        finite("angle_at_zero", joint.angle_at_zero)?;
        if let Amplifier::CurrentOn(winding) | Amplifier::Voltage(winding) = joint.amplifier {
            positive("supply", winding.supply)?;
            positive("resistance", winding.resistance)?;
            not_negative("inductance", winding.inductance)?;
        }
        not_negative("torque_constant", joint.torque_constant)?;
        not_negative("current_at_full", joint.current_at_full)?;
        not_negative("current_limit", joint.current_limit)?;
        // Above zero, so that the mass matrix has an inverse whatever the links weigh.
        positive("rotor_inertia", joint.rotor_inertia)?;
        not_negative("viscous_friction", joint.viscous_friction)?;
        not_negative("coulomb_friction", joint.coulomb_friction)?;
        let [least, most] = joint.stops;
        let apart = least < most;
        if !apart {
            return Err(PlantError::NotPositive { field: "stops", value: most - least });
        }
    }
    not_negative("current_time_constant", plant.current_time_constant)?;
    not_negative("delay_periods", plant.delay_periods)?;
    positive("sub_steps", f64::from(plant.sub_steps))?;
    not_negative("hand.stiffness", hand.stiffness)?;
    not_negative("hand.damping", hand.damping)?;
    not_negative("hand.mass", hand.mass)
}

fn validate_mechanism(mechanism: &MechanismSettings) -> Result<(), PlantError> {
    match mechanism {
        MechanismSettings::Arm(arm) => validate_arm(arm),
        MechanismSettings::Paddle(paddle) => {
            positive("handle", paddle.handle)?;
            not_negative("inertia", paddle.inertia)?;
            not_negative("mass", paddle.mass)?;
            finite("centre", paddle.centre)
        }
        MechanismSettings::FiveBar(linkage) => validate_linkage(linkage),
        MechanismSettings::LinkageArm(arm) => {
            validate_linkage(&arm.linkage)?;
            finite("pivot_reach", arm.pivot_reach)?;
            arm.workspace_centre.into_iter().try_for_each(|entry| finite("workspace_centre", entry))?;
            not_negative("turntable_inertia", arm.turntable_inertia)
        }
        MechanismSettings::Delta(delta) => {
            for (name, length) in [("a", delta.a), ("b", delta.b), ("workspace_depth", delta.workspace_depth)] {
                positive(name, length)?;
            }
            not_negative("d", delta.d)?;
            not_negative("e", delta.e)?;
            for (name, number) in [("c", delta.c), ("f", delta.f), ("r", delta.r), ("s", delta.s)] {
                finite(name, number)?;
            }
            delta.legs.into_iter().try_for_each(|leg| finite("legs", leg))?;
            not_negative("thigh_inertia", delta.thigh_inertia)?;
            not_negative("shin_mass", delta.shin_mass)?;
            not_negative("plate_mass", delta.plate_mass)?;
            not_negative("thigh_mass", delta.thigh_mass)?;
            finite("thigh_centre", delta.thigh_centre)
        }
    }
}

fn validate_arm(arm: &ArmSettings) -> Result<(), PlantError> {
    not_negative("base_height", arm.base_height)?;
    for (link, [length, mass, centre, inertia]) in [
        (&arm.first_link, ["first_link.length", "first_link.mass", "first_link.centre", "first_link.inertia"]),
        (&arm.second_link, ["second_link.length", "second_link.mass", "second_link.centre", "second_link.inertia"]),
    ] {
        positive(length, link.length)?;
        not_negative(mass, link.mass)?;
        finite(centre, link.centre)?;
        not_negative(inertia, link.inertia)?;
    }
    arm.workspace_centre.into_iter().try_for_each(|entry| finite("workspace_centre", entry))?;
    not_negative("turntable_inertia", arm.turntable_inertia)?;
    arm.balance.into_iter().try_for_each(|entry| finite("balance", entry))?;
    arm.balance_inertia.into_iter().try_for_each(|entry| not_negative("balance_inertia", entry))
}

fn validate_linkage(linkage: &FiveBarSettings) -> Result<(), PlantError> {
    finite("second_pivot", linkage.second_pivot)?;
    linkage.cranks.into_iter().try_for_each(|length| positive("cranks", length))?;
    linkage.rods.into_iter().try_for_each(|length| positive("rods", length))?;
    positive("tool", linkage.tool.abs())?;
    linkage.workspace_centre.into_iter().try_for_each(|entry| finite("workspace_centre", entry))?;
    not_negative("tool_mass", linkage.tool_mass)?;
    for link in linkage.links {
        not_negative("links.mass", link.mass)?;
        finite("links.along", link.along)?;
        finite("links.across", link.across)?;
        not_negative("links.inertia", link.inertia)?;
    }
    Ok(())
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
    fn the_presets_are_valid() {
        for preset in [
            PlantSettings::wooden_haptics_2016(),
            PlantSettings::phantom_premium(),
            PlantSettings::polhem_v2(),
            PlantSettings::hapkit(),
            PlantSettings::haply_2diy_v3(),
            PlantSettings::haply_kit_v1(),
            PlantSettings::novint_falcon(),
        ] {
            assert_eq!(validate(&preset, &HandSettings::default(), 4_000.0), Ok(()));
        }
    }

    /// The arm to change.
    fn arm(plant: &mut PlantSettings) -> &mut ArmSettings {
        match &mut plant.mechanism {
            MechanismSettings::Arm(arm) => arm,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_offending_number_is_named() {
        let names = [
            verdict(|_, _, rate| *rate = 0.0),
            verdict(|plant, _, _| arm(plant).first_link.mass = -0.1),
            verdict(|plant, _, _| arm(plant).second_link.inertia = f64::NAN),
            verdict(|plant, _, _| arm(plant).second_link.length = 0.0),
            verdict(|plant, _, _| arm(plant).workspace_centre[2] = f64::INFINITY),
            verdict(|plant, _, _| plant.gravity = f64::NAN),
            verdict(|plant, _, _| plant.joints[1].rotor_inertia = 0.0),
            verdict(|plant, _, _| plant.joints[2].coulomb_friction = -1.0),
            verdict(|plant, _, _| plant.joints[0].stops = [0.5, 0.5]),
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
            "stops",
            "delay_periods",
            "sub_steps",
            "hand.stiffness",
            "hand.mass",
        ];
        assert_eq!(names, expected);
    }
}
