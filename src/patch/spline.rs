//! NURBS patches as polynomial spans in flash.
//!
//! The host splits a patch at its knots and writes each span in powers of the distance from the span's centre
//! (`s = u - centre`), which keeps Horner's rule well conditioned in `f32`. Rational patches are kept homogeneous
//! (`w x, w y, w z, w`) and divided once.

use super::coefficients::coefficient_word;
use super::span_grid::{SpanGrid, breaks_are_valid};
use super::spans::Spans;
use super::{Coefficients, CurvedPoint, Patch, SecondDerivativeBounds, ShapeBounds, SurfacePoint};
use core::num::NonZeroU32;
use thiserror::Error;

/// The highest degree along either parameter.
pub const MAX_DEGREE: usize = 5;
/// Which way the outward normal points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// `f_u × f_v` points out of the body.
    Outward,
    /// `f_u × f_v` points into the body.
    Inward,
}

/// Why a table is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum TableError {
    /// A degree is 0 or above [`MAX_DEGREE`].
    #[error("the degree must be 1 to 5 along u and along v")]
    Degree,
    /// The span borders along `u` do not run from 0 to 1, strictly rising, with at most [`super::MAX_SPANS`] spans.
    #[error("the span borders along u must rise strictly from 0 to 1, at most 256 spans")]
    BreaksU,
    /// The same along `v`.
    #[error("the span borders along v must rise strictly from 0 to 1, at most 256 spans")]
    BreaksV,
    /// The number of coefficients is not spans × (degree + 1) along both parameters.
    #[error("the number of coefficients does not match the spans and degrees")]
    CoefficientCount,
    /// A coefficient is not finite.
    #[error("a coefficient is not finite")]
    CoefficientNotFinite,
    /// A second-derivative bound is negative or not finite, or another bound is NaN or out of order. An infinite
    /// curvature or third derivative, or a least stretch of 0, is accepted: it says "no bound".
    #[error("a second-derivative bound is negative or not finite, or a bound of the shape is NaN or out of order")]
    Bounds,
    /// The size is not positive and finite.
    #[error("the size must be positive and finite")]
    Size,
}

/// A NURBS patch of degree 1 to 5, polynomial or rational, as a table in flash.
///
/// # Shapes
/// `breaks_u` and `breaks_v` are the span borders, from 0 to 1; see [`Coefficients`] for the rest.
#[derive(Clone, Copy, Debug)]
pub struct SplinePatch<'a> {
    pub(super) spans: Spans<'a>,
    pub(super) grid: SpanGrid<'a>,
    shape: ShapeBounds,
    /// 1 if `f_u × f_v` points out of the body, −1 if into it.
    outward: f32,
    size: f32,
    baked_crc: Option<NonZeroU32>,
}

impl<'a> SplinePatch<'a> {
    /// A square of 1 m.
    pub(crate) const VACANT: Self = Self::from_table(
        [1, 1],
        &[0.0, 1.0],
        &[0.0, 1.0],
        Coefficients::Polynomial(&[[0.5, 0.5, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]]),
        ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 }),
        Orientation::Outward,
        1.0,
    );

    /// Whether it has weights.
    #[inline]
    pub(crate) const fn is_rational(&self) -> bool {
        self.spans.is_rational()
    }

    /// Checks a table and takes it.
    ///
    /// # Errors
    /// The first thing wrong with the table, as a [`TableError`].
    pub const fn try_new(
        degree: [u8; 2],
        breaks_u: &'a [f32],
        breaks_v: &'a [f32],
        coefficients: Coefficients<'a>,
        shape: ShapeBounds,
        orientation: Orientation,
        size: f32,
    ) -> Result<Self, TableError> {
        let expected = match Self::coefficient_count(degree, [breaks_u, breaks_v]) {
            Ok(expected) => expected,
            Err(error) => return Err(error),
        };
        let (count, finite) = match coefficients {
            Coefficients::Polynomial(entries) => (entries.len(), all_finite(entries)),
            Coefficients::Rational(entries) => (entries.len(), all_finite(entries)),
        };
        if count != expected {
            return Err(TableError::CoefficientCount);
        }
        if !finite {
            return Err(TableError::CoefficientNotFinite);
        }
        if !shape.is_possible() {
            return Err(TableError::Bounds);
        }
        if !(size > 0.0 && size < f32::INFINITY) {
            return Err(TableError::Size);
        }
        let outward = match orientation {
            Orientation::Outward => 1.0,
            Orientation::Inward => -1.0,
        };
        let spans = Spans::new(degree, coefficients);
        Ok(Self { spans, grid: SpanGrid { degree, breaks_u, breaks_v }, shape, outward, size, baked_crc: None })
    }

    /// How many coefficients a patch of these degrees and span borders has.
    ///
    /// # Errors
    /// Degrees and borders that no patch has.
    pub(crate) const fn coefficient_count(degree: [u8; 2], breaks: [&[f32]; 2]) -> Result<usize, TableError> {
        let [degree_u, degree_v] = [degree[0] as usize, degree[1] as usize];
        if degree_u < 1 || degree_u > MAX_DEGREE || degree_v < 1 || degree_v > MAX_DEGREE {
            return Err(TableError::Degree);
        }
        if !breaks_are_valid(breaks[0]) {
            return Err(TableError::BreaksU);
        }
        if !breaks_are_valid(breaks[1]) {
            return Err(TableError::BreaksV);
        }
        Ok((breaks[0].len() - 1) * (breaks[1].len() - 1) * (degree_u + 1) * (degree_v + 1))
    }

    /// [`Self::try_new`] for a `static`: a bad table does not compile.
    ///
    /// # Panics
    /// At compile time, naming what is wrong.
    pub const fn from_table(
        degree: [u8; 2],
        breaks_u: &'a [f32],
        breaks_v: &'a [f32],
        coefficients: Coefficients<'a>,
        shape: ShapeBounds,
        orientation: Orientation,
        size: f32,
    ) -> Self {
        match Self::try_new(degree, breaks_u, breaks_v, coefficients, shape, orientation, size) {
            Ok(patch) => patch,
            Err(TableError::Degree) => panic!("degree"),
            Err(TableError::BreaksU) => panic!("breaks_u"),
            Err(TableError::BreaksV) => panic!("breaks_v"),
            Err(TableError::CoefficientCount) => panic!("coefficients: count"),
            Err(TableError::CoefficientNotFinite) => panic!("coefficients: not finite"),
            Err(TableError::Bounds) => panic!("bounds"),
            Err(TableError::Size) => panic!("size"),
        }
    }

    /// The same table with the CRC that its words had when it was baked: the loop compares them with it, see
    /// [`crate::servo::Safety::checks_tables`]. A patch of a body needs none, the body has one. (A CRC of 0, one in
    /// 2³², is none.)
    #[must_use]
    pub const fn with_crc(self, baked: u32) -> Self {
        Self { baked_crc: NonZeroU32::new(baked), ..self }
    }

    /// Degrees along `u` and `v`.
    pub const fn degree(&self) -> [u8; 2] {
        self.grid.degree
    }

    /// Span borders along `u` and `v`.
    pub const fn breaks(&self) -> [&'a [f32]; 2] {
        [self.grid.breaks_u, self.grid.breaks_v]
    }

    /// The coefficients of all spans.
    pub const fn coefficients(&self) -> Coefficients<'a> {
        self.spans.coefficients()
    }

    /// Bytes of table this patch keeps in flash.
    pub const fn table_bytes(&self) -> usize {
        let coefficients = match self.spans.coefficients() {
            Coefficients::Polynomial(entries) => entries.len() * 12,
            Coefficients::Rational(entries) => entries.len() * 16,
        };
        coefficients + (self.grid.breaks_u.len() + self.grid.breaks_v.len()) * 4 + size_of::<Self>()
    }
}

impl<'a> SplinePatch<'a> {
    /// The `index`-th word of the table: degrees and orientation, bounds, size, the borders along `u` and `v`, the
    /// coefficients.
    pub(crate) const fn word(&self, index: usize) -> Option<u32> {
        let (u, v) = (self.grid.breaks_u.len(), self.grid.breaks_v.len());
        let (bounds, third) = (&self.shape.second_derivatives, &self.shape.third_derivatives);
        let coefficients = self.spans.coefficients();
        let value = match index {
            0 => {
                let degrees = self.grid.degree[0] as u32 | (self.grid.degree[1] as u32) << 8;
                let bits = self.outward.to_bits();
                // Of all its bits: those besides the sign are known.
                let spoiled = (bits << 1 >> 1) ^ 1.0_f32.to_bits();
                return Some((degrees | coefficients.tag() << 16 | (bits >> 31) << 24) ^ spoiled);
            }
            1 => return Some(u as u32 | (v as u32) << 16),
            2 => bounds.uu,
            3 => bounds.uv,
            4 => bounds.vv,
            5 => third.uuu,
            6 => third.uuv,
            7 => third.uvv,
            8 => third.vvv,
            9 => third.jump_uu,
            10 => third.jump_vv,
            11 => self.shape.curvature.min,
            12 => self.shape.curvature.max,
            13 => self.shape.min_stretch,
            14 => self.shape.max_stretch,
            15 => self.shape.max_bend,
            16 => self.size,
            _ if index - HEAD < u => self.grid.breaks_u[index - HEAD],
            _ if index - HEAD - u < v => self.grid.breaks_v[index - HEAD - u],
            _ => return coefficient_word(coefficients, index - HEAD - u - v),
        };
        Some(value.to_bits())
    }

    /// CRC-32 of the table. As a `const` it is computed by the compiler, from the source and not from flash.
    pub const fn table_crc(&self) -> u32 {
        let (mut crc, mut index) = (0, 0);
        while let Some(word) = self.word(index) {
            crc = super::crc32(crc, word);
            index += 1;
        }
        crc
    }
}

/// Words before the borders.
const HEAD: usize = 17;

impl Patch for SplinePatch<'_> {
    #[inline(always)]
    fn evaluate_curved(&self, u: f32, v: f32) -> CurvedPoint {
        self.evaluate_curved(u, v)
    }

    #[inline(always)]
    fn beyond_knots(&self, from: [f32; 2], to: [f32; 2]) -> [f32; 2] {
        if self.grid.is_one_span() { [0.0; 2] } else { self.grid.beyond_borders(from, to) }
    }

    #[inline(always)]
    fn evaluate(&self, u: f32, v: f32) -> SurfacePoint {
        self.spans.evaluate(&self.grid, u, v)
    }

    fn bounds(&self) -> SecondDerivativeBounds {
        self.shape.second_derivatives
    }

    fn shape(&self) -> ShapeBounds {
        self.shape
    }

    fn orientation(&self) -> f32 {
        self.outward
    }

    fn size(&self) -> f32 {
        self.size
    }

    fn table_word(&self, index: usize) -> Option<u32> {
        self.word(index)
    }

    fn baked_crc(&self) -> Option<u32> {
        self.baked_crc.map(NonZeroU32::get)
    }
}

const fn all_finite<const D: usize>(entries: &[[f32; D]]) -> bool {
    let mut index = 0;
    while index < entries.len() {
        let mut component = 0;
        while component < D {
            if !entries[index][component].is_finite() {
                return false;
            }
            component += 1;
        }
        index += 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_of_the_orientation_is_in_the_first_word() {
        static POWERS: [[f32; 3]; 4] = [[0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]];
        let patch = SplinePatch::from_table(
            [1, 1],
            &[0.0, 1.0],
            &[0.0, 1.0],
            Coefficients::Polynomial(&POWERS),
            ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 }),
            Orientation::Outward,
            1.0,
        );
        for bit in 0..32 {
            let outward = f32::from_bits(patch.outward.to_bits() ^ 1 << bit);
            assert_ne!(SplinePatch { outward, ..patch }.word(0), patch.word(0), "bit {bit}");
        }
    }

    #[test]
    fn a_table_says_what_it_is_made_of() {
        static ROUND: [[f32; 4]; 4] = [[0.0, 0.0, 0.0, 1.0]; 4];
        static FLAT: [[f32; 3]; 4] = [[7.0, 8.0, 9.0], [1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [0.0; 3]];
        let patch = |coefficients| {
            let shape = ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 });
            SplinePatch::from_table([1, 1], &[0.0, 1.0], &[0.0, 1.0], coefficients, shape, Orientation::Outward, 1.0)
        };
        let (flat, round) = (patch(Coefficients::Polynomial(&FLAT)), patch(Coefficients::Rational(&ROUND)));
        assert_eq!((flat.word(0), round.word(0)), (Some(0x0000_0101), Some(0x0001_0101)));
        assert_eq!((flat.baked_crc(), flat.with_crc(5).baked_crc()), (None, Some(5)));
        // The coefficients come last, one after the other.
        let words: [Option<u32>; 13] = core::array::from_fn(|index| flat.word(HEAD + 4 + index));
        let numbers = FLAT.as_flattened();
        assert!(words[..12].iter().zip(numbers).all(|(word, number)| *word == Some(number.to_bits())), "{words:?}");
        assert_eq!(words[12], None);
        // Of rational ones, four a point.
        let last: [Option<u32>; 3] = core::array::from_fn(|index| round.word(HEAD + 18 + index));
        assert_eq!(last, [Some(0), Some(1.0_f32.to_bits()), None]);
    }
}
