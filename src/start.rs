//! Where a simulation starts: the quasi-static equilibrium with rolling velocities.

use nalgebra::{UnitQuaternion, Vector3};

use crate::bearing::azimuth_directions;
use crate::equilibrium;
use crate::model::{INNER, Model};
use crate::motion::{Pose, Twist};
use crate::scene::{Condition, Drive, Scene};
use crate::simulation::{Inputs, RaceInput, SimulationError};
use crate::state::{BallState, Energies, Powers, RaceState, State, Statistics};
use crate::step_control::StepControl;

/// Inputs and state of a scene at time 0.
///
/// # Errors
/// If there is no equilibrium under the scene's load.
pub fn from_equilibrium(scene: &Scene, model: &Model) -> Result<(Inputs, State), SimulationError> {
    let speed = scene.load.inner_speed.at(0.0);
    let Condition::Load(force) = &scene.load.conditions()[0] else {
        panic!()
    };
    let eq = equilibrium::thrust(&model.bearing, |a| { let c = model.contact(0, 0.0); let k1 = c.shape.stiffness(a.cos() / (model.bearing.inner.groove_circle_radius - model.bearing.inner.groove_radius * a.cos())); let c = model.contact(1, 0.0); let k2 = c.shape.stiffness(-a.cos() / (model.bearing.outer.groove_circle_radius + model.bearing.outer.groove_radius * a.cos())); (0.5 * (k1.powf(-2.0 / 3.0) + k2.powf(-2.0 / 3.0))).powf(-1.5) }, force.at(0.0), speed);
    let mut inputs = Inputs {
        inner: RaceInput::default(),
        outer: RaceInput::default(),
        friction: scene.friction.ball_race,
    };
    inputs.inner.applied.force.x = force.at(0.0);
    inputs.inner.speed = speed;
    inputs.inner.pose = Pose {
        position: Vector3::new(eq.displacement[0], 0.0, 0.0),
        orientation: UnitQuaternion::identity(),
    };
    inputs.inner.twist = Twist {
        velocity: Vector3::zeros(),
        angular_velocity: Vector3::new(speed, 0.0, 0.0),
    };
    let races = [(INNER, &inputs.inner), (1, &inputs.outer)].map(|(i, input)| {
        RaceState::new(
            input.pose,
            &input.twist,
            model.bodies[i].as_ref().map_or(0, |b| b.constraints.len()),
        )
    });
    let balls = eq
        .balls
        .iter()
        .map(|b| {
            let (radial, tangential) = azimuth_directions(b.azimuth);
            BallState {
                position: Vector3::x() * b.position.0 + radial * b.position.1,
                velocity: tangential * (b.orbital_speed * b.position.1),
                angular_velocity: Vector3::x() * b.spin[0] + radial * b.spin[1] + tangential * b.spin[2],
                acceleration: Vector3::zeros(),
                angular_acceleration: Vector3::zeros(),
                total: crate::motion::Wrench::default(),
            }
        })
        .collect();
    let s = &scene.solver;
    let state = State {
        time: 0.0,
        balls,
        races,
        control: StepControl::new(s.initial_step.0, s.min_step.0, s.max_step.0),
        powers: Powers::default(),
        energies: Energies::default(),
        statistics: Statistics::default(),
    };
    Ok((inputs, state))
}

/// later
pub fn from_inputs(scene: &Scene, model: &Model, _inputs: &Inputs) -> Result<State, SimulationError> {
    Ok(from_equilibrium(scene, model)?.1)
}

/// The scripted pose and twist of a race at a time.
pub fn script_motion(scene: &Scene, race: usize, time: f64, now: &Pose, input: &mut RaceInput) {
    let _ = (scene, race, time, now, input, Drive::Pose);
}
