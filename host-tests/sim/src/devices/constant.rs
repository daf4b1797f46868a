//! A device file as the library's constants, checked when they are compiled.

use super::read::OwnDevice;
use super::table::ShippedDevice;
use crate::devices::preset::Preset;
use crate::devices::schema::HomingEntry;
use palpate::device::Device;
use palpate::device::drive::Feed;
use std::fmt::{Debug, Write as _};

/// The file's text as Rust source: `Mechanism`, `DEVICE`, `PROTECTION`, `REFERENCE` and `WIRING`. Every number reads back
/// as the same `f32`.
pub fn source(own: &OwnDevice, from: &str) -> String {
    let mut text = format!("// Written by `palpate device` from {from}. Change that, not this.\n\n");
    match own.preset {
        Preset::SerialArm(device) => constants(&mut text, "SerialArm", device),
        Preset::LinkageArm(device) => constants(&mut text, "LinkageArm", device),
        Preset::Delta(device) => constants(&mut text, "Delta", device),
        Preset::FiveBar(_) | Preset::Paddle(_) => {}
    }
    let _ = write!(
        text,
        "\n/// Its protection.\n#[allow(dead_code)]\npub const PROTECTION: palpate::device::Protection<3> = {};\n",
        literal(&own.protection),
    );
    let _ = write!(
        text,
        "\n/// The homing reference; `None` for counts that are known after each reset.\n#[allow(dead_code)]\n\
         pub const REFERENCE: Option<palpate::device::Reference<3>> = {};\n",
        reference(own.file.homing),
    );
    let [inputs, outputs] = own.channels();
    // Without a permission to be unused: a board that ignores its wiring gets a warning.
    let _ = write!(
        text,
        "\n/// Which of the board's encoder inputs and motor outputs each joint is on.\n\
         pub const WIRING: palpate::commission::Wiring<3> =\n    \
         palpate::commission::Wiring::try_new({inputs:?}, {outputs:?}).expect(\"each joint needs channels of its own\");\n"
    );
    text
}

/// The constant of a device that ships: of fewer joints than three, which have no device file.
pub fn rust_preset(shipped: &ShippedDevice) -> String {
    let mut text =
        format!("// Written by `palpate device` from {}: the numbers are yours to change.\n\n", shipped.name);
    match shipped.preset {
        Preset::SerialArm(device) => constants(&mut text, "SerialArm", device),
        Preset::LinkageArm(device) => constants(&mut text, "LinkageArm", device),
        Preset::Delta(device) => constants(&mut text, "Delta", device),
        Preset::FiveBar(device) => constants(&mut text, "FiveBar", device),
        Preset::Paddle(device) => constants(&mut text, "Paddle", device),
    }
    text
}

/// The board's homing reference, for joints whose encoder zeroes refer to it.
const fn reference(homing: HomingEntry) -> &'static str {
    match homing {
        HomingEntry::Pose => "Some(palpate::device::Reference::Pose(DEVICE.angles_at_zero()))",
        HomingEntry::Index => "Some(palpate::device::Reference::Index(DEVICE.angles_at_zero()))",
        HomingEntry::None => "None",
    }
}

/// The source for an image of a device that is still to be commissioned: its constants, gains within its limits, and no
/// host timeout. `rate` in Hz.
pub fn settings_source(own: &OwnDevice, rate: f32) -> String {
    let limits = own.preset.limits();
    let (stiffness, damping, force) = (0.5 * limits.stiffness, 0.5 * limits.damping, 0.5 * limits.force);
    format!(
        "{}\n/// The loop's settings.\npub const SETTINGS: palpate::servo::Settings = palpate::servo::Settings {{\n    \
         rate_hz: {rate:?},\n    stiffness_n_per_m: {stiffness:?},\n    damping_n_s_per_m: {damping:?},\n    max_force_n: {force:?},\n    \
         velocity_corner_hz: 200.0,\n    soft_start_s: 0.2,\n    body_origin_m: palpate::math::vec3(-0.03, -0.02, \
         -0.015),\n}};\n/// Its limits.\npub const SAFETY: palpate::servo::Safety = palpate::servo::Safety::DEFAULT;\n\
         /// How the surface feels.\npub const RENDERING: palpate::servo::Rendering = palpate::servo::Rendering::SMOOTH;\n",
        source(own, &own.file.name),
    )
}

/// `Debug` of the library's plain structs is the Rust that makes them, but for the paths.
fn literal(value: &impl Debug) -> String {
    let text = format!("{value:?}");
    let text = text.replace("Vec3(", "palpate::math::vec3(").replace("Vec2(", "palpate::math::vec2(");
    let names = [
        "SerialArm {",
        "LinkageArm {",
        "FiveBar {",
        "Delta {",
        "Paddle {",
        "LinkMass {",
        "Encoder {",
        "Motor {",
        "Protection {",
        "Endurance {",
        "SupplyRange {",
        "PolarityCheck {",
    ];
    names.iter().fold(text, |text, name| text.replace(name, &format!("palpate::device::{name}")))
}

fn feeds(feeds: &[Feed]) -> String {
    let each = feeds.iter().map(|feed| match feed {
        Feed::Current => "palpate::device::drive::Feed::Current".to_owned(),
        Feed::Voltage(voltage) => {
            format!("palpate::device::drive::Feed::Voltage(palpate::device::drive::{voltage:?})")
        }
    });
    format!("[{}]", each.collect::<Vec<_>>().join(", "))
}

fn constants<K: Debug, const JOINTS: usize>(text: &mut String, mechanism: &str, device: &Device<K, JOINTS>) {
    let Device { kinematics, encoders, motors, dry_friction_n_m, joint_range_rad, min_margin_m_per_rad, .. } = device;
    let Device { max_joint_rate_rad_per_s, max_force_n, max_stiffness_n_per_m, max_damping_n_s_per_m, .. } = device;
    // The weight of a planar linkage does not load its joints.
    let holds = if mechanism == "FiveBar" { "" } else { "DEVICE.full_torques_n_m()" };
    let check =
        |what: &str| format!("if let Err(error) = {what} {{\n        panic!(\"{{}}\", error.message());\n    }}");
    let (numbers, parts) = (check("DEVICE.check()"), check(&format!("DEVICE.kinematics.check({holds})")));
    let _ = write!(
        text,
        "pub use palpate::device::{mechanism} as Mechanism;\n\n\
         /// The device.\npub const DEVICE: palpate::device::Device<Mechanism, {JOINTS}> = palpate::device::Device {{\n    \
         kinematics: {},\n    encoders: {},\n    motors: {},\n    feeds: {},\n    dry_friction_n_m: {dry_friction_n_m:?},\n    \
         joint_range_rad: {joint_range_rad:?},\n    min_margin_m_per_rad: {min_margin_m_per_rad:?},\n    max_joint_rate_rad_per_s: {max_joint_rate_rad_per_s:?},\n    \
         max_force_n: {max_force_n:?},\n    max_stiffness_n_per_m: {max_stiffness_n_per_m:?},\n    max_damping_n_s_per_m: {max_damping_n_s_per_m:?},\n}};\n\
         const _: () = {{\n    {numbers}\n    {parts}\n}};\n",
        literal(kinematics),
        literal(encoders),
        literal(motors),
        feeds(&device.feeds),
    );
}
