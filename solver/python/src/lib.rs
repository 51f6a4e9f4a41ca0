//! `alewife_session`: the extension module behind `alewife.session`, one thread of its own for each session.

mod environment;
mod session;
mod worker;

use pyo3::create_exception;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

create_exception!(
    alewife_session,
    SessionError,
    PyRuntimeError,
    "Message and exit code of a failure."
);

/// Sessions of alewife.
#[pymodule]
fn alewife_session(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("SessionError", module.py().get_type::<SessionError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<session::Session>()?;
    module.add_class::<session::State>()?;
    module.add_class::<environment::Environment>()?;
    module.add_class::<environment::Batch>()
}
