//! Result table of a run: CSV with units in the header, columns from the variable table, where every row is in the file when the
//! next one is computed; or Parquet.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use thiserror::Error;

use roulement::interface::variables::Variables;
use roulement::scene::Scene;
use roulement::scene::units::{Quantity, Time};
use roulement::simulation::inputs::Inputs;
use roulement::simulation::outputs::Outputs;

use super::acceleration::{self, Accelerations};
use super::machine_columns::named;
use super::number;
#[cfg(feature = "parquet")]
use super::{
    cells::{Cell, Column},
    parquet::ParquetWriter,
};

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
    /// A limit that cannot be read.
    #[error("--columns {0}: a limit is a column, < or >, and a number in SI, such as `clearance<0`")]
    Limit(String),
}

/// Columns and rows of a run that are written.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Names of columns with `*` for any characters; empty is all.
    pub columns: Vec<String>,
    /// Time of the rows.
    pub window: Window,
}

impl Choice {
    /// Is a column chosen?
    pub fn wants(&self, name: &str) -> bool {
        self.columns.is_empty() || self.columns.iter().any(|pattern| fits(name, pattern))
    }

    /// Is an acceleration chosen? By a pattern that names it alone: its values go by the distance of rows, those of all other columns do not.
    pub fn asks(&self, acceleration: &str) -> bool {
        self.columns.iter().any(|pattern| pattern.contains("acceleration") && fits(acceleration, pattern))
    }
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
pub fn fits(name: &str, pattern: &str) -> bool {
    match pattern.split_once('*') {
        None => name == pattern,
        Some((head, rest)) => name.strip_prefix(head).is_some_and(|tail| {
            let ends = (0..=tail.len()).filter(|&i| tail.is_char_boundary(i));
            ends.into_iter().any(|i| fits(&tail[i..], rest))
        }),
    }
}

/// The columns of a result table: the time, those variables of a scene that are chosen, and accelerations that are asked for.
pub struct Columns {
    variables: Variables,
    /// Rows of the variable table that are written.
    chosen: Vec<usize>,
    /// Accelerations that are written, by the rows of their velocities.
    accelerated: Vec<(usize, String)>,
    accelerations: Accelerations,
    window: Window,
}

/// Velocities among columns, by their index, with the names of the accelerations that a rule chooses; not those that are columns themselves.
pub(super) fn accelerated(names: &[&str], is_asked: impl Fn(&str) -> bool) -> Vec<(usize, String)> {
    let of = |(index, velocity): (usize, &&str)| {
        let (place, component) = acceleration::of_velocity(velocity)?;
        let name = acceleration::name(place, component);
        (is_asked(&name) && !names.contains(&name.as_str())).then_some((index, name))
    };
    names.iter().enumerate().filter_map(of).collect()
}

impl Columns {
    /// A column for the time and one for every chosen variable, those of each ball included.
    ///
    /// # Errors
    /// If a chosen column is not there.
    pub fn new(scene: &Scene, choice: &Choice) -> Result<Self, ResultsError> {
        let all = Self::that(scene, Window::default(), |_| true, |_| true);
        let missing = |pattern: &&String| !all.names().skip(1).any(|(name, _)| fits(name, pattern));
        match choice.columns.iter().find(missing) {
            Some(pattern) => Err(ResultsError::Column(pattern.clone())),
            None => Ok(Self::that(scene, choice.window, |name| choice.wants(name), |name| choice.asks(name))),
        }
    }

    /// Those that a rule chooses by their names, and accelerations that another one asks for.
    pub(super) fn that(
        scene: &Scene,
        window: Window,
        is_chosen: impl Fn(&str) -> bool,
        is_asked: impl Fn(&str) -> bool,
    ) -> Self {
        let variables = Variables::moving(scene, true);
        let names: Vec<&str> = variables.rows().iter().map(|row| row.name.as_str()).collect();
        let accelerated = accelerated(&names, is_asked);
        let chosen = (0..names.len()).filter(|i| is_chosen(names[*i])).collect();
        Self { variables, chosen, accelerated, accelerations: Accelerations::default(), window }
    }

    /// Those of a bearing of a machine that are chosen with its name before them; unknown names are passed over.
    pub(super) fn named(scene: &Scene, bearing: &str, choice: &Choice) -> Self {
        let own = |name: &str| named(bearing, name);
        Self::that(scene, choice.window, |name| choice.wants(&own(name)), |name| choice.asks(&own(name)))
    }

    /// Names and units, the time first.
    pub fn names(&self) -> impl Iterator<Item = (&str, &'static str)> {
        let of = |i: &usize| (self.variables.rows()[*i].name.as_str(), self.variables.rows()[*i].unit.name);
        let accelerations = self.accelerated.iter().map(|(_, name)| (name.as_str(), acceleration::UNIT));
        std::iter::once(("time", "s")).chain(self.chosen.iter().map(of)).chain(accelerations)
    }

    /// Takes a row; its values, if its time is in the window.
    pub fn row(&mut self, inputs: &Inputs, outputs: &Outputs) -> Option<impl Iterator<Item = f64>> {
        self.push(inputs, outputs);
        let values = std::iter::once(outputs.time).chain(self.values(inputs, outputs));
        self.window.contains(outputs.time).then_some(values)
    }

    /// Takes the velocities of a row.
    pub(super) fn push(&mut self, inputs: &Inputs, outputs: &Outputs) {
        let Self { variables, accelerated, accelerations, .. } = self;
        let value = |(i, _): &(usize, String)| variables.value(&variables.rows()[*i], inputs, outputs);
        accelerations.push(outputs.time, accelerated.iter().map(value));
    }

    /// Values of all but the time, of the row that was taken last.
    pub(super) fn values(&self, inputs: &Inputs, outputs: &Outputs) -> impl Iterator<Item = f64> {
        let value = move |i: &usize| self.variables.value(&self.variables.rows()[*i], inputs, outputs);
        self.chosen.iter().map(value).chain(self.accelerations.values().iter().copied())
    }
}

/// Where the rows of a table go.
enum Sink {
    /// Text, a line at once. A program that is killed leaves whole lines; of a last one, Linux may have written some pages.
    Csv { file: File, line: Vec<u8> },
    /// Columns.
    #[cfg(feature = "parquet")]
    Parquet(Box<ParquetWriter>),
}

/// A table of numbers being written: Parquet where its path ends so, else CSV.
pub struct TableWriter {
    sink: Sink,
    path: String,
}

impl TableWriter {
    /// Begins a table of columns with these names and units.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn create<'a>(
        path: &Path,
        names: impl Iterator<Item = (impl AsRef<str>, &'a str)>,
    ) -> Result<Self, ResultsError> {
        let name = path.display().to_string();
        let sink =
            Self::begin(path, names).map_err(|source| ResultsError::Write { path: name.clone(), source })?;
        Ok(Self { sink, path: name })
    }

    fn begin<'a>(path: &Path, names: impl Iterator<Item = (impl AsRef<str>, &'a str)>) -> io::Result<Sink> {
        if is_parquet(path) {
            #[cfg(feature = "parquet")]
            {
                let columns = names.map(|(name, unit)| Column::number(name.as_ref(), unit));
                return Ok(Sink::Parquet(Box::new(ParquetWriter::create(path, columns.collect())?)));
            }
            #[cfg(not(feature = "parquet"))]
            return Err(io::Error::other("this program was built without Parquet"));
        }
        let mut writer = csv::Writer::from_writer(vec![]);
        writer.write_record(names.map(|(name, unit)| format!("{} [{unit}]", name.as_ref())))?;
        let line = writer.into_inner().map_err(|why| io::Error::other(why.to_string()))?;
        let mut file = File::create(path)?;
        file.write_all(&line)?;
        Ok(Sink::Csv { file, line })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&mut self, values: impl Iterator<Item = f64>) -> Result<(), ResultsError> {
        let written = match &mut self.sink {
            Sink::Csv { file, line } => {
                line.clear();
                for value in values {
                    number::append(line, value);
                    line.push(b',');
                }
                if let Some(end) = line.last_mut() {
                    *end = b'\n';
                }
                file.write_all(line)
            }
            #[cfg(feature = "parquet")]
            Sink::Parquet(table) => table.push(values.map(Cell::Number)),
        };
        written.map_err(|source| ResultsError::Write { path: self.path.clone(), source })
    }

    /// Makes sure that every row is on the disk.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(self) -> Result<(), ResultsError> {
        let finished = match self.sink {
            Sink::Csv { file, .. } => file.sync_data(),
            #[cfg(feature = "parquet")]
            Sink::Parquet(table) => table.finish(),
        };
        match finished {
            // Devices and pipes have nothing to sync.
            Err(why) if ![io::ErrorKind::InvalidInput, io::ErrorKind::Unsupported].contains(&why.kind()) => {
                Err(ResultsError::Write { path: self.path, source: why })
            }
            _ => Ok(()),
        }
    }
}

/// Does a file's name ask for Parquet?
pub fn is_parquet(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"))
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
