//! Outlines that touch themselves: refused at once, with the edges and their distance.
//!
//! A face that passes one vertex twice has no width there, and no division into quads exists. A strip between two edges
//! nearer than the tolerance needs a smaller one, or the curves beside it might cross.

use crate::error::ImportError;
use crate::part::{Edge, Part, Use};
use crate::patches::STRAIGHT;
use glam::DVec3;
use std::collections::HashMap;

/// Samples of an edge that is compared with another.
const SAMPLES: usize = 32;
/// Edges of one face that are compared in pairs; one with more is left to the search.
const MOST_EDGES: usize = 256;
/// The curves on both sides of a gap stray by a tolerance each.
pub const TOLERANCES_IN_A_GAP: f64 = 3.0;
/// The narrowest gap for which the tolerance is lowered, as a part of it: patches and time grow as it falls.
const NARROWEST: f64 = 0.1;

/// A strip narrower than the tolerance.
#[derive(Debug)]
pub struct Gap {
    /// Millimetres.
    pub width: f64,
    /// Face, edges, place and width.
    pub reason: String,
}

/// Refuses faces whose outlines touch themselves, within a tenth of `tolerance`, millimetres; gives the narrowest gap
/// below it.
///
/// # Errors
/// The first such face, with the edges, where, and how far apart.
pub fn refuse(part: &Part, tolerance: f64) -> Result<Option<Gap>, ImportError> {
    let mut narrowest: Option<Gap> = None;
    for face in 0..part.faces.len() {
        refuse_pinched(part, face)?;
        if let Some(gap) = refuse_close(part, face, tolerance)?
            && narrowest.as_ref().is_none_or(|other| gap.width < other.width)
        {
            narrowest = Some(gap);
        }
    }
    Ok(narrowest)
}

/// A vertex that the outline passes twice. Where the face has an edge twice, as along a crease, that is no pinch.
fn refuse_pinched(part: &Part, face: usize) -> Result<(), ImportError> {
    let of = &part.faces[face];
    let mut arriving: HashMap<usize, Use> = HashMap::new();
    let twice = |used: &Use| of.loops.iter().flatten().filter(|other| other.edge == used.edge).count() > 1;
    for used in of.loops.iter().flatten() {
        let vertex = part.ends(*used)[1];
        let Some(other) = arriving.insert(vertex, *used) else { continue };
        let at_vertex = |used: &&Use| part.edges[used.edge].ends.contains(&vertex);
        if of.loops.iter().flatten().filter(at_vertex).any(twice) {
            continue;
        }
        let [first, second] = [other, *used].map(|used| part.edges[used.edge].label(used.edge));
        let reason = format!(
            "its outline touches itself at {}: its {first} and its {second} are 0 mm apart there, and what lies \
             between has no width; move them apart in the CAD program",
            place(part.vertices[vertex])
        );
        return Err(ImportError::face(of.label(), reason));
    }
    Ok(())
}

/// Two edges without a common end that are nearer than the tolerance.
fn refuse_close(part: &Part, face: usize, tolerance: f64) -> Result<Option<Gap>, ImportError> {
    let mut narrowest: Option<Gap> = None;
    let of = &part.faces[face];
    let mut edges: Vec<usize> = of.loops.iter().flatten().map(|used| used.edge).collect();
    edges.sort_unstable();
    edges.dedup();
    if edges.len() > MOST_EDGES {
        return Ok(None);
    }
    let points: Vec<Vec<DVec3>> = edges.iter().map(|edge| samples(part, *edge)).collect();
    let boxes: Vec<[DVec3; 2]> = points.iter().map(|points| around(points)).collect();
    for a in 0..edges.len() {
        for b in a + 1..edges.len() {
            let (first, second) = (&part.edges[edges[a]], &part.edges[edges[b]]);
            let is_beside = first.ends.iter().any(|end| second.ends.contains(end));
            let gap = (boxes[a][0] - boxes[b][1]).max(boxes[b][0] - boxes[a][1]).max_element();
            if is_beside || gap > tolerance {
                continue;
            }
            let (distance, at) = nearest(part, edges[a], edges[b], &points[a], &points[b]);
            // Straight lines stay where they are.
            let is_straight = [a, b].iter().all(|k| bend(&points[*k]) <= STRAIGHT * tolerance);
            let least = if is_straight { 5.0 * STRAIGHT * tolerance } else { tolerance };
            if distance < least && !is_end_of_a_sliver(part, face, [first, second], at, tolerance) {
                let [a, b] = [first.label(edges[a]), second.label(edges[b])];
                let reason = format!("its {a} passes its {b} {distance:.6} mm off at {}", place(at));
                if distance < NARROWEST * tolerance {
                    let reason = format!(
                        "{reason}: nothing between them can be kept within {tolerance} mm; choose a tolerance below a \
                         third of that, or take the step out of the part"
                    );
                    return Err(ImportError::face(of.label(), reason));
                }
                if narrowest.as_ref().is_none_or(|other| distance < other.width) {
                    narrowest = Some(Gap { width: distance, reason: format!("{}: {reason}", of.label()) });
                }
            }
        }
    }
    Ok(narrowest)
}

/// Whether two edges are that near because a third joins their ends there that is as short.
fn is_end_of_a_sliver(part: &Part, face: usize, pair: [&Edge; 2], at: DVec3, tolerance: f64) -> bool {
    let mut uses = part.faces[face].loops.iter().flatten().map(|used| &part.edges[used.edge]);
    uses.any(|edge| {
        let joins = |ends: [usize; 2]| pair[0].ends.contains(&ends[0]) && pair[1].ends.contains(&ends[1]);
        let [a, b] = edge.ends;
        (joins([a, b]) || joins([b, a]))
            && edge.length() < tolerance
            && edge.ends.iter().all(|end| part.vertices[*end].distance(at) < 2.0 * tolerance)
    })
}

fn samples(part: &Part, edge: usize) -> Vec<DVec3> {
    (0..=SAMPLES).map(|k| part.edges[edge].at(k as f64 / SAMPLES as f64)[0]).collect()
}

/// How far an edge strays from its chord.
fn bend(points: &[DVec3]) -> f64 {
    let (first, last) = (points[0], points[points.len() - 1]);
    let way = (last - first).normalize_or_zero();
    points.iter().map(|point| (*point - first).reject_from_normalized(way).length()).fold(0.0, f64::max)
}

/// A box around an edge: between two samples it strays by less than they are apart.
fn around(points: &[DVec3]) -> [DVec3; 2] {
    let reach = points.windows(2).map(|pair| pair[0].distance(pair[1])).fold(0.0, f64::max);
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    [low - reach, high + reach]
}

/// How near two edges come, and where: from the nearest pairs of samples, to and fro.
fn nearest(part: &Part, first: usize, second: usize, a: &[DVec3], b: &[DVec3]) -> (f64, DVec3) {
    let reach = |points: &[DVec3]| points.windows(2).map(|pair| pair[0].distance(pair[1])).fold(0.0, f64::max);
    let far = |point: &DVec3| b.iter().map(|other| other.distance(*point)).fold(f64::INFINITY, f64::min);
    let mut starts: Vec<(f64, DVec3)> = a.iter().map(|point| (far(point), *point)).collect();
    starts.sort_by(|x, y| x.0.total_cmp(&y.0));
    let mut best = (f64::INFINITY, DVec3::ZERO);
    for (distance, start) in starts.into_iter().take(4) {
        // Sampled points are farther off than the curves by no more.
        if distance > best.0 + reach(a) + reach(b) {
            break;
        }
        let mut at = start;
        for _ in 0..12 {
            let (share, _) = part.edges[second].nearest(at);
            let there = part.edges[second].at(share)[0];
            let (share, distance) = part.edges[first].nearest(there);
            at = part.edges[first].at(share)[0];
            if distance < best.0 {
                best = (distance, at);
            }
        }
    }
    best
}

fn place(at: DVec3) -> String {
    format!("({:.3}, {:.3}, {:.3}) mm", at.x, at.y, at.z)
}
