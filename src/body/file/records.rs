//! Faces and edges from their records.

use super::super::curve::SplineCurve;
use super::super::feature::{Edge, EdgeFace, EdgeKind, Face, Separator, Side};
use super::error::{FileError, Section};
use super::sections::{EDGE_WORDS, FACE_WORDS};
use crate::math::vec3;
use crate::patch::{
    Coefficients, Curvature, Orientation, SecondDerivativeBounds, ShapeBounds, SplineTable, ThirdDerivativeBounds,
};

/// Error in a record, without its place.
pub(super) enum Wrong {
    /// See [`FileError::Code`].
    Code,
    /// See [`FileError::Missing`].
    Missing,
}

impl Wrong {
    pub const fn at(self, section: Section, record: usize) -> FileError {
        let record = record as u32;
        match self {
            Self::Code => FileError::Code { section, record },
            Self::Missing => FileError::Missing { section, record },
        }
    }
}

/// The numbers of the records: borders by their place, as many records share them; coefficients one after the other.
///
/// As no coefficient is read for two records, the work of reading all of them is bounded by their number.
pub(super) struct Numbers<'a> {
    pub borders: &'a [f32],
    /// Those that no record has used yet.
    pub coefficients: &'a [f32],
}

impl<'a> Numbers<'a> {
    /// A patch with its four sides.
    pub fn face(&mut self, record: &[u32; FACE_WORDS], index: usize) -> Result<Face<'a>, FileError> {
        let wrong = |wrong: Wrong| wrong.at(Section::Faces, index);
        let [codes, counts, first_u, first_v, ..] = *record;
        let [degree_u, degree_v, kind, turned] = codes.to_le_bytes();
        let [count_u, count_v] = halves(counts);
        let degree = [degree_u, degree_v];
        let breaks = [self.borders(first_u, count_u).map_err(wrong)?, self.borders(first_v, count_v).map_err(wrong)?];
        let refused = |error| FileError::Patch { face: index as u16, error };
        let entries = SplineTable::coefficient_count(degree, breaks).map_err(refused)?;
        let coefficients = self.coefficients(kind, entries).map_err(wrong)?;
        let orientation = match turned {
            0 => Orientation::Outward,
            1 => Orientation::Inward,
            _ => return Err(wrong(Wrong::Code)),
        };
        let (patch, of_sides) = record.split_at(FACE_WORDS - 4 * SIDE_WORDS);
        let numbers = patch.last_chunk().map(|words| words.map(f32::from_bits)).unwrap_or_default();
        let [uu, uv, vv, uuu, uuv, uvv, vvv, jump_uu, jump_vv, min, max, min_stretch, max_stretch, max_bend, size] =
            numbers;
        let shape = ShapeBounds {
            second_derivatives: SecondDerivativeBounds { uu, uv, vv },
            third_derivatives: ThirdDerivativeBounds { uuu, uuv, uvv, vvv, jump_uu, jump_vv },
            curvature: Curvature { min, max },
            min_stretch,
            max_stretch,
            max_bend,
        };
        let [breaks_u, breaks_v] = breaks;
        let table =
            SplineTable { degree, breaks_u, breaks_v, coefficients, shape, orientation, size_m: size, crc: None };
        let patch = table.try_checked_in_body().map_err(refused)?;
        let mut sides = [Side::Pole { vertex: 0 }; 4];
        for (side, words) in sides.iter_mut().zip(of_sides.as_chunks().0) {
            *side = self.side(words).map_err(wrong)?;
        }
        Ok(Face { patch, sides })
    }

    /// An edge.
    pub fn edge(&mut self, record: &[u32; EDGE_WORDS]) -> Result<Edge<'a>, Wrong> {
        let [curve @ .., third_derivative, jump, first, second, ends] = record;
        let curve = self.curve(curve)?;
        let face = |word: u32| EdgeFace { face: word as u16, side: (word >> 16) as u8 };
        let kind = match first >> 24 {
            0 => EdgeKind::Convex,
            1 => EdgeKind::Smooth,
            2 => EdgeKind::Reflex,
            3 => EdgeKind::Mixed,
            4 => EdgeKind::Open,
            _ => return Err(Wrong::Code),
        };
        if second >> 24 != 0 {
            return Err(Wrong::Code);
        }
        let [third_derivative, jump] = [*third_derivative, *jump].map(f32::from_bits);
        Ok(Edge { curve, third_derivative, jump, faces: [face(*first), face(*second)], ends: halves(*ends), kind })
    }

    fn side(&mut self, [codes, numbers @ ..]: &[u32; SIDE_WORDS]) -> Result<Side<'a>, Wrong> {
        let [kind, reversed, ..] = codes.to_le_bytes();
        let index = (codes >> 16) as u16;
        let reversed = match reversed {
            0 => false,
            1 => true,
            _ => return Err(Wrong::Code),
        };
        let separator = match (kind, numbers) {
            (0, [0, 0, 0, 0]) if !reversed => return Ok(Side::Pole { vertex: index }),
            (1, _) => {
                let [x, y, z, offset] = numbers.map(f32::from_bits);
                Separator::Plane { across: vec3(x, y, z), offset }
            }
            (2, [curve @ .., 0]) => Separator::Ruled(self.curve(curve)?),
            _ => return Err(Wrong::Code),
        };
        Ok(Side::Edge { edge: index, reversed, separator })
    }

    fn curve(&mut self, [codes, first, second_derivative]: &[u32; 3]) -> Result<SplineCurve<'a>, Wrong> {
        let [degree, kind, ..] = codes.to_le_bytes();
        let count = (codes >> 16) as u16;
        let breaks = self.borders(*first, count)?;
        let entries = usize::from(count).saturating_sub(1) * (usize::from(degree) + 1);
        let coefficients = self.coefficients(kind, entries)?;
        Ok(SplineCurve { degree, breaks, coefficients, second_derivative: f32::from_bits(*second_derivative) })
    }

    fn borders(&self, first: u32, count: u16) -> Result<&'a [f32], Wrong> {
        let from = self.borders.get(first as usize..).ok_or(Wrong::Missing)?;
        from.get(..usize::from(count)).ok_or(Wrong::Missing)
    }

    fn coefficients(&mut self, kind: u8, entries: usize) -> Result<Coefficients<'a>, Wrong> {
        let components = match kind {
            0 => 3,
            1 => 4,
            _ => return Err(Wrong::Code),
        };
        let (these, rest) = self.coefficients.split_at_checked(entries * components).ok_or(Wrong::Missing)?;
        self.coefficients = rest;
        Ok(match kind {
            0 => Coefficients::Polynomial(these.as_chunks().0),
            _ => Coefficients::Rational(these.as_chunks().0),
        })
    }
}

/// Words of a side in a face's record.
const SIDE_WORDS: usize = 5;

/// The lower and the upper 16 bits.
const fn halves(word: u32) -> [u16; 2] {
    [word as u16, (word >> 16) as u16]
}
