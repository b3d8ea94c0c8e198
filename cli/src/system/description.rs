//! The description of a system.
//!
//! ```toml
//! name = "gearbox"
//! step = "10 us"                          # communication step
//! stop = "20 ms"
//! connections = [
//!     "shaft.left -> left.inner",         # every input left.inner.* from the output shaft.left.* of the same ending
//!     "left.inner -> shaft.left",
//! ]
//!
//! [components.shaft]
//! fmu = "Shaft.fmu"                       # beside this file
//!
//! [components.left]
//! scene = "bearing.toml"                  # packed as by `roulement fmu`
//! changes = { "load.inner_speed" = "-6000 rpm" }   # keys of the scene
//! mounting = "-x"                         # its x axis points the other way: half a turn about z
//!
//! [start]
//! "shaft.mass" = "1.8 kg"                 # parameters and inputs
//! "shaft.left.offset" = { of = "left.inner.position.x" }   # the start value of another variable
//! ```

use std::path::PathBuf;

use roulement::schema::units::{Quantity, Time};
use toml::{Table, Value};

use super::nearest::meant;

/// Keys of a description.
const KEYS: [&str; 6] = ["name", "step", "stop", "components", "connections", "start"];
/// Keys of a component.
const COMPONENT_KEYS: [&str; 4] = ["fmu", "scene", "changes", "mounting"];

/// Where the package of a component comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A package that is there.
    Fmu(PathBuf),
    /// A scene, and changes of its keys, to be packed.
    Scene(PathBuf, Vec<(String, String)>),
}

/// A component by its name.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name, as a variable of a program.
    pub name: String,
    /// Its package.
    pub source: Source,
    /// Does its x axis point the other way?
    pub turned: bool,
}

/// A start value as it is written.
#[derive(Clone, Debug)]
pub enum Written {
    /// A value.
    Value(Value),
    /// The start value of another variable.
    Of(String),
}

/// A description as it is read, not yet checked against packages.
#[derive(Clone, Debug)]
pub struct Description {
    /// Name of the system and of its files.
    pub name: String,
    /// \[s] communication step.
    pub step: f64,
    /// \[s]
    pub stop: f64,
    /// Components in alphabetical order.
    pub components: Vec<Named>,
    /// Connections as they are written.
    pub connections: Vec<String>,
    /// Variables with their component, and their start values.
    pub start: Vec<(String, Written)>,
}

impl Description {
    /// Reads a description.
    ///
    /// # Errors
    /// Key, value, and what is allowed.
    pub fn read(text: &str) -> Result<Self, String> {
        let table: Table =
            text.parse().map_err(|why: toml::de::Error| why.to_string().trim_end().to_string())?;
        known(&table, &KEYS, "")?;
        let name = string(&table, "name")?.ok_or("name is missing: give it, such as name = \"gearbox\"")?;
        if !is_name(&name) {
            return Err(format!("name = {name:?}: {NAMES}"));
        }
        let (step, stop) = (time(&table, "step", "10 us")?, time(&table, "stop", "20 ms")?);
        if step > stop {
            return Err(format!("step = {step} s is longer than stop = {stop} s"));
        }
        let listed = section(&table, "components")?;
        let components: Vec<Named> =
            listed.iter().map(|(name, value)| component(name, value)).collect::<Result<_, _>>()?;
        if components.is_empty() {
            return Err("components are missing: give sections such as [components.left]".to_string());
        }
        let wanted = "connections has to be a list such as [\"shaft.left -> left.inner\"]";
        let connections = match table.get("connections") {
            None => vec![],
            Some(value) => {
                let texts = value.as_array().and_then(|list| {
                    list.iter().map(|one| one.as_str().map(str::to_string)).collect::<Option<Vec<_>>>()
                });
                texts.ok_or_else(|| format!("{wanted}, not {value}"))?
            }
        };
        let mut start = vec![];
        flatten("", &section(&table, "start")?, &mut start)?;
        Ok(Self { name, step, stop, components, connections, start })
    }
}

/// Rule for names.
const NAMES: &str = "a name has letters, digits and _ alone, and does not begin with a digit";

fn is_name(name: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_';
    name.starts_with(|c: char| allowed(c) && !c.is_ascii_digit()) && name.chars().all(allowed)
}

/// Refuses other keys than these.
fn known(table: &Table, keys: &[&str], section: &str) -> Result<(), String> {
    match table.keys().find(|key| !keys.contains(&key.as_str())) {
        Some(key) => {
            let meant = meant(key, keys.iter().copied());
            Err(format!("{section}{key} is no known key{meant}; there may be {}", keys.join(", ")))
        }
        None => Ok(()),
    }
}

fn string(table: &Table, key: &str) -> Result<Option<String>, String> {
    let text = |value: &Value| {
        value
            .as_str()
            .map(str::to_string)
            .ok_or_else(|| format!("{key} has to be text in quotes, not {value}"))
    };
    table.get(key).map(text).transpose()
}

/// A time \[s] above 0.
fn time(table: &Table, key: &str, example: &str) -> Result<f64, String> {
    let seconds = match table.get(key) {
        None => return Err(format!("{key} is missing: give it, such as {key} = \"{example}\"")),
        Some(Value::String(text)) => Time::DIMENSION.parse(text).map_err(|why| format!("{key}: {why}"))?,
        Some(Value::Float(number)) => *number,
        Some(Value::Integer(number)) => *number as f64,
        Some(other) => {
            return Err(format!("{key} = {other}: write a number in s, or text such as \"{example}\""));
        }
    };
    if seconds > 0.0 && seconds.is_finite() {
        Ok(seconds)
    } else {
        Err(format!("{key} = {seconds} s: it has to be above 0"))
    }
}

/// A section, empty if it is not there.
fn section(table: &Table, key: &str) -> Result<Table, String> {
    match table.get(key) {
        None => Ok(Table::new()),
        Some(Value::Table(section)) => Ok(section.clone()),
        Some(value) => Err(format!("{key} has to be a section, not {value}")),
    }
}

fn component(name: &str, value: &Value) -> Result<Named, String> {
    let at = format!("components.{name}");
    let in_section = |why: String| format!("{at}.{why}");
    if !is_name(name) {
        return Err(format!("{at}: {NAMES}"));
    }
    let table = value.as_table().ok_or_else(|| format!("{at} has to be a section, not {value}"))?;
    known(table, &COMPONENT_KEYS, &format!("{at}."))?;
    let changes = section(table, "changes").map_err(in_section)?;
    let source =
        match (string(table, "fmu").map_err(in_section)?, string(table, "scene").map_err(in_section)?) {
            (Some(_), None) if !changes.is_empty() => {
                return Err(format!("{at}.changes is for scenes: this component has an FMU"));
            }
            (Some(fmu), None) => Source::Fmu(fmu.into()),
            (None, Some(scene)) => Source::Scene(
                scene.into(),
                changes.iter().map(|(key, value)| (key.clone(), value.to_string())).collect(),
            ),
            _ => return Err(format!("{at} has to have either fmu = \"FILE.fmu\" or scene = \"FILE.toml\"")),
        };
    let turned = match string(table, "mounting").map_err(in_section)?.as_deref() {
        None | Some("x") => false,
        Some("-x") => true,
        Some(other) => return Err(format!("{at}.mounting = {other:?}: it is \"x\" or \"-x\"")),
    };
    Ok(Named { name: name.to_string(), source, turned })
}

/// Adds start values by their whole names.
fn flatten(path: &str, table: &Table, into: &mut Vec<(String, Written)>) -> Result<(), String> {
    for (key, value) in table {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        match value {
            Value::Table(inner) if inner.len() == 1 && inner.get("of").is_some_and(Value::is_str) => {
                into.push((path, Written::Of(inner["of"].as_str().unwrap_or_default().to_string())));
            }
            Value::Table(inner) => flatten(&path, inner, into)?,
            Value::Array(_) | Value::Datetime(_) => {
                return Err(format!(
                    "start.{path} = {value}: a start value is a number, text, true or false, or {{ of = \"component.variable\" }}"
                ));
            }
            _ => into.push((path, Written::Value(value.clone()))),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "name = \"pair\"\nstep = \"10 us\"\nstop = 0.02\nconnections = [\"a.u -> b.v\"]\n\
                        [components.a]\nfmu = \"a.fmu\"\n[components.b]\nscene = \"b.toml\"\nmounting = \"-x\"\n\
                        changes = { \"load.duration\" = \"1 ms\" }\n[start]\n\"a.k\" = 1\nb.inner.v = { of = \"a.k\" }\n";

    #[test]
    fn all_keys_are_read() {
        let read = Description::read(TEXT).unwrap();
        assert_eq!((read.name.as_str(), read.step, read.stop), ("pair", 1e-5, 0.02));
        let sources: Vec<_> = read.components.iter().map(|one| (&one.source, one.turned)).collect();
        let changes = vec![("load.duration".to_string(), "\"1 ms\"".to_string())];
        assert_eq!(
            sources,
            [(&Source::Fmu("a.fmu".into()), false), (&Source::Scene("b.toml".into(), changes), true)]
        );
        assert_eq!(read.connections, ["a.u -> b.v"]);
        assert!(
            matches!(&read.start[..], [(a, Written::Value(_)), (b, Written::Of(of))] if a == "a.k" && b == "b.inner.v" && of == "a.k")
        );
    }

    #[test]
    fn errors_name_key_value_and_what_is_allowed() {
        for (from, to, parts) in [
            (
                "step = \"10 us\"",
                "stp = 1",
                &["stp is no known key", "nearest name is step", "connections"][..],
            ),
            ("step = \"10 us\"\n", "", &["step is missing", "10 us"]),
            ("\"10 us\"", "\"10 N\"", &["step", "10 N", "a time"]),
            ("\"10 us\"", "0", &["step = 0 s", "above 0"]),
            ("\"10 us\"", "1.0", &["step = 1 s", "stop = 0.02 s"]),
            ("\"pair\"", "\"a pair\"", &["name = \"a pair\"", "letters"]),
            ("[components.a]", "[components.\"a.b\"]", &["components.a.b", "letters"]),
            ("\"-x\"", "\"y\"", &["components.b.mounting = \"y\"", "\"x\" or \"-x\""]),
            ("fmu = \"a.fmu\"", "", &["components.a", "either fmu", "or scene"]),
            ("fmu = \"a.fmu\"", "fmu = 1", &["components.a.fmu has to be text"]),
            (
                "fmu = \"a.fmu\"",
                "fmu = \"a.fmu\"\nchanges = { x = 1 }",
                &["components.a.changes is for scenes"],
            ),
            ("[\"a.u -> b.v\"]", "\"a.u -> b.v\"", &["connections has to be a list"]),
            ("\"a.k\" = 1", "\"a.k\" = [1]", &["start.a.k = [1]", "a number"]),
        ] {
            let why = Description::read(&TEXT.replacen(from, to, 1)).unwrap_err();
            for part in parts {
                assert!(why.contains(part), "{why}\nshould say {part}");
            }
        }
    }
}
