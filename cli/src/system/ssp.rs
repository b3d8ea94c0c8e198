//! The SSP 1.0 file: `SystemStructure.ssd` and the packages below `resources`, in one zip file.
//!
//! The system has no connectors of its own: Ecos refuses those. Connectors name no units, so that no importer converts them a second
//! time: conversions and signs of mountings are in the linear transformations of connections. Start values are a parameter set of each component, all
//! of one name.

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use roulement::schema::regular::{self, LARGEST_BINARY};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::interface::Kind;
use super::{System, SystemError, file_error};
use crate::package::replaceable;

/// Name of all sets of start values.
const PARAMETER_SET: &str = "start";
const NAMESPACES: [(&str, &str); 3] = [
    ("xmlns:ssd", "http://ssp-standard.org/SSP1/SystemStructureDescription"),
    ("xmlns:ssc", "http://ssp-standard.org/SSP1/SystemStructureCommon"),
    ("xmlns:ssv", "http://ssp-standard.org/SSP1/SystemStructureParameterValues"),
];

type Xml = Writer<Vec<u8>>;

/// Writes the file with the packages of a folder; one that is there is replaced only by a complete one.
///
/// # Errors
/// If a package cannot be read, or the file not be written.
pub fn write(system: &System, packages: &Path, file: &Path) -> Result<(), SystemError> {
    replaceable(file).map_err(file_error("write", file))?;
    // Without time stamps: the same system gives the same bytes.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    let stored = options.compression_method(CompressionMethod::Stored);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("SystemStructure.ssd", options)?;
    zip.write_all(structure(system)?.as_bytes())?;
    let mut files: Vec<&str> = system.components.iter().map(|component| component.file.as_str()).collect();
    files.sort_unstable();
    files.dedup();
    for name in files {
        let package = packages.join(name);
        // Packages are deflated already.
        zip.start_file(format!("resources/{name}"), stored)?;
        zip.write_all(&regular::bytes(&package, LARGEST_BINARY).map_err(file_error("read", &package))?)?;
    }
    let partial = file.with_extension("ssp.part");
    fs::write(&partial, zip.finish()?.into_inner()).map_err(file_error("write", &partial))?;
    fs::rename(&partial, file).map_err(file_error("write", file))
}

/// The system structure description.
fn structure(system: &System) -> std::io::Result<String> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let described = format!("communication step {:?} s", system.step);
    xml.create_element("ssd:SystemStructureDescription")
        .with_attributes(NAMESPACES)
        .with_attributes([
            ("version", "1.0"),
            ("name", system.name.as_str()),
            ("description", described.as_str()),
            ("generationTool", concat!("roulement ", env!("CARGO_PKG_VERSION"))),
        ])
        .write_inner_content(|xml| {
            xml.create_element("ssd:System")
                .with_attribute(("name", system.name.as_str()))
                .write_inner_content(|xml| {
                    xml.create_element("ssd:Elements").write_inner_content(|xml| {
                        (0..system.components.len()).try_for_each(|index| component(xml, system, index))
                    })?;
                    connections(xml, system)
                })?;
            let stop = format!("{:?}", system.stop);
            xml.create_element("ssd:DefaultExperiment")
                .with_attributes([("startTime", "0.0"), ("stopTime", stop.as_str())])
                .write_empty()?;
            Ok(())
        })?;
    let mut text = String::from_utf8(xml.into_inner()).map_err(std::io::Error::other)?;
    text.push('\n');
    Ok(text)
}

/// Connectors of a component that something is done with, in alphabetical order: name, kind, type.
fn connectors(system: &System, index: usize) -> Vec<(&str, &'static str, Kind)> {
    let mut all = vec![];
    for connection in &system.connections {
        for ((of, name), kind) in [(&connection.from, "output"), (&connection.to, "input")] {
            if *of == index {
                all.push((name.as_str(), kind, connection.kind));
            }
        }
    }
    let of_start = |input: bool| if input { "input" } else { "parameter" };
    all.extend(system.starts[index].iter().map(|one| (one.name.as_str(), of_start(one.input), one.kind)));
    all.sort_unstable_by_key(|(name, ..)| *name);
    all.dedup();
    all
}

fn component(xml: &mut Xml, system: &System, index: usize) -> std::io::Result<()> {
    let component = &system.components[index];
    let source = format!("resources/{}", component.file);
    let (connectors, starts) = (connectors(system, index), &system.starts[index]);
    let element = xml.create_element("ssd:Component").with_attributes([
        ("name", component.name.as_str()),
        ("type", "application/x-fmu-sharedlibrary"),
        ("source", source.as_str()),
        ("implementation", "CoSimulation"),
    ]);
    element.write_inner_content(|xml| {
        if !connectors.is_empty() {
            xml.create_element("ssd:Connectors").write_inner_content(|xml| {
                connectors.iter().try_for_each(|(name, kind, of)| {
                    let element = xml
                        .create_element("ssd:Connector")
                        .with_attributes([("name", *name), ("kind", *kind)]);
                    element.write_inner_content(|xml| {
                        xml.create_element(format!("ssc:{of}")).write_empty().map(drop)
                    })?;
                    Ok(())
                })
            })?;
        }
        if starts.is_empty() {
            return Ok(());
        }
        within(xml, &["ssd:ParameterBindings", "ssd:ParameterBinding", "ssd:ParameterValues"], &|xml| {
            let set = xml.create_element("ssv:ParameterSet");
            set.with_attributes([("version", "1.0"), ("name", PARAMETER_SET)]).write_inner_content(
                |xml| {
                    xml.create_element("ssv:Parameters").write_inner_content(|xml| {
                        starts.iter().try_for_each(|start| {
                            let parameter = xml
                                .create_element("ssv:Parameter")
                                .with_attribute(("name", start.name.as_str()));
                            parameter.write_inner_content(|xml| {
                                let value = ("value", start.value.as_str());
                                xml.create_element(format!("ssv:{}", start.kind))
                                    .with_attribute(value)
                                    .write_empty()?;
                                Ok(())
                            })?;
                            Ok(())
                        })
                    })?;
                    Ok(())
                },
            )?;
            Ok(())
        })
    })?;
    Ok(())
}

/// Writes elements within each other, and what is in the innermost one.
fn within(
    xml: &mut Xml,
    names: &[&str],
    inside: &dyn Fn(&mut Xml) -> std::io::Result<()>,
) -> std::io::Result<()> {
    match names.split_first() {
        None => inside(xml),
        Some((name, rest)) => {
            xml.create_element(*name).write_inner_content(|xml| within(xml, rest, inside))?;
            Ok(())
        }
    }
}

fn connections(xml: &mut Xml, system: &System) -> std::io::Result<()> {
    if system.connections.is_empty() {
        return Ok(());
    }
    xml.create_element("ssd:Connections").write_inner_content(|xml| {
        system.connections.iter().try_for_each(|connection| {
            let element = xml.create_element("ssd:Connection").with_attributes([
                ("startElement", system.components[connection.from.0].name.as_str()),
                ("startConnector", connection.from.1.as_str()),
                ("endElement", system.components[connection.to.0].name.as_str()),
                ("endConnector", connection.to.1.as_str()),
            ]);
            if !connection.changes() {
                element.write_empty()?;
                return Ok(());
            }
            let (factor, offset) = (format!("{:?}", connection.factor), format!("{:?}", connection.offset));
            element.write_inner_content(|xml| {
                xml.create_element("ssc:LinearTransformation")
                    .with_attributes([("factor", factor.as_str()), ("offset", offset.as_str())])
                    .write_empty()?;
                Ok(())
            })?;
            Ok(())
        })
    })?;
    Ok(())
}
