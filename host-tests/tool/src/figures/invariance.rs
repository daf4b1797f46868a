//! Figure 6: a start from which the witness point meets a border, follows it and leaves it again on its way.

use super::page::{THICK, scene, sight, view_of};
use super::subject::{Subject, cell_centres};
use crate::plot::{Area, Axes, Axis, Chart, FIGURE, Ink, Key, Mark, Svg, draw};
use glam::DVec3;
use palpate::math::Vec3;
use palpate::track::{BoundaryMode, Controller, FirstOrder, Gain, Outcome, Probe, ProjectionErrors, Witness};
use palpate_truth::oracle::ClosestPoint;

/// The gain, 1/s: `K h = 1/100` a step draws the flow, not jumps.
pub const GAIN: f32 = 10.0;
const CONTROLLER: Controller = Controller::FirstOrder(FirstOrder::CERTIFIED.gain(Gain::Constant(GAIN)));
/// The paper's step, s.
const PERIOD: f64 = 1e-3;
/// Arrived, for the figure: this near to `P*`, relative to the patch's size; a tenth of a line's width on the page.
const ARRIVED: f64 = 1e-3;
/// Slower passages make no figure: a free one needs about `100 ln 1000 = 700` steps.
const STEP_LIMIT: usize = 2_000;

/// A tick of the passage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// s.
    pub time: f64,
    /// `(u, v)`.
    pub parameters: [f64; 2],
    /// The witness point, metres.
    pub point: DVec3,
    /// The mode of the step from here.
    pub mode: BoundaryMode,
    /// The measure numbers `Ψᵘ, Ψᵛ` here.
    pub errors: [f64; 2],
    /// `‖ΔR‖`, metres.
    pub distance: f64,
}

/// A run from a start to the closest point.
#[derive(Clone, Debug)]
pub struct Passage {
    /// `Q`, metres.
    pub probe: Vec3,
    /// `P*`.
    pub closest: ClosestPoint,
    /// From `P₀` on, a tick each; goes on for a quarter of its time after arrival.
    pub samples: Vec<Sample>,
    /// The witness point of the law of second order, metres: a tick each, from `P₀` until it rests.
    pub second_order: Vec<DVec3>,
    /// `t₁`: the border is met, s.
    pub meets_border: f64,
    /// `t₂`: the border is left, s.
    pub leaves_border: f64,
    /// `t₃`: 1/1000 of the patch's size from `P*`, s.
    pub arrives: f64,
}

/// The search looks at feet of the probe in a grid of cells over the patch, at these distances in sizes, and at starts
/// in a grid.
const FEET: usize = 7;
const DISTANCES: [f64; 3] = [0.1, 0.3, 0.6];
const STARTS: usize = 11;

impl Passage {
    /// The passage that shows the mode changes best, of a grid of probes and starts: interior, one border, interior;
    /// each projection error rises at some time; and the shortest of the three stretches is as long as it can be.
    /// `None` if no passage of the grid has those modes.
    pub fn search(subject: &Subject, mut progress: impl FnMut(usize, usize)) -> Option<Self> {
        let oracle = subject.oracle();
        let mut best: Option<(f64, Self)> = None;
        let feet = cell_centres(FEET).flat_map(|u| cell_centres(FEET).map(move |v| [u, v]));
        for (index, foot) in feet.enumerate() {
            for distance in DISTANCES {
                let Some((probe, closest)) = subject.probe_over(&oracle, foot, distance * subject.size) else {
                    continue;
                };
                for start in cell_centres(STARTS).flat_map(|u| cell_centres(STARTS).map(move |v| [u, v])) {
                    let Some(passage) = Self::run(subject, probe, closest, start) else { continue };
                    let score = passage.score();
                    if best.as_ref().is_none_or(|(most, _)| score > *most) {
                        best = Some((score, passage));
                    }
                }
            }
            progress(index + 1, FEET * FEET);
        }
        best.map(|(_, passage)| passage)
    }

    /// Runs from a start; `None` if the modes are not those of the figure.
    fn run(subject: &Subject, probe: Vec3, closest: ClosestPoint, start: [f64; 2]) -> Option<Self> {
        let patch = &subject.patch;
        let mut witness = Witness::at(patch, start[0] as f32, start[1] as f32);
        let mut samples: Vec<Sample> = Vec::new();
        let (mut meets_border, mut leaves_border, mut arrives) = (None, None, None);
        for step in 0..STEP_LIMIT {
            let time = step as f64 * PERIOD;
            let errors = ProjectionErrors::new(&witness.surface, probe).measure_numbers()?;
            let (at, point) = (witness.parameters, witness.surface.point.as_dvec3());
            let moved = CONTROLLER.step(patch, &mut witness, Probe::at(probe), PERIOD as f32);
            // Where the certified gain is less, time would not be the flow's.
            if moved.outcome != Outcome::AtRest && moved.gain < GAIN * PERIOD as f32 {
                return None;
            }
            let mode = witness.mode;
            match (samples.last().map_or(BoundaryMode::Interior, |last| last.mode), mode) {
                (BoundaryMode::Interior, BoundaryMode::Interior) => {}
                (before, now) if before == now => {}
                (BoundaryMode::Interior, BoundaryMode::Corner) => return None,
                (BoundaryMode::Interior, _) if meets_border.is_none() => meets_border = Some(time),
                (_, BoundaryMode::Interior) if leaves_border.is_none() => leaves_border = Some(time),
                _ => return None,
            }
            samples.push(Sample {
                time,
                parameters: at.map(f64::from),
                point,
                mode,
                errors: errors.map(f64::from),
                distance: point.distance(probe.as_dvec3()),
            });
            if arrives.is_none() && point.distance(closest.point) <= ARRIVED * subject.size {
                arrives = Some(time);
            }
            if arrives.is_some_and(|arrives| time >= 1.25 * arrives) {
                break;
            }
        }
        let (meets_border, leaves_border, arrives) = (meets_border?, leaves_border?, arrives?);
        let second_order = second_order(subject, probe, start);
        (leaves_border < arrives).then_some(Self {
            probe,
            closest,
            samples,
            second_order,
            meets_border,
            leaves_border,
            arrives,
        })
    }

    /// The stretches before, on and after the border.
    pub fn stretches(&self) -> [&[Sample]; 3] {
        let index = |time: f64| self.samples.partition_point(|sample| sample.time < time);
        let (meets, leaves) = (index(self.meets_border), index(self.leaves_border));
        [&self.samples[..=meets], &self.samples[meets..=leaves], &self.samples[leaves..]]
    }

    /// Whether the size of a projection error rises at some step by more than rounding.
    pub fn error_rises(&self, axis: usize) -> bool {
        let size = |sample: &Sample| sample.errors[axis].abs();
        let largest = self.samples.iter().map(size).fold(0.0, f64::max);
        // f32 gives the errors to a few 1e-7; a rise that can be seen is a hundredth.
        let mut least = f64::INFINITY;
        self.samples.iter().any(|sample| {
            least = least.min(size(sample));
            size(sample) > least + 0.01 * largest
        })
    }

    /// By how much `‖ΔR‖` rises at most from one tick to the next, metres; 0 if it never does.
    pub fn largest_rise(&self) -> f64 {
        self.samples.windows(2).map(|pair| pair[1].distance - pair[0].distance).fold(0.0, f64::max)
    }

    /// Length of the shortest stretch, metres; halved for each projection error that never rises.
    fn score(&self) -> f64 {
        let length = |stretch: &[Sample]| stretch.windows(2).map(|pair| pair[0].point.distance(pair[1].point)).sum();
        let shortest = self.stretches().map(length).into_iter().fold(f64::INFINITY, f64::min);
        let monotone = (0..2).filter(|axis| !self.error_rises(*axis)).count();
        shortest * 0.5_f64.powi(monotone as i32)
    }
}

/// The same way to second order: until a step is shorter than what single precision resolves.
fn second_order(subject: &Subject, probe: Vec3, start: [f64; 2]) -> Vec<DVec3> {
    let patch = &subject.patch;
    let mut witness = Witness::at(patch, start[0] as f32, start[1] as f32);
    let mut points = vec![witness.surface.point.as_dvec3()];
    while points.len() < STEP_LIMIT {
        let step = Controller::SecondOrder.step(patch, &mut witness, Probe::at(probe), PERIOD as f32);
        points.push(witness.surface.point.as_dvec3());
        if step.outcome != Outcome::Moved || step.residual() < 4.0 * f32::EPSILON * subject.size as f32 {
            break;
        }
    }
    points
}

// Figure 6 as the paper draws it.

/// The figure, as SVG text.
pub fn draw_passage(subject: &Subject, passage: &Passage) -> String {
    draw(FIGURE, 1_280.0, |svg, area| {
        let panels = area.split(4, 1);
        path(svg, panels[0], subject, passage);
        let border = passage.stretches()[1].first().map_or(BoundaryMode::Interior, |sample| sample.mode);
        let title = format!("(B) mode: 5 interior, {} {}", border as u8, place(border));
        let mut modes = axes(passage, &title, "mode", [0.6, 6.4], &[]).on(svg, panels[1]);
        mark(&mut modes, passage);
        modes.line(Ink::Blue, THICK, steps(passage));
        errors(svg, panels[2], passage);
        let millimetres = |sample: &Sample| sample.distance * 1e3;
        let (least, most) = (passage.closest.distance * 1e3, passage.samples.first().map_or(1.0, millimetres));
        let room = 0.06 * (most - least);
        let keys = [("the closest point's", Ink::Text, Mark::Dashed)];
        let axes = axes(passage, "(D) distance", "‖ΔR‖, mm", [least - room, most + 2.5 * room], &keys);
        let mut distance = axes.on(svg, panels[3]);
        mark(&mut distance, passage);
        distance.dashed(Ink::Text, 1.0, [(0.0, least), (end(passage), least)]);
        distance.line(Ink::Blue, THICK, passage.samples.iter().map(|sample| (sample.time, millimetres(sample))));
    })
}

fn path(svg: &mut Svg, area: Area, subject: &Subject, passage: &Passage) {
    let view = view_of(subject, passage.samples.iter().map(|sample| &sample.parameters));
    let probe = passage.probe.as_dvec3();
    let keys = [
        ("interior", Ink::Blue, Mark::Line),
        ("on the border", Ink::Green, Mark::Line),
        ("ticks of second order", Ink::Red, Mark::Dot),
    ];
    let mut chart = scene(svg, area, ("(A) path", &keys), subject, &view, &[probe]);
    for (stretch, ink) in passage.stretches().into_iter().zip([Ink::Blue, Ink::Green, Ink::Blue]) {
        chart.line(ink, THICK + 0.5, stretch.iter().map(|sample| view.seen(sample.point)));
    }
    let ticks: Vec<_> = passage.second_order.iter().map(|point| view.seen(*point)).collect();
    chart.line(Ink::Red, 0.5, ticks.iter().copied());
    chart.dots(Ink::Red, 2.5, ticks);
    sight(&mut chart, &view, probe, passage.closest.point);
    let [_, on_border, after] = passage.stretches();
    let named = [(passage.samples.first(), "P₀"), (on_border.first(), "t₁"), (after.first(), "t₂")];
    for (sample, name) in named {
        if let Some(sample) = sample {
            chart.dot(view.seen(sample.point), name, Ink::Blue, (7.0, 9.0));
        }
    }
}

fn errors(svg: &mut Svg, area: Area, passage: &Passage) {
    let lines = [(0, "Ψᵘ", Ink::Blue), (1, "Ψᵛ", Ink::Red)];
    let keys = lines.map(|(_, name, ink)| (name, ink, Mark::Line));
    let title = "(C) projection errors, each over its peak";
    let mut chart = axes(passage, title, "Ψ / max |Ψ|", [-1.1, 1.25], &keys).on(svg, area);
    mark(&mut chart, passage);
    for (axis, _, ink) in lines {
        let peak = passage.samples.iter().map(|sample| sample.errors[axis].abs()).fold(f64::MIN_POSITIVE, f64::max);
        chart.line(ink, THICK, passage.samples.iter().map(|sample| (sample.time, sample.errors[axis] / peak)));
    }
}

fn axes<'a>(passage: &Passage, title: &'a str, y_label: &'a str, y: [f64; 2], keys: &'a [Key<'a>]) -> Axes<'a> {
    let x = Axis::linear("time, s", [0.0, end(passage)]);
    Axes { title, x, y: Axis::linear(y_label, y), keys }
}

fn end(passage: &Passage) -> f64 {
    passage.samples.last().map_or(1.0, |sample| sample.time)
}

fn mark(chart: &mut Chart<'_>, passage: &Passage) {
    let times = [(passage.meets_border, "t₁"), (passage.leaves_border, "t₂"), (passage.arrives, "t₃")];
    times.into_iter().for_each(|(time, name)| chart.mark(time, name));
}

/// Where a mode holds the witness point.
const fn place(mode: BoundaryMode) -> &'static str {
    match mode {
        BoundaryMode::LowerU => "on u = 0",
        BoundaryMode::UpperU => "on u = 1",
        BoundaryMode::LowerV => "on v = 0",
        BoundaryMode::UpperV => "on v = 1",
        BoundaryMode::Interior => "interior",
        BoundaryMode::Corner => "at a corner",
    }
}

/// The modes as a staircase.
fn steps(passage: &Passage) -> Vec<(f64, f64)> {
    let number = |mode: BoundaryMode| f64::from(mode as u8);
    let pairs = passage.samples.windows(2).filter(|pair| pair[0].mode != pair[1].mode);
    let corners = pairs.flat_map(|pair| [(pair[1].time, number(pair[0].mode)), (pair[1].time, number(pair[1].mode))]);
    let first = passage.samples.first().map(|sample| (0.0, number(sample.mode)));
    let last = passage.samples.last().map(|sample| (sample.time, number(sample.mode)));
    first.into_iter().chain(corners).chain(last).collect()
}
