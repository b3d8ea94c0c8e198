//! `modelDescription.xml` of a package, rendered from the variable table.

use std::fmt::Write as _;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use sha2::{Digest, Sha256};

use crate::analysis::condensed::Condensed;
use crate::interface::variables::{Causality, InputKind, Kind, MachineVariables, Offered, Source, Variable};
use crate::scene::{Dependencies, Drive};
use crate::schema::Method;
use crate::schema::numbers::Variability;
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

/// Renders the model description of a started machine for a package with a name, with some of its outputs. Value references and the identifier
/// are those of all: what the library knows does not change.
///
/// # Errors
/// Only those of writing to memory.
pub fn render(machine: &impl Parts, name: &str, wanted: Wanted<'_>) -> std::io::Result<ModelDescription> {
    let variables = MachineVariables::new(machine);
    let bearings = || machine.bearings().map(|(_, bearing)| bearing);
    let (usual, title, source, load, dependencies) = match machine.shaft().map(System::scene) {
        Some(scene) => {
            let load = (scene.load.duration.0, scene.load.output_interval.0);
            ("shaft on ball bearings", &scene.title, &scene.source, load, Dependencies::Point)
        }
        None => {
            let alone =
                bearings().next().ok_or_else(|| std::io::Error::other("there is no bearing"))?.scene();
            let load = (alone.load.duration.0, alone.load.output_interval.0);
            ("ball bearing", &alone.title, &alone.source, load, alone.interface.dependencies)
        }
    };
    let step: fn(&Simulation) -> f64 = match machine.shaft() {
        Some(_) => passing_step,
        None => recommended_step,
    };
    let guid = guid(source, variables.rows());
    let about = About {
        title: if title.is_empty() { usual } else { title },
        name,
        guid: &guid,
        dependencies,
        derivatives: bearings().all(|bearing| bearing.scene().solver.method == Method::Hht),
        stop: load.0,
        step: bearings().map(step).fold(load.1, f64::min),
    };
    let xml = document(&about, &Exported::new(variables.rows(), &variables.values(machine), wanted))?;
    Ok(ModelDescription { xml, guid })
}

/// The variables that a model description has.
struct Exported {
    rows: Vec<Variable>,
    /// Value reference of each: its place among all rows.
    references: Vec<usize>,
    starts: Vec<f64>,
}

impl Exported {
    fn new(all: &[Variable], starts: &[f64], wanted: Wanted<'_>) -> Self {
        let exported = || (0..all.len()).filter(|index| is_exported(&all[*index], wanted));
        Self {
            rows: exported().map(|index| all[index].clone()).collect(),
            references: exported().collect(),
            starts: exported().map(|index| starts[index]).collect(),
        }
    }
}

/// Attributes of the whole package in a model description.
struct About<'a> {
    title: &'a str,
    name: &'a str,
    guid: &'a str,
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
    let rows = &exported.rows;
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    xml.create_element("fmiModelDescription")
        .with_attributes([
            ("fmiVersion", "2.0"),
            ("modelName", about.name),
            ("guid", about.guid),
            ("description", about.title),
            ("version", env!("CARGO_PKG_VERSION")),
            ("generationTool", concat!("roulement ", env!("CARGO_PKG_VERSION"))),
            ("license", env!("CARGO_PKG_LICENSE")),
            ("variableNamingConvention", "structured"),
            ("numberOfEventIndicators", "0"),
        ])
        .write_inner_content(|xml| {
            co_simulation(xml, about)?;
            let units = used_units(rows);
            unit_definitions(xml, &units)?;
            type_definitions(xml, &units)?;
            xml.create_element("LogCategories").write_inner_content(|xml| {
                for (name, description) in LOG_CATEGORIES {
                    let attributes = [("name", name), ("description", description)];
                    xml.create_element("Category").with_attributes(attributes).write_empty()?;
                }
                Ok(())
            })?;
            default_experiment(xml, about)?;
            xml.create_element("ModelVariables").write_inner_content(|xml| {
                for (reference, (row, start)) in
                    exported.references.iter().zip(rows.iter().zip(&exported.starts))
                {
                    scalar_variable(xml, *reference, row, *start)?;
                }
                Ok(())
            })?;
            model_structure(xml, rows, about.dependencies)
        })?;
    let mut text = String::from_utf8(xml.into_inner()).map_err(std::io::Error::other)?;
    text.push('\n');
    Ok(text)
}

fn co_simulation(xml: &mut Xml, about: &About<'_>) -> std::io::Result<()> {
    let identifier = identifier(about.name);
    xml.create_element("CoSimulation")
        .with_attributes([
            ("modelIdentifier", identifier.as_str()),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("canInterpolateInputs", "true"),
            ("maxOutputDerivativeOrder", "1"),
            ("canGetAndSetFMUstate", "true"),
            ("canSerializeFMUstate", "true"),
            ("providesDirectionalDerivative", if about.derivatives { "true" } else { "false" }),
        ])
        .write_empty()?;
    Ok(())
}

/// The units that variables have, in the order of the table of units. Counts are given without one.
fn used_units(rows: &[Variable]) -> Vec<Unit> {
    let used = |unit: &Unit| rows.iter().any(|row| row.kind == Kind::Real && row.unit == *unit);
    units::ALL.into_iter().filter(used).collect()
}

fn unit_definitions(xml: &mut Xml, used: &[Unit]) -> std::io::Result<()> {
    xml.create_element("UnitDefinitions").write_inner_content(|xml| {
        for (index, unit) in used.iter().enumerate() {
            // Quantities may share a unit and differ in how it is displayed.
            if used[..index].iter().all(|before| before.name != unit.name) {
                let displayed = used.iter().filter(|other| other.name == unit.name).filter_map(|u| u.display);
                unit_definition(xml, unit, displayed)?;
            }
        }
        Ok(())
    })?;
    Ok(())
}

fn unit_definition(
    xml: &mut Xml,
    unit: &Unit,
    displayed: impl Iterator<Item = (&'static str, f64)>,
) -> std::io::Result<()> {
    xml.create_element("Unit").with_attribute(("name", unit.name)).write_inner_content(|xml| {
        let mut base = xml.create_element("BaseUnit");
        for (name, exponent) in ["kg", "m", "s", "rad", "K"].into_iter().zip(unit.exponents) {
            if exponent != 0 {
                base = base.with_attribute((name, exponent.to_string().as_str()));
            }
        }
        base.write_empty()?;
        for (name, factor) in displayed {
            let factor = factor.to_string();
            let attributes = [("name", name), ("factor", factor.as_str())];
            xml.create_element("DisplayUnit").with_attributes(attributes).write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

fn type_definitions(xml: &mut Xml, used: &[Unit]) -> std::io::Result<()> {
    xml.create_element("TypeDefinitions").write_inner_content(|xml| {
        for unit in used {
            let element = xml.create_element("SimpleType").with_attribute(("name", unit.quantity));
            element.write_inner_content(|xml| {
                let attributes = [("quantity", unit.quantity), ("unit", unit.name)];
                let mut real = xml.create_element("Real").with_attributes(attributes);
                if let Some((display, _)) = unit.display {
                    real = real.with_attribute(("displayUnit", display));
                }
                real.write_empty()?;
                Ok(())
            })?;
        }
        Ok(())
    })?;
    Ok(())
}

/// The recommended communication step resolves the passing of the balls with twenty points, and is not longer than the
/// scene's own output interval. Where the pose of the inner race is an input, it also is short enough for a shaft that its
/// master moves by leapfrog (`docs/coupling.md`): half the reciprocal of its angular frequency on the bearing, a quarter of
/// what is stable. The shaft has the mass that the scene gives, or 1 kg.
fn recommended_step(simulation: &Simulation) -> f64 {
    const SHAFT_MASS: f64 = 1.0; // [kg]
    const FREQUENCY_BY_STEP: f64 = 0.5; // [rad]
    let scene = simulation.scene();
    let mut step = scene.load.output_interval.0.min(passing_step(simulation));
    if scene.inner.drive == Drive::Pose {
        let condensed = Condensed::new(simulation.model(), simulation.state(), &simulation.conditions());
        let stiffness = (0..3).map(|axis| condensed.stiffness[(axis, axis)]).fold(0.0, f64::max);
        let mass = scene.inner.mass.map_or(SHAFT_MASS, |mass| mass.0);
        if stiffness > 0.0 {
            step = step.min(round_down(FREQUENCY_BY_STEP * (mass / stiffness).sqrt()));
        }
    }
    step
}

/// \[s] communication step that resolves the passing of the balls; infinite where they do not pass.
fn passing_step(simulation: &Simulation) -> f64 {
    const POINTS_PER_PASSAGE: f64 = 20.0;
    let outputs = simulation.outputs();
    let balls = simulation.scene().bearing.balls as f64;
    // Balls pass a point of a race at their speed relative to it.
    let speeds = [outputs.inner.twist.angular_velocity.x, outputs.outer.twist.angular_velocity.x];
    let passing = speeds.map(|speed| balls * (speed - outputs.cage_speed).abs() / std::f64::consts::TAU);
    let frequency = passing[0].max(passing[1]);
    if frequency > 0.0 { round_down(1.0 / (POINTS_PER_PASSAGE * frequency)) } else { f64::INFINITY }
}

fn default_experiment(xml: &mut Xml, about: &About<'_>) -> std::io::Result<()> {
    let (stop, step) = (about.stop.to_string(), about.step.to_string());
    let attributes = [("startTime", "0"), ("stopTime", stop.as_str()), ("stepSize", step.as_str())];
    xml.create_element("DefaultExperiment").with_attributes(attributes).write_empty()?;
    Ok(())
}

/// The next number below of 1, 2, 5, 10 and so on.
fn round_down(x: f64) -> f64 {
    let exponent = x.log10().floor() as i32;
    let mantissa = x / 10f64.powi(exponent);
    let digit = if mantissa >= 5.0 {
        5.0
    } else if mantissa >= 2.0 {
        2.0
    } else {
        1.0
    };
    // Written in decimals and read again, so that it is the number nearest to what it says.
    format!("{digit}e{exponent}").parse().unwrap_or(x)
}

fn scalar_variable(xml: &mut Xml, reference: usize, row: &Variable, start: f64) -> std::io::Result<()> {
    let reference = reference.to_string();
    // What the standard takes where nothing is written is left out: continuous, and calculated for outputs.
    let (causality, variability, initial) = match (row.causality, row.kind) {
        (Causality::Input, _) => ("input", None, None),
        (Causality::Output, _) => ("output", None, None),
        (Causality::Local, _) => ("local", Some("discrete"), Some("calculated")),
        (Causality::Parameter, _) => ("parameter", Some(variability(row)), Some("exact")),
    };
    let mut element = xml.create_element("ScalarVariable").with_attributes([
        ("name", row.name.as_str()),
        ("valueReference", reference.as_str()),
        ("description", row.description.as_str()),
        ("causality", causality),
    ]);
    for (name, value) in [("variability", variability), ("initial", initial)] {
        if let Some(value) = value {
            element = element.with_attribute((name, value));
        }
    }
    element.write_inner_content(|xml| {
        let mut attributes = vec![];
        if row.kind == Kind::Real {
            attributes.extend([
                ("declaredType", row.unit.quantity.to_string()),
                ("unit", row.unit.name.to_string()),
            ]);
            attributes.extend(row.unit.display.map(|(display, _)| ("displayUnit", display.to_string())));
        }
        for (name, limit) in ["min", "max"].into_iter().zip(row.limits) {
            attributes.extend(limit.map(|limit| (name, limit.to_string())));
        }
        if row.kind == Kind::Real {
            attributes.push(("nominal", row.nominal.to_string()));
        }
        if matches!(row.causality, Causality::Input | Causality::Parameter) {
            attributes.push(("start", format!("{start:?}")));
        }
        let kind = if row.kind == Kind::Real { "Real" } else { "Integer" };
        let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
        xml.create_element(kind).with_attributes(attributes).write_empty()?;
        Ok(())
    })?;
    Ok(())
}

fn variability(row: &Variable) -> &'static str {
    match row.offered() {
        Some(Offered { variability: Variability::Tunable, .. }) => "tunable",
        _ => "fixed",
    }
}

/// Dependencies of the outputs (`docs/decisions/dependencies.md`). At a communication point none depends on an input as it is
/// set there: outputs are those of the last step. In a step, and at the start, they depend on all inputs, as the bearing is one
/// mechanism, at the start on all parameters, too; exceptions are few.
fn model_structure(xml: &mut Xml, rows: &[Variable], dependencies: Dependencies) -> std::io::Result<()> {
    let outputs = || rows.iter().enumerate().filter(|(_, row)| row.causality == Causality::Output);
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        xml.create_element("Outputs").write_inner_content(|xml| {
            for (index, row) in outputs() {
                // Written out, although no list would mean all: importers for which the lists are sparsity (PyFMI, OMSimulator)
                // take an output without a list as one without dependencies.
                let known = match dependencies {
                    Dependencies::Point => vec![],
                    Dependencies::Step => inputs_of_step(rows, row),
                };
                unknown(xml, index, Some(&known))?;
            }
            Ok(())
        })?;
        xml.create_element("InitialUnknowns").write_inner_content(|xml| {
            for (index, row) in outputs() {
                unknown(xml, index, is_counted_from_start(row).then_some(&[]))?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    Ok(())
}

/// One unknown with what it depends on, where that is not everything; both by their places among the variables.
fn unknown(xml: &mut Xml, index: usize, known: Option<&[usize]>) -> std::io::Result<()> {
    // Indices count from 1.
    let number = |index: &usize| (index + 1).to_string();
    let mut element = xml.create_element("Unknown").with_attribute(("index", number(&index).as_str()));
    if let Some(known) = known {
        let list = known.iter().map(number).collect::<Vec<_>>().join(" ");
        element = element.with_attribute(("dependencies", list.as_str()));
    }
    element.write_empty()?;
    Ok(())
}

/// Places of the inputs that an output at the end of a step can depend on. The turn of a race about its own axis follows from
/// its prescribed speed and, where its axis is moved from outside, from how that tilts.
fn inputs_of_step(rows: &[Variable], output: &Variable) -> Vec<usize> {
    let turned = match output.source {
        Source::Race(race, ..) if output.name.ends_with(".turned") => Some(race),
        _ => None,
    };
    let reaches = |input: &Variable| match (turned, &input.source) {
        (None, _) => true,
        (Some(race), Source::Race(of, ..)) if *of == race => {
            matches!(input.input_kind(), Some(InputKind::Angle | InputKind::AngularVelocity))
        }
        (Some(_), _) => false,
    };
    let inputs = rows.iter().enumerate().filter(|(_, row)| row.causality == Causality::Input);
    inputs.filter(|(_, input)| reaches(input)).map(|(index, _)| index).collect()
}

/// Is an output 0 at the start, whatever the inputs are?
fn is_counted_from_start(row: &Variable) -> bool {
    // Also of a bearing or a shaft, whose name comes first.
    ["energy.work", "energy.dissipated", "energy.to_bearings", "inner.turned", "outer.turned"].iter().any(
        |name| {
            let before = row.name.strip_suffix(name);
            before.is_some_and(|before| before.is_empty() || before.ends_with('.'))
        },
    )
}
