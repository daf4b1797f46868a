//! What the stage of three half-bridges does to its outputs, and in which order.

use embedded_hal::digital::{self, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use palpate::device::drive::{Drive, DriveError, Field, Modulation, ThreePhase};
use palpate::device::{Duty, ElectricalAngle};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

const MOST: u16 = 1_000;
const MODULATION: Modulation = Modulation::IDEAL;

/// What was written to which output: a width, or 1 and 0 for a pin.
type Log = Rc<RefCell<Vec<(char, u16)>>>;

/// An output that writes down what it is given, and fails at the writes for which that was asked.
#[derive(Debug)]
struct Written {
    name: char,
    log: Log,
    /// Of each write whether it fails; none of those behind.
    fails: VecDeque<bool>,
}

#[derive(Debug)]
struct Broken;

impl digital::Error for Broken {
    fn kind(&self) -> digital::ErrorKind {
        digital::ErrorKind::Other
    }
}

impl pwm::Error for Broken {
    fn kind(&self) -> pwm::ErrorKind {
        pwm::ErrorKind::Other
    }
}

impl digital::ErrorType for Written {
    type Error = Broken;
}

impl pwm::ErrorType for Written {
    type Error = Broken;
}

impl Written {
    fn write(&mut self, value: u16) -> Result<(), Broken> {
        self.log.borrow_mut().push((self.name, value));
        if self.fails.pop_front().unwrap_or(false) { Err(Broken) } else { Ok(()) }
    }
}

impl OutputPin for Written {
    fn set_low(&mut self) -> Result<(), Broken> {
        self.write(0)
    }

    fn set_high(&mut self) -> Result<(), Broken> {
        self.write(1)
    }
}

impl SetDutyCycle for Written {
    fn max_duty_cycle(&self) -> u16 {
        MOST
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Broken> {
        self.write(duty)
    }
}

type Stage = ThreePhase<Written, Written, Written, Written>;

/// A stage whose output `bad` fails at these writes.
fn stage(bad: char, fails: &[bool]) -> (Stage, Log) {
    let log = Log::default();
    let output = |name: char| Written {
        name,
        log: log.clone(),
        fails: if name == bad { fails.iter().copied().collect() } else { VecDeque::new() },
    };
    (ThreePhase::new((output('a'), output('b'), output('c')), output('e'), MODULATION), log)
}

fn said(log: &Log) -> Vec<(char, u16)> {
    std::mem::take(&mut log.borrow_mut())
}

/// The widths of a field, in the order in which they are written.
fn widths(angle: ElectricalAngle, duty: Duty) -> [(char, u16); 3] {
    let [a, b, c] =
        MODULATION.widths(Field::at_rest(angle), duty).map(|width| (width * f32::from(MOST)).round() as u16);
    [('a', a), ('b', b), ('c', c)]
}

const ANGLE: ElectricalAngle = ElectricalAngle(9_000);
const OFF: [(char, u16); 3] = [('a', 0), ('b', 0), ('c', 0)];

#[test]
fn a_stage_is_enabled_only_once_all_its_widths_are_there_and_disabled_before_they_go() {
    let (mut stage, log) = stage(' ', &[]);
    stage.aim(Field::at_rest(ANGLE));
    assert!(said(&log).is_empty(), "an aim drives nothing");
    stage.apply(Duty(12_000)).unwrap();
    assert_eq!(said(&log), [&widths(ANGLE, Duty(12_000))[..], &[('e', 1)]].concat());
    // It stays enabled, and the field turns on.
    stage.aim(Field::at_rest(ElectricalAngle(20_000)));
    stage.apply(Duty(-32_767)).unwrap();
    assert_eq!(said(&log), widths(ElectricalAngle(20_000), Duty(-32_767)));
    stage.release().unwrap();
    assert_eq!(said(&log), [&[('e', 0)], &OFF[..]].concat());
    // Anew: an aim, widths, and only then the pin.
    stage.aim(Field::at_rest(ANGLE));
    stage.apply(Duty::ZERO).unwrap();
    assert_eq!(said(&log), [&widths(ANGLE, Duty::ZERO)[..], &[('e', 1)]].concat());
}

#[test]
fn without_an_aim_a_command_is_refused_and_nothing_is_written() {
    let (mut stage, log) = stage(' ', &[]);
    assert!(matches!(stage.apply(Duty::FULL), Err(DriveError::Direction)));
    assert!(said(&log).is_empty());
    stage.aim(Field::at_rest(ANGLE));
    stage.apply(Duty::FULL).unwrap();
    stage.release().unwrap();
    said(&log);
    // The aim of before is not believed after a release: the rotor may be anywhere.
    assert!(matches!(stage.apply(Duty::FULL), Err(DriveError::Direction)));
    assert!(said(&log).is_empty());
}

#[test]
fn a_stage_whose_width_fails_writes_the_others_and_is_not_enabled() {
    for bad in ['a', 'b', 'c'] {
        let (mut stage, log) = stage(bad, &[true]);
        stage.aim(Field::at_rest(ANGLE));
        assert!(matches!(stage.apply(Duty(12_000)), Err(DriveError::PulseWidth(()))), "{bad}");
        assert_eq!(said(&log), widths(ANGLE, Duty(12_000)), "{bad}");
        stage.apply(Duty(12_000)).unwrap();
        assert_eq!(said(&log).last(), Some(&('e', 1)), "{bad}");
    }
}

#[test]
fn a_stage_whose_pin_fails_says_so_and_tries_again() {
    let (mut stage, log) = stage('e', &[true, false, true, false]);
    stage.aim(Field::at_rest(ANGLE));
    for is_enabled in [false, true] {
        assert_eq!(stage.apply(Duty(12_000)).is_ok(), is_enabled);
        assert_eq!(said(&log).last(), Some(&('e', 1)));
    }
    // What is to be off gets no width even where the pin fails, and both are said again with the next release.
    for is_off in [false, true] {
        assert_eq!(matches!(stage.release(), Err(DriveError::Pin(()))), !is_off);
        assert_eq!(said(&log), [&[('e', 0)], &OFF[..]].concat());
    }
}

#[test]
fn a_release_writes_every_width_and_the_pin_even_if_one_fails() {
    for bad in ['a', 'b', 'c'] {
        let (mut stage, log) = stage(bad, &[false, true]);
        stage.aim(Field::at_rest(ANGLE));
        stage.apply(Duty(12_000)).unwrap();
        said(&log);
        assert!(matches!(stage.release(), Err(DriveError::PulseWidth(()))), "{bad}");
        assert_eq!(said(&log), [&[('e', 0)], &OFF[..]].concat(), "{bad}");
    }
}
