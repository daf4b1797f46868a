//! The second-order law: the minimiser of the quadratic model over the whole square, taken in full if the distance is
//! proved to fall.
//!
//! Theory §12 has lemma, rule and theorem. With `w` the step, `s = −gᵀw`, `h = wᵀ H w`, `a = Df w`, `b = D²f[w, w]`,
//! `m₃` the bound of `D³f[w, w, w]` and `j` that of the jumps of second derivatives on the way, the fraction `t` of
//! the step changes `R ‖ΔR‖` by at most
//!
//! `−s t + ½ (h + R j) t² + (3 a·b + R m₃) t³/6 + |b|² t⁴/8`.

use super::border::{self, BoundaryMode};
use super::projection::{MIN_SINE_SQUARED, ProjectionErrors};
use super::witness::Witness;
use crate::math::{saturate, sqrt, sqrt_from_above, vec3};
use crate::patch::{Patch, ShapeBounds};

/// Minimum determinant of the Hessian, relative to `E G`, at which the model is solved: below it a difference of
/// nearly equal numbers has few good bits, by the angle of the tangents or next to a focus.
const MIN_DETERMINANT: f32 = 1.0e-3;

/// Minimum eigenvalue of a shifted model against `I`.
const MIN_EIGENVALUE: f32 = 0.05;

/// The quadratic model of `½ ‖ΔR‖²` at the witness point: `gᵀw + ½ wᵀ H w`, `H = I + ΔR · D²f` positive definite.
#[derive(Clone, Copy)]
pub(super) struct Model {
    gradient: [f32; 2],
    /// `[uu, uv, vv]`.
    hessian: [f32; 3],
    determinant: f32,
}

/// A step to the minimiser.
#[derive(Clone, Copy)]
pub(super) struct Plan {
    /// Change `w` of the parameters.
    pub change: [f32; 2],
    /// `(u, v)` at its end, in `[0, 1]²`.
    pub parameters: [f32; 2],
    /// [`border::is_inside`] of that.
    pub is_inside: bool,
    /// Boundary mode at the witness point.
    pub mode: BoundaryMode,
    /// Boundary mode at the end of the step, by the model.
    pub beyond: BoundaryMode,
    /// `s = −gᵀw`, metres squared; not below `wᵀ H w`.
    pub slope: f32,
}

impl Model {
    /// The model at a witness point; `None` where it is not safely convex.
    #[inline(always)]
    pub(super) fn new(errors: &ProjectionErrors, witness: &Witness) -> Option<Self> {
        let form = &errors.form;
        let [uu, uv, vv] = witness.second.along(errors.difference);
        let hessian @ [a, b, c] = [form.e + uu, form.f + uv, form.g + vv];
        let determinant = a * c - b * b;
        let is_convex = determinant > MIN_DETERMINANT * (form.e * form.g) && a > 0.0;
        is_convex.then_some(Self { gradient: errors.gradient, hessian, determinant })
    }

    /// The model shifted to `H + σ I`, if `H` is not convex: its smallest eigenvalue against `I` is then as far above
    /// 0 as that of `H` is below. `None` if the tangents span no plane.
    #[inline(always)]
    pub(super) fn shifted(errors: &ProjectionErrors, witness: &Witness) -> Option<Self> {
        let form = &errors.form;
        let area = form.determinant();
        let spans_a_plane = area > MIN_SINE_SQUARED * (form.e * form.g);
        if !spans_a_plane {
            return None;
        }
        let [uu, uv, vv] = witness.second.along(errors.difference);
        let form = [form.e, form.f, form.g];
        let hessian @ [a, b, c] = shifted(form, [form[0] + uu, form[1] + uv, form[2] + vv]);
        Some(Self { gradient: errors.gradient, hessian, determinant: a * c - b * b })
    }

    /// The step to its minimiser over the square.
    #[inline(always)]
    pub(super) fn plan(&self, from: [f32; 2]) -> Plan {
        let free = self.free(from);
        if free.is_inside { free } else { self.on_border(from, free.parameters) }
    }

    /// The step to its free minimiser, wherever that is.
    #[inline(always)]
    fn free(&self, [u, v]: [f32; 2]) -> Plan {
        let [along_u, along_v] = self.gradient;
        let [a, b, c] = self.hessian;
        let inverse = -1.0 / self.determinant;
        let change = [(c * along_u - b * along_v) * inverse, (a * along_v - b * along_u) * inverse];
        let parameters = [u + change[0], v + change[1]];
        let (is_inside, slope) = (border::is_inside(parameters), self.slope(change));
        Plan { change, parameters, is_inside, mode: BoundaryMode::Interior, beyond: BoundaryMode::Interior, slope }
    }

    #[inline(always)]
    fn slope(&self, [w_u, w_v]: [f32; 2]) -> f32 {
        -self.gradient[0] * w_u - self.gradient[1] * w_v
    }

    /// The model after a step.
    #[inline(always)]
    fn value(&self, [w_u, w_v]: [f32; 2]) -> f32 {
        let [a, b, c] = self.hessian;
        let [along_u, along_v] = self.gradient;
        w_u * (along_u + 0.5 * a * w_u + b * w_v) + w_v * (along_v + 0.5 * c * w_v)
    }

    /// The minimiser where the free one, at `to`, is not inside: on a side that this violates.
    #[inline(always)]
    fn on_border(&self, from: [f32; 2], to: [f32; 2]) -> Plan {
        let [a, b, c] = self.hessian;
        let [along_u, along_v] = self.gradient;
        // Most often one of the two is violated; bits tell that the other is not.
        let cut = |x: f32| if border::is_within(x) { x } else { saturate(x, 0.0, 1.0) };
        let target = [cut(to[0]), cut(to[1])];
        // On a side of u, and of v: each a step of one parameter, cut at its ends.
        let side_u = || {
            let slope = along_v + b * (target[0] - from[0]);
            [target[0], saturate(from[1] - slope / c, 0.0, 1.0)]
        };
        let side_v = || {
            let slope = along_u + b * (target[1] - from[1]);
            [saturate(from[0] - slope / a, 0.0, 1.0), target[1]]
        };
        let parameters = match (to[0] != target[0], to[1] != target[1]) {
            (false, false) => target,
            (true, false) => side_u(),
            (false, true) => side_v(),
            (true, true) => {
                let (on_u, on_v) = (side_u(), side_v());
                let value = |[u, v]: [f32; 2]| self.value([u - from[0], v - from[1]]);
                if value(on_u) <= value(on_v) { on_u } else { on_v }
            }
        };
        let change = [parameters[0] - from[0], parameters[1] - from[1]];
        // Whether the model would gain beyond a border that it reaches.
        let pushes = |axis: usize, slope: f32| {
            let at = parameters[axis];
            (at <= 0.0 && slope > 0.0) || (at >= 1.0 && slope < 0.0)
        };
        let pushes_u = pushes(0, along_u + a * change[0] + b * change[1]);
        let pushes_v = pushes(1, along_v + b * change[0] + c * change[1]);
        let beyond = border::mode_at(parameters, [pushes_u, pushes_v]);
        let mode = border::mode_at(parameters, [pushes_u && change[0] == 0.0, pushes_v && change[1] == 0.0]);
        let is_inside = border::is_inside(parameters);
        // A step that is not finite has no slope.
        let slope = if (to[0] + to[1]).is_finite() { self.slope(change) } else { 0.0 };
        Plan { change, parameters, is_inside, mode, beyond, slope }
    }
}

/// A Hessian that is not convex, shifted to `H + σ I`: its smallest eigenvalue against `I` is then as far above 0 as that
/// of `H` is below. `I` is `[E, F, G]`, positive definite.
#[inline(never)]
pub(crate) fn shifted([e, f, g]: [f32; 3], [a, b, c]: [f32; 3]) -> [f32; 3] {
    let area = e * g - f * f;
    // Half the sum of the eigenvalues, and half their difference.
    let mean = 0.5 * (e * c + g * a - 2.0 * (f * b)) / area;
    let off = sqrt(saturate(mean * mean - (a * c - b * b) / area, 0.0, f32::MAX));
    let least = mean - off;
    let shift = saturate(-least, MIN_EIGENVALUE, f32::MAX) - least;
    [a + shift * e, b + shift * f, c + shift * g]
}

/// Bounds of a step: `R` from above, `m₂` of `‖D²f[w, w]‖`, `m₃` of `‖D³f[w, w, w]‖`.
struct Terms {
    distance: f32,
    bend: f32,
    twist: f32,
}

impl Terms {
    #[inline(always)]
    fn new([w_u, w_v]: [f32; 2], shape: &ShapeBounds, squared: f32) -> Self {
        let (x, y) = (w_u.abs(), w_v.abs());
        let (xx, xy, yy) = (x * x, x * y, y * y);
        let (second, third) = (&shape.second_derivatives, &shape.third_derivatives);
        let bend = second.uu * xx + 2.0 * second.uv * xy + second.vv * yy;
        let twist = x * (third.uuu * xx + 3.0 * third.uuv * xy) + y * (third.vvv * yy + 3.0 * third.uvv * xy);
        Self { distance: sqrt_from_above(squared), bend, twist }
    }

    /// Whether the full step between two knots lowers `R ‖ΔR‖` by a quarter of the slope, by bounds alone: `h ≤ s`,
    /// `|a·b| ≤ ℓ m₂`, `ℓ² = h − ΔR·b ≤ s + R m₂`, so
    /// `−s + s/2 + (3 ℓ m₂ + R m₃)/6 + m₂²/4 ≤ −s/4` is enough (an eighth would be).
    #[inline(always)]
    fn is_certain(&self, slope: f32) -> bool {
        let Self { distance, bend, twist } = *self;
        let length = sqrt_from_above(slope + distance * bend);
        bend * (2.0 * length + bend) + (2.0 / 3.0) * (distance * twist) <= slope
    }
}

impl Plan {
    /// Whether the full step is proved to lower `R ‖ΔR‖` by a quarter of the slope, by bounds alone. Only between two
    /// knots.
    #[inline(always)]
    pub(super) fn is_certain<P: Patch>(&self, patch: &P, witness: &Witness, squared: f32) -> bool {
        Terms::new(self.change, &patch.shape(), squared).is_certain(self.slope)
            && patch.beyond_knots(witness.parameters, self.parameters) == [0.0; 2]
    }
}

/// The fraction of a step that is proved to lower `R ‖ΔR‖` by half of that fraction of the slope; 1 if the full step
/// lowers it by a quarter. With `h`, `a·b` and `b` at the witness point, and with knots on the way. A function of its
/// own with scalar arguments, so that the tick that does not need it keeps no registers in memory for it.
#[inline(never)]
pub(super) fn exact_share<P: Patch>(
    patch: &P,
    witness: &Witness,
    x: f32,
    y: f32,
    z: f32,
    [w_u, w_v]: [f32; 2],
    slope: f32,
) -> f32 {
    let (shape, [u, v]) = (patch.shape(), witness.parameters);
    let difference = witness.surface.point - vec3(x, y, z);
    let Terms { distance, twist, .. } = Terms::new([w_u, w_v], &shape, difference.length_squared());
    // Without this case, an unbounded jump and no crossed knot would give NaN.
    let jump = |beyond: f32, bound: f32| if beyond > 0.0 { beyond * bound } else { 0.0 };
    let [beyond_u, beyond_v] = patch.beyond_knots([u, v], [u + w_u, v + w_v]);
    let third = &shape.third_derivatives;
    let jumps = jump(beyond_u, third.jump_uu) + jump(beyond_v, third.jump_vv);
    let (way, bend) = (witness.surface.along([w_u, w_v]), witness.second.bend([w_u, w_v]));
    let (cubic, quartic) = (3.0 * way.dot(bend) + distance * twist, bend.length_squared());
    let half = 0.5 * (way.length_squared() + difference.dot(bend) + distance * jumps);
    // An infinite bound proves nothing; times zero it is NaN.
    if !(half + cubic).is_finite() {
        return 0.0;
    }
    if half + cubic * (1.0 / 6.0) + 0.125 * quartic <= 0.75 * slope {
        return 1.0;
    }
    let steep = if cubic > 0.0 { cubic } else { 0.0 } + 0.75 * quartic;
    let share = slope / (half + sqrt_from_above(half * half + 0.5 * steep * slope));
    saturate(share, 0.0, 1.0)
}
