//! Scenes from a text and changes of its keys.

use toml::{Table, Value};

use super::{Scene, SceneError};
use crate::schema::explain;

impl Scene {
    /// Reads a scene from text after some of its keys have been changed, one after another.
    ///
    /// A change is a key with its sections, `load.y.force`, and its value as a scene file has it: `"300 N"` in quotes, or
    /// `0.3` in SI, `true`, `[[0, 1], [1, 2]]`, `{ force = 300 }`. Sections that are not there are made. An empty value
    /// takes the key, or the whole section, out of the scene.
    ///
    /// [`Scene::source`] is the changed text: the same keys and values in alphabetical order, without comments.
    ///
    /// # Errors
    /// [`SceneError::Change`] with the key, if a part of its path is no section, its value is no TOML, or there is nothing
    /// to take out; else as [`Scene::parse`].
    ///
    /// # Example
    /// ```
    /// use roulement::scene::Scene;
    ///
    /// let text = std::fs::read_to_string("scenes/thrust.toml")?;
    /// let changes = [("friction.ball_race", "0.05"), ("load.y.force", "\"0.3 kN\""), ("solver.alpha_f", "")];
    /// let scene = Scene::edited(&text, changes)?;
    /// assert_eq!(scene.friction.ball_race.at(0.0), 0.05);
    /// assert!(scene.source.contains("force = \"0.3 kN\"") && !scene.source.contains("alpha_f"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn edited<K: AsRef<str>, V: AsRef<str>>(
        text: &str,
        changes: impl IntoIterator<Item = (K, V)>,
    ) -> Result<Self, SceneError> {
        let text = Self::edited_text(text, changes)?;
        // Lines of the changed text are not those that the reader of a message has.
        Self::read(&text, std::path::Path::new("")).map_err(|(error, _)| error)
    }

    /// The text of a scene after some of its keys have been changed, as [`Scene::edited`] reads it then: a scene of that
    /// text may still be refused.
    ///
    /// # Errors
    /// If a key cannot be changed.
    pub fn edited_text<K: AsRef<str>, V: AsRef<str>>(
        text: &str,
        changes: impl IntoIterator<Item = (K, V)>,
    ) -> Result<String, SceneError> {
        let mut table: Table = toml::from_str(text).map_err(|why| {
            let spot = why.span().map(|span| span.start);
            explain::with_place(explain::format_error(text, &why), text, spot, None)
        })?;
        for (key, value) in changes {
            let (key, value) = (key.as_ref(), value.as_ref());
            change(&mut table, key, value).map_err(|why| SceneError::Change { key: key.to_string(), why })?;
        }
        Ok(table.to_string())
    }

    /// Switches effects by their keys, here and in the text, which then asks for nothing to be found out any more.
    pub(crate) fn settle_effects(&mut self, switches: &[(&'static str, bool)]) {
        for (key, on) in switches {
            for effect in self.effects.each_mut() {
                effect.switch(key, *on);
            }
        }
        self.effects.auto.on = false;
        let Ok(mut table) = toml::from_str::<Table>(&self.source) else { return };
        let effects = table.entry("effects").or_insert_with(|| Value::Table(Table::new()));
        if !effects.is_table() {
            *effects = Value::Table(Table::new());
        }
        if let Some(section) = effects.as_table_mut() {
            section.remove("auto");
        }
        for (key, on) in switches {
            // Every key has its section in the scene, or that of effects.
            let _ = change(&mut table, key, if *on { "true" } else { "false" });
        }
        self.source = table.to_string();
    }
}

/// Sets a key, or takes it out where the value is empty; why that cannot be done. A part of a list is named by its `name`, by its
/// number from 0, or by x, y, z where it is one of three.
fn change(table: &mut Table, key: &str, value: &str) -> Result<(), String> {
    if key.split('.').any(str::is_empty) {
        return Err("a key is names with dots between them".to_string());
    }
    let (path, last) = key.rsplit_once('.').map_or((None, key), |(path, last)| (Some(path), last));
    let mut names = path.into_iter().flat_map(|path| path.split('.'));
    let mut inner = match names.next() {
        None => return set(table, last, value),
        Some(name) => table.entry(name).or_insert_with(|| Value::Table(Table::new())),
    };
    let mut at = path.unwrap_or_default().split('.').next().unwrap_or_default();
    for name in names {
        inner = match inner {
            Value::Table(section) => section.entry(name).or_insert_with(|| Value::Table(Table::new())),
            Value::Array(list) => {
                let place = place_in(list, at, name)?;
                &mut list[place]
            }
            _ => return Err(format!("{at} is no section")),
        };
        at = name;
    }
    match inner {
        Value::Table(section) => set(section, last, value),
        Value::Array(list) => {
            let place = place_in(list, at, last)?;
            match value.is_empty() {
                true => drop(list.remove(place)),
                false => list[place] = parsed(value)?,
            }
            Ok(())
        }
        _ => Err(format!("{at} is no section")),
    }
}

/// Sets a key of a section, or takes it out.
fn set(section: &mut Table, name: &str, value: &str) -> Result<(), String> {
    if value.is_empty() {
        section.remove(name).ok_or("it is not in the scene")?;
    } else {
        section.insert(name.to_string(), parsed(value)?);
    }
    Ok(())
}

/// A value; the parser's own message is of several lines with a marker, here it stands in one.
fn parsed(value: &str) -> Result<Value, String> {
    value.parse().map_err(|why: toml::de::Error| format!("{value}: {}", why.message()))
}

/// Where a part of a list is.
fn place_in(list: &[Value], key: &str, part: &str) -> Result<usize, String> {
    let name = |value: &Value| value.get("name").and_then(Value::as_str).map(str::to_string);
    if let Some(place) = list.iter().position(|value| name(value).as_deref() == Some(part)) {
        return Ok(place);
    }
    let axis = ["x", "y", "z"].iter().position(|axis| *axis == part && list.len() == 3);
    let place = axis.or_else(|| part.parse().ok()).filter(|place| *place < list.len());
    place.ok_or_else(|| {
        let names: Vec<String> = list.iter().filter_map(name).collect();
        let there = if names.is_empty() { String::new() } else { format!(": {}", names.join(", ")) };
        format!("{key} is a list of {} and has no part {part}{there}", list.len())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_lists_are_named_by_name_number_or_axis() {
        let text = "[[bearing]]\nname = \"left\"\n[[bearing]]\nname = \"right\"\n[[shaft.load]]\nname = \"mesh\"\nforce = [1, 2, 3]\n[[shaft.disc]]\nmass = 1\n";
        let changed =
            |key: &str, value: &str| Scene::edited_text(text, [(key, value)]).map_err(|why| why.to_string());
        let right = changed("bearing.right.set.friction.ball_race", "0.05").unwrap();
        assert!(
            right.parse::<Table>().unwrap()["bearing"][1]["set"]["friction"]["ball_race"].as_float()
                == Some(0.05)
        );
        let force = changed("shaft.load.mesh.force.y", "\"9 N\"").unwrap().parse::<Table>().unwrap();
        assert_eq!(force["shaft"]["load"][0]["force"].to_string(), "[1, \"9 N\", 3]");
        let disc = changed("shaft.disc.0.mass", "2").unwrap().parse::<Table>().unwrap();
        assert_eq!(disc["shaft"]["disc"][0]["mass"].as_integer(), Some(2));
        assert!(!changed("bearing.left", "").unwrap().contains("left"));
        for (key, part) in [
            (
                "bearing.middle.set.friction.ball_race",
                "bearing is a list of 2 and has no part middle: left, right",
            ),
            ("shaft.disc.1.mass", "disc is a list of 1 and has no part 1"),
            ("shaft.load.mesh.force.w", "no part w"),
            ("shaft.load.mesh.name.x", "name is no section"),
        ] {
            let why = changed(key, "1").unwrap_err();
            assert!(why.contains(part), "{why}");
        }
    }
}
