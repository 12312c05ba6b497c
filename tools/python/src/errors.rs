//! Exceptions.

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::{PyErr, create_exception};
use sunfleck::document::ReadError;
use sunfleck::run::Failure;

create_exception!(
    sunfleck,
    SceneError,
    PyValueError,
    "A scene is wrong; the message says where, and what to write."
);
create_exception!(sunfleck, RunError, PyRuntimeError, "A run could not go on.");

/// Exception for a text that is no scene.
pub(crate) fn of_text(error: &ReadError) -> PyErr {
    SceneError::new_err(error.to_string())
}

/// Exception for a run that failed.
pub(crate) fn of_run(failure: &Failure) -> PyErr {
    match failure {
        Failure::Scene(_) | Failure::Problems(_) => SceneError::new_err(failure.to_string()),
        _ => RunError::new_err(failure.to_string()),
    }
}
