//! Device files: what ships as a file is the preset, and what no device has is refused by its entry.

use palpate::device::presets::{HAPKIT, HAPLY_2DIY_V3};
use palpate_sim::devices::{DEVICES, Preset};
use palpate_sim::devices::{HomingEntry, OwnDevice, named, rust_preset, source};
use palpate_sim::plant::{Amplifier, Winding};
use std::fs;

/// The file of WoodenHaptics, as text.
fn text() -> String {
    toml::to_string(&DEVICES[0].file().expect("three joints")).expect("a file")
}

#[test]
fn the_file_of_a_device_that_ships_reads_back_as_its_constant() {
    let mut seen = 0;
    for shipped in &DEVICES {
        let Some(file) = shipped.file() else { continue };
        seen += 1;
        let own = OwnDevice::parse(&toml::to_string(&file).unwrap(), shipped.name).unwrap();
        assert_eq!(own.file, file);
        let [mine, theirs] = [own.preset, shipped.preset].map(Preset::limits);
        assert_eq!(mine, theirs);
        // The encoders' angles per count and the motors' torques to the rounding of a product of three f32.
        let close = |a: f32, b: f32| (a - b).abs() <= 4.0 * f32::EPSILON * b.abs();
        let parts = |preset: Preset| match preset {
            Preset::SerialArm(device) => (device.encoders, device.motors),
            Preset::LinkageArm(device) => (device.encoders, device.motors),
            Preset::Delta(device) => (device.encoders, device.motors),
            Preset::FiveBar(_) | Preset::Paddle(_) => unreachable!("three joints"),
        };
        let ((encoders, motors), (expected_encoders, expected_motors)) = (parts(own.preset), parts(shipped.preset));
        for joint in 0..3 {
            assert!(close(encoders[joint].radians_per_count, expected_encoders[joint].radians_per_count));
            assert!((encoders[joint].angle_at_zero_rad - expected_encoders[joint].angle_at_zero_rad).abs() < 1e-6);
            assert!(
                close(motors[joint].torque_at_full_n_m, expected_motors[joint].torque_at_full_n_m),
                "{}",
                shipped.name
            );
        }
        let rust = source(&own, "my.toml");
        syn::parse_file(&rust).expect("it is Rust");
        assert!(rust.contains("DEVICE.check()") && rust.contains("DEVICE.kinematics.check("));
    }
    assert_eq!(seen, 4);
}

#[test]
fn the_constants_say_by_what_the_joints_are_homed() {
    for (homing, says) in [
        (HomingEntry::Pose, "= Some(palpate::device::Reference::Pose(DEVICE.angles_at_zero()));"),
        (HomingEntry::Index, "= Some(palpate::device::Reference::Index(DEVICE.angles_at_zero()));"),
        (HomingEntry::None, "= None;"),
    ] {
        let mut file = DEVICES[0].file().expect("three joints");
        file.homing = homing;
        let own = OwnDevice::parse(&toml::to_string(&file).unwrap(), "my.toml").unwrap();
        let rust = source(&own, "my.toml");
        let line = rust.lines().find(|line| line.starts_with("pub const REFERENCE")).expect("it says");
        assert!(line.ends_with(says), "{homing:?}: {line}");
    }
}

#[test]
fn a_bad_file_is_refused_by_its_entry() {
    for (good, bad, entry) in [
        ("counts = 2000.0", "counts = 0.0", "joint a: encoder.counts"),
        ("counts = 2000.0", "counts = nan", "joint a: encoder.counts"),
        ("counts = 2000.0", "count = 2000.0", "unknown field `count`"),
        ("ratio = -16.0", "ratio = 0.0", "joint a: encoder"),
        ("first_link = 0.205", "first_link = -0.205", "mechanism.first_link"),
        ("first_link = 0.205", "first_link = 205.0", "mechanism.first_link"),
        ("workspace_centre = [0.22, 0.0, 0.08]", "workspace_centre = [0.9, 0.0, 0.08]", "mechanism.workspace_centre"),
        // 9.81 m/s² · 50 kg · 0.245 m, and 0.0259 N·m/A · 3 A · 12.
        ("0.04085714]", "50.0]", "joint c: gravity compensation takes 120.17 N·m, and its motor holds 0.93 N·m"),
        ("[0.15229268,", "[-5.0,", "joint b: gravity compensation takes 10.06 N·m"),
        ("range = [-1.6, 1.6]", "range = [0.5, 1.6]", "mechanism.workspace_centre: needs joint a at 0.00 rad"),
        ("range = [-1.6, 1.6]", "range = [1.6, -1.6]", "joint a: range"),
        ("channel = 1", "channel = 0", "joint b: channel"),
        ("max_force = 5.0", "max_force = -5.0", "limits"),
        ("kind = \"serial-arm\"", "kind = \"octopus\"", "unknown variant `octopus`"),
        ("time_constant = 16.0", "time_constant = 0.0", "joint a: motor.time_constant"),
        ("max_force = 5.0\n", "", "missing field `max_force`"),
        ("name = \"woodenhaptics-2016\"", "name = \"a b\"", "name: must be"),
        ("second_link = ", "second_link = \"180 mm\" # ", "line 8: second_link: invalid type: string"),
        ("end_masses = [", "end_masses = [0.1] # [", "the section [mechanism] of line 4: invalid length 1"),
        ("max_joint_rate = ", "# ", "the section [limits] of line 12: missing field `max_joint_rate`"),
        ("torque_constant = 0.0259", "torque_constant = 25.9", "joint a: motor.torque_constant: 25.9 is no"),
        ("current_at_full = 3.0", "current_at_full = 3000.0", "joint a: motor.current_at_full: 3000 is no"),
        ("torque_constant = 0.0259", "torque_constant = 4.9", "joint a: motor: torque_constant times current_at_full"),
        ("range = [-1.6, 1.6]", "range = [-92.0, 92.0]", "joint a: range: -92 is no haptic device's: it is in radians"),
        ("zero = 0.0", "zero = 45.0", "joint a: encoder.zero: 45 is no"),
        ("friction = ", "friction = 12", "joint a: friction: 12"),
        ("max_stiffness = ", "max_stiffness = 1.0 # ", "limits.max_stiffness: must be at least 10 N/m"),
        ("max_force = 5.0", "max_force = 5000.0", "limits.max_force: 5000 is no"),
        (
            "max_probe_speed = 1.5",
            "max_probe_speed = 1500.0",
            "limits.max_probe_speed: must be positive and at most 10",
        ),
        ("max_rate = 15.0", "max_rate = 3000.0", "joint a: motor.max_rate: must be at most 500 rad/s"),
    ] {
        let spoilt = text().replacen(good, bad, 1);
        assert_ne!(spoilt, text(), "{good} is not in the file");
        let error = OwnDevice::parse(&spoilt, "my.toml").expect_err(bad).to_string();
        assert!(error.starts_with("my.toml: ") && error.contains(entry), "{bad}: {error}");
        assert!(!error.contains('\n'), "one sentence: {error}");
    }
    // By its name where it has one of its own.
    for (name, entry) in [("name = \"shoulder\"", "joint shoulder: channel"), ("name = \"a\"", "joint 1: channel")] {
        let spoilt = text().replacen("channel = 1", "channel = 0", 1).replacen("name = \"b\"", name, 1);
        let error = OwnDevice::parse(&spoilt, "my.toml").expect_err(name).to_string();
        assert!(error.contains(entry), "{error}");
    }
}

#[test]
fn a_bridge_that_no_device_has_is_refused_by_its_number() {
    let with = |entries: &str| {
        let bridge = format!("max_rate = 15.0\nbridge = {{ {entries}, back_emf_share = 0.8 }}");
        OwnDevice::parse(&text().replacen("max_rate = 15.0", &bridge, 1), "my.toml").map_err(|error| error.to_string())
    };
    for (entries, says) in [
        ("supply = 24000.0, resistance = 0.7", "supply = 24000 is no haptic device's: it is in V"),
        ("supply = 0.024, resistance = 0.7", "supply = 0.024"),
        ("supply = nan, resistance = 0.7", "supply = NaN"),
        ("supply = 24.0, resistance = 7000.0", "resistance = 7000"),
        (
            "supply = 24.0, resistance = 0.7, inductance = 0.12",
            "inductance over resistance is 171.429 ms, and must be 0 to 5",
        ),
        ("supply = 24.0, resistance = 0.7, inductance = -1e-4", "inductance"),
        ("supply = 24.0, resistance = 0.7, inductance = nan", "inductance"),
        ("supply = 24.0, resistance = 9.0", "its supply drives 2.67 A at most"),
    ] {
        let error = with(entries).expect_err(entries);
        assert!(error.contains(&format!("my.toml: joint a: motor.bridge: {says}")), "{entries}: {error}");
    }
    for (entries, inductance) in [("", 1e-3), (", inductance = 1.2e-4", 1.2e-4), (", inductance = 0.0", 0.0)] {
        let own = with(&format!("supply = 24.0, resistance = 0.7{entries}")).expect(entries);
        let amplifiers = own.plant.joints.map(|joint| joint.amplifier);
        let winding = Amplifier::Voltage(Winding { supply: 24.0, resistance: 0.7, inductance });
        assert_eq!(amplifiers, [winding, Amplifier::Current, Amplifier::Current], "{entries}");
    }
}

/// Constants of one and two joints, as `palpate device hapkit --out device.rs` writes them.
mod hapkit {
    include!("../../data/hapkit.device.rs");
}
mod haply {
    include!("../../data/haply-2diy-v3.device.rs");
}

#[test]
fn the_constants_of_one_and_two_joints_compile_and_are_the_presets() {
    assert_eq!(format!("{:?}", hapkit::DEVICE), format!("{HAPKIT:?}"));
    assert_eq!(format!("{:?}", haply::DEVICE), format!("{HAPLY_2DIY_V3:?}"));
    for name in ["hapkit", "haply-2diy-v3"] {
        let path = format!("{}/data/{name}.device.rs", env!("CARGO_MANIFEST_DIR"));
        let written = rust_preset(named(name).expect("it ships"));
        if std::env::var_os("PALPATE_WRITE").is_some() {
            fs::write(&path, &written).expect("it is written");
        }
        assert_eq!(fs::read_to_string(&path).expect("a file"), written, "PALPATE_WRITE=1 writes it again");
    }
}
