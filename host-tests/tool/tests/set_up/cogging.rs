//! The cogging of a simulated motor, recorded over its line, and the torque that its map leaves on the shaft.

use palpate::device::CoggingMap;
use palpate_sim::knob::HostKnob;
use palpate_sim::plant::DialSettings;
use palpate_tool::commands::demo_knob::{recorded_of, recorded_source};
use palpate_truth::measured::measured;
use std::f64::consts::TAU;
use std::path::Path;

fn recorded(settings: DialSettings) -> CoggingMap {
    let (step, table) = recorded_of(settings).expect("the recording").table();
    CoggingMap::new(step, Box::leak(table.into_boxed_slice()))
}

/// The greatest torque on the shaft around a quarter of a pitch from a detent, N·m, by the clamp.
fn peak(knob: &mut HostKnob, detent: i32, side: f64) -> f64 {
    let pitch = TAU / 24.0;
    // The plant's sensor begins to count at 0.7 rad; a magnet off its centre moves a detent by up to 0.3°.
    let at = |step: i32| 0.7 + (f64::from(detent) + side * (0.25 + 0.02 * f64::from(step))) * pitch;
    (-4..=4).map(|step| -side * knob.held_at(at(step))).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn every_detent_of_a_turn_has_its_torque_on_either_side_within_two_percent_with_the_map_and_not_without() {
    let settings = DialSettings::gimbal_knob();
    let worst = |cogging| {
        let mut knob = HostKnob::running(settings, cogging);
        let off = |place: (i32, f64)| (peak(&mut knob, place.0, place.1) / 0.03 - 1.0).abs();
        (-12..12).flat_map(|detent| [(detent, -1.0), (detent, 1.0)]).map(off).fold(0.0, f64::max)
    };
    let (with, without) = (worst(Some(recorded(settings))), worst(None));
    measured(
        "knob: torque of every detent of a turn, off at most, with the map of its cogging",
        format!("{:.2}", 100.0 * with),
    );
    measured("knob: the same without the map", format!("{:.1}", 100.0 * without));
    assert!(with <= 0.02, "{with}");
    // Cogging of up to 6 of 30 mN·m: the measure sees it.
    assert!(without > 0.1, "{without}");
}

/// Largest and root mean square torque on the shaft, N·m, at 600 places of a turn, and the map's doing apart from the
/// motor's own.
fn felt_cogging(knob: &mut HostKnob) -> [f64; 2] {
    knob.choose(5);
    let start = knob.dial.angle();
    let (mut most, mut squares) = (0.0_f64, 0.0);
    // Not in step with 264 a turn.
    for place in 0..600 {
        let torque = knob.held_at(start + f64::from(place) * TAU / 601.3);
        most = most.max(torque.abs());
        squares += torque * torque;
    }
    [most, (squares / 600.0_f64).sqrt()]
}

#[test]
fn with_the_map_less_than_a_tenth_of_the_cogging_is_left() {
    let settings = DialSettings::gimbal_knob();
    let with = felt_cogging(&mut HostKnob::running(settings, Some(recorded(settings))));
    let without = felt_cogging(&mut HostKnob::running(settings, None));
    let told = |torque: f64| format!("{:.2}", 1e3 * torque);
    measured("knob: cogging, root mean square", told(without[1]));
    measured("knob: cogging with the map, root mean square", told(with[1]));
    measured("knob: cogging, at most", told(without[0]));
    measured("knob: cogging with the map, at most", told(with[0]));
    // What is left: the finest cogging between the map's entries (a straight line through eight to a wave leaves 5 %),
    // the sensor's counts and noise while it was recorded, and half a step of the table.
    assert!(with[1] <= without[1] / 10.0 && with[0] <= without[0] / 10.0, "{with:?} {without:?}");
    assert!(without[0] > 5e-3, "there is cogging: {without:?}");
}

#[test]
fn the_map_in_the_image_is_what_is_recorded_of_the_simulated_motor() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../boards/emulated/knob_cogging.rs");
    let source = recorded_source().unwrap();
    if std::env::var_os("PALPATE_WRITE").is_some() {
        std::fs::write(&file, &source).unwrap();
    }
    assert!(std::fs::read_to_string(&file).unwrap() == source, "PALPATE_WRITE=1 writes {}", file.display());
}
