//! Poses and marks; searches have their tests with them.

use super::*;
use crate::device::Commutation;

const ENCODERS: [Encoder; 2] = [Encoder::geared(1_000.0, 1.0, 0.0), Encoder::geared(1_000.0, -2.0, 9.0)];
const ANGLES: [f32; 2] = [0.5, -0.25];

fn homing(reference: Reference<2>) -> Homing<2> {
    Homing::try_new(ENCODERS, reference, 5, 1, 50).unwrap()
}

fn at(counts: [i32; 2]) -> HomingInput<2> {
    HomingInput { counts: Some(counts.map(Counts)), index: [None; 2], rates: [0.0; 2], period: 2.5e-4 }
}

/// Runs the inputs to the end, and gives the tick after which nothing is waited for any more.
fn run(homing: &Homing<2>, input: impl Fn(u32) -> HomingInput<2>) -> (u32, HomingProgress<2>) {
    let mut state = HomingState::default();
    let mut end = None;
    for tick in 0..100 {
        let progress = homing.tick(&mut state, input(tick));
        match end {
            None if progress != HomingProgress::Waiting => end = Some((tick, progress)),
            Some((_, first)) => assert_eq!(progress, first, "latched"),
            None => {}
        }
    }
    end.expect("it ends by the timeout")
}

fn angles(progress: HomingProgress<2>, counts: [i32; 2]) -> [f32; 2] {
    let HomingProgress::Done(encoders) = progress else { panic!("{progress:?}") };
    let [first, second] = counts;
    [encoders[0].angle(Counts(first)), encoders[1].angle(Counts(second))]
}

#[test]
fn held_still_the_reference_pose_is_what_the_encoders_then_say() {
    // It moves for ten ticks, then trembles by a count.
    let (tick, progress) = run(&homing(Reference::Pose(ANGLES)), |tick| {
        at(if tick < 10 { [7 * tick as i32, 0] } else { [700 + (tick % 2) as i32, -300] })
    });
    // Anchored at tick 10, still for the five after it.
    assert_eq!(tick, 15);
    for (angle, expected) in angles(progress, [701, -300]).into_iter().zip(ANGLES) {
        // Roundings of 4.4 rad.
        assert!((angle - expected).abs() < 1e-6, "{angle} {expected}");
    }
}

#[test]
fn a_device_that_never_rests_is_refused_when_the_time_is_over() {
    let drift = run(&homing(Reference::Pose(ANGLES)), |tick| at([tick as i32, 0]));
    assert_eq!(drift, (49, HomingProgress::Refused(Refusal::Moving)));
}

#[test]
fn a_device_put_down_elsewhere_is_refused() {
    let known = Reference::KnownPose { angles: ANGLES, counts: [Counts(100), Counts(-100)], tolerance: 3 };
    let (_, good) = run(&homing(known), |_| at([103, -97]));
    assert!(matches!(good, HomingProgress::Done(_)));
    assert_eq!(run(&homing(known), |_| at([104, -97])), (5, HomingProgress::Refused(Refusal::OutOfTolerance)));
}

#[test]
fn a_sensor_that_fails_is_refused_at_once() {
    let input = |tick| HomingInput { counts: (tick != 3).then_some([Counts(0); 2]), ..at([0; 2]) };
    for reference in [Reference::Pose(ANGLES), Reference::Index(ANGLES)] {
        assert_eq!(run(&homing(reference), input), (3, HomingProgress::Refused(Refusal::Sensor)));
    }
}

#[test]
fn each_joint_passes_its_index_once_or_is_refused() {
    let input = |joints: usize| {
        move |tick: u32| {
            let mut input = at([tick as i32 * 10, 0]);
            for (joint, mark) in input.index.iter_mut().enumerate().take(joints) {
                // A second pass elsewhere must not count.
                *mark = match tick {
                    7 => Some(Counts(40 + joint as i32)),
                    9 => Some(Counts(900)),
                    _ => None,
                };
            }
            input
        }
    };
    let homing = homing(Reference::Index(ANGLES));
    let (tick, progress) = run(&homing, input(2));
    assert_eq!(tick, 7);
    for (angle, expected) in angles(progress, [40, 41]).into_iter().zip(ANGLES) {
        assert!((angle - expected).abs() < 1e-6);
    }
    assert_eq!(run(&homing, input(1)), (49, HomingProgress::Refused(Refusal::NoIndex)));
}

#[test]
fn with_encoders_that_were_measured_each_way_of_homing_has_the_angles_that_they_have() {
    // The second joint's encoder was found finer and the other way round, and zero elsewhere.
    let found = [Encoder::geared(1_000.0, 1.0, 0.3), Encoder::geared(1_000.0, 2.5, -0.7)];
    let stop = |angle| StopSearch {
        angle_rad: angle,
        speed_rad_per_s: 1.0,
        torque_n_m: 0.1,
        clearance_rad: 0.1,
        travel_rad: 1.0,
    };
    let search = FieldSearch {
        commutation: Commutation { counts_per_turn: 1_000, pole_pairs: 7 },
        torque_n_m: 0.02,
        ramp_ticks: 10,
        turn_ticks: 64,
        turns: 1,
    };
    let (zeroes, counts) = (found.map(|encoder| encoder.angle_at_zero_rad), [Counts(100), Counts(-100)]);
    for (built, expected) in [
        // The measured zero is the angle in the pose, or at the mark.
        (Reference::Pose(ANGLES), Reference::Pose(zeroes)),
        (Reference::Index(ANGLES), Reference::Index(zeroes)),
        // The measured zero is the angle at count zero; the pose is elsewhere.
        (
            Reference::KnownPose { angles: ANGLES, counts, tolerance: 3 },
            Reference::KnownPose {
                angles: [found[0].angle(counts[0]), found[1].angle(counts[1])],
                counts,
                tolerance: 3,
            },
        ),
        // Stops and poles are where they are.
        (Reference::Stops([stop(0.1), stop(0.2)]), Reference::Stops([stop(0.1), stop(0.2)])),
        (Reference::Fields([search; 2]), Reference::Fields([search; 2])),
    ] {
        let homing = Homing::try_new(ENCODERS, built, 5, 1, 1_000).unwrap().when_asked();
        let wanted = Homing::try_new(found, expected, 5, 1, 1_000).unwrap().when_asked();
        assert_eq!(homing.of_encoders(found), wanted);
    }
    // In a known pose every angle is then what the encoders say by themselves.
    let known = Reference::KnownPose { angles: ANGLES, counts, tolerance: 3 };
    let (_, progress) = run(&homing(known).of_encoders(found), |_| at([102, -98]));
    for (angle, expected) in
        angles(progress, [500, 500]).into_iter().zip(found.map(|encoder| encoder.angle(Counts(500))))
    {
        // Two counts of the pose, 6 and 2.5 mrad each.
        assert!((angle - expected).abs() < 0.013, "{angle} {expected}");
    }
}

#[test]
fn numbers_that_make_no_sense_are_refused() {
    let with = |angle: f32, still, timeout| {
        Homing::try_new(ENCODERS, Reference::Pose([angle, 0.0]), still, 1, timeout).unwrap_err()
    };
    assert_eq!(with(f32::NAN, 5, 50), HomingError::Angle);
    assert_eq!(with(0.0, 0, 50), HomingError::StillTicks);
    assert_eq!(with(0.0, 5, 5), HomingError::TimeoutTicks);
    let search = |pole_pairs, torque_n_m| {
        let commutation = Commutation { counts_per_turn: 1_024, pole_pairs };
        let search = FieldSearch { commutation, torque_n_m, ramp_ticks: 10, turn_ticks: 100, turns: 1 };
        Homing::try_new(ENCODERS, Reference::Fields([search; 2]), 1, 0, 1_000).err()
    };
    assert_eq!([search(16, 0.1), search(16, 0.0)], [None, Some(HomingError::Field)]);
    assert_eq!([search(0, 0.1), search(17, 0.1)], [Some(HomingError::PolePairs); 2]);
}

#[test]
fn counts_at_the_ends_of_their_range_are_far_apart_and_no_panic() {
    let (_, progress) = run(&homing(Reference::Pose(ANGLES)), |tick| {
        at(if tick % 2 == 0 { [i32::MIN, i32::MAX] } else { [i32::MAX, i32::MIN] })
    });
    assert_eq!(progress, HomingProgress::Refused(Refusal::Moving));
}
