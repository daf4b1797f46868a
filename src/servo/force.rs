//! From the witness point to the force on the probe.

use super::{Carrier, Guard, Phase, Rendering, Servo, ServoState, Surface, ToolContact, Tracked as _};
use crate::device::Kinematics;
use crate::math::Vec3;
use crate::render::{Moved, Press, Reason, Tool, limit};
use crate::track::Contact;

impl<S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'_, S, K, JOINTS, G> {
    /// The force on the probe, N. `tool` touches the surface, `motion` is the probe's. The velocity of the state's own
    /// tool is still the last tick's, and set here.
    #[inline]
    pub(super) fn force(
        &self,
        state: &mut ServoState<JOINTS, S::Witness, G::State>,
        tool: Tool,
        normal: Vec3,
        motion: &Moved,
    ) -> Vec3 {
        let mut surface = self.surface_force(state, tool, normal);
        if let Some(fading) = self.fading(state) {
            surface += fading;
        }
        if let Some(own) = state.contact.witness.own_force() {
            surface += own;
        }
        let last = state.contact.tool.velocity;
        let felt = match &self.core.rendering.coupling {
            None => {
                state.contact.tool.velocity = tool.velocity;
                surface
            }
            Some(coupling) => {
                state.contact.tool =
                    coupling.step(&tool, state.contact.probe, motion.velocity, surface, self.core.period);
                coupling.force(&tool, state.contact.probe, motion.velocity)
            }
        };
        let faded = limit::saturated(felt * (state.drive.fade * state.drive.margin), self.core.penalty.max_force_n);
        let slewed = if self.guard.force_fraction(&state.guard) < 1.0 {
            // The slew limit must not start from a withheld force; once the force is permitted, the guard lets it rise
            // slowly.
            faded
        } else {
            let eased = match &self.core.eased {
                Some(eased) => {
                    let quickened = tool.velocity - last;
                    eased.next(faded, state.drive.force, &Reason { moved: motion.moved, quickened })
                }
                None => faded,
            };
            limit::slewed(eased, state.drive.force, self.core.max_growth)
        };
        let Some(passivity) = &self.core.rendering.passivity else { return slewed };
        let touching = state.contact() == Contact::Touching || self.core.rendering.coupling.is_some();
        passivity.control(&mut state.drive.energy, slewed, motion, touching, self.core.penalty.max_force_n)
    }

    /// The surface's force on the probe or tool, N.
    #[inline]
    fn surface_force(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, tool: Tool, normal: Vec3) -> Vec3 {
        if S::Witness::HAS_OWN_FORCE_ONLY {
            return Vec3::ZERO;
        }
        let wall = match &self.core.eased {
            Some(eased) if state.contact() == Contact::Touching => eased.wall(&self.core.penalty, state.gap()),
            _ => self.core.penalty,
        };
        let touch = (state.contact() == Contact::Touching).then(|| ToolContact {
            gap_m: state.gap(),
            normal,
            velocity: tool.velocity,
            carrier: Carrier::FIXED,
            period_s: self.core.period,
        });
        let push = self.core.surface.push(&mut state.contact.witness, &wall, touch);
        let witness = *state.contact.witness.witness();
        let surface = &witness.surface;
        let Rendering { friction, texture, .. } = &self.core.rendering;
        let press = Press { point: surface.point, normal, velocity: tool.velocity, push };
        press.force(friction.as_ref(), texture.as_ref(), &mut state.contact.anchor, || {
            (witness.parameters, surface.tangent_u)
        })
    }

    /// The force rises slowly after each start, so that nothing kicks, and is zero at once without a request.
    #[inline]
    pub(super) fn next_fade(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) -> f32 {
        if state.phase != Phase::Running {
            // Nothing is left for an easing to end slowly.
            state.drive.force = Vec3::ZERO;
            return 0.0;
        }
        let fade = state.drive.fade + self.core.fade_step;
        if fade < 1.0 { fade } else { 1.0 }
    }
}
