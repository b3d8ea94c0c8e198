//! The table of a machine: rows of its shaft and housings, then those of every bearing with its name before them; those of a bearing alone have
//! no name.

use super::shaft_rows::{self, ShaftSource};
use super::{InputError, Source, Variable, Variables, references_of_inputs};
use crate::scene::Group;
use crate::scene::machine::MachineScene;
use crate::simulation::Simulation;
use crate::simulation::driven::{MachineInputs, Parts};

/// The table of a machine.
#[derive(Clone, Debug)]
pub struct MachineVariables {
    rows: Vec<Variable>,
    inputs: Vec<usize>,
    bearings: Vec<Part>,
}

/// The rows of a bearing.
#[derive(Clone, Debug)]
struct Part {
    /// Reference of the first one.
    first: usize,
    /// They by themselves.
    variables: Variables,
}

/// Group that an input of a machine is given with: a script gives all of it, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MachineGroup {
    /// Force and moment at a named load, by its index.
    Load(usize),
    /// Torque of a gear, by its index.
    Gear(usize),
    /// Speed or torque of a shaft, by its index.
    Drive(usize),
    /// Motion that is given at a named load, by its index.
    Motion(usize),
    /// Motion of the machine's frame.
    Frame,
    /// A group of inputs of a bearing, by its index.
    Bearing(usize, Group),
}

impl MachineVariables {
    /// The variables of a machine's package.
    pub fn new(machine: &impl Parts) -> Self {
        let shaft = machine.shaft();
        let mut rows = shaft.map_or(vec![], |system| shaft_rows::rows(system.scene()));
        let mut bearings = vec![];
        for (name, bearing) in machine.bearings() {
            let first = rows.len();
            let variables = match shaft {
                Some(_) => {
                    let own = Variables::carried(bearing.scene(), |race| bearing.model().is_carried(race));
                    rows.extend(own.rows().iter().map(|row| of_bearing(row, name)));
                    own
                }
                None => {
                    let own = Variables::new(bearing.scene());
                    rows.extend_from_slice(own.rows());
                    own
                }
            };
            bearings.push(Part { first, variables });
        }
        Self { inputs: references_of_inputs(&rows), rows, bearings }
    }

    /// Rows; the index of a row is its value reference.
    pub fn rows(&self) -> &[Variable] {
        &self.rows
    }

    /// Value references of the inputs.
    pub fn input_references(&self) -> &[usize] {
        &self.inputs
    }

    /// The bearing that a row is of, and its reference in the table of that bearing; none for those of the shaft.
    fn part(&self, reference: usize) -> Option<(usize, usize)> {
        let after = self.bearings.partition_point(|part| part.first <= reference);
        let index = after.checked_sub(1)?;
        Some((index, reference - self.bearings[index].first))
    }

    /// Value of a row.
    pub fn value(&self, reference: usize, machine: &impl Parts) -> f64 {
        if let Some((index, own)) = self.part(reference) {
            let variables = &self.bearings[index].variables;
            let value = |bearing: &Simulation| variables.value_of(&variables.rows()[own], bearing);
            return machine.bearings().nth(index).map_or(f64::NAN, |(_, bearing)| value(bearing));
        }
        let of_shaft = shaft_source(&self.rows[reference]).zip(machine.shaft());
        of_shaft.map_or(f64::NAN, |(source, system)| source.value(system.inputs(), system.outputs()))
    }

    /// Values of the rows of the shaft; none of a bearing alone.
    pub fn shaft_values<'a>(&'a self, machine: &'a impl Parts) -> impl Iterator<Item = f64> + 'a {
        let own = self.rows.iter().map_while(shaft_source);
        let all =
            machine.shaft().map(|system| own.map(|source| source.value(system.inputs(), system.outputs())));
        all.into_iter().flatten()
    }

    /// Values of all rows.
    pub fn values(&self, machine: &impl Parts) -> Vec<f64> {
        let mut values: Vec<f64> = self.shaft_values(machine).collect();
        for (part, (_, bearing)) in self.bearings.iter().zip(machine.bearings()) {
            values.extend(part.variables.values(bearing.inputs(), bearing.outputs()));
        }
        values
    }

    /// Rates of all rows that inputs were given with; loads and drives have none.
    pub fn rates(&self, machine: &impl Parts) -> Vec<f64> {
        let mut rates = vec![0.0; self.rows.len()];
        if let Some(system) = machine.shaft() {
            let own = self.rows.iter().map_while(shaft_source);
            rates.iter_mut().zip(own).for_each(|(rate, source)| *rate = source.rate(system.inputs()));
        }
        for (part, (_, bearing)) in self.bearings.iter().zip(machine.bearings()) {
            let own = part.variables.rates(bearing.inputs());
            rates[part.first..part.first + own.len()].copy_from_slice(&own);
        }
        rates
    }

    /// Turns the values of all rows (those of outputs are ignored) and their rates into inputs, on top of those that a machine has.
    ///
    /// # Errors
    /// See [`Variables::inputs`].
    pub fn inputs(
        &self,
        values: &[f64],
        rates: &[f64],
        machine: &impl Parts,
    ) -> Result<MachineInputs, InputError> {
        let mut shaft = machine.shaft().map(|system| system.inputs().clone());
        for &reference in &self.inputs {
            if let (Some(source), Some(shaft)) = (shaft_source(&self.rows[reference]), &mut shaft) {
                let (value, rate) = (values[reference], rates[reference]);
                if let Some(value) = [value, rate].into_iter().find(|number| !number.is_finite()) {
                    let name = self.rows[reference].name.clone();
                    return Err(InputError::NotFinite { name, value });
                }
                source.set(shaft, value, rate);
            }
        }
        let alone = shaft.is_none();
        let inputs = |(part, (name, bearing)): (&Part, (&str, &Simulation))| {
            let range = part.first..part.first + part.variables.rows().len();
            let inputs = part.variables.inputs(&values[range.clone()], &rates[range], bearing.inputs());
            inputs.map_err(|source| match alone {
                true => source,
                false => InputError::Bearing { name: name.into(), source: Box::new(source) },
            })
        };
        let bearings = self.bearings.iter().zip(machine.bearings()).map(inputs).collect::<Result<_, _>>()?;
        Ok(MachineInputs { shaft, bearings })
    }

    /// Sets the pose and the twist of races that are given to where they are now: [`Variables::follow`].
    pub fn follow(&self, values: &mut [f64], machine: &impl Parts) {
        for (part, (_, bearing)) in self.bearings.iter().zip(machine.bearings()) {
            part.variables.follow(&mut values[part.first..], bearing);
        }
    }

    /// Writes the parameters among the values of all rows into a scene.
    pub fn set_parameters(&self, scene: &mut MachineScene, values: &[f64]) {
        if let MachineScene::Shaft(scene) = scene {
            for (row, value) in self.rows.iter().zip(values) {
                if let Some(ShaftSource::Number(parameter)) = shaft_source(row) {
                    parameter.set(scene, *value);
                }
            }
        }
        for (part, scene) in self.bearings.iter().zip(scene.bearings_mut()) {
            part.variables.set_parameters(scene, &values[part.first..]);
        }
    }

    /// Group that an input is given with; none for other variables.
    pub fn group(&self, reference: usize, machine: &impl Parts) -> Option<MachineGroup> {
        if let Some((index, own)) = self.part(reference) {
            let (_, bearing) = machine.bearings().nth(index)?;
            let group = self.bearings[index].variables.rows()[own].group(bearing.scene())?;
            return Some(MachineGroup::Bearing(index, group));
        }
        match shaft_source(&self.rows[reference])? {
            ShaftSource::Force(load, _) | ShaftSource::Moment(load, _) => Some(MachineGroup::Load(load)),
            ShaftSource::Gear(index) => Some(MachineGroup::Gear(index)),
            ShaftSource::Drive(shaft) | ShaftSource::Flange(shaft, _) => Some(MachineGroup::Drive(shaft)),
            ShaftSource::Given(index, _) => Some(MachineGroup::Motion(index)),
            ShaftSource::Frame(..) => Some(MachineGroup::Frame),
            ShaftSource::Number(_)
            | ShaftSource::Jump(..)
            | ShaftSource::Whole(..)
            | ShaftSource::Link(..)
            | ShaftSource::Housing(..)
            | ShaftSource::Holding(_)
            | ShaftSource::Motion(..) => None,
        }
    }

    /// The tables of the bearings by themselves, and the references of their first rows.
    pub fn bearings(&self) -> impl Iterator<Item = (usize, &Variables)> {
        self.bearings.iter().map(|part| (part.first, &part.variables))
    }
}

fn shaft_source(row: &Variable) -> Option<ShaftSource> {
    match row.source {
        Source::Shaft(source) => Some(source),
        _ => None,
    }
}

/// A row of a bearing as one of a machine with a shaft.
fn of_bearing(row: &Variable, bearing: &str) -> Variable {
    let name = format!("{}.{}", shaft_rows::quoted(bearing), row.name);
    // Its axes are its own: those of a bearing that is mounted against the shaft's axis are turned by half a turn about z.
    let description = row.description.replace("world axes", "axes of the bearing");
    Variable { name, description: format!("bearing {bearing}: {description}"), ..row.clone() }
}
