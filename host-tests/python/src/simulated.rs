//! Simulated runs for Python: arrays, a row a tick.

use crate::arrays::{line, table, usable, wide};
use crate::body::Body;
use crate::devices::on_device;
use crate::simulate::{Run, Sample, Simulated, Touched, Wishes};
use glam::DVec3;
use palpate::body::Effort;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Runs the loop; `at` is where the model's origin lies in the device's workspace, m.
#[pyfunction]
#[pyo3(signature = (
    device, body, *, rate, seconds, seed, stiffness, damping, max_force, velocity_corner, soft_start, smooth, protected, at
))]
#[allow(clippy::too_many_arguments, reason = "each is an argument of the function in Python, by its name")]
pub fn simulate<'py>(
    py: Python<'py>,
    device: PathBuf,
    body: Py<Body>,
    rate: f32,
    seconds: f64,
    seed: u64,
    stiffness: Option<f32>,
    damping: Option<f32>,
    max_force: Option<f32>,
    velocity_corner: Option<f32>,
    soft_start: f32,
    smooth: bool,
    protected: bool,
    at: Option<[f64; 3]>,
) -> PyResult<Bound<'py, PyDict>> {
    let body = body.get();
    if let Some(at) = at {
        usable("at", &[at])?;
    }
    let origin = at.map(|at| DVec3::from_array(at) + body.middle());
    // As the emulated boards do, whose runs have the same state hash. The loop wants its surface for good.
    let surface = Box::leak(Box::new(body.tables.with_effort(Effort::ONE)));
    let soft = body.modes.as_ref().map(|modes| modes.moving(*surface, rate)).transpose()?;
    let soft = soft.map(|soft| &*Box::leak(Box::new(soft)));
    let wishes = Wishes {
        rate,
        seconds,
        seed,
        stiffness,
        damping,
        max_force,
        velocity_corner,
        soft_start,
        smooth,
        protected,
        origin,
    };
    let touched = match (body.alone, soft) {
        (_, Some(soft)) => Touched::Soft(surface, soft),
        (Some(patch), None) => Touched::Patch(patch, &body.model.patches[0]),
        (None, None) => Touched::Body(surface),
    };
    let run = py.detach(|| on_device(&device, Simulated(touched, &wishes)))?;
    columns(py, &run, body.count())
}

/// A run as arrays by name.
fn columns<'py>(py: Python<'py>, run: &Run, modes: usize) -> PyResult<Bound<'py, PyDict>> {
    let samples = &run.samples;
    let number = |what: fn(&Sample) -> u32| line(py, samples.iter().map(what).collect());
    let columns = PyDict::new(py);
    columns.set_item("state_hash", format!("{:08x}", run.state_hash()))?;
    columns.set_item("time", line(py, samples.iter().map(|sample| sample.time).collect()))?;
    columns.set_item("counts", table(py, samples.iter().map(|sample| sample.counts).collect()))?;
    columns.set_item("duties", table(py, samples.iter().map(|sample| sample.report.duties).collect()))?;
    columns.set_item("hand", table(py, samples.iter().map(|sample| sample.hand).collect()))?;
    columns.set_item("probe", table(py, samples.iter().map(|sample| sample.report.probe).collect()))?;
    columns.set_item("parameters", table(py, samples.iter().map(|sample| sample.report.parameters).collect()))?;
    columns.set_item("force", table(py, samples.iter().map(|sample| sample.report.force).collect()))?;
    columns.set_item("gap", line(py, samples.iter().map(|sample| sample.report.gap).collect()))?;
    columns.set_item("contact", number(|sample| sample.report.contact.into()))?;
    columns.set_item("feature", number(|sample| sample.report.feature.into()))?;
    columns.set_item("phase", number(|sample| sample.report.phase.into()))?;
    columns.set_item("fault", number(|sample| sample.report.fault.into()))?;
    let q = samples.iter().flat_map(|sample| &sample.q[..modes]).copied().collect();
    columns.set_item("q", wide(py, q, (samples.len(), modes)))?;
    columns.set_item("digest", number(|sample| sample.report.digest))?;
    Ok(columns)
}
