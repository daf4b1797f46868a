//! Which borders of faces coincide: what the locator needs to know of a body's features.

use super::stored::StoredSurface;
use glam::DVec3;

/// A side of a face: `u = 0`, `u = 1`, `v = 0`, `v = 1` are 0 to 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BorderSide {
    /// The face.
    pub face: u16,
    /// Its side.
    pub side: u8,
    /// Whether it runs against the first side of its seam.
    pub reversed: bool,
}

/// A corner of a face: bit 0 for `u = 1`, bit 1 for `v = 1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BorderCorner {
    /// The face.
    pub face: u16,
    /// Its corner.
    pub corner: u8,
}

/// The seams of a body. The first member of each owns it: its candidates stand for all.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seams {
    /// Border curves with the sides that lie on them: one if open.
    pub edges: Vec<Vec<BorderSide>>,
    /// Points with the corners that lie on them; a side that is one point brings both its corners.
    pub vertices: Vec<Vec<BorderCorner>>,
    /// For each face, which sides are one point.
    pub poles: Vec<[bool; 4]>,
}

/// Parameters of a point of a side, `t` along it.
pub(super) fn on_side(side: u8, t: f64) -> [f64; 2] {
    match side {
        0 => [0.0, t],
        1 => [1.0, t],
        2 => [t, 0.0],
        _ => [t, 1.0],
    }
}

/// Parameters of a corner.
pub(super) fn at_corner(corner: u8) -> [f64; 2] {
    [f64::from(corner & 1), f64::from(corner >> 1)]
}

impl Seams {
    /// Finds the borders that coincide within `tolerance`, metres, by comparing 9 points of each.
    pub fn find(faces: &[StoredSurface], tolerance: f64) -> Self {
        const SAMPLES: usize = 9;
        let points = |face: usize, side: u8| -> [DVec3; SAMPLES] {
            std::array::from_fn(|k| faces[face].evaluate(on_side(side, k as f64 / (SAMPLES - 1) as f64)).point)
        };
        let same = |a: &[DVec3; SAMPLES], b: &mut dyn Iterator<Item = &DVec3>| {
            a.iter().zip(b).all(|(a, b)| a.distance(*b) <= tolerance)
        };
        let mut edges: Vec<(Vec<BorderSide>, [DVec3; SAMPLES])> = Vec::new();
        let mut vertices: Vec<(Vec<BorderCorner>, DVec3)> = Vec::new();
        let mut poles = vec![[false; 4]; faces.len()];
        for face in 0..faces.len() {
            for side in 0..4_u8 {
                let line = points(face, side);
                if line.iter().all(|point| point.distance(line[0]) <= tolerance) {
                    poles[face][usize::from(side)] = true;
                    continue;
                }
                let member = |reversed| BorderSide { face: face as u16, side, reversed };
                let found = edges.iter_mut().find_map(|(members, other)| {
                    let forward = same(&line, &mut other.iter());
                    (forward || same(&line, &mut other.iter().rev())).then_some((members, !forward))
                });
                match found {
                    Some((members, reversed)) => members.push(member(reversed)),
                    None => edges.push((vec![member(false)], line)),
                }
            }
            for corner in 0..4_u8 {
                let point = faces[face].evaluate(at_corner(corner)).point;
                let member = BorderCorner { face: face as u16, corner };
                match vertices.iter_mut().find(|(_, other)| other.distance(point) <= tolerance) {
                    Some((members, _)) => members.push(member),
                    None => vertices.push((vec![member], point)),
                }
            }
        }
        Self {
            edges: edges.into_iter().map(|(members, _)| members).collect(),
            vertices: vertices.into_iter().map(|(members, _)| members).collect(),
            poles,
        }
    }
}
