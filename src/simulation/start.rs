//! Where a simulation starts: the quasi-static equilibrium with rolling velocities.

use nalgebra::{SMatrix, Vector3};

use super::error::SimulationError;
use super::inputs::Inputs;
use super::orientation::{own_spin, pose_of, spin_free, tilt_of, turn_of};
use super::start_state::{apply, base_inputs, place_fixed, state};
use super::{Simulation, supported};
use crate::equilibrium::{self, EquilibriumInput, Gyroscopic, Prescribed};
use crate::model::Model;
use crate::model::bodies::{PerRace, Race};
use crate::model::state::State;
use crate::numerics::motion::{Pose, Twist};
use crate::scene::{Drive, Scene};

/// Inputs and state of a scene at a time \[s] of its script: the equilibrium under the scene's load, every race spinning about its own
/// axis at its scripted speed.
///
/// # Errors
/// If there is no equilibrium under the scene's load.
pub fn from_equilibrium(scene: &Scene, model: &Model, time: f64) -> Result<(Inputs, State), SimulationError> {
    if supported::is_supported(model) {
        return supported::from_scene(scene, model, time);
    }
    let problem = EquilibriumInput::at(scene, Gyroscopic::Friction, time);
    let solution = equilibrium::solve(model, &problem)?;
    let inputs = base_inputs(scene, model, &problem, &solution);
    let poses = PerRace { inner: inputs.inner.pose, outer: inputs.outer.pose };
    let state = State { time, ..state(scene, model, &inputs, &problem, &solution, &poses)? };
    Ok((inputs, state))
}

/// State for given inputs: races with given motion are where the inputs put them, a race body is in equilibrium under
/// its applied wrench, in the directions that the scene does not hold where its script is at `time` \[s].
///
/// # Errors
/// If there is no equilibrium.
pub fn from_inputs(
    scene: &Scene,
    model: &Model,
    inputs: &mut Inputs,
    time: f64,
) -> Result<State, SimulationError> {
    if supported::is_supported(model) {
        return supported::from_inputs(scene, model, inputs, time);
    }
    let (problem, origin) = problem_of(scene, inputs, time);
    let (race, moves) = (problem.race, problem.race.section(scene).drive == Drive::Wrench);
    let solution = equilibrium::solve(model, &problem)?;
    if moves {
        let Pose { position, orientation } = pose_of(&solution);
        let input = &mut inputs[race];
        input.pose = Pose { position: origin + position, orientation };
        let angular_velocity = orientation * Vector3::x() * input.speed;
        input.twist = Twist { velocity: Vector3::zeros(), angular_velocity };
    }
    let poses = PerRace { inner: inputs.inner.pose, outer: inputs.outer.pose };
    Ok(State { time, ..state(scene, model, inputs, &problem, &solution, &poses)? })
}

/// External load that holds the inner race, a race with given motion, where the inputs put it, and its derivative by that race's
/// displacement: forces along x, y, z \[N], moments about y, z [N m], in the bearing's frame.
///
/// # Errors
/// If there is no equilibrium.
pub fn held_load(
    scene: &Scene,
    model: &Model,
    inputs: &mut Inputs,
    time: f64,
) -> Result<([f64; 5], SMatrix<f64, 5, 5>), SimulationError> {
    if supported::is_supported(model) {
        return supported::held_load(scene, model, inputs, time);
    }
    let (problem, _) = problem_of(scene, inputs, time);
    let solution = equilibrium::solve(model, &problem)?;
    Ok((solution.load, solution.stiffness))
}

impl Simulation {
    /// The equilibrium of the bearing under its present inputs: races with given motion where they are, a race under a wrench under it.
    pub fn equilibrium_input(&self) -> EquilibriumInput {
        problem_of(&self.scene, &mut self.inputs.clone(), self.state.time).0
    }
}

/// The equilibrium for given inputs, and where the bearing frame is \[m].
fn problem_of(scene: &Scene, inputs: &mut Inputs, time: f64) -> (EquilibriumInput, Vector3<f64>) {
    place_fixed(scene, inputs);
    let mut problem = EquilibriumInput::at(scene, Gyroscopic::Friction, time);
    let (race, resting) = match problem.race {
        Race::Inner => (Race::Inner, Race::Outer),
        Race::Outer => (Race::Outer, Race::Inner),
    };
    // Places are taken from the race that rests, wherever that is.
    let origin = inputs[resting].pose.position;
    problem.friction = inputs.friction;
    problem.lubrication = inputs.effects.lubrication;
    problem.frame = inputs.effects.frame.motion;
    problem.origin = origin;
    problem.rises = inputs.rises.unwrap_or_default();
    problem.resting =
        Pose { position: Vector3::zeros(), orientation: spin_free(&inputs[resting].pose.orientation) };
    problem.turned = PerRace::new(|race| turn_of(&inputs[race].pose.orientation));
    let moves = race.section(scene).drive == Drive::Wrench;
    let speed = |of: Race| if of == race && moves { inputs[of].speed } else { own_spin(&inputs[of]) };
    (problem.inner_speed, problem.outer_speed) = (speed(Race::Inner), speed(Race::Outer));
    if moves {
        apply(&mut problem, &inputs[race].applied);
    } else {
        let relative = inputs.inner.pose.position - origin;
        let tilt = tilt_of(&inputs.inner.pose);
        let motion = [relative.x, relative.y, relative.z, tilt.y, tilt.z];
        problem.conditions = motion.map(Prescribed::Motion);
    }
    (problem, origin)
}
