//! A controller on one patch, from many starts: what Figure 7 asks.

use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::track::{Controller, Outcome, Probe, Witness};

/// Steps in a row without progress after which a witness point rests.
const RESTS: u32 = 8;
/// The period of a step, s. It matters to no law here: both take the gain that is certified.
const PERIOD: f32 = 1e-3;

/// Where each start ends, and after how many steps; `most` of them at most.
pub fn settle(
    patch: &SplinePatch<'_>,
    controller: &Controller,
    probe: Vec3,
    starts: &[[f64; 2]],
    most: u32,
) -> (Vec<[f32; 2]>, Vec<u32>) {
    let end = |[u, v]: &[f64; 2]| {
        let mut at = Witness::at(patch, *u as f32, *v as f32);
        let (mut steps, mut still) = (0, 0);
        while steps < most && still < RESTS {
            let before = at.parameters;
            let step = controller.step(patch, &mut at, Probe::at(probe), PERIOD);
            steps += 1;
            still = if step.outcome == Outcome::AtRest || before == at.parameters { still + 1 } else { 0 };
        }
        (at.parameters, steps - still)
    };
    starts.iter().map(end).unzip()
}
