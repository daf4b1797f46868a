//! The closest pair of two faces.

use crate::arrays::{Line, Table, line, rows, table};
use crate::body::Body;
use crate::refusal::Refusal;
use glam::DVec3;
use numpy::PyReadonlyArray2;
use palpate::math::Vec3;
use palpate::track::{PairTracker, PairWitness, Placement};
use pyo3::prelude::*;

/// How far axes may be from units at right angles: what products of rounded numbers leave, and no more.
const SKEW: f64 = 1e-6;

/// Two witness points.
#[pyclass(module = "palpate")]
pub struct Pair {
    bodies: [Py<Body>; 2],
    faces: [usize; 2],
    witness: PairWitness,
}

/// The result of each row: both points, each in its own model's frame, and their distance.
type Apart<'py> = (Table<'py, f64>, Table<'py, f64>, Line<'py, f32>);

impl Pair {
    /// From the middle of both faces.
    ///
    /// # Errors
    /// That there is no such face.
    pub fn new(bodies: [Py<Body>; 2], faces: [usize; 2]) -> Result<Self, Refusal> {
        bodies.iter().try_for_each(|body| body.get().at_rest("a pair"))?;
        let [first, second] = [bodies[0].get().face(faces[0])?, bodies[1].get().face(faces[1])?];
        let witness = PairWitness::at(&first.patch, &second.patch, [0.5; 2], [0.5; 2]);
        Ok(Self { bodies, faces, witness })
    }
}

/// The axes of a row; refused unless they are units at right angles, and right-handed.
fn axes(row: usize, numbers: &[f64; 9]) -> Result<[DVec3; 3], Refusal> {
    let [x, y, z] = [0, 3, 6].map(|at| DVec3::from_slice(&numbers[at..at + 3]));
    let off = [x.length() - 1.0, y.length() - 1.0, x.dot(y), z.distance(x.cross(y))];
    if off.into_iter().all(|off| off.abs() <= SKEW) {
        return Ok([x, y, z]);
    }
    Err(Refusal::Array(format!("axes[{row}] are not three right-handed units at right angles, a row each")))
}

/// Where the tables of the second model lie in those of the first.
fn placement([first, second]: [&Body; 2], origin: [f64; 3], axes: [DVec3; 3]) -> Placement {
    let [x, y, z] = axes;
    let centre = second.middle();
    let moved = DVec3::from_array(origin) + x * centre.x + y * centre.y + z * centre.z - first.middle();
    Placement {
        axes: axes.map(|axis| axis.as_vec3()),
        origin: moved.as_vec3(),
        velocity: Vec3::ZERO,
        angular_velocity: Vec3::ZERO,
    }
}

#[pymethods]
impl Pair {
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        origins: PyReadonlyArray2<'py, f64>,
        axes_of: PyReadonlyArray2<'py, f64>,
        steps: u32,
    ) -> PyResult<Apart<'py>> {
        let origins = rows::<3>("origins", &origins)?;
        let numbers = rows::<9>("axes", &axes_of)?;
        let all = numbers.iter().enumerate().map(|(row, numbers)| axes(row, numbers));
        let all = all.collect::<Result<Vec<_>, _>>()?;
        let bodies = self.bodies.each_ref().map(Py::get);
        let (f, h) = (&bodies[0].face(self.faces[0])?.patch, &bodies[1].face(self.faces[1])?.patch);
        let (tracker, witness) = (PairTracker::default(), &mut self.witness);
        let (mut on_first, mut on_second, mut apart) = (Vec::new(), Vec::new(), Vec::new());
        py.detach(|| {
            for (origin, axes) in origins.into_iter().zip(all) {
                let placement = placement(bodies, origin, axes);
                let mut difference = Vec3::ZERO;
                for _ in 0..steps.max(1) {
                    difference = tracker.step(f, h, &placement, witness, 1.0).difference;
                }
                on_first.push(bodies[0].placed(witness.a.surface.point));
                on_second.push(bodies[1].placed(witness.b.surface.point));
                apart.push(difference.length());
            }
        });
        Ok((table(py, on_first), table(py, on_second), line(py, apart)))
    }
}
