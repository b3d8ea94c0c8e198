//! A machine's file as a gearbox: what of it a REXS file can hold.

use std::collections::BTreeSet;
use std::error::Error;
use std::fmt::Display;
use std::path::Path;

use roulement::scene::machine::MachineScene;
use roulement::scene::system::SystemScene;
use roulement::schema::schedule::Schedule;
use roulement::schema::{AxialSeat, AxialTaken, MountingDirection, PointLoad, Stiffness, StiffnessSection};
use toml::{Table, Value};

use super::gearbox::{
    Bearing, Coupling, Disc, Duty, Gear, Gearbox, Kind, Load, Material, Mesh, STEEL, Section, Shaft, Springs,
};
use super::gears;

/// [-] by how much a disc may differ from a gear's body, by the digits of a file.
const SAME_BODY: f64 = 1e-3;

/// Reads a machine, and tells what of it the format does not have.
///
/// # Errors
/// If the file is refused, or has no machine that the format can hold.
pub fn gearbox(path: &Path, notes: &mut Vec<String>) -> Result<(Gearbox, Vec<Gearbox>), Box<dyn Error>> {
    let machine = MachineScene::load(path)?;
    let MachineScene::Shaft(scene) = &machine else {
        return Err(format!(
            "{}: a bearing alone: REXS files have gearboxes, write the file of a machine ([[shaft]])",
            path.display()
        )
        .into());
    };
    let table: Table = std::fs::read_to_string(path)?.parse()?;
    let own = of(scene, &table, notes)?;
    let mut cases = vec![];
    for of_duty in &scene.duty {
        let told = |why: &dyn Display| format!("duty {}: {why}", of_duty.name);
        match machine.under(of_duty).map_err(|why| told(&why))? {
            MachineScene::Shaft(changed) => cases.push(of(&changed, &table, &mut vec![])?),
            MachineScene::Bearing(_) => return Err(told(&"it is no machine any more").into()),
        }
    }
    Ok((own, cases))
}

/// Keys of a machine that are written, or say how it is simulated and not what it is; `*` is all below.
#[rustfmt::skip]
const WRITTEN: &[&str] = &[
    "title",
    "gravity",
    "load.*",
    "solver.*",
    "ranges.*",
    "duty.*",
    "shaft.name",
    "shaft.origin",
    "shaft.speed",
    "shaft.torque",
    "shaft.drive_position",
    "shaft.modes_up_to",
    "shaft.material.*",
    "shaft.section.*",
    "shaft.disc.position",
    "shaft.disc.mass",
    "shaft.disc.polar_inertia",
    "shaft.disc.transverse_inertia",
    "shaft.load.name",
    "shaft.load.position",
    "shaft.load.force",
    "shaft.load.moment",
    "mesh.name",
    "mesh.normal_module",
    "mesh.pressure_angle",
    "mesh.helix_angle",
    "mesh.gears.*",
    "bearing.name",
    "bearing.shaft",
    "bearing.catalogue",
    "bearing.set.bearing.diametral_clearance",
    "bearing.scene",
    "bearing.scene.*",
    "bearing.rollers.*",
    "bearing.mounting.position",
    "bearing.mounting.direction",
    "bearing.mounting.outer_shaft",
    "bearing.mounting.axial",
    "bearing.mounting.misalignment.*",
    "bearing.mounting.offset.*",
    "bearing.mounting.preload.displacement",
    "bearing.stiffness.radial",
    "bearing.stiffness.axial",
    "bearing.stiffness.axial_way",
    "bearing.stiffness.tilt",
    "coupling.name",
    "coupling.shafts",
    "coupling.position",
    "coupling.stiffness.radial",
    "coupling.stiffness.axial",
    "coupling.stiffness.tilt",
    "coupling.stiffness.torsion",
];

/// Tells of keys that are not written, each once.
fn not_written(table: &Table, notes: &mut Vec<String>) {
    let mut found = BTreeSet::new();
    table.iter().for_each(|(name, value)| look(value, name, &mut found));
    notes.extend(found.into_iter().map(|key| format!("not written: {key}")));
}

fn look(value: &Value, key: &str, found: &mut BTreeSet<String>) {
    let is_written = |of: &str| of.strip_suffix('*').map_or(key == of, |section| key.starts_with(section));
    if WRITTEN.iter().any(|of| is_written(of)) {
        return;
    }
    match value {
        Value::Table(table) => {
            table.iter().for_each(|(name, value)| look(value, &format!("{key}.{name}"), found));
        }
        Value::Array(entries) if entries.iter().all(Value::is_table) => {
            entries.iter().for_each(|entry| look(entry, key, found));
        }
        _ => {
            found.insert(key.to_owned());
        }
    }
}

/// The gearbox of a scene at time 0, whose bearings have the designations of a table.
fn of(scene: &SystemScene, table: &Table, notes: &mut Vec<String>) -> Result<Gearbox, String> {
    let mut found = Gearbox { title: scene.title.clone(), ..Gearbox::default() };
    let gravity = scene.gravity.at(0.0);
    found.gravity = (gravity.norm() > 0.0).then(|| gravity.into());
    not_written(table, notes);
    if scene.schedules().any(Schedule::is_scripted) {
        notes.push("not written: what changes over time; values at time 0 are".into());
    }
    for section in &scene.shafts {
        if section.section.is_empty() {
            return Err(format!(
                "shaft \"{}\": it has no beams ([[shaft.section]]), and shafts of REXS are made of sections",
                section.name
            ));
        }
        let material = &section.material;
        let material = Material {
            youngs_modulus: material.youngs_modulus.0,
            poisson_ratio: material.poisson_ratio,
            density: material.density.0,
        };
        let load = |of: &PointLoad| Load {
            name: of.name.clone(),
            position: of.position.0,
            force: of.force.at(0.0).into(),
            moment: of.moment.at(0.0).into(),
            ..Load::default()
        };
        let mut sections: Vec<Section> = section
            .section
            .iter()
            .map(|of| Section {
                from: of.from.0,
                to: of.to.0,
                outer: of.outer_diameter.0,
                inner: of.inner_diameter.map_or(0.0, |inner| inner.0),
            })
            .collect();
        sections.sort_by(|one, other| one.from.total_cmp(&other.from));
        found.shafts.push(Shaft {
            name: section.name.clone(),
            origin: section.place(0.0),
            way: 1.0,
            speed: section.speed.as_ref().map(|speed| speed.at(0.0)),
            torque: section.torque.as_ref().map(|torque| torque.at(0.0)),
            drive_position: section.drive_position.map(|position| position.0),
            material: (material != STEEL).then_some(material),
            sections,
            discs: section
                .disc
                .iter()
                .map(|of| Disc {
                    position: of.position.0,
                    mass: of.mass.0,
                    polar: of.polar_inertia.0,
                    transverse: of.transverse_inertia.0,
                })
                .collect(),
            loads: section.load.iter().map(load).collect(),
            ..Shaft::default()
        });
    }
    for mesh in &scene.meshes {
        let section = &mesh.section;
        let gear = |index: usize| {
            let of = &section.gears[index];
            Gear {
                shaft: mesh.shafts[index],
                position: of.position.0,
                teeth: of.teeth,
                inside: of.inside,
                face_width: of.face_width.0,
                profile_shift: of.profile_shift,
            }
        };
        found.meshes.push(Mesh {
            name: section.name.clone(),
            module: section.normal_module.0,
            pressure_angle: section.pressure_angle.map_or(20_f64.to_radians(), |angle| angle.0),
            helix_angle: section.helix_angle.map_or(0.0, |angle| angle.0),
            gears: [gear(0), gear(1)],
        });
    }
    bearings(scene, table, &mut found, notes);
    let mut bodies: Vec<Shaft> =
        found.shafts.iter().map(|of| Shaft { discs: vec![], ..of.clone() }).collect();
    gears::bodies(&found.meshes, &mut bodies);
    for (shaft, with_bodies) in found.shafts.iter().zip(&bodies) {
        // The body of a gear follows from the gear.
        let follows = |of: &Disc| {
            with_bodies.discs.iter().any(|body| {
                (of.position - body.position).abs() < 1e-9 && (of.mass / body.mass - 1.0).abs() < SAME_BODY
            })
        };
        for disc in shaft.discs.iter().filter(|of| !follows(of)) {
            let told = "which is no gear's body up to its reference cylinder";
            notes.push(format!(
                "not written: shaft \"{}\": disc at {} mm, {told}",
                shaft.name,
                disc.position * 1e3
            ));
        }
    }
    for of in &scene.duty {
        found.duty.push(Duty { name: of.name.clone(), share: of.part(), set: vec![] });
    }
    Ok(found)
}

/// A bearing in the file's own text.
fn entry<'a>(table: &'a Table, name: &str) -> Option<&'a Value> {
    let entries = table.get("bearing")?.as_array()?;
    entries.iter().find(|of| of.get("name").and_then(Value::as_str) == Some(name))
}

/// Its designation there.
fn designation(table: &Table, name: &str) -> Option<String> {
    Some(entry(table, name)?.get("catalogue")?.as_str()?.to_owned())
}

/// Does its x axis point along that of the shaft backwards?
fn is_reversed(table: &Table, name: &str) -> bool {
    let direction = entry(table, name).and_then(|of| of.get("mounting")?.get("direction")?.as_str());
    direction == Some("-x")
}

/// Does the text give a clearance in place of the catalogue's?
fn has_clearance(table: &Table, name: &str) -> bool {
    entry(table, name).and_then(|of| of.get("set")?.get("bearing")?.get("diametral_clearance")).is_some()
}

fn bearings(scene: &SystemScene, table: &Table, found: &mut Gearbox, notes: &mut Vec<String>) {
    for of in &scene.bearings {
        let mounting = &of.mounting;
        let (offset, misalignment) = mounting.bore();
        let kind = match designation(table, &of.name) {
            Some(name) => Kind::Catalogue(name),
            None => {
                let bearing = &of.scene.bearing;
                let mut geometry = Table::new();
                for (key, number) in [
                    ("balls", Some(bearing.balls as f64)),
                    ("ball_diameter", Some(bearing.ball_diameter.0)),
                    ("pitch_diameter", Some(bearing.pitch_diameter.0)),
                    ("inner_conformity", Some(bearing.inner_conformity)),
                    ("outer_conformity", Some(bearing.outer_conformity)),
                    ("contact_angle", bearing.contact_angle.map(|angle| angle.0)),
                    ("diametral_clearance", bearing.diametral_clearance.map(|clearance| clearance.0)),
                ] {
                    geometry.extend(number.map(|number| (key.to_owned(), Value::Float(number))));
                }
                Kind::Scene(geometry.to_string())
            }
        };
        if matches!(kind, Kind::Scene(_)) {
            notes.push(format!("not written: the scene of bearing \"{}\" but for its geometry", of.name));
        }
        found.bearings.push(Bearing {
            name: of.name.clone(),
            shaft: of.shaft,
            outer_shaft: of.outer_shaft,
            position: mounting.position.0,
            kind,
            held: mounting.axial == AxialSeat::Held,
            reversed: mounting.direction == MountingDirection::Against,
            clearance: of
                .scene
                .bearing
                .diametral_clearance
                .map(|of| of.0)
                .filter(|_| has_clearance(table, &of.name)),
            preload: mounting.preload.displacement.map_or(0.0, |way| way.0),
            offset: [offset.y, offset.z],
            misalignment: [misalignment.y, misalignment.z],
            ..Bearing::default()
        });
    }
    for of in &scene.springs {
        let kind = match (of.rollers.is_some(), designation(table, &of.name)) {
            (true, Some(name)) => Kind::Rollers(name),
            (true, None) => {
                notes.push(format!("not written: bearing \"{}\", rollers without a designation", of.name));
                continue;
            }
            (false, _) => Kind::Springs(springs(&of.stiffness, &of.name, notes)),
        };
        match of.second.filter(|_| of.is_coupling()) {
            Some(second) => found.couplings.push(Coupling {
                name: of.name.clone(),
                shafts: [of.shaft, second],
                position: of.position,
                springs: springs(&of.stiffness, &of.name, &mut vec![]),
                ..Coupling::default()
            }),
            None => found.bearings.push(Bearing {
                name: of.name.clone(),
                shaft: of.shaft,
                outer_shaft: of.second,
                position: of.position,
                kind,
                held: true,
                reversed: is_reversed(table, &of.name),
                offset: [of.bore.0.y, of.bore.0.z],
                misalignment: [of.bore.1.y, of.bore.1.z],
                ..Bearing::default()
            }),
        }
    }
}

/// Springs that are numbers; of tables it is told.
fn springs(of: &StiffnessSection, name: &str, notes: &mut Vec<String>) -> Springs {
    let ways = [&of.radial, &of.axial].map(|given| given.as_ref().map(Stiffness::number));
    let turns = [&of.tilt, &of.torsion].map(|given| given.as_ref().map(Stiffness::number));
    let numbers = [ways[0], ways[1], turns[0], turns[1]];
    if numbers.contains(&Some(None)) {
        notes.push(format!("not written: \"{name}\": a stiffness by a table"));
    }
    let [radial, axial, tilt, torsion] = numbers.map(|number| number.flatten().unwrap_or(0.0));
    let way = match of.axial_way {
        AxialTaken::Both => 0.0,
        AxialTaken::Along => 1.0,
        AxialTaken::Against => -1.0,
    };
    Springs { radial, axial, way, tilt, torsion }
}
