//! One tick, from top to bottom.

use super::gate::gate;
use super::sense::sense;
use super::{Event, Fault, Phase, SafeOutput, Servo, ServoState};
use crate::device::{Counts, Duty, Kinematics, ProbePose};
use crate::math::Vec3;
use crate::patch::Patch;
use crate::render::{Motion, Tool, limit};
use crate::track::{Outcome, Probe};

/// What a tick starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Input<const JOINTS: usize> {
    /// The sensors' word.
    Sensors {
        /// Encoder counts, one a joint.
        counts: [Counts; JOINTS],
        /// Whether force is asked for.
        enable: bool,
    },
    /// No frame came, or one for another tick.
    Lost,
    /// A frame came damaged.
    Damaged,
}

impl<P: Patch, K: Kinematics<JOINTS>, const JOINTS: usize> Servo<'_, P, K, JOINTS> {
    /// Takes note of what happened outside a tick, at any time between two ticks. A fault is latched at once and the
    /// duties in the state are zero when this returns: apply them.
    pub fn note(&self, state: &mut ServoState<JOINTS>, event: Event) {
        match event {
            Event::LinkAlive => state.link_silence = 0,
            Event::Homed => state.homed = true,
            Event::HomingRefused => stop(state, Fault::Homing),
            Event::DriveFault => stop(state, Fault::Drive),
            Event::Stop => stop(state, Fault::Stopped),
            Event::Overrun => {
                state.overran = true;
                state.overruns = state.overruns.saturating_add(1);
                state.overruns_in_a_row = state.overruns_in_a_row.saturating_add(1);
                if state.overruns_in_a_row > self.safety.overruns_allowed {
                    stop(state, Fault::Overrun);
                }
            }
        }
    }

    /// One tick. The duties to apply are in the state when it returns.
    ///
    /// Bounded work: one pose, one evaluation of the patch. No panic. Whatever the input, the duties are finite and in
    /// range; from the tick in which a fault is seen they are safe.
    #[inline]
    pub fn tick(&self, state: &mut ServoState<JOINTS>, input: Input<JOINTS>) {
        self.watch(state);
        let torques = self.feel(state, input);
        let damps = matches!(self.safety.output, SafeOutput::Damping(_)) && state.phase == Phase::Fault;
        let live = state.phase == Phase::Running || damps;
        match torques.and_then(|torques| gate(live, &self.device.motors, torques)) {
            Ok((duties, scale)) => {
                state.duties = self.device.feed(live, duties, state.rates);
                state.force *= scale;
            }
            Err(fault) => stop(state, fault),
        }
        state.ticks = state.ticks.wrapping_add(1);
    }

    /// What can be wrong whatever the sensors say.
    #[inline]
    fn watch(&self, state: &mut ServoState<JOINTS>) {
        if !state.overran {
            state.overruns_in_a_row = 0;
        }
        state.overran = false;
        state.link_silence = state.link_silence.saturating_add(1);
        if state.link_silence > self.link_ticks {
            stop(state, Fault::LinkLost);
        }
        if let Some(expected) = self.safety.table_crc
            && !state.table_check.step(self.patch, expected)
        {
            stop(state, Fault::TableCorrupt);
        }
    }

    /// From the input to joint torques, N·m.
    #[inline]
    fn feel(&self, state: &mut ServoState<JOINTS>, input: Input<JOINTS>) -> Result<[f32; JOINTS], Fault> {
        let (counts, enable) = match input {
            Input::Sensors { counts, enable } => (counts, enable),
            Input::Lost => return Err(count_lost(state, Fault::FrameLost)),
            Input::Damaged => return Err(count_lost(state, Fault::FrameDamaged)),
        };

        // Counts → joint angles → probe.
        let first = state.counts.is_none();
        sense(self.device, &self.estimators, self.greatest_move, self.safety.stuck, state, counts)?;
        let pose = self.device.kinematics.pose(state.angles);
        let probe = pose.position - self.settings.body_origin;
        let moved = if first { Vec3::ZERO } else { probe - state.probe };
        let velocity = pose.velocity(state.rates);
        if !(probe.is_finite() && velocity.is_finite()) {
            return Err(Fault::NotFinite);
        }
        state.probe = probe;
        if state.phase == Phase::Fault {
            return Ok(self.safe_torques(state, &pose, velocity));
        }
        state.phase = self.next_phase(state, enable);

        // Probe, or the virtual tool it pulls → witness point.
        let held = Tool { position: probe, velocity };
        let pulls = self.rendering.coupling.is_some() && state.phase == Phase::Running;
        let tool = if pulls { state.tool } else { held };
        state.tool = tool;
        let target = Probe { position: tool.position, velocity: tool.velocity };
        let step = self.controller.step(self.patch, &mut state.witness, target, self.period);
        state.steps_undone = state.steps_undone.wrapping_add(u32::from(step.outcome == Outcome::Undone));

        // Witness point → gap → force → torques.
        let normal = state.witness.normal(self.patch).unwrap_or(Vec3::ZERO);
        state.gap = (tool.position - state.witness.surface.point).dot(normal);
        state.contact = state.contact.next(state.gap, state.witness.mode);
        state.fade = self.next_fade(state);
        let motion = Motion { moved, velocity, rate: self.rate };
        if let Some(passivity) = &self.rendering.passivity {
            passivity.observe(&mut state.energy, state.force, &motion);
        }
        state.force = self.force(state, tool, normal, &motion);
        Ok(pose.torques(state.force))
    }

    /// At most one step a tick; [`Phase::Fault`] is never left.
    #[inline]
    fn next_phase(&self, state: &mut ServoState<JOINTS>, enable: bool) -> Phase {
        match state.phase {
            Phase::Reset => Phase::Calibrate,
            Phase::Calibrate => {
                state.settled = state.settled.saturating_add(1);
                let checked = self.safety.table_crc.is_none() || state.table_check.passes > 0;
                let ready = state.settled >= self.safety.settle_ticks && state.homed && checked;
                if ready { Phase::Armed } else { Phase::Calibrate }
            }
            Phase::Armed | Phase::Running => {
                if enable {
                    Phase::Running
                } else {
                    Phase::Armed
                }
            }
            Phase::Fault => Phase::Fault,
        }
    }

    /// What the motors do after a fault, in a tick whose sensors can be believed.
    #[inline]
    fn safe_torques(&self, state: &mut ServoState<JOINTS>, pose: &ProbePose<JOINTS>, velocity: Vec3) -> [f32; JOINTS] {
        state.force = match self.safety.output {
            SafeOutput::Zero => Vec3::ZERO,
            SafeOutput::Damping(damping) => limit::saturated(velocity * -damping, self.penalty.greatest_force),
        };
        pose.torques(state.force)
    }
}

/// Latches a fault; the first one stands. Motors at zero.
fn stop<const JOINTS: usize>(state: &mut ServoState<JOINTS>, fault: Fault) {
    state.phase = Phase::Fault;
    state.fault = state.fault.or(Some((fault, state.ticks)));
    state.force = Vec3::ZERO;
    state.fade = 0.0;
    state.duties = [Duty::ZERO; JOINTS];
}

fn count_lost<const JOINTS: usize>(state: &mut ServoState<JOINTS>, fault: Fault) -> Fault {
    state.frames_lost = state.frames_lost.wrapping_add(1);
    fault
}
