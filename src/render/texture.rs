//! Texture: a small force of your own on top of the surface's.

use crate::math::{Vec3, sin_cos, sqrt};

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

/// A texture: a function of the touch, and the bound of its force.
///
/// ```
/// use palpate::render::{Texture, grating};
/// use palpate::servo::Rendering;
///
/// /// 40 ridges across `u`, of up to 0.2 of the normal force.
/// const RIDGES: Texture = Texture { force: |touch| grating(touch, 40.0, 0.2), max_fraction: 0.2 };
/// let rendering = Rendering { texture: Some(RIDGES), ..Rendering::PLAIN };
/// assert_eq!(rendering.check(500.0, 1.0 / 4_000.0), Ok(()));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Texture {
    /// The extra force on the probe, N. Called in the tick while the surface is touched: it must not wait or panic.
    pub force: fn(&Touch) -> Vec3,
    /// The extra force is scaled down to this share of the normal force, so that it goes to zero with it.
    pub max_fraction: f32,
}

impl Texture {
    /// The extra force, N: at most `max_share · push` long, zero where the function gives no finite force.
    #[inline]
    pub fn bounded(&self, touch: &Touch) -> Vec3 {
        let force = (self.force)(touch);
        let squared = force.length_squared();
        let most = self.max_fraction * touch.push;
        if squared <= most * most {
            return force;
        }
        let scale = most / sqrt(squared);
        // NaN and ∞ end here: the comparison above is false for both.
        if scale > 0.0 && squared.is_finite() { force * scale } else { Vec3::ZERO }
    }
}

/// A grating of ridges across `u`, as a tangential force `−share · push · sin(2π u · ridges) · f_u/‖f_u‖`: the effect
/// of a height profile of the same period on the normal (M. Minsky, *Computational haptics*, 1995).
pub fn grating(touch: &Touch, ridges: f32, share: f32) -> Vec3 {
    let turns = touch.parameters[0] * ridges;
    // The fraction of a turn: a cast that saturates removes the whole turns.
    let (sine, _) = sin_cos((turns - turns as i32 as f32) * core::f32::consts::TAU);
    touch.along_u * (-share * touch.push * sine)
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
            let found = Texture { force, max_fraction: 0.25 }.bounded(&TOUCH);
            assert!((found - expected).length() < 1e-6, "{found} {expected}");
        }
        let off = Texture { force: |_| Vec3::X, max_fraction: 0.25 }.bounded(&Touch { push: 0.0, ..TOUCH });
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
