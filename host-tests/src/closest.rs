//! Closest points of a model with the firmware's own controller: from a few starts on every patch, or tick after tick.

use palpate::math::Vec3;
use palpate::patch::{Patch as _, SplinePatch};
use palpate::track::{Controller, Outcome, Probe, Witness};

/// Starts on each patch, along each parameter: until a locator picks one, they stand in for it.
const STARTS: [f32; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
/// Steps from one start. A far probe needs a few hundred: the certified gain falls with the distance.
const STEP_LIMIT: u32 = 1000;
/// Converged: what the controller still asks for, relative to the patch's size plus the distance. The distance is then off by less,
/// and f32 rounds the correction at a few times 1e-7 of these lengths.
const CONVERGED: f32 = 1e-6;

/// Finds closest points.
#[derive(Clone, Copy, Debug)]
pub struct Solver<'a> {
    patches: &'a [SplinePatch],
    controller: Controller,
}

/// How a closest point was come by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Cold: the controller asks for no more.
    Converged,
    /// Cold: the start that came nearest was stopped.
    StepLimit,
    /// One row of a track.
    Tracking,
}

/// A closest point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Index of the patch.
    pub patch: usize,
    /// The witness point on it.
    pub witness: Witness,
    /// Evaluations of patches spent.
    pub evaluations: u32,
    /// How.
    pub status: Status,
}

impl<'a> Solver<'a> {
    /// Over these patches, with the certified gain.
    pub const fn new(patches: &'a [SplinePatch]) -> Self {
        Self { patches, controller: Controller::CERTIFIED }
    }

    /// The nearest end of all starts on all patches; `None` without patches. `probe` in metres.
    pub fn cold(&self, probe: Vec3) -> Option<Found> {
        let mut best: Option<(f32, Found)> = None;
        let mut evaluations = 0;
        for (index, patch) in self.patches.iter().enumerate() {
            for start_u in STARTS {
                for start_v in STARTS {
                    let mut witness = Witness::at(patch, start_u, start_v);
                    let (steps, status) = self.settle(patch, &mut witness, probe);
                    evaluations += 1 + steps;
                    let distance = witness.surface.point.distance(probe);
                    if best.is_none_or(|(least, _)| distance < least) {
                        best = Some((distance, Found { patch: index, witness, evaluations, status }));
                    }
                }
            }
        }
        best.map(|(_, found)| Found { evaluations, ..found })
    }

    /// Follows a probe that has moved: `ticks` steps on the patch it was on. `probe` in metres.
    pub fn track(&self, previous: &Found, probe: Vec3, ticks: u32) -> Option<Found> {
        let patch = self.patches.get(previous.patch)?;
        let mut witness = previous.witness;
        let mut evaluations = 0;
        for _ in 0..ticks {
            // The gain is certified, not a rate: the period does not matter.
            let step = self.controller.step(patch, &mut witness, Probe::at(probe), 1.0);
            evaluations += u32::from(step.outcome != Outcome::AtRest);
        }
        Some(Found { patch: previous.patch, witness, evaluations, status: Status::Tracking })
    }

    /// Steps until the controller asks for no more; the evaluations spent.
    fn settle(&self, patch: &SplinePatch, witness: &mut Witness, probe: Vec3) -> (u32, Status) {
        for steps in 0..STEP_LIMIT {
            let step = self.controller.step(patch, witness, Probe::at(probe), 1.0);
            if step.outcome == Outcome::AtRest {
                return (steps, Status::Converged);
            }
            if step.residual() <= CONVERGED * (patch.size() + step.distance_before()) {
                return (steps + 1, Status::Converged);
            }
        }
        (STEP_LIMIT, Status::StepLimit)
    }
}
