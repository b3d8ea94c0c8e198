//! Ranges of inputs that a package can meet: the section `[ranges]` of a scene.

use serde::Deserialize;
use toml::{Table, Value};

use super::{Scene, SceneError};

/// Most ranges in a scene: effects are judged at all corners that they have together.
const MOST: usize = 6;

/// Keys of the file, each with the two ends of the range that its value can have: a table of its sections. `effects.auto` of a package is judged at
/// all corners of these ranges.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(transparent)]
pub struct Ranges(Table);

/// A key with both ends of its range, as a scene has them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Between {
    /// The key with its sections.
    pub key: String,
    /// Its values there.
    pub ends: [String; 2],
}

impl Ranges {
    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All of them, in alphabetical order.
    ///
    /// # Errors
    /// Names the key whose value is no pair, or how many there are, if those are too many.
    pub fn all(&self) -> Result<Vec<Between>, SceneError> {
        let mut all = vec![];
        collect(&self.0, "", &mut all)?;
        if all.len() > MOST {
            let why = format!("{} of them: allowed are {MOST}, whose corners are {}", all.len(), 1 << MOST);
            return Err(SceneError::conflict("ranges", why));
        }
        Ok(all)
    }

    /// Checks that a file can be read with either end of each range; `read` reads the text of one.
    ///
    /// # Errors
    /// Those of [`Ranges::all`], and what is said of a value, or of a key that is not there.
    pub fn check(&self, text: &str, read: impl Fn(&str) -> Result<(), SceneError>) -> Result<(), SceneError> {
        let inside = |why| SceneError::At { place: "ranges".into(), source: Box::new(why) };
        for Between { key, ends } in self.all()? {
            if key.split('.').next() == Some("ranges") {
                return Err(SceneError::conflict("ranges.ranges", "a range has no range of its own"));
            }
            for end in ends {
                read(&without(text, [(key.as_str(), end.as_str())])?).map_err(inside)?;
            }
        }
        Ok(())
    }
}

/// The text of a file that has ranges without these, with changed keys.
///
/// # Errors
/// If a key cannot be changed.
pub fn without<'a>(
    text: &str,
    changes: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> Result<String, SceneError> {
    Scene::edited_text(text, [("ranges", "")].into_iter().chain(changes))
}

/// Keys of a table that have a pair of values.
fn collect(table: &Table, before: &str, all: &mut Vec<Between>) -> Result<(), SceneError> {
    for (name, value) in table {
        let key = if before.is_empty() { name.clone() } else { format!("{before}.{name}") };
        match value {
            Value::Table(inside) => collect(inside, &key, all)?,
            Value::Array(ends) if ends.len() == 2 && ends.iter().all(is_one) => {
                let ends = [ends[0].to_string(), ends[1].to_string()];
                all.push(Between { key, ends });
            }
            _ => {
                let why = format!(
                    "{value}: a range has two ends, each a number in SI or a text with a unit, such as [\"0 N\", \"5 kN\"]"
                );
                return Err(SceneError::conflict(format!("ranges.{key}"), why));
            }
        }
    }
    Ok(())
}

/// Is it one number, or a text?
fn is_one(value: &Value) -> bool {
    matches!(value, Value::Integer(_) | Value::Float(_) | Value::String(_))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Between>, String> {
        toml::from_str::<Ranges>(text).unwrap().all().map_err(|why| why.to_string())
    }

    #[test]
    fn pairs_are_found_in_sections_and_anything_else_is_refused_by_its_key() {
        let found = read("[load]\ny.force = [\"0 N\", \"5 kN\"]\ninner_speed = [0, 1e3]").unwrap();
        let keys: Vec<_> = found.iter().map(|one| (one.key.as_str(), one.ends[1].as_str())).collect();
        assert_eq!(keys, [("load.inner_speed", "1000.0"), ("load.y.force", "\"5 kN\"")]);
        for (text, key) in [
            ("load.y.force = 3", "ranges.load.y.force"),
            ("load.y.force = [1, 2, 3]", "ranges.load.y.force"),
            ("load.inner_speed = [[0, 1], [1, 2]]", "ranges.load.inner_speed"),
        ] {
            let why = read(text).unwrap_err();
            assert!(why.contains(key) && why.contains("two ends"), "{why}");
        }
        let many: String = (0..7).map(|k| format!("a{k} = [0, 1]\n")).collect();
        assert!(read(&many).unwrap_err().contains("7 of them: allowed are 6"));
    }
}
