//! Directional derivatives: how the outputs at the last communication point depend on the inputs that led there.
//!
//! After a step they are the derivatives of that step, from its start with everything but the inputs as it was: what
//! repeating the step from a saved state with slightly different inputs would show, without the noise of the
//! iteration. Every internal step contributes by its Newton matrix with the balls eliminated
//! ([`crate::dynamics::advance_perturbed`]). Before the first step they are those of the equilibrium that the simulation starts
//! from.

use super::instance::Instance;
use super::outcome::{Outcome, error};
use super::state::Phase;
use crate::interface::variables::{Causality, InputKind, Kind, Variable};
use crate::scene::Level;
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

impl Instance {
    /// Changes of unknowns (outputs) for a change of knowns (inputs).
    ///
    /// # Errors
    /// If a reference is not of its kind, or the derivatives do not exist here.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        changes: &[f64],
        results: &mut [f64],
    ) -> Outcome {
        let check = |reference: &u32, causality: Causality, role: &str| -> Outcome<usize> {
            let index = self.row(*reference, Kind::Real)?;
            let row = &self.variables.rows()[index];
            if row.causality == causality {
                return Ok(index);
            }
            error(format!("{} cannot be {role} of a directional derivative", row.name))
        };
        let find = |list: &[u32], causality: Causality, role: &str| -> Outcome<Vec<usize>> {
            list.iter().map(|reference| check(reference, causality, role)).collect()
        };
        let unknowns = find(unknowns, Causality::Output, "an unknown")?;
        let knowns = find(knowns, Causality::Input, "a known")?;
        if let Some(value) = changes.iter().find(|value| !value.is_finite()) {
            return error(format!("{value} is no change of a known"));
        }
        match self.state.phase {
            Phase::Initialization => self.refresh()?,
            Phase::StepFailed | Phase::Error => {
                return error("there are no directional derivatives of a step that was not finished");
            }
            Phase::Instantiated | Phase::StepComplete | Phase::Terminated | Phase::Fatal => {}
        }
        let columns = self.columns()?;
        for (unknown, result) in unknowns.iter().zip(results) {
            *result =
                knowns.iter().zip(changes).map(|(known, change)| columns[*known][*unknown] * change).sum();
        }
        Ok(())
    }

    /// Derivatives of all variables by every input, one column per input (columns of outputs are empty), computed when
    /// first asked for at a communication point.
    fn columns(&mut self) -> Outcome<&[Vec<f64>]> {
        let columns = match self.columns.take() {
            Some(columns) => columns,
            None => self.compute_columns()?,
        };
        Ok(self.columns.insert(columns))
    }

    fn compute_columns(&self) -> Outcome<Vec<Vec<f64>>> {
        let failed = |why: SimulationError| error(format!("no directional derivatives here: {why}"));
        let base = self.simulation.inputs();
        let duration = self.state.before.as_ref().map(|before| self.simulation.time() - before.time());
        // Equilibria know no duration.
        let dynamic = self.simulation.scene().solver.level == Level::Dynamic;
        let changes = changes(&self.simulation, duration.filter(|_| dynamic));
        let rows = self.variables.rows();
        let inputs: Vec<usize> = (0..rows.len())
            .filter(|&i| rows[i].causality == Causality::Input && rows[i].kind == Kind::Real)
            .collect();

        // Two perturbations per input, of opposite sign; at the end of what is allowed there is one.
        let values = self.variables.values(base, self.simulation.outputs());
        let moved = |index: usize, sign: f64| {
            let value = values[index] + sign * changes.of(&rows[index]);
            rows[index].allowed().map_or(value, |range| value.clamp(range.low, range.high))
        };
        let perturbed = |index: usize, sign: f64| -> Outcome<Inputs> {
            let mut values = values.clone();
            values[index] = moved(index, sign);
            self.variables
                .inputs(&values, &self.variables.rates(base), base)
                .or_else(|why| error(why.to_string()))
        };
        let mut perturbations = Vec::with_capacity(2 * inputs.len());
        for &index in &inputs {
            perturbations.push(perturbed(index, 1.0)?);
            perturbations.push(perturbed(index, -1.0)?);
        }
        let mut central = self.simulation.clone();
        let outputs: Vec<Outputs> = match &self.state.before {
            Some(before) => {
                if !central.restore(before) {
                    return error("the start of the last step is of another scene");
                }
                central.set_inputs(*base);
                central
                    .advance_perturbed(self.simulation.time(), &perturbations, self.state.played)
                    .or_else(failed)?
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
            let [plus, minus] = [0, 1].map(|side: usize| self.variables.values(base, &pair[side]));
            let apart = moved(index, 1.0) - moved(index, -1.0);
            columns[index] = plus.iter().zip(&minus).map(|(plus, minus)| (plus - minus) / apart).collect();
        }
        Ok(columns)
    }
}
