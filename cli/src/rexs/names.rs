//! Names of a machine's parts from those of a REXS model: letters, digits, _ and -, each its own.

use std::collections::HashSet;

use super::model::Component;

/// Names that are taken.
#[derive(Debug, Default)]
pub struct Names {
    taken: HashSet<String>,
}

impl Names {
    /// A name for a component: its own without what names do not have, or what it is with its number.
    pub fn of(&mut self, component: &Component, what: &str) -> String {
        // Programs add type and number in brackets: they are no part of the name.
        let plain = plain(component.name.split(['[', '(']).next().unwrap_or_default());
        let name = match plain.is_empty() {
            true => format!("{what}-{}", component.id),
            false if self.taken.contains(&plain) => format!("{plain}-{}", component.id),
            false => plain,
        };
        self.taken.insert(name.clone());
        name
    }
}

/// A text without characters that names do not have.
pub fn plain(text: &str) -> String {
    let mut found = String::new();
    for char in text.chars() {
        match char {
            'ä' => found += "ae",
            'ö' => found += "oe",
            'ü' => found += "ue",
            'Ä' => found += "Ae",
            'Ö' => found += "Oe",
            'Ü' => found += "Ue",
            'ß' => found += "ss",
            _ if char.is_ascii_alphanumeric() || char == '_' => found.push(char),
            _ if !found.is_empty() && !found.ends_with('-') => found.push('-'),
            _ => {}
        }
    }
    found.trim_end_matches('-').to_owned()
}
