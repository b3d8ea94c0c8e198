//! The parts of a system put together, and their balance: of all of them, and again of a system in balance one of whose bearings has another
//! scene.

use std::sync::Arc;

use nalgebra::{DVector, Vector3};

use super::super::inputs::Inputs;
use super::super::together::Together;
use super::super::{Simulation, SimulationError};
use super::inputs::{Given, Played, ShaftInputs, ShaftPaths, scripted_spin, spin_of};
use super::start::found_out;
use super::statics::Statics;
use super::{
    System, SystemError, first_stations, housing_stations, links, loads, places_of_housing, stations,
};
use crate::dynamics::system::{Joint, Seat, StructureLoad};
use crate::equilibrium::{self, EquilibriumInput, Gyroscopic, Prescribed};
use crate::model::Model;
use crate::model::bodies::Race;
use crate::model::link::Link;
use crate::model::structure::{
    Carrier, Map, Ring, Spin, Structure, StructureEnergies, StructurePowers, StructureState, Turning,
};
use crate::numerics::tilt;
use crate::scene::Scene;
use crate::scene::system::mesh::{InTrain, trains};
use crate::scene::system::{MountedScene, SystemScene};
use crate::schema::ShaftSection;

/// The parts of a system at a time.
pub(super) struct Assembly {
    time: f64,
    pub carriers: Vec<Carrier>,
    /// Scales of the equations of each structure.
    pub scales: Vec<DVector<f64>>,
    /// External loads on each.
    pub loads: Vec<StructureLoad>,
    /// Races on their seats.
    pub joints: Vec<Joint>,
    pub links: Vec<Link>,
    pub bearings: Vec<Simulation>,
    /// \[N] preload that each bearing asks for.
    asked: Vec<f64>,
    /// [N m] moment of each bearing on its outer race about its axis.
    friction: Vec<f64>,
    pub states: Vec<StructureState>,
    pub inputs: ShaftInputs,
    pub paths: ShaftPaths,
}

impl Assembly {
    /// Under these inputs of shaft and bearings, or those of the scripts, with these turns of the shafts, or those of their drives.
    pub fn new(
        scene: &SystemScene,
        time: f64,
        given: Option<(&ShaftInputs, &[Inputs])>,
        spins: Option<Vec<Spin>>,
    ) -> Result<Self, SystemError> {
        let carriers = carriers(scene)?;
        let mut bearings = vec![];
        let mut asked = vec![];
        let mut joints = vec![];
        let mut seated = vec![0; carriers.len()];
        for (index, mounted) in scene.bearings.iter().enumerate() {
            let (mut bearing, Preloaded { offset, force }) = preloaded(mounted, time)?;
            if let Some((_, inputs)) = given {
                bearing.set_inputs(inputs[index]);
            }
            asked.push(force);
            let outer = outer_structure(scene, index).map(|structure| (Race::Outer, structure));
            for (race, structure) in [(Race::Inner, mounted.shaft)].into_iter().chain(outer) {
                let station = carriers[structure].ring_at(seated[structure]);
                seated[structure] += 1;
                joints.push(Joint {
                    bearing: index,
                    race,
                    structure,
                    seat: seat(mounted, race, station, offset),
                });
            }
            bearings.push(bearing);
        }
        let scripted = ShaftInputs::scripted(scene, time);
        let inputs = given.map_or(scripted, |(shaft, _)| shaft.clone());
        let spins = spins.unwrap_or_else(|| initial_spins(scene, &inputs, &carriers, time));
        let still = std::iter::repeat(Spin::default());
        let turning = carriers.iter().zip(spins.iter().copied().chain(still));
        let mut states: Vec<_> = turning.map(|(one, spin)| at_rest(&one.structure, spin)).collect();
        let angles: Vec<f64> = spins.iter().map(|spin| spin.angle).collect();
        let paths = ShaftPaths::steady(&inputs, time, &angles);
        // What scripts say at this time is among the inputs.
        let played = Played::none(scene);
        let loads =
            loads::at(&Given { scene, paths: &paths, played: &played }, &carriers, &states, time, time);
        for ((one, state), load) in carriers.iter().zip(&mut states).zip(&loads) {
            one.structure.hold(state, &load.held);
        }
        let scales = carriers.iter().map(|one| one.structure.scales()).collect();
        let links = links::of(scene, &carriers);
        let friction = vec![0.0; bearings.len()];
        Ok(Self {
            time,
            carriers,
            scales,
            loads,
            joints,
            links,
            bearings,
            asked,
            friction,
            states,
            inputs,
            paths,
        })
    }

    /// Brings structures and bearings into balance.
    pub fn balance(&mut self, scene: &SystemScene) -> Result<(), SystemError> {
        let mut statics = Statics {
            scene,
            time: self.time,
            carriers: &self.carriers,
            scales: &self.scales,
            loads: &self.loads,
            joints: &self.joints,
            links: &self.links,
            flanks: vec![None; self.links.len()],
            bearings: &mut self.bearings,
            friction: &mut self.friction,
        };
        statics.turn_into_mesh(&mut self.states);
        let all: Vec<usize> = (0..self.asked.len()).collect();
        balance(&mut statics, &mut self.states, &self.asked, &all)
    }
}

/// Brings structures into balance from where they are, and starts some of the bearings there.
fn balance(
    statics: &mut Statics<'_>,
    states: &mut [StructureState],
    asked: &[f64],
    bearings: &[usize],
) -> Result<(), SystemError> {
    statics.solve(states)?;
    statics.check_preloads(asked, states)?;
    statics.initialise(states, bearings)?;
    // Housings feel the friction torque of their bearings too, which those say that are in balance; shafts that give way to a torque that of bearings without states.
    let scene = statics.scene;
    let gives_way =
        || (0..scene.shafts.len()).any(|shaft| scene.shafts[shaft].speed.is_none() || scene.twists(shaft));
    let brakes = || bearings.iter().any(|&index| statics.is_without_states(index)) && gives_way();
    if !scene.housings.is_empty() || brakes() {
        statics.see_friction(bearings);
        statics.solve(states)?;
        statics.initialise(states, bearings)?;
    }
    Ok(())
}

/// A system in balance, from which others are found that differ from it in the effects of one bearing.
pub struct InBalance {
    scene: SystemScene,
    assembly: Assembly,
}

impl InBalance {
    /// At a time \[s], under what the scripts say then.
    ///
    /// # Errors
    /// See [`SystemError`].
    pub fn new(scene: &SystemScene, time: f64) -> Result<Self, SystemError> {
        let scene = found_out(scene)?.into_owned();
        let mut assembly = Assembly::new(&scene, time, None, None)?;
        assembly.balance(&scene)?;
        Ok(Self { scene, assembly })
    }

    /// The scene of a bearing.
    pub fn scene(&self, bearing: usize) -> &Scene {
        &self.scene.bearings[bearing].scene
    }

    /// A bearing with another scene, just started in the balance that the system then has: sought from here, or anew where it is not found so.
    ///
    /// # Errors
    /// See [`SystemError`].
    pub fn with(&self, bearing: usize, scene: &Scene) -> Result<Simulation, SystemError> {
        let mut mounted = self.scene.bearings[bearing].clone();
        mounted.scene = scene.clone();
        self.near(bearing, &mounted).or_else(|_| {
            let mut changed = self.scene.clone();
            changed.bearings[bearing] = mounted;
            Ok(System::starting_at(&changed, self.assembly.time)?.bearings.swap_remove(bearing))
        })
    }

    fn near(&self, bearing: usize, mounted: &MountedScene) -> Result<Simulation, SystemError> {
        let Assembly {
            time, carriers, scales, loads, links, joints, bearings, asked, friction, states, ..
        } = &self.assembly;
        let (mut joints, mut bearings, mut asked) = (joints.clone(), bearings.clone(), asked.clone());
        let (started, Preloaded { offset, force }) = preloaded(mounted, *time)?;
        bearings[bearing] = started;
        asked[bearing] = force;
        for index in 0..joints.len() {
            let Joint { bearing: of, race, structure, .. } = joints[index];
            if of == bearing {
                let before = joints[..index].iter().filter(|joint| joint.structure == structure).count();
                joints[index].seat = seat(mounted, race, carriers[structure].ring_at(before), offset);
            }
        }
        let mut statics = Statics {
            scene: &self.scene,
            time: *time,
            carriers,
            scales,
            loads,
            joints: &joints,
            links,
            flanks: vec![None; links.len()],
            bearings: &mut bearings,
            friction: &mut friction.clone(),
        };
        balance(&mut statics, &mut states.clone(), &asked, &[bearing])?;
        let mut found = bearings.swap_remove(bearing);
        for joint in joints.iter().filter(|joint| joint.bearing == bearing) {
            Arc::make_mut(&mut found.model).carry(joint.race);
        }
        found.settle();
        Together { bearings: std::slice::from_mut(&mut found), structures: None }.see_races();
        Ok(found)
    }
}

/// A bearing alone, and its preload.
fn preloaded(mounted: &MountedScene, time: f64) -> Result<(Simulation, Preloaded), SystemError> {
    let inside = |source: SimulationError| SystemError::Bearing { name: mounted.name.clone(), source };
    let bearing = Simulation::starting_at(&mounted.scene, time).map_err(inside)?;
    let preload = preload(mounted, &bearing.model).map_err(inside)?;
    Ok((bearing, preload))
}

/// The seat of a race at a station, with the place of the inner race's origin along x \[m].
fn seat(mounted: &MountedScene, race: Race, station: &Map, offset: f64) -> Seat {
    let direction = mounted.mounting.direction.sign();
    match race {
        Race::Inner => Seat::new(station, direction, offset),
        Race::Outer => {
            let (place, tilt) = mounted.bore();
            Seat::new(station, direction, 0.0).lying_off(place, tilt)
        }
    }
}

/// The shafts, then the housings, then the ground if it has bores.
fn carriers(scene: &SystemScene) -> Result<Vec<Carrier>, SystemError> {
    let named = |name: String| move |why| SystemError::Structure { name, why };
    let shafts = scene.shafts.iter().enumerate().map(|(index, shaft)| {
        let name = if scene.shafts.len() == 1 { "shaft".into() } else { format!("shaft \"{}\"", shaft.name) };
        let carrier = Carrier::of_shaft(shaft, &stations(scene, index), scene.twists(index))
            .map_err(named(name.clone()))?;
        let [first, ..] = first_stations(scene, index);
        holding(scene, (index, first), carrier, name)
    });
    let housings = scene.housings.iter().enumerate().map(|(index, housing)| {
        let name = format!("housing \"{}\"", housing.name);
        let carrier =
            Carrier::of_housing(housing, &places_of_housing(scene, index)).map_err(named(name.clone()))?;
        let carrier = carrier.with_rings(&sliding(scene, scene.bearings_in(index)));
        let [first, _] = housing_stations(scene, index);
        holding(scene, (scene.shafts.len() + index, first), carrier, name)
    });
    let bores = scene.bearings_in_ground().count();
    let ground = || Ok(Carrier::of_ground(bores).with_rings(&sliding(scene, scene.bearings_in_ground())));
    shafts.chain(housings).chain((bores > 0).then(ground)).collect()
}

/// A structure with the motions that are given at its named loads, the first of which is at this station.
fn holding(
    scene: &SystemScene,
    (structure, first): (usize, usize),
    carrier: Carrier,
    name: String,
) -> Result<Carrier, SystemError> {
    let held: Vec<_> =
        scene.held(structure).map(|(own, (_, component, _))| (first + own, component)).collect();
    carrier.holding(&held).map_err(|which| {
        let before: usize = (0..structure).map(|one| scene.held(one).count()).sum();
        let given = scene.motions().nth(before + which);
        let key = given.map_or(String::new(), |(load, (key, ..))| format!("{load}: {key}"));
        let why = format!("{key} follows from the motions that are given before it: take it out");
        SystemError::Structure { name, why }
    })
}

/// Rings that slide, of the bearings at the first stations of a structure.
fn sliding(scene: &SystemScene, bearings: impl Iterator<Item = usize>) -> Vec<Ring> {
    let ring = |(station, bearing): (usize, usize)| {
        let mounted = &scene.bearings[bearing];
        let axis = tilt::orientation(&mounted.bore().1) * Vector3::x();
        let place = Vector3::from(mounted.place(&scene.shafts));
        mounted.sliding_mass().map(|mass| Ring { station, mass, place, axis })
    };
    bearings.enumerate().filter_map(ring).collect()
}

/// The structure that carries the outer race of a bearing, if one does.
fn outer_structure(scene: &SystemScene, bearing: usize) -> Option<usize> {
    let MountedScene { outer_shaft, mounting, .. } = &scene.bearings[bearing];
    let ground = || mounting.has_bore().then_some(scene.housings.len());
    let still = || scene.housing_of(bearing).or_else(ground).map(|structure| structure + scene.shafts.len());
    outer_shaft.or_else(still)
}

/// Turns of the shafts at the start.
fn initial_spins(scene: &SystemScene, inputs: &ShaftInputs, carriers: &[Carrier], time: f64) -> Vec<Spin> {
    let driven = scene.shafts.iter().zip(inputs.drives.iter().zip(&inputs.flanges)).zip(carriers);
    let own = driven.map(|((shaft, (drive, flange)), carrier)| match flange {
        Some(turn) => spin_of(turn),
        None => initial_spin(shaft, *drive, carrier.structure.turning, time),
    });
    let own: Vec<Spin> = own.collect();
    // Shafts of a train turn as its teeth say.
    let trains = trains(&scene.shafts, &scene.meshes, &scene.springs).into_iter().enumerate();
    let of_train = |(shaft, InTrain { root, ratio }): (usize, InTrain)| {
        let Spin { angle, speed, acceleration } = own[root];
        match shaft == root {
            true => own[root],
            false => Spin { angle: angle * ratio, speed: speed * ratio, acceleration: acceleration * ratio },
        }
    };
    trains.map(of_train).collect()
}

fn initial_spin(shaft: &ShaftSection, drive: f64, turning: Turning, time: f64) -> Spin {
    match turning {
        Turning::Free => Spin { speed: shaft.start_speed.map_or(0.0, |speed| speed.0), ..Spin::default() },
        Turning::Given | Turning::Still => {
            let scripted = scripted_spin(shaft, time);
            let acceleration = if drive == scripted.speed { scripted.acceleration } else { 0.0 };
            Spin { speed: drive, acceleration, ..scripted }
        }
    }
}

/// A structure that rests but for its spin.
fn at_rest(structure: &Structure, spin: Spin) -> StructureState {
    let zero = DVector::zeros(structure.size());
    let (mut coordinates, mut rates) = (zero.clone(), zero.clone());
    if structure.turning == Turning::Free {
        coordinates[structure.size() - 1] = spin.angle;
        rates[structure.size() - 1] = spin.speed;
    }
    StructureState {
        coordinates,
        rates,
        accelerations: zero.clone(),
        total: zero.clone(),
        remainder: zero,
        spin,
        torque: 0.0,
        holding: vec![0.0; structure.held.len()],
        powers: StructurePowers::default(),
        energies: StructureEnergies::default(),
    }
}

/// A preload of a bearing.
struct Preloaded {
    /// \[m] axial way of its inner race along its x axis.
    offset: f64,
    /// \[N] axial force that it takes while its races are held there.
    force: f64,
}

/// The preload of a bearing.
fn preload(mounted: &MountedScene, model: &Model) -> Result<Preloaded, SimulationError> {
    let preload = mounted.mounting.preload;
    let under = |given| {
        let mut problem = EquilibriumInput::from_scene(&mounted.scene, Gyroscopic::Friction);
        problem.conditions = [Prescribed::Motion(0.0); 5];
        problem.conditions[0] = given;
        (problem.inner_speed, problem.outer_speed) = (0.0, 0.0);
        problem.frame = Default::default();
        equilibrium::solve(model, &problem)
    };
    Ok(match (preload.force, preload.displacement) {
        (Some(force), _) => {
            let offset = under(Prescribed::Load(force.0))?.displacement[0];
            Preloaded { offset, force: force.0 }
        }
        // What cannot be solved for held races is not judged.
        (None, Some(way)) => {
            let force = under(Prescribed::Motion(way.0)).map_or(0.0, |solution| solution.load[0]);
            Preloaded { offset: way.0, force }
        }
        (None, None) => Preloaded { offset: 0.0, force: 0.0 },
    })
}
