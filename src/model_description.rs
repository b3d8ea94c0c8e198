//! `modelDescription.xml` of a package, rendered from the variable table.

use std::fmt::Write as _;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use sha2::{Digest, Sha256};

use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::variables::units::{self, Unit};
use crate::variables::{Causality, Kind, Variable, Variables};

/// Model identifier: the name of the shared library in a package.
pub const MODEL_IDENTIFIER: &str = "roulement";

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

/// Renders the model description of a started scene.
///
/// # Errors
/// Only those of writing to memory.
pub fn render(simulation: &Simulation) -> std::io::Result<ModelDescription> {
    let scene = simulation.scene();
    let variables = Variables::new(scene);
    // The identifier is a digest of everything else that the document and the scene say.
    let draft = document(simulation, &variables, "")?;
    let mut digest = Sha256::new();
    digest.update(draft.as_bytes());
    digest.update(scene.source.as_bytes());
    let hex = digest.finalize().iter().take(16).fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    });
    let guid =
        format!("{{{}-{}-{}-{}-{}}}", &hex[0..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..32]);
    let xml = document(simulation, &variables, &guid)?;
    Ok(ModelDescription { xml, guid })
}

fn document(simulation: &Simulation, variables: &Variables, guid: &str) -> std::io::Result<String> {
    let scene = simulation.scene();
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let title = if scene.title.is_empty() { "ball bearing" } else { &scene.title };
    xml.create_element("fmiModelDescription")
        .with_attributes([
            ("fmiVersion", "2.0"),
            ("modelName", "roulement"),
            ("guid", guid),
            ("description", title),
            ("version", env!("CARGO_PKG_VERSION")),
            ("generationTool", concat!("roulement ", env!("CARGO_PKG_VERSION"))),
            ("license", env!("CARGO_PKG_LICENSE")),
            ("variableNamingConvention", "structured"),
            ("numberOfEventIndicators", "0"),
        ])
        .write_inner_content(|xml| {
            co_simulation(xml)?;
            unit_definitions(xml)?;
            xml.create_element("LogCategories").write_inner_content(|xml| {
                for (name, description) in LOG_CATEGORIES {
                    let attributes = [("name", name), ("description", description)];
                    xml.create_element("Category").with_attributes(attributes).write_empty()?;
                }
                Ok(())
            })?;
            default_experiment(xml, scene)?;
            let inputs = simulation.inputs();
            let starts = variables.values(inputs, simulation.outputs());
            xml.create_element("ModelVariables").write_inner_content(|xml| {
                for (reference, (row, start)) in variables.rows().iter().zip(starts).enumerate() {
                    scalar_variable(xml, reference, row, start)?;
                }
                Ok(())
            })?;
            model_structure(xml, variables)
        })?;
    let mut text = String::from_utf8(xml.into_inner()).map_err(std::io::Error::other)?;
    text.push('\n');
    Ok(text)
}

fn co_simulation(xml: &mut Xml) -> std::io::Result<()> {
    xml.create_element("CoSimulation")
        .with_attributes([
            ("modelIdentifier", MODEL_IDENTIFIER),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("canInterpolateInputs", "true"),
            ("maxOutputDerivativeOrder", "1"),
            ("canGetAndSetFMUstate", "true"),
            ("canSerializeFMUstate", "true"),
            ("providesDirectionalDerivative", "true"),
        ])
        .write_empty()?;
    Ok(())
}

fn unit_definitions(xml: &mut Xml) -> std::io::Result<()> {
    xml.create_element("UnitDefinitions").write_inner_content(|xml| {
        for unit in units::ALL {
            unit_definition(xml, &unit)?;
        }
        Ok(())
    })?;
    Ok(())
}

fn unit_definition(xml: &mut Xml, unit: &Unit) -> std::io::Result<()> {
    xml.create_element("Unit").with_attribute(("name", unit.name)).write_inner_content(|xml| {
        let mut base = xml.create_element("BaseUnit");
        for (name, exponent) in ["kg", "m", "s", "rad"].into_iter().zip(unit.exponents) {
            if exponent != 0 {
                base = base.with_attribute((name, exponent.to_string().as_str()));
            }
        }
        base.write_empty()?;
        if let Some((name, factor)) = unit.display {
            let factor = factor.to_string();
            let attributes = [("name", name), ("factor", factor.as_str())];
            xml.create_element("DisplayUnit").with_attributes(attributes).write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

fn default_experiment(xml: &mut Xml, scene: &Scene) -> std::io::Result<()> {
    let (stop, step) = (scene.load.duration.0.to_string(), scene.load.output_interval.0.to_string());
    let attributes = [("startTime", "0"), ("stopTime", stop.as_str()), ("stepSize", step.as_str())];
    xml.create_element("DefaultExperiment").with_attributes(attributes).write_empty()?;
    Ok(())
}

fn scalar_variable(xml: &mut Xml, reference: usize, row: &Variable, start: f64) -> std::io::Result<()> {
    let reference = reference.to_string();
    let (causality, variability) = match (row.causality, row.kind) {
        (Causality::Input, _) => ("input", "continuous"),
        (Causality::Output, Kind::Real) => ("output", "continuous"),
        (Causality::Output, Kind::Integer) => ("output", "discrete"),
    };
    let mut element = xml.create_element("ScalarVariable").with_attributes([
        ("name", row.name.as_str()),
        ("valueReference", reference.as_str()),
        ("description", row.description.as_str()),
        ("causality", causality),
        ("variability", variability),
    ]);
    if row.causality == Causality::Output {
        element = element.with_attribute(("initial", "calculated"));
    }
    element.write_inner_content(|xml| {
        match row.kind {
            Kind::Integer => xml.create_element("Integer").write_empty()?,
            Kind::Real => {
                let (nominal, start) = (row.nominal.to_string(), format!("{start:?}"));
                let mut real = xml
                    .create_element("Real")
                    .with_attributes([("unit", row.unit.name), ("nominal", nominal.as_str())]);
                if let Some((display, _)) = row.unit.display {
                    real = real.with_attribute(("displayUnit", display));
                }
                if row.causality == Causality::Input {
                    real = real.with_attribute(("start", start.as_str()));
                }
                real.write_empty()?
            }
        };
        Ok(())
    })?;
    Ok(())
}

fn model_structure(xml: &mut Xml, variables: &Variables) -> std::io::Result<()> {
    // Indices count from 1. Every output depends on every input: the bearing is one mechanism.
    let outputs = || {
        variables
            .rows()
            .iter()
            .enumerate()
            .filter(|(_, row)| row.causality == Causality::Output)
            .map(|(index, _)| (index + 1).to_string())
    };
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        for list in ["Outputs", "InitialUnknowns"] {
            xml.create_element(list).write_inner_content(|xml| {
                for index in outputs() {
                    xml.create_element("Unknown").with_attribute(("index", index.as_str())).write_empty()?;
                }
                Ok(())
            })?;
        }
        Ok(())
    })?;
    Ok(())
}
