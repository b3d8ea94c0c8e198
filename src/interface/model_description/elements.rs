//! Elements that descriptions of all versions have alike.

use super::LOG_CATEGORIES;
use crate::interface::model_description::{About, Xml};
use crate::interface::variables::{Causality, Kind, Offered, Variable};
use crate::schema::numbers::Variability;
use crate::schema::variable_units::Unit;

/// Units, each once.
pub fn unit_definitions(xml: &mut Xml, used: &[Unit]) -> std::io::Result<()> {
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

/// Categories of the log.
pub fn log_categories(xml: &mut Xml) -> std::io::Result<()> {
    xml.create_element("LogCategories").write_inner_content(|xml| {
        for (name, description) in LOG_CATEGORIES {
            let attributes = [("name", name), ("description", description)];
            xml.create_element("Category").with_attributes(attributes).write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

/// Times of an experiment as the scene has it.
pub fn default_experiment(xml: &mut Xml, about: &About<'_>) -> std::io::Result<()> {
    let (stop, step) = (about.stop.to_string(), about.step.to_string());
    let attributes = [("startTime", "0"), ("stopTime", stop.as_str()), ("stepSize", step.as_str())];
    xml.create_element("DefaultExperiment").with_attributes(attributes).write_empty()?;
    Ok(())
}

/// Causality, variability and what is known of the start of a row, in the standard's words. What it takes where nothing is written is left
/// out: continuous, and calculated for outputs.
pub fn nature(row: &Variable) -> impl Iterator<Item = (&'static str, &'static str)> {
    let (causality, variability, initial) = match row.causality {
        Causality::Input => ("input", None, None),
        Causality::Output => ("output", None, None),
        Causality::Local => ("local", Some("discrete"), Some("calculated")),
        Causality::Parameter => ("parameter", Some(variability(row)), Some("exact")),
    };
    let all = [("causality", Some(causality)), ("variability", variability), ("initial", initial)];
    all.into_iter().filter_map(|(name, value)| Some((name, value?)))
}

/// Type, unit, limits, typical size and start value of a row.
pub fn numbers(row: &Variable, start: f64) -> Vec<(&'static str, String)> {
    let mut attributes = vec![];
    if row.kind == Kind::Real {
        attributes
            .extend([("declaredType", row.unit.quantity.to_string()), ("unit", row.unit.name.to_string())]);
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
    attributes
}

fn variability(row: &Variable) -> &'static str {
    match row.offered() {
        Some(Offered { variability: Variability::Tunable, .. }) => "tunable",
        _ => "fixed",
    }
}
