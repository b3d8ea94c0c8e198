//! Columns of the tables of a machine: of its bearings with their names, of its shafts and housings.

use roulement::interface::variables::{MachineVariables, Source, Variable, quoted};
use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement::simulation::system::System;

use super::acceleration::{self, Accelerations};
use super::results::{Choice, Columns, ResultsError, Window, accelerated, fits};
use super::shaft;

/// Name of a column of a bearing of a machine.
pub fn named(bearing: &str, column: &str) -> String {
    if bearing.is_empty() { column.to_string() } else { format!("{}.{column}", quoted(bearing)) }
}

/// Columns of the tables of a machine's parts.
pub struct PartColumns {
    /// Columns of every bearing.
    pub bearings: Vec<Columns>,
    /// Which of the table of the shaft, the time first; none of a bearing alone.
    pub shaft: Option<Vec<bool>>,
}

impl PartColumns {
    /// Those that are chosen: of bearings by names of their own tables, which choose of all of them, or with the name of a bearing before
    /// them; of the shaft by the names of its table, which is whole if none is chosen.
    ///
    /// # Errors
    /// If a chosen column is in none of the tables.
    pub fn new(scene: &MachineScene, choice: &Choice) -> Result<Self, ResultsError> {
        let Some(system) = scene.shaft() else {
            let of = |(_, scene)| Columns::new(scene, choice);
            let bearings = scene.bearings().into_iter().map(of).collect::<Result<_, _>>()?;
            return Ok(Self { bearings, shaft: None });
        };
        let of_shaft = shaft::columns_with_accelerations(system);
        let own = || of_shaft.iter().skip(1).map(|(name, _)| name.as_str());
        let in_bearings = |pattern: &str| {
            scene.bearings().into_iter().any(|(bearing, scene)| {
                let fit = |name: &str| fits(name, pattern) || fits(&named(bearing, name), pattern);
                Columns::that(scene, Window::default(), |_| true, |_| true)
                    .names()
                    .skip(1)
                    .any(|(name, _)| fit(name))
            })
        };
        let missing =
            |pattern: &&String| !own().any(|name| fits(name, pattern)) && !in_bearings(pattern.as_str());
        if let Some(pattern) = choice.columns.iter().find(missing) {
            return Err(ResultsError::Column(pattern.clone()));
        }
        let of = |(bearing, scene): (&str, &Scene)| {
            let own = |name: &str| named(bearing, name);
            let is_chosen = |name: &str| choice.wants(name) || choice.wants(&own(name));
            Columns::that(scene, choice.window, is_chosen, |name| {
                choice.asks(name) || choice.asks(&own(name))
            })
        };
        let whole = !own().any(|name| choice.wants(name));
        // Accelerations stand behind the others.
        let others = shaft::columns(system).len() - 1;
        let of_table = own().enumerate().map(|(index, name)| match index < others {
            true => whole || choice.wants(name),
            false => choice.asks(name),
        });
        Ok(Self {
            bearings: scene.bearings().into_iter().map(of).collect(),
            shaft: Some(std::iter::once(true).chain(of_table).collect()),
        })
    }
}

/// Columns of the one table of a whole machine: of a bearing alone its own; of a shaft those of the shaft and its housings, then those
/// of every bearing with its name before them, all as variables of packages are named.
pub struct MachineColumns {
    shaft: Option<ShaftColumns>,
    /// By the name of their bearing.
    bearings: Vec<(String, Columns)>,
    window: Window,
}

/// Columns of the shaft and its housings.
struct ShaftColumns {
    variables: MachineVariables,
    /// References of those that are written.
    chosen: Vec<usize>,
    /// Accelerations that are written, by the references of their velocities.
    accelerated: Vec<(usize, String)>,
    accelerations: Accelerations,
}

impl ShaftColumns {
    fn new(system: &System, choice: &Choice) -> Self {
        let variables = MachineVariables::new(system);
        let is_own = |row: &Variable| matches!(row.source, Source::Shaft(_));
        let own = variables.rows().iter().enumerate().filter(|(_, row)| is_own(row));
        let chosen = own.filter(|(_, row)| choice.wants(&row.name)).map(|(reference, _)| reference);
        let names = variables.rows().iter().map(|row| if is_own(row) { row.name.as_str() } else { "" });
        let accelerated = accelerated(&names.collect::<Vec<_>>(), |name| choice.asks(name));
        let chosen = chosen.collect();
        Self { variables, chosen, accelerated, accelerations: Accelerations::default() }
    }

    fn names(&self) -> impl Iterator<Item = (String, &'static str)> {
        let of = |i: &usize| (self.variables.rows()[*i].name.clone(), self.variables.rows()[*i].unit.name);
        let accelerations = self.accelerated.iter().map(|(_, name)| (name.clone(), acceleration::UNIT));
        self.chosen.iter().map(of).chain(accelerations)
    }

    /// Takes a row.
    fn push(&mut self, system: &System) {
        let Self { variables, accelerated, accelerations, .. } = self;
        accelerations
            .push(system.time(), accelerated.iter().map(|(velocity, _)| variables.value(*velocity, system)));
    }

    /// Values of the row that was taken last.
    fn values(&self, system: &System) -> impl Iterator<Item = f64> {
        let own = self.chosen.iter().map(|reference| self.variables.value(*reference, system));
        own.chain(self.accelerations.values().iter().copied())
    }
}

impl MachineColumns {
    /// Those that are chosen.
    ///
    /// # Errors
    /// If a chosen column is not there.
    pub fn new(machine: &Machine, choice: &Choice) -> Result<Self, ResultsError> {
        let shaft = machine.shaft().map(|system| ShaftColumns::new(system, choice));
        let bearings = machine.bearings().map(|(name, bearing)| {
            let columns = Columns::named(bearing.scene(), name, choice);
            (name.to_string(), columns)
        });
        let all = Self { shaft, bearings: bearings.collect(), window: choice.window };
        let names: Vec<String> = all.names().map(|(name, _)| name).collect();
        let missing = |pattern: &&String| !names.iter().any(|name| fits(name, pattern));
        match choice.columns.iter().find(missing) {
            Some(pattern) => Err(ResultsError::Column(pattern.clone())),
            None => Ok(all),
        }
    }

    /// Names and units, the time first.
    pub fn names(&self) -> impl Iterator<Item = (String, &'static str)> {
        let shaft = self.shaft.iter().flat_map(ShaftColumns::names);
        let bearings = self.bearings.iter().flat_map(|(bearing, columns)| {
            columns.names().skip(1).map(move |(name, unit)| (named(bearing, name), unit))
        });
        [("time".to_string(), "s")].into_iter().chain(shaft).chain(bearings)
    }

    /// Takes a row; its values, if its time is in the window.
    pub fn row(&mut self, machine: &Machine) -> Option<Vec<f64>> {
        if let (Some(columns), Some(system)) = (&mut self.shaft, machine.shaft()) {
            columns.push(system);
        }
        for ((_, columns), (_, bearing)) in self.bearings.iter_mut().zip(machine.bearings()) {
            columns.push(bearing.inputs(), bearing.outputs());
        }
        if !self.window.contains(machine.time()) {
            return None;
        }
        let mut row = vec![machine.time()];
        if let (Some(columns), Some(system)) = (&self.shaft, machine.shaft()) {
            row.extend(columns.values(system));
        }
        for ((_, columns), (_, bearing)) in self.bearings.iter().zip(machine.bearings()) {
            row.extend(columns.values(bearing.inputs(), bearing.outputs()));
        }
        Some(row)
    }
}
