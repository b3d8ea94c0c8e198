//! The folder for libcosim: `OspSystemStructure.xml` (version 0.1) beside the packages.
//!
//! A connection with a factor goes through a linear transformation of libcosim, which is applied where values are handed over: it takes
//! no step longer than a plain connection.

use std::fs;
use std::path::Path;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};

use super::connections::{Connection, End};
use super::{System, SystemError, file_error};

const NAMESPACE: &str = "http://opensimulationplatform.com/MSMI/OSPSystemStructure";

type Xml = Writer<Vec<u8>>;

/// Writes the structure into the folder of the packages.
///
/// # Errors
/// If the file cannot be written.
pub fn write(system: &System, folder: &Path) -> Result<(), SystemError> {
    let file = folder.join("OspSystemStructure.xml");
    fs::write(&file, structure(system)?).map_err(file_error("write", &file))
}

fn structure(system: &System) -> std::io::Result<String> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let root = xml.create_element("OspSystemStructure");
    root.with_attributes([("xmlns", NAMESPACE), ("version", "0.1")]).write_inner_content(|xml| {
        let step = format!("{:?}", system.step);
        for (name, text) in
            [("StartTime", "0.0"), ("BaseStepSize", step.as_str()), ("Algorithm", "fixedStep")]
        {
            xml.create_element(name).write_text_content(BytesText::new(text))?;
        }
        xml.create_element("Simulators").write_inner_content(|xml| {
            (0..system.components.len()).try_for_each(|index| simulator(xml, system, index))
        })?;
        let (changed, plain): (Vec<_>, Vec<_>) =
            system.connections.iter().partition(|connection| connection.changes());
        if !changed.is_empty() {
            xml.create_element("Functions").write_inner_content(|xml| {
                changed.iter().try_for_each(|connection| {
                    let (factor, offset) =
                        (format!("{:?}", connection.factor), format!("{:?}", connection.offset));
                    let attributes =
                        [("name", function(system, connection)), ("factor", factor), ("offset", offset)];
                    let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
                    xml.create_element("LinearTransformation").with_attributes(attributes).write_empty()?;
                    Ok(())
                })
            })?;
        }
        if system.connections.is_empty() {
            return Ok(());
        }
        xml.create_element("Connections").write_inner_content(|xml| {
            for connection in plain {
                xml.create_element("VariableConnection").write_inner_content(|xml| {
                    variable(xml, system, &connection.from)?;
                    variable(xml, system, &connection.to)
                })?;
            }
            for connection in changed {
                let function = function(system, connection);
                for (end, signal) in [(&connection.from, "in"), (&connection.to, "out")] {
                    xml.create_element("SignalConnection").write_inner_content(|xml| {
                        variable(xml, system, end)?;
                        let attributes = [("function", function.as_str()), ("name", signal)];
                        xml.create_element("Signal").with_attributes(attributes).write_empty()?;
                        Ok(())
                    })?;
                }
            }
            Ok(())
        })?;
        Ok(())
    })?;
    let mut text = String::from_utf8(xml.into_inner()).map_err(std::io::Error::other)?;
    text.push('\n');
    Ok(text)
}

fn simulator(xml: &mut Xml, system: &System, index: usize) -> std::io::Result<()> {
    let component = &system.components[index];
    let attributes = [("name", component.name.as_str()), ("source", component.file.as_str())];
    let element = xml.create_element("Simulator").with_attributes(attributes);
    if system.starts[index].is_empty() {
        element.write_empty()?;
        return Ok(());
    }
    element.write_inner_content(|xml| {
        xml.create_element("InitialValues").write_inner_content(|xml| {
            system.starts[index].iter().try_for_each(|start| {
                let value =
                    xml.create_element("InitialValue").with_attribute(("variable", start.name.as_str()));
                value.write_inner_content(|xml| {
                    let value = ("value", start.value.as_str());
                    xml.create_element(start.kind.to_string()).with_attribute(value).write_empty()?;
                    Ok(())
                })?;
                Ok(())
            })
        })?;
        Ok(())
    })?;
    Ok(())
}

/// Name of the transformation of a connection: that of its input, which no other connection has.
fn function(system: &System, connection: &Connection) -> String {
    format!("{}.{}", system.components[connection.to.0].name, connection.to.1)
}

fn variable(xml: &mut Xml, system: &System, (component, name): &End) -> std::io::Result<()> {
    let attributes = [("simulator", system.components[*component].name.as_str()), ("name", name.as_str())];
    xml.create_element("Variable").with_attributes(attributes).write_empty()?;
    Ok(())
}
