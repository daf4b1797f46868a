//! Sensors that are late, absent, stuck or lying, and frames that are bad now and then.

use palpate::device::SerialArm;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::servo::{Config, Fault, ResetReason, Safety, Servo};
use palpate_bench::Settings;
use palpate_bench::sensors::BadFrame;
use palpate_sim::plant::{EncoderFault, HandPath, HandSettings, Plant, PlantSettings, Vector};
use palpate_sim::rig::{RATE, Rig, SETTINGS, WALL, settings};
use std::f64::consts::TAU;

/// A hand that presses the probe into the wall and slides it about, 40 mm either way, a few times a second.
struct Brush;

impl HandPath for Brush {
    fn target(&self, time: f64) -> Vector {
        [0.04 * (TAU * 1.5 * time).sin(), 0.03 * (TAU * 2.0 * time).sin(), -0.006 + 0.004 * (TAU * 3.0 * time).sin()]
    }

    fn velocity(&self, time: f64) -> Vector {
        [
            0.06 * TAU * (TAU * 1.5 * time).cos(),
            0.06 * TAU * (TAU * 2.0 * time).cos(),
            0.012 * TAU * (TAU * 3.0 * time).cos(),
        ]
    }
}

fn rig(settings: &Settings) -> Rig<SerialArm> {
    rig_with(settings, Safety::DEFAULT)
}

fn rig_with(settings: &Settings, safety: Safety) -> Rig<SerialArm> {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
    let hand = HandSettings { stiffness: 600.0, damping: 8.0, mass: 0.0 };
    let plant = Plant::new(&PlantSettings::wooden_haptics_2016(), hand, Box::new(Brush), RATE).unwrap();
    let mut rig = Rig::new(servo, plant, settings, ResetReason::PowerOn);
    rig.press_until_it_runs();
    rig
}

#[test]
fn two_bad_frames_in_a_row_are_bridged_and_counted_and_the_third_is_the_fault_in_its_own_tick() {
    for (kind, fault) in [
        (BadFrame::Damaged, Fault::FrameDamaged),
        (BadFrame::Jumped, Fault::FrameDamaged),
        (BadFrame::Absent, Fault::FrameLost),
        (BadFrame::Magnet, Fault::Magnet),
        (BadFrame::Frozen, Fault::Frozen),
    ] {
        let mut rig = rig(&settings());
        rig.set(|world| world.kind = kind);
        for time in 1..=8 {
            rig.set(|world| world.bad = 2);
            // Less than one frame in a hundred.
            rig.ticks(250);
            assert_eq!((rig.fault(), rig.bench.bridged(), rig.is_off()), (None, 2 * time, false));
        }
        rig.set(|world| world.bad = 3);
        rig.ticks(2);
        assert!(!rig.is_off());
        rig.ticks_off(1);
        assert_eq!((rig.fault(), rig.state().frames_lost()), (Some(fault), 1));
        rig.ticks_off(100);
        let last = rig.last_record().unwrap();
        assert_eq!((last.bridged, last.fault), (18, fault.code()));
    }
}

#[test]
fn more_than_one_bad_frame_in_a_hundred_is_a_fault_though_no_three_come_in_a_row() {
    for (bad_of, faults) in [([2, 3], true), ([1, 2], true), ([1, 20], true), ([1, 60], true), ([1, 128], false)] {
        let mut rig = rig(&settings());
        rig.set(|world| world.bad_of = bad_of);
        // The low-pass of 1,024 frames in real numbers: the tick in which it exceeds 1 %.
        let frames = rig.world.borrow().frames;
        let mut level = 0.0;
        let expected = (1..20_000_u32).find(|tick| {
            level += (f64::from(u8::from((frames + tick) % bad_of[1] < bad_of[0])) - level) / 1_024.0;
            level > 0.01
        });
        assert_eq!(expected.is_some(), faults);
        let found = (1..expected.map_or(4_000, |tick| tick + 2)).find(|_| {
            rig.tick();
            rig.fault().is_some()
        });
        assert_eq!((found, rig.is_off()), (expected, faults), "{bad_of:?}");
        println!("{bad_of:?}: {found:?}");
        // Two of three: 4 ms at 4 kHz.
        assert!(bad_of != [2, 3] || found.is_some_and(|tick| tick <= 17), "{found:?}");
        let rate = rig.last_record().unwrap().bad_frames;
        assert!(if faults { rate >= 95 } else { (60..100).contains(&rate) }, "{bad_of:?}: {rate} in 10,000");
    }
}

#[test]
fn a_magnet_that_falls_off_and_a_sensor_that_freezes_are_faults_on_an_arm() {
    for joint in 0..3 {
        let mut with_magnets = rig(&settings());
        let table = with_magnets.with_magnetic_sensors();
        with_magnets.ticks(2_000);
        assert_eq!(with_magnets.fault(), None);
        assert_eq!(with_magnets.last_record().unwrap().gains, [128; 3]);
        table.borrow_mut().chips[joint].field = 0.1;
        // The diagnostics come with the next reading; two bad frames are bridged.
        with_magnets.ticks(4);
        assert_eq!((with_magnets.fault(), with_magnets.is_off()), (Some(Fault::Magnet), true));

        let mut frozen = rig(&settings());
        let table = frozen.with_magnetic_sensors();
        frozen.ticks(2_000);
        table.borrow_mut().chips[joint].is_frozen = true;
        frozen.ticks(1_004);
        assert_eq!((frozen.fault(), frozen.is_off()), (Some(Fault::Frozen), true));
    }
}

#[test]
fn how_many_are_bridged_is_a_setting_and_none_is_one_of_them() {
    for bad_frames in [0, 1, 5] {
        let mut rig = rig(&Settings { bad_frames, ..settings() });
        rig.set(|world| world.bad = bad_frames);
        rig.ticks(bad_frames + 1);
        assert_eq!(rig.fault(), None);
        rig.set(|world| world.bad = bad_frames + 1);
        rig.ticks(bad_frames);
        assert_eq!(rig.fault(), None);
        rig.ticks_off(1);
        assert_eq!(rig.fault(), Some(Fault::FrameDamaged));
    }
}

#[test]
fn a_bridged_frame_is_not_felt() {
    // Two frames of every 250 are bad, over seconds of a brisk brush: as many as are allowed. Each tick is predicted from
    // the good ones before it, and compared with where the joints are.
    let mut rig = rig(&settings());
    let mut worst = 0;
    for tick in 0..60_000 {
        let is_bad = tick % 250 == 0;
        if is_bad {
            rig.set(|world| world.bad = 2);
        }
        let truth = rig.world.borrow().plant.counts();
        rig.tick();
        assert_eq!(rig.fault(), None, "tick {tick}");
        if tick % 250 <= 1 {
            let believed = rig.state().counts().unwrap();
            worst = truth.iter().zip(believed).map(|(truth, count)| (truth - count.0).abs()).max().unwrap().max(worst);
        }
    }
    println!("a bridged frame is off by {worst} counts at most");
    // The low-pass lags by 0.8 ms, three periods; a hand that brakes with 20 m/s² changes its speed by 16 mm/s
    // meanwhile, which over two periods is 8 µm: a count of 43 µm is off by its own rounding on either side.
    assert!(worst <= 2, "{worst} counts");
}

#[test]
fn nothing_is_bridged_before_the_first_counts_nor_after_a_fault() {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    let mut fresh = Rig::new(servo, palpate_sim::rig::held_at([0.0; 3]), &settings(), ResetReason::PowerOn);
    fresh.set(|world| (world.bad, world.kind) = (1, BadFrame::Absent));
    fresh.ticks_off(1);
    assert_eq!((fresh.fault(), fresh.bench.bridged()), (Some(Fault::FrameLost), 0));
    fresh.set(|world| world.bad = 1);
    fresh.ticks_off(10);
    assert_eq!(fresh.bench.bridged(), 0);
}

#[test]
fn sensors_that_lie_or_fall_silent_are_faults_and_the_motors_are_off() {
    for joint in 0..3 {
        for (wrong, ticks) in [
            // A wire that is off reads zero: a jump, bridged twice.
            (EncoderFault::Absent, 3),
            (EncoderFault::Jump(300), 3),
            (EncoderFault::Jump(-300), 3),
        ] {
            let mut rig = rig(&settings());
            // Where the counter is far from zero, so that zero is wrong.
            rig.ticks(500);
            rig.world.borrow_mut().plant.inject(joint, Some(wrong));
            let mut seen = None;
            for tick in 1..=ticks {
                rig.tick();
                if rig.fault().is_some() {
                    assert!(rig.is_off());
                    seen = Some(tick);
                    break;
                }
            }
            assert!(seen.is_some(), "joint {joint}: {wrong:?}");
            rig.world.borrow_mut().plant.inject(joint, None);
            rig.ticks_off(500);
        }
    }
}

#[test]
fn a_glitch_of_one_reading_is_bridged() {
    let mut rig = rig(&settings());
    for joint in 0..3 {
        rig.world.borrow_mut().plant.inject(joint, Some(EncoderFault::Glitch(5_000)));
        rig.ticks(100);
        assert_eq!((rig.fault(), rig.bench.bridged()), (None, joint as u32 + 1));
    }
}

#[test]
fn a_sensor_that_sticks_under_load_is_a_fault_though_each_of_its_frames_is_good() {
    // A level wall does not load the turntable, and without load a joint may rest.
    let safety = Safety::DEFAULT;
    for joint in 1..3 {
        let mut rig = rig_with(&settings(), safety);
        rig.ticks(500);
        rig.world.borrow_mut().plant.inject(joint, Some(EncoderFault::Stuck));
        let stopped = (1..8_000).find(|_| {
            rig.tick();
            rig.fault().is_some()
        });
        assert!(stopped.is_some() && rig.is_off(), "joint {joint}");
        assert_eq!((rig.fault(), rig.bench.bridged()), (Some(Fault::JointStuck), 0));
        rig.ticks_off(100);
    }
}
