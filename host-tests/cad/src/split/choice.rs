//! Which line of many a face is split along.

use super::line::{Asked, Crossing, Cut, Line, line};
use crate::mesh::Side;
use crate::nurbs::Surface;
use crate::part::Part;
use crate::trace::{self, Traced};
use glam::{DVec2, DVec3};

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

/// What a line costs.
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
