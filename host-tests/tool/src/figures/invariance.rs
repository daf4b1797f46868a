//! Figure 6: a start from which the witness point meets a border, follows it and leaves it again on its way.

use super::page::{Axes, Chart, THICK, dot, key, legend, mark_time, page, scene, sight, view_of};
use super::subject::{Subject, cell_centres};
use crate::drawing::{BLUE_INK, DrawingResult, GREEN_INK, RED_INK, TEXT_INK};
use glam::DVec3;
use palpate::math::Vec3;
use palpate::track::{BoundaryMode, Controller, FirstOrder, Gain, Outcome, Probe, ProjectionErrors, Witness};
use palpate_truth::oracle::ClosestPoint;
use plotters::element::{DashedPathElement, PathElement};
use plotters::prelude::*;

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
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw_passage(subject: &Subject, passage: &Passage) -> anyhow::Result<String> {
    page((1000, 760), |area| {
        let panels = area.split_evenly((2, 2));
        path(&panels[0], subject, passage)?;
        let border = passage.stretches()[1].first().map_or(BoundaryMode::Interior, |sample| sample.mode);
        let title = format!("(B) mode: 5 interior, {} {}", border as u8, place(border));
        let mut modes = axes(passage, &title, "mode", (0.6, 6.4)).chart(&panels[1])?;
        mark(&mut modes, passage)?;
        modes.draw_series([PathElement::new(steps(passage), BLUE_INK.stroke_width(THICK))])?;
        errors(&panels[2], passage)?;
        let millimetres = |sample: &Sample| sample.distance * 1e3;
        let (least, most) = (passage.closest.distance * 1e3, passage.samples.first().map_or(1.0, millimetres));
        let room = 0.06 * (most - least);
        let mut distance =
            axes(passage, "(D) distance", "‖ΔR‖, mm", (least - room, most + 2.5 * room)).chart(&panels[3])?;
        mark(&mut distance, passage)?;
        let floor = vec![(0.0, least), (end(passage), least)];
        distance.draw_series([DashedPathElement::new(floor, 10, 8, TEXT_INK.stroke_width(1))])?;
        let line = passage.samples.iter().map(|sample| (sample.time, millimetres(sample)));
        distance.draw_series(LineSeries::new(line, BLUE_INK.stroke_width(THICK)))?;
        Ok(())
    })
}

fn path(area: &crate::drawing::Drawing<'_>, subject: &Subject, passage: &Passage) -> DrawingResult {
    let view = view_of(subject, passage.samples.iter().map(|sample| &sample.parameters));
    let probe = passage.probe.as_dvec3();
    let mut chart = scene(area, "(A) path; red dots: ticks of second order", subject, &view, &[probe])?;
    for (stretch, ink) in passage.stretches().into_iter().zip([BLUE_INK, GREEN_INK, BLUE_INK]) {
        let line: Vec<_> = stretch.iter().map(|sample| view.seen(sample.point)).collect();
        chart.draw_series([PathElement::new(line, ink.stroke_width(THICK + 1))])?;
    }
    let ticks: Vec<_> = passage.second_order.iter().map(|point| view.seen(*point)).collect();
    chart.draw_series([PathElement::new(ticks.clone(), RED_INK.stroke_width(1))])?;
    chart.draw_series(ticks.into_iter().map(|tick| Circle::new(tick, 5, RED_INK.filled())))?;
    sight(&mut chart, &view, probe, passage.closest.point)?;
    let [_, on_border, after] = passage.stretches();
    let named = [(passage.samples.first(), "P₀"), (on_border.first(), "t₁"), (after.first(), "t₂")];
    for (sample, name) in named {
        if let Some(sample) = sample {
            dot(&mut chart, view.seen(sample.point), name, BLUE_INK, (12, 4))?;
        }
    }
    Ok(())
}

fn errors(area: &crate::drawing::Drawing<'_>, passage: &Passage) -> DrawingResult {
    let mut chart =
        axes(passage, "(C) projection errors, each over its peak", "Ψ / max |Ψ|", (-1.1, 1.25)).chart(area)?;
    mark(&mut chart, passage)?;
    for (axis, name, ink) in [(0, "Ψᵘ", BLUE_INK), (1, "Ψᵛ", RED_INK)] {
        let peak = passage.samples.iter().map(|sample| sample.errors[axis].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let line = passage.samples.iter().map(|sample| (sample.time, sample.errors[axis] / peak));
        chart.draw_series(LineSeries::new(line, ink.stroke_width(THICK)))?.label(name).legend(key(ink));
    }
    legend(&mut chart, SeriesLabelPosition::LowerRight)
}

fn axes<'a>(passage: &Passage, title: &'a str, y_label: &'a str, y: (f64, f64)) -> Axes<'a> {
    Axes { title, x: (0.0, end(passage)), y, x_label: "time, s", y_label }
}

fn end(passage: &Passage) -> f64 {
    passage.samples.last().map_or(1.0, |sample| sample.time)
}

fn mark(chart: &mut Chart<'_, '_>, passage: &Passage) -> DrawingResult {
    let times = [(passage.meets_border, " t₁"), (passage.leaves_border, " t₂"), (passage.arrives, " t₃")];
    times.into_iter().try_for_each(|(time, name)| mark_time(chart, time, name))
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
