//! From the witness point to the force on the probe.

use super::{Guard, Phase, Servo, ServoState, Surface, Tracked as _};
use crate::device::Kinematics;
use crate::math::{Vec3, sqrt};
use crate::render::{Motion, Tool, Touch, limit};
use crate::track::Contact;

impl<S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'_, S, K, JOINTS, G> {
    /// The force on the probe, N. `tool` is what touches the surface, `motion` is the probe's.
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
        let felt = match &self.rendering.coupling {
            None => surface,
            Some(coupling) => {
                state.tool = coupling.step(&tool, state.probe, motion.velocity, surface, self.period);
                coupling.force(&tool, state.probe, motion.velocity)
            }
        };
        let faded = limit::saturated(felt * (state.fade * state.room), self.penalty.max_force);
        let slewed = limit::slewed(faded, state.force, self.max_growth);
        let Some(passivity) = &self.rendering.passivity else { return slewed };
        let touching = state.contact() == Contact::Touching || self.rendering.coupling.is_some();
        passivity.control(&mut state.energy, slewed, motion, touching, self.penalty.max_force)
    }

    /// The surface's force on what touches it, N.
    #[inline]
    fn surface_force(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, tool: Tool, normal: Vec3) -> Vec3 {
        let push = match state.contact() {
            Contact::Touching => self.penalty.push(state.gap(), tool.velocity.dot(normal)),
            Contact::Behind | Contact::InFront => 0.0,
        };
        let mut force = normal * push;
        let witness = *state.witness.witness();
        let surface = &witness.surface;
        if let Some(friction) = &self.rendering.friction {
            force += friction.pull(&mut state.anchor, surface.point, normal, push, tool.velocity);
        }
        if let Some(texture) = &self.rendering.texture
            && push > 0.0
        {
            let squared = surface.tangent_u.length_squared();
            let inverse = if squared > f32::MIN_POSITIVE { 1.0 / sqrt(squared) } else { 0.0 };
            force += texture.bounded(&Touch {
                parameters: witness.parameters,
                point: surface.point,
                normal,
                along_u: surface.tangent_u * inverse,
                velocity: tool.velocity,
                push,
            });
        }
        force
    }

    /// The force comes up slowly after each start, so that nothing kicks.
    #[inline]
    pub(super) fn next_fade(&self, state: &ServoState<JOINTS, S::Witness, G::State>) -> f32 {
        if state.phase != Phase::Running {
            return 0.0;
        }
        let fade = state.fade + self.fade_step;
        if fade < 1.0 { fade } else { 1.0 }
    }
}
