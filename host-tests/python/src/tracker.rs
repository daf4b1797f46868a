//! Trackers: the firmware's own, a row of the array a servo tick.

use crate::arrays::{line, rows, table, usable};
use crate::body::Body;
use crate::refusal::Refusal;
use numpy::PyReadonlyArray2;
use palpate::body::BodyWitness;
use palpate::math::Vec3;
use palpate::servo::Tracked as _;
use palpate::track::{Controller, FirstOrder, Probe};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// The period of a tick, s. It matters to no law here: both take the gain that is certified.
const PERIOD: f32 = 1e-3;

/// A control law by its name.
///
/// # Errors
/// That there is none.
pub fn law(name: &str) -> Result<Controller, Refusal> {
    match name {
        "second-order" => Ok(Controller::SecondOrder),
        "certified" => Ok(Controller::FirstOrder(FirstOrder::CERTIFIED)),
        _ => Err(Refusal::Settings(format!("there is no law {name:?}; there are \"second-order\" and \"certified\""))),
    }
}

/// The closest point, followed.
#[pyclass(module = "palpate")]
pub struct Tracker {
    body: Py<Body>,
    controller: Controller,
    state: BodyWitness,
}

impl Tracker {
    /// On a body, from nothing or from a place on a face.
    ///
    /// # Errors
    /// That there is no such law or face, or that the place is none.
    pub fn new(body: Py<Body>, name: &str, start: Option<(u16, f32, f32)>) -> Result<Self, Refusal> {
        let controller = law(name)?;
        let of = body.get();
        of.at_rest("a tracker")?;
        let state = match start {
            None => of.tables.start(),
            Some((face, u, v)) => {
                of.face(usize::from(face))?;
                usable("start", &[[u, v].map(f64::from)])?;
                of.tables.start_on(face, [u, v])
            }
        };
        Ok(Self { body, controller, state })
    }
}

/// Ticks, a row each.
#[derive(Default)]
struct Ticks {
    point: Vec<[f64; 3]>,
    normal: Vec<[f32; 3]>,
    gap: Vec<f32>,
    parameters: Vec<[f32; 2]>,
    feature: Vec<u16>,
    contact: Vec<u8>,
    located: Vec<bool>,
    evaluations: Vec<u8>,
}

impl Ticks {
    fn of(body: &Body, controller: &Controller, state: &mut BodyWitness, points: &[[f64; 3]]) -> Self {
        let mut ticks = Self::default();
        for given in points {
            let step = body.tables.step(controller, state, Probe::at(body.local(*given)), PERIOD);
            ticks.point.push(body.placed(state.witness.surface.point));
            ticks.normal.push(state.normal.to_array());
            // Without a normal there is none yet, and 0 would be contact.
            let has_gap = state.is_located && state.normal != Vec3::ZERO;
            ticks.gap.push(if has_gap { state.gap } else { f32::NAN });
            ticks.parameters.push(state.witness.parameters);
            ticks.feature.push(state.feature());
            ticks.contact.push(state.contact as u8);
            ticks.located.push(state.is_located);
            ticks.evaluations.push(step.evaluations);
        }
        ticks
    }
}

#[pymethods]
impl Tracker {
    fn step<'py>(&mut self, py: Python<'py>, points: PyReadonlyArray2<'py, f64>) -> PyResult<Bound<'py, PyTuple>> {
        let points = rows::<3>("points", &points)?;
        let (body, controller, state) = (self.body.get(), &self.controller, &mut self.state);
        let ticks = py.detach(|| Ticks::of(body, controller, state, &points));
        (
            table(py, ticks.point),
            table(py, ticks.normal),
            line(py, ticks.gap),
            table(py, ticks.parameters),
            line(py, ticks.feature),
            line(py, ticks.contact),
            line(py, ticks.located),
            line(py, ticks.evaluations),
        )
            .into_pyobject(py)
    }
}
