//! A scripted quantity: constant, or a table of time and value.

use serde::Deserialize;
use serde::de::{Deserializer, Error};

use super::units::{Quantity, Time};

/// A value over time: constant, or piecewise linear through `(time [s], value)`, held before and after the table.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// One value at all times.
    Constant(f64),
    /// Points with strictly growing times; at least one.
    Table(Vec<(f64, f64)>),
}

impl Schedule {
    /// Value at a time \[s].
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

    /// Value and rate at a time \[s] of a smooth motion through the points of a table: monotone cubic (Fritsch and
    /// Carlson 1980), at rest at both ends, so that a scripted displacement has no jump in speed.
    pub fn smooth_at(&self, time: f64) -> (f64, f64) {
        let Self::Table(points) = self else {
            return (self.at(time), 0.0);
        };
        let next = points.partition_point(|&(t, _)| t <= time);
        let (Some(&(t1, v1)), Some(&(t0, v0))) = (points.get(next), points.get(next.wrapping_sub(1))) else {
            return (self.at(time), 0.0);
        };
        // Harmonic mean of the secants on both sides; 0 at extrema and at the ends.
        let slope = |i: usize| -> f64 {
            if i == 0 || i + 1 == points.len() {
                return 0.0;
            }
            let secant = |j: usize| (points[j + 1].1 - points[j].1) / (points[j + 1].0 - points[j].0);
            let (left, right) = (secant(i - 1), secant(i));
            if left * right <= 0.0 { 0.0 } else { 2.0 * left * right / (left + right) }
        };
        let (duration, s) = (t1 - t0, (time - t0) / (t1 - t0));
        let (m0, m1) = (slope(next - 1) * duration, slope(next) * duration);
        let rise = v1 - v0;
        let value = v0 + s * (m0 + s * (3.0 * rise - 2.0 * m0 - m1 + s * (m0 + m1 - 2.0 * rise)));
        let rate = m0 + s * (2.0 * (3.0 * rise - 2.0 * m0 - m1) + 3.0 * s * (m0 + m1 - 2.0 * rise));
        (value, rate / duration)
    }

    /// \[1/s] rate of change of the value just before a time \[s]; before a table and after it, 0.
    pub fn slope(&self, time: f64) -> f64 {
        let Self::Table(points) = self else {
            return 0.0;
        };
        let next = points.partition_point(|&(t, _)| t < time);
        match (points.get(next), points.get(next.wrapping_sub(1))) {
            (Some(&(t1, v1)), Some(&(t0, v0))) => (v1 - v0) / (t1 - t0),
            _ => 0.0,
        }
    }

    /// Integral of the value from one time \[s] to another, exact for the straight pieces of a table.
    pub fn integral(&self, from: f64, to: f64) -> f64 {
        match self {
            Self::Constant(value) => value * (to - from),
            Self::Table(points) => area(points, to) - area(points, from),
        }
    }

    /// Does the value come from a table?
    pub fn is_table(&self) -> bool {
        matches!(self, Self::Table(_))
    }

    /// \[s] times after `from` and before `to` at which a table bends.
    pub fn knots(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        let points: &[(f64, f64)] = match self {
            Self::Constant(_) => &[],
            Self::Table(points) => points,
        };
        let first = points.partition_point(|&(time, _)| time <= from);
        points[first..].iter().map(|&(time, _)| time).take_while(move |&time| time < to)
    }

    /// The value, to be changed, of a schedule that is the same at all times.
    pub fn constant_mut(&mut self) -> Option<&mut f64> {
        match self {
            Self::Constant(value) => Some(value),
            Self::Table(_) => None,
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

/// Area below a table from its first point to a time \[s]; negative before that point.
fn area(points: &[(f64, f64)], time: f64) -> f64 {
    let (first, last) = (points[0], points[points.len() - 1]);
    let mut sum = first.1 * (time.min(first.0) - first.0);
    for pair in points.windows(2) {
        let ((t0, v0), (t1, v1)) = (pair[0], pair[1]);
        if time <= t0 {
            break;
        }
        let end = time.min(t1);
        let value = v0 + (v1 - v0) * ((end - t0) / (t1 - t0));
        sum += 0.5 * (v0 + value) * (end - t0);
    }
    sum + last.1 * (time.max(last.0) - last.0)
}

const PAIRS: &str = "a table over time is a list of pairs [time, value], such as [[0, 0], [\"10 ms\", 1]]";

/// A quantity in SI; errors in one sentence, without the parser's marks.
fn read<Q: Quantity + for<'a> Deserialize<'a>, E: Error>(value: toml::Value) -> Result<f64, E> {
    Q::deserialize(value).map(Quantity::si).map_err(|why| E::custom(why.message()))
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
        return Ok(Schedule::Constant(read::<Q, D::Error>(value)?));
    };
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(rows.len());
    for row in rows {
        let toml::Value::Array(mut row) = row else {
            return Err(Error::custom(PAIRS));
        };
        let (Some(value), Some(time), true) = (row.pop(), row.pop(), row.is_empty()) else {
            return Err(Error::custom(PAIRS));
        };
        let time = read::<Time, D::Error>(time)?;
        if points.last().is_some_and(|&(last, _)| last >= time) {
            return Err(Error::custom(format!("table times must grow, but {time} s does not")));
        }
        points.push((time, read::<Q, D::Error>(value)?));
    }
    if points.is_empty() { Err(Error::custom("the table is empty")) } else { Ok(Schedule::Table(points)) }
}
