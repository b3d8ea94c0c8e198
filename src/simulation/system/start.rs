//! Where a system starts: shafts and housings in balance with the bearings under their loads, balls in the quasi-static equilibrium of that.

use std::sync::Arc;

use nalgebra::{DVector, Vector3};

use super::super::inputs::Inputs;
use super::super::play::Scripted;
use super::super::{Simulation, SimulationError};
use super::inputs::{Given, Played, ShaftInputs, ShaftPaths, scripted_spin};
use super::statics::Statics;
use super::{Structures, System, SystemError, SystemOutputs, links, loads, places_of_housing, stations};
use crate::analysis::auto;
use crate::dynamics::system::{Joined, Joint, Seat, StructureLoad, StructureTrial};
use crate::equilibrium::{self, EquilibriumInput, Gyroscopic, Prescribed};
use crate::model::bodies::Race;
use crate::model::structure::{
    Carrier, Ring, Spin, Structure, StructureEnergies, StructurePowers, StructureState, Turning,
};
use crate::model::{Model, link};
use crate::numerics::step_control::StepControl;
use crate::numerics::tilt;
use crate::scene::system::mesh::{InTrain, trains};
use crate::scene::system::{MountedScene, SystemScene};
use crate::schema::ShaftSection;

impl System {
    /// Prepares a system and starts it at time 0, from the equilibrium under its loads.
    ///
    /// # Errors
    /// See [`SystemError`].
    pub fn new(scene: &SystemScene) -> Result<Self, SystemError> {
        Self::starting_at(scene, 0.0)
    }

    /// Prepares a system and starts it at a time \[s], from the equilibrium under what its scripts say then.
    ///
    /// # Errors
    /// See [`SystemError`].
    pub fn starting_at(scene: &SystemScene, time: f64) -> Result<Self, SystemError> {
        if scene.bearings.iter().any(|mounted| mounted.scene.effects.auto.on) {
            let resolved = auto::resolve_shaft(scene.clone(), false);
            let (scene, _) = resolved.map_err(|why| SystemError::Together(SimulationError::Auto(why)))?;
            return Self::start(&scene, time, None, None);
        }
        Self::start(scene, time, None, None)
    }

    /// Starts again at the present time, from the equilibrium under the present inputs.
    ///
    /// # Errors
    /// See [`SystemError`].
    pub fn initialise(&mut self) -> Result<(), SystemError> {
        let bearings: Vec<Inputs> = self.bearings.iter().map(|bearing| bearing.inputs).collect();
        *self = Self::start(
            &self.structures.scene,
            self.time(),
            Some((&self.structures.inputs, &bearings)),
            None,
        )?;
        Ok(())
    }

    /// Starts under these inputs of shaft and bearings, or those of the scripts, with these turns of the shafts, or those of their drives.
    pub(super) fn start(
        scene: &SystemScene,
        time: f64,
        given: Option<(&ShaftInputs, &[Inputs])>,
        spins: Option<Vec<Spin>>,
    ) -> Result<Self, SystemError> {
        let carriers = carriers(scene)?;
        let inside = |mounted: &MountedScene| {
            let name = mounted.name.clone();
            move |source: SimulationError| SystemError::Bearing { name, source }
        };
        let mut bearings = vec![];
        let mut asked = vec![];
        let mut joints = vec![];
        let mut seated = vec![0; carriers.len()];
        for (index, mounted) in scene.bearings.iter().enumerate() {
            let mut bearing = Simulation::starting_at(&mounted.scene, time).map_err(inside(mounted))?;
            if let Some((_, inputs)) = given {
                bearing.set_inputs(inputs[index]);
            }
            let Preloaded { offset, force } = preload(mounted, &bearing.model).map_err(inside(mounted))?;
            asked.push(force);
            let outer = outer_structure(scene, index).map(|structure| (Race::Outer, structure));
            for (race, structure) in [(Race::Inner, mounted.shaft)].into_iter().chain(outer) {
                let station = carriers[structure].ring_at(seated[structure]);
                seated[structure] += 1;
                let direction = mounted.mounting.direction.sign();
                let seat = match race {
                    Race::Inner => Seat::new(station, direction, offset),
                    Race::Outer => {
                        let (place, tilt) = mounted.bore();
                        Seat::new(station, direction, 0.0).lying_off(place, tilt)
                    }
                };
                joints.push(Joint { bearing: index, race, structure, seat });
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
        let scales: Vec<_> = carriers.iter().map(|one| one.structure.scales()).collect();
        let links = links::of(scene, &carriers);
        let mut statics = Statics {
            scene,
            time,
            carriers: &carriers,
            scales: &scales,
            loads: &loads,
            joints: &joints,
            links: &links,
            flanks: vec![None; links.len()],
            bearings: &mut bearings,
            friction: vec![0.0; scene.bearings.len()],
        };
        statics.turn_into_mesh(&mut states);
        statics.solve(&mut states)?;
        statics.check_preloads(&asked, &states)?;
        statics.initialise(&states)?;
        // Housings feel the friction torque of their bearings too, which those say that are in balance.
        if !scene.housings.is_empty() {
            statics.see_friction();
            statics.solve(&mut states)?;
            statics.initialise(&states)?;
        }
        for joint in &joints {
            Arc::make_mut(&mut bearings[joint.bearing].model).carry(joint.race);
        }
        bearings.iter_mut().for_each(Simulation::settle);
        let joined = Joined { joints: &joints, links: &links };
        let states = started(&carriers, &states, &loads, joined, &bearings);
        let link_states = links.iter().map(|link| link.started(|structure| &states[structure])).collect();
        let solver = scene.solver();
        let control = StepControl::new(solver.initial_step.0, solver.min_step.0, solver.max_step.0);
        bearings.iter_mut().for_each(|bearing| bearing.state.control = control);
        let structures = Structures {
            scene: Arc::new(scene.clone()),
            carriers: Arc::new(carriers),
            scales: Arc::new(scales),
            joints: Arc::new(joints),
            links: Arc::new(links),
            link_states,
            inputs,
            paths,
            states,
            outputs: SystemOutputs::default(),
        };
        let mut system = Self { bearings, structures };
        system.together().report();
        Ok(system)
    }
}

/// The shafts, then the housings, then the ground if it has bores.
fn carriers(scene: &SystemScene) -> Result<Vec<Carrier>, SystemError> {
    let named = |name: String| move |why| SystemError::Structure { name, why };
    let shafts = scene.shafts.iter().enumerate().map(|(index, shaft)| {
        let name = if scene.shafts.len() == 1 { "shaft".into() } else { format!("shaft \"{}\"", shaft.name) };
        Carrier::of_shaft(shaft, &stations(scene, index), scene.twists(index)).map_err(named(name))
    });
    let housings = scene.housings.iter().enumerate().map(|(index, housing)| {
        let name = format!("housing \"{}\"", housing.name);
        let carrier = Carrier::of_housing(housing, &places_of_housing(scene, index)).map_err(named(name))?;
        Ok(carrier.with_rings(&sliding(scene, scene.bearings_in(index))))
    });
    let bores = scene.bearings_in_ground().count();
    let ground = || Ok(Carrier::of_ground(bores).with_rings(&sliding(scene, scene.bearings_in_ground())));
    shafts.chain(housings).chain((bores > 0).then(ground)).collect()
}

/// Rings that slide, of the bearings at the first stations of a structure.
fn sliding(scene: &SystemScene, bearings: impl Iterator<Item = usize>) -> Vec<Ring> {
    let ring = |(station, bearing): (usize, usize)| {
        let mounted = &scene.bearings[bearing];
        let axis = tilt::orientation(&mounted.bore().1) * Vector3::x();
        mounted.sliding_mass().map(|mass| Ring { station, mass, axis })
    };
    bearings.enumerate().filter_map(ring).collect()
}

/// The structure that carries the outer race of a bearing, if one does.
fn outer_structure(scene: &SystemScene, bearing: usize) -> Option<usize> {
    let ground = || scene.bearings[bearing].mounting.seats_outer_ring().then_some(scene.housings.len());
    scene.housing_of(bearing).or_else(ground).map(|structure| structure + scene.shafts.len())
}

/// Turns of the shafts at the start.
fn initial_spins(scene: &SystemScene, inputs: &ShaftInputs, carriers: &[Carrier], time: f64) -> Vec<Spin> {
    let driven = scene.shafts.iter().zip(&inputs.drives).zip(carriers);
    let own =
        driven.map(|((shaft, drive), carrier)| initial_spin(shaft, *drive, carrier.structure.turning, time));
    let own: Vec<Spin> = own.collect();
    // Shafts of a train turn as its teeth say.
    let trains = trains(&scene.shafts, &scene.meshes).into_iter().enumerate();
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

/// States of the structures where a run starts, with accelerations under what the bearings do.
fn started(
    carriers: &[Carrier],
    states: &[StructureState],
    loads: &[StructureLoad],
    joined: Joined<'_>,
    bearings: &[Simulation],
) -> Vec<StructureState> {
    let mut trials: Vec<_> = states.iter().map(StructureTrial::new).collect();
    for Joint { bearing, race, structure, seat } in joined.joints {
        let motion = trials[*structure].seat(&carriers[*structure].structure, seat);
        trials[*structure].add(seat, &motion, &bearings[*bearing].state.race(*race).bearing_wrench);
    }
    for one in joined.links {
        let [displacement, rate] = one.motion(|structure| &trials[structure].end);
        let force = one.force(&displacement, &rate, None).force;
        for (index, end) in one.ends.iter().enumerate() {
            trials[end.structure].add_link(end, &(force * link::sign(index)));
        }
    }
    let all = trials.into_iter().zip(carriers.iter().zip(loads));
    all.map(|(trial, (carrier, load))| trial.started(&carrier.structure, load)).collect()
}
