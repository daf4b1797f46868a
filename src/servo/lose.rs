//! What the loop does about contact that no motion explains: see `lost_contact.rs`.

use super::{Fault, Guard, Phase, Servo, ServoState, Surface};
use crate::device::Kinematics;
use crate::math::Vec3;

impl<S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'_, S, K, JOINTS, G> {
    /// Ends contact that no motion explains.
    #[cold]
    #[inline(never)]
    pub(super) fn lose_contact(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) -> Result<(), Fault> {
        if self.safety.contact.is_none() {
            return Ok(());
        }
        self.surface.lose(&mut state.witness);
        let lost = &mut state.lost_contact;
        let follows = state.ticks.wrapping_sub(lost.tick) <= self.contact_watch.quiet;
        // Without force a hand may lead the probe through anything, as often as it likes.
        let felt = u32::from(state.phase == Phase::Running);
        lost.in_a_row = if follows { lost.in_a_row.saturating_add(felt) } else { felt };
        lost.count = lost.count.saturating_add(1);
        (lost.tick, lost.force, lost.share) = (state.ticks, state.force, if S::FEELS_ITSELF { 0.0 } else { 1.0 });
        if lost.in_a_row > self.contact_watch.max_in_a_row { Err(Fault::ContactLost) } else { Ok(()) }
    }

    /// What is still given of the force of contact that was lost, N; `None` of none.
    #[inline]
    pub(super) fn fading(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) -> Option<Vec3> {
        let lost = &mut state.lost_contact;
        if lost.share <= 0.0 {
            return None;
        }
        lost.share -= self.contact_watch.fade_step;
        (lost.share > 0.0).then(|| lost.force * lost.share)
    }
}
