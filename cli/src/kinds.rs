//! Kinds of files that commands take, told by what is in them.

use std::fmt;
use std::path::Path;

use toml::{Table, Value};

/// Bytes of a file whose kind is told at most.
const LARGEST: u64 = 64 << 20;

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The scene of one bearing.
    Bearing,
    /// A machine: shafts with their bearings.
    Machine,
    /// Bearings of one's own catalogue.
    Shelf,
    /// Cases of a scene.
    Sweep,
    /// Connected packages.
    System,
    /// A gearbox of another program.
    Rexs,
    /// A package.
    Package,
    /// A table, which sweeps, ratings and contacts read.
    Csv,
    /// A folder with the results of a run or a sweep.
    Results,
}

impl Kind {
    /// Kind of a file or folder; none if it cannot be told.
    pub fn of(path: &Path) -> Option<Self> {
        if path.is_dir() {
            let is_there = |name: &str| path.join(name).is_file();
            return (is_there("run.json") || is_there("summary.csv")).then_some(Self::Results);
        }
        let ending = path.extension().map(|of| of.to_string_lossy().to_lowercase()).unwrap_or_default();
        match ending.as_str() {
            "fmu" => return Some(Self::Package),
            "rexs" | "rexsj" | "rexsz" => return Some(Self::Rexs),
            "csv" => return Some(Self::Csv),
            _ => {}
        }
        // A pipe would wait for its writer.
        std::fs::metadata(path).ok().filter(|of| of.is_file() && of.len() < LARGEST)?;
        let table: Table = std::fs::read_to_string(path).ok()?.parse().ok()?;
        let has = |keys: &[&str]| keys.iter().any(|key| table.contains_key(*key));
        // A sweep may be of anything, so its own keys come first.
        if has(&["latin_hypercube", "grid", "case"]) {
            Some(Self::Sweep)
        } else if has(&["components", "connections"]) {
            Some(Self::System)
        } else if has(&["shaft"]) {
            Some(Self::Machine)
        } else if table.len() == 1 && table.get("bearing").is_some_and(Value::is_array) {
            Some(Self::Shelf)
        } else if has(&["bearing", "ball", "race"]) {
            Some(Self::Bearing)
        } else {
            None
        }
    }

    /// Commands that take it.
    pub fn commands(self) -> &'static str {
        match self {
            Self::Bearing | Self::Machine => {
                "check, run, equilibrium, effects, rating, modes, field, cost, describe, fmu"
            }
            Self::Shelf => "check; bearing and machines look it up by its name, catalogue.toml",
            Self::Sweep => "check, sweep",
            Self::System => "check, system",
            Self::Rexs => "check, import",
            Self::Package => "system, as the component of a description",
            Self::Csv => "sweep and rating --loads with --scene or a scene, contact",
            Self::Results => "report",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(match self {
            Self::Bearing => "the scene of a bearing",
            Self::Machine => "a machine: shafts with their bearings",
            Self::Shelf => "a shelf of bearings, one's own catalogue",
            Self::Sweep => "a sweep: cases of a scene",
            Self::System => "the description of a system of packages",
            Self::Rexs => "a gearbox in REXS",
            Self::Package => "a package (FMU)",
            Self::Csv => "a table (CSV)",
            Self::Results => "a folder of results",
        })
    }
}

/// Why a file cannot be what a command wants, where it is something else: which kind it is, and which commands take that.
pub fn other_kind(path: &Path, wanted: &[Kind]) -> Option<String> {
    let kind = Kind::of(path).filter(|kind| !wanted.contains(kind))?;
    Some(format!("{} is {kind}; commands that take it: {}", path.display(), kind.commands()))
}
