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
/// Maximum number of steps of a run. On the patches of the figures, a run that converges needs at most 600 steps (ours,
/// from a probe near Table I) or 81 (Newton's methods). A run that still bounces at the limit counts as not converged.
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

    /// Name in tables.
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

    /// Name in figures.
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
            Self::SecondOrder => return firmware(&Controller::SecondOrder, subject, probe, start),
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

// Figure 7 in numbers: all controllers on all probes, and the probe and start that are drawn.

/// The controllers of the paper's figure, in its order, and the law of second order.
pub const DRAWN: [Contender; 4] = [
    Contender::Newton(Errors::MeasureNumbers),
    Contender::SaturatedNewton(Errors::MeasureNumbers),
    Contender::Switching,
    Contender::SecondOrder,
];

/// All controllers on all probes.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The probes.
    pub targets: Vec<Target>,
    /// A row a probe: the share of starts that find the closest point, for [`Contender::ALL`].
    pub shares: Vec<[f64; Contender::ALL.len()]>,
    /// Index of the probe that is drawn.
    pub drawn: usize,
    /// The start of the paths that are drawn.
    pub start: [f64; 2],
    /// The basins of [`DRAWN`] for that probe.
    pub basins: [Basin; DRAWN.len()],
    /// The paths of [`DRAWN`] from that start.
    pub runs: [Run; DRAWN.len()],
}

impl Comparison {
    /// Compares; there must be a probe. `progress` hears of every probe done.
    pub fn new(subject: &Subject, targets: Vec<Target>, mut progress: impl FnMut(usize, usize)) -> Self {
        let count = targets.len();
        let row = |(index, target): (usize, &Target)| {
            let shares = Contender::ALL.map(|contender| Basin::new(contender, subject, target).share());
            progress(index + 1, count);
            shares
        };
        let shares: Vec<_> = targets.iter().enumerate().map(row).collect();
        let (drawn, start) = representative(subject, &targets, &shares);
        let target = &targets[drawn];
        Self {
            basins: DRAWN.map(|contender| Basin::new(contender, subject, target)),
            runs: DRAWN.map(|contender| contender.run(subject, target.probe, start)),
            targets,
            shares,
            drawn,
            start,
        }
    }

    /// The mean and the minimum share of a controller over all probes.
    pub fn mean_and_worst(&self, contender: Contender) -> (f64, f64) {
        let index = Contender::ALL.iter().position(|other| *other == contender).unwrap_or_default();
        let shares = || self.shares.iter().map(|row| row[index]);
        (shares().sum::<f64>() / self.shares.len() as f64, shares().fold(1.0, f64::min))
    }
}

/// The probe whose basin under Newton is nearest to the mean in size, among those with a start that shows the paper's
/// argument: Newton leaves the patch, while saturation reaches the border at least twice and still converges. Among its
/// starts, the one with the fewest bounces, then the one with the fewest steps. Without such a probe, the most average
/// one and its first start from which Newton fails.
fn representative(subject: &Subject, targets: &[Target], shares: &[[f64; Contender::ALL.len()]]) -> (usize, [f64; 2]) {
    let mean = shares.iter().map(|row| row[0]).sum::<f64>() / shares.len() as f64;
    let mut order: Vec<usize> = (0..targets.len()).collect();
    order.sort_by(|a, b| (shares[*a][0] - mean).abs().total_cmp(&(shares[*b][0] - mean).abs()));
    let [newton, saturated, ..] = DRAWN;
    let fails = |index: usize, start| newton.run(subject, targets[index].probe, start).left;
    for &index in &order {
        let story = start_grid().filter(|start| fails(index, *start)).filter_map(|start| {
            let run = saturated.run(subject, targets[index].probe, start);
            let inside = start.iter().all(|parameter| *parameter > 0.0 && *parameter < 1.0);
            let tells = inside && run.border_visits() >= 2 && run.found(subject, &targets[index]);
            tells.then(|| ((run.border_visits(), run.steps()), start))
        });
        if let Some((_, start)) = story.min_by_key(|(bounces, _)| *bounces) {
            return (index, start);
        }
    }
    let index = order.first().copied().unwrap_or_default();
    (index, start_grid().find(|start| fails(index, *start)).unwrap_or_default())
}
