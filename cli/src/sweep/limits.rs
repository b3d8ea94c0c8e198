//! Limits of chosen columns: `clearance<0` asks for the time at which a run first comes there.

use crate::report::results::{ResultsError, fits};

/// A limit of the columns that fit a pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// As it was written.
    pub text: String,
    pattern: String,
    below: bool,
    value: f64,
}

/// The columns that a choice with or without a limit is of.
pub fn bare(chosen: &str) -> &str {
    chosen.split(['<', '>']).next().unwrap_or(chosen).trim_end()
}

/// All of them.
pub fn all_bare(chosen: &[String]) -> Vec<String> {
    chosen.iter().map(|of| bare(of).to_owned()).collect()
}

impl Limit {
    /// Limits among choices.
    ///
    /// # Errors
    /// If one has no number.
    pub fn all(chosen: &[String]) -> Result<Vec<Self>, ResultsError> {
        let of = |text: &String| {
            let (pattern, value) = text.split_once(['<', '>'])?;
            let value =
                value.trim_start_matches('=').trim().parse().ok().filter(|value| f64::is_finite(*value));
            let limit = |value| Self {
                text: text.clone(),
                pattern: pattern.trim_end().to_owned(),
                below: text.contains('<'),
                value,
            };
            Some(value.map(limit).ok_or_else(|| ResultsError::Limit(text.clone())))
        };
        chosen.iter().filter_map(of).collect()
    }

    /// Is it one of a column?
    pub fn is_of(&self, column: &str) -> bool {
        fits(column, &self.pattern)
    }

    /// Is a value there, or beyond?
    pub fn is_met(&self, value: f64) -> bool {
        if self.below { value <= self.value } else { value >= self.value }
    }
}
