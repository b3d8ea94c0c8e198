//! Arrays of Python's buffer protocol: numbers of NumPy without its C interface.

use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;

use crate::failures::value;

/// Numbers of an array of float64, row by row.
pub fn numbers(py: Python<'_>, array: &PyBuffer<f64>) -> PyResult<Vec<f64>> {
    array.to_vec(py)
}

/// Writes numbers into an array of float64 of as many elements.
pub fn write(py: Python<'_>, array: &PyBuffer<f64>, numbers: &[f64]) -> PyResult<()> {
    if array.item_count() != numbers.len() {
        return Err(value(format!(
            "an array of {} values is needed, of {}",
            numbers.len(),
            array.item_count()
        )));
    }
    array.copy_from_slice(py, numbers)
}

/// Bytes of numbers, for `numpy.frombuffer`.
pub fn bytes(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_ne_bytes()).collect()
}
