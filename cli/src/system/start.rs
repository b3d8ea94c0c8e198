//! Start values, checked against the packages.

use roulement::schema::units::{
    Angle, AngularAcceleration, AngularVelocity, Density, Dimension, DissipationFactor, Force, Inertia,
    KinematicViscosity, Length, Mass, Moment, Pressure, Quantity, Ratio, RotationalDamping,
    RotationalStiffness, TemperatureRise, Time, TranslationalDamping, TranslationalStiffness, Velocity,
    Viscosity,
};
use toml::Value;

use super::components::Component;
use super::connections::{end, variable};
use super::description::Written;
use super::interface::{Kind, Variable};

/// A start value of a variable of a component.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Name of the variable.
    pub name: String,
    /// Type.
    pub kind: Kind,
    /// Is it an input? Else it is a parameter.
    pub input: bool,
    /// Value as all files write it.
    pub value: String,
}

/// Dimensions that text is converted to.
const DIMENSIONS: [Dimension; 21] = [
    Ratio::DIMENSION,
    Length::DIMENSION,
    Angle::DIMENSION,
    Pressure::DIMENSION,
    Density::DIMENSION,
    Mass::DIMENSION,
    Inertia::DIMENSION,
    Time::DIMENSION,
    Force::DIMENSION,
    Moment::DIMENSION,
    AngularVelocity::DIMENSION,
    AngularAcceleration::DIMENSION,
    Viscosity::DIMENSION,
    TranslationalStiffness::DIMENSION,
    RotationalStiffness::DIMENSION,
    TranslationalDamping::DIMENSION,
    RotationalDamping::DIMENSION,
    Velocity::DIMENSION,
    KinematicViscosity::DIMENSION,
    DissipationFactor::DIMENSION,
    TemperatureRise::DIMENSION,
];

/// Start values of each component, in alphabetical order.
///
/// # Errors
/// Names the variable, the value, and what is allowed.
pub fn resolve(written: &[(String, Written)], components: &[Component]) -> Result<Vec<Vec<Start>>, String> {
    let mut all: Vec<Vec<Start>> = components.iter().map(|_| vec![]).collect();
    for (path, written) in written {
        let refused = |why: String| format!("start.{path}: {why}");
        let (index, name) = end(path, components).map_err(refused)?;
        let target = variable(&components[index], name).map_err(refused)?;
        if !["input", "parameter"].contains(&target.causality.as_str()) {
            let why = format!(
                "it is of causality {}: only inputs and parameters have start values",
                target.causality
            );
            return Err(refused(why));
        }
        let value = match written {
            Written::Value(value) => of_value(value, target).map_err(refused)?,
            Written::Of(other) => of_other(other, index, target, components).map_err(refused)?,
        };
        let input = target.causality == "input";
        all[index].push(Start { name: name.to_string(), kind: target.kind, input, value });
    }
    for starts in &mut all {
        starts.sort_by(|one, other| one.name.cmp(&other.name));
        if let Some(twice) = starts.windows(2).find(|pair| pair[0].name == pair[1].name) {
            return Err(format!("start.{}: it is given twice", twice[0].name));
        }
    }
    Ok(all)
}

/// A value that is written, as the type and the unit of its variable want it.
fn of_value(value: &Value, target: &Variable) -> Result<String, String> {
    match (target.kind, value) {
        (Kind::Real, Value::Float(number)) if number.is_finite() => Ok(format!("{number:?}")),
        (Kind::Real, Value::Integer(number)) => Ok(format!("{:?}", *number as f64)),
        (Kind::Real, Value::String(text)) => {
            let number = match target.unit.as_deref() {
                None => {
                    return Err(format!("{text:?}: the variable has no unit: write a number without quotes"));
                }
                Some(unit) => of_text(text, unit)?,
            };
            Ok(format!("{number:?}"))
        }
        (Kind::Integer, Value::Integer(number)) if i32::try_from(*number).is_ok() => Ok(number.to_string()),
        (Kind::Boolean, Value::Boolean(value)) => Ok(value.to_string()),
        (Kind::String, Value::String(text)) => Ok(text.clone()),
        (kind, value) => {
            let wanted = match kind {
                Kind::Real => "a number, or text with a unit",
                Kind::Integer => "a whole number of 32 bits",
                Kind::Boolean => "true or false",
                Kind::String => "text in quotes",
            };
            Err(format!("{value} is not of type {kind}: write {wanted}"))
        }
    }
}

/// A text with a unit in the unit of a variable, by the names that packages have for it (`N.m`, `kg.m2`).
fn of_text(text: &str, unit: &str) -> Result<f64, String> {
    let as_package = |dimension: &&Dimension| dimension.unit.replace(' ', ".").replace('^', "") == unit;
    match DIMENSIONS.iter().find(as_package) {
        Some(dimension) => dimension.parse(text),
        None => {
            Err(format!("{text:?} cannot be converted to {unit}: write a number in {unit} without quotes"))
        }
    }
}

/// The start value of another variable, seen by the component of the first: with the sign of both mountings, in its unit.
fn of_other(
    other: &str,
    index: usize,
    target: &Variable,
    components: &[Component],
) -> Result<String, String> {
    let (source, name) = end(other, components)?;
    let (component, own) = (&components[source], &components[index]);
    let from = variable(component, name)?;
    let start = from.start.as_ref().ok_or_else(|| format!("{other} has no start value"))?;
    if from.kind != target.kind {
        return Err(format!("{other} is of type {}, not {}", from.kind, target.kind));
    }
    if target.kind != Kind::Real {
        return Ok(start.clone());
    }
    let number: f64 =
        start.parse().map_err(|_| format!("{other} starts with {start:?}, which is no number"))?;
    let (mut factor, mut offset) = (1.0, 0.0);
    if let (Some(ours), Some(theirs)) = (&from.unit, &target.unit)
        && ours != theirs
    {
        let units = component.interface.units.get(ours).zip(own.interface.units.get(theirs));
        (factor, offset) = units
            .and_then(|(unit, wanted)| unit.to(wanted))
            .ok_or_else(|| format!("{other} is in {ours}, which cannot be converted to {theirs}"))?;
    }
    let sign = component.sign(name) * own.sign(&target.name);
    // No zero with a sign.
    Ok(format!("{:?}", sign * (number * factor + offset) + 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_texts_are_converted_to_units_of_packages() {
        for (text, unit, value) in [
            ("50 mm", "m", 0.05),
            ("0.5 kN m", "N.m", 500.0),
            ("6 kg cm^2", "kg.m2", 6e-4),
            ("60 rpm", "rad/s", std::f64::consts::TAU),
            ("2 mm/s", "m/s", 2e-3),
        ] {
            let converted = of_text(text, unit).unwrap();
            assert!((converted - value).abs() <= 1e-15 * value, "{text}: {converted}");
        }
        assert!(of_text("1 N", "m").unwrap_err().contains("a length"));
        assert!(of_text("1 N", "furlong").unwrap_err().contains("write a number in furlong"));
    }

    #[test]
    fn values_are_of_the_type_of_their_variable() {
        let of = |kind, value: &str| {
            let (name, causality) = ("k".to_string(), "parameter".to_string());
            let target = Variable { name, causality, kind, unit: None, start: None };
            of_value(&value.parse::<Value>().unwrap(), &target)
        };
        for (kind, value, written) in [
            (Kind::Real, "2", "2.0"),
            (Kind::Real, "1e-5", "1e-5"),
            (Kind::Integer, "-3", "-3"),
            (Kind::Boolean, "true", "true"),
            (Kind::String, "\"a\"", "a"),
        ] {
            assert_eq!(of(kind, value).as_deref(), Ok(written));
        }
        for (kind, value, part) in [
            (Kind::Real, "true", "a number"),
            (Kind::Real, "\"1 m\"", "has no unit"),
            (Kind::Integer, "1.5", "a whole number"),
            (Kind::Integer, "3000000000", "32 bits"),
            (Kind::Boolean, "1", "true or false"),
            (Kind::String, "1", "text in quotes"),
        ] {
            assert!(of(kind, value).unwrap_err().contains(part), "{value}");
        }
    }
}
