//! The outlines of all faces, closed in their parameters, and every wire of them cut into pieces that one curve can
//! follow.

use crate::circles::{self, Turns};
use crate::error::ImportError;
use crate::fit::fit_curve;
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
const MOST_PIECES: usize = 64;
/// Of the search for the end of a piece.
const HALVINGS: usize = 10;

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
    let places = |mesh: &Mesh<'_>, wire: usize| {
        let level = match mesh.wires[wire].source {
            Source::Edge { edge, .. } => fine.get(&edge).copied().unwrap_or(0),
            Source::Inside { .. } => 0,
        };
        let Source::Edge { edge, range } = mesh.wires[wire].source else { return places(mesh, wire, level, tolerance) };
        let mut hasher = DefaultHasher::new();
        ("pieces", level, range.map(f64::to_bits), tolerance.to_bits()).hash(&mut hasher);
        part.edges[edge].hash(&mut hasher);
        let (key, memory) = (hasher.finish(), &part.memory);
        memory.get(key).unwrap_or_else(|| {
            let places = places(mesh, wire, level, tolerance);
            memory.keep(key, places.clone());
            places
        })
    };
    cut_bent(&mut mesh, &places, false);
    circles::cut(&mut mesh, &all_turns, &|mesh, wire| places(mesh, wire).len() + 1);
    for (face, turns) in all_turns.iter().enumerate() {
        outline::close(&mut mesh, face, turns)?;
    }
    cut_bent(&mut mesh, &places, true);
    Ok(mesh)
}

/// Where a wire is cut: no piece turns by more than a quarter, or less on a finer level, and each is one curve within the
/// tolerance.
fn places(mesh: &Mesh<'_>, wire: usize, level: i32, tolerance: f64) -> Vec<f64> {
    let turned = |turn: f64| ((turn - 0.05) / (FRAC_PI_2 * 0.5_f64.powi(level))).ceil().max(1.0) as usize;
    let is_near = |[from, to]: [f64; 2], share: f64| {
        let at = |t: f64| {
            let [point, slope] = mesh.at(wire, from + (to - from) * t);
            [point, slope * (to - from)]
        };
        fit_curve(at, [at(0.0)[0], at(1.0)[0]], 5).deviation <= share * SHARE_OF_EDGES * tolerance
    };
    // On the finest even what is straight is cut.
    let fewest = turned(mesh.extent(wire).1).max(if level == FINEST { 2 } else { 1 });
    let mut even = Vec::new();
    for count in fewest..=MOST_PIECES {
        even = mesh.even(wire, count);
        let borders: Vec<f64> = [0.0].into_iter().chain(even.iter().copied()).chain([1.0]).collect();
        if borders.windows(2).all(|pair| is_near([pair[0], pair[1]], 1.0)) {
            break;
        }
    }
    if even.len() < fewest {
        return even;
    }
    // Where a tight bend or a knot asks for more pieces, each is as long as it can be; `share` is of both limits.
    let reach = |share: f64| {
        let is_sound = |piece: [f64; 2]| turned(mesh.turn_of(wire, piece) / share) == 1 && is_near(piece, share);
        let mut reached = vec![0.0];
        while let Some(&from) = reached.last()
            && from < 1.0
            && reached.len() <= even.len()
        {
            let [mut low, mut high] = if is_sound([from, 1.0]) { [1.0; 2] } else { [from, 1.0] };
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                *(if is_sound([from, middle]) { &mut low } else { &mut high }) = middle;
            }
            reached.push(low);
        }
        (reached.pop() == Some(1.0)).then(|| reached.split_off(1))
    };
    let Some(mut best) = reach(1.0) else { return even };
    // Then all of them as far from the limits.
    let [mut low, mut high] = [0.0, 1.0];
    for _ in 0..HALVINGS / 2 {
        let middle = 0.5 * (low + high);
        match reach(middle).filter(|places| places.len() == best.len()) {
            Some(places) => (best, high) = (places, middle),
            None => low = middle,
        }
    }
    best
}

/// Cuts the wires of the outlines that need it; those that are closed and meet no other only if `all`.
fn cut_bent(mesh: &mut Mesh<'_>, places: &dyn Fn(&Mesh<'_>, usize) -> Vec<f64>, all: bool) {
    let sides = mesh.regions.iter().flat_map(|region| region.loops.iter().flatten());
    let wires: BTreeSet<usize> = sides.filter_map(|side| side.wire.map(|(wire, _)| wire)).collect();
    for wire in wires {
        let ends = mesh.wires[wire].ends;
        if ends[0] == ends[1] && !all {
            continue;
        }
        let mut at = places(mesh, wire);
        if ends[0] == ends[1] && at.len() < 3 {
            at = mesh.even(wire, 4);
        }
        if !at.is_empty() {
            mesh.cut(wire, &at);
        }
    }
}
