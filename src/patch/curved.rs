//! Evaluation of a point with both tangents and all second derivatives, for second-order steps in the tick and the
//! search.

use super::SurfacePoint;
use super::curved_point::{CurvedPoint, SecondDerivatives};
use super::kinds::{self, ALL_KINDS, KindSet, Kinds};
use super::span_grid::SpanGrid;
use super::spans::{Spans, rows_at};
use super::spline::SplinePatch;
use super::taylor::{self, Taylor};
use crate::math::{Vec3, vec3};
use crate::tally;

impl SplinePatch<'_> {
    /// The point and its derivatives up to the second at `(u, v)`, by Horner's rule on the span that holds it.
    #[inline(always)]
    pub fn evaluate_curved(&self, u: f32, v: f32) -> CurvedPoint {
        self.evaluate_kinds::<KindSet<ALL_KINDS>>(u, v)
    }

    /// The same for a patch that is of one of these kinds.
    #[inline(always)]
    pub(crate) fn evaluate_kinds<K: Kinds>(&self, u: f32, v: f32) -> CurvedPoint {
        tally::patch();
        match self.spans {
            Spans::Bilinear(spans) => whole::<K, 3, 2, 4>(spans, &self.grid, u, v),
            Spans::Biquadratic(spans) => whole::<K, 3, 3, 9>(spans, &self.grid, u, v),
            Spans::Bicubic(spans) => whole::<K, 3, 4, 16>(spans, &self.grid, u, v),
            Spans::RationalBilinear(spans) => whole::<K, 4, 2, 4>(spans, &self.grid, u, v),
            Spans::RationalBiquadratic(spans) => whole::<K, 4, 3, 9>(spans, &self.grid, u, v),
            Spans::RationalBicubic(spans) => whole::<K, 4, 4, 16>(spans, &self.grid, u, v),
            Spans::Rows(entries) => rows::<K, 3>(entries, &self.grid, u, v),
            Spans::RationalRows(entries) => rows::<K, 4>(entries, &self.grid, u, v),
        }
    }

    /// [`Self::evaluate_kinds`] in a copy of its own: ten instructions more, less flash.
    #[inline(never)]
    pub(crate) fn evaluate_apart<K: Kinds>(&self, [u, v]: [f32; 2]) -> CurvedPoint {
        self.evaluate_kinds::<K>(u, v)
    }
}

/// Evaluates one of these spans of `N` coefficients, `Q` a row. A single one needs no search: it goes from 0 to 1.
#[inline(always)]
fn whole<K: Kinds, const D: usize, const Q: usize, const N: usize>(
    spans: &[[[f32; D]; N]],
    grid: &SpanGrid,
    u: f32,
    v: f32,
) -> CurvedPoint
where
    CurvedPoint: From<Taylor<D>>,
{
    match spans {
        _ if const { !kinds::has::<K, D>([Q as u8 - 1; 2]) } => CurvedPoint::NOWHERE,
        [only] => unrolled::<D, Q, N>(only, u - 0.5, v - 0.5),
        _ => one_of::<D, Q, N>(spans, grid, u, v),
    }
}

#[inline(never)]
fn one_of<const D: usize, const Q: usize, const N: usize>(
    spans: &[[[f32; D]; N]],
    grid: &SpanGrid,
    u: f32,
    v: f32,
) -> CurvedPoint
where
    CurvedPoint: From<Taylor<D>>,
{
    let (span, [s, t]) = grid.locate(u, v);
    // The constructor counted the entries: none is missing, this only keeps a panic out of the tick.
    spans.get(span).map_or(CurvedPoint::NOWHERE, |coefficients| unrolled::<D, Q, N>(coefficients, s, t))
}

#[inline(never)]
fn unrolled<const D: usize, const Q: usize, const N: usize>(coefficients: &[[f32; D]; N], s: f32, t: f32) -> CurvedPoint
where
    CurvedPoint: From<Taylor<D>>,
{
    taylor::evaluate::<D, Q>(coefficients, s, t).into()
}

/// Evaluates a span of any other degree. A single one of degree (1, 2) or (2, 1), a plane with a parabola for a border
/// or a piece of a cylinder, is found without a search.
#[inline(always)]
fn rows<K: Kinds, const D: usize>(entries: &[[f32; D]], grid: &SpanGrid, u: f32, v: f32) -> CurvedPoint
where
    CurvedPoint: From<Taylor<D>>,
{
    match (grid.degree, <&[[f32; D]; 6]>::try_from(entries)) {
        ([2, 1], Ok(only)) if const { kinds::has::<K, D>([2, 1]) } => unrolled::<D, 2, 6>(only, u - 0.5, v - 0.5),
        ([1, 2], Ok(only)) if const { kinds::has::<K, D>([1, 2]) } => unrolled::<D, 3, 6>(only, u - 0.5, v - 0.5),
        _ => by_rows::<K, D>(entries, grid, u, v),
    }
}

/// Evaluates a span of any other degree. Those of spheres, cylinders and cones and of surfaces of revolution have code
/// of their own, unrolled as that of the common degrees; the rest share loops.
#[inline(never)]
fn by_rows<K: Kinds, const D: usize>(entries: &[[f32; D]], grid: &SpanGrid, u: f32, v: f32) -> CurvedPoint
where
    CurvedPoint: From<Taylor<D>>,
{
    let Some((rows, [s, t])) = rows_at(entries, grid, u, v) else { return CurvedPoint::NOWHERE };
    match grid.degree {
        [1, 2] if const { kinds::has::<K, D>([1, 2]) } => all_rows::<D, 3, 6>(rows, s, t),
        [2, 1] if const { kinds::has::<K, D>([2, 1]) } => all_rows::<D, 2, 6>(rows, s, t),
        [1, 3] if const { kinds::has::<K, D>([1, 3]) } => all_rows::<D, 4, 8>(rows, s, t),
        [3, 1] if const { kinds::has::<K, D>([3, 1]) } => all_rows::<D, 2, 8>(rows, s, t),
        [3, 5] if const { kinds::has_own::<K, D>([3, 5]) } => all_rows::<D, 6, 24>(rows, s, t),
        [5, 3] if const { kinds::has_own::<K, D>([5, 3]) } => all_rows::<D, 4, 24>(rows, s, t),
        [4, 4] if const { kinds::has::<K, D>([4, 4]) } => all_rows::<D, 5, 25>(rows, s, t),
        [5, 5] if const { kinds::has::<K, D>([5, 5]) } => all_rows::<D, 6, 36>(rows, s, t),
        [_, columns] if const { kinds::has::<K, D>([0, 0]) } => {
            taylor::evaluate_rows(rows, usize::from(columns) + 1, s, t).into()
        }
        _ => CurvedPoint::NOWHERE,
    }
}

/// Rows of `Q`, `N` coefficients in all.
#[inline(always)]
fn all_rows<const D: usize, const Q: usize, const N: usize>(rows: &[[f32; D]], s: f32, t: f32) -> CurvedPoint
where
    CurvedPoint: From<Taylor<D>>,
{
    rows.first_chunk::<N>().map_or(CurvedPoint::NOWHERE, |coefficients| unrolled::<D, Q, N>(coefficients, s, t))
}

impl From<Taylor<3>> for CurvedPoint {
    #[inline(always)]
    fn from(d: Taylor<3>) -> Self {
        let [tangent_u, tangent_v] = d.along.map(Vec3::from_array);
        Self {
            surface: SurfacePoint { point: Vec3::from_array(d.value), tangent_u, tangent_v },
            second: SecondDerivatives {
                half_uu: Vec3::from_array(d.half_ss),
                uv: Vec3::from_array(d.mixed),
                half_vv: Vec3::from_array(d.half_tt),
            },
        }
    }
}

/// Leibniz' rule on `w P = A`, solved for the highest derivative of `P`.
impl From<Taylor<4>> for CurvedPoint {
    #[inline(always)]
    fn from(d: Taylor<4>) -> Self {
        let split = |[x, y, z, w]: [f32; 4]| (vec3(x, y, z), w);
        let ((a, w), (a_u, w_u), (a_v, w_v)) = (split(d.value), split(d.along[0]), split(d.along[1]));
        let ((a_uu, w_uu), (a_uv, w_uv), (a_vv, w_vv)) = (split(d.half_ss), split(d.mixed), split(d.half_tt));
        let inverse = 1.0 / w;
        let point = a * inverse;
        let tangent_u = (a_u - point * w_u) * inverse;
        let tangent_v = (a_v - point * w_v) * inverse;
        Self {
            surface: SurfacePoint { point, tangent_u, tangent_v },
            second: SecondDerivatives {
                half_uu: (a_uu - tangent_u * w_u - point * w_uu) * inverse,
                uv: (a_uv - tangent_u * w_v - tangent_v * w_u - point * w_uv) * inverse,
                half_vv: (a_vv - tangent_v * w_v - point * w_vv) * inverse,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::{Coefficients, Patch as _, SplineTable};

    /// Step at which the error of the difference, a sixth of the squared step times the third derivative, equals its
    /// rounding.
    const STEP: f32 = 1.0 / 64.0;

    /// Numbers without a pattern, the weights near 1.
    const fn entries<const D: usize, const N: usize>() -> [[f32; D]; N] {
        let mut entries = [[1.0; D]; N];
        let mut index = 0;
        while index < N {
            let mut component = 0;
            while component < D {
                let number = ((index * D + component) * 7 % 11) as f32 / 11.0 - 0.5;
                entries[index][component] =
                    if component == 3 { if index == 0 { 1.0 } else { 0.05 * number } } else { number };
                component += 1;
            }
            index += 1;
        }
        entries
    }

    fn check(degree: [u8; 2], coefficients: Coefficients) {
        let patch = SplineTable { degree, coefficients, ..SplineTable::UNIT_SQUARE }.checked_in_body();
        for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.9, 0.3)] {
            let curved = patch.evaluate_curved(u, v);
            let at = patch.evaluate(u, v);
            for (found, known) in [
                (curved.surface.point, at.point),
                (curved.surface.tangent_u, at.tangent_u),
                (curved.surface.tangent_v, at.tangent_v),
            ] {
                // Ten roundings of numbers of the size of 1.
                assert!((found - known).length() < 2e-6, "{degree:?}: {found} {known}");
            }
            let [right, left] = [STEP, -STEP].map(|step| patch.evaluate(u + step, v));
            let [above, below] = [STEP, -STEP].map(|step| patch.evaluate(u, v + step));
            let differences = [
                (curved.second.half_uu * 2.0, right.tangent_u - left.tangent_u),
                (curved.second.uv, right.tangent_v - left.tangent_v),
                (curved.second.uv, above.tangent_u - below.tangent_u),
                (curved.second.half_vv * 2.0, above.tangent_v - below.tangent_v),
            ];
            for (found, change) in differences {
                let known = change / (2.0 * STEP);
                // Third derivatives are a few dozen at degree 5.
                assert!((found - known).length() < 0.01, "{degree:?} at {u}, {v}: {found}, by differences {known}");
            }
        }
    }

    #[test]
    fn second_derivatives_are_those_of_the_differences() {
        check([1, 1], Coefficients::Polynomial(&const { entries::<3, 4>() }));
        check([1, 2], Coefficients::Polynomial(&const { entries::<3, 6>() }));
        check([2, 2], Coefficients::Polynomial(&const { entries::<3, 9>() }));
        check([3, 2], Coefficients::Polynomial(&const { entries::<3, 12>() }));
        check([3, 3], Coefficients::Polynomial(&const { entries::<3, 16>() }));
        check([5, 4], Coefficients::Polynomial(&const { entries::<3, 30>() }));
        check([2, 2], Coefficients::Rational(&const { entries::<4, 9>() }));
        check([3, 5], Coefficients::Rational(&const { entries::<4, 24>() }));
        check([2, 1], Coefficients::Rational(&const { entries::<4, 6>() }));
        check([4, 4], Coefficients::Rational(&const { entries::<4, 25>() }));
    }

    /// The bits of a point with all its derivatives.
    fn bits(point: &CurvedPoint) -> [[u32; 3]; 6] {
        let CurvedPoint { surface, second } = point;
        [surface.point, surface.tangent_u, surface.tangent_v, second.half_uu, second.uv, second.half_vv]
            .map(|vector| vector.to_array().map(f32::to_bits))
    }

    fn unrolled_as_loops<const D: usize>(degree: [u8; 2], entries: &[[f32; D]], coefficients: Coefficients)
    where
        CurvedPoint: From<Taylor<D>>,
    {
        let patch = SplineTable { degree, coefficients, ..SplineTable::UNIT_SQUARE }.checked_in_body();
        for [u, v] in [[0.1, 0.2], [0.5, 0.5], [0.9, 0.3], [0.0, 1.0]] {
            let loops = taylor::evaluate_rows(entries, usize::from(degree[1]) + 1, u - 0.5, v - 0.5).into();
            assert_eq!(bits(&patch.evaluate_curved(u, v)), bits(&loops), "{degree:?} at {u}, {v}");
        }
    }

    #[test]
    fn unrolled_code_gives_the_bits_of_the_loops() {
        static POLYNOMIAL: [[f32; 3]; 36] = entries();
        static RATIONAL: [[f32; 4]; 36] = entries();
        for u in 1..=5_u8 {
            for v in 1..=5_u8 {
                let count = usize::from(u + 1) * usize::from(v + 1);
                let (polynomial, rational) = (&POLYNOMIAL[..count], &RATIONAL[..count]);
                unrolled_as_loops([u, v], polynomial, Coefficients::Polynomial(polynomial));
                unrolled_as_loops([u, v], rational, Coefficients::Rational(rational));
            }
        }
    }

    #[test]
    fn a_body_of_one_kind_has_no_code_for_others() {
        let patch = SplineTable {
            degree: [1, 2],
            coefficients: Coefficients::Polynomial(&const { entries::<3, 6>() }),
            ..SplineTable::UNIT_SQUARE
        }
        .checked_in_body();
        let all = patch.evaluate_curved(0.3, 0.7);
        const OWN: u32 = kinds::kind([1, 2], false);
        assert_eq!(patch.kind(), OWN);
        assert_eq!(patch.evaluate_kinds::<KindSet<OWN>>(0.3, 0.7), all);
        assert_eq!(patch.evaluate_kinds::<KindSet<0>>(0.3, 0.7), CurvedPoint::NOWHERE);
        // These two have code in such an image alone: its bits are those of the loops.
        const STEEP: [u32; 2] = [kinds::kind([3, 5], false), kinds::kind([5, 3], false)];
        let coefficients = Coefficients::Polynomial(&const { entries::<3, 24>() });
        let [wide, long] = [[3, 5], [5, 3]]
            .map(|degree| SplineTable { degree, coefficients, ..SplineTable::UNIT_SQUARE }.checked_in_body());
        assert_eq!(
            bits(&wide.evaluate_kinds::<KindSet<{ STEEP[0] }>>(0.3, 0.7)),
            bits(&wide.evaluate_curved(0.3, 0.7))
        );
        assert_eq!(
            bits(&long.evaluate_kinds::<KindSet<{ STEEP[1] }>>(0.3, 0.7)),
            bits(&long.evaluate_curved(0.3, 0.7))
        );
    }
}
