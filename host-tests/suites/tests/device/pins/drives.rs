//! What the drives do to their pins, and in which order.

use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as PinStep};
use embedded_hal_mock::eh1::pwm::{Mock as PulseWidth, Transaction as WidthStep};
use palpate::device::Duty;
use palpate::device::drive::{Drive, DriveError, HBridge, SetPointDrive, SetPointRange};
use std::io::ErrorKind;

const MOST: u16 = 1_000;

/// A pulse width that is set to these values; each but an off asks for the full scale first.
fn widths(values: &[u16], offs: &[usize]) -> PulseWidth {
    let mut steps = Vec::new();
    for (index, value) in values.iter().enumerate() {
        if !offs.contains(&index) {
            steps.push(WidthStep::max_duty_cycle(MOST));
        }
        steps.push(WidthStep::set_duty_cycle(*value));
    }
    PulseWidth::new(&steps)
}

fn pin(states: &[State]) -> Pin {
    Pin::new(&states.iter().map(|state| PinStep::set(*state)).collect::<Vec<_>>())
}

#[test]
fn a_reversal_never_drives_the_old_magnitude_the_new_way() {
    // A width takes effect from its next period on. So a command at no width comes before the pin turns, at the start
    // and wherever the sign changes; the pin turns with the next command, and only then is there a width.
    let mut bridge = HBridge::new(
        widths(&[0, 500, 1_000, 0, 1_000, 1_000, 0, 0, 0], &[0, 3, 6, 8]),
        pin(&[State::High, State::Low, State::High]),
    );
    for duty in [16_384, 16_384, 32_767, -16_384, -32_767, i16::MIN, 0, 0] {
        bridge.apply(Duty(duty)).unwrap();
    }
    bridge.release().unwrap();
    let (mut width, mut pin) = bridge.free();
    width.done();
    pin.done();
}

#[test]
fn a_bridge_whose_pulse_width_is_slower_than_its_commands_stays_off_for_as_many() {
    let mut bridge = HBridge::dwelling(widths(&[0, 0, 0, 1_000, 0, 1_000], &[0, 1, 2, 4]), pin(&[State::High]), 3);
    // A sign that changes to and fro within the dwell finds the pin as it was.
    for duty in [32_767, 32_767, 32_767, 32_767, -1, 32_767] {
        bridge.apply(Duty(duty)).unwrap();
    }
    let (mut width, mut pin) = bridge.free();
    width.done();
    pin.done();
}

#[test]
fn a_bridge_whose_pin_fails_stays_off_and_tries_again() {
    let steps =
        [PinStep::set(State::High).with_error(MockError::Io(ErrorKind::NotConnected)), PinStep::set(State::High)];
    let mut bridge = HBridge::new(widths(&[0, 0, 500], &[0, 1]), Pin::new(&steps));
    bridge.apply(Duty(16_384)).unwrap();
    assert!(matches!(bridge.apply(Duty(16_384)), Err(DriveError::Pin(_))));
    bridge.apply(Duty(16_384)).unwrap();
    let (mut width, mut pin) = bridge.free();
    width.done();
    pin.done();
}

#[test]
fn a_set_point_with_a_direction_pin_is_none_at_ten_percent_and_turns_only_there() {
    // WoodenHaptics' own convention: 10 % is no current and 90 % full, whichever way the pin says. Two commands of
    // none before each turn; released: enable first, then none.
    let mut amplifier = SetPointDrive::with_direction(
        widths(&[100, 100, 900, 500, 100, 100, 500, 100], &[]),
        pin(&[State::High, State::Low]),
        pin(&[State::High, State::Low]),
        SetPointRange::TEN_TO_NINETY,
        2,
    );
    for duty in [32_767, 32_767, 32_767, 16_384, -16_384, -16_384, -16_384] {
        amplifier.apply(Duty(duty)).unwrap();
    }
    amplifier.release().unwrap();
    let (mut width, mut enable, direction) = amplifier.free();
    width.done();
    enable.done();
    direction.unwrap().done();
}

#[test]
fn an_amplifier_with_a_direction_pin_is_enabled_once_none_was_sent_for_as_long_as_a_turn_takes() {
    // Its width may still be an old one: what is sent holds from the next period on. None for two commands, twice, for
    // what is released begins anew; a release disables whatever was not enabled too.
    let mut amplifier = SetPointDrive::with_direction(
        widths(&[100, 100, 100, 100, 100, 900], &[]),
        pin(&[State::Low, State::High]),
        pin(&[State::High]),
        SetPointRange::TEN_TO_NINETY,
        2,
    );
    amplifier.apply(Duty::FULL).unwrap();
    amplifier.apply(Duty::FULL).unwrap();
    amplifier.release().unwrap();
    for _ in 0..3 {
        amplifier.apply(Duty::FULL).unwrap();
    }
    let (mut width, mut enable, direction) = amplifier.free();
    width.done();
    enable.done();
    direction.unwrap().done();
}

#[test]
fn a_set_point_is_there_before_the_amplifier_is_enabled_and_in_the_middle_after() {
    // 10 %, 50 % and 90 % of 1,000, and half way; released: pin first, then no current.
    let mut amplifier = SetPointDrive::new(
        widths(&[500, 900, 100, 700, 500, 900], &[]),
        pin(&[State::High, State::Low, State::High]),
        SetPointRange::TEN_TO_NINETY,
    );
    for duty in [Duty::ZERO, Duty::FULL, Duty(-32_767), Duty(16_384)] {
        amplifier.apply(duty).unwrap();
    }
    amplifier.release().unwrap();
    amplifier.apply(Duty::FULL).unwrap();
    let (mut width, mut pin, _) = amplifier.free();
    width.done();
    pin.done();
}

#[test]
fn a_release_tries_the_set_point_even_if_the_pin_fails() {
    let pin = Pin::new(&[PinStep::set(State::Low).with_error(MockError::Io(ErrorKind::NotConnected))]);
    let mut amplifier = SetPointDrive::new(widths(&[500], &[]), pin, SetPointRange::TEN_TO_NINETY);
    assert!(matches!(amplifier.release(), Err(DriveError::Pin(_))));
    let (mut width, mut pin, _) = amplifier.free();
    width.done();
    pin.done();
}
