//! One tick, from top to bottom.

use super::gate::gate;
use super::sense::sense;
use super::{Fault, Phase, ServoState, Settings, SettingsError};
use crate::device::{Counts, Device, Duty, Kinematics, VelocityFilter};
use crate::math::Vec3;
use crate::patch::Patch;
use crate::render::{Contact, Penalty};
use crate::track::{Controller, Outcome, Probe, Witness};

/// What a tick starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

/// The loop's configuration: device, surface, controller and settings. Constant, in flash.
#[derive(Clone, Copy, Debug)]
pub struct Servo<'a, P, K, const JOINTS: usize> {
    device: &'a Device<K, JOINTS>,
    patch: &'a P,
    controller: Controller,
    penalty: Penalty,
    filter: VelocityFilter,
    body_origin: Vec3,
    period: f32,
    greatest_move: f32,
    fade_step: f32,
}

impl<'a, P: Patch, K: Kinematics<JOINTS>, const JOINTS: usize> Servo<'a, P, K, JOINTS> {
    /// The loop of a device that touches a patch.
    ///
    /// # Errors
    /// The setting that is refused.
    pub const fn try_new(
        device: &'a Device<K, JOINTS>,
        patch: &'a P,
        controller: Controller,
        settings: Settings,
    ) -> Result<Self, SettingsError> {
        if let Err(error) = settings.check(device.greatest_stiffness, device.greatest_damping) {
            return Err(error);
        }
        let period = 1.0 / settings.rate;
        let greatest_force = if settings.greatest_force < device.greatest_force {
            settings.greatest_force
        } else {
            device.greatest_force
        };
        // A fade no longer than a tick is no fade.
        let fade_step = if settings.soft_start > period { period / settings.soft_start } else { 1.0 };
        Ok(Self {
            device,
            patch,
            controller,
            penalty: Penalty { stiffness: settings.stiffness, damping: settings.damping, greatest_force },
            filter: VelocityFilter::new(settings.velocity_corner, settings.rate),
            body_origin: settings.body_origin,
            period,
            greatest_move: device.greatest_joint_rate * period,
            fade_step,
        })
    }

    /// [`Self::try_new`] for a `static`: refused settings do not compile.
    ///
    /// # Panics
    /// At compile time, naming the setting.
    pub const fn new(device: &'a Device<K, JOINTS>, patch: &'a P, controller: Controller, settings: Settings) -> Self {
        match Self::try_new(device, patch, controller, settings) {
            Ok(servo) => servo,
            Err(SettingsError::Rate) => panic!("rate"),
            Err(SettingsError::Stiffness) => panic!("stiffness"),
            Err(SettingsError::Damping) => panic!("damping"),
            Err(SettingsError::GreatestForce) => panic!("greatest_force"),
            Err(SettingsError::VelocityCorner) => panic!("velocity_corner"),
            Err(SettingsError::SoftStart) => panic!("soft_start"),
            Err(SettingsError::BodyOrigin) => panic!("body_origin"),
        }
    }

    /// The state before the first tick: standby, motors at zero, the witness point in the middle of the patch.
    pub fn start(&self) -> ServoState<JOINTS> {
        ServoState {
            phase: Phase::Standby,
            fault: None,
            ticks: 0,
            frames_lost: 0,
            steps_undone: 0,
            counts: None,
            angles: [0.0; JOINTS],
            rates: [0.0; JOINTS],
            probe: Vec3::ZERO,
            witness: Witness::at(self.patch, 0.5, 0.5),
            gap: 0.0,
            contact: Contact::default(),
            fade: 0.0,
            force: Vec3::ZERO,
            duties: [Duty::ZERO; JOINTS],
        }
    }

    /// One tick. The duties to apply are in the state when it returns.
    ///
    /// Bounded work: one pose, one evaluation of the patch. No panic. Whatever the input, the duties are finite and in range; from the
    /// tick in which a fault is seen they are zero.
    #[inline]
    pub fn tick(&self, state: &mut ServoState<JOINTS>, input: Input<JOINTS>) {
        let torques = self.feel(state, input);
        let gated = torques.and_then(|torques| gate(state.phase, &self.device.motors, torques));
        match gated {
            Ok(duties) => state.duties = duties,
            Err(fault) => {
                state.phase = Phase::Fault;
                state.fault = state.fault.or(Some((fault, state.ticks)));
                state.force = Vec3::ZERO;
                state.duties = [Duty::ZERO; JOINTS];
            }
        }
        state.ticks = state.ticks.wrapping_add(1);
    }

    /// From the input to joint torques, N·m.
    #[inline]
    fn feel(&self, state: &mut ServoState<JOINTS>, input: Input<JOINTS>) -> Result<[f32; JOINTS], Fault> {
        let (counts, enable) = match input {
            Input::Sensors { counts, enable } => (counts, enable),
            Input::Lost => return Err(Self::count_lost(state, Fault::FrameLost)),
            Input::Damaged => return Err(Self::count_lost(state, Fault::FrameDamaged)),
        };
        if state.phase != Phase::Fault {
            state.phase = if enable { Phase::Running } else { Phase::Standby };
        }

        // Counts → joint angles → probe.
        sense(self.device, &self.filter, self.greatest_move, state, counts)?;
        let pose = self.device.kinematics.pose(state.angles);
        state.probe = pose.position - self.body_origin;

        // Probe → witness point.
        let probe = Probe { position: state.probe, velocity: pose.velocity(state.rates) };
        let step = self.controller.step(self.patch, &mut state.witness, probe, self.period);
        state.steps_undone = state.steps_undone.wrapping_add(u32::from(step.outcome == Outcome::Undone));

        // Witness point → gap → force → torques.
        let normal = state.witness.normal(self.patch).unwrap_or(Vec3::ZERO);
        state.gap = (state.probe - state.witness.surface.point).dot(normal);
        state.contact = state.contact.next(state.gap, state.witness.mode);
        state.fade = self.next_fade(state);
        let push = match state.contact {
            Contact::Touching => self.penalty.push(state.gap, probe.velocity.dot(normal)),
            Contact::Behind | Contact::InFront => 0.0,
        };
        state.force = normal * (push * state.fade);
        Ok(pose.torques(state.force))
    }

    /// The force comes up slowly after each start, so that nothing kicks.
    #[inline]
    fn next_fade(&self, state: &ServoState<JOINTS>) -> f32 {
        match state.phase {
            Phase::Running => (state.fade + self.fade_step).min(1.0),
            Phase::Standby | Phase::Fault => 0.0,
        }
    }

    fn count_lost(state: &mut ServoState<JOINTS>, fault: Fault) -> Fault {
        state.frames_lost = state.frames_lost.wrapping_add(1);
        fault
    }
}
