//! A bridge with a pulse-width input and a direction pin.

use super::{Direction, Drive, DriveError, part_of};
use crate::device::Duty;
use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;

/// Sign and magnitude: the pin says which way, the pulse width how much. Positive duty is the pin high.
///
/// A pulse width takes effect from its next period on, a pin at once. So a reversal gives a command at no width first,
/// and turns the pin with the next one: no period ever drives the old magnitude the new way. Commands must come no
/// faster than the pulse width's periods; where they do, say how many of them a period lasts ([`Self::dwelling`]).
#[derive(Debug)]
pub struct HBridge<W, P> {
    pulse_width: W,
    direction: Direction<P>,
}

impl<W: SetDutyCycle, P: OutputPin> HBridge<W, P> {
    /// A bridge on these pins. Nothing is sent before the first command.
    pub const fn new(pulse_width: W, direction: P) -> Self {
        Self::dwelling(pulse_width, direction, 1)
    }

    /// The same, which stays at no width for this many commands, at least one, before it turns.
    pub const fn dwelling(pulse_width: W, direction: P, commands: u8) -> Self {
        Self { pulse_width, direction: Direction::new(direction, commands) }
    }

    /// Gives the pins back.
    pub fn free(self) -> (W, P) {
        (self.pulse_width, self.direction.free())
    }
}

impl<W: SetDutyCycle, P: OutputPin> Drive for HBridge<W, P> {
    type Error = DriveError<W::Error, P::Error>;

    fn apply(&mut self, Duty(duty): Duty) -> Result<(), Self::Error> {
        let pointed = self.direction.point(duty >= 0);
        if !matches!(pointed, Ok(true)) {
            self.pulse_width.set_duty_cycle_fully_off().map_err(DriveError::PulseWidth)?;
            return pointed.map(|_| ()).map_err(DriveError::Pin);
        }
        let most = self.pulse_width.max_duty_cycle();
        // −32,768 is no duty of ours, but a number all the same.
        let share = duty.unsigned_abs().min(Duty::FULL.0.unsigned_abs());
        self.pulse_width.set_duty_cycle(part_of(share, most)).map_err(DriveError::PulseWidth)
    }

    fn release(&mut self) -> Result<(), Self::Error> {
        self.direction.forget();
        self.pulse_width.set_duty_cycle_fully_off().map_err(DriveError::PulseWidth)
    }
}
