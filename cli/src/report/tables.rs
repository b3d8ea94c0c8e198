//! The tables of a run being written: one of every bearing and one of the shaft with its housings, or one of all.

use std::path::{Path, PathBuf};

use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;

use super::results::{Choice, Columns, MachineColumns, ResultsError, TableWriter};
use super::shaft;

/// Where the rows of a run go.
pub enum Tables {
    /// One table of the whole machine, whose columns are named as variables of packages are.
    Whole(Box<(MachineColumns, TableWriter)>),
    /// A table of every bearing, and one of the shaft.
    Each {
        /// Of every bearing.
        bearings: Vec<(Columns, TableWriter)>,
        /// Of the shaft, and what of it is written.
        shaft: Option<(Choice, TableWriter)>,
    },
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
        let begin = |(name, scene)| {
            let columns = Columns::new(scene, choice)?;
            let table = TableWriter::create(&of_bearing(name), columns.names())?;
            Ok((columns, table))
        };
        let bearings = scene.bearings().into_iter().map(begin).collect::<Result<_, ResultsError>>()?;
        let begin = |scene| {
            let table = TableWriter::create(of_shaft, shaft::columns(scene).into_iter())?;
            Ok((choice.clone(), table))
        };
        Ok(Self::Each { bearings, shaft: scene.shaft().map(begin).transpose()? })
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
                if let (Some((choice, table)), Some(system)) = (shaft, machine.shaft())
                    && choice.window.contains(machine.time())
                {
                    table.write(shaft::row(system.scene(), system.outputs()).into_iter())?;
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
                tables.chain(shaft.map(|(_, table)| table)).try_for_each(TableWriter::finish)
            }
        }
    }
}
