//! The record of a run, `run.json` beside its table: what the table does not say and a report needs.

use std::io;
use std::path::Path;

use roulement::analysis::estimate::Verdicts;
use roulement::scene::Scene;
use roulement::schema::regular;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::system::{System, SystemOutputs};
use serde_json::{Value, json};

use super::{bearing, fields, history, shaft};
use crate::report::figures::Shown;
use crate::report::json;
use crate::report::spectrum::Spectrum;
use crate::sweep::store::aside;
use crate::watch::{BearingSeen, ShaftSeen};

/// Name of its file.
pub const FILE: &str = "run.json";
/// What runs write beside the record, those of shafts too. Tables of a new run take the place of former ones by themselves.
const BESIDE: [&str; 12] = [
    "summary.txt",
    "means.csv",
    "phases.csv",
    "spectrum.csv",
    "spectrum.svg",
    "contacts.svg",
    "bearing.svg",
    "balls.svg",
    "results.csv.round",
    "shaft.csv.round",
    "shaft.csv",
    "shaft.svg",
];
/// Form of the record: another number where its parts mean something else.
pub const FORM: u64 = 1;

/// What a record is made of.
pub struct Run<'a> {
    /// The bearing at the end.
    pub simulation: &'a Simulation,
    /// Rows that pictures are drawn of.
    pub rows: &'a [Outputs],
    /// What was gathered of all rows.
    pub seen: &'a BearingSeen,
    /// Figures and their error bars.
    pub shown: &'a Shown,
    /// What estimates of effects say.
    pub verdicts: &'a Verdicts,
    /// The summary in words.
    pub summary: &'a str,
    /// \[s] wall and CPU time.
    pub took: [f64; 2],
    /// Why it ended before its time.
    pub ended_early: Option<String>,
}

impl Run<'_> {
    /// The record.
    pub fn to_json(&self) -> Value {
        let Self { simulation, rows, seen, shown, verdicts, summary, took, ended_early } = self;
        let (scene, model) = (simulation.scene(), simulation.model());
        let statistics = &simulation.outputs().statistics;
        json!({
            "form": FORM,
            "program": env!("ROULEMENT_VERSION"),
            "title": scene.title,
            "scene": scene.source,
            "ended_early": ended_early,
            "warnings": seen.warnings(simulation),
            "bearing": bearing::describe(scene, model),
            "summary": json::summary(simulation, seen, shown),
            "summary_text": summary,
            "effects": effects(scene, verdicts),
            "cost": {
                "wall": took[0],
                "cpu": took[1],
                "steps": statistics.steps,
                "rejected_by_error": statistics.rejected_error,
                "rejected_by_newton": statistics.rejected_newton,
                "newton_iterations": statistics.newton.iterations,
                "factorisations": statistics.newton.factorisations,
                "contact_values": statistics.contact_values,
                "contact_tangents": statistics.contact_tangents,
                "polynomials": statistics.polynomials,
                "polynomial_failures": statistics.polynomial_failures,
            },
            "spectrum": seen.spectrum.as_ref().map(spectrum),
            "history": history::columns(rows).to_json(),
            "field_causes": fields::causes(simulation),
        })
    }

    /// Writes it: the run is finished then.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        put(path, &self.to_json())
    }
}

/// What the record of a shaft with its bearings is made of; each bearing has one of its own, in a directory of its name beside it.
pub struct ShaftRun<'a> {
    /// The shaft at the end.
    pub system: &'a System,
    /// Rows that pictures are drawn of.
    pub rows: &'a [SystemOutputs],
    /// What was gathered of all rows.
    pub seen: &'a ShaftSeen,
    /// Figures and their error bars.
    pub shown: &'a Shown,
    /// What whoever reads its results should know, of its bearings, too.
    pub warnings: Vec<String>,
    /// The summary in words.
    pub summary: &'a str,
    /// \[s] wall and CPU time.
    pub took: [f64; 2],
    /// Why it ended before its time.
    pub ended_early: Option<String>,
}

impl ShaftRun<'_> {
    /// The record.
    pub fn to_json(&self) -> Value {
        let Self { system, rows, seen, shown, warnings, summary, took, ended_early } = self;
        json!({
            "form": FORM,
            "program": env!("ROULEMENT_VERSION"),
            "title": system.scene().title,
            "scene": system.scene().source,
            "ended_early": ended_early,
            "shaft": shaft::describe(system),
            "warnings": warnings,
            "summary": json::of_shaft(system, seen, shown),
            "summary_text": summary,
            "cost": { "wall": took[0], "cpu": took[1] },
            "history": shaft::columns(system, rows).to_json(),
        })
    }

    /// Writes it: the run is finished then.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        put(path, &self.to_json())
    }
}

/// Names of the bearings in the record of a shaft; none in that of a bearing.
pub fn bearings(record: &Value) -> Option<Vec<String>> {
    let bearings = record["shaft"]["bearings"].as_array()?;
    Some(bearings.iter().filter_map(|bearing| bearing["name"].as_str().map(str::to_string)).collect())
}

/// Puts a record in the place of another at once, so that it is whole whenever the program is killed.
fn put(path: &Path, record: &Value) -> io::Result<()> {
    let part = aside(path);
    std::fs::write(&part, format!("{record}\n")).and_then(|()| std::fs::rename(&part, path))
}

/// Gives a directory, which is made if missing, to a new run before its first row. Until [`Run::write`] its record says that the run is
/// unfinished, and nothing of a former run is there that could be taken for a part of this one.
///
/// # Errors
/// If files cannot be written or removed.
pub fn begin(directory: &Path) -> io::Result<()> {
    std::fs::create_dir_all(directory)?;
    put(&directory.join(FILE), &json!({ "form": FORM, "unfinished": true }))?;
    clear(directory)
}

fn clear(directory: &Path) -> io::Result<()> {
    BESIDE.iter().try_for_each(|name| remove(&directory.join(name)))
}

/// Removes a file, if it is there. What is no file, such as a link, was not written by a run.
fn remove(path: &Path) -> io::Result<()> {
    match path.symlink_metadata() {
        Ok(found) if found.is_file() => std::fs::remove_file(path),
        _ => Ok(()),
    }
}

/// Which effects are on, and what all of them would matter; nothing where that cannot be estimated.
fn effects(scene: &Scene, verdicts: &Verdicts) -> Value {
    let why = verdicts.as_ref().err().map(ToString::to_string);
    let mut effects = json::effects(scene, verdicts.as_deref().unwrap_or_default()).unwrap_or(Value::Null);
    effects["simulated"] = scene.effects.simulated().into();
    effects["why_not"] = why.into();
    effects
}

fn spectrum(spectrum: &Spectrum) -> Value {
    json!({
        "race": spectrum.race.name(),
        "window": spectrum.window,
        "shaft": spectrum.shaft,
        "marked": spectrum.marked.map(|(name, frequency)| json!([name, frequency])),
    })
}

/// Reads the record of a directory of results, with the fields of its contacts.
///
/// # Errors
/// If there is none, it is of another form, or its run is unfinished.
pub fn read(directory: &Path) -> Result<Value, String> {
    let path = directory.join(FILE);
    let text = regular::text(&path).map_err(|why| {
        format!(
            "cannot read {}: {why}; results of `roulement run SCENE -o {}` have it",
            path.display(),
            directory.display()
        )
    })?;
    let mut record: Value = serde_json::from_str(&text)
        .map_err(|why| format!("{} is no record of a run: {why}", path.display()))?;
    if record["unfinished"] == true {
        return Err(format!(
            "the run in {} is unfinished: it is still going on, or was killed before it could write its summary; run the scene again",
            directory.display()
        ));
    }
    match record["form"].as_u64() {
        Some(FORM) => {
            if record["fields"].is_null() && bearings(&record).is_none() {
                record["fields"] = fields::solved(&record["field_causes"]).into();
            }
            Ok(record)
        }
        Some(other) => Err(format!(
            "{} has form {other}, this program reads {FORM}: run the scene again",
            path.display()
        )),
        None => Err(format!("{} is no record of a run: it has no form", path.display())),
    }
}
