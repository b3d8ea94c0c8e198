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
        let mut table =
            explain::table(text).map_err(|(why, spot)| explain::with_place(why, text, spot, None))?;
        for (key, value) in changes {
            let (key, value) = (key.as_ref(), value.as_ref());
            change(&mut table, key, value).map_err(|why| SceneError::Change { key: key.to_string(), why })?;
        }
        Ok(table.to_string())
    }

    /// Switches effects by their keys, here and in the text, which then asks for nothing to be found out any more, and says what was.
    pub(crate) fn settle_effects(&mut self, switches: &[(&'static str, bool)], notes: &[String]) {
        for (key, on) in switches {
            for effect in self.effects.each_mut() {
                effect.switch(key, *on);
            }
        }
        self.effects.auto.on = false;
        self.effects.auto.found = notes.to_vec();
        let Ok(mut table) = toml::from_str::<Table>(&self.source) else { return };
        let effects = table.entry("effects").or_insert_with(|| Value::Table(Table::new()));
        if !effects.is_table() {
            *effects = Value::Table(Table::new());
        }
        if let Some(section) = effects.as_table_mut() {
            section.remove("auto");
            let notes = notes.iter().map(|note| Value::from(note.as_str())).collect();
            section.insert("auto_found".into(), Value::Array(notes));
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
fn change(section: &mut Table, key: &str, value: &str) -> Result<(), String> {
    let (name, rest) = split(key)?;
    match rest {
        Some(rest) => {
            change_in(section.entry(name).or_insert_with(|| Table::new().into()), name, rest, value)
        }
        None if value.is_empty() => section.remove(name).map(drop).ok_or("it is not in the scene".into()),
        None => parsed(value).map(|value| drop(section.insert(name.to_string(), value))),
    }
}

/// Change of a key of a section or of a part of a list, whose own key is `at`.
fn change_in(inner: &mut Value, at: &str, key: &str, value: &str) -> Result<(), String> {
    let list = match inner {
        Value::Table(section) => return change(section, key, value),
        Value::Array(list) => list,
        _ => return Err(format!("{at} is no section")),
    };
    let (part, rest) = split(key)?;
    let place = place_in(list, at, part)?;
    match rest {
        Some(rest) => return change_in(&mut list[place], part, rest, value),
        None if value.is_empty() => drop(list.remove(place)),
        None => list[place] = parsed(value)?,
    }
    Ok(())
}

/// First name of a key, and the rest of it.
fn split(key: &str) -> Result<(&str, Option<&str>), String> {
    let (name, rest) = key.split_once('.').map_or((key, None), |(name, rest)| (name, Some(rest)));
    if name.is_empty() { Err("a key is names with dots between them".to_string()) } else { Ok((name, rest)) }
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
    use crate::scene::{Condition, Schedule};

    const THRUST: &str = include_str!("../../scenes/thrust.toml");
    const CAGE: &str = include_str!("../../scenes/cage.toml");

    fn refusal(changes: &[(&str, &str)]) -> String {
        Scene::edited(THRUST, changes.iter().copied()).unwrap_err().to_string()
    }

    #[test]
    fn values_of_every_kind_are_set() {
        let changes = [
            ("title", "\"a \\\"title\\\"\""),
            ("bearing.balls", "12"),
            ("friction.ball_race", "0.1"),
            ("bearing.pitch_diameter", "\"60 mm\""),
            ("effects.heathcote_slip", "true"),
            ("effects.gravity", "[0, 0, -9.81]"),
            ("load.inner_speed", "[[0, 0], [\"1 ms\", \"60 rpm\"]]"),
            ("load.x", "{ displacement = 1e-6 }"),
        ];
        let scene = Scene::edited(THRUST, changes).unwrap();
        assert_eq!((scene.title.as_str(), scene.bearing.balls), ("a \"title\"", 12));
        assert_eq!((scene.friction.ball_race.at(0.0), scene.bearing.pitch_diameter.0), (0.1, 0.06));
        assert!(scene.effects.groove_slip.on);
        assert_eq!(scene.effects.gravity.acceleration, [0.0, 0.0, -9.81].into());
        assert!((scene.load.inner_speed.at(5e-4) - std::f64::consts::PI).abs() < 1e-12);
        assert_eq!(scene.load.conditions()[0], Condition::Motion(Schedule::Constant(1e-6)));
        // What was not named is as it was.
        let plain = Scene::parse(THRUST).unwrap();
        assert_eq!(format!("{:?}", scene.solver), format!("{:?}", plain.solver));
        assert_eq!(format!("{:?}", scene.inner), format!("{:?}", plain.inner));
    }

    #[test]
    fn sections_are_made_and_changes_follow_one_another() {
        let changes = [
            ("start.orbital_speed", "10.0"),
            ("load.y.force", "\"1 N\""),
            ("load.y.force", "\"300 N\""),
            ("outer.misalignment.ry", "[[0.0, 0.0], [\"2 ms\", 3e-4]]"),
        ];
        let scene = Scene::edited(THRUST, changes).unwrap();
        assert_eq!(scene.start.orbital_speed.map(|speed| speed.0), Some(10.0));
        assert_eq!(scene.load.conditions()[1], Condition::Load(Schedule::Constant(300.0)));
    }

    #[test]
    fn an_empty_value_takes_a_key_or_a_section_out() {
        let keys = ["cage", "effects.cage", "friction.ball_cage", "friction.cage_race", "load.z"];
        let scene = Scene::edited(CAGE, keys.map(|key| (key, ""))).unwrap();
        assert!(!scene.effects.cage.is_body());
        assert_eq!(scene.load.conditions()[2], Scene::parse(THRUST).unwrap().load.conditions()[2]);
        let scene =
            Scene::edited(THRUST, [("bearing.contact_angle", ""), ("bearing.diametral_clearance", "1e-5")]);
        assert_eq!(scene.unwrap().bearing.diametral_clearance.map(|clearance| clearance.0), Some(1e-5));
        // Needed keys are missed.
        assert!(refusal(&[("bearing.balls", "")]).contains("bearing.balls is missing"));
    }

    #[test]
    fn the_source_is_the_changed_text_and_gives_the_same_scene() {
        for text in [THRUST, CAGE, include_str!("../../scenes/radial.toml")] {
            let same = Scene::edited(text, [("title", "\"other\""); 0]).unwrap();
            let again = Scene::parse(&same.source).unwrap();
            assert_eq!(format!("{same:?}"), format!("{again:?}"));
            let mut written = Scene::parse(text).unwrap();
            written.source = same.source.clone();
            assert_eq!(format!("{same:?}"), format!("{written:?}"));
        }
        let scene = Scene::edited(THRUST, [("solver.max_step", "0.1e-5")]).unwrap();
        assert_eq!(Scene::parse(&scene.source).unwrap().solver.max_step.0, 0.1e-5);
    }

    #[test]
    fn errors_name_the_key() {
        for (key, value, parts) in [
            ("title.text", "1", &["title.text", "title is no section"][..]),
            ("load.inner_speed.at.start", "1", &["load.inner_speed.at.start", "inner_speed is no section"]),
            ("load.x.force", "1500 N", &["load.x.force", "1500 N"]),
            ("load.x.force", "1\ny = 2", &["load.x.force"]),
            ("load.x.force", " ", &["load.x.force"]),
            ("load.z", "", &["load.z", "not in the scene"]),
            ("strat.spin_balance", "", &["strat.spin_balance", "not in the scene"]),
            ("", "1", &["names"]),
            ("load..force", "1", &["load..force", "names"]),
            // Known to be wrong only by the scene.
            ("load.duraton", "1", &["load.duraton", "did you mean duration?"]),
            ("friction.ball_race", "-1", &["friction.ball_race = -1", "[0, 2]"]),
            ("load.x.displacement", "0", &["load.x", "at most one"]),
        ] {
            let message = refusal(&[(key, value)]);
            for part in parts {
                assert!(message.contains(part), "{message}\nshould name {part}");
            }
        }
        let message = Scene::edited("[load", [("title", "\"other\"")]).unwrap_err().to_string();
        assert!(message.contains("[load"), "{message}");
    }

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
