//! REXS files: XML, JSON, or either in a zip archive.

use std::error::Error;
use std::io::{Cursor, Read};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use serde_json::Value;

use super::model::{Attribute, Component, Model, Relation};

/// Bytes of an unpacked file at most: a model has some hundred kilobytes.
const LARGEST: u64 = 256 << 20;

/// Reads a model from the bytes of a file, whichever form it has.
///
/// # Errors
/// Says what form it was taken for, and what is wrong with it.
pub fn model(bytes: &[u8]) -> Result<Model, Box<dyn Error>> {
    let start =
        bytes.iter().copied().find(|byte| !byte.is_ascii_whitespace() && !matches!(byte, 0xef | 0xbb | 0xbf));
    let model = match start {
        Some(b'P') if bytes.starts_with(b"PK") => return model(&unpacked(bytes)?),
        Some(b'{') => of_json(bytes).map_err(|why| format!("as JSON: {why}"))?,
        Some(b'<') => of_xml(&text_of(bytes)).map_err(|why| format!("as XML: {why}"))?,
        _ => return Err("it is no REXS file: neither XML, nor JSON, nor a zip archive of one".into()),
    };
    match model.version.split('.').next() {
        Some("1") => Ok(model),
        _ => Err(format!("version {:?} of REXS: versions 1.0 to 1.7 are read", model.version).into()),
    }
}

/// The model in an archive.
fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes))?;
    let names: Vec<String> =
        archive.file_names().map(|name| name.map(String::from)).collect::<Result<_, _>>()?;
    let is_model = |name: &&String| {
        [".rexs", ".rexsj", ".xml", ".json"].iter().any(|end| name.to_lowercase().ends_with(end))
    };
    let name = names.iter().find(is_model).ok_or("the archive has no file that ends with .rexs or .rexsj")?;
    let mut found = vec![];
    archive.by_name(name)?.take(LARGEST).read_to_end(&mut found)?;
    if found.starts_with(b"PK") {
        return Err("an archive in an archive".into());
    }
    Ok(found)
}

/// Text of a file in UTF-8, or in Latin 1, which old programs write.
fn text_of(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

/// Numbers of an array in base64: `float64`, `float32` or `int32`, least byte first.
fn decoded(code: &str, text: &str) -> Result<Vec<String>, String> {
    let compact: String = text.split_whitespace().collect();
    let bytes = STANDARD.decode(compact).map_err(|why| format!("array in base64: {why}"))?;
    fn each<const N: usize>(bytes: &[u8], number: fn([u8; N]) -> String) -> Vec<String> {
        bytes.as_chunks::<N>().0.iter().map(|chunk| number(*chunk)).collect()
    }
    match code.split('_').next() {
        Some("float64") => Ok(each(&bytes, |of| f64::from_le_bytes(of).to_string())),
        Some("float32") => Ok(each(&bytes, |of| f32::from_le_bytes(of).to_string())),
        Some("int32") => Ok(each(&bytes, |of| i32::from_le_bytes(of).to_string())),
        _ => Err(format!("array in code {code:?}: float64, float32 and int32 are read")),
    }
}

/// Value of an attribute of an XML element; empty if it has none of that name.
fn given(element: &BytesStart, name: &str) -> Result<String, Box<dyn Error>> {
    match element.try_get_attribute(name)? {
        Some(found) => Ok(found.normalized_value(XmlVersion::Explicit1_0)?.into_owned()),
        None => Ok(String::new()),
    }
}

/// Number of a component.
fn id(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| format!("{text:?} is no number of a component"))
}

/// What is being read of an XML file.
#[derive(Default)]
struct Place {
    model: Model,
    component: Option<Component>,
    attribute: Option<Attribute>,
    /// Code of an array, and the text of the innermost element.
    code: String,
    text: String,
    case: Option<Vec<Component>>,
    /// Results of the whole spectrum are no load.
    accumulates: bool,
}

impl Place {
    fn begin(&mut self, element: &BytesStart) -> Result<(), Box<dyn Error>> {
        self.text.clear();
        match element.local_name().as_ref() {
            "model" => {
                self.model.version = given(element, "version")?;
                let program = [given(element, "applicationId")?, given(element, "applicationVersion")?];
                self.model.application = program.join(" ").trim().to_owned();
            }
            "relation" => {
                self.model.relations.push(Relation { kind: given(element, "type")?, roles: vec![] });
            }
            "ref" => {
                let role = (given(element, "role")?, id(&given(element, "id")?)?);
                let relation = self.model.relations.last_mut().ok_or("<ref> outside of <relation>")?;
                relation.roles.push(role);
            }
            "load_case" => self.case = Some(vec![]),
            "accumulation" => self.accumulates = true,
            "component" => {
                self.component = Some(Component {
                    id: id(&given(element, "id")?)?,
                    kind: given(element, "type")?,
                    name: given(element, "name")?,
                    attributes: vec![],
                });
            }
            "attribute" => {
                self.attribute = Some(Attribute {
                    id: given(element, "id")?,
                    unit: given(element, "unit")?,
                    values: vec![],
                });
                self.code.clear();
            }
            "array" => self.code = given(element, "code")?,
            _ => {}
        }
        Ok(())
    }

    fn end(&mut self, name: &str) -> Result<(), Box<dyn Error>> {
        let text = std::mem::take(&mut self.text);
        match name {
            "c" => self.attribute.iter_mut().for_each(|of| of.values.push(text.clone())),
            "array" if !self.code.is_empty() => {
                if let Some(of) = &mut self.attribute {
                    of.values = decoded(&self.code, &text)?;
                }
            }
            "attribute" => {
                let Some(mut of) = self.attribute.take() else { return Ok(()) };
                if of.values.is_empty() {
                    of.values.push(text);
                }
                self.component.iter_mut().for_each(|component| component.attributes.push(of.clone()));
            }
            "component" => match (self.component.take(), &mut self.case) {
                (Some(of), Some(case)) => case.push(of),
                (Some(of), None) if !self.accumulates => {
                    self.model.components.insert(of.id, of);
                }
                _ => {}
            },
            "load_case" => self.model.cases.extend(self.case.take()),
            "accumulation" => self.accumulates = false,
            _ => {}
        }
        Ok(())
    }
}

fn of_xml(text: &str) -> Result<Model, Box<dyn Error>> {
    let mut reader = Reader::from_str(text.trim_start_matches('\u{feff}').trim_start());
    reader.config_mut().expand_empty_elements = true;
    let mut place = Place::default();
    let mut depth = 0_usize;
    loop {
        let at = reader.buffer_position();
        let told = |why: Box<dyn Error>| format!("{why}, at byte {at}");
        match reader.read_event().map_err(|why| told(why.into()))? {
            Event::Start(element) => {
                depth += 1;
                place.begin(&element).map_err(told)?;
            }
            Event::End(element) => {
                depth = depth.saturating_sub(1);
                place.end(element.local_name().as_ref()).map_err(told)?;
            }
            Event::Text(text) => place.text += &text.xml10_content(),
            Event::CData(text) => place.text += &text.xml10_content(),
            Event::GeneralRef(of) => match of.resolve_char_ref()? {
                Some(char) => place.text.push(char),
                None => {
                    let name = of.xml10_content();
                    let text =
                        resolve_predefined_entity(&name).ok_or_else(|| format!("&{name}; is not known"))?;
                    place.text += text;
                }
            },
            Event::Eof if depth > 0 => return Err("the file ends inside of an element".into()),
            Event::Eof => break,
            _ => {}
        }
    }
    Ok(place.model)
}

/// Text of a value of JSON.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Members of a list; none if it is not there.
fn list<'a>(of: &'a Value, name: &str) -> impl Iterator<Item = &'a Value> + use<'a> {
    of.get(name).and_then(Value::as_array).into_iter().flatten()
}

/// Load spectra: one, or a list of them.
fn spectra(of: &Value) -> impl Iterator<Item = &Value> {
    let found = of.get("load_spectrum");
    found.into_iter().flat_map(|of| of.as_array().map_or(std::slice::from_ref(of), Vec::as_slice))
}

/// Component of JSON.
fn component(of: &Value) -> Result<Component, Box<dyn Error>> {
    let text = |of: &Value, name: &str| of.get(name).map(plain).unwrap_or_default();
    let mut found = Component {
        id: id(&text(of, "id"))?,
        kind: text(of, "type"),
        name: text(of, "name"),
        attributes: vec![],
    };
    for attribute in list(of, "attributes") {
        let (name, unit) = (text(attribute, "id"), text(attribute, "unit"));
        // Its value is the member that is called by its type.
        let value = attribute.as_object().and_then(|members| {
            members.iter().find(|(key, _)| !matches!(key.as_str(), "id" | "unit" | "name"))
        });
        let values = match value {
            Some((_, Value::Array(values))) => values.iter().map(plain).collect(),
            Some((_, Value::Object(coded))) => {
                let part = |name: &str| coded.get(name).map(plain).unwrap_or_default();
                decoded(&part("code"), &part("value"))?
            }
            Some((_, value)) => vec![plain(value)],
            None => vec![],
        };
        found.attributes.push(Attribute { id: name, unit, values });
    }
    Ok(found)
}

fn of_json(bytes: &[u8]) -> Result<Model, Box<dyn Error>> {
    let whole: Value = serde_json::from_str(text_of(bytes).trim_start_matches('\u{feff}'))?;
    let of = whole.get("model").ok_or("it has no \"model\"")?;
    let text = |name: &str| of.get(name).map(plain).unwrap_or_default();
    let mut model = Model {
        version: text("version"),
        application: [text("applicationId"), text("applicationVersion")].join(" ").trim().to_owned(),
        ..Model::default()
    };
    for relation in list(of, "relations") {
        let mut roles = vec![];
        for role in list(relation, "refs") {
            let text = |name: &str| role.get(name).map(plain).unwrap_or_default();
            roles.push((text("role"), id(&text("id"))?));
        }
        model.relations.push(Relation { kind: relation.get("type").map(plain).unwrap_or_default(), roles });
    }
    for found in list(of, "components") {
        let found = component(found)?;
        model.components.insert(found.id, found);
    }
    for case in spectra(of).flat_map(|of| list(of, "load_cases")) {
        model.cases.push(list(case, "components").map(component).collect::<Result<_, _>>()?);
    }
    Ok(model)
}
