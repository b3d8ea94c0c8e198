//! The summary of a sweep: a row for every case in the order of the cases, whatever finished first.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use super::SweepError;
use super::all::Sweep;
use super::case::{Row, WARNINGS, failed};
use super::store::aside;
use crate::report::cells::{Cell, Column};
#[cfg(feature = "parquet")]
use crate::report::parquet::ParquetWriter;

/// How many cases ended how.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// With a result.
    pub done: usize,
    /// Without one.
    pub failed: usize,
    /// Not yet.
    pub not_run: usize,
    /// With a result and warnings.
    pub warned: usize,
    /// The first of these, counted from 1, and what it warns of.
    pub first_warning: Option<(usize, String)>,
}

impl Sweep {
    /// Row of a case with its number and its keys before what came of it.
    fn row(&self, case: usize) -> Row {
        let mut row: Row = vec![(Column::number("case", ""), Cell::Number(self.cases.number(case) as f64))];
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
                (name.as_str(), self.store.get(name).unwrap_or_else(not_run))
            }
        };
        row.push((Column::text("file"), Cell::Text(name.to_string())));
        row.extend(own);
        row
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
    /// If files cannot be written.
    pub fn write_summary(&self, directory: &Path) -> Result<Counts, SweepError> {
        let cases = self.names.len();
        // Cases of other settings have other columns: all that there are, each behind those that it was first seen behind.
        let mut table = Columns::default();
        let mut counts = Counts::default();
        for case in 0..cases {
            let row = self.row(case);
            match row
                .iter()
                .find(|(column, _)| column.name == "status")
                .map(|(_, cell)| cell.to_text())
                .as_deref()
            {
                Some("done") => counts.done += 1,
                Some("failed") => counts.failed += 1,
                _ => counts.not_run += 1,
            }
            let warns = |(column, cell): &(Column, Cell)| {
                let said = column.name.rsplit('.').next() == Some(WARNINGS) && column.unit.is_none();
                Some(cell.to_text()).filter(|text| said && !text.is_empty())
            };
            if let Some(warning) = row.iter().find_map(warns) {
                counts.warned += 1;
                counts.first_warning.get_or_insert((self.cases.number(case), warning));
            }
            table.see(&row);
        }
        let csv_path = directory.join("summary.csv");
        let csv_part = aside(&csv_path);
        let failed = |why: std::io::Error| SweepError::file("write", &csv_path, &why);
        let mut csv = csv::Writer::from_path(&csv_part).map_err(|why| failed(why.into()))?;
        csv.write_record(table.columns.iter().map(Column::to_string)).map_err(|why| failed(why.into()))?;
        #[cfg(feature = "parquet")]
        let (path, part) = {
            let path = directory.join("summary.parquet");
            let part = aside(&path);
            (path, part)
        };
        #[cfg(feature = "parquet")]
        let not_written = |why: std::io::Error| SweepError::file("write", &path, &why);
        #[cfg(feature = "parquet")]
        let mut parquet = ParquetWriter::create(&part, table.columns.clone()).map_err(not_written)?;
        for case in 0..cases {
            let cells = table.fill(self.row(case));
            csv.write_record(cells.iter().map(Cell::to_text)).map_err(|why| failed(why.into()))?;
            #[cfg(feature = "parquet")]
            parquet.push(cells.into_iter()).map_err(not_written)?;
        }
        csv.flush().and_then(|()| fs::rename(&csv_part, &csv_path)).map_err(failed)?;
        #[cfg(feature = "parquet")]
        parquet.finish().and_then(|()| fs::rename(&part, &path)).map_err(not_written)?;
        Ok(counts)
    }
}

/// The columns of a summary.
#[derive(Default)]
struct Columns {
    columns: Vec<Column>,
    places: HashMap<Column, usize>,
    /// Columns of the row that was seen last, and their places: those of most rows.
    last: (Vec<Column>, Vec<usize>),
}

impl Columns {
    /// Takes in the columns of a row.
    fn see(&mut self, row: &Row) {
        if self.last.0.iter().eq(row.iter().map(|(column, _)| column)) {
            return;
        }
        for (column, _) in row {
            let next = self.columns.len();
            if *self.places.entry(column.clone()).or_insert(next) == next {
                self.columns.push(column.clone());
            }
        }
        self.last.0 = row.iter().map(|(column, _)| column.clone()).collect();
        self.last.1 = self.last.0.iter().map(|column| self.places[column]).collect();
    }

    /// A row with a cell for every column.
    fn fill(&mut self, row: Row) -> Vec<Cell> {
        self.see(&row);
        let mut cells = vec![Cell::Empty; self.columns.len()];
        for ((_, cell), place) in row.into_iter().zip(&self.last.1) {
            cells[*place] = cell;
        }
        cells
    }
}
