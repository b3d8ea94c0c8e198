//! Errors in a scene's text in plain words: key, line, what was meant perhaps, and what to write.

use serde::de::DeserializeOwned;
use toml::Table;
use toml::de::{DeTable, DeValue};

use super::error::SceneError;
use super::reader;

/// Hints for keys that are missing: the end of the key, and what to write.
const HINTS: [(&str, &str); 13] = [
    (
        "bearing",
        "a scene needs a section [bearing] with balls, ball_diameter, pitch_diameter and contact_angle",
    ),
    (
        "load",
        "a scene needs a section [load], such as inner_speed = \"6000 rpm\" and x = { force = \"1500 N\" }",
    ),
    ("balls", "give the number of balls, such as balls = 10"),
    ("ball_diameter", "give it, such as ball_diameter = \"9.525 mm\""),
    (
        "pitch_diameter",
        "give the diameter of the circle through the ball centres, such as pitch_diameter = \"46 mm\"",
    ),
    ("cage.mass", "give it, such as mass = \"20 g\""),
    (
        "inertia",
        "give the moments about x, y and z, such as inertia = [\"11 kg mm^2\", \"6 kg mm^2\", \"6 kg mm^2\"]",
    ),
    ("pocket_clearance", "give the diametral clearance of a ball, such as pocket_clearance = \"0.2 mm\""),
    ("guided_by", "write guided_by = \"inner\", \"outer\" or \"balls\""),
    ("eta", IDENTIFY),
    ("beta", IDENTIFY),
    ("alpha", IDENTIFY),
    ("", "give it"),
];
const IDENTIFY: &str = "`roulement identify` prints it";

/// Kinds that the reader of numbers and texts wants, by its words, and ours.
const KINDS: [(&str, &str); 9] = [
    ("usize", "a whole number"),
    ("f64", "a number"),
    ("a boolean", "true or false"),
    ("a string", "text in quotes"),
    ("string or table", "text in quotes"),
    ("an array of length 2", "a list of 2 values"),
    ("an array of length 3", "a list of 3 values"),
    ("map", "a table"),
    ("sequence", "a list"),
];

/// A table of a text.
///
/// # Errors
/// If it is no TOML; with the spot \[bytes].
pub fn table(text: &str) -> Result<Table, (SceneError, Option<usize>)> {
    toml::from_str(text).map_err(|why: toml::de::Error| {
        let spot = why.span().map(|span| span.start);
        let at = spot.map_or(String::new(), |spot| format!(" at {:?}", line_text(text, spot)));
        let why = match why.message().split_once(", expected ") {
            Some((why, "nothing")) => why.to_string(),
            Some((why, wanted)) => format!("{why}; there should be {wanted}"),
            None => why.message().to_string(),
        };
        (SceneError::Format(format!("not TOML{at}: {why}")), spot)
    })
}

/// Reads the sections of a text.
///
/// # Errors
/// In words of the scene, with the spot \[bytes].
pub fn read<T: DeserializeOwned>(text: &str) -> Result<T, (SceneError, Option<usize>)> {
    reader::read(&table(text)?.into()).map_err(|why| {
        let key = why.key();
        let spot = if key.is_empty() { Some(0) } else { start_of(text, &key) };
        (SceneError::Format(in_words(&key, why.message())), spot)
    })
}

/// Adds the place of an error to it: the line of its key, or of the spot where the text cannot be read, and its file.
pub fn with_place(error: SceneError, text: &str, spot: Option<usize>, file: Option<&str>) -> SceneError {
    let start = match &error {
        SceneError::Range { key, .. } | SceneError::Conflict { key, .. } => start_of(text, key),
        _ => spot,
    };
    let line = start.map(|start| format!("line {}", 1 + text[..start].matches('\n').count()));
    let place = match (file, line) {
        (Some(file), Some(line)) => format!("{file}, {line}"),
        (Some(place), None) => place.to_string(),
        (None, Some(line)) => line,
        (None, None) => return error,
    };
    SceneError::At { place, source: Box::new(error) }
}

/// The line of a text that a byte lies in.
fn line_text(text: &str, at: usize) -> &str {
    let at = (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
    let begin = text[..at].rfind('\n').map_or(0, |line| line + 1);
    text[begin..].lines().next().unwrap_or_default().trim()
}

/// Where the key stands, or what there is of its sections.
fn start_of(text: &str, key: &str) -> Option<usize> {
    let table = DeTable::parse(text).ok()?;
    let (mut table, mut start) = (table.get_ref(), None);
    for name in key.split('.') {
        // An entry of a list has its place behind the name.
        let (name, place) =
            name.strip_suffix(']').and_then(|name| name.split_once('[')).unwrap_or((name, ""));
        let Some((found, value)) = table.iter().find(|(found, _)| found.get_ref() == name) else { break };
        start = Some(found.span().start);
        let entry = match value.get_ref() {
            DeValue::Array(entries) => place.parse().ok().and_then(|place: usize| entries.get(place)),
            _ => Some(value),
        };
        let Some(DeValue::Table(inner)) = entry.map(toml::Spanned::get_ref) else { break };
        table = inner;
    }
    start
}

/// The reader's message in our words; `key` is where it stands.
fn in_words(key: &str, message: &str) -> String {
    let names: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    if let Some(rest) = message.strip_prefix("invalid type: ").or(message.strip_prefix("invalid value: ")) {
        let (got, wanted) = rest.split_once(", expected ").unwrap_or((rest, "another kind of value"));
        return format!("{key} wants {}, not {}", kind(wanted), kind(got.trim_matches('`')));
    }
    if let Some(rest) = message.strip_prefix("invalid length ") {
        let (got, wanted) = rest.split_once(", expected ").unwrap_or((rest, "another number of values"));
        return format!("{key} wants {}, not {got}", kind(wanted));
    }
    match names.split_first() {
        Some((unknown, known)) if message.starts_with("unknown field") => {
            let section = key.rsplit_once('.').map_or("a scene", |(section, _)| section);
            format!("{key} is no known key{}; {section} has {}", meant(unknown, known), known.join(", "))
        }
        Some((unknown, known)) if message.starts_with("unknown variant") => {
            format!(
                "{key} = \"{unknown}\" is not known{}; allowed are {}",
                meant(unknown, known),
                known.join(", ")
            )
        }
        Some((name, _)) if message.starts_with("missing field") => {
            let full = if key.is_empty() { (*name).to_string() } else { format!("{key}.{name}") };
            let hint = HINTS.iter().find(|(end, _)| full.ends_with(end)).map_or("", |(_, hint)| hint);
            format!("{full} is missing: {hint}")
        }
        _ => format!("{key}: {message}"),
    }
}

/// A kind of value, or a value with its kind, in words.
fn kind(words: &str) -> String {
    if let Some((_, ours)) = KINDS.iter().find(|(theirs, _)| *theirs == words) {
        return (*ours).to_string();
    }
    if words.starts_with("struct ") {
        return "a table of keys".to_string();
    }
    // "integer `5`" and "string \"five\"" are said by their values.
    let value = ["integer ", "floating point ", "boolean ", "string "]
        .iter()
        .find_map(|kind| words.strip_prefix(kind));
    value.unwrap_or(words).trim_matches('`').to_string()
}

/// The known name that is nearest to an unknown one, if one is near.
fn meant(unknown: &str, known: &[&str]) -> String {
    let near = known.iter().map(|name| (edits(unknown, name), name)).min();
    match near {
        Some((edits, name)) if edits <= 1 + unknown.chars().count() / 4 => format!(": did you mean {name}?"),
        _ => String::new(),
    }
}

/// Letters to put in, take out, replace, or swap with their neighbour (Damerau 1964) to make one word of another.
pub(super) fn edits(from: &str, to: &str) -> usize {
    let (from, to): (Vec<char>, Vec<char>) = (from.chars().collect(), to.chars().collect());
    let mut rows: Vec<Vec<usize>> = vec![(0..=to.len()).collect()];
    for i in 1..=from.len() {
        let mut row = vec![i];
        for j in 1..=to.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(from[i - 1] != to[j - 1]);
            let mut least = replaced.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[from.len()][to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_edits_between_words() {
        for (from, to, n) in [
            ("", "abc", 3),
            ("balls", "balls", 0),
            ("bals", "balls", 1),
            ("blals", "balls", 1),
            ("kitten", "sitting", 3),
        ] {
            assert_eq!((edits(from, to), edits(to, from)), (n, n), "{from} {to}");
        }
    }

    #[test]
    fn any_place_of_a_text_has_a_line() {
        let text = "a = 1\n\u{b5} = 2\n";
        assert_eq!(line_text(text, 3), "a = 1");
        assert_eq!((line_text(text, 7), line_text(text, 99)), ("\u{b5} = 2", ""));
    }
}
