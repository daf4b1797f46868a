//! The demo with all protection is rendered, and raises no alarm.

use clap::Parser;
use palpate_sim::devices::named;
use palpate_tool::commands::options::SceneOptions;
use palpate_tool::commands::sim::run_on_host;
use palpate_tool::report::Summary;
use std::ops::RangeInclusive;

#[derive(Parser)]
struct Demo {
    #[command(flatten)]
    options: SceneOptions,
}

const MODELS: [&str; 2] = ["capped_box", "ellipsoid_body"];

/// Two seconds of the demo with all protection: what the hand needs for its touches.
fn demos(device: &str, models: &[&str], seeds: RangeInclusive<u64>) {
    for model in models {
        let words = ["demo", "--device", device, "--model", model, "--seconds", "2", "--protected"];
        let Demo { mut options } = Demo::parse_from(words);
        let scene = options.scene().unwrap();
        for seed in seeds.clone() {
            options.seed = seed;
            let summary = Summary::new(&run_on_host(&options, &scene).unwrap());
            println!("{device}, {model}, seed {seed}: {:?}", summary.rows());
            assert!(summary.fault.is_none() && summary.touches > 0, "{device}, {model}, seed {seed}: {summary}");
            assert!(summary.largest_force > 1.0, "{device}, {model}, seed {seed}: {summary}");
        }
    }
}

#[test]
fn the_protected_demo_is_felt_and_no_alarm() {
    demos("woodenhaptics-2016", &MODELS[..1], 1..=3);
    demos("phantom-premium", &MODELS[..1], 1..=3);
}

#[test]
fn the_protected_demo_of_an_ellipsoid_is_felt_and_no_alarm() {
    demos("phantom-premium", &MODELS[1..], 1..=1);
}

/// The plants of these two take longer.
#[test]
fn the_protected_demo_of_polhem_is_felt_and_no_alarm() {
    demos("polhem-v2", &MODELS[..1], 1..=1);
}

#[test]
fn the_protected_demo_of_the_falcon_is_felt_and_no_alarm() {
    demos("falcon", &MODELS[..1], 1..=1);
}

#[test]
#[ignore = "a minute: every device, model and seed"]
fn every_protected_demo_is_felt_and_no_alarm() {
    for device in ["woodenhaptics-2016", "polhem-v2", "phantom-premium", "falcon"] {
        demos(device, &MODELS, 1..=3);
    }
}

#[test]
fn a_run_that_ends_before_all_polarities_are_confirmed_says_so_and_for_how_long() {
    let folder = tempfile::tempdir().unwrap();
    let arm = folder.path().join("arm.toml");
    let text = toml::to_string(&named("woodenhaptics-2016").and_then(|arm| arm.file()).unwrap()).unwrap();
    std::fs::write(&arm, text.replace("name = \"b\"", "name = \"elbow\"")).unwrap();
    let withheld = |seconds: &str| {
        let device = arm.to_str().unwrap();
        let Demo { options } = Demo::parse_from(["demo", "--seconds", seconds, "--protected", "--device", device]);
        let scene = options.scene().unwrap();
        let trace = run_on_host(&options, &scene).unwrap();
        let words = scene.withheld(&trace).expect("a polarity check").1;
        (words, Summary::new(&trace).largest_force)
    };
    let (short, force) = withheld("0.2");
    // The pulses alone: below a quarter of 5 N.
    assert!(force < 1.25 && short.contains("a not confirmed, elbow not confirmed, c not confirmed"), "{short}");
    assert!(short.contains("force withheld for 0.10 s, to the end"), "{short}");
    // The force of a first contact, but too low for the pulses of a joint.
    let Demo { options } = Demo::parse_from(["demo", "--seconds", "1", "--protected", "--max-force", "0.5"]);
    let scene = options.scene().unwrap();
    let weak = scene.withheld(&run_on_host(&options, &scene).unwrap()).expect("a polarity check").1;
    assert!(weak.contains("too weak at 0.5 N") && weak.contains("joint b needs max_force 2."), "{weak}");
    let (whole, force) = withheld("2");
    assert!(force > 1.0 && !whole.contains("not confirmed") && !whole.contains("to the end"), "{whole}");
}
