//! One tick, from top to bottom.

use super::guard::Moving;
use super::sense::sense;
use super::{Event, Fault, Guard, Phase, SafeOutput, Servo, ServoState, Surface, Tracked as _};
use crate::device::{Counts, Duty, Homing, HomingInput, HomingProgress, Kinematics, ProbePose, VelocityMethod};
use crate::math::Vec3;
use crate::order::{Order, SceneError};
use crate::render::{Motion, Tool, limit};
use crate::track::{Contact, Probe};

/// What a tick starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Input<const JOINTS: usize> {
    /// What the sensors say.
    Sensors {
        /// Encoder counts, one per joint.
        counts: [Counts; JOINTS],
        /// Whether force is asked for.
        enable: bool,
    },
    /// No frame came, or one that belongs to another tick.
    Lost,
    /// A frame came damaged.
    Damaged,
}

/// Joint torques, N·m.
struct Torques<const JOINTS: usize> {
    /// Those of the force that the hand feels.
    felt: [f32; JOINTS],
    /// Those that carry the links.
    weight: [f32; JOINTS],
    /// Whether any may reach the motors.
    live: bool,
}

impl<const JOINTS: usize> Torques<JOINTS> {
    const NONE: Self = Self { felt: [0.0; JOINTS], weight: [0.0; JOINTS], live: false };
}

impl<S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'_, S, K, JOINTS, G> {
    /// Takes note of what happened outside a tick, at any time between two ticks. A fault is latched at once and the
    /// motors are off when this returns: apply [`ServoState::output`].
    pub fn note(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, event: Event) {
        match event {
            Event::LinkAlive => state.link_silence = 0,
            // With homing of its own the loop is homed when that is done.
            Event::Homed => state.homed |= self.homing.is_none(),
            Event::IndexPassed { joint, counts } => {
                if let Some(homing) = &self.homing {
                    homing.pass_index(&mut state.homing, joint, counts);
                }
            }
            Event::HomingRefused => stop(state, Fault::Homing),
            Event::CalibrationRefused => stop(state, Fault::Calibration),
            Event::DriveFault => stop(state, Fault::Drive),
            Event::Stop => stop(state, Fault::Stopped),
            Event::Acknowledged => {
                if state.reset.fault().is_some_and(|fault| state.fault == Some((fault, 0))) {
                    // What was found since is not what somebody has looked at.
                    state.fault = state.later.take().map(|fault| (fault, state.ticks));
                    if state.fault.is_none() {
                        state.phase = Phase::Reset;
                        self.begin_anew(state);
                    }
                }
            }
            Event::Chosen { index } => self.surface.choose(&mut state.witness, index),
            Event::Supply { millivolts } => {
                if let Err(fault) = self.guard.measured(&mut state.guard, millivolts) {
                    stop(state, fault);
                }
            }
            Event::Overrun => {
                state.overran = true;
                state.overruns = state.overruns.saturating_add(1);
                state.overruns_in_a_row = state.overruns_in_a_row.saturating_add(1);
                if state.overruns_in_a_row > self.safety.max_overruns {
                    stop(state, Fault::Overrun);
                }
            }
        }
    }

    /// Does what a host asks for between two ticks, or nothing. It neither drives a motor nor ends a fault: what is
    /// felt of it is felt in the ticks that follow, as far as there is force at all.
    ///
    /// # Errors
    /// What is out of range, or not offered by what is felt.
    pub fn obey(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, order: &Order) -> Result<(), SceneError> {
        self.surface.obey(&mut state.witness, order)
    }

    /// One tick. What the motors get is in the state when it returns: [`ServoState::output`].
    ///
    /// Bounded work: one pose, one evaluation of the patch. No panic. Whatever the input, the duties are finite and in
    /// range; from the tick in which a fault is seen they are safe.
    #[inline]
    pub fn tick(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, input: Input<JOINTS>) {
        self.watch(state);
        let torques = self.feel(state, input);
        let gated = torques.and_then(|Torques { felt, weight, live }| {
            let gated = self.guard.gate(&state.guard, live, &self.device.motors, felt, weight);
            gated.map(|(duties, scale)| (duties, scale, live))
        });
        match gated {
            Ok((duties, scale, live)) => {
                state.duties = self.device.feed(live, duties, self.rates_to_feed(state));
                state.force *= scale;
                self.guard.given(&mut state.guard, &duties);
            }
            Err(fault) => {
                stop(state, fault);
                self.guard.given(&mut state.guard, &[Duty::ZERO; JOINTS]);
            }
        }
        state.ticks = state.ticks.wrapping_add(1);
    }

    /// The joint rates that the drives make up for: none while a field is led. The rotor is to follow it, and a hand
    /// that spins the dial is to get no volts for that.
    #[inline]
    fn rates_to_feed(&self, state: &ServoState<JOINTS, S::Witness, G::State>) -> [f32; JOINTS] {
        let leads = !state.homed && self.homing.as_ref().is_some_and(Homing::leads_fields);
        if leads { [0.0; JOINTS] } else { state.rates }
    }

    /// What the CRC of the tables must be, if they are to be checked and carry one.
    #[inline]
    pub(super) fn expected_crc(&self) -> Option<u32> {
        if self.safety.checks_tables { self.surface.baked_crc() } else { None }
    }

    /// What can be wrong whatever the sensors say.
    #[inline]
    fn watch(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) {
        if !state.overran {
            state.overruns_in_a_row = 0;
        }
        state.overran = false;
        state.link_silence = state.link_silence.saturating_add(1);
        if state.link_silence > self.link_ticks {
            stop(state, Fault::LinkLost);
        }
        if let Err(fault) = self.guard.watch(&mut state.guard) {
            stop(state, fault);
        }
        if let Some(expected) = self.expected_crc()
            && !self.guard.is_busy(&state.guard)
            && !state.table_check.step(self.surface, expected)
        {
            stop(state, Fault::TableCorrupt);
        }
    }

    /// From the input to joint torques.
    #[inline(always)]
    fn feel(
        &self,
        state: &mut ServoState<JOINTS, S::Witness, G::State>,
        input: Input<JOINTS>,
    ) -> Result<Torques<JOINTS>, Fault> {
        let (counts, enable) = match input {
            Input::Sensors { counts, enable } => (counts, enable),
            Input::Lost => return Err(count_lost(state, Fault::FrameLost)),
            Input::Damaged => return Err(count_lost(state, Fault::FrameDamaged)),
        };

        // Counts → joint angles → probe.
        let first = state.counts.is_none();
        let homing = self.homing.as_ref().filter(|_| !state.homed);
        let to_stop = sense(self.device, &self.estimators, self.max_move, homing.is_none(), state, counts)?;
        if let Some(homing) = homing {
            return self.home(homing, state, counts, enable);
        }
        let between = matches!(self.rendering.velocity, VelocityMethod::BetweenCounts);
        let angles = if between { state.believed_angles() } else { state.angles };
        let (pose, weight) = if self.rendering.compensates_gravity {
            self.device.kinematics.held_pose(angles)
        } else {
            (self.device.kinematics.pose(angles), [0.0; JOINTS])
        };
        let probe = pose.position - self.settings.body_origin_m;
        let moved = if first { Vec3::ZERO } else { probe - state.probe };
        let velocity = pose.velocity(state.rates);
        // The sum of all six is finite only where each is.
        if !(probe + velocity).element_sum().is_finite() {
            return Err(if pose.is_reachable() { Fault::NotFinite } else { Fault::Unreachable });
        }
        state.probe = probe;
        state.room = self.device.room(to_stop, &pose);
        if state.phase == Phase::Fault {
            let faults = [state.fault.map(|(fault, _)| fault), state.later];
            // A motor that may push the wrong way would not damp.
            let may =
                faults.iter().flatten().all(|fault| fault.leaves_damping()) && self.guard.share(&state.guard) >= 1.0;
            let live = may && matches!(self.safety.output, SafeOutput::Damping(_));
            state.drives = live;
            return Ok(Torques { felt: self.safe_torques(state, &pose, velocity), live, ..Torques::NONE });
        }
        state.phase = self.next_phase(state, enable);

        // Probe, or the virtual tool it pulls → witness point.
        let held = Tool { position: probe, velocity };
        let pulls = self.rendering.coupling.is_some() && state.phase == Phase::Running;
        let tool = if pulls { state.tool } else { held };
        state.tool.position = tool.position;
        let target = Probe { position: tool.position, velocity: tool.velocity };
        let touched = self.surface.follow(&self.controller, &mut state.witness, target, self.period);
        state.rejected_steps = state.rejected_steps.wrapping_add(u32::from(touched.rejected));
        state.is_too_deep = false;
        if state.witness.contact() == Contact::Touching {
            // A hand goes deep where the force is withheld, and nothing pushes it out.
            let is_given_up = -state.witness.gap() > self.contact_watch.max_depth && !self.guard.is_busy(&state.guard);
            if touched.unexplained || is_given_up {
                self.lose_contact(state)?;
            } else {
                state.is_too_deep = self.surface.is_too_deep(&state.witness);
            }
        }

        // Gap → force → torques.
        let motion = Motion { moved, velocity, rate: self.rate };
        if let Some(passivity) = &self.rendering.passivity {
            passivity.observe(&mut state.energy, state.force, &motion);
        }
        state.fade = self.next_fade(state);
        state.force = self.force(state, tool, touched.normal, &motion);
        let mut felt = pose.torques(state.force);
        if state.phase == Phase::Running {
            let (angles, rates) = (&state.angles, &state.rates);
            let moving = Moving { angles, rates, velocity, pose: &pose };
            self.guard.motion(&mut state.guard, &moving, &mut state.force, &mut felt)?;
        } else {
            self.guard.released(&mut state.guard);
        }
        if let Some(limits) = self.safety.stuck
            && !self.guard.is_busy(&state.guard)
            && state.stillness.is_broken(limits, &self.device.dry_friction_n_m, &counts, &state.angles, &felt)
        {
            return Err(Fault::JointStuck);
        }
        let carried = state.fade * self.guard.share(&state.guard);
        Ok(Torques { felt, weight: weight.map(|torque| torque * carried), live: state.phase == Phase::Running })
    }

    /// A tick of homing: no angle can be believed yet, only how it changes.
    fn home(
        &self,
        homing: &Homing<JOINTS>,
        state: &mut ServoState<JOINTS, S::Witness, G::State>,
        counts: [Counts; JOINTS],
        enable: bool,
    ) -> Result<Torques<JOINTS>, Fault> {
        state.drives = false;
        if state.phase == Phase::Fault {
            return Ok(Torques::NONE);
        }
        state.phase = self.next_phase(state, enable);
        // No motor moves by itself: whoever wants force wants homing.
        if homing.waits_for_enable() && !enable {
            state.homing.pause();
            return Ok(Torques::NONE);
        }
        let input =
            HomingInput { counts: Some(counts), index: [None; JOINTS], rates: state.rates, period: self.period };
        match homing.tick(&mut state.homing, input) {
            HomingProgress::Waiting => {
                state.drives = homing.drives();
                Ok(Torques { felt: state.homing.torques(), live: state.drives, ..Torques::NONE })
            }
            HomingProgress::Refused(_) => Err(Fault::Homing),
            HomingProgress::Done(encoders) => {
                state.homed = true;
                state.angles_at_zero = encoders.map(|encoder| encoder.angle_at_zero_rad);
                // The angles jump.
                self.begin_anew(state);
                Ok(Torques::NONE)
            }
        }
    }

    /// Forgets where the joints were, and how fast.
    fn begin_anew(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) {
        state.counts = None;
        state.rates = [0.0; JOINTS];
        state.velocities = self.estimators.map(|estimator| estimator.start());
    }

    /// At most one step a tick; [`Phase::Fault`] is never left.
    #[inline]
    fn next_phase(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, enable: bool) -> Phase {
        match state.phase {
            Phase::Reset => Phase::Calibrate,
            Phase::Calibrate => {
                state.settled = state.settled.saturating_add(1);
                let checked = self.expected_crc().is_none() || state.table_check.passes > 0;
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
    fn safe_torques(
        &self,
        state: &mut ServoState<JOINTS, S::Witness, G::State>,
        pose: &ProbePose<JOINTS>,
        velocity: Vec3,
    ) -> [f32; JOINTS] {
        state.force = match self.safety.output {
            SafeOutput::Zero => Vec3::ZERO,
            SafeOutput::Damping(damping) => limit::saturated(velocity * -damping, self.penalty.max_force_n),
        };
        pose.torques(state.force)
    }
}

/// Latches a fault; the first one stands, and of the others the gravest is remembered. Motors at zero.
fn stop<W, G, const JOINTS: usize>(state: &mut ServoState<JOINTS, W, G>, fault: Fault) {
    state.phase = Phase::Fault;
    match state.fault {
        None => state.fault = Some((fault, state.ticks)),
        Some((first, _)) if first == fault => {}
        Some(_) => {
            let is_graver = |later: Fault| later.leaves_damping() && !fault.leaves_damping();
            if state.later.is_none_or(is_graver) {
                state.later = Some(fault);
            }
        }
    }
    state.force = Vec3::ZERO;
    state.fade = 0.0;
    state.drives = false;
    state.duties = [Duty::ZERO; JOINTS];
}

fn count_lost<W, G, const JOINTS: usize>(state: &mut ServoState<JOINTS, W, G>, fault: Fault) -> Fault {
    state.frames_lost = state.frames_lost.wrapping_add(1);
    fault
}
