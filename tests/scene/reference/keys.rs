//! Keys of a scene as the reference has them: from the structs that scenes are read by, and from what a user is told.

use quote::ToTokens;
use roulement::scene::Scene;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;
use syn::{Expr, GenericArgument, PathArguments, Type};

use super::sources::{Field, Section, Source, sources};

pub const THRUST: &str = include_str!("../../../scenes/thrust.toml");
/// Types that are read in several ways, with the structs of those that are tables.
const UNIONS: [(&str, &[&str]); 2] =
    [("Given", &["RestitutionSection", "RetardationSection"]), ("Shape", &["WaveSection"])];
/// Values of types that have a way of their own to be written.
const VALUES: [(&str, &str); 6] = [
    ("Given", "s/m, or text: `\"0.02 s/m\"`, or a table, below"),
    (
        "Shape",
        "list of waves, below, or `{ profile = \"file.csv\" }`, or `{ profile = [[radial, axial], ...] }`",
    ),
    ("Parameters", "table of `eta`, `beta`, `alpha`: `roulement identify` writes it"),
    ("DirectionMatrix", "six numbers, or six rows of six"),
    ("Goal", "text or table"),
    ("CageKind", "`true`, `false`, `\"ideal\"`, `\"none\"`"),
];
/// Keys of such types.
pub const UNION_KEYS: [&str; 3] = ["effects.damping", "form.inner", "form.outer"];
/// Dimensions: type, SI unit, example; as `src/schema/units/mod.rs` has them.
const UNITS: &str = include_str!("../../../src/schema/units/mod.rs");
/// What a section needs beside a key that is tried.
pub const NEEDS: [(&str, &[(&str, &str)]); 8] = [
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
pub struct Key {
    pub name: String,
    pub meaning: String,
    pub values: String,
    pub default: String,
    /// What a JSON schema says of its value.
    pub schema: Value,
}

/// A table of keys.
pub struct Chapter {
    pub title: String,
    pub doc: String,
    pub keys: Vec<Key>,
}

pub struct Reference {
    pub sources: Vec<Source>,
    pub chapters: Vec<Chapter>,
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
                match inside.iter_mut().find(|(_, _, known)| {
                    known.1.fields.len() == found.1.fields.len() && known.1.doc == found.1.doc
                }) {
                    Some((known, _, _)) => known.extend(names),
                    None => inside.push((names, found.1.doc.clone(), found)),
                }
                continue;
            }
            chapter.keys.push(self.key(place, &section, field, names));
            if let Some((_, structs)) = UNIONS.iter().find(|(name, _)| *name == kind.name) {
                for one in *structs {
                    let found =
                        self.sources.iter().position(|source| source.sections.contains_key(*one)).unwrap();
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

    /// The schema of a struct of a file, with all that is in it.
    pub fn object_of(&self, name: &str, file: &str) -> Value {
        let place = self.sources.iter().position(|source| source.path.ends_with(file)).unwrap();
        self.object(place, &self.sources[place].sections[name].clone())
    }

    fn object(&self, place: usize, section: &Section) -> Value {
        let mut properties = json!({});
        for field in section.fields.iter().filter(|field| !field.skipped) {
            let kind = plain(&field.kind);
            let mut own = self.key(place, section, field, &[]).schema;
            if let Some((place, inside)) = self.section(place, &kind) {
                let description = own["description"].take();
                own = self.object(place, &inside);
                if kind.several.is_some() {
                    own = json!({ "type": "array", "items": own });
                }
                own["description"] = description;
            }
            properties[&field.name] = own;
        }
        json!({
            "type": "object",
            "additionalProperties": false,
            "description": meaning(&section.doc).replace("\\[", "["),
            "properties": properties,
        })
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
            ("Table", _, _) => "keys with their sections".into(),
            (_, Some((_, variants)), _) => {
                let of =
                    |(name, doc): &(String, String)| format!("`\"{name}\"`: {}", doc.trim_end_matches('.'));
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
            values += if over_time {
                "; constant, a table `[[time, value], ...]`, or a [building block](load-cases.md)"
            } else {
                "; a list of x, y, z, each constant, a table `[[time, value], ...]`, or a [building block](load-cases.md)"
            };
        }
        if let Some(range) = names.iter().find_map(|name| range(&format!("{name}.{}", field.name))) {
            let _ = write!(values, "<br>{range}");
        }
        let default = match self.default(place, section, field, &kind) {
            Some(default) => default,
            None if kind.optional => "none".into(),
            None => "must be given".into(),
        };
        let names =
            choices.map(|(_, variants)| variants.into_iter().map(|(name, _)| name).collect::<Vec<_>>());
        let mut schema = match (kind.name.as_str(), names) {
            ("bool", _) => json!({ "type": "boolean" }),
            ("DirectionMatrix", _) => json!({ "type": "array" }),
            ("CageKind", _) => json!({ "enum": [true, false, "ideal", "none"] }),
            ("String", _) => json!({ "type": "string" }),
            ("Table", _) => json!({ "type": "object" }),
            (_, Some(names)) => json!({ "enum": names }),
            ("usize" | "u32", _) => json!({ "type": "integer" }),
            ("f64", _) => json!({ "type": "number" }),
            _ if dimension.is_some() && over_time => {
                json!({ "type": ["number", "string", "array", "object"] })
            }
            ("Components", _) => json!({ "type": "array" }),
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
            "Table" => "none".into(),
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
                    let name =
                        variants.iter().find(|(name, _)| name.replace('_', "") == last.to_lowercase())?;
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
                let each =
                    array.elems.iter().map(|of| self.written(place, of, kind)).collect::<Option<Vec<_>>>()?;
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
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Documentation as a cell of a table: without marks of Rust's own documents.
pub fn meaning(doc: &str) -> String {
    let mut text = doc.replace("\\[", "[").replace('|', "\\|");
    while let Some(begin) = text.find("[`") {
        // Links to items of the program tell a reader of scenes nothing.
        let end = text[begin..].find("`]").map_or(text.len(), |end| begin + end + 2);
        let item = text[begin..end].trim_matches(['[', ']', '`']).to_string();
        text.replace_range(begin..end, &format!("`{}`", item.rsplit("::").next().unwrap()));
    }
    // A unit in brackets is no link; what is code stays as it is.
    let parts = text.split('`').enumerate();
    let parts =
        parts.map(|(place, part)| if place % 2 == 0 { part.replace('[', "\\[") } else { part.to_string() });
    parts.collect::<Vec<_>>().join("`")
}

/// Lists of tables in other sections, with keys that an entry needs.
pub const LISTS: [(&str, &[(&str, &str)]); 4] = [
    ("duty", &[("name", "\"a\""), ("share", "1.0")]),
    ("phase", &[("name", "\"a\""), ("from", "0"), ("to", "1e-3")]),
    ("load.rotating", &[("unbalance", "1e-5")]),
    ("load.gear", &[("torque", "1.0"), ("pitch_radius", "0.02"), ("pressure_angle", "0.3")]),
];

/// The range of a number of a list of tables, as a refusal of an entry states it.
fn range_in_list(list: &str, needs: &[(&str, &str)], key: &str) -> Option<String> {
    let others: String = needs
        .iter()
        .filter(|(name, _)| *name != key && key != "force")
        .map(|(name, value)| format!(", {name} = {value}"))
        .collect();
    ["1e300", "-1e300", "1000000000"].into_iter().find_map(|value| {
        let why =
            Scene::edited(THRUST, [(list, format!("[{{ {key} = {value}{others} }}]"))]).err()?.to_string();
        let (about, allowed) = why.split_once("allowed is ")?;
        about.contains(&format!("{list}[0].{key}")).then(|| allowed.trim_end_matches('.').to_string())
    })
}

/// The range of a number, as a refusal states it.
fn range(key: &str) -> Option<String> {
    // Times of a phase lie within the run, whose end is that of the scene.
    if key.starts_with("phase.") {
        return None;
    }
    for (list, needs) in LISTS {
        if let Some(name) = key.strip_prefix(list).and_then(|rest| rest.strip_prefix('.')) {
            return range_in_list(list, needs, name);
        }
    }
    let needs = NEEDS.iter().filter(|(section, _)| key.starts_with(section)).flat_map(|(_, needs)| *needs);
    let needs: Vec<(&str, &str)> = needs.copied().filter(|(needed, _)| *needed != key).collect();
    ["1e300", "-1e300", "[1e300, 1e300]", "[1e300, 1e300, 1e300]", "1000000000"].into_iter().find_map(
        |value| {
            let changes = needs.iter().copied().chain([(key, value)]);
            let why = Scene::edited(THRUST, changes).err()?.to_string();
            let (about, allowed) = why.split_once("allowed is ")?;
            about.contains(key).then(|| allowed.trim_end_matches('.').to_string())
        },
    )
}

pub fn reference() -> Reference {
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
        } else if kind.name == "Ranges" {
            let (title, doc) = (format!("`{}`", field.name), field.doc.clone());
            reference.chapters.push(Chapter { title, doc, keys: vec![] });
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
            let none = Section {
                doc: String::new(),
                fields: vec![],
                read_as: None,
                defaults: Default::default(),
                all_default: true,
            };
            let kind = plain(&field.kind);
            let names = ["effects".to_string()];
            let name = format!("effects.{}", field.name);
            match reference.section(place, &kind) {
                Some(section) => inside.push((name, section)),
                None => {
                    chapter.keys.push(reference.key(place, &none, &field, &names));
                    for (_, structs) in UNIONS.iter().filter(|(of, _)| *of == kind.name) {
                        for one in *structs {
                            inside.push((
                                name.clone(),
                                (place, reference.sources[place].sections[*one].clone()),
                            ));
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
