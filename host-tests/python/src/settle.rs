//! A controller on one patch, from many starts: what Figure 7 asks.

use crate::refusal::Refusal;
use crate::tracker::law;
use glam::DVec3;
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::track::{Controller, Outcome, Probe, Witness};
use palpate_bake::NurbsPatch;
use palpate_truth::baselines::{Advance, Baseline, Errors, Method};
use palpate_truth::oracle::{Oracle, OraclePoint};

/// Steps in a row without progress after which a witness point rests.
const RESTS: u32 = 8;
/// The period of a step, s. It matters to no law here: both take the gain that is certified.
const PERIOD: f32 = 1e-3;

/// Parameters at the end, steps, whether it rests, and steps and evaluations until it is at the closest point; a row a
/// start.
pub type Ends = (Vec<[f32; 2]>, Vec<u32>, Vec<bool>, Vec<f64>, Vec<f64>);

/// The closest point of a face, in double precision.
pub struct Target<'a> {
    patch: &'a NurbsPatch,
    closest: DVec3,
    tolerance: f64,
}

impl<'a> Target<'a> {
    /// Of a probe; `tolerance` in metres.
    pub fn new(patch: &'a NurbsPatch, probe: DVec3, tolerance: f64) -> Self {
        Self { patch, closest: Oracle::new(patch).closest(probe).point, tolerance }
    }

    /// After how many steps a run is at it and stays: `arrived` is the answer before this step.
    fn arrival(&self, arrived: f64, steps: u32, [u, v]: [f64; 2]) -> f64 {
        let is_near = OraclePoint::evaluate(self.patch, u, v).point.distance(self.closest) <= self.tolerance;
        match (is_near, arrived.is_nan()) {
            (false, _) => f64::NAN,
            (true, true) => f64::from(steps),
            (true, false) => arrived,
        }
    }
}

/// Where each start ends, after how many steps, whether it rests there, and when it arrived; `most` steps at most.
pub fn settle(
    patch: &SplinePatch<'_>,
    controller: &Controller,
    probe: Vec3,
    starts: &[[f64; 2]],
    most: u32,
    target: &Target<'_>,
) -> Ends {
    let end = |[u, v]: &[f64; 2]| {
        let mut at = Witness::at(patch, *u as f32, *v as f32);
        let (mut steps, mut still) = (0, 0);
        let mut arrived = target.arrival(f64::NAN, steps, at.parameters.map(f64::from));
        while steps < most && still < RESTS {
            let before = at.parameters;
            let step = controller.step(patch, &mut at, Probe::at(probe), PERIOD);
            steps += 1;
            arrived = target.arrival(arrived, steps, at.parameters.map(f64::from));
            still = if step.outcome == Outcome::AtRest || before == at.parameters { still + 1 } else { 0 };
        }
        // A step evaluates the face once.
        (at.parameters, steps - still, still == RESTS, arrived, arrived)
    };
    starts.iter().map(end).collect()
}

/// A law on one face: one of the firmware's controllers, or a method in double precision to compare them with.
pub enum Law {
    /// The firmware's, or the paper's.
    Controller(Controller),
    /// Newton's method or the projected gradient.
    Baseline(Method),
}

impl Law {
    /// By its name.
    ///
    /// # Errors
    /// That there is none.
    pub fn named(name: &str) -> Result<Self, Refusal> {
        Ok(match name {
            "newton" => Self::Baseline(Method::Newton),
            "saturated-newton" => Self::Baseline(Method::SaturatedNewton),
            "projected-newton" => Self::Baseline(Method::ProjectedNewton),
            "projected-gradient" => Self::Baseline(Method::ProjectedGradient),
            "second-order" | "certified" => Self::Controller(law(name)?),
            _ => {
                let says = "there are \"second-order\", \"certified\", \"newton\", \"saturated-newton\", \
                            \"projected-newton\" and \"projected-gradient\"";
                return Err(Refusal::Settings(format!("there is no law {name:?}; {says}")));
            }
        })
    }
}

/// Where a baseline ends from each start, likewise, with its steps up to the last that single precision shows; not a
/// number where it left the patch.
pub fn settle_baseline(method: Method, probe: DVec3, starts: &[[f64; 2]], most: u32, target: &Target<'_>) -> Ends {
    let baseline = Baseline::new(target.patch, method, Errors::Covariant);
    let end = |start: &[f64; 2]| {
        let (mut at, mut steps) = (start.map(|parameter| parameter.clamp(0.0, 1.0)), 0);
        let mut still = 0;
        let mut arrived = target.arrival(f64::NAN, steps, at);
        let (mut spent, mut spent_until, mut is_stuck) = (0, 0, false);
        // In double precision eight small steps may be on the way: it goes on to the end.
        while steps < most {
            let (advance, evaluations) = baseline.counted_step(at, probe);
            spent += evaluations;
            match advance {
                // What single precision does not show is no progress here, as for the firmware's laws.
                Advance::To(next) => {
                    let is_still = next.map(|parameter| parameter as f32) == at.map(|parameter| parameter as f32);
                    still = if is_still { still + 1 } else { 0 };
                    at = next;
                }
                Advance::Out(_) => return ([f32::NAN; 2], steps, false, f64::NAN, f64::NAN),
                Advance::Nowhere => {
                    is_stuck = true;
                    break;
                }
            }
            steps += 1;
            let before = arrived;
            arrived = target.arrival(arrived, steps, at);
            if before.is_nan() {
                spent_until = spent;
            }
        }
        let evaluations = if arrived.is_nan() { f64::NAN } else { f64::from(spent_until) };
        (at.map(|parameter| parameter as f32), steps - still, still >= RESTS || is_stuck, arrived, evaluations)
    };
    starts.iter().map(end).collect()
}
