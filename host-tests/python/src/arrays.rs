//! Arrays of numpy as rows, and back.

use crate::refusal::Refusal;
use numpy::ndarray::Array2;
use numpy::{Element, IntoPyArray as _, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

/// An array of `(n,)` numbers.
pub type Line<'py, T> = Bound<'py, PyArray1<T>>;
/// An array of `(n, N)` numbers.
pub type Table<'py, T> = Bound<'py, PyArray2<T>>;

/// No number may be larger, in metres, radians or shares: its square, the largest number that the library forms of it,
/// is far below the end of `f32`, 3e38.
const LARGEST: f64 = 1e9;

/// The rows of an array of `(n, N)` numbers; a copy, for a view may have gaps, and for another thread may write to it.
///
/// # Errors
/// Another shape; the first row with a number that is not finite, or too large.
pub fn rows<const N: usize>(what: &str, array: &PyReadonlyArray2<'_, f64>) -> Result<Vec<[f64; N]>, Refusal> {
    let view = array.as_array();
    let (count, width) = view.dim();
    if width != N {
        return Err(Refusal::Array(format!("{what} is of shape ({count}, {width}), and must be (n, {N})")));
    }
    let mut rows = vec![[0.0; N]; count];
    for (row, given) in rows.iter_mut().zip(view.rows()) {
        for (number, given) in row.iter_mut().zip(given) {
            *number = *given;
        }
    }
    usable(what, &rows)?;
    Ok(rows)
}

/// Refuses the first row with a number that cannot be computed with.
///
/// # Errors
/// That row, by its index.
pub fn usable<const N: usize>(what: &str, rows: &[[f64; N]]) -> Result<(), Refusal> {
    // A number that is none compares as false.
    let is_usable = |number: &f64| number.abs() <= LARGEST;
    let Some(row) = rows.iter().position(|row| !row.iter().all(is_usable)) else { return Ok(()) };
    let is_finite = rows[row].iter().all(|number| number.is_finite());
    let why = if is_finite { format!("is beyond {LARGEST:e}") } else { "is not finite".to_owned() };
    Err(Refusal::Array(format!("{what}[{row}] {why}")))
}

/// The rows of an array of `(n, modes)` numbers, one after the other: `q` of each mode, metres.
///
/// # Errors
/// Another shape; the first number that is not finite, or too large.
pub fn amplitudes(array: &PyReadonlyArray2<'_, f64>, count: usize, modes: usize) -> Result<Vec<f32>, Refusal> {
    let view = array.as_array();
    let (given, width) = view.dim();
    if (given, width) != (count, modes) {
        return Err(Refusal::Array(format!("q is of shape ({given}, {width}), and must be ({count}, {modes})")));
    }
    for ((row, mode), q) in view.indexed_iter() {
        if !q.is_finite() {
            return Err(Refusal::Array(format!("q[{row}]: q{mode} is {q}: give a finite number of metres")));
        }
        if q.abs() > LARGEST {
            return Err(Refusal::Array(format!("q[{row}]: q{mode} is beyond {LARGEST:e}: give metres")));
        }
    }
    Ok(view.iter().map(|q| *q as f32).collect())
}

/// An array of `(n,)` numbers.
pub fn line<T: Element>(py: Python<'_>, numbers: Vec<T>) -> Line<'_, T> {
    numbers.into_pyarray(py)
}

/// An array of `(n, N)` numbers.
pub fn table<T: Element + Clone, const N: usize>(py: Python<'_>, rows: Vec<[T; N]>) -> Table<'_, T> {
    let count = rows.len();
    Array2::from_shape_vec((count, N), rows.into_flattened()).expect("as many as the shape says").into_pyarray(py)
}

/// An array of this shape, of rows one after the other.
pub fn wide<T: Element>(py: Python<'_>, numbers: Vec<T>, shape: (usize, usize)) -> Table<'_, T> {
    Array2::from_shape_vec(shape, numbers).expect("as many as the shape says").into_pyarray(py)
}
