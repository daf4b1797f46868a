//! Merges vertices and edges that are the same to the file's own precision.
//!
//! Vertices in one place are merged and edges of zero length are left out. Where faces meet along separate edges, a
//! free edge is cut at the free vertices on it, and two that then coincide become one: so the start and direction of
//! each face's own edges do not matter. A face that is narrower than a body's tables tell apart is left out, and its
//! long edges become one. A solid that is still open is refused with face, edge and millimetres.

use crate::error::ImportError;
use crate::part::{Edge, Part, Use};
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// Millimetres below which two points are one, however exact a file claims to be.
const LEAST: f64 = 1e-6;
/// In sizes of the body, points that are nearer are one to its tables (`palpate_bake::topology::TOLERANCE`).
const ONE_IN_TABLES: f64 = 1e-6;
/// Shares of an edge at which it is compared with another.
const COMPARED: i32 = 16;

/// Sews a part, up to its own precision and no farther than `tolerance`, millimetres: only where it does not close
/// without, because a file that claims little may have steps that are smaller.
///
/// # Errors
/// A loop whose edges do not follow each other, or a solid that stays open.
pub fn sew(part: &mut Part, tolerance: f64) -> Result<(), ImportError> {
    let mut exact = part.clone();
    if sewn(&mut exact, LEAST).is_ok() {
        // What a table cannot tell apart is one, if the part closes then.
        let near = 2.0 * ONE_IN_TABLES * size(&exact);
        let is_short = |edge: &usize| exact.edges[*edge].length() <= near;
        if near < tolerance && used(&exact).any(|edge| is_short(&edge)) {
            let mut merged = exact.clone();
            if sewn(&mut merged, near).is_ok() {
                exact = merged;
            }
        }
        *part = exact;
        return Ok(());
    }
    sewn(part, part.precision.min(tolerance).max(LEAST))
}

fn sewn(part: &mut Part, near: f64) -> Result<(), ImportError> {
    merge_vertices(part, near);
    leave_out_slivers(part, near);
    leave_out_narrow_faces(part, near);
    check_loops(part, near)?;
    if !free(part).is_empty() {
        cut_at_vertices(part, near);
        join(part, near);
    }
    refuse_gaps(part, near)
}

/// The edges of all faces.
fn used(part: &Part) -> impl Iterator<Item = usize> {
    part.faces.iter().flat_map(|face| face.loops.iter().flatten().map(|used| used.edge))
}

/// The longest side of a box about the vertices, millimetres.
fn size(part: &Part) -> f64 {
    let all = || part.vertices.iter().copied();
    (all().fold(DVec3::NEG_INFINITY, DVec3::max) - all().fold(DVec3::INFINITY, DVec3::min)).max_element()
}

/// The solid of every vertex that a face has.
fn solids(part: &Part) -> Vec<Option<usize>> {
    let mut solids = vec![None; part.vertices.len()];
    for face in &part.faces {
        for end in face.loops.iter().flatten().flat_map(|used| part.ends(*used)) {
            solids[end] = Some(face.solid);
        }
    }
    solids
}

fn merge_vertices(part: &mut Part, near: f64) {
    let solids = solids(part);
    let cell = |point: DVec3| (point / near).floor().to_array().map(|along| along as i64);
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut kept: Vec<usize> = (0..part.vertices.len()).collect();
    for vertex in 0..part.vertices.len() {
        let here = part.vertices[vertex];
        let [x, y, z] = cell(here);
        let about = (0..27).map(|k: i64| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let others = about.filter_map(|cell| cells.get(&cell)).flatten();
        let is_one = |other: &&usize| {
            solids[**other] == solids[vertex]
                && part.vertices[**other].distance(here) <= near
                && solids[vertex].is_some()
        };
        match others.copied().filter(|other| is_one(&other)).min() {
            Some(other) => kept[vertex] = other,
            None => cells.entry(cell(here)).or_default().push(vertex),
        }
    }
    for edge in &mut part.edges {
        let was_open = edge.ends[0] != edge.ends[1];
        edge.ends = edge.ends.map(|end| kept[end]);
        let [low, high] = edge.range;
        edge.is_round |= was_open
            && edge.ends[0] == edge.ends[1]
            && edge.curve.at(low)[0].distance(edge.curve.at(high)[0]) <= 4.0 * near;
    }
}

/// Edges of no length, of loops that have others.
fn leave_out_slivers(part: &mut Part, near: f64) {
    let is_sliver = |edge: &Edge| edge.ends[0] == edge.ends[1] && edge.length() <= 2.0 * near;
    let slivers: Vec<bool> = part.edges.iter().map(is_sliver).collect();
    for outline in part.faces.iter_mut().flat_map(|face| &mut face.loops) {
        if outline.iter().any(|used| !slivers[used.edge]) {
            outline.retain(|used| !slivers[used.edge]);
        }
    }
}

/// Faces between two edges that run together: their neighbours' edges are free then, and joined.
fn leave_out_narrow_faces(part: &mut Part, near: f64) {
    let (edges, mut names) = (&part.edges, Vec::new());
    part.faces.retain(|face| {
        let is_narrow = match &face.loops[..] {
            [outline] => match outline[..] {
                // On a surface that closes, the face may be what lies round the other way.
                [first, second] if first.edge != second.edge && face.surface.closed == [false; 2] => {
                    let [first, second] = [first, second].map(|used| &edges[used.edge]);
                    apart(first, second).max(apart(second, first)) <= near
                }
                _ => false,
            },
            _ => false,
        };
        if is_narrow {
            names.push(face.label());
        }
        !is_narrow
    });
    part.remarks
        .extend(names.into_iter().map(|name| format!("healed: {name} is narrower than {near:.6} mm: left out")));
}

fn check_loops(part: &Part, near: f64) -> Result<(), ImportError> {
    for face in &part.faces {
        for uses in &face.loops {
            for (first, second) in uses.iter().zip(uses.iter().cycle().skip(1)) {
                let (end, start) = (part.ends(*first)[1], part.ends(*second)[0]);
                if end != start {
                    let reason = format!(
                        "the edges of a loop of it do not follow each other: {} begins {:.6} mm from the end of {}, \
                         {near} mm count as nothing; repair it in the CAD program",
                        part.edges[second.edge].label(second.edge),
                        part.vertices[end].distance(part.vertices[start]),
                        part.edges[first.edge].label(first.edge)
                    );
                    return Err(ImportError::face(face.label(), reason));
                }
            }
        }
    }
    Ok(())
}

/// Where an edge is used: face, loop, place.
type Place = [usize; 3];

/// The edges that have one face, and where.
fn free(part: &Part) -> Vec<(usize, Place)> {
    let mut uses: Vec<(usize, Place)> = vec![(0, [0; 3]); part.edges.len()];
    for (face, of) in part.faces.iter().enumerate() {
        for (index, outline) in of.loops.iter().enumerate() {
            for (place, used) in outline.iter().enumerate() {
                uses[used.edge] = (uses[used.edge].0 + 1, [face, index, place]);
            }
        }
    }
    let single = uses.into_iter().enumerate().filter(|(_, (count, _))| *count == 1);
    single.map(|(edge, (_, place))| (edge, place)).collect()
}

/// Cuts free edges at the ends of others that lie on them.
fn cut_at_vertices(part: &mut Part, near: f64) {
    let free = free(part);
    let solids = solids(part);
    let mut ends: Vec<usize> = free.iter().flat_map(|(edge, _)| part.edges[*edge].ends).collect();
    ends.sort_by(|a, b| part.vertices[*a].x.total_cmp(&part.vertices[*b].x).then(a.cmp(b)));
    ends.dedup();
    let mut cut: HashMap<usize, Vec<usize>> = HashMap::new();
    for (edge, [face, ..]) in free {
        let of = part.edges[edge].clone();
        let points: Vec<DVec3> = (0..=32).map(|k| of.at(f64::from(k) / 32.0)[0]).collect();
        // Between two samples a curve strays by less than they are apart.
        let reach = near + points.windows(2).map(|pair| pair[0].distance(pair[1])).fold(0.0, f64::max);
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min) - reach;
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max) + reach;
        let first = ends.partition_point(|end| part.vertices[*end].x < low.x);
        let beside = ends[first..].iter().take_while(|end| part.vertices[**end].x <= high.x);
        let mut at: Vec<(f64, usize)> = Vec::new();
        for end in beside {
            let point = part.vertices[*end];
            let is_own = of.ends.contains(end) || of.ends.iter().any(|own| part.vertices[*own].distance(point) <= near);
            if is_own
                || solids[*end] != Some(part.faces[face].solid)
                || point.cmplt(low).any()
                || point.cmpgt(high).any()
            {
                continue;
            }
            let (share, distance) = of.nearest(point);
            if distance <= near {
                at.push((share.rem_euclid(1.0), *end));
            }
        }
        if at.is_empty() {
            continue;
        }
        at.sort_by(|a, b| a.0.total_cmp(&b.0));
        let shares: Vec<f64> = [0.0].into_iter().chain(at.iter().map(|at| at.0)).chain([1.0]).collect();
        let vertices: Vec<usize> =
            [of.ends[0]].into_iter().chain(at.iter().map(|at| at.1)).chain([of.ends[1]]).collect();
        let pieces = (0..=at.len()).map(|k| {
            part.edges.push(of.stretch([shares[k], shares[k + 1]], [vertices[k], vertices[k + 1]]));
            part.edges.len() - 1
        });
        cut.insert(edge, pieces.collect());
    }
    replace(part, &cut);
}

/// Puts the pieces of edges where the edges were used.
pub fn replace(part: &mut Part, cut: &HashMap<usize, Vec<usize>>) {
    for outline in part.faces.iter_mut().flat_map(|face| &mut face.loops) {
        if outline.iter().all(|used| !cut.contains_key(&used.edge)) {
            continue;
        }
        let pieces = |used: &Use| -> Vec<Use> {
            let Some(pieces) = cut.get(&used.edge) else { return vec![*used] };
            let mut uses: Vec<Use> = pieces.iter().map(|edge| Use { edge: *edge, reversed: used.reversed }).collect();
            if used.reversed {
                uses.reverse();
            }
            uses
        };
        *outline = outline.iter().flat_map(pieces).collect();
    }
}

/// Makes free edges that run together one.
fn join(part: &mut Part, near: f64) {
    let mut groups: HashMap<[usize; 2], Vec<(usize, Place)>> = HashMap::new();
    for (edge, place) in free(part) {
        let [a, b] = part.edges[edge].ends;
        groups.entry([a.min(b), a.max(b)]).or_default().push((edge, place));
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_unstable_by_key(|(ends, _)| *ends);
    let (mut count, mut widest): (usize, f64) = (0, 0.0);
    for (_, group) in groups {
        let mut gone: HashSet<usize> = HashSet::new();
        for (k, (first, _)) in group.iter().enumerate() {
            if gone.contains(first) {
                continue;
            }
            let others = group[k + 1..].iter().filter(|(edge, _)| !gone.contains(edge));
            let gaps = others.map(|(edge, place)| (apart(&part.edges[*first], &part.edges[*edge]), *edge, *place));
            let Some((gap, second, [face, index, place])) = gaps.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            if gap > near {
                continue;
            }
            let is_same_way = runs_with(&part.edges[*first], &part.edges[second]);
            let used = &mut part.faces[face].loops[index][place];
            *used = Use { edge: *first, reversed: used.reversed == is_same_way };
            gone.extend([*first, second]);
            (count, widest) = (count + 1, widest.max(gap));
        }
    }
    if count > 0 {
        part.remarks.push(format!("healed: {count} pairs of edges made one, up to {widest:.6} mm apart"));
    }
}

/// How far an edge strays from another, millimetres.
fn apart(edge: &Edge, from: &Edge) -> f64 {
    let points = (1..COMPARED).map(|k| from.at(f64::from(k) / f64::from(COMPARED))[0]);
    points.map(|point| edge.nearest(point).1).fold(0.0, f64::max)
}

/// Whether two edges that run together do so the same way.
fn runs_with(first: &Edge, second: &Edge) -> bool {
    let [a, b] = [0.4, 0.6].map(|share| first.nearest(second.at(share)[0]).0);
    let way = b - a;
    if first.is_closed() { way.rem_euclid(1.0) < 0.5 } else { way > 0.0 }
}

/// Refuses a solid with an edge that has one face.
fn refuse_gaps(part: &Part, near: f64) -> Result<(), ImportError> {
    let open: Vec<_> =
        free(part).into_iter().filter(|(_, place)| part.solids[part.faces[place[0]].solid].is_closed).collect();
    let Some((edge, [face, ..])) = open.first() else { return Ok(()) };
    let of = &part.edges[*edge];
    let others = open.iter().filter(|(other, _)| other != edge);
    let gap = others.map(|(other, place)| (apart(&part.edges[*other], of), *other, place[0]));
    let nearest = gap.min_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(String::new, |(gap, other, beyond)| {
        let (label, name) = (part.edges[other].label(other), part.faces[beyond].label());
        format!("; the nearest that has none either is {label} of {name}, {gap:.6} mm off")
    });
    let reason = format!(
        "no other face has its {}{nearest}: the solid is open, and {near} mm count as nothing; repair it in the CAD program",
        of.label(*edge)
    );
    Err(ImportError::face(part.faces[*face].label(), reason))
}
