//! The loop's own square root, sine and cosine, and arc tangent, beside those of two libraries.
//!
//! Each is behind a function that is not inlined. The call counts, and so do the few instructions that hide argument
//! and result from the compiler: the same for all.

use core::f32::consts::{PI, TAU};
use core::hint::black_box;

use micromath::F32;
use palpate::math;

use super::tally::Tally;
use crate::timer::InstructionCounter;

/// Arguments of each.
const PLACES: u16 = 200;

pub fn run(counter: &mut InstructionCounter) {
    // Squares of lengths from a tenth of a millimetre to a metre.
    let square = |share: f32| 1e-8 + share * share * share;
    let angle = |share: f32| (2.0 * share - 1.0) * PI;
    count(counter, "square root, palpate", square, math::sqrt);
    count(counter, "square root, libm", square, libm::sqrtf);
    count(counter, "square root, micromath", square, |x| F32(x).sqrt().0);
    count(counter, "sine and cosine, palpate", angle, math::sin_cos);
    count(counter, "sine and cosine, libm", angle, libm::sincosf);
    count(counter, "sine and cosine, micromath", angle, |x| F32(x).sin_cos());
    let vector = |share: f32| {
        let (sine, cosine) = math::sin_cos(share * TAU);
        (0.3 * sine, 0.3 * cosine)
    };
    count(counter, "arc tangent, palpate", vector, |(y, x)| math::atan2(y, x));
    count(counter, "arc tangent, libm", vector, |(y, x)| libm::atan2f(y, x));
    count(counter, "arc tangent, micromath", vector, |(y, x)| F32(y).atan2(F32(x)).0);
}

/// Counts a function at places all over a range. By itself: what else is in a frame would move its loop by an
/// instruction or two.
#[inline(never)]
fn count<A, R>(counter: &mut InstructionCounter, name: &str, argument: impl Fn(f32) -> A, function: impl Fn(A) -> R) {
    #[inline(never)]
    fn call<A, R>(function: &impl Fn(A) -> R, argument: A) -> R {
        function(argument)
    }

    let mut tally = Tally::new();
    for place in 0..PLACES {
        let argument = argument(f32::from(place) / f32::from(PLACES));
        // Hidden on both sides: what touches no memory could be moved out of what is counted.
        let (_, instructions) = counter.count(|| black_box(call(&function, black_box(argument))));
        tally.add(instructions);
    }
    tally.print(name);
}
