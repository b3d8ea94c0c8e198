//! Limits that a bearing meets in a run: largest values over all of it, told in its summary, its warnings and the tables of sweeps where
//! there are some. Each is defined by the effect that reports it.

use super::reports::Reports;
use crate::schema::variable_units::Unit;

/// Limit of one quantity, or of a few of a kind.
#[derive(Debug)]
pub struct Limit {
    /// Heading of its line in a summary.
    pub title: &'static str,
    /// Quantities; all are 0 where the limit is not met.
    pub quantities: &'static [Quantity],
    /// [-] factor of values in that line, and their digits.
    pub shown: (f64, usize),
    /// Line after its heading, from the texts of all quantities.
    pub line: fn(&[String]) -> String,
    /// Subject of verdicts before a run that say nothing more once the limit was met.
    pub subject: Option<&'static str>,
}

/// Quantity of a limit.
#[derive(Debug)]
pub struct Quantity {
    /// Name among the figures of a run.
    pub name: &'static str,
    /// Name among the columns of a sweep, before `.largest`.
    pub column: &'static str,
    /// Unit.
    pub unit: Unit,
    /// \[unit] value of a state; 0 where there is none.
    pub get: fn(&Reports<'_>) -> f64,
    /// Warning of a largest value that is not 0, in one sentence.
    pub warning: Option<fn(f64) -> String>,
}
