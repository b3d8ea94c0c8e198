//! Bearings that change their level between two steps: both levels begin at the equilibrium of where the rings are, with the balls where they have come to.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::super::play::Scripted;
use super::super::{Simulation, SimulationError, start};
use super::inputs::{Given, Played, ShaftPaths};
use super::{System, SystemError, elements, loads};
use crate::dynamics::system::StepBuffers;
use crate::dynamics::system::elements::ElementJoint;
use crate::model::Model;
use crate::model::bodies::Race;
use crate::model::spacing::{CommonTurn, Spacing};
use crate::model::state::KeptMatrix;
use crate::numerics::step_control::StepControl;
use crate::scene::Scene;
use crate::scene::system::SystemScene;
use crate::schema::Start;

/// What the last change of a bearing's level did to what its inner ring feels; nothing if it has not changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LevelJump {
    /// [-] changes of level since the start.
    pub changes: u32,
    /// \[N] size of the jump of its force.
    pub force: f64,
    /// [N m] size of the jump of its moment.
    pub moment: f64,
}

impl System {
    /// Changes of level since the start, in the order of the scene's bearings.
    pub fn level_jumps(&self) -> &[LevelJump] {
        &self.structures.jumps
    }

    /// Brings bearings to the levels of a scene; nothing is changed if one of them has no equilibrium.
    pub(super) fn change_levels(&mut self, scene: &SystemScene) -> Result<(), SystemError> {
        let levels = self.structures.scene.bearings.iter().zip(&scene.bearings);
        let changed = levels.enumerate().filter(|(_, (own, other))| own.level() != other.level());
        let changed: Vec<usize> = changed.map(|(bearing, _)| bearing).collect();
        if changed.is_empty() {
            return Ok(());
        }
        let mut next = self.clone();
        let own = &mut Arc::make_mut(&mut next.structures.scene).bearings;
        own.iter_mut().zip(&scene.bearings).for_each(|(own, other)| own.dynamic = other.dynamic);
        next.begin_levels(&changed)?;
        *self = next;
        Ok(())
    }

    /// Bearings begin at the levels that their scene now gives, and the structures go on under what they then feel.
    fn begin_levels(&mut self, changed: &[usize]) -> Result<(), SystemError> {
        let before: Vec<_> = changed.iter().map(|&index| self.bearings[index].state.clone()).collect();
        for &index in changed {
            self.bearings[index].begin_where_it_is().map_err(|why| self.stopped((index, why)))?;
        }
        let all = &mut self.structures;
        let (joints, stepped) = elements::joints(&all.scene, &all.joints, &mut self.bearings);
        let before_states = std::mem::take(&mut all.element_states);
        let kept =
            all.elements.iter().zip(before_states).filter(|(joint, _)| !changed.contains(&joint.bearing));
        let mut kept = kept.map(|(_, state)| state);
        let state = |joint: &ElementJoint| {
            if !changed.contains(&joint.bearing) {
                return kept.next();
            }
            let bearing = &mut self.bearings[joint.bearing];
            let turn = bearing.turn_of_balls();
            Some(elements::started_at(turn, joint, (&all.carriers, &all.states), bearing))
        };
        let states = joints.iter().filter_map(state).collect();
        (all.elements, all.stepped, all.element_states) = (Arc::new(joints), Arc::new(stepped), states);
        for (&index, before) in changed.iter().zip(&before) {
            let bearing = &mut self.bearings[index];
            let stored = bearing.state.energies.stored;
            bearing.go_on_from(before);
            // What the other level stores is no loss.
            bearing.state.energies.stored = stored;
            let [from, to] = [before, &bearing.state].map(|state| state.race(Race::Inner).bearing_wrench);
            let changes = all.jumps[index].changes + 1;
            let (force, moment) = ((to.force - from.force).norm(), (to.moment - from.moment).norm());
            all.jumps[index] = LevelJump { changes, force, moment };
        }
        self.accelerate_anew();
        self.together().report();
        Ok(())
    }

    /// Accelerations of the structures under what their bearings now do; steps begin with the first one.
    fn accelerate_anew(&mut self) {
        let all = &self.structures;
        let (scene, time) = (&all.scene, all.pace.time);
        let turns: Vec<f64> = all.states[..scene.shafts.len()].iter().map(|state| state.spin.angle).collect();
        let paths = ShaftPaths::steady(&all.inputs, time, &turns);
        let given = Given { scene, paths: &paths, played: &Played::none(scene) };
        let loads = loads::at(&given, &all.carriers, &all.states, time, time);
        let mut states = self.started(&loads);
        for (state, before) in states.iter_mut().zip(&all.states) {
            state.energies = before.energies;
        }
        let solver = self.structures.solver;
        let control = StepControl::new(solver.initial_step.0, solver.min_step.0, solver.max_step.0);
        for bearing in &mut self.bearings {
            (bearing.state.matrix, bearing.state.control) = (KeptMatrix::default(), control);
        }
        let all = &mut self.structures;
        (all.states, all.pace.control, all.buffers) = (states, control, StepBuffers::default());
    }
}

impl Simulation {
    /// \[rad] turn of the balls since the start, without whole ones.
    fn turn_of_balls(&self) -> f64 {
        let outer = self.state.race(Race::Outer);
        let evenly = Spacing::new(&self.model.bearing);
        CommonTurn::of_balls(&evenly, &self.state.balls, outer.pose.position, outer.velocity).angle
    }

    /// Goes to the equilibrium of where its rings are, with its balls at the azimuths that they have come to.
    fn begin_where_it_is(&mut self) -> Result<(), SimulationError> {
        let mut turned = Model::clone(&self.model);
        turned.bearing.first_ball_azimuth += self.turn_of_balls();
        // What is said of the start was so then.
        let mut scene = Scene::clone(&self.scene);
        let Start { spin_balance, .. } = scene.start;
        scene.start = Start { spin_balance, ..Start::default() };
        let time = self.state.time;
        self.state = start::from_inputs(&scene, &turned, &mut self.inputs, time)?;
        self.check_room()?;
        self.settle();
        self.check_creep(&self.boundary(time))
    }
}
