//! A current amplifier whose set-point is a pulse width or a voltage, with an enable pin.

use super::{Direction, Drive, DriveError, NoPin, SetPointRange, part_of};
use crate::device::Duty;
use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;

/// An amplifier that makes current from a pulse width (or from a voltage: a digital-to-analog converter is a
/// [`SetDutyCycle`] too). Enabled by the first command, disabled by release.
///
/// Two conventions, and **the amplifier must be configured for the one that is sent**:
///
/// | | no current | full | which way |
/// |---|---|---|---|
/// | [`Self::new`] | the middle of the range | its two ends | the set-point itself |
/// | [`Self::with_direction`] | the start of the range | its end | a pin |
///
/// Sent the first and configured for the second, an amplifier gives half its current as soon as it is enabled.
#[derive(Debug)]
pub struct SetPointDrive<W, E, D = NoPin> {
    pulse_width: W,
    enable: E,
    range: SetPointRange,
    direction: Option<Direction<D>>,
    enabled: bool,
}

impl<W: SetDutyCycle, E: OutputPin> SetPointDrive<W, E> {
    /// An amplifier on these pins, enabled by the pin high; the set-point has a sign, and the middle of its range is no
    /// current. Nothing is sent before the first command.
    pub const fn new(pulse_width: W, enable: E, range: SetPointRange) -> Self {
        Self { pulse_width, enable, range, direction: None, enabled: false }
    }
}

impl<W: SetDutyCycle, E: OutputPin, D: OutputPin> SetPointDrive<W, E, D> {
    /// An amplifier whose set-point is a magnitude, none at the start of the range, and whose direction is a pin, high
    /// for positive duty. A reversal first gives no magnitude for `dwell` commands, at least one: make them last two
    /// periods of the pulse width, since the amplifier measures it over one. Neither is the amplifier enabled before.
    pub const fn with_direction(pulse_width: W, enable: E, direction: D, range: SetPointRange, dwell: u8) -> Self {
        Self { pulse_width, enable, range, direction: Some(Direction::new(direction, dwell)), enabled: false }
    }

    /// Gives the pins back: pulse width, enable, direction.
    pub fn free(self) -> (W, E, Option<D>) {
        (self.pulse_width, self.enable, self.direction.map(Direction::free))
    }

    fn send(&mut self, share: u16) -> Result<(), DriveError<W::Error, E::Error>> {
        let most = self.pulse_width.max_duty_cycle();
        self.pulse_width.set_duty_cycle(part_of(share, most)).map_err(DriveError::PulseWidth)
    }

    /// The set-point of a duty; no current while the direction has to turn first. Whether it need not.
    fn set(&mut self, duty: Duty) -> Result<bool, DriveError<W::Error, E::Error>> {
        let Some(direction) = &mut self.direction else { return self.send(self.range.of_signed(duty)).map(|()| true) };
        let pointed = direction.point(duty.0 >= 0);
        let may = if matches!(pointed, Ok(true)) { duty } else { Duty::ZERO };
        self.send(self.range.of_magnitude(may))?;
        pointed.map_err(|_| DriveError::Direction)
    }
}

impl<W: SetDutyCycle, E: OutputPin, D: OutputPin> Drive for SetPointDrive<W, E, D> {
    type Error = DriveError<W::Error, E::Error>;

    fn apply(&mut self, duty: Duty) -> Result<(), Self::Error> {
        let is_there = self.set(duty)?;
        if is_there && !self.enabled {
            // Only now that the set-point is there, and with a direction pin has been none for as long as a turn takes:
            // until its next period the pulse width is whatever it was.
            self.enable.set_high().map_err(DriveError::Pin)?;
            self.enabled = true;
        }
        Ok(())
    }

    fn release(&mut self) -> Result<(), Self::Error> {
        self.enabled = false;
        let pin = self.enable.set_low().map_err(DriveError::Pin);
        let none = match &mut self.direction {
            None => self.range.of_signed(Duty::ZERO),
            Some(direction) => {
                direction.forget();
                self.range.of_magnitude(Duty::ZERO)
            }
        };
        pin.and(self.send(none))
    }
}
