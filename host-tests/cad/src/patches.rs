//! Wires to curves, quads to patches, and cuts where the tolerance asks for them.

use crate::bezier::{Bezier, Points};
use crate::error::ImportError;
use crate::fit::{FittedCurve, fit_curve, fit_patch};
use crate::mesh::{Mesh, Quad};
use crate::{proof, strips};
use std::collections::hash_map::DefaultHasher;
use std::collections::{BTreeSet, HashMap};
use std::hash::{Hash as _, Hasher as _};

/// Of the tolerance, what the curves of edges may use up.
pub const SHARE_OF_EDGES: f64 = 0.6;
/// Rounds of cutting.
const ROUNDS: usize = 12;
/// A curve that is off its chord by less than this share of the tolerance is a straight line.
pub const STRAIGHT: f64 = 0.02;
/// The effort of fitting a patch of some degrees and measuring it.
const FITTED: u64 = 12_000;
/// The most patches a body can have.
pub const MOST: usize = 1024;

/// A finished patch.
#[derive(Clone, Debug)]
pub struct Made {
    /// Its face.
    pub face: usize,
    /// Where in the face it lies.
    pub quad: Quad,
    /// The patch; its parameters run as the quad's.
    pub bezier: Bezier,
    /// How far the curves of its borders are off the edges.
    pub edges_off: f64,
}

/// Patches for all quads.
///
/// # Errors
/// The faces that do not come within the tolerance, or have a patch that is not proved regular.
pub fn make(mesh: &mut Mesh<'_>, tolerance: f64) -> Result<Vec<Made>, Vec<ImportError>> {
    let mut curves: HashMap<usize, FittedCurve> = HashMap::new();
    let mut least: HashMap<usize, usize> = HashMap::new();
    for round in 0..ROUNDS {
        let count: usize = mesh.regions.iter().map(|region| region.quads.len()).sum();
        if count > MOST {
            let worst = (0..mesh.regions.len()).max_by_key(|face| mesh.regions[*face].quads.len()).unwrap_or(0);
            let reason = format!(
                "the part takes {count} patches, most of them here, and a body has {MOST} at most: import one solid \
                 (--solid), leave out small features, or try a greater tolerance"
            );
            return Err(vec![ImportError::too_many(mesh.part, worst, reason)]);
        }
        let mut cuts: BTreeSet<usize> = BTreeSet::new();
        let mut raised = false;
        let mut made = Vec::new();
        for face in 0..mesh.regions.len() {
            for quad in &mesh.regions[face].quads {
                for (wire, _) in quad.sides.iter().filter_map(|side| side.wire) {
                    let degree = least.get(&wire).copied().unwrap_or(1);
                    let curve = curves.entry(wire).or_insert_with(|| curve_of(mesh, wire, degree, tolerance));
                    if curve.deviation > SHARE_OF_EDGES * tolerance {
                        cuts.insert(wire);
                    }
                }
                let (patch, off) = patch_of(mesh, face, quad, &curves, tolerance);
                if off > tolerance {
                    let bent = |wire: &usize| curves[wire].points.len() == 4;
                    let wires: Vec<usize> =
                        quad.sides.iter().filter_map(|side| side.wire.map(|(wire, _)| wire)).collect();
                    if off < 8.0 * tolerance && wires.iter().any(bent) {
                        for wire in wires.into_iter().filter(bent) {
                            least.insert(wire, 5);
                            raised = true;
                        }
                    } else {
                        cuts.extend(longer(mesh, face, quad));
                    }
                }
                let wires = quad.sides.iter().filter_map(|side| side.wire);
                let edges_off = wires.map(|(wire, _)| curves[&wire].deviation).fold(0.0, f64::max);
                made.push(Made { face, quad: quad.clone(), bezier: patch, edges_off });
            }
        }
        if cuts.is_empty() && !raised {
            return check(mesh, made);
        }
        if round + 1 == ROUNDS || mesh.part.effort.is_spent() {
            break;
        }
        curves.retain(|wire, curve| least.get(wire).copied().unwrap_or(1) < curve.points.len());
        strips::cut(mesh, &cuts.into_iter().collect::<Vec<_>>());
    }
    let worst = (0..mesh.regions.len()).max_by_key(|face| mesh.regions[*face].quads.len()).unwrap_or(0);
    let reason = format!(
        "it does not come within {tolerance} mm by cutting, as it may within a greater tolerance (--tolerance)"
    );
    Err(vec![ImportError::too_much(mesh.part, worst, reason)])
}

fn check(mesh: &Mesh<'_>, made: Vec<Made>) -> Result<Vec<Made>, Vec<ImportError>> {
    let mut bad: Vec<&Made> = made.iter().filter(|made| !proof::is_regular(&made.bezier)).collect();
    bad.dedup_by_key(|made| made.face);
    if bad.is_empty() {
        return Ok(made);
    }
    let error = |bad: &Made| {
        let centre = bad.bezier.at(0.5, 0.5)[0];
        let reason = format!(
            "a patch of it, about ({:.3}, {:.3}, {:.3}) mm, is not proved to have a tangent plane everywhere",
            centre.x, centre.y, centre.z
        );
        ImportError::too_much(mesh.part, bad.face, reason)
    };
    Err(bad.into_iter().map(error).collect())
}

/// The curve of a wire: of the lowest degree of 1, 3 and 5 that is near enough.
pub fn curve_of(mesh: &Mesh<'_>, wire: usize, least: usize, tolerance: f64) -> FittedCurve {
    let ends = mesh.wires[wire].ends.map(|node| mesh.nodes[node]);
    let fit = |degree: usize| fit_curve(|t| mesh.at(wire, t), ends, degree);
    if least <= 1 {
        let line = fit(1);
        if line.deviation <= STRAIGHT * tolerance {
            return line;
        }
    }
    if least <= 3 {
        let cubic = fit(3);
        if cubic.deviation <= SHARE_OF_EDGES * tolerance {
            return cubic;
        }
    }
    fit(5)
}

/// The patch of the lowest degrees that is near enough, or the nearest; and its deviation.
fn patch_of(
    mesh: &Mesh<'_>,
    face: usize,
    quad: &Quad,
    curves: &HashMap<usize, FittedCurve>,
    tolerance: f64,
) -> (Bezier, f64) {
    let side = |k: usize, turned: bool| -> Points {
        let side = &quad.sides[k];
        let Some((wire, against)) = side.wire else { return vec![mesh.nodes[side.ends[0]]; 2] };
        let mut points = curves[&wire].points.clone();
        if against != turned {
            points.reverse();
        }
        points
    };
    let sides = [side(0, false), side(1, false), side(2, true), side(3, true)];
    let mut hasher = DefaultHasher::new();
    let paths = quad.sides.each_ref().map(|side| (&side.path, side.wire.is_none()));
    format!("{} {paths:?} {sides:?}", mesh.part.faces[face].name).hash(&mut hasher);
    let (key, memory) = (hasher.finish(), &mesh.part.memory);
    memory.get(key).unwrap_or_else(|| {
        let fitted = fit(mesh, face, quad, &sides, tolerance);
        memory.keep(key, fitted.clone());
        fitted
    })
}

fn fit(mesh: &Mesh<'_>, face: usize, quad: &Quad, sides: &[Points; 4], tolerance: f64) -> (Bezier, f64) {
    let surface = &mesh.part.faces[face].surface;
    let has_pole = quad.sides.iter().any(|side| side.wire.is_none());
    let mut best: Option<(Bezier, f64)> = None;
    for least in [[1, 1], [3, 3], [5, 5]] {
        mesh.part.effort.spend(FITTED);
        mesh.part.effort.tell(&mesh.part.faces[face].name);
        let mut patch = fit_patch(surface, quad, sides, least, 1.0);
        if best.as_ref().is_some_and(|(other, _)| other.degree == patch.degree) {
            continue;
        }
        let mut off = deviation(mesh, face, quad, &patch);
        // Beside a pole little holds the inner points where they are.
        if has_pole && !proof::is_regular(&patch) {
            for firmness in FIRM {
                let firm = fit_patch(surface, quad, sides, least, firmness);
                if proof::is_regular(&firm) {
                    (off, patch) = (deviation(mesh, face, quad, &firm), firm);
                    break;
                }
            }
        }
        if best.as_ref().is_none_or(|(_, least)| off < 0.9 * least) {
            best = Some((patch, off));
        }
        if off <= 0.8 * tolerance || surface.degree == [1, 1] {
            break;
        }
    }
    best.unwrap_or_else(|| (fit_patch(surface, quad, sides, [1, 1], 1.0), f64::INFINITY))
}

/// Firmness of a patch with a pole that folds without it, tried in turn: the steeper the tip, the more it takes.
const FIRM: [f64; 3] = [30.0, 1_000.0, 1e6];

fn deviation(mesh: &Mesh<'_>, face: usize, quad: &Quad, patch: &Bezier) -> f64 {
    const STEPS: usize = 13;
    let surface = &mesh.part.faces[face].surface;
    let mut largest: f64 = 0.0;
    for k in 0..=STEPS {
        for l in 0..=STEPS {
            let (s, t) = (k as f64 / STEPS as f64, l as f64 / STEPS as f64);
            largest = largest.max(surface.project(patch.at(s, t)[0], quad.map(s, t)).distance);
        }
    }
    largest
}

/// The wires to cut for two quads along the way in which the normal turns more, or that is longer.
fn longer(mesh: &Mesh<'_>, face: usize, quad: &Quad) -> Vec<usize> {
    let surface = &mesh.part.faces[face].surface;
    let measure = |axis: usize| {
        let at = |k: usize| {
            let x = k as f64 / 8.0;
            if axis == 0 { quad.map(x, 0.5) } else { quad.map(0.5, x) }
        };
        let pairs = (0..8).map(|k| {
            let turn = surface.normal(at(k)).angle_between(surface.normal(at(k + 1)));
            let length = surface.at(at(k)).point.distance(surface.at(at(k + 1)).point);
            (if turn.is_finite() { turn } else { 0.0 }, length)
        });
        pairs.fold((0.0, 0.0), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1))
    };
    let (across, up) = (measure(0), measure(1));
    let is_across = if (across.0 - up.0).abs() > 0.1 * across.0.max(up.0) { across.0 > up.0 } else { across.1 > up.1 };
    let sides = if is_across { [0, 2] } else { [1, 3] };
    sides.iter().filter_map(|k| quad.sides[*k].wire.map(|(wire, _)| wire)).collect()
}
