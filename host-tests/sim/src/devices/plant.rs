//! Simulated plant of the user's own device.
//!
//! Geometry, transmission and friction come from the file. Inertia that the file does not state is assumed: thin rods
//! of 100 g, a turntable of 2e-3 kg·m², rotors of 10 g·cm². The load of gravity on the joints is the file's,
//! independent of the assumed masses.

use super::schema::{DeviceFile, JointEntry, MassEntry, MechanismEntry};
use crate::plant::{
    Amplifier, ArmSettings, DeltaSettings, Direction, FiveBarSettings, JointSettings, Link, LinkLump,
    LinkageArmSettings, MechanismSettings, PlantSettings, Winding,
};

/// How far inside a joint's range its stops are, rad.
const STOPS_WITHIN: f64 = 0.03;
/// Assumed, kg.
const ROD: f64 = 0.1;
/// Assumed, kg·m².
const TURNTABLE: f64 = 2.0e-3;
/// Assumed, kg·m².
const ROTOR: f64 = 1e-6;

/// The plant of a file; else the entry that it refuses, and why.
pub(super) fn settings(file: &DeviceFile) -> Result<PlantSettings, (&'static str, String)> {
    let settings = PlantSettings {
        mechanism: mechanism(&file.mechanism),
        gravity: 9.81,
        joints: core::array::from_fn(|index| joint(&file.joint[index])),
        current_time_constant: 1.5e-4,
        delay_periods: 1.0,
        sub_steps: 20,
    };
    let refuse = |reason: String| {
        let serial = "; put it half to 0.7 of first_link + second_link from the first link's axis";
        let start = if matches!(file.mechanism, MechanismEntry::SerialArm { .. }) { serial } else { "" };
        Err((file.mechanism.centre(), format!("{reason}{start}")))
    };
    let Some(angles) = settings.mechanism(0.0).angles([0.0; 3]) else {
        return refuse("is out of the mechanism's reach".to_owned());
    };
    for ((angle, JointSettings { stops: [least, most], .. }), JointEntry { name, .. }) in
        angles.iter().zip(&settings.joints).zip(&file.joint)
    {
        if !(least..=most).contains(&angle) {
            let stops = format!("{STOPS_WITHIN} rad within its range");
            return refuse(format!("needs joint {name} at {angle:.2} rad, beyond its stops, {stops}"));
        }
    }
    Ok(settings)
}

fn direction(ratio: f64) -> Direction {
    if ratio < 0.0 { Direction::Against } else { Direction::With }
}

fn joint(entry: &JointEntry) -> JointSettings {
    let JointEntry { range: [least, most], friction, encoder, motor, .. } = entry;
    // One ratio for both in the plant: the encoder's is counted into its counts.
    let counts = encoder.counts * (encoder.ratio / motor.ratio).abs();
    JointSettings {
        ratio: motor.ratio.abs(),
        counts_per_turn: counts,
        encoder_direction: direction(encoder.ratio),
        angle_at_zero: encoder.zero,
        amplifier: motor.bridge.map_or(Amplifier::Current, |bridge| {
            Amplifier::Voltage(Winding { supply: bridge.supply, resistance: bridge.resistance, inductance: 1e-3 })
        }),
        motor_direction: direction(motor.ratio),
        torque_constant: motor.torque_constant,
        current_at_full: motor.current_at_full,
        current_limit: if motor.bridge.is_some() { 2.0 * motor.current_at_full } else { motor.current_at_full },
        rotor_inertia: ROTOR,
        viscous_friction: 5e-4,
        coulomb_friction: *friction,
        stops: [least + STOPS_WITHIN, most - STOPS_WITHIN],
    }
}

fn mechanism(entry: &MechanismEntry) -> MechanismSettings {
    match entry {
        MechanismEntry::SerialArm { base_height, first_link, second_link, workspace_centre, end_masses } => {
            let [first, second] = [first_link, second_link].map(|length| Link::rod(*length, ROD, 0.5 * length));
            MechanismSettings::Arm(ArmSettings {
                base_height: *base_height,
                first_link: first,
                second_link: second,
                workspace_centre: *workspace_centre,
                turntable_inertia: TURNTABLE,
                // What the file says that they lift, less what these rods weigh.
                balance: [
                    end_masses[0] * first_link - ROD * first.centre - ROD * first_link,
                    end_masses[1] * second_link - ROD * second.centre,
                ],
                balance_inertia: [1e-3, 5e-4],
            })
        }
        MechanismEntry::LinkageArm(arm) => {
            let lengths = [arm.cranks[0], arm.cranks[1], arm.tool.abs().max(arm.rods[0]), arm.rods[1]];
            let assumed = |length: f64| MassEntry { mass: ROD, along: 0.5 * length, across: 0.0 };
            let masses = arm.masses.unwrap_or_else(|| lengths.map(assumed));
            MechanismSettings::LinkageArm(LinkageArmSettings {
                linkage: FiveBarSettings {
                    second_pivot: arm.second_pivot,
                    cranks: arm.cranks,
                    rods: arm.rods,
                    tool: arm.tool,
                    side: arm.side,
                    bends: [1.0, 1.0],
                    workspace_centre: [0.0; 2],
                    links: core::array::from_fn(|link| LinkLump {
                        mass: masses[link].mass,
                        along: masses[link].along,
                        across: masses[link].across,
                        inertia: masses[link].mass * lengths[link] * lengths[link] / 12.0,
                    }),
                    tool_mass: 0.0,
                },
                pivot_reach: arm.pivot_reach,
                workspace_centre: arm.workspace_centre,
                turntable_inertia: TURNTABLE,
            })
        }
        MechanismEntry::Delta { thigh, shin, stub, reach, side, legs, workspace_depth, carried_mass, thigh_moment } => {
            let shin_mass = 0.015_f64.min(carried_mass / 3.0);
            let knee = 0.5 * shin_mass * thigh;
            MechanismSettings::Delta(DeltaSettings {
                a: *thigh,
                b: *shin,
                c: 0.0,
                d: 0.5 * stub,
                e: 0.5 * stub,
                f: 0.0,
                r: *reach,
                s: *side,
                legs: *legs,
                workspace_depth: *workspace_depth,
                thigh_inertia: 1.5e-4,
                shin_mass,
                plate_mass: (carried_mass - 1.5 * shin_mass).max(0.02),
                thigh_mass: 0.060,
                thigh_centre: ((thigh_moment - knee) / 0.060).max(0.0),
            })
        }
    }
}
