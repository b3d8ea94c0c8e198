//! Columns and cells of tables that hold numbers and texts.

use std::fmt;

/// A column.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Column {
    /// Name.
    pub name: String,
    /// Unit of numbers, empty where it is not shown; none for texts.
    pub unit: Option<String>,
}

impl Column {
    /// A column of numbers.
    pub fn number(name: &str, unit: &str) -> Self {
        Self { name: name.to_string(), unit: Some(unit.to_string()) }
    }

    /// A column of texts.
    pub fn text(name: &str) -> Self {
        Self { name: name.to_string(), unit: None }
    }
}

/// A cell of a row.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Cells of a column of numbers.
    Number(f64),
    /// Cells of a column of texts.
    Text(String),
    /// Cells of any column.
    Empty,
}

impl fmt::Display for Column {
    /// As in the header of a CSV file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.unit {
            Some(unit) if !unit.is_empty() => write!(f, "{} [{unit}]", self.name),
            _ => f.write_str(&self.name),
        }
    }
}

impl Column {
    /// Reads what a header says.
    pub fn from_header(text: &str) -> Self {
        match text.strip_suffix(']').and_then(|text| text.split_once(" [")) {
            Some((name, unit)) => Self::number(name, unit),
            None => Self::text(text),
        }
    }
}

impl Cell {
    /// As in a CSV file: numbers to the last bit.
    pub fn to_text(&self) -> String {
        match self {
            Self::Number(number) => {
                let mut text = vec![];
                super::number::append(&mut text, *number);
                String::from_utf8_lossy(&text).into_owned()
            }
            Self::Text(text) => text.clone(),
            Self::Empty => String::new(),
        }
    }
}
