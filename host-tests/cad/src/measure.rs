//! How far the result is from the part, both ways; volume and area beside the part's.

use crate::bezier::Bezier;
use crate::mesh::{Mesh, Side};
use crate::nurbs::Surface;
use crate::outline::contains;
use crate::patches::Made;
use glam::{DVec2, DVec3};

/// Measured deviations.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// The largest distance of a point of a patch, or of an edge's curve, from the part, millimetres; and its face.
    pub out: (f64, usize),
    /// The largest distance of a point of the part from the patches, millimetres; and its face.
    pub back: (f64, usize),
    /// The largest angle between the normals, degrees; and its face.
    pub normal: (f64, usize),
    /// Area of the patches and of the part, mm².
    pub area: [f64; 2],
    /// Volume inside the patches and inside the part, mm³, by the divergence theorem; means nothing where the part is
    /// open.
    pub volume: [f64; 2],
}

/// Intervals of the grid on a patch, and on the box of a face's parameters.
const ON_PATCH: usize = 24;
const ON_FACE: usize = 40;

/// Measures.
pub fn measure(mesh: &Mesh<'_>, made: &[Made], tolerance: f64) -> Measured {
    let mut measured = Measured::default();
    for made in made {
        let face = made.face;
        let surface = &mesh.part.faces[face].surface;
        let distance = |at: DVec2| surface.project(made.bezier.at(at.x, at.y)[0], made.quad.map(at.x, at.y)).distance;
        let mut worst = (0.0, DVec2::ZERO);
        for k in 0..=ON_PATCH {
            for l in 0..=ON_PATCH {
                let at = DVec2::new(k as f64, l as f64) / ON_PATCH as f64;
                let [point, du, dv] = made.bezier.at(at.x, at.y);
                let foot = surface.project(point, made.quad.map(at.x, at.y));
                if foot.distance > worst.0 {
                    worst = (foot.distance, at);
                }
                let cross = du.cross(dv);
                if cross.length() > 1e-6 * du.length_squared().max(dv.length_squared()) {
                    let angle = cross.angle_between(surface.normal(foot.uv)).to_degrees();
                    if angle > measured.normal.0 {
                        measured.normal = (angle, face);
                    }
                }
            }
        }
        let largest =
            climb(worst, 1.0 / ON_PATCH as f64, &distance, &|at| at.clamp(DVec2::ZERO, DVec2::ONE)).max(made.edges_off);
        if largest > measured.out.0 {
            measured.out = (largest, face);
        }
    }
    for face in 0..mesh.regions.len() {
        let largest = back(mesh, face, made, 0.1 * tolerance);
        if largest > measured.back.0 {
            measured.back = (largest, face);
        }
    }
    integrate(mesh, made, &mut measured);
    measured
}

/// From the best point of a grid to a greater value near it, by steps that shrink.
fn climb(start: (f64, DVec2), step: f64, value: &dyn Fn(DVec2) -> f64, keep: &dyn Fn(DVec2) -> DVec2) -> f64 {
    let (mut best, mut at) = start;
    let mut step = 0.5 * step;
    for _ in 0..8 {
        for k in 0..8 {
            let next = keep(at + DVec2::from_angle(f64::from(k) * std::f64::consts::FRAC_PI_4) * step);
            let there = value(next);
            if there > best {
                (best, at) = (there, next);
            }
        }
        step *= 0.6;
    }
    best
}

/// The largest distance from a point of a face to its patches.
fn back(mesh: &Mesh<'_>, face: usize, made: &[Made], near: f64) -> f64 {
    const TABLE: usize = 6;
    let surface = &mesh.part.faces[face].surface;
    let polygons: Vec<Vec<DVec2>> = mesh.regions[face]
        .loops
        .iter()
        .map(|sides| sides.iter().flat_map(|side| outlined(surface, side, near)).collect())
        .collect();
    let own: Vec<&Bezier> = made.iter().filter(|made| made.face == face).map(|made| &made.bezier).collect();
    let mut table: Vec<(DVec3, usize, [f64; 2])> = Vec::new();
    for (index, patch) in own.iter().enumerate() {
        for k in 0..TABLE * TABLE {
            let at = [k % TABLE, k / TABLE].map(|k| (k as f64 + 0.5) / TABLE as f64);
            table.push((patch.at(at[0], at[1])[0], index, at));
        }
    }
    let distance = |uv: DVec2| {
        let point = surface.at(uv).point;
        // Patch by patch, the one with the nearest sample first, until one holds the point.
        let mut starts: Vec<(f64, usize)> = table
            .chunks(TABLE * TABLE)
            .enumerate()
            .map(|(patch, entries)| {
                let far = entries.iter().enumerate().map(|(k, entry)| (entry.0.distance_squared(point), k));
                let (far, k) = far.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0));
                (far, patch * TABLE * TABLE + k)
            })
            .collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut least = f64::INFINITY;
        for (_, k) in starts {
            let (_, patch, at) = table[k];
            least = least.min(own[patch].project(point, at).1);
            if least <= near {
                break;
            }
        }
        least
    };
    let is_inside = |uv: DVec2| contains(&polygons[0], uv) && !polygons[1..].iter().any(|hole| contains(hole, uv));
    let low = polygons[0].iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = polygons[0].iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let mut worst = (0.0, DVec2::ZERO);
    let mut is_any = false;
    for k in 0..ON_FACE * ON_FACE {
        let share = DVec2::new((k % ON_FACE) as f64 + 0.5, (k / ON_FACE) as f64 + 0.5) / ON_FACE as f64;
        let uv = low + (high - low) * share;
        if is_inside(uv) {
            is_any = true;
            let here = distance(uv);
            if here > worst.0 {
                worst = (here, uv);
            }
        }
    }
    if !is_any {
        return worst.0;
    }
    let scale = high - low;
    let start = (worst.0, (worst.1 - low) / scale);
    let outside = |at: DVec2| if is_inside(low + at * scale) { distance(low + at * scale) } else { 0.0 };
    climb(start, 1.0 / ON_FACE as f64, &outside, &|at| at)
}

/// Points along a side, all but the last, dense enough that no straight line between two deviates by more than `near`,
/// millimetres.
fn outlined(surface: &Surface, side: &Side, near: f64) -> Vec<DVec2> {
    const COARSE: usize = 16;
    const MOST: f64 = 64.0;
    let at = |k: usize, count: usize| side.path.at(k as f64 / count as f64);
    let sag = (0..COARSE).map(|k| {
        let middle = at(2 * k + 1, 2 * COARSE);
        surface.at(middle).point.distance(surface.at(at(k, COARSE).midpoint(at(k + 1, COARSE))).point)
    });
    // The sag falls with the square of the step.
    let finer = (sag.fold(0.0, f64::max) / near).sqrt().ceil().clamp(1.0, MOST);
    let count = COARSE * finer as usize;
    (0..count).map(|k| at(k, count)).collect()
}

/// Areas and volumes by Gauss's quadrature, eight by eight: exact for the volume of the patches. The part's edges bend
/// at their knots: there each quad is taken in 4 × 4 pieces.
fn integrate(mesh: &Mesh<'_>, made: &[Made], measured: &mut Measured) {
    const PIECES: usize = 4;
    let nodes = gauss();
    let centre = made.first().map_or(DVec3::ZERO, |made| made.bezier.points[0]);
    for made in made {
        let face = &mesh.part.faces[made.face];
        let turn = if face.flip { -1.0 } else { 1.0 };
        for (s, a) in nodes {
            for (t, b) in nodes {
                let [point, du, dv] = made.bezier.at(s, t);
                let cross = du.cross(dv) * (a * b);
                measured.area[0] += cross.length();
                measured.volume[0] += turn * (point - centre).dot(cross) / 3.0;
                for k in 0..PIECES * PIECES {
                    let [s, t] = [(s, k % PIECES), (t, k / PIECES)].map(|(x, k)| (x + k as f64) / PIECES as f64);
                    let step = 1e-4;
                    let ds = (made.quad.map(s + step, t) - made.quad.map(s - step, t)) / (2.0 * step);
                    let dt = (made.quad.map(s, t + step) - made.quad.map(s, t - step)) / (2.0 * step);
                    let jet = face.surface.at(made.quad.map(s, t));
                    let cross = jet.cross() * (ds.perp_dot(dt) * a * b / (PIECES * PIECES) as f64);
                    measured.area[1] += cross.length();
                    measured.volume[1] += turn * (jet.point - centre).dot(cross) / 3.0;
                }
            }
        }
    }
}

/// Nodes and weights over `[0, 1]`: zeros of Legendre's polynomial of degree 8, by Newton's method.
fn gauss() -> [(f64, f64); 8] {
    std::array::from_fn(|k| {
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / 8.5).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut before, mut value) = (1.0, x);
            for n in 1..8 {
                let n = f64::from(n);
                (before, value) = (value, ((2.0 * n + 1.0) * x * value - n * before) / (n + 1.0));
            }
            slope = 8.0 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
}
