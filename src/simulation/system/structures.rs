//! Shafts and housings in motion: what carries the races of a system's bearings, and what acts on it.

use std::sync::Arc;

use nalgebra::DVector;

use super::inputs::{Given, Played, ShaftInputs, ShaftPaths};
use super::pace::Pace;
use super::{LevelJump, LinkOutputs, SystemOutputs, loads};
use crate::dynamics::system::elements::{ElementJoint, ElementState, ElementStep, residual_of};
use crate::dynamics::system::{Joined, Joint, MayLeave, StepBuffers, StructureLoad, StructureStep};
use crate::dynamics::{Allowed, Boundary};
use crate::model::bodies::Race;
use crate::model::link::{Link, LinkState};
use crate::model::structure::{Carrier, StructureState, Turning};
use crate::scene::system::SystemScene;
use crate::schema::Solver;

/// Shafts and housings in motion.
#[derive(Clone, Debug)]
pub struct Structures {
    /// The scene.
    pub scene: Arc<SystemScene>,
    /// The shafts, then the housings in the order of the scene, then the ground if it has bores.
    pub carriers: Arc<Vec<Carrier>>,
    /// [`crate::model::structure::Structure::scales`] of each.
    pub scales: Arc<Vec<DVector<f64>>>,
    /// Races on their seats.
    pub joints: Arc<Vec<Joint>>,
    /// Those of the bearings that have states, which are counted without the others.
    pub stepped: Arc<Vec<Joint>>,
    /// Bearings without states between them.
    pub elements: Arc<Vec<ElementJoint>>,
    /// States of their elements.
    pub element_states: Vec<ElementState>,
    /// What changes of level did, in the order of the scene's bearings.
    pub jumps: Vec<LevelJump>,
    /// Links between them: meshes, then bearings by their stiffness.
    pub links: Arc<Vec<Link>>,
    /// States of these.
    pub link_states: Vec<LinkState>,
    /// Inputs as set last.
    pub inputs: ShaftInputs,
    /// How they go on.
    pub paths: ShaftPaths,
    /// State of each structure.
    pub states: Vec<StructureState>,
    /// Their time, and that of all bearings.
    pub pace: Pace,
    /// Settings of their steps.
    pub solver: Solver,
    /// Buffers of these.
    pub buffers: StepBuffers,
    /// Their outputs.
    pub outputs: SystemOutputs,
}

impl Structures {
    /// Loads on them: scripts where they are played, else inputs.
    pub fn given<'a>(&'a self, played: &'a Played) -> Given<'a> {
        Given { scene: &self.scene, paths: &self.paths, played }
    }

    /// \[s] shortest period in which a load or a mesh swings after a time \[s].
    pub fn shortest_period(&self, played: &Played, time: f64) -> Option<f64> {
        let links = self.links.iter().zip(&self.link_states);
        let links = links.filter_map(|(link, state)| link.shortest_period(&state.rate));
        loads::shortest_period(&self.given(played), &self.states, time)
            .into_iter()
            .chain(links)
            .reduce(f64::min)
    }

    /// \[s] times between two others at which a table of a load or of the drive bends.
    pub fn knots(&self, played: &Played, from: f64, to: f64) -> Vec<f64> {
        loads::knots(&self.given(played), from, to)
    }

    /// Loads on each at the end of a step from one time \[s] to another.
    pub fn loads(&self, played: &Played, from: f64, to: f64) -> Vec<StructureLoad> {
        loads::at(&self.given(played), &self.carriers, &self.states, from, to)
    }

    /// Joints between them.
    pub fn joined<'a>(&'a self, elements: &'a [ElementStep<'a>]) -> Joined<'a> {
        Joined {
            joints: &self.stepped,
            links: &self.links,
            link_states: &self.link_states,
            elements,
            solver: Some(&self.solver),
            of_links: self.may_leave(),
        }
    }

    /// What a step may leave of a machine all of whose bearings are links.
    fn may_leave(&self) -> Option<MayLeave> {
        self.scene.bearings.is_empty().then(|| {
            let forces = self.link_states.iter().map(|link| link.force.fixed_rows::<3>(0).norm());
            let largest = forces.fold(0.0, f64::max);
            let unresolved = (self.solver.unresolved > 0.0).then(|| self.solver.unresolved_share() * largest);
            let length = self.solver.tolerance_without_states() * self.scene.smallest_element();
            let error = Allowed { length, unresolved };
            MayLeave { force: residual_of(largest, &self.solver), error }
        })
    }

    /// Takes the states that a step of `h` \[s] has led to.
    pub fn reach(&mut self, states: Vec<StructureState>, h: f64) {
        for (link, state) in self.links.iter().zip(&mut self.link_states) {
            *state = link.reached(state, h, |structure| &states[structure]);
        }
        self.states = states;
    }

    /// Each in these states at the start of a step, and what acts on it at its end.
    pub fn steps<'a>(
        &'a self,
        states: &'a [StructureState],
        loads: &'a [StructureLoad],
    ) -> Vec<StructureStep<'a>> {
        let all = self.carriers.iter().zip(&*self.scales).zip(states.iter().zip(loads));
        all.map(|((carrier, scales), (start, load))| StructureStep {
            model: &carrier.structure,
            scales,
            start,
            load,
        })
        .collect()
    }

    /// Rings that are parts of shafts turn with them at the end of a step.
    pub fn turn_races(&self, boundaries: &mut [Boundary], loads: &[StructureLoad]) {
        let speed = |shaft: usize| match self.carriers[shaft].structure.turning {
            Turning::Free => self.states[shaft].spin.speed,
            Turning::Given | Turning::Still => loads[shaft].spin.speed,
        };
        for (boundary, bearing) in boundaries.iter_mut().zip(&self.scene.bearings) {
            let direction = bearing.mounting.direction.sign();
            boundary.loads[Race::Inner].speed = direction * speed(bearing.shaft);
            if let Some(shaft) = bearing.outer_shaft {
                boundary.loads[Race::Outer].speed = direction * speed(shaft);
            }
        }
    }

    /// Loads and drive go linearly to the inputs over a communication step from one time \[s] to another.
    pub fn head_for_inputs(&mut self, from: f64, to: f64) {
        self.paths = self.paths.towards(&self.inputs, from, to - from);
    }

    /// Inputs where a communication step has ended at a time \[s].
    pub fn end_script(&mut self, played: &Played, time: f64) {
        (self.inputs, self.paths) = self.given(played).reached(&self.inputs, time);
    }

    /// Outputs of the states as they are at a time \[s].
    pub fn report(&mut self, time: f64) {
        let torque = |shaft: usize| match self.carriers[shaft].structure.turning {
            Turning::Free => self.paths.torque(shaft, time),
            Turning::Given | Turning::Still => self.states[shaft].torque,
        };
        let torques: Vec<_> = (0..self.scene.shafts.len()).map(torque).collect();
        self.outputs = SystemOutputs::of(&self.scene, &self.carriers, &self.states, &torques, time);
        let links = self.link_states.iter().enumerate();
        self.outputs.jumps.clone_from(&self.jumps);
        self.outputs.links = links.map(|(index, state)| LinkOutputs::of(&self.links, index, state)).collect();
    }
}
