//! Whether the distance has one minimum on a rectangle of a face's parameters, for every probe of a box.
//!
//! # Why it is a proof
//! - *Convex*: the matrix of second derivatives of `φ` is a mean of its Bernstein coefficients, and affine in the
//!   probe: if every coefficient is positive definite at every corner of the box, so is the matrix everywhere.
//! - *One minimum*: every point of the rectangle that no first-order step improves is a strict local minimum. Such a
//!   point is where `φ` has a slope that the rectangle's border holds back in both parameters, or in one with `φ`
//!   convex along the other, or where `φ` is convex. The basins of strict minima under projected gradient flow are open
//!   and fill the rectangle, which is connected: there is one.
//! - *Within*: along the segment from any point that no first-order step improves to the best one, `φ` falls by at most
//!   `½ max(−δᵀHδ)`, `δ` not beyond the rectangle: the distance is off by no more than what is returned.
//!
//! A crease inside the rectangle is never passed.

use super::faces::{Faces, Query, Region};
use super::field::{Field, Part, Probes};
use super::piece::{LEVELS, Piece};
use palpate::body::GRID;

/// What is proved of the minima on a rectangle, best first.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) enum Minima {
    /// `φ` is convex.
    Convex,
    /// There is one.
    One,
    /// Any of them is as good as the best to this much, metres.
    Within(f64),
    /// Nothing.
    Unknown,
}

/// A rectangle on the grid: least and greatest step along `u` and `v`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rectangle {
    pub lower: [u8; 2],
    pub upper: [u8; 2],
}

impl Rectangle {
    /// The least one that holds a rectangle of parameters.
    pub(super) fn around([low, high]: [[f64; 2]; 2]) -> Self {
        let grid = f64::from(GRID);
        // A rectangle that ends on the grid, as all borders do, ends there; anything else is rounded outward by more
        // than rounding.
        Self {
            lower: low.map(|x| (x * grid + if x == 1.0 { 0.0 } else { -1e-9 }).floor().max(0.0) as u8),
            upper: high.map(|x| (x * grid + if x == 0.0 { 0.0 } else { 1e-9 }).ceil().min(grid) as u8),
        }
    }

    pub(super) fn hull(&self, other: &Self) -> Self {
        Self {
            lower: [0, 1].map(|axis| self.lower[axis].min(other.lower[axis])),
            upper: [0, 1].map(|axis| self.upper[axis].max(other.upper[axis])),
        }
    }

    pub(crate) fn parameters(&self) -> [[f64; 2]; 2] {
        [self.lower, self.upper].map(|corner| corner.map(|step| f64::from(step) / f64::from(GRID)))
    }
}

/// A rectangle on a face.
pub(super) struct Subject<'a> {
    pub faces: &'a Faces,
    pub face: u16,
    pub rectangle: Rectangle,
    pub query: &'a Query<'a>,
}

impl Subject<'_> {
    /// What is proved; `nearest` is at most the distance of the closest point from any probe.
    pub(super) fn minima(&self, nearest: f64) -> Minima {
        let [low, high] = self.rectangle.parameters();
        let flat = [0, 1].map(|axis| low[axis] == high[axis]);
        let pieces = &self.faces.spans[usize::from(self.face)];
        match flat {
            [true, true] => return Minima::Convex,
            [true, false] | [false, true] => {
                let axis = usize::from(flat[1]);
                let side = (2 * axis) as u8 + u8::from(low[axis] == 1.0);
                return if pieces.iter().all(|piece| self.is_convex_along(piece, side)) {
                    Minima::Convex
                } else {
                    Minima::Unknown
                };
            }
            [false, false] => {}
        }
        if pieces.iter().all(|piece| self.is_convex(piece)) {
            return Minima::Convex;
        }
        if pieces.iter().all(|piece| self.has_strict_minima(piece)) {
            return Minima::One;
        }
        let mut loss = 0.0;
        if pieces.iter().any(|piece| self.raise_loss(piece, &mut loss).is_none()) {
            return Minima::Unknown;
        }
        Minima::Within((nearest * nearest + loss).sqrt() - nearest)
    }

    /// Whether there is one minimum, with no bound of the loss if not.
    pub(super) fn is_unique(&self) -> bool {
        let pieces = &self.faces.spans[usize::from(self.face)];
        pieces.iter().all(|piece| self.has_strict_minima(piece))
    }

    /// Whether a piece has some of the rectangle, more than a border.
    fn overlaps(&self, piece: &Piece) -> bool {
        let [low, high] = self.rectangle.parameters();
        (0..2).all(|axis| piece.low[axis] < high[axis] && low[axis] < piece.high[axis])
    }

    /// Whether a crease on the piece's border runs through the inside of the rectangle.
    fn is_creased(&self, piece: &Piece) -> bool {
        let [low, high] = self.rectangle.parameters();
        (0..4).any(|side| {
            let axis = side / 2;
            let at = if side % 2 == 0 { piece.low[axis] } else { piece.high[axis] };
            piece.on_crease[side] && low[axis] < at && at < high[axis]
        })
    }

    fn is_convex(&self, piece: &Piece) -> bool {
        if !self.overlaps(piece) {
            return true;
        }
        if self.is_creased(piece) {
            return false;
        }
        let probes = &self.query.probes;
        if is_positive(&piece.hessian, Part::Inside, probes) {
            return true;
        }
        // Corners are values: where one in the rectangle is not convex, halving is in vain.
        let [low, high] = self.rectangle.parameters();
        let refuted = (0..4_u8).any(|corner| {
            let at = [0, 1].map(|axis| if corner >> axis & 1 == 0 { piece.low[axis] } else { piece.high[axis] });
            let inside = (0..2).all(|axis| low[axis] <= at[axis] && at[axis] <= high[axis]);
            inside && !is_positive(&piece.hessian, Part::Corner(corner), probes)
        });
        !refuted && piece.quarters().is_some_and(|quarters| quarters.iter().all(|quarter| self.is_convex(quarter)))
    }

    /// Whether `φ` is convex along the rectangle, which is a part of a side of its face.
    fn is_convex_along(&self, piece: &Piece, side: u8) -> bool {
        let axis = if side < 2 { 1 } else { 0 };
        let [low, high] = self.rectangle.parameters();
        let apart = piece.high[axis] <= low[axis] || high[axis] <= piece.low[axis];
        if !piece.on_border[usize::from(side)] || apart {
            return true;
        }
        if self.is_creased(piece) {
            return false;
        }
        if least(&piece.hessian, 2 * axis, Part::Side(side), &self.query.probes) > 0.0 {
            return true;
        }
        piece.quarters().is_some_and(|quarters| quarters.iter().all(|quarter| self.is_convex_along(quarter, side)))
    }

    /// Whether all that no first-order step improves is a strict minimum.
    fn has_strict_minima(&self, piece: &Piece) -> bool {
        if !self.overlaps(piece) {
            return true;
        }
        if self.is_creased(piece) {
            return false;
        }
        if self.passes(piece) {
            return true;
        }
        piece.quarters().is_some_and(|quarters| quarters.iter().all(|quarter| self.has_strict_minima(quarter)))
    }

    fn passes(&self, piece: &Piece) -> bool {
        let probes = &self.query.probes;
        let [low, high] = self.rectangle.parameters();
        let slopes = [0, 1].map(|axis| self.query.sign(piece, axis, Part::Inside));
        let is_held = |axis: usize| match slopes[axis] {
            1 => piece.low[axis] <= low[axis],
            -1 => piece.high[axis] >= high[axis],
            _ => false,
        };
        if (0..2).any(|axis| slopes[axis] != 0 && !is_held(axis)) {
            return true;
        }
        // Held back on a pole it is at rest at one point, however far around.
        let on_pole = |axis: usize| match slopes[axis] {
            1 => piece.on_pole[2 * axis],
            -1 => piece.on_pole[2 * axis + 1],
            _ => false,
        };
        if slopes.iter().all(|slope| *slope != 0) || on_pole(0) || on_pole(1) {
            return true;
        }
        if piece.on_pole.contains(&true) {
            return false;
        }
        if slopes[0] != 0 {
            return least(&piece.hessian, 2, Part::Inside, probes) > 0.0;
        }
        if slopes[1] != 0 {
            return least(&piece.hessian, 0, Part::Inside, probes) > 0.0;
        }
        is_positive(&piece.hessian, Part::Inside, probes)
    }

    /// Raises a loss to the most that `−δᵀHδ` can be on a piece for `δ` within the rectangle; `None` across a crease.
    /// What is bounded below the loss as a whole is in its quarters too.
    fn raise_loss(&self, piece: &Piece, most: &mut f64) -> Option<()> {
        if !self.overlaps(piece) {
            return Some(());
        }
        if self.is_creased(piece) {
            return None;
        }
        if is_positive(&piece.hessian, Part::Inside, &self.query.probes) {
            return Some(());
        }
        let loss = self.loss(piece);
        if loss <= *most {
            return Some(());
        }
        if piece.level < LEVELS - 1
            && let Some(quarters) = piece.quarters()
        {
            return quarters.iter().try_for_each(|quarter| self.raise_loss(quarter, most));
        }
        *most = most.max(loss);
        Some(())
    }

    /// A bound of `−δᵀHδ` on a piece.
    fn loss(&self, piece: &Piece) -> f64 {
        let [low, high] = self.rectangle.parameters();
        let [du, dv] = [high[0] - low[0], high[1] - low[1]];
        let probes = &self.query.probes;
        let [uu, vv] = [0, 2].map(|entry| least(&piece.hessian, entry, Part::Inside, probes) / piece.least_weight);
        let mixed = [-1.0, 1.0].map(|side| -least_times(&piece.hessian, 1, side, Part::Inside, probes));
        let uv = mixed[0].max(mixed[1]).max(0.0) / piece.least_weight;
        // Extreme at a corner, or on a border of the rectangle of δ where the other is free.
        let form = |x: f64, y: f64| uu * x * x - 2.0 * uv * x * y + vv * y * y;
        let free =
            |along: f64, reach: f64, other: f64| if along > 0.0 { (uv * other / along).min(reach) } else { reach };
        let lowest = [form(du, dv), form(free(uu, du, dv), dv), form(du, free(vv, dv, du)), 0.0];
        -lowest.into_iter().fold(0.0, f64::min)
    }
}

/// Whether the matrix of second derivatives is positive definite on a part, for all probes.
pub(crate) fn is_positive(hessian: &Field<12>, part: Part, probes: &Probes) -> bool {
    let corners: [_; 8] = std::array::from_fn(|index| probes.corner(index));
    let slack = hessian.slack;
    hessian.on(part).all(|entry| {
        corners.iter().all(|corner| {
            let [uu, uv, vv] = [0, 4, 8].map(|first| {
                entry[first] - corner.x * entry[first + 1] - corner.y * entry[first + 2] - corner.z * entry[first + 3]
            });
            let (uu, vv, uv) = (uu - slack, vv - slack, uv.abs() + slack);
            uu > 0.0 && vv > 0.0 && uu * vv > uv * uv * (1.0 + 4.0 * f64::EPSILON)
        })
    })
}

/// At most the least value of an entry (0, 1, 2 for `φ_uu`, `φ_uv`, `φ_vv`).
fn least(hessian: &Field<12>, entry: usize, part: Part, probes: &Probes) -> f64 {
    least_times(hessian, entry, 1.0, part, probes)
}

fn least_times(hessian: &Field<12>, entry: usize, factor: f64, part: Part, probes: &Probes) -> f64 {
    let mut lowest = f64::INFINITY;
    for coefficients in hessian.on(part) {
        let slope = glam::DVec3::from_slice(&coefficients[4 * entry + 1..4 * entry + 4]);
        let middle = factor * (coefficients[4 * entry] - probes.centre.dot(slope));
        lowest = lowest.min(middle - probes.half.dot(slope.abs()));
    }
    lowest - hessian.slack
}

/// At most the distance of a region from any probe.
pub(super) fn nearest(region: &Region<'_>, query: &Query<'_>, faces: &Faces) -> f64 {
    let distance = match *region {
        Region::Inside(piece) | Region::Side { piece, .. } => {
            let [low, high] = piece.bounds;
            query.probes.centre.distance(query.probes.centre.clamp(low, high))
        }
        Region::Vertex(_) => {
            let [at, _] = region.rectangle(faces);
            faces.surfaces[usize::from(region.face(faces))].evaluate(at).point.distance(query.probes.centre)
        }
    };
    (distance - query.probes.radius()).max(0.0)
}
