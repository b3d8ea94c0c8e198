//! What acts on the shaft of a system at a time: its weight, loads at points, unbalance, and its drive.

use nalgebra::{Vector3, Vector6};

use super::first_stations;
use super::inputs::Given;
use crate::dynamics::system::StructureLoad;
use crate::model::state::stack;
use crate::model::structure::{Shaft, Spin, StructureState, Turning};
use crate::scene::Schedule;

/// Load of the shaft at a time \[s]. Where its turn is a coordinate, the direction of unbalance follows it from the state it had.
pub fn at(given: &Given<'_>, shaft: &Shaft, state: &StructureState, from: f64, time: f64) -> StructureLoad {
    let scene = given.scene;
    let structure = &shaft.structure;
    let free = structure.turning == Turning::Free;
    let spin = if free { ahead(&state.spin, time - from) } else { given.spin(time) };
    let [loads, _, discs] = first_stations(scene);
    let mut force = structure.weight(&scene.gravity);
    let mut axial_moment = 0.0;
    let mut add = |station: usize, on: Vector6<f64>| {
        force += shaft.stations[station].tr_mul(&on);
        axial_moment += on[3];
    };
    for index in 0..scene.shaft.load.len() {
        add(loads + index, given.load(index, time));
    }
    for (index, disc) in scene.shaft.disc.iter().enumerate() {
        if let Some(unbalance) = disc.unbalance {
            let azimuth = spin.angle + disc.unbalance_azimuth.map_or(0.0, |azimuth| azimuth.0);
            let (sin, cos) = azimuth.sin_cos();
            let outward = Vector3::new(0.0, cos, sin);
            let along = Vector3::new(0.0, -sin, cos);
            let inertial = outward * (spin.speed * spin.speed) - along * spin.acceleration;
            add(discs + index, stack(&(inertial * unbalance.0), &Vector3::zeros()));
        }
    }
    if free {
        let last = force.len() - 1;
        force[last] += given.torque(time);
    }
    StructureLoad { force, spin, axial_moment }
}

/// A turn that goes on as it is.
fn ahead(spin: &Spin, duration: f64) -> Spin {
    let speed = spin.speed + spin.acceleration * duration;
    Spin { angle: spin.angle + 0.5 * (spin.speed + speed) * duration, speed, ..*spin }
}

/// \[s] times at which a table of the shaft's loads or drive bends, of those that are played.
pub fn knots(given: &Given<'_>, from: f64, to: f64) -> Vec<f64> {
    let shaft = &given.scene.shaft;
    let played = shaft.load.iter().enumerate().filter(|(index, _)| given.plays_load(*index));
    let components = played.flat_map(|(_, load)| load.force.0.iter().chain(&load.moment.0));
    let drive = [&shaft.speed, &shaft.torque].into_iter().flatten().filter(|_| given.plays_drive());
    let schedules = components.chain(drive);
    schedules.flat_map(|schedule: &Schedule| schedule.knots(from, to)).collect()
}
