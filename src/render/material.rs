//! Materials by name: stiffness, damping and friction that go together and are clean to touch at 4 kHz.

use super::Friction;

/// The feel of a material's surface. Copy its stiffness and damping into the loop's settings, within the device's
/// limits, and its friction into the rendering, best a smooth one; `palpate feel` measures the result.
///
/// ```
/// use palpate::render::Material;
/// use palpate::servo::{Rendering, Settings};
///
/// const WOOD: Material = Material::WOOD;
/// let settings = Settings { stiffness_n_per_m: WOOD.stiffness_n_per_m, damping_n_s_per_m: WOOD.damping_n_s_per_m, ..Settings::default() };
/// let rendering = Rendering { friction: Some(WOOD.friction), ..Rendering::SMOOTH };
/// assert!(rendering.check(settings.stiffness_n_per_m, 1.0 / settings.rate_hz).is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// N/m.
    pub stiffness_n_per_m: f32,
    /// N·s/m.
    pub damping_n_s_per_m: f32,
    /// Along the surface.
    pub friction: Friction,
}

impl Material {
    /// Soft, well damped, and it holds.
    pub const RUBBER: Self = Self {
        stiffness_n_per_m: 300.0,
        damping_n_s_per_m: 2.0,
        friction: Friction {
            stiffness_n_per_m: 300.0,
            damping_n_s_per_m: 1.0,
            static_coefficient: 0.8,
            dynamic_coefficient: 0.7,
        },
    };

    /// As stiff as no step between two ticks at 4 kHz exceeds 50 mN up to 0.3 m/s: a spring's own is `K v/f`.
    pub const WOOD: Self = Self {
        stiffness_n_per_m: 500.0,
        damping_n_s_per_m: 2.0,
        friction: Friction {
            stiffness_n_per_m: 500.0,
            damping_n_s_per_m: 1.0,
            static_coefficient: 0.4,
            dynamic_coefficient: 0.3,
        },
    };

    /// Twice as stiff, and slippery: its spring steps by more than 50 mN from 0.2 m/s on.
    pub const STEEL: Self = Self {
        stiffness_n_per_m: 1_000.0,
        damping_n_s_per_m: 2.0,
        friction: Friction {
            stiffness_n_per_m: 800.0,
            damping_n_s_per_m: 1.0,
            static_coefficient: 0.2,
            dynamic_coefficient: 0.15,
        },
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_has_friction_that_makes_sense_and_each_is_stiffer_than_the_last() {
        let all = [Material::RUBBER, Material::WOOD, Material::STEEL];
        assert!(all.iter().all(|material| material.friction.is_valid()));
        assert!(all.windows(2).all(|pair| pair[0].stiffness_n_per_m < pair[1].stiffness_n_per_m));
    }

    #[test]
    fn wood_is_the_stiffest_whose_spring_alone_keeps_to_fifty_millinewtons_a_tick() {
        let step = |material: Material| material.stiffness_n_per_m * 0.3 / 4_000.0;
        assert!(step(Material::WOOD) < 0.05 && step(Material::STEEL) > 0.05);
    }
}
