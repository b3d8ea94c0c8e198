//! Where a simulation starts: the quasi-static equilibrium with rolling velocities.

use nalgebra::{DMatrix, SMatrix, Vector3};

use super::error::SimulationError;
use super::inputs::Inputs;
use super::orientation::{own_spin, pose_of, spin_free, tilt_of, turn_of};
use super::start_state::{apply, base_inputs, place_fixed, state};
use super::{Simulation, supported};
use crate::equilibrium::{self, Equilibrium, EquilibriumInput, Gyroscopic, Prescribed};
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
    let (problem, solution) = solved(scene, model, inputs, time)?;
    let poses = PerRace { inner: inputs.inner.pose, outer: inputs.outer.pose };
    Ok(State { time, ..state(scene, model, inputs, &problem, &solution, &poses)? })
}

/// The equilibrium for given inputs, which then have the place of a race that a wrench moves.
fn solved(
    scene: &Scene,
    model: &Model,
    inputs: &mut Inputs,
    time: f64,
) -> Result<(EquilibriumInput, Equilibrium), SimulationError> {
    let (problem, origin) = problem_of(Race::loaded(scene), scene, inputs, time);
    let (race, moves) = (problem.race, problem.race.section(scene).drive == Drive::Wrench);
    let solution = equilibrium::solve(model, &problem)?;
    if moves {
        let Pose { position, orientation } = pose_of(&solution);
        let input = &mut inputs[race];
        input.pose = Pose { position: origin + position, orientation };
        let angular_velocity = orientation * Vector3::x() * input.speed;
        input.twist = Twist { velocity: Vector3::zeros(), angular_velocity };
    }
    Ok((problem, solution))
}

/// External load that holds the inner race, a race with given motion, where the inputs put it, and its derivative by that race's
/// displacement: forces along x, y, z \[N], moments about y, z [N m], in the bearing's frame. An outer race under a wrench follows it.
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
    let goes_along = scene.outer.drive == Drive::Wrench;
    if goes_along {
        solved(scene, model, inputs, time)?;
    }
    // The outer race is then where it is in balance.
    let (problem, _) = problem_of(Race::Inner, scene, inputs, time);
    let solution = equilibrium::solve(model, &problem)?;
    let stiffness = match goes_along {
        true => followed(
            &solution.stiffness,
            Race::Outer.directions(scene).map(|direction| direction.motion.is_none()),
        ),
        false => solution.stiffness,
    };
    Ok((solution.load, stiffness))
}

/// What is left of the stiffness between two races where one of them follows the other in some directions.
fn followed(stiffness: &SMatrix<f64, 5, 5>, follows: [bool; 5]) -> SMatrix<f64, 5, 5> {
    let pick = |wanted: bool| -> Vec<usize> { (0..5).filter(|i| follows[*i] == wanted).collect() };
    let (free, held) = (pick(true), pick(false));
    if free.is_empty() {
        return *stiffness;
    }
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, k| stiffness[(rows[i], columns[k])])
    };
    let mut left = part(&held, &held);
    if let Some(way) = part(&free, &free).lu().solve(&part(&free, &held)) {
        left -= part(&held, &free) * way;
    }
    let mut whole = SMatrix::zeros();
    for (i, row) in held.iter().enumerate() {
        for (k, column) in held.iter().enumerate() {
            whole[(*row, *column)] = left[(i, k)];
        }
    }
    whole
}

impl Simulation {
    /// The equilibrium of the bearing under its present inputs: races with given motion where they are, a race under a wrench under it.
    pub fn equilibrium_input(&self) -> EquilibriumInput {
        let scene = &self.scene;
        problem_of(Race::loaded(scene), scene, &mut self.inputs.clone(), self.state.time).0
    }
}

/// The equilibrium of one race against the other for given inputs, and where the bearing frame is \[m].
fn problem_of(race: Race, scene: &Scene, inputs: &mut Inputs, time: f64) -> (EquilibriumInput, Vector3<f64>) {
    place_fixed(scene, inputs);
    let mut problem = EquilibriumInput { race, ..EquilibriumInput::at(scene, Gyroscopic::Friction, time) };
    let resting = match race {
        Race::Inner => Race::Outer,
        Race::Outer => Race::Inner,
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
