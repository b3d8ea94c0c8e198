//! Result table of a run: CSV with units in the header, columns from the variable table.

use std::fs::File;
use std::path::Path;

use thiserror::Error;

use roulement::interface::variables::Variables;
use roulement::scene::Scene;
use roulement::simulation::inputs::Inputs;
use roulement::simulation::outputs::Outputs;

/// Why results could not be written.
#[derive(Debug, Error)]
#[error("cannot write {path}: {source}")]
pub struct ResultsError {
    path: String,
    source: csv::Error,
}

/// A result table being written.
pub struct ResultsWriter {
    variables: Variables,
    writer: csv::Writer<File>,
    path: String,
}

impl ResultsWriter {
    /// Begins a table with a column for the time and one for every variable, those of each ball included.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn create(path: &Path, scene: &Scene) -> Result<Self, ResultsError> {
        let name = path.display().to_string();
        let failed = |source| ResultsError { path: name.clone(), source };
        let variables = Variables::moving(scene, true);
        let mut writer = csv::Writer::from_path(path).map_err(failed)?;
        let mut header = vec!["time [s]".to_string()];
        header.extend(variables.rows().iter().map(|row| format!("{} [{}]", row.name, row.unit.name)));
        writer.write_record(&header).map_err(failed)?;
        Ok(Self { variables, writer, path: name })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&mut self, inputs: &Inputs, outputs: &Outputs) -> Result<(), ResultsError> {
        let values = self.variables.values(inputs, outputs);
        let row = std::iter::once(outputs.time).chain(values).map(|value| value.to_string());
        self.writer.write_record(row).map_err(|source| ResultsError { path: self.path.clone(), source })
    }

    /// Makes sure that every row is in the file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(mut self) -> Result<(), ResultsError> {
        self.writer.flush().map_err(|source| ResultsError { path: self.path, source: source.into() })
    }
}
