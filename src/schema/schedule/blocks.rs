//! Schedules as a scene has them: a number, a table `[[time, value], ...]`, or one of the building blocks
//!
//! ```toml
//! { ramp = ["0 N", "2 kN"], from = "1 ms", to = "5 ms" }
//! { step = ["0 N", "2 kN"], at = "1 ms", rise = "10 us" }
//! { mean = "1 kN", amplitude = "100 N", frequency = "2.3 kHz", phase = "90 deg", begin = "1 ms" }
//! { table = [[0, 0.5], [1e-3, 0.7]], unit = "kN", scale = 2.0, offset = "10 N" }
//! { file = "measured.csv", time = "t [ms]", value = "Fy [N]", scale = 2.0, offset = "10 N" }
//! { sum = ["1 kN", { amplitude = "100 N", frequency = "50 Hz" }] }
//! ```
//!
//! A file is replaced by the table that is in it ([`super::files`]) before anything of this is read.

use serde::Deserialize;
use serde::de::{Deserializer, Error};
use toml::{Table, Value};

use super::{Schedule, Sine};
use crate::schema::numbers::Range;
use crate::schema::units::{Angle, Dimension, Frequency, Quantity, Ratio, Time, Unit};

/// \[s] times in schedules.
const TIME: Range = Range::closed(-1e6, 1e6, "s");
/// \[s] durations of a rise.
const RISE: Range = Range::above(0.0, 1e6, "s");
/// \[s] rise of a step, where none is given: short for machines, and long enough for a motion to be possible.
const DEFAULT_RISE: f64 = 1e-5;
const FREQUENCY: Range = Range::closed(1e-6, 1e6, "Hz");
const PHASE: Range = Range::closed(-7.0, 7.0, "rad");
const SCALE: Range = Range::closed(-1e12, 1e12, "");

/// A building block by its keys.
struct Kind {
    /// Name in messages.
    name: &'static str,
    /// Keys by one of which it is known.
    marks: &'static [&'static str],
    /// All its keys.
    keys: &'static [&'static str],
}

const KINDS: [Kind; 6] = [
    Kind { name: "a ramp", marks: &["ramp"], keys: &["ramp", "from", "to"] },
    Kind { name: "a step", marks: &["step"], keys: &["step", "at", "rise"] },
    Kind {
        name: "a sine",
        marks: &["amplitude", "frequency"],
        keys: &["mean", "amplitude", "frequency", "phase", "begin"],
    },
    Kind { name: "a table", marks: &["table"], keys: &["table", "unit", "scale", "offset", "source"] },
    Kind { name: "a file", marks: &["file"], keys: &super::files::KEYS },
    Kind { name: "a sum", marks: &["sum"], keys: &["sum"] },
];
const PAIRS: &str = "a table over time is a list of pairs [time, value], such as [[0, 0], [\"10 ms\", 1]]";
const BLOCKS: &str = "a value over time is a number, a list [[time, value], ...], or a table with one of the keys ramp, \
                      step, amplitude, table, file, sum, such as { ramp = [0, 1], from = 0, to = \"5 ms\" }";

/// Is a table of a scene a building block of a schedule, and no section?
pub fn is_block(table: &Table) -> bool {
    KINDS.iter().any(|kind| kind.marks.iter().any(|mark| table.contains_key(*mark)))
}

/// Reads a schedule whose values are quantities of dimension `Q`, numbers in SI or text with units.
///
/// # Errors
/// Those of the deserializer; also an empty table, times that do not grow, and building blocks with keys or numbers that are
/// not allowed.
pub fn deserialize<'de, Q: Quantity, D: Deserializer<'de>>(deserializer: D) -> Result<Schedule, D::Error> {
    of_value(&Value::deserialize(deserializer)?, &Q::DIMENSION).map_err(D::Error::custom)
}

/// A schedule that may be left out.
///
/// # Errors
/// As [`deserialize`].
pub(in crate::schema) fn some_schedule<'de, Q: Quantity, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Schedule>, D::Error> {
    deserialize::<Q, D>(deserializer).map(Some)
}

/// Schedule of a value of TOML.
///
/// # Errors
/// One sentence.
pub fn of_value(value: &Value, of: &'static Dimension) -> Result<Schedule, String> {
    match value {
        Value::Array(rows) => points(rows, |value| of.read(value)).map(Schedule::Table),
        Value::Table(table) => block(table, of),
        value => of.read(value).map(Schedule::Constant),
    }
}

/// Points of a table whose values are read in some way.
fn points(rows: &[Value], read: impl Fn(&Value) -> Result<f64, String>) -> Result<Vec<(f64, f64)>, String> {
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(rows.len());
    for row in rows {
        let Some([time, value]) = row.as_array().map(Vec::as_slice) else {
            return Err(PAIRS.to_string());
        };
        let time = allowed("time", Time::DIMENSION.read(time)?, TIME)?;
        if points.last().is_some_and(|&(last, _)| last >= time) {
            return Err(format!("table times must grow, but {time} s does not"));
        }
        points.push((time, read(value)?));
    }
    if points.is_empty() { Err("the table is empty".to_string()) } else { Ok(points) }
}

/// A number within its range.
fn allowed(key: &str, value: f64, range: Range) -> Result<f64, String> {
    range.check(key, value).map(|()| value).map_err(|why| why.to_string())
}

/// The keys of a building block.
struct Keys<'a> {
    name: &'static str,
    table: &'a Table,
}

impl Keys<'_> {
    /// A value of a key, if it is given.
    fn get(&self, key: &str, of: &'static Dimension) -> Result<Option<f64>, String> {
        let Some(value) = self.table.get(key) else { return Ok(None) };
        of.read(value).map(Some).map_err(|why| format!("{key}: {why}"))
    }

    /// A number of a key with its range, if it is given.
    fn number<Q: Quantity>(&self, key: &str, range: Range) -> Result<Option<f64>, String> {
        self.get(key, &Q::DIMENSION)?.map(|value| allowed(key, value, range)).transpose()
    }

    /// Value of a key that must be given.
    fn needed<T>(&self, key: &str, value: Option<T>) -> Result<T, String> {
        value.ok_or_else(|| format!("{} needs {key}", self.name))
    }

    /// Two values of a key.
    fn pair(&self, key: &str, of: &'static Dimension) -> Result<[f64; 2], String> {
        let values = self.table.get(key).and_then(Value::as_array);
        let Some([before, after]) = values.map(Vec::as_slice) else {
            return Err(format!("{key} is a list of two values, before and after, such as {key} = [0, 1]"));
        };
        let read = |value| of.read(value).map_err(|why| format!("{key}: {why}"));
        Ok([read(before)?, read(after)?])
    }
}

/// Reads a building block.
fn block(table: &Table, of: &'static Dimension) -> Result<Schedule, String> {
    let kind = KINDS.iter().find(|kind| kind.marks.iter().any(|mark| table.contains_key(*mark)));
    let kind = kind.ok_or_else(|| BLOCKS.to_string())?;
    if let Some(key) = table.keys().find(|key| !kind.keys.contains(&key.as_str())) {
        return Err(format!("{key} is no key of {}, which has {}", kind.name, kind.keys.join(", ")));
    }
    let keys = Keys { name: kind.name, table };
    match kind.marks[0] {
        "ramp" => {
            let [before, after] = keys.pair("ramp", of)?;
            let from = keys.number::<Time>("from", TIME)?.unwrap_or(0.0);
            let to = keys.number::<Time>("to", TIME)?;
            let to = keys.needed("to", to)?;
            allowed("to", to, Range::above(from, TIME.high, "s"))?;
            Ok(Schedule::Table(vec![(from, before), (to, after)]))
        }
        "step" => {
            let [before, after] = keys.pair("step", of)?;
            let at = keys.number::<Time>("at", TIME)?;
            let at = keys.needed("at", at)?;
            let rise = keys.number::<Time>("rise", RISE)?.unwrap_or(DEFAULT_RISE);
            if at + rise <= at {
                return Err(format!("rise = {rise} s is lost in rounding at {at} s"));
            }
            Ok(Schedule::Table(vec![(at, before), (at + rise, after)]))
        }
        "amplitude" => {
            let amplitude = keys.get("amplitude", of)?;
            let frequency = keys.number::<Frequency>("frequency", FREQUENCY)?;
            Ok(Schedule::Sine(Sine {
                mean: keys.get("mean", of)?.unwrap_or(0.0),
                amplitude: keys.needed("amplitude", amplitude)?,
                frequency: keys.needed("frequency", frequency)?,
                phase: keys.number::<Angle>("phase", PHASE)?.unwrap_or(0.0),
                begin: keys.number::<Time>("begin", TIME)?,
            }))
        }
        "table" => table_with_unit(&keys, of),
        "sum" => {
            let Some(Value::Array(values)) = keys.table.get("sum") else {
                return Err("sum is a list of values over time".to_string());
            };
            let read = |(place, value): (usize, &Value)| {
                of_value(value, of).map_err(|why| format!("sum[{place}]: {why}"))
            };
            let parts = values.iter().enumerate().map(read).collect::<Result<Vec<_>, _>>()?;
            sum(parts)
        }
        _ => Err("the file was not read: it needs time and value, the names of its columns".to_string()),
    }
}

/// A table with one unit for all values, a factor and an offset.
fn table_with_unit(keys: &Keys<'_>, of: &'static Dimension) -> Result<Schedule, String> {
    let scale = keys.number::<Ratio>("scale", SCALE)?.unwrap_or(1.0);
    let offset = keys.get("offset", of)?.unwrap_or(0.0);
    let source = keys.table.get("source").and_then(Value::as_str);
    let from = |why: String| source.map_or(why.clone(), |source| format!("{source}: {why}"));
    let Some(Value::Array(rows)) = keys.table.get("table") else {
        return Err(PAIRS.to_string());
    };
    let mut points = match keys.table.get("unit") {
        None => points(rows, |value| of.read(value)),
        Some(Value::String(written)) => {
            let unit: Unit = of
                .unit(written.trim())
                .map_err(|why| from(format!("unit = \"{written}\" is not that of {}: {why}", of.name)))?;
            points(rows, |value| match value {
                Value::Float(number) => Ok(unit.si(*number)),
                Value::Integer(number) => Ok(unit.si(*number as f64)),
                value => Err(format!("{value}: values of a table with a unit are numbers")),
            })
        }
        Some(unit) => Err(format!("unit = {unit} is no text, such as unit = \"kN\"")),
    }
    .map_err(from)?;
    points.iter_mut().for_each(|(_, value)| *value = scale * *value + offset);
    Ok(Schedule::Table(points))
}

/// The sum of some schedules, without sums in it.
fn sum(parts: Vec<Schedule>) -> Result<Schedule, String> {
    if parts.is_empty() {
        return Err("the sum is empty".to_string());
    }
    let mut constant = None;
    let mut scripted = vec![];
    for part in parts {
        match part {
            Schedule::Constant(value) => constant = Some(constant.unwrap_or(0.0) + value),
            Schedule::Sum(inner) => scripted.extend(inner),
            part => scripted.push(part),
        }
    }
    if scripted.is_empty() {
        return Ok(Schedule::Constant(constant.unwrap_or(0.0)));
    }
    Ok(Schedule::Sum(constant.map(Schedule::Constant).into_iter().chain(scripted).collect()))
}
