//! Figure 9: a probe on its way around a body of several patches, and Figure 3: the body's Voronoi regions.

use super::page::{Axes, THICK, THIN, dot, font, key, legend, page};
use crate::drawing::{BLUE_INK, Drawing, DrawingResult, RED_INK, SURFACE_INK, TEXT_INK, View, equal_scale};
use crate::models;
use anyhow::{Context as _, ensure};
use glam::DVec3;
use palpate::body::{Body, Feature};
use palpate::math::Vec3;
use palpate::track::{Controller, Probe};
use palpate_bake::BakedBody;
use palpate_truth::body_oracle::{BodyOracle, claims};
use palpate_truth::oracle::OraclePoint;
use plotters::element::PathElement;
use plotters::prelude::*;
use std::path::Path;

/// Seconds of a tick.
pub const PERIOD: f64 = 1e-3;
/// Seconds once around.
pub const ROUND: f64 = 4.0;
/// The witness point's start, as the paper has it: on the curved patch, far from the closest point.
const START: [f32; 2] = [0.1, 0.9];

/// A body to go around.
#[derive(Debug)]
pub struct Touring {
    /// Its name.
    pub name: String,
    /// As the firmware has it.
    pub body: Body<'static>,
    baked: BakedBody,
    centre: DVec3,
    reach: DVec3,
}

/// A tick of the tour.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// Metres.
    pub probe: DVec3,
    /// Metres.
    pub witness: DVec3,
    /// The active feature.
    pub feature: Feature,
    /// `(u, v)` on a face, `(t, 0)` on an edge.
    pub parameters: [f32; 2],
    /// By how much the distance is longer than the oracle's, metres.
    pub excess: f64,
    /// By how much the tick has lengthened the distance to its probe, metres: not above 0 but for rounding.
    pub rise: f64,
}

/// A slice through the regions, row by row.
#[derive(Clone, Debug)]
pub struct Slice {
    /// Name of the plane.
    pub title: &'static str,
    /// Names of its axes.
    pub axes: [&'static str; 2],
    /// Ranges along them, metres.
    pub ranges: [[f64; 2]; 2],
    /// Owner of each cell of a square grid; `None` inside the body.
    pub cells: Vec<Vec<Option<Feature>>>,
}

impl Touring {
    /// Bakes the body of a model file.
    ///
    /// # Errors
    /// A model that cannot be baked, or that has one patch only.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let model = models::read(path)?;
        ensure!(model.patches.len() > 1, "{}: Figures 3 and 9 need a body of several patches", path.display());
        let baked = BakedBody::new(&model, &path.display().to_string())?;
        let body = baked.to_body()?;
        let name = path.file_stem().context("a model file has a name")?.to_string_lossy().into_owned();
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for face in &baked.faces {
            for step in 0..9 * 9 {
                let [u, v] = [step / 9, step % 9].map(|k| f64::from(k) / 8.0);
                let point = OraclePoint::evaluate(&face.surface, u, v).point;
                (low, high) = (low.min(point), high.max(point));
            }
        }
        Ok(Self { name, body, baked, centre: 0.5 * (low + high), reach: 0.5 * (high - low) })
    }

    /// The patches' names, by face.
    pub fn face_name(&self, face: u16) -> String {
        self.baked.faces[usize::from(face)].surface.name.clone().unwrap_or_else(|| face.to_string())
    }

    /// The probe's closed path: an ellipse in an upright plane across a corner of the body.
    pub fn path(&self, time: f64) -> DVec3 {
        let (sine, cosine) = (std::f64::consts::TAU * time / ROUND).sin_cos();
        let across = DVec3::new(0.82, 0.57, 0.0) * (1.6 * self.reach.truncate().length());
        self.centre + across * sine + DVec3::Z * (1.9 * self.reach.z) * cosine
    }

    /// Once around, one tick of the tracker a millisecond.
    pub fn tour(&self) -> Vec<Sample> {
        let surfaces: Vec<_> = self.baked.faces.iter().map(|face| face.surface.clone()).collect();
        let oracle = BodyOracle::new(&surfaces);
        let mut state = self.body.start_on(0, START);
        let ticks = (ROUND / PERIOD) as u32;
        let sample = |tick: u32| {
            let time = f64::from(tick) * PERIOD;
            let probe = self.path(time);
            let at = probe.as_vec3();
            let before = state.witness.surface.point.distance(at);
            self.body.step(&Controller::SecondOrder, &mut state, Probe::at(at), PERIOD as f32);
            let after = state.witness.surface.point.distance(at);
            let truth = oracle.closest(at.as_dvec3()).distance();
            Sample {
                time,
                probe,
                witness: state.witness.surface.point.as_dvec3(),
                feature: state.feature,
                parameters: state.witness.parameters,
                excess: f64::from(after) - truth,
                rise: f64::from(after) - f64::from(before),
            }
        };
        (0..ticks).map(sample).collect()
    }

    /// A horizontal and an upright slice through the middle, each `cells` wide.
    pub fn slices(&self, cells: usize) -> [Slice; 2] {
        let surfaces: Vec<_> = self.baked.faces.iter().map(|face| face.surface.clone()).collect();
        let oracle = BodyOracle::new(&surfaces);
        let planes = [
            ("(A) z through the middle", [0, 1], ["x, mm", "y, mm"]),
            ("(B) y through the middle", [0, 2], ["x, mm", "z, mm"]),
        ];
        planes.map(|(title, [first, second], axes)| {
            let half = 1.7 * self.reach.max_element();
            let range = |axis: usize| [self.centre[axis] - half, self.centre[axis] + half];
            let ranges = [range(first), range(second)];
            let place =
                |range: [f64; 2], index: usize| range[0] + (range[1] - range[0]) * (index as f64 + 0.5) / cells as f64;
            let owner = |row: usize, column: usize| {
                let mut probe = self.centre;
                probe[first] = place(ranges[0], column);
                probe[second] = place(ranges[1], row);
                self.owner(&oracle, probe.as_vec3())
            };
            let cells = (0..cells).map(|row| (0..cells).map(|column| owner(row, column)).collect()).collect();
            Slice { title, axes, ranges, cells }
        })
    }

    /// The feature that owns a probe according to the tables; on a border between regions the first match.
    fn owner(&self, oracle: &BodyOracle<'_>, probe: Vec3) -> Option<Feature> {
        let truth = oracle.closest(probe.as_dvec3());
        if truth.is_inside_convex() {
            return None;
        }
        claims(&self.body, probe, |face| truth.heights[face] < 0.0).features.first().copied()
    }
}

// Figures 3 and 9 as pictures.

/// Ticks between the lines from probe to witness point.
const SNAPSHOT: usize = 40;

/// Pale inks for faces, in their order and then again.
const FACE_INKS: [RGBColor; 6] = [
    RGBColor(255, 214, 165),
    RGBColor(202, 230, 184),
    RGBColor(187, 216, 247),
    RGBColor(248, 199, 204),
    RGBColor(217, 204, 242),
    RGBColor(246, 238, 172),
];
const EDGE_INKS: [RGBColor; 2] = [RGBColor(150, 160, 172), RGBColor(124, 135, 148)];
const VERTEX_INKS: [RGBColor; 2] = [RGBColor(72, 79, 88), RGBColor(98, 106, 116)];

fn ink(feature: Feature) -> RGBColor {
    let pick = |inks: &[RGBColor], index: u16| inks[usize::from(index) % inks.len()];
    match feature {
        Feature::Face(index) => pick(&FACE_INKS, index),
        Feature::Edge(index) => pick(&EDGE_INKS, index),
        Feature::Vertex(index) => pick(&VERTEX_INKS, index),
    }
}

/// Figure 9: the way around the body, and `u`, `v` and the active feature over time.
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw_tour(touring: &Touring, samples: &[Sample]) -> anyhow::Result<String> {
    page((1000, 900), |area| {
        let (upper, lower) = area.split_vertically(1080);
        around(&upper, touring, samples)?;
        over_time(&lower, touring, samples)
    })
}

fn around(area: &Drawing<'_>, touring: &Touring, samples: &[Sample]) -> DrawingResult {
    let area = area.titled("(A) P and Q around the body", font(super::page::TITLE))?;
    let view = View { turn: -0.55, ..View::FRONT_RIGHT };
    let nets: Vec<_> = touring.body.faces().iter().flat_map(|face| view.net(&face.patch)).collect();
    let path =
        |point: fn(&Sample) -> glam::DVec3| samples.iter().map(|sample| view.seen(point(sample))).collect::<Vec<_>>();
    let probes = path(|sample| sample.probe);
    let (width, height) = area.dim_in_pixel();
    let all = nets.iter().flatten().chain(&probes).copied();
    let (x, y) = equal_scale(all, (f64::from(width), f64::from(height)));
    let mut chart = ChartBuilder::on(&area).build_cartesian_2d(x, y)?;
    chart.draw_series(nets.into_iter().map(|line| PathElement::new(line, SURFACE_INK.stroke_width(1))))?;
    let lines = samples.iter().step_by(SNAPSHOT);
    let lines = lines.map(|sample| vec![view.seen(sample.witness), view.seen(sample.probe)]);
    chart.draw_series(lines.map(|line| PathElement::new(line, SURFACE_INK.stroke_width(THIN))))?;
    chart.draw_series([PathElement::new(probes, RED_INK.stroke_width(THICK))])?;
    chart.draw_series([PathElement::new(path(|sample| sample.witness), BLUE_INK.stroke_width(THICK))])?;
    if let [first, ..] = samples {
        dot(&mut chart, view.seen(first.witness), "P₀", BLUE_INK, (12, 4))?;
        dot(&mut chart, view.seen(first.probe), "Q", RED_INK, (-34, -34))?;
    }
    Ok(())
}

fn over_time(area: &Drawing<'_>, touring: &Touring, samples: &[Sample]) -> DrawingResult {
    let title = "(B) u, v over the active feature (faces coloured, edges grey, vertices dark)";
    let axes = Axes { title, x: (0.0, ROUND), y: (0.0, 1.12), x_label: "time, s", y_label: "u, v" };
    let mut chart = axes.chart(area)?;
    let stretches = || samples.chunk_by(|a, b| a.feature == b.feature);
    let end = |stretch: &[Sample]| stretch.last().map_or(0.0, |sample| sample.time + PERIOD);
    let fill = |stretch: &[Sample]| {
        Rectangle::new([(stretch[0].time, 0.0), (end(stretch), 1.12)], ink(stretch[0].feature).filled())
    };
    chart.draw_series(stretches().map(fill))?;
    for stretch in stretches() {
        if let Feature::Face(face) = stretch[0].feature {
            let middle = 0.5 * (stretch[0].time + end(stretch));
            let style = font(super::page::LABEL - 6).pos(plotters::style::text_anchor::Pos::new(
                plotters::style::text_anchor::HPos::Center,
                plotters::style::text_anchor::VPos::Top,
            ));
            if end(stretch) - stretch[0].time > 0.06 * ROUND {
                chart.draw_series([Text::new(touring.face_name(face), (middle, 1.1), style)])?;
            }
        }
    }
    for (axis, name, line_ink) in [(0, "u", BLUE_INK), (1, "v", RED_INK)] {
        let mut named = false;
        for stretch in stretches().filter(|stretch| matches!(stretch[0].feature, Feature::Face(_))) {
            let line: Vec<_> = stretch.iter().map(|sample| (sample.time, f64::from(sample.parameters[axis]))).collect();
            let drawn = chart.draw_series([PathElement::new(line, line_ink.stroke_width(THICK))])?;
            if !named {
                drawn.label(name).legend(key(line_ink));
                named = true;
            }
        }
    }
    legend(&mut chart, SeriesLabelPosition::LowerRight)
}

/// Figure 3: slices through the Voronoi regions.
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw_regions(slices: &[Slice; 2]) -> anyhow::Result<String> {
    page((1000, 520), |area| {
        let panels = area.split_evenly((1, 2));
        slices.iter().zip(&panels).try_for_each(|(slice, panel)| draw_slice(panel, slice))
    })
}

fn draw_slice(area: &Drawing<'_>, slice: &Slice) -> DrawingResult {
    let [x, y] = slice.ranges.map(|[low, high]| (1e3 * low, 1e3 * high));
    let axes = Axes { title: slice.title, x, y, x_label: slice.axes[0], y_label: slice.axes[1] };
    let mut chart = axes.chart(area)?;
    let count = slice.cells.len() as f64;
    let place = |(low, high): (f64, f64), index: usize| low + (high - low) * index as f64 / count;
    for (row, cells) in slice.cells.iter().enumerate() {
        let mut column = 0;
        // One rectangle a run of equal cells.
        for run in cells.chunk_by(|a, b| a == b) {
            let corners = [(place(x, column), place(y, row)), (place(x, column + run.len()), place(y, row + 1))];
            let fill = run[0].map_or(WHITE, ink);
            chart.draw_series([Rectangle::new(corners, fill.filled())])?;
            column += run.len();
        }
    }
    let inside = Text::new("body", (0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1)), font(super::page::LABEL).color(&TEXT_INK));
    chart.draw_series([inside])?;
    Ok(())
}
