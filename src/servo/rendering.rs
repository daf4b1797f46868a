//! What a user chooses about the force beyond a spring and a damper.

use crate::device::VelocityMethod;
use crate::render::{Coupling, Friction, Passivity, Texture};
use thiserror::Error;

/// How the surface feels. Begin with [`Rendering::PLAIN`].
#[derive(Clone, Copy, Debug)]
pub struct Rendering {
    /// The velocity estimator.
    pub velocity: VelocityMethod,
    /// Dry friction of the surface.
    pub friction: Option<Friction>,
    /// Texture on top.
    pub texture: Option<Texture>,
    /// A virtual tool between probe and surface.
    pub coupling: Option<Coupling>,
    /// Passivity control.
    pub passivity: Option<Passivity>,
    /// How fast the force may grow, N/s. It may always fall at once.
    pub greatest_slew: f32,
    /// Whether the motors carry the weight of the device's own links, as far as its kinematics knows it.
    ///
    /// The torques that do come on top of the force's, last before the gate, which gives them what they need first. They fade
    /// in with the force, for at the start the hand still carries what the motors did not, and would be lifted by a step.
    /// They are no part of [`super::ServoState::force`], nor of what the greatest force, the slew limit and the passivity
    /// control look at: they come from a height, and give back what they took. At the rim of the workspace they stay. Without
    /// [`super::Phase::Running`], and so after any fault, they are zero.
    pub carries_weight: bool,
}

/// Which choice is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RenderingError {
    /// A parameter of the friction is negative or not finite, or slipping holds more than sticking.
    #[error("friction must be finite and not negative, its dynamic coefficient not above the static one")]
    Friction,
    /// The texture's share is not between 0 and 1.
    #[error("a texture's share must be between 0 and 1")]
    Texture,
    /// The tool is too light for coupling and surface at this rate, or a parameter is negative or not finite.
    #[error("the virtual tool is too light for its coupling and the surface at this rate")]
    Coupling,
    /// A parameter of the passivity control is negative or not finite.
    #[error("passivity control's parameters must be finite and not negative")]
    Passivity,
    /// The slew limit is not positive.
    #[error("the slew limit must be positive")]
    Slew,
}

impl Rendering {
    /// Spring and damper alone, low-pass velocity, no slew limit, the links' weight carried.
    pub const PLAIN: Self = Self {
        velocity: VelocityMethod::LowPass,
        friction: None,
        texture: None,
        coupling: None,
        passivity: None,
        greatest_slew: f32::INFINITY,
        carries_weight: true,
    };

    /// Checks the choices, for a surface's stiffness (N/m) and a period (s).
    ///
    /// # Errors
    /// The first that is refused.
    pub const fn check(&self, stiffness: f32, period: f32) -> Result<(), RenderingError> {
        if let Some(friction) = &self.friction
            && !friction.is_valid()
        {
            return Err(RenderingError::Friction);
        }
        if let Some(texture) = &self.texture
            && !(texture.greatest_share >= 0.0 && texture.greatest_share <= 1.0)
        {
            return Err(RenderingError::Texture);
        }
        if let Some(coupling) = &self.coupling
            && !coupling.is_valid(stiffness, period)
        {
            return Err(RenderingError::Coupling);
        }
        if let Some(passivity) = &self.passivity
            && !passivity.is_valid()
        {
            return Err(RenderingError::Passivity);
        }
        let grows = self.greatest_slew > 0.0;
        if grows { Ok(()) } else { Err(RenderingError::Slew) }
    }
}

impl Default for Rendering {
    fn default() -> Self {
        Self::PLAIN
    }
}
