//! Figure 9: a probe on its way around a body of several patches, and Figure 3: the body's Voronoi regions.

use crate::models;
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
    /// Who owns each cell of a square grid; `None` inside the body.
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
            self.body.step(&Controller::SECOND_ORDER, &mut state, Probe::at(at), PERIOD as f32);
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

    /// A horizontal and an upright slice through the middle, so many cells wide.
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

    /// Who claims a probe by the tables; on a border between regions the first of those that do.
    fn owner(&self, oracle: &BodyOracle<'_>, probe: Vec3) -> Option<Feature> {
        let truth = oracle.closest(probe.as_dvec3());
        if truth.is_inside_convex() {
            return None;
        }
        claims(&self.body, probe, |face| truth.heights[face] < 0.0).features.first().copied()
    }
}
