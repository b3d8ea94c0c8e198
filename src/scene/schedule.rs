//! A scripted quantity: constant, or a table of time and value.

use serde::Deserialize;
use serde::de::{Deserializer, Error};

use crate::units::{Quantity, Time};

/// A value over time: constant, or piecewise linear through `(time [s], value)`, held before and after the table.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// The same at all times.
    Constant(f64),
    /// Points with strictly growing times; at least one.
    Table(Vec<(f64, f64)>),
}

impl Schedule {
    /// Value at a time [s].
    pub fn at(&self, time: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(points) => {
                let next = points.partition_point(|&(t, _)| t <= time);
                let (Some(&(t1, v1)), Some(&(t0, v0))) = (points.get(next), points.get(next.wrapping_sub(1)))
                else {
                    return points[next.min(points.len() - 1)].1;
                };
                v0 + (v1 - v0) * ((time - t0) / (t1 - t0))
            }
        }
    }

    /// Rate of change at a time [1/s of the value's unit], of the segment that begins there.
    pub fn rate(&self, time: f64) -> f64 {
        match self {
            Self::Constant(_) => 0.0,
            Self::Table(points) => {
                let next = points.partition_point(|&(t, _)| t <= time);
                match (points.get(next), points.get(next.wrapping_sub(1))) {
                    (Some(&(t1, v1)), Some(&(t0, v0))) => (v1 - v0) / (t1 - t0),
                    _ => 0.0,
                }
            }
        }
    }

    /// All values the schedule passes through, for range checks.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::Constant(value) => vec![*value],
            Self::Table(points) => points.iter().map(|&(_, value)| value).collect(),
        }
    }
}

impl Default for Schedule {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

/// Reads a schedule whose values are quantities of dimension `Q`, numbers in SI or text with units.
///
/// # Errors
/// Those of the deserializer; also an empty table and times that do not grow.
pub fn deserialize<'de, Q: Quantity + for<'a> Deserialize<'a>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Schedule, D::Error> {
    let value = toml::Value::deserialize(deserializer)?;
    let toml::Value::Array(rows) = value else {
        return Ok(Schedule::Constant(
            Q::deserialize(value).map_err(Error::custom)?.si(),
        ));
    };
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(rows.len());
    for row in rows {
        let toml::Value::Array(mut row) = row else {
            return Err(Error::custom("a table is a list of [time, value] pairs"));
        };
        let (Some(value), Some(time), true) = (row.pop(), row.pop(), row.is_empty()) else {
            return Err(Error::custom("a table is a list of [time, value] pairs"));
        };
        let time = Time::deserialize(time).map_err(Error::custom)?.si();
        if points.last().is_some_and(|&(last, _)| last >= time) {
            return Err(Error::custom(format!(
                "table times must grow, but {time} s does not"
            )));
        }
        points.push((time, Q::deserialize(value).map_err(Error::custom)?.si()));
    }
    if points.is_empty() {
        Err(Error::custom("the table is empty"))
    } else {
        Ok(Schedule::Table(points))
    }
}
