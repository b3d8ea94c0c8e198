//! Dimensions of a shaft, what is on it, where its bearings sit, and its housings, for drawings; and its motion.

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
        "shafts": shafts.iter().zip(system.shafts()).map(|(shaft, carrier)| {
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
                "gears": shaft.gear.iter().map(|gear| json!({
                    "position": along(gear.offset.0),
                    "pitch_radius": gear.pitch_radius.0,
                    "azimuth": gear.position.0,
                    "helix_angle": gear.helix_angle.0,
                    "teeth": gear.teeth,
                })).collect::<Vec<_>>(),
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
        "gravity": Vector3::from(*gravity).as_slice(),
    })
}

/// The columns of its table, of these rows.
pub fn columns(system: &System, rows: &[SystemOutputs]) -> Grid {
    let mut grid = Grid::new(rows.len());
    let values: Vec<Vec<f64>> = rows.iter().map(shaft::row).collect();
    for (index, (name, unit)) in shaft::columns(system.scene()).into_iter().enumerate() {
        grid.push(&name, unit, values.iter().map(|row| row[index]).collect());
    }
    grid
}
