//! Which features claim a probe for their Voronoi region, by the probe alone: the tables' word, solved to the end.

use palpate::body::{Body, CurvePoint, EdgeFace, Feature, Separator, Side, SplineCurve};
use palpate::math::Vec3;

/// The features that claim a probe.
#[derive(Clone, Debug)]
pub struct Claims {
    /// Those that do.
    pub features: Vec<Feature>,
    /// The least absolute value of all tests that were decided, metres: near 0 the probe lies on a border between
    /// regions.
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
