//! Result table of a run: CSV with units in the header, columns from the variable table. Every row is in the file when the
//! next one is computed.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use thiserror::Error;

use roulement::interface::variables::Variables;
use roulement::scene::Scene;
use roulement::scene::units::{Quantity, Time};
use roulement::simulation::inputs::Inputs;
use roulement::simulation::outputs::Outputs;

use super::number;

/// Why results could not be written.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// A file that cannot be made or written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// File.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// A column that is not there.
    #[error("--columns {0}: there is no such column; `*` stands for any characters, time is always there")]
    Column(String),
}

/// What of a run is written.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Names of columns with `*` for any characters; empty is all.
    pub columns: Vec<String>,
    /// Time of the rows.
    pub window: Window,
}

/// \[s] span of time, ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// First time.
    pub from: f64,
    /// Last time.
    pub to: f64,
}

impl Default for Window {
    fn default() -> Self {
        Self { from: f64::NEG_INFINITY, to: f64::INFINITY }
    }
}

impl Window {
    /// Is a time in it? A last digit beyond its ends is.
    pub fn contains(&self, time: f64) -> bool {
        let rounding = 1e-9 * time.abs();
        time >= self.from - rounding && time <= self.to + rounding
    }
}

impl std::str::FromStr for Window {
    type Err = String;

    /// Reads `FROM:TO`, each a number of seconds or a text with a unit such as `10 ms`, or nothing.
    fn from_str(text: &str) -> Result<Self, String> {
        let (from, to) =
            text.split_once(':').ok_or_else(|| "write FROM:TO, such as \"10 ms:20 ms\"".to_string())?;
        let time = |text: &str, open: f64| match text.trim() {
            "" => Ok(open),
            text => text.parse().or_else(|_| Time::DIMENSION.parse(text)),
        };
        let window = Self { from: time(from, f64::NEG_INFINITY)?, to: time(to, f64::INFINITY)? };
        if window.from <= window.to {
            Ok(window)
        } else {
            Err(format!("it must not end before it begins: {} s, {} s", window.from, window.to))
        }
    }
}

/// Does a name fit a pattern in which `*` stands for any characters?
fn fits(name: &str, pattern: &str) -> bool {
    match pattern.split_once('*') {
        None => name == pattern,
        Some((head, rest)) => name.strip_prefix(head).is_some_and(|tail| {
            let ends = (0..=tail.len()).filter(|&i| tail.is_char_boundary(i));
            ends.into_iter().any(|i| fits(&tail[i..], rest))
        }),
    }
}

/// A result table being written.
pub struct ResultsWriter {
    variables: Variables,
    /// Rows of the variable table that are written.
    chosen: Vec<usize>,
    window: Window,
    /// Text of a row.
    line: Vec<u8>,
    file: File,
    path: String,
}

impl ResultsWriter {
    /// Begins a table with a column for the time and one for every chosen variable, those of each ball included.
    ///
    /// # Errors
    /// If the file cannot be written, or a chosen column is not there.
    pub fn create(path: &Path, scene: &Scene, choice: &Choice) -> Result<Self, ResultsError> {
        let name = path.display().to_string();
        let variables = Variables::moving(scene, true);
        let names = || variables.rows().iter().map(|row| row.name.as_str());
        if let Some(pattern) = choice.columns.iter().find(|pattern| !names().any(|name| fits(name, pattern)))
        {
            return Err(ResultsError::Column(pattern.clone()));
        }
        let wanted = |name: &str| {
            choice.columns.is_empty() || choice.columns.iter().any(|pattern| fits(name, pattern))
        };
        let chosen: Vec<usize> =
            names().enumerate().filter(|(_, name)| wanted(name)).map(|(i, _)| i).collect();
        let header = chosen.iter().map(|&i| {
            let row = &variables.rows()[i];
            format!("{} [{}]", row.name, row.unit.name)
        });
        let header: Vec<String> = std::iter::once("time [s]".to_string()).chain(header).collect();
        let file = File::create(path).map_err(|source| ResultsError::Write { path: name.clone(), source })?;
        let mut table = Self { variables, chosen, window: choice.window, line: vec![], file, path: name };
        table.write_header(&header)?;
        Ok(table)
    }

    /// Adds a row, if its time is in the window.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&mut self, inputs: &Inputs, outputs: &Outputs) -> Result<(), ResultsError> {
        if !self.window.contains(outputs.time) {
            return Ok(());
        }
        let rows = self.variables.rows();
        self.line.clear();
        number::append(&mut self.line, outputs.time);
        for &i in &self.chosen {
            self.line.push(b',');
            number::append(&mut self.line, self.variables.value(&rows[i], inputs, outputs));
        }
        self.line.push(b'\n');
        // At once: a program that is killed leaves whole lines.
        self.file.write_all(&self.line).map_err(|source| self.failed(source))
    }

    fn write_header(&mut self, names: &[String]) -> Result<(), ResultsError> {
        let mut writer = csv::Writer::from_writer(vec![]);
        let line = writer
            .write_record(names)
            .map_err(io::Error::from)
            .and_then(|()| writer.into_inner().map_err(|why| io::Error::other(why.to_string())));
        line.and_then(|line| self.file.write_all(&line)).map_err(|source| self.failed(source))
    }

    fn failed(&self, source: io::Error) -> ResultsError {
        ResultsError::Write { path: self.path.clone(), source }
    }

    /// Makes sure that every row is on the disk.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(self) -> Result<(), ResultsError> {
        match self.file.sync_data() {
            // Devices and pipes have nothing to sync.
            Err(why) if ![io::ErrorKind::InvalidInput, io::ErrorKind::Unsupported].contains(&why.kind()) => {
                Err(ResultsError::Write { path: self.path, source: why })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_and_windows_are_read() {
        assert!(fits("inner.force.x", "inner.force.x") && !fits("inner.force.x", "inner.force"));
        assert!(fits("ball[10].outer.load", "ball[*].outer.load") && fits("ball[1].outer.load", "ball*"));
        assert!(!fits("ball[1].outer.load", "*.inner.*") && fits("x", "*"));
        let window: Window = "10 ms:0.02".parse().unwrap_or_default();
        assert_eq!(window, Window { from: 0.01, to: 0.02 });
        assert!(
            window.contains(0.02 * (1.0 + 1e-15)) && !window.contains(0.0201) && !window.contains(0.0099)
        );
        assert_eq!(":".parse(), Ok(Window::default()));
        for (wrong, part) in [("10 ms", "FROM:TO"), ("2:1", "before it begins"), ("1 kg:", "1 kg")] {
            assert!(wrong.parse::<Window>().is_err_and(|why| why.contains(part)), "{wrong}");
        }
    }
}
