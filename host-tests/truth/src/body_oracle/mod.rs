//! Bodies on the host: the truth in double precision, and which features claim a probe.

use crate::oracle::{ClosestPoint, Oracle, OraclePoint};
use glam::DVec3;
use palpate::body::{Body, CurvePoint, EdgeFace, Feature, Separator, Side, SplineCurve};
use palpate::math::Vec3;
use palpate_bake::NurbsPatch;
use std::f64::consts::TAU;

// Distance and side of closed polyhedra, by other means than patches.

/// The distance from a probe to a triangle: in its plane where the foot lies inside, else to the nearest of its sides.
pub fn triangle_distance(probe: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let is_within =
        [(a, b), (b, c), (c, a)].iter().all(|(from, to)| (*to - *from).cross(probe - *from).dot(normal) >= 0.0);
    if is_within {
        return (probe - a).dot(normal).abs() / normal.length();
    }
    [(a, b), (b, c), (c, a)].iter().map(|(from, to)| segment_distance(probe, *from, *to)).fold(f64::INFINITY, f64::min)
}

/// The distance from a probe to a segment.
pub fn segment_distance(probe: DVec3, from: DVec3, to: DVec3) -> f64 {
    let along = to - from;
    let t = ((probe - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    probe.distance(from + along * t)
}

/// How often closed triangles, anticlockwise seen from outside, wind around a probe: 1 inside, 0 outside, up to
/// rounding.
///
/// The solid angle `Ω` of a triangle has `tan Ω/2 = a·(b×c) / (|a||b||c| + (a·b)|c| + (b·c)|a| + (c·a)|b|)` (A. van
/// Oosterom and J. Strackee, *The solid angle of a plane triangle*, 1983).
pub fn winding_number(probe: DVec3, triangles: &[[DVec3; 3]]) -> f64 {
    let half_angle = |triangle: &[DVec3; 3]| {
        let [a, b, c] = triangle.map(|corner| corner - probe);
        let [x, y, z] = [a, b, c].map(DVec3::length);
        a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    triangles.iter().map(half_angle).sum::<f64>() / TAU
}

// The closest point of a whole body, in double precision.

/// One oracle a patch.
#[derive(Clone, Debug)]
pub struct BodyOracle<'a> {
    patches: &'a [NurbsPatch],
    oracles: Vec<Oracle<'a>>,
    /// Bounding boxes of the control points: weights are positive, so that they hold the patches.
    boxes: Vec<[DVec3; 2]>,
}

/// Points of several patches that differ by less than this part of the size are one.
const SAME: f64 = 1e-9;
/// Of the way to the middle of the patch.
const OFF_THE_BORDER: f64 = 1e-4;
/// The sine of an angle that turning by the curvature over that way can make up.
const IN_ITS_PLANE: f64 = 1e-3;

/// True answers for a probe.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The closest point of each patch.
    pub feet: Vec<ClosestPoint>,
    /// Index of the patch with the nearest.
    pub nearest: usize,
    /// Height of the probe over each patch's foot along the outward normal there, metres. At a pole, where there is no
    /// normal, NaN.
    pub heights: Vec<f64>,
}

impl Truth {
    /// The body's distance, metres.
    pub fn distance(&self) -> f64 {
        self.feet[self.nearest].distance
    }

    /// The closest point.
    pub fn point(&self) -> DVec3 {
        self.feet[self.nearest].point
    }

    /// Whether the probe is inside a closed convex body: behind every face.
    pub fn is_inside_convex(&self) -> bool {
        self.heights.iter().all(|height| is_behind(*height))
    }
}

impl<'a> BodyOracle<'a> {
    /// Samples every patch.
    pub fn new(patches: &'a [NurbsPatch]) -> Self {
        let bounds = |patch: &NurbsPatch| {
            let whole = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            patch.points.iter().fold(whole, |[low, high], point| [low.min(*point), high.max(*point)])
        };
        let boxes = patches.iter().map(bounds).collect();
        Self { patches, oracles: patches.iter().map(Oracle::new).collect(), boxes }
    }

    /// The closest point of the body and those of other patches that are at most `within` metres farther, with the
    /// patches' indices, the nearest first. Patches whose bounding box is too far are left out.
    pub fn nearest(&self, probe: DVec3, within: f64) -> Vec<(usize, ClosestPoint)> {
        let distance = |[low, high]: &[DVec3; 2]| probe.distance(probe.clamp(*low, *high));
        let mut order: Vec<_> = self.boxes.iter().map(distance).enumerate().collect();
        order.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut found: Vec<(usize, ClosestPoint)> = Vec::new();
        let mut least = f64::INFINITY;
        for (index, bound) in order {
            if bound > least + within {
                break;
            }
            let foot = self.oracles[index].closest(probe);
            least = least.min(foot.distance);
            found.push((index, foot));
        }
        found.retain(|(_, foot)| foot.distance <= least + within);
        found.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        found
    }

    /// Height of the probe over one patch's closest point, see [`Truth::heights`].
    pub fn height(&self, index: usize, probe: DVec3) -> f64 {
        height(&self.patches[index], &self.oracles[index].closest(probe), probe)
    }

    /// Whether the probe is inside a closed convex body; `nearest` is the patch with the closest point.
    pub fn is_inside_convex(&self, nearest: usize, probe: DVec3) -> bool {
        // Outside it is mostly the nearest that says so.
        let rest = (0..self.patches.len()).filter(|index| *index != nearest);
        std::iter::once(nearest).chain(rest).all(|index| is_behind(self.height(index, probe)))
    }

    /// Whether the probe is inside a closed body of any shape, by the outward normals of all patches that hold the
    /// closest point; `None` on the surface, and where these normals do not agree (at a vertex that is a saddle).
    pub fn is_inside(&self, probe: DVec3) -> Option<bool> {
        let nearest = self.nearest(probe, SAME * self.scale());
        let (_, foot) = nearest.first()?;
        let away = (probe - foot.point).try_normalize()?;
        let heights: Vec<f64> = nearest
            .iter()
            .map(|(index, foot)| {
                // A little way off the border: a pole has no normal.
                let [u, v] = foot.parameters.map(|parameter| parameter + OFF_THE_BORDER * (0.5 - parameter));
                away.dot(OraclePoint::evaluate(&self.patches[*index], u, v).normal(self.patches[*index].flip))
            })
            .collect();
        let sum: f64 = heights.iter().sum();
        // Beside an edge the probe may lie in the plane of one of its faces.
        let agree = heights.iter().all(|height| height * sum.signum() > -IN_ITS_PLANE);
        (agree && sum.abs() > IN_ITS_PLANE).then_some(sum < 0.0)
    }

    /// A length of about the body's size.
    fn scale(&self) -> f64 {
        self.boxes.iter().map(|[low, high]| (*high - *low).max_element()).fold(0.0, f64::max)
    }

    /// The truth about a probe, metres.
    pub fn closest(&self, probe: DVec3) -> Truth {
        let feet: Vec<_> = self.oracles.iter().map(|oracle| oracle.closest(probe)).collect();
        let nearest = (0..feet.len())
            .fold(0, |best, index| if feet[index].distance < feet[best].distance { index } else { best });
        let heights = self.patches.iter().zip(&feet).map(|(patch, foot)| height(patch, foot, probe)).collect();
        Truth { feet, nearest, heights }
    }
}

fn height(patch: &NurbsPatch, foot: &ClosestPoint, probe: DVec3) -> f64 {
    let [u, v] = foot.parameters;
    (probe - foot.point).dot(OraclePoint::evaluate(patch, u, v).normal(patch.flip))
}

/// A pole has no height, and never decides.
fn is_behind(height: f64) -> bool {
    height.is_nan() || height < 0.0
}

// Which features claim a probe for their Voronoi region, by the probe alone: the tables' word, solved to the end.

/// The features that claim a probe.
#[derive(Clone, Debug)]
pub struct Claims {
    /// Those that do.
    pub features: Vec<Feature>,
    /// The minimum absolute value of all decided tests, metres: near 0 the probe lies on a border between regions.
    pub margin: f32,
}

/// The closest point of an edge.
struct Foot {
    t: f32,
    at: CurvePoint,
}

/// Starts on an edge.
const STARTS: u32 = 32;

/// All claims on a probe outside the body. A face claims no probe behind it: `is_behind` says so of a face, and is
/// asked only where it matters.
pub fn claims(body: &Body, probe: Vec3, is_behind: impl Fn(usize) -> bool) -> Claims {
    let mut margin = f32::INFINITY;
    let mut features = Vec::new();
    let feet: Vec<Foot> = body.edges().iter().map(|edge| foot(&edge.curve, probe)).collect();
    for (index, face) in body.faces().iter().enumerate() {
        let sides = face.sides.iter().filter_map(|side| match side {
            Side::Pole { .. } => None,
            Side::Edge { edge, separator, .. } => Some(beyond(separator, &feet[usize::from(*edge)], probe)),
        });
        let (mut left, mut least) = (false, f32::INFINITY);
        for beyond in sides {
            (left, least) = (left || beyond > 0.0, least.min(beyond.abs()));
        }
        if (left && least >= margin) || is_behind(index) {
            continue;
        }
        margin = margin.min(least);
        if !left {
            features.push(Feature::Face(index as u16));
        }
    }
    let mut positive = |value: f32| {
        margin = margin.min(value.abs());
        value > 0.0
    };
    for (index, (edge, foot)) in body.edges().iter().zip(&feet).enumerate() {
        let inner = foot.t > 0.0 && foot.t < 1.0;
        let left = |of: EdgeFace, positive: &mut dyn FnMut(f32) -> bool| {
            side_of(body, of).is_none_or(|separator| positive(beyond(separator, foot, probe)))
        };
        if inner && edge.faces.into_iter().all(|of| left(of, &mut positive)) {
            features.push(Feature::Edge(index as u16));
        }
    }
    for (index, vertex) in body.vertices().iter().enumerate() {
        let first = usize::from(vertex.first_spoke);
        let spokes = &body.spokes()[first..first + usize::from(vertex.spokes)];
        if spokes.iter().all(|spoke| !positive((probe - vertex.point).dot(spoke.direction))) {
            features.push(Feature::Vertex(index as u16));
        }
    }
    Claims { features, margin }
}

fn side_of<'a>(body: &'a Body<'_>, of: EdgeFace) -> Option<&'a Separator<'a>> {
    match body.faces().get(usize::from(of.face))?.sides.get(usize::from(of.side))? {
        Side::Edge { separator, .. } => Some(separator),
        Side::Pole { .. } => None,
    }
}

/// How far the probe is beyond a separator, metres.
fn beyond(separator: &Separator, foot: &Foot, probe: Vec3) -> f32 {
    match separator {
        Separator::Plane { across, offset } => (across.dot(probe) - offset) / across.length(),
        Separator::Ruled(cross) => {
            let (cross, tangent) = (cross.evaluate(foot.t).point, foot.at.tangent);
            let conormal = cross - tangent * (cross.dot(tangent) / tangent.length_squared());
            (probe - foot.at.point).dot(conormal.normalize_or_zero())
        }
    }
}

/// The closest point of a curve: the best of many starts, by Gauss and Newton's steps halved until they help.
fn foot(curve: &SplineCurve, probe: Vec3) -> Foot {
    let distance = |t: f32| curve.evaluate(t).point.distance_squared(probe);
    let starts = (0..=STARTS).map(|step| step as f32 / STARTS as f32);
    let mut t = starts.fold(0.0, |best, t| if distance(t) < distance(best) { t } else { best });
    for _ in 0..40 {
        let at = curve.evaluate(t);
        let mut change = (probe - at.point).dot(at.tangent) / at.tangent.length_squared();
        let best = distance(t);
        while change.abs() > 1e-8 && distance((t + change).clamp(0.0, 1.0)) > best {
            change *= 0.5;
        }
        let next = (t + change).clamp(0.0, 1.0);
        if next == t || change.abs() <= 1e-8 {
            break;
        }
        t = next;
    }
    // Single precision sees the least distance only to the root of its resolution, but where the slope vanishes to all
    // of it. The best of several lengths: the whole step turns the slope round where the edge is curved as much as the
    // probe is far.
    let slope = |t: f32| {
        let at = curve.evaluate(t);
        ((probe - at.point).dot(at.tangent), at.tangent.length_squared())
    };
    for _ in 0..40 {
        let (here, stretch) = slope(t);
        let steps = (0..16).map(|index| (t + here / stretch * 0.75_f32.powi(index)).clamp(0.0, 1.0));
        let least = |best: (f32, f32), next: f32| {
            let after = slope(next).0.abs();
            if after < best.1 { (next, after) } else { best }
        };
        let (next, _) = steps.fold((t, here.abs()), least);
        if next == t {
            break;
        }
        t = next;
    }
    Foot { t, at: curve.evaluate(t) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_winds_once_around_what_is_inside() {
        let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let faces = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
        assert!((winding_number(DVec3::splat(0.1), &faces) - 1.0).abs() < 1e-12);
        assert!(winding_number(DVec3::splat(0.4), &faces).abs() < 1e-12);
        assert!(winding_number(DVec3::new(-0.1, 0.2, 0.2), &faces).abs() < 1e-12);
        assert!((triangle_distance(DVec3::splat(1.0), faces[3]) - 2.0 / 3.0_f64.sqrt()).abs() < 1e-12);
        assert!((triangle_distance(DVec3::new(3.0, -1.0, 0.0), faces[3]) - 5.0_f64.sqrt()).abs() < 1e-12);
    }
}
