//! Closed edges that meet no other: where they are cut is free.
//!
//! Circles that bound one tube are cut where the lines along it meet them. Where a circle lies in a plane, the cuts
//! look towards the corners of the other outlines there, so that the quads between are as square as they can be.

use crate::mesh::{Mesh, Side, Source};
use crate::trace;
use glam::DVec2;
use std::f64::consts::TAU;

/// Winding and area of a traced loop.
#[derive(Clone, Copy, Debug)]
pub struct Turns {
    /// Number of turns around each closed parameter.
    pub winding: [i32; 2],
    /// Enclosed area in the parameters.
    pub area: f64,
}

/// Cuts every closed edge that meets no other into `pieces(wire)` at least.
pub fn cut(mesh: &mut Mesh<'_>, turns: &[Vec<Turns>], pieces: &dyn Fn(&Mesh<'_>, usize) -> usize) {
    let free = free(mesh);
    let tubes = tubes(turns);
    // Those on a tube whose other end has corners are cut beneath those.
    let mut done = vec![false; free.len()];
    loop {
        let mut moved = false;
        for (face, axis, loops) in &tubes {
            for (from, to) in [(loops[0], loops[1]), (loops[1], loops[0])] {
                let Some(wire) = single(mesh, *face, to) else { continue };
                if wire >= free.len() || !free[wire] || done[wire] || mesh.regions[*face].loops[from].len() < 3 {
                    continue;
                }
                let at = beneath(mesh, *face, *axis, from, to);
                if at.len() >= 3 {
                    rotate_and_cut(mesh, wire, &at);
                    done[wire] = true;
                    moved = true;
                }
            }
        }
        if moved {
            continue;
        }
        // The next that nothing ties: all circles of its group have their say.
        let Some(seed) = (0..free.len()).find(|wire| free[*wire] && !done[*wire]) else { break };
        let group = group(mesh, &tubes, &free, &done, seed);
        let count = group.iter().map(|(wire, _)| pieces(mesh, *wire)).max().unwrap_or(4);
        let phase = phase(mesh, &group, count);
        let at: Vec<f64> = (0..count).map(|k| (phase + k as f64 / count as f64).rem_euclid(1.0)).collect();
        let at: Vec<f64> = at.into_iter().map(|share| by_length(mesh, seed, share)).collect();
        rotate_and_cut(mesh, seed, &at);
        done[seed] = true;
    }
}

/// Which wires are closed edges that meet no other.
fn free(mesh: &Mesh<'_>) -> Vec<bool> {
    let mut uses = vec![0; mesh.nodes.len()];
    let mut used = vec![false; mesh.wires.len()];
    for side in mesh.regions.iter().flat_map(|region| region.loops.iter().flatten()) {
        if let Some((wire, _)) = side.wire
            && !std::mem::replace(&mut used[wire], true)
        {
            for end in mesh.wires[wire].ends {
                uses[end] += 1;
            }
        }
    }
    let is_free = |wire: usize| {
        let ends = mesh.wires[wire].ends;
        used[wire] && ends[0] == ends[1] && uses[ends[0]] == 2
    };
    (0..mesh.wires.len()).map(is_free).collect()
}

/// Faces between two loops that wind: the face, the parameter round it, and the loops.
fn tubes(turns: &[Vec<Turns>]) -> Vec<(usize, usize, [usize; 2])> {
    let mut tubes = Vec::new();
    for (face, turns) in turns.iter().enumerate() {
        for axis in 0..2 {
            let winding: Vec<usize> = (0..turns.len()).filter(|index| turns[*index].winding[axis] != 0).collect();
            if let [a, b] = winding[..] {
                tubes.push((face, axis, [a, b]));
            }
        }
    }
    tubes
}

/// The wire of a loop that has one side.
fn single(mesh: &Mesh<'_>, face: usize, index: usize) -> Option<usize> {
    match &mesh.regions[face].loops[index][..] {
        [Side { wire: Some((wire, _)), .. }] => Some(*wire),
        _ => None,
    }
}

/// The parameters of a loop's single wire that lie beneath the corners of another loop, in order.
fn beneath(mesh: &Mesh<'_>, face: usize, axis: usize, from: usize, to: usize) -> Vec<f64> {
    let side = mesh.regions[face].loops[to][0].clone();
    let corners: Vec<f64> = mesh.regions[face].loops[from]
        .iter()
        .filter(|side| side.wire.is_some())
        .map(|side| side.path.start()[axis])
        .collect();
    let mut at: Vec<f64> = corners.iter().map(|value| where_at(mesh, face, axis, &side, *value)).collect();
    at.sort_by(f64::total_cmp);
    at.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    at
}

/// The wire's parameter where a side that winds has this value of the parameter round.
fn where_at(mesh: &Mesh<'_>, face: usize, axis: usize, side: &Side, value: f64) -> f64 {
    let period = mesh.part.faces[face].surface.period(axis);
    let (start, end) = (side.path.start()[axis], side.path.end()[axis]);
    let rising = end > start;
    let (low, high) = (start.min(end), start.max(end));
    let wanted = low + (value - low).rem_euclid(period);
    if (wanted - low).abs() < 1e-9 * period || (high - wanted).abs() < 1e-9 * period {
        return 0.0;
    }
    let (mut a, mut b) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if (side.path.at(middle)[axis] < wanted) == rising { a = middle } else { b = middle }
    }
    let t = 0.5 * (a + b);
    if side.wire.is_some_and(|(_, against)| against) { 1.0 - t } else { t }
}

/// Circles that tubes connect, each with its offset from the start of the first one, as a fraction of its length, and
/// its sense.
fn group(
    mesh: &Mesh<'_>,
    tubes: &[(usize, usize, [usize; 2])],
    free: &[bool],
    done: &[bool],
    seed: usize,
) -> Vec<(usize, [f64; 2])> {
    let mut group = vec![(seed, [0.0, 1.0])];
    let mut next = 0;
    while next < group.len() {
        let (wire, [offset, sense]) = group[next];
        next += 1;
        for (face, axis, loops) in tubes {
            for (from, to) in [(loops[0], loops[1]), (loops[1], loops[0])] {
                let (Some(a), Some(b)) = (single(mesh, *face, from), single(mesh, *face, to)) else { continue };
                if a != wire || b >= free.len() || !free[b] || done[b] || group.iter().any(|(of, _)| *of == b) {
                    continue;
                }
                let (of_a, of_b) = (&mesh.regions[*face].loops[from][0], &mesh.regions[*face].loops[to][0]);
                let place = where_at(mesh, *face, *axis, of_b, of_a.path.at(0.0)[*axis]);
                let rises = |side: &Side| {
                    let rising = side.path.end()[*axis] > side.path.start()[*axis];
                    rising != side.wire.is_some_and(|(_, against)| against)
                };
                let turn = if rises(of_a) == rises(of_b) { 1.0 } else { -1.0 };
                // A point at share x of the new circle is at offset + sense · (x − place) · turn of the first.
                let (new_sense, place) = (sense * turn, share_of(mesh, b, place));
                group.push((b, [offset - new_sense * place, new_sense]));
            }
        }
    }
    group
}

/// Start of the cuts of the first circle of a group, as a fraction of its length, below `1/count`.
fn phase(mesh: &Mesh<'_>, group: &[(usize, [f64; 2])], count: usize) -> f64 {
    let mut sum = DVec2::ZERO;
    for (wire, [offset, sense]) in group {
        let samples: Vec<_> = (0..360).map(|k| mesh.at(*wire, f64::from(k) / 360.0)[0]).collect();
        for (face, region) in mesh.part.faces.iter().zip(&mesh.regions) {
            let on = |side: &Side| side.wire.is_some_and(|(of, _)| of == *wire);
            if face.kind != "plane" || !region.loops.iter().flatten().any(on) {
                continue;
            }
            for outline in region.loops.iter().filter(|outline| !outline.iter().any(on)) {
                let edge = |side: &Side| match side.wire.map(|(wire, _)| &mesh.wires[wire].source) {
                    Some(Source::Edge { edge, .. }) => Some(*edge),
                    _ => None,
                };
                let first = edge(&outline[0]);
                // Of a round hole the corners are cuts, if it is cut already.
                let closed = outline.len() == 1
                    || first.is_some_and(|edge| mesh.part.edges[edge].is_closed())
                        && outline.iter().all(|side| edge(side) == first)
                        && trace::area(outline) < 0.0;
                let points = outline[..if closed { 1 } else { outline.len() }].iter().map(|side| {
                    if !closed {
                        return mesh.nodes[side.ends[0]];
                    }
                    // A circle: its centre, towards which one should look between two cuts.
                    let all = || outline.iter().flat_map(|side| side.path.polyline());
                    all().map(|uv| face.surface.at(uv).point).sum::<glam::DVec3>() / all().count() as f64
                });
                for point in points {
                    let far = samples.iter().enumerate().map(|(k, sample)| (sample.distance(point), k));
                    let Some((distance, k)) = far.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
                    let share = offset + sense * share_of(mesh, *wire, k as f64 / 360.0);
                    let half = if closed { 0.5 } else { 0.0 };
                    let angle = TAU * (count as f64 * share + half);
                    sum += DVec2::from_angle(angle) / (distance + 1e-3);
                }
            }
        }
    }
    if sum.length() < 1e-9 { 0.0 } else { sum.to_angle() / TAU / count as f64 }
}

/// The share of its length at which a wire has this parameter.
fn share_of(mesh: &Mesh<'_>, wire: usize, t: f64) -> f64 {
    length(mesh, wire, t) / length(mesh, wire, 1.0).max(f64::MIN_POSITIVE)
}

/// The length of a wire up to a parameter.
fn length(mesh: &Mesh<'_>, wire: usize, to: f64) -> f64 {
    let points = (0..=128).map(|k| mesh.at(wire, to * f64::from(k) / 128.0)[0]).collect::<Vec<_>>();
    points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>()
}

/// The parameter at which a wire has gone this share of its length.
fn by_length(mesh: &Mesh<'_>, wire: usize, share: f64) -> f64 {
    let whole = length(mesh, wire, 1.0).max(f64::MIN_POSITIVE);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if length(mesh, wire, middle) / whole < share { low = middle } else { high = middle }
    }
    let t = 0.5 * (low + high);
    if !(1e-7..=1.0 - 1e-7).contains(&t) { 0.0 } else { t }
}

/// Cuts a closed wire at these parameters only: its previous start is removed.
fn rotate_and_cut(mesh: &mut Mesh<'_>, wire: usize, at: &[f64]) {
    let mut at = at.to_vec();
    at.sort_by(f64::total_cmp);
    mesh.turn(wire, at[0]);
    let rest: Vec<f64> = at[1..].iter().map(|t| t - at[0]).collect();
    mesh.cut(wire, &rest);
}
