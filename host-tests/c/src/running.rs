//! A loop that runs, whatever its mechanism and its guard.

use crate::felt::Felt;
use crate::state::{MotorOutput, StateNumbers, report};
use crate::status::Status;
use palpate_core::body::BodyWitness;
use palpate_core::device::{Counts, Kinematics};
use palpate_core::servo::{Event, Guard, Input, Servo, ServoState};
use palpate_core::wire::Report;

/// A loop and its state.
pub struct Loop<K: 'static, const JOINTS: usize, G: Guard<JOINTS>> {
    /// The loop.
    pub servo: Servo<'static, Felt, K, JOINTS, G>,
    /// What it remembers.
    pub state: ServoState<JOINTS, BodyWitness, G::State>,
}

/// What the sensors say, or that they say nothing.
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
    /// What happened between two ticks.
    fn note(&mut self, event: Event);
    /// What the motors get.
    fn output(&self) -> MotorOutput;
    /// All that is told.
    fn state(&self) -> StateNumbers;
    /// The same for the wire.
    fn report(&self, instructions: u32) -> Report;
}

impl<K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Running for Loop<K, JOINTS, G> {
    fn tick(&mut self, sensed: Sensed<'_>) -> Result<(), Status> {
        let input = match sensed {
            Sensed::Counts { counts, enable } => {
                let counts: [i32; JOINTS] = counts.try_into().map_err(|_| Status::OutOfRange)?;
                Input::Sensors { counts: counts.map(Counts), enable }
            }
            Sensed::Lost => Input::Lost,
            Sensed::Damaged => Input::Damaged,
        };
        self.servo.tick(&mut self.state, input);
        Ok(())
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

    fn report(&self, instructions: u32) -> Report {
        report(&self.state, instructions)
    }
}
