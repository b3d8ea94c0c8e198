//! A description as FMI 2.0 has it.

use super::elements::{default_experiment, log_categories, nature, numbers, unit_definitions};
use super::structure::Output;
use super::{About, Exported, Xml, identifier, used_units};
use crate::interface::variables::{Kind, Variable};
use crate::schema::variable_units::Unit;

/// Writes the document.
pub fn write(xml: &mut Xml, about: &About<'_>, exported: &Exported) -> std::io::Result<()> {
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
        .with_attributes(about.edition.attributes())
        .write_inner_content(|xml| {
            co_simulation(xml, about)?;
            let units = used_units(&exported.rows);
            unit_definitions(xml, &units)?;
            type_definitions(xml, &units)?;
            log_categories(xml)?;
            default_experiment(xml, about)?;
            xml.create_element("ModelVariables").write_inner_content(|xml| {
                for (reference, row, start) in exported.all() {
                    scalar_variable(xml, reference, row, start)?;
                }
                Ok(())
            })?;
            model_structure(xml, &exported.outputs(about.dependencies))
        })?;
    Ok(())
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

fn scalar_variable(xml: &mut Xml, reference: usize, row: &Variable, start: f64) -> std::io::Result<()> {
    let reference = reference.to_string();
    let element = xml.create_element("ScalarVariable").with_attributes([
        ("name", row.name.as_str()),
        ("valueReference", reference.as_str()),
        ("description", row.description.as_str()),
    ]);
    element.with_attributes(nature(row)).write_inner_content(|xml| {
        let kind = if row.kind == Kind::Real { "Real" } else { "Integer" };
        let numbers = numbers(row, start);
        let attributes = numbers.iter().map(|(name, value)| (*name, value.as_str()));
        xml.create_element(kind).with_attributes(attributes).write_empty()?;
        Ok(())
    })?;
    Ok(())
}

fn model_structure(xml: &mut Xml, outputs: &[Output]) -> std::io::Result<()> {
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        xml.create_element("Outputs").write_inner_content(|xml| {
            for output in outputs {
                // Written out, although no list would mean all: importers for which the lists are sparsity (PyFMI, OMSimulator)
                // take an output without a list as one without dependencies.
                unknown(xml, output.index, Some(&output.inputs))?;
            }
            Ok(())
        })?;
        xml.create_element("InitialUnknowns").write_inner_content(|xml| {
            for output in outputs {
                unknown(xml, output.index, output.counted_from_start.then_some(&[]))?;
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
