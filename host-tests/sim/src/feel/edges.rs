//! Hands that cross the edges of a body: found on its tables, longest first.

use super::hand::Legs;
use super::script::{Deed, Script, Stage};
use crate::plant::Vector;
use palpate::body::{Body, Edge, EdgeFace, EdgeKind, Face};
use palpate::math::Vec3;
use palpate::patch::Patch as _;

/// Distance from an edge at which the hand comes down, and to which it goes on, m; less on a small face.
const REACH: f64 = 0.012;
/// Height of the hand over the surface at the start, m.
const ABOVE: f64 = 0.01;
/// Points along a way.
const POINTS: usize = 24;
/// Force with which the hand presses, N.
const PUSH: f64 = 0.7;
/// Speed around an edge, m/s.
const ROUNDING: f64 = 0.03;
/// Name of the way round a convex edge.
pub const ROUND: &str = "round a convex edge";
/// Maximum difference of the normals at the middle of a smooth seam, rad.
const SMOOTH: f64 = 0.02;

/// A way on a face towards the middle of one of its edges: points and normals, the last of them on the edge.
type Way = Vec<(Vector, Vector)>;

/// Scripts over the longest convex edge, concave edge and smooth seam of a body, and off it over a corner, as far as it
/// has them; its origin lies at `origin` in the device's frame, m.
pub fn over_edges(body: &Body<'_>, origin: Vec3, stage: &Stage) -> Vec<Script> {
    let mut scripts = Vec::new();
    let origin = origin.to_array().map(f64::from);
    let placed = |way: Way| -> Way {
        way.into_iter().map(|(point, normal)| (core::array::from_fn(|i| point[i] + origin[i]), normal)).collect()
    };
    let ways = |edge: &Edge<'_>| -> Option<[Way; 2]> {
        let way = |side: EdgeFace| Some(placed(towards(body.faces().get(usize::from(side.face))?, side.side)));
        let [Some(from), Some(to)] = edge.faces.map(way) else { return None };
        Some([from, to])
    };
    let longest = |kinds: &[EdgeKind], is_smooth: bool| {
        let fitting = body.edges().iter().filter(|edge| kinds.contains(&edge.kind));
        let crossings = fitting.filter_map(|edge| Some((length_of(edge), ways(edge)?)));
        let same = crossings.filter(|(_, ways)| (turn(ways) < SMOOTH) == is_smooth);
        same.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, ways)| ways)
    };
    if let Some(ways) = longest(&[EdgeKind::Convex], false) {
        for speed in [0.05, 0.1, 0.3] {
            scripts.push(off(format!("off an edge {speed} m/s"), &ways[0], speed, stage));
        }
        scripts.push(across(ROUND, &ways, stage));
    }
    if let Some(ways) = longest(&[EdgeKind::Reflex], false) {
        scripts.push(across("into a concave edge", &ways, stage));
    }
    if let Some(ways) = longest(&[EdgeKind::Smooth, EdgeKind::Mixed], true) {
        scripts.push(across("over a smooth seam", &ways, stage));
    }
    let corner = |face: &Face<'_>| placed(towards_corner(face));
    if longest(&[EdgeKind::Convex], false).is_some()
        && let Some(face) = body.faces().first()
    {
        scripts.push(off("off a corner 0.1 m/s".into(), &corner(face), 0.1, stage));
    }
    scripts
}

/// The angle between the two normals at an edge, rad.
fn turn([from, to]: &[Way; 2]) -> f64 {
    from.last().zip(to.last()).map_or(0.0, |(from, to)| super::figures::angle(from.1, to.1))
}

fn length_of(edge: &Edge<'_>) -> f64 {
    let point = |index: usize| edge.curve.point(index as f32 / 16.0);
    (0..16).map(|index| f64::from((point(index + 1) - point(index)).length())).sum()
}

/// From the inside of a face to the middle of one of its borders.
fn towards(face: &Face<'_>, side: u8) -> Way {
    let across = |inside: f32| match side {
        0 => [inside, 0.5],
        1 => [1.0 - inside, 0.5],
        2 => [0.5, inside],
        _ => [0.5, 1.0 - inside],
    };
    way(face, across)
}

/// From the inside of a face to the corner `(0, 0)`.
fn towards_corner(face: &Face<'_>) -> Way {
    way(face, |inside| [inside, inside])
}

/// From where a face is so far from its border, at most half of it, to the border.
fn way(face: &Face<'_>, across: impl Fn(f32) -> [f32; 2]) -> Way {
    let at = |inside: f32| {
        let [u, v] = across(inside);
        let point = face.patch.evaluate(u, v);
        // At the very border a tangent may vanish: the normal is that just inside of it.
        let [u, v] = across(inside.max(1e-3));
        let near = face.patch.evaluate(u, v);
        let normal = near.tangent_u.cross(near.tangent_v).normalize_or_zero() * face.patch.orientation();
        (point.point.to_array().map(f64::from), normal.to_array().map(f64::from))
    };
    let border = at(0.0).0;
    let distance = |inside: f32| (0..3).map(|i| (at(inside).0[i] - border[i]).powi(2)).sum::<f64>().sqrt();
    let start = (1..=50).map(|step| step as f32 * 0.01).find(|inside| distance(*inside) >= REACH).unwrap_or(0.5);
    (0..=POINTS).map(|index| at(start * (1.0 - index as f32 / POINTS as f32))).collect()
}

fn lifted((point, normal): &(Vector, Vector), height: f64) -> Vector {
    core::array::from_fn(|i| point[i] + normal[i] * height)
}

/// Comes down at the start of a way and presses along it.
fn pressed(way: &Way, speed: f64, stage: &Stage) -> (Legs, f64) {
    let depth = -stage.aim(PUSH);
    let (Some(first), rest) = (way.first(), way.iter().skip(1)) else { return (Legs::from([0.0; 3]), 0.0) };
    let down = Legs::from(lifted(first, ABOVE)).wait(0.3).at_speed(lifted(first, depth), 0.05).wait(0.3);
    let begin = down.end();
    (rest.fold(down, |legs, place| legs.at_speed(lifted(place, depth), speed)), begin)
}

/// Along the way and straight on, off the body.
fn off(name: String, way: &Way, speed: f64, stage: &Stage) -> Script {
    let (legs, begin) = pressed(way, speed, stage);
    let [.., before, last] = way.as_slice() else {
        return Script { name, deed: Deed::Off(speed), path: legs, looked_at: [begin, begin] };
    };
    let depth = -stage.aim(PUSH);
    let [from, to] = [before, last].map(|place| lifted(place, depth));
    let step = (0..3).map(|i| (to[i] - from[i]).powi(2)).sum::<f64>().sqrt();
    let beyond = core::array::from_fn(|i| to[i] + (to[i] - from[i]) / step * REACH);
    let path = legs.at_speed(beyond, speed).wait(0.2);
    let end = path.end();
    Script { name, deed: Deed::Off(speed), path, looked_at: [begin, end] }
}

/// Along one way and on along the other, back to front.
fn across(name: &str, ways: &[Way; 2], stage: &Stage) -> Script {
    let (legs, begin) = pressed(&ways[0], ROUNDING, stage);
    let depth = -stage.aim(PUSH);
    let path = ways[1].iter().rev().fold(legs, |legs, place| legs.at_speed(lifted(place, depth), ROUNDING));
    let until = path.end();
    let normals = [&ways[0], &ways[1]].map(|way| way.last().map_or([0.0; 3], |place| place.1));
    let turned = (turn(ways) > SMOOTH).then_some(normals);
    Script { name: name.into(), deed: Deed::Across(turned), path, looked_at: [begin + 0.1, until] }
}
