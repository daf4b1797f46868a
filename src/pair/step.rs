//! The joint step of both witness points, and its certificate.
//!
//! `x` are the parameters of the body's point `f(x)`, `y` the coordinates of the core's point `h(y)`: parameters of a
//! face, or coordinates in a solid. With `d` the step in both, `a = Df d_A − Dh d_B`, `b = D²f[d_A, d_A] − D²h[d_B,
//! d_B]` and `s = −gᵀd`, the difference `ΔR = f − h` is a quadratic plus a remainder, so that theory §12's lemma holds
//! as it stands (§14): `R (‖ΔR(t d)‖ − R) ≤ −s t + …`. A solid's `h` is linear, and has no remainder.

use super::quadratic::{Quadratic, SIZE, Step};
use super::tool::Region;
use crate::body::Body;
use crate::math::{Vec3, saturate, sqrt, sqrt_from_above};
use crate::patch::{ALL_KINDS, CurvedPoint, KindSet, Patch as _, SecondDerivatives, SplinePatch, SurfacePoint};
use crate::track::Placement;

/// Shifts `σ` of the model `H + σ J`, in their sequence; then `J` alone.
const SHIFTS: [f32; 4] = [0.0, 1.0e-4, 1.0e-2, 1.0];
/// A rise of the squared distance below this, times the size and the distance, is rounding.
const ROUNDING: f32 = 16.0 * f32::EPSILON;
/// Relative to the size: a step that promises to lower the distance by less is one at rest.
const RESOLUTION: f32 = 3.0e-8;
/// Relative to the size: a tangent shorter than this is that of a pole, along which nothing moves.
const NO_TANGENT: f32 = 1.0e-6;
/// Maximum halvings of a step after rejected ones.
const MAX_HALVINGS: u8 = 15;

/// A witness point on a face, or in a solid, whose coordinates are then `curved.surface.point`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Index of the face.
    pub face: u16,
    /// `(u, v)` on it, in `[0, 1]²`.
    pub parameters: [f32; 2],
    /// The face evaluated there, in the frame of the body's tables.
    pub curved: CurvedPoint,
}

/// Both witness points, each in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// On the body.
    pub a: Foot,
    /// On the core.
    pub b: Foot,
    /// Number of halvings of the next step: one more after each rejected step in a row. None is rejected with valid
    /// bounds on faces that are C¹.
    pub halvings: u8,
}

/// Outcome of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moved {
    /// Both points moved, and are not farther apart.
    Nearer,
    /// The step promised less than rounding.
    AtRest,
    /// The points would have been farther apart; they stayed.
    Rejected,
}

impl Foot {
    pub(super) fn on(body: &Body, face: u16, parameters: [f32; 2]) -> Self {
        let [u, v] = parameters.map(|parameter| saturate(parameter, 0.0, 1.0));
        let patch = patch_of(body, face);
        Self { face, parameters: [u, v], curved: patch.evaluate_apart::<KindSet<ALL_KINDS>>([u, v]) }
    }

    pub(super) const fn in_solid(point: Vec3) -> Self {
        let surface = SurfacePoint { point, tangent_u: Vec3::ZERO, tangent_v: Vec3::ZERO };
        Self { face: 0, parameters: [0.0; 2], curved: CurvedPoint { surface, second: SecondDerivatives::NONE } }
    }

    /// The point, in its own frame.
    pub const fn point(&self) -> Vec3 {
        self.curved.surface.point
    }

    /// The outward normal, not normalised; zero at a pole.
    pub(super) fn normal(&self, body: &Body) -> Vec3 {
        let surface = &self.curved.surface;
        surface.tangent_u.cross(surface.tangent_v) * patch_of(body, self.face).orientation()
    }
}

pub(super) fn patch_of<'a>(body: &Body<'a>, face: u16) -> SplinePatch<'a> {
    body.faces().get(usize::from(face)).map_or(SplinePatch::VACANT, |face| face.patch)
}

impl Pair {
    /// The core's nearest point to a point of the body.
    pub(super) fn facing(a: Foot, region: &Region, placement: &Placement) -> Self {
        let (point, face, parameters) = region.nearest(placement.point_to_b(a.point()));
        let b = match region {
            Region::Solid { .. } => Foot::in_solid(point),
            Region::Surface(body) => Foot::on(body, face, parameters),
        };
        Self { a, b, halvings: 0 }
    }

    /// `ΔR = f − h`, metres, in the body's frame.
    pub fn difference(&self, placement: &Placement) -> Vec3 {
        self.a.point() - placement.point_to_a(self.b.point())
    }

    /// One step of both points towards the closest pair. One evaluation of the body, and one of a core that is a body.
    ///
    /// The distance never rises by more than rounding: the full step if the lemma promises a quarter of the slope,
    /// otherwise the model with the largest promise, and its fraction.
    /// The body's point keeps the parameters that are `held`.
    pub(super) fn step(&mut self, body: &Body, region: &Region, placement: &Placement, held: [bool; 2]) -> Moved {
        let mut joint = Joint::new(self, body, region, placement);
        for (axis, is_held) in held.into_iter().enumerate() {
            if is_held {
                (joint.lower[axis], joint.upper[axis]) = (0.0, 0.0);
            }
        }
        let squared = joint.difference.length_squared();
        let Some((step, slope)) = joint.plan_moving(self, body, region) else { return Moved::AtRest };
        let [u, v, r, s, _] = step;
        let moved = |at: [f32; 2], w: [f32; 2]| [at[0] + w[0], at[1] + w[1]];
        let a = Foot::on(body, self.a.face, moved(self.a.parameters, [u, v]));
        let next = match region {
            // The projection is at least as near as the step's own end.
            Region::Solid { .. } => Self::facing(a, region, placement),
            Region::Surface(core) => {
                Self { a, b: Foot::on(core, self.b.face, moved(self.b.parameters, [r, s])), halvings: 0 }
            }
        };
        let size = body.size() + placement.origin.abs().max_element();
        let rise = next.difference(placement).length_squared() - squared;
        // Near contact the points' own rounding is the distance.
        let rounding = ROUNDING * size;
        let is_no_rise = rise <= rounding * (sqrt(squared) + rounding);
        if !is_no_rise {
            self.halvings = if self.halvings < MAX_HALVINGS { self.halvings + 1 } else { MAX_HALVINGS };
            return Moved::Rejected;
        }
        *self = next;
        let resolved = RESOLUTION * body.size();
        if slope <= resolved * (sqrt(squared) + resolved) { Moved::AtRest } else { Moved::Nearer }
    }
}

/// The start of a step: `ΔR` with its derivatives in all variables, in the body's frame.
struct Joint {
    difference: Vec3,
    columns: [Vec3; SIZE],
    /// Second derivatives of `f`, and of `−h`.
    second: [SecondDerivatives; 2],
    lower: Step,
    upper: Step,
}

impl Joint {
    fn new(pair: &Pair, body: &Body, region: &Region, placement: &Placement) -> Self {
        let ([u, v], f) = (pair.a.parameters, &pair.a.curved);
        let mut joint = Self {
            difference: pair.difference(placement),
            columns: [f.surface.tangent_u, f.surface.tangent_v, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO],
            second: [f.second, SecondDerivatives::NONE],
            lower: [-u, -v, 0.0, 0.0, 0.0],
            upper: [1.0 - u, 1.0 - v, 0.0, 0.0, 0.0],
        };
        match region {
            Region::Solid { middle, half } => {
                let point = (pair.b.point() - *middle).to_array();
                for ((axis, at), half) in point.into_iter().enumerate().zip(half.to_array()) {
                    joint.columns[2 + axis] = -placement.axes[axis];
                    (joint.lower[2 + axis], joint.upper[2 + axis]) = (-half - at, half - at);
                }
            }
            Region::Surface(_) => {
                let ([r, s], CurvedPoint { surface, second }) = (pair.b.parameters, &pair.b.curved);
                let turned = |direction| -placement.direction_to_a(direction);
                (joint.columns[2], joint.columns[3]) = (turned(surface.tangent_u), turned(surface.tangent_v));
                let SecondDerivatives { half_uu, uv, half_vv } = *second;
                joint.second[1] =
                    SecondDerivatives { half_uu: turned(half_uu), uv: turned(uv), half_vv: turned(half_vv) };
                (joint.lower[2], joint.upper[2]) = (-r, 1.0 - r);
                (joint.lower[3], joint.upper[3]) = (-s, 1.0 - s);
            }
        }
        // Along a vanishing tangent nothing moves; a solid's axes have length 1.
        let shortest = NO_TANGENT * body.size();
        for i in 0..SIZE {
            let still = joint.columns[i].length_squared() <= shortest * shortest;
            let no_range = joint.upper[i] <= joint.lower[i];
            if still || no_range {
                (joint.lower[i], joint.upper[i]) = (0.0, 0.0);
            }
        }
        joint
    }

    /// The plan in those variables that can move: a corner of a core has none of its own, a segment one.
    fn plan_moving(&self, pair: &Pair, body: &Body, region: &Region) -> Option<(Step, f32)> {
        if let Region::Surface(_) = region {
            return self.plan([0, 1, 2, 3], pair, body, region);
        }
        let [x, y, z] = [2, 3, 4].map(|i| self.upper[i] > self.lower[i]);
        match (x, y, z) {
            (false, false, false) => self.plan([0, 1], pair, body, region),
            (true, false, false) => self.plan([0, 1, 2], pair, body, region),
            (false, true, false) => self.plan([0, 1, 3], pair, body, region),
            (false, false, true) => self.plan([0, 1, 4], pair, body, region),
            _ => self.plan([0, 1, 2, 3, 4], pair, body, region),
        }
    }

    /// The step with the largest promise, and its slope; `None` if no step promises anything. In the variables `of`.
    fn plan<const N: usize>(&self, of: [usize; N], pair: &Pair, body: &Body, region: &Region) -> Option<(Step, f32)> {
        let columns = of.map(|i| self.columns[i]);
        let (lower, upper) = (of.map(|i| self.lower[i]), of.map(|i| self.upper[i]));
        let gradient = columns.map(|column| column.dot(self.difference));
        let metric: [[f32; N]; N] = core::array::from_fn(|i| {
            core::array::from_fn(|k| if (i < 2) == (k < 2) { columns[i].dot(columns[k]) } else { 0.0 })
        });
        let minimiser = |hessian| {
            let within = Quadratic { gradient, hessian, lower, upper }.minimiser()?;
            let slope = -gradient.iter().zip(&within).fold(0.0, |sum, (g, d)| sum + g * d);
            let mut step = [0.0; SIZE];
            of.into_iter().zip(within).for_each(|(i, moved)| step[i] = moved);
            Some((step, slope))
        };
        let mut best: Option<(Step, f32, f32)> = None;
        if pair.halvings == 0 {
            let newton = self.newton(&columns);
            for shift in SHIFTS {
                let shifted = core::array::from_fn(|i| core::array::from_fn(|k| newton[i][k] + shift * metric[i][k]));
                let Some((step, slope)) = minimiser(shifted) else { continue };
                let share = self.share(&step, slope, pair, body, region);
                if share >= 1.0 && slope > 0.0 {
                    return Some((step, slope));
                }
                consider(&mut best, step, slope, share);
            }
        }
        // Always positive: the tangents span a plane, or one of them is left out.
        let (step, slope) = minimiser(metric).unwrap_or(([0.0; SIZE], 0.0));
        let mut share = self.share(&step, slope, pair, body, region);
        if share <= 0.0 && best.is_none() {
            // Without bounds (next to a pole) the evaluation decides.
            share = 1.0;
        }
        consider(&mut best, step, slope, share / f32::from(1_u16 << pair.halvings));
        best.map(|(step, slope, share)| (step.map(|w| share * w), share * slope))
    }

    /// `H`: all products of the tangents, and the second derivatives.
    fn newton<const N: usize>(&self, columns: &[Vec3; N]) -> [[f32; N]; N] {
        let mut hessian = columns.map(|column| columns.map(|other| column.dot(other)));
        for (block, second) in self.second.iter().enumerate().take(N / 2) {
            let ([uu, uv, vv], i) = (second.along(self.difference), 2 * block);
            hessian[i][i] += uu;
            hessian[i][i + 1] += uv;
            hessian[i + 1][i] += uv;
            hessian[i + 1][i + 1] += vv;
        }
        hessian
    }

    /// The fraction of a step that is proved to lower `R ‖ΔR‖` by half of that fraction of the slope; 1 if the full
    /// step lowers it by a quarter. 0 without a proof.
    fn share(&self, step: &Step, slope: f32, pair: &Pair, body: &Body, region: &Region) -> f32 {
        let [u, v, r, s, _] = *step;
        let way = (0..SIZE).fold(Vec3::ZERO, |sum, i| sum + self.columns[i] * step[i]);
        let bend = self.second[0].bend([u, v]) + self.second[1].bend([r, s]);
        let (mut twist, mut jumps) = remainder(&patch_of(body, pair.a.face), pair.a.parameters, [u, v]);
        if let Region::Surface(core) = region {
            let of_core = remainder(&patch_of(core, pair.b.face), pair.b.parameters, [r, s]);
            (twist, jumps) = (twist + of_core.0, jumps + of_core.1);
        }
        let distance = sqrt_from_above(self.difference.length_squared());
        // `U(1)`, without the cancellation of its terms.
        let full = way + bend * 0.5;
        let certified = 0.5 * full.dot(self.difference * 2.0 + full) + distance * (twist * (1.0 / 6.0) + 0.5 * jumps);
        if certified <= -0.25 * slope {
            return 1.0;
        }
        let half = 0.5 * (way.length_squared() + self.difference.dot(bend) + distance * jumps);
        let cubic = 3.0 * way.dot(bend) + distance * twist;
        if !(half + cubic).is_finite() {
            return 0.0;
        }
        let steep = if cubic > 0.0 { cubic } else { 0.0 } + 0.75 * bend.length_squared();
        let share = slope / (half + sqrt_from_above(half * half + 0.5 * steep * slope));
        // Below 1: the full step is not certified.
        saturate(share, 0.0, 0.999)
    }
}

/// Bounds of `‖D³f[w, w, w]‖` and of what the jumps of the second derivatives add to `b` on the way.
fn remainder(patch: &SplinePatch, from: [f32; 2], [w_u, w_v]: [f32; 2]) -> (f32, f32) {
    let third = &patch.shape().third_derivatives;
    let (x, y) = (w_u.abs(), w_v.abs());
    let (xx, xy, yy) = (x * x, x * y, y * y);
    let along = |bound: f32, w: f32| if w > 0.0 { bound * w } else { 0.0 };
    let twist = along(third.uuu, x * xx)
        + 3.0 * along(third.uuv, x * xy)
        + 3.0 * along(third.uvv, y * xy)
        + along(third.vvv, y * yy);
    let [beyond_u, beyond_v] = patch.beyond_knots(from, [from[0] + w_u, from[1] + w_v]);
    (twist, along(third.jump_uu, beyond_u) + along(third.jump_vv, beyond_v))
}

fn consider(best: &mut Option<(Step, f32, f32)>, step: Step, slope: f32, share: f32) {
    let is_best = slope > 0.0 && best.is_none_or(|(_, known, of_it)| slope * share > known * of_it);
    if is_best && share > 0.0 && slope.is_finite() {
        *best = Some((step, slope, share));
    }
}
