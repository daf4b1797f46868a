//! The force of a pressed surface: the push along its normal, friction along it, texture on top.

use super::{Anchor, Friction, Texture, Touch};
use crate::math::{Vec3, sqrt};

/// Where a surface is pressed, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// The witness point, metres.
    pub point: Vec3,
    /// Its outward unit normal.
    pub normal: Vec3,
    /// Velocity of the probe or tool along the surface, m/s.
    pub velocity: Vec3,
    /// The push along the normal, N, see [`super::Penalty::push`].
    pub push: f32,
}

impl Press {
    /// The force on the probe or tool, N. Without a push the anchor is released. `place` is needed for a texture: `(u,
    /// v)` of the witness point and its tangent along `u`.
    #[inline(always)]
    pub fn force(
        &self,
        friction: Option<&Friction>,
        texture: Option<&Texture>,
        anchor: &mut Anchor,
        place: impl FnOnce() -> ([f32; 2], Vec3),
    ) -> Vec3 {
        let Self { point, normal, velocity, push } = *self;
        let mut force = normal * push;
        if let Some(friction) = friction {
            force += friction.pull(anchor, point, normal, push, velocity);
        }
        if let Some(texture) = texture
            && push > 0.0
        {
            let (parameters, tangent_u) = place();
            let squared = tangent_u.length_squared();
            let inverse = if squared > f32::MIN_POSITIVE { 1.0 / sqrt(squared) } else { 0.0 };
            force +=
                texture.bounded(&Touch { parameters, point, normal, along_u: tangent_u * inverse, velocity, push });
        }
        force
    }
}
