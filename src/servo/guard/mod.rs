//! What guards motors and hand beyond the loop's own checks, and costs nothing where it is not chosen.
//!
//! A loop carries a [`Guard`] as a type: [`Unguarded`], which has no state and whose every answer is a constant, or
//! [`Guarded`], made from a device's [`Protection`] by [`super::Servo::protected`]. So the instructions and the bytes of
//! what is not chosen are not there to be skipped.

mod guarded;
mod heat;
mod polarity;

pub use guarded::{GuardState, Guarded, ProtectionError};
pub use heat::Heat;

use super::Fault;
use super::gate::gate;
use crate::device::{Duty, Motor, ProbePose};
use crate::math::Vec3;
use core::fmt::Debug;

/// What a tick's motion is, as a guard looks at it.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a, const JOINTS: usize> {
    /// Joint angles, as the counts tell them, rad.
    pub angles: &'a [f32; JOINTS],
    /// Joint rates, rad/s.
    pub rates: &'a [f32; JOINTS],
    /// The probe's velocity, m/s.
    pub velocity: Vec3,
    /// Where the probe is, and the Jacobian.
    pub pose: &'a ProbePose<JOINTS>,
}

/// What guards a loop. Every call is bounded, and none panics.
pub trait Guard<const JOINTS: usize>: Copy + Debug {
    /// What it remembers from tick to tick.
    type State: Remembered;

    /// The same for motors, and joints of a dry friction, N·m, that are not those it was made for.
    #[must_use]
    fn of_motors(self, motors: &[Motor; JOINTS], dry_friction: &[f32; JOINTS]) -> Self;

    /// The duty of torque that each motor may be given for ever, as a share of full duty, 0 to 1: for whoever drives it
    /// where no heat is counted.
    fn continuous(&self) -> [f32; JOINTS];

    /// Before the first tick after any reset.
    fn start(&self) -> Self::State;

    /// The supply was measured, between two ticks.
    fn measured(&self, state: &mut Self::State, millivolts: u32) -> Result<(), Fault>;

    /// What can be wrong whatever the sensors say; once a tick.
    fn watch(&self, state: &mut Self::State) -> Result<(), Fault>;

    /// The share of force and weight that may be given: less than 1 while it is not known that all motors push the way
    /// they should. What is given meanwhile is not the force that was asked for, nor does it grow out of that.
    fn force_fraction(&self, state: &Self::State) -> f32;

    /// Whether it withholds the force of a contact. The check of the tables and the watch over stuck sensors wait
    /// meanwhile: they pay for it, and nothing is felt that they would guard.
    fn withholds_force(&self, state: &Self::State) -> bool;

    /// Looks at a tick in which force is given, and leaves of the force, N, and of its joint torques `felt`, N·m, what
    /// may be given.
    ///
    /// # Errors
    /// What it finds wrong.
    fn limit(
        &self,
        state: &mut Self::State,
        moving: &Motion<'_, JOINTS>,
        force: &mut Vec3,
        felt: &mut [f32; JOINTS],
    ) -> Result<(), Fault>;

    /// A tick in which no force is asked for.
    fn force_not_requested(&self, state: &mut Self::State);

    /// The last thing before the motors (`gate.rs`): the duties for these torques, N·m, and what the felt ones were
    /// scaled by.
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

    /// What the motors are given until the next tick, as duties of torque.
    fn record_output(&self, state: &mut Self::State, duties: &[Duty; JOINTS]);
}

/// What a guard remembers.
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

    fn of_motors(self, _: &[Motor; JOINTS], _: &[f32; JOINTS]) -> Self {
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
