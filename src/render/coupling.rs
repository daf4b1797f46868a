//! Virtual coupling: a spring and damper between the probe and a virtual tool of some mass.

use crate::math::Vec3;

/// A coupling separates device and surface: the device meets the coupling alone, whose stiffness is within the device's
/// limits, and the surface meets the tool, and may be as stiff as the tool's mass can follow (R. J. Adams and B.
/// Hannaford, *Stable haptic interaction with virtual environments*, IEEE Trans. Robotics and Automation 15(3), 1999).
///
/// ```
/// use palpate::render::Coupling;
///
/// let coupling = Coupling { stiffness_n_per_m: 500.0, damping_n_s_per_m: 5.0, mass_kg: 0.02 };
/// assert!(coupling.is_valid(1_000.0, 1.0 / 4_000.0));
/// assert!(!coupling.is_valid(1_000.0, 1.0 / 100.0), "20 g is too light for a surface of 1,000 N/m at 100 Hz");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// N/m.
    pub stiffness_n_per_m: f32,
    /// N·s/m.
    pub damping_n_s_per_m: f32,
    /// Mass of the tool, kg.
    pub mass_kg: f32,
}

/// The virtual tool.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tool {
    /// Metres, in the body's frame.
    pub position: Vec3,
    /// m/s.
    pub velocity: Vec3,
}

impl Coupling {
    /// The force on the probe, N; minus this acts on the tool.
    #[inline]
    pub fn force(&self, tool: &Tool, position: Vec3, velocity: Vec3) -> Vec3 {
        (tool.position - position) * self.stiffness_n_per_m + (tool.velocity - velocity) * self.damping_n_s_per_m
    }

    /// The tool a period later, under the coupling and the surface's force on it, N: velocity first, then position with
    /// the new velocity; the coupling's damper is taken implicitly, so that no damping is too much.
    #[inline]
    pub fn step(&self, tool: &Tool, position: Vec3, velocity: Vec3, surface_force: Vec3, period: f32) -> Tool {
        let spring =
            (position - tool.position) * self.stiffness_n_per_m + surface_force + velocity * self.damping_n_s_per_m;
        let damped = 1.0 / (self.mass_kg + self.damping_n_s_per_m * period);
        let velocity = (tool.velocity * self.mass_kg + spring * period) * damped;
        Tool { position: tool.position + velocity * period, velocity }
    }

    /// Whether a tool that meets a surface of this stiffness (N/m) is integrated stably: all positive and finite, and
    /// `(K_coupling + K_surface) h² < 2 m`, half of the rule's limit without damping.
    pub const fn is_valid(&self, surface_stiffness: f32, period: f32) -> bool {
        let Self { stiffness_n_per_m: stiffness, damping_n_s_per_m: damping, mass_kg: mass } = *self;
        let sensible = stiffness > 0.0 && damping >= 0.0 && damping < f32::INFINITY && mass < f32::INFINITY;
        sensible && (stiffness + surface_stiffness) * period * period < 2.0 * mass
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    const COUPLING: Coupling = Coupling { stiffness_n_per_m: 500.0, damping_n_s_per_m: 5.0, mass_kg: 0.02 };
    const PERIOD: f32 = 1.0 / 4_000.0;

    #[test]
    fn pressed_on_a_wall_both_springs_share_the_depth() {
        let probe = vec3(0.0, 0.0, -0.004);
        let mut tool = Tool::default();
        for _ in 0..8_000 {
            let depth = if tool.position.z < 0.0 { -tool.position.z } else { 0.0 };
            tool = COUPLING.step(&tool, probe, Vec3::ZERO, Vec3::Z * (2_000.0 * depth), PERIOD);
        }
        // In series: 500 · 2,000 / 2,500 = 400 N/m.
        let force = COUPLING.force(&tool, probe, Vec3::ZERO);
        assert!((force.z - 1.6).abs() < 1e-3, "{force}");
    }

    #[test]
    fn the_bound_of_the_step_separates_what_stays_from_what_grows() {
        let peak = |mass: f32| {
            let coupling = Coupling { mass_kg: mass, damping_n_s_per_m: 0.0, ..COUPLING };
            let mut tool = Tool { position: vec3(0.001, 0.0, 0.0), velocity: Vec3::ZERO };
            let mut peak = 0.0_f32;
            for _ in 0..4_000 {
                tool = coupling.step(&tool, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, PERIOD);
                peak = if tool.position.x.abs() > peak { tool.position.x.abs() } else { peak };
            }
            peak
        };
        let least = COUPLING.stiffness_n_per_m * PERIOD * PERIOD / 2.0;
        assert!(!Coupling { mass_kg: least * 0.99, ..COUPLING }.is_valid(0.0, PERIOD));
        assert!(Coupling { mass_kg: least * 1.01, ..COUPLING }.is_valid(0.0, PERIOD));
        // Within the bound the amplitude at most doubles (1/√(1 − ω²h²/4)); at half of it the rule itself gives way.
        assert!(peak(least * 1.01) < 0.002);
        assert!(peak(least * 0.49) > 1.0);
    }
}
