//! The loads that a machine meets over its life: the entries `[[duty]]` of a scene.

use serde::Deserialize;
use toml::{Table, Value};

use super::error::SceneError;
use super::numbers::Range;

/// [-] entries of a duty at most.
const MOST: usize = 1000;
/// [-] shares of the time.
const SHARE: Range = Range::above(0.0, 1e9, "");
/// \[h] times in a load.
const HOURS: Range = Range::above(0.0, 1e9, "h");

/// A load that the machine meets for a part of its life: an entry `[[duty]]`. `roulement rating` adds up what all of them take of the life.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct DutySection {
    /// Its name: letters, digits, _ and -.
    pub name: String,
    /// [-] share of the time, of the sum of all shares; exactly one of this and `hours` is given, the same of all entries.
    pub share: Option<f64>,
    /// \[h] time in this load over the whole duty, a number of hours.
    pub hours: Option<f64>,
    /// Keys of this file that are different, as sections or with dots between names: `{ load = { inner_speed = "3000 rpm" } }` or
    /// `{ "load.y.force" = "4 kN" }`.
    #[serde(default)]
    pub set: Table,
}

impl DutySection {
    /// [-] or \[h] part of the whole duty.
    pub fn part(&self) -> f64 {
        self.share.or(self.hours).unwrap_or(0.0)
    }

    /// Keys with their sections and values as a scene file has them.
    pub fn changes(&self) -> Vec<(String, String)> {
        let mut found = vec![];
        flatten("", &self.set, &mut found);
        found
    }
}

/// Takes sections apart down to values. A section of names is one; what is a value in itself, such as a list, is set as a whole.
fn flatten(before: &str, table: &Table, found: &mut Vec<(String, String)>) {
    for (name, value) in table {
        let key = if before.is_empty() { name.clone() } else { format!("{before}.{name}") };
        match value {
            Value::Table(inner) if !inner.is_empty() => flatten(&key, inner, found),
            value => found.push((key, value.to_string())),
        }
    }
}

/// Checks the entries of a duty: names of their own, and shares or hours of all.
///
/// # Errors
/// Names the key, the value and what is allowed.
pub fn check_duty(duty: &[DutySection]) -> Result<(), SceneError> {
    if duty.len() > MOST {
        let why = format!("{} loads are too many: allowed is [0, {MOST}]", duty.len());
        return Err(SceneError::conflict("duty", why));
    }
    let by_hours = duty.first().is_some_and(|first| first.hours.is_some());
    for (place, of) in duty.iter().enumerate() {
        let key = |name: &str| format!("duty[{place}].{name}");
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if of.name.is_empty() || !of.name.chars().all(plain) {
            let why =
                format!("\"{}\" is no name: allowed are letters, digits, _ and -, such as climb", of.name);
            return Err(SceneError::conflict(key("name"), why));
        }
        if duty[..place].iter().any(|other| other.name == of.name) {
            let why = format!("\"{}\" is the name of another load: each needs one of its own", of.name);
            return Err(SceneError::conflict(key("name"), why));
        }
        match (of.share, of.hours) {
            (Some(share), None) if !by_hours => SHARE.check(&key("share"), share)?,
            (None, Some(hours)) if by_hours => HOURS.check(&key("hours"), hours)?,
            (None, None) => {
                let why = "it is missing: the share of the time, or hours, that this load has";
                return Err(SceneError::conflict(key("share"), why));
            }
            _ => {
                let why = "one of share and hours is given, the same in all entries";
                return Err(SceneError::conflict(key(if by_hours { "hours" } else { "share" }), why));
            }
        }
        if of.set.contains_key("duty") {
            return Err(SceneError::conflict(key("set.duty"), "a load has no duty of its own"));
        }
    }
    Ok(())
}
