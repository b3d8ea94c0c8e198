//! Single rolling contacts on arrays.

use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use roulement::analysis::single_contact::{Law, RollingContact};
use roulement::scene::CreepLaw;

use crate::arrays::{numbers, write};
use crate::failures::value;

/// Inputs of a contact, a row of the array each.
const INPUTS: usize = 11;
/// Outputs of a contact.
const OUTPUTS: usize = 5;

fn law_of(name: &str, degree: usize, grid: usize) -> PyResult<Law> {
    Ok(match name {
        "frictionless" => Law::Simulated(CreepLaw::Frictionless),
        "linear" => Law::Simulated(CreepLaw::Linear),
        "regularised" => Law::Simulated(CreepLaw::Regularised),
        "saturated" => Law::Simulated(CreepLaw::Saturated),
        "kalker" => Law::Kalker(degree),
        "kalker_table" => Law::Simulated(CreepLaw::KalkerTable),
        "reference" => Law::Reference(grid),
        "exact" => Law::Exact,
        other => {
            return Err(value(format!(
                "law = {other:?} is none of \"frictionless\", \"linear\", \"regularised\", \"saturated\", \"kalker\", \
                 \"kalker_table\", \"reference\", \"exact\""
            )));
        }
    })
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
    let law = law_of(law, degree, grid)?;
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
