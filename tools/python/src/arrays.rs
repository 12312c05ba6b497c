//! Arrays of results as numpy arrays, without a copy.

use numpy::{PyArray1, PyArrayMethods as _};
use pyo3::IntoPyObjectExt as _;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use sunfleck::output::{ArrayValues, Attribute, NamedArray, SensorArrays};

/// Arrays of a sensor: `name`, `attributes`, and `arrays` of (name, names of dimensions, attributes, values).
pub(crate) fn of_sensor(py: Python<'_>, sensor: SensorArrays) -> PyResult<Bound<'_, PyDict>> {
    let SensorArrays { name, dimensions, attributes: of_all, arrays } = sensor;
    let result = PyDict::new(py);
    result.set_item("name", name)?;
    result.set_item("attributes", attributes(py, of_all)?)?;
    let list = PyList::empty(py);
    for NamedArray { name, dimensions: places, attributes: own, values: of } in arrays {
        let names: Vec<&str> = places.iter().map(|&place| dimensions[place].0.as_str()).collect();
        let shape: Vec<usize> = places.iter().map(|&place| dimensions[place].1).collect();
        list.append((name, names, attributes(py, own)?, values(py, of, shape)?))?;
    }
    result.set_item("arrays", list)?;
    Ok(result)
}

fn attributes(py: Python<'_>, of: Vec<(String, Attribute)>) -> PyResult<Bound<'_, PyDict>> {
    let result = PyDict::new(py);
    for (name, value) in of {
        match value {
            Attribute::Text(text) => result.set_item(name, text)?,
            Attribute::Numbers(numbers) if numbers.len() == 1 => {
                result.set_item(name, numbers[0])?;
            }
            Attribute::Numbers(numbers) => {
                result.set_item(name, PyArray1::from_vec(py, numbers))?;
            }
            Attribute::Floats(numbers) => result.set_item(name, PyArray1::from_vec(py, numbers))?,
        }
    }
    Ok(result)
}

fn values(py: Python<'_>, values: ArrayValues, shape: Vec<usize>) -> PyResult<Bound<'_, PyAny>> {
    match values {
        ArrayValues::Doubles(values) => {
            PyArray1::from_vec(py, values).reshape(shape)?.into_bound_py_any(py)
        }
        ArrayValues::Floats(values) => {
            PyArray1::from_vec(py, values).reshape(shape)?.into_bound_py_any(py)
        }
        ArrayValues::Texts(texts) => texts.into_bound_py_any(py),
        ArrayValues::Nothing => 0_i32.into_bound_py_any(py),
    }
}
