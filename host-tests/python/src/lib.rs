//! palpate for Python: what lies under the package `palpate`, whose pages say what each thing is.
//!
//! Arrays come in and go out whole; every loop over points is here, with Python's lock let go of. Points are in metres,
//! in the frame of the model, in double precision; the tables' frame and its single precision are the library's own.

mod arrays;
mod body;
mod closest;
mod devices;
mod evaluate;
mod knob;
mod link;
mod methods;
mod model;
mod modes;
mod pair;
mod patches;
mod refusal;
mod rig;
mod settle;
mod simulate;
mod simulated;
mod tool;
mod tracker;

use pyo3::prelude::*;

/// The compiled half of the package.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    refusal::add(module)?;
    module.add_class::<body::Body>()?;
    module.add_class::<tracker::Tracker>()?;
    module.add_class::<pair::Pair>()?;
    module.add_class::<tool::ToolTracker>()?;
    module.add_class::<link::Link>()?;
    module.add_class::<knob::Knob>()?;
    module.add_class::<rig::Device>()?;
    module.add_class::<rig::Loop>()?;
    module.add_class::<rig::Plant>()?;
    module.add_function(wrap_pyfunction!(simulated::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(devices::devices, module)?)?;
    Ok(())
}
