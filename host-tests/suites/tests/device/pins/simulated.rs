//! Sensors and feeds on the simulated device.

use embedded_hal_mock::eh1::spi::{Mock, Transaction};
use palpate::device::drive::Supply;
use palpate::device::presets::HAPKIT;
use palpate::device::sensor::{AmsAngle, AmsChip, Mt6701, TimerCount, TurnCount};
use palpate::device::{Counts, Duty};
use palpate_sim::plant::{EncoderFault, HandPath, HandSettings, Plant, PlantSettings, Vector};
use std::f64::consts::TAU;

/// A hand that swings the paddle to and fro, 40 mm either way, once a second.
struct Swing;

impl HandPath for Swing {
    fn target(&self, time: f64) -> Vector {
        [0.04 * (TAU * time).sin(), 0.0, 0.0]
    }

    fn velocity(&self, time: f64) -> Vector {
        [0.04 * TAU * (TAU * time).cos(), 0.0, 0.0]
    }
}

/// Counts of the Hapkit's encoder over a swing, as a sensor of `2¹⁴` a turn of the motor would give them.
fn swing() -> Vec<i32> {
    let mut settings = PlantSettings::hapkit();
    settings.joints[0].counts_per_turn = 16_384.0;
    let hand = HandSettings { stiffness: 2_000.0, damping: 5.0, mass: 0.0 };
    let mut plant = Plant::new(&settings, hand, Box::new(Swing), 4_000.0).unwrap();
    (0..4_000)
        .map(|_| {
            plant.advance([0; 3]);
            plant.counts()[0]
        })
        .collect()
}

fn even(frame: u16) -> u16 {
    frame | ((frame.count_ones() % 2) as u16) << 15
}

#[test]
fn a_single_turn_sensor_follows_the_shaft_over_many_turns() {
    let swing = swing();
    let exchange = |asked: u16, frame: u16| {
        let both = Transaction::transfer_in_place(asked.to_be_bytes().to_vec(), frame.to_be_bytes().to_vec());
        [Transaction::transaction_start(), both, Transaction::transaction_end()]
    };
    let frames = swing.iter().flat_map(|counts| {
        let angle = exchange(0xfffc, even(*counts as u16 & 0x3fff));
        [exchange(0xffff, even(0x0180)), angle].concat()
    });
    let mut sensor = AmsAngle::new(Mock::new(&frames.collect::<Vec<_>>()), AmsChip::As5047p);
    // 0.5 m/s at the hand is 133 rad/s at the motor, 87 counts a tick.
    let mut turns = TurnCount::new(200);
    let mut offset = None;
    for counts in &swing {
        let Counts(total) = turns.count(u32::from(sensor.read().unwrap().angle)).unwrap();
        // From then on the whole turns stay the same.
        assert_eq!(*offset.get_or_insert(total - counts), total - counts);
    }
    sensor.free().done();
    let (least, most) = (swing.iter().min().unwrap(), swing.iter().max().unwrap());
    assert!(most - least > 16_384, "the shaft turns more than once: {least} {most}");
    assert_eq!(offset.unwrap() % 16_384, 0);
}

#[test]
fn an_ssi_sensor_follows_the_shaft() {
    // Long division of the polynomial, written apart from the library's.
    let crc = |payload: u32| {
        (0..18).rev().fold(0_u32, |crc, bit| {
            let carry = (crc >> 5 ^ payload >> bit) & 1;
            ((crc << 1) & 0x3f) ^ (carry * 0x03)
        })
    };
    let swing = swing();
    let mut turns = TurnCount::new(200);
    let mut offset = None;
    for counts in swing.iter().filter(|counts| *counts & 0x3fff != 0) {
        let payload = (*counts as u32 & 0x3fff) << 4;
        let frame = (payload << 6 | crc(payload)).to_be_bytes();
        let exchange = Transaction::read_vec(frame[1..].to_vec());
        let transactions = [Transaction::transaction_start(), exchange, Transaction::transaction_end()];
        let mut sensor = Mt6701::new(Mock::new(&transactions));
        let Counts(total) = turns.count(u32::from(sensor.read().unwrap().angle)).unwrap();
        assert_eq!(*offset.get_or_insert(total - counts), total - counts);
        sensor.free().done();
    }
}

#[test]
fn a_timer_follows_the_encoder_until_it_jumps() {
    let settings = PlantSettings::hapkit();
    let hand = HandSettings { stiffness: 2_000.0, damping: 5.0, mass: 0.0 };
    let mut plant = Plant::new(&settings, hand, Box::new(Swing), 4_000.0).unwrap();
    let mut timer = TimerCount::new(40);
    // The timer starts near its end, so that it wraps.
    let offset = 65_500;
    for tick in 0..2_000 {
        plant.advance([0; 3]);
        let counts = plant.counts()[0];
        assert_eq!(timer.count((counts + offset) as u32 & 0xffff), Ok(Counts(counts + offset)), "tick {tick}");
    }
    plant.inject(0, Some(EncoderFault::Jump(500)));
    plant.advance([0; 3]);
    assert!(timer.count((plant.counts()[0] + offset) as u32 & 0xffff).is_err());
    plant.inject(0, None);
    let counts = plant.counts()[0];
    assert_eq!(timer.count((counts + offset) as u32 & 0xffff), Ok(Counts(counts + offset)));
}

#[test]
fn a_fed_bridge_gives_the_torque_asked_for_at_speed_and_a_bare_one_does_not() {
    // A hand that pulls the paddle at a steady 0.3 m/s, stiffly enough that the motor does not matter.
    struct Pull;
    impl HandPath for Pull {
        fn target(&self, time: f64) -> Vector {
            [-0.04 + 0.3 * time, 0.0, 0.0]
        }
        fn velocity(&self, _: f64) -> Vector {
            [0.3, 0.0, 0.0]
        }
    }
    let hand = HandSettings { stiffness: 1e5, damping: 500.0, mass: 0.0 };
    let currents = [false, true].map(|fed| {
        let mut plant = Plant::new(&PlantSettings::hapkit(), hand, Box::new(Pull), 4_000.0).unwrap();
        let torque = Duty::from_fraction(0.25);
        for _ in 0..600 {
            let rate = plant.rates()[0] as f32;
            let [duty] = if fed { HAPKIT.feed(true, [torque], [rate], Supply::UNMEASURED) } else { [torque] };
            plant.advance([duty.0, 0, 0]);
        }
        plant.currents()[0]
    });
    // A quarter of 1.2 A. Back-EMF is 0.025 · 17.45 · 0.3/0.0657 = 1.99 V, which takes 0.2 A; the preset makes up for
    // four fifths of it. To a milliampere for the duty's steps and the last of the start.
    for (current, expected) in currents.into_iter().zip([0.3 - 0.1994, 0.3 - 0.0399]) {
        assert!((current - expected).abs() < 1e-3, "{currents:?}");
    }
}
