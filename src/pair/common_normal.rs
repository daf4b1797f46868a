//! Where two smooth convex bodies intersect: the pair of points whose normals are opposite and whose difference is
//! along them, by Newton's method. Its depth is the smallest translation that separates the bodies.
//!
//! Unlike the closest pair it is no minimum of the distance (theory §7), so that no Lyapunov function guards it: starts
//! come from the support points of sampled normals. Regular through contact where the curvatures do not both vanish.

use super::step::{Foot, Pair};
use crate::body::{Body, EdgeKind};
use crate::math::{Vec3, saturate};
use crate::track::Placement;

/// Samples of a face along each parameter, for starts.
const SAMPLES: u16 = 4;
/// Starts of which the shallowest are followed.
const STARTS: usize = 8;
/// Maximum Newton steps from one start.
const MAX_STEPS: usize = 16;
/// Relative to the size: the largest residual of a solution, a multiple of the rounding of coordinates.
const SOLVED: f32 = 2.0e-6;

/// Whether the law holds: both convex, without sharp edges.
pub(super) fn is_smooth(body: &Body) -> bool {
    body.is_convex() && body.edges().iter().all(|edge| edge.kind == EdgeKind::Smooth)
}

/// Depth of the common normal that the pair is on, metres, after at most `steps` of Newton; `None` if it was not
/// reached. Counts evaluations.
pub(super) fn follow(
    pair: &mut Pair,
    body: &Body,
    core: &Body,
    placement: &Placement,
    steps: usize,
    evaluations: &mut u32,
) -> Option<f32> {
    for _ in 0..steps {
        let Some(step) = newton(pair, placement) else { break };
        advance(&mut pair.a, body, [step[0], step[1]]);
        advance(&mut pair.b, core, [step[2], step[3]]);
        *evaluations += 2;
    }
    let difference = pair.difference(placement);
    let normal = pair.a.unit_normal(body);
    let other = placement.direction_to_a(pair.b.unit_normal(core));
    let depth = difference.dot(normal);
    let (slide, mismatch) = (difference - normal * depth, normal + other);
    let solved = SOLVED * body.size();
    let is_solved = slide.length_squared() <= solved * solved && mismatch.length_squared() <= 1.0e-6;
    is_solved.then_some(depth)
}

/// The shallowest common normal of two smooth convex bodies that intersect, and its depth.
pub(super) fn locate(body: &Body, core: &Body, placement: &Placement, evaluations: &mut u32) -> Option<(Pair, f32)> {
    let mut starts: [Option<(f32, Pair)>; STARTS] = [None; STARTS];
    for a in samples(body) {
        *evaluations += 1;
        let normal = a.unit_normal(body);
        let towards = placement.direction_to_b(-normal);
        let mut farthest: Option<(f32, Foot)> = None;
        for b in samples(core) {
            let along = b.point().dot(towards);
            if farthest.is_none_or(|(most, _)| along > most) {
                farthest = Some((along, b));
            }
        }
        *evaluations += core.faces().len() as u32 * u32::from(SAMPLES * SAMPLES);
        let Some((_, b)) = farthest else { continue };
        let pair = Pair { a, b, halvings: 0 };
        let depth = pair.difference(placement).dot(normal);
        let mut entering = Some((depth, pair));
        for slot in &mut starts {
            if let Some((depth, _)) = entering
                && slot.is_none_or(|(known, _)| depth < known)
            {
                entering = core::mem::replace(slot, entering);
            }
        }
    }
    let mut best: Option<(Pair, f32)> = None;
    for (_, mut pair) in starts.into_iter().flatten() {
        if let Some(depth) = follow(&mut pair, body, core, placement, MAX_STEPS, evaluations)
            && best.is_none_or(|(_, known)| depth < known)
        {
            best = Some((pair, depth));
        }
    }
    best
}

fn samples<'a>(body: &'a Body) -> impl Iterator<Item = Foot> + 'a {
    let at = |index: u16| (f32::from(index) + 0.5) / f32::from(SAMPLES);
    let faces = 0..body.faces().len() as u16;
    faces.flat_map(move |face| {
        (0..SAMPLES * SAMPLES).map(move |index| Foot::on(body, face, [at(index / SAMPLES), at(index % SAMPLES)]))
    })
}

/// Newton's step of `ΔR·f_u = ΔR·f_v = n_A·h_r = n_A·h_s = 0` with `n_A = f_u × f_v`.
fn newton(pair: &Pair, placement: &Placement) -> Option<[f32; 4]> {
    let (f, d2f) = (&pair.a.curved.surface, &pair.a.curved.second);
    let (h, d2h) = (&pair.b.curved.surface, &pair.b.curved.second);
    let difference = pair.difference(placement);
    let normal = f.tangent_u.cross(f.tangent_v);
    let [h_r, h_s] = [h.tangent_u, h.tangent_v].map(|tangent| placement.direction_to_a(tangent));
    let [h_rr, h_rs, h_ss] =
        [d2h.half_uu * 2.0, d2h.uv, d2h.half_vv * 2.0].map(|second| placement.direction_to_a(second));
    let [f_uu, f_uv, f_vv] = [d2f.half_uu * 2.0, d2f.uv, d2f.half_vv * 2.0];
    let normal_u = f_uu.cross(f.tangent_v) + f.tangent_u.cross(f_uv);
    let normal_v = f_uv.cross(f.tangent_v) + f.tangent_u.cross(f_vv);
    let of_difference = |tangent: Vec3, by_u: Vec3, by_v: Vec3| {
        [
            f.tangent_u.dot(tangent) + difference.dot(by_u),
            f.tangent_v.dot(tangent) + difference.dot(by_v),
            -h_r.dot(tangent),
            -h_s.dot(tangent),
            -difference.dot(tangent),
        ]
    };
    let of_normal = |tangent: Vec3, by_r: Vec3, by_s: Vec3| {
        [normal_u.dot(tangent), normal_v.dot(tangent), normal.dot(by_r), normal.dot(by_s), -normal.dot(tangent)]
    };
    let rows = [
        of_difference(f.tangent_u, f_uu, f_uv),
        of_difference(f.tangent_v, f_uv, f_vv),
        of_normal(h_r, h_rr, h_rs),
        of_normal(h_s, h_rs, h_ss),
    ];
    solve(rows)
}

/// Four equations, with pivots by rows; the right side last.
fn solve(mut rows: [[f32; 5]; 4]) -> Option<[f32; 4]> {
    for row in &mut rows {
        let largest = row[..4].iter().fold(0.0_f32, |largest, x| if x.abs() > largest { x.abs() } else { largest });
        *row = row.map(|x| x / largest);
    }
    for i in 0..4 {
        let pivot = (i..4).fold(i, |best, k| if rows[k][i].abs() > rows[best][i].abs() { k } else { best });
        rows.swap(i, pivot);
        let is_regular = rows[i][i].abs() > 1.0e-6;
        if !is_regular {
            return None;
        }
        let above = rows[i];
        for row in &mut rows[i + 1..] {
            let share = row[i] / above[i];
            for (x, above) in row.iter_mut().zip(above) {
                *x -= share * above;
            }
        }
    }
    let mut found = [0.0; 4];
    for i in (0..4).rev() {
        let rest = (i + 1..4).fold(rows[i][4], |rest, k| rest - rows[i][k] * found[k]);
        found[i] = rest / rows[i][i];
    }
    found.iter().all(|x| x.is_finite()).then_some(found)
}

/// Moves a point by a change of its parameters, at most to the border, and over it if the change leads there.
fn advance(foot: &mut Foot, body: &Body, [w_u, w_v]: [f32; 2]) {
    let [u, v] = foot.parameters;
    let way = foot.curved.surface.along([w_u, w_v]);
    let next = [saturate(u + w_u, 0.0, 1.0), saturate(v + w_v, 0.0, 1.0)];
    *foot = Foot::on(body, foot.face, next);
    foot.hand_over(body, way);
}
