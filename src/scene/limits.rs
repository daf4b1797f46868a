//! Limits of the bodies of a scene.

use super::part::Part;
use crate::device::Device;
use crate::render::EffectLimits;

/// The limits of all bodies of a scene.
///
/// ```
/// use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
/// use palpate::scene::Limits;
///
/// // The device's own, with half of its force.
/// let limits = Limits { max_force_n: 0.5 * DEVICE.max_force_n, ..Limits::of(&DEVICE, 4_000.0) };
/// assert_eq!(limits.max_force_n, 2.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Maximum stiffness of a body, N/m.
    pub max_stiffness_n_per_m: f32,
    /// Maximum damping of a body, N·s/m.
    pub max_damping_n_s_per_m: f32,
    /// Maximum force of a body, N.
    pub max_force_n: f32,
    /// Release rate, N/s: how fast a force falls that no body backs any more, and how fast a force rises that a switch
    /// brings.
    pub release_n_per_s: f32,
    /// Ticks a second.
    pub rate_hz: f32,
    /// Maximum approach speed, m/s: the tool's speed plus the body's own. It determines for how long a distant body
    /// needs no check.
    pub max_speed_m_per_s: f32,
}

impl Limits {
    /// The limits of a device, at a servo rate: its own maximum force, released in 50 ms; approach at up to 2 m/s.
    pub const fn of<K, const JOINTS: usize>(device: &Device<K, JOINTS>, rate: f32) -> Self {
        let Device {
            max_stiffness_n_per_m: max_stiffness,
            max_damping_n_s_per_m: max_damping,
            max_force_n: max_force,
            ..
        } = *device;
        Self {
            max_stiffness_n_per_m: max_stiffness,
            max_damping_n_s_per_m: max_damping,
            max_force_n: max_force,
            release_n_per_s: 20.0 * max_force,
            rate_hz: rate,
            max_speed_m_per_s: 2.0,
        }
    }

    /// The limits that are left for the effects of one of these bodies.
    pub const fn for_effects<S>(&self, parts: &[Part<'_, S>], index: usize) -> EffectLimits {
        EffectLimits {
            force_n: self.max_force_n,
            stiffness_n_per_m: self.max_stiffness_n_per_m - self.stiffest_beside(parts, index),
            damping_n_s_per_m: self.max_damping_n_s_per_m - parts[index].material.damping_n_s_per_m,
        }
    }

    /// The stiffness of the stiffest body beside this one, as configured, N/m.
    pub(super) const fn stiffest_beside<S>(&self, parts: &[Part<'_, S>], index: usize) -> f32 {
        let (mut stiffest, mut beside) = (0.0, 0);
        while beside < parts.len() {
            let material = &parts[beside].material;
            let its = material.steepest(material.stiffness_n_per_m, self.max_force_n);
            if beside != index && its > stiffest {
                stiffest = its;
            }
            beside += 1;
        }
        stiffest
    }

    pub(super) const fn is_valid(&self) -> bool {
        let Self {
            max_stiffness_n_per_m: max_stiffness,
            max_damping_n_s_per_m: max_damping,
            max_force_n: max_force,
            release_n_per_s: let_go,
            rate_hz: rate,
            max_speed_m_per_s: max_speed,
        } = *self;
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
