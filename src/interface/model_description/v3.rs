//! A description as FMI 3.0 has it.

use super::elements::{default_experiment, log_categories, nature, numbers, unit_definitions};
use super::structure::Output;
use super::{About, Exported, Xml, identifier, used_units};
use crate::interface::arrays::Array;
use crate::interface::references::{RateRow, rate_row, updates_are_offered};
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
    // By their references, of those that are told of.
    let mut scalars: Vec<Option<Scalar>> = (0..references.count()).map(|_| None).collect();
    for (reference, row, start) in exported.all() {
        scalars[reference] = Some(Scalar::of(row, start, updated));
    }
    scalars[references.time()] = Some(Scalar::time());
    for (reference, rate) in &rates {
        scalars[*reference] = Some(Scalar::of_rate(rate, updated));
    }
    let arrays = references.whole_arrays(|reference| scalars[reference].is_some());
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
        .with_attributes(about.edition.attributes())
        .write_inner_content(|xml| {
            co_simulation(xml, about, updated)?;
            unit_definitions(xml, &units)?;
            type_definitions(xml, &units)?;
            log_categories(xml)?;
            default_experiment(xml, about)?;
            xml.create_element("ModelVariables").write_inner_content(|xml| {
                for (reference, scalar) in scalars.iter().enumerate() {
                    let Some(scalar) = scalar else { continue };
                    match arrays[reference] {
                        None => scalar.write(xml, reference, &[])?,
                        // Where its first element would be.
                        Some((own, array)) if array.elements.first() == Some(&(reference as u32)) => {
                            scalar.array(array, &scalars).write(xml, own, &array.dimensions)?;
                        }
                        Some(_) => {}
                    }
                }
                Ok(())
            })?;
            model_structure(xml, exported, &exported.outputs(about.dependencies), &arrays)
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

/// A variable as it is written: of the table, time, or the rate of an input.
struct Scalar {
    /// `Float64` or `Int64`.
    kind: &'static str,
    name: String,
    description: String,
    /// All others.
    attributes: Vec<(&'static str, String)>,
}

impl Scalar {
    fn of(row: &Variable, start: f64, updated: bool) -> Self {
        let within_steps = updated && matches!(row.causality, Causality::Input | Causality::Output);
        let mut attributes = vec![];
        attributes.extend(within_steps.then(|| ("intermediateUpdate", "true".to_string())));
        attributes.extend(nature(row).map(|(name, value)| (name, value.to_string())));
        attributes.extend(numbers(row, start));
        Self {
            kind: if row.kind == Kind::Real { "Float64" } else { "Int64" },
            name: row.name.clone(),
            description: row.description.clone(),
            attributes,
        }
    }

    fn time() -> Self {
        let attributes = [
            ("causality", "independent"),
            ("variability", "continuous"),
            ("declaredType", units::SECOND.quantity),
            ("unit", units::SECOND.name),
        ];
        Self::real("time".into(), "time".into(), &attributes)
    }

    /// An optional input: it starts at 0, and a master that knows no accelerations leaves it there.
    fn of_rate(rate: &RateRow, updated: bool) -> Self {
        let update = updated.then_some(("intermediateUpdate", "true"));
        let attributes = [
            ("causality", "input"),
            ("declaredType", rate.unit.quantity),
            ("unit", rate.unit.name),
            ("start", "0.0"),
        ];
        let attributes: Vec<_> = update.into_iter().chain(attributes).collect();
        Self::real(rate.name.clone(), rate.description.clone(), &attributes)
    }

    fn real(name: String, description: String, attributes: &[(&'static str, &str)]) -> Self {
        let attributes = attributes.iter().map(|(name, value)| (*name, (*value).to_string())).collect();
        Self { kind: "Float64", name, description, attributes }
    }

    fn attribute(&self, name: &str) -> &str {
        self.attributes.iter().find(|(own, _)| *own == name).map_or("", |(_, value)| value)
    }

    /// The array of this one and others, which differ in what they start at and in their typical size.
    fn array(&self, array: &Array, all: &[Option<Self>]) -> Self {
        let elements = || array.elements.iter().filter_map(|reference| all[*reference as usize].as_ref());
        let attributes = self.attributes.iter().map(|(name, value)| match *name {
            "start" => (*name, elements().map(|one| one.attribute(name)).collect::<Vec<_>>().join(" ")),
            "nominal" => {
                let sizes = elements().filter_map(|one| one.attribute(name).parse::<f64>().ok());
                (*name, sizes.fold(0.0, f64::max).to_string())
            }
            _ => (*name, value.clone()),
        });
        Self {
            kind: self.kind,
            name: array.name.clone(),
            description: array.description.clone(),
            attributes: attributes.collect(),
        }
    }

    fn write(&self, xml: &mut Xml, reference: usize, dimensions: &[usize]) -> std::io::Result<()> {
        let reference = reference.to_string();
        let attributes = self.attributes.iter().map(|(name, value)| (*name, value.as_str()));
        let element = xml
            .create_element(self.kind)
            .with_attributes([
                ("name", self.name.as_str()),
                ("valueReference", reference.as_str()),
                ("description", self.description.as_str()),
            ])
            .with_attributes(attributes);
        if dimensions.is_empty() {
            element.write_empty()?;
            return Ok(());
        }
        element.write_inner_content(|xml| {
            for length in dimensions {
                let length = length.to_string();
                xml.create_element("Dimension").with_attribute(("start", length.as_str())).write_empty()?;
            }
            Ok(())
        })?;
        Ok(())
    }
}

/// The structure; `arrays` as [`crate::interface::references::References::whole_arrays`] has them.
fn model_structure(
    xml: &mut Xml,
    exported: &Exported,
    outputs: &[Output],
    arrays: &[Option<(usize, &Array)>],
) -> std::io::Result<()> {
    let told = |reference: usize| arrays[reference].map_or(reference, |(own, _)| own);
    // An array depends on what one of its elements depends on; the order is that of the variables.
    let mut unknowns: Vec<(usize, Vec<usize>, bool)> = vec![];
    let mut places: Vec<Option<usize>> = vec![None; arrays.len()];
    for Output { index, inputs, counted_from_start } in outputs {
        let reference = told(exported.references[*index]);
        let place = *places[reference].get_or_insert(unknowns.len());
        if place == unknowns.len() {
            unknowns.push((reference, vec![], true));
        }
        let (_, known, counted) = &mut unknowns[place];
        *counted &= counted_from_start;
        for input in inputs.iter().flat_map(|input| exported.with_rate(*input)).map(told) {
            if !known.contains(&input) {
                known.push(input);
            }
        }
    }
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        for (reference, known, _) in &unknowns {
            unknown(xml, "Output", *reference, Some(known))?;
        }
        for (reference, _, counted_from_start) in &unknowns {
            unknown(xml, "InitialUnknown", *reference, counted_from_start.then_some(&[][..]))?;
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
