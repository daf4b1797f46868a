//! Figure 9: a probe on its way around a body of several patches, and Figure 3: the body's Voronoi regions.

use super::page::{THICK, THIN};
use crate::models;
use crate::plot::{Anchor, Area, Axes, Axis, Chart, FIGURE, Ink, Mark, Svg, View, draw};
use anyhow::{Context as _, ensure};
use glam::DVec3;
use palpate::body::{Body, Feature};
use palpate::math::Vec3;
use palpate::track::{Controller, Probe};
use palpate_bake::BakedBody;
use palpate_truth::body_oracle::{BodyOracle, claims};
use palpate_truth::oracle::OraclePoint;
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

fn ink(feature: Feature) -> Ink {
    match feature {
        Feature::Face(index) => Ink::Face(index),
        Feature::Edge(index) => Ink::Edge(index),
        Feature::Vertex(index) => Ink::Vertex(index),
    }
}

/// Figure 9: the way around the body, and `u`, `v` and the active feature over time.
pub fn draw_tour(touring: &Touring, samples: &[Sample]) -> String {
    draw(FIGURE, 640.0, |svg, area| {
        let (upper, lower) = area.split_at(320.0);
        around(svg, upper, touring, samples);
        over_time(svg, lower, touring, samples);
    })
}

fn around(svg: &mut Svg, area: Area, touring: &Touring, samples: &[Sample]) {
    let view = View { turn: -0.55, ..View::FRONT_RIGHT };
    let nets: Vec<_> = touring.body.faces().iter().flat_map(|face| view.net(&face.patch)).collect();
    let path =
        |point: fn(&Sample) -> glam::DVec3| samples.iter().map(|sample| view.seen(point(sample))).collect::<Vec<_>>();
    let probes = path(|sample| sample.probe);
    let all: Vec<_> = nets.iter().flatten().chain(&probes).copied().collect();
    let keys = [("probe Q", Ink::Red, Mark::Line), ("witness point P", Ink::Blue, Mark::Line)];
    let mut chart = Chart::scene(svg, area, "(A) around the body", &keys, all);
    chart.lines(Ink::Grey, 0.5, nets);
    let lines = samples.iter().step_by(SNAPSHOT);
    chart.lines(Ink::Grey, THIN, lines.map(|sample| vec![view.seen(sample.witness), view.seen(sample.probe)]));
    chart.line(Ink::Red, THICK, probes);
    chart.line(Ink::Blue, THICK, path(|sample| sample.witness));
    if let [first, ..] = samples {
        chart.dot(view.seen(first.witness), "P₀", Ink::Blue, (7.0, 9.0));
        chart.dot(view.seen(first.probe), "Q", Ink::Red, (-17.0, -10.0));
    }
}

fn over_time(svg: &mut Svg, area: Area, touring: &Touring, samples: &[Sample]) {
    let keys = [
        ("u", Ink::Blue, Mark::Line),
        ("v", Ink::Red, Mark::Line),
        ("edge", Ink::Edge(0), Mark::Fill),
        ("vertex", Ink::Vertex(0), Mark::Fill),
    ];
    let (x, y) = (Axis::linear("time, s", [0.0, ROUND]), Axis::linear("u, v", [0.0, 1.16]));
    let title = "(B) u, v over the active feature; faces by name";
    let mut chart = Axes { title, x, y, keys: &keys }.on(svg, area);
    let stretches = || samples.chunk_by(|a, b| a.feature == b.feature);
    let end = |stretch: &[Sample]| stretch.last().map_or(0.0, |sample| sample.time + PERIOD);
    for stretch in stretches() {
        chart.fill(ink(stretch[0].feature), [[(stretch[0].time, 0.0), (end(stretch), 1.16)]]);
    }
    for stretch in stretches() {
        if let Feature::Face(face) = stretch[0].feature {
            let middle = 0.5 * (stretch[0].time + end(stretch));
            let name = touring.face_name(face);
            // As much as its words need of 360 px.
            if end(stretch) - stretch[0].time > ROUND * (8.0 * name.chars().count() as f64 + 8.0) / 360.0 {
                chart.words((middle, 1.09), (0.0, 0.0), Anchor::Middle, Ink::Text, &name);
            }
        }
    }
    for (axis, line_ink) in [(0, Ink::Blue), (1, Ink::Red)] {
        for stretch in stretches().filter(|stretch| matches!(stretch[0].feature, Feature::Face(_))) {
            chart.line(line_ink, THICK, stretch.iter().map(|sample| (sample.time, f64::from(sample.parameters[axis]))));
        }
    }
}

/// Figure 3: slices through the Voronoi regions.
pub fn draw_regions(slices: &[Slice; 2]) -> String {
    draw(FIGURE, 960.0, |svg, area| {
        slices.iter().zip(area.split(2, 1)).for_each(|(slice, panel)| draw_slice(svg, panel, slice));
    })
}

/// Two corners.
type Rectangle = [(f64, f64); 2];

fn draw_slice(svg: &mut Svg, area: Area, slice: &Slice) {
    let [x, y] = slice.ranges.map(|[low, high]| [1e3 * low, 1e3 * high]);
    let [across, up] = slice.axes;
    let mut chart =
        Axes { title: slice.title, x: Axis::linear(across, x), y: Axis::linear(up, y), keys: &[] }.on(svg, area);
    let count = slice.cells.len() as f64;
    let place = |[low, high]: [f64; 2], index: usize| low + (high - low) * index as f64 / count;
    let mut regions: Vec<(Option<Feature>, Vec<Rectangle>)> = Vec::new();
    for (row, cells) in slice.cells.iter().enumerate() {
        let mut column = 0;
        // One rectangle a run of equal cells.
        for run in cells.chunk_by(|a, b| a == b) {
            // A little higher, so that no seam shows between rows.
            let top = place(y, row + 1) + 0.1 * (y[1] - y[0]) / count;
            let corners = [(place(x, column), place(y, row)), (place(x, column + run.len()), top)];
            column += run.len();
            match regions.iter_mut().find(|(owner, _)| *owner == run[0]) {
                Some((_, rectangles)) => rectangles.push(corners),
                None => regions.push((run[0], vec![corners])),
            }
        }
    }
    for (owner, rectangles) in regions {
        chart.fill(owner.map_or(Ink::Paper, ink), rectangles);
    }
    let middle = (0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
    chart.words(middle, (0.0, 0.0), Anchor::Middle, Ink::Text, "body");
}
