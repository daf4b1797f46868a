//! The report of a tick, from the loop's state.

use super::Report;
use crate::device::{Duty, Refusal};
use crate::servo::ServoState;

impl Report {
    /// What to say of a tick once it is done. `instructions` is what the board counted, 0 where it cannot.
    pub fn new<const JOINTS: usize>(state: &ServoState<JOINTS>, instructions: u32) -> Self {
        let (fault, fault_tick) = state.fault.map_or((0, 0), |(fault, tick)| (fault.code(), tick));
        let mut duties = [0; 3];
        for (said, Duty(duty)) in duties.iter_mut().zip(state.duties) {
            *said = duty;
        }
        Self {
            tick: state.ticks.wrapping_sub(1),
            duties,
            phase: state.phase as u8,
            fault,
            fault_tick,
            refusal: state.homing.refusal().map_or(0, Refusal::code),
            reset: state.reset as u8,
            overruns: state.overruns,
            mode: state.witness.mode as u8,
            contact: state.contact as u8,
            room: (state.room * 100.0) as u8,
            parameters: state.witness.parameters,
            probe: state.probe.to_array(),
            gap: state.gap,
            force: state.force.to_array(),
            frames_lost: state.frames_lost,
            steps_undone: state.steps_undone,
            instructions,
            digest: state.digest(),
        }
    }
}
