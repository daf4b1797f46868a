//! The spans of a patch in the form of the evaluation: an array each for the common degrees, so that all loops are
//! unrolled and the tick does not branch on a degree.

use super::horner::{self, Derivatives};
use super::{Coefficients, SpanGrid, SurfacePoint};
use crate::math::{Vec3, vec3};

/// All spans of a patch.
#[derive(Clone, Copy, Debug)]
pub(super) enum Spans<'a> {
    /// Degree (1, 1).
    Bilinear(&'a [[[f32; 3]; 4]]),
    /// Degree (2, 2).
    Biquadratic(&'a [[[f32; 3]; 9]]),
    /// Degree (3, 3).
    Bicubic(&'a [[[f32; 3]; 16]]),
    /// Degree (1, 1), rational.
    RationalBilinear(&'a [[[f32; 4]; 4]]),
    /// Degree (2, 2), rational.
    RationalBiquadratic(&'a [[[f32; 4]; 9]]),
    /// Degree (3, 3), rational.
    RationalBicubic(&'a [[[f32; 4]; 16]]),
    /// Any other degree: row by row.
    Rows(&'a [[f32; 3]]),
    /// Any other degree, rational.
    RationalRows(&'a [[f32; 4]]),
}

impl<'a> Spans<'a> {
    /// Whether there are weights.
    #[inline]
    pub(super) const fn is_rational(&self) -> bool {
        matches!(
            self,
            Self::RationalBilinear(_) | Self::RationalBiquadratic(_) | Self::RationalBicubic(_) | Self::RationalRows(_)
        )
    }

    /// The coefficients, counted already, in spans.
    pub(super) const fn new(degree: [u8; 2], coefficients: Coefficients<'a>) -> Self {
        match (degree, coefficients) {
            ([1, 1], Coefficients::Polynomial(entries)) => Self::Bilinear(entries.as_chunks().0),
            ([2, 2], Coefficients::Polynomial(entries)) => Self::Biquadratic(entries.as_chunks().0),
            ([3, 3], Coefficients::Polynomial(entries)) => Self::Bicubic(entries.as_chunks().0),
            ([1, 1], Coefficients::Rational(entries)) => Self::RationalBilinear(entries.as_chunks().0),
            ([2, 2], Coefficients::Rational(entries)) => Self::RationalBiquadratic(entries.as_chunks().0),
            ([3, 3], Coefficients::Rational(entries)) => Self::RationalBicubic(entries.as_chunks().0),
            (_, Coefficients::Polynomial(entries)) => Self::Rows(entries),
            (_, Coefficients::Rational(entries)) => Self::RationalRows(entries),
        }
    }

    /// The coefficients in one piece.
    pub(super) const fn coefficients(&self) -> Coefficients<'a> {
        match self {
            Self::Bilinear(spans) => Coefficients::Polynomial(spans.as_flattened()),
            Self::Biquadratic(spans) => Coefficients::Polynomial(spans.as_flattened()),
            Self::Bicubic(spans) => Coefficients::Polynomial(spans.as_flattened()),
            Self::RationalBilinear(spans) => Coefficients::Rational(spans.as_flattened()),
            Self::RationalBiquadratic(spans) => Coefficients::Rational(spans.as_flattened()),
            Self::RationalBicubic(spans) => Coefficients::Rational(spans.as_flattened()),
            Self::Rows(entries) => Coefficients::Polynomial(entries),
            Self::RationalRows(entries) => Coefficients::Rational(entries),
        }
    }

    /// The point and both tangents at `(u, v)` of the patch whose spans these are, with its grid. Inlined, as each tick
    /// goes through it.
    #[inline(always)]
    pub(super) fn evaluate(&self, grid: &SpanGrid<'_>, u: f32, v: f32) -> SurfacePoint {
        match self {
            Self::Bilinear(spans) => whole::<3, 2, 4>(spans, grid, u, v),
            Self::Biquadratic(spans) => whole::<3, 3, 9>(spans, grid, u, v),
            Self::Bicubic(spans) => whole::<3, 4, 16>(spans, grid, u, v),
            Self::RationalBilinear(spans) => whole::<4, 2, 4>(spans, grid, u, v),
            Self::RationalBiquadratic(spans) => whole::<4, 3, 9>(spans, grid, u, v),
            Self::RationalBicubic(spans) => whole::<4, 4, 16>(spans, grid, u, v),
            Self::Rows(entries) => by_rows(entries, grid, u, v),
            Self::RationalRows(entries) => by_rows(entries, grid, u, v),
        }
    }
}

/// Evaluates one of these spans of `N` coefficients, `Q` a row. A single one needs no search: it goes from 0 to 1.
#[inline(always)]
fn whole<const D: usize, const Q: usize, const N: usize>(
    spans: &[[[f32; D]; N]],
    grid: &SpanGrid<'_>,
    u: f32,
    v: f32,
) -> SurfacePoint
where
    SurfacePoint: From<Derivatives<D>>,
{
    match spans {
        [only] => unrolled::<D, Q, N>(only, u - 0.5, v - 0.5),
        _ => one_of::<D, Q, N>(spans, grid, u, v),
    }
}

/// Not inlined, as [`unrolled`]: only the patches that need it pay for its stack.
#[inline(never)]
fn one_of<const D: usize, const Q: usize, const N: usize>(
    spans: &[[[f32; D]; N]],
    grid: &SpanGrid<'_>,
    u: f32,
    v: f32,
) -> SurfacePoint
where
    SurfacePoint: From<Derivatives<D>>,
{
    let (span, [s, t]) = grid.locate(u, v);
    // The constructor counted the entries: none is missing, this only keeps a panic out of the tick.
    spans.get(span).map_or(SurfacePoint::NOWHERE, |coefficients| unrolled::<D, Q, N>(coefficients, s, t))
}

#[inline(never)]
fn unrolled<const D: usize, const Q: usize, const N: usize>(
    coefficients: &[[f32; D]; N],
    s: f32,
    t: f32,
) -> SurfacePoint
where
    SurfacePoint: From<Derivatives<D>>,
{
    horner::evaluate::<D, Q>(coefficients, s, t).into()
}

/// Evaluates a span of any degree: the degree along `v` picks a loop that is unrolled for it, if there is one.
#[inline(never)]
fn by_rows<const D: usize>(entries: &[[f32; D]], grid: &SpanGrid<'_>, u: f32, v: f32) -> SurfacePoint
where
    SurfacePoint: From<Derivatives<D>>,
{
    let Some((rows, [s, t])) = rows_at(entries, grid, u, v) else { return SurfacePoint::NOWHERE };
    match grid.degree[1] {
        1 => unrolled_along_v::<D, 2>(rows, s, t),
        2 => unrolled_along_v::<D, 3>(rows, s, t),
        3 => unrolled_along_v::<D, 4>(rows, s, t),
        4 => unrolled_along_v::<D, 5>(rows, s, t),
        _ => unrolled_along_v::<D, 6>(rows, s, t),
    }
}

/// The coefficients of the span that holds `(u, v)`, and the position in it, from its centre. A checked table has
/// them.
#[inline(always)]
pub(super) fn rows_at<'a, const D: usize>(
    entries: &'a [[f32; D]],
    grid: &SpanGrid<'_>,
    u: f32,
    v: f32,
) -> Option<(&'a [[f32; D]], [f32; 2])> {
    let [degree_u, degree_v] = grid.degree;
    let count = (usize::from(degree_u) + 1) * (usize::from(degree_v) + 1);
    if entries.len() == count {
        return Some((entries, [u - 0.5, v - 0.5]));
    }
    let (span, at) = grid.locate(u, v);
    Some((entries.get(span * count..)?.get(..count)?, at))
}

#[inline(never)]
fn unrolled_along_v<const D: usize, const Q: usize>(rows: &[[f32; D]], s: f32, t: f32) -> SurfacePoint
where
    SurfacePoint: From<Derivatives<D>>,
{
    horner::evaluate::<D, Q>(rows, s, t).into()
}

impl From<Derivatives<3>> for SurfacePoint {
    #[inline(always)]
    fn from(d: Derivatives<3>) -> Self {
        Self {
            point: Vec3::from_array(d.value),
            tangent_u: Vec3::from_array(d.along_s),
            tangent_v: Vec3::from_array(d.along_t),
        }
    }
}

/// The quotient rule: `P = A / w`, `P_u = (A_u - w_u P) / w`.
impl From<Derivatives<4>> for SurfacePoint {
    #[inline(always)]
    fn from(d: Derivatives<4>) -> Self {
        let split = |[x, y, z, w]: [f32; 4]| (vec3(x, y, z), w);
        let ((a, w), (a_u, w_u), (a_v, w_v)) = (split(d.value), split(d.along_s), split(d.along_t));
        let inverse = 1.0 / w;
        let point = a * inverse;
        Self { point, tangent_u: (a_u - point * w_u) * inverse, tangent_v: (a_v - point * w_v) * inverse }
    }
}
