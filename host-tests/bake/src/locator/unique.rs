//! Whether the distance has one minimum on a rectangle of a face's parameters, for every probe of a box.
//!
//! # Why it is a proof
//! - *Convex*: the matrix of second derivatives of `φ` is a mean of its Bernstein coefficients, and affine in the
//!   probe: if every coefficient is positive definite at every corner of the box, so is the matrix everywhere.
//! - *One minimum*: every point of the rectangle that no first-order step improves is a strict local minimum. Such a
//!   point is where `φ` has a slope that the rectangle's border holds back in both parameters, or in one with `φ`
//!   convex along the other, or where `φ` is convex. The basins of strict minima under projected gradient flow are open
//!   and fill the rectangle, which is connected: there is one.
//!   Where a face bends less than the farthest probe is away, as a plane one does, `φ` is convex wherever it has no
//!   slope: the probe is on the normal there. Then only the rectangle's sides are left to prove.
//! - *Within*: along the segment from any point that no first-order step improves to the best one, `φ` falls by at most
//!   `½ max(−δᵀHδ)`, `δ` not beyond the rectangle: the error of the distance is at most the returned value.
//!
//! A crease inside the rectangle is never passed.

use super::faces::Rectangle;
use super::faces::{Faces, Query, Region};
use super::piece::{Field, Part, Probes};
use super::piece::{LEVELS, Piece};
use glam::DVec3;

/// The proof of the minima on a rectangle, best first.
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

impl Minima {
    /// Whether it is proved to lose no more than this, metres.
    pub(super) fn is_proved(self, tolerance: f64) -> bool {
        match self {
            Self::Convex | Self::One => true,
            Self::Within(loss) => loss <= tolerance,
            Self::Unknown => false,
        }
    }
}

/// The proof of the minima on a rectangle wherever the closest point is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Proof {
    Minima(Minima),
    /// Twice `φ` is off by no more, m².
    Loss(f64),
}

impl Proof {
    /// `nearest` is at most the distance of the closest point from any probe.
    pub(super) fn minima(self, nearest: f64) -> Minima {
        match self {
            Self::Minima(minima) => minima,
            Self::Loss(loss) => Minima::Within((nearest * nearest + loss).sqrt() - nearest),
        }
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
    /// The proof.
    pub(super) fn proof(&self) -> Proof {
        let [low, high] = self.rectangle.parameters();
        let flat = [0, 1].map(|axis| low[axis] == high[axis]);
        let pieces = &self.faces.spans[usize::from(self.face)];
        match flat {
            [true, true] => return Proof::Minima(Minima::Convex),
            [true, false] | [false, true] => {
                let axis = usize::from(flat[1]);
                let side = (2 * axis) as u8 + u8::from(low[axis] == 1.0);
                let is_convex = pieces.iter().all(|piece| self.is_convex_along(piece, side));
                return Proof::Minima(if is_convex { Minima::Convex } else { Minima::Unknown });
            }
            [false, false] => {}
        }
        if self.is_known_convex() || pieces.iter().all(|piece| self.is_convex(piece)) {
            return Proof::Minima(Minima::Convex);
        }
        if pieces.iter().all(|piece| self.has_strict_minima(piece)) {
            return Proof::Minima(Minima::One);
        }
        let mut loss = 0.0;
        if pieces.iter().any(|piece| self.raise_loss(piece, &mut loss).is_none()) {
            return Proof::Minima(Minima::Unknown);
        }
        Proof::Loss(loss)
    }

    /// Whether there is one minimum, with no bound of the loss if not.
    pub(super) fn is_unique(&self) -> bool {
        let Rectangle { lower, upper } = self.rectangle;
        if (0..2).any(|axis| lower[axis] == upper[axis]) {
            return matches!(self.proof(), Proof::Minima(Minima::Convex));
        }
        let pieces = &self.faces.spans[usize::from(self.face)];
        pieces.iter().all(|piece| self.has_strict_minima(piece))
    }

    /// Whether it is proved of a larger rectangle, and of more probes.
    fn is_known_convex(&self) -> bool {
        let holds = |(face, known): &(u16, Rectangle)| {
            let Rectangle { lower, upper } = self.rectangle;
            *face == self.face
                && (0..2).all(|axis| known.lower[axis] <= lower[axis] && upper[axis] <= known.upper[axis])
        };
        self.query.convex.iter().any(holds)
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
        if self.query.bends(piece, Part::Side(side)).least[2 * axis] > 0.0 {
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
        let refuted = (0..4).any(|corner| self.is_refuted(piece, corner));
        !refuted
            && piece.quarters().is_some_and(|quarters| quarters.iter().all(|quarter| self.has_strict_minima(quarter)))
    }

    /// Whether no part of a piece that has a corner of it passes, however small: coefficients at a corner are values.
    fn is_refuted(&self, piece: &Piece, corner: u8) -> bool {
        let [low, high] = self.rectangle.parameters();
        let is_upper = |axis: usize| corner >> axis & 1 == 1;
        let at = [0, 1].map(|axis| if is_upper(axis) { piece.high[axis] } else { piece.low[axis] });
        // Around it there is some of the rectangle in the piece.
        let around = (0..2).all(|axis| if is_upper(axis) { low[axis] < at[axis] } else { at[axis] < high[axis] })
            && (0..2).all(|axis| low[axis] <= at[axis] && at[axis] <= high[axis]);
        if !around || piece.on_pole.contains(&true) {
            return false;
        }
        let part = Part::Corner(corner);
        let slopes = [0, 1].map(|axis| self.query.sign(piece, axis, part));
        let is_held = |axis: usize| match slopes[axis] {
            1 => !is_upper(axis) && at[axis] == low[axis],
            -1 => is_upper(axis) && at[axis] == high[axis],
            _ => false,
        };
        let is_on_side = |axis: usize| at[axis] == if is_upper(axis) { high[axis] } else { low[axis] };
        let is_flat = |entry: usize| self.query.bends(piece, part).least[entry] <= 0.0;
        match slopes {
            [0, 0] if self.bends_little(piece) => (0..2).any(|axis| is_on_side(axis) && is_flat(2 * (1 - axis))),
            [0, 0] => !is_positive(&piece.hessian, part, &self.query.probes),
            [_, 0] => is_held(0) && is_flat(2),
            [0, _] => is_held(1) && is_flat(0),
            _ => false,
        }
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
            return self.query.bends(piece, Part::Inside).least[2] > 0.0;
        }
        if slopes[1] != 0 {
            return self.query.bends(piece, Part::Inside).least[0] > 0.0;
        }
        is_positive(&piece.hessian, Part::Inside, probes)
            || self.bends_little(piece) && (0..4).all(|side| self.is_strict_on(piece, side))
    }

    /// Whether a point without slope is a strict minimum wherever it is: the probe then is on the normal, and nearer
    /// than the centre of any curvature.
    fn bends_little(&self, piece: &Piece) -> bool {
        self.query.in_plane && piece.curvature * self.query.farthest < 1.0
    }

    /// Whether all that a side of the rectangle holds back on a piece is a strict minimum along the side.
    fn is_strict_on(&self, piece: &Piece, side: usize) -> bool {
        let (axis, is_upper) = (side / 2, side % 2 == 1);
        let at = self.rectangle.parameters()[usize::from(is_upper)][axis];
        if at < piece.low[axis] || piece.high[axis] < at {
            return true;
        }
        let own = if is_upper { piece.high[axis] } else { piece.low[axis] };
        let part = if own == at { Part::Side(side as u8) } else { Part::Inside };
        self.query.sign(piece, axis, part) == if is_upper { 1 } else { -1 }
            || self.query.sign(piece, 1 - axis, part) != 0
            || self.query.bends(piece, part).least[2 * (1 - axis)] > 0.0
    }

    /// Raises a loss to the most that `−δᵀHδ` can be on a piece for `δ` within the rectangle; `None` across a crease.
    fn raise_loss(&self, piece: &Piece, most: &mut f64) -> Option<()> {
        match self.loss(piece)? {
            loss if loss > *most => self.raise_to(piece, loss, most),
            _ => Some(()),
        }
    }

    /// The same of a piece whose own bound is known and larger. A piece that is below the loss as a whole is below it
    /// in its quarters too: the worst of them go first, so that few others are divided.
    fn raise_to(&self, piece: &Piece, loss: f64, most: &mut f64) -> Option<()> {
        let quarters = if piece.level < LEVELS - 1 { piece.quarters() } else { None };
        let Some(quarters) = quarters else {
            *most = most.max(loss);
            return Some(());
        };
        let mut parts = Vec::with_capacity(4);
        for quarter in quarters {
            parts.push((self.loss(quarter)?, quarter));
        }
        parts.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (loss, quarter) in parts {
            if loss > *most {
                self.raise_to(quarter, loss, most)?;
            }
        }
        Some(())
    }

    /// A bound of `−δᵀHδ` on a piece, 0 where it has none of the rectangle; `None` across a crease.
    fn loss(&self, piece: &Piece) -> Option<f64> {
        if !self.overlaps(piece) {
            return Some(0.0);
        }
        if self.is_creased(piece) {
            return None;
        }
        if is_positive(&piece.hessian, Part::Inside, &self.query.probes) {
            return Some(0.0);
        }
        let [low, high] = self.rectangle.parameters();
        let [du, dv] = [high[0] - low[0], high[1] - low[1]];
        let bends = self.query.bends(piece, Part::Inside);
        let [uu, vv] = [0, 2].map(|entry| bends.least[entry] / piece.least_weight);
        let uv = bends.greatest[1].max(-bends.least[1]).max(0.0) / piece.least_weight;
        // Extreme at a corner, or on a border of the rectangle of δ where the other is free.
        let form = |x: f64, y: f64| uu * x * x - 2.0 * uv * x * y + vv * y * y;
        let free =
            |along: f64, reach: f64, other: f64| if along > 0.0 { (uv * other / along).min(reach) } else { reach };
        let lowest = [form(du, dv), form(free(uu, du, dv), dv), form(du, free(vv, dv, du)), 0.0];
        Some(-lowest.into_iter().fold(0.0, f64::min))
    }
}

/// Whether the matrix of second derivatives is positive definite on a part, for all probes.
pub(crate) fn is_positive(hessian: &Field<12>, part: Part, probes: &Probes) -> bool {
    let slack = hessian.slack;
    let is_definite = |[uu, uv, vv]: [f64; 3]| {
        let (uu, vv, uv) = (uu - slack, vv - slack, uv.abs() + slack);
        uu > 0.0 && vv > 0.0 && uu * vv > uv * uv * (1.0 + 4.0 * f64::EPSILON)
    };
    hessian.on(part).flatten().all(|entry| {
        let [(uu, along_uu), (uv, along_uv), (vv, along_vv)] = [0, 4, 8].map(|first| {
            let along = DVec3::new(entry[first + 1], entry[first + 2], entry[first + 3]);
            (entry[first] - probes.centre.dot(along), probes.half * along)
        });
        // The centre's matrix is a mean of the corners'.
        if !is_definite([uu, uv, vv]) {
            return false;
        }
        let reach = |along: DVec3| along.abs().element_sum();
        if is_definite([uu - reach(along_uu), uv.abs() + reach(along_uv), vv - reach(along_vv)]) {
            return true;
        }
        let sides = [-1.0, 1.0];
        sides.iter().all(|x| {
            sides.iter().all(|y| {
                sides.iter().all(|z| {
                    let corner = DVec3::new(*x, *y, *z);
                    is_definite([uu - corner.dot(along_uu), uv - corner.dot(along_uv), vv - corner.dot(along_vv)])
                })
            })
        })
    })
}

/// Bounds of the entries `φ_uu`, `φ_uv`, `φ_vv`, up to the weight.
pub(super) struct Bends {
    least: [f64; 3],
    greatest: [f64; 3],
}

impl Query<'_> {
    /// Bounds over a part of a piece and all probes.
    fn bends(&self, piece: &Piece, part: Part) -> Bends {
        let Field { slack, .. } = piece.hessian;
        let mut bends = Bends { least: [f64::INFINITY; 3], greatest: [f64::NEG_INFINITY; 3] };
        for coefficients in piece.hessian.on(part).flatten() {
            for entry in 0..3 {
                let [value, x, y, z] = std::array::from_fn(|c| coefficients[4 * entry + c]);
                let slope = DVec3::new(x, y, z);
                let (middle, reach) = (value - self.probes.centre.dot(slope), self.probes.half.dot(slope.abs()));
                bends.least[entry] = bends.least[entry].min(middle - reach);
                bends.greatest[entry] = bends.greatest[entry].max(middle + reach);
            }
        }
        bends.least = bends.least.map(|least| least - slack);
        bends.greatest = bends.greatest.map(|greatest| greatest + slack);
        bends
    }
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

#[cfg(test)]
mod tests {
    use super::super::list::Entry;
    use super::super::octree::Search;
    use super::super::{LocatorOptions, Seams, StoredSurface};
    use super::*;
    use crate::{BakedPatch, Model};
    use palpate::body::GRID;
    use std::error::Error;

    /// A quarter of a plate around a hole of 2 mm, to a side 5 mm from its centre, in a tilted plane; with its middle
    /// raised, 1 or a little, it is not plane.
    fn quarter(raised: f64) -> Result<BakedPatch, Box<dyn Error>> {
        let arc = [[1.414, -1.414], [2.195, -0.633], [2.195, 0.633], [1.414, 1.414]];
        let point = |[x, y]: [f64; 2], z: f64| format!("[{}, {}, {}]", x, 0.8 * y - 0.6 * z, 0.6 * y + 0.8 * z);
        let row = |at: usize| {
            let far = [5.0, -5.0 + 10.0 * at as f64 / 3.0];
            let z = if at.is_multiple_of(3) { 0.0 } else { raised };
            format!("[{}, {}]", point(arc[at], z), point(far, z))
        };
        let rows: Vec<_> = (0..4).map(row).collect();
        let text = format!(
            "name = \"quarter\"\nunit = \"mm\"\n[[patch]]\nname = \"top\"\ndegree = [3, 1]\npoints = [{}]\n",
            rows.join(", ")
        );
        Ok(BakedPatch::without_shape(&Model::parse(&text, "quarter")?.patches[0])?)
    }

    /// Against descents from a grid of starts: one minimum wherever it is proved, several around the hole's axis.
    #[test]
    fn a_plane_face_is_proved_in_its_plane() -> Result<(), Box<dyn Error>> {
        let patch = quarter(0.0)?;
        let surface = StoredSurface::new(&patch);
        let seams = Seams::find(std::slice::from_ref(&surface), 1e-9);
        let faces = Faces::new(&[patch], seams, &[[Vec::new(), Vec::new()]], 0.1).ok_or("a weight")?;
        // The last two: around the hole's axis, and out to its rim, where a slope may hold a probe back or not.
        for (x, half, is_one) in
            [(3e-3, 1e-3, true), (4e-3, 1e-3, true), (5e-3, 1e-3, true), (0.0, 1e-3, false), (0.0, 2.5e-3, false)]
        {
            let probes = Probes::cube(DVec3::new(x, -1.2e-3, 1.6e-3), half);
            let is_proved = |in_plane: bool| {
                let query = Query { probes, references: &[], seam: 0.0, farthest: 0.02, convex: &[], in_plane };
                let rectangle = Rectangle { lower: [0; 2], upper: [GRID as u8; 2] };
                let subject = Subject { faces: &faces, face: 0, rectangle, query: &query };
                matches!(subject.proof(), Proof::Minima(Minima::Convex | Minima::One))
            };
            // As any surface it is not.
            assert_eq!([false, true].map(is_proved), [false, is_one], "{x}");
            let apart = (0..9).map(|place| {
                let probe = if place == 8 { probes.centre } else { probes.corner(place) };
                let ends = (0..81).map(|start| {
                    let start = [start / 9, start % 9].map(|step| f64::from(step) / 8.0);
                    surface.descend(probe, start, [[0.0; 2], [1.0; 2]]).point
                });
                let ends: Vec<_> = ends.collect();
                ends.iter().map(|end| end.distance(ends[0])).fold(0.0, f64::max)
            });
            let apart = apart.fold(0.0, f64::max);
            assert_eq!(apart < 1e-6, is_one, "{x}: {apart}");
        }
        Ok(())
    }

    /// Against descents from a grid of starts, beside the hole's axis and out to it.
    #[test]
    fn one_minimum_is_left_to_probes_of_no_open_part() -> Result<(), Box<dyn Error>> {
        let patch = quarter(0.0)?;
        let surface = StoredSurface::new(&patch);
        let seams = Seams::find(std::slice::from_ref(&surface), 1e-9);
        let faces = Faces::new(&[patch], seams, &[[Vec::new(), Vec::new()]], 0.1).ok_or("a weight")?;
        let options = &LocatorOptions::one_patch();
        let search = Search { faces: &faces, options, size: 0.01, farthest: 0.02, wanted: None };
        let cell = Probes::cube(DVec3::new(1e-3, -1.2e-3, 1.6e-3), 2e-3);
        let whole = |upper: [u8; 2]| Entry {
            face: 0,
            rectangle: Rectangle { lower: [0; 2], upper },
            minima: Minima::Unknown,
            distance: 0.0,
        };
        let open = |entry: Entry| search.open_parts(&cell, &[entry], &faces.regions(), &[]).ok_or("not plane");
        let parts = open(whole([GRID as u8; 2]))?;
        // By whether its part is open, whether probes lead to several minima.
        let mut several = [[0, 0]; 2];
        for place in 0..16_i32.pow(3) {
            let at =
                DVec3::from_array([place % 16, place / 16 % 16, place / 256].map(|step| f64::from(step) / 7.5 - 1.0));
            let probe = cell.centre + cell.half * at;
            let ends = (0..25).map(|start| {
                let start = [start / 5, start % 5].map(|step| f64::from(step) / 4.0);
                surface.descend(probe, start, [[0.0; 2], [1.0; 2]]).point
            });
            let ends: Vec<_> = ends.collect();
            let is_one = ends.iter().all(|end| end.distance(ends[0]) < 1e-6);
            several[usize::from(parts.iter().any(|part| part.holds(probe)))][usize::from(!is_one)] += 1;
        }
        println!("not open, open: one minimum, several: {several:?}");
        assert!(several[0][0] > 1000 && several[0][1] == 0 && several[1][1] > 100);
        // The rim alone, around its own centre of curvature, is not convex.
        assert!(!open(whole([GRID as u8, 0]))?.is_empty());
        Ok(())
    }

    /// A raised patch is no plane; one that is raised by less than the rounding of a table has a bound of its bend,
    /// which is not less than its larger principal curvature at any point of a grid.
    #[test]
    fn only_plane_faces_have_a_bound_of_their_curvature() -> Result<(), Box<dyn Error>> {
        let bound = |raised: f64| -> Result<[f64; 2], Box<dyn Error>> {
            let patch = quarter(raised)?;
            let surface = StoredSurface::new(&patch);
            let bends = (0..81).map(|at| {
                let here = surface.evaluate([at / 9, at % 9].map(|step| f64::from(step) / 8.0));
                let [u, v] = here.first;
                let normal = u.cross(v).normalize();
                let ([e, f, g], [l, m, n]) =
                    ([u.dot(u), u.dot(v), v.dot(v)], here.second.map(|second| second.dot(normal)));
                let determinant = e * g - f * f;
                let (mean, product) =
                    (0.5 * (l * g - 2.0 * m * f + n * e) / determinant, (l * n - m * m) / determinant);
                mean.abs() + (mean * mean - product).max(0.0).sqrt()
            });
            let bend = bends.fold(0.0, f64::max);
            let seams = Seams::find(&[surface], 1e-9);
            let faces = Faces::new(&[patch], seams, &[[Vec::new(), Vec::new()]], 0.1).ok_or("a weight")?;
            Ok([faces.spans[0][0].curvature, bend])
        };
        let [plane, _] = bound(0.0)?;
        let [raised, bend] = bound(5e-5)?;
        println!("plane {plane:e}, raised {raised:e}, bends {bend:e} 1/m");
        assert!(plane < 1.0);
        // Loose by how much the lengths of the tangents differ over the patch.
        assert!(bend <= raised && raised < 1e3 * bend);
        assert_eq!(bound(0.1)?[0], f64::INFINITY);
        Ok(())
    }
}
