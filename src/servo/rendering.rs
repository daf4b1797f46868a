//! What a user chooses about the force beyond a spring and a damper.

use crate::device::VelocityMethod;
use crate::render::{Coupling, Ease, Friction, Passivity, Texture};
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
    /// What keeps the force from clicking at contact and over edges. In a scene the damping of its bodies is there at
    /// once, and the settings' stiffness should be that of the stiffest: a spring that is stiffer is held back.
    pub ease: Option<Ease>,
    /// How fast the force may grow, N/s. It may always fall at once.
    pub max_slew_n_per_s: f32,
    /// Whether the motors carry the weight of the device's own links, as far as its kinematics knows it.
    ///
    /// The torques that do come on top of the force's, last before the gate, which gives them what they need first.
    /// They fade in with the force, for at the start the hand still carries what the motors did not, and would be
    /// lifted by a step. They are no part of [`super::ServoState::force`], nor of what the greatest force, the slew
    /// limit and the passivity control look at: they are conservative, and give back what they took. At the rim of the
    /// workspace they stay. Without [`super::Phase::Running`], and so after any fault, they are zero.
    pub compensates_gravity: bool,
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
    /// A parameter of the easing is negative or not finite, or its rate zero.
    #[error("easing's onset must be finite and not negative, its rate finite and positive")]
    Ease,
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
        ease: None,
        max_slew_n_per_s: f32::INFINITY,
        compensates_gravity: true,
    };

    /// As little to feel as there can be of counts, ticks and edges: position between counts, and [`Ease::SMOOTH`].
    /// Best with a velocity corner of 80 Hz and a wall of at most 500 N/m at 4 kHz ([`crate::render::Material`]): the
    /// position's delay costs stiffness.
    pub const SMOOTH: Self = Self { velocity: VelocityMethod::BetweenCounts, ..Self::EASED };

    /// For stiff walls: nothing clicks at contact and over edges, but counts are felt as they are. It costs little
    /// stiffness, for nothing lags.
    pub const EASED: Self = Self { ease: Some(Ease::SMOOTH), ..Self::PLAIN };

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
            && !(texture.max_fraction >= 0.0 && texture.max_fraction <= 1.0)
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
        if let Some(ease) = &self.ease
            && !ease.is_valid()
        {
            return Err(RenderingError::Ease);
        }
        let grows = self.max_slew_n_per_s > 0.0;
        if grows { Ok(()) } else { Err(RenderingError::Slew) }
    }
}

impl Default for Rendering {
    fn default() -> Self {
        Self::PLAIN
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    const STIFFNESS: f32 = 1_000.0;
    const PERIOD: f32 = 1e-3;
    const FRICTION: Friction = Friction {
        stiffness_n_per_m: 500.0,
        damping_n_s_per_m: 1.0,
        static_coefficient: 0.4,
        dynamic_coefficient: 0.3,
    };
    const COUPLING: Coupling = Coupling { stiffness_n_per_m: 500.0, damping_n_s_per_m: 3.0, mass_kg: 0.01 };
    const PASSIVITY: Passivity = Passivity {
        device_damping_n_s_per_m: 0.1,
        device_friction_n: 0.01,
        max_damping_n_s_per_m: 8.0,
        resolution_m: 1e-4,
    };

    fn refused(rendering: Rendering, error: RenderingError) {
        assert_eq!(rendering.check(STIFFNESS, PERIOD), Err(error), "{rendering:?}");
    }

    #[test]
    fn each_choice_that_cannot_be_felt_is_refused_by_its_name() {
        let texture = Texture { force: |_| Vec3::ZERO, max_fraction: 1.0 };
        let all = Rendering {
            friction: Some(FRICTION),
            texture: Some(texture),
            coupling: Some(COUPLING),
            passivity: Some(PASSIVITY),
            max_slew_n_per_s: 100.0,
            ..Rendering::PLAIN
        };
        assert_eq!(Rendering::PLAIN.check(STIFFNESS, PERIOD), Ok(()));
        assert_eq!(all.check(STIFFNESS, PERIOD), Ok(()));
        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            for friction in [
                Friction { stiffness_n_per_m: bad, ..FRICTION },
                Friction { damping_n_s_per_m: bad, ..FRICTION },
                Friction { static_coefficient: bad, ..FRICTION },
                Friction { dynamic_coefficient: bad, ..FRICTION },
            ] {
                refused(Rendering { friction: Some(friction), ..all }, RenderingError::Friction);
            }
            let coarse = Texture { max_fraction: bad, ..texture };
            refused(Rendering { texture: Some(coarse), ..all }, RenderingError::Texture);
            for coupling in [
                Coupling { stiffness_n_per_m: bad, ..COUPLING },
                Coupling { damping_n_s_per_m: bad, ..COUPLING },
                Coupling { mass_kg: bad, ..COUPLING },
            ] {
                refused(Rendering { coupling: Some(coupling), ..all }, RenderingError::Coupling);
            }
            for passivity in [
                Passivity { device_damping_n_s_per_m: bad, ..PASSIVITY },
                Passivity { device_friction_n: bad, ..PASSIVITY },
                Passivity { max_damping_n_s_per_m: bad, ..PASSIVITY },
                Passivity { resolution_m: bad, ..PASSIVITY },
            ] {
                refused(Rendering { passivity: Some(passivity), ..all }, RenderingError::Passivity);
            }
        }
        let hasty = Ease { change_n_per_s: 0.0, ..Ease::SMOOTH };
        refused(Rendering { ease: Some(hasty), ..all }, RenderingError::Ease);
        assert!([Rendering::SMOOTH, Rendering::EASED].iter().all(|kind| kind.check(STIFFNESS, PERIOD).is_ok()));
        // Slipping must not hold more than sticking.
        let sticky = Friction { dynamic_coefficient: 0.41, ..FRICTION };
        refused(Rendering { friction: Some(sticky), ..all }, RenderingError::Friction);
        let still = Passivity { resolution_m: 0.0, ..PASSIVITY };
        refused(Rendering { passivity: Some(still), ..all }, RenderingError::Passivity);
        refused(Rendering { texture: Some(Texture { max_fraction: 1.01, ..texture }), ..all }, RenderingError::Texture);
        // (500 + 1,000) N/m · 1 ms² < 2 m asks for 0.75 g.
        refused(
            Rendering { coupling: Some(Coupling { mass_kg: 7.4e-4, ..COUPLING }), ..all },
            RenderingError::Coupling,
        );
        let light = Rendering { coupling: Some(Coupling { mass_kg: 7.6e-4, ..COUPLING }), ..all };
        assert_eq!(light.check(STIFFNESS, PERIOD), Ok(()));
        for max_slew in [0.0, -1.0, f32::NAN] {
            refused(Rendering { max_slew_n_per_s: max_slew, ..all }, RenderingError::Slew);
        }
    }
}
