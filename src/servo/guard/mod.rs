//! Protection of motors and hand beyond the loop's own checks, which costs nothing in a loop without it.
//!
//! A loop carries a [`Guard`] as a type: [`Unguarded`], which has no state and whose methods return constants, or
//! [`Guarded`], made from a device's [`Protection`] by [`super::Servo::protected`]. So an unguarded loop contains
//! neither its instructions nor its bytes.

mod guarded;
mod heat;
mod polarity;
mod release;

pub use guarded::{GuardState, Guarded, ProtectionError};
pub use heat::Heat;

use super::Fault;
use super::gate::gate;
use crate::device::{Duty, Encoder, Motor, ProbePose};
use crate::math::Vec3;
use crate::render::Penalty;
use core::fmt::Debug;

/// The motion of a tick: the input of a guard.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a, const JOINTS: usize> {
    /// Joint angles, as the counts tell them, rad.
    pub angles: &'a [f32; JOINTS],
    /// Joint rates, rad/s.
    pub rates: &'a [f32; JOINTS],
    /// The probe's velocity, m/s.
    pub velocity: Vec3,
    /// How far the probe moved since the last tick, m.
    pub moved: Vec3,
    /// The force that the motors gave meanwhile, N.
    pub given: Vec3,
    /// Where the probe is, and the Jacobian.
    pub pose: &'a ProbePose<JOINTS>,
}

/// Protection of a loop. Every call is bounded, and none panics.
pub trait Guard<const JOINTS: usize>: Copy + Debug {
    /// Its state from tick to tick.
    type State: Remembered;

    /// The same for motors, encoders, and joints of a dry friction, N·m, that are not those it was made for.
    #[must_use]
    fn of_joints(self, motors: &[Motor; JOINTS], encoders: &[Encoder; JOINTS], dry_friction: &[f32; JOINTS]) -> Self;

    /// The same for a loop of another wall, which gives contact up at a depth, m.
    #[must_use]
    fn of_wall(self, wall: &Penalty, max_depth_m: f32) -> Self;

    /// Continuous torque limit of each motor, as a fraction of full duty, 0 to 1: for code that drives the motors
    /// without a heat model.
    fn continuous(&self) -> [f32; JOINTS];

    /// Before the first tick after any reset.
    fn start(&self) -> Self::State;

    /// The supply was measured, between two ticks.
    fn measured(&self, state: &mut Self::State, millivolts: u32) -> Result<(), Fault>;

    /// The checks that need no sensors; once a tick.
    fn watch(&self, state: &mut Self::State) -> Result<(), Fault>;

    /// The permitted fraction of force and gravity compensation: below 1 until the polarity of all motors is confirmed.
    /// The force until then is that of the polarity pulses, and the slew limit does not start from it.
    fn force_fraction(&self, state: &Self::State) -> f32;

    /// Whether it withholds the force of a contact. The check of the tables and the check for stuck sensors pause
    /// meanwhile, which saves their time: no force depends on them then.
    fn withholds_force(&self, state: &Self::State) -> bool;

    /// Checks a tick in which force is given, and limits the force, N, and its joint torques `felt`, N·m.
    ///
    /// # Errors
    /// The fault that it detects.
    fn limit(
        &self,
        state: &mut Self::State,
        moving: &Motion<'_, JOINTS>,
        force: &mut Vec3,
        felt: &mut [f32; JOINTS],
    ) -> Result<(), Fault>;

    /// A tick without a request for force.
    fn force_not_requested(&self, state: &mut Self::State);

    /// The last stage before the motors (`gate.rs`): the duties for these torques, N·m, and the scale of the contact
    /// torques.
    ///
    /// # Errors
    /// [`Fault::NotFinite`].
    fn gate(
        &self,
        state: &Self::State,
        drives: bool,
        motors: &[Motor; JOINTS],
        felt: [f32; JOINTS],
        weight: [f32; JOINTS],
    ) -> Result<([Duty; JOINTS], f32), Fault>;

    /// The motors' duties of torque until the next tick.
    fn record_output(&self, state: &mut Self::State, duties: &[Duty; JOINTS]);
}

/// The state of a guard.
pub trait Remembered: Copy + Debug + PartialEq {
    /// Gives every word of it to a hash.
    fn for_each_word(&self, take: impl FnMut(u32));
}

impl Remembered for () {
    fn for_each_word(&self, _: impl FnMut(u32)) {}
}

/// No guard: the loop's own checks alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unguarded;

impl<const JOINTS: usize> Guard<JOINTS> for Unguarded {
    type State = ();

    fn of_joints(self, _: &[Motor; JOINTS], _: &[Encoder; JOINTS], _: &[f32; JOINTS]) -> Self {
        self
    }

    fn of_wall(self, _: &Penalty, _: f32) -> Self {
        self
    }

    fn continuous(&self) -> [f32; JOINTS] {
        [1.0; JOINTS]
    }

    fn start(&self) {}

    #[inline]
    fn measured(&self, (): &mut (), _: u32) -> Result<(), Fault> {
        Ok(())
    }

    #[inline]
    fn watch(&self, (): &mut ()) -> Result<(), Fault> {
        Ok(())
    }

    #[inline]
    fn force_fraction(&self, (): &()) -> f32 {
        1.0
    }

    #[inline]
    fn withholds_force(&self, (): &()) -> bool {
        false
    }

    #[inline]
    fn limit(&self, (): &mut (), _: &Motion<'_, JOINTS>, _: &mut Vec3, _: &mut [f32; JOINTS]) -> Result<(), Fault> {
        Ok(())
    }

    #[inline]
    fn force_not_requested(&self, (): &mut ()) {}

    #[inline]
    fn gate(
        &self,
        (): &(),
        drives: bool,
        motors: &[Motor; JOINTS],
        felt: [f32; JOINTS],
        weight: [f32; JOINTS],
    ) -> Result<([Duty; JOINTS], f32), Fault> {
        gate(drives, motors, felt, weight)
    }

    #[inline]
    fn record_output(&self, (): &mut (), _: &[Duty; JOINTS]) {}
}
