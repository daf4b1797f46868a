//! A line of a face's parameters, and where it meets the outline.

use crate::mesh::Side;
use crate::nurbs::Surface;
use crate::part::{Part, Use};
use crate::trace::{self, Traced};
use glam::{DVec2, DVec3};

/// Conditions where a line meets the outline.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// Minimum sine of the angle there.
    pub sine: f64,
    /// Minimum fraction of the edge on either side.
    pub share: f64,
}

/// Crossing of a line and the outline.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// The edge, as the loop runs along it.
    pub used: Use,
    /// The share of the edge.
    pub share: f64,
    /// The other parameter there.
    pub along: f64,
    /// Whether the loop goes to greater values of the parameter that the line holds: then the face lies beyond, for
    /// lines along `v`.
    pub is_rising: bool,
    /// The sine of the angle between them.
    pub sine: f64,
}

/// One line: the value it holds, and its stretches inside the face; none if all of a closed line is inside.
#[derive(Clone, Debug)]
pub struct Line {
    /// Of the parameter that it holds.
    pub value: f64,
    /// Start and end of each stretch.
    pub stretches: Vec<[Crossing; 2]>,
}

/// Lines that hold one parameter.
#[derive(Clone, Debug)]
pub struct Cut {
    /// The parameter, 0 or 1.
    pub axis: usize,
    /// One, or two round a closed parameter.
    pub lines: Vec<Line>,
    /// Their total cost.
    pub cost: f64,
}

/// A line, if its ends are sound.
pub fn line(part: &Part, face: usize, loops: &[Traced], axis: usize, value: f64, asked: &Asked) -> Option<Line> {
    let surface = &part.faces[face].surface;
    let other = 1 - axis;
    let mut met = Vec::new();
    for side in loops.iter().flat_map(|of| &of.sides) {
        let all = crossings(part, surface, side, axis, value);
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
fn crossings(part: &Part, surface: &Surface, side: &Side, axis: usize, value: f64) -> Vec<Crossing> {
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
            let (t, uv) = on_edge(part, surface, side, axis, value, 0.5 * (low + high));
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

/// Where a side's edge itself meets a line, near where its path does, which follows it only about; and the parameters
/// there. A pole has no edge.
fn on_edge(part: &Part, surface: &Surface, side: &Side, axis: usize, value: f64, near: f64) -> (f64, DVec2) {
    let (mut t, mut uv) = (near, side.path.at(near));
    let Some((edge, reversed)) = side.wire else { return (t, uv) };
    for _ in 0..8 {
        let share = if reversed { 1.0 - t } else { t };
        uv = surface.project(part.edges[edge].at(share)[0], side.path.at(t)).uv;
        let slope = side.path.slope(t)[axis];
        let step = (value - uv[axis]) / if slope == 0.0 { f64::INFINITY } else { slope };
        // Never as far as the next place where they meet.
        t = (t + step.clamp(-0.01, 0.01)).clamp(0.0, 1.0);
        if step.abs() < 1e-13 {
            break;
        }
    }
    (t, uv)
}

// Which line of many a face is split along.

/// Lines that are tried along each parameter.
const LINES: usize = 60;
/// And round a closed one.
const ABOUT: usize = 72;

/// The cheapest cut of all that are tried.
pub fn best(part: &Part, face: usize, loops: &[Traced], asked: &Asked) -> Option<Cut> {
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

/// Cost of a line.
fn cost(part: &Part, face: usize, loops: &[Traced], axis: usize, line: &Line) -> f64 {
    let surface = &part.faces[face].surface;
    let place = |along: f64| if axis == 0 { DVec2::new(line.value, along) } else { DVec2::new(along, line.value) };
    let sides: Vec<&Side> = loops.iter().flat_map(|of| &of.sides).collect();
    let points = |side: &&Side| side.path.polyline().map(|uv| surface.at(uv).point).collect::<Vec<_>>();
    let all: Vec<Vec<_>> = sides.iter().map(points).collect();
    let far = |first: DVec3| all.iter().flatten().map(move |point| point.distance(first));
    let size = all.first().and_then(|of| of.first()).map_or(1.0, |first| far(*first).fold(f64::MIN_POSITIVE, f64::max));
    // How long a stretch is, and what it costs that it passes by other edges closely: that leaves a strip that no quad
    // fits into.
    let passed = |from: f64, to: f64, met: &[usize]| {
        let on = |k: f64| surface.at(place(from + (to - from) * k / 16.0)).point;
        let stretch: Vec<_> = (0..=16).map(|k| on(f64::from(k))).collect();
        let length = stretch.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>() / size;
        let others = sides.iter().zip(&all).filter(|(side, _)| side.wire.is_none_or(|(edge, _)| !met.contains(&edge)));
        let clear =
            others.flat_map(|(_, points)| points).flat_map(|point| stretch.iter().map(|on| on.distance(*point)));
        let clear = clear.fold(f64::INFINITY, f64::min) / size;
        (length, 0.2 * length / clear.max(1e-4))
    };
    if line.stretches.is_empty() {
        let [low, high] = surface.range(1 - axis);
        return 1.5 + passed(low, high, &[]).1;
    }
    let of_stretch = |[from, to]: &[Crossing; 2]| {
        let (length, passed) = passed(from.along, to.along, &[from.used.edge, to.used.edge]);
        let slant = 1.0 - from.sine.min(to.sine);
        1.0 + length + 3.0 * slant + 0.02 / length.max(1e-3) + passed
    };
    line.stretches.iter().map(of_stretch).sum()
}
