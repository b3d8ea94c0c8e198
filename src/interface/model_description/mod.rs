//! `modelDescription.xml` of a package, rendered from the variable table.
//!
//! ```text
//! steps.rs      communication steps that are recommended
//! structure.rs  what outputs depend on
//! elements.rs   elements that all versions have alike
//! v2.rs, v3.rs  documents of the versions of the standard
//! ```

mod elements;
mod steps;
mod structure;
mod v2;
mod v3;

use std::fmt::Write as _;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use sha2::{Digest, Sha256};

use crate::interface::references::References;
use crate::interface::variables::{Causality, Kind, MachineVariables, Variable};
use crate::scene::Dependencies;
use crate::schema::Method;
use crate::schema::variable_units::{self as units, Unit};
use crate::simulation::Simulation;
use crate::simulation::driven::Parts;
use crate::simulation::system::System;

/// Model identifier of a package with a name, which its library has as its file name: the name with every character that
/// is not allowed in C replaced.
pub fn identifier(name: &str) -> String {
    let allowed = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let text: String = name.chars().map(allowed).collect();
    if text.starts_with(|c: char| !c.is_ascii_digit()) { text } else { format!("_{text}") }
}

/// Log categories: name and meaning.
pub const LOG_CATEGORIES: [(&str, &str); 5] = [
    ("logEvents", "phases of the instance"),
    ("logStatusWarning", "calls that had to be bent to fit"),
    ("logStatusDiscard", "steps that could not be finished"),
    ("logStatusError", "calls that were refused"),
    ("logStatusFatal", "faults of the model itself"),
];

/// A rendered model description.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelDescription {
    /// The document.
    pub xml: String,
    /// Its globally unique identifier.
    pub guid: String,
}

type Xml = Writer<Vec<u8>>;

/// Version of the standard that a package follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    #[default]
    V2,
    /// FMI 3.0.
    V3,
}

/// What a package is beside its scene: the version of the standard that it follows, and what it says of who made it and when.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edition {
    /// Version of the standard.
    pub version: Version,
    /// Author of the model, and the organisation.
    pub author: Option<String>,
    /// Copyright of the model; that of the library is in its licences.
    pub copyright: Option<String>,
    /// When it was made, `2026-11-28T15:00:00Z`. Nothing if not given: the same scene then makes the same bytes.
    pub date: Option<String>,
}

impl Edition {
    /// Attributes of a model description.
    fn attributes(&self) -> impl Iterator<Item = (&str, &str)> {
        let Self { author, copyright, date, .. } = self;
        let all = [("author", author), ("copyright", copyright), ("generationDateAndTime", date)];
        all.into_iter().filter_map(|(name, value)| Some((name, value.as_deref()?)))
    }
}

impl From<Version> for Edition {
    fn from(version: Version) -> Self {
        Self { version, ..Self::default() }
    }
}

/// Which outputs a package tells of, by their names. Inputs and parameters it always tells of.
pub type Wanted<'a> = &'a dyn Fn(&str) -> bool;

/// Is a row told of by a package with these outputs?
pub fn is_exported(row: &Variable, wanted: Wanted<'_>) -> bool {
    row.causality != Causality::Output || wanted(&row.name)
}

/// All outputs.
pub fn all(_: &str) -> bool {
    true
}

/// Renders the model description of a started machine for a package of FMI 2.0: [`render_as`].
///
/// # Errors
/// Only those of writing to memory.
pub fn render(machine: &impl Parts, name: &str, wanted: Wanted<'_>) -> std::io::Result<ModelDescription> {
    render_as(&Edition::default(), machine, name, wanted)
}

/// Renders the model description of a started machine for a package with a name, with some of its outputs. Value references and the identifier
/// are those of all: what the library knows does not change.
///
/// # Errors
/// Only those of writing to memory.
pub fn render_as(
    edition: &Edition,
    machine: &impl Parts,
    name: &str,
    wanted: Wanted<'_>,
) -> std::io::Result<ModelDescription> {
    let variables = MachineVariables::new(machine);
    let bearings = || machine.bearings().map(|(_, bearing)| bearing);
    let (usual, title, source, load, (dependencies, arrays)) = match machine.shaft().map(System::scene) {
        Some(scene) => {
            let load = (scene.load.duration.0, scene.load.output_interval.0);
            let structure = (Dependencies::Point, scene.interface.arrays);
            ("shaft on ball bearings", &scene.title, &scene.source, load, structure)
        }
        None => {
            let alone =
                bearings().next().ok_or_else(|| std::io::Error::other("there is no bearing"))?.scene();
            let load = (alone.load.duration.0, alone.load.output_interval.0);
            let structure = (alone.interface.dependencies, alone.interface.arrays);
            ("ball bearing", &alone.title, &alone.source, load, structure)
        }
    };
    let step: fn(&Simulation) -> f64 = match machine.shaft() {
        Some(_) => steps::passing_step,
        None => steps::recommended_step,
    };
    let guid = guid(source, variables.rows());
    let about = About {
        title: if title.is_empty() { usual } else { title },
        name,
        guid: &guid,
        edition,
        dependencies,
        derivatives: bearings().all(|bearing| bearing.scene().solver.method == Method::Hht),
        stop: load.0,
        step: bearings().map(step).fold(load.1, f64::min),
    };
    let exported = Exported::new(variables.rows(), &variables.values(machine), arrays, wanted);
    let xml = document(&about, &exported)?;
    Ok(ModelDescription { xml, guid })
}

/// The variables that a model description has.
struct Exported {
    rows: Vec<Variable>,
    /// Value reference of each: its place among all rows.
    references: Vec<usize>,
    starts: Vec<f64>,
    /// References of FMI 3.0.
    version3: References,
}

impl Exported {
    fn new(all: &[Variable], starts: &[f64], arrays: bool, wanted: Wanted<'_>) -> Self {
        let exported = || (0..all.len()).filter(|index| is_exported(&all[*index], wanted));
        Self {
            rows: exported().map(|index| all[index].clone()).collect(),
            references: exported().collect(),
            starts: exported().map(|index| starts[index]).collect(),
            version3: References::of(all, arrays),
        }
    }

    /// References, rows and start values.
    fn all(&self) -> impl Iterator<Item = (usize, &Variable, f64)> {
        let starts = self.starts.iter().copied();
        self.references.iter().copied().zip(&self.rows).zip(starts).map(|((at, row), start)| (at, row, start))
    }

    fn outputs(&self, dependencies: Dependencies) -> Vec<structure::Output> {
        structure::outputs(&self.rows, dependencies)
    }
}

/// Attributes of the whole package in a model description.
struct About<'a> {
    title: &'a str,
    name: &'a str,
    guid: &'a str,
    edition: &'a Edition,
    /// Meaning of the dependencies of its outputs.
    dependencies: Dependencies,
    /// Are there derivatives by inputs?
    derivatives: bool,
    /// \[s] end of the default experiment.
    stop: f64,
    /// \[s] recommended communication step.
    step: f64,
}

/// Identifier of a scene's package: a digest of the scene and of what the variables are, but not of the start values that
/// were computed, whose last bits may differ between platforms.
pub fn guid(source: &str, rows: &[Variable]) -> String {
    let mut digest = Sha256::new();
    digest.update(env!("CARGO_PKG_VERSION"));
    for row in rows {
        let what = (&row.name, row.unit.name, row.kind, row.causality, row.limits, &row.description);
        digest.update(format!("{what:?}"));
    }
    digest.update(source);
    let hex = digest.finalize().iter().take(16).fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    });
    format!("{{{}-{}-{}-{}-{}}}", &hex[0..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..32])
}

fn document(about: &About<'_>, exported: &Exported) -> std::io::Result<String> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    match about.edition.version {
        Version::V2 => v2::write(&mut xml, about, exported)?,
        Version::V3 => v3::write(&mut xml, about, exported)?,
    }
    let mut text = String::from_utf8(xml.into_inner()).map_err(std::io::Error::other)?;
    text.push('\n');
    Ok(text)
}

/// The units that variables have, in the order of the table of units. Counts are given without one.
fn used_units(rows: &[Variable]) -> Vec<Unit> {
    let used = |unit: &Unit| rows.iter().any(|row| row.kind == Kind::Real && row.unit == *unit);
    units::ALL.into_iter().filter(used).collect()
}
