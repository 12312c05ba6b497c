//! The native part of the Python package: texts and trees of scenes, checks, and runs whose results are arrays.

mod arrays;
mod errors;
mod running;
mod text;

use pyo3::prelude::*;

/// Native part of `sunfleck`.
#[pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::errors::{RunError, SceneError};
    #[pymodule_export]
    use super::running::{check, run};
    #[pymodule_export]
    use super::text::{edited, formatted, text_of_file, tree, types};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
