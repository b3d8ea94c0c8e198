//! A REXS file as it is written: relations, components, load cases.

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};

/// A component in a relation: role, type, number.
pub type Role = (&'static str, &'static str, u64);

/// What is written: relations by their types, components.
#[derive(Default)]
pub struct Document {
    relations: Vec<(&'static str, Vec<Role>)>,
    components: Vec<Part>,
}

/// A component with its attributes: name, unit, values.
pub struct Part {
    /// Its number.
    pub id: u64,
    kind: &'static str,
    name: String,
    attributes: Vec<(&'static str, &'static str, Vec<String>)>,
}

impl Part {
    /// A component without a name, as load cases have it.
    pub fn of_case(id: u64, kind: &'static str) -> Self {
        Self { id, kind, name: String::new(), attributes: vec![] }
    }

    /// A number in SI as an attribute in a unit.
    pub fn number(&mut self, name: &'static str, unit: &'static str, number: f64) {
        self.attributes.push((name, unit, vec![in_unit(number, unit)]));
    }

    /// A text as an attribute.
    pub fn text(&mut self, name: &'static str, text: &str) {
        self.attributes.push((name, "none", vec![text.into()]));
    }

    /// Its place, with axes along those of the gear unit.
    pub fn place(&mut self, origin: [f64; 3]) {
        let plain = |numbers: [f64; 3]| numbers.map(|number| in_unit(number, "mm")).to_vec();
        self.attributes.push(("support_vector", "mm", plain(origin)));
        self.attributes.push(("u_axis_vector", "mm", ["1", "0", "0"].map(String::from).to_vec()));
        self.attributes.push(("w_axis_vector", "mm", ["0", "0", "1"].map(String::from).to_vec()));
        self.text("reference_component_for_position", "1");
    }
}

/// A number of SI in a unit of the file: the shortest text that reads back as the same number in that unit, to 15 digits.
fn in_unit(number: f64, unit: &str) -> String {
    let size = super::units::size(unit).unwrap_or(1.0);
    let text = format!("{:.14e}", number / size);
    text.parse::<f64>().map_or(text, |number| number.to_string())
}

impl Document {
    /// A new component.
    pub fn add(&mut self, kind: &'static str, name: &str) -> &mut Part {
        let id = self.components.len() as u64 + 1;
        self.components.push(Part { id, kind, name: name.into(), attributes: vec![] });
        let last = self.components.len() - 1;
        &mut self.components[last]
    }

    /// A relation.
    pub fn relate(&mut self, kind: &'static str, roles: &[Role]) {
        self.relations.push((kind, roles.to_vec()));
    }

    /// A component that is a part of another.
    pub fn part_of(&mut self, assembly: (&'static str, u64), part: (&'static str, u64)) {
        self.relate("assembly", &[("assembly", assembly.0, assembly.1), ("part", part.0, part.1)]);
    }
}

/// Text of the file.
///
/// # Errors
/// If it cannot be written.
pub fn text(document: &Document, cases: &[Vec<Part>]) -> Result<String, Box<dyn std::error::Error>> {
    let mut writer = Writer::new_with_indent(vec![], b' ', 2);
    writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    writer
        .create_element("model")
        .with_attributes([
            ("applicationId", "roulement"),
            ("applicationVersion", env!("CARGO_PKG_VERSION")),
            ("version", "1.4"),
        ])
        .write_inner_content(|writer| {
            writer.create_element("relations").write_inner_content(|writer| {
                for (index, (kind, roles)) in document.relations.iter().enumerate() {
                    writer
                        .create_element("relation")
                        .with_attributes([("id", (index + 1).to_string().as_str()), ("type", kind)])
                        .write_inner_content(|writer| {
                            for (role, hint, id) in roles {
                                writer
                                    .create_element("ref")
                                    .with_attributes([
                                        ("hint", *hint),
                                        ("id", id.to_string().as_str()),
                                        ("role", role),
                                    ])
                                    .write_empty()?;
                            }
                            Ok(())
                        })?;
                }
                Ok(())
            })?;
            writer
                .create_element("components")
                .write_inner_content(|writer| parts(writer, &document.components))?;
            if !cases.is_empty() {
                writer.create_element("load_spectrum").with_attribute(("id", "1")).write_inner_content(
                    |writer| {
                        for (index, case) in cases.iter().enumerate() {
                            writer
                                .create_element("load_case")
                                .with_attribute(("id", (index + 1).to_string().as_str()))
                                .write_inner_content(|writer| parts(writer, case))?;
                        }
                        Ok(())
                    },
                )?;
            }
            Ok(())
        })?;
    Ok(String::from_utf8(writer.into_inner())? + "\n")
}

fn parts(writer: &mut Writer<Vec<u8>>, parts: &[Part]) -> std::io::Result<()> {
    for part in parts {
        writer
            .create_element("component")
            .with_attributes([
                ("id", part.id.to_string().as_str()),
                ("name", &part.name),
                ("type", part.kind),
            ])
            .write_inner_content(|writer| {
                for (name, unit, values) in &part.attributes {
                    let element =
                        writer.create_element("attribute").with_attributes([("id", *name), ("unit", *unit)]);
                    match values.as_slice() {
                        [value] => element.write_text_content(BytesText::new(value))?,
                        several => element.write_inner_content(|writer| {
                            writer.create_element("array").write_inner_content(|writer| {
                                for value in several {
                                    writer.create_element("c").write_text_content(BytesText::new(value))?;
                                }
                                Ok(())
                            })?;
                            Ok(())
                        })?,
                    };
                }
                Ok(())
            })?;
    }
    Ok(())
}
