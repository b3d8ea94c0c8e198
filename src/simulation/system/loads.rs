//! Loads on the structures of a system at a time: weight, loads at points, unbalance and drive of its shafts.

use std::f64::consts::TAU;

use nalgebra::{Vector3, Vector6};

use super::super::path::Motion;
use super::inputs::{Field, Given, Played, ShaftInputs, ShaftPaths};
use super::{first_stations, housing_stations};
use crate::dynamics::system::StructureLoad;
use crate::effects::frame::FrameSection;
use crate::loads::{Mesh, unbalance as unbalance_of};
use crate::model::state::stack;
use crate::model::structure::{Carrier, Spin, StructureState, Turning};
use crate::numerics::motion::Wrench;
use crate::scene::system::SystemScene;
use crate::scene::{GearSection, RotatingSection, Schedule};

/// Loads of the shafts, the housings and the ground at a time \[s]. Where the turn of a shaft is a coordinate, the direction of unbalance
/// follows it from the state it had.
pub fn at(
    given: &Given<'_>,
    carriers: &[Carrier],
    states: &[StructureState],
    from: f64,
    time: f64,
) -> Vec<StructureLoad> {
    let scene = given.scene;
    let count = scene.shafts.len();
    let Field { acceleration, turning } = given.field(time);
    // Loads, gears and given motions of structures that went before.
    let mut before = [0; 3];
    let of_shafts = carriers.iter().zip(states).take(count).enumerate().map(|(shaft, (carrier, state))| {
        let load = on_shaft(given, (shaft, before), (carrier, state), acceleration, [from, time]);
        before[0] += scene.shafts[shaft].load.len();
        before[1] += scene.shafts[shaft].gear.len();
        before[2] += load.held.len();
        load
    });
    let of_shafts: Vec<_> = of_shafts.collect();
    let [mut first, _, mut first_motion] = before;
    let housings = given.scene.housings.iter().zip(&carriers[count..]).enumerate();
    let of_housings = housings.map(|(index, (housing, carrier))| {
        let mut force = carrier.structure.weight(&acceleration);
        let [loads, _] = housing_stations(given.scene, index);
        for own in 0..housing.load.len() {
            force += carrier.stations[loads + own].tr_mul(&given.load(first + own, time));
        }
        first += housing.load.len();
        let held = held(given, (count + index, first_motion), time);
        first_motion += held.len();
        StructureLoad { force, spin: Spin::default(), axial_moment: 0.0, frame: None, held }
    });
    let ground = carriers.get(scene.housings.len() + count).map(|ground| StructureLoad {
        force: ground.structure.weight(&acceleration),
        spin: Spin::default(),
        axial_moment: 0.0,
        frame: None,
        held: vec![],
    });
    let all = of_shafts.into_iter().chain(of_housings).chain(ground);
    all.map(|load| StructureLoad { frame: turning, ..load }).collect()
}

/// Motions that are given of a structure, of which those of others go before.
fn held(given: &Given<'_>, (structure, first): (usize, usize), time: f64) -> Vec<[f64; 3]> {
    let motions = given.scene.held(structure).enumerate();
    let motions = motions.map(|(index, _)| given.motion(first + index, time));
    motions.map(|Motion { value, rate, acceleration }| [value, rate, acceleration]).collect()
}

/// Loads of a shaft, with the loads, gears and given motions of shafts that go before it.
fn on_shaft(
    given: &Given<'_>,
    (shaft, [first_load, first_gear, first_motion]): (usize, [usize; 3]),
    (carrier, state): (&Carrier, &StructureState),
    acceleration: Vector3<f64>,
    [from, time]: [f64; 2],
) -> StructureLoad {
    let scene = given.scene;
    let section = &scene.shafts[shaft];
    let structure = &carrier.structure;
    let free = structure.turning == Turning::Free;
    let spin = if free { ahead(&state.spin, time - from) } else { given.spin(shaft, time) };
    let [loads, _, discs, gears, rotating] = first_stations(scene, shaft);
    let mut force = structure.weight(&acceleration);
    let mut axial_moment = 0.0;
    let mut add = |station: usize, on: Vector6<f64>| {
        force += carrier.stations[station].tr_mul(&on);
        axial_moment += on[3];
    };
    for index in 0..section.load.len() {
        add(loads + index, given.load(first_load + index, time));
    }
    for (index, disc) in section.disc.iter().enumerate() {
        if let Some(unbalance) = disc.unbalance {
            let azimuth = spin.angle + disc.unbalance_azimuth.map_or(0.0, |azimuth| azimuth.0);
            let Wrench { force, moment } =
                unbalance_of(unbalance.0, azimuth, spin.speed, spin.acceleration, 0.0);
            add(discs + index, stack(&force, &moment));
        }
    }
    for (index, gear) in section.gear.iter().enumerate() {
        // The pitch point is in the plane of its station.
        let mesh = Mesh { offset: 0.0, ..gear.mesh() };
        let factor = gear.ripple().map_or(1.0, |ripple| ripple.factor(spin.angle));
        let Wrench { force, moment } = mesh.wrench(given.gear(first_gear + index, time) * factor);
        add(gears + index, stack(&force, &moment));
    }
    for (index, part) in section.rotating.iter().enumerate() {
        let Wrench { force, moment } = part.on_shaft([spin.angle, spin.speed, spin.acceleration], time);
        add(rotating + index, stack(&force, &moment));
    }
    if free {
        let last = force.len() - 1;
        force[last] += given.torque(shaft, time);
    }
    StructureLoad { force, spin, axial_moment, frame: None, held: held(given, (shaft, first_motion), time) }
}

/// A turn that goes on as it is.
fn ahead(spin: &Spin, duration: f64) -> Spin {
    let speed = spin.speed + spin.acceleration * duration;
    Spin { angle: spin.angle + 0.5 * (spin.speed + speed) * duration, speed, ..*spin }
}

/// Schedules of named loads, drives, given motions, the frame and gravity that are played; those of forces that turn always are.
fn schedules<'a>(given: &Given<'a>) -> Vec<&'a Schedule> {
    let scene = given.scene;
    let played = given.scene.loads().enumerate().filter(|(index, _)| given.plays_load(*index));
    let components = played.flat_map(|(_, load)| load.force.0.iter().chain(&load.moment.0));
    let driven = scene.shafts.iter().enumerate().filter(|(shaft, _)| given.plays_drive(*shaft));
    let drive = driven.flat_map(|(_, shaft)| shaft.speed.iter().chain(&shaft.torque));
    let gears = scene.gears().enumerate().filter(|(index, _)| given.plays_gear(*index));
    let frame = scene.frame.iter().filter(|_| given.plays_frame()).flat_map(FrameSection::schedules);
    let gravity = scene.gravity.0.iter().filter(|_| scene.frame.is_none() || given.plays_frame());
    let rotating = scene.rotating().flat_map(RotatingSection::schedules);
    let held = scene.motions().enumerate().filter(|(index, _)| given.plays_motion(*index));
    let held = held.map(|(_, (_, (.., schedule)))| schedule);
    let loads = components.chain(gears.map(|(_, gear)| &gear.torque)).chain(rotating);
    loads.chain(held).chain(drive).chain(frame).chain(gravity).collect()
}

/// Does a load or the drive of a scene come to other values within a span \[s] of time?
pub fn script_changes_within(scene: &SystemScene, from: f64, to: f64) -> bool {
    let inputs = ShaftInputs::scripted(scene, from);
    let (paths, played) =
        (ShaftPaths::steady(&inputs, from, &vec![0.0; scene.shafts.len()]), Played::all(scene));
    let given = Given { scene, paths: &paths, played: &played };
    schedules(&given).into_iter().any(|schedule| schedule.changes_within(from, to))
}

/// \[s] times at which a table of a load or of the drive bends, of those that are played.
pub fn knots(given: &Given<'_>, from: f64, to: f64) -> Vec<f64> {
    schedules(given).into_iter().flat_map(|schedule| schedule.knots(from, to)).collect()
}

/// \[s] shortest period in which a load swings, from a script or as a shaft turns; none where none does.
pub fn shortest_period(given: &Given<'_>, states: &[StructureState], time: f64) -> Option<f64> {
    let scripted = schedules(given).into_iter().filter_map(|schedule| schedule.shortest_period(time));
    let turning = given.scene.shafts.iter().zip(states).flat_map(|(shaft, state)| {
        let discs = shaft.disc.iter().filter(|disc| disc.unbalance.is_some()).map(|_| 1.0);
        let per_turn = discs.chain(shaft.rotating.iter().filter(|part| part.speed.is_none()).map(|_| 1.0));
        let meshes = shaft.gear.iter().filter_map(GearSection::ripple).map(|ripple| ripple.teeth);
        let speed = state.spin.speed.abs();
        per_turn.chain(meshes).filter(move |_| speed > 0.0).map(move |times| TAU / (times * speed))
    });
    let by_themselves = given.scene.rotating().filter_map(|part| part.speed.as_ref());
    let by_themselves = by_themselves.map(|speed| speed.at(time).abs()).filter(|speed| *speed > 0.0);
    scripted.chain(turning).chain(by_themselves.map(|speed| TAU / speed)).reduce(f64::min)
}
