//! The loop's own square root, sine and cosine, and arc tangent beside `libm` and `micromath`: the table in
//! `docs/reference/measured.md`.
//!
//! Errors are of a dense sweep on the host, where the same single-precision code gives the same bits; instructions are
//! the Cortex-M4F's budget, counted in the emulator.

use crate::pages::{compare, text};
use micromath::F32;
use palpate::math;
use palpate_tool::budgets::Budget;
use palpate_tool::firmware::Board;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

const PAGE: &str = "docs/reference/measured.md";
const HEADER: &str =
    "| function | library | largest error | instructions, median | instructions, worst |\n|---|---|---|---|---|\n";
const STEPS: i32 = 1_000_000;

/// Relative: over two octaves, which repeat. Every 7th mantissa.
fn of_root(root: impl Fn(f32) -> f32) -> f64 {
    let mantissas = (1.0_f32.to_bits()..4.0_f32.to_bits()).step_by(7).map(f32::from_bits);
    mantissas.map(|x| (f64::from(root(x)) / f64::from(x).sqrt() - 1.0).abs()).fold(0.0, f64::max)
}

/// Absolute: over a turn either way, farther than a joint goes.
fn of_sine(sin_cos: impl Fn(f32) -> (f32, f32)) -> f64 {
    let error = |step: i32| {
        let x = (f64::from(step) / f64::from(STEPS) * TAU) as f32;
        let ((sine, cosine), (true_sine, true_cosine)) = (sin_cos(x), f64::from(x).sin_cos());
        (f64::from(sine) - true_sine).abs().max((f64::from(cosine) - true_cosine).abs())
    };
    (-STEPS..=STEPS).map(error).fold(0.0, f64::max)
}

fn micromath_sine(x: f32) -> (f32, f32) {
    let (sine, cosine) = F32(x).sin_cos();
    (sine.0, cosine.0)
}

/// Radians: around the circle. At the cut −π and π are one angle.
fn of_arc(atan2: impl Fn(f32, f32) -> f32) -> f64 {
    let error = |step: i32| {
        let (sine, cosine) = (f64::from(step) / f64::from(STEPS) * PI).sin_cos();
        let (y, x) = ((0.3 * sine) as f32, (0.3 * cosine) as f32);
        let off = (f64::from(atan2(y, x)) - f64::from(y).atan2(f64::from(x))).abs();
        off.min((TAU - off).abs())
    };
    (-STEPS..=STEPS).map(error).fold(0.0, f64::max)
}

#[test]
fn own_functions_beside_two_libraries() {
    let rows = [
        ("square root", "palpate", of_root(math::sqrt)),
        ("square root", "libm", of_root(libm::sqrtf)),
        ("square root", "micromath", of_root(|x| F32(x).sqrt().0)),
        ("sine and cosine", "palpate", of_sine(math::sin_cos)),
        ("sine and cosine", "libm", of_sine(libm::sincosf)),
        ("sine and cosine", "micromath", of_sine(micromath_sine)),
        ("arc tangent", "palpate", of_arc(math::atan2)),
        ("arc tangent", "libm", of_arc(libm::atan2f)),
        ("arc tangent", "micromath", of_arc(|y, x| F32(y).atan2(F32(x)).0)),
    ];
    let budget = Budget::load(Board::M4).expect("a budget");
    let mut table = HEADER.to_owned();
    for (function, library, error) in rows {
        let name = format!("{function}, {library}");
        let [median, worst] = ["median", "worst"].map(|which| {
            let figure = format!("{name}, {which}");
            budget.of(&figure).unwrap_or_else(|| panic!("no budget of {figure:?}"))
        });
        let _ = writeln!(table, "| {function} | {library} | {error:.1e} | {median} | {worst} |");
    }
    print!("{table}");
    let page = text(PAGE);
    let (before, rest) = page.split_once(HEADER).expect("the table");
    let after = rest.find("\n\n").map_or("", |end| &rest[end + 1..]);
    compare(PAGE, &format!("{before}{table}{after}"));
}
