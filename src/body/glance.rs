//! Whether a candidate is farther than a distance, without an evaluation: most of a long list need no more.
//!
//! A polynomial of one span has its value and first derivatives at the span's centre among its coefficients, and the
//! table bounds the second derivatives: with Taylor's remainder the patch comes no nearer over a rectangle.

use super::locator::Candidate;
use crate::math::Vec3;
use crate::patch::{Coefficients, Patch as _, SplinePatch};

/// Middle of a patch of one span.
const CENTRE: f32 = 0.5;

/// Whether all of a candidate's rectangle is proved to be farther from the probe than a distance, metres.
#[inline(always)]
pub(super) fn is_farther(patch: &SplinePatch<'_>, candidate: &Candidate, probe: Vec3, distance: f32) -> bool {
    let Coefficients::Polynomial(coefficients) = patch.coefficients() else { return false };
    let [breaks_u, breaks_v] = patch.breaks();
    let row = usize::from(patch.degree()[1]) + 1;
    let (Some(value), Some(along_v), Some(along_u)) =
        (coefficients.first(), coefficients.get(1), coefficients.get(row))
    else {
        return false;
    };
    if breaks_u.len() + breaks_v.len() != 4 {
        return false;
    }
    let away = Vec3::from_array(*value) - probe;
    let slopes = [away.dot(Vec3::from_array(*along_u)), away.dot(Vec3::from_array(*along_v))];
    let [lower, upper] = candidate.rectangle().map(|corner| corner.map(|parameter| parameter - CENTRE));
    let most = |axis: usize| if -lower[axis] > upper[axis] { -lower[axis] } else { upper[axis] };
    let fall = |axis: usize| slopes[axis] * if slopes[axis] > 0.0 { lower[axis] } else { upper[axis] };
    let second = patch.shape().second_derivatives;
    let (x, y) = (most(0), most(1));
    let beyond = distance + 0.5 * (second.uu * x * x + 2.0 * second.uv * x * y + second.vv * y * y);
    // In the direction of the centre, times its distance.
    let squared = away.length_squared();
    let least = squared + fall(0) + fall(1);
    least > 0.0 && least * least > beyond * beyond * squared
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Aligned, Body, BodyBuffer, Edge, Face, GRID, TickLimit};
    use crate::math::vec3;

    static BOX: &Aligned<[u8]> = &Aligned(*include_bytes!("../../boards/bodies/capped_box.palp"));

    /// Against points of the rectangle; that it says something, too.
    #[test]
    fn no_point_of_a_rectangle_is_nearer_than_what_it_is_farther_than() {
        let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
        let buffer = BodyBuffer { faces: &mut faces, edges: &mut edges };
        let body = Body::from_bytes_with(&BOX.0, buffer, TickLimit::NONE, &mut || ()).unwrap();
        let mut state = 1_u32;
        let mut below = |most: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % (most + 1)
        };
        let mut tight = 0;
        for _ in 0..2_000 {
            let face = below(5) as u16;
            let [a, b, c, d] = [(); 4].map(|()| below(GRID) as u8);
            let (lower, upper) = ([a.min(b), c.min(d)], [a.max(b), c.max(d)]);
            let candidate = Candidate { face, lower, upper, convex: false, more: false };
            let reach = |step: u32| (step as f32 / 500.0 - 1.0) * 1.5 * body.size();
            let probe = vec3(reach(below(1_000)), reach(below(1_000)), reach(below(1_000)));
            let patch = &body.faces()[usize::from(face)].patch;
            let [low, high] = candidate.rectangle();
            let mut squared = f32::INFINITY;
            for step in 0..81_u8 {
                let at = |axis: usize, step: u8| low[axis] + (high[axis] - low[axis]) * f32::from(step) / 8.0;
                let point = patch.evaluate(at(0, step / 9), at(1, step % 9)).point;
                squared = squared.min((point - probe).length_squared());
            }
            let nearest = squared.sqrt();
            // Rounding of single precision.
            assert!(!is_farther(patch, &candidate, probe, nearest * (1.0 + 1e-5)), "{candidate:?} {probe:?}");
            tight += u32::from(is_farther(patch, &candidate, probe, 0.8 * nearest));
        }
        assert!(tight > 500, "{tight}");
    }
}
