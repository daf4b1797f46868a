//! The measure against what is known beforehand of a spring and a damper alone.

use palpate::body::Body;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::math::{Vec3, vec3};
use palpate::servo::{Config, Servo, Settings};
use palpate_sim::feel::{Deed, Recording, Script, Stage, Threshold, over_edges, record, wall};
use palpate_sim::plant::{HandSettings, PlantSettings};

mod capped_box {
    include!("../../../../boards/bodies/capped_box.rs");
}

/// The middle of the box.
const AT: Vec3 = vec3(-0.03, -0.02, -0.016);
const SETTINGS: Settings = Settings {
    rate_hz: 4_000.0,
    stiffness_n_per_m: 1_000.0,
    damping_n_s_per_m: 2.0,
    max_force_n: 5.0,
    velocity_corner_hz: 150.0,
    soft_start_s: 0.1,
    body_origin_m: Vec3::ZERO,
};
const STAGE: Stage = Stage { joints: 3, stiffness: 1_000.0, hand: 300.0, dry: 0.08, max_force: 5.0 };

fn on_the_wall(settings: Settings, like: impl Fn(&Deed) -> bool) -> Vec<(Script, Recording)> {
    let servo = Servo::try_new(&WOODEN_HAPTICS_2016, wall(3), Config { settings, ..Config::DEFAULT }).unwrap();
    let plant = PlantSettings::wooden_haptics_2016();
    let scripts = STAGE.on_the_wall().into_iter().filter(|script| like(&script.deed));
    scripts
        .map(|script| {
            let recording = record(&servo, &plant, HandSettings::default(), &script).unwrap();
            (script, recording)
        })
        .collect()
}

#[test]
fn a_damper_meets_the_speed_at_once_and_that_is_the_step_at_contact() {
    let fast = |deed: &Deed| matches!(deed, Deed::Approach(speed) if *speed == 0.3);
    for damping in [0.0, 2.0] {
        let [(_, recording)] = &on_the_wall(Settings { damping_n_s_per_m: damping, ..SETTINGS }, fast)[..] else {
            panic!("one script")
        };
        let step = recording.steps().contact;
        // In a tick the probe moves on by 75 µm, give or take a count of 58 µm in each of two joints, at 1 N/mm; and
        // the damper takes 0.3 m/s, give or take what counts make of it: 44 mm/s.
        let expected = 0.3 * f64::from(damping) + 0.075;
        assert!((step - expected).abs() < 0.117 + 0.044 * f64::from(damping), "{damping}: {step}, not {expected}");
    }
}

#[test]
fn in_front_of_the_wall_there_is_no_force_at_all_and_on_it_stiffness_times_depth() {
    let threshold = Threshold::approximate();
    for (script, recording) in on_the_wall(SETTINGS, |deed| matches!(deed, Deed::Hover | Deed::Air)) {
        assert!(recording.ticks.iter().all(|tick| tick.force == [0.0; 3]), "{}", script.name);
        assert_eq!(recording.steps().any, 0.0);
    }
    for (script, recording) in on_the_wall(SETTINGS, |deed| *deed == Deed::Rest) {
        let figures = recording.figures(script.looked_at, &threshold);
        // Single precision of a force; the hand's friction is not in it.
        assert!((figures.force / (1_000.0 * figures.depth) - 1.0).abs() < 1e-5, "{}: {figures:?}", script.name);
        assert!(figures.sensation.is_below() && figures.ripple < 1e-6, "{}: {:?}", script.name, figures.sensation);
    }
}

#[test]
fn what_an_edge_takes_away_at_once_is_found_as_a_step() {
    let body: &Body<'_> = &capped_box::BODY;
    let settings = Settings { body_origin_m: AT, ..SETTINGS };
    let servo = Servo::try_new(&WOODEN_HAPTICS_2016, body, Config { settings, ..Config::DEFAULT }).unwrap();
    let scripts = over_edges(body, AT, &STAGE);
    assert!(scripts.iter().any(|script| matches!(script.deed, Deed::Across(Some(_)))));
    let slow = scripts.into_iter().find(|script| script.deed == Deed::Off(0.1)).unwrap();
    let recording = record(&servo, &PlantSettings::wooden_haptics_2016(), HandSettings::default(), &slow).unwrap();
    // At the edge the face hands over to the side, which the probe only brushes.
    let length = |force: [f64; 3]| force.iter().map(|force| force * force).sum::<f64>().sqrt();
    let lost = recording.ticks.windows(2).map(|pair| [length(pair[0].force), length(pair[1].force)]);
    let [held, left] = lost.max_by(|a, b| (a[0] - a[1]).total_cmp(&(b[0] - b[1]))).unwrap();
    // The hand presses with 0.7 N; the device's friction and the slope of the dome take or give a tenth. On the side it
    // is the damper that meets 0.1 m/s: 0.2 N.
    assert!((held - 0.7).abs() < 0.1 && left < 0.2, "{held} {left}");
    let step = recording.steps().any;
    assert!(step >= held - left && step <= held + left, "{step} {held} {left}");
}
