//! Playing a scene's own script from start to end.

use std::ops::ControlFlow;

use super::{Simulation, SimulationError};
use crate::scene::Scene;

/// Plays the script of a scene: advances from one row of results to the next, the last at the scene's duration.
///
/// `row` is called with the simulation at every row, that of the start included, and breaks the play off if it says so. A
/// run that cannot go on ends with a row of where it came to, and the error.
///
/// # Errors
/// See [`SimulationError`].
pub fn play<B>(
    simulation: &mut Simulation,
    mut row: impl FnMut(&Simulation) -> ControlFlow<B>,
) -> Result<ControlFlow<B>, SimulationError> {
    let rows = rows(simulation.scene());
    let (interval, duration) =
        (simulation.scene().load.output_interval.0, simulation.scene().load.duration.0);
    if let ControlFlow::Break(why) = row(simulation) {
        return Ok(ControlFlow::Break(why));
    }
    for index in 1..=rows {
        let end = if index == rows { duration } else { index as f64 * interval };
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        let advanced = simulation.advance(end);
        if let ControlFlow::Break(why) = row(simulation) {
            return Ok(ControlFlow::Break(why));
        }
        advanced?;
    }
    Ok(ControlFlow::Continue(()))
}

/// [-] rows of results after that of the start. The last interval ends with the duration, even if that is no multiple.
pub fn rows(scene: &Scene) -> u64 {
    (scene.load.duration.0 / scene.load.output_interval.0 * (1.0 - 1e-9)).ceil().max(1.0) as u64
}
