//! The recommended rendering and the plain one in C, beside the same loop in Rust: hands that tap the capped box and
//! slip off its edge, over the counts of each run, on every shipped device; with less than three joints over a sweep of
//! counts.

use crate::running::{capped_box, file, is_wanted, library, run, with_capped_box};
use palpate::body::Body;
use palpate::device::{Counts, Device, Kinematics};
use palpate::math::{Vec3, vec3};
use palpate::servo::recommended::Recommended;
use palpate::servo::{Config, Input, Output, Rendering, Servo, Settings};
use palpate_sim::devices::{DEVICES, Preset, ShippedDevice, c_preset};
use palpate_sim::feel::{Script, Stage, over_edges};
use palpate_sim::plant::{HandSettings, Plant};
use palpate_sim::zwidth::Slice;
use palpate_tool::in_c::{self, Core};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Where the box's tables lie, so that it is centred in the workspace.
const ORIGIN: Vec3 = vec3(-0.03, -0.02, -0.016_75);
/// Plain, as the C library had it alone: N/m, or the device's limit; N·s/m, Hz.
const PLAIN: [f32; 3] = [1_000.0, 2.0, 150.0];
/// The tick from which force is asked for.
const ENABLE_AT: usize = 200;

/// Counts of a device that reaches no edge: up to 200 and back, each joint at its own pace.
const SWEEP: [i32; 3] = [3, 5, 7];

/// What a run comes to: the hash of its states, and the largest step of the force from tick to tick, mN.
#[derive(Debug, Default, PartialEq)]
struct Felt {
    hash: u32,
    step: f32,
}

fn in_rust<K: Kinematics<JOINTS>, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    body: &Body<'_>,
    shipped: &ShippedDevice,
    (settings, rendering): (Settings, Rendering),
    script: Option<&Script>,
) -> (Felt, Vec<[i32; 3]>) {
    let servo = Servo::try_new(device, body, Config { settings, rendering, ..Config::DEFAULT }).expect("settings");
    let plant = |script: &Script| {
        Plant::new(&shipped.plant, HandSettings::default(), Box::new(script.path.clone()), 4_000.0)
            .expect("the hand starts within reach")
    };
    let mut plant = script.map(plant);
    let (mut state, mut felt, mut all) = (servo.start(), Felt::default(), Vec::new());
    let mut last = Vec3::ZERO;
    for tick in 0..(script.map_or(1.0, |script| script.path.end()) * 4_000.0) as usize {
        let swept = SWEEP.map(|pace| 200 - (tick as i32 / pace % 400 - 200).abs());
        let counts = plant.as_ref().map_or(swept, Plant::counts);
        all.push(counts);
        let sensed = core::array::from_fn(|joint| Counts(counts[joint]));
        let _ = servo.tick(&mut state, Input::Sensors { counts: sensed, enable: tick >= ENABLE_AT });
        felt.hash = (felt.hash ^ state.digest()).wrapping_mul(0x0100_0193);
        felt.step = felt.step.max(1e3 * (state.force() - last).length());
        last = state.force();
        let mut duties = [0; 3];
        if let Output::Drive(given) = state.output() {
            duties.iter_mut().zip(given).for_each(|(duty, given)| *duty = given.0);
        }
        plant.iter_mut().for_each(|plant| plant.advance(duties));
    }
    assert_eq!(state.fault(), None, "{}", shipped.name);
    (felt, all)
}

fn compare<K: Kinematics<JOINTS>, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    shipped: &ShippedDevice,
    library: &Path,
    folder: &Path,
) {
    let path = |name: &str| folder.join(name);
    fs::write(path("device.h"), c_preset(shipped)).expect("a header");
    let mut gcc = in_c::compiler(Core::Host, "gcc").expect("in the repository");
    gcc.arg("-std=c11").arg("-I").arg(folder).arg(file("tests/rendering.c")).arg(library);
    run(gcc.args(["-lm", "-o"]).arg(path("rendering")));
    let Recommended { settings, rendering } = shipped.recommended();
    let settings = Settings { body_origin_m: ORIGIN, ..settings };
    let [stiffness, damping, corner] = PLAIN;
    let stiffness = stiffness.min(device.max_stiffness_n_per_m);
    let plain =
        Settings { stiffness_n_per_m: stiffness, damping_n_s_per_m: damping, velocity_corner_hz: corner, ..settings };
    let stage = Stage {
        joints: JOINTS,
        stiffness: settings.stiffness_n_per_m.into(),
        hand: HandSettings::default().stiffness,
        dry: Slice::of(shipped).coulomb,
        max_force: settings.max_force_n.into(),
    };
    with_capped_box(|body| {
        let all = over_edges(body, ORIGIN, &stage);
        let is_wanted = |script: &&Script| ["off an edge 0.1 m/s", "off an edge 0.3 m/s"].contains(&&*script.name);
        let mut scripts: Vec<Option<&Script>> = all.iter().filter(is_wanted).map(Some).collect();
        assert_eq!(scripts.len(), 2);
        let mut ways = vec![("recommended", (settings, rendering)), ("plain", (plain, Rendering::PLAIN))];
        if JOINTS < 3 {
            scripts = vec![None];
            // Their limits are below that wall.
            ways.truncate(1);
        }
        let mut largest = [0.0_f32; 2];
        for script in scripts {
            for ((way, wanted), largest) in ways.iter().copied().zip(&mut largest) {
                let (rust, counts) = in_rust(device, body, shipped, wanted, script);
                fs::write(path("counts"), bytemuck::cast_slice::<[i32; 3], u8>(&counts)).expect("counts");
                let mut replay = Command::new(path("rendering"));
                replay.arg(capped_box()).arg(path("counts")).args([ENABLE_AT.to_string(), way.to_owned()]);
                // Nine places are more than the bits of a float.
                assert_eq!(
                    run(&mut replay).trim(),
                    format!("{:08x} {:.9}", rust.hash, rust.step),
                    "{} {way}",
                    shipped.name
                );
                *largest = largest.max(rust.step);
            }
        }
        if JOINTS < 3 {
            return;
        }
        let [smooth, plain] = largest;
        println!(
            "{:<20} largest step off an edge, in C as in Rust: {smooth:>6.1} mN; plain {plain:>6.0} mN",
            shipped.name
        );
        // The ease's own 200 N/s at 4 kHz, to the rounding of a vector's length.
        assert!(smooth < 50.01 && plain > 200.0, "{smooth} {plain}");
    });
}

#[test]
fn the_recommended_rendering_in_c_has_the_bits_and_the_steps_of_rust() {
    if !is_wanted("the recommended rendering in C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let library = library(Core::Host);
    for shipped in &DEVICES {
        match shipped.preset {
            Preset::SerialArm(device) => compare(device, shipped, &library, folder.path()),
            Preset::LinkageArm(device) => compare(device, shipped, &library, folder.path()),
            Preset::Delta(device) => compare(device, shipped, &library, folder.path()),
            Preset::FiveBar(device) => compare(device, shipped, &library, folder.path()),
            Preset::Paddle(device) => compare(device, shipped, &library, folder.path()),
        }
    }
}
