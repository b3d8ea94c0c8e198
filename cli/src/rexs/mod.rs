//! Gearboxes from REXS files (Reusable Engineering EXchange Standard, versions 1.0 to 1.7) as machines: shafts, gears, bearings, oil, loads and their spectrum.
//!
//! What a machine does not have is told of, and stands in the head of its file; nothing is left out in silence. Names of components and attributes are those of the
//! specification.

mod bearings;
mod document;
mod duty;
mod frame;
mod gearbox;
mod gears;
mod model;
mod names;
mod of_scene;
mod power;
mod read;
mod shafts;
mod text;
mod units;
mod write;

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use frame::Frame;
use gearbox::Gearbox;
use model::{Component, Model};
use names::Names;

/// Types of components that the machine is made of, or that say nothing of how it moves.
const KNOWN: &[&str] = &[
    "gear_unit",
    "gear_casing",
    "shaft",
    "shaft_section",
    "external_load",
    "cylindrical_gear",
    "ring_gear",
    "cylindrical_stage",
    "stage_gear_data",
    "cylindrical_stage_gear_data",
    "flank_geometry",
    "cylindrical_gear_flank",
    "concept_bearing",
    "rolling_bearing_with_catalog_geometry",
    "rolling_bearing_with_detailed_geometry",
    "rolling_bearing_row",
    "rolling_element",
    "coupling",
    "switchable_coupling",
    "lubricant",
    "material",
    "assembly_group",
];

/// A machine from a file.
#[derive(Debug)]
pub struct Imported {
    /// The machine's file.
    pub text: String,
    /// What of the gearbox it does not have, or has otherwise.
    pub notes: Vec<String>,
    /// What was read, in one line.
    pub summary: String,
}

/// Reads a gearbox and writes it as a machine.
///
/// # Errors
/// If the file cannot be read, or has no machine in it; names component, attribute and value.
pub fn import(path: &Path) -> Result<Imported, Box<dyn Error>> {
    let told = |why: Box<dyn Error>| -> Box<dyn Error> { format!("{}: {why}", path.display()).into() };
    let bytes = std::fs::read(path).map_err(|why| told(why.into()))?;
    let model = read::model(&bytes).map_err(told)?;
    let mut notes = vec![];
    let mut gearbox = machine(&model, &mut notes).map_err(|why| told(why.into()))?;
    if gearbox.title.is_empty() {
        gearbox.title =
            path.file_stem().map(|stem| stem.to_string_lossy().replace('_', " ")).unwrap_or_default();
    }
    let by = if model.application.is_empty() { "an unnamed program" } else { &model.application };
    let mut head =
        vec![format!("Imported from a file in the REXS {} format, written by {by}.", model.version)];
    head.push("x along all shafts; positions count from the left end of each shaft. Housings are rigid. Inner geometry of bearings is that of the catalogue.".into());
    if !notes.is_empty() {
        head.push(String::new());
        head.push("What this machine does not have of the gearbox, or has otherwise:".into());
        head.extend(notes.iter().map(|note| format!("- {note}")));
    }
    let count = |kind: &str| model.of_kind(kind).count();
    let summary = format!(
        "{} of {} shafts, {} of {} stages, {} of {} bearings and couplings, {} of {} load cases",
        gearbox.shafts.len(),
        count("shaft"),
        gearbox.meshes.len(),
        model.related("stage").count(),
        gearbox.bearings.len() + gearbox.couplings.len(),
        model.related("side").count(),
        gearbox.duty.len(),
        model.cases.len()
    );
    Ok(Imported { text: text::file(&gearbox, &head), notes, summary })
}

/// A gearbox's file from a machine, and what of the machine it does not have.
///
/// # Errors
/// If the machine is refused, or has shafts that the format cannot hold.
pub fn export(path: &Path) -> Result<(String, Vec<String>), Box<dyn Error>> {
    let mut notes = vec![];
    let (gearbox, cases) = of_scene::gearbox(path, &mut notes)?;
    Ok((write::file(&gearbox, &cases)?, notes))
}

/// The machine of a model.
fn machine(model: &Model, notes: &mut Vec<String>) -> Result<Gearbox, String> {
    others(model, notes);
    // The machine's own loads are those of the file; where it has them in its spectrum alone, those of the first case.
    let own: &[Component] = if model.cases.is_empty() || has_drive(model) { &[] } else { &model.cases[0] };
    let mut names = Names::default();
    let (shafts, axes) = shafts::shafts(model, &mut names, notes)?;
    let mut gearbox = Gearbox { shafts, ..Gearbox::default() };
    gearbox.meshes = gears::meshes(model, &gearbox.shafts, &axes, &mut names, notes)?;
    (gearbox.bearings, gearbox.couplings) =
        bearings::bearings(model, &gearbox.shafts, &axes, &mut names, notes)?;
    gearbox.oil = bearings::oil(model, own)?;
    gears::bodies(&gearbox.meshes, &mut gearbox.shafts);
    power::positions(model, &mut gearbox.shafts)?;
    let drives = power::drives(model, own, &gearbox.shafts, &gearbox.meshes, &gearbox.couplings, notes)?;
    for (index, shaft) in gearbox.shafts.iter_mut().enumerate() {
        shaft.speed = drives.speeds[index];
        shaft.torque = drives.torques[index];
        if shaft.speed.is_none() && shaft.torque.is_none() {
            shaft.drive_position = None;
        }
        let frame = model.components.get(&shaft.id).map(|of| Frame::of(of, model)).transpose()?.flatten();
        for load in &mut shaft.loads {
            if let Some(of) = own.iter().find(|of| of.id == load.id) {
                (load.force, load.moment) = shafts::wrench(of, &frame.unwrap_or_default(), &axes)?;
            }
        }
    }
    gearbox.duty = duty::duty(model, &gearbox, &axes, &drives, notes)?;
    for unit in model.of_kind("gear_unit") {
        gearbox.title = unit.text("model_name").unwrap_or_default().to_owned();
        if unit.is("account_for_gravity") {
            let [u, v, w] =
                ["u", "v", "w"].map(|axis| unit.number(&format!("direction_vector_gravity_{axis}")));
            let way = nalgebra::Vector3::new(u?.unwrap_or(0.0), v?.unwrap_or(0.0), w?.unwrap_or(0.0));
            if let Some(way) = way.try_normalize(0.0) {
                let size = unit.number("gravitational_acceleration")?.unwrap_or(9.80665);
                gearbox.gravity = Some((axes.turned(&way) * size).into());
            }
        }
    }
    Ok(gearbox)
}

/// Does the file itself have a speed or a torque, outside of its spectrum?
fn has_drive(model: &Model) -> bool {
    model.of_kind("shaft").any(|of| of.text("rotational_speed").is_some())
        || model.of_kind("external_load").any(|of| of.text("torque_around_u_axis").is_some())
}

/// Tells of components that no machine has, by their types.
fn others(model: &Model, notes: &mut Vec<String>) {
    let mut found: BTreeMap<&str, Vec<u64>> = BTreeMap::new();
    for of in model.components.values().filter(|of| !KNOWN.contains(&of.kind.as_str())) {
        found.entry(&of.kind).or_default().push(of.id);
    }
    for (kind, ids) in found {
        let ids: Vec<String> = ids.iter().map(u64::to_string).collect();
        notes.push(format!("not simulated: {} ({})", kind.replace('_', " "), ids.join(", ")));
    }
    if model.of_kind("planetary_stage").next().is_some() {
        notes.push("planets go round with their carrier: give the machine a frame that turns with it, and speeds against it (docs/shaft.md, Planets)".into());
    }
}
