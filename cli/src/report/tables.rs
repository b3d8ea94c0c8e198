//! The tables of a run being written: one of every bearing, and one of the shaft with its housings.

use std::path::{Path, PathBuf};

use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;

use super::results::{Choice, Columns, ResultsError, TableWriter};
use super::shaft;

/// Tables of a run.
pub struct Tables {
    bearings: Vec<(Columns, TableWriter)>,
    shaft: Option<TableWriter>,
    choice: Choice,
}

impl Tables {
    /// Are all columns that are chosen there?
    ///
    /// # Errors
    /// If one is not.
    pub fn check(scene: &MachineScene, choice: &Choice) -> Result<(), ResultsError> {
        scene.bearings().into_iter().try_for_each(|(_, scene)| Columns::new(scene, choice).map(drop))
    }

    /// Begins the tables of a scene at the path of that of every bearing, by its name, and of the shaft.
    ///
    /// # Errors
    /// If a file cannot be written, or a chosen column is not there.
    pub fn create(
        scene: &MachineScene,
        choice: &Choice,
        of_bearing: impl Fn(&str) -> PathBuf,
        of_shaft: &Path,
    ) -> Result<Self, ResultsError> {
        let begin = |(name, scene)| {
            let columns = Columns::new(scene, choice)?;
            let table = TableWriter::create(&of_bearing(name), columns.names())?;
            Ok((columns, table))
        };
        let bearings = scene.bearings().into_iter().map(begin).collect::<Result<_, ResultsError>>()?;
        let begin = |scene| TableWriter::create(of_shaft, shaft::columns(scene).into_iter());
        Ok(Self { bearings, shaft: scene.shaft().map(begin).transpose()?, choice: choice.clone() })
    }

    /// Writes a row of each, if its time is in the window.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&mut self, machine: &Machine) -> Result<(), ResultsError> {
        if let (Some(table), Some(system)) = (&mut self.shaft, machine.shaft())
            && self.choice.window.contains(machine.time())
        {
            table.write(shaft::row(system.outputs()).into_iter())?;
        }
        for ((columns, table), (_, bearing)) in self.bearings.iter_mut().zip(machine.bearings()) {
            if let Some(row) = columns.row(bearing.inputs(), bearing.outputs()) {
                table.write(row)?;
            }
        }
        Ok(())
    }

    /// Makes sure that every row is on the disk.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn finish(self) -> Result<(), ResultsError> {
        self.bearings.into_iter().map(|(_, table)| table).chain(self.shaft).try_for_each(TableWriter::finish)
    }
}
