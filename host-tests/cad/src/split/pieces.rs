//! Which loops bound one piece of a face that was split.

use super::line::Cut;
use crate::error::ImportError;
use crate::mesh::Side;
use crate::nurbs::Surface;
use crate::outline::contains;
use crate::part::{Part, Use};
use crate::trace::{self, Traced};
use glam::DVec2;

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
