//! What acts on the structures of a system at a time: weight, loads at points, unbalance and drive of its shaft.

use std::f64::consts::TAU;

use nalgebra::Vector6;

use super::inputs::{Given, Played, ShaftInputs, ShaftPaths};
use super::{first_stations, housing_stations};
use crate::dynamics::system::StructureLoad;
use crate::loads::{Mesh, unbalance as unbalance_of};
use crate::model::state::stack;
use crate::model::structure::{Carrier, Spin, StructureState, Turning};
use crate::numerics::motion::Wrench;
use crate::scene::system::SystemScene;
use crate::scene::{GearSection, Schedule};

/// Loads of the shaft and the housings at a time \[s]. Where the shaft's turn is a coordinate, the direction of unbalance follows it
/// from the state it had.
pub fn at(
    given: &Given<'_>,
    carriers: &[Carrier],
    state: &StructureState,
    from: f64,
    time: f64,
) -> Vec<StructureLoad> {
    let mut first = given.scene.shaft.load.len();
    let housings = given.scene.housings.iter().zip(&carriers[1..]).enumerate();
    let of_housings = housings.map(|(index, (housing, carrier))| {
        let mut force = carrier.structure.weight(&given.scene.gravity);
        let [loads, _] = housing_stations(given.scene, index);
        for own in 0..housing.load.len() {
            force += carrier.stations[loads + own].tr_mul(&given.load(first + own, time));
        }
        first += housing.load.len();
        StructureLoad { force, spin: Spin::default(), axial_moment: 0.0 }
    });
    let of_shaft = on_shaft(given, &carriers[0], state, from, time);
    let ground = carriers.get(given.scene.housings.len() + 1).map(|ground| StructureLoad {
        force: ground.structure.weight(&given.scene.gravity),
        spin: Spin::default(),
        axial_moment: 0.0,
    });
    [of_shaft].into_iter().chain(of_housings).chain(ground).collect()
}

fn on_shaft(
    given: &Given<'_>,
    shaft: &Carrier,
    state: &StructureState,
    from: f64,
    time: f64,
) -> StructureLoad {
    let scene = given.scene;
    let structure = &shaft.structure;
    let free = structure.turning == Turning::Free;
    let spin = if free { ahead(&state.spin, time - from) } else { given.spin(time) };
    let [loads, _, discs, gears] = first_stations(scene);
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
            let Wrench { force, moment } =
                unbalance_of(unbalance.0, azimuth, spin.speed, spin.acceleration, 0.0);
            add(discs + index, stack(&force, &moment));
        }
    }
    for (index, gear) in scene.shaft.gear.iter().enumerate() {
        // The pitch point is in the plane of its station.
        let mesh = Mesh { offset: 0.0, ..gear.mesh() };
        let factor = gear.ripple().map_or(1.0, |ripple| ripple.factor(spin.angle));
        let Wrench { force, moment } = mesh.wrench(given.gear(index, time) * factor);
        add(gears + index, stack(&force, &moment));
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

/// Schedules of named loads and the drive that are played.
fn schedules<'a>(given: &Given<'a>) -> Vec<&'a Schedule> {
    let shaft = &given.scene.shaft;
    let played = given.scene.loads().enumerate().filter(|(index, _)| given.plays_load(*index));
    let components = played.flat_map(|(_, load)| load.force.0.iter().chain(&load.moment.0));
    let drive = [&shaft.speed, &shaft.torque].into_iter().flatten().filter(|_| given.plays_drive());
    let gears = shaft.gear.iter().enumerate().filter(|(index, _)| given.plays_gear(*index));
    components.chain(drive).chain(gears.map(|(_, gear)| &gear.torque)).collect()
}

/// Does a load or the drive of a scene come to other values within a span \[s] of time?
pub fn script_changes_within(scene: &SystemScene, from: f64, to: f64) -> bool {
    let inputs = ShaftInputs::scripted(scene, from);
    let (paths, played) = (ShaftPaths::steady(&inputs, from, 0.0), Played::all(scene));
    let given = Given { scene, paths: &paths, played: &played };
    schedules(&given).into_iter().any(|schedule| schedule.changes_within(from, to))
}

/// \[s] times at which a table of a load or of the drive bends, of those that are played.
pub fn knots(given: &Given<'_>, from: f64, to: f64) -> Vec<f64> {
    schedules(given).into_iter().flat_map(|schedule| schedule.knots(from, to)).collect()
}

/// \[s] shortest period in which a load swings, from a script or as the shaft turns; none where none does.
pub fn shortest_period(given: &Given<'_>, state: &StructureState, time: f64) -> Option<f64> {
    let shaft = &given.scene.shaft;
    let scripted = schedules(given).into_iter().filter_map(|schedule| schedule.shortest_period(time));
    let per_turn = shaft.disc.iter().filter(|disc| disc.unbalance.is_some()).map(|_| 1.0);
    let meshes = shaft.gear.iter().filter_map(GearSection::ripple).map(|ripple| ripple.teeth);
    let speed = state.spin.speed.abs();
    let turning = per_turn.chain(meshes).filter(|_| speed > 0.0).map(|times| TAU / (times * speed));
    scripted.chain(turning).reduce(f64::min)
}
