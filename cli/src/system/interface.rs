//! Variables and units of a package, read from its model description.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{Cursor, Read};

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use zip::ZipArchive;

/// Type of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Number.
    Real,
    /// Whole number.
    Integer,
    /// True or false.
    Boolean,
    /// Text.
    String,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Real, Self::Integer, Self::Boolean, Self::String];
}

/// Its name in FMI, SSP and OSP.
impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, formatter)
    }
}

/// A variable of a package.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Name.
    pub name: String,
    /// `input`, `output`, `parameter` or another word of FMI 2.0.
    pub causality: String,
    /// Type.
    pub kind: Kind,
    /// Unit of a number, if the package says it.
    pub unit: Option<String>,
    /// Start value as it is written.
    pub start: Option<String>,
}

/// A unit in SI base units.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Exponents of kg, m, s, A, K, mol, cd, rad.
    exponents: [i32; 8],
    /// [SI] one of this unit.
    factor: f64,
    /// [SI] zero of this unit.
    offset: f64,
}

/// Base units by the names that FMI has for them.
const BASE: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

impl Unit {
    /// Factor and offset that make a value in this unit one in another; none if they measure different things.
    pub fn to(&self, other: &Self) -> Option<(f64, f64)> {
        let scale = (self.factor / other.factor, (self.offset - other.offset) / other.factor);
        (self.exponents == other.exponents).then_some(scale)
    }
}

/// Variables and units of a package.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Interface {
    /// Variables in their order.
    pub variables: Vec<Variable>,
    /// Units by name, as far as their dimension is given.
    pub units: BTreeMap<String, Unit>,
}

impl Interface {
    /// Reads the model description of a package.
    ///
    /// # Errors
    /// If it is no package that can be read; the reason is given.
    pub fn of_package(package: &[u8]) -> Result<Self, String> {
        let mut zip = ZipArchive::new(Cursor::new(package)).map_err(|why| format!("it is no FMU: {why}"))?;
        let mut text = String::new();
        zip.by_name("modelDescription.xml")
            .map_err(|why| format!("it is no FMU: modelDescription.xml: {why}"))?
            .read_to_string(&mut text)
            .map_err(|why| format!("modelDescription.xml cannot be read: {why}"))?;
        Self::read(&text)
    }

    /// Reads a model description.
    fn read(text: &str) -> Result<Self, String> {
        let mut reader = Reader::from_str(text);
        let mut found = Self::default();
        // Units of types, by their names.
        let mut types: BTreeMap<String, String> = BTreeMap::new();
        // Name of the unit or type, and name and causality of the variable, that is being read.
        let (mut unit, mut simple, mut variable) = (None, None, None);
        let (mut version, mut steps) = (None, false);
        loop {
            let event =
                reader.read_event().map_err(|why| format!("modelDescription.xml is no XML: {why}"))?;
            let (element, ends) = match &event {
                Event::Start(element) => (element, false),
                Event::Empty(element) => (element, true),
                Event::End(end) => {
                    match end.name().as_ref() {
                        "Unit" => unit = None,
                        "SimpleType" => simple = None,
                        "ScalarVariable" => variable = None,
                        _ => {}
                    }
                    continue;
                }
                Event::Eof => break,
                _ => continue,
            };
            let name = element.name();
            let name = name.as_ref();
            match name {
                "fmiModelDescription" => version = attribute(element, "fmiVersion")?,
                "CoSimulation" => steps = true,
                "Unit" if !ends => unit = attribute(element, "name")?,
                "BaseUnit" => {
                    if let Some(unit) = unit.take() {
                        found.units.insert(unit, base_unit(element)?);
                    }
                }
                "SimpleType" if !ends => simple = attribute(element, "name")?,
                "ScalarVariable" if !ends => {
                    let causality = attribute(element, "causality")?.unwrap_or_else(|| "local".to_string());
                    variable = attribute(element, "name")?.map(|name| (name, causality));
                }
                _ => {}
            }
            let Some(kind) = Kind::ALL.into_iter().find(|kind| kind.to_string() == name) else { continue };
            let mut written = attribute(element, "unit")?;
            if let Some(simple) = &simple {
                types.extend(written.map(|unit| (simple.clone(), unit)));
            } else if let Some((name, causality)) = variable.take() {
                if written.is_none() {
                    let declared = attribute(element, "declaredType")?;
                    written = declared.and_then(|declared| types.get(&declared).cloned());
                }
                let start = attribute(element, "start")?;
                found.variables.push(Variable { name, causality, kind, unit: written, start });
            }
        }
        match version.as_deref() {
            Some("2.0") if steps => Ok(found),
            Some("2.0") => Err("it is no FMU for co-simulation".to_string()),
            Some(other) => Err(format!("fmiVersion = \"{other}\": it has to be \"2.0\"")),
            None => Err("modelDescription.xml has no fmiVersion".to_string()),
        }
    }

    /// A variable by its name.
    pub fn find(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }
}

fn attribute(element: &BytesStart<'_>, name: &str) -> Result<Option<String>, String> {
    let failed = |why: &dyn fmt::Display| format!("modelDescription.xml is no XML: {why}");
    let found = element.try_get_attribute(name).map_err(|why| failed(&why))?;
    let value =
        found.map(|found| found.normalized_value(XmlVersion::default()).map(std::borrow::Cow::into_owned));
    value.transpose().map_err(|why| failed(&why))
}

fn base_unit(element: &BytesStart<'_>) -> Result<Unit, String> {
    let number = |name: &str, otherwise: f64| match attribute(element, name)? {
        None => Ok(otherwise),
        Some(text) => {
            text.parse().map_err(|_| format!("modelDescription.xml: BaseUnit {name} = {text:?} is no number"))
        }
    };
    let mut exponents = [0; 8];
    for (exponent, name) in exponents.iter_mut().zip(BASE) {
        *exponent = number(name, 0.0)? as i32;
    }
    Ok(Unit { exponents, factor: number("factor", 1.0)?, offset: number("offset", 0.0)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0"><CoSimulation modelIdentifier="m"/>
        <UnitDefinitions><Unit name="rpm"><BaseUnit rad="1" s="-1" factor="0.5"/></Unit>
        <Unit name="rad/s"><BaseUnit rad="1" s="-1"/></Unit><Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
        <Unit name="K"><BaseUnit K="1"/></Unit></UnitDefinitions>
        <TypeDefinitions><SimpleType name="Speed"><Real unit="rpm"/></SimpleType></TypeDefinitions>
        <ModelVariables><ScalarVariable name="a&lt;b" causality="input"><Real declaredType="Speed" start="1"/></ScalarVariable>
        <ScalarVariable name="n"><Integer/></ScalarVariable></ModelVariables></fmiModelDescription>"#;

    #[test]
    fn variables_have_the_units_of_their_types() {
        let read = Interface::read(TEXT).unwrap();
        let speed = read.find("a<b").unwrap();
        assert_eq!(
            (speed.unit.as_deref(), speed.start.as_deref(), speed.kind),
            (Some("rpm"), Some("1"), Kind::Real)
        );
        assert_eq!(read.find("n").map(|n| (n.causality.as_str(), n.kind)), Some(("local", Kind::Integer)));
    }

    #[test]
    fn closed_form_units_are_converted_by_their_dimension() {
        let units = Interface::read(TEXT).unwrap().units;
        assert_eq!(units["rpm"].to(&units["rad/s"]), Some((0.5, 0.0)));
        assert_eq!(units["degC"].to(&units["K"]), Some((1.0, 273.15)));
        assert_eq!(units["degC"].to(&units["rpm"]), None);
    }

    #[test]
    fn other_files_are_refused() {
        assert!(Interface::of_package(b"no zip").unwrap_err().contains("no FMU"));
        for (from, to, part) in [
            ("\"2.0\"", "\"3.0\"", "fmiVersion = \"3.0\""),
            ("<CoSimulation", "<ModelExchange", "co-simulation"),
            ("factor=\"0.5\"", "factor=\"half\"", "factor = \"half\""),
            ("</ModelVariables>", "", "no XML"),
        ] {
            let why = Interface::read(&TEXT.replacen(from, to, 1)).unwrap_err();
            assert!(why.contains(part), "{why}");
        }
    }
}
