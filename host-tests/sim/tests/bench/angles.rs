//! AS5047P sensors at their pins: the driver keeps the data sheet's times, and says what it cannot believe.

use embedded_hal::delay::DelayNs;
use palpate::device::Counts;
use palpate_bench::sensors::{BadFrame, Sensors};
use palpate_bench::{Counter, CycleDelay};
use palpate_sim::magnetic::table;
use std::cell::Cell;

/// The data sheet's minimum times, nanoseconds: written here once more, from its table.
const HIGH: f64 = 350.0;
const SET_UP: f64 = 350.0;
/// Half a clock of 8 MHz.
const HOLD: f64 = 62.5;

/// The clocks of the boards that read angles: 150 MHz of the Pico 2, 600 MHz of the Teensy, and a core so slow that a
/// look at the counter alone is long.
const CLOCKS_OF_BOARDS: [(u32, u64); 4] = [(150_000_000, 1), (150_000_000, 6), (600_000_000, 2), (8_000_000, 10)];

#[test]
fn a_select_line_is_high_and_set_up_as_long_as_the_data_sheet_asks_at_every_boards_clock() {
    for (frequency, look) in CLOCKS_OF_BOARDS {
        let (shared, mut joints) = table::<3>(frequency, look);
        joints.start().unwrap();
        for turn in 0..200_i32 {
            for (joint, chip) in shared.borrow_mut().chips.iter_mut().enumerate() {
                chip.angle = (turn * 100 * (joint as i32 + 1)) as u16 & 0x3fff;
            }
            let counts = joints.read().unwrap();
            assert_eq!(counts, [1, 2, 3].map(|joint| Counts(turn * 100 * joint)));
        }
        let [high, set_up, hold] = shared.borrow().least;
        assert!(high >= HIGH && set_up >= SET_UP && hold >= HOLD, "{frequency} Hz: {high} {set_up} {hold} ns");
        // And not much longer: all three are read within 30 µs at 150 MHz.
        assert!(frequency < 100_000_000 || (high < 600.0 && set_up < 600.0 && hold < 700.0), "{high} {set_up} {hold}");
    }
}

/// Counts a tick of three joints.
const STEPS: [i32; 3] = [3, 9, -6];

#[test]
fn above_10_khz_a_tick_reads_one_sensor_and_all_counts_are_of_one_moment() {
    let (shared, joints) = table::<3>(150_000_000, 6);
    let mut joints = joints.at(20_000.0);
    joints.start().unwrap();
    joints.place().unwrap();
    let (mut last, mut disturbed) = ([Counts(0); 3], 0);
    for tick in 1..300 {
        for (chip, step) in shared.borrow_mut().chips.iter_mut().zip(STEPS) {
            chip.angle = (tick * step) as u16 & 0x3fff;
            // Its turn comes within three ticks.
            chip.is_there = !(100..103).contains(&tick) || step != 9;
        }
        let (frames, cycles) = (shared.borrow().frames, shared.borrow().cycles);
        let read = joints.read();
        let took = (shared.borrow().cycles - cycles) as f32 / 150e6;
        let Ok(counts) = read else {
            (disturbed, _) = (tick, assert_eq!(read, Err(BadFrame::Absent)));
            continue;
        };
        // The time by which the rate is chosen, and three frames more after an error.
        assert!(took < if tick == disturbed + 1 { 20e-6 } else { 8e-6 }, "{tick}: {took} s");
        assert!(tick == disturbed + 1 || shared.borrow().frames - frames == 2, "{tick}");
        for ((count, before), step) in counts.iter().zip(last).zip(STEPS) {
            let moved = (count.0 - before.0) * step.signum();
            // Up to five ticks' way in three after two bad frames, which the loop bridges.
            assert!((0..=2 * step.abs()).contains(&moved) || tick - disturbed < 3, "{tick}: {moved} of {step}");
        }
        if tick > 5 && tick - disturbed > 8 {
            assert_eq!(counts, STEPS.map(|step| Counts(step * (tick - 2))), "{tick}");
        }
        last = counts;
    }
    assert!((100..103).contains(&disturbed));
}

/// A counter that stands still, and how often it was looked at.
#[derive(Default)]
struct Still(Cell<u32>);

impl Counter for &Still {
    fn now(&self) -> u32 {
        self.0.set(self.0.get() + 1);
        7
    }
}

#[test]
fn a_delay_is_never_short_by_a_cycle() {
    for frequency in [150_000_000_u32, 170_000_000, 600_000_000, 8_000_000] {
        let still = Still::default();
        let delay = CycleDelay::new(&still, frequency);
        for nanoseconds in [1_u32, 50, 100, 350, 351, 1_000, 10_000_000, u32::MAX] {
            let exact = f64::from(nanoseconds) * 1e-9 * f64::from(frequency);
            let counts = f64::from(delay.counts(nanoseconds));
            // The first may be over as soon as it is read.
            let over = counts - 1.0 - exact;
            let longest = 1.0 + f64::from(nanoseconds) * 4e-9;
            assert!((0.0..=longest).contains(&over), "{nanoseconds} ns at {frequency} Hz: {counts}");
        }
    }
}

#[test]
fn a_delay_ends_though_its_counter_stands_still() {
    let still = Still::default();
    let mut delay = CycleDelay::new(&still, 150_000_000);
    delay.delay_ns(350);
    // One to begin with, and one for each count.
    assert_eq!(still.0.get(), 1 + delay.counts(350));
}

#[test]
fn nothing_is_sent_before_the_sensors_have_powered_up_and_a_slow_one_is_waited_for() {
    let (shared, mut joints) = table::<3>(150_000_000, 6);
    // 40 ms later than its data sheet says: the supply came up slowly.
    shared.borrow_mut().chips[1].ready_at += 6_000_000;
    joints.start().unwrap();
    assert!(shared.borrow().cycles >= 7_500_000);

    // The first frame comes no earlier than 10 ms after power-on.
    let (shared, mut joints) = table::<3>(150_000_000, 6);
    shared.borrow_mut().chips.iter_mut().for_each(|chip| chip.ready_at = 1_500_000);
    joints.start().unwrap();
    // Three frames each: not one was in vain.
    assert_eq!(shared.borrow().frames, 9);
}

#[test]
fn a_sensor_that_is_not_there_is_said_so_within_a_fifth_of_a_second_and_found_when_it_comes() {
    let (shared, mut joints) = table::<3>(150_000_000, 6);
    shared.borrow_mut().chips[2].is_there = false;
    assert_eq!(joints.start(), Err(BadFrame::Absent));
    assert!(shared.borrow().cycles < 150_000_000 / 5);
    assert_eq!(joints.read(), Err(BadFrame::Absent));
    shared.borrow_mut().chips[2].is_there = true;
    assert!(joints.read().is_ok());
}

#[test]
fn a_sensor_whose_data_line_dies_is_absent_whichever_level_it_reads_then() {
    for silence in [0, u16::MAX] {
        for angle in [0, 8, 1_000] {
            let (shared, mut joints) = table::<3>(150_000_000, 6);
            for chip in &mut shared.borrow_mut().chips {
                (chip.silence, chip.angle) = (silence, angle);
            }
            joints.start().unwrap();
            assert_eq!(joints.read(), Ok([Counts(i32::from(angle)); 3]));
            shared.borrow_mut().chips[1].is_there = false;
            for _ in 0..10 {
                assert_eq!(joints.read(), Err(BadFrame::Absent), "{silence:#x} at {angle}");
            }
        }
    }
}

#[test]
fn a_joint_that_rests_at_angle_zero_is_read_there() {
    let (shared, mut joints) = table::<3>(150_000_000, 6);
    joints.start().unwrap();
    for angle in [5, 3, 0, 0, 0, 0, 0, 2, 0] {
        shared.borrow_mut().chips[0].angle = angle;
        assert_eq!(joints.read(), Ok([Counts(i32::from(angle)), Counts(0), Counts(0)]));
    }
    // Where one answers, and another one has died, the dead one is found.
    shared.borrow_mut().chips[2].silence = 0;
    shared.borrow_mut().chips[2].is_there = false;
    assert_eq!(joints.read(), Err(BadFrame::Absent));
}

#[test]
fn a_command_that_arrives_damaged_costs_one_reading_and_its_flag_is_cleared_in_the_next() {
    let (shared, mut joints) = table::<3>(150_000_000, 6);
    joints.start().unwrap();
    joints.read().unwrap();
    for joint in 0..3 {
        shared.borrow_mut().chips[joint].deaf = 1;
        assert_eq!(joints.read(), Err(BadFrame::Damaged), "joint {joint}");
        assert_eq!(joints.read(), Ok([Counts(0); 3]), "joint {joint}");
    }
}

#[test]
fn a_jump_that_no_hand_makes_is_refused_and_measured_against_the_last_good_one() {
    let (shared, mut joints) = table::<3>(150_000_000, 6);
    joints.start().unwrap();
    joints.read().unwrap();
    shared.borrow_mut().chips[0].angle = 6_000;
    assert_eq!(joints.read(), Err(BadFrame::Jumped));
    shared.borrow_mut().chips[0].angle = 300;
    assert_eq!(joints.read(), Ok([Counts(300), Counts(0), Counts(0)]));
}

#[test]
fn a_magnet_that_falls_off_or_a_frozen_sensor_is_not_believed_for_4_000_readings() {
    // Each of the frames is whole. The diagnostics are those of the reading before: the second bad one at the latest.
    for joint in 0..3 {
        for field in [0.0, 0.4, 200.0] {
            let (shared, mut joints) = table::<3>(150_000_000, 6);
            joints.start().unwrap();
            for turn in 0..4_000_u16 {
                shared.borrow_mut().chips.iter_mut().for_each(|chip| chip.angle = 100 + turn % 5);
                assert!(joints.read().is_ok());
            }
            assert_eq!(joints.gains(), [128; 3]);
            shared.borrow_mut().chips[joint].field = field;
            let mut bad = 0;
            for turn in 0..4_000_u16 {
                shared.borrow_mut().chips.iter_mut().for_each(|chip| chip.angle = 100 + turn % 7);
                let read = joints.read();
                assert!(turn == 0 || read == Err(BadFrame::Magnet), "joint {joint}, field {field}, reading {turn}");
                bad += u32::from(read.is_err());
            }
            assert!(bad >= 3_999);
            shared.borrow_mut().chips[joint].field = 1.0;
            assert!(joints.read().is_ok(), "a magnet that is back is seen again");
        }
        let (shared, mut joints) = table::<3>(150_000_000, 6);
        joints.start().unwrap();
        shared.borrow_mut().chips[joint].is_frozen = true;
        let found = (0..4_000_u16).find(|turn| {
            shared.borrow_mut().chips.iter_mut().for_each(|chip| chip.angle = 100 + turn % 3);
            joints.read() == Err(BadFrame::Frozen)
        });
        // A quarter of a second at 4 kHz.
        assert_eq!(found, Some(1_000), "joint {joint}");
    }
}

#[test]
fn a_reading_is_two_frames_and_its_diagnostics_cost_none() {
    let (shared, mut joints) = table::<3>(150_000_000, 6);
    joints.start().unwrap();
    let before = shared.borrow().frames;
    (0..100).for_each(|_| assert!(joints.read().is_ok()));
    assert_eq!(shared.borrow().frames - before, 100 * 3 * 2);
}
