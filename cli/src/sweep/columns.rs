//! Columns that are chosen for the summary, of bearings and of a shaft.

use roulement::interface::variables::{
    Causality, MachineVariables, Source, Variable, Variables, rows_of_shaft,
};
use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::Observer;

use super::extremes::{Gathered, OfColumn};
use super::limits::{Limit, all_bare, bare};
use crate::report::results::{Choice, Columns, ResultsError, fits};

/// Columns that are chosen of each bearing, by the names that its own table has: those that begin with its name, or with `*`; of a
/// bearing alone, all of them.
fn of_bearings(scene: &MachineScene, chosen: &[String]) -> Vec<Vec<String>> {
    let of_shaft = scene.shaft().map_or(vec![], rows_of_shaft);
    let of = |(name, bearing): (&str, &Scene)| -> Vec<String> {
        if name.is_empty() {
            return chosen.to_vec();
        }
        let rows = Variables::moving(bearing, true);
        let own = |pattern: &String| {
            let (bearing, column) = pattern.split_once('.')?;
            let is_here = fits_one(rows.rows(), bare(column)) || !fits_one(&of_shaft, bare(pattern));
            (fits(name, bearing) && is_here).then(|| column.to_string())
        };
        chosen.iter().filter_map(own).collect()
    };
    scene.bearings().into_iter().map(of).collect()
}

/// Does the name of a variable fit a pattern?
fn fits_one(rows: &[Variable], pattern: &str) -> bool {
    rows.iter().any(|row| fits(&row.name, pattern))
}

/// Is all there that is chosen?
///
/// # Errors
/// If a column is not there, or a limit cannot be read.
pub fn check(scene: &MachineScene, chosen: &[String]) -> Result<(), ResultsError> {
    for ((_, bearing), columns) in scene.bearings().into_iter().zip(of_bearings(scene, chosen)) {
        Columns::new(bearing, &Choice { columns: all_bare(&columns), ..Choice::default() })?;
    }
    Limit::all(chosen)?;
    let Some(shaft) = scene.shaft() else { return Ok(()) };
    // All outputs of the shaft are in the summary; a name among them chooses for tables of cases.
    let own = rows_of_shaft(shaft);
    let known = |pattern: &str| {
        let of_bearing = pattern
            .split_once('.')
            .is_some_and(|(bearing, _)| shaft.bearings.iter().any(|own| fits(&own.name, bearing)));
        of_bearing || fits_one(&own, bare(pattern))
    };
    match chosen.iter().find(|pattern| !known(pattern)) {
        Some(pattern) => Err(ResultsError::Column(pattern.clone())),
        None => Ok(()),
    }
}

/// Chosen columns of a machine: those of bearings, and all of a shaft.
pub struct GatheredMachine {
    /// Figures of every bearing.
    pub bearings: Vec<Gathered>,
    /// Outputs of the shaft and its housings.
    pub shaft: Vec<OfColumn>,
    variables: Option<MachineVariables>,
    /// Their references.
    references: Vec<usize>,
}

impl GatheredMachine {
    /// Gatherer of a run of a duration \[s].
    ///
    /// # Errors
    /// If a column is not there, or a limit cannot be read.
    pub fn new(
        scene: &MachineScene,
        machine: &Machine,
        duration: f64,
        chosen: &[String],
    ) -> Result<Self, ResultsError> {
        let bearings = machine.bearings().zip(of_bearings(scene, chosen));
        let bearings = bearings.map(|((_, bearing), columns)| Gathered::new(bearing, duration, &columns));
        let variables = machine.shaft().map(MachineVariables::new);
        let limits = Limit::all(chosen)?;
        let rows_of = || variables.iter().flat_map(|variables| variables.rows().iter().enumerate());
        let is_output =
            |row: &Variable| matches!(row.source, Source::Shaft(_)) && row.causality == Causality::Output;
        let outputs = || rows_of().filter(|(_, row)| is_output(row));
        Ok(Self {
            bearings: bearings.collect::<Result<_, _>>()?,
            shaft: outputs()
                .map(|(_, row)| OfColumn::new(&row.name, row.unit.name, duration, &limits))
                .collect(),
            references: outputs().map(|(reference, _)| reference).collect(),
            variables,
        })
    }
}

impl Observer for GatheredMachine {
    fn step(&mut self, machine: &Machine) {
        for (gathered, (_, bearing)) in self.bearings.iter_mut().zip(machine.bearings()) {
            gathered.push(bearing);
        }
        if let Some(variables) = &self.variables {
            for (column, reference) in self.shaft.iter_mut().zip(&self.references) {
                column.push(machine.time(), variables.value(*reference, machine));
            }
        }
    }
}
