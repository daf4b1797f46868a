//! A current amplifier whose set-point is a pulse width, with an enable pin.

use super::{Drive, DriveError, part_of};
use crate::device::Duty;
use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;
use thiserror::Error;

/// Which pulse widths stand for full current one way and the other, as fractions of 32,767.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SetPointRange {
    full_back: u16,
    full_ahead: u16,
}

/// The set-point's range is empty or outside the pulse width.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a set-point's range must lie between 0 and 1 and not be empty")]
pub struct SetPointRangeError;

impl SetPointRange {
    /// 10 % to 90 %, which Maxon's ESCON amplifiers take as a pulse-width set-point: what lies outside is a broken
    /// wire.
    pub const TEN_TO_NINETY: Self = Self { full_back: 3_277, full_ahead: 29_490 };

    /// A range between two pulse widths, each from 0 to 1. The first stands for full current back; it may be the
    /// larger.
    ///
    /// # Errors
    /// A range that is empty or not within 0 and 1.
    pub const fn try_new(full_back: f32, full_ahead: f32) -> Result<Self, SetPointRangeError> {
        let within = full_back >= 0.0 && full_back <= 1.0 && full_ahead >= 0.0 && full_ahead <= 1.0;
        let range =
            Self { full_back: (full_back * 32_767.0 + 0.5) as u16, full_ahead: (full_ahead * 32_767.0 + 0.5) as u16 };
        if within && range.full_back != range.full_ahead { Ok(range) } else { Err(SetPointRangeError) }
    }

    /// The pulse width of a duty, 0 to 32,767.
    fn pulse_width(self, Duty(duty): Duty) -> u16 {
        let (back, ahead) = (i32::from(self.full_back), i32::from(self.full_ahead));
        let duty = i32::from(duty).max(-32_767);
        // Twice the middle, so that nothing is lost before the one division; largest number 2·10⁹.
        let doubled = (back + ahead) * 32_767 + (ahead - back) * duty;
        u16::try_from((doubled + 32_767) / 65_534).unwrap_or(0)
    }
}

/// An amplifier that makes current from a pulse width. Enabled by the first command, disabled by release.
#[derive(Debug)]
pub struct SetPointDrive<W, P> {
    pulse_width: W,
    enable: P,
    range: SetPointRange,
    enabled: bool,
}

impl<W: SetDutyCycle, P: OutputPin> SetPointDrive<W, P> {
    /// An amplifier on these pins, enabled by the pin high. Nothing is sent before the first command.
    pub const fn new(pulse_width: W, enable: P, range: SetPointRange) -> Self {
        Self { pulse_width, enable, range, enabled: false }
    }

    /// Gives the pins back.
    pub fn free(self) -> (W, P) {
        (self.pulse_width, self.enable)
    }

    fn set(&mut self, duty: Duty) -> Result<(), DriveError<W::Error, P::Error>> {
        let most = self.pulse_width.max_duty_cycle();
        let width = part_of(self.range.pulse_width(duty), most);
        self.pulse_width.set_duty_cycle(width).map_err(DriveError::PulseWidth)
    }
}

impl<W: SetDutyCycle, P: OutputPin> Drive for SetPointDrive<W, P> {
    type Error = DriveError<W::Error, P::Error>;

    fn apply(&mut self, duty: Duty) -> Result<(), Self::Error> {
        self.set(duty)?;
        if !self.enabled {
            // Only now that the set-point is there.
            self.enable.set_high().map_err(DriveError::Pin)?;
            self.enabled = true;
        }
        Ok(())
    }

    fn release(&mut self) -> Result<(), Self::Error> {
        self.enabled = false;
        let pin = self.enable.set_low().map_err(DriveError::Pin);
        let set_point = self.set(Duty::ZERO);
        pin.and(set_point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_is_no_current_and_the_ends_are_full() {
        let range = SetPointRange::TEN_TO_NINETY;
        assert_eq!(SetPointRange::try_new(0.1, 0.9), Ok(range));
        // 0.1, 0.5 and 0.9 of 32,767, to nearest.
        for (duty, width) in
            [(Duty(-32_767), 3_277), (Duty::ZERO, 16_384), (Duty::FULL, 29_490), (Duty(i16::MIN), 3_277)]
        {
            assert_eq!(range.pulse_width(duty), width, "{duty:?}");
        }
        let reversed = SetPointRange::try_new(1.0, 0.0).unwrap();
        assert_eq!([Duty::FULL, Duty(-32_767)].map(|duty| reversed.pulse_width(duty)), [0, 32_767]);
    }

    #[test]
    fn a_range_that_makes_no_sense_is_refused() {
        for (back, ahead) in [(0.5, 0.5), (-0.1, 0.9), (0.1, 1.1), (f32::NAN, 0.9), (0.1, f32::INFINITY)] {
            assert_eq!(SetPointRange::try_new(back, ahead), Err(SetPointRangeError));
        }
    }
}
