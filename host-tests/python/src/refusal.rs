//! Refusals, and their Python exceptions.

use pyo3::create_exception;
use pyo3::exceptions::{PyIndexError, PyOSError, PyValueError};
use pyo3::prelude::*;
use std::io;

create_exception!(palpate, ArrayError, PyValueError, "An array that is not of the shape or kind asked for.");
create_exception!(palpate, ModelError, PyValueError, "A model, or a CAD part, that is no body.");
create_exception!(palpate, FileError, PyValueError, "A body's file that is spoiled, or none.");
create_exception!(palpate, SettingsError, PyValueError, "A setting, a law or a device that there is not.");
create_exception!(palpate, LinkError, PyOSError, "A device's line that cannot be opened or read.");

/// Why something was not done, in one sentence that names the culprit.
#[derive(Debug)]
pub enum Refusal {
    /// An array.
    Array(String),
    /// The source of a body.
    Model(String),
    /// A body's file.
    File(String),
    /// A setting, a law or a device.
    Settings(String),
    /// A line.
    Link(String),
    /// There is no such thing at this index.
    Index(String),
    /// The operating system refused a file.
    Path(String, io::Error),
}

impl From<Refusal> for PyErr {
    fn from(refusal: Refusal) -> Self {
        match refusal {
            Refusal::Array(says) => ArrayError::new_err(says),
            Refusal::Model(says) => ModelError::new_err(says),
            Refusal::File(says) => FileError::new_err(says),
            Refusal::Settings(says) => SettingsError::new_err(says),
            Refusal::Link(says) => LinkError::new_err(says),
            Refusal::Index(says) => PyIndexError::new_err(says),
            // Three arguments, and Python makes of it FileNotFoundError, PermissionError and their like.
            Refusal::Path(path, cause) => match cause.raw_os_error() {
                Some(number) => PyOSError::new_err((number, said(&cause), path)),
                None => PyOSError::new_err(format!("{path}: {cause}")),
            },
        }
    }
}

/// The operating system's words, without the number that Python adds.
fn said(cause: &io::Error) -> String {
    let words = cause.to_string();
    words.split(" (os error").next().unwrap_or_default().to_owned()
}

/// Adds the exceptions to the module.
pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("ArrayError", py.get_type::<ArrayError>())?;
    module.add("ModelError", py.get_type::<ModelError>())?;
    module.add("FileError", py.get_type::<FileError>())?;
    module.add("SettingsError", py.get_type::<SettingsError>())?;
    module.add("LinkError", py.get_type::<LinkError>())
}
