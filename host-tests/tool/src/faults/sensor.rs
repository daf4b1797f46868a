//! Sensors of the joints.

use super::hand::APPROACHES;
use super::{Failure, Reaction::Latched, Setting, Shown::Planted, Touch, gap, row};
use palpate::servo::Fault;
use palpate_bench::sensors::BadFrame;
use palpate_sim::plant::EncoderFault;

/// Frames that are bad from now on.
fn bad(touch: &mut Touch<'_>, kind: BadFrame) -> bool {
    (touch.world.kind, touch.world.bad) = (kind, 1);
    true
}

/// The hand slides, pressing with some 2 N; then a count stands still.
fn sticks(touch: &mut Touch<'_>) -> bool {
    if touch.tick == 0 {
        touch.follow(&[[0.0, -0.004], [0.3, -0.006]], 0.045);
    }
    if touch.tick == 4_000 {
        let joint = if touch.world.plant.mechanism().joints() == 3 { 1 } else { 0 };
        touch.world.plant.inject(joint, Some(EncoderFault::Stuck));
    }
    touch.tick >= 4_000
}

pub(super) const TABLE: &[Failure] = &[
    row(
        [
            "sensor",
            "no frame of a sensor on a bus comes",
            "third in a row",
            "two_bad_frames_in_a_row_are_bridged_and_counted_and_the_third_is_the_fault_in_its_own_tick",
        ],
        0.75,
        Latched(Fault::FrameLost),
        Planted(Setting::Pressed, |touch| bad(touch, BadFrame::Absent)),
    ),
    row(
        [
            "sensor",
            "every frame of a sensor on a bus is damaged",
            "third in a row",
            "two_bad_frames_in_a_row_are_bridged_and_counted_and_the_third_is_the_fault_in_its_own_tick",
        ],
        0.75,
        Latched(Fault::FrameDamaged),
        Planted(Setting::Pressed, |touch| bad(touch, BadFrame::Damaged)),
    ),
    row(
        [
            "sensor",
            "two of three frames of a sensor on a bus are damaged",
            "more than 1 % of frames",
            "more_than_one_bad_frame_in_a_hundred_is_a_fault_though_no_three_come_in_a_row",
        ],
        4.25,
        Latched(Fault::FrameDamaged),
        Planted(Setting::Pressed, |touch| {
            touch.world.bad_of = [2, 3];
            true
        }),
    ),
    row(
        [
            "sensor",
            "a reading jumps",
            "faster than a hand, three times; without `FrameBridge`, as in C, at once as fault 4",
            "sensors_that_lie_or_fall_silent_are_faults_and_the_motors_are_off",
        ],
        0.75,
        Latched(Fault::FrameDamaged),
        Planted(Setting::Pressed, |touch| {
            if touch.tick == 0 {
                touch.world.plant.inject(0, Some(EncoderFault::Jump(3_000)));
            }
            true
        }),
    ),
    row(
        [
            "sensor",
            "the magnet is lost",
            "diagnostic frame",
            "a_magnet_that_falls_off_and_a_sensor_that_freezes_are_faults_on_an_arm",
        ],
        1.0,
        Latched(Fault::Magnet),
        Planted(Setting::Magnetic, |touch| {
            touch.magnets.iter_mut().for_each(|table| table.chips[0].field = 0.0);
            true
        }),
    ),
    row(
        [
            "sensor",
            "a magnetic reading freezes",
            "1,000 equal readings",
            "a_magnet_that_falls_off_and_a_sensor_that_freezes_are_faults_on_an_arm",
        ],
        251.0,
        Latched(Fault::Frozen),
        Planted(Setting::Magnetic, |touch| {
            touch.magnets.iter_mut().for_each(|table| table.chips[0].is_frozen = true);
            true
        }),
    ),
    row(
        [
            "sensor",
            "a counter sticks under load, the others move",
            "stuck limits: 30 mm of travel, 0.75 s",
            "a_count_that_stands_still_under_load_is_found_by_default",
        ],
        2_000.0,
        Latched(Fault::JointStuck),
        Planted(Setting::Pressed, sticks),
    )
    .but("a Falcon (friction hides the load), devices of one or two joints", |subject| match subject.joints() {
        1 => Some("it has no other joint that moves"),
        2 => Some("the probe leaves the wall along the stuck joint, which ends the force"),
        _ => subject.is_delta().then_some("the load of 2 N is below five times its dry friction"),
    }),
    row(
        [
            "sensor",
            "an angle leaves its range or the mechanism's reach",
            "every tick",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        0.5,
        Latched(Fault::JointOutOfRange),
        Planted(Setting::Pressed, |touch| {
            if touch.tick == 0 {
                touch.follow(&[[0.0, -0.004], [0.1, 0.02]], 0.0);
            }
            if touch.tick > 600 {
                touch.world.turned[0] += touch.slow;
            }
            touch.leaves_range
        }),
    ),
    row(
        [
            "sensor",
            "the controller of the bus never ends a frame (Pico 2, Teensy)",
            "bounded wait; third in a row",
            "test_bus_that_never_ends_a_frame_stops_in_the_third_tick_and_no_tick_is_long",
        ],
        0.75,
        Latched(Fault::FrameLost),
        Planted(Setting::Magnetic, |touch| {
            touch.magnets.iter_mut().for_each(|table| table.finishes = false);
            true
        }),
    ),
    gap(
        "sensor",
        "a counter without load stands still",
        "a joint at rest reads the same",
        Some((Setting::Heavier, |touch| {
            if touch.tick == 0 {
                touch.world.plant.inject(0, Some(EncoderFault::Stuck));
            }
            true
        })),
    ),
    gap(
        "sensor",
        "a reversed encoder of a joint beyond the first keeps the probe from contact",
        "no contact gives no force; commissioning turns each joint and finds it",
        Some((Setting::ReversedEncoder(1), |touch| {
            if touch.tick == 0 {
                touch.follow(&APPROACHES, 0.0);
            }
            touch.world.button = true;
            true
        })),
    ),
];
