//! Implausible contact: a depth at which no wall holds a hand, or a witness point farther away than the probe has moved
//! since the contact started.
//!
//! A witness point that is left behind would pull the hand back to it with full force, through free air. So such
//! contact gives no force but an event, [`super::ServoState::contacts_lost`]: the force fades out, the closest point is
//! located again, and there is no new force until the probe has been in front of the surface. A hand that is stronger
//! than the device and goes through a part ends the contact the same way. Repeated events are a fault:
//! [`super::Fault::ContactLost`].

use super::{Fault, Guard, Phase, Servo, ServoState, Surface, Tracked};
use crate::device::Kinematics;
use crate::math::Vec3;
use crate::render::Penalty;

/// When a contact counts as implausible, and the reaction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ContactLimits {
    /// Maximum depth, as a multiple of the depth at which the surface's stiffness alone gives the maximum force; above
    /// 1.
    pub depth: f32,
    /// Depth, metres, up to which every contact is plausible: a stiff wall that is struck yields by more than its
    /// maximum force implies.
    pub min_depth_m: f32,
    /// Seconds over which the force fades out.
    pub fade_s: f32,
    /// How many events may follow each other, none later than [`Self::quiet_s`] after the one before; one more is a
    /// fault.
    pub max_in_a_row: u32,
    /// Seconds after which an event is forgotten.
    pub quiet_s: f32,
}

impl ContactLimits {
    /// Twice the depth of the maximum force, because beyond it the wall's force no longer grows, and no less than 10
    /// mm; 5 ms of fading, too gentle for a blow; three events within a second of each other.
    pub const DEFAULT: Self = Self { depth: 2.0, min_depth_m: 0.01, fade_s: 0.005, max_in_a_row: 3, quiet_s: 1.0 };

    pub(super) const fn is_valid(&self) -> bool {
        self.depth > 1.0
            && self.min_depth_m >= 0.0
            && self.fade_s >= 0.0
            && self.fade_s < f32::INFINITY
            && self.quiet_s >= 0.0
    }
}

/// The limits as the tick needs them.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactWatch {
    /// Metres; infinite where nothing is watched.
    pub max_depth: f32,
    /// By how much the share of the force falls a tick.
    pub fade_step: f32,
    /// One more is a fault.
    pub max_in_a_row: u32,
    /// Ticks after which an event is forgotten.
    pub quiet: u32,
}

impl ContactWatch {
    pub(super) const fn new(limits: Option<ContactLimits>, wall: &Penalty, rate: f32) -> Self {
        let full_force_depth =
            if wall.stiffness_n_per_m > 0.0 { wall.max_force_n / wall.stiffness_n_per_m } else { f32::INFINITY };
        match limits {
            Some(ContactLimits { depth, min_depth_m: min_depth, fade_s: fade, max_in_a_row, quiet_s: quiet }) => Self {
                max_depth: if depth * full_force_depth < min_depth { min_depth } else { depth * full_force_depth },
                fade_step: if fade * rate > 1.0 { 1.0 / (fade * rate) } else { 1.0 },
                max_in_a_row,
                // The cast saturates.
                quiet: (quiet * rate) as u32,
            },
            None => Self { max_depth: f32::INFINITY, fade_step: 1.0, max_in_a_row: u32::MAX, quiet: 0 },
        }
    }
}

/// The fading force of a released contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LostContact {
    /// Events so far.
    pub count: u32,
    /// Of them those that followed each other.
    pub in_a_row: u32,
    /// The tick of the last one.
    pub tick: u32,
    /// The force when it happened, N.
    pub force: Vec3,
    /// Which share of it is still given.
    pub share: f32,
}

impl<S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'_, S, K, JOINTS, G> {
    /// Ends contact that no motion explains.
    #[cold]
    #[inline(never)]
    pub(super) fn release_contact(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) -> Result<(), Fault> {
        if self.core.safety.contact.is_none() {
            return Ok(());
        }
        self.core.surface.release(&mut state.contact.witness);
        let lost = &mut state.contact.lost;
        let follows = state.ticks.wrapping_sub(lost.tick) <= self.core.contact_watch.quiet;
        // Without force a hand may lead the probe through anything, as often as it likes.
        let felt = u32::from(state.phase == Phase::Running);
        lost.in_a_row = if follows { lost.in_a_row.saturating_add(felt) } else { felt };
        lost.count = lost.count.saturating_add(1);
        (lost.tick, lost.force, lost.share) =
            (state.ticks, state.drive.force, if S::Witness::HAS_OWN_FORCE_ONLY { 0.0 } else { 1.0 });
        if lost.in_a_row > self.core.contact_watch.max_in_a_row { Err(Fault::ContactLost) } else { Ok(()) }
    }

    /// The remaining force of a released contact, N; `None` once it has faded out.
    #[inline]
    pub(super) fn fading(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) -> Option<Vec3> {
        let lost = &mut state.contact.lost;
        if lost.share <= 0.0 {
            return None;
        }
        lost.share -= self.core.contact_watch.fade_step;
        (lost.share > 0.0).then(|| lost.force * lost.share)
    }
}
