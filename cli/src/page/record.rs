//! The record of a run, `run.json` beside its table: what the table does not say and a report needs.

use std::io;
use std::path::Path;

use roulement::analysis::estimate::Verdicts;
use roulement::model::state::Statistics;
use roulement::scene::Scene;
use roulement::schema::regular;
use serde_json::{Value, json};

use super::grid::Grid;
use super::{bearing, fields, shaft};
use crate::duty::DutyRating;
use crate::report::figures::Shown;
use crate::report::json;
use crate::report::spectrum::Spectrum;
use crate::sweep::store::aside;
use crate::watch::Part;

/// Name of its file.
pub const FILE: &str = "run.json";
/// Names of the files that runs write beside the record, those of shafts too. Tables of a new run take the place of former ones by themselves.
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

/// Source of the record of a part of a machine: of a bearing, or of the shafts, whose bearings have records of their own in directories of
/// their names beside it.
pub struct Run<'a> {
    /// The part at the end.
    pub part: Part<'a>,
    /// Columns that are drawn over time.
    pub history: Grid,
    /// Figures and their error bars.
    pub shown: &'a Shown,
    /// Warnings for whoever reads its results; of shafts, those of their bearings, too.
    pub warnings: Vec<String>,
    /// Estimates of effects of a bearing.
    pub verdicts: Option<&'a Verdicts>,
    /// Rating over the duty of the machine, with its last part.
    pub duty: Option<&'a DutyRating>,
    /// The summary in words.
    pub summary: &'a str,
    /// \[s] wall and CPU time.
    pub took: [f64; 2],
    /// Work of the integrator; of shafts, that for their bearings.
    pub work: Statistics,
    /// Why it ended before its time.
    pub ended_early: Option<String>,
}

impl Run<'_> {
    /// The record.
    pub fn to_json(&self) -> Value {
        let Self { part, history, shown, warnings, verdicts, duty, summary, took, work, ended_early } = self;
        let mut record = json!({
            "form": FORM,
            "program": env!("ROULEMENT_VERSION"),
            "title": part.title(),
            "scene": part.source(),
            "ended_early": ended_early,
            "warnings": warnings,
            "summary": json::summary(*part, shown),
            "summary_text": summary,
            "cost": {
                "wall": took[0],
                "cpu": took[1],
                "steps": work.steps,
                "rejected_by_error": work.rejected_error,
                "rejected_by_newton": work.rejected_newton,
                "newton_iterations": work.newton.iterations,
                "factorisations": work.newton.factorisations,
                "contact_values": work.contact_values,
                "contact_tangents": work.contact_tangents,
                "polynomials": work.polynomials,
                "polynomial_failures": work.polynomial_failures,
            },
            "history": history.to_json(),
            "duty": duty.map(DutyRating::to_json),
        });
        match part {
            Part::Shaft(system, _) => record["shaft"] = shaft::describe(system),
            Part::Bearing(simulation, seen) => {
                record["bearing"] = bearing::describe(simulation.scene(), simulation.model());
                record["effects"] = verdicts.map(|verdicts| effects(simulation.scene(), verdicts)).into();
                record["spectrum"] = seen.spectrum.as_ref().map(spectrum).into();
                record["field_causes"] = fields::causes(simulation).into();
            }
        }
        record
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
        "meshes": spectrum.meshes.iter().map(|mesh| json!([mesh.name, mesh.frequency])).collect::<Vec<_>>(),
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
