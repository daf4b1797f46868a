//! The only file that names a mathematics library. Each function states its error and its cost on a Cortex-M4F.
//!
//! Nothing here uses fused multiply-add: without the hardware instruction it is software `f64`, and with it the host
//! and the target would differ in the last bit.

mod quaternion;

pub use glam::{Vec2, Vec3, vec2, vec3};
pub(crate) use quaternion::{product, quaternion, turned_by};

/// `1/√x` for a normal positive `x`. About 20 instructions, no division.
///
/// Error at most 2 units in the last place (tested for all mantissas and both parities of the exponent, on which alone
/// it depends). For other numbers the result is finite and arbitrary. Halving and negating the exponent gives 3.5 %
/// (the constant is J. Blinn's and G. Tarolli's, C. Lomont, *Fast inverse square root*, 2003); each Newton step `y (3
/// − x y²)/2` squares the error.
#[inline]
pub fn inverse_sqrt(x: f32) -> f32 {
    let half = 0.5 * x;
    let y = f32::from_bits(0x5f37_59df_u32.wrapping_sub(x.to_bits() >> 1));
    let y = y * (1.5 - half * y * y);
    let y = y * (1.5 - half * y * y);
    // The last step as a correction: it rounds only the small part.
    y + y * (0.5 - half * y * y)
}

/// `1/√x` for a normal positive `x`, or less by up to 0.2 %. About 10 instructions.
///
/// The first of [`inverse_sqrt`]'s Newton steps: from either side it ends below, but for its rounding.
#[inline]
pub fn inverse_sqrt_from_below(x: f32) -> f32 {
    let half = 0.5 * x;
    let y = f32::from_bits(0x5f37_59df_u32.wrapping_sub(x.to_bits() >> 1));
    y * (1.5 - half * y * y)
}

/// Square root. 45 instructions with its call, against 62 for `libm::sqrtf` (`cargo palpate budgets`), which has no
/// Cortex-M path; inline assembly would need `unsafe`.
///
/// Error at most 2 units in the last place; exact for 0 and infinity; 0 below the normal numbers; NaN for a negative
/// `x` and for a NaN.
#[inline]
pub fn sqrt(x: f32) -> f32 {
    if (f32::MIN_POSITIVE..f32::INFINITY).contains(&x) {
        x * inverse_sqrt(x)
    } else if x >= f32::INFINITY {
        x
    } else if x >= 0.0 {
        0.0
    } else {
        f32::NAN
    }
}

/// Maximum of [`sqrt_from_above`] over the root, as a factor: `3/√8`, rounded up.
pub const ROOT_EXCESS: f32 = 1.060_661;

/// Not below `√x`, and at most [`ROOT_EXCESS`] times it for a normal `x`; `x` finite and not negative. Four
/// instructions: for bounds that need no digits.
///
/// The bits of a float are a piecewise linear logarithm, which halving takes to a root. With the mantissa `1 + m` and
/// an even exponent that is `1 + m/2 ≥ √(1 + m)`, with an odd one `(3 + m)/2 ≥ √(2 (1 + m))`, both by the inequality of
/// the means; worst where the two meet, `3/2` for `√2`. The bit that halving drops is made good by one unit in the last
/// place.
#[inline]
pub fn sqrt_from_above(x: f32) -> f32 {
    f32::from_bits((x.to_bits() >> 1) + 0x1fc0_0001)
}

/// The root of a positive number, by Newton's method from above, to 2 units in the last place; at compile time.
pub(crate) const fn square_root(x: f32) -> f32 {
    let mut root = f32::from_bits((x.to_bits() >> 1) + 0x1fc0_0001);
    let mut round = 0;
    while round < 3 {
        root = 0.5 * (root + x / root);
        round += 1;
    }
    root
}

/// The cube root of a positive number, 0 of 0, by Newton's method from above, to 2 units in the last place; at compile
/// time.
pub(crate) const fn cube_root(x: f32) -> f32 {
    if !(x > 0.0 && x < f32::INFINITY) {
        return x;
    }
    // A third of the logarithm, and a tenth more than the most that it falls short by.
    let mut root = 1.1 * f32::from_bits(x.to_bits() / 3 + 0x2a51_4000);
    let mut round = 0;
    while round < 4 {
        root -= (root - x / (root * root)) / 3.0;
        round += 1;
    }
    root
}

/// `x` saturated to `[low, high]`; NaN becomes `low`. Plain comparisons: `f32::max` leaves the sign of zero open, and
/// with it the last bit that host and target must share; `f32::clamp` panics if `low > high`.
#[inline]
pub fn saturate(x: f32, low: f32, high: f32) -> f32 {
    if x > low { if x < high { x } else { high } } else { low }
}

/// `(sin x, cos x)`, `x` in radians. About 40 instructions, against 2,200 for `libm::sincosf`, which computes in
/// software `f64`.
///
/// Error at most 2 units in the last place of 1 (1.2e-7 absolute) for `|x| ≤ 100`; joint angles stay within a turn.
/// Reduction in two parts after Cody and Waite; the polynomials are the single-precision minimax ones of the Cephes
/// library (S. Moshier, *Methods and Programs for Mathematical Functions*, 1989).
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    const HALF_PI_HIGH: f32 = 1.570_312_5;
    const HALF_PI_LOW: f32 = 4.838_268e-4;
    // 3·2²²: added to a number of quarter turns it leaves no bits for a fraction, so that the sum is rounded to a whole
    // number, which stands in its last bits. A NaN stays visible in the remainder.
    const WHOLE: f32 = 12_582_912.0;
    let rounded = x * core::f32::consts::FRAC_2_PI + WHOLE;
    let quarter = rounded.to_bits();
    let count = rounded - WHOLE;
    let r = (x - count * HALF_PI_HIGH) - count * HALF_PI_LOW;
    let r2 = r * r;
    let sine = r + r * r2 * (-0.166_666_55 + r2 * (8.332_161e-3 + r2 * -1.951_529_6e-4));
    let cosine = 1.0 - 0.5 * r2 + r2 * r2 * (4.166_664_6e-2 + r2 * (-1.388_731_6e-3 + r2 * 2.443_315_7e-5));
    match quarter & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// The angle of the vector `(x, y)` from the x axis, radians, in `[−π, π]`; 0 for the zero vector. About 60
/// instructions, a division among them; `libm::atan2f` branches over twice as many.
///
/// Error at most 3e-7 absolute (a rounding of π). The argument is brought below tan π/8; the polynomial is the
/// single-precision minimax one of the Cephes library (see [`sin_cos`]).
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    const TAN_EIGHTH: f32 = 0.414_213_56;
    let (size_x, size_y) = (x.abs(), y.abs());
    let (low, high) = if size_y <= size_x { (size_y, size_x) } else { (size_x, size_y) };
    if high == 0.0 {
        return 0.0;
    }
    let ratio = low / high;
    let (base, r) = if ratio > TAN_EIGHTH { (FRAC_PI_4, (ratio - 1.0) / (ratio + 1.0)) } else { (0.0, ratio) };
    let r2 = r * r;
    let bend = r2 * (-0.333_329_5 + r2 * (0.199_777_11 + r2 * (-0.138_776_86 + r2 * 8.053_744_5e-2)));
    let octant = base + (r + r * bend);
    let quadrant = if size_y <= size_x { octant } else { FRAC_PI_2 - octant };
    let half = if x < 0.0 { PI - quadrant } else { quadrant };
    if y < 0.0 { -half } else { half }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All mantissas with an even and an odd exponent, as bits.
    fn two_octaves() -> impl Iterator<Item = f32> {
        (1.0_f32.to_bits()..4.0_f32.to_bits()).map(f32::from_bits)
    }

    /// Relative error in units of the last place at its coarsest, 2⁻²³.
    fn units(found: f32, expected: f64) -> f64 {
        (f64::from(found) / expected - 1.0).abs() / f64::from(f32::EPSILON)
    }

    #[test]
    fn roots_are_within_two_units_in_the_last_place_for_every_mantissa() {
        let (mut inverse, mut root): (f64, f64) = (0.0, 0.0);
        for x in two_octaves() {
            inverse = inverse.max(units(inverse_sqrt(x), 1.0 / f64::from(x).sqrt()));
            root = root.max(units(sqrt(x), f64::from(x).sqrt()));
        }
        assert!(inverse <= 2.0 && root <= 2.0, "{inverse} {root}");
    }

    #[test]
    fn the_root_from_below_is_never_above_and_near() {
        for x in two_octaves() {
            let share = f64::from(inverse_sqrt_from_below(x)) * f64::from(x).sqrt();
            // At the top of the curve only rounding is left: half a unit each of the product and the difference, and
            // three quarters of the subtrahend, a half.
            assert!(share > 0.998 && share < 1.0 + 1.75 * f64::from(f32::EPSILON), "{x}: {share}");
        }
    }

    #[test]
    fn roots_do_not_depend_on_the_exponent_but_for_its_parity() {
        // Every 997th mantissa. Half of the smallest normal numbers is not normal and may round.
        for x in two_octaves().step_by(997) {
            for power in -60..63 {
                let scale = f32::from_bits(((127 + power) as u32) << 23);
                let scaled = x * scale * scale;
                assert_eq!(inverse_sqrt(scaled) * scale, inverse_sqrt(x), "{scaled}");
                assert_eq!(sqrt(scaled), sqrt(x) * scale, "{scaled}");
            }
        }
        for x in [f32::MIN_POSITIVE, 1.5 * f32::MIN_POSITIVE, f32::MAX] {
            assert!(units(sqrt(x), f64::from(x).sqrt()) <= 2.0, "{x}");
        }
    }

    #[test]
    fn the_root_of_what_is_not_a_normal_number_is_defined() {
        assert_eq!([0.0, -0.0, 1e-40, f32::INFINITY].map(sqrt), [0.0, 0.0, 0.0, f32::INFINITY]);
        assert!(sqrt(-1.0).is_nan() && sqrt(f32::NAN).is_nan() && sqrt(f32::NEG_INFINITY).is_nan());
        for x in [0.0, -1.0, 1e-45, f32::INFINITY] {
            assert!(!inverse_sqrt(x).is_nan() || x == f32::INFINITY, "{x}");
        }
    }

    #[test]
    fn the_root_from_above_is_above_and_near() {
        let mut largest: f64 = 0.0;
        for x in two_octaves() {
            let ratio = f64::from(sqrt_from_above(x)) / f64::from(x).sqrt();
            assert!(ratio >= 1.0, "{x}");
            largest = largest.max(ratio);
        }
        assert!(largest <= f64::from(ROOT_EXCESS) && largest > 1.06, "{largest}");
        // At the ends of the range, and below the normal numbers.
        for x in [0.0, f32::from_bits(1), 1e-40, 1.175e-38, f32::MIN_POSITIVE, f32::MAX] {
            assert!(f64::from(sqrt_from_above(x)) >= f64::from(x).sqrt(), "{x}");
        }
    }

    #[test]
    fn atan2_is_within_a_rounding_of_pi() {
        let mut worst: f64 = 0.0;
        for step in -1_000_000..=1_000_000 {
            let (sine, cosine) = (f64::from(step) * core::f64::consts::PI * 1e-6).sin_cos();
            let (y, x) = ((sine * 0.3) as f32, (cosine * 0.3) as f32);
            let error = (f64::from(atan2(y, x)) - f64::from(y).atan2(f64::from(x))).abs();
            // At the cut −π and π are the same angle.
            worst = worst.max(if error > 6.0 { 0.0 } else { error });
        }
        assert!(worst <= 3e-7, "largest error {worst:e}");
        assert!(atan2(f32::NAN, 1.0).is_nan() && atan2(1.0, f32::NAN).is_nan());
        assert_eq!(
            [atan2(0.0, 0.0), atan2(0.0, -1.0), atan2(-1.0, 0.0)].map(f32::to_bits),
            [0.0, core::f32::consts::PI, -core::f32::consts::FRAC_PI_2].map(f32::to_bits)
        );
    }

    #[test]
    fn sin_cos_is_within_two_units_in_the_last_place() {
        let mut worst: f64 = 0.0;
        for step in -1_000_000..=1_000_000 {
            let x = step as f32 * 1e-4;
            let (sine, cosine) = sin_cos(x);
            let error =
                (f64::from(sine) - f64::from(x).sin()).abs().max((f64::from(cosine) - f64::from(x).cos()).abs());
            worst = worst.max(error);
        }
        assert!(worst <= 1.2e-7 + 100.0 * 1e-9, "largest error {worst:e}");
    }

    #[test]
    fn sin_cos_passes_a_nan_on() {
        assert!(sin_cos(f32::NAN).0.is_nan() && sin_cos(f32::INFINITY).1.is_nan());
    }
}
