//! The state of a loop, as numbers.

use crate::pointers::Plain;
use palpate_core::device::Refusal;
use palpate_core::servo::{Output, Remembered, ServoState, Tracked};
use palpate_core::wire::Report;

/// The motors' commands.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct MotorOutput {
    pub drives: u32,
    pub duties: [i32; 3],
    pub phase: u32,
    pub fault: u32,
}

impl MotorOutput {
    /// Nothing: where there is no loop, or none that could be asked.
    pub const OFF: Self = Self { drives: 0, duties: [0; 3], phase: 0, fault: 0 };

    /// Of a state.
    pub fn of<const JOINTS: usize, W: Tracked, G: Remembered>(state: &ServoState<JOINTS, W, G>) -> Self {
        let fault = state.fault().map_or(0, |(fault, _)| u32::from(fault.code()));
        let mut output = Self { phase: state.phase() as u32, fault, ..Self::OFF };
        if let Output::Drive(duties) = state.output() {
            output.drives = 1;
            for (place, duty) in output.duties.iter_mut().zip(duties) {
                *place = i32::from(duty.0);
            }
        }
        output
    }
}

/// A loop's state after a tick.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct StateNumbers {
    pub ticks: u32,
    pub phase: u32,
    pub fault: u32,
    pub fault_tick: u32,
    pub contact: u32,
    pub feature: u32,
    pub frames_lost: u32,
    pub overruns: u32,
    pub contacts_lost: u32,
    pub rejected_steps: u32,
    pub refusal: u32,
    pub too_deep: u32,
    pub probe: [f32; 3],
    pub point: [f32; 3],
    pub parameters: [f32; 2],
    pub gap: f32,
    pub force: [f32; 3],
    pub angles: [f32; 3],
    pub rates: [f32; 3],
    pub fade: f32,
    pub room: f32,
    pub digest: u32,
}

// SAFETY: numbers alone.
unsafe impl Plain for StateNumbers {}

impl StateNumbers {
    /// Of a state.
    pub fn of<const JOINTS: usize, W: Tracked, G: Remembered>(state: &ServoState<JOINTS, W, G>) -> Self {
        let (fault, fault_tick) = state.fault().map_or((0, 0), |(fault, tick)| (fault.code(), tick));
        Self {
            ticks: state.ticks(),
            phase: state.phase() as u32,
            fault: u32::from(fault),
            fault_tick,
            contact: state.contact() as u32,
            feature: u32::from(state.witness().feature()),
            frames_lost: state.frames_lost(),
            overruns: state.overruns(),
            contacts_lost: state.contacts_lost(),
            rejected_steps: state.rejected_steps(),
            refusal: state.homing().refusal().map_or(0, |refusal: Refusal| u32::from(refusal.code())),
            too_deep: u32::from(state.is_too_deep()),
            probe: state.probe().to_array(),
            point: state.witness().witness().surface.point.to_array(),
            parameters: state.witness().witness().parameters,
            gap: state.gap(),
            force: state.force().to_array(),
            angles: first_three(state.angles()),
            rates: first_three(state.rates()),
            fade: state.fade(),
            room: state.workspace_margin(),
            digest: state.digest(),
        }
    }
}

fn first_three<const JOINTS: usize>(of_joints: [f32; JOINTS]) -> [f32; 3] {
    let mut three = [0.0; 3];
    for (place, number) in three.iter_mut().zip(of_joints) {
        *place = number;
    }
    three
}

/// A report as the wire has it.
pub fn report<const JOINTS: usize, W: Tracked, G: Remembered>(
    state: &ServoState<JOINTS, W, G>,
    instructions: u32,
) -> Report {
    Report::new(state, instructions)
}
