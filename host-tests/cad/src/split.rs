//! A face in pieces, along lines of its parameters: what is too much to be divided into quads at once.
//!
//! A line runs from where it comes into the face to where it leaves it; those stretches become edges of both pieces,
//! and the edges they meet are cut there in all faces. Round a closed parameter that the face goes all about there are
//! two lines. Of many, the line is taken that has few and short stretches, meets the outline squarely and far from its
//! vertices, passes by nothing closely, and leaves as much on one side as on the other.

use crate::error::ImportError;
use crate::mesh::{Mesh, Side};
use crate::nurbs::Surface;
use crate::outline::contains;
use crate::part::{Edge, Face, Part, Use};
use crate::sew::replace;
use crate::trace::{self, Traced};
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// Lines that are tried along each parameter.
const LINES: usize = 60;
/// And round a closed one.
const ABOUT: usize = 72;
/// What is asked of a line at first, and then.
const ASKED: [Asked; 2] = [Asked { sine: 0.3, share: 0.07 }, Asked { sine: 0.12, share: 0.02 }];

/// What is asked where a line meets the outline.
#[derive(Clone, Copy, Debug)]
struct Asked {
    /// The sine of the angle there, at least.
    sine: f64,
    /// The share of the edge that is left on either side.
    share: f64,
}

/// Where a line meets the outline.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    used: Use,
    /// The share of the edge.
    share: f64,
    /// The other parameter there.
    along: f64,
    /// Whether the loop goes to greater values of the parameter that the line holds: then the face lies beyond, for
    /// lines along `v`.
    is_rising: bool,
    sine: f64,
}

/// One line: the value it holds, and its stretches inside the face; none if all of a closed line is inside.
#[derive(Clone, Debug)]
struct Line {
    value: f64,
    stretches: Vec<[Crossing; 2]>,
}

/// Lines that hold one parameter.
#[derive(Clone, Debug)]
struct Cut {
    axis: usize,
    lines: Vec<Line>,
    cost: f64,
}

/// Splits a face in two or more, in its place; says whether a way was found.
///
/// # Errors
/// What is wrong with its loops.
pub fn split(part: &mut Part, face: usize, tolerance: f64) -> Result<bool, ImportError> {
    let loops = traced(part, face, &part.faces[face].loops, tolerance)?;
    let Some(cut) = ASKED.iter().find_map(|asked| best(part, face, &loops, asked)) else { return Ok(false) };
    let pieces = carry_out(part, face, &cut, tolerance)?;
    Ok(pieces > 1)
}

fn traced(part: &Part, face: usize, loops: &[Vec<Use>], tolerance: f64) -> Result<Vec<Traced>, ImportError> {
    let mesh = Mesh::new(part);
    loops.iter().map(|uses| trace::trace(&mesh, face, uses, tolerance)).collect()
}

/// The cheapest cut of all that are tried.
fn best(part: &Part, face: usize, loops: &[Traced], asked: &Asked) -> Option<Cut> {
    let surface = &part.faces[face].surface;
    let sides: Vec<&Side> = loops.iter().flat_map(|of| &of.sides).collect();
    let is_twice = |side: &&Side| {
        let edge = |side: &Side| side.wire.map(|(edge, _)| edge);
        edge(side).is_some() && sides.iter().filter(|other| edge(other) == edge(side)).count() > 1
    };
    if sides.iter().any(is_twice) {
        return None;
    }
    let mut found: Option<Cut> = None;
    for axis in 0..2 {
        let values: Vec<f64> = sides.iter().flat_map(|side| side.path.polyline()).map(|uv| uv[axis]).collect();
        let [low, high] = if values.is_empty() {
            surface.range(axis)
        } else {
            [
                values.iter().copied().fold(f64::INFINITY, f64::min),
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        let period = surface.period(axis);
        let goes_about = surface.closed[axis]
            && (high - low > 0.7 * period || loops.is_empty() || is_all_about(loops, surface, axis));
        let [first, width, count] =
            if goes_about { [surface.range(axis)[0], period, ABOUT as f64] } else { [low, high - low, LINES as f64] };
        let middles: Vec<f64> = sides.iter().map(|side| side.path.at(0.5)[axis]).collect();
        let lines: Vec<(usize, Line, f64)> = (0..count as usize)
            .filter_map(|k| {
                let line = line(part, face, loops, axis, first + width * (k as f64 + 0.5) / count, asked)?;
                let cost = cost(part, face, loops, axis, &line);
                Some((k, line, cost))
            })
            .collect();
        let mut keep = |lines: Vec<Line>, cost: f64| {
            if found.as_ref().is_none_or(|best| cost < best.cost - 1e-6) {
                found = Some(Cut { axis, lines, cost });
            }
        };
        if !goes_about {
            for (_, line, cost) in lines {
                let beyond = middles.iter().filter(|middle| **middle > line.value).count();
                let share = beyond as f64 / middles.len().max(1) as f64;
                keep(vec![line], cost + 3.0 * (share - 0.5).abs());
            }
            continue;
        }
        for (k, line, cost) in &lines {
            for (l, other, more) in &lines {
                if (k + ABOUT / 3..=k + ABOUT * 2 / 3).contains(l) {
                    let off = (l - k) as f64 / ABOUT as f64 - 0.5;
                    keep(vec![line.clone(), other.clone()], cost + more + 4.0 * off.abs());
                }
            }
        }
    }
    found
}

/// Whether a face without loops that wind is all of a closed surface but its holes.
fn is_all_about(loops: &[Traced], surface: &Surface, axis: usize) -> bool {
    let is_hole = |of: &Traced| of.winding == [0, 0] && trace::area(&of.sides) < 0.0;
    loops.iter().any(|of| of.winding[axis] != 0) || (surface.closed == [true; 2] && loops.iter().all(is_hole))
}

/// A line, if its ends are sound.
fn line(part: &Part, face: usize, loops: &[Traced], axis: usize, value: f64, asked: &Asked) -> Option<Line> {
    let surface = &part.faces[face].surface;
    let other = 1 - axis;
    let mut met = Vec::new();
    for side in loops.iter().flat_map(|of| &of.sides) {
        let all = crossings(surface, side, axis, value);
        let is_sound = |at: &Crossing| {
            let is_inner =
                (asked.share..=1.0 - asked.share).contains(&at.share) || part.edges[at.used.edge].is_closed();
            at.sine >= asked.sine && is_inner
        };
        if !all.iter().all(is_sound) || side.wire.is_none() && !all.is_empty() {
            return None;
        }
        met.extend(all);
    }
    if met.is_empty() {
        return whole_line(surface, loops, axis, value).then(|| Line { value, stretches: Vec::new() });
    }
    if surface.closed[other] {
        let [low, high] = surface.range(other);
        met.iter_mut().for_each(|at| at.along = low + (at.along - low).rem_euclid(high - low));
    }
    met.sort_by(|a, b| a.along.total_cmp(&b.along));
    // Along v the face lies beyond a loop that goes to greater u; along u beyond one that goes to lesser v.
    let begins = |at: &Crossing| at.is_rising == (axis == 0);
    if !begins(&met[0]) {
        if !surface.closed[other] {
            return None;
        }
        let mut last = met.remove(0);
        last.along += surface.period(other);
        met.push(last);
    }
    if met.len() % 2 == 1 || !met.iter().enumerate().all(|(k, at)| begins(at) == (k % 2 == 0)) {
        return None;
    }
    Some(Line { value, stretches: met.chunks(2).map(|pair| [pair[0], pair[1]]).collect() })
}

/// Whether a closed line that meets no loop lies in the face.
fn whole_line(surface: &Surface, loops: &[Traced], axis: usize, value: f64) -> bool {
    let other = 1 - axis;
    if !surface.closed[other] {
        return false;
    }
    let winding: Vec<&Traced> = loops.iter().filter(|of| of.winding[other] != 0).collect();
    if winding.is_empty() {
        return surface.closed == [true; 2]
            && loops.iter().all(|of| of.winding == [0, 0] && trace::area(&of.sides) < 0.0);
    }
    // Between the loops that go round: beyond one at least, and not beyond all.
    let beyond = winding.iter().filter(|of| of.sides[0].path.start()[axis] < value).count();
    // On both sides there is a hole or a pole: from a smooth tube nothing is gained.
    let holes = || loops.iter().filter(|of| of.winding == [0, 0]);
    let has_hole = |is_beyond: bool| holes().any(|of| (of.sides[0].path.start()[axis] > value) == is_beyond);
    let is_pole = |is_beyond: bool| winding.len() == 1 && (beyond == 1) == is_beyond;
    !surface.closed[axis]
        && (beyond == 1 || winding.len() == 1)
        && holes().all(|of| trace::area(&of.sides) < 0.0)
        && [false, true].into_iter().all(|side| has_hole(side) || is_pole(side))
}

/// Where a side meets a line, wherever round the surface.
fn crossings(surface: &Surface, side: &Side, axis: usize, value: f64) -> Vec<Crossing> {
    const STEPS: usize = 64;
    let period = surface.period(axis);
    let at = |k: usize| side.path.at(k as f64 / STEPS as f64)[axis];
    let turns: Vec<f64> =
        if surface.closed[axis] { (-3..=3).map(|k| f64::from(k) * period).collect() } else { vec![0.0] };
    let mut met = Vec::new();
    for value in turns.into_iter().map(|by| value + by) {
        for k in 0..STEPS {
            let (a, b) = (at(k) - value, at(k + 1) - value);
            if (a < 0.0) == (b < 0.0) {
                continue;
            }
            let (mut low, mut high) = (k as f64 / STEPS as f64, (k + 1) as f64 / STEPS as f64);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if (side.path.at(middle)[axis] < value) == (a < 0.0) { low = middle } else { high = middle }
            }
            let t = 0.5 * (low + high);
            let uv = side.path.at(t);
            let jet = surface.at(uv);
            let slope = side.path.slope(t);
            let [on_side, on_line] = [jet.first[0] * slope.x + jet.first[1] * slope.y, jet.first[1 - axis]];
            let sine = on_side.cross(on_line).length() / (on_side.length() * on_line.length()).max(f64::MIN_POSITIVE);
            // A pole is left to the caller to refuse.
            let (edge, reversed) = side.wire.unwrap_or_default();
            let share = if reversed { 1.0 - t } else { t };
            met.push(Crossing { used: Use { edge, reversed }, share, along: uv[1 - axis], is_rising: b > a, sine });
        }
    }
    met
}

/// What a line costs.
fn cost(part: &Part, face: usize, loops: &[Traced], axis: usize, line: &Line) -> f64 {
    let surface = &part.faces[face].surface;
    let place = |along: f64| if axis == 0 { DVec2::new(line.value, along) } else { DVec2::new(along, line.value) };
    let sides: Vec<&Side> = loops.iter().flat_map(|of| &of.sides).collect();
    let points = |side: &&Side| side.path.polyline().map(|uv| surface.at(uv).point).collect::<Vec<_>>();
    let all: Vec<Vec<_>> = sides.iter().map(points).collect();
    let far = |first: DVec3| all.iter().flatten().map(move |point| point.distance(first));
    let size = all.first().and_then(|of| of.first()).map_or(1.0, |first| far(*first).fold(f64::MIN_POSITIVE, f64::max));
    if line.stretches.is_empty() {
        return 1.5;
    }
    let of_stretch = |[from, to]: &[Crossing; 2]| {
        let on = |k: f64| surface.at(place(from.along + (to.along - from.along) * k / 16.0)).point;
        let stretch: Vec<_> = (0..=16).map(|k| on(f64::from(k))).collect();
        let length = stretch.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>() / size;
        // What it passes by closely leaves a strip that no quad fits into.
        let met = [from.used.edge, to.used.edge];
        let others = sides.iter().zip(&all).filter(|(side, _)| side.wire.is_none_or(|(edge, _)| !met.contains(&edge)));
        let clear =
            others.flat_map(|(_, points)| points).flat_map(|point| stretch.iter().map(|on| on.distance(*point)));
        let clear = clear.fold(f64::INFINITY, f64::min) / size;
        let slant = 1.0 - from.sine.min(to.sine);
        1.0 + length + 3.0 * slant + 0.02 / length.max(1e-3) + 0.2 * length / clear.max(1e-4)
    };
    line.stretches.iter().map(of_stretch).sum()
}

/// Cuts the edges, puts the stretches in, and chains the loops anew; gives the number of pieces.
fn carry_out(part: &mut Part, face: usize, cut: &Cut, tolerance: f64) -> Result<usize, ImportError> {
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

/// Loops by the piece that they bound: by the strip between lines, and there by the outline around them.
fn grouped(
    part: &Part,
    face: usize,
    loops: Vec<Vec<Use>>,
    cut: &Cut,
    lines: &[usize],
    tolerance: f64,
) -> Result<Vec<Vec<Vec<Use>>>, ImportError> {
    let surface = &part.faces[face].surface;
    let found = traced(part, face, &loops, tolerance)?;
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
