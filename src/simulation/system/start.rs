//! Where a system starts: shafts and housings in balance with the bearings under their loads, balls in the quasi-static equilibrium of that.

use std::borrow::Cow;
use std::sync::Arc;

use super::super::inputs::Inputs;
use super::super::play::Scripted;
use super::super::{Simulation, SimulationError};
use super::assembly::Assembly;
use super::elements;
use super::inputs::ShaftInputs;
use super::pace::Pace;
use super::{LevelJump, Structures, System, SystemError, SystemOutputs};
use crate::analysis::auto;
use crate::dynamics::system::{Joined, Joint, StepBuffers, StructureLoad, StructureStep, StructureTrial};
use crate::model::link;
use crate::model::state::Statistics;
use crate::model::structure::{Carrier, Spin, StructureState};
use crate::numerics::step_control::StepControl;
use crate::scene::system::SystemScene;

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
        Self::start(found_out(scene)?.as_ref(), time, None, None)
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
        let mut assembly = Assembly::new(scene, time, given, spins)?;
        assembly.balance(scene)?;
        let Assembly { carriers, scales, loads, joints, links, mut bearings, states, inputs, paths, .. } =
            assembly;
        for joint in &joints {
            Arc::make_mut(&mut bearings[joint.bearing].model).carry(joint.race);
        }
        bearings.iter_mut().for_each(Simulation::settle);
        let (elements, stepped) = elements::joints(scene, &joints, &mut bearings);
        let element_states = elements::started(&elements, &carriers, &states, &mut bearings);
        let link_states = links.iter().map(|link| link.started(|structure| &states[structure])).collect();
        let solver = scene.solver();
        let control = StepControl::new(solver.initial_step.0, solver.min_step.0, solver.max_step.0);
        bearings.iter_mut().for_each(|bearing| bearing.state.control = control);
        let structures = Structures {
            scene: Arc::new(scene.clone()),
            carriers: Arc::new(carriers),
            scales: Arc::new(scales),
            joints: Arc::new(joints),
            stepped: Arc::new(stepped),
            elements: Arc::new(elements),
            element_states,
            jumps: vec![LevelJump::default(); scene.bearings.len()],
            links: Arc::new(links),
            link_states,
            inputs,
            paths,
            states,
            pace: Pace { time, control, statistics: Statistics::default() },
            solver,
            buffers: StepBuffers::default(),
            outputs: SystemOutputs::default(),
        };
        let mut system = Self { bearings, structures };
        system.structures.states = system.started(&loads);
        system.together().report();
        Ok(system)
    }

    /// States of the structures as at a start: accelerations, torques and powers under these loads and what the bearings now do.
    pub(super) fn started(&self, loads: &[StructureLoad]) -> Vec<StructureState> {
        let all = &self.structures;
        let boundaries: Vec<_> =
            self.bearings.iter().map(|bearing| bearing.boundary(all.pace.time)).collect();
        let elements = all.element_steps(&self.bearings, &boundaries, 0.0);
        let bearings: Vec<_> = self.bearings.iter().filter(|bearing| !bearing.model.without_states).collect();
        started(&all.carriers, &all.steps(&all.states, loads), all.joined(&elements), &bearings)
    }
}

/// A scene with effects and levels found out of those bearings that ask for it.
pub(super) fn found_out(scene: &SystemScene) -> Result<Cow<'_, SystemScene>, SystemError> {
    if scene.bearings.iter().any(|mounted| mounted.finds_level || mounted.scene.effects.auto.on) {
        let resolved = auto::resolve_shaft(scene.clone(), false);
        let (scene, _) = resolved.map_err(|why| SystemError::Together(SimulationError::Auto(why)))?;
        return Ok(Cow::Owned(scene));
    }
    Ok(Cow::Borrowed(scene))
}

/// States of the structures where a run starts, with accelerations under what the bearings do.
fn started(
    carriers: &[Carrier],
    structures: &[StructureStep<'_>],
    joined: Joined<'_>,
    bearings: &[&Simulation],
) -> Vec<StructureState> {
    let mut trials: Vec<_> = structures.iter().map(|one| StructureTrial::new(one.start)).collect();
    for Joint { bearing, race, structure, seat } in joined.joints {
        let motion = trials[*structure].seat(&carriers[*structure].structure, seat);
        trials[*structure].add(seat, &motion, &bearings[*bearing].state.race(*race).bearing_wrench);
    }
    for (one, own) in joined.links.iter().zip(joined.link_states) {
        let force = &own.force;
        for (index, end) in one.ends.iter().enumerate() {
            trials[end.structure].add_link(end, &(force * link::sign(index)));
        }
    }
    for element in joined.elements {
        let seen = element.see(&trials, structures);
        element.add(&seen, &element.forces(&seen), &mut trials);
    }
    let all = trials.into_iter().zip(structures);
    all.map(|(trial, one)| trial.started(one.model, one.load)).collect()
}
