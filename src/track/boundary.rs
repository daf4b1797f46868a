//! The boundary automaton: the directions that the witness point may take, and the end of a step.
//!
//! One view covers the five modes of Eq. (1) and the corners: the direction is the minimiser of `½ δᵀ I δ + gᵀ δ` over
//! the directions that the boundary allows. Strictly convex in two variables, it has one minimiser, and its active
//! constraints are the mode.

use super::border::{Border, BoundaryMode, is_inside, is_within};
use super::projection::ProjectionErrors;
use super::witness::Witness;
use crate::math::saturate;

/// Maximum halvings of a step, so that a witness point is never stuck permanently. All bits of a mask.
pub const MAX_HALVINGS: u8 = 15;

/// The direction a step takes, before its length is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Descent {
    /// Change `w` of `(u, v)` for a gain of 1 (`K h = 1`): `−Ψ` in the interior, `−g_v/G` or `−g_u/E` along an edge.
    pub direction: [f32; 2],
    /// `s = −gᵀ w`, the fall of `½ ‖ΔR‖²` to first order, metres squared. Never negative without feed-forward.
    pub slope: f32,
    /// An upper bound of `wᵀ I w`, the squared length of the step in space, metres squared. Without feed-forward it is
    /// `s`.
    pub length_squared: f32,
    /// The mode.
    pub mode: BoundaryMode,
}

impl Descent {
    /// The direction from the witness point: the best that the boundary allows, halved after rejected steps.
    #[inline(always)]
    pub fn of(errors: &ProjectionErrors, witness: &Witness) -> Self {
        if witness.is_free
            && let Some(direction) = errors.correction()
        {
            return Self::along(direction, errors.gradient, BoundaryMode::Interior);
        }
        Self::new(errors, witness.parameters).halved(witness.halvings)
    }

    /// The same direction, `2ⁿ` times shorter.
    #[inline]
    pub(super) fn halved(self, halvings: u8) -> Self {
        if halvings == 0 {
            return self;
        }
        // 2⁻ⁿ, by its exponent. The square of the length is only an upper bound, and shrinks faster.
        let share = f32::from_bits(1.0_f32.to_bits() - (u32::from(halvings & MAX_HALVINGS) << 23));
        let [w_u, w_v] = self.direction;
        Self {
            direction: [share * w_u, share * w_v],
            slope: share * self.slope,
            length_squared: share * self.length_squared,
            mode: self.mode,
        }
    }

    /// The best direction that the boundary allows at `(u, v)`: `−Ψ`, or the active set of the two-variable problem.
    #[inline(always)]
    pub fn new(errors: &ProjectionErrors, parameters: [f32; 2]) -> Self {
        let [u, v] = parameters.map(Border::of);
        // At a pole there is no inverse: the gradient still descends.
        let Some([w_u, w_v]) = errors.correction() else {
            return Self::projected_gradient(errors, parameters);
        };
        if !(u.blocks(w_u) || v.blocks(w_v)) {
            return Self::along([w_u, w_v], errors.gradient, BoundaryMode::Interior);
        }
        // On an edge the error is measured against the geodesic normal: g/G, not the measure number of Eq. (4).
        match (u.is_met(), v.is_met()) {
            (true, false) => Self::along_edge_u(errors, u),
            (false, _) => Self::along_edge_v(errors, v),
            // At a corner the requested edge may be blocked while the other is open: take the steeper one.
            (true, true) => {
                let [along_u, along_v] = errors.gradient;
                match (u.blocks(-along_u), v.blocks(-along_v)) {
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
    fn along_edge_u(errors: &ProjectionErrors, u: Border) -> Self {
        let slide = -errors.gradient[1] * reciprocal_or_zero(errors.form.g);
        Self::along([0.0, slide], errors.gradient, u.mode_along_u())
    }

    /// Along the edge of constant `v`: `−g_u/E`.
    #[inline]
    fn along_edge_v(errors: &ProjectionErrors, v: Border) -> Self {
        let slide = -errors.gradient[0] * reciprocal_or_zero(errors.form.e);
        Self::along([slide, 0.0], errors.gradient, v.mode_along_v())
    }

    /// `−g / trace I`, saturated component by component. The trace is not below the largest eigenvalue of `I`, so that
    /// `wᵀ I w ≤ −gᵀ w`.
    #[inline]
    pub(super) fn projected_gradient(errors: &ProjectionErrors, parameters: [f32; 2]) -> Self {
        let [u, v] = parameters.map(Border::of);
        let scale = -reciprocal_or_zero(errors.form.e + errors.form.g);
        let [w_u, w_v] = [errors.gradient[0] * scale, errors.gradient[1] * scale];
        match (u.blocks(w_u), v.blocks(w_v)) {
            (false, false) => Self::along([w_u, w_v], errors.gradient, BoundaryMode::Interior),
            (true, false) => Self::along([0.0, w_v], errors.gradient, u.mode_along_u()),
            (false, true) => Self::along([w_u, 0.0], errors.gradient, v.mode_along_v()),
            (true, true) => Self::AT_CORNER,
        }
    }

    const AT_CORNER: Self = Self { direction: [0.0; 2], slope: 0.0, length_squared: 0.0, mode: BoundaryMode::Corner };

    #[inline]
    fn along(direction: [f32; 2], gradient: [f32; 2], mode: BoundaryMode) -> Self {
        let slope = -gradient[0] * direction[0] - gradient[1] * direction[1];
        Self { direction, slope, length_squared: slope, mode }
    }
}

/// The end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// `(u, v)`, in `[0, 1]²`.
    pub parameters: [f32; 2],
    /// [`is_inside`] of them.
    pub is_inside: bool,
}

/// The point a step reaches: `(u, v) + gain · direction`, cut where it would leave `[0, 1]²`; `None` where that is not
/// a number.
///
/// Cutting (and not clamping each parameter by itself) keeps the step on the segment along which the distance is proved
/// to fall. A component that points outward from its border already is left out: an integrator's mean may have one.
#[inline(always)]
pub fn advance([u, v]: [f32; 2], direction: [f32; 2], gain: f32) -> Option<Landing> {
    let parameters = [u + gain * direction[0], v + gain * direction[1]];
    if is_inside(parameters) {
        Some(Landing { parameters, is_inside: true })
    } else if is_within(parameters[0]) && is_within(parameters[1]) {
        Some(Landing { parameters, is_inside: false })
    } else {
        cut([u, v], direction, gain)
    }
}

/// [`advance`] where the border is met.
#[inline]
fn cut([u, v]: [f32; 2], direction: [f32; 2], gain: f32) -> Option<Landing> {
    let change = |parameter, along: f32| if Border::of(parameter).blocks(along) { 0.0 } else { gain * along };
    let (change_u, change_v) = (change(u, direction[0]), change(v, direction[1]));
    let (cut_u, cut_v) = (fraction_inside(u, change_u), fraction_inside(v, change_v));
    let cut = if cut_u < cut_v { cut_u } else { cut_v };
    let parameters = [land(u, change_u, cut_u, cut), land(v, change_v, cut_v, cut)];
    (change_u + change_v).is_finite().then_some(Landing { parameters, is_inside: is_inside(parameters) })
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

/// The end of one parameter: exactly on its border if the border cut the step.
#[inline]
fn land(parameter: f32, change: f32, own_cut: f32, cut: f32) -> f32 {
    if own_cut < 1.0 && own_cut <= cut {
        if change < 0.0 { 0.0 } else { 1.0 }
    } else {
        saturate(parameter + cut * change, 0.0, 1.0)
    }
}

/// `1/x`, or 0 if a tangent vanishes, along which nothing can be gained.
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
            if Border::of(u).blocks(cosine) || Border::of(v).blocks(sine) {
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
                        let descent = Descent::new(&errors, [u, v]);
                        modes[descent.mode as usize] = true;
                        assert!(
                            !Border::of(u).blocks(descent.direction[0]) && !Border::of(v).blocks(descent.direction[1])
                        );
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
        let landing = |parameters| Some(Landing { parameters, is_inside: is_inside(parameters) });
        assert_eq!(advance([0.5, 0.5], [-1.0, -0.5], 1.0), landing([0.0, 0.25]));
        assert_eq!(advance([0.5, 0.5], [0.25, 2.0], 1.0), landing([0.5625, 1.0]));
        assert_eq!(advance([0.5, 0.5], [0.25, 0.25], 1.0), landing([0.75, 0.75]));
        assert_eq!(advance([0.5, 0.5], [5.0, 5.0], 1.0), landing([1.0, 1.0]));
    }

    #[test]
    fn what_is_not_a_number_leads_nowhere() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for start in [[0.5, 0.5], [0.0, 0.5], [1.0, 0.0]] {
                assert_eq!(advance(start, [bad, bad], 1.0), None);
                assert_eq!(advance(start, [0.1, 0.1], f32::NAN), None);
            }
            assert_eq!(advance([0.5, 0.5], [bad, 0.0], 1.0), None);
            assert_eq!(advance([0.5, 0.5], [0.0, bad], 1.0), None);
        }
    }

    #[test]
    fn inside_is_where_nothing_is_blocked() {
        let below_one = 1.0 - f32::EPSILON / 2.0;
        for x in [f32::MIN_POSITIVE, 1e-20, 0.5, below_one] {
            assert!(is_inside([x, 0.5]) && is_inside([0.5, x]));
            assert!(!Border::of(x).is_met());
        }
        for x in [0.0, -0.0, 1e-40, -1e-40, -0.5, 1.0, 1.5, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, -f32::NAN] {
            assert!(!is_inside([x, 0.5]) && !is_inside([0.5, x]), "{x}");
        }
    }

    #[test]
    fn no_step_leaves_the_patch() {
        let samples = [0.0, f32::MIN_POSITIVE, 1e-30, 1e-7, 0.25, 0.999_999_94, 1.0];
        let changes = [-1e30, -1.0, -1e-7, -1e-40, 0.0, 1e-40, 1e-7, 0.3, 1.0, 1e30];
        for (u, v) in samples.into_iter().flat_map(|u| samples.map(|v| (u, v))) {
            for (du, dv) in changes.into_iter().flat_map(|du| changes.map(|dv| (du, dv))) {
                let next = advance([u, v], [du, dv], 1.0).unwrap();
                assert!(next.parameters.iter().all(|x| (0.0..=1.0).contains(x)), "{u} {v} {du} {dv}: {next:?}");
                assert_eq!(next.is_inside, is_inside(next.parameters));
            }
        }
    }

    #[test]
    fn without_a_plane_the_step_is_the_gradient_over_the_trace() {
        let errors = ProjectionErrors {
            difference: Vec3::ZERO,
            gradient: [3.0, -5.0],
            form: crate::track::FirstFundamentalForm { e: 6.0, f: 0.0, g: 2.0 },
        };
        let free = Descent::projected_gradient(&errors, [0.5, 0.5]);
        assert_eq!((free.direction, free.slope), ([-3.0 / 8.0, 5.0 / 8.0], 34.0 / 8.0));
        assert_eq!(Descent::projected_gradient(&errors, [0.0, 0.5]).direction, [0.0, 5.0 / 8.0]);
        assert_eq!(Descent::projected_gradient(&errors, [0.5, 1.0]).direction, [-3.0 / 8.0, 0.0]);
    }

    #[test]
    fn a_halved_step_is_the_same_step_and_shorter() {
        let whole = Descent { direction: [0.5, -0.25], slope: 3.0, length_squared: 5.0, mode: BoundaryMode::Interior };
        let quarter = Descent { direction: [0.125, -0.0625], slope: 0.75, length_squared: 1.25, ..whole };
        assert_eq!((whole.halved(0), whole.halved(2)), (whole, quarter));
    }
}
