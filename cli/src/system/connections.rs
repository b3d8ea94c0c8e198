//! Connections of single variables, checked against the packages.

use super::components::Component;
use super::interface::{Kind, Variable};
use super::nearest::meant;

/// An end of a connection: index of the component, name of the variable.
pub type End = (usize, String);

/// A connection of two variables: the input is the output times `factor` plus `offset`.
#[derive(Clone, Debug, PartialEq)]
pub struct Connection {
    /// Output.
    pub from: End,
    /// Input.
    pub to: End,
    /// Type of both.
    pub kind: Kind,
    /// Signs of mountings times that of the units.
    pub factor: f64,
    /// Difference of the zeros of both units, in that of the input.
    pub offset: f64,
}

impl Connection {
    /// Does the value change on its way?
    pub fn changes(&self) -> bool {
        self.factor != 1.0 || self.offset != 0.0
    }
}

/// A component by a name with it in front, and the rest of the name.
///
/// # Errors
/// If there is no such end; with the nearest name.
pub fn end<'a>(text: &'a str, components: &[Component]) -> Result<(usize, &'a str), String> {
    let Some((name, variable)) = text.split_once('.') else {
        return Err(format!("{text:?} has to be a component and a variable with a dot between them"));
    };
    let index = components.iter().position(|component| component.name == name).ok_or_else(|| {
        let names = components.iter().map(|component| component.name.as_str());
        format!("{name} is no component{}", meant(name, names))
    })?;
    Ok((index, variable))
}

/// A variable of a component.
///
/// # Errors
/// That there is none, and the nearest name.
pub fn variable<'a>(component: &'a Component, name: &str) -> Result<&'a Variable, String> {
    component.interface.find(name).ok_or_else(|| {
        let names = component.interface.variables.iter().map(|variable| variable.name.as_str());
        format!("{} has no variable {name}{}", component.name, meant(name, names))
    })
}

/// Expands connections as they are written, and checks each of its variables; with what the reader should know.
///
/// # Errors
/// Names the connection, and what is wrong.
pub fn expand(
    written: &[String],
    components: &[Component],
) -> Result<(Vec<Connection>, Vec<String>), String> {
    let mut all: Vec<(Connection, &str)> = vec![];
    let (mut notes, mut without_unit) = (vec![], vec![]);
    for text in written {
        let refused = |why: String| format!("connection \"{text}\": {why}");
        for (from, to) in pairs(text, components).map_err(refused)? {
            let connection = connect(from, to, components).map_err(refused)?;
            if let Some((_, before)) = all.iter().find(|(before, _)| before.to == connection.to) {
                let name = named(&connection.to, components);
                return Err(refused(format!("{name} is connected by \"{before}\", too")));
            }
            match said(&connection, components) {
                Said::Nothing => {}
                Said::NoUnit(name) => without_unit.push(name),
                Said::Converted(note) => notes.push(note),
            }
            all.push((connection, text));
        }
    }
    if let Some(first) = without_unit.first() {
        notes.push(format!(
            "units of {} connections are not checked: one end has none, such as {first}",
            without_unit.len()
        ));
    }
    Ok((all.into_iter().map(|(connection, _)| connection).collect(), notes))
}

fn named((component, variable): &End, components: &[Component]) -> String {
    format!("{}.{variable}", components[*component].name)
}

/// Pairs of output and input that a written connection means: of two variables, or every input below a name with the output of the
/// same ending.
fn pairs(text: &str, components: &[Component]) -> Result<Vec<(End, End)>, String> {
    let ends: Vec<&str> = text.split("->").map(str::trim).collect();
    let [from, to] = ends[..] else {
        return Err("write it as \"component.output -> component.input\"".to_string());
    };
    let ((source, output), (target, input)) = (end(from, components)?, end(to, components)?);
    if components[target].interface.find(input).is_some()
        || components[source].interface.find(output).is_some()
    {
        return Ok(vec![((source, output.to_string()), (target, input.to_string()))]);
    }
    let below = format!("{input}.");
    let variables = &components[target].interface.variables;
    let endings: Vec<&Variable> =
        variables.iter().filter(|variable| variable.name.starts_with(&below)).collect();
    let inputs: Vec<&Variable> =
        endings.iter().copied().filter(|variable| variable.causality == "input").collect();
    match (endings.first(), inputs.is_empty()) {
        (None, _) => {
            // Names that end at a dot mean something here, too.
            let names = variables.iter().flat_map(|variable| {
                let dots = variable.name.match_indices('.').map(|(at, _)| &variable.name[..at]);
                dots.chain([variable.name.as_str()])
            });
            Err(format!("{} has no variable {input}{}", components[target].name, meant(input, names)))
        }
        (Some(first), true) => Err(format!(
            "no {to}.* is an input: {}.{} is of causality {}",
            components[target].name, first.name, first.causality
        )),
        _ => Ok(inputs
            .into_iter()
            .map(|input| {
                let ending = &input.name[below.len()..];
                ((source, format!("{output}.{ending}")), (target, input.name.clone()))
            })
            .collect()),
    }
}

/// A connection of two variables that fit.
fn connect(from: End, to: End, components: &[Component]) -> Result<Connection, String> {
    let (source, target) = (&components[from.0], &components[to.0]);
    let (output, input) = (variable(source, &from.1)?, variable(target, &to.1)?);
    let (from_name, to_name) = (named(&from, components), named(&to, components));
    for (name, variable, wanted) in [(&from_name, output, "output"), (&to_name, input, "input")] {
        if variable.causality != wanted {
            return Err(format!("{name} is of causality {}: it has to be an {wanted}", variable.causality));
        }
    }
    if output.kind != input.kind {
        return Err(format!("{from_name} is of type {}, {to_name} of type {}", output.kind, input.kind));
    }
    let sign = source.sign(&from.1) * target.sign(&to.1);
    let (mut factor, mut offset) = (1.0, 0.0);
    if let (Some(ours), Some(theirs)) = (&output.unit, &input.unit) {
        let units = source.interface.units.get(ours).zip(target.interface.units.get(theirs));
        (factor, offset) = match units {
            Some((unit, other)) => unit.to(other),
            None => (ours == theirs).then_some((1.0, 0.0)),
        }
        .ok_or_else(|| {
            format!("{from_name} is in {ours}, {to_name} in {theirs}: they cannot be converted")
        })?;
    }
    Ok(Connection { from, to, kind: input.kind, factor: sign * factor, offset: sign * offset + 0.0 })
}

/// Notes on a connection for its reader.
enum Said {
    Nothing,
    /// The end that has no unit, where the other one has.
    NoUnit(String),
    Converted(String),
}

fn said(connection: &Connection, components: &[Component]) -> Said {
    let unit =
        |end: &End| components[end.0].interface.find(&end.1).and_then(|variable| variable.unit.clone());
    let (from, to) = (named(&connection.from, components), named(&connection.to, components));
    match (unit(&connection.from), unit(&connection.to)) {
        (None, Some(_)) => Said::NoUnit(from),
        (Some(_), None) => Said::NoUnit(to),
        (Some(ours), Some(theirs)) if connection.factor.abs() != 1.0 || connection.offset != 0.0 => {
            let Connection { factor, offset, .. } = connection;
            Said::Converted(format!("{to} [{theirs}] is {factor:?} times {from} [{ours}] plus {offset:?}"))
        }
        _ => Said::Nothing,
    }
}
