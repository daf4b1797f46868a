//! A device's telemetry, read and never written.

use crate::arrays::{line, table};
use crate::refusal::Refusal;
use palpate::wire::frame::{Received, Receiver};
use palpate::wire::{DeviceMessage, Record};
use pyo3::prelude::*;
use pyo3::sync::MutexExt as _;
use pyo3::types::PyDict;
use std::io::{self, ErrorKind, Read as _};
use std::sync::{Mutex, MutexGuard};
use std::time::{Duration, Instant};

/// How long to wait for bytes before looking at the clock, and at Python's signals.
const LOOK: Duration = Duration::from_millis(20);

/// A serial port, and what came in parts.
struct Open {
    port: Box<dyn serialport::SerialPort>,
    receiver: Receiver<DeviceMessage>,
    damaged: u32,
}

/// A device's line.
#[pyclass(frozen, module = "palpate")]
pub struct Link {
    open: Mutex<Option<Open>>,
    name: String,
}

impl Open {
    /// Reads for a while; the records that came.
    fn some(&mut self) -> io::Result<Vec<Record>> {
        let mut bytes = [0; 512];
        let read = match self.port.read(&mut bytes) {
            Ok(read) => read,
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => 0,
            Err(error) => return Err(error),
        };
        let mut records = Vec::new();
        for byte in &bytes[..read] {
            match self.receiver.feed(*byte) {
                Some(Received::Message(DeviceMessage::Record(record))) => records.push(record),
                Some(Received::Damaged) => self.damaged += 1,
                Some(Received::Empty | Received::Message(_)) | None => {}
            }
        }
        Ok(records)
    }
}

impl Link {
    fn refused(&self, why: impl std::fmt::Display) -> Refusal {
        Refusal::Link(format!("{}: {why}", self.name))
    }

    /// The line; another thread that reads it has its time first.
    fn line(&self, py: Python<'_>) -> Result<MutexGuard<'_, Option<Open>>, Refusal> {
        self.open.lock_py_attached(py).map_err(|_| self.refused("was left in the middle of a read"))
    }
}

#[pymethods]
impl Link {
    #[new]
    fn new(port: String, baud: u32) -> PyResult<Self> {
        let opened = serialport::new(&port, baud).timeout(LOOK).open();
        let opened = opened.map_err(|error| Refusal::Link(format!("cannot open the serial port {port}: {error}")))?;
        let open = Open { port: opened, receiver: Receiver::new(), damaged: 0 };
        Ok(Self { open: Mutex::new(Some(open)), name: port })
    }

    fn read<'py>(&self, py: Python<'py>, count: usize, timeout: f64) -> PyResult<Bound<'py, PyDict>> {
        let timeout = Duration::try_from_secs_f64(timeout)
            .map_err(|_| Refusal::Settings("the timeout must be a number of seconds, not negative".to_owned()))?;
        let mut open = self.line(py)?;
        let open = open.as_mut().ok_or_else(|| self.refused("is closed"))?;
        let (start, mut records) = (Instant::now(), Vec::new());
        while records.len() < count && start.elapsed() < timeout {
            records.extend(py.detach(|| open.some()).map_err(|error| self.refused(error))?);
            py.check_signals()?;
        }
        let columns = columns(py, &records)?;
        columns.set_item("damaged", open.damaged)?;
        Ok(columns)
    }

    fn close(&self, py: Python<'_>) -> PyResult<()> {
        *self.line(py)? = None;
        Ok(())
    }
}

/// Records as arrays by name.
fn columns<'py>(py: Python<'py>, records: &[Record]) -> PyResult<Bound<'py, PyDict>> {
    let number = |what: fn(&Record) -> u32| line(py, records.iter().map(what).collect());
    let columns = PyDict::new(py);
    columns.set_item("tick", number(|record| record.tick))?;
    columns.set_item("number", number(|record| record.number))?;
    columns.set_item("phase", number(|record| record.phase.into()))?;
    columns.set_item("fault", number(|record| record.fault.into()))?;
    columns.set_item("feature", number(|record| record.feature.into()))?;
    columns.set_item("contact", number(|record| record.contact.into()))?;
    columns.set_item("overruns", number(|record| record.overruns))?;
    columns.set_item("gap", line(py, records.iter().map(|record| record.gap).collect()))?;
    columns.set_item("probe", table(py, records.iter().map(|record| record.probe).collect()))?;
    columns.set_item("force", table(py, records.iter().map(|record| record.force).collect()))?;
    columns.set_item("duties", table(py, records.iter().map(|record| record.duties).collect()))?;
    Ok(columns)
}
