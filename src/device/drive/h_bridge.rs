//! A bridge with a pulse-width input and a direction pin.

use super::{Drive, DriveError, part_of};
use crate::device::Duty;
use embedded_hal::digital::{OutputPin, PinState};
use embedded_hal::pwm::SetDutyCycle;

/// Sign and magnitude: the pin says which way, the pulse width how much. Positive duty is the pin high.
#[derive(Debug)]
pub struct HBridge<W, P> {
    pulse_width: W,
    direction: P,
    forward: Option<bool>,
}

impl<W: SetDutyCycle, P: OutputPin> HBridge<W, P> {
    /// A bridge on these pins. Nothing is sent before the first command.
    pub const fn new(pulse_width: W, direction: P) -> Self {
        Self { pulse_width, direction, forward: None }
    }

    /// Gives the pins back.
    pub fn free(self) -> (W, P) {
        (self.pulse_width, self.direction)
    }
}

impl<W: SetDutyCycle, P: OutputPin> Drive for HBridge<W, P> {
    type Error = DriveError<W::Error, P::Error>;

    fn apply(&mut self, Duty(duty): Duty) -> Result<(), Self::Error> {
        let forward = duty >= 0;
        if self.forward != Some(forward) {
            // Between the two edges the old magnitude must not push the new way.
            self.forward = None;
            self.pulse_width.set_duty_cycle_fully_off().map_err(DriveError::PulseWidth)?;
            self.direction.set_state(PinState::from(forward)).map_err(DriveError::Pin)?;
            self.forward = Some(forward);
        }
        let most = self.pulse_width.max_duty_cycle();
        // −32,768 is no duty of ours, but a number all the same.
        let share = duty.unsigned_abs().min(Duty::FULL.0.unsigned_abs());
        self.pulse_width.set_duty_cycle(part_of(share, most)).map_err(DriveError::PulseWidth)
    }

    fn release(&mut self) -> Result<(), Self::Error> {
        self.pulse_width.set_duty_cycle_fully_off().map_err(DriveError::PulseWidth)
    }
}
