//! Writes and checks docs/scene.md and the schemas for editors beside it, the reference of scenes: every key with its meaning, unit, default and
//! range. Meanings, types and defaults are those of the structs that scenes are read by; ranges those of the refusals that a user gets.
//! `scripts/tables` writes it.

mod keys;
mod others;
mod page;
mod sources;
mod units;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use keys::{LISTS, NEEDS, THRUST, UNION_KEYS, reference};
use others::schemas;
use page::{page, schema};
use roulement::scene::Scene;
use serde_json::Value;

use crate::whole::compare;

#[test]
fn the_reference_of_scenes_is_that_of_the_sources() {
    let reference = reference();
    compare("docs/scene.md", &page(&reference));
    let scene = schema(&reference);
    compare("docs/scene.schema.json", &format!("{scene:#}\n"));
    for (kind, schema) in schemas(&reference, &scene) {
        compare(&format!("docs/{kind}.schema.json"), &format!("{schema:#}\n"));
    }
}

/// Are all keys of a table known to a schema?
fn known(schema: &Value, value: &toml::Value, path: &str) {
    let schema = schema.get("anyOf").map_or(schema, |of| &of[1]);
    match (value, schema.get("properties").and_then(Value::as_object)) {
        (toml::Value::Table(table), Some(properties)) => {
            for (key, value) in table {
                let path = format!("{path}.{key}");
                known(
                    properties.get(key).unwrap_or_else(|| panic!("{path} is not in the schema")),
                    value,
                    &path,
                );
            }
        }
        (toml::Value::Array(values), _) if schema.get("items").is_some() => {
            values.iter().for_each(|value| known(&schema["items"], value, path));
        }
        _ => {}
    }
}

#[test]
fn the_schema_has_all_keys_of_all_scenes_of_the_project() {
    let schema = schema(&reference());
    let mut seen = 0;
    for folder in ["scenes", "scenes/effects", "scenes/cost", "scenes/error"] {
        for entry in fs::read_dir(Path::new(roulement_tests::ROOT).join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|of| of == "toml") {
                let scene: toml::Table = fs::read_to_string(&path).unwrap().parse().unwrap();
                known(&schema, &toml::Value::Table(scene), &path.display().to_string());
                seen += 1;
            }
        }
    }
    assert!(seen > 20, "{seen}");
}

/// Is it a list of tables in another section?
fn is_list(section: &str) -> bool {
    LISTS.iter().any(|(list, _)| *list == section)
}

/// The key that is documented for each key of a list's entries: what a refusal names is known.
#[test]
fn no_key_of_a_list_is_missing() {
    let reference = reference();
    for (list, needs) in LISTS {
        let given: String = needs.iter().map(|(name, value)| format!("{name} = {value}, ")).collect();
        let changes = [(list, format!("[{{ {given}no_such_key = 1 }}]"))];
        let why = Scene::edited(THRUST, changes).unwrap_err().to_string();
        let (_, names) = why.split_once(" has ").unwrap_or_else(|| panic!("{list}: {why}"));
        let chapter = reference.chapters.iter().find(|of| of.title == format!("`{list}`")).unwrap();
        for key in names.split(", ") {
            assert!(
                chapter.keys.iter().any(|known| known.name == key),
                "{list}.{key} is not documented: {why}"
            );
        }
    }
}

/// Keys of a section that the refusal of an unknown one names.
fn expected(section: &str) -> Vec<String> {
    let needs = NEEDS.iter().filter(|(of, _)| section.starts_with(of)).flat_map(|(_, needs)| *needs);
    let key = if section.is_empty() { "no_such_key".to_string() } else { format!("{section}.no_such_key") };
    let changes = needs.copied().chain([(key.as_str(), "1")]);
    let why = Scene::edited(THRUST, changes).unwrap_err().to_string();
    let (_, names) = why.split_once(" has ").unwrap_or_else(|| panic!("{section}: {why}"));
    names.split(", ").map(str::to_string).collect()
}

#[test]
fn no_key_that_a_scene_may_have_is_missing() {
    let reference = reference();
    let mut documented: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for chapter in &reference.chapters {
        for section in chapter.title.split(", ").map(|name| name.trim_matches('`')) {
            let keys = documented.entry(section.to_string()).or_default();
            keys.extend(chapter.keys.iter().map(|key| key.name.clone()));
        }
    }
    // A section is a key of the one that it is in.
    for section in documented.keys().cloned().collect::<Vec<_>>() {
        let (outside, key) = section.rsplit_once('.').unwrap_or(("", &section));
        documented.entry(outside.to_string()).or_default().insert(key.to_string());
    }
    documented.entry(String::new()).or_default().insert("title".into());
    let mut keys = 0;
    for (section, documented) in &documented {
        // Lists of tables, a value that may be a table, and ranges of keys have no key that can be tried like this.
        if section == "defect"
            || section == "ranges"
            || is_list(section)
            || UNION_KEYS.contains(&section.as_str())
        {
            continue;
        }
        for key in expected(section) {
            assert!(documented.contains(&key), "`{key}` of [{section}] is not documented: {documented:?}");
            keys += 1;
        }
    }
    assert!(keys > 150, "{keys}");
}

#[test]
fn every_key_has_a_meaning_and_values() {
    for chapter in reference().chapters {
        assert!(!chapter.doc.is_empty(), "{}", chapter.title);
        for key in chapter.keys {
            assert!(!key.meaning.is_empty(), "{} {}", chapter.title, key.name);
        }
    }
}
