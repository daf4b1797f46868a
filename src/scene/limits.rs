//! What the bodies of a scene share, and what of a scene is refused.

use crate::device::Device;
use thiserror::Error;

/// What the parts share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The greatest stiffness that a body may be given, N/m.
    pub max_stiffness: f32,
    /// The greatest damping, N·s/m.
    pub max_damping: f32,
    /// The greatest force of a body, N.
    pub max_force: f32,
    /// How much of a force that is no longer backed by a body is let go of in a second, N/s; a force that a switch
    /// brings comes up as fast.
    pub let_go: f32,
    /// Ticks a second.
    pub rate: f32,
    /// No body is met faster than this, m/s: by the tool's speed and its own. It says how long a body that is far off
    /// need not be looked at.
    pub max_speed: f32,
}

/// Which choice is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SceneError {
    /// No body, or more than 32.
    #[error("a scene has 1 to 32 bodies")]
    Bodies,
    /// A shared limit is not positive, or not finite.
    #[error("the scene's limits must be positive and finite")]
    Limits,
    /// A stiffness is out of range. Where several bodies may be touched, two of them must be within it together.
    #[error("body {0}: the stiffness must be between 0 and the greatest, with that of the stiffest other body")]
    Stiffness(u8),
    /// A damping is out of range.
    #[error("body {0}: the damping must be between 0 and the greatest")]
    Damping(u8),
    /// Friction is negative, not finite, or holds more slipping than sticking.
    #[error("body {0}: friction must be finite and not negative, its dynamic coefficient not above the static one")]
    Friction(u8),
    /// A texture's share is not between 0 and 1.
    #[error("body {0}: a texture's share must be between 0 and 1")]
    Texture(u8),
    /// Axes that are not orthonormal, a number that is not finite, no mass.
    #[error("body {0}: its motion has axes that are not orthonormal, a number that is not finite, or no mass")]
    Motion(u8),
    /// A free body is lighter than its stiffness, damping and friction allow at this rate.
    #[error("body {0}: it is too light for its stiffness, damping and friction at this rate")]
    Light(u8),
    /// The damping along a free body's surface is less than its stiffness there times half a tick.
    #[error("body {0}: friction on a free body needs a damping of at least its stiffness times half a tick")]
    Slack(u8),
    /// A sphere that is not finite.
    #[error("body {0}: its sphere must have a finite centre and a radius")]
    Sphere(u8),
    /// A group of 32 and more.
    #[error("body {0}: groups are 0 to 31")]
    Group(u8),
    /// There is no such body.
    #[error("there is no body {0}")]
    Missing(u8),
    /// A placement that is no rigid motion, or of a body that does not rest.
    #[error("body {0}: only a resting body is placed, with orthonormal axes and finite numbers")]
    Placement(u8),
    /// The radius of a tool's tip is negative or not finite.
    #[error("the radius of the tip must be finite and not negative")]
    TipRadius,
    /// A body is to move faster than [`Limits::max_speed`].
    #[error("body {0}: it may not be moved faster than the scene's bodies are met at most")]
    TooFast(u8),
    /// A force of the host's, or a limit of the force, that is negative, not finite or above [`Limits::max_force`].
    #[error("a force must be finite, and at most the scene's greatest")]
    Force,
    /// What is touched does not offer this.
    #[error("what is felt here does not offer this")]
    NotOffered,
    /// There is no body that was uploaded, or it does not go there.
    #[error("body {0}: nothing was uploaded for it")]
    NotUploaded(u8),
}

impl Limits {
    /// Those of a device, at a servo rate: no more force than it has, let go of in 50 ms; bodies met at up to 2 m/s.
    pub const fn of<K, const JOINTS: usize>(device: &Device<K, JOINTS>, rate: f32) -> Self {
        let Device { max_stiffness, max_damping, max_force, .. } = *device;
        Self { max_stiffness, max_damping, max_force, let_go: 20.0 * max_force, rate, max_speed: 2.0 }
    }

    pub(super) const fn is_valid(&self) -> bool {
        let Self { max_stiffness, max_damping, max_force, let_go, rate, max_speed } = *self;
        max_stiffness > 0.0
            && max_damping >= 0.0
            && max_force > 0.0
            && let_go > 0.0
            && rate >= 1.0
            && max_speed > 0.0
            && max_stiffness < f32::INFINITY
            && max_damping < f32::INFINITY
            && max_force < f32::INFINITY
            && let_go < f32::INFINITY
            && rate < f32::INFINITY
            && max_speed < f32::INFINITY
    }
}
