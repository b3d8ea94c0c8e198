//! Meshes of a REXS model, and the bodies of gears.

use super::frame::{Axes, Frame};
use super::gearbox::{Disc, Gear, Mesh, Shaft};
use super::model::{Component, Model};
use super::names::Names;

/// [-] rim over the shaft's diameter below which a gear is cut into its shaft and has no body of its own.
const CUT_INTO_SHAFT: f64 = 0.25;

/// Meshes of cylindrical stages.
///
/// # Errors
/// Names the component, and what is missing.
pub fn meshes(
    model: &Model,
    shafts: &[Shaft],
    axes: &Axes,
    names: &mut Names,
    notes: &mut Vec<String>,
) -> Result<Vec<Mesh>, String> {
    let mut found = vec![];
    for relation in model.related("stage") {
        let part = |role: &str| relation.role(role).and_then(|id| model.components.get(&id));
        let (Some(stage), Some(one), Some(other)) = (part("stage"), part("gear_1"), part("gear_2")) else {
            continue;
        };
        if stage.kind != "cylindrical_stage" {
            continue;
        }
        let mut pair = [one, other];
        if pair[0].kind == "ring_gear" {
            pair.reverse();
        }
        let on_shaft = pair.iter().all(|gear| shaft_of(model, gear, shafts).is_some());
        if !on_shaft || pair[0].kind == "ring_gear" {
            notes.push(format!("{stage}: not simulated: its gears are not two on shafts of the machine"));
            continue;
        }
        let [first, second] = pair;
        let gear = |of: &Component| gear(model, of, shafts, axes);
        let mut mesh = Mesh {
            name: names.of(stage, "mesh"),
            module: needed(first, second, "normal_module")?,
            pressure_angle: pressure_angle(model, first)?
                .or(pressure_angle(model, second)?)
                .unwrap_or(20_f64.to_radians()),
            helix_angle: first.number("helix_angle_reference_diameter")?.unwrap_or(0.0),
            gears: [gear(first)?, gear(second)?],
        };
        for (index, of) in pair.iter().enumerate() {
            if mesh.gears[index].face_width == 0.0 {
                mesh.gears[index].face_width = stage
                    .number("common_face_width")?
                    .ok_or_else(|| format!("{of}: face_width is missing"))?;
            }
        }
        shifts(model, stage, &pair, &mut mesh, shafts, notes)?;
        found.push(mesh);
    }
    Ok(found)
}

/// A number of either gear of a pair.
fn needed(one: &Component, other: &Component, key: &str) -> Result<f64, String> {
    match one.number(key)?.or(other.number(key)?) {
        Some(number) => Ok(number),
        None => one.needed(key),
    }
}

/// Flanks of a gear, left and right.
fn flanks<'a>(model: &'a Model, gear: &'a Component) -> impl Iterator<Item = &'a Component> {
    model
        .related("flank")
        .filter(|of| of.role("gear") == Some(gear.id))
        .flat_map(|of| [of.role("left"), of.role("right")])
        .filter_map(|id| model.components.get(&id?))
}

/// [rad] pressure angle of a gear's flanks.
fn pressure_angle(model: &Model, gear: &Component) -> Result<Option<f64>, String> {
    of_flanks(model, gear, "normal_pressure_angle")
}

/// A number of a gear, or of its flanks.
fn of_flanks(model: &Model, gear: &Component, key: &str) -> Result<Option<f64>, String> {
    let mut found = gear.number(key)?;
    for flank in flanks(model, gear) {
        found = found.or(flank.number(key)?);
    }
    Ok(found)
}

/// Index of a gear's shaft.
fn shaft_of(model: &Model, gear: &Component, shafts: &[Shaft]) -> Option<usize> {
    let shaft = model.assembly_of(gear.id, "shaft")?;
    shafts.iter().position(|of| of.id == shaft.id)
}

fn gear(model: &Model, of: &Component, shafts: &[Shaft], axes: &Axes) -> Result<Gear, String> {
    let shaft = shaft_of(model, of, shafts).ok_or_else(|| format!("{of}: it is on no shaft"))?;
    let face_width = of.number("face_width")?.unwrap_or(0.0);
    let teeth = of.needed("number_of_teeth")?.abs();
    if !(1.0..=10_000.0).contains(&teeth) || teeth.fract() != 0.0 {
        return Err(format!("{of}: number_of_teeth {teeth}: allowed is [1, 10000]"));
    }
    // Where it is said in space, it is the middle of the teeth in all versions; along the shaft it is that from 1.1 on, and the beginning in 1.0.
    let position = match Frame::of(of, model)? {
        Some(frame) => axes.turned(&frame.origin).x - shafts[shaft].origin[0],
        None => {
            let middle = if model.version == "1.0" { face_width / 2.0 } else { 0.0 };
            shafts[shaft].position(of.needed("u_coordinate_on_shaft")? + middle)
        }
    };
    Ok(Gear {
        shaft,
        position,
        teeth: teeth as u32,
        inside: of.kind == "ring_gear",
        face_width,
        profile_shift: 0.0,
    })
}

/// Profile shifts: those of the flanks, or what the distance of both axes asks for.
fn shifts(
    model: &Model,
    stage: &Component,
    pair: &[&Component; 2],
    mesh: &mut Mesh,
    shafts: &[Shaft],
    notes: &mut Vec<String>,
) -> Result<(), String> {
    let key = "addendum_modification_coefficient";
    let given = [of_flanks(model, pair[0], key)?, of_flanks(model, pair[1], key)?];
    let [one, other] = match given {
        [Some(one), Some(other)] => [one, other],
        _ => {
            let [from, to] = mesh.gears.map(|gear| shafts[gear.shaft].origin);
            let distance = (to[1] - from[1]).hypot(to[2] - from[2]);
            let sum = sum_of_shifts(mesh, distance).ok_or_else(|| {
                format!("{stage}: the axes are {:.4} mm apart, where its teeth do not reach", distance * 1e3)
            })?;
            notes.push(format!("{stage}: profile shifts follow from the distance of both axes"));
            match given {
                [Some(one), None] => [one, sum - one],
                [None, Some(other)] => [sum - other, other],
                _ => [sum / 2.0, sum / 2.0],
            }
        }
    };
    [mesh.gears[0].profile_shift, mesh.gears[1].profile_shift] = [one, other];
    Ok(())
}

/// [-] sum of both profile shifts for a distance \[m] without play, teeth of a ring counted as negative (ISO 21771: involutes of the working and of the own
/// pressure angle).
fn sum_of_shifts(mesh: &Mesh, distance: f64) -> Option<f64> {
    let [one, other] =
        mesh.gears.map(|gear| if gear.inside { -f64::from(gear.teeth) } else { f64::from(gear.teeth) });
    let teeth = one + other;
    let normal = mesh.pressure_angle.tan();
    let own = (normal / mesh.helix_angle.cos()).atan();
    let without = teeth.abs() * mesh.module / mesh.helix_angle.cos() / 2.0;
    let cosine = without * own.cos() / distance;
    let involute = |angle: f64| angle.tan() - angle;
    (cosine < 1.0).then(|| teeth * (involute(cosine.acos()) - involute(own)) / (2.0 * normal))
}

/// Bodies of gears up to their reference cylinders, on their shafts.
pub fn bodies(meshes: &[Mesh], shafts: &mut [Shaft]) {
    let mut done: Vec<(usize, f64)> = vec![];
    for mesh in meshes {
        for gear in mesh.gears {
            // A gear that meshes with several has one body.
            let is_there =
                done.iter().any(|(shaft, at)| *shaft == gear.shaft && (at - gear.position).abs() < 1e-9);
            if is_there {
                continue;
            }
            done.push((gear.shaft, gear.position));
            let shaft = &mut shafts[gear.shaft];
            let reference = mesh.module * f64::from(gear.teeth) / mesh.helix_angle.cos();
            let section = shaft.sections.iter().find(|of| of.from <= gear.position && gear.position <= of.to);
            let diameter = section.map_or(0.0, |of| of.outer);
            // A ring's body is what its shaft is drawn as.
            if gear.inside || reference < diameter * (1.0 + CUT_INTO_SHAFT) {
                continue;
            }
            let [outer, inner] = [reference, diameter].map(|of| of * of / 4.0);
            let mass = shaft.gear_density() * std::f64::consts::PI * (outer - inner) * gear.face_width;
            let polar = mass * (outer + inner) / 2.0;
            let transverse = polar / 2.0 + mass * gear.face_width * gear.face_width / 12.0;
            shaft.discs.push(Disc { position: gear.position, mass, polar, transverse });
        }
    }
}
