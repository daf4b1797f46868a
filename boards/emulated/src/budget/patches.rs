//! Patches of every degree, of one span. Their shape does not matter: the evaluation has no branch that depends
//! on a coefficient.

use palpate::body::{MAX_CURVE_DEGREE, SplineCurve};
use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};

/// Nothing is proved of them; the controller is measured on the image's own body.
const BOUNDS: ShapeBounds = ShapeBounds::unknown(SecondDerivativeBounds { uu: 1.0, uv: 1.0, vv: 1.0 });

/// Numbers that are all different, so that no compiler finds a pattern in them.
const fn coefficients<const D: usize, const N: usize>() -> [[f32; D]; N] {
    let mut entries = [[1.0; D]; N];
    let mut index = 0;
    while index < N {
        let mut component = 0;
        while component < 3 {
            entries[index][component] = 0.01 + 0.001 * (index * 3 + component) as f32;
            component += 1;
        }
        index += 1;
    }
    entries
}

const fn patch(degree: u8, coefficients: Coefficients<'static>) -> SplinePatch<'static> {
    SplineTable {
        degree: [degree, degree],
        breaks_u: &[0.0, 1.0],
        breaks_v: &[0.0, 1.0],
        coefficients,
        shape: BOUNDS,
        orientation: Orientation::Outward,
        size_m: 0.1,
        crc: None,
    }
    .checked()
}

/// Of degree 1 to 5 along both parameters.
pub static POLYNOMIAL: [SplinePatch; 5] = [
    patch(1, Coefficients::Polynomial(&const { coefficients::<3, 4>() })),
    patch(2, Coefficients::Polynomial(&const { coefficients::<3, 9>() })),
    patch(3, Coefficients::Polynomial(&const { coefficients::<3, 16>() })),
    patch(4, Coefficients::Polynomial(&const { coefficients::<3, 25>() })),
    patch(5, Coefficients::Polynomial(&const { coefficients::<3, 36>() })),
];

/// The same, rational.
pub static RATIONAL: [SplinePatch; 5] = [
    patch(1, Coefficients::Rational(&const { coefficients::<4, 4>() })),
    patch(2, Coefficients::Rational(&const { coefficients::<4, 9>() })),
    patch(3, Coefficients::Rational(&const { coefficients::<4, 16>() })),
    patch(4, Coefficients::Rational(&const { coefficients::<4, 25>() })),
    patch(5, Coefficients::Rational(&const { coefficients::<4, 36>() })),
];

const fn curve(coefficients: Coefficients<'static>) -> SplineCurve<'static> {
    SplineCurve { degree: MAX_CURVE_DEGREE as u8, breaks: &[0.0, 1.0], coefficients, second_derivative: 1.0 }
}

/// A curve of the highest degree.
pub static POLYNOMIAL_CURVE: SplineCurve = curve(Coefficients::Polynomial(&const { coefficients::<3, 11>() }));

/// The same, rational.
pub static RATIONAL_CURVE: SplineCurve = curve(Coefficients::Rational(&const { coefficients::<4, 11>() }));
