//! A face's lines as edges, and its loops along them.

use super::line::Cut;
use crate::error::ImportError;
use crate::mesh::Side;
use crate::nurbs::Surface;
use crate::outline::contains;
use crate::part::{Edge, Face, Part, Use};
use crate::sew::replace;
use crate::trace::{self, Traced};
use glam::DVec2;
use std::collections::HashMap;

/// Cuts the edges, inserts the stretches, and chains the loops again; returns the number of pieces.
pub fn carry_out(part: &mut Part, face: usize, cut: &Cut, tolerance: f64) -> Result<usize, ImportError> {
    let vertices = cut_edges(part, cut);
    // After the loop has come to a vertex on a line it goes on along the line, and from its other end along the loop.
    let mut next: HashMap<usize, Use> = HashMap::new();
    let mut closed = Vec::new();
    for (line, ends) in cut.lines.iter().zip(&vertices) {
        let curve = part.faces[face].surface.line(cut.axis, line.value);
        let is_round = part.faces[face].surface.closed[1 - cut.axis];
        if line.stretches.is_empty() {
            part.vertices.push(curve.at(curve.range()[0])[0]);
            let vertex = part.vertices.len() - 1;
            part.edges.push(Edge::whole(curve, [vertex; 2], None));
            let edge = part.edges.len() - 1;
            closed.extend([false, true].map(|reversed| vec![Use { edge, reversed }]));
            continue;
        }
        for ([from, to], ends) in line.stretches.iter().zip(ends) {
            part.edges.push(Edge {
                curve: curve.clone(),
                range: [from.along, to.along],
                ends: *ends,
                is_round,
                number: None,
            });
            let edge = part.edges.len() - 1;
            next.insert(ends[0], Use { edge, reversed: false });
            next.insert(ends[1], Use { edge, reversed: true });
        }
    }
    let mut loops = chained(part, face, &next);
    let lines: Vec<usize> = closed.iter().map(|uses: &Vec<Use>| uses[0].edge).collect();
    loops.extend(closed);
    let groups = grouped(part, face, loops, cut, &lines, tolerance)?;
    let count = groups.len();
    let pieces: Vec<Face> = groups.into_iter().map(|loops| Face { loops, ..part.faces[face].clone() }).collect();
    part.faces.splice(face..=face, pieces);
    Ok(count)
}

/// Cuts all edges that the lines meet, in all faces; gives the vertices at the ends of each line's stretches.
fn cut_edges(part: &mut Part, cut: &Cut) -> Vec<Vec<[usize; 2]>> {
    let mut at: HashMap<usize, Vec<(f64, usize)>> = HashMap::new();
    let mut ends = Vec::new();
    for line in &cut.lines {
        let mut of_line = Vec::new();
        for pair in &line.stretches {
            of_line.push(pair.map(|crossing| {
                let edge = crossing.used.edge;
                part.vertices.push(part.edges[edge].at(crossing.share)[0]);
                at.entry(edge).or_default().push((crossing.share, part.vertices.len() - 1));
                part.vertices.len() - 1
            }));
        }
        ends.push(of_line);
    }
    let mut uses: HashMap<usize, usize> = HashMap::new();
    let mut seen = vec![false; part.edges.len()];
    for used in part.faces.iter().flat_map(|face| face.loops.iter().flatten()) {
        if !std::mem::replace(&mut seen[used.edge], true) {
            part.edges[used.edge].ends.iter().for_each(|end| *uses.entry(*end).or_insert(0) += 1);
        }
    }
    let mut order: Vec<_> = at.into_iter().collect();
    order.sort_by_key(|(edge, _)| *edge);
    let mut pieces = HashMap::new();
    for (edge, mut at) in order {
        at.sort_by(|a, b| a.0.total_cmp(&b.0));
        let of = part.edges[edge].clone();
        // Of a circle that meets no other edge, the place where it began means nothing.
        let is_free = of.is_closed() && of.is_round && uses.get(&of.ends[0]) == Some(&2);
        let mut places = at.clone();
        if is_free {
            places.push((at[0].0 + 1.0, at[0].1));
        } else {
            places.insert(0, (0.0, of.ends[0]));
            places.push((1.0, of.ends[1]));
        }
        let made = places.windows(2).map(|pair| {
            part.edges.push(of.stretch([pair[0].0, pair[1].0], [pair[0].1, pair[1].1]));
            part.edges.len() - 1
        });
        pieces.insert(edge, made.collect());
    }
    replace(part, &pieces);
    ends
}

/// The loops of a face whose uses are followed, at the ends of the stretches, by those.
fn chained(part: &Part, face: usize, next: &HashMap<usize, Use>) -> Vec<Vec<Use>> {
    let all = &part.faces[face].loops;
    let mut after: HashMap<Use, Use> = HashMap::new();
    let mut leaving: HashMap<usize, Use> = HashMap::new();
    for uses in all {
        for (first, second) in uses.iter().zip(uses.iter().cycle().skip(1)) {
            let vertex = part.ends(*first)[1];
            match next.get(&vertex) {
                Some(stretch) => {
                    after.insert(*first, *stretch);
                    leaving.insert(vertex, *second);
                }
                None => {
                    after.insert(*first, *second);
                }
            }
        }
    }
    for stretch in next.values() {
        if let Some(on) = leaving.get(&part.ends(*stretch)[1]) {
            after.insert(*stretch, *on);
        }
    }
    let mut left: Vec<Use> = all.concat();
    let mut loops = Vec::new();
    while let Some(start) = left.first().copied() {
        let mut chain = vec![start];
        while let Some(on) = after.get(&chain[chain.len() - 1])
            && *on != start
            && chain.len() <= after.len()
        {
            chain.push(*on);
        }
        left.retain(|used| !chain.contains(used));
        loops.push(chain);
    }
    loops
}

// Which loops bound one piece of a face that was split.

/// Loops by the piece that they bound: by the strip between lines, and there by the outline around them.
pub fn grouped(
    part: &Part,
    face: usize,
    loops: Vec<Vec<Use>>,
    cut: &Cut,
    lines: &[usize],
    tolerance: f64,
) -> Result<Vec<Vec<Vec<Use>>>, ImportError> {
    let surface = &part.faces[face].surface;
    let found = trace::all(part, face, &loops, tolerance)?;
    let axis = cut.axis;
    let middle = |of: &Traced| {
        let values: Vec<f64> = of.sides.iter().flat_map(|side| side.path.polyline()).map(|uv| uv[axis]).collect();
        let [low, high] = [
            values.iter().copied().fold(f64::INFINITY, f64::min),
            values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ];
        0.5 * (low + high)
    };
    let strip = |of: &Traced| -> usize {
        let is_line = |side: &Side| side.wire.is_some_and(|(edge, _)| lines.contains(&edge));
        if of.sides.len() == 1 && is_line(&of.sides[0]) {
            // The line itself: the face lies on its left.
            let rises = of.winding[1 - axis] > 0;
            let value = of.sides[0].path.start()[axis];
            let here = if rises == (axis == 0) { -1e-3 } else { 1e-3 } * surface.period(axis);
            return beyond(value + here, cut, surface);
        }
        beyond(middle(of), cut, surface)
    };
    let mut groups: Vec<(usize, Vec<DVec2>, Vec<Vec<Use>>)> = Vec::new();
    let mut rest = Vec::new();
    for (uses, of) in loops.into_iter().zip(&found) {
        let strip = strip(of);
        if of.winding == [0, 0] && trace::area(&of.sides) > 0.0 {
            let polygon = of.sides.iter().flat_map(|side| side.path.polyline()).collect();
            groups.push((strip, polygon, vec![uses]));
        } else {
            rest.push((strip, of, uses));
        }
    }
    for (strip, of, uses) in rest {
        let start = of.sides[0].path.start();
        let turns = |axis: usize| if surface.closed[axis] { -2..=2 } else { 0..=0 };
        let holds = |polygon: &[DVec2]| {
            turns(0).any(|i| {
                turns(1).any(|j| {
                    let by = DVec2::new(f64::from(i) * surface.period(0), f64::from(j) * surface.period(1));
                    contains(polygon, start + by)
                })
            })
        };
        let around = groups.iter().position(|(of, polygon, _)| *of == strip && !polygon.is_empty() && holds(polygon));
        let around = around.or_else(|| groups.iter().position(|(of, polygon, _)| *of == strip && polygon.is_empty()));
        match around {
            Some(index) => groups[index].2.push(uses),
            None => groups.push((strip, Vec::new(), vec![uses])),
        }
    }
    Ok(groups.into_iter().map(|(_, _, loops)| loops).collect())
}

/// The strip that a value lies in.
fn beyond(value: f64, cut: &Cut, surface: &Surface) -> usize {
    if let [first, second] = &cut.lines[..] {
        let period = surface.period(cut.axis);
        return usize::from((value - first.value).rem_euclid(period) > second.value - first.value);
    }
    usize::from(value > cut.lines[0].value)
}
