//! Dry friction of the surface: the god-object sticks, and slips when it is pulled too far.

use crate::math::{Vec3, sqrt};

/// Stick and slip along the surface.
///
/// The *anchor* is where the god-object holds the surface (C. B. Zilles and J. K. Salisbury, *A constraint-based
/// god-object method for haptic display*, 1995). While it sticks, a spring and damper pull the witness point back to
/// it. Where the pull would leave the Coulomb cone `‖F_t‖ ≤ μ F_n` it slips: the anchor is dragged after the witness
/// point so that the pull is `μ_d F_n`.
///
/// ```
/// use palpate::math::{Vec3, vec3};
/// use palpate::render::{Anchor, Friction};
///
/// let friction = Friction {
///     stiffness_n_per_m: 500.0,
///     damping_n_s_per_m: 1.0,
///     static_coefficient: 0.4,
///     dynamic_coefficient: 0.3,
/// };
/// let mut anchor = Anchor::default();
/// // Pressed with 2 N: it sticks.
/// let at_first = friction.pull(&mut anchor, Vec3::ZERO, Vec3::Z, 2.0, Vec3::ZERO);
/// assert!(at_first == Vec3::ZERO && !anchor.slips);
/// // Dragged by 10 mm the spring would pull with 5 N: it slips at 0.3 · 2 N.
/// let dragged = friction.pull(&mut anchor, vec3(0.01, 0.0, 0.0), Vec3::Z, 2.0, Vec3::ZERO);
/// assert!(anchor.slips && (dragged.length() - 0.6).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Stiffness along the surface while it sticks, N/m.
    pub stiffness_n_per_m: f32,
    /// Damping along the surface while it sticks, N·s/m.
    pub damping_n_s_per_m: f32,
    /// `μ_s`: tangential over normal force at which slip starts.
    pub static_coefficient: f32,
    /// `μ_d ≤ μ_s`: tangential over normal force while it slips.
    pub dynamic_coefficient: f32,
}

/// Where the surface is held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Anchor {
    /// The point, in the body's frame, metres; `None` out of contact.
    pub point: Option<Vec3>,
    /// Whether it slips.
    pub slips: bool,
}

impl Friction {
    /// The tangential force on the probe, N, and the next anchor.
    ///
    /// `witness` is the witness point (m), `normal` its unit normal, `push` the normal force (N), `velocity` that of
    /// the probe (m/s). `‖F_t‖ ≤ μ_s push` always; without push there is no force and no anchor.
    #[inline]
    pub fn pull(&self, anchor: &mut Anchor, witness: Vec3, normal: Vec3, push: f32, velocity: Vec3) -> Vec3 {
        let touching = push > 0.0;
        if !touching {
            *anchor = Anchor::default();
            return Vec3::ZERO;
        }
        let along = |vector: Vec3| vector - normal * vector.dot(normal);
        // The surface may have turned since: only the part along it now counts.
        let stretch = along(anchor.point.unwrap_or(witness) - witness);
        let damping = along(velocity) * -self.damping_n_s_per_m;
        let pull = stretch * self.stiffness_n_per_m + damping;
        let coefficient = if anchor.slips { self.dynamic_coefficient } else { self.static_coefficient };
        let most = coefficient * push;
        let squared = pull.length_squared();
        let sticks = squared <= most * most;
        if sticks {
            *anchor = Anchor { point: Some(witness + stretch), slips: false };
            return pull;
        }
        // Slipping, the damper has nothing to do: the pull is that of dry friction, and the anchor is where the spring
        // gives it.
        let slide = self.dynamic_coefficient * push;
        let scale = slide / sqrt(squared);
        let pull = if scale.is_finite() { pull * scale } else { Vec3::ZERO };
        let reach = if self.stiffness_n_per_m > 0.0 { 1.0 / self.stiffness_n_per_m } else { 0.0 };
        *anchor = Anchor { point: Some(witness + pull * reach), slips: true };
        pull
    }

    /// Whether all four are finite and not negative, and `μ_d ≤ μ_s`.
    pub const fn is_valid(&self) -> bool {
        let Self { stiffness_n_per_m: stiffness, damping_n_s_per_m: damping, static_coefficient, dynamic_coefficient } =
            *self;
        let finite = stiffness < f32::INFINITY && damping < f32::INFINITY && static_coefficient < f32::INFINITY;
        finite
            && stiffness >= 0.0
            && damping >= 0.0
            && dynamic_coefficient >= 0.0
            && dynamic_coefficient <= static_coefficient
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    const STEEL: Friction = Friction {
        stiffness_n_per_m: 500.0,
        damping_n_s_per_m: 0.0,
        static_coefficient: 0.5,
        dynamic_coefficient: 0.3,
    };

    fn at(x: f32) -> Vec3 {
        vec3(x, 0.0, 0.0)
    }

    #[test]
    fn it_sticks_to_the_edge_of_the_cone_then_slips() {
        let mut anchor = Anchor::default();
        let mut pull = |x: f32| STEEL.pull(&mut anchor, at(x), Vec3::Z, 2.0, Vec3::ZERO).x;
        assert_eq!(pull(0.0), 0.0);
        // 500 N/m × 1 mm; the cone is 0.5 × 2 N.
        assert!((pull(0.001) + 0.5).abs() < 1e-6);
        assert!((pull(0.001_99) + 0.995).abs() < 1e-6);
        // Beyond 2 mm: 0.3 × 2 N, whatever the distance, and it goes on while dragged.
        assert!((pull(0.002_1) + 0.6).abs() < 1e-6);
        assert!((pull(0.010) + 0.6).abs() < 1e-6);
        // Let go: 1.2 mm of stretch stay; back by 0.2 mm the spring gives 0.5 N.
        assert!((pull(0.009_8) + 0.5).abs() < 1e-5);
        // It sticks again, so that the wider cone holds.
        assert!((pull(0.010_6) + 0.9).abs() < 1e-5);
    }

    #[test]
    fn on_a_surface_that_turns_only_what_lies_along_it_pulls() {
        // Over a ball of 20 mm by 0.02 rad, in steps of 0.5 mrad: the chord to where it began dips under the tangent
        // plane.
        let mut anchor = Anchor::default();
        for step in 0..=40 {
            let (sine, cosine) = crate::math::sin_cos(step as f32 * 5e-4);
            let normal = vec3(sine, 0.0, cosine);
            let pull = STEEL.pull(&mut anchor, normal * 0.02, normal, 2.0, Vec3::ZERO);
            // Half a rounding of the 20 mm of each coordinate, times 500 N/m.
            assert!(pull.dot(normal).abs() < 2e-6, "{step}: {pull} leaves the surface");
            let held = anchor.point.unwrap_or(Vec3::ZERO) - normal * 0.02;
            assert!(held.dot(normal).abs() < 4e-9, "{step}: the anchor leaves the tangent plane by {held}");
            // It sticks: 500 N/m along an arc of 10 µm a step, which turning makes longer by 2·10⁻⁴ of itself at most.
            let along = sqrt(pull.length_squared());
            assert!((along - 500.0 * 0.02 * step as f32 * 5e-4).abs() < 1e-4, "{step}: {along} N");
        }
    }

    #[test]
    fn the_cone_holds_whatever_comes() {
        let mut anchor = Anchor::default();
        let friction = Friction { damping_n_s_per_m: 5.0, ..STEEL };
        let mut slipped = 0;
        for step in 0..10_000 {
            let (sine, cosine) = crate::math::sin_cos(step as f32 * 0.013);
            let witness = vec3(0.02 * sine, 0.03 * cosine, 0.0);
            let push = 2.0 + 2.0 * sine;
            let pull = friction.pull(&mut anchor, witness, Vec3::Z, push, vec3(cosine, sine, 0.3));
            slipped += usize::from(anchor.slips);
            // A few roundings.
            assert!(sqrt(pull.length_squared()) <= 0.5 * push * (1.0 + 1e-6) && pull.z == 0.0, "{step}");
        }
        assert!(slipped > 1_000 && slipped < 10_000, "{slipped}");
    }

    #[test]
    fn it_never_gives_out_more_than_it_took() {
        // A closed path under steady push: the work done on the probe is negative or zero.
        let (mut anchor, mut work, mut last) = (Anchor::default(), 0.0_f64, Vec3::ZERO);
        let mut held = Vec3::ZERO;
        for step in 0..20_000 {
            let (sine, cosine) = crate::math::sin_cos(step as f32 * 0.003);
            let witness = vec3(0.005 * sine, 0.004 * cosine * sine, 0.0);
            let pull = STEEL.pull(&mut anchor, witness, Vec3::Z, 1.0, Vec3::ZERO);
            work += f64::from((held + pull).dot(witness - last)) * 0.5;
            (held, last) = (pull, witness);
            // The spring's store, ½ · 1 N of slip²/K, is all that can come back at a time; here it begins empty.
            assert!(work <= 1e-6, "{step}: {work}");
        }
        assert!(work < -0.01, "it brakes: {work} J");
    }

    #[test]
    fn without_push_it_lets_go_and_a_nan_gives_no_force() {
        let mut anchor = Anchor { point: Some(at(0.01)), slips: true };
        assert_eq!(STEEL.pull(&mut anchor, at(0.0), Vec3::Z, 0.0, Vec3::ZERO), Vec3::ZERO);
        assert_eq!(anchor, Anchor::default());
        assert_eq!(STEEL.pull(&mut anchor, at(0.0), Vec3::Z, f32::NAN, Vec3::ZERO), Vec3::ZERO);
    }
}
