//! From the text of a device file to a device that has been checked, entry by entry.

#[cfg(feature = "std")]
use super::plant;
use super::schema::{BridgeEntry, DeviceFile, JointEntry, MechanismEntry};
use crate::devices::preset::Preset;
#[cfg(feature = "std")]
use crate::plant::PlantSettings;
use alloc::borrow::ToOwned as _;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;
use palpate::commission::Wiring;
use palpate::device::drive::{Feed, VoltageFeed};
use palpate::device::{
    Delta, Device, DeviceError, Encoder, Endurance, FiveBar, Kinematics, LinkMass, LinkageArm, Motor, PolarityCheck,
    Protection, SerialArm,
};
use palpate::math::{Vec2, vec3};
#[cfg(feature = "std")]
use std::{fs, path::Path};
use thiserror::Error;

/// More than any haptic device's motor gives at its joint, N·m.
const MAX_JOINT_TORQUE: f64 = 100.0;
/// Two turns either way: the smallest range in degrees is beyond.
const MAX_ANGLE: f64 = 12.6;

/// Why a device file is refused.
#[derive(Debug, Error)]
pub enum DeviceFileError {
    /// It cannot be read.
    #[cfg(feature = "std")]
    #[error(
        "{file}: cannot be read: {cause}; `palpate device woodenhaptics-2016 --out my.toml` writes one to start from"
    )]
    Read {
        /// Which.
        file: String,
        /// Why.
        cause: std::io::Error,
    },
    /// Its name is that of another kind of file.
    #[error(
        "{0}: a device file ends in .toml, and states lengths, masses, encoders and motors of an arm; URDF, SDF and MJCF are \
         not read; `palpate device woodenhaptics-2016 --out my.toml` writes one to start from \
         (docs/reference/device-format.md)"
    )]
    Kind(String),
    /// It is not a device file: an entry is missing, unknown or of another kind.
    #[error("{file}: {reason}")]
    Schema {
        /// Which.
        file: String,
        /// Line, entry and reason.
        reason: String,
    },
    /// An entry has a value that no device has.
    #[error("{file}: {entry}: {reason}")]
    Entry {
        /// Which.
        file: String,
        /// As the file names it.
        entry: String,
        /// The reason.
        reason: String,
    },
}

/// A device file that has been read, with all that it describes.
#[derive(Clone, Debug)]
pub struct OwnDevice {
    /// Content of the file.
    pub file: DeviceFile,
    /// The servo's description of it, a leaked `'static`.
    pub preset: Preset,
    /// Its protection.
    pub protection: Protection<3>,
    /// Its simulated plant.
    #[cfg(feature = "std")]
    pub plant: PlantSettings,
}

impl OwnDevice {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// The first thing wrong with it.
    #[cfg(feature = "std")]
    pub fn read(path: &Path) -> Result<Self, DeviceFileError> {
        let file = path.display().to_string();
        if path.extension().is_some_and(|extension| extension != "toml") {
            return Err(DeviceFileError::Kind(file));
        }
        let text = fs::read_to_string(path).map_err(|cause| DeviceFileError::Read { file: file.clone(), cause })?;
        Self::parse(&text, &file)
    }

    /// The same from its text; messages call it `label`.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn parse(text: &str, label: &str) -> Result<Self, DeviceFileError> {
        let file: DeviceFile = toml::from_str(text).map_err(|error| {
            let reason = error.message().lines().next().unwrap_or_default();
            let place = place(text, error.span().map_or(0, |span| span.start), reason);
            DeviceFileError::Schema { file: label.to_owned(), reason: format!("{place}: {reason}") }
        })?;
        Self::new(file, label)
    }

    /// A device from the entries of a file.
    ///
    /// # Errors
    /// The first entry that no device has.
    pub fn new(file: DeviceFile, label: &str) -> Result<Self, DeviceFileError> {
        let refuse = |entry: &str, reason: &str| DeviceFileError::Entry {
            file: label.to_owned(),
            entry: file.by_name(&format!("{entry}:")).trim_end_matches(':').to_owned(),
            reason: reason.to_owned(),
        };
        check(&file, refuse)?;
        let (preset, problem) = preset(&file);
        if let Err(error) = problem {
            let entry = match error {
                DeviceError::Encoder(joint) => format!("joint {joint}: encoder"),
                DeviceError::Motor(joint) => format!("joint {joint}: motor"),
                DeviceError::Friction(joint) => format!("joint {joint}: friction"),
                DeviceError::Range(joint) | DeviceError::Endless(joint) => format!("joint {joint}: range"),
                DeviceError::Centre => file.mechanism.centre().to_owned(),
                // Their entry comes first in their own words.
                DeviceError::Mechanism(_) | DeviceError::Mass(_) | DeviceError::Weight { .. } => {
                    let text = error.to_string();
                    let (entry, reason) = text.split_once(": ").unwrap_or(("mechanism", &text));
                    return Err(refuse(entry, reason));
                }
                DeviceError::Limit => {
                    let limits = &file.limits;
                    let all = [
                        ("min_margin", limits.min_margin),
                        ("max_joint_rate", limits.max_joint_rate),
                        ("max_force", limits.max_force),
                        ("max_stiffness", limits.max_stiffness),
                        ("max_damping", limits.max_damping),
                    ];
                    let bad = all.iter().find(|(_, limit)| !(*limit as f32 > 0.0 && (*limit as f32).is_finite()));
                    let entry = bad.map_or("limits".to_owned(), |(name, _)| format!("limits.{name}"));
                    return Err(refuse(
                        &entry,
                        &format!(
                            "{error}; `palpate device woodenhaptics-2016 --out near.toml` shows those of a near device"
                        ),
                    ));
                }
            };
            // The joint stands before it.
            let text = error.to_string();
            return Err(refuse(&entry, text.split_once(": ").map_or(&*text, |(_, reason)| reason)));
        }
        let protection = protection(&file);
        #[cfg(feature = "std")]
        let plant = plant::settings(&file).map_err(|(entry, reason)| refuse(entry, &reason))?;
        Ok(Self {
            preset,
            protection,
            #[cfg(feature = "std")]
            plant,
            file,
        })
    }

    /// The channels of the joints' encoders and of their motors.
    pub(crate) fn channels(&self) -> [[u8; 3]; 2] {
        // Three joints and channels below three, as the file was checked.
        let of = |channel: fn(&JointEntry) -> usize| {
            core::array::from_fn(|joint| self.file.joint.get(joint).map_or(0, |joint| channel(joint) as u8))
        };
        [of(|joint| joint.encoder.channel), of(|joint| joint.motor.channel)]
    }

    /// Which of the board's inputs and outputs each joint is on.
    ///
    /// # Panics
    /// If the file was changed after it was checked.
    pub fn wiring(&self) -> Wiring<3> {
        let [inputs, outputs] = self.channels();
        Wiring::try_new(inputs, outputs).expect("a file is refused unless each joint has channels of its own")
    }
}

/// Where the text is wrong. Of an entry of a mechanism the parser knows its section only: the entry is the one with the
/// text that the message quotes, if there is one such.
fn place(text: &str, start: usize, reason: &str) -> String {
    let number = |at: usize| text[..at].matches('\n').count() + 1;
    let quoted =
        reason.split_once('"').and_then(|(_, rest)| rest.rsplit_once('"')).map(|(value, _)| format!("\"{value}\""));
    if let Some(at) = quoted.and_then(|value| text.find(&value).filter(|at| text.rfind(&value) == Some(*at))) {
        let entry = text[..at].lines().last().unwrap_or_default().split('=').next().unwrap_or_default().trim();
        return format!("line {}: {entry}", number(at));
    }
    let (start, rest) = text.get(start..).map_or((0, text), |rest| (start, rest));
    let section = rest.lines().next().unwrap_or_default().trim();
    if section.starts_with('[') {
        format!("the section {section} of line {}", number(start))
    } else {
        format!("line {}", number(start))
    }
}

/// Refuses numbers that no haptic device has: those of another unit.
fn check_units(file: &DeviceFile, refuse: &impl Fn(&str, &str) -> DeviceFileError) -> Result<(), DeviceFileError> {
    let within = |entry: &str, number: f64, least: f64, most: f64, unit: &str| {
        // A number that is none is refused elsewhere, by its own reason.
        if number < least || number > most {
            return Err(refuse(entry, &format!("{number} is no haptic device's: it is in {unit}, {least} to {most}")));
        }
        Ok(())
    };
    for (index, JointEntry { range, friction, encoder, motor, inertia, .. }) in file.joint.iter().enumerate() {
        let entry = |name: &str| format!("joint {index}: {name}");
        within(&entry("motor.torque_constant"), motor.torque_constant, 1e-4, 5.0, "N·m/A (36 mN·m/A are 0.036)")?;
        within(&entry("motor.current_at_full"), motor.current_at_full, 1e-3, 200.0, "A")?;
        let torque = (motor.torque_constant * motor.current_at_full * motor.ratio).abs();
        if torque > MAX_JOINT_TORQUE {
            let reason = format!(
                "torque_constant times current_at_full times ratio is {torque:.1} N·m at the joint, above {MAX_JOINT_TORQUE} N·m: \
                 they are in N·m/A and A"
            );
            return Err(refuse(&entry("motor"), &reason));
        }
        if *friction > torque && torque > 0.0 {
            let reason = format!("{friction} N·m is more than its motor's {torque:.3} N·m at the joint: it is in N·m");
            return Err(refuse(&entry("friction"), &reason));
        }
        for angle in range {
            within(&entry("range"), *angle, -MAX_ANGLE, MAX_ANGLE, "radians")?;
        }
        within(&entry("encoder.zero"), encoder.zero, -2.0 * MAX_ANGLE, 2.0 * MAX_ANGLE, "radians")?;
        within(&entry("inertia"), inertia.unwrap_or(0.0), 0.0, 1.0, "kg·m²")?;
    }
    within("limits.max_force", file.limits.max_force, 0.0, 500.0, "N")?;
    within("limits.max_stiffness", file.limits.max_stiffness, 0.0, 1e6, "N/m")?;
    if file.limits.max_stiffness > 0.0 && file.limits.max_stiffness < 10.0 {
        return Err(refuse("limits.max_stiffness", "must be at least 10 N/m: it is in N/m, not in N/mm"));
    }
    Ok(())
}

/// Refuses a bridge by its first implausible number, units before the current that it drives.
fn check_bridge(bridge: &BridgeEntry, current_at_full: f64) -> Result<(), String> {
    let BridgeEntry { supply, resistance, inductance, back_emf_share } = *bridge;
    for (name, number, [least, most], unit) in [
        ("supply", supply, [1.0, 100.0], "V"),
        ("resistance", resistance, [0.01, 1_000.0], "ohms"),
        ("back_emf_share", back_emf_share, [0.0, 1.0], "shares of the whole"),
    ] {
        if !(least..=most).contains(&number) {
            return Err(format!("{name} = {number} is no haptic device's: it is in {unit}, {least} to {most}"));
        }
    }
    // Of coreless to iron motors 0.01 to 2 ms.
    let lag_ms = inductance.map_or(0.0, |inductance| 1e3 * inductance / resistance);
    if !(0.0..=5.0).contains(&lag_ms) {
        return Err(format!(
            "inductance over resistance is {lag_ms:.3} ms, and must be 0 to 5: inductance is in H (0.12 mH are 0.00012)"
        ));
    }
    let most = supply / resistance;
    if most < current_at_full {
        return Err(format!(
            "its supply drives {most:.2} A at most through its resistance: lower current_at_full to that"
        ));
    }
    Ok(())
}

/// Checks beyond the library's own.
fn check(file: &DeviceFile, refuse: impl Fn(&str, &str) -> DeviceFileError) -> Result<(), DeviceFileError> {
    if file.name.is_empty() || !file.name.chars().all(|letter| letter.is_ascii_alphanumeric() || "-_.".contains(letter))
    {
        return Err(refuse("name", "must be letters, digits, '-', '_' and '.'"));
    }
    if file.joint.len() != 3 {
        return Err(refuse("joint", &format!("{} joints; these mechanisms have three", file.joint.len())));
    }
    for inputs in [
        file.joint.iter().map(|joint| joint.encoder.channel).collect::<Vec<_>>(),
        file.joint.iter().map(|joint| joint.motor.channel).collect(),
    ] {
        for (joint, channel) in inputs.iter().enumerate() {
            if *channel > 2 || inputs[..joint].contains(channel) {
                return Err(refuse(
                    &format!("joint {joint}: channel"),
                    "must be 0, 1 or 2, each once for the encoders and once for the motors",
                ));
            }
        }
    }
    let positive = |number: f64| number > 0.0 && number.is_finite();
    for (index, joint) in file.joint.iter().enumerate() {
        let entry = |name: &str| format!("joint {index}: {name}");
        for (name, number) in [
            ("encoder.counts", joint.encoder.counts),
            ("motor.torque_constant", joint.motor.torque_constant),
            ("motor.current_at_full", joint.motor.current_at_full),
            ("motor.continuous_current", joint.motor.continuous_current),
            ("motor.max_rate", joint.motor.max_rate),
            ("inertia", joint.inertia.unwrap_or(1.0)),
        ] {
            if !positive(number) {
                return Err(refuse(&entry(name), &format!("{number} must be positive and finite")));
            }
        }
        if joint.motor.max_rate > 500.0 {
            return Err(refuse(&entry("motor.max_rate"), "must be at most 500 rad/s: 3000 rpm are 314 rad/s"));
        }
        if !(joint.motor.time_constant >= 0.1 && joint.motor.time_constant <= 600.0) {
            return Err(refuse(&entry("motor.time_constant"), "must be between 0.1 and 600 s"));
        }
        if let Some(bridge) = joint.motor.bridge {
            check_bridge(&bridge, joint.motor.current_at_full)
                .map_err(|reason| refuse(&entry("motor.bridge"), &reason))?;
        }
    }
    if !(file.limits.max_probe_speed > 0.0 && file.limits.max_probe_speed <= 10.0) {
        return Err(refuse("limits.max_probe_speed", "must be positive and at most 10 m/s: 1500 mm/s are 1.5"));
    }
    check_units(file, &refuse)
}

fn three(numbers: [f64; 3]) -> [f32; 3] {
    numbers.map(|number| number as f32)
}

/// The library's constant, and what its check says.
fn preset(file: &DeviceFile) -> (Preset, Result<(), DeviceError>) {
    match &file.mechanism {
        MechanismEntry::SerialArm { base_height, first_link, second_link, workspace_centre, end_masses } => {
            let [x, y, z] = three(*workspace_centre);
            let device = device(
                file,
                SerialArm {
                    base_height_m: *base_height as f32,
                    first_link_m: *first_link as f32,
                    second_link_m: *second_link as f32,
                    workspace_centre_m: vec3(x, y, z),
                    end_masses_kg: end_masses.map(|mass| mass as f32),
                },
            );
            (Preset::SerialArm(Box::leak(Box::new(device))), whole(file, &device))
        }
        MechanismEntry::LinkageArm(arm) => {
            let [x, y, z] = three(arm.workspace_centre);
            let device = device(
                file,
                LinkageArm {
                    linkage: FiveBar {
                        second_pivot_m: arm.second_pivot as f32,
                        cranks_m: arm.cranks.map(|length| length as f32),
                        rods_m: arm.rods.map(|length| length as f32),
                        side: arm.side as f32,
                        tool_m: arm.tool as f32,
                        workspace_centre_m: Vec2::ZERO,
                    },
                    pivot_reach_m: arm.pivot_reach as f32,
                    workspace_centre_m: vec3(x, y, z),
                    masses: arm.masses.unwrap_or_default().map(|link| LinkMass {
                        mass_kg: link.mass as f32,
                        along_m: link.along as f32,
                        across_m: link.across as f32,
                    }),
                },
            );
            (Preset::LinkageArm(Box::leak(Box::new(device))), whole(file, &device))
        }
        MechanismEntry::Delta { thigh, shin, stub, reach, side, legs, workspace_depth, carried_mass, thigh_moment } => {
            let device = device(
                file,
                Delta {
                    thigh_m: *thigh as f32,
                    shin_m: *shin as f32,
                    stub_m: *stub as f32,
                    reach_m: *reach as f32,
                    side_m: *side as f32,
                    directions: legs.map(|leg| [libm::cos(leg) as f32, libm::sin(leg) as f32]),
                    workspace_centre_m: vec3(0.0, 0.0, *workspace_depth as f32),
                    up: vec3(0.0, 1.0, 0.0),
                    carried_mass_kg: *carried_mass as f32,
                    thigh_moment_kg_m: *thigh_moment as f32,
                },
            );
            (Preset::Delta(Box::leak(Box::new(device))), whole(file, &device))
        }
    }
}

/// The library's checks. A motor holds the links' weight for long, by its continuous current.
fn whole<K: Kinematics<3>>(file: &DeviceFile, device: &Device<K, 3>) -> Result<(), DeviceError> {
    device.check()?;
    let shares = each(file, |joint| (joint.motor.continuous_current / joint.motor.current_at_full).min(1.0) as f32);
    let full = device.full_torques_n_m();
    device.kinematics.check(core::array::from_fn(|joint| full[joint] * shares[joint]))
}

/// The joint's entries, by index; there are three.
fn each<T>(file: &DeviceFile, of: impl Fn(&JointEntry) -> T) -> [T; 3] {
    core::array::from_fn(|joint| of(&file.joint[joint]))
}

fn device<K>(file: &DeviceFile, kinematics: K) -> Device<K, 3> {
    let limits = &file.limits;
    Device {
        kinematics,
        encoders: each(file, |joint| {
            Encoder::geared(joint.encoder.counts as f32, joint.encoder.ratio as f32, joint.encoder.zero as f32)
        }),
        motors: each(file, |joint| {
            let motor = &joint.motor;
            Motor::current_driven(motor.torque_constant as f32, motor.current_at_full as f32, motor.ratio as f32)
        }),
        feeds: each(file, |joint| {
            let motor = &joint.motor;
            motor.bridge.map_or(Feed::Current, |bridge| {
                Feed::Voltage(VoltageFeed {
                    supply_v: bridge.supply as f32,
                    full_fraction: 1.0,
                    resistance_ohm: bridge.resistance as f32,
                    torque_constant_n_m_per_a: motor.torque_constant as f32,
                    current_at_full_a: motor.current_at_full as f32,
                    ratio: motor.ratio as f32,
                    back_emf_fraction: bridge.back_emf_share as f32,
                })
            })
        }),
        dry_friction_n_m: each(file, |joint| joint.friction as f32),
        joint_range_rad: each(file, |joint| joint.range.map(|angle| angle as f32)),
        min_margin_m_per_rad: limits.min_margin as f32,
        max_joint_rate_rad_per_s: limits.max_joint_rate as f32,
        max_force_n: limits.max_force as f32,
        max_stiffness_n_per_m: limits.max_stiffness as f32,
        max_damping_n_s_per_m: limits.max_damping as f32,
    }
}

fn protection(file: &DeviceFile) -> Protection<3> {
    let inertias = each(file, |joint| joint.inertia);
    Protection {
        motors: each(file, |joint| Endurance {
            continuous: (joint.motor.continuous_current / joint.motor.current_at_full) as f32,
            time_constant_s: joint.motor.time_constant as f32,
        }),
        max_joint_rates_rad_per_s: each(file, |joint| joint.motor.max_rate as f32),
        max_probe_speed_m_per_s: file.limits.max_probe_speed as f32,
        supply: None,
        polarity: inertias
            .iter()
            .all(Option::is_some)
            .then(|| PolarityCheck { inertia_kg_m2: inertias.map(|inertia| inertia.unwrap_or_default() as f32) }),
    }
}
