//! Inputs and state of a solved equilibrium.

use nalgebra::{UnitQuaternion, Vector3};

use super::cage_start;
use super::error::SimulationError;
use super::inputs::{Inputs, RaceInput};
use super::orientation::{own_spin, pose_of, spin_free};
use super::script::hinge;
use super::spin_balance::{Surroundings, balance};
use crate::effects::EffectInputs;
use crate::effects::growth::Grown;
use crate::effects::moving_frame::{FrameInputs, FrameMotion};
use crate::effects::reports::Warm;
use crate::effects::support::Support;
use crate::equilibrium::{self, BallEquilibrium, EquilibriumInput, Prescribed};
use crate::model::Model;
use crate::model::bearing::azimuth_directions;
use crate::model::bodies::{Bodies, PerRace, Race};
use crate::model::energies::{Energies, Powers};
use crate::model::spacing::CommonTurn;
use crate::model::state::{BallState, BodyState, KeptMatrix, State, Statistics, Trend};
use crate::numerics::motion::{FrameInput, Pose, Twist, Wrench};
use crate::numerics::step_control::StepControl;
use crate::scene::{Drive, Scene};

/// Inputs of a scene whose problem is solved.
pub fn base_inputs(
    scene: &Scene,
    model: &Model,
    problem: &EquilibriumInput,
    solution: &equilibrium::Equilibrium,
) -> Inputs {
    let pose = |race: Race| if race == problem.race { pose_of(solution) } else { problem.resting };
    // What is applied is what the scene says; directions with an imposed motion are held by constraints.
    let load = |direction: usize| match problem.conditions[direction] {
        Prescribed::Load(load) => load,
        Prescribed::Motion(_) => 0.0,
    };
    let applied = Wrench {
        force: Vector3::new(load(0), load(1), load(2)),
        moment: Vector3::new(0.0, load(3), load(4)),
    };
    let on = |race: Race| if race == problem.race { applied } else { Wrench::default() };
    let mut inputs = Inputs {
        inner: spinning(pose(Race::Inner), problem.inner_speed, on(Race::Inner)),
        outer: spinning(pose(Race::Outer), problem.outer_speed, on(Race::Outer)),
        friction: problem.friction,
        rises: model.growth.map(|_| problem.rises),
        effects: EffectInputs {
            frame: FrameInputs {
                motion: problem.frame,
                rate: FrameMotion::default(),
                accelerates: scene
                    .effects
                    .frame
                    .section
                    .as_ref()
                    .is_some_and(|section| section.angular_acceleration.is_some()),
            },
            lubrication: problem.lubrication,
        },
    };
    if let Some(velocity) = scene.start.inner_velocity {
        inputs.inner.twist.velocity = Vector3::from(velocity.map(|component| component.0));
    }
    inputs
}

/// Puts races that are fixed or hinged into their frames, which rest at the start.
pub fn place_fixed(scene: &Scene, inputs: &mut Inputs) {
    for (race, section) in [(Race::Inner, &scene.inner), (Race::Outer, &scene.outer)] {
        // Its frame rests at the start.
        if matches!(section.drive, Drive::Fixed | Drive::Hinge) {
            let input = &mut inputs[race];
            if section.drive == Drive::Hinge && input.frame != FrameInput::default() {
                input.pose = hinge(section, &input.frame, 0.0);
            }
            input.twist.angular_velocity = input.pose.orientation * Vector3::x() * input.speed;
        }
    }
}

/// Gives the equilibrium of a race the wrench that is applied to it, where it is not held, and places from where the other race is.
pub fn apply(problem: &mut EquilibriumInput, applied: &Wrench) {
    let Wrench { force, moment } = applied;
    let loads = [force.x, force.y, force.z, moment.y, moment.z];
    for (direction, (condition, load)) in problem.conditions.iter_mut().zip(loads).enumerate() {
        match condition {
            Prescribed::Load(value) => *value = load,
            Prescribed::Motion(value) => *value -= problem.origin.get(direction).unwrap_or(&0.0),
        }
    }
}

/// A race that spins about its own axis.
fn spinning(pose: Pose, speed: f64, applied: Wrench) -> RaceInput {
    let angular_velocity = pose.orientation * Vector3::x() * speed;
    let twist = Twist { velocity: Vector3::zeros(), angular_velocity };
    RaceInput { pose, twist, applied, speed, ..RaceInput::default() }
}

/// Twist of a race at a pose: a race on a support follows its flange, and spins about its own axis.
fn twist_of(model: &Model, inputs: &Inputs, race: Race, pose: &Pose) -> Twist {
    let given = &inputs[race];
    if model.supports[race].is_none() {
        return given.twist;
    }
    let axes = [given.pose.orientation, pose.orientation].map(|orientation| orientation * Vector3::x());
    let spin = own_spin(given);
    let angular_velocity = given.twist.angular_velocity + (axes[1] - axes[0]) * spin;
    Twist { velocity: given.twist.velocity, angular_velocity }
}

/// The state of a solution: balls roll, races move as the inputs say.
///
/// # Errors
/// If a cage does not fit.
pub fn state(
    scene: &Scene,
    model: &Model,
    inputs: &Inputs,
    problem: &EquilibriumInput,
    solution: &equilibrium::Equilibrium,
    poses: &PerRace<Pose>,
) -> Result<State, SimulationError> {
    let races = PerRace::new(|race| {
        let n_constraints = model.bodies[race].as_ref().map_or(0, |body| body.constraints.len());
        BodyState::new(poses[race], &twist_of(model, inputs, race, &poses[race]), n_constraints)
    });
    let supports = PerRace::new(|race| {
        let flange = &inputs[race];
        let body: &BodyState = &races[race];
        let of =
            |support: &Support| support.state((&flange.pose, &flange.twist), (&body.pose, &body.twist()));
        model.supports[race].as_ref().map(of)
    });
    let outer = &races.outer;
    let frame = spin_free(&outer.pose.orientation);
    let mut balls: Vec<BallState> = solution
        .balls
        .iter()
        .map(|ball| {
            let (velocity, angular_velocity) = given_velocities(scene, ball);
            BallState {
                position: outer.pose.position + frame * ball.position,
                velocity: outer.velocity + frame * velocity,
                angular_velocity: frame * angular_velocity,
                acceleration: Vector3::zeros(),
                angular_acceleration: Vector3::zeros(),
                total: Wrench::default(),
                remainder: Wrench::default(),
                pressed: PerRace::default(),
            }
        })
        .collect();
    let keep_apart = |balls: &mut [BallState]| {
        let spacing = model.spacing.as_ref()?;
        let velocity = model.bodies[Race::Outer].as_ref().map_or(outer.velocity, |_| Vector3::zeros());
        let turn = CommonTurn::of_balls(spacing, balls, outer.pose.position, velocity);
        turn.place(spacing, balls);
        Some(turn)
    };
    keep_apart(&mut balls);
    let orientations = model
        .damaged
        .as_ref()
        .map(|damaged| damaged.at_start.iter().map(|orientation| frame * orientation).collect::<Vec<_>>());
    if scene.start.balances_spin() {
        let conditions = problem.with_friction();
        let around = Surroundings {
            model,
            contacts: model.contacts_oriented(&conditions, orientations.as_ref()),
            ambient: model.ambient(&inputs.effects.frame.motion),
            races: PerRace::new(|race| races[race].motion()),
        };
        let mut motions: Vec<_> = balls.iter().map(BallState::motion).collect();
        balance(&around, &mut motions);
        for (ball, motion) in balls.iter_mut().zip(&motions) {
            (ball.velocity, ball.angular_velocity) = (motion.velocity, motion.angular_velocity);
        }
    }
    let spacing = keep_apart(&mut balls);
    let cage = match &model.cage {
        Some(cage) => {
            let centred = among(&balls, outer.pose.position, frame);
            let radius = 0.5 * model.bearing.pitch_diameter;
            Some(cage_start::place(cage, &balls, &races, centred, radius, solution.cage_speed)?)
        }
        None => None,
    };
    let solver = &scene.solver;
    Ok(State {
        time: 0.0,
        bodies: Bodies::new(races, cage),
        supports,
        spacing,
        differences: if model.polynomials(Race::Inner).is_some() {
            vec![Default::default(); balls.len()]
        } else {
            vec![]
        },
        balls,
        control: StepControl::new(solver.initial_step.0, solver.min_step.0, solver.max_step.0),
        force_tolerance: 0.0,
        matrix: KeptMatrix::default(),
        trend: Trend::default(),
        powers: Powers::default(),
        energies: Energies::default(),
        statistics: Statistics::default(),
        grown: model.growth.map(|_| Grown { warmth: problem.surroundings().warmth, ..Grown::default() }),
        rating: model.rating.map(|_| Default::default()),
        warm: model.heat_balance.map(|_| Warm { rises: problem.rises, out: 0.0 }),
        heat: model.heat_outputs.then(Default::default),
        means: model.mean_outputs.then(Default::default),
        orientations,
    })
}

/// Pose in the middle of the balls, with the axes of a frame.
fn among(balls: &[BallState], origin: Vector3<f64>, frame: UnitQuaternion<f64>) -> Pose {
    let axis = frame * Vector3::x();
    let axial =
        balls.iter().map(|ball| axis.dot(&(ball.position - origin))).sum::<f64>() / balls.len() as f64;
    Pose { position: origin + axis * axial, orientation: frame }
}

/// Velocity of a ball's centre and its angular velocity in the outer race's frame: the scene's, or those of rolling.
fn given_velocities(scene: &Scene, ball: &BallEquilibrium) -> (Vector3<f64>, Vector3<f64>) {
    let (radial, tangential) = azimuth_directions(ball.azimuth);
    let velocity = scene
        .start
        .orbital_speed
        .map_or(ball.velocity, |speed| tangential * (speed.0 * ball.position.dot(&radial)));
    let angular_velocity = scene.start.ball_angular_velocity.map_or(ball.angular_velocity, |given| {
        Vector3::x() * given[0].0 + radial * given[1].0 + tangential * given[2].0
    });
    (velocity, angular_velocity)
}
