//! Loops in the parameters of their surfaces: where each edge runs, how often a loop winds round a closed parameter,
//! and where it passes a pole.

use crate::error::{HEAL, ImportError};
use crate::mesh::{Mesh, Side};
use crate::part::{Face, Part, Use};
use crate::path::Path;
use glam::DVec2;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// A loop as it was traced.
#[derive(Clone, Debug)]
pub struct Traced {
    /// Its sides.
    pub sides: Vec<Side>,
    /// How often it goes round each parameter.
    pub winding: [i32; 2],
}

/// Traces loops of a face, uncut; `limit` is how far an edge may lie off its face, millimetres.
pub fn all(part: &Part, face: usize, loops: &[Vec<Use>], limit: f64) -> Result<Vec<Traced>, ImportError> {
    let mesh = Mesh::new(part);
    loops.iter().map(|uses| trace(&mesh, face, uses, limit)).collect()
}

/// Traces a loop of a face; `limit` is how far an edge may lie off its face, millimetres.
pub fn trace(mesh: &Mesh<'_>, face: usize, uses: &[Use], limit: f64) -> Result<Traced, ImportError> {
    let of = &mesh.part.faces[face];
    let mut sides: Vec<Side> = Vec::new();
    let period = DVec2::new(of.surface.period(0), of.surface.period(1));
    // Never first an edge on which the surface meets itself: which of its sides is meant only the one before tells.
    let twice = |used: &Use| uses.iter().filter(|other| other.edge == used.edge).count() > 1;
    let first = uses.iter().position(|used| !twice(used)).unwrap_or(0);
    for used in uses[first..].iter().chain(&uses[..first]) {
        let path = traced(mesh, of, *used, limit)?;
        let ends = mesh.part.ends(*used);
        let mut side = Side { wire: Some((used.edge, used.reversed)), ends, path };
        if let Some(last) = sides.last().cloned() {
            side = side.shifted(shift(of, last.path.end(), side.path.start(), period));
            if let Some(pole) = pole_between(of, &last, &mut side, period) {
                sides.push(pole);
            } else {
                side = side.shifted(across_seam(of, last.path.end(), &side.path, period));
                check_joint(of, last.path.end(), side.path.start(), limit)?;
            }
        }
        sides.push(side);
    }
    let (first, last) = (sides[0].clone(), sides[sides.len() - 1].clone());
    let mut again = first.shifted(shift(of, last.path.end(), first.path.start(), period));
    if let Some(pole) = pole_between(of, &last, &mut again, period) {
        sides.push(pole);
    } else {
        check_joint(of, last.path.end(), again.path.start(), limit)?;
    }
    let whole = again.path.start() - first.path.start();
    let wind =
        |axis: usize, way: f64, period: f64| if of.surface.closed[axis] { (way / period).round() as i32 } else { 0 };
    let winding = [wind(0, whole.x, period.x), wind(1, whole.y, period.y)];
    Ok(Traced { sides, winding })
}

/// Area of a closed outline.
pub fn area(sides: &[Side]) -> f64 {
    let points: Vec<_> = sides.iter().flat_map(|side| side.path.polyline().collect::<Vec<_>>()).collect();
    let pairs = points.iter().zip(points.iter().cycle().skip(1));
    pairs.map(|(a, b)| 0.5 * a.perp_dot(*b)).sum()
}

/// Where a surface meets itself in a crease, an edge there lies at either end of the parameter: the way to the end at
/// which the loop is.
fn across_seam(face: &Face, to: DVec2, path: &Path, period: DVec2) -> DVec2 {
    let surface = &face.surface;
    for (axis, unit) in [(0, DVec2::X), (1, DVec2::Y)] {
        let way = (to - path.start()).dot(unit);
        let whole = period.dot(unit);
        let is_seam = surface.touching[axis] && !surface.closed[axis] && (way.abs() - whole).abs() < 1e-6 * whole;
        if is_seam && path.polyline().all(|uv| (uv - path.start()).dot(unit).abs() < 1e-6 * whole) {
            return unit * way;
        }
    }
    DVec2::ZERO
}

/// Refuses a loop that leaps in the parameters.
fn check_joint(face: &Face, from: DVec2, to: DVec2, limit: f64) -> Result<(), ImportError> {
    let jet = face.surface.at(to);
    let way = (from - to).abs();
    let gap = (jet.first[0].length() * way.x).max(jet.first[1].length() * way.y);
    let near = f64::max(10.0 * limit, 1e-3);
    if gap <= near {
        return Ok(());
    }
    Err(ImportError::face(face.label(), format!("a loop of it leaps {gap:.6} mm in its surface's parameters; {HEAL}")))
}

/// Whole periods that bring a point nearest to another.
pub fn shift(face: &Face, to: DVec2, from: DVec2, period: DVec2) -> DVec2 {
    let along = |axis: usize, way: f64, period: f64| {
        if face.surface.closed[axis] { (way / period).round() * period } else { 0.0 }
    };
    DVec2::new(along(0, to.x - from.x, period.x), along(1, to.y - from.y, period.y))
}

/// The side along a pole between two that meet there at different parameters. Along the lesser end of `v` the face lies
/// to the left of rising `u`, along the greater of falling; for poles of `u` it is the other way about.
fn pole_between(face: &Face, last: &Side, next: &mut Side, period: DVec2) -> Option<Side> {
    let (from, to) = (last.path.end(), next.path.start());
    for axis in 0..2 {
        let [low, high] = face.surface.range(axis);
        let (value, along) = if axis == 0 { (from.x, 1) } else { (from.y, 0) };
        let near = 1e-6 * (high - low);
        for (end, at) in [(0, low), (1, high)] {
            if !face.surface.poles[axis][end] || (value - at).abs() > near {
                continue;
            }
            let unit = if along == 0 { DVec2::X } else { DVec2::Y };
            let mut way = (to - from).dot(unit);
            let rising = (end == 0) == (axis == 1);
            if face.surface.closed[along] {
                let period = period.dot(unit);
                let turns = way.rem_euclid(period);
                let wanted = if rising || turns == 0.0 { turns } else { turns - period };
                *next = next.shifted(unit * (wanted - way));
                way = wanted;
            }
            if way.abs() <= 1e-9 * face.surface.period(along) {
                return None;
            }
            return Some(Side::pole(last.ends[1], from, from + unit * way));
        }
    }
    None
}

/// The path of an edge, which may be known.
fn traced(mesh: &Mesh<'_>, face: &Face, used: Use, limit: f64) -> Result<Path, ImportError> {
    let mut hasher = DefaultHasher::new();
    ("path", used.reversed, limit.to_bits()).hash(&mut hasher);
    face.surface.hash(&mut hasher);
    mesh.part.edges[used.edge].hash(&mut hasher);
    let (key, memory) = (hasher.finish(), &mesh.part.memory);
    if let Some(path) = memory.get(key) {
        return Ok(path);
    }
    let path = trace_edge(mesh, face, used, limit)?;
    memory.keep(key, path.clone());
    Ok(path)
}

fn trace_edge(mesh: &Mesh<'_>, face: &Face, used: Use, limit: f64) -> Result<Path, ImportError> {
    const STEPS: usize = 96;
    let edge = &mesh.part.edges[used.edge];
    let point = |k: usize| {
        let t = k as f64 / STEPS as f64;
        edge.at(if used.reversed { 1.0 - t } else { t })[0]
    };
    let surface = &face.surface;
    let mut feet = vec![DVec2::ZERO; STEPS + 1];
    let middle = STEPS / 2;
    let start = surface.locate(point(middle));
    let start = surface.project_within(point(middle), start.uv, limit);
    let mut farthest = start.distance;
    feet[middle] = start.uv;
    for k in middle + 1..=STEPS {
        let guess = if k > middle + 1 { feet[k - 1] * 2.0 - feet[k - 2] } else { feet[k - 1] };
        let foot = surface.project_within(point(k), guess, limit);
        farthest = farthest.max(foot.distance);
        feet[k] = foot.uv;
    }
    for k in (0..middle).rev() {
        let foot = surface.project_within(point(k), feet[k + 1] * 2.0 - feet[k + 2], limit);
        farthest = farthest.max(foot.distance);
        feet[k] = foot.uv;
    }
    // At a pole one of the parameters means nothing: it goes on as it came.
    for (end, before, earlier) in [(0, 1, 2), (STEPS, STEPS - 1, STEPS - 2)] {
        for axis in 0..2 {
            let [low, high] = surface.range(axis);
            let is_pole = |which: usize, at: f64| {
                surface.poles[axis][which] && (feet[end][axis] - at).abs() < 1e-6 * (high - low)
            };
            if is_pole(0, low) || is_pole(1, high) {
                let other = 1 - axis;
                feet[end][other] = 2.0 * feet[before][other] - feet[earlier][other];
            }
        }
    }
    if farthest > limit {
        let label = edge.label(used.edge);
        return Err(ImportError::face(face.label(), format!("its {label} lies {farthest:.6} mm off it; {HEAL}")));
    }
    // Of a straight one two samples say all.
    let straight = |k: usize| feet[0].lerp(feet[STEPS], k as f64 / STEPS as f64);
    let scale = surface.period(0).max(surface.period(1));
    if (0..=STEPS).all(|k| feet[k].distance(straight(k)) <= 1e-11 * scale) {
        return Ok(Path::line(feet[0], feet[STEPS]));
    }
    Ok(Path::sampled(|t| feet[(t * STEPS as f64).round() as usize]))
}
