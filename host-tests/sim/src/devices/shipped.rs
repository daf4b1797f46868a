//! The device file of a shipped device: a starting point for the user's own.

use super::schema::{
    BridgeEntry, DeviceFile, EncoderEntry, HomingEntry, JointEntry, LimitsEntry, LinkageEntry, MassEntry,
    MechanismEntry, MotorEntry,
};
use crate::devices::preset::Preset;
use crate::plant::{Amplifier, Direction, PlantSettings};
use palpate::device::drive::Feed;
use palpate::device::{Device, Protection, presets};

/// The shortest decimal that reads back as the same `f32`.
fn decimal(number: f32) -> f64 {
    number.to_string().parse().unwrap_or_else(|_| f64::from(number))
}

/// The file of a shipped device of three joints; `None` with fewer.
pub fn file_of(name: &str, preset: Preset, plant: &PlantSettings) -> Option<DeviceFile> {
    let (mechanism, rest) = match preset {
        Preset::SerialArm(device) => {
            let arm = device.kinematics;
            let mechanism = MechanismEntry::SerialArm {
                base_height: decimal(arm.base_height_m),
                first_link: decimal(arm.first_link_m),
                second_link: decimal(arm.second_link_m),
                workspace_centre: arm.workspace_centre_m.to_array().map(decimal),
                end_masses: arm.end_masses_kg.map(decimal),
            };
            (mechanism, rest(name, plant, device))
        }
        Preset::LinkageArm(device) => {
            let arm = device.kinematics;
            let mechanism = MechanismEntry::LinkageArm(LinkageEntry {
                second_pivot: decimal(arm.linkage.second_pivot_m),
                cranks: arm.linkage.cranks_m.map(decimal),
                rods: arm.linkage.rods_m.map(decimal),
                side: decimal(arm.linkage.side),
                tool: decimal(arm.linkage.tool_m),
                pivot_reach: decimal(arm.pivot_reach_m),
                workspace_centre: arm.workspace_centre_m.to_array().map(decimal),
                masses: Some(arm.masses.map(|link| MassEntry {
                    mass: decimal(link.mass_kg),
                    along: decimal(link.along_m),
                    across: decimal(link.across_m),
                })),
            });
            (mechanism, rest(name, plant, device))
        }
        Preset::Delta(device) => {
            let delta = device.kinematics;
            let mechanism = MechanismEntry::Delta {
                thigh: decimal(delta.thigh_m),
                shin: decimal(delta.shin_m),
                stub: decimal(delta.stub_m),
                reach: decimal(delta.reach_m),
                side: decimal(delta.side_m),
                legs: delta.directions.map(|[cosine, sine]| f64::from(sine).atan2(f64::from(cosine))),
                workspace_depth: decimal(delta.workspace_centre_m.z),
                carried_mass: decimal(delta.carried_mass_kg),
                thigh_moment: decimal(delta.thigh_moment_kg_m),
            };
            (mechanism, rest(name, plant, device))
        }
        Preset::FiveBar(_) | Preset::Paddle(_) => return None,
    };
    let (limits, joint) = rest;
    Some(DeviceFile { name: name.to_owned(), homing: HomingEntry::Pose, mechanism, limits, joint })
}

/// Protection of a shipped device of three joints.
pub fn protection_of(name: &str) -> Protection<3> {
    match name {
        "polhem-v2" => presets::POLHEM_V2_PROTECTION,
        "phantom-premium" => presets::PHANTOM_PREMIUM_PROTECTION,
        "falcon" => presets::NOVINT_FALCON_PROTECTION,
        _ => presets::WOODEN_HAPTICS_2016_PROTECTION,
    }
}

/// Limits and joints. Counts a turn and ratio are the plant's, for the library keeps their product alone.
fn rest<K>(name: &str, settings: &PlantSettings, device: &Device<K, 3>) -> (LimitsEntry, Vec<JointEntry>) {
    let protection = protection_of(name);
    let names = ["a", "b", "c"];
    let joints = (0..3).map(|index| {
        let plant = &settings.joints[index];
        let sign = |direction: Direction| if direction == Direction::With { 1.0 } else { -1.0 };
        let encoder = EncoderEntry {
            channel: index,
            counts: plant.counts_per_turn,
            ratio: sign(plant.encoder_direction) * plant.ratio,
            zero: plant.angle_at_zero,
        };
        let endurance = protection.motors[index];
        let motor = MotorEntry {
            channel: index,
            torque_constant: plant.torque_constant,
            current_at_full: plant.current_at_full,
            ratio: sign(plant.motor_direction) * plant.ratio,
            // Without the noise of the share's rounding.
            continuous_current: (decimal(endurance.continuous) * plant.current_at_full * 1e6).round() / 1e6,
            time_constant: decimal(endurance.time_constant_s),
            max_rate: decimal(protection.max_joint_rates_rad_per_s[index]),
            bridge: match device.feeds[index] {
                Feed::Current => None,
                Feed::Voltage(feed) => Some(BridgeEntry {
                    supply: decimal(feed.supply_v),
                    resistance: decimal(feed.resistance_ohm),
                    inductance: match plant.amplifier {
                        Amplifier::Voltage(winding) => Some(winding.inductance),
                        Amplifier::Current | Amplifier::CurrentOn(_) => None,
                    },
                    back_emf_share: decimal(feed.back_emf_fraction),
                }),
            },
        };
        JointEntry {
            name: names[index].to_owned(),
            range: device.joint_range_rad[index].map(decimal),
            friction: decimal(device.dry_friction_n_m[index]),
            inertia: protection.polarity.map(|signs| decimal(signs.inertia_kg_m2[index])),
            encoder,
            motor,
        }
    });
    let limits = LimitsEntry {
        min_margin: decimal(device.min_margin_m_per_rad),
        max_joint_rate: decimal(device.max_joint_rate_rad_per_s),
        max_force: decimal(device.max_force_n),
        max_stiffness: decimal(device.max_stiffness_n_per_m),
        max_damping: decimal(device.max_damping_n_s_per_m),
        max_probe_speed: decimal(protection.max_probe_speed_m_per_s),
    };
    (limits, joints.collect())
}
