//! Derivatives of a bearing's outputs by its inputs, by small changes of these.

use super::{BearingUnit, UnitSnapshot};
use crate::fmi::outcome::{Outcome, error};
use crate::interface::variables::{Causality, InputKind, Kind, Variable};
use crate::scene::{Groups, Level};
use crate::simulation::inputs::Inputs;
use crate::simulation::outputs::Outputs;
use crate::simulation::{Simulation, SimulationError};

/// Sizes of the changes of inputs whose effects are compared: small against what bends the contact laws (an approach of
/// some micrometres, slip speeds of millimetres per second), large against rounding.
struct Changes {
    /// \[m] of positions, and of points at the pitch radius by rotations.
    displacement: f64,
    /// [m/s] of velocities, and of points at the pitch radius by angular velocities.
    velocity: f64,
    /// \[N] of forces, and of moments over the pitch radius.
    force: f64,
    /// [-] of the friction coefficient.
    friction: f64,
    /// \[m] pitch radius.
    length: f64,
}

/// [1/K] thermal expansion whose growth at the pitch radius measures changes of temperatures.
const STEEL_EXPANSION: f64 = 12e-6;

impl Changes {
    /// \[unit] change of an input; not a number for other variables, which are no knowns.
    fn of(&self, row: &Variable) -> f64 {
        match row.input_kind() {
            Some(InputKind::Displacement) => self.displacement,
            // A quaternion turns by twice the change of its components.
            Some(InputKind::Quaternion) => 0.5 * self.displacement / self.length,
            Some(InputKind::Angle) => self.displacement / self.length,
            Some(InputKind::Velocity) => self.velocity,
            Some(InputKind::AngularVelocity) => self.velocity / self.length,
            Some(InputKind::Force) => self.force,
            Some(InputKind::Moment) => self.force * self.length,
            Some(InputKind::Friction) => self.friction,
            Some(InputKind::Temperature) => self.displacement / (STEEL_EXPANSION * self.length),
            None => row.small_change().unwrap_or(f64::NAN),
        }
    }
}

/// Changes for a step of `duration` \[s], or for an equilibrium, which is less precise and knows no duration.
fn changes(simulation: &Simulation, duration: Option<f64>) -> Changes {
    let contacts = simulation.outputs().balls.iter().flat_map(|ball| [ball.inner.load, ball.outer.load]);
    let load = contacts.fold(1.0, f64::max);
    let displacement = 1e-9;
    Changes {
        displacement,
        velocity: duration.map_or(1e-3, |duration| (displacement / duration).min(1e-6)),
        force: 1e-4 * load,
        friction: 1e-5,
        length: simulation.model().race_length(),
    }
}

/// Derivatives of all variables by every input, one column per input (columns of outputs are empty): of the step since a point, or of
/// the start.
///
/// # Errors
/// If they do not exist here.
pub fn columns(unit: &BearingUnit, before: Option<&UnitSnapshot>, played: Groups) -> Outcome<Vec<Vec<f64>>> {
    let (variables, simulation) = (&unit.variables, &unit.simulation);
    let failed = |why: SimulationError| error(format!("no directional derivatives here: {why}"));
    let base = simulation.inputs();
    let duration = before.map(|before| simulation.time() - before.time());
    // Equilibria know no duration.
    let dynamic = simulation.scene().solver.level == Level::Dynamic;
    let changes = changes(simulation, duration.filter(|_| dynamic));
    let rows = variables.rows();
    let inputs: Vec<usize> = (0..rows.len())
        .filter(|&i| rows[i].causality == Causality::Input && rows[i].kind == Kind::Real)
        .collect();

    // Two perturbations per input, of opposite sign; at the end of what is allowed there is one.
    let values = variables.values(base, simulation.outputs());
    let moved = |index: usize, sign: f64| {
        let value = values[index] + sign * changes.of(&rows[index]);
        rows[index].allowed().map_or(value, |range| value.clamp(range.low, range.high))
    };
    let perturbed = |index: usize, sign: f64| -> Outcome<Inputs> {
        let mut values = values.clone();
        values[index] = moved(index, sign);
        variables.inputs(&values, &variables.rates(base), base).or_else(|why| error(why.to_string()))
    };
    let mut perturbations = Vec::with_capacity(2 * inputs.len());
    for &index in &inputs {
        perturbations.push(perturbed(index, 1.0)?);
        perturbations.push(perturbed(index, -1.0)?);
    }
    let mut central = simulation.clone();
    let outputs: Vec<Outputs> = match before {
        Some(before) => {
            let UnitSnapshot::Bearing(before) = before else {
                return error("the start of the last step is of a system");
            };
            if !central.restore(before) {
                return error("the start of the last step is of another scene");
            }
            central.set_inputs(*base);
            central.advance_perturbed(simulation.time(), &perturbations, played).or_else(failed)?
        }
        None => {
            let start = |inputs: &Inputs| {
                central.set_inputs(*inputs);
                central.initialise()?;
                Ok(central.outputs().clone())
            };
            perturbations.iter().map(start).collect::<Result<_, _>>().or_else(failed)?
        }
    };

    let mut columns = vec![vec![]; rows.len()];
    for (&index, pair) in inputs.iter().zip(outputs.chunks_exact(2)) {
        let [plus, minus] = [0, 1].map(|side: usize| variables.values(base, &pair[side]));
        let apart = moved(index, 1.0) - moved(index, -1.0);
        columns[index] = plus.iter().zip(&minus).map(|(plus, minus)| (plus - minus) / apart).collect();
    }
    Ok(columns)
}
