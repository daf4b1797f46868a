//! The boundary automaton: which way the witness point may go, and where a step has to stop.
//!
//! One view covers the five modes of Eq. (1) and the corners: the direction is the minimiser of
//! `½ δᵀ I δ + gᵀ δ` over the directions the boundary allows. Strictly convex in two variables, it has one minimiser, and
//! the set of constraints active there is the mode.

use super::law::Law;
use super::projection::ProjectionErrors;
use crate::math::saturate;

/// The active constraints. Numbers 1 to 5 are those of Eq. (1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum BoundaryMode {
    /// Held at `u = 0`, moving along the edge.
    LowerU = 1,
    /// Held at `u = 1`, moving along the edge.
    UpperU = 2,
    /// Held at `v = 0`, moving along the edge.
    LowerV = 3,
    /// Held at `v = 1`, moving along the edge.
    UpperV = 4,
    /// Free in both parameters.
    #[default]
    Interior = 5,
    /// Held at a vertex: both errors point outward. The paper does not list it.
    Corner = 6,
}

impl BoundaryMode {
    /// Every mode, in the order of its number, from 1.
    pub const ALL: [Self; 6] = [Self::LowerU, Self::UpperU, Self::LowerV, Self::UpperV, Self::Interior, Self::Corner];
}

/// The direction a step takes, before its length is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Descent {
    /// Change `w` of `(u, v)` for a gain of 1 (`K h = 1`): `−Ψ` in the interior, `−g_v/G` or `−g_u/E` along an edge.
    pub direction: [f32; 2],
    /// `s = −gᵀ w`, the fall of `½ ‖ΔR‖²` to first order, metres squared. Never negative without feed-forward.
    pub slope: f32,
    /// An upper bound of `wᵀ I w`, the squared length of the step in space, metres squared. Without feed-forward it is `s`.
    pub length_squared: f32,
    /// The mode.
    pub mode: BoundaryMode,
}

impl Descent {
    /// The best direction that the boundary allows at `(u, v)` under a law.
    #[inline(always)]
    pub fn new(law: Law, errors: &ProjectionErrors, parameters: [f32; 2]) -> Self {
        match law {
            Law::MeasureNumbers => Self::measured(errors, parameters),
            Law::Covariant => Self::projected_gradient(errors, parameters),
        }
    }

    /// `−Ψ`, or the active set of the two-variable problem.
    #[inline(always)]
    fn measured(errors: &ProjectionErrors, [u, v]: [f32; 2]) -> Self {
        // No inverse at a pole: the plain gradient is still a descent there.
        let Some([psi_u, psi_v]) = errors.measure_numbers() else {
            return Self::projected_gradient(errors, [u, v]);
        };
        let inside = is_inside(u) && is_inside(v);
        if inside || !(is_blocked(u, -psi_u) || is_blocked(v, -psi_v)) {
            return Self::along([-psi_u, -psi_v], errors.gradient, BoundaryMode::Interior);
        }
        // On an edge the error is measured against the geodesic normal: g/G, not the measure number of Eq. (4).
        match (is_inside(u), is_inside(v)) {
            (false, true) => Self::along_edge_u(errors, u),
            (true, _) => Self::along_edge_v(errors, v),
            // At a corner the edge that was asked for may be blocked while the other is open: take the greater fall.
            (false, false) => {
                let [along_u, along_v] = errors.gradient;
                match (is_blocked(u, -along_u), is_blocked(v, -along_v)) {
                    (true, true) => Self::AT_CORNER,
                    (true, false) => Self::along_edge_u(errors, u),
                    (false, true) => Self::along_edge_v(errors, v),
                    (false, false) => {
                        let (edge_u, edge_v) = (Self::along_edge_u(errors, u), Self::along_edge_v(errors, v));
                        if edge_u.slope >= edge_v.slope { edge_u } else { edge_v }
                    }
                }
            }
        }
    }

    /// Along the edge of constant `u`: `−g_v/G`.
    #[inline]
    fn along_edge_u(errors: &ProjectionErrors, u: f32) -> Self {
        let slide = -errors.gradient[1] * reciprocal_or_zero(errors.form.g);
        Self::along([0.0, slide], errors.gradient, lower_or_upper_u(u))
    }

    /// Along the edge of constant `v`: `−g_u/E`.
    #[inline]
    fn along_edge_v(errors: &ProjectionErrors, v: f32) -> Self {
        let slide = -errors.gradient[0] * reciprocal_or_zero(errors.form.e);
        Self::along([slide, 0.0], errors.gradient, lower_or_upper_v(v))
    }

    /// `−g / trace I`, saturated component by component. The trace is not below the largest eigenvalue of `I`, so that
    /// `wᵀ I w ≤ −gᵀ w`.
    #[inline]
    fn projected_gradient(errors: &ProjectionErrors, [u, v]: [f32; 2]) -> Self {
        let scale = -reciprocal_or_zero(errors.form.e + errors.form.g);
        let [w_u, w_v] = [errors.gradient[0] * scale, errors.gradient[1] * scale];
        match (is_blocked(u, w_u), is_blocked(v, w_v)) {
            (false, false) => Self::along([w_u, w_v], errors.gradient, BoundaryMode::Interior),
            (true, false) => Self::along([0.0, w_v], errors.gradient, lower_or_upper_u(u)),
            (false, true) => Self::along([w_u, 0.0], errors.gradient, lower_or_upper_v(v)),
            (true, true) => Self::AT_CORNER,
        }
    }

    const AT_CORNER: Self = Self { direction: [0.0; 2], slope: 0.0, length_squared: 0.0, mode: BoundaryMode::Corner };

    #[inline]
    fn along(direction: [f32; 2], gradient: [f32; 2], mode: BoundaryMode) -> Self {
        let slope = -(gradient[0] * direction[0] + gradient[1] * direction[1]);
        Self { direction, slope, length_squared: slope, mode }
    }
}

/// The point a step reaches: `(u, v) + gain · direction`, cut where it would leave `[0, 1]²`.
///
/// Cutting (and not clamping each parameter by itself) keeps the step on the segment along which the distance is proved to
/// fall. A component that points outward from its border already is left out: an integrator's mean may have one.
#[inline]
pub fn advance([u, v]: [f32; 2], direction: [f32; 2], gain: f32) -> [f32; 2] {
    let target = [u + gain * direction[0], v + gain * direction[1]];
    if is_within(target[0]) && is_within(target[1]) { target } else { cut([u, v], direction, gain) }
}

/// [`advance`] where the border is met.
#[inline]
fn cut([u, v]: [f32; 2], direction: [f32; 2], gain: f32) -> [f32; 2] {
    let change = |parameter, along: f32| if is_blocked(parameter, along) { 0.0 } else { gain * along };
    let (change_u, change_v) = (change(u, direction[0]), change(v, direction[1]));
    let (cut_u, cut_v) = (fraction_inside(u, change_u), fraction_inside(v, change_v));
    let cut = if cut_u < cut_v { cut_u } else { cut_v };
    [land(u, change_u, cut_u, cut), land(v, change_v, cut_v, cut)]
}

/// How much of a change of one parameter fits into `[0, 1]`.
#[inline]
fn fraction_inside(parameter: f32, change: f32) -> f32 {
    let target = parameter + change;
    if target < 0.0 {
        parameter / -change
    } else if target > 1.0 {
        (1.0 - parameter) / change
    } else {
        1.0
    }
}

/// Where one parameter ends: exactly on its border if that is what cut the step.
#[inline]
fn land(parameter: f32, change: f32, own_cut: f32, cut: f32) -> f32 {
    if own_cut < 1.0 && own_cut <= cut {
        if change < 0.0 { 0.0 } else { 1.0 }
    } else {
        saturate(parameter + cut * change, 0.0, 1.0)
    }
}

#[inline]
fn is_blocked(parameter: f32, change: f32) -> bool {
    (parameter <= 0.0 && change < 0.0) || (parameter >= 1.0 && change > 0.0)
}

/// Whether `0 ≤ x ≤ 1`; false for −0. As bits it is one comparison: those of a positive number rise with it, and a sign bit is
/// larger than all.
#[inline]
fn is_within(x: f32) -> bool {
    x.to_bits() <= 1.0_f32.to_bits()
}

/// Whether `0 < x < 1`, in the same way.
#[inline]
fn is_inside(x: f32) -> bool {
    x.to_bits().wrapping_sub(1) < 1.0_f32.to_bits() - 1
}

#[inline]
fn lower_or_upper_u(u: f32) -> BoundaryMode {
    if u <= 0.0 { BoundaryMode::LowerU } else { BoundaryMode::UpperU }
}

#[inline]
fn lower_or_upper_v(v: f32) -> BoundaryMode {
    if v <= 0.0 { BoundaryMode::LowerV } else { BoundaryMode::UpperV }
}

/// `1/x`, or 0 where a tangent vanishes and nothing can be gained along it.
#[inline]
fn reciprocal_or_zero(x: f32) -> f32 {
    if x > f32::MIN_POSITIVE { 1.0 / x } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Vec3, vec3};
    use crate::patch::SurfacePoint;

    /// Brute force: the best point of the quadratic model over a fine fan of allowed directions.
    fn best_model_fall(errors: &ProjectionErrors, [u, v]: [f32; 2]) -> f32 {
        let mut best = 0.0_f32;
        let fan = (0..36_000).map(|step| crate::math::sin_cos(step as f32 * core::f32::consts::TAU / 36_000.0));
        // The borders of the fan's sectors, which rounding would miss.
        let axes = [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)];
        for (sine, cosine) in fan.chain(axes) {
            if is_blocked(u, cosine) || is_blocked(v, sine) {
                continue;
            }
            let slope = errors.gradient[0] * cosine + errors.gradient[1] * sine;
            let form = errors.form;
            let curvature = form.e * cosine * cosine + 2.0 * form.f * cosine * sine + form.g * sine * sine;
            if slope < 0.0 {
                best = best.max(0.5 * slope * slope / curvature);
            }
        }
        best
    }

    #[test]
    fn the_direction_minimises_the_model_over_what_the_boundary_allows() {
        let corners = [0.0, 0.37, 1.0];
        let mut modes = [false; 7];
        for skew in [-0.9_f32, -0.5, 0.0, 0.5, 0.9] {
            let surface = SurfacePoint {
                point: Vec3::ZERO,
                tangent_u: vec3(1.0, 0.0, 0.0),
                tangent_v: vec3(1.3 * skew, 1.3 * crate::math::sqrt(1.0 - skew * skew), 0.0),
            };
            for turn in 0..64 {
                let (sine, cosine) = crate::math::sin_cos(turn as f32 * 0.1);
                let errors = ProjectionErrors::new(&surface, vec3(cosine, sine, 0.4));
                for u in corners {
                    for v in corners {
                        let descent = Descent::new(Law::MeasureNumbers, &errors, [u, v]);
                        modes[descent.mode as usize] = true;
                        assert!(!is_blocked(u, descent.direction[0]) && !is_blocked(v, descent.direction[1]));
                        // At the minimiser of the model the fall is half the slope. The fan's 1e-4 rad step costs
                        // less than 1e-6 of it; rounding as much.
                        let expected = best_model_fall(&errors, [u, v]);
                        assert!(
                            (0.5 * descent.slope - expected).abs() < 1e-5,
                            "{skew} {turn} {u} {v}: {descent:?}, best {expected}"
                        );
                    }
                }
            }
        }
        assert!(modes[1..].iter().all(|reached| *reached), "{modes:?}");
    }

    #[test]
    fn a_step_stops_on_the_border_it_meets_first() {
        assert_eq!(advance([0.5, 0.5], [-1.0, -0.5], 1.0), [0.0, 0.25]);
        assert_eq!(advance([0.5, 0.5], [0.25, 2.0], 1.0), [0.5625, 1.0]);
        assert_eq!(advance([0.5, 0.5], [0.25, 0.25], 1.0), [0.75, 0.75]);
        assert_eq!(advance([0.5, 0.5], [5.0, 5.0], 1.0), [1.0, 1.0]);
    }

    #[test]
    fn no_step_leaves_the_patch() {
        let samples = [0.0, f32::MIN_POSITIVE, 1e-30, 1e-7, 0.25, 0.999_999_94, 1.0];
        let changes = [-1e30, -1.0, -1e-7, -1e-40, 0.0, 1e-40, 1e-7, 0.3, 1.0, 1e30];
        for (u, v) in samples.into_iter().flat_map(|u| samples.map(|v| (u, v))) {
            for (du, dv) in changes.into_iter().flat_map(|du| changes.map(|dv| (du, dv))) {
                let next = advance([u, v], [du, dv], 1.0);
                assert!(next.iter().all(|x| (0.0..=1.0).contains(x)), "{u} {v} {du} {dv}: {next:?}");
            }
        }
    }
}
