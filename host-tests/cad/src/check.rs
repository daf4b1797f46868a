//! Invariants of every result: no face lies on a neighbour along their edge, the patches of a solid close, and every
//! face has the solid behind it. Rays decide, independently of the file and of how the importer chose its regions.

use crate::error::ImportError;
use crate::part::Part;
use crate::patches::Made;
use glam::DVec3;
use std::collections::HashMap;

/// Cosine of the angle between two patches below which they lie on each other: less than a degree.
const FOLDED: f64 = 0.9999;
/// Intervals of the grid of triangles on a patch.
const INTERVALS: usize = 12;
/// Rays from a face, and lines through a solid.
const RAYS: usize = 5;
const LINES: usize = 64;

/// Refuses a result that folds back on itself, does not close, or has single faces against their solid. Gives the faces
/// of whole shells that lie the wrong way round: those of a cavity, which some exporters turn.
///
/// # Errors
/// The first face with such a fault.
pub fn check(part: &Part, made: &[Made]) -> Result<Vec<usize>, ImportError> {
    folds(part, made)?;
    let mut turned = Vec::new();
    for solid in (0..part.solids.len()).filter(|solid| part.solids[*solid].is_closed) {
        let sheets = made.iter().filter(|made| part.faces[made.face].solid == solid).map(|made| Sheet::new(part, made));
        let sheets: Vec<Sheet> = sheets.collect();
        closes(part, solid, &sheets)?;
        turned.extend(against(part, solid, &sheets)?);
    }
    Ok(turned)
}

/// Patches of two faces that lie on each other along a side they share.
fn folds(part: &Part, made: &[Made]) -> Result<(), ImportError> {
    let mut sides: HashMap<usize, Vec<(usize, [DVec3; 3])>> = HashMap::new();
    for made in made {
        for (k, side) in made.quad.sides.iter().enumerate() {
            let Some((wire, against)) = side.wire else { continue };
            let inward = [0.25, 0.5, 0.75].map(|t| {
                let along = if against { 1.0 - t } else { t };
                // Each side as the quad runs round: up the right, back along the top, down the left.
                let (at, axis, way) = match k {
                    0 => ([along, 0.0], 1, 1.0),
                    1 => ([1.0, along], 0, -1.0),
                    2 => ([1.0 - along, 1.0], 1, -1.0),
                    _ => ([0.0, 1.0 - along], 0, 1.0),
                };
                let [_, du, dv] = made.bezier.at(at[0], at[1]);
                let (tangent, inward) = if axis == 1 { (du, dv) } else { (dv, du) };
                (inward.reject_from(tangent) * way).normalize_or_zero()
            });
            sides.entry(wire).or_default().push((made.face, inward));
        }
    }
    let mut pairs: Vec<_> = sides.into_iter().filter(|(_, of)| of.len() == 2 && of[0].0 != of[1].0).collect();
    pairs.sort_by_key(|(wire, _)| *wire);
    for (_, of) in pairs {
        let [(face, a), (other, b)] = [of[0], of[1]];
        if a.iter().zip(b).all(|(a, b)| a.dot(b) > FOLDED) {
            let reason = format!(
                "it lies on {} along their common edge, where the part has no thickness: one of them may be the wrong \
                 part of its surface; export the part again, with these faces split",
                part.faces[other].label()
            );
            return Err(ImportError::face(part.faces[face].label(), reason));
        }
    }
    Ok(())
}

/// A patch as triangles, its sides the same points as its neighbours'.
struct Sheet {
    face: usize,
    low: DVec3,
    high: DVec3,
    /// Anticlockwise seen from outside, as far as the face's sense is right.
    triangles: Vec<[DVec3; 3]>,
}

impl Sheet {
    fn new(part: &Part, made: &Made) -> Self {
        let at = |i: usize, j: usize| made.bezier.at(i as f64 / INTERVALS as f64, j as f64 / INTERVALS as f64)[0];
        let mut triangles = Vec::new();
        for i in 0..INTERVALS {
            for j in 0..INTERVALS {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        if part.faces[made.face].flip {
            triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        let points = || triangles.iter().flatten().copied();
        let (low, high) = (points().fold(DVec3::INFINITY, DVec3::min), points().fold(DVec3::NEG_INFINITY, DVec3::max));
        Self { face: made.face, low, high, triangles }
    }

    /// Whether a ray meets the box around the sheet.
    fn is_near(&self, from: DVec3, inverse: DVec3) -> bool {
        let [a, b] = [(self.low - from) * inverse, (self.high - from) * inverse];
        a.max(b).min_element() >= a.min(b).max_element().max(0.0)
    }
}

/// How often a ray goes through a solid's triangles, but for one.
fn crossings(sheets: &[Sheet], from: DVec3, way: DVec3, but: Option<(usize, usize)>) -> usize {
    let inverse = way.recip();
    let near = sheets.iter().enumerate().filter(|(_, sheet)| sheet.is_near(from, inverse));
    let through = |(index, sheet): (usize, &Sheet)| {
        let others = sheet.triangles.iter().enumerate().filter(|(k, _)| but != Some((index, *k)));
        others.filter(|(_, triangle)| is_through(**triangle, from, way)).count()
    };
    near.map(through).sum()
}

/// Whether a ray goes through a triangle: by the signs of the volumes over its sides, which two triangles share.
fn is_through([a, b, c]: [DVec3; 3], from: DVec3, way: DVec3) -> bool {
    let [a, b, c] = [a - from, b - from, c - from];
    let over = |p: DVec3, q: DVec3| way.dot(p.cross(q)) > 0.0;
    let sides = [over(a, b), over(b, c), over(c, a)];
    let normal = (b - a).cross(c - a);
    (sides == [true; 3] || sides == [false; 3]) && normal.dot(a) * normal.dot(way) > 0.0
}

/// Refuses a solid through which a line passes an odd number of times.
fn closes(part: &Part, solid: usize, sheets: &[Sheet]) -> Result<(), ImportError> {
    let low = sheets.iter().map(|sheet| sheet.low).fold(DVec3::INFINITY, DVec3::min);
    let high = sheets.iter().map(|sheet| sheet.high).fold(DVec3::NEG_INFINITY, DVec3::max);
    let (middle, size) = (low.midpoint(high), low.distance(high));
    let odd = (0..LINES).filter(|k| {
        let way = direction(*k);
        let through = middle + 0.4 * (high - low) * (direction(k + 7) * 2.0).clamp(-DVec3::ONE, DVec3::ONE);
        crossings(sheets, through - way * (2.0 * size), way, None) % 2 == 1
    });
    // One may pass along a triangle's side.
    if odd.count() > 1 {
        let reason = "its patches do not close: a face or a part of one is missing; export the part again";
        return Err(ImportError::face(part.solids[solid].name.clone(), reason));
    }
    Ok(())
}

/// The faces of shells that lie the wrong way round.
fn against(part: &Part, solid: usize, sheets: &[Sheet]) -> Result<Vec<usize>, ImportError> {
    let mut votes: HashMap<usize, [usize; 2]> = HashMap::new();
    for (index, sheet) in sheets.iter().enumerate() {
        for ray in 0..RAYS {
            let k = (2 * INTERVALS * INTERVALS * (2 * ray + 1) / (2 * RAYS) + INTERVALS) % sheet.triangles.len();
            let [a, b, c] = sheet.triangles[k];
            let normal = (b - a).cross(c - a).normalize_or_zero();
            if normal == DVec3::ZERO {
                continue;
            }
            let way = normal + 0.6 * direction(index * RAYS + ray);
            let is_against = crossings(sheets, (a + b + c) / 3.0, way, Some((index, k))) % 2 == 1;
            votes.entry(sheet.face).or_default()[usize::from(is_against)] += 1;
        }
    }
    let wrong = |face: &usize| votes.get(face).is_some_and(|[right, wrong]| wrong > right);
    let all: Vec<usize> = (0..part.faces.len()).filter(|face| part.faces[*face].solid == solid).collect();
    let mut turned = Vec::new();
    for face in all.iter().copied().filter(wrong) {
        let shell = shell(part, face);
        // Thin walls are beneath the triangles' accuracy: only faces without one ray for them are sure.
        let is_sure = |face: &usize| votes.get(face).is_some_and(|[right, _]| *right == 0);
        if shell.iter().all(wrong) {
            turned.push(face);
        } else if is_sure(&face) {
            let reason = "its outward side is inside the solid: the file turns it against its neighbours, or it is the \
                          wrong part of its surface; export the part again";
            return Err(ImportError::face(part.faces[face].label(), reason));
        }
    }
    Ok(turned)
}

/// The faces that hang together with one by their edges.
fn shell(part: &Part, first: usize) -> Vec<usize> {
    let edges = |face: usize| part.faces[face].loops.iter().flatten().map(|used| used.edge);
    let mut of_edge: HashMap<usize, Vec<usize>> = HashMap::new();
    for face in 0..part.faces.len() {
        edges(face).for_each(|edge| of_edge.entry(edge).or_default().push(face));
    }
    let (mut shell, mut next) = (vec![first], 0);
    while let Some(face) = shell.get(next).copied() {
        next += 1;
        for other in edges(face).flat_map(|edge| &of_edge[&edge]) {
            if !shell.contains(other) {
                shell.push(*other);
            }
        }
    }
    shell
}

/// Directions spread evenly over the sphere, none along an axis.
fn direction(k: usize) -> DVec3 {
    let [u, v] = [0.754_877_666, 0.569_840_291].map(|step: f64| (0.37 + step * (k + 1) as f64).fract());
    let z = 2.0 * u - 1.0;
    let (sine, cosine) = (std::f64::consts::TAU * v).sin_cos();
    DVec3::new((1.0 - z * z).sqrt() * cosine, (1.0 - z * z).sqrt() * sine, z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::divide::{Manner, Turning};
    use crate::wires::Fine;
    use crate::{heal, read, sew, turn};
    use std::path::PathBuf;

    /// A part and its patches, with a fault planted into the part before it is divided.
    fn made(name: &str, fault: impl Fn(&mut Part)) -> (Part, Vec<Made>) {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/parts/{name}.step"));
        let mut part = read::read(&path, None, 0.01, crate::part::Sweep::Start).unwrap();
        sew::sew(&mut part, 0.01).unwrap();
        let seams = heal::take_out_seams(&mut part);
        turn::turn(&mut part, &seams, 0.01).unwrap();
        fault(&mut part);
        let manner = Manner { turning: Turning::Free, triangles: false };
        let made = crate::import::patched(&part, &Fine::new(), 0.01, manner).map_err(|errors| format!("{errors:?}"));
        let made = made.unwrap().2;
        (part, made)
    }

    fn said(part: &Part, made: &[Made]) -> String {
        check(part, made).unwrap_err().to_string()
    }

    #[test]
    fn sound_parts_pass() {
        for name in ["s02", "pill"] {
            let (part, made) = made(name, |_| ());
            assert_eq!(check(&part, &made).unwrap(), [0; 0], "{name}");
        }
    }

    /// Three quarters of a fillet's tube, turned so that all edges are run along both ways.
    #[test]
    fn the_complement_of_a_torus_folds_back() {
        let (part, made) = made("pill", |part| {
            let face = part.faces.iter_mut().find(|face| face.kind == "torus").unwrap();
            face.flip = !face.flip;
            for uses in &mut face.loops {
                uses.reverse();
                uses.iter_mut().for_each(|used| used.reversed = !used.reversed);
            }
        });
        assert!(said(&part, &made).contains("face 2 (#105)"), "{}", said(&part, &made));
    }

    #[test]
    fn a_turned_face_is_named_and_a_turned_shell_is_turned_back() {
        let (mut part, made) = made("s02", |_| ());
        part.faces[3].flip = !part.faces[3].flip;
        assert!(said(&part, &made).starts_with(&part.faces[3].label()), "{}", said(&part, &made));
        part.faces[3].flip = !part.faces[3].flip;
        part.faces.iter_mut().for_each(|face| face.flip = !face.flip);
        assert_eq!(check(&part, &made).unwrap(), (0..part.faces.len()).collect::<Vec<_>>());
    }

    #[test]
    fn a_hole_or_a_piece_that_is_missing_leaves_the_solid_open() {
        let (part, made) = made("s02", |_| ());
        for face in ["cylinder", "plane"] {
            let kept = made.iter().filter(|made| part.faces[made.face].kind != face).cloned().collect::<Vec<_>>();
            assert!(said(&part, &kept).contains("do not close"), "{face}: {}", said(&part, &kept));
        }
        // One of the four pieces round the hole, as if a seam were lost.
        let piece = made.iter().position(|made| part.faces[made.face].kind == "cylinder").unwrap();
        let kept = made.iter().enumerate().filter(|(k, _)| *k != piece).map(|(_, made)| made.clone());
        let kept: Vec<_> = kept.collect();
        assert!(said(&part, &kept).contains("do not close"), "{}", said(&part, &kept));
    }
}
