//! Values of keys, as tables of cases and ranges give them.

use toml::{Table, Value};

/// A value of a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// As its reader wrote it; a number without the unit that the column has.
    pub shown: String,
    /// As a scene file has it.
    pub toml: String,
}

impl Setting {
    /// A value as a scene file has it.
    pub(super) fn of_value(value: &Value) -> Self {
        let toml = value.to_string();
        let shown = value.as_str().map_or_else(|| toml.clone(), str::to_string);
        Self { shown, toml }
    }

    /// A cell of a table: what a scene file could have there; anything else is a text.
    pub fn of_cell(cell: &str, unit: Option<&str>) -> Self {
        let text = |text: String| Value::String(text).to_string();
        let toml = match unit {
            // Values over time have units of their own.
            Some(_) if cell.starts_with(['{', '[']) => cell.to_string(),
            Some(unit) => text(format!("{cell} {unit}")),
            None if cell.parse::<Value>().is_ok() => cell.to_string(),
            None => text(cell.to_string()),
        };
        Self { shown: cell.to_string(), toml }
    }
}

/// Keys of a table and of the tables in it, dotted, and their values; tables for which `is_value` holds are values themselves.
pub(super) fn leaves<'a>(table: &'a Table, is_value: &dyn Fn(&Table) -> bool) -> Vec<(String, &'a Value)> {
    let mut found = vec![];
    for (name, value) in table {
        match value {
            Value::Table(inner) if !is_value(inner) => {
                found.extend(
                    leaves(inner, is_value).into_iter().map(|(key, value)| (format!("{name}.{key}"), value)),
                );
            }
            value => found.push((name.clone(), value)),
        }
    }
    found
}
