//! One step of the flow with the chosen integrator.

use super::laws::Integrator;
use crate::patch::{Patch, SurfacePoint};
use crate::track::boundary::advance;

/// The change of `(u, v)`, for a gain of 1, that the integrator makes of the flow over a step of the given gain.
///
/// `first` is the direction at the start; `direction_at` gives it elsewhere. Euler evaluates the patch no more, Heun
/// once, Runge–Kutta three times; the evaluation at the end of the step is the caller's. Every stage is cut at the
/// border, so no evaluation lies outside `[0, 1]²`.
#[inline]
pub fn change<P: Patch>(
    integrator: Integrator,
    patch: &P,
    start: [f32; 2],
    first: [f32; 2],
    gain: f32,
    direction_at: impl Fn(&SurfacePoint, [f32; 2]) -> [f32; 2],
) -> [f32; 2] {
    let stage = |direction: [f32; 2], fraction: f32| {
        let [u, v] = advance(start, direction, fraction * gain).map_or(start, |landing| landing.parameters);
        direction_at(&patch.evaluate(u, v), [u, v])
    };
    let mean = |sum: [f32; 2], weight: f32| [sum[0] * weight, sum[1] * weight];
    match integrator {
        Integrator::Euler => first,
        Integrator::Heun => {
            let second = stage(first, 1.0);
            mean([first[0] + second[0], first[1] + second[1]], 0.5)
        }
        Integrator::RungeKutta4 => {
            let second = stage(first, 0.5);
            let third = stage(second, 0.5);
            let fourth = stage(third, 1.0);
            let sum = |axis: usize| first[axis] + 2.0 * (second[axis] + third[axis]) + fourth[axis];
            mean([sum(0), sum(1)], 1.0 / 6.0)
        }
    }
}
