//! Figure 7: from where each controller finds the closest point.

use super::subject::Subject;
use glam::DVec3;
use palpate::math::Vec3;
use palpate::patch::Patch as _;
use palpate::track::{Controller, FirstOrder, Outcome, Probe, Witness};
use palpate_truth::baselines::{Advance, Baseline, Errors, Method};
use palpate_truth::oracle::ClosestPoint;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

/// Starts along each parameter, borders included.
pub const STARTS: usize = 21;
/// A run has found the closest point if it ends this near to it, relative to the patch's size. On both patches at hand
/// the runs leave a wide gap: Newton's end within 3e-8 of it, ours within 2e-6 (roundings of `f32`), and all others
/// beyond 5e-2 or outside.
pub const TOLERANCE: f64 = 1e-4;
/// Steps a run may take. What arrives on the patches at hand needs 600 at most (ours, from a probe near to Table I),
/// Newton's methods 81: those that still bounce about after so many are counted as lost.
const STEP_LIMIT: usize = 1_000;

/// A controller of the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contender {
    /// The paper's Newton-based controller, on these errors.
    Newton(Errors),
    /// The same with saturation at the borders.
    SaturatedNewton(Errors),
    /// Textbook projected Newton; not in the paper.
    ProjectedNewton,
    /// The paper's controller as the firmware has it, in `f32`, at the certified gain.
    Switching,
    /// The firmware's default, of second order.
    SecondOrder,
}

impl Contender {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Newton(Errors::MeasureNumbers),
        Self::SaturatedNewton(Errors::MeasureNumbers),
        Self::Newton(Errors::Covariant),
        Self::SaturatedNewton(Errors::Covariant),
        Self::ProjectedNewton,
        Self::Switching,
        Self::SecondOrder,
    ];

    /// What tables call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Newton(Errors::MeasureNumbers) => "newton",
            Self::SaturatedNewton(Errors::MeasureNumbers) => "newton-saturated",
            Self::Newton(Errors::Covariant) => "newton-covariant",
            Self::SaturatedNewton(Errors::Covariant) => "newton-covariant-saturated",
            Self::ProjectedNewton => "newton-projected",
            Self::Switching => "switching",
            Self::SecondOrder => "second-order",
        }
    }

    /// What figures call it.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Newton(_) => "Newton",
            Self::SaturatedNewton(_) => "Newton with saturation",
            Self::ProjectedNewton => "projected Newton",
            Self::Switching => "switching controller",
            Self::SecondOrder => "second-order law",
        }
    }

    /// Runs from a start until it rests, leaves the patch or has made 1000 steps.
    pub fn run(self, subject: &Subject, probe: Vec3, start: [f64; 2]) -> Run {
        let (method, errors) = match self {
            Self::Switching => return firmware(&Controller::FirstOrder(FirstOrder::CERTIFIED), subject, probe, start),
            Self::SecondOrder => return firmware(&Controller::SECOND_ORDER, subject, probe, start),
            Self::Newton(errors) => (Method::Newton, errors),
            Self::SaturatedNewton(errors) => (Method::SaturatedNewton, errors),
            Self::ProjectedNewton => (Method::ProjectedNewton, Errors::Covariant),
        };
        newton(&Baseline::new(&subject.surface, method, errors), probe.as_dvec3(), start)
    }
}

/// A probe and its closest point.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// `Q`, metres.
    pub probe: Vec3,
    /// `P*`.
    pub closest: ClosestPoint,
}

/// The way from one start.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// `(u, v)` of every step, from the start; the last may lie outside the square if it left.
    pub path: Vec<[f64; 2]>,
    /// Whether it ended outside the patch.
    pub left: bool,
}

impl Run {
    /// The last parameters.
    pub fn end(&self) -> [f64; 2] {
        self.path.last().copied().unwrap_or_default()
    }

    /// Steps made.
    pub fn steps(&self) -> usize {
        self.path.len() - 1
    }

    /// Whether it ended at the closest point.
    pub fn found(&self, subject: &Subject, target: &Target) -> bool {
        !self.left && self.error(subject, target) <= TOLERANCE
    }

    /// How far from the closest point it ended, relative to the patch's size; it must not have left.
    pub fn error(&self, subject: &Subject, target: &Target) -> f64 {
        subject.at(self.end()).0.point.distance(target.closest.point) / subject.size
    }

    /// How often it came to the border from the inside.
    pub fn border_visits(&self) -> usize {
        let at_border = |at: &[f64; 2]| at.iter().any(|parameter| *parameter <= 0.0 || *parameter >= 1.0);
        self.path.windows(2).filter(|pair| !at_border(&pair[0]) && at_border(&pair[1])).count()
    }
}

fn newton(baseline: &Baseline<'_>, probe: DVec3, start: [f64; 2]) -> Run {
    let mut path = vec![start];
    let mut at = start;
    for _ in 0..STEP_LIMIT {
        match baseline.step(at, probe) {
            Advance::To(next) => {
                path.push(next);
                // The last bits of a double may go back and forth for ever.
                let is_still = (0..2).all(|i| (next[i] - at[i]).abs() < 1e-14);
                at = next;
                if is_still {
                    break;
                }
            }
            Advance::Out(next) => {
                path.push(next);
                return Run { path, left: true };
            }
            Advance::Nowhere => break,
        }
    }
    Run { path, left: false }
}

fn firmware(controller: &Controller, subject: &Subject, probe: Vec3, start: [f64; 2]) -> Run {
    let patch = &subject.patch;
    let mut witness = Witness::at(patch, start[0] as f32, start[1] as f32);
    let mut path = vec![witness.parameters.map(f64::from)];
    for _ in 0..STEP_LIMIT {
        // The gain is certified, not a rate: the period does not matter.
        let step = controller.step(patch, &mut witness, Probe::at(probe), 1.0);
        if step.outcome == Outcome::AtRest {
            break;
        }
        path.push(witness.parameters.map(f64::from));
        // It asks for less than f32 can place on this patch.
        if step.residual() < 4.0 * f32::EPSILON * (patch.size() + step.distance_before()) {
            break;
        }
    }
    Run { path, left: false }
}

/// Which starts of the grid find the closest point.
#[derive(Clone, Debug, PartialEq)]
pub struct Basin {
    /// Start `(i, j)`, at `(i, j) / (STARTS − 1)`, is entry `i · STARTS + j`: found, and the steps it took.
    pub starts: Vec<(bool, usize)>,
}

impl Basin {
    /// Runs from every start of the grid.
    pub fn new(contender: Contender, subject: &Subject, target: &Target) -> Self {
        let one = |start| {
            let run = contender.run(subject, target.probe, start);
            (run.found(subject, target), run.steps())
        };
        Self { starts: start_grid().map(one).collect() }
    }

    /// The share of starts that find the closest point, 0 to 1.
    pub fn share(&self) -> f64 {
        self.starts.iter().filter(|(found, _)| *found).count() as f64 / self.starts.len() as f64
    }
}

/// The starts, in the order of [`Basin::starts`].
pub fn start_grid() -> impl Iterator<Item = [f64; 2]> {
    let grid = |index: usize| index as f64 / (STARTS - 1) as f64;
    (0..STARTS).flat_map(move |i| (0..STARTS).map(move |j| [grid(i), grid(j)]))
}

/// Probes that Theorem 1 covers: straight out from feet spread over the inside of the patch, their
/// distances in sizes of the patch spread over `distances`. Where another
/// point of the patch is nearer than the foot, the probe is drawn again.
pub fn seeded_targets(subject: &Subject, count: usize, distances: [f64; 2], seed: u64) -> Vec<Target> {
    let [nearest, farthest] = distances;
    let oracle = subject.oracle();
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut targets = Vec::with_capacity(count);
    // Bounded, for a patch that has hardly a covered probe.
    for _ in 0..100 * count {
        if targets.len() == count {
            break;
        }
        let foot = [random.random_range(0.02..0.98), random.random_range(0.02..0.98)];
        let distance = subject.size * (nearest + (farthest - nearest) * random.random_range(0.0..1.0));
        targets.extend(subject.probe_over(&oracle, foot, distance).map(|(probe, closest)| Target { probe, closest }));
    }
    targets
}
