//! A loop with all that a C program may choose (protection, virtual tool, texture, passivity control) beside the same
//! loop in Rust, tick by tick over the counts of a run.

use crate::running::{capped_box, file, is_wanted, program, run, with_capped_box};
use clap::Parser;
use palpate::body::{Body, Soft};
use palpate::device::drive::Feed;
use palpate::device::presets::{WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION};
use palpate::device::{Counts, Protection, SupplyRange};
use palpate::field::Bump;
use palpate::math::vec3;
use palpate::render::{Coupling, Passivity, Texture, TextureShape, Touch};
use palpate::servo::{
    Config, Event, Fault, Input, Rendering, Safety, Servo, Settings, SoftBody, Surface, Tracked as _,
};
use palpate::track::Contact;
use palpate_bake::source::modes_source;
use palpate_tool::commands::options::SceneOptions;
use palpate_tool::commands::sim::run_on_host;
use palpate_tool::repository;
use std::fs;
use std::process::Command;

const RATE: f32 = 4_000.0;

mod capped_box_modes {
    include!("../../../../boards/bodies/capped_box_modes.rs");
}

#[derive(Parser)]
struct Demo {
    #[command(flatten)]
    options: SceneOptions,
}

const PROTECTION: Protection<3> =
    Protection { supply: Some(SupplyRange { min_mv: 20_000, max_mv: 30_000 }), ..WOODEN_HAPTICS_2016_PROTECTION };

/// The numbers of arm, device and protection in the order of the header's structures.
pub fn numbers() -> Vec<f32> {
    let device = &WOODEN_HAPTICS_2016;
    let arm = device.kinematics;
    let mut all = vec![arm.base_height_m, arm.first_link_m, arm.second_link_m];
    all.extend(arm.workspace_centre_m.to_array());
    all.extend(arm.end_masses_kg);
    for joint in 0..3 {
        assert_eq!(device.feeds[joint], Feed::Current, "its feed has no numbers");
        let (encoder, [least, greatest]) = (device.encoders[joint], device.joint_range_rad[joint]);
        // Count zero begins in the calibration pose.
        all.extend([encoder.radians_per_count, 0.0, device.motors[joint].torque_at_full_n_m]);
        all.extend([device.dry_friction_n_m[joint], least, greatest]);
        all.extend([0.0; 6]);
    }
    all.extend([
        device.min_margin_m_per_rad,
        device.max_joint_rate_rad_per_s,
        device.max_force_n,
        device.max_stiffness_n_per_m,
        device.max_damping_n_s_per_m,
    ]);
    all.extend(PROTECTION.motors.iter().flat_map(|motor| [motor.continuous, motor.time_constant_s]));
    all.extend(PROTECTION.max_joint_rates_rad_per_s);
    all.push(PROTECTION.max_probe_speed_m_per_s);
    all.extend(PROTECTION.polarity.expect("the watch over signs").inertia_kg_m2);
    all
}

/// As in `tests/replay.c`.
fn bowl(touch: &Touch) -> palpate::math::Vec3 {
    let share = -0.25 * touch.push * (touch.parameters[0] - 0.5);
    touch.along_u * share
}

/// What a run comes to: the hash of its states, how many ticks touched, how far modes went, its fault.
#[derive(Debug)]
struct Replayed {
    hash: u32,
    touched: u32,
    moved: f32,
    fault: Option<Fault>,
}

fn in_rust<S: Surface>(surface: &S, counts: &[[i32; 3]], enable_at: usize) -> Replayed {
    let settings = Settings {
        rate_hz: RATE,
        stiffness_n_per_m: 1_000.0,
        damping_n_s_per_m: 2.0,
        max_force_n: 5.0,
        velocity_corner_hz: 150.0,
        soft_start_s: 0.1,
        body_origin_m: vec3(-0.03, -0.02, -0.01675),
    };
    let rendering = Rendering {
        texture: Some(Texture { shape: TextureShape::Custom(bowl), max_fraction: 0.2 }),
        coupling: Some(Coupling { stiffness_n_per_m: 800.0, damping_n_s_per_m: 4.0, mass_kg: 0.05 }),
        passivity: Some(Passivity {
            device_damping_n_s_per_m: 0.5,
            device_friction_n: 0.01,
            max_damping_n_s_per_m: 4.0,
            resolution_m: 1e-4,
        }),
        ..Rendering::PLAIN
    };
    let servo = Servo::try_protected(
        &WOODEN_HAPTICS_2016,
        surface,
        PROTECTION,
        Config { settings, rendering, safety: Safety { link_timeout_s: 0.1, ..Safety::DEFAULT }, ..Config::DEFAULT },
    )
    .expect("protection");
    let mut state = servo.start();
    let (mut hash, mut touched, mut moved) = (0_u32, 0, 0.0_f32);
    let mut mix = |word: u32| hash = (hash ^ word).wrapping_mul(0x0100_0193);
    for (tick, counts) in counts.iter().enumerate() {
        servo.note(&mut state, Event::LinkAlive);
        servo.note(&mut state, Event::Supply { millivolts: 24_000 });
        let _ = servo.tick(&mut state, Input::Sensors { counts: counts.map(Counts), enable: tick >= enable_at });
        mix(state.digest());
        if let Some(q) = state.witness().modes() {
            let force = state.force().to_array();
            q.iter().chain(&force).for_each(|number| mix(number.to_bits()));
            moved = q.iter().fold(moved, |moved, q| moved.max(q.abs()));
        }
        touched += u32::from(state.contact() == Contact::Touching);
    }
    Replayed { hash, touched, moved, fault: state.fault().map(|(fault, _)| fault) }
}

/// The counts of a run of the demo, replayed in Rust and in C.
fn replay(title: &str, demo: &[&str], in_rust: impl FnOnce(&Body<'_>, &[[i32; 3]], usize) -> Replayed, gcc: &[String]) {
    let Demo { options } = Demo::parse_from([&["demo"], demo].concat());
    let scene = options.scene().expect("the demo's scene");
    let trace = run_on_host(&options, &scene).expect("a whole run");
    let counts: Vec<[i32; 3]> = trace.samples.iter().map(|sample| sample.sensors.counts).collect();
    let enable_at = scene.enable_at as usize;
    let rust = with_capped_box(|body| in_rust(body, &counts, enable_at));
    assert!(rust.touched > 1_000 && rust.fault.is_none(), "{title}: {rust:?}");

    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("numbers"), bytemuck::cast_slice::<f32, u8>(&numbers())).expect("numbers");
    fs::write(path("counts"), bytemuck::cast_slice::<[i32; 3], u8>(&counts)).expect("counts");
    let mut replay = program("tests/replay.c", folder.path(), gcc);
    replay.arg(capped_box()).args([path("numbers"), path("counts")]).arg(enable_at.to_string());
    assert_eq!(run(&mut replay).trim(), format!("{:08x} {} none", rust.hash, rust.touched), "{title}");
    println!("{title}, {} ticks: {:08x} in C and in Rust, modes to {} mm", counts.len(), rust.hash, 1e3 * rust.moved);
}

#[test]
fn a_protected_loop_with_tool_texture_and_passivity_control_is_that_of_rust() {
    if !is_wanted("a protected loop in C") {
        return;
    }
    replay("protection, tool, texture and passivity control", &[], |body, counts, at| in_rust(body, counts, at), &[]);
}

#[test]
fn a_body_that_gives_way_has_the_modes_and_forces_of_rust_and_each_refusal() {
    if !is_wanted("a body that gives way in C") {
        return;
    }
    let root = repository::root().expect("in the repository");
    let folder = tempfile::tempdir().expect("a folder");
    // The foam box, one of its modes with a bump under the hand, as `bake` writes them and a user has them in C.
    let mut modes = capped_box_modes::MODES;
    modes[3].bump = Some(Bump { direction: vec3(0.3, 0.2, 0.9), at: vec3(0.03, 0.02, 0.03), radius: 0.04 });
    let [source, header] = ["part.rs", "modes.h"].map(|name| folder.path().join(name));
    let both: Vec<_> = modes.into_iter().zip(capped_box_modes::MOTION).collect();
    fs::write(&source, modes_source(&both).expect("Rust")).expect("a source");
    let written = run(Command::new("python3").arg(file("modes.py")).arg(&source));
    fs::write(&header, written).expect("a header");
    let soft = |body: &Body<'_>, counts: &[[i32; 3]], at: usize| {
        let soft = Soft::new(*body, &modes).expect("modes");
        let soft = SoftBody::new(soft, &capped_box_modes::MOTION, RATE).expect("motion");
        let rust = in_rust(&soft, counts, at);
        assert!(rust.moved > 1e-4, "{rust:?}");
        rust
    };
    let toml = root.join("host-tests/soft/capped_box.modes.toml").display().to_string();
    replay("a body that gives way", &["--modes", &toml], soft, &[format!("-DMODES_FILE=\"{}\"", header.display())]);
}
