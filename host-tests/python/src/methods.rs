//! The methods of a body in Python.

use crate::arrays::{Table, amplitudes, line, rows, table, usable};
use crate::body::Body;
use crate::closest::Found;
use crate::model::{Source, of_baked, of_file};
use crate::modes::Modes;
use crate::pair::Pair;
use crate::refusal::Refusal;
use crate::settle::{Ends, Law, Target, settle, settle_baseline};
use crate::tool::ToolTracker;
use crate::tracker::Tracker;
use crate::{evaluate, patches};
use glam::DVec3;
use numpy::PyReadonlyArray2;
use palpate_bake::flaws::{self, Flaw};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex};
use std::thread::Builder;
use std::time::{Duration, Instant};

/// Between two reports of progress, and before the first.
const PACE: Duration = Duration::from_secs(1);
/// How long to wait before looking at Python's signals.
const LOOK: Duration = Duration::from_millis(100);
/// Stack of a thread that bakes, bytes: as that of a program's first thread.
const STACK: usize = 8 << 20;

/// A model to bake.
enum Given {
    File(PathBuf),
    Patches(Source),
}

/// Does a job in a thread of its own, and looks at Python's signals meanwhile. Where one of them raises, `is_left` is set,
/// at which the job may unwind.
fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    is_left: &AtomicBool,
    job: impl FnOnce() -> Result<T, Refusal> + Send + 'static,
) -> PyResult<T> {
    let (answer, hear) = sync_channel(1);
    // Nothing of a job that unwound is used.
    let work = move || answer.send(catch_unwind(AssertUnwindSafe(job)));
    Builder::new().stack_size(STACK).spawn(work)?;
    let hear = Mutex::new(hear);
    loop {
        let heard =
            py.detach(|| hear.lock().map_or(Err(RecvTimeoutError::Disconnected), |hear| hear.recv_timeout(LOOK)));
        // Before the answer: the same signal may have ended an importer.
        if let Err(raised) = py.check_signals() {
            is_left.store(true, Ordering::Relaxed);
            return Err(raised);
        }
        match heard {
            Ok(Ok(made)) => return Ok(made?),
            Ok(Err(panic)) => resume_unwind(panic),
            Err(RecvTimeoutError::Timeout) => (),
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Refusal::Model("the thread that bakes has ended".to_owned()).into());
            }
        }
    }
}

#[pymethods]
impl Body {
    #[staticmethod]
    fn bake(
        py: Python<'_>,
        model: &Bound<'_, PyAny>,
        tolerance: f64,
        unit: &str,
        modes: Option<PathBuf>,
        margin: f64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let given = if let Ok(path) = model.extract::<PathBuf>() {
            Given::File(path)
        } else {
            let listed: Vec<Bound<'_, PyDict>> = model
                .extract()
                .map_err(|_| Refusal::Model("a model is a path, or a list of patches, each a dictionary".to_owned()))?;
            Given::Patches(patches::model(&listed, unit)?)
        };
        let (told, is_left) = (Mutex::new(Instant::now()), Arc::new(AtomicBool::new(false)));
        let is_over = Arc::clone(&is_left);
        let tell = move |done: usize, all: usize| {
            if is_over.load(Ordering::Relaxed) {
                resume_unwind(Box::new("interrupted"));
            }
            // Workers that find another one speaking go on.
            let Some((progress, mut told)) = progress.as_ref().zip(told.try_lock().ok()) else { return };
            if told.elapsed() > PACE {
                // A display that fails spoils no body.
                let _ = Python::attach(|py| progress.call1(py, (done, all)).map(drop));
                *told = Instant::now();
            }
        };
        interruptible(py, &is_left, move || {
            let source = match given {
                Given::File(path) => of_file(&path, tolerance)?,
                Given::Patches(source) => source,
            };
            Self::of(source, modes.as_deref(), margin, &tell)
        })
    }

    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Ok(py.detach(|| of_baked(&path).and_then(|source| Self::of(source, None, 0.0, &|_, _| ())))?)
    }

    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let written = py.detach(|| fs::write(&path, &self.bytes));
        Ok(written.map_err(|cause| Refusal::Path(path.display().to_string(), cause))?)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.model.name
    }

    #[getter]
    fn patches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, (0..self.model.patches.len()).map(|index| self.model.patch_label(index)))
    }

    /// Each in words, and whether signs are wrong near it.
    #[getter]
    fn flaws(&self, py: Python<'_>) -> Vec<(String, bool)> {
        py.detach(|| {
            let surfaces: Vec<_> = self.baked.faces.iter().map(|face| face.surface.clone()).collect();
            let labels = self.baked.labels(&self.model);
            let found = flaws::find(&surfaces, &self.baked.topology);
            let label = |index: usize| labels.get(index).cloned().unwrap_or_default();
            let told = |flaw: &Flaw| (flaw.describe(&label, self.model.centre, self.model.unit), flaw.is_wrong());
            found.iter().map(told).collect()
        })
    }

    #[getter]
    fn faces(&self) -> usize {
        self.tables.faces().len()
    }

    #[getter]
    fn edges(&self) -> usize {
        self.tables.edges().len()
    }

    #[getter]
    fn vertices(&self) -> usize {
        self.tables.vertices().len()
    }

    #[getter]
    fn size(&self) -> f32 {
        self.tables.size()
    }

    #[getter]
    fn centre(&self) -> (f64, f64, f64) {
        self.model.centre.into()
    }

    #[getter]
    fn is_closed(&self) -> bool {
        self.has_inside()
    }

    #[getter]
    fn is_convex(&self) -> bool {
        self.tables.is_convex()
    }

    #[getter]
    fn modes(&self) -> usize {
        self.count()
    }

    #[getter]
    fn budget(&self) -> f32 {
        self.modes.as_ref().map_or(0.0, Modes::budget)
    }

    fn __repr__(&self) -> String {
        format!("<palpate.Body {:?}: {} faces, {} edges>", self.model.name, self.faces(), self.edges())
    }

    fn closest<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
        q: PyReadonlyArray2<'py, f64>,
        signed: bool,
        bounded: bool,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let points = rows::<3>("points", &points)?;
        let q = amplitudes(&q, points.len(), self.count())?;
        let found = py.detach(|| match &self.modes {
            None => Found::of(self, &points, signed, bounded),
            Some(modes) => Found::displaced(self, modes.fields, &points, &q, signed),
        });
        (
            line(py, found.patch),
            table(py, found.parameters),
            table(py, found.point),
            line(py, found.gap),
            line(py, found.face),
            table(py, found.on_face),
            line(py, found.evaluations),
            line(py, found.complete),
            line(py, found.far),
            line(py, found.clamped),
            line(py, found.error_bound),
        )
            .into_pyobject(py)
    }

    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        face: usize,
        parameters: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<[Table<'py, f64>; 6]> {
        let at = rows::<2>("parameters", &parameters)?;
        let patch = &self.face(face)?.patch;
        let columns = py.detach(|| evaluate::columns(patch, &at, |point| self.placed(point)));
        Ok(columns.map(|column| table(py, column)))
    }

    #[expect(clippy::too_many_arguments, reason = "Python's own")]
    fn settle<'py>(
        &self,
        py: Python<'py>,
        face: usize,
        probe: [f64; 3],
        starts: PyReadonlyArray2<'py, f64>,
        law_name: &str,
        most: u32,
        tolerance: f64,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let starts = rows::<2>("starts", &starts)?;
        usable("probe", &[probe])?;
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            let says = "give how near to the closest point counts as there, in sizes of the body, above 0";
            return Err(Refusal::Settings(format!("tolerance is {tolerance}: {says}")).into());
        }
        let (law, patch, place) = (Law::named(law_name)?, &self.face(face)?.patch, self.local(probe));
        let (ends, steps, rests, arrived, evaluations): Ends = py.detach(|| {
            let probe = DVec3::from_array(probe) - self.middle();
            let target = Target::new(&self.baked.faces[face].surface, probe, tolerance * f64::from(self.size()));
            match law {
                Law::Controller(controller) => settle(patch, &controller, place, &starts, most, &target),
                Law::Baseline(method) => settle_baseline(method, probe, &starts, most, &target),
            }
        });
        let last = [arrived, evaluations].map(|numbers| line(py, numbers));
        let [arrived, evaluations] = last;
        (table(py, ends), line(py, steps), line(py, rests), arrived, evaluations).into_pyobject(py)
    }

    fn tracker(slf: Py<Self>, law: &str, start: Option<(u16, f32, f32)>) -> PyResult<Tracker> {
        Ok(Tracker::new(slf, law, start)?)
    }

    fn pair(slf: Py<Self>, other: Py<Self>, face: usize, other_face: usize) -> PyResult<Pair> {
        Ok(Pair::new([slf, other], [face, other_face])?)
    }

    fn tool(slf: Py<Self>, half: [f64; 3], core: Option<Py<Self>>, radius: f64) -> PyResult<ToolTracker> {
        Ok(ToolTracker::new(slf, half, core, radius)?)
    }
}
