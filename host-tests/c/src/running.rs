//! A loop that runs, whatever its mechanism and its guard.

use crate::felt::Felt;
use crate::ground::Dialled;
use crate::homing::HomingNumbers;
use crate::state::{MotorOutput, StateNumbers, report};
use crate::status::Status;
use palpate_core::device::{Counts, Kinematics};
use palpate_core::field::MAX_MODES;
use palpate_core::servo::{
    DialState, Event, Guard, Input, Knob, KnobWitness, ResetReason, Servo, ServoState, Surface, Tracked as _,
};
use palpate_core::wire::Report;

/// A loop and its state.
pub struct Loop<K: 'static, const JOINTS: usize, G: Guard<JOINTS>, S: Surface + 'static> {
    /// The loop.
    pub servo: Servo<'static, Felt<S>, K, JOINTS, G>,
    /// Its state.
    pub state: ServoState<JOINTS, S::Witness, G::State>,
    /// Why the chip was reset.
    pub reset: ResetReason,
}

/// The sensors' values, or that there are none in this tick.
#[derive(Clone, Copy)]
pub enum Sensed<'a> {
    Counts { counts: &'a [i32], enable: bool },
    Lost,
    Damaged,
}

/// A loop, whatever its mechanism.
pub trait Running {
    /// One tick; refused, with nothing done, for counts of other joints than there are.
    fn tick(&mut self, sensed: Sensed<'_>) -> Result<(), Status>;
    /// Has it find out where its joints are; refused, with nothing done, after its first tick.
    fn home(&mut self, homing: &HomingNumbers) -> Result<(), Status>;
    /// How many joints it has.
    fn joints(&self) -> usize;
    /// Records an event between two ticks.
    fn note(&mut self, event: Event);
    /// The motors' commands.
    fn output(&self) -> MotorOutput;
    /// The whole state, as numbers.
    fn state(&self) -> StateNumbers;
    /// `q` of each mode, metres, of a body that has any.
    fn modes(&self) -> Option<[f32; MAX_MODES]>;
    /// The dial and its state, of a loop that renders one.
    fn dial(&mut self) -> Option<(&Knob, &mut KnobWitness)>;
    /// Where that dial is.
    fn turned(&mut self) -> Option<DialState>;
    /// The state for the wire.
    fn report(&self, instructions: u32) -> Report;
}

impl<K, const JOINTS: usize, G, S> Running for Loop<K, JOINTS, G, S>
where
    K: Kinematics<JOINTS> + Copy,
    G: Guard<JOINTS> + Copy,
    S: Dialled,
{
    fn tick(&mut self, sensed: Sensed<'_>) -> Result<(), Status> {
        let input = match sensed {
            Sensed::Counts { counts, enable } => {
                let counts: [i32; JOINTS] = counts.try_into().map_err(|_| Status::OutOfRange)?;
                Input::Sensors { counts: counts.map(Counts), enable }
            }
            Sensed::Lost => Input::Lost,
            Sensed::Damaged => Input::Damaged,
        };
        // The caller reads it from the state.
        let _ = self.servo.tick(&mut self.state, input);
        Ok(())
    }

    fn home(&mut self, homing: &HomingNumbers) -> Result<(), Status> {
        if self.state.ticks() > 0 {
            return Err(Status::HomingStarted);
        }
        self.servo = self.servo.with_homing(homing.homing(self.servo.device().encoders)?);
        let own = self.dial().and_then(|(_, state)| state.own().copied());
        self.state = self.servo.start_after(self.reset);
        if let (Some(own), Some((knob, state))) = (own, self.dial()) {
            knob.restore(state, own)?;
        }
        Ok(())
    }

    fn joints(&self) -> usize {
        JOINTS
    }

    fn note(&mut self, event: Event) {
        self.servo.note(&mut self.state, event);
    }

    fn output(&self) -> MotorOutput {
        MotorOutput::of(&self.state)
    }

    fn state(&self) -> StateNumbers {
        StateNumbers::of(&self.state)
    }

    fn modes(&self) -> Option<[f32; MAX_MODES]> {
        self.state.witness().modes()
    }

    fn dial(&mut self) -> Option<(&Knob, &mut KnobWitness)> {
        self.servo.surface().0.dial(self.state.witness_mut())
    }

    fn turned(&mut self) -> Option<DialState> {
        let (angle, phase) = (*self.state.angles().first()?, self.state.phase());
        let (knob, state) = self.dial()?;
        Some(knob.dial(state, angle, phase))
    }

    fn report(&self, instructions: u32) -> Report {
        report(&self.state, instructions)
    }
}
