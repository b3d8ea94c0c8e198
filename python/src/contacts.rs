//! Single rolling contacts on arrays.

use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use roulement::analysis::single_contact::{Law, RollingContact};

use crate::arrays::{numbers, write};
use crate::failures::value;

/// Inputs of a contact, a row of the array each.
const INPUTS: usize = 11;
/// Outputs of a contact.
const OUTPUTS: usize = 5;

/// Names of the laws.
#[pyfunction]
pub fn laws() -> Vec<&'static str> {
    Law::names().map(|(name, _)| name).collect()
}

/// Evaluates contacts: an array of 11 rows in, one of 5 rows out, a column for each contact.
#[pyfunction]
pub fn contact(
    py: Python<'_>,
    law: &str,
    degree: usize,
    grid: usize,
    inputs: PyBuffer<f64>,
    outputs: PyBuffer<f64>,
) -> PyResult<()> {
    let law = Law::named(law, degree, grid).ok_or_else(|| {
        let names: Vec<_> = laws().into_iter().map(|name| format!("{name:?}")).collect();
        value(format!("law = {law:?} is none of {}", names.join(", ")))
    })?;
    let inputs = numbers(py, &inputs)?;
    let count = inputs.len() / INPUTS;
    let forces = py.detach(|| {
        let mut forces = vec![f64::NAN; OUTPUTS * count];
        for i in 0..count {
            let of = |row: usize| inputs[row * count + i];
            let contact = RollingContact {
                id: (i + 1).to_string(),
                poisson_ratio: of(0),
                shear_modulus: of(1),
                friction: of(2),
                peak_pressure: of(3),
                semi_axis_x: of(4),
                semi_axis_y: of(5),
                rolling_angle: of(6),
                creep_x: of(7),
                creep_y: of(8),
                spin: of(9),
                curvature: of(10),
            };
            let f = contact.evaluate(law).map_err(value)?;
            let row = [f.fx, f.fy, f.mz, f.power, f.stick.unwrap_or(f64::NAN)];
            row.into_iter().enumerate().for_each(|(at, value)| forces[at * count + i] = value);
        }
        Ok::<_, PyErr>(forces)
    })?;
    write(py, &outputs, &forces)
}
