//! One tick, from top to bottom.

use super::sense::{Sensed, sense};
use super::{
    Event, Fault, Guard, Motion, Output, Phase, SafeOutput, Servo, ServoState, Surface, TableCheck, Tracked as _,
};
use crate::device::drive::Field;
use crate::device::{
    Counts, Duty, Encoder, Homing, HomingInput, HomingProgress, Kinematics, Mount, ProbePose, VelocityMethod, Wrist,
    WristError, WristState,
};
use crate::math::Vec3;
use crate::render::{Moved, Tool, limit};
use crate::track::{Contact, Probe};

/// The input of a tick.
///
/// ```
/// use palpate::device::Counts;
/// use palpate::servo::Input;
///
/// /// `frame`: the sensors' answer, or whether it came at all.
/// fn input(frame: Result<[i32; 3], bool>, enable: bool) -> Input<3> {
///     match frame {
///         Ok(counts) => Input::Sensors { counts: counts.map(Counts), enable },
///         Err(true) => Input::Damaged,
///         Err(false) => Input::Lost,
///     }
/// }
/// assert_eq!(input(Err(false), true), Input::Lost);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Input<const JOINTS: usize> {
    /// The sensors' readings.
    Sensors {
        /// Encoder counts, one per joint.
        counts: [Counts; JOINTS],
        /// Whether force is requested.
        enable: bool,
    },
    /// No frame came, or one that belongs to another tick.
    Lost,
    /// A frame came damaged.
    Damaged,
    /// A sensor's magnet is too near, too far or gone.
    Magnet,
    /// A sensor repeats the same reading ([`crate::device::sensor::Frozen`]).
    Frozen,
}

/// Joint torques, N·m.
struct Torques<const JOINTS: usize> {
    /// Those of the force that the hand feels.
    felt: [f32; JOINTS],
    /// The torques of gravity compensation.
    weight: [f32; JOINTS],
    /// Whether any may reach the motors.
    live: bool,
}

impl<const JOINTS: usize> Torques<JOINTS> {
    const NONE: Self = Self { felt: [0.0; JOINTS], weight: [0.0; JOINTS], live: false };
}

impl<S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'_, S, K, JOINTS, G> {
    /// Notes the handle's orientation ([`Event::Oriented`]) from the counts of the arm and of the wrist on it. Call it
    /// before each tick, with the arm's counts of that tick.
    ///
    /// # Errors
    /// An axis of the wrist out of its range or too fast: nothing is noted. Contact ends once the last orientation is old.
    pub fn orient(
        &self,
        state: &mut ServoState<JOINTS, S::Witness, G::State>,
        wrist: &Wrist,
        memory: &mut WristState,
        arm: [Counts; JOINTS],
        counts: [Counts; 3],
    ) -> Result<(), WristError>
    where
        K: Mount<JOINTS>,
    {
        let zeros = state.angles_at_zero();
        let angles = core::array::from_fn(|joint| {
            let encoder = self.core.device.encoders[joint];
            Encoder { angle_at_zero_rad: zeros[joint], ..encoder }.angle(arm[joint])
        });
        // An arm that cannot be closed is a fault of the tick itself.
        if let Some(link) = self.core.device.kinematics.last_link(angles) {
            let quaternion = wrist.orientation(memory, link, counts, self.core.period)?;
            self.note(state, Event::Oriented { quaternion });
        }
        Ok(())
    }

    /// Records an event between two ticks. A fault is latched at once and the motors are off when this returns: apply
    /// [`ServoState::output`].
    pub fn note(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, event: Event) {
        match event {
            Event::LinkAlive => state.faults.link_silence = 0,
            // With homing of its own the loop is homed when that is done.
            Event::Homed => state.readiness.homed |= self.core.homing.is_none(),
            Event::IndexPassed { joint, counts } => {
                if let Some(homing) = &self.core.homing {
                    homing.pass_index(&mut state.readiness.homing, joint, counts);
                }
            }
            Event::HomingRefused => stop(state, Fault::Homing),
            Event::CalibrationRefused => stop(state, Fault::Calibration),
            Event::DriveFault => stop(state, Fault::Drive),
            Event::Stop => stop(state, Fault::Stopped),
            Event::Acknowledged => {
                if state.faults.reset.fault().is_some_and(|fault| state.faults.first == Some((fault, 0))) {
                    // The person has not seen the faults that came later.
                    state.faults.first = state.faults.later.take().map(|fault| (fault, state.ticks));
                    if state.faults.first.is_none() {
                        state.phase = Phase::Reset;
                        self.restart_estimators(state);
                    }
                }
            }
            Event::Oriented { quaternion } => self.core.surface.orient(&mut state.contact.witness, quaternion),
            Event::Chosen { index } => self.core.surface.choose(&mut state.contact.witness, index),
            Event::Supply { millivolts } => {
                if self.core.device.needs_supply() {
                    state.drive.supply.measured(millivolts as f32 / 1e3);
                }
                if let Err(fault) = self.guard.measured(&mut state.guard, millivolts) {
                    stop(state, fault);
                }
            }
            Event::Overrun => {
                state.faults.overran = true;
                state.faults.overruns = state.faults.overruns.saturating_add(1);
                state.faults.overruns_in_a_row = state.faults.overruns_in_a_row.saturating_add(1);
                if state.faults.overruns_in_a_row > self.core.safety.max_overruns {
                    stop(state, Fault::Overrun);
                }
            }
        }
    }

    /// One tick. The motors get its output and nothing else; [`ServoState::output`] repeats it.
    ///
    /// Bounded work: one pose, one evaluation of the patch. No panic. For any input the duties are finite and in range;
    /// from the tick in which a fault is detected they are safe.
    #[inline]
    pub fn tick(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, input: Input<JOINTS>) -> Output<JOINTS> {
        self.watch(state);
        state.drive.supply.tick();
        let torques = self.feel(state, input);
        let gated = torques.and_then(|Torques { felt, weight, live }| {
            let gated = self.guard.gate(&state.guard, live, &self.core.device.motors, felt, weight);
            gated.map(|(duties, scale)| (duties, scale, live))
        });
        match gated {
            Ok((duties, scale, live)) => {
                let rates = self.rates_to_feed(state);
                state.drive.duties = self.core.device.feed(live, duties, rates, state.drive.supply);
                if scale < 1.0 {
                    state.drive.force *= scale;
                }
                self.guard.record_output(&mut state.guard, &duties);
            }
            Err(fault) => {
                stop(state, fault);
                self.guard.record_output(&mut state.guard, &[Duty::ZERO; JOINTS]);
            }
        }
        state.ticks = state.ticks.wrapping_add(1);
        state.output()
    }

    /// The field of each motor for the duties that the state now has; `None` for motors that do not have three phases
    /// ([`crate::device::Reference::Fields`]), and before the first good counts.
    #[inline]
    pub fn fields(&self, state: &ServoState<JOINTS, S::Witness, G::State>) -> Option<[Field; JOINTS]> {
        let angles = self.core.homing.as_ref()?.fields(&state.readiness.homing, state.sensors.counts?)?;
        let live = matches!(state.output(), Output::Drive(_));
        // The commands of no torque are for back-EMF alone.
        let rates = self.rates_to_feed(state);
        let back_emf = self.core.device.feed(live, [Duty::ZERO; JOINTS], rates, state.drive.supply);
        Some(core::array::from_fn(|joint| Field { angle: angles[joint], back_emf: back_emf[joint] }))
    }

    /// The joint rates that the drives make up for: none while a field is led. The rotor is to follow it, and a hand
    /// that spins the dial is to get no volts for that. Until the polarity of all motors is confirmed none either: of a
    /// wrong one it would brake the polarity pulses, and they would take long to tell.
    #[inline]
    fn rates_to_feed(&self, state: &ServoState<JOINTS, S::Witness, G::State>) -> [f32; JOINTS] {
        let leads = !state.readiness.homed && self.core.homing.as_ref().is_some_and(Homing::leads_fields);
        let fraction = self.guard.force_fraction(&state.guard);
        if leads {
            [0.0; JOINTS]
        } else if fraction < 1.0 {
            state.sensors.rates.map(|rate| rate * fraction)
        } else {
            state.sensors.rates
        }
    }

    /// The expected CRC of the tables, if they are to be checked and carry one.
    #[inline]
    pub(super) fn expected_crc(&self) -> Option<u32> {
        if self.core.safety.checks_tables { self.core.surface.baked_crc() } else { None }
    }

    /// The checks that need no sensors.
    #[inline]
    fn watch(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) {
        if !state.faults.overran {
            state.faults.overruns_in_a_row = 0;
        }
        state.faults.overran = false;
        state.faults.link_silence = state.faults.link_silence.saturating_add(1);
        if state.faults.link_silence > self.core.link_ticks {
            stop(state, Fault::LinkLost);
        }
        if let Err(fault) = self.guard.watch(&mut state.guard) {
            stop(state, fault);
        }
        if let Some(expected) = self.expected_crc()
            && state.ticks.is_multiple_of(TableCheck::EVERY)
            && !self.guard.withholds_force(&state.guard)
            && !state.faults.table_check.step(self.core.surface, expected)
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
            bad => return Err(count_lost(state, bad)),
        };

        // Counts → joint angles → probe.
        let first = state.sensors.counts.is_none();
        let homing = self.core.homing.as_ref().filter(|_| !state.readiness.homed);
        let sensors = &mut state.sensors;
        let core = &self.core;
        let placed = homing.is_none();
        let Sensed { to_stop, turned } =
            sense(core.device, &core.estimators, core.max_move, core.per_turn, placed, sensors, counts)?;
        if turned {
            self.core.surface.turn(&mut state.contact.witness, state.sensors.turns);
        }
        if let Some(homing) = homing {
            return self.home(homing, state, counts, enable);
        }
        let between = matches!(self.core.rendering.velocity, VelocityMethod::BetweenCounts);
        let angles = if between { state.sensors.estimated_angles() } else { state.sensors.angles };
        let (pose, weight) = if self.core.rendering.compensates_gravity {
            self.core.device.kinematics.held_pose(angles)
        } else {
            self.core.device.kinematics.pose(angles).map(|pose| (pose, [0.0; JOINTS]))
        }
        .ok_or(Fault::Unreachable)?;
        let probe = pose.position - self.core.settings.body_origin_m;
        let velocity = pose.velocity(state.sensors.rates);
        let moved = if first {
            Vec3::ZERO
        } else if turned {
            velocity * self.core.period
        } else {
            probe - state.contact.probe
        };
        // The sum of all six is finite only where each is.
        if !(probe + velocity).element_sum().is_finite() {
            return Err(Fault::NotFinite);
        }
        state.contact.probe = probe;
        state.drive.margin = self.core.device.workspace_margin(to_stop, &pose);
        if state.phase == Phase::Fault {
            self.core.surface.stopped(&mut state.contact.witness, probe);
            let faults = [state.faults.first.map(|(fault, _)| fault), state.faults.later];
            // A motor that may push the wrong way would not damp.
            let may = faults.iter().flatten().all(|fault| fault.leaves_damping())
                && self.guard.force_fraction(&state.guard) >= 1.0;
            let live = may && matches!(self.core.safety.output, SafeOutput::Damping(_));
            state.drive.drives = live;
            return Ok(Torques { felt: self.safe_torques(state, &pose, velocity), live, ..Torques::NONE });
        }
        let phase = self.next_phase(state, enable);
        if phase == Phase::Running && state.phase != Phase::Running {
            self.core.surface.start_force(&mut state.contact.witness);
        }
        state.phase = phase;

        // Probe, or the virtual tool it pulls → witness point.
        let held = Tool { position: probe, velocity };
        let pulls = self.core.rendering.coupling.is_some() && state.phase == Phase::Running;
        let tool = if pulls && !turned { state.contact.tool } else { held };
        state.contact.tool.position = tool.position;
        let target = Probe { position: tool.position, velocity: tool.velocity };
        let touched =
            self.core.surface.follow(&self.core.controller, &mut state.contact.witness, target, self.core.period);
        state.contact.rejected_steps = state.contact.rejected_steps.wrapping_add(u32::from(touched.rejected));
        state.contact.is_too_deep = false;
        if state.contact.witness.contact() == Contact::Touching {
            // A hand goes deep where the force is withheld, and nothing pushes it out.
            let is_given_up = -state.contact.witness.gap() > self.core.contact_watch.max_depth
                && !self.guard.withholds_force(&state.guard);
            if touched.unexplained || is_given_up {
                self.release_contact(state)?;
            } else {
                state.contact.is_too_deep = self.core.surface.is_too_deep(&state.contact.witness);
            }
        }

        // Gap → force → torques.
        let motion = Moved { moved, velocity, rate: self.core.rate };
        if let Some(passivity) = &self.core.rendering.passivity {
            passivity.observe(&mut state.drive.energy, state.drive.force, &motion);
        }
        state.drive.fade = self.next_fade(state);
        let given = state.drive.force;
        state.drive.force = self.force(state, tool, touched.normal, &motion);
        let mut felt = pose.torques(state.drive.force);
        if state.phase == Phase::Running {
            let (angles, rates) = (&state.sensors.angles, &state.sensors.rates);
            let moving = Motion { angles, rates, velocity, moved, given, pose: &pose };
            self.guard.limit(&mut state.guard, &moving, &mut state.drive.force, &mut felt)?;
        } else {
            self.guard.force_not_requested(&mut state.guard);
        }
        let ticks = state.ticks;
        if let Some(limits) = self.core.safety.stuck
            && !self.guard.withholds_force(&state.guard)
            && state.sensors.stillness.is_broken(
                limits,
                // In steps of an eighth of a second at most: after twelve days, when the ticks of 4 kHz start again.
                || (ticks as f32 * self.core.period * 64.0) as u32 as u8,
                &self.core.device.dry_friction_n_m,
                &counts,
                probe,
                &felt,
            )
        {
            return Err(Fault::JointStuck);
        }
        let carried = state.drive.fade * self.guard.force_fraction(&state.guard);
        Ok(Torques { felt, weight: weight.map(|torque| torque * carried), live: state.phase == Phase::Running })
    }

    /// A tick of homing: angles are untrusted, only their changes count.
    fn home(
        &self,
        homing: &Homing<JOINTS>,
        state: &mut ServoState<JOINTS, S::Witness, G::State>,
        counts: [Counts; JOINTS],
        enable: bool,
    ) -> Result<Torques<JOINTS>, Fault> {
        state.drive.drives = false;
        if state.phase == Phase::Fault {
            return Ok(Torques::NONE);
        }
        state.phase = self.next_phase(state, enable);
        // Homing that moves motors requires enable: no motor may start on its own.
        if homing.waits_for_enable() && !enable {
            state.readiness.homing.pause();
            return Ok(Torques::NONE);
        }
        let input = HomingInput {
            counts: Some(counts),
            index: [None; JOINTS],
            rates: state.sensors.rates,
            period: self.core.period,
        };
        match homing.tick(&mut state.readiness.homing, input) {
            HomingProgress::Waiting => {
                state.drive.drives = homing.drives();
                Ok(Torques { felt: state.readiness.homing.torques(), live: state.drive.drives, ..Torques::NONE })
            }
            HomingProgress::Refused(_) => Err(Fault::Homing),
            HomingProgress::Done(encoders) => {
                state.readiness.homed = true;
                state.sensors.angles_at_zero = encoders.map(|encoder| encoder.angle_at_zero_rad);
                // The angles jump.
                self.restart_estimators(state);
                Ok(Torques::NONE)
            }
        }
    }

    /// Forgets where the joints were, and how fast.
    fn restart_estimators(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) {
        state.sensors.counts = None;
        state.sensors.rates = [0.0; JOINTS];
        state.sensors.lags = [0.0; JOINTS];
    }

    /// At most one step a tick; [`Phase::Fault`] is never left.
    #[inline]
    fn next_phase(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, enable: bool) -> Phase {
        match state.phase {
            Phase::Reset => Phase::Calibrate,
            Phase::Calibrate => {
                state.readiness.settled = state.readiness.settled.saturating_add(1);
                let checked = self.expected_crc().is_none() || state.faults.table_check.passes > 0;
                let ready =
                    state.readiness.settled >= self.core.safety.settle_ticks && state.readiness.homed && checked;
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

    /// The motors' torques after a fault, in a tick whose sensors are trusted.
    #[inline]
    fn safe_torques(
        &self,
        state: &mut ServoState<JOINTS, S::Witness, G::State>,
        pose: &ProbePose<JOINTS>,
        velocity: Vec3,
    ) -> [f32; JOINTS] {
        state.drive.force = match self.core.safety.output {
            SafeOutput::Zero => Vec3::ZERO,
            SafeOutput::Damping(damping) => limit::saturated(velocity * -damping, self.core.penalty.max_force_n),
        };
        pose.torques(state.drive.force)
    }
}

/// Latches a fault; the first one stands, and of the others the gravest is remembered. Motors at zero.
fn stop<W, G, const JOINTS: usize>(state: &mut ServoState<JOINTS, W, G>, fault: Fault) {
    state.phase = Phase::Fault;
    match state.faults.first {
        None => state.faults.first = Some((fault, state.ticks)),
        Some((first, _)) if first == fault => {}
        Some(_) => {
            let is_graver = |later: Fault| later.leaves_damping() && !fault.leaves_damping();
            if state.faults.later.is_none_or(is_graver) {
                state.faults.later = Some(fault);
            }
        }
    }
    state.drive.force = Vec3::ZERO;
    state.drive.fade = 0.0;
    state.drive.drives = false;
    state.drive.duties = [Duty::ZERO; JOINTS];
}

/// Counts an input without sensors, and names its fault.
#[cold]
#[inline(never)]
fn count_lost<W, G, const JOINTS: usize>(state: &mut ServoState<JOINTS, W, G>, input: Input<JOINTS>) -> Fault {
    state.sensors.frames_lost = state.sensors.frames_lost.wrapping_add(1);
    match input {
        Input::Damaged => Fault::FrameDamaged,
        Input::Magnet => Fault::Magnet,
        Input::Frozen => Fault::Frozen,
        Input::Lost | Input::Sensors { .. } => Fault::FrameLost,
    }
}
