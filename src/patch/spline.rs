//! NURBS patches as polynomial spans in flash.
//!
//! The host splits a patch at its knots and writes each span in powers of the distance from the span's centre
//! (`s = u - centre`), which keeps Horner's rule well conditioned in `f32`. Rational patches are kept homogeneous
//! (`w x, w y, w z, w`) and divided once.

use super::coefficients::coefficient_word;
use super::span_grid::SpanGrid;
use super::spans::Spans;
use super::{Coefficients, CurvedPoint, Patch, SecondDerivativeBounds, ShapeBounds, SplineTable, SurfacePoint};
use crate::tally;
use core::num::NonZeroU32;

/// A NURBS patch of degree 1 to 5, polynomial or rational, as a checked table in flash: made of a [`SplineTable`].
#[derive(Clone, Copy, Debug)]
pub struct SplinePatch<'a> {
    pub(super) spans: Spans<'a>,
    pub(super) grid: SpanGrid<'a>,
    pub(super) shape: ShapeBounds,
    /// 1 if `f_u × f_v` points out of the body, −1 if into it.
    pub(super) outward: f32,
    pub(super) size: f32,
    pub(super) baked_crc: Option<NonZeroU32>,
}

impl<'a> SplinePatch<'a> {
    /// Content of an unused slot: a square of 1 m.
    pub(crate) const VACANT: Self = SplineTable::UNIT_SQUARE.checked_in_body();

    /// Its kind, as a set of one ([`super::Kinds::MASK`]).
    pub const fn kind(&self) -> u32 {
        super::kinds::kind(self.grid.degree, self.is_rational())
    }

    /// Whether it has weights.
    #[inline]
    pub(crate) const fn is_rational(&self) -> bool {
        self.spans.is_rational()
    }

    /// The proved bounds, in place.
    #[inline(always)]
    pub(crate) const fn bounds_of_shape(&self) -> &ShapeBounds {
        &self.shape
    }

    /// The same table with another baked CRC, which the servo loop compares with flash (see
    /// [`crate::servo::Safety::checks_tables`]). [`SplineTable::checked`] sets it: this is for a face that is used
    /// without its body. 0 is no CRC: one table in 2³² is not checked.
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

    /// Bytes of flash of the table.
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
                // Every bit: those besides the sign are known.
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

    /// CRC-32 of the table's words. In a `const` the compiler computes it from the source, not from flash.
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
        tally::patch();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_of_the_orientation_is_in_the_first_word() {
        let patch = SplinePatch::VACANT;
        for bit in 0..32 {
            let outward = f32::from_bits(patch.outward.to_bits() ^ 1 << bit);
            assert_ne!(SplinePatch { outward, ..patch }.word(0), patch.word(0), "bit {bit}");
        }
    }

    #[test]
    fn the_words_hold_the_kind_and_all_coefficients_of_a_table() {
        static ROUND: [[f32; 4]; 4] = [[0.0, 0.0, 0.0, 1.0]; 4];
        static FLAT: [[f32; 3]; 4] = [[7.0, 8.0, 9.0], [1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [0.0; 3]];
        let patch = |coefficients| SplineTable { coefficients, ..SplineTable::UNIT_SQUARE }.checked_in_body();
        let (flat, round) = (patch(Coefficients::Polynomial(&FLAT)), patch(Coefficients::Rational(&ROUND)));
        assert_eq!((flat.word(0), round.word(0)), (Some(0x0000_0101), Some(0x0001_0101)));
        assert_eq!((flat.baked_crc(), flat.with_crc(5).baked_crc()), (None, Some(5)));
        // The coefficients come last, one after the other.
        let words: [Option<u32>; 13] = core::array::from_fn(|index| flat.word(HEAD + 4 + index));
        let numbers = FLAT.as_flattened();
        assert!(words[..12].iter().zip(numbers).all(|(word, number)| *word == Some(number.to_bits())), "{words:?}");
        assert_eq!(words[12], None);
        // Rational ones have four a point.
        let last: [Option<u32>; 3] = core::array::from_fn(|index| round.word(HEAD + 18 + index));
        assert_eq!(last, [Some(0), Some(1.0_f32.to_bits()), None]);
    }
}
