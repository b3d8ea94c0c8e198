//! The reference as a page, and as a schema for editors.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::keys::{Key, Reference, UNION_KEYS, meaning};
use super::units;

const HEAD: &str = "# Scene reference\n\n\
    Every key of a scene file, from the structs that read it (`cargo test --test scene reference` compares; `scripts/tables` writes). \
    Numbers are SI, or texts with a unit ([Units](#units)). A key that is left out has its default; an unknown key is refused. \
    A value over time may be a table or a building block: [Load cases](load-cases.md). \
    `roulement scene --keys` prints this page, `roulement scene --keys film` what is about a word.\n";

pub fn page(reference: &Reference) -> String {
    let mut page = HEAD.to_string();
    for chapter in &reference.chapters {
        let _ = write!(page, "\n## {}\n\n{}\n", chapter.title, meaning(&chapter.doc));
        if chapter.keys.is_empty() {
            continue;
        }
        page += "\n| key | meaning | values | default |\n|---|---|---|---|\n";
        for Key { name, meaning, values, default, .. } in &chapter.keys {
            let _ = writeln!(page, "| `{name}` | {meaning} | {} | {default} |", values.replace('|', "\\|"));
        }
    }
    page + &units::section()
}

/// An object of a schema that has no other keys than its own.
fn object() -> Value {
    json!({ "type": "object", "additionalProperties": false, "properties": {} })
}

/// The place of a section in a schema, made where it is not there yet.
fn place<'a>(schema: &'a mut Value, path: &str) -> &'a mut Value {
    path.split('.').fold(schema, |inside, key| {
        // Lists of tables, a value that may be a table, and a section that may be a word.
        let of_items = inside.get("items").is_some();
        let inside = if of_items { &mut inside["items"] } else { inside };
        let properties = inside["properties"].as_object_mut().unwrap_or_else(|| panic!("{path}"));
        properties.entry(key).or_insert_with(|| match path {
            "defect" | "load.rotating" | "load.gear" | "phase" | "duty" => {
                json!({ "type": "array", "items": object() })
            }
            _ => object(),
        })
    })
}

/// A JSON schema for editors.
pub fn schema(reference: &Reference) -> Value {
    let mut schema = object();
    schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
    schema["title"] = "A scene of roulement".into();
    schema["properties"]["title"] =
        json!({ "type": "string", "description": "One line for plots and reports." });
    for chapter in &reference.chapters {
        for path in chapter.title.split(", ").map(|name| name.trim_matches('`')) {
            if UNION_KEYS.contains(&path) {
                // Described by its key: several kinds of values are allowed there.
                continue;
            }
            let section = place(&mut schema, path);
            section["description"] = meaning(&chapter.doc).replace("\\[", "[").into();
            let section = if section.get("items").is_some() { &mut section["items"] } else { section };
            for key in &chapter.keys {
                section["properties"][&key.name] = key.schema.clone();
            }
        }
    }
    // Its keys are those of all sections.
    schema["properties"]["ranges"]["additionalProperties"] = true.into();
    // The word alone: effects = "auto".
    let effects = schema["properties"]["effects"].take();
    schema["properties"]["effects"] = json!({ "anyOf": [{ "enum": ["auto"] }, effects] });
    schema
}
