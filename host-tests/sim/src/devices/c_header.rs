//! One's own device as a C header: the structures of `palpate.h`, in their order.

use super::OwnDevice;
use super::preset::Preset;
use palpate::device::drive::Feed;
use palpate::device::{Delta, Device, FiveBar, LinkageArm, Protection, SerialArm};
use std::fmt::Write as _;

/// A header for a device: mechanism, `DEVICE`, `PROTECTION`, channels, and the function that starts its loop. `from` is
/// what it is written from.
pub fn c_header(own: &OwnDevice, from: &str) -> String {
    let mut text = format!(
        "/* Written by `palpate device` from {from}. Change that, not this. */\n\
         #ifndef OWN_DEVICE_H\n#define OWN_DEVICE_H\n\n#include \"palpate.h\"\n\n"
    );
    let protection = &own.protection;
    match own.preset {
        Preset::SerialArm(device) => {
            constants(&mut text, "serial_arm", &serial_arm(&device.kinematics), device, protection)
        }
        Preset::LinkageArm(device) => {
            constants(&mut text, "linkage_arm", &linkage_arm(&device.kinematics), device, protection);
        }
        Preset::Delta(device) => constants(&mut text, "delta", &delta(&device.kinematics), device, protection),
        // Device files have three joints.
        Preset::FiveBar(_) | Preset::Paddle(_) => {}
    }
    let [inputs, outputs] = own.channels();
    let _ = write!(
        text,
        "/* Which of the board's encoder inputs and motor outputs each joint is on. */\n\
         static const uint8_t ENCODER_INPUTS[3] = {};\nstatic const uint8_t MOTOR_OUTPUTS[3] = {};\n\n#endif\n",
        list(inputs.map(|channel| channel.to_string())),
        list(outputs.map(|channel| channel.to_string())),
    );
    text
}

fn constants<K>(text: &mut String, kind: &str, mechanism: &str, device: &Device<K, 3>, protection: &Protection<3>) {
    let joints = [0, 1, 2].map(|joint| {
        let feed = match device.feeds[joint] {
            Feed::Current => [0.0; 6],
            Feed::Voltage(feed) => [
                // As a device file has it, full duty is the whole supply.
                feed.supply_v * feed.full_fraction,
                feed.resistance_ohm,
                feed.torque_constant_n_m_per_a,
                feed.current_at_full_a,
                feed.ratio,
                feed.back_emf_fraction,
            ],
        };
        let (encoder, [min, max]) = (device.encoders[joint], device.joint_range_rad[joint]);
        let numbers = [
            encoder.radians_per_count,
            encoder.angle_at_zero_rad,
            device.motors[joint].torque_at_full_n_m,
            device.dry_friction_n_m[joint],
            min,
            max,
        ];
        list(numbers.map(number).into_iter().chain([list(feed.map(number))]))
    });
    let limits = [
        device.min_margin_m_per_rad,
        device.max_joint_rate_rad_per_s,
        device.max_force_n,
        device.max_stiffness_n_per_m,
        device.max_damping_n_s_per_m,
    ];
    let inertia = protection.polarity.map(|polarity| polarity.inertia_kg_m2);
    let supply = protection.supply.map_or([0, 0], |range| [range.min_mv, range.max_mv]);
    let guards = [
        list(protection.motors.map(|motor| list([motor.continuous, motor.time_constant_s].map(number)))),
        list(protection.max_joint_rates_rad_per_s.map(number)),
        number(protection.max_probe_speed_m_per_s),
        u8::from(inertia.is_some()).to_string(),
        list(inertia.unwrap_or([0.0; 3]).map(number)),
        u8::from(protection.supply.is_some()).to_string(),
        supply[0].to_string(),
        supply[1].to_string(),
    ];
    let _ = write!(
        text,
        "/* Starts its loop; with `_protected`, under PROTECTION. */\n\
         #define START_DEVICE palpate_servo_start_{kind}\n\
         #define START_DEVICE_PROTECTED palpate_servo_start_{kind}_protected\n\n\
         static const palpate_{kind} MECHANISM = {mechanism};\n\n\
         static const palpate_device DEVICE = {};\n\n\
         static const palpate_protection PROTECTION = {};\n\n",
        list([format!("{{\n    {}}}", joints.join(",\n    "))].into_iter().chain(limits.map(number))),
        list(guards),
    );
}

fn serial_arm(arm: &SerialArm) -> String {
    let lengths = [arm.base_height_m, arm.first_link_m, arm.second_link_m].map(number);
    list(lengths.into_iter().chain([numbers(arm.workspace_centre_m.to_array()), numbers(arm.end_masses_kg)]))
}

fn delta(delta: &Delta) -> String {
    let lengths = [delta.thigh_m, delta.shin_m, delta.stub_m, delta.reach_m, delta.side_m].map(number);
    list(lengths.into_iter().chain([
        list(delta.directions.map(numbers)),
        numbers(delta.workspace_centre_m.to_array()),
        numbers(delta.up.to_array()),
        number(delta.carried_mass_kg),
        number(delta.thigh_moment_kg_m),
    ]))
}

fn five_bar(linkage: &FiveBar) -> String {
    list([
        number(linkage.second_pivot_m),
        numbers(linkage.cranks_m),
        numbers(linkage.rods_m),
        number(linkage.side),
        number(linkage.tool_m),
        numbers(linkage.workspace_centre_m.to_array()),
    ])
}

fn linkage_arm(arm: &LinkageArm) -> String {
    list([
        five_bar(&arm.linkage),
        number(arm.pivot_reach_m),
        numbers(arm.workspace_centre_m.to_array()),
        list(arm.masses.map(|mass| numbers([mass.mass_kg, mass.along_m, mass.across_m]))),
    ])
}

fn list(items: impl IntoIterator<Item = String>) -> String {
    format!("{{{}}}", items.into_iter().collect::<Vec<_>>().join(", "))
}

fn numbers<const N: usize>(values: [f32; N]) -> String {
    list(values.map(number))
}

/// A float of C with the digits that give back its bits.
fn number(value: f32) -> String {
    format!("{value:?}f")
}
