//! The outlines of all faces, closed in their parameters, and every wire of them cut into pieces that one curve can
//! follow.

use crate::circles::{self, Turns};
use crate::error::ImportError;
use crate::mesh::{Mesh, Source};
use crate::part::Part;
use crate::patches::SHARE_OF_EDGES;
use crate::{outline, trace};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_2;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// How finely edges are cut, because a face of theirs was too much: 1 and 2 halve the pieces once and twice.
pub type Fine = BTreeMap<usize, i32>;
/// The finest of these levels.
pub const FINEST: i32 = 2;

/// The part with every face's outline closed in its parameters, and every wire cut into pieces that one curve can
/// follow.
pub fn outlined<'p>(part: &'p Part, fine: &Fine, tolerance: f64) -> Result<Mesh<'p>, ImportError> {
    let mut mesh = Mesh::new(part);
    let mut all_turns: Vec<Vec<Turns>> = Vec::new();
    for (face, of) in part.faces.iter().enumerate() {
        let mut turns = Vec::new();
        let mut loops = Vec::new();
        for uses in &of.loops {
            let traced = trace::trace(&mesh, face, uses, tolerance)?;
            turns.push(outline::turns(&traced.sides, traced.winding));
            loops.push(traced.sides);
        }
        mesh.regions[face].loops = loops;
        all_turns.push(turns);
    }
    let count = |mesh: &Mesh<'_>, wire: usize| {
        let level = match mesh.wires[wire].source {
            Source::Edge { edge, .. } => fine.get(&edge).copied().unwrap_or(0),
            Source::Inside { .. } => 0,
        };
        let Source::Edge { edge, range } = mesh.wires[wire].source else { return pieces(mesh, wire, level, tolerance) };
        let mut hasher = DefaultHasher::new();
        ("pieces", level, range.map(f64::to_bits), tolerance.to_bits()).hash(&mut hasher);
        part.edges[edge].hash(&mut hasher);
        let (key, memory) = (hasher.finish(), &part.memory);
        memory.get(key).unwrap_or_else(|| {
            let count = pieces(mesh, wire, level, tolerance);
            memory.keep(key, count);
            count
        })
    };
    cut_bent(&mut mesh, &count, false);
    circles::cut(&mut mesh, &all_turns, &count);
    for (face, turns) in all_turns.iter().enumerate() {
        outline::close(&mut mesh, face, turns)?;
    }
    cut_bent(&mut mesh, &count, true);
    Ok(mesh)
}

/// Into how many pieces a wire is cut: none turns by more than a quarter, or less on a finer level, and each is one
/// curve within the tolerance.
fn pieces(mesh: &Mesh<'_>, wire: usize, level: i32, tolerance: f64) -> usize {
    let (_, turn) = mesh.extent(wire);
    let mut count = ((turn - 0.05) / (FRAC_PI_2 * 0.5_f64.powi(level))).ceil().max(1.0) as usize;
    // On the finest even what is straight is cut.
    count = count.max(if level == FINEST { 2 } else { 1 });
    while count < 64 {
        let borders: Vec<f64> = [0.0].into_iter().chain(mesh.even(wire, count)).chain([1.0]).collect();
        let near = borders.windows(2).all(|pair| {
            let at = |t: f64| {
                let [point, slope] = mesh.at(wire, pair[0] + (pair[1] - pair[0]) * t);
                [point, slope * (pair[1] - pair[0])]
            };
            crate::fit::fit_curve(at, [at(0.0)[0], at(1.0)[0]], 5).deviation <= SHARE_OF_EDGES * tolerance
        });
        if near {
            break;
        }
        count += 1;
    }
    count
}

/// Cuts the wires of the outlines that need it; those that are closed and meet no other only if `all`.
fn cut_bent(mesh: &mut Mesh<'_>, count: &dyn Fn(&Mesh<'_>, usize) -> usize, all: bool) {
    let sides = mesh.regions.iter().flat_map(|region| region.loops.iter().flatten());
    let wires: BTreeSet<usize> = sides.filter_map(|side| side.wire.map(|(wire, _)| wire)).collect();
    for wire in wires {
        let ends = mesh.wires[wire].ends;
        if ends[0] == ends[1] && !all {
            continue;
        }
        let count = count(mesh, wire).max(if ends[0] == ends[1] { 4 } else { 1 });
        if count > 1 {
            let at = mesh.even(wire, count);
            mesh.cut(wire, &at);
        }
    }
}
