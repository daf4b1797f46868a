//! What a file's way of writing has put in, taken out.
//!
//! Seams of closed surfaces are no features: an edge that a face uses in both senses is taken out, and the loop falls
//! in two.

use crate::part::{Face, Part, Use};
use glam::{DQuat, DVec3};

/// Takes the seams out of every face whose surface closes smoothly; says how many.
pub fn take_out_seams(part: &mut Part) -> usize {
    let mut count = 0;
    for face in 0..part.faces.len() {
        if part.faces[face].surface.closed == [false; 2] {
            continue;
        }
        let all: Vec<Use> = part.faces[face].loops.concat();
        let is_seam = |used: &Use| all.contains(&Use { reversed: !used.reversed, ..*used });
        if !all.iter().any(is_seam) {
            continue;
        }
        count += all.iter().filter(|used| is_seam(used)).count() / 2;
        let loops: Vec<Vec<Use>> = part.faces[face].loops.clone();
        let mut chained = Vec::new();
        for uses in loops {
            // In the order of the loop, so that at a vertex that is passed twice the right one follows.
            let mut left: Vec<Use> = uses.iter().copied().filter(|used| !is_seam(used)).collect();
            while !left.is_empty() {
                let mut chain = vec![left.remove(0)];
                let start = part.ends(chain[0])[0];
                loop {
                    let end = part.ends(chain[chain.len() - 1])[1];
                    if end == start {
                        break;
                    }
                    let Some(next) = left.iter().position(|used| part.ends(*used)[0] == end) else { break };
                    chain.push(left.remove(next));
                }
                chained.push(chain);
            }
        }
        part.faces[face].loops = chained;
    }
    count
}

/// Turns spheres so that a circle that bounds one alone goes round its poles: the face is a cap then, and its surface
/// the same.
pub fn turn_spheres(part: &mut Part) {
    for face in 0..part.faces.len() {
        let Face { kind: "sphere", loops, surface, .. } = &part.faces[face] else { continue };
        let [uses] = &loops[..] else { continue };
        if !(0..2).any(|axis| surface.closed[axis] && surface.poles[1 - axis] == [true; 2]) {
            continue;
        }
        let (low, high) = (surface.points[0], surface.points[surface.points.len() - 1]);
        let poles = [low, high].map(|point| point.truncate() / point.w);
        let centre = (poles[0] + poles[1]) * 0.5;
        let radius = centre.distance(poles[0]);
        let points: Vec<DVec3> = uses.iter().flat_map(|used| around(part, *used)).map(|point| point - centre).collect();
        let pairs = points.iter().zip(points.iter().cycle().skip(1));
        let to = pairs.map(|(a, b)| a.cross(*b)).sum::<DVec3>().normalize_or_zero();
        let from = (poles[1] - poles[0]).normalize_or_zero();
        let is_circle = points.iter().all(|point| (point.dot(to) - points[0].dot(to)).abs() < 1e-6 * radius);
        if to == DVec3::ZERO || !is_circle || from.cross(to).length() < 1e-9 {
            continue;
        }
        let turn = DQuat::from_rotation_arc(from, to);
        for point in &mut part.faces[face].surface.points {
            let place = turn * (point.truncate() / point.w - centre) + centre;
            *point = (place * point.w).extend(point.w);
        }
    }
}

/// Points along an edge as a loop runs, the end left out.
fn around(part: &Part, used: Use) -> impl Iterator<Item = DVec3> + '_ {
    let at = move |k: i32| if used.reversed { 1.0 - f64::from(k) / 32.0 } else { f64::from(k) / 32.0 };
    (0..32).map(move |k| part.edges[used.edge].at(at(k))[0])
}
