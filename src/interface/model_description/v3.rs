//! A description as FMI 3.0 has it.

use super::elements::{default_experiment, log_categories, nature, numbers, unit_definitions};
use super::structure::Output;
use super::{About, Exported, Xml, identifier, used_units};
use crate::interface::references::{RateRow, References, rate_row, updates_are_offered};
use crate::interface::variables::{Causality, Kind, Variable};
use crate::schema::variable_units::{self as units, Unit};

/// Writes the document.
pub fn write(xml: &mut Xml, about: &About<'_>, exported: &Exported) -> std::io::Result<()> {
    let references = &exported.version3;
    let rates: Vec<_> = references.rates().map(|(reference, row)| (reference, exported.rate(row))).collect();
    let mut units = used_units(&exported.rows);
    let more = [units::SECOND].into_iter().chain(rates.iter().map(|(_, rate)| rate.unit));
    more.for_each(|unit| {
        if !units.contains(&unit) {
            units.push(unit);
        }
    });
    let updated = exported.takes_updates();
    xml.create_element("fmiModelDescription")
        .with_attributes([
            ("fmiVersion", "3.0"),
            ("modelName", about.name),
            ("instantiationToken", about.guid),
            ("description", about.title),
            ("version", env!("CARGO_PKG_VERSION")),
            ("license", env!("CARGO_PKG_LICENSE")),
            ("generationTool", concat!("roulement ", env!("CARGO_PKG_VERSION"))),
            ("variableNamingConvention", "structured"),
        ])
        .write_inner_content(|xml| {
            co_simulation(xml, about, updated)?;
            unit_definitions(xml, &units)?;
            type_definitions(xml, &units)?;
            log_categories(xml)?;
            default_experiment(xml, about)?;
            xml.create_element("ModelVariables").write_inner_content(|xml| {
                for (reference, row, start) in exported.all() {
                    variable(xml, reference, row, start, updated)?;
                }
                time(xml, references)?;
                rates.iter().try_for_each(|(reference, rate)| rate_of_input(xml, *reference, rate, updated))
            })?;
            model_structure(xml, exported, &exported.outputs(about.dependencies))
        })?;
    Ok(())
}

fn co_simulation(xml: &mut Xml, about: &About<'_>, updated: bool) -> std::io::Result<()> {
    let identifier = identifier(about.name);
    let word = |yes: bool| if yes { "true" } else { "false" };
    let (derivatives, updates) = (word(about.derivatives), word(updated));
    xml.create_element("CoSimulation")
        .with_attributes([
            ("modelIdentifier", identifier.as_str()),
            ("canGetAndSetFMUState", "true"),
            ("canSerializeFMUState", "true"),
            ("providesDirectionalDerivatives", derivatives),
            ("providesAdjointDerivatives", derivatives),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("maxOutputDerivativeOrder", "1"),
            ("providesIntermediateUpdate", updates),
            ("canReturnEarlyAfterIntermediateUpdate", updates),
        ])
        .write_empty()?;
    Ok(())
}

fn type_definitions(xml: &mut Xml, used: &[Unit]) -> std::io::Result<()> {
    xml.create_element("TypeDefinitions").write_inner_content(|xml| {
        for unit in used {
            let quantity = unit.quantity;
            let attributes = [("name", quantity), ("quantity", quantity), ("unit", unit.name)];
            let display = unit.display.map(|(display, _)| ("displayUnit", display));
            let attributes = attributes.into_iter().chain(display);
            xml.create_element("Float64Type").with_attributes(attributes).write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

fn variable(
    xml: &mut Xml,
    reference: usize,
    row: &Variable,
    start: f64,
    updated: bool,
) -> std::io::Result<()> {
    let reference = reference.to_string();
    let numbers = numbers(row, start);
    let kind = if row.kind == Kind::Real { "Float64" } else { "Int64" };
    let element = xml.create_element(kind).with_attributes([
        ("name", row.name.as_str()),
        ("valueReference", reference.as_str()),
        ("description", row.description.as_str()),
    ]);
    let within_steps = updated && matches!(row.causality, Causality::Input | Causality::Output);
    let element = element.with_attributes(within_steps.then_some(("intermediateUpdate", "true")));
    let numbers = numbers.iter().map(|(name, value)| (*name, value.as_str()));
    element.with_attributes(nature(row)).with_attributes(numbers).write_empty()?;
    Ok(())
}

fn time(xml: &mut Xml, references: &References) -> std::io::Result<()> {
    let reference = references.time().to_string();
    xml.create_element("Float64")
        .with_attributes([
            ("name", "time"),
            ("valueReference", reference.as_str()),
            ("description", "time"),
            ("causality", "independent"),
            ("variability", "continuous"),
            ("declaredType", units::SECOND.quantity),
            ("unit", units::SECOND.name),
        ])
        .write_empty()?;
    Ok(())
}

/// An optional input: it starts at 0, and a master that knows no accelerations leaves it there.
fn rate_of_input(xml: &mut Xml, reference: usize, rate: &RateRow, updated: bool) -> std::io::Result<()> {
    let reference = reference.to_string();
    xml.create_element("Float64")
        .with_attributes([
            ("name", rate.name.as_str()),
            ("valueReference", reference.as_str()),
            ("description", rate.description.as_str()),
            ("causality", "input"),
            ("declaredType", rate.unit.quantity),
            ("unit", rate.unit.name),
            ("start", "0.0"),
        ])
        .with_attributes(updated.then_some(("intermediateUpdate", "true")))
        .write_empty()?;
    Ok(())
}

fn model_structure(xml: &mut Xml, exported: &Exported, outputs: &[Output]) -> std::io::Result<()> {
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        for Output { index, inputs, .. } in outputs {
            let known: Vec<usize> = inputs.iter().flat_map(|input| exported.with_rate(*input)).collect();
            unknown(xml, "Output", exported.references[*index], Some(&known))?;
        }
        for Output { index, counted_from_start, .. } in outputs {
            let known = counted_from_start.then_some(&[][..]);
            unknown(xml, "InitialUnknown", exported.references[*index], known)?;
        }
        Ok(())
    })?;
    Ok(())
}

/// One unknown with what it depends on, where that is not everything; both by their references.
fn unknown(xml: &mut Xml, element: &str, reference: usize, known: Option<&[usize]>) -> std::io::Result<()> {
    let reference = reference.to_string();
    let mut element = xml.create_element(element).with_attribute(("valueReference", reference.as_str()));
    if let Some(known) = known {
        let list = known.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
        element = element.with_attribute(("dependencies", list.as_str()));
    }
    element.write_empty()?;
    Ok(())
}

impl Exported {
    /// Can inputs be set within steps?
    fn takes_updates(&self) -> bool {
        updates_are_offered(&self.rows)
    }

    /// The rate of an input, as a variable; by the row of that among all.
    fn rate(&self, row: usize) -> RateRow {
        // Inputs are always told of.
        let place = self.references.binary_search(&row).unwrap_or(0);
        rate_row(&self.rows[place])
    }

    /// References of an input, by its place among the variables, and of its rate where it has one.
    fn with_rate(&self, input: usize) -> impl Iterator<Item = usize> {
        let reference = self.references[input];
        let rate = self.version3.rates().find(|(_, row)| *row == reference).map(|(rate, _)| rate);
        [reference].into_iter().chain(rate)
    }
}
