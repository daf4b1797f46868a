//! Effects of a body beside spring, damper and friction: texture, magnet, viscous layer, and its own limit of force.

use super::texture::PITCH_M;
use super::{Texture, limit};
use crate::math::Vec3;

/// A pull toward the surface, out of contact: `4 F x (1 − x)` with `x = gap/reach`, from 0 at the surface through `F` in
/// the middle to 0 at the reach. It has a potential: there and back it does no work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnet {
    /// Maximum pull `F`, N.
    pub force_n: f32,
    /// Gap at which it ends, m.
    pub reach_m: f32,
}

/// A viscous layer: a drag against the tool's velocity past the body, whole in contact, falling with the gap to zero at
/// the reach. It never does work on the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viscosity {
    /// N·s/m, in contact.
    pub damping_n_s_per_m: f32,
    /// Gap at which it ends, m.
    pub reach_m: f32,
}

/// The effects of a body.
#[derive(Clone, Copy, Debug)]
pub struct Effects {
    /// Texture along the surface; a function is called with the body's own frame.
    pub texture: Option<Texture>,
    /// Pull toward the surface.
    pub magnet: Option<Magnet>,
    /// Viscous layer.
    pub viscosity: Option<Viscosity>,
    /// Maximum force of the body, N; infinite: that of the scene.
    pub max_force_n: f32,
}

/// A number of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectField {
    /// [`Effects::max_force_n`].
    MaxForce,
    /// [`Texture::max_fraction`].
    TextureFraction,
    /// The pitch of the texture's shape.
    TexturePitch,
    /// The direction of the texture's ridges: a unit vector.
    TextureAcross,
    /// [`Magnet::force_n`].
    MagnetForce,
    /// [`Magnet::reach_m`].
    MagnetReach,
    /// [`Viscosity::damping_n_s_per_m`].
    ViscosityDamping,
    /// [`Viscosity::reach_m`].
    ViscosityReach,
}

/// A number of an effect that is out of range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectError {
    /// Which.
    pub field: EffectField,
    /// Its range, in the field's unit.
    pub range: [f32; 2],
}

/// The part of a device's limits that is left for the effects of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectLimits {
    /// Maximum force, N.
    pub force_n: f32,
    /// Maximum stiffness, less that of the stiffest other body, N/m.
    pub stiffness_n_per_m: f32,
    /// Maximum damping, less the body's own, N·s/m.
    pub damping_n_s_per_m: f32,
}

/// Range of a reach, m: a hand at 0.3 m/s takes seven ticks of 4 kHz to cross the shortest.
const REACH_M: [f32; 2] = [0.5e-3, 0.1];
/// Smallest positive force or damping.
const SMALL: f32 = 1e-6;

impl Effects {
    /// None; the force is limited by the scene.
    pub const NONE: Self = Self { texture: None, magnet: None, viscosity: None, max_force_n: f32::INFINITY };

    /// The whole force on the tool, N, from that of the pressed surface with its texture, at a gap (m) and with a
    /// velocity past the body (m/s).
    #[inline(never)]
    pub fn force(&self, pressed: Vec3, gap: f32, normal: Vec3, velocity: Vec3) -> Vec3 {
        let mut force = pressed;
        if let Some(Magnet { force_n, reach_m }) = self.magnet
            && gap > 0.0
            && gap < reach_m
        {
            let x = gap / reach_m;
            force -= normal * (4.0 * force_n * x * (1.0 - x));
        }
        if let Some(Viscosity { damping_n_s_per_m, reach_m }) = self.viscosity
            && gap < reach_m
        {
            let part = if gap > 0.0 { 1.0 - gap / reach_m } else { 1.0 };
            force -= velocity * (part * damping_n_s_per_m);
        }
        limit::saturated(force, self.max_force_n)
    }

    /// The longest reach, m.
    pub const fn reach(&self) -> f32 {
        let magnet = match self.magnet {
            Some(magnet) => magnet.reach_m,
            None => 0.0,
        };
        match self.viscosity {
            Some(viscosity) if viscosity.reach_m > magnet => viscosity.reach_m,
            _ => magnet,
        }
    }

    /// The steepest change of texture and magnet with the tool's position, N/m, for a maximum force, N.
    pub const fn stiffness(&self, max_force: f32) -> f32 {
        let texture = match &self.texture {
            Some(texture) => texture.steepness() * lesser(self.max_force_n, max_force),
            None => 0.0,
        };
        match self.magnet {
            Some(Magnet { force_n, reach_m }) if 4.0 * force_n / reach_m > texture => 4.0 * force_n / reach_m,
            _ => texture,
        }
    }

    /// The damping of the viscous layer, N·s/m.
    pub const fn damping(&self) -> f32 {
        match self.viscosity {
            Some(viscosity) => viscosity.damping_n_s_per_m,
            None => 0.0,
        }
    }

    /// Whether every number is within its range.
    ///
    /// # Errors
    /// The first that is not, with the range.
    pub const fn check(&self, limits: &EffectLimits) -> Result<(), EffectError> {
        let max_force = self.max_force_n;
        if !(max_force == f32::INFINITY || within(max_force, [SMALL, limits.force_n])) {
            return refused(EffectField::MaxForce, [SMALL, limits.force_n]);
        }
        let force = lesser(max_force, limits.force_n);
        if let Some(texture) = &self.texture {
            if !within(texture.max_fraction, [0.0, 1.0]) {
                return refused(EffectField::TextureFraction, [0.0, 1.0]);
            }
            if !texture.shape.has_direction() {
                return refused(EffectField::TextureAcross, [1.0, 1.0]);
            }
            // Steepness times pitch is the same for each pitch.
            if let Some(pitch) = texture.shape.pitch() {
                let range = at_least(texture.steepness() * pitch * force / limits.stiffness_n_per_m, PITCH_M);
                if !within(pitch, range) {
                    return refused(EffectField::TexturePitch, range);
                }
            }
        }
        if let Some(Magnet { force_n, reach_m }) = self.magnet {
            if !within(force_n, [SMALL, force]) {
                return refused(EffectField::MagnetForce, [SMALL, force]);
            }
            let range = at_least(4.0 * force_n / limits.stiffness_n_per_m, REACH_M);
            if !within(reach_m, range) {
                return refused(EffectField::MagnetReach, range);
            }
        }
        if let Some(Viscosity { damping_n_s_per_m: damping, reach_m }) = self.viscosity {
            if !within(damping, [SMALL, limits.damping_n_s_per_m]) {
                return refused(EffectField::ViscosityDamping, [SMALL, limits.damping_n_s_per_m]);
            }
            if !within(reach_m, REACH_M) {
                return refused(EffectField::ViscosityReach, REACH_M);
            }
        }
        Ok(())
    }
}

const fn refused(field: EffectField, range: [f32; 2]) -> Result<(), EffectError> {
    Err(EffectError { field, range })
}

const fn within(number: f32, [min, max]: [f32; 2]) -> bool {
    number >= min && number <= max
}

const fn at_least(least: f32, [min, max]: [f32; 2]) -> [f32; 2] {
    [if least > min { least } else { min }, max]
}

const fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
