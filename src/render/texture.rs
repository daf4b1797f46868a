//! Texture: a small force of your own on top of the surface's.

use crate::math::{Vec3, sin_cos, sqrt, vec3};
use core::f32::consts::TAU;

/// The input of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// `(u, v)` of the witness point.
    pub parameters: [f32; 2],
    /// The witness point, metres, in the body's frame.
    pub point: Vec3,
    /// Its outward unit normal.
    pub normal: Vec3,
    /// The unit tangent along `u`.
    pub along_u: Vec3,
    /// The probe's velocity, m/s.
    pub velocity: Vec3,
    /// The normal force without texture, N.
    pub push: f32,
}

/// The shape of a texture.
#[derive(Clone, Copy, Debug)]
pub enum TextureShape {
    /// A function: the extra force on the probe, N. Called in the tick while the surface is touched: it must not wait or
    /// panic.
    Custom(fn(&Touch) -> Vec3),
    /// Ridges across a direction of the body's frame: `−max_fraction · push · sin(2π s/pitch)` along the part of the
    /// direction that lies in the surface, `s` the witness point's coordinate along it.
    Ridges {
        /// A unit vector.
        across: Vec3,
        /// m.
        pitch_m: f32,
    },
    /// Bumps: `1/√3` of such ridges across each of the three axes of the body's frame.
    Bumps {
        /// m.
        pitch_m: f32,
    },
}

/// A texture: its shape, and the bound of its force.
///
/// ```
/// use palpate::render::{Texture, TextureShape, grating};
/// use palpate::servo::Rendering;
///
/// /// 40 ridges across `u`, of up to 0.2 of the normal force.
/// const RIDGES: Texture = Texture { shape: TextureShape::Custom(|touch| grating(touch, 40.0, 0.2)), max_fraction: 0.2 };
/// let rendering = Rendering { texture: Some(RIDGES), ..Rendering::PLAIN };
/// assert_eq!(rendering.check(500.0, 1.0 / 4_000.0), Ok(()));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Texture {
    /// Its shape.
    pub shape: TextureShape,
    /// The extra force is scaled down to this share of the normal force, so that it goes to zero with it.
    pub max_fraction: f32,
}

impl Texture {
    /// The extra force, N: at most `max_fraction · push` long, zero where a function gives no finite force.
    #[inline]
    pub fn bounded(&self, touch: &Touch) -> Vec3 {
        let force = match &self.shape {
            TextureShape::Custom(force) => force(touch),
            named => named.force(touch, self.max_fraction * touch.push),
        };
        let squared = force.length_squared();
        let most = self.max_fraction * touch.push;
        if squared <= most * most {
            return force;
        }
        let scale = most / sqrt(squared);
        // NaN and ∞ end here: the comparison above is false for both.
        if scale > 0.0 && squared.is_finite() { force * scale } else { Vec3::ZERO }
    }

    /// Whether the share is between 0 and 1, the pitch between 0.1 mm and 1 m, and the direction a unit vector.
    pub const fn is_valid(&self) -> bool {
        let is_pitch = match self.shape.pitch() {
            Some(pitch) => pitch >= PITCH_M[0] && pitch <= PITCH_M[1],
            None => true,
        };
        self.max_fraction >= 0.0 && self.max_fraction <= 1.0 && is_pitch && self.shape.has_direction()
    }

    /// The steepest change of a named shape's force along the surface for each newton of push, 1/m.
    pub(super) const fn steepness(&self) -> f32 {
        match self.shape {
            TextureShape::Custom(_) => 0.0,
            TextureShape::Ridges { pitch_m, .. } => self.max_fraction * TAU / pitch_m,
            TextureShape::Bumps { pitch_m } => INVERSE_SQRT_3 * self.max_fraction * TAU / pitch_m,
        }
    }
}

/// Range of a pitch, m.
pub(super) const PITCH_M: [f32; 2] = [0.1e-3, 1.0];

const INVERSE_SQRT_3: f32 = 0.577_350_26;

impl TextureShape {
    /// The force of a named shape with an amplitude, N.
    #[inline(never)]
    fn force(&self, touch: &Touch, amplitude: f32) -> Vec3 {
        let force = match *self {
            Self::Custom(force) => return force(touch),
            Self::Ridges { across, pitch_m } => across * ripple(touch.point.dot(across) / pitch_m),
            Self::Bumps { pitch_m } => {
                let [x, y, z] = touch.point.to_array().map(|along| INVERSE_SQRT_3 * ripple(along / pitch_m));
                vec3(x, y, z)
            }
        };
        (force - touch.normal * force.dot(touch.normal)) * -amplitude
    }

    /// The pitch of a named shape, m.
    pub const fn pitch(&self) -> Option<f32> {
        match *self {
            Self::Custom(_) => None,
            Self::Ridges { pitch_m, .. } | Self::Bumps { pitch_m } => Some(pitch_m),
        }
    }

    pub(super) const fn has_direction(&self) -> bool {
        match *self {
            Self::Ridges { across: Vec3 { x, y, z, .. }, .. } => (x * x + y * y + z * z - 1.0).abs() < 1e-4,
            _ => true,
        }
    }
}

/// `sin 2πx`. The cast saturates: the rest of a number beyond 2³¹ is not a fraction, and `bounded` ends what follows.
#[inline]
fn ripple(turns: f32) -> f32 {
    sin_cos((turns - turns as i32 as f32) * TAU).0
}

/// A grating of ridges across `u`, as a tangential force `−share · push · sin(2π u · ridges) · f_u/‖f_u‖`: the effect
/// of a height profile of the same period on the normal (M. Minsky, *Computational haptics*, 1995).
pub fn grating(touch: &Touch, ridges: f32, share: f32) -> Vec3 {
    touch.along_u * (-share * touch.push * ripple(touch.parameters[0] * ridges))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOUCH: Touch = Touch {
        parameters: [0.3, 0.5],
        point: Vec3::ZERO,
        normal: Vec3::Z,
        along_u: Vec3::X,
        velocity: Vec3::ZERO,
        push: 2.0,
    };

    #[test]
    fn a_texture_is_bounded_by_its_share_of_the_push() {
        for (force, expected) in [
            ((|_| Vec3::X * 0.1) as fn(&Touch) -> Vec3, Vec3::X * 0.1),
            (|_| Vec3::Y * 50.0, Vec3::Y * 0.5),
            (|_| Vec3::X * f32::NAN, Vec3::ZERO),
            (|_| Vec3::X * f32::INFINITY, Vec3::ZERO),
            (|_| Vec3::X * 1e30, Vec3::ZERO),
        ] {
            let found = Texture { shape: TextureShape::Custom(force), max_fraction: 0.25 }.bounded(&TOUCH);
            assert!((found - expected).length() < 1e-6, "{found} {expected}");
        }
        let off = Texture { shape: TextureShape::Custom(|_| Vec3::X), max_fraction: 0.25 }
            .bounded(&Touch { push: 0.0, ..TOUCH });
        assert_eq!(off, Vec3::ZERO);
    }

    #[test]
    fn a_grating_pushes_into_its_valleys() {
        let at = |u: f32| grating(&Touch { parameters: [u, 0.0], ..TOUCH }, 20.0, 0.1).x;
        // A quarter of a ridge past the middle of a valley it pulls back with share · push; a quarter before, forward.
        assert!((at(0.5 + 0.25 / 20.0) + 0.2).abs() < 1e-5 && (at(0.5 - 0.25 / 20.0) - 0.2).abs() < 1e-5);
        assert!(at(0.5).abs() < 1e-5);
    }
}
