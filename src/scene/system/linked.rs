//! Machines whose bearings are all links, by rollers or by their stiffness: their steps follow the shafts alone.

use toml::{Table, Value};

use super::spring::SceneSpring;
use crate::scene::numbers::{DAMPING, ERROR_GOAL, MAX_STEP, SHARE, TOLERANCE};
use crate::scene::validate::steps;
use crate::schema::{Method, SceneError, Solver, reader};

/// \[m] diameter of rolling elements of bearings that are given by their stiffness.
const USUAL_DIAMETER: f64 = 0.01;
/// \[Hz] frequency that steps begin with: 4 of its periods are the largest step of `accuracy = "fast"`. Elements in balance have none of their own
/// to follow; how shafts swing is found by the local error.
const USUAL_FREQUENCY: f64 = 2e4;
/// [-] approach over diameter of elements that are loaded well.
const USUAL_APPROACH: f64 = 1e-3;

/// \[m] smallest diameter of a roller, or a usual one where there are none.
pub fn smallest_roller(springs: &[SceneSpring]) -> f64 {
    let rollers = springs.iter().filter_map(|spring| spring.rollers.as_ref());
    rollers.map(|rollers| rollers.geometry().diameter).reduce(f64::min).unwrap_or(USUAL_DIAMETER)
}

/// Settings of the integration of such a machine, by the keys of its `[solver]`.
///
/// # Errors
/// If a key is none, or a value out of range.
pub fn solver(keys: &Table, springs: &[SceneSpring]) -> Result<Solver, SceneError> {
    let read = reader::read(&Value::Table(keys.clone()));
    let mut solver: Solver =
        read.map_err(|why| SceneError::conflict(format!("solver.{}", why.key()), why.message()))?;
    solver.follow(USUAL_FREQUENCY, USUAL_APPROACH);
    solver.fit_to(smallest_roller(springs));
    check(&solver)?;
    Ok(solver)
}

/// Checks these settings against their ranges.
///
/// # Errors
/// Names the key, the value and the range.
pub fn check(solver: &Solver) -> Result<(), SceneError> {
    if solver.method != Method::Hht {
        let why = "is for bearings with states: here are none";
        return Err(SceneError::conflict("solver.method", why));
    }
    MAX_STEP.check("solver.max_step", solver.max_step.0)?;
    steps(solver)?;
    DAMPING.check("solver.alpha_f", solver.alpha_f)?;
    TOLERANCE.check("solver.tolerance", solver.tolerance)?;
    SHARE.check("solver.matrix_reuse", solver.matrix_reuse)?;
    SHARE.check("solver.energy_error", solver.energy_error)?;
    solver.goal.map_or(Ok(()), |goal| ERROR_GOAL.check("solver.accuracy.error", goal.error))
}
