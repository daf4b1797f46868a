//! Whether a pressed device was let go: the energy of the wall is then in its motion.
//!
//! Contact is given up at a depth `D`, so a wall of stiffness `k` and maximum force `F` holds at most `E = F D − F²/2k`.
//! A device that is released there gets all of it but for the wall's damping, whose force at speed `v` is at most `B v`
//! and acts over `F/k`: it leaves the wall with `½ q̇ᵀM q̇ ≥ E − F B v/k`, and the force has done that work on it. A hand
//! that draws the probe away takes the energy, or brings its own: then the work is not the energy of the motion.
//!
//! Motors that are folded back give a share `s` of the maximum force. The wall then holds `s F D − (s F)²/2k ≥ s E`,
//! and its damping takes `s F B v/k`: both sides shrink by `s`.
//!
//! The inertias are those of single joints in the middle of the workspace, where coupling and pose change the energy of
//! a motion by a third, dry friction takes a tenth and the estimated rates lag: so half is asked for, of either.

use super::Motion;
use crate::math::Vec3;
use crate::render::Penalty;

/// Share of the wall's energy, and of the motion's.
const SHARE: f32 = 0.5;
/// The work from which on the motion is looked at, as a share of the wall's energy: less than the most damped wall
/// leaves.
const WORTH: f32 = 1.0 / 16.0;
/// Seconds after the end of the force.
const AFTER: f32 = 0.05;

/// The watch as the tick needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReleaseWatch {
    /// Energy that the wall holds at most, J; infinite where nothing is watched.
    energy: f32,
    /// Maximum loss of it in the wall's damping, J per m/s.
    loss: f32,
    /// Ticks after the end of the force.
    after: u16,
}

/// The work of a force that has not ended long ago.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ReleaseState {
    /// Done by the motors on the probe since it was deepest, J.
    pub work: f32,
    /// Ticks until it is forgotten.
    pub ticks: u16,
}

impl ReleaseState {
    /// Takes a tick's force, N, and motion. Returns whether speeds are to be checked: while a contact gives force,
    /// and for a while after.
    #[inline]
    pub(super) fn follow<const JOINTS: usize>(
        &mut self,
        watch: &ReleaseWatch,
        force: Vec3,
        moving: &Motion<'_, JOINTS>,
    ) -> bool {
        if force != Vec3::ZERO {
            let work = self.work + moving.given.dot(moving.moved);
            *self = Self { work: if work > 0.0 { work } else { 0.0 }, ticks: watch.after };
        } else if self.ticks > 0 {
            self.ticks -= 1;
        } else {
            self.work = 0.0;
            return false;
        }
        true
    }
}

impl ReleaseWatch {
    /// The watch over a wall that gives contact up at a depth, m; infinite where it does not.
    pub(super) const fn new(wall: &Penalty, max_depth: f32, rate: f32) -> Self {
        Self { energy: f32::INFINITY, loss: 0.0, after: (AFTER * rate) as u16 }.of_wall(wall, max_depth)
    }

    /// The same for another wall.
    pub(super) const fn of_wall(self, wall: &Penalty, max_depth: f32) -> Self {
        // Where contact is never given up, as if it were at twice the depth of the maximum force.
        let full = wall.max_force_n / wall.stiffness_n_per_m;
        let depth = if max_depth < f32::INFINITY { max_depth } else { 2.0 * full };
        let energy = wall.max_force_n * (depth - 0.5 * full);
        let energy = if energy > 0.0 { energy } else { f32::INFINITY };
        Self { energy, loss: full * wall.damping_n_s_per_m, ..self }
    }

    /// Whether the work is worth a look at the motion.
    #[inline]
    pub(super) fn may_be_released(&self, state: &ReleaseState) -> bool {
        state.work >= WORTH * self.energy
    }

    /// Whether the work of the wall is in the motion of joints of these inertias, kg·m², where the motors may give a
    /// `share` of full scale.
    #[inline]
    pub(super) fn is_released<const JOINTS: usize>(
        &self,
        state: &ReleaseState,
        share: f32,
        inertia: &[f32; JOINTS],
        moving: &Motion<'_, JOINTS>,
    ) -> bool {
        let mut twice = 0.0;
        for (inertia, rate) in inertia.iter().zip(moving.rates) {
            twice += inertia * rate * rate;
        }
        let motion = 0.5 * twice;
        // A hand that slides along the wall has a motion of its own: what the wall released is at most its work.
        let released = if state.work < motion { state.work } else { motion };
        // `released + loss · speed ≥ half of the energy`, squared: no root in the tick.
        let (energy, loss) = (share * self.energy, share * self.loss);
        let missing = SHARE * energy - released;
        let is_enough = missing <= 0.0 || loss * loss * moving.velocity.length_squared() >= missing * missing;
        is_enough && state.work >= SHARE * motion
    }
}
