//! From the witness point to the force on the probe.

use super::{Guard, Phase, Rendering, Servo, ServoState, Surface, Tracked as _};
use crate::device::Kinematics;
use crate::math::Vec3;
use crate::render::{Motion, Press, Reason, Tool, limit};
use crate::track::Contact;

impl<S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'_, S, K, JOINTS, G> {
    /// The force on the probe, N. `tool` is what touches the surface, `motion` is the probe's. The velocity of the
    /// state's own tool is still the last tick's, and set here.
    #[inline]
    pub(super) fn force(
        &self,
        state: &mut ServoState<JOINTS, S::Witness, G::State>,
        tool: Tool,
        normal: Vec3,
        motion: &Motion,
    ) -> Vec3 {
        let mut surface = self.surface_force(state, tool, normal);
        if let Some(fading) = self.fading(state) {
            surface += fading;
        }
        if let Some(own) = self.surface.own_force(&state.witness) {
            surface += own;
        }
        let last = state.tool.velocity;
        let felt = match &self.rendering.coupling {
            None => {
                state.tool.velocity = tool.velocity;
                surface
            }
            Some(coupling) => {
                state.tool = coupling.step(&tool, state.probe, motion.velocity, surface, self.period);
                coupling.force(&tool, state.probe, motion.velocity)
            }
        };
        let faded = limit::saturated(felt * (state.fade * state.room), self.penalty.max_force_n);
        let slewed = if self.guard.share(&state.guard) < 1.0 {
            // What is withheld cannot grow out of what was given, and once it may be given the guard lets it come
            // slowly.
            faded
        } else {
            let eased = match &self.eased {
                Some(eased) => {
                    let quickened = tool.velocity - last;
                    eased.next(faded, state.force, &Reason { moved: motion.moved, quickened })
                }
                None => faded,
            };
            limit::slewed(eased, state.force, self.max_growth)
        };
        let Some(passivity) = &self.rendering.passivity else { return slewed };
        let touching = state.contact() == Contact::Touching || self.rendering.coupling.is_some();
        passivity.control(&mut state.energy, slewed, motion, touching, self.penalty.max_force_n)
    }

    /// The surface's force on what touches it, N.
    #[inline]
    fn surface_force(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, tool: Tool, normal: Vec3) -> Vec3 {
        if S::FEELS_ITSELF {
            return Vec3::ZERO;
        }
        let push = match state.contact() {
            Contact::Touching => {
                let wall = self.eased.map_or(self.penalty, |eased| eased.wall(&self.penalty, state.gap()));
                wall.push(state.gap(), tool.velocity.dot(normal))
            }
            Contact::Behind | Contact::InFront => 0.0,
        };
        let witness = *state.witness.witness();
        let surface = &witness.surface;
        let Rendering { friction, texture, .. } = &self.rendering;
        let press = Press { point: surface.point, normal, velocity: tool.velocity, push };
        press.force(friction.as_ref(), texture.as_ref(), &mut state.anchor, || (witness.parameters, surface.tangent_u))
    }

    /// The force comes up slowly after each start, so that nothing kicks, and is gone at once when it is not asked for.
    #[inline]
    pub(super) fn next_fade(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>) -> f32 {
        if state.phase != Phase::Running {
            // Nothing is left for an easing to end slowly.
            state.force = Vec3::ZERO;
            return 0.0;
        }
        let fade = state.fade + self.fade_step;
        if fade < 1.0 { fade } else { 1.0 }
    }
}
