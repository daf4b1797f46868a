//! Cuts through the finished quads: a cut goes on from side to opposite side, from face to face, until it ends on a
//! free border or meets itself.

use crate::mesh::{Mesh, Quad, Side};
use crate::path::Path;
use std::collections::{HashMap, HashSet};

/// Cuts these wires in the middle, and all that follows.
pub fn cut(mesh: &mut Mesh<'_>, wanted: &[usize]) {
    let mut quads_of: HashMap<usize, Vec<(usize, usize, usize)>> = HashMap::new();
    for (face, region) in mesh.regions.iter().enumerate() {
        for (index, quad) in region.quads.iter().enumerate() {
            for (k, side) in quad.sides.iter().enumerate() {
                if let Some((wire, _)) = side.wire {
                    quads_of.entry(wire).or_default().push((face, index, k));
                }
            }
        }
    }
    let mut all: HashSet<usize> = HashSet::new();
    let mut open: Vec<usize> = wanted.to_vec();
    while let Some(wire) = open.pop() {
        if !all.insert(wire) {
            continue;
        }
        for (face, index, k) in quads_of.get(&wire).into_iter().flatten() {
            if let Some((opposite, _)) = mesh.regions[*face].quads[*index].sides[(k + 2) % 4].wire {
                open.push(opposite);
            }
        }
    }
    let mut order: Vec<usize> = all.into_iter().collect();
    order.sort_unstable();
    let pieces: HashMap<usize, Vec<usize>> = order.into_iter().map(|wire| (wire, mesh.cut(wire, &[0.5]))).collect();
    for face in 0..mesh.regions.len() {
        let quads = std::mem::take(&mut mesh.regions[face].quads);
        let mut parts = Vec::with_capacity(quads.len());
        for quad in quads {
            let is_cut = |k: usize| quad.sides[k].wire.is_some_and(|(wire, _)| pieces.contains_key(&wire));
            let (across, up) = (is_cut(0) || is_cut(2), is_cut(1) || is_cut(3));
            match (across, up) {
                (false, false) => parts.push(quad),
                (true, false) => parts.extend(halves(mesh, face, &quad, 0, &pieces)),
                (false, true) => parts.extend(halves(mesh, face, &quad, 1, &pieces)),
                (true, true) => parts.extend(quarters(mesh, face, &quad, &pieces)),
            }
        }
        mesh.regions[face].quads = parts;
    }
}

/// A side in two.
fn split(mesh: &Mesh<'_>, face: usize, side: &Side, pieces: &HashMap<usize, Vec<usize>>) -> [Side; 2] {
    let Some((wire, _)) = side.wire else {
        let middle = side.path.at(0.5);
        let node = side.ends[0];
        return [Side::pole(node, side.path.start(), middle), Side::pole(node, middle, side.path.end())];
    };
    let mut parts = mesh.cut_side(face, side, &[0.0, 0.5, 1.0], &pieces[&wire]).into_iter();
    let first = parts.next().unwrap_or_else(|| side.clone());
    let second = parts.next().unwrap_or_else(|| side.clone());
    [first, second]
}

/// Along the middle: `axis` 0 cuts bottom and top, 1 left and right.
fn halves(
    mesh: &mut Mesh<'_>,
    face: usize,
    quad: &Quad,
    axis: usize,
    pieces: &HashMap<usize, Vec<usize>>,
) -> [Quad; 2] {
    let [bottom, right, top, left] = &quad.sides;
    if axis == 0 {
        let [b, t] = [bottom, top].map(|side| split(mesh, face, side, pieces));
        let path = sampled(|x| quad.map(0.5, x));
        let middle = mesh.add_inside(face, [b[0].ends[1], t[0].ends[1]], path);
        let [b0, b1] = b;
        let [t0, t1] = t;
        [
            Quad { sides: [b0, middle.clone(), t1, left.clone()] },
            Quad { sides: [b1, right.clone(), t0, middle.reversed()] },
        ]
    } else {
        let [r, l] = [right, left].map(|side| split(mesh, face, side, pieces));
        let path = sampled(|x| quad.map(x, 0.5));
        let middle = mesh.add_inside(face, [l[0].ends[1], r[0].ends[1]], path);
        let [r0, r1] = r;
        let [l0, l1] = l;
        [Quad { sides: [bottom.clone(), r0, middle.reversed(), l1] }, Quad { sides: [middle, r1, top.clone(), l0] }]
    }
}

/// Both ways.
fn quarters(mesh: &mut Mesh<'_>, face: usize, quad: &Quad, pieces: &HashMap<usize, Vec<usize>>) -> Vec<Quad> {
    let [b, r, t, l] = [0, 1, 2, 3].map(|k| split(mesh, face, &quad.sides[k], pieces));
    let centre = mesh.add_node(mesh.part.faces[face].surface.at(quad.map(0.5, 0.5)).point);
    let south = mesh.add_inside(face, [b[0].ends[1], centre], sampled(|x| quad.map(0.5, 0.5 * x)));
    let east = mesh.add_inside(face, [centre, r[0].ends[1]], sampled(|x| quad.map(0.5 + 0.5 * x, 0.5)));
    let north = mesh.add_inside(face, [centre, t[0].ends[1]], sampled(|x| quad.map(0.5, 0.5 + 0.5 * x)));
    let west = mesh.add_inside(face, [l[0].ends[1], centre], sampled(|x| quad.map(0.5 * x, 0.5)));
    let ([b0, b1], [r0, r1], [t0, t1], [l0, l1]) = (b, r, t, l);
    vec![
        Quad { sides: [b0, south.clone(), west.reversed(), l1] },
        Quad { sides: [b1, r0, east.reversed(), south.reversed()] },
        Quad { sides: [east, r1, t0, north.reversed()] },
        Quad { sides: [west, north, t1, l0] },
    ]
}

/// Straight if it is.
fn sampled(at: impl Fn(f64) -> glam::DVec2) -> Path {
    let (a, b) = (at(0.0), at(1.0));
    let off = (0..=8).map(|k| at(f64::from(k) / 8.0).distance(a.lerp(b, f64::from(k) / 8.0))).fold(0.0, f64::max);
    if off <= 1e-11 * a.distance(b) { Path::line(a, b) } else { Path::sampled(at) }
}
