//! Figure 8: following a moving probe with a good gain, one too high and one too low; and the limit of the gain.

use super::page::{THICK, THIN, scene, view_across};
use super::subject::Subject;
use crate::plot::{Area, Axes, Axis, FIGURE, Ink, Key, Mark, Svg, draw};
use anyhow::bail;
use glam::DVec3;
use palpate::math::Vec3;
use palpate::track::{Controller, FirstOrder, Gain, Integrator, Probe, ProjectionErrors, Witness};
use palpate_truth::baselines::ErrorKinematics;
use palpate_truth::oracle::Oracle;

/// The paper's step, s.
pub const PERIOD: f64 = 1e-3;
/// The paper's gains, 1/s: good, chattering, slow.
pub const GAINS: [f64; 3] = [50.0, 1300.0, 0.02];
/// The gain at which the paper's simulation becomes unstable, 1/s.
pub const PAPER_LIMIT: f64 = 1250.0;
/// The probe moves for so long and then rests, s: 25 time constants `1/K` at `K = 50`.
pub const MOTION: f64 = 0.5;
/// Where the probe's foot sets out and where the witness point is put, in parameters from where the probe comes to
/// rest: far from each other and from the goal, so that the correction of the start and the tracking show.
const SETS_OUT: [f64; 2] = [-0.3, -0.35];
const START: [f64; 2] = [0.3, -0.4];

/// Where the probe comes to rest: there the discretisation limit of Euler's method is the paper's.
#[derive(Clone, Copy, Debug)]
pub struct Configuration {
    /// The foot of the probe, `(u, v)`.
    pub foot: [f64; 2],
    /// The largest principal curvature there, seen from the probe, 1/m.
    pub curvature: f64,
    /// `‖ΔR‖`, metres.
    pub distance: f64,
    /// `Q`, metres.
    pub probe: Vec3,
}

impl Configuration {
    /// The distance at which `2 / (h (1 + κ ‖ΔR‖))` is the paper's 1250 1/s, so `κ ‖ΔR‖ = 0.6`, over the centre of a
    /// cell of the patch (inner knots, where the curvature may jump, lie on the cells' borders): the one nearest to the
    /// middle where the patch is convex and the foot is the closest point. `None` if there is no such place.
    pub fn find(subject: &Subject, oracle: &Oracle<'_>) -> Option<Self> {
        let borders = [palpate_bake::Axis::U, palpate_bake::Axis::V].map(|axis| subject.surface.borders(axis));
        let centres = |axis: usize| borders[axis].windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect::<Vec<_>>();
        let mut feet: Vec<_> = centres(0).iter().flat_map(|u| centres(1).into_iter().map(|v| [*u, v])).collect();
        let from_middle = |foot: &[f64; 2]| foot.iter().map(|parameter| (parameter - 0.5).powi(2)).sum::<f64>();
        feet.sort_by(|a, b| from_middle(a).total_cmp(&from_middle(b)));
        feet.into_iter().find_map(|foot| Self::over(subject, oracle, foot, 2.0 / (PERIOD * PAPER_LIMIT) - 1.0))
    }

    /// A probe over a foot with a given `κ ‖ΔR‖`; `None` where the patch is not convex or another point is nearer.
    pub fn over(subject: &Subject, oracle: &Oracle<'_>, foot: [f64; 2], product: f64) -> Option<Self> {
        let (surface, normal) = subject.at(foot);
        // Seen from one metre out, the eigenvalues of M are 1 + κ.
        let kinematics = ErrorKinematics::measure_numbers(&surface, surface.point + normal)?;
        let [greatest, _] = kinematics.eigenvalues()?;
        let curvature = greatest - 1.0;
        // A radius of a hundred sizes is a plane.
        if curvature * subject.size < 0.01 {
            return None;
        }
        let distance = product / curvature;
        let (probe, _) = subject.probe_over(oracle, foot, distance)?;
        Some(Self { foot, curvature, distance, probe })
    }

    /// The maximum stable gain, 1/s: `z / (h (1 + κ ‖ΔR‖))`.
    pub fn predicted_limit(&self, integrator: Integrator) -> f64 {
        f64::from(integrator.stability_bound()) / (PERIOD * (1.0 + self.curvature * self.distance))
    }

    /// The maximum stable gain, 1/s, by bisection: a small error of the witness point along the worst direction shrinks
    /// below this gain and grows above it.
    ///
    /// # Errors
    /// If the limit is far from the prediction.
    pub fn measured_limit(&self, subject: &Subject, integrator: Integrator) -> anyhow::Result<f64> {
        let predicted = self.predicted_limit(integrator);
        let (mut stable, mut unstable) = (0.5 * predicted, 1.5 * predicted);
        if self.growth(subject, integrator, stable) >= 1.0 || self.growth(subject, integrator, unstable) <= 1.0 {
            bail!("the limit of stability is not within half of the predicted {predicted:.0} 1/s");
        }
        // To 1e-4 of the gain.
        while unstable - stable > 1e-4 * predicted {
            let middle = 0.5 * (stable + unstable);
            if self.growth(subject, integrator, middle) > 1.0 { unstable = middle } else { stable = middle }
        }
        Ok(0.5 * (stable + unstable))
    }

    /// By how much the error grows over a run of the firmware's controller at a fixed gain.
    fn growth(&self, subject: &Subject, integrator: Integrator, gain: f64) -> f64 {
        // A thousand times the rounding of f32, and so small that the linear theory holds: beyond the limit the chatter
        // settles at an amplitude that grows from zero, and must be above this.
        const OFFSET: f64 = 1e-4;
        // 1/1000 beyond the limit is a factor of 1.002^1000 = 7; the share of the offset along the worst direction
        // matters less.
        const STEPS: usize = 1_000;
        let controller =
            Controller::FirstOrder(FirstOrder::CERTIFIED.gain(Gain::Unlimited(gain as f32)).integrator(integrator));
        let patch = &subject.patch;
        let start = self.foot.map(|parameter| (parameter + OFFSET) as f32);
        let mut witness = Witness::at(patch, start[0], start[1]);
        let error = |witness: &Witness| {
            let psi =
                ProjectionErrors::new(&witness.surface, self.probe).measure_numbers().unwrap_or([f32::INFINITY; 2]);
            f64::from(psi[0]).hypot(f64::from(psi[1]))
        };
        let before = error(&witness);
        for _ in 0..STEPS {
            controller.step(patch, &mut witness, Probe::at(self.probe), PERIOD as f32);
        }
        error(&witness) / before
    }
}

/// A tick of the tracking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// s.
    pub time: f64,
    /// `Q`, metres.
    pub probe: DVec3,
    /// `P`, metres.
    pub witness: DVec3,
    /// `(u, v)`.
    pub parameters: [f64; 2],
    /// `Ψᵘ, Ψᵛ`.
    pub errors: [f64; 2],
    /// `‖Ψ‖` once the tick has corrected it.
    pub left: f64,
}

/// The runs of the figure, one for each of [`GAINS`]: the slow one until it has converged too.
pub fn runs(subject: &Subject, rest: &Configuration) -> [Vec<Sample>; 3] {
    let [good, chatter, slow] = GAINS;
    // Four time constants of the slow gain.
    [(good, 0.7), (chatter, 0.7), (slow, 200.0)].map(|(gain, seconds)| {
        track(subject, rest, &Controller::FirstOrder(FirstOrder::CERTIFIED.gain(Gain::Unlimited(gain as f32))), seconds)
    })
}

/// The same run with what the firmware offers instead of a gain: the paper's law at the certified one, and the law of
/// second order.
pub fn certified_runs(subject: &Subject, rest: &Configuration) -> [Vec<Sample>; 2] {
    [Controller::FirstOrder(FirstOrder::CERTIFIED), Controller::SecondOrder]
        .map(|controller| track(subject, rest, &controller, 0.7))
}

/// Follows the moving probe for `seconds`, even if the witness point is lost.
fn track(subject: &Subject, rest: &Configuration, controller: &Controller, seconds: f64) -> Vec<Sample> {
    let patch = &subject.patch;
    let start = [0, 1].map(|i| (rest.foot[i] + START[i]) as f32);
    let mut witness = Witness::at(patch, start[0], start[1]);
    let steps = (seconds / PERIOD).round() as usize;
    (0..=steps)
        .map(|step| {
            let time = step as f64 * PERIOD;
            let probe = probe_at(subject, rest, time);
            let before = witness;
            controller.step(patch, &mut witness, Probe::at(probe), PERIOD as f32);
            let errors = |witness: &Witness| {
                let psi = ProjectionErrors::new(&witness.surface, probe).measure_numbers();
                psi.unwrap_or_default().map(f64::from)
            };
            let left = errors(&witness);
            Sample {
                time,
                probe: probe.as_dvec3(),
                witness: before.surface.point.as_dvec3(),
                parameters: before.parameters.map(f64::from),
                errors: errors(&before),
                left: left[0].hypot(left[1]),
            }
        })
        .collect()
}

/// The probe keeps its distance; its foot goes to the rest in a straight line of parameters, and stops smoothly.
fn probe_at(subject: &Subject, rest: &Configuration, time: f64) -> Vec3 {
    let fraction = (time / MOTION).min(1.0);
    let left = 1.0 - fraction * fraction * (3.0 - 2.0 * fraction);
    if left == 0.0 {
        return rest.probe;
    }
    let foot = [0, 1].map(|i| (rest.foot[i] + left * SETS_OUT[i]).clamp(0.0, 1.0));
    let (surface, normal) = subject.at(foot);
    (surface.point + normal * rest.distance).as_vec3()
}

/// A point of the sweep over distances.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// The integrator.
    pub integrator: Integrator,
    /// `κ ‖ΔR‖`.
    pub product: f64,
    /// 1/s.
    pub predicted: f64,
    /// 1/s.
    pub measured: f64,
}

/// Measures the limits of all integrators over distances from the foot where the probe of the figure rests.
///
/// # Errors
/// A limit that is nowhere near the prediction.
pub fn limits(subject: &Subject, oracle: &Oracle<'_>, rest: &Configuration) -> anyhow::Result<Vec<Limit>> {
    let mut limits = Vec::new();
    for integrator in [Integrator::Euler, Integrator::Heun, Integrator::RungeKutta4] {
        for step in 1..=12 {
            let product = f64::from(step) * 0.2;
            let Some(configuration) = Configuration::over(subject, oracle, rest.foot, product) else { continue };
            limits.push(Limit {
                integrator,
                product,
                predicted: configuration.predicted_limit(integrator),
                measured: configuration.measured_limit(subject, integrator)?,
            });
        }
    }
    Ok(limits)
}

// Figure 8 as the paper draws it, and the limits of stability beside their predictions.

/// Ticks between the snapshots of panel (A): with `K = 50` and a step of 1 ms the correction of the start shows in the
/// first few.
const SNAPSHOT: usize = 12;

/// The figure, as SVG text: runs at the good, the chattering and the slow gain, and those without a gain to choose.
pub fn draw_tracking(subject: &Subject, runs: &[Vec<Sample>; 3], certified: &[Vec<Sample>; 2]) -> String {
    draw(FIGURE, 1_600.0, |svg, area| {
        let panels = area.split(5, 1);
        path(svg, panels[0], subject, &runs[0]);
        errors(svg, panels[1], "(B) K = 50 1/s", &runs[0]);
        errors(svg, panels[2], "(C) K = 1300 1/s: chatter", &runs[1]);
        errors(svg, panels[3], "(D) K = 0.02 1/s: slow", &runs[2]);
        lags(svg, panels[4], [&runs[0], &certified[0], &certified[1]]);
    })
}

/// Smallest error that is drawn: about the resolution of single precision.
const LEAST: f64 = 1e-8;

fn lags(svg: &mut Svg, area: Area, runs: [&Vec<Sample>; 3]) {
    let end = runs[0].last().map_or(1.0, |sample| sample.time);
    let laws = [
        ("the paper's law, K = 50 1/s", Ink::Red),
        ("the paper's law, certified gain", Ink::Green),
        ("second order", Ink::Blue),
    ];
    let keys = laws.map(|(name, ink)| (name, ink, Mark::Line));
    let (x, y) = (Axis::linear("time, s", [0.0, end]), Axis::log("‖Ψ‖", [LEAST, 1.0]));
    let mut chart = Axes { title: "(E) what a tick leaves", x, y, keys: &keys }.on(svg, area);
    for (run, (_, ink)) in runs.into_iter().zip(laws) {
        chart.line(ink, THIN + 0.5, run.iter().map(|sample| (sample.time, sample.left.max(LEAST))));
    }
}

fn path(svg: &mut Svg, area: Area, subject: &Subject, run: &[Sample]) {
    // The start is on its own way; after it the lines show how far the witness point lags.
    let lines: Vec<_> =
        run.iter().skip(100).step_by(SNAPSHOT).map(|sample| (sample.parameters, sample.probe)).collect();
    let view = view_across(subject, &lines);
    let probes: Vec<_> = run.iter().map(|sample| sample.probe).collect();
    let keys = [("probe", Ink::Red, Mark::Line), ("witness point", Ink::Blue, Mark::Line)];
    let mut chart = scene(svg, area, ("(A) tracking, K = 50 1/s", &keys), subject, &view, &probes);
    let lines = run.iter().step_by(SNAPSHOT);
    chart.lines(Ink::Grey, THIN, lines.map(|sample| vec![view.seen(sample.witness), view.seen(sample.probe)]));
    chart.line(Ink::Red, THICK, run.iter().map(|sample| view.seen(sample.probe)));
    chart.line(Ink::Blue, THICK, run.iter().map(|sample| view.seen(sample.witness)));
    chart.dots(Ink::Blue, 2.5, run.iter().step_by(SNAPSHOT).map(|sample| view.seen(sample.witness)));
    if let [first, ..] = run {
        chart.dot(view.seen(first.witness), "P₀", Ink::Blue, (7.0, 9.0));
        chart.dot(view.seen(first.probe), "Q", Ink::Red, (-17.0, -10.0));
    }
}

fn errors(svg: &mut Svg, area: Area, title: &str, run: &[Sample]) {
    let end = run.last().map_or(1.0, |sample| sample.time);
    let lines = [(0, "Ψᵘ", Ink::Blue), (1, "Ψᵛ", Ink::Red)];
    let keys = lines.map(|(_, name, ink)| (name, ink, Mark::Line));
    let (x, y) = (Axis::linear("time, s", [0.0, end]), Axis::linear("Ψ / max |Ψ|", [-1.1, 1.1]));
    let mut chart = Axes { title, x, y, keys: &keys }.on(svg, area);
    for (axis, _, ink) in lines {
        let peak = run.iter().map(|sample| sample.errors[axis].abs()).fold(f64::MIN_POSITIVE, f64::max);
        chart.line(ink, THIN + 0.5, run.iter().map(|sample| (sample.time, sample.errors[axis] / peak)));
    }
}

/// The limits of stability: predictions as lines, measurements as dots.
pub fn draw_limits(limits: &[Limit], rest: &Configuration) -> String {
    draw(FIGURE, 480.0, |svg, area| {
        let end = limits.iter().map(|limit| limit.product).fold(0.0, f64::max) + 0.1;
        let runs = [
            (Integrator::RungeKutta4, "Runge–Kutta: 2.785 / (h (1 + κ ‖ΔR‖))", Ink::Green),
            (Integrator::Heun, "Euler and Heun: 2 / (h (1 + κ ‖ΔR‖))", Ink::Blue),
            (Integrator::Euler, "", Ink::Blue),
        ];
        let named = runs[..2].iter().map(|(_, name, ink)| (*name, *ink, Mark::Line));
        let others = [
            ("measured", Ink::Text, Mark::Dot),
            ("Heun, measured", Ink::Blue, Mark::Ring),
            ("the paper's 1250 1/s", Ink::Red, Mark::Dashed),
        ];
        let keys: Vec<Key<'_>> = named.chain(others).collect();
        // Both lines from the start on: 2.785 / h at most.
        let (x, y) = (Axis::linear("κ ‖ΔR‖", [0.0, end]), Axis::linear("K, 1/s", [0.0, 2_900.0]));
        let title = "Maximum stable gain, step 1 ms";
        let mut chart = Axes { title, x, y, keys: &keys }.on(svg, area);
        for (integrator, name, ink) in runs {
            let points = limits.iter().filter(|limit| limit.integrator == integrator);
            let points = points.map(|limit| (limit.product, limit.measured));
            if integrator == Integrator::Heun {
                chart.rings(ink, 6.0, points)
            } else {
                chart.dots(ink, 3.0, points)
            }
            if !name.is_empty() {
                let at = |step: i32| f64::from(step) * end / 100.0;
                let predicted = |x: f64| f64::from(integrator.stability_bound()) / (PERIOD * (1.0 + x));
                chart.line(ink, THIN, (0..=100).map(|step| (at(step), predicted(at(step)))));
            }
        }
        let product = rest.curvature * rest.distance;
        chart.dashed(Ink::Red, THIN, [(0.0, PAPER_LIMIT), (product, PAPER_LIMIT), (product, 0.0)]);
    })
}
