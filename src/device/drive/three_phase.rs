//! A stage of three half-bridges with a pulse-width input each.

use super::{Drive, DriveError, Field, Modulation, part_of};
use crate::device::Duty;
use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;

/// Three half-bridges, each with a pulse width for its upper switch, behind a pin that enables them, high: DRV8313,
/// L6234, and gate drivers of their kind.
///
/// The stage applies the voltage of a [`super::VoltageFeed`] ([`super::VoltageFeed::three_phase`]) in the
/// field of the last [`Drive::aim`].
#[derive(Debug)]
pub struct ThreePhase<A, B, C, E> {
    widths: (A, B, C),
    enable: E,
    modulation: Modulation,
    aim: Option<Field>,
    enabled: bool,
}

impl<A: SetDutyCycle, B: SetDutyCycle, C: SetDutyCycle, E: OutputPin> ThreePhase<A, B, C, E> {
    /// A stage on these pins. Nothing is sent before the first command.
    pub const fn new(widths: (A, B, C), enable: E, modulation: Modulation) -> Self {
        Self { widths, enable, modulation, aim: None, enabled: false }
    }

    /// Gives the pins back.
    pub fn free(self) -> ((A, B, C), E) {
        (self.widths, self.enable)
    }

    /// Sets all three widths, even after one failed; true if none failed.
    fn send(&mut self, [a, b, c]: [f32; 3]) -> bool {
        fn set<W: SetDutyCycle>(output: &mut W, width: f32) -> bool {
            // At most 32,767, for a width is at most 1; the cast saturates.
            output.set_duty_cycle(part_of((width * 32_767.0 + 0.5) as u16, output.max_duty_cycle())).is_ok()
        }
        set(&mut self.widths.0, a) & set(&mut self.widths.1, b) & set(&mut self.widths.2, c)
    }
}

/// The error of a stage: which output failed.
type StageError = DriveError<(), ()>;

impl<A: SetDutyCycle, B: SetDutyCycle, C: SetDutyCycle, E: OutputPin> Drive for ThreePhase<A, B, C, E> {
    type Error = StageError;

    fn aim(&mut self, field: Field) {
        self.aim = Some(field);
    }

    /// A stage without a field takes no duty.
    fn apply(&mut self, duty: Duty) -> Result<(), StageError> {
        let Some(field) = self.aim else { return Err(DriveError::Direction) };
        let widths = self.modulation.widths(field, duty);
        if !self.send(widths) {
            return Err(DriveError::PulseWidth(()));
        }
        if !self.enabled {
            // Only now that the widths are there.
            self.enable.set_high().map_err(|_| DriveError::Pin(()))?;
            self.enabled = true;
        }
        Ok(())
    }

    /// The enable pin first, then the widths at zero: if the pin fails, the lower switches brake the motor.
    fn release(&mut self) -> Result<(), StageError> {
        self.enabled = false;
        self.aim = None;
        let pin = self.enable.set_low().map_err(|_| DriveError::Pin(()));
        let sent = if self.send([0.0; 3]) { Ok(()) } else { Err(DriveError::PulseWidth(())) };
        pin.and(sent)
    }
}
