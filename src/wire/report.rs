//! The report of a tick, from the loop's state.

use super::Report;
use super::telemetry::first_three;
use crate::device::Refusal;
use crate::servo::{Remembered, ServoState, Tracked};

impl Report {
    /// The report of a finished tick. `instructions` is the board's count, 0 where it cannot count.
    pub fn new<const JOINTS: usize, W: Tracked, G: Remembered>(
        state: &ServoState<JOINTS, W, G>,
        instructions: u32,
    ) -> Self {
        let (fault, fault_tick) = state.fault().map_or((0, 0), |(fault, tick)| (fault.code(), tick));
        Self {
            tick: state.ticks().wrapping_sub(1),
            duties: first_three(&state.duties()),
            phase: state.phase() as u8,
            fault,
            fault_tick,
            refusal: state.homing().refusal().map_or(0, Refusal::code),
            reset: state.reset() as u8,
            overruns: state.overruns(),
            feature: state.witness().feature(),
            mode: state.witness().witness().mode as u8,
            contact: state.contact() as u8,
            room: (state.workspace_margin() * 100.0) as u8,
            parameters: state.witness().witness().parameters,
            probe: state.probe().to_array(),
            gap: state.gap(),
            force: state.force().to_array(),
            frames_lost: state.frames_lost(),
            rejected_steps: state.rejected_steps(),
            instructions,
            digest: state.digest(),
        }
    }
}
