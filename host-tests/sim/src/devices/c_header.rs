//! A device as a C header: the structures of `palpate.h`, in their order.

use super::{OwnDevice, Preset, ShippedDevice, own_device};
use palpate::device::drive::Feed;
use palpate::device::{Delta, Device, Encoder, FiveBar, LinkageArm, Paddle, Protection, SerialArm};
use palpate::servo::recommended::Recommended;
use std::fmt::Write as _;

/// A header for one's own device: mechanism, `DEVICE`, `PROTECTION`, channels, the function that starts its loop, and the
/// recommended settings. `from` is what it is written from.
pub fn c_header(own: &OwnDevice, from: &str) -> String {
    let [inputs, outputs] = own.channels();
    let channels = format!(
        "/* Which of the board's encoder inputs and motor outputs each joint is on. */\n\
         static const uint8_t ENCODER_INPUTS[3] = {};\nstatic const uint8_t MOTOR_OUTPUTS[3] = {};\n\n",
        list(inputs.map(|channel| channel.to_string())),
        list(outputs.map(|channel| channel.to_string())),
    );
    header(own_device(own, from), from, &channels)
}

/// The same for a device that ships; with less than three joints without `PROTECTION`.
pub fn c_preset(shipped: &ShippedDevice) -> String {
    header(shipped, shipped.name, "")
}

fn header(device: &ShippedDevice, from: &str, channels: &str) -> String {
    // One device a program: a second header does not compile.
    let guard: String =
        device.name.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect();
    let guard = format!("DEVICE_{}_H", guard.to_uppercase());
    let protection = device.protection();
    let constants = match device.preset {
        Preset::SerialArm(of) => constants("serial_arm", &serial_arm(&of.kinematics), of, Some(&protection)),
        Preset::LinkageArm(of) => constants("linkage_arm", &linkage_arm(&of.kinematics), of, Some(&protection)),
        Preset::Delta(of) => constants("delta", &delta(&of.kinematics), of, Some(&protection)),
        Preset::FiveBar(of) => constants("five_bar", &five_bar(&of.kinematics), of, None),
        Preset::Paddle(of) => constants("paddle", &paddle(&of.kinematics), of, None),
    };
    format!(
        "/* Written by `palpate device` from {from}. Change that, not this. */\n\
         #ifndef {guard}\n#define {guard}\n\n#include \"palpate.h\"\n\n{constants}{}{channels}#endif\n",
        settings(&device.recommended())
    )
}

fn settings(Recommended { settings, .. }: &Recommended) -> String {
    format!(
        "/* Recommended settings: the hand feels the surface and not the loop. body_origin is yours to set. */\n\
         static inline palpate_status device_settings(palpate_settings *settings)\n{{\n    \
         const palpate_status status = palpate_settings_recommended(settings, &DEVICE);\n    \
         if (status) return status;\n    \
         settings->stiffness = {};\n    settings->damping = {};\n    return status;\n}}\n\n",
        number(settings.stiffness_n_per_m),
        number(settings.damping_n_s_per_m),
    )
}

fn constants<K, const JOINTS: usize>(
    kind: &str,
    mechanism: &str,
    device: &Device<K, JOINTS>,
    protection: Option<&Protection<3>>,
) -> String {
    let joints = (0..JOINTS).map(|joint| {
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
            angle_at_line(encoder),
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
    let joints = joints.collect::<Vec<_>>().join(",\n    ");
    let device = list([format!("{{\n    {joints}}}")].into_iter().chain(limits.map(number)));
    let mut text = format!(
        "/* Starts its loop; with `_protected`, under a palpate_protection. */\n\
         #define START_DEVICE palpate_servo_start_{kind}\n\
         #define START_DEVICE_PROTECTED palpate_servo_start_{kind}_protected\n\n\
         #define DEVICE_JOINTS {JOINTS}\n\n\
         static const palpate_{kind} MECHANISM = {mechanism};\n\n\
         static const palpate_device DEVICE = {device};\n\n",
    );
    if let Some(protection) = protection {
        let _ = write!(text, "static const palpate_protection PROTECTION = {};\n\n", guards(protection));
    }
    text
}

fn guards(protection: &Protection<3>) -> String {
    let inertia = protection.polarity.map(|polarity| polarity.inertia_kg_m2);
    let supply = protection.supply.map_or([0, 0], |range| [range.min_mv, range.max_mv]);
    list([
        list(protection.motors.map(|motor| list([motor.continuous, motor.time_constant_s].map(number)))),
        list(protection.max_joint_rates_rad_per_s.map(number)),
        number(protection.max_probe_speed_m_per_s),
        u8::from(inertia.is_some()).to_string(),
        list(inertia.unwrap_or([0.0; 3]).map(number)),
        u8::from(protection.supply.is_some()).to_string(),
        supply[0].to_string(),
        supply[1].to_string(),
    ])
}

/// The angle from which [`Encoder::new`] makes this encoder, bit for bit: half a count before its middle, and a rounding.
fn angle_at_line(encoder: Encoder) -> f32 {
    let near = encoder.angle_at_zero_rad - 0.5 * encoder.radians_per_count;
    let makes = |line: &f32| Encoder::new(encoder.radians_per_count, *line) == encoder;
    let below = std::iter::successors(Some(near), |line| Some(line.next_down())).take(4);
    let above = std::iter::successors(Some(near), |line| Some(line.next_up())).take(4);
    below.chain(above).find(makes).unwrap_or(near)
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

fn paddle(paddle: &Paddle) -> String {
    numbers([paddle.handle_m, paddle.mass_moment_kg_m])
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
