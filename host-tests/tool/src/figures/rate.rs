//! How fast the paper's law and that of second order arrive at a probe that rests, and how far behind one that moves
//! they are: both with the firmware's own code, in single precision.

use super::page::THIN;
use super::subject::Subject;
use super::tracking::Configuration;
use crate::plot::{Area, Axes, Axis, FIGURE, Ink, Key, Mark, Svg, draw};
use palpate::math::Vec3;
use palpate::track::{Controller, FirstOrder, Probe, Witness};
use palpate_bake::Axis as Parameter;
use palpate_truth::oracle::Oracle;

/// Beside each other.
pub const LAWS: [Controller; 2] = [Controller::FirstOrder(FirstOrder::CERTIFIED), Controller::SecondOrder];
/// Ticks of a run.
const TICKS: usize = 12;
/// Height of the probe, in sizes of the patch.
const HEIGHT: f64 = 0.1;
/// The start, from the closest point, in parameters.
const START: [f64; 2] = [0.11, -0.08];
/// A servo at 4 kHz, s.
const PERIOD: f64 = 2.5e-4;
/// The way on which the lag is measured, in parameters from the foot at rest: within one span, for over a knot the
/// model is the wrong span's for a tick.
const WAY: [f64; 2] = [0.12, 0.14];
/// Ticks until the start is corrected.
const SETTLED: usize = 20;

/// A run to a closest point.
#[derive(Clone, Debug)]
pub struct Rate {
    /// Where the closest point lies.
    pub place: &'static str,
    /// `‖x − x*‖`, from the start on, for each of [`LAWS`].
    pub errors: [Vec<f64>; 2],
}

/// Runs to closest points inside a span, on a knot, where two knots cross, and on a border.
pub fn rates(subject: &Subject, oracle: &Oracle<'_>) -> Vec<Rate> {
    let knots = [Parameter::U, Parameter::V].map(|axis| {
        let borders = subject.surface.borders(axis);
        borders.get(1).copied().filter(|knot| *knot < 1.0)
    });
    let places = [
        ("inside a span", Some([0.52, 0.47])),
        ("on a knot", knots[0].map(|u| [u, 0.47])),
        ("where knots cross", knots[0].zip(knots[1]).map(|(u, v)| [u, v])),
        ("on a border", Some([0.0, 0.47])),
    ];
    let rate = |(place, foot): (&'static str, Option<[f64; 2]>)| {
        let foot = foot?;
        let (surface, normal) = subject.at(foot);
        // Beyond a border as far as it is high.
        let out = if foot[0] == 0.0 { normal - surface.tangent_u.normalize() } else { normal };
        let probe = (surface.point + out * (HEIGHT * subject.size)).as_vec3();
        let closest = oracle.closest(probe.as_dvec3()).parameters;
        let start = [0, 1].map(|axis| closest[axis] + START[axis]);
        Some(Rate { place, errors: LAWS.map(|law| run(&law, subject, probe, start, closest)) })
    };
    places.into_iter().filter_map(rate).collect()
}

fn run(law: &Controller, subject: &Subject, probe: Vec3, start: [f64; 2], closest: [f64; 2]) -> Vec<f64> {
    let patch = &subject.patch;
    let mut witness = Witness::at(patch, start[0] as f32, start[1] as f32);
    let mut errors = vec![off(&witness, closest)];
    for _ in 0..TICKS {
        law.step(patch, &mut witness, Probe::at(probe), PERIOD as f32);
        errors.push(off(&witness, closest));
    }
    errors
}

fn off(witness: &Witness, closest: [f64; 2]) -> f64 {
    let [u, v] = witness.parameters.map(f64::from);
    (u - closest[0]).hypot(v - closest[1])
}

/// The maximum error while a probe moves evenly.
#[derive(Clone, Copy, Debug)]
pub struct Lag {
    /// Of the probe's foot in the middle of its way, m/s.
    pub speed: f64,
    /// `‖x − x*‖` at most once the start is corrected, for each of [`LAWS`].
    pub errors: [f64; 2],
}

/// Lags at speeds from 1 cm/s to 1 m/s, at the height of the rest of Figure 8.
pub fn lags(subject: &Subject, rest: &Configuration) -> Vec<Lag> {
    let foot = |share: f64| [0, 1].map(|axis| rest.foot[axis] + (2.0 * share - 1.0) * WAY[axis]);
    let place = |share: f64| {
        let (surface, normal) = subject.at(foot(share));
        surface.point + normal * rest.distance
    };
    // Metres of surface, in the middle.
    let length = {
        let [ahead, behind] = [0.51, 0.49].map(|share| subject.at(foot(share)).0.point);
        ahead.distance(behind) / 0.02
    };
    let lag = |step: i32| {
        let speed = 10.0_f64.powf(-2.0 + f64::from(step) / 6.0);
        let ticks = (length / (speed * PERIOD)) as usize;
        let errors = LAWS.map(|law| {
            let patch = &subject.patch;
            let start = foot(0.0).map(|parameter| parameter as f32);
            let mut witness = Witness::at(patch, start[0], start[1]);
            let tick = |tick: usize| {
                let share = tick as f64 / ticks as f64;
                law.step(patch, &mut witness, Probe::at(place(share).as_vec3()), PERIOD as f32);
                if tick < SETTLED { 0.0 } else { off(&witness, foot(share)) }
            };
            (0..=ticks).map(tick).fold(0.0, f64::max)
        });
        Lag { speed, errors }
    };
    (0..=12).map(lag).collect()
}

/// The power of the speed with which the lag of a law grows, over the fastest third of the speeds: there rounding hides
/// nothing.
pub fn power(lags: &[Lag], law: usize) -> f64 {
    let (from, to) = (lags[2 * lags.len() / 3], lags[lags.len() - 1]);
    (to.errors[law] / from.errors[law]).ln() / (to.speed / from.speed).ln()
}

// Local rate and lag of the paper's law and of that of second order.

/// Less is drawn as this: single precision holds parameters to 6e-8.
const LEAST: f64 = 1e-8;

/// The figure, as SVG text.
pub fn draw_rates(rates: &[Rate], lags: &[Lag]) -> String {
    draw(FIGURE, 800.0, |svg, area| {
        let panels = area.split(2, 1);
        arriving(svg, panels[0], rates);
        following(svg, panels[1], lags);
    })
}

/// Second order as lines with dots, the paper's law as thin lines.
fn arriving(svg: &mut Svg, area: Area, rates: &[Rate]) {
    let inks = [Ink::Blue, Ink::Green, Ink::Red, Ink::Text];
    let keys: Vec<Key<'_>> = rates.iter().zip(inks).map(|(rate, ink)| (rate.place, ink, Mark::Line)).collect();
    let ticks = rates.first().map_or(1, |rate| rate.errors[0].len() - 1);
    let (x, y) = (Axis::linear("tick", [0.0, ticks as f64]), Axis::log("‖x − x*‖", [LEAST, 1.0]));
    let title = "(A) arriving: dots second order, thin the paper's law";
    let mut chart = Axes { title, x, y, keys: &keys }.on(svg, area);
    for (Rate { errors, .. }, ink) in rates.iter().zip(inks) {
        let [first, second] = [0, 1].map(|law| {
            let point = |(tick, error): (usize, &f64)| (tick as f64, error.max(LEAST));
            errors[law].iter().enumerate().map(point).collect::<Vec<_>>()
        });
        chart.line(ink, 0.5, first);
        chart.dots(ink, 2.5, second.iter().copied());
        chart.line(ink, THIN + 0.5, second);
    }
}

fn following(svg: &mut Svg, area: Area, lags: &[Lag]) {
    let laws = [(0, "the paper's law, certified gain", Ink::Green), (1, "second order", Ink::Blue)];
    let keys = laws.map(|(_, name, ink)| (name, ink, Mark::Line));
    let (x, y) = (Axis::log("speed, m/s", [0.01, 1.0]), Axis::log("‖x − x*‖", [LEAST, 1.0]));
    let mut chart = Axes { title: "(B) following: maximum lag at 4 kHz", x, y, keys: &keys }.on(svg, area);
    for (law, _, ink) in laws {
        let line: Vec<_> = lags.iter().map(|lag| (lag.speed, lag.errors[law].max(LEAST))).collect();
        chart.dots(ink, 2.5, line.iter().copied());
        chart.line(ink, THIN + 0.5, line);
    }
}
