//! The table of a system: rows of its shaft and housings, then those of every bearing with its name before them.

use super::shaft_rows::{self, ShaftSource};
use super::{InputError, Source, Variable, Variables, references_of_inputs};
use crate::scene::Group;
use crate::scene::system::SystemScene;
use crate::simulation::Simulation;
use crate::simulation::inputs::Inputs;
use crate::simulation::system::{ShaftInputs, System};

/// The table of a system.
#[derive(Clone, Debug)]
pub struct SystemVariables {
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

/// What an input of a system is given together with: a script gives all of it, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemGroup {
    /// Force and moment at a named load, by its index.
    Load(usize),
    /// Torque of a gear, by its index.
    Gear(usize),
    /// Speed or torque of the shaft.
    Drive,
    /// A group of inputs of a bearing, by its index.
    Bearing(usize, Group),
}

impl SystemVariables {
    /// The variables of a system's package.
    pub fn new(system: &System) -> Self {
        let mut rows = shaft_rows::rows(system.scene());
        let mut bearings = vec![];
        for (name, bearing) in system.bearings() {
            let variables = Variables::carried(bearing.scene(), |race| bearing.model().is_carried(race));
            let first = rows.len();
            rows.extend(variables.rows().iter().map(|row| of_bearing(row, name)));
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
    pub fn value(&self, reference: usize, system: &System) -> f64 {
        if let Some((index, own)) = self.part(reference) {
            let variables = &self.bearings[index].variables;
            let value = |bearing: &Simulation| variables.value_of(&variables.rows()[own], bearing);
            return system.bearings().nth(index).map_or(f64::NAN, |(_, bearing)| value(bearing));
        }
        shaft_source(&self.rows[reference])
            .map_or(f64::NAN, |source| source.value(system.inputs(), system.outputs()))
    }

    /// Values of the rows of the shaft.
    pub fn shaft_values<'a>(&'a self, system: &'a System) -> impl Iterator<Item = f64> + 'a {
        let own = self.rows.iter().map_while(shaft_source);
        own.map(|source| source.value(system.inputs(), system.outputs()))
    }

    /// Values of all rows.
    pub fn values(&self, system: &System) -> Vec<f64> {
        let mut values: Vec<f64> = self.shaft_values(system).collect();
        for (part, (_, bearing)) in self.bearings.iter().zip(system.bearings()) {
            values.extend(part.variables.values(bearing.inputs(), bearing.outputs()));
        }
        values
    }

    /// Rates of all rows that inputs were given with; loads and drive have none.
    pub fn rates(&self, system: &System) -> Vec<f64> {
        let mut rates = vec![0.0; self.rows.len()];
        for (part, (_, bearing)) in self.bearings.iter().zip(system.bearings()) {
            let own = part.variables.rates(bearing.inputs());
            rates[part.first..part.first + own.len()].copy_from_slice(&own);
        }
        rates
    }

    /// Turns the values of all rows (those of outputs are ignored) and their rates into inputs of shaft and bearings, on top of those
    /// that a system has.
    ///
    /// # Errors
    /// See [`Variables::inputs`].
    pub fn inputs(
        &self,
        values: &[f64],
        rates: &[f64],
        system: &System,
    ) -> Result<(ShaftInputs, Vec<Inputs>), InputError> {
        let mut shaft = system.inputs().clone();
        for &reference in &self.inputs {
            if let Some(source) = shaft_source(&self.rows[reference]) {
                if !values[reference].is_finite() {
                    let name = self.rows[reference].name.clone();
                    return Err(InputError::NotFinite { name, value: values[reference] });
                }
                source.set(&mut shaft, values[reference]);
            }
        }
        let inputs = |(part, (name, bearing)): (&Part, (&str, &Simulation))| {
            let range = part.first..part.first + part.variables.rows().len();
            let inputs = part.variables.inputs(&values[range.clone()], &rates[range], bearing.inputs());
            inputs.map_err(|source| InputError::Bearing { name: name.into(), source: Box::new(source) })
        };
        let bearings = self.bearings.iter().zip(system.bearings()).map(inputs).collect::<Result<_, _>>()?;
        Ok((shaft, bearings))
    }

    /// Writes the parameters among the values of all rows into a scene.
    pub fn set_parameters(&self, scene: &mut SystemScene, values: &[f64]) {
        for (row, value) in self.rows.iter().zip(values) {
            if let Some(ShaftSource::Number(parameter)) = shaft_source(row) {
                parameter.set(scene, *value);
            }
        }
        for (part, mounted) in self.bearings.iter().zip(&mut scene.bearings) {
            part.variables.set_parameters(&mut mounted.scene, &values[part.first..]);
        }
    }

    /// What an input is given together with; none for other variables.
    pub fn group(&self, reference: usize, system: &System) -> Option<SystemGroup> {
        if let Some((index, own)) = self.part(reference) {
            let (_, bearing) = system.bearings().nth(index)?;
            let group = self.bearings[index].variables.rows()[own].group(bearing.scene())?;
            return Some(SystemGroup::Bearing(index, group));
        }
        match shaft_source(&self.rows[reference])? {
            ShaftSource::Force(load, _) | ShaftSource::Moment(load, _) => Some(SystemGroup::Load(load)),
            ShaftSource::Gear(index) => Some(SystemGroup::Gear(index)),
            ShaftSource::Drive => Some(SystemGroup::Drive),
            ShaftSource::Number(_)
            | ShaftSource::Whole(_)
            | ShaftSource::Housing(..)
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

/// A row of a bearing as one of the system.
fn of_bearing(row: &Variable, bearing: &str) -> Variable {
    let name = format!("{}.{}", shaft_rows::quoted(bearing), row.name);
    // Its axes are its own: those of a bearing that is mounted against the shaft's axis are turned by half a turn about z.
    let description = row.description.replace("world axes", "axes of the bearing");
    Variable { name, description: format!("bearing {bearing}: {description}"), ..row.clone() }
}
