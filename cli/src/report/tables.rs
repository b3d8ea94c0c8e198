//! The tables of a run being written: one of every bearing and one of the shaft with its housings, or one of all.

use std::path::{Path, PathBuf};

use roulement::scene::machine::MachineScene;
use roulement::scene::system::SystemScene;
use roulement::simulation::machine::Machine;
use roulement::simulation::system::System;

use super::acceleration::Accelerations;
use super::machine_columns::{MachineColumns, PartColumns};
use super::results::{Choice, Columns, ResultsError, TableWriter, Window};
use super::shaft;

/// Where the rows of a run go.
pub enum Tables {
    /// One table of the whole machine, whose columns are named as variables of packages are.
    Whole(Box<(MachineColumns, TableWriter)>),
    /// A table of every bearing, and one of the shaft.
    Each {
        /// Table of every bearing.
        bearings: Vec<(Columns, TableWriter)>,
        /// Table of the shaft.
        shaft: Option<ShaftTable>,
    },
}

/// The table of a shaft being written.
pub struct ShaftTable {
    /// Which of its columns.
    chosen: Vec<bool>,
    accelerations: Accelerations,
    window: Window,
    table: TableWriter,
}

impl ShaftTable {
    /// Takes a row, and writes it if its time is in the window.
    fn write(&mut self, system: &System) -> Result<(), ResultsError> {
        let Self { chosen, accelerations, window, table } = self;
        accelerations.push(system.time(), shaft::velocities(system.outputs()));
        if !window.contains(system.time()) {
            return Ok(());
        }
        let row = shaft::row(system.scene(), system.outputs());
        let all = row.into_iter().chain(accelerations.values().iter().copied()).zip(&*chosen);
        table.write(all.filter(|(_, chosen)| **chosen).map(|(value, _)| value))
    }
}

impl Tables {
    /// Begins the one table of a machine.
    ///
    /// # Errors
    /// If the file cannot be written, or a chosen column is not there.
    pub fn whole(machine: &Machine, choice: &Choice, path: &Path) -> Result<Self, ResultsError> {
        let columns = MachineColumns::new(machine, choice)?;
        let table = TableWriter::create(path, columns.names())?;
        Ok(Self::Whole(Box::new((columns, table))))
    }

    /// Begins the tables of a scene at the path of that of every bearing, by its name, and of the shaft.
    ///
    /// # Errors
    /// If a file cannot be written, or a chosen column is not there.
    pub fn each(
        scene: &MachineScene,
        choice: &Choice,
        of_bearing: impl Fn(&str) -> PathBuf,
        of_shaft: &Path,
    ) -> Result<Self, ResultsError> {
        let columns = PartColumns::new(scene, choice)?;
        let begin = |((name, _), columns): ((&str, _), Columns)| {
            let table = TableWriter::create(&of_bearing(name), columns.names())?;
            Ok((columns, table))
        };
        let bearings = scene.bearings().into_iter().zip(columns.bearings).map(begin);
        let bearings = bearings.collect::<Result<_, ResultsError>>()?;
        let begin = |(scene, chosen): (&SystemScene, Vec<bool>)| {
            let all = shaft::columns_with_accelerations(scene).into_iter().zip(&chosen);
            let names = all.filter(|(_, chosen)| **chosen).map(|(name, _)| name).collect::<Vec<_>>();
            let table = TableWriter::create(of_shaft, names.into_iter())?;
            let accelerations = Accelerations::default();
            Ok(ShaftTable { chosen, accelerations, window: choice.window, table })
        };
        Ok(Self::Each { bearings, shaft: scene.shaft().zip(columns.shaft).map(begin).transpose()? })
    }

    /// Writes a row of each, if its time is in the window.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&mut self, machine: &Machine) -> Result<(), ResultsError> {
        match self {
            Self::Whole(whole) => {
                let (columns, table) = &mut **whole;
                columns.row(machine).map_or(Ok(()), |row| table.write(row.into_iter()))
            }
            Self::Each { bearings, shaft } => {
                if let (Some(shaft), Some(system)) = (shaft, machine.shaft()) {
                    shaft.write(system)?;
                }
                for ((columns, table), (_, bearing)) in bearings.iter_mut().zip(machine.bearings()) {
                    if let Some(row) = columns.row(bearing.inputs(), bearing.outputs()) {
                        table.write(row)?;
                    }
                }
                Ok(())
            }
        }
    }

    /// Makes sure that every row is on the disk.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn finish(self) -> Result<(), ResultsError> {
        match self {
            Self::Whole(whole) => whole.1.finish(),
            Self::Each { bearings, shaft } => {
                let tables = bearings.into_iter().map(|(_, table)| table);
                tables.chain(shaft.map(|shaft| shaft.table)).try_for_each(TableWriter::finish)
            }
        }
    }
}
