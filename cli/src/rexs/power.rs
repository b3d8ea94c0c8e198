//! Speeds and torques of a REXS model: which shafts are driven, and what follows from the teeth.

use std::f64::consts::PI;

use super::gearbox::{Coupling, Mesh, Shaft};
use super::model::{Component, Model};

/// [-] power that may be left over, of the largest, by the digits of a file.
const BALANCED: f64 = 1e-3;

/// Drives of all shafts: speeds [rad/s] and torques [N m] by their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drives {
    /// Speeds that are given: one of each train.
    pub speeds: Vec<Option<f64>>,
    /// Torques about x, given or found.
    pub torques: Vec<Option<f64>>,
}

/// Turns of all shafts by trains, each a list of shafts with their turns in one turn of its first.
fn trains(shafts: usize, meshes: &[Mesh], couplings: &[Coupling]) -> Vec<Vec<(usize, f64)>> {
    let mut joints: Vec<(usize, usize, f64)> =
        meshes.iter().map(|mesh| (mesh.gears[0].shaft, mesh.gears[1].shaft, mesh.ratio())).collect();
    let stiff = couplings.iter().filter(|of| of.springs.torsion > 0.0);
    joints.extend(stiff.map(|of| (of.shafts[0], of.shafts[1], 1.0)));
    let mut seen = vec![false; shafts];
    let mut found = vec![];
    for first in 0..shafts {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        let mut train = vec![(first, 1.0)];
        let mut next = 0;
        while let Some((shaft, turns)) = train.get(next).copied() {
            next += 1;
            for (one, other, ratio) in &joints {
                let (to, ratio) = match shaft {
                    _ if shaft == *one => (*other, *ratio),
                    _ if shaft == *other => (*one, 1.0 / ratio),
                    _ => continue,
                };
                if !std::mem::replace(&mut seen[to], true) {
                    train.push((to, turns * ratio));
                }
            }
        }
        found.push(train);
    }
    found
}

/// Attribute holders of a component: what a load case says of it, then what the file does.
fn said<'a>(component: &'a Component, case: &'a [Component]) -> impl Iterator<Item = &'a Component> {
    case.iter().filter(|of| of.id == component.id).chain([component])
}

/// A number of a component in a load case.
fn number(component: &Component, case: &[Component], key: &str) -> Result<Option<f64>, String> {
    for of in said(component, case) {
        if let Some(number) = of.number(key)? {
            return Ok(Some(number));
        }
    }
    Ok(None)
}

/// Drives in a load case (none: those of the file itself).
///
/// # Errors
/// Names the component whose numbers cannot be read.
pub fn drives(
    model: &Model,
    case: &[Component],
    shafts: &[Shaft],
    meshes: &[Mesh],
    couplings: &[Coupling],
    notes: &mut Vec<String>,
) -> Result<Drives, String> {
    let mut found = Drives { speeds: vec![None; shafts.len()], torques: vec![None; shafts.len()] };
    for train in trains(shafts.len(), meshes, couplings) {
        let mut speed: Option<(usize, f64)> = None;
        let (mut power, mut largest, mut open) = (0.0, 0.0_f64, vec![]);
        let mut with_power = vec![];
        for (shaft, turns) in &train {
            let Some(component) = model.components.get(&shafts[*shaft].id) else { continue };
            if let Some(given) =
                number(component, case, "rotational_speed")?.map(|given| given * shafts[*shaft].way)
            {
                let defines = component.text("defines_speed") != Some("false");
                match speed {
                    None if defines => speed = Some((*shaft, given)),
                    Some((first, of_first)) if defines && case.is_empty() => {
                        let own =
                            train.iter().find(|(shaft, _)| *shaft == first).map_or(1.0, |(_, turns)| *turns);
                        let follows = of_first / own * turns;
                        if (given - follows).abs() > BALANCED * follows.abs() {
                            notes.push(format!(
                                "{component}: its speed of {:.4} rpm is not the {:.4} rpm that follow from the teeth: the latter here",
                                given * 30.0 / PI,
                                follows * 30.0 / PI
                            ));
                        }
                    }
                    _ => {}
                }
            }
            for load in model.parts(component.id, "external_load") {
                if load.text("transmits_torque") == Some("false") {
                    continue;
                }
                let torque = number(load, case, "torque_around_u_axis")?
                    .filter(|_| load.text("defines_torque") != Some("false"));
                let carries = load.is("transmits_torque") || torque.is_some_and(|torque| torque != 0.0);
                match torque {
                    Some(torque) => {
                        let torque = torque * shafts[*shaft].way;
                        found.torques[*shaft] = Some(found.torques[*shaft].unwrap_or(0.0) + torque);
                        power += torque * turns;
                        largest = largest.max((torque * turns).abs());
                    }
                    None => match number(load, case, "power")? {
                        Some(given) if given != 0.0 => with_power.push((*shaft, *turns, given)),
                        _ if carries => open.push((*shaft, *turns)),
                        _ => {}
                    },
                }
            }
        }
        if let Some((of, speed)) = speed {
            let own = train.iter().find(|(shaft, _)| *shaft == of).map_or(1.0, |(_, turns)| *turns);
            for (shaft, turns, given) in with_power {
                let torque = given / (speed / own * turns);
                found.torques[shaft] = Some(found.torques[shaft].unwrap_or(0.0) + torque);
                power += torque * turns;
                largest = largest.max((torque * turns).abs());
            }
            found.speeds[of] = Some(speed);
        }
        match open.as_slice() {
            [] => {
                let is_left = largest > 0.0 && power.abs() > BALANCED * largest && train.len() > 1;
                if is_left && speed.is_none() {
                    notes.push(format!(
                        "torques of the train of {} are not in balance: it speeds up",
                        shafts[train[0].0].name
                    ));
                }
            }
            [(shaft, turns)] => {
                found.torques[*shaft] = Some(found.torques[*shaft].unwrap_or(0.0) - power / turns);
            }
            several => {
                // The shaft with the speed takes what is left of all.
                for (shaft, _) in several.iter().filter(|(shaft, _)| speed.is_none_or(|(of, _)| of != *shaft))
                {
                    notes.push(format!("{}: no torque is given: 0 here", shafts[*shaft].name));
                }
            }
        }
        if let Some((of, _)) = speed {
            // What holds a speed is a result.
            found.torques[of] = None;
        } else if largest > 0.0 {
            notes.push(format!(
                "no speed is given for the train of {}: it starts from rest",
                shafts[train[0].0].name
            ));
        }
    }
    Ok(found)
}

/// \[m] positions at which the shafts are driven: of the load that transmits torque.
///
/// # Errors
/// Names the component whose numbers cannot be read.
pub fn positions(model: &Model, shafts: &mut [Shaft]) -> Result<(), String> {
    for shaft in shafts {
        for load in model.parts(shaft.id, "external_load") {
            if load.is("transmits_torque")
                || load.number("torque_around_u_axis")?.is_some_and(|torque| torque != 0.0)
            {
                shaft.drive_position = load.number("u_coordinate_on_shaft")?.map(|own| shaft.position(own));
            }
        }
    }
    Ok(())
}
