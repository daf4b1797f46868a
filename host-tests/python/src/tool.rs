//! Closest pairs of a body and a tool: a convex core and a radius.

use crate::arrays::{Line, Table, line, rows, table};
use crate::body::Body;
use crate::refusal::Refusal;
use glam::{DMat3, DQuat, DVec3};
use numpy::PyReadonlyArray2;
use palpate::math::Vec3;
use palpate::pair::{Closest, Core, DEFAULT_CELLS, Tool, ToolWitness};
use palpate::track::Placement;
use pyo3::prelude::*;

/// How far the length of a quaternion may be from 1: the last digits of a printed one.
const ROUNDED: f64 = 1e-3;

/// The closest pair of a body and a tool, followed.
#[pyclass(module = "palpate")]
pub struct ToolTracker {
    body: Py<Body>,
    core: Option<Py<Body>>,
    tool: Tool<'static>,
    state: Option<ToolWitness>,
}

/// The result of each row: the distance, both points each in its own model's frame, evaluations and status.
type Pairs<'py> = (Line<'py, f32>, Table<'py, f64>, Table<'py, f64>, Line<'py, u32>, Vec<&'static str>);

impl ToolTracker {
    /// A tracker that knows nothing yet. Half lengths of a box, of a segment along z if the first two are 0, or of a
    /// point; or a convex body.
    ///
    /// # Errors
    /// A length that is none, a core that is not convex, a body with modes.
    pub fn new(body: Py<Body>, half: [f64; 3], core: Option<Py<Body>>, radius: f64) -> Result<Self, Refusal> {
        let of = body.get();
        of.at_rest("a tool")?;
        let kind = match (&core, half.map(|length| length as f32)) {
            (Some(core), _) => {
                core.get().at_rest("a tool")?;
                Core::Body(core.get().tables)
            }
            (None, [0.0, 0.0, 0.0]) => Core::Point,
            (None, [0.0, 0.0, half]) => Core::Segment { half },
            (None, half) => Core::Box { half },
        };
        let tool = Tool::new(kind, radius as f32).map_err(|refused| Refusal::Settings(refused.to_string()))?;
        Ok(Self { body, core, tool, state: None })
    }

    /// The middle of the core's model.
    fn core_middle(&self) -> DVec3 {
        self.core.as_ref().map_or(DVec3::ZERO, |core| core.get().middle())
    }

    /// Where the core's tables lie in those of the body, a row each.
    fn placements(
        &self,
        origins: &PyReadonlyArray2<'_, f64>,
        quaternions: &PyReadonlyArray2<'_, f64>,
    ) -> Result<Vec<Placement>, Refusal> {
        let (origins, turns) = (rows::<3>("origins", origins)?, rows::<4>("quaternions", quaternions)?);
        let (middle, core_middle) = (self.body.get().middle(), self.core_middle());
        let placement = |(row, (origin, [w, x, y, z])): (usize, ([f64; 3], [f64; 4]))| {
            let turn = DQuat::from_xyzw(x, y, z, w);
            let length = turn.length();
            if (length - 1.0).abs() > ROUNDED {
                let says = format!("quaternions[{row}] has length {length}: give a unit quaternion w, x, y, z");
                return Err(Refusal::Array(says));
            }
            let axes = DMat3::from_quat(turn.normalize());
            let moved = DVec3::from_array(origin) + axes * core_middle - middle;
            Ok(Placement {
                axes: [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| axis.as_vec3()),
                origin: moved.as_vec3(),
                ..Placement::IDENTITY
            })
        };
        origins.into_iter().zip(turns).enumerate().map(placement).collect()
    }

    /// Rows for Python.
    fn pairs<'py>(&self, py: Python<'py>, found: &[Closest], sound: &'static str) -> Pairs<'py> {
        let core_middle = self.core_middle();
        let on_core = |point: Vec3| (point.as_dvec3() + core_middle).to_array();
        (
            line(py, found.iter().map(|pair| pair.distance).collect()),
            table(py, found.iter().map(|pair| self.body.get().placed(pair.body)).collect()),
            table(py, found.iter().map(|pair| on_core(pair.core)).collect()),
            line(py, found.iter().map(|pair| pair.evaluations).collect()),
            found.iter().map(|pair| pair.status.name(sound)).collect(),
        )
    }
}

#[pymethods]
impl ToolTracker {
    fn locate<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray2<'py, f64>,
        quaternions: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Pairs<'py>> {
        let placements = self.placements(&origins, &quaternions)?;
        let (body, tool) = (self.body.get().tables, &self.tool);
        let found: Vec<_> = py.detach(|| placements.iter().map(|pose| body.locate_tool(tool, pose).1).collect());
        Ok(self.pairs(py, &found, "converged"))
    }

    fn step<'py>(
        &mut self,
        py: Python<'py>,
        origins: PyReadonlyArray2<'py, f64>,
        quaternions: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Pairs<'py>> {
        let placements = self.placements(&origins, &quaternions)?;
        let (body, tool, state) = (self.body.get().tables, &self.tool, &mut self.state);
        let mut follow = |pose: &Placement| match state {
            Some(state) => body.follow_tool(tool, state, pose, DEFAULT_CELLS),
            None => {
                let (start, found) = body.locate_tool(tool, pose);
                *state = Some(start);
                found
            }
        };
        let found: Vec<_> = py.detach(|| placements.iter().map(&mut follow).collect());
        Ok(self.pairs(py, &found, "tracking"))
    }
}
