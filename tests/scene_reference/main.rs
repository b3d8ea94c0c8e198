//! Writes and checks docs/scene.md and docs/scene.schema.json, the reference of scenes: every key with its meaning, unit, default and range. Meanings, types and
//! defaults are those of the structs that scenes are read by; ranges those of the refusals that a user gets. `scripts/tables` writes it.
#![allow(clippy::unwrap_used)]

mod sources;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use quote::ToTokens;
use roulement::scene::Scene;
use serde_json::{Value, json};
use sources::{Field, Section, Source, sources};
use syn::{Expr, GenericArgument, PathArguments, Type};

const THRUST: &str = include_str!("../../scenes/thrust.toml");
/// Types that are read in several ways, with the structs of those that are tables.
const UNIONS: [(&str, &[&str]); 2] =
    [("Given", &["RestitutionSection", "RetardationSection"]), ("Shape", &["WaveSection"])];
/// Values of types that have a way of their own to be written.
const VALUES: [(&str, &str); 5] = [
    ("Given", "s/m, or text: `\"0.02 s/m\"`, or a table, below"),
    ("Shape", "list of waves, below, or `{ profile = \"file.csv\" }`, or `{ profile = [[radial, axial], ...] }`"),
    ("Parameters", "table of `eta`, `beta`, `alpha`: `roulement identify` writes it"),
    ("DirectionMatrix", "six numbers, or six rows of six"),
    ("Goal", "text or table"),
];
/// Keys of such types.
const UNION_KEYS: [&str; 3] = ["effects.damping", "form.inner", "form.outer"];
/// Dimensions: type, SI unit, example; as `src/schema/units.rs` has them.
const UNITS: &str = include_str!("../../src/schema/units.rs");
/// What a section needs beside a key that is tried.
const NEEDS: [(&str, &[(&str, &str)]); 8] = [
    ("film", &[("film.viscosity", "0.02")]),
    (
        "cage",
        &[
            ("effects.cage", "true"),
            ("cage.mass", "0.02"),
            ("cage.inertia", "[1e-5, 1e-5, 1e-5]"),
            ("cage.pocket_clearance", "2e-4"),
            ("cage.guided_by", "\"balls\""),
        ],
    ),
    ("effects.heat_balance", &[("growth.inner", "0.0")]),
    ("growth.shaft", &[("growth.shaft.diameter", "0.03")]),
    ("growth.housing", &[("growth.housing.diameter", "0.062")]),
    ("effects.ambient", &[("effects.ambient.density", "10.0"), ("effects.ambient.viscosity", "2e-5")]),
    ("inner.support", &[("inner.drive", "\"pose\""), ("inner.mass", ""), ("inner.inertia", "")]),
    ("outer", &[("outer.mass", "0.1"), ("outer.inertia", "[1e-5, 1e-5, 1e-5]")]),
];

/// A key as it is documented.
struct Key {
    name: String,
    meaning: String,
    values: String,
    default: String,
    /// What a JSON schema says of its value.
    schema: Value,
}

/// A table of keys.
struct Chapter {
    title: String,
    doc: String,
    keys: Vec<Key>,
}

struct Reference {
    sources: Vec<Source>,
    chapters: Vec<Chapter>,
}

/// What a type is, without what may be left out, and several of it.
struct Plain {
    /// Last word of its path.
    name: String,
    /// Module before it, if one is named.
    module: Option<String>,
    optional: bool,
    /// Words for several.
    several: Option<String>,
    /// Argument in angle brackets.
    argument: Option<String>,
}

fn plain(kind: &Type) -> Plain {
    match kind {
        Type::Array(array) => {
            let count = array.len.to_token_stream().to_string();
            Plain { several: Some(format!("array of {count}, each")), ..plain(&array.elem) }
        }
        Type::Path(path) => {
            let last = path.path.segments.last().unwrap();
            let argument = match &last.arguments {
                PathArguments::AngleBracketed(arguments) => arguments.args.iter().find_map(|of| match of {
                    GenericArgument::Type(kind) => Some(kind.clone()),
                    _ => None,
                }),
                _ => None,
            };
            match (last.ident.to_string().as_str(), argument) {
                ("Option", Some(of)) => Plain { optional: true, ..plain(&of) },
                ("Vec", Some(of)) => Plain { several: Some("list, each".into()), ..plain(&of) },
                (name, argument) => Plain {
                    name: name.to_string(),
                    module: path.path.segments.iter().rev().nth(1).map(|of| of.ident.to_string()),
                    optional: false,
                    several: None,
                    argument: argument.map(|of| of.to_token_stream().to_string()),
                },
            }
        }
        other => panic!("{}", other.to_token_stream()),
    }
}

/// Unit and example of a dimension, by its type's name.
fn dimension(name: &str) -> Option<(String, String)> {
    let line = UNITS.lines().find(|line| line.trim().starts_with(&format!("{name} = \"")))?;
    let quoted: Vec<&str> = line.split('"').collect();
    Some((quoted[1].to_string(), quoted[5].to_string()))
}

impl Reference {
    /// The file that a type of a field is in.
    fn find<T>(&self, from: usize, of: &Plain, get: impl Fn(&Source) -> Option<T>) -> Option<(usize, T)> {
        let named = |source: &Source| {
            of.module.as_ref().is_none_or(|module| {
                source.path.components().any(|part| {
                    Path::new(part.as_os_str()).file_stem().is_some_and(|stem| stem == module.as_str())
                })
            })
        };
        let places = std::iter::once(from).chain(0..self.sources.len());
        let mut places = places.filter(|place| of.module.is_none() || named(&self.sources[*place]));
        places.find_map(|place| Some((place, get(&self.sources[place])?)))
    }

    fn section(&self, from: usize, of: &Plain) -> Option<(usize, Section)> {
        let (place, section) = self.find(from, of, |source| source.sections.get(&of.name).cloned())?;
        let Some(read_as) = &section.read_as else { return Some((place, section)) };
        // What it is read as, with the documentation of the fields that it becomes.
        let mut read = self.sources[place].sections[read_as].clone();
        for field in read.fields.iter_mut().filter(|field| field.doc.is_empty()) {
            let own = section.fields.iter().find(|own| own.name == field.name);
            field.doc = own.map(|own| own.doc.clone()).unwrap_or_default();
        }
        Some((place, Section { doc: section.doc, ..read }))
    }

    /// Adds a section that stands under several names.
    fn add(&mut self, names: &[String], doc: &str, (place, section): (usize, Section)) {
        let mut chapter = Chapter {
            title: names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "),
            doc: if doc.is_empty() { section.doc.clone() } else { doc.to_string() },
            keys: vec![],
        };
        let mut inside: Vec<(Vec<String>, String, (usize, Section))> = vec![];
        for field in section.fields.iter().filter(|field| !field.skipped) {
            let kind = plain(&field.kind);
            let of = |name: &String| format!("{name}.{}", field.name);
            if let Some(found) = self.section(place, &kind) {
                let names: Vec<String> = names.iter().map(of).collect();
                // Of one type and several keys: one table.
                match inside.iter_mut().find(|(_, _, known)| known.1.fields.len() == found.1.fields.len() && known.1.doc == found.1.doc) {
                    Some((known, _, _)) => known.extend(names),
                    None => inside.push((names, found.1.doc.clone(), found)),
                }
                continue;
            }
            chapter.keys.push(self.key(place, &section, field, names));
            if let Some((_, structs)) = UNIONS.iter().find(|(name, _)| *name == kind.name) {
                for one in *structs {
                    let found = self.sources.iter().position(|source| source.sections.contains_key(*one)).unwrap();
                    let section = self.sources[found].sections[*one].clone();
                    inside.push((names.iter().map(of).collect(), section.doc.clone(), (found, section)));
                }
            }
        }
        self.chapters.push(chapter);
        for (names, doc, section) in inside {
            self.add(&names, &doc, section);
        }
    }

    fn key(&self, place: usize, section: &Section, field: &Field, names: &[String]) -> Key {
        let kind = plain(&field.kind);
        let dimension = [field.quantity.clone(), kind.argument.clone(), Some(kind.name.clone())]
            .into_iter()
            .flatten()
            .find_map(|name| dimension(&name));
        let choices = self.find(place, &kind, |source| source.enums.get(&kind.name).cloned());
        let over_time = field.quantity.is_some();
        let own = VALUES.iter().find(|(name, _)| *name == kind.name).map(|(_, values)| (*values).to_string());
        let mut values = match (kind.name.as_str(), &choices, &dimension) {
            _ if own.is_some() => own.unwrap_or_default(),
            ("bool", _, _) => "`true`, `false`".to_string(),
            ("String", _, _) => "text".into(),
            (_, Some((_, variants)), _) => {
                let of = |(name, doc): &(String, String)| format!("`\"{name}\"`: {}", doc.trim_end_matches('.'));
                variants.iter().map(of).collect::<Vec<_>>().join("<br>")
            }
            (_, None, Some((unit, example))) if unit != "1" => format!("{unit}, or text: `\"{example}\"`"),
            ("usize" | "u32", _, _) => "whole number".into(),
            ("f64" | "Schedule", _, _) => "number".into(),
            _ => String::new(),
        };
        if let Some(several) = &kind.several {
            values = format!("{several} {values}");
        }
        if over_time || kind.name == "Components" {
            values += if over_time { "; constant, or a table `[[time, value], ...]`" } else { "; `{ x, y, z }`, each constant or a table `[[time, value], ...]`" };
        }
        if let Some(range) = names.iter().find_map(|name| range(&format!("{name}.{}", field.name))) {
            let _ = write!(values, "<br>{range}");
        }
        let default = match self.default(place, section, field, &kind) {
            Some(default) => default,
            None if kind.optional => "none".into(),
            None => "must be given".into(),
        };
        let names = choices.map(|(_, variants)| variants.into_iter().map(|(name, _)| name).collect::<Vec<_>>());
        let mut schema = match (kind.name.as_str(), names) {
            ("bool", _) => json!({ "type": "boolean" }),
            ("String", _) => json!({ "type": "string" }),
            (_, Some(names)) => json!({ "enum": names }),
            ("usize" | "u32", _) => json!({ "type": "integer" }),
            ("f64", _) => json!({ "type": "number" }),
            _ if dimension.is_some() && over_time => json!({ "type": ["number", "string", "array"] }),
            ("Components", _) => json!({ "type": "object" }),
            _ if dimension.is_some() => json!({ "type": ["number", "string"] }),
            _ => json!({}),
        };
        if kind.several.is_some() {
            schema = json!({ "type": "array", "items": schema });
        }
        let meaning = meaning(&field.doc);
        schema["description"] = meaning.replace("\\[", "[").into();
        Key { name: field.name.clone(), meaning, values, default, schema }
    }

    /// The default of a field as a scene would have it.
    fn default(&self, place: usize, section: &Section, field: &Field, kind: &Plain) -> Option<String> {
        let given = field.default.clone().or_else(|| section.defaults.get(&field.name).cloned());
        if let Some(expression) = given {
            return self.written(place, &expression, kind);
        }
        if !(field.of_type || section.all_default) || kind.optional {
            return None;
        }
        if let Some((_, variants)) = self.find(place, kind, |source| source.enums.get(&kind.name).cloned()) {
            return Some(format!("`\"{}\"`", variants[0].0));
        }
        Some(match kind.name.as_str() {
            "bool" => "`false`".into(),
            "String" => "`\"\"`".into(),
            _ if kind.several.is_some() => "none".into(),
            _ => "0".into(),
        })
    }

    /// An expression of Rust as a scene would have it.
    fn written(&self, place: usize, expression: &Expr, kind: &Plain) -> Option<String> {
        match expression {
            Expr::Lit(literal) => match &literal.lit {
                syn::Lit::Bool(of) => Some(format!("`{}`", of.value)),
                syn::Lit::Float(of) => Some(short(of.base10_parse().ok()?)),
                syn::Lit::Int(of) => Some(of.base10_digits().to_string()),
                _ => None,
            },
            Expr::Unary(unary) => Some(format!("-{}", self.written(place, &unary.expr, kind)?)),
            Expr::Path(path) => {
                let last = path.path.segments.last()?.ident.to_string();
                if last == "None" {
                    return Some("none".into());
                }
                let choice = |source: &Source| source.enums.get(&kind.name).cloned();
                if let Some((_, variants)) = self.find(place, kind, choice) {
                    let name = variants.iter().find(|(name, _)| name.replace('_', "") == last.to_lowercase())?;
                    return Some(format!("`\"{}\"`", name.0));
                }
                let sources = std::iter::once(place).chain(0..self.sources.len());
                let constant = sources.filter_map(|of| self.sources[of].constants.get(&last)).next()?;
                self.written(place, constant, kind)
            }
            Expr::Call(call) => match &*call.func {
                Expr::Path(path) if call.args.is_empty() => {
                    let name = path.path.segments.last()?.ident.to_string();
                    if let Some(body) = self.sources[place].functions.get(&name) {
                        return self.written(place, body, kind);
                    }
                    (name == "default").then(|| "none".to_string())
                }
                _ => self.written(place, call.args.first()?, kind),
            },
            // A default of another section, such as that of steel.
            Expr::Field(field) => {
                let member = field.member.to_token_stream().to_string();
                let base = field.base.to_token_stream().to_string();
                let name = base.split(' ').next()?;
                let section = self.sources.iter().find_map(|source| source.sections.get(name))?;
                self.written(place, section.defaults.get(&member)?, kind)
            }
            Expr::Array(array) => {
                let each = array.elems.iter().map(|of| self.written(place, of, kind)).collect::<Option<Vec<_>>>()?;
                Some(format!("`[{}]`", each.join(", ")))
            }
            Expr::Repeat(repeat) => {
                let count = repeat.len.to_token_stream().to_string().parse().ok()?;
                let each = vec![self.written(place, &repeat.expr, kind)?; count];
                Some(format!("`[{}]`", each.join(", ")))
            }
            _ => None,
        }
    }
}

fn short(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) { format!("{value:e}") } else { format!("{value}") }
}

/// Documentation as a cell of a table: without marks of Rust's own documents.
fn meaning(doc: &str) -> String {
    let mut text = doc.replace("\\[", "[").replace('|', "\\|");
    while let Some(begin) = text.find("[`") {
        // Links to items of the program tell a reader of scenes nothing.
        let end = text[begin..].find("`]").map_or(text.len(), |end| begin + end + 2);
        let item = text[begin..end].trim_matches(['[', ']', '`']).to_string();
        text.replace_range(begin..end, &format!("`{}`", item.rsplit("::").next().unwrap()));
    }
    // A unit in brackets is no link; what is code stays as it is.
    let parts = text.split('`').enumerate();
    let parts = parts.map(|(place, part)| if place % 2 == 0 { part.replace('[', "\\[") } else { part.to_string() });
    parts.collect::<Vec<_>>().join("`")
}

/// The range of a number, as a refusal states it.
fn range(key: &str) -> Option<String> {
    let needs = NEEDS.iter().filter(|(section, _)| key.starts_with(section)).flat_map(|(_, needs)| *needs);
    let needs: Vec<(&str, &str)> = needs.copied().filter(|(needed, _)| *needed != key).collect();
    ["1e300", "-1e300", "[1e300, 1e300, 1e300]", "1000000000"].into_iter().find_map(|value| {
        let changes = needs.iter().copied().chain([(key, value)]);
        let why = Scene::edited(THRUST, changes).err()?.to_string();
        let (about, allowed) = why.split_once("allowed is ")?;
        about.contains(key).then(|| allowed.trim_end_matches('.').to_string())
    })
}

fn reference() -> Reference {
    let mut reference = Reference { sources: sources(), chapters: vec![] };
    let scene = reference.sources.iter().position(|source| source.sections.contains_key("Scene")).unwrap();
    let fields = reference.sources[scene].sections["Scene"].fields.clone();
    for field in fields.iter().filter(|field| !field.skipped) {
        let kind = plain(&field.kind);
        if kind.name == "Effects" {
            effects(&mut reference, &field.doc);
        } else if let Some(section) = reference.section(scene, &kind) {
            let until = section.1.doc.clone();
            let doc = if field.doc.contains("until it joins") { until } else { field.doc.clone() };
            reference.add(std::slice::from_ref(&field.name), &doc, section);
        }
    }
    reference
}

/// The section `[effects]`, whose keys are those of all effects.
fn effects(reference: &mut Reference, doc: &str) {
    let mut chapter = Chapter { title: "`effects`".into(), doc: doc.to_string(), keys: vec![] };
    let mut inside = vec![];
    for place in 0..reference.sources.len() {
        for field in reference.sources[place].keys.clone() {
            let none = Section { doc: String::new(), fields: vec![], read_as: None, defaults: Default::default(), all_default: true };
            let kind = plain(&field.kind);
            let names = ["effects".to_string()];
            let name = format!("effects.{}", field.name);
            match reference.section(place, &kind) {
                Some(section) => inside.push((name, section)),
                None => {
                    chapter.keys.push(reference.key(place, &none, &field, &names));
                    for (_, structs) in UNIONS.iter().filter(|(of, _)| *of == kind.name) {
                        for one in *structs {
                            inside.push((name.clone(), (place, reference.sources[place].sections[*one].clone())));
                        }
                    }
                }
            }
        }
    }
    reference.chapters.push(chapter);
    for (name, section) in inside {
        let doc = section.1.doc.clone();
        reference.add(&[name], &doc, section);
    }
}

const HEAD: &str = "# Scene reference\n\n\
    Every key of a scene file, from the structs that read it (`cargo test --test scene_reference` compares; `scripts/tables` writes). \
    Numbers are SI, or texts with a unit. A key that is left out has its default; an unknown key is refused. \
    `roulement scene --keys` prints this page, `roulement scene --keys film` what is about a word.\n";

fn page(reference: &Reference) -> String {
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
    page
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
            "defect" => json!({ "type": "array", "items": object() }),
            _ => object(),
        })
    })
}

/// A JSON schema for editors.
fn schema(reference: &Reference) -> Value {
    let mut schema = object();
    schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
    schema["title"] = "A scene of roulement".into();
    schema["properties"]["title"] = json!({ "type": "string", "description": "One line for plots and reports." });
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
    // The word alone: effects = "auto".
    let effects = schema["properties"]["effects"].take();
    schema["properties"]["effects"] = json!({ "anyOf": [{ "enum": ["auto"] }, effects] });
    schema
}

/// Compares a file with what it should be, or writes it where that is asked for.
fn compare(file: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    if std::env::var("ROULEMENT_RENEW").is_ok() {
        fs::write(path, text).unwrap();
        return;
    }
    let written = fs::read_to_string(path).unwrap();
    for (ours, theirs) in text.lines().zip(written.lines()) {
        assert_eq!(ours, theirs, "{file} is stale: scripts/tables");
    }
    assert_eq!(text.lines().count(), written.lines().count(), "{file} is stale: scripts/tables");
}

#[test]
fn the_reference_of_scenes_is_that_of_the_sources() {
    let reference = reference();
    compare("docs/scene.md", &page(&reference));
    compare("docs/scene.schema.json", &format!("{:#}\n", schema(&reference)));
}

/// Are all keys of a table known to a schema?
fn known(schema: &Value, value: &toml::Value, path: &str) {
    let schema = schema.get("anyOf").map_or(schema, |of| &of[1]);
    match (value, schema.get("properties").and_then(Value::as_object)) {
        (toml::Value::Table(table), Some(properties)) => {
            for (key, value) in table {
                let path = format!("{path}.{key}");
                known(properties.get(key).unwrap_or_else(|| panic!("{path} is not in the schema")), value, &path);
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
        for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap() {
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

/// Names in backquotes behind "expected" in a refusal of an unknown key.
fn expected(section: &str) -> Vec<String> {
    let needs = NEEDS.iter().filter(|(of, _)| section.starts_with(of)).flat_map(|(_, needs)| *needs);
    let key = if section.is_empty() { "no_such_key".to_string() } else { format!("{section}.no_such_key") };
    let changes = needs.copied().chain([(key.as_str(), "1")]);
    let why = Scene::edited(THRUST, changes).unwrap_err().to_string();
    if let Some((_, names)) = why.split_once("a scene has ") {
        return names.split(", ").map(str::to_string).collect();
    }
    let (_, names) = why.split_once("expected").unwrap_or_else(|| panic!("{section}: {why}"));
    names.split('`').skip(1).step_by(2).map(str::to_string).collect()
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
        // Lists of tables, and a value that may be a table, have no key that can be tried like this.
        if section == "defect" || UNION_KEYS.contains(&section.as_str()) {
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
