//! The summary of a sweep: a row for every case in the order of the cases, whatever finished first.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fs;
use std::path::Path;

use super::SweepError;
use super::all::Sweep;
use super::case::{Row, failed};
use super::store::aside;
use crate::report::cells::{Cell, Column};
#[cfg(feature = "parquet")]
use crate::report::parquet::ParquetWriter;

/// How many cases ended how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// With a result.
    pub done: usize,
    /// Without one.
    pub failed: usize,
    /// Not yet.
    pub not_run: usize,
}

impl Sweep {
    /// Row of a case with its number and its keys before what came of it.
    ///
    /// # Errors
    /// If a file cannot be read.
    pub fn row(&self, case: usize) -> Result<Row, SweepError> {
        let mut row: Row = vec![(Column::number("case", ""), Cell::Number((case + 1) as f64))];
        for (place, key) in self.cases.keys.iter().enumerate() {
            let shown =
                self.cases.rows[case].get(place).and_then(Option::as_ref).map(|setting| &setting.shown);
            let cell = shown.map_or(Cell::Empty, |shown| self.cell(place, shown));
            let unit = match (&key.unit, self.numeric[place]) {
                (Some(unit), true) => Some(unit.clone()),
                (None, true) => Some(String::new()),
                (_, false) => None,
            };
            row.push((Column { name: key.name.clone(), unit }, cell));
        }
        let (name, own) = match &self.names[case] {
            Err(why) => ("", failed(why)),
            Ok(name) => {
                let not_run = || {
                    vec![
                        (Column::text("status"), Cell::Text("not run".into())),
                        (Column::text("reason"), Cell::Empty),
                    ]
                };
                (name.as_str(), self.store.get(name)?.unwrap_or_else(not_run))
            }
        };
        row.push((Column::text("file"), Cell::Text(name.to_string())));
        row.extend(own);
        Ok(row)
    }

    fn cell(&self, place: usize, shown: &str) -> Cell {
        match shown.parse() {
            Ok(number) if self.numeric[place] => Cell::Number(number),
            _ => Cell::Text(shown.to_string()),
        }
    }

    /// Writes `summary.csv` and, where the program can, `summary.parquet`.
    ///
    /// # Errors
    /// If files cannot be read or written.
    pub fn write_summary(&self, directory: &Path) -> Result<Counts, SweepError> {
        let cases = self.names.len();
        // Cases of other settings have other columns: all that there are, each behind those that it was first seen behind.
        let mut columns: Vec<Column> = vec![];
        let mut places: HashMap<String, usize> = HashMap::new();
        let mut counts = Counts::default();
        for case in 0..cases {
            for (column, cell) in self.row(case)? {
                if column.name == "status" {
                    match cell.to_text().as_str() {
                        "done" => counts.done += 1,
                        "failed" => counts.failed += 1,
                        _ => counts.not_run += 1,
                    }
                }
                if let Entry::Vacant(place) = places.entry(column.to_string()) {
                    place.insert(columns.len());
                    columns.push(column);
                }
            }
        }
        let filled = |case: usize| -> Result<Vec<Cell>, SweepError> {
            let mut cells = vec![Cell::Empty; columns.len()];
            for (column, cell) in self.row(case)? {
                if let Some(place) = places.get(&column.to_string()) {
                    cells[*place] = cell;
                }
            }
            Ok(cells)
        };
        let path = directory.join("summary.csv");
        let failed = |why: std::io::Error| SweepError::file("write", &path, &why);
        let part = aside(&path);
        let mut table = csv::Writer::from_path(&part).map_err(|why| failed(why.into()))?;
        table.write_record(columns.iter().map(Column::to_string)).map_err(|why| failed(why.into()))?;
        for case in 0..cases {
            let cells = filled(case)?;
            table.write_record(cells.iter().map(Cell::to_text)).map_err(|why| failed(why.into()))?;
        }
        table.flush().and_then(|()| fs::rename(&part, &path)).map_err(failed)?;
        #[cfg(feature = "parquet")]
        {
            let path = directory.join("summary.parquet");
            let failed = |why: std::io::Error| SweepError::file("write", &path, &why);
            let part = aside(&path);
            let mut table = ParquetWriter::create(&part, columns.clone()).map_err(failed)?;
            for case in 0..cases {
                table.push(filled(case)?.into_iter()).map_err(failed)?;
            }
            table.finish().and_then(|()| fs::rename(&part, &path)).map_err(failed)?;
        }
        Ok(counts)
    }
}
