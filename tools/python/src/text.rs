//! Texts of scenes: their trees, and changes that keep comments.

use std::path::Path;

use pyo3::IntoPyObjectExt as _;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use sunfleck::document::{self, Named, Node, Value};

use crate::errors::{SceneError, of_text};

/// Types of the scene language as JSON: pairs of a name and an annotated schema.
#[pyfunction]
pub(crate) fn types() -> String {
    document::types_json()
}

/// Text of a scene file.
#[pyfunction]
pub(crate) fn text_of_file(path: &str) -> PyResult<String> {
    document::text_of_file(Path::new(path), false).map_err(|error| of_text(&error))
}

/// Text in its normal form.
#[pyfunction]
pub(crate) fn formatted(text: &str, name: &str) -> PyResult<String> {
    document::format(name, text).map_err(|error| of_text(&error))
}

/// Text with the values of another one; comments, order and layout stay.
#[pyfunction]
pub(crate) fn edited(text: &str, new: &str, name: &str) -> PyResult<String> {
    document::with_values_of(name, text, new).map_err(|error| of_text(&error))
}

/// Tree of a text: numbers and texts as they are, all else as pairs of a kind and what it holds: `("list", [..])`,
/// `("tuple", [..])`, `("record", [(key, value), ..])`, `("map", [(key, value), ..])`, `("named", (name, body))`.
/// Formulas are texts with their `=`.
#[pyfunction]
pub(crate) fn tree<'py>(py: Python<'py>, text: &str, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let node = document::tree_of_text(name, text).map_err(|error| of_text(&error))?;
    value(py, &node)
}

fn value<'py>(py: Python<'py>, node: &Node) -> PyResult<Bound<'py, PyAny>> {
    let all = |nodes: &[Node]| -> PyResult<Bound<'py, PyList>> {
        let values = nodes.iter().map(|node| value(py, node)).collect::<PyResult<Vec<_>>>()?;
        PyList::new(py, values)
    };
    Ok(match &node.value {
        Value::Bool(flag) => flag.into_pyobject(py)?.to_owned().into_any(),
        Value::Integer { negative, magnitude } => {
            let number = i128::from(*magnitude);
            (if *negative { -number } else { number }).into_pyobject(py)?.into_any()
        }
        Value::Float(number) => number.into_pyobject(py)?.into_any(),
        Value::BadNumber(_) => return Err(SceneError::new_err("a number that no scene can hold")),
        Value::Text(text) => text.into_pyobject(py)?.into_any(),
        Value::Formula(formula) => format!("={formula}").into_pyobject(py)?.into_any(),
        Value::List(nodes) => pair(py, "list", all(nodes)?)?,
        Value::Tuple(nodes) => pair(py, "tuple", all(nodes)?)?,
        Value::Record(fields) => {
            let fields = fields
                .iter()
                .map(|field| Ok((field.name.as_str(), value(py, &field.value)?)))
                .collect::<PyResult<Vec<_>>>()?;
            pair(py, "record", PyList::new(py, fields)?)?
        }
        Value::Map(entries) => {
            let entries = entries
                .iter()
                .map(|(key, entry)| Ok((value(py, key)?, value(py, entry)?)))
                .collect::<PyResult<Vec<_>>>()?;
            pair(py, "map", PyList::new(py, entries)?)?
        }
        Value::Named(named) => {
            let Named { name, body, .. } = &**named;
            let body = body.as_ref().map(|body| value(py, body)).transpose()?;
            pair(py, "named", (name.as_str(), body).into_pyobject(py)?)?
        }
    })
}

fn pair<'py>(
    py: Python<'py>,
    kind: &str,
    holds: impl IntoPyObject<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let holds = holds.into_bound_py_any(py)?;
    Ok(PyTuple::new(py, [kind.into_bound_py_any(py)?, holds])?.into_any())
}
