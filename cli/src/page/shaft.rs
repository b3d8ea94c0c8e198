//! Dimensions of a shaft, what is on it, where its bearings and links sit, and its housings, for drawings; and its motion.

use nalgebra::Vector3;
use roulement::scene::system::SystemScene;
use roulement::schema::Components;
use roulement::schema::units::{Force, Length};
use roulement::simulation::system::{System, SystemOutputs};
use serde_json::{Value, json};

use super::bearing::{self, schedule};
use super::grid::Grid;
use crate::report::shaft;

/// All of it; lengths \[m], angles \[rad], positions along all shafts. Each bearing has its own dimensions with it: a sweep keeps the record of a shaft alone.
pub fn describe(system: &System) -> Value {
    let SystemScene { shafts, housings, bearings, gravity, .. } = system.scene();
    let place = |place: &[Length; 3]| place.map(|length| length.0);
    let force = |force: &Components<Force>| force.0.each_ref().map(schedule);
    json!({
        "shafts": shafts.iter().zip(system.shafts()).enumerate().map(|(index, (shaft, carrier))| {
            let along = |position: f64| shaft.place(position)[0];
            json!({
                "name": shaft.name,
                "modes": carrier.modes,
                "sections": shaft.section.iter().map(|beam| json!({
                    "from": along(beam.from.0),
                    "to": along(beam.to.0),
                    "outer_diameter": beam.outer_diameter.0,
                    "inner_diameter": beam.inner_diameter.map_or(0.0, |diameter| diameter.0),
                })).collect::<Vec<_>>(),
                "discs": shaft.disc.iter().map(|disc| json!({
                    "position": along(disc.position.0),
                    "mass": disc.mass.0,
                    "polar_inertia": disc.polar_inertia.0,
                    "unbalance": disc.unbalance.map_or(0.0, |unbalance| unbalance.0),
                })).collect::<Vec<_>>(),
                "axis": shaft.place(0.0)[1..],
                "gears": gears(system.scene(), index),
                "loads": shaft.load.iter().map(|load| json!({
                    "name": load.name,
                    "position": along(load.position.0),
                    "force": force(&load.force),
                })).collect::<Vec<_>>(),
                "points": shaft.point.iter().map(|point| json!({ "name": point.name, "position": along(point.position.0) })).collect::<Vec<_>>(),
            })
        }).collect::<Vec<_>>(),
        "bearings": bearings.iter().zip(system.bearings()).enumerate().map(|(index, (mounted, (_, own)))| json!({
            "name": mounted.name,
            "position": shafts[mounted.shaft].place(mounted.mounting.position.0)[0],
            "shaft": shafts[mounted.shaft].name,
            "direction": mounted.mounting.direction.sign(),
            "housing": system.scene().housing_of(index).map(|housing| &housings[housing].name),
            "bearing": bearing::describe(own.scene(), own.model()),
        })).collect::<Vec<_>>(),
        "links": system.scene().springs.iter().map(|link| json!({
            "name": link.name,
            "position": shafts[link.shaft].place(link.position)[0],
            "shaft": shafts[link.shaft].name,
            "with": link.second.map(|second| &shafts[second].name),
            "direction": link.rollers.as_ref().and_then(|rollers| rollers.geometry().taper).map_or(1.0, |taper| taper.direction),
            "rollers": link.rollers.as_ref().map(|rollers| {
                let of = rollers.geometry();
                json!({
                    "count": of.count,
                    "diameter": of.diameter,
                    "length": of.length,
                    "pitch_diameter": of.pitch_diameter,
                    "contact_angle": of.taper.map_or(0.0, |taper| taper.contact_angle),
                    "roller_angle": of.taper.map_or(0.0, |taper| taper.roller_angle),
                })
            }),
        })).collect::<Vec<_>>(),
        "housings": housings.iter().map(|housing| json!({
            "name": housing.name,
            "centre": housing.centre.as_ref().map(place),
            "feet": housing.foot.iter().map(|foot| place(&foot.position)).collect::<Vec<_>>(),
            "loads": housing.load.iter().map(|load| json!({
                "name": load.name,
                "position": place(&load.position),
                "force": force(&load.force),
            })).collect::<Vec<_>>(),
            "points": housing.point.iter().map(|point| json!({
                "name": point.name,
                "position": place(&point.position),
            })).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "meshes": system.scene().meshes.iter().map(|mesh| &mesh.section.name).collect::<Vec<_>>(),
        "gravity": gravity.at(0.0).as_slice(),
    })
}

/// Gears on a shaft, those in a mesh with their place and width: the azimuth is that of the pitch point, which the other gear is beyond.
fn gears(scene: &SystemScene, index: usize) -> Vec<Value> {
    let shaft = &scene.shafts[index];
    let axis = Vector3::from(shaft.place(0.0));
    let driven = shaft.gear.iter().map(|gear| {
        json!({
            "position": shaft.place(gear.offset.0)[0],
            "pitch_radius": gear.pitch_radius.0,
            "azimuth": gear.position.0,
            "helix_angle": gear.helix_angle.0,
            "teeth": gear.teeth,
        })
    });
    let meshed = scene.meshes.iter().flat_map(|mesh| (0..2).map(move |end| (mesh, end)));
    let meshed = meshed.filter(|(mesh, end)| mesh.shafts[*end] == index).map(|(mesh, end)| {
        let (gear, pair) = (&mesh.section.gears[end], mesh.pair(scene));
        let arm = mesh.place(scene) - axis;
        json!({
            "position": shaft.place(gear.position.0)[0],
            "pitch_radius": pair.pitch_radii()[end].abs(),
            "azimuth": arm.z.atan2(arm.y),
            "helix_angle": if end == 0 { pair.helix_angle } else { -pair.helix_angle },
            "teeth": gear.teeth,
            "face_width": gear.face_width.0,
            "mesh": mesh.section.name,
            "with": scene.shafts[mesh.shafts[1 - end]].name,
        })
    });
    driven.chain(meshed).collect()
}

/// The columns of its table, of these rows.
pub fn columns(system: &System, rows: &[SystemOutputs]) -> Grid {
    let mut grid = Grid::new(rows.len());
    let values: Vec<Vec<f64>> = rows.iter().map(|row| shaft::row(system.scene(), row)).collect();
    for (index, (name, unit)) in shaft::columns(system.scene()).into_iter().enumerate() {
        grid.push(&name, unit, values.iter().map(|row| row[index]).collect());
    }
    grid
}
