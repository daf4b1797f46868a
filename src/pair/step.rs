//! The joint step of both witness points, and its certificate.
//!
//! `x` are the parameters of the body's point `f(x)`, `y` the coordinates of the core's point `h(y)`: parameters of a
//! face, or coordinates in a solid. With `d` the step in both, `a = Df d_A − Dh d_B`, `b = D²f[d_A, d_A] − D²h[d_B,
//! d_B]` and `s = −gᵀd`, the difference `ΔR = f − h` is a quadratic plus a remainder, so that theory §12's lemma holds
//! as it stands (§14): `R (‖ΔR(t d)‖ − R) ≤ −s t + …`. A solid's `h` is linear, and has no remainder.

use super::quadratic::{Block, Bordered, Quadratic, SIZE, Step};
use super::tool::Region;
use crate::body::Body;
use crate::math::{Vec3, saturate, sqrt, sqrt_from_above, vec3};
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

pub(super) fn patch_of<'a>(body: &Body<'a>, face: u16) -> &'a SplinePatch<'a> {
    body.faces().get(usize::from(face)).map_or(const { &SplinePatch::VACANT }, |face| &face.patch)
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
        let plan = match region {
            Region::Solid { half: Vec3::ZERO, .. } => joint.plan(self, body, region, |shift| joint.of_point(shift)),
            Region::Solid { .. } => joint.plan(self, body, region, |shift| joint.bordered(shift)),
            Region::Surface(_) => joint.plan(self, body, region, |shift| joint.full(shift)),
        };
        let Some((step, promise)) = plan else { return Moved::AtRest };
        let [u, v, r, s, _] = step;
        let moved = |at: [f32; 2], w: [f32; 2]| [at[0] + w[0], at[1] + w[1]];
        let [u, v] = moved(self.a.parameters, [u, v]).map(|parameter| saturate(parameter, 0.0, 1.0));
        let curved = patch_of(body, self.a.face).evaluate_apart::<KindSet<ALL_KINDS>>([u, v]);
        let core = match region {
            Region::Solid { .. } => None,
            Region::Surface(core) => Some(Foot::on(core, self.b.face, moved(self.b.parameters, [r, s]))),
        };
        // The projection on a solid is at least as near as the step's own end.
        let b = match &core {
            Some(foot) => foot.point(),
            None => region.nearest(placement.point_to_b(curved.surface.point)).0,
        };
        let size = body.size() + placement.origin.abs().max_element();
        let rise = (curved.surface.point - placement.point_to_a(b)).length_squared() - squared;
        // Near contact the points' own rounding is the distance.
        let rounding = ROUNDING * size;
        let is_no_rise = rise <= rounding * (sqrt(squared) + rounding);
        if !is_no_rise {
            self.halvings = if self.halvings < MAX_HALVINGS { self.halvings + 1 } else { MAX_HALVINGS };
            return Moved::Rejected;
        }
        (self.a.parameters, self.a.curved, self.halvings) = ([u, v], curved, 0);
        match core {
            Some(foot) => self.b = foot,
            None => self.b.curved.surface.point = b,
        }
        let resolved = RESOLUTION * body.size();
        if promise <= resolved * (sqrt(squared) + resolved) { Moved::AtRest } else { Moved::Nearer }
    }
}

/// The start of a step: `ΔR` with its derivatives in all variables; in the frame of a solid, otherwise in the body's.
struct Joint<'a> {
    placement: &'a Placement,
    difference: Vec3,
    /// Of the body's parameters, and of a core's that is a body.
    columns: [Vec3; 4],
    /// Second derivatives of `f`, in the body's frame, and of `−h`.
    second: (&'a SecondDerivatives, Option<SecondDerivatives>),
    /// `ΔR · D²f`.
    bend: [f32; 3],
    lower: Step,
    upper: Step,
}

impl<'a> Joint<'a> {
    fn new(pair: &'a Pair, body: &Body, region: &Region, placement: &'a Placement) -> Self {
        let ([u, v], f) = (pair.a.parameters, &pair.a.curved);
        let difference = pair.difference(placement);
        let [f_u, f_v] = [f.surface.tangent_u, f.surface.tangent_v];
        let mut joint = Self {
            placement,
            difference,
            columns: [f_u, f_v, Vec3::ZERO, Vec3::ZERO],
            bend: f.second.along(difference),
            second: (&f.second, None),
            lower: [-u, -v, 0.0, 0.0, 0.0],
            upper: [1.0 - u, 1.0 - v, 0.0, 0.0, 0.0],
        };
        // Along a vanishing tangent nothing moves.
        let shortest = NO_TANGENT * body.size();
        let moves = |tangent: Vec3| tangent.length_squared() > shortest * shortest;
        match region {
            Region::Solid { middle, half } => {
                let [low, high] = [*middle - *half - pair.b.point(), *middle + *half - pair.b.point()];
                joint.lower = [-u, -v, low.x, low.y, low.z];
                joint.upper = [1.0 - u, 1.0 - v, high.x, high.y, high.z];
                for i in 2..SIZE {
                    if joint.upper[i] <= joint.lower[i] {
                        (joint.lower[i], joint.upper[i]) = (0.0, 0.0);
                    }
                }
                joint.difference = placement.direction_to_b(difference);
                (joint.columns[0], joint.columns[1]) = (placement.direction_to_b(f_u), placement.direction_to_b(f_v));
            }
            Region::Surface(_) => {
                let ([r, s], CurvedPoint { surface, second }) = (pair.b.parameters, &pair.b.curved);
                let turned = |direction| -placement.direction_to_a(direction);
                (joint.columns[2], joint.columns[3]) = (turned(surface.tangent_u), turned(surface.tangent_v));
                let SecondDerivatives { half_uu, uv, half_vv } = *second;
                let second = SecondDerivatives { half_uu: turned(half_uu), uv: turned(uv), half_vv: turned(half_vv) };
                joint.second.1 = Some(second);
                (joint.lower[2], joint.upper[2]) = (-r, 1.0 - r);
                (joint.lower[3], joint.upper[3]) = (-s, 1.0 - s);
                for i in 2..4 {
                    if !moves(joint.columns[i]) {
                        (joint.lower[i], joint.upper[i]) = (0.0, 0.0);
                    }
                }
            }
        }
        for i in 0..2 {
            if !moves(joint.columns[i]) {
                (joint.lower[i], joint.upper[i]) = (0.0, 0.0);
            }
        }
        joint
    }

    /// The minimiser of the model `H + σ J`, or of `J` alone, and its slope; of a solid.
    fn bordered(&self, shift: Option<f32>) -> Option<(Step, f32)> {
        let ([t_u, t_v, ..], away) = (self.columns, -self.difference);
        let metric = [t_u.length_squared(), t_u.dot(t_v), t_v.length_squared()];
        let gradient = [t_u.dot(self.difference), t_v.dot(self.difference), away.x, away.y, away.z];
        let hessian = match shift {
            Some(shift) => Bordered {
                block: core::array::from_fn(|i| metric[i] + self.bend[i] + shift * metric[i]),
                tangents: [t_u, t_v],
                stiff: [1.0 + shift, if shift > 0.0 { 1.0 / (1.0 + shift) } else { 1.0 }],
            },
            None => Bordered { block: metric, tangents: [Vec3::ZERO; 2], stiff: [1.0; 2] },
        };
        let step = Quadratic { gradient, hessian, lower: self.lower, upper: self.upper }.minimiser()?;
        Some((step, -(0..SIZE).fold(0.0, |sum, i| sum + gradient[i] * step[i])))
    }

    /// The same of a point, which has no coordinates to move.
    fn of_point(&self, shift: Option<f32>) -> Option<(Step, f32)> {
        let [t_u, t_v, ..] = self.columns;
        let metric = [t_u.length_squared(), t_u.dot(t_v), t_v.length_squared()];
        let gradient = [t_u.dot(self.difference), t_v.dot(self.difference)];
        let block = match shift {
            Some(shift) => core::array::from_fn(|i| metric[i] + self.bend[i] + shift * metric[i]),
            None => metric,
        };
        let [lower, upper] = [&self.lower, &self.upper].map(|bound| [bound[0], bound[1]]);
        let [u, v] = Quadratic { gradient, hessian: Block(block), lower, upper }.minimiser()?;
        Some(([u, v, 0.0, 0.0, 0.0], -(0.0 + gradient[0] * u + gradient[1] * v)))
    }

    /// The same of a core that is a body.
    fn full(&self, shift: Option<f32>) -> Option<(Step, f32)> {
        let columns = &self.columns;
        let gradient = columns.map(|column| column.dot(self.difference));
        let of_core = self.second.1.map_or([0.0; 3], |second| second.along(self.difference));
        let metric = |i: usize, k: usize| if (i < 2) == (k < 2) { columns[i].dot(columns[k]) } else { 0.0 };
        let hessian: [[f32; 4]; 4] = match shift {
            Some(shift) => {
                let mut hessian = columns.map(|column| columns.map(|other| column.dot(other)));
                for (i, [uu, uv, vv]) in [(0, self.bend), (2, of_core)] {
                    hessian[i][i] += uu;
                    hessian[i][i + 1] += uv;
                    hessian[i + 1][i] += uv;
                    hessian[i + 1][i + 1] += vv;
                }
                core::array::from_fn(|i| core::array::from_fn(|k| hessian[i][k] + shift * metric(i, k)))
            }
            None => core::array::from_fn(|i| core::array::from_fn(|k| metric(i, k))),
        };
        let [lower, upper] = [&self.lower, &self.upper].map(|bound| core::array::from_fn(|i| bound[i]));
        let step = Quadratic { gradient, hessian, lower, upper }.minimiser()?;
        let slope = -(0..4).fold(0.0, |sum, i| sum + gradient[i] * step[i]);
        Some(([step[0], step[1], step[2], step[3], 0.0], slope))
    }

    /// The step with the largest proved promise, and the largest promise of a model; `None` if none promises anything.
    /// Where the bounds allow but a small fraction of a step, the pair is not at rest.
    fn plan(
        &self,
        pair: &Pair,
        body: &Body,
        region: &Region,
        minimiser: impl Fn(Option<f32>) -> Option<(Step, f32)>,
    ) -> Option<(Step, f32)> {
        let mut best: Option<(Step, f32, f32)> = None;
        let mut promise = 0.0;
        if pair.halvings == 0 {
            for shift in SHIFTS {
                let Some((step, slope)) = minimiser(Some(shift)) else { continue };
                let share = self.share(&step, slope, pair, body, region);
                promise = largest(promise, slope);
                if share >= 1.0 && slope > 0.0 {
                    return Some((step, promise));
                }
                consider(&mut best, step, slope, share);
            }
        }
        // Always positive: the tangents span a plane, or one of them is left out.
        let (step, slope) = minimiser(None).unwrap_or(([0.0; SIZE], 0.0));
        let mut share = self.share(&step, slope, pair, body, region);
        if share <= 0.0 && best.is_none() {
            // Without bounds (next to a pole) the evaluation decides.
            share = 1.0;
        }
        consider(&mut best, step, slope, share / f32::from(1_u16 << pair.halvings));
        promise = largest(promise, slope);
        best.map(|(step, _, share)| (step.map(|w| share * w), promise))
    }

    /// The fraction of a step that is proved to lower `R ‖ΔR‖` by half of that fraction of the slope; 1 if the full
    /// step lowers it by a quarter. 0 without a proof.
    fn share(&self, step: &Step, slope: f32, pair: &Pair, body: &Body, region: &Region) -> f32 {
        let [u, v, r, s, t] = *step;
        let of_body = self.columns[0] * u + self.columns[1] * v;
        let (way, bend) = match region {
            Region::Solid { .. } => {
                (of_body - vec3(r, s, t), self.placement.direction_to_b(self.second.0.bend([u, v])))
            }
            Region::Surface(_) => {
                let way = of_body + self.columns[2] * r + self.columns[3] * s;
                let of_core = self.second.1.map_or(Vec3::ZERO, |second| second.bend([r, s]));
                (way, self.second.0.bend([u, v]) + of_core)
            }
        };
        let (mut twist, mut jumps) = remainder(patch_of(body, pair.a.face), pair.a.parameters, [u, v]);
        if let Region::Surface(core) = region {
            let of_core = remainder(patch_of(core, pair.b.face), pair.b.parameters, [r, s]);
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

/// The larger number, or the one that is a number.
fn largest(known: f32, other: f32) -> f32 {
    if other > known { other } else { known }
}

fn consider(best: &mut Option<(Step, f32, f32)>, step: Step, slope: f32, share: f32) {
    let is_best = slope > 0.0 && best.is_none_or(|(_, known, of_it)| slope * share > known * of_it);
    if is_best && share > 0.0 && slope.is_finite() {
        *best = Some((step, slope, share));
    }
}
