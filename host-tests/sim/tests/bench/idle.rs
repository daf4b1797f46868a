//! What runs below the tick: heartbeat, records, and a line that is never waited for.

use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::servo::{Config, Heartbeat, ResetReason, Servo};
use palpate::wire::frame::{MAX_FRAME, Received, Receiver};
use palpate::wire::{DeviceMessage, PROTOCOL};
use palpate_bench::{Idle, Port, WINDOW_MS, Watchdog, heartbeat};
use palpate_sim::rig::{Rig, SETTINGS, WALL, held_at, settings};

#[derive(Default)]
struct Counted(u32);

impl Watchdog for Counted {
    fn feed(&mut self) {
        self.0 += 1;
    }
}

/// A line that takes a byte now and then.
struct Slow {
    every: u32,
    asked: u32,
    sent: Vec<u8>,
}

impl Port for Slow {
    fn send(&mut self, byte: u8) -> bool {
        self.asked += 1;
        let takes = self.every > 0 && self.asked.is_multiple_of(self.every);
        if takes {
            self.sent.push(byte);
        }
        takes
    }

    fn receive(&mut self) -> Option<u8> {
        None
    }
}

fn rig() -> Rig<palpate::device::SerialArm> {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    Rig::new(servo, held_at([0.0; 3]), &settings(), ResetReason::PowerOn)
}

#[test]
fn the_watchdog_is_fed_once_a_tick_and_starves_when_ticks_stop_whatever_the_line_does() {
    for every in [0, 1] {
        let mut rig = rig();
        let (mailbox, records) = (rig.mailbox, rig.take_records());
        let mut idle = Idle::new(mailbox, records, Heartbeat::default());
        let (mut watchdog, mut line) = (Counted::default(), Slow { every, asked: 0, sent: Vec::new() });
        for tick in 1..=100 {
            rig.tick();
            for _ in 0..50 {
                idle.step(&mut line, &mut watchdog);
            }
            assert_eq!(watchdog.0, tick);
        }
        for _ in 0..1_000 {
            idle.step(&mut line, &mut watchdog);
        }
        assert_eq!(watchdog.0, 100);
        assert_eq!(line.sent.is_empty(), every == 0);
    }
}

#[test]
fn the_watchdog_is_fed_within_its_window_at_any_rate() {
    for rate in [100.0, 400.0, 600.0, 999.0, 1_000.0, 1_500.0, 4_000.0, 10_000.0, 20_000.0, 40_000.0] {
        let mut heartbeat = heartbeat(rate);
        let fed: Vec<u32> = (1..=10_000).filter(|tick| heartbeat.may_feed(*tick)).collect();
        for pair in [0].iter().chain(&fed).zip(&fed) {
            let apart_ms = 1e3 * f64::from(pair.1 - pair.0) / f64::from(rate);
            // Half of it is for an oscillator that is a tenth off and for main, which feeds some turns after the tick;
            // the timeout is 20 ms.
            assert!(apart_ms > 1.99 * f64::from(WINDOW_MS) && apart_ms <= 10.0, "{rate} Hz: {apart_ms} ms");
        }
    }
}

#[test]
fn records_go_out_whole_over_a_line_that_takes_a_byte_now_and_then() {
    let mut rig = rig();
    rig.ticks(200);
    let (mailbox, records) = (rig.mailbox, rig.take_records());
    let mut idle = Idle::new(mailbox, records, Heartbeat::default());
    let mut line = Slow { every: 7, asked: 0, sent: Vec::new() };
    for _ in 0..200 * MAX_FRAME {
        idle.step(&mut line, &mut Counted::default());
    }
    let mut receiver = Receiver::<DeviceMessage>::new();
    let received: Vec<_> = line.sent.iter().filter_map(|byte| receiver.feed(*byte)).collect();
    assert!(received.len() >= 10);
    let hello = received.first();
    assert!(
        matches!(hello, Some(Received::Message(DeviceMessage::Hello(hello))) if hello.protocol == PROTOCOL),
        "{hello:?}"
    );
    for (number, told) in received.into_iter().skip(1).enumerate() {
        let Received::Message(DeviceMessage::Record(record)) = told else { panic!("{told:?}") };
        assert_eq!(record.number, number as u32);
    }
}
