//! Outlines that close in the parameters: of a face that goes round its surface, the loops that wind and the poles are
//! joined by a cut along the surface, which is a wire like any other, used twice.

use crate::circles::Turns;
use crate::error::ImportError;
use crate::mesh::{Mesh, Side};
use crate::path::Path;
use crate::trace;
use glam::DVec2;

/// Joins a region's loops to one outer outline, first, and holes that lie inside it.
pub fn close(mesh: &mut Mesh<'_>, face: usize, turns: &[Turns]) -> Result<(), ImportError> {
    let part = mesh.part;
    let surface = &part.faces[face].surface;
    let loops = std::mem::take(&mut mesh.regions[face].loops);
    let (mut winding, mut outer, mut holes) = (Vec::new(), Vec::new(), Vec::new());
    for (sides, turns) in loops.into_iter().zip(turns) {
        if turns.winding != [0, 0] {
            winding.push((sides, turns.winding));
        } else if turns.area > 0.0 {
            outer.push(sides);
        } else {
            holes.push(sides);
        }
    }
    let refuse = |reason: &str| Err(ImportError::too_much(part, face, reason));
    let outline = match (outer.len(), &winding[..]) {
        (1, []) => outer.remove(0),
        (0, []) if surface.closed == [true; 2] => torus(mesh, face, &holes),
        (0, []) => match (0..2).find(|axis| surface.closed[*axis] && surface.poles[1 - axis] == [true; 2]) {
            Some(axis) => ball(mesh, face, axis, &holes),
            None => return refuse("it has no outer loop, and its surface is not closed"),
        },
        (0, _) => {
            let axis = usize::from(winding[0].1[0] == 0);
            match tube(mesh, face, axis, winding, &holes) {
                Ok(sides) => sides,
                Err(reason) => return refuse(reason),
            }
        }
        (count, _) => {
            return refuse(&format!("it has {count} outer loops, or one and others that go round its surface"));
        }
    };
    let mut loops = vec![outline];
    for hole in holes {
        let by = inside(mesh, face, &loops[0], &hole);
        loops.push(hole.iter().map(|side| side.shifted(by)).collect());
    }
    mesh.regions[face].loops = loops;
    Ok(())
}

fn period(mesh: &Mesh<'_>, face: usize) -> DVec2 {
    let part = mesh.part;
    let surface = &part.faces[face].surface;
    DVec2::new(surface.period(0), surface.period(1))
}

/// One or two loops that wind round the parameter `axis`, and a pole for the one that is missing.
fn tube(
    mesh: &mut Mesh<'_>,
    face: usize,
    axis: usize,
    winding: Vec<(Vec<Side>, [i32; 2])>,
    holes: &[Vec<Side>],
) -> Result<Vec<Side>, &'static str> {
    let part = mesh.part;
    let surface = &part.faces[face].surface;
    let other = 1 - axis;
    let unit = if axis == 0 { DVec2::X } else { DVec2::Y };
    let way = if axis == 0 { 1.0 } else { -1.0 };
    let whole = unit * way * surface.period(axis);
    let [mut low, mut high] = [None, None];
    for (sides, winding) in winding {
        if winding[other] != 0 || winding[axis].abs() != 1 {
            return Err("a loop of it winds round its surface in a way that is not read");
        }
        // The face lies on the left: above a loop that runs along rising u, beneath one along falling u.
        let place = if f64::from(winding[axis]) == way { &mut low } else { &mut high };
        if place.replace(sides).is_some() {
            return Err("two loops of it go round its surface the same way");
        }
    }
    let end_of = |sides: &[Side]| sides[sides.len() - 1].path.end();
    let mut node_of_pole = |end: usize, sides: &[Side]| -> Result<Vec<Side>, &'static str> {
        if !surface.poles[other][end] {
            return Err("a loop of it goes round its surface, and nothing closes the other end");
        }
        let at = surface.range(other)[end];
        let place = |uv: DVec2| if axis == 0 { DVec2::new(uv.x, at) } else { DVec2::new(at, uv.y) };
        let node = mesh.nodes.len();
        mesh.nodes.push(surface.at(place(sides[0].path.start())).point);
        let along = sides.iter().rev().map(|side| Side::pole(node, place(side.path.end()), place(side.path.start())));
        Ok(along.collect())
    };
    let (low, high) = match (low, high) {
        (Some(low), Some(high)) => {
            // Round the other parameter too, the upper loop comes next above the lower.
            let mut high = high;
            if surface.closed[other] {
                let period = surface.period(other);
                let gap = high[0].path.start()[other] - low[0].path.start()[other];
                let by = gap.rem_euclid(period) - gap;
                let across = if axis == 0 { DVec2::Y } else { DVec2::X };
                high = high.iter().map(|side| side.shifted(across * by)).collect();
            }
            (low, high)
        }
        (Some(low), None) => {
            let high = node_of_pole(1, &low)?;
            (low, high)
        }
        (None, Some(high)) => {
            let low = node_of_pole(0, &high)?;
            (low, high)
        }
        (None, None) => return Err("no loop of it goes round its surface"),
    };
    // The shortest cut from a corner to a corner that crosses no hole.
    let mut best: Option<(f64, usize, usize, DVec2)> = None;
    for i in 0..low.len() {
        for j in 0..high.len() {
            let from = low[i].path.start() + whole;
            let to = high[j].path.start();
            let turns = ((from - to).dot(unit) / surface.period(axis)).round();
            for turns in [turns - 1.0, turns, turns + 1.0] {
                let by = unit * (turns * surface.period(axis));
                let slant = (to + by - from).dot(unit).abs();
                if best.is_none_or(|(least, ..)| slant < least - 1e-9) && !crosses(mesh, face, [from, to + by], holes) {
                    best = Some((slant, i, j, by));
                }
            }
        }
    }
    let Some((_, i, j, by)) = best else {
        return Err("no straight cut from one end of it to the other misses its holes");
    };
    let low = rotated(&low, i, end_of(&low) - low[0].path.start());
    let high = rotated(&high, j, end_of(&high) - high[0].path.start());
    let high: Vec<Side> = high.iter().map(|side| side.shifted(by)).collect();
    let (from, to) = (end_of(&low), high[0].path.start());
    let seam = mesh.add_inside(face, [low[0].ends[0], high[0].ends[0]], Path::line(from, to));
    let back = seam.reversed().shifted(-whole);
    Ok([low, vec![seam], high, vec![back]].concat())
}

/// A loop that starts at its `first` side; the sides before it follow at the end, shifted by one turn.
fn rotated(sides: &[Side], first: usize, whole: DVec2) -> Vec<Side> {
    let after = sides[..first].iter().map(|side| side.shifted(whole));
    sides[first..].iter().cloned().chain(after).collect()
}

/// The whole of a surface that is closed in both parameters.
fn torus(mesh: &mut Mesh<'_>, face: usize, holes: &[Vec<Side>]) -> Vec<Side> {
    let part = mesh.part;
    let surface = &part.faces[face].surface;
    let (period, [u, v]) = (period(mesh, face), [surface.range(0)[0], surface.range(1)[0]]);
    let starts =
        (0..64).map(|k| DVec2::new(u, v) + period * DVec2::new(f64::from(k % 8) / 8.0, f64::from(k / 8) / 8.0));
    let free = |start: &DVec2| {
        let [right, up] = [*start + DVec2::X * period.x, *start + DVec2::Y * period.y];
        !crosses(mesh, face, [*start, right], holes) && !crosses(mesh, face, [*start, up], holes)
    };
    let start = starts.into_iter().find(free).unwrap_or(DVec2::new(u, v));
    let node = mesh.add_node(surface.at(start).point);
    let (right, up) = (DVec2::X * period.x, DVec2::Y * period.y);
    let bottom = mesh.add_inside(face, [node; 2], Path::line(start, start + right));
    let left = mesh.add_inside(face, [node; 2], Path::line(start, start + up));
    vec![bottom.clone(), left.shifted(right), bottom.shifted(up).reversed(), left.reversed()]
}

/// The whole of a surface that is closed in one parameter and has poles at the ends of the other.
fn ball(mesh: &mut Mesh<'_>, face: usize, axis: usize, holes: &[Vec<Side>]) -> Vec<Side> {
    const SECTORS: usize = 4;
    let part = mesh.part;
    let surface = &part.faces[face].surface;
    let (period, first) = (surface.period(axis), surface.range(axis)[0]);
    let ends = surface.range(1 - axis);
    let at = |along: f64, end: f64| if axis == 0 { DVec2::new(along, end) } else { DVec2::new(end, along) };
    let is_free = |along: &f64| !crosses(mesh, face, [at(*along, ends[0]), at(*along, ends[1])], holes);
    let start = (0..32).map(|k| first + period * f64::from(k) / 32.0).find(is_free).unwrap_or(first);
    let poles = ends.map(|end| mesh.add_node(surface.at(at(start, end)).point));
    let along = |k: usize| start + period * k as f64 / SECTORS as f64;
    let lower = (0..SECTORS).map(|k| Side::pole(poles[0], at(along(k), ends[0]), at(along(k + 1), ends[0])));
    let upper = (0..SECTORS).rev().map(|k| Side::pole(poles[1], at(along(k + 1), ends[1]), at(along(k), ends[1])));
    let (lower, upper): (Vec<_>, Vec<_>) = (lower.collect(), upper.collect());
    let left = mesh.add_inside(face, poles, Path::line(at(start, ends[0]), at(start, ends[1])));
    let by = at(period, 0.0) - at(0.0, 0.0);
    let right = left.shifted(by);
    if axis == 0 {
        return [lower, vec![right], upper, vec![left.reversed()]].concat();
    }
    // Along v: counter-clockwise is down the lesser end of u, and up the greater.
    let lower: Vec<Side> = lower.iter().rev().map(Side::reversed).collect();
    let upper: Vec<Side> = upper.iter().rev().map(Side::reversed).collect();
    [lower, vec![left], upper, vec![right.reversed()]].concat()
}

/// Whether a straight cut meets a hole, or touches it, wherever round the surface.
fn crosses(mesh: &Mesh<'_>, face: usize, [a, b]: [DVec2; 2], holes: &[Vec<Side>]) -> bool {
    let period = period(mesh, face);
    let closed = mesh.part.faces[face].surface.closed;
    let turns = |axis: usize| if closed[axis] { -2..=2 } else { 0..=0 };
    holes.iter().flatten().any(|side| {
        let points: Vec<_> = side.path.polyline().chain([side.path.end()]).collect();
        turns(0).any(|i| {
            turns(1).any(|j| {
                let by = DVec2::new(f64::from(i), f64::from(j)) * period;
                points.windows(2).any(|pair| meet([a, b], [pair[0] + by, pair[1] + by]))
            })
        })
    })
}

/// Whether two straight lines have a point in common.
pub fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}

/// Whole periods that bring a hole inside an outline.
fn inside(mesh: &Mesh<'_>, face: usize, outline: &[Side], hole: &[Side]) -> DVec2 {
    let polygon: Vec<_> = outline.iter().flat_map(|side| side.path.polyline().collect::<Vec<_>>()).collect();
    let period = period(mesh, face);
    let closed = mesh.part.faces[face].surface.closed;
    let turns = |axis: usize| if closed[axis] { -2..=2 } else { 0..=0 };
    let start = hole[0].path.start();
    for i in turns(0) {
        for j in turns(1) {
            let by = DVec2::new(f64::from(i), f64::from(j)) * period;
            if contains(&polygon, start + by) {
                return by;
            }
        }
    }
    DVec2::ZERO
}

/// Whether a polygon goes round a point.
pub fn contains(polygon: &[DVec2], point: DVec2) -> bool {
    let mut inside = false;
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        if (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

/// The area of an outline and the sense in which it runs.
pub fn turns(sides: &[Side], winding: [i32; 2]) -> Turns {
    Turns { winding, area: if winding == [0, 0] { trace::area(sides) } else { 0.0 } }
}
