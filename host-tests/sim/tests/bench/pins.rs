//! The parts of a board at their pins, transaction by transaction.

use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as PinStep};
use embedded_hal_mock::eh1::pwm::{Mock as Width, Transaction as WidthStep};
use palpate::device::drive::{Drive, Field, HBridge, SetPointDrive, SetPointRange};
use palpate::device::{Counts, Duty, ElectricalAngle};
use palpate_bench::sensors::{BadFrame, Counters, Readings};
use palpate_bench::{
    Board, ClockCheck, Counter, Divider, Drives, Lines, NoSupply, NotObeyed, OneChannel, Panel, Parts, Passive,
    Switched, Timer,
};
use std::cell::Cell;
use std::io::ErrorKind;

struct Still;

impl Counter for Still {
    fn now(&self) -> u32 {
        7
    }
}

impl Timer for Still {
    fn acknowledge(&mut self) {}
}

/// A counter that the test sets.
struct Set<'a>(&'a Cell<u32>);

impl Counter for Set<'_> {
    fn now(&self) -> u32 {
        self.0.get()
    }
}

#[test]
fn a_direction_turns_once_the_width_before_is_over_at_every_rate() {
    for (rate, carrier, periods, ticks) in [
        (4_000, 20_000, 1, 1),
        (20_000, 20_000, 1, 2),
        (4_000, 2_000, 2, 5),
        (20_000, 2_000, 2, 21),
        (40_000, 2_000, 2, 41),
        (15_000, 20_000, 1, 2),
    ] {
        assert_eq!(palpate_bench::dwell(rate, carrier, periods), ticks, "{rate} Hz");
    }
    for rate in 3_000..40_000 {
        // The last tick may come half a period early.
        let rests = (f64::from(palpate_bench::dwell(rate, 20_000, 1)) - 0.5) / f64::from(rate);
        assert!(rests >= 1.0 / 20e3, "{rate} Hz: {rests} s");
    }
}

#[test]
fn two_clocks_that_are_a_fifth_apart_or_of_which_one_stands_still_disagree() {
    // 170 MHz beside 32 kHz of 16 bits, for a second in turns of a tick; the second's share of what it should make.
    let agree = |share: f64| {
        let (clock, reference) = (Cell::new(u32::MAX - 9), Cell::new(0));
        let mut check = ClockCheck::new((Set(&clock), 170_000_000), (Set(&reference), 32_000));
        (0..4_000_u32).all(|tick| {
            clock.set((u32::MAX - 9).wrapping_add(tick * 42_500));
            reference.set((f64::from(tick) * 8.0 * share) as u32 & 0xffff);
            check.step().is_ok()
        })
    };
    for (share, holds) in
        [(1.0, true), (0.9, true), (1.1, true), (0.8, false), (1.3, false), (0.0, false), (2.0, false)]
    {
        assert_eq!(agree(share), holds, "{share}");
    }
}

struct Three([u32; 3]);

impl Readings<3> for Three {
    fn readings(&mut self) -> [u32; 3] {
        self.0
    }
}

fn reads(level: State) -> Pin {
    Pin::new(&[PinStep::get(level)])
}

fn fails() -> MockError {
    MockError::Io(ErrorKind::NotConnected)
}

/// What lines at these levels say.
fn panel(enable: Pin, enable_level: bool, stop: Pin, ready: [Pin; 2]) -> Panel {
    let enable = OneChannel { pin: enable, pressed_level: enable_level };
    let mut lines = Lines { enable, stop, ready, supply: NoSupply };
    let panel = lines.read();
    lines.enable.pin.done();
    lines.stop.done();
    lines.ready.iter_mut().for_each(Pin::done);
    panel
}

#[test]
fn each_line_says_what_its_level_means_and_every_pin_is_read() {
    use State::{High, Low};
    for (enable, level, stop, ready, expected) in [
        (High, true, Low, [High, High], (true, false, true)),
        (Low, true, High, [Low, High], (false, true, false)),
        (Low, false, Low, [High, Low], (true, false, false)),
        (High, false, Low, [Low, Low], (false, false, false)),
    ] {
        let said = panel(reads(enable), level, reads(stop), ready.map(reads));
        assert_eq!((said.enable, said.stop, said.ready, said.supply), (expected.0, expected.1, expected.2, None));
    }
}

#[test]
fn a_pin_that_cannot_be_read_is_a_broken_wire() {
    let broken = |level| Pin::new(&[PinStep::get(level).with_error(fails())]);
    for level in [true, false] {
        let pressed = if level { State::High } else { State::Low };
        let said = panel(broken(pressed), level, broken(State::Low), [broken(State::High), reads(State::High)]);
        assert_eq!((said.enable, said.stop, said.ready), (false, true, false));
    }
}

/// An amplifier whose set-point and enable take these steps.
fn amplifier(widths: &[u16], enables: &[PinStep]) -> SetPointDrive<Width, Pin> {
    let steps: Vec<_> =
        widths.iter().flat_map(|width| [WidthStep::max_duty_cycle(1_000), WidthStep::set_duty_cycle(*width)]).collect();
    SetPointDrive::new(Width::new(&steps), Pin::new(enables), SetPointRange::TEN_TO_NINETY)
}

fn done(amplifier: SetPointDrive<Width, Pin>) {
    let (mut width, mut pin, _) = amplifier.free();
    width.done();
    pin.done();
}

#[test]
fn amplifiers_are_enabled_behind_their_set_points_and_disabled_before_them() {
    let steps = [PinStep::set(State::High), PinStep::set(State::Low)];
    let mut board = Parts {
        counter: Still,
        timer: Still,
        sensors: Counters::new(Three([10, 20, 30]), [5; 3]),
        drives: [amplifier(&[500, 500], &steps), amplifier(&[900, 500], &steps), amplifier(&[100, 500], &steps)],
        lines: Lines {
            enable: OneChannel { pin: reads(State::High), pressed_level: true },
            stop: reads(State::Low),
            ready: [reads(State::High)],
            supply: NoSupply,
        },
        light: Pin::new(&[PinStep::set(State::High), PinStep::set(State::Low)]),
    };
    assert_eq!(board.now(), 7);
    assert_eq!(board.read(), Ok([Counts(10), Counts(20), Counts(30)]));
    assert!(Passive::<3>::panel(&mut board).enable);
    assert_eq!(board.drive([Duty::ZERO, Duty::FULL, Duty(-32_767)]), Ok(()));
    assert_eq!(Passive::<3>::release(&mut board), Ok(()));
    Passive::<3>::show(&mut board, true);
    Passive::<3>::show(&mut board, false);
    board.sensors = Counters::new(Three([10, 20, 30]), [5; 3]);
    board.drives.into_iter().for_each(done);
    board.light.done();
    board.lines.enable.pin.done();
    board.lines.stop.done();
    board.lines.ready.iter_mut().for_each(Pin::done);
}

#[test]
fn whichever_amplifier_fails_the_others_are_told_all_the_same() {
    for broken in 0..3 {
        let steps = |joint: usize| {
            let low = PinStep::set(State::Low);
            vec![if joint == broken { low.with_error(fails()) } else { low }]
        };
        let mut three = [0, 1, 2].map(|joint| amplifier(&[500], &steps(joint)));
        assert_eq!(Drives::<3>::release(&mut three), Err(NotObeyed));
        three.into_iter().for_each(done);
        let mut three = (amplifier(&[500], &steps(0)), amplifier(&[500], &steps(1)), amplifier(&[500], &steps(2)));
        assert_eq!(three.release(), Err(NotObeyed));
        done(three.0);
        done(three.1);
        done(three.2);
    }
}

#[test]
fn bridges_behind_one_enable_line_are_off_before_their_widths_are() {
    // The first command of a bridge is no width; the second turns the pin and gives the magnitude.
    let width = || {
        Width::new(&[
            WidthStep::set_duty_cycle(0),
            WidthStep::max_duty_cycle(1_000),
            WidthStep::set_duty_cycle(1_000),
            WidthStep::set_duty_cycle(0),
        ])
    };
    let mut pins: Vec<(Width, Pin)> = (0..3).map(|_| (width(), Pin::new(&[PinStep::set(State::High)]))).collect();
    let bridges = [0, 1, 2].map(|joint| HBridge::new(pins[joint].0.clone(), pins[joint].1.clone()));
    let mut enable = Pin::new(&[PinStep::set(State::High), PinStep::set(State::High), PinStep::set(State::Low)]);
    let mut all = Switched::new(bridges, enable.clone());
    all.apply([Duty::FULL; 3]).unwrap();
    all.apply([Duty::FULL; 3]).unwrap();
    assert_eq!(Drives::<3>::release(&mut all), Ok(()));
    enable.done();
    pins.iter_mut().for_each(|(width, pin)| {
        width.done();
        pin.done();
    });
}

/// Where its field was aimed.
struct Aimed<'a>(&'a core::cell::Cell<u16>);

impl Drive for Aimed<'_> {
    type Error = core::convert::Infallible;

    fn aim(&mut self, field: Field) {
        self.0.set(field.angle.0);
    }

    fn apply(&mut self, _: Duty) -> Result<(), Self::Error> {
        Ok(())
    }

    fn release(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

#[test]
fn fields_reach_drives_of_three_types_behind_one_enable_line() {
    let aimed = [const { core::cell::Cell::new(0) }; 3];
    let [a, b, c] = &aimed;
    let mut enable = Pin::new(&[]);
    let mut all = Switched::new((Aimed(a), Aimed(b), Aimed(c)), enable.clone());
    all.aim([1, 2, 3].map(|angle| Field::at_rest(ElectricalAngle(angle))));
    assert_eq!(aimed.map(|angle| angle.get()), [1, 2, 3]);
    enable.done();
}

#[test]
fn a_count_that_jumps_is_no_count() {
    let mut counters = Counters::new(Three([0, 0, 0xffff]), [5; 3]);
    use palpate_bench::sensors::Sensors;
    assert_eq!(counters.read(), Ok([Counts(0), Counts(0), Counts(0xffff)]));
    let mut counters = Counters::new(Jumping(0), [5; 3]);
    assert_eq!(counters.read(), Ok([Counts(0); 3]));
    assert_eq!(counters.read(), Err(BadFrame::Jumped));
}

struct Jumping(u32);

impl Readings<3> for Jumping {
    fn readings(&mut self) -> [u32; 3] {
        let now = [0, 0, self.0];
        self.0 += 6;
        now
    }
}

#[test]
fn a_divider_gives_the_supply_of_a_reading() {
    // 24 V through 100 kΩ and 10 kΩ are 2.1818 V: 2,707.4 of 4,095 at 3.3 V.
    let divider = Divider::new(4_095, 3.3, 100e3, 10e3);
    assert!((divider.volts(2_707) - 24.0).abs() < 0.01 && divider.volts(0) == 0.0);
    assert!((divider.volts(4_095) - 36.3).abs() < 1e-3);
}
