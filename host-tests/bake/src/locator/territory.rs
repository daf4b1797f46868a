//! The space over one patch, and whether every probe there has one nearest point on it.

use super::faces::Rectangle;
use super::faces::{Faces, Query};
use super::piece::Piece;
use super::piece::{Part, Probes};
use super::stored::Seams;
use super::stored::StoredSurface;
use super::unique::Subject;
use crate::BakedPatch;
use glam::DVec3;
use palpate::body::GRID;
use std::f64::consts::PI;

/// How finely normals are bounded where they spread: quarterings of a span.
const CONE_LEVEL: u8 = 4;
/// A product of tangents that is shorter than this, relative to the longest on its cell, is a pole's and has no
/// direction.
const NO_NORMAL: f64 = 1e-12;

/// A patch with the probes over it.
pub(crate) struct Territory {
    faces: Faces,
    farthest: f64,
}

/// All normals on a piece: an axis, and the angle from it that none exceeds.
#[derive(Clone, Copy, Debug)]
struct Cone {
    axis: DVec3,
    angle: f64,
}

/// Some of the probes over a patch: over a piece of it, from one height to another.
struct Column<'a> {
    piece: &'a Piece,
    cone: Cone,
    heights: [f64; 2],
}

impl Territory {
    /// For probes up to `range` metres over a patch; `None` if a weight is not proved positive.
    pub(crate) fn new(patch: &BakedPatch, creases: &[Vec<f64>; 2], range: f64) -> Option<Self> {
        let surface = StoredSurface::new(patch);
        let corner = surface.evaluate([0.0; 2]).point;
        let seams = Seams::find(&[surface], 1e-6 * f64::from(patch.size));
        // Generous: it only scales what rounding is reckoned with.
        let reach = corner.abs().max_element() + 4.0 * f64::from(patch.size) + range;
        let faces = Faces::new(std::slice::from_ref(patch), seams, std::slice::from_ref(creases), reach)?;
        Some(Self { faces, farthest: 3.0_f64.sqrt() * (f64::from(patch.size) + range) })
    }

    /// 1, or −1 where the outward normal is `−f_u × f_v`.
    pub(crate) fn turn(&self) -> f64 {
        self.faces.turns[0]
    }

    /// Half the angle of a cone that holds all normals, radians; π if none is proved.
    pub(crate) fn cone_angle(&self) -> f64 {
        let whole = self.faces.spans[0].iter().map(|piece| self.cone(piece).axis).sum::<DVec3>();
        let axis = whole.normalize_or_zero();
        if axis == DVec3::ZERO {
            return PI;
        }
        let mut open: Vec<&Piece> = self.faces.spans[0].iter().collect();
        let mut angle: f64 = 0.0;
        while let Some(piece) = open.pop() {
            let reached = self.angle_from(piece, axis);
            match piece.quarters() {
                Some(quarters) if reached > angle && piece.level < CONE_LEVEL => open.extend(quarters),
                _ => angle = angle.max(reached),
            }
        }
        angle
    }

    /// Whether the distance from every probe up to `range` over the patch has one minimum on it, within `boxes` boxes
    /// of probes.
    pub(crate) fn has_one_minimum(&self, range: f64, boxes: usize) -> bool {
        let mut open: Vec<_> = self.faces.spans[0]
            .iter()
            .map(|piece| Column { piece, cone: self.cone(piece), heights: [0.0, range] })
            .collect();
        let mut count = 0;
        while let Some(column) = open.pop() {
            count += 1;
            let probes = column.probes();
            if count <= boxes && self.is_unique(probes) {
                continue;
            }
            // What is not proved of one probe is not proved of any box with it.
            let middle = Probes { half: DVec3::ZERO, ..probes };
            if count > boxes || !self.is_unique(middle) {
                return false;
            }
            let [low, high] = column.heights;
            let spread = column.piece.diameter + high * 2.0 * (0.5 * column.cone.angle.min(PI)).sin();
            if high - low > spread {
                let half = 0.5 * (low + high);
                open.extend([[low, half], [half, high]].map(|heights| Column { heights, ..column }));
            } else {
                let Some(quarters) = column.piece.quarters() else { return false };
                open.extend(quarters.iter().map(|piece| Column { piece, cone: self.cone(piece), ..column }));
            }
        }
        true
    }

    fn is_unique(&self, probes: Probes) -> bool {
        let query = Query { probes, references: &[], seam: 0.0, farthest: self.farthest, convex: &[], in_plane: false };
        let rectangle = Rectangle { lower: [0; 2], upper: [GRID as u8; 2] };
        Subject { faces: &self.faces, face: 0, rectangle, query: &query }.is_unique()
    }

    /// The normals of a piece. A normal is a mean, with positive shares, of the products of the tangents' coefficients.
    fn cone(&self, piece: &Piece) -> Cone {
        let axis = products(piece).sum::<DVec3>().normalize_or_zero() * self.turn();
        Cone { axis, angle: if axis == DVec3::ZERO { PI } else { self.angle_from(piece, axis) } }
    }

    fn angle_from(&self, piece: &Piece, axis: DVec3) -> f64 {
        let longest = products(piece).map(|normal| normal.length_squared()).fold(0.0, f64::max);
        // The one with the least cosine, of which alone the angle is asked: an arc cosine takes longer than all else.
        let mut farthest: Option<(f64, DVec3)> = None;
        for normal in products(piece) {
            let square = normal.length_squared();
            let cosine = (normal * self.turn()).dot(axis) / square.sqrt();
            if square > NO_NORMAL * NO_NORMAL * longest && farthest.is_none_or(|(least, _)| cosine < least) {
                farthest = Some((cosine, normal * self.turn()));
            }
        }
        // The angle itself rounds by less.
        let angle = farthest.map_or(0.0, |(_, normal)| normal.angle_between(axis)) + 1e-7;
        // The hull of vectors beyond a right angle from the axis is no cone around it.
        if angle < 0.5 * PI { angle } else { PI }
    }
}

impl Column<'_> {
    /// A box that holds them all.
    fn probes(&self) -> Probes {
        let [low, high] = self.piece.bounds;
        let Cone { axis, angle } = self.cone;
        let reach = |component: f64| {
            let from = component.clamp(-1.0, 1.0).acos();
            let range = [(from + angle).min(PI).cos(), (from - angle).max(0.0).cos()];
            let heights = self.heights;
            [(heights[0] * range[0]).min(heights[1] * range[0]), (heights[0] * range[1]).max(heights[1] * range[1])]
        };
        let [x, y, z] = axis.to_array().map(reach);
        let (low, high) = (low + DVec3::new(x[0], y[0], z[0]), high + DVec3::new(x[1], y[1], z[1]));
        // Rounding of the box itself.
        let half = 0.5 * (high - low) + 1e-12 * (high.abs() + low.abs());
        Probes { centre: 0.5 * (low + high), half }
    }
}

/// Products of the coefficients of `f_u` and `f_v`.
fn products(piece: &Piece) -> impl Iterator<Item = DVec3> {
    let vector = |[_, x, y, z]: &[f64; 4]| DVec3::new(*x, *y, *z);
    let [along_u, along_v] =
        piece.gradient.each_ref().map(|field| field.on(Part::Inside).flatten().map(vector).collect::<Vec<_>>());
    along_u.into_iter().flat_map(move |u| along_v.clone().into_iter().map(move |v| u.cross(v)))
}
