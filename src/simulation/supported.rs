//! Starts of a bearing whose races rest on flexible supports: races and balls are in balance, the flanges are where the inputs
//! or the scene put them.

use nalgebra::{SMatrix, SVector, UnitQuaternion, Vector3};

use super::SimulationError;
use super::inputs::Inputs;
use super::orientation::{own_spin, pose_of, spin_free, turn_of};
use super::start_state::{apply, base_inputs, place_fixed, state};
use crate::equilibrium::{self, Equilibrium, EquilibriumInput, Gyroscopic, Prescribed};
use crate::forces::{Contacts, Totals};
use crate::model::bodies::{PerRace, Race};
use crate::model::state::State;
use crate::model::{Conditions, Model};
use crate::numerics::motion::{Pose, Twist, Wrench};
use crate::numerics::rotation::tilt_to;
use crate::scene::{Drive, Scene};

/// Most rounds of the deflection of a second race, and of the place of a flange under given loads.
const ROUNDS: usize = 60;
/// [-] change of a deflection over the ball diameter, and of a load over the largest, that is none.
const SETTLED: f64 = 1e-12;
const LOADED: f64 = 1e-10;
/// [-] stiffness of a support that a flange keeps where the bearing gives way, over that of the support.
const SLACK: f64 = 1e-6;

type Five = SVector<f64, 5>;
type Stiffness = SMatrix<f64, 5, 5>;

/// Does a race of the model rest on a support?
pub fn is_supported(model: &Model) -> bool {
    model.supports.iter().any(Option::is_some)
}

/// Inputs and state of a scene at a time \[s]. Where the scene gives displacements they are the flange's; where it gives loads or
/// nothing, the flange is where it takes these loads.
pub fn from_scene(scene: &Scene, model: &Model, time: f64) -> Result<(Inputs, State), SimulationError> {
    let problem = EquilibriumInput::at(scene, Gyroscopic::Friction, time);
    let stiff = equilibrium::solve(model, &problem)?;
    let mut inputs = base_inputs(scene, model, &problem, &stiff);
    let given = problem.conditions;
    let loads = |i: usize| match given[i] {
        Prescribed::Load(load) => Some(load),
        Prescribed::Motion(_) => None,
    };
    let free: Vec<usize> = (0..5).filter(|&i| loads(i).is_some()).collect();
    if let (Some(support), Race::Inner, false) = (&model.supports.inner, problem.race, free.is_empty()) {
        // As if the race carried the loads and the flange moved with it.
        let held = support.stiffness();
        let deflection = held.lu().solve(&Five::from(stiff.load)).unwrap_or_else(Five::zeros);
        let mut flange = Five::from(stiff.displacement);
        for &i in &free {
            flange[i] += deflection[i];
        }
        let largest = stiff.balls.iter().map(|ball| ball.report.inner_load).fold(1.0, f64::max);
        let length = model.race_length();
        for _ in 0..ROUNDS {
            inputs.inner.pose = pose(&flange);
            inputs.inner.twist.angular_velocity =
                inputs.inner.pose.orientation * Vector3::x() * problem.inner_speed;
            let (state, solution) = solve(scene, model, &mut inputs, time)?;
            let on_flange = state.supports.inner.map(|support| support.wrench).unwrap_or_default();
            let taken = [
                -on_flange.force.x,
                -on_flange.force.y,
                -on_flange.force.z,
                -on_flange.moment.y,
                -on_flange.moment.z,
            ];
            let missing = Five::from_fn(|i, _| loads(i).map_or(0.0, |load| load - taken[i]));
            let size = |i: usize| if i < 3 { 1.0 } else { length };
            if (0..5).all(|i| missing[i].abs() <= LOADED * largest * size(i)) {
                break;
            }
            let mut matrix = in_series(&held, &solution.stiffness) + held * SLACK;
            for i in (0..5).filter(|i| loads(*i).is_none()) {
                matrix.row_mut(i).fill(0.0);
                matrix[(i, i)] = 1.0;
            }
            flange += matrix.lu().solve(&missing).unwrap_or_else(Five::zeros);
        }
    }
    let (state, _) = solve(scene, model, &mut inputs, time)?;
    Ok((inputs, state))
}

/// State for given inputs.
pub fn from_inputs(
    scene: &Scene,
    model: &Model,
    inputs: &mut Inputs,
    time: f64,
) -> Result<State, SimulationError> {
    solve(scene, model, inputs, time).map(|(state, _)| state)
}

/// External load that holds the inner race where the inputs put it, and its derivative by that race's displacement.
pub fn held_load(
    scene: &Scene,
    model: &Model,
    inputs: &mut Inputs,
    time: f64,
) -> Result<([f64; 5], Stiffness), SimulationError> {
    let (state, solution) = solve(scene, model, inputs, time)?;
    let conditions = EquilibriumInput::at(scene, Gyroscopic::Friction, time).with_friction();
    let contacts = Contacts::new(model, &state, &conditions);
    let Wrench { force, moment } = Totals::of(&contacts, state.balls.len()).on(Race::Inner.into());
    let stiffness = match &model.supports.outer {
        Some(support) => in_series(&support.stiffness(), &solution.stiffness),
        None => solution.stiffness,
    };
    Ok(([-force.x, -force.y, -force.z, -moment.y, -moment.z], stiffness))
}

/// Stiffness of a support in series with a bearing.
fn in_series(support: &Stiffness, bearing: &Stiffness) -> Stiffness {
    let sum = (support + bearing).lu();
    sum.solve(bearing).map_or_else(Stiffness::zeros, |follow| support * follow)
}

/// Pose of these displacements and components of a rotation vector.
fn pose(place: &Five) -> Pose {
    Pose {
        position: Vector3::new(place[0], place[1], place[2]),
        orientation: UnitQuaternion::new(Vector3::new(0.0, place[3], place[4])),
    }
}

fn solve(
    scene: &Scene,
    model: &Model,
    inputs: &mut Inputs,
    time: f64,
) -> Result<(State, Equilibrium), SimulationError> {
    place_fixed(scene, inputs);
    let scripted = EquilibriumInput::at(scene, Gyroscopic::Friction, time);
    let supported = |race: Race| model.supports[race].is_some();
    let under_wrench = |race: Race| race.section(scene).drive == Drive::Wrench;
    // The equilibrium moves one race: one that loads move, or else one on a support.
    let race = match scripted.race {
        Race::Inner if !supported(Race::Inner) && !under_wrench(Race::Inner) => Race::Outer,
        race => race,
    };
    let resting = match race {
        Race::Inner => Race::Outer,
        Race::Outer => Race::Inner,
    };
    let speed = |of: Race| if under_wrench(of) { inputs[of].speed } else { own_spin(&inputs[of]) };
    let speeds = PerRace::new(speed);
    let mut held = inputs[resting].pose;
    let mut rounds = 0;
    loop {
        rounds += 1;
        let origin = held.position;
        let mut problem = EquilibriumInput {
            race,
            inner_speed: speeds.inner,
            outer_speed: speeds.outer,
            resting: Pose { position: Vector3::zeros(), orientation: spin_free(&held.orientation) },
            turned: PerRace::new(|of| {
                turn_of(if of == resting { &held.orientation } else { &inputs[of].pose.orientation })
            }),
            friction: inputs.friction,
            lubrication: inputs.effects.lubrication,
            rises: inputs.rises.unwrap_or_default(),
            frame: inputs.effects.frame.motion,
            origin,
            ..scripted.clone()
        };
        if under_wrench(race) {
            apply(&mut problem, &inputs[race].applied);
        } else {
            problem.conditions = [Prescribed::Load(0.0); 5];
            let flange = inputs[race].pose;
            problem.flange = Some(Pose { position: flange.position - origin, ..flange });
        }
        let solution = equilibrium::solve(model, &problem)?;
        let Pose { position, orientation } = pose_of(&solution);
        let turned = match under_wrench(race) {
            true => UnitQuaternion::identity(),
            false => own_turn(&inputs[race].pose.orientation),
        };
        let moved = Pose { position: origin + position, orientation: orientation * turned };
        let mut poses = PerRace { inner: moved, outer: held };
        if race == Race::Outer {
            poses = PerRace { inner: held, outer: moved };
        }
        if under_wrench(race) {
            inputs[race].pose = poses[race];
            let angular_velocity = poses[race].orientation * Vector3::x() * inputs[race].speed;
            inputs[race].twist = Twist { velocity: Vector3::zeros(), angular_velocity };
        }
        let mut start = State { time, ..state(scene, model, inputs, &problem, &solution, &poses)? };
        let conditions = problem.with_friction();
        let change =
            deflect(model, (inputs, &conditions), resting, &mut start, &solution, under_wrench(race));
        let Some((pose, size)) = change else {
            return Ok((start, solution));
        };
        held = pose;
        if size <= SETTLED * 2.0 * model.bearing.ball.radius || rounds == ROUNDS {
            return Ok((start, solution));
        }
    }
}

/// Pose of a resting race on a support under what the bearing does to it, and by how much that differs \[m]; none without a support.
fn deflect(
    model: &Model,
    (inputs, conditions): (&Inputs, &Conditions),
    race: Race,
    state: &mut State,
    solution: &Equilibrium,
    free: bool,
) -> Option<(Pose, f64)> {
    let support = model.supports[race].as_ref()?;
    let body = model.bodies[race].as_ref()?;
    let contacts = Contacts::new(model, state, conditions);
    let Wrench { mut force, moment } = Totals::of(&contacts, state.balls.len()).on(race.into());
    let ambient = model.ambient(&inputs.effects.frame.motion);
    let pose = state.race(race).pose;
    force += ambient.gravity * body.mass;
    if let Some(frame) = &ambient.frame {
        force += frame.field(&pose.position, &Vector3::zeros()) * body.mass;
    }
    let held = state.supports[race].as_ref()?;
    let flange = inputs[race].pose.orientation;
    // The support's wrench on the race, about the race's origin.
    let arm = pose.position - inputs[race].pose.position;
    let on_race =
        Wrench { force: -held.wrench.force, moment: -held.wrench.moment - arm.cross(&-held.wrench.force) };
    let force = flange.inverse() * (force + on_race.force);
    let moment = flange.inverse() * (moment + on_race.moment);
    let missing = Five::new(force.x, force.y, force.z, moment.y, moment.z);
    // What moves with the race gives way, if it is free.
    let other = match race {
        Race::Inner => &model.supports.outer,
        Race::Outer => &model.supports.inner,
    };
    let around = match other {
        _ if free => Stiffness::zeros(),
        Some(other) => in_series(&other.stiffness(), &solution.stiffness),
        None => solution.stiffness,
    };
    let step = (support.stiffness() + around).lu().solve(&missing)?;
    let turn = UnitQuaternion::new(Vector3::new(0.0, step[3], step[4]));
    let relative = flange.inverse() * pose.orientation;
    let pose = Pose {
        position: pose.position + flange * Vector3::new(step[0], step[1], step[2]),
        orientation: UnitQuaternion::new_normalize((flange * turn * relative).into_inner()),
    };
    let length = model.race_length();
    Some((pose, step.fixed_rows::<3>(0).norm() + length * step.fixed_rows::<2>(3).norm()))
}

/// Turn of a race about its own axis.
fn own_turn(orientation: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    tilt_to(&(orientation * Vector3::x())).inverse() * orientation
}
