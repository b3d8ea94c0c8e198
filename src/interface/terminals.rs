//! Terminals of a package: variables that belong to one place, which a master connects together. One terminal for each race, as a flange with
//! six degrees of freedom, and for each load, point, seat, gear and drive of a shaft or a housing.

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::model_description::{Version, Wanted, is_exported};
use super::references::{References, rate_row};
use super::variables::{Causality, ShaftSource, Source, Variable};

/// A member of a terminal.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Name of the variable.
    pub variable: String,
    /// Name in the terminal.
    pub name: String,
    /// Kind in the standard's words: forces flow out of a bearing into what is connected to its race, and into a shaft.
    pub kind: &'static str,
}

/// A terminal.
#[derive(Clone, Debug, PartialEq)]
pub struct Terminal {
    /// Name: the beginning of the names of its variables.
    pub name: String,
    /// Its variables.
    pub members: Vec<Member>,
}

/// Quantities that are members: the parts of names that stand before their components.
const MOTIONS: [&str; 18] = [
    "position",
    "rotation",
    "orientation",
    "angle",
    "velocity",
    "rotation_rate",
    "angular_velocity",
    "acceleration",
    "rotation_acceleration",
    "angular_acceleration",
    "speed",
    "speed_rate",
    "turned",
    "displacement",
    "tilt",
    "tilt_rate",
    "tilt_acceleration",
    "drive_torque",
];
const EFFORTS: [&str; 5] = ["force", "moment", "torque", "applied_force", "applied_moment"];

/// Terminal, member and kind of a variable with this name; none if it belongs to no place.
fn member(name: &str, of_race: bool) -> Option<(&str, Member)> {
    let axis = ["w", "x", "y", "z"].into_iter().find(|axis| name.ends_with(&format!(".{axis}")));
    let stem = axis.map_or(name, |_| &name[..name.len() - 2]);
    let (terminal, quantity) = stem.rsplit_once('.')?;
    let kind = match quantity {
        "force" | "moment" if of_race => "outflow",
        _ if EFFORTS.contains(&quantity) => "inflow",
        _ if MOTIONS.contains(&quantity) => "signal",
        _ => return None,
    };
    let short = name[terminal.len() + 1..].to_string();
    Some((terminal, Member { variable: name.into(), name: short, kind }))
}

/// The terminals among rows in a package of a version, with some of the outputs. Arrays and accelerations are variables in packages of FMI 3.0
/// alone; variables are arrays, where these are asked for, if they are all there.
pub fn terminals(rows: &[Variable], version: Version, arrays: bool, wanted: Wanted<'_>) -> Vec<Terminal> {
    let third = version == Version::V3;
    let references = References::of(rows, third && arrays);
    let whole = references.whole_arrays(|one| rows.get(one).is_none_or(|row| is_exported(row, wanted)));
    let mut all: Vec<Terminal> = vec![];
    let mut add = |reference: usize, name: &str, of_race: bool| {
        let array = whole[reference].map(|(_, array)| array);
        // An array stands where its first element would.
        if array.is_some_and(|array| array.elements.first() != Some(&(reference as u32))) {
            return;
        }
        let name = array.map_or(name, |array| &array.name);
        let Some((terminal, member)) = member(name, of_race) else { return };
        match all.iter_mut().find(|one| one.name == terminal) {
            Some(one) => one.members.push(member),
            None => all.push(Terminal { name: terminal.into(), members: vec![member] }),
        }
    };
    for (reference, row) in rows.iter().enumerate() {
        if row.causality == Causality::Parameter || !is_exported(row, wanted) {
            continue;
        }
        match row.source {
            Source::Race(..) => add(reference, &row.name, true),
            Source::Shaft(ShaftSource::Frame(..)) => {}
            Source::Shaft(_) => add(reference, &row.name, false),
            _ => {}
        }
    }
    for (reference, row) in references.rates().filter(|_| third) {
        add(reference, &rate_row(&rows[row]).name, matches!(rows[row].source, Source::Race(..)));
    }
    all
}

/// `terminalsAndIcons.xml` of a package. FMI 2.0.4 takes the file from 3.0 as it is: its version is that of its schema. Members are matched by
/// their names, as many as both sides have: which there are depends on how a race is driven.
///
/// # Errors
/// Only those of writing to memory.
pub fn render(terminals: &[Terminal]) -> std::io::Result<String> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let root = xml.create_element("fmiTerminalsAndIcons").with_attribute(("fmiVersion", "3.0"));
    root.write_inner_content(|xml| {
        xml.create_element("Terminals").write_inner_content(|xml| {
            for Terminal { name, members } in terminals {
                let attributes = [("name", name.as_str()), ("matchingRule", "bus")];
                xml.create_element("Terminal").with_attributes(attributes).write_inner_content(|xml| {
                    for Member { variable, name, kind } in members {
                        let attributes = [
                            ("variableName", variable.as_str()),
                            ("memberName", name),
                            ("variableKind", kind),
                        ];
                        xml.create_element("TerminalMemberVariable")
                            .with_attributes(attributes)
                            .write_empty()?;
                    }
                    Ok(())
                })?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    let mut text = String::from_utf8(xml.into_inner()).map_err(std::io::Error::other)?;
    text.push('\n');
    Ok(text)
}
