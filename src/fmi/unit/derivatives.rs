//! Derivatives of outputs of a machine by its inputs, by small changes of these.

use super::Unit;
use crate::fmi::outcome::{Outcome, Status, error};
use crate::interface::variables::{InputKind, Variable};
use crate::scene::Level;
use crate::simulation::Simulation;
use crate::simulation::driven::{MachineInputs, MachineSnapshot};
use crate::simulation::machine::{Machine, MachineError};
use crate::simulation::system::Played;

/// Sizes of the changes of inputs whose effects are compared: small against what bends the contact laws (an approach of
/// some micrometres, slip speeds of millimetres per second), large against rounding.
#[derive(Clone, Copy)]
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
            None => match row.unit.name {
                // Loads, torques and the speed of a shaft, and motions that are given.
                _ if row.small_change().is_some() => row.small_change().unwrap_or(f64::NAN),
                "m" => self.displacement,
                "rad" => self.displacement / self.length,
                "m/s" => self.velocity,
                "N" => self.force,
                "N.m" => self.force * self.length,
                "rad/s" => self.velocity / self.length,
                _ => f64::NAN,
            },
        }
    }

    /// The smaller ones of two bearings.
    fn smaller(self, other: Self) -> Self {
        Self {
            displacement: self.displacement.min(other.displacement),
            velocity: self.velocity.min(other.velocity),
            force: self.force.min(other.force),
            friction: self.friction.min(other.friction),
            length: self.length.min(other.length),
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

/// Derivatives of all variables by some inputs (their references), one column per input: of the step since a point, or of the start.
///
/// # Errors
/// If they do not exist here.
pub fn columns(
    unit: &Unit,
    before: Option<&MachineSnapshot>,
    played: &Played,
    inputs: &[usize],
) -> Outcome<Vec<Vec<f64>>> {
    let Unit { variables, machine, .. } = unit;
    let changes = smallest_changes(unit, duration(unit, before))?;
    let rows = variables.rows();
    let (values, rates) = (variables.values(machine), variables.rates(machine));
    let moved = |index: usize, sign: f64| moved(&rows[index], values[index], sign, &changes);
    let perturbed = |index: usize, sign: f64| -> Outcome<MachineInputs> {
        let mut values = values.clone();
        values[index] = moved(index, sign);
        variables.inputs(&values, &rates, machine).or_else(|why| error(why.to_string()))
    };
    let perturbations = both_ways(inputs, perturbed)?;
    let ends = match before {
        Some(before) => stepped(unit, before, perturbations, played)?,
        None => {
            let start = |inputs: MachineInputs| {
                let mut central = machine.clone();
                let fit = central.set_inputs(inputs);
                debug_assert!(fit, "they were made for this very machine");
                central.initialise().map(|()| central)
            };
            perturbations.into_iter().map(start).collect::<Result<Vec<_>, _>>().map_err(|why| failed(&why))?
        }
    };
    let of: Vec<_> = ends.iter().map(|end| variables.values(end)).collect();
    Ok(differences(inputs, &of, |index| moved(index, 1.0) - moved(index, -1.0)))
}

/// Derivatives of all variables by the rates of some inputs, likewise; a start, which knows no rates, has none other than 0.
///
/// # Errors
/// If they do not exist here.
pub fn columns_of_rates(
    unit: &Unit,
    before: Option<&MachineSnapshot>,
    played: &Played,
    inputs: &[usize],
) -> Outcome<Vec<Vec<f64>>> {
    let Unit { variables, machine, .. } = unit;
    let rows = variables.rows();
    let Some((before, duration)) = before.zip(duration(unit, before)) else {
        return Ok(vec![vec![0.0; rows.len()]; inputs.len()]);
    };
    let changes = smallest_changes(unit, Some(duration))?;
    let (values, rates) = (variables.values(machine), variables.rates(machine));
    // Such a rate changes its input over the step by as much as that may be changed by itself.
    let moved = |index: usize, sign: f64| rates[index] + sign * changes.of(&rows[index]) / duration;
    let perturbed = |index: usize, sign: f64| -> Outcome<MachineInputs> {
        let mut rates = rates.clone();
        rates[index] = moved(index, sign);
        variables.inputs(&values, &rates, machine).or_else(|why| error(why.to_string()))
    };
    let ends = stepped(unit, before, both_ways(inputs, perturbed)?, played)?;
    let of: Vec<_> = ends.iter().map(|end| variables.values(end)).collect();
    Ok(differences(inputs, &of, |index| moved(index, 1.0) - moved(index, -1.0)))
}

fn failed(why: &MachineError) -> (Status, String) {
    (Status::Error, format!("no directional derivatives here: {why}"))
}

/// \[s] duration of the step since a point; equilibria know none.
fn duration(unit: &Unit, before: Option<&MachineSnapshot>) -> Option<f64> {
    let dynamic = unit.scene.solver().level == Level::Dynamic;
    before.map(|before| unit.machine.time() - before.time()).filter(|_| dynamic)
}

/// Changes that are small for all bearings.
fn smallest_changes(unit: &Unit, duration: Option<f64>) -> Outcome<Changes> {
    let each = unit.machine.bearings().map(|(_, bearing)| changes(bearing, duration));
    each.reduce(Changes::smaller).map_or_else(|| error("there is no bearing"), Ok)
}

/// The machine after the step since a point under other inputs.
fn stepped(
    unit: &Unit,
    before: &MachineSnapshot,
    perturbations: Vec<MachineInputs>,
    played: &Played,
) -> Outcome<Vec<Machine>> {
    let machine = &unit.machine;
    let mut central = machine.clone();
    if !(central.restore(before) && central.set_inputs(machine.inputs())) {
        return error("the start of the last step is of another scene");
    }
    central.advance_perturbed(machine.time(), perturbations, played).map_err(|why| failed(&why))
}

/// A changed value of an input.
fn moved(row: &Variable, value: f64, sign: f64, changes: &Changes) -> f64 {
    let value = value + sign * changes.of(row);
    row.allowed().map_or(value, |range| value.clamp(range.low, range.high))
}

/// Two perturbations per input, of opposite sign; at the end of what is allowed there is one.
fn both_ways<P>(inputs: &[usize], perturbed: impl Fn(usize, f64) -> Outcome<P>) -> Outcome<Vec<P>> {
    let signs = inputs.iter().flat_map(|index| [(*index, 1.0), (*index, -1.0)]);
    signs.map(|(index, sign)| perturbed(index, sign)).collect()
}

/// Derivatives of all rows by inputs, from their values under each pair of perturbations, and how far these are apart.
fn differences(inputs: &[usize], values: &[Vec<f64>], apart: impl Fn(usize) -> f64) -> Vec<Vec<f64>> {
    let column = |(&index, pair): (&usize, &[Vec<f64>])| {
        let apart = apart(index);
        pair[0].iter().zip(&pair[1]).map(|(plus, minus)| (plus - minus) / apart).collect()
    };
    inputs.iter().zip(values.chunks_exact(2)).map(column).collect()
}
