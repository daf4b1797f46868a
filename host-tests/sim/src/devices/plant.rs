//! Simulated plant of the user's own device.
//!
//! Geometry, transmission and friction come from the file, and where it states the inertia of a joint that in the middle
//! of the workspace. The rest is assumed: thin rods of 100 g, a turntable of 2e-3 kg·m², rotors of 10 g·cm²,
//! windings of 1 mH. The load of gravity on the joints is the file's, independent of the assumed masses.

use super::read::OwnDevice;
use super::schema::{DeviceFile, JointEntry, MassEntry, MechanismEntry};
use crate::plant::{
    Amplifier, ArmSettings, DeltaSettings, Direction, FiveBarSettings, JointSettings, Link, LinkLump,
    LinkageArmSettings, MechanismSettings, PlantSettings, Vector, Winding,
};
use std::fmt::Write as _;

/// How far inside a joint's range its stops are, rad.
const STOPS_WITHIN: f64 = 0.03;
/// Assumed, kg.
const ROD: f64 = 0.1;
/// Assumed, kg·m².
const TURNTABLE: f64 = 2.0e-3;
/// Assumed, kg·m².
const ROTOR: f64 = 1e-6;
/// Of the drums and counterweights of each link, assumed, kg·m².
const BALANCE: [f64; 2] = [1e-3, 5e-4];
/// The part of a stated inertia that assumed masses may make up; the rotor has the rest.
const OF_LINKS: f64 = 0.9;
/// Assumed of a winding on a bridge, H.
const INDUCTANCE: f64 = 1e-3;
/// Rotors are positive, kg·m².
const MIN_ROTOR: f64 = 1e-9;

/// The plant of a file; else the entry that it refuses, and why.
pub(super) fn settings(file: &DeviceFile) -> Result<PlantSettings, (&'static str, String)> {
    let mut settings = PlantSettings {
        mechanism: mechanism(&file.mechanism, 1.0),
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
    state_inertia(file, &mut settings, angles);
    Ok(settings)
}

/// The inertia that turns with each joint at these angles, the others held, kg·m²: drum, links and rotor; of a delta
/// without its plate, which three joints share.
fn inertias(settings: &PlantSettings, angles: Vector) -> Vector {
    let mut alone = *settings;
    if let MechanismSettings::Delta(delta) = &mut alone.mechanism {
        delta.plate_mass = 0.0;
    }
    let matrix = alone.mechanism(0.0).mass_matrix(angles);
    core::array::from_fn(|index| matrix[index][index])
}

/// Scales assumed masses down to less than every stated inertia, and gives the rotors the rest.
fn state_inertia(file: &DeviceFile, settings: &mut PlantSettings, angles: Vector) {
    let stated = || file.joint.iter().enumerate().filter_map(|(index, joint)| Some((index, joint.inertia?)));
    let squared = settings.joints.map(|joint| joint.ratio * joint.ratio);
    let found = inertias(settings, angles);
    let scales = stated().map(|(index, wanted)| OF_LINKS * wanted / (found[index] - ROTOR * squared[index]));
    settings.mechanism = mechanism(&file.mechanism, scales.fold(1.0, f64::min));
    let found = inertias(settings, angles);
    for (index, wanted) in stated() {
        settings.joints[index].rotor_inertia = (ROTOR + (wanted - found[index]) / squared[index]).max(MIN_ROTOR);
    }
}

/// The assumptions, in a line.
pub(super) fn remark(own: &OwnDevice) -> String {
    let mut bridges = own.file.joint.iter().filter_map(|joint| joint.motor.bridge);
    let winding = if bridges.any(|bridge| bridge.inductance.is_none()) {
        "; inductance of 1 mH assumed where `bridge` states none"
    } else {
        ""
    };
    if own.file.joint.iter().any(|joint| joint.inertia.is_none()) {
        return format!("inertia that the file does not state is assumed{winding}");
    }
    let mut said = format!("inertia as stated; its split over links assumed{winding}");
    let angles = own.plant.mechanism(0.0).angles([0.0; 3]).unwrap_or_default();
    for (joint, found) in own.file.joint.iter().zip(inertias(&own.plant, angles)) {
        let stated = joint.inertia.unwrap_or(found);
        if found > 1.01 * stated {
            let _ = write!(
                said,
                "; joint {}: {stated} kg·m² stated, {found:.1e} simulated, of its masses alone: correct one of them",
                joint.name
            );
        }
    }
    said
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
            Amplifier::Voltage(Winding {
                supply: bridge.supply,
                resistance: bridge.resistance,
                inductance: bridge.inductance.unwrap_or(INDUCTANCE),
            })
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

/// With this part of the assumed masses.
fn mechanism(entry: &MechanismEntry, part: f64) -> MechanismSettings {
    let rod = ROD * part;
    match entry {
        MechanismEntry::SerialArm { base_height, first_link, second_link, workspace_centre, end_masses } => {
            let [first, second] = [first_link, second_link].map(|length| Link::rod(*length, rod, 0.5 * length));
            MechanismSettings::Arm(ArmSettings {
                base_height: *base_height,
                first_link: first,
                second_link: second,
                workspace_centre: *workspace_centre,
                turntable_inertia: TURNTABLE * part,
                // What the file says that they lift, less what these rods weigh.
                balance: [
                    end_masses[0] * first_link - rod * first.centre - rod * first_link,
                    end_masses[1] * second_link - rod * second.centre,
                ],
                balance_inertia: BALANCE.map(|inertia| inertia * part),
            })
        }
        MechanismEntry::LinkageArm(arm) => {
            let lengths = [arm.cranks[0], arm.cranks[1], arm.tool.abs().max(arm.rods[0]), arm.rods[1]];
            let assumed = |length: f64| MassEntry { mass: rod, along: 0.5 * length, across: 0.0 };
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
                turntable_inertia: TURNTABLE * part,
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
                thigh_inertia: 1.5e-4 * part,
                shin_mass,
                plate_mass: (carried_mass - 1.5 * shin_mass).max(0.02),
                thigh_mass: 0.060,
                thigh_centre: ((thigh_moment - knee) / 0.060).max(0.0),
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{inertias, remark};
    use crate::devices::{OwnDevice, named};

    /// The shipped plants have the same numbers of another make, their links and rotors; the constants are rounded.
    #[test]
    fn the_plant_of_a_file_has_the_stated_inertia_in_the_middle_of_the_workspace() {
        for name in ["woodenhaptics-2016", "polhem-v2", "phantom-premium", "falcon"] {
            let shipped = named(name).expect("it ships");
            let file = shipped.file().expect("a file of it");
            let stated: Vec<f64> = file.joint.iter().map(|joint| joint.inertia.expect("stated")).collect();
            let own = OwnDevice::new(file, name).expect("a device").plant;
            for (plant, off) in [(shipped.plant, 0.06), (own, 1e-9)] {
                let angles = plant.mechanism(0.0).angles([0.0; 3]).expect("within reach");
                for (found, stated) in inertias(&plant, angles).into_iter().zip(&stated) {
                    println!("{name}: {found:.3e} kg·m², {stated:.3e} stated");
                    assert!((found / stated - 1.0).abs() < off, "{name}: {found} {stated}");
                }
            }
        }
    }

    #[test]
    fn inertia_below_that_of_the_stated_masses_is_reported() {
        let mut file = named("polhem-v2").and_then(|device| device.file()).expect("a file of it");
        assert_eq!(
            remark(&OwnDevice::new(file.clone(), "a").expect("a device")),
            "inertia as stated; its split over links assumed"
        );
        file.joint[2].inertia = Some(1e-4);
        let said = remark(&OwnDevice::new(file.clone(), "a").expect("a device"));
        assert!(said.contains("joint c: 0.0001 kg·m² stated, "), "{said}");
        file.joint[2].inertia = None;
        let said = remark(&OwnDevice::new(file, "a").expect("a device"));
        assert_eq!(said, "inertia that the file does not state is assumed");
    }
}
