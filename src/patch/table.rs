//! The table of a NURBS patch by named fields, and its checks.

use super::span_grid::{SpanGrid, breaks_are_valid};
use super::spans::Spans;
use super::{Coefficients, SecondDerivativeBounds, ShapeBounds, SplinePatch};
use core::fmt;

/// Maximum degree along either parameter.
pub const MAX_DEGREE: usize = 5;

/// Direction of the outward normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Orientation {
    /// `f_u × f_v` points out of the body.
    Outward,
    /// `f_u × f_v` points into the body.
    Inward,
}

/// The table of a NURBS patch, before its checks: [`SplineTable::checked`] makes the [`SplinePatch`].
///
/// `cargo palpate bake` writes these tables from a model. Written by hand, a plane square of 0.2 m at `x = 0`:
///
/// ```
/// use palpate::patch::{Coefficients, Orientation, Patch as _, SecondDerivativeBounds, ShapeBounds};
/// use palpate::patch::{SplinePatch, SplineTable};
///
/// static WALL: SplinePatch = SplineTable {
///     degree: [1, 1],
///     breaks_u: &[0.0, 1.0],
///     breaks_v: &[0.0, 1.0],
///     // The centre, then the powers t, s and st of the distance from it: 0.2 m along z and along y.
///     coefficients: Coefficients::Polynomial(&[[0.0; 3], [0.0, 0.0, 0.2], [0.0, 0.2, 0.0], [0.0; 3]]),
///     shape: ShapeBounds::unknown(SecondDerivativeBounds::ZERO),
///     orientation: Orientation::Outward,
///     size_m: 0.2,
///     crc: None,
/// }
/// .checked();
/// assert_eq!(WALL.evaluate(1.0, 0.5).point.to_array(), [0.0, 0.1, 0.0]);
/// assert_eq!(WALL.baked_crc(), Some(WALL.table_crc()));
/// ```
///
/// A bad table is a compile error that names the field:
///
/// ```compile_fail
/// # use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
/// static WALL: SplinePatch = SplineTable {
///     degree: [1, 1],
///     breaks_u: &[0.0, 0.9], // must end at 1
/// #   breaks_v: &[0.0, 1.0],
/// #   coefficients: Coefficients::Polynomial(&[[0.0; 3], [0.0, 0.0, 0.2], [0.0, 0.2, 0.0], [0.0; 3]]),
/// #   shape: ShapeBounds::unknown(SecondDerivativeBounds::ZERO),
/// #   orientation: Orientation::Outward,
/// #   size_m: 0.2,
/// #   crc: None,
///     // …
/// }
/// .checked();
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SplineTable<'a> {
    /// Degrees along `u` and `v`, 1 to [`MAX_DEGREE`].
    pub degree: [u8; 2],
    /// Span borders along `u`, strictly rising from 0 to 1.
    pub breaks_u: &'a [f32],
    /// Span borders along `v`.
    pub breaks_v: &'a [f32],
    /// The coefficients of all spans.
    pub coefficients: Coefficients<'a>,
    /// Proved bounds of the shape.
    pub shape: ShapeBounds,
    /// Direction of the outward normal.
    pub orientation: Orientation,
    /// Largest side of the bounding box, metres.
    pub size_m: f32,
    /// CRC-32 of the table's words ([`SplinePatch::table_crc`]) if a host has computed it: the check compares it.
    pub crc: Option<u32>,
}

/// Error in the table of a patch. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TableError {
    /// A degree is 0 or above [`MAX_DEGREE`].
    Degree,
    /// The span borders along `u` do not run from 0 to 1, strictly rising, with at most [`super::MAX_SPANS`] spans.
    BreaksU,
    /// The same along `v`.
    BreaksV,
    /// The number of coefficients is not spans × (degree + 1) along both parameters.
    CoefficientCount,
    /// A coefficient is not finite.
    CoefficientNotFinite,
    /// A second-derivative bound is negative or not finite, or another bound is NaN or out of order. Infinite curvature
    /// or third derivatives and a minimum stretch of 0 are valid: no bound is known.
    Shape,
    /// The size is not positive and finite.
    Size,
    /// The CRC-32 of the words is not the given one: a number has changed since the table was baked.
    Crc,
}

impl TableError {
    /// The message: the field, and its requirement.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Degree => "degree: must be 1 to 5 along u and along v",
            Self::BreaksU => "breaks_u: must rise strictly from 0 to 1, with at most 256 spans",
            Self::BreaksV => "breaks_v: must rise strictly from 0 to 1, with at most 256 spans",
            Self::CoefficientCount => "coefficients: their number does not match the spans and degrees",
            Self::CoefficientNotFinite => "coefficients: a number is not finite",
            Self::Shape => {
                "shape: a second-derivative bound is negative or not finite, or a bound is NaN or out of order"
            }
            Self::Size => "size_m: must be positive and finite",
            Self::Crc => "crc: the table's numbers are not those that were baked",
        }
    }
}

impl fmt::Display for TableError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.message())
    }
}

impl core::error::Error for TableError {}

impl<'a> SplineTable<'a> {
    /// A plane square of 1 m, `z = 0`, from the origin along x and y, facing +z: a start for tables by hand.
    pub const UNIT_SQUARE: Self = Self {
        degree: [1, 1],
        breaks_u: &[0.0, 1.0],
        breaks_v: &[0.0, 1.0],
        coefficients: Coefficients::Polynomial(&[[0.5, 0.5, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]]),
        shape: ShapeBounds::unknown(SecondDerivativeBounds::ZERO),
        orientation: Orientation::Outward,
        size_m: 1.0,
        crc: None,
    };

    /// The patch, with its CRC, for a `static`.
    ///
    /// # Panics
    /// At compile time, with [`TableError::message`].
    pub const fn checked(self) -> SplinePatch<'a> {
        match self.try_checked() {
            Ok(patch) => patch,
            Err(error) => panic!("{}", error.message()),
        }
    }

    /// Checks the table, and its CRC if one is given. The patch carries the CRC of its words: the servo loop compares
    /// flash with it (see [`crate::servo::Safety::checks_tables`]).
    ///
    /// # Errors
    /// The first error in the table.
    pub const fn try_checked(self) -> Result<SplinePatch<'a>, TableError> {
        let patch = match self.try_checked_in_body() {
            Ok(patch) => patch,
            Err(error) => return Err(error),
        };
        let found = patch.table_crc();
        match self.crc {
            Some(baked) if baked != found => Err(TableError::Crc),
            _ => Ok(patch.with_crc(found)),
        }
    }

    /// [`Self::checked`] for a face of a body, without a CRC: the body has one over all its tables.
    ///
    /// # Panics
    /// At compile time, with [`TableError::message`].
    pub const fn checked_in_body(self) -> SplinePatch<'a> {
        match self.try_checked_in_body() {
            Ok(patch) => patch,
            Err(error) => panic!("{}", error.message()),
        }
    }

    /// [`Self::try_checked`] for a face of a body, without a CRC.
    ///
    /// # Errors
    /// The first error in the table.
    pub const fn try_checked_in_body(self) -> Result<SplinePatch<'a>, TableError> {
        let Self { degree, breaks_u, breaks_v, coefficients, shape, orientation, size_m, .. } = self;
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
            return Err(TableError::Shape);
        }
        if !(size_m > 0.0 && size_m < f32::INFINITY) {
            return Err(TableError::Size);
        }
        let outward = match orientation {
            Orientation::Outward => 1.0,
            Orientation::Inward => -1.0,
        };
        let spans = Spans::new(degree, coefficients);
        let grid = SpanGrid { degree, breaks_u, breaks_v };
        Ok(SplinePatch { spans, grid, shape, outward, size: size_m, baked_crc: None })
    }

    /// The number of coefficients of a patch of these degrees and span borders.
    ///
    /// # Errors
    /// Invalid degrees or borders.
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
    fn a_baked_crc_is_compared_with_the_words() {
        let table = SplineTable::UNIT_SQUARE;
        let crc = table.checked().table_crc();
        let with = |crc| SplineTable { crc: Some(crc), ..table }.try_checked().map(|patch| patch.baked_crc);
        assert_eq!(with(crc).unwrap().map(u32::from), Some(crc));
        assert_eq!(with(crc ^ 1), Err(TableError::Crc));
        let moved = SplineTable { size_m: 1.5, crc: Some(crc), ..table };
        assert_eq!(moved.try_checked().err(), Some(TableError::Crc));
        assert_eq!(table.checked_in_body().baked_crc, None);
    }
}
