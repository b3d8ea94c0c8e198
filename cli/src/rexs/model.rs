//! The model in a REXS file: components with attributes, relations between them, and the loads of its spectrum.

use std::collections::BTreeMap;
use std::fmt::Display;

use super::units::size;

/// A model as the file has it.
#[derive(Debug, Default)]
pub struct Model {
    /// Version of the format, such as "1.4".
    pub version: String,
    /// Program that wrote it, with its version.
    pub application: String,
    /// Components by their numbers.
    pub components: BTreeMap<u64, Component>,
    /// Relations in the order of the file.
    pub relations: Vec<Relation>,
    /// Loads of the spectrum: components with the attributes that differ.
    pub cases: Vec<Vec<Component>>,
}

/// A part of the gearbox, or of its description.
#[derive(Clone, Debug, Default)]
pub struct Component {
    /// Its number in the file.
    pub id: u64,
    /// Its type, such as `shaft`.
    pub kind: String,
    /// Its name, which may be empty.
    pub name: String,
    /// Its attributes in the order of the file.
    pub attributes: Vec<Attribute>,
}

/// A property of a component.
#[derive(Clone, Debug, Default)]
pub struct Attribute {
    /// Its name by the specification.
    pub id: String,
    /// Its unit as the file writes it.
    pub unit: String,
    /// Its value as text; numbers of a vector one after another.
    pub values: Vec<String>,
}

/// What ties components: a type, and components in their roles.
#[derive(Debug, Default)]
pub struct Relation {
    /// Its type, such as `assembly`.
    pub kind: String,
    /// Roles, and numbers of the components in them.
    pub roles: Vec<(String, u64)>,
}

impl Relation {
    /// Number of the component in a role.
    pub fn role(&self, role: &str) -> Option<u64> {
        self.roles.iter().find(|(name, _)| name == role).map(|(_, id)| *id)
    }
}

impl Display for Component {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(to, "{} {}", self.kind, self.id)?;
        if self.name.is_empty() { Ok(()) } else { write!(to, " ({})", self.name) }
    }
}

impl Component {
    fn attribute(&self, id: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|of| of.id == id)
    }

    /// Text of an attribute; none if it is empty.
    pub fn text(&self, id: &str) -> Option<&str> {
        self.attribute(id)?.values.first().map(|text| text.trim()).filter(|text| !text.is_empty())
    }

    /// Is an attribute given as true?
    pub fn is(&self, id: &str) -> bool {
        self.text(id) == Some("true")
    }

    /// Numbers of an attribute, in SI.
    ///
    /// # Errors
    /// Names component and attribute, if a value is no number or its unit is not known.
    pub fn numbers(&self, id: &str) -> Result<Option<Vec<f64>>, String> {
        let Some(of) = self.attribute(id) else { return Ok(None) };
        let size = size(&of.unit).ok_or_else(|| format!("{self}: {id}: unit {:?} is not known", of.unit))?;
        let number = |text: &String| match text.trim().parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number * size),
            _ => Err(format!("{self}: {id}: {text:?} is no finite number")),
        };
        of.values.iter().map(number).collect::<Result<Vec<_>, _>>().map(Some)
    }

    /// A number of an attribute, in SI.
    ///
    /// # Errors
    /// As [`Self::numbers`].
    pub fn number(&self, id: &str) -> Result<Option<f64>, String> {
        Ok(self.numbers(id)?.and_then(|numbers| numbers.first().copied()))
    }

    /// A number that has to be there.
    ///
    /// # Errors
    /// As [`Self::numbers`], or if it is missing.
    pub fn needed(&self, id: &str) -> Result<f64, String> {
        self.number(id)?.ok_or_else(|| format!("{self}: {id} is missing"))
    }

    /// Three numbers of an attribute, in SI.
    ///
    /// # Errors
    /// As [`Self::numbers`], or if there are not three.
    pub fn vector(&self, id: &str) -> Result<Option<[f64; 3]>, String> {
        let Some(numbers) = self.numbers(id)? else { return Ok(None) };
        numbers
            .try_into()
            .map(Some)
            .map_err(|found: Vec<f64>| format!("{self}: {id}: {} numbers, 3 are needed", found.len()))
    }
}

impl Model {
    /// Components of a type, by growing number.
    pub fn of_kind<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = &'a Component> {
        self.components.values().filter(move |of| of.kind == kind)
    }

    /// Relations of a type.
    pub fn related<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = &'a Relation> {
        self.relations.iter().filter(move |of| of.kind == kind)
    }

    /// Parts of an assembly of a type.
    pub fn parts<'a>(&'a self, assembly: u64, kind: &'a str) -> impl Iterator<Item = &'a Component> {
        self.relations
            .iter()
            .filter(move |of| {
                matches!(of.kind.as_str(), "assembly" | "ordered_assembly")
                    && of.role("assembly") == Some(assembly)
            })
            .filter_map(|of| self.components.get(&of.role("part")?))
            .filter(move |of| of.kind == kind)
    }

    /// Assembly of a type that a component is a part of.
    pub fn assembly_of<'a>(&'a self, part: u64, kind: &'a str) -> Option<&'a Component> {
        self.related("assembly")
            .filter(|of| of.role("part") == Some(part))
            .filter_map(|of| self.components.get(&of.role("assembly")?))
            .find(|of| of.kind == kind)
    }

    /// Component of a type that another one refers to.
    pub fn referenced<'a>(&'a self, by: u64, kind: &'a str) -> Option<&'a Component> {
        self.related("reference")
            .filter(|of| of.role("origin") == Some(by))
            .filter_map(|of| self.components.get(&of.role("referenced")?))
            .find(|of| of.kind == kind)
    }
}
