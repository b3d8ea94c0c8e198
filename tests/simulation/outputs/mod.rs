//! Every reported quantity of a bearing against mechanics in own formulas (tests/common/mechanics.rs): values, signs,
//! frames and units.

use std::f64::consts::{PI, TAU};

use nalgebra::{UnitQuaternion, Vector2};
use roulement::model::Conditions;
use roulement::model::Model;
use roulement::model::bodies::{Body as BodyName, Race};
use roulement::model::state::{BallState, BodyState, State};
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::{ContactOutput, Outputs};

use crate::mechanics::{Body, CageDimensions, Contact, Dimensions, Land, V, grooves};
use crate::random::vector;
use crate::scenes;

mod contacts;
mod sums;

const DIAMETER: f64 = 9.525e-3;
const RADIUS: f64 = 0.5 * DIAMETER;
const PITCH: f64 = 46e-3;
const ANGLE: f64 = 0.44;
const CONFORMITIES: [f64; 2] = [0.515, 0.525];
const BALLS: usize = 9;
const FIRST: f64 = 0.2;
/// Silicon nitride in steel.
const MATERIALS: [(f64, f64); 2] = [(310e9, 0.26), (206e9, 0.29)];
const BRASS: (f64, f64) = (105e9, 0.3);
const DENSITY: f64 = 3200.0;
const GRAVITY: [f64; 3] = [1.0, -3.0, -9.0];
const MASSES: [f64; 3] = [0.2, 0.3, 0.02];
const INERTIAS: [[f64; 3]; 3] = [[6e-5, 4e-5, 4e-5], [9e-5, 6e-5, 6e-5], [1.1e-5, 6e-6, 7e-6]];
const CLEARANCE: f64 = 0.2e-3;
const TILT: [f64; 2] = [0.8e-3, -0.5e-3];
const SPEEDS: [f64; 2] = [600.0, -150.0];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Guide {
    Inner,
    Outer,
    Balls,
}

fn dimensions() -> Dimensions {
    Dimensions {
        ball_radius: RADIUS,
        grooves: grooves(DIAMETER, PITCH, ANGLE, CONFORMITIES),
        materials: MATERIALS,
        friction: 0.07,
        damping: 0.02,
    }
}

fn cage_dimensions(guide: Guide) -> CageDimensions {
    let land = |race, diameter| Some((race, CLEARANCE, diameter, 2e-3));
    CageDimensions {
        ball_radius: RADIUS,
        materials: [MATERIALS[0], BRASS],
        pocket_clearance: CLEARANCE,
        ball_friction: 0.05,
        land_friction: 0.06,
        damping: 0.5,
        sphere: (guide == Guide::Balls).then_some(0.5 * PITCH),
        lands: match guide {
            Guide::Inner => land(0, 40e-3),
            Guide::Outer => land(1, 52e-3),
            Guide::Balls => None,
        },
    }
}

/// Thrust, radial load and tilt on turning races, the outer one on a misaligned hinge; hybrid, with a cage.
fn scene(guide: Guide) -> String {
    let (guided_by, lands) = match guide {
        Guide::Inner => ("inner", "land_diameter = 0.04"),
        Guide::Outer => ("outer", "land_diameter = 0.052"),
        Guide::Balls => ("balls", ""),
    };
    let (lands, race_friction) = if lands.is_empty() {
        (String::new(), "")
    } else {
        (format!("{lands}\nguidance_clearance = {CLEARANCE}\nland_width = 2e-3"), "cage_race = 0.06")
    };
    let body = |i: usize| format!("mass = {}\ninertia = {:?}", MASSES[i], INERTIAS[i]);
    let [(ball_e, ball_nu), (race_e, race_nu)] = MATERIALS;
    format!(
        "[bearing]\nballs = {BALLS}\nball_diameter = {DIAMETER}\npitch_diameter = {PITCH}\ncontact_angle = {ANGLE}\n\
         inner_conformity = {}\nouter_conformity = {}\nfirst_ball_azimuth = {FIRST}\n\
         [ball]\nyoungs_modulus = {ball_e:?}\npoisson_ratio = {ball_nu}\ndensity = {DENSITY:?}\n\
         [race]\nyoungs_modulus = {race_e:?}\npoisson_ratio = {race_nu}\n\
         [friction]\nball_race = 0.07\nball_cage = 0.05\n{race_friction}\n\
         [effects]\ncreep = \"saturated\"\ndamping = 0.02\ncage = true\ngravity = {GRAVITY:?}\n\
         [cage]\n{}\npocket_clearance = {CLEARANCE}\nguided_by = \"{guided_by}\"\n{lands}\n\
         youngs_modulus = {:?}\npoisson_ratio = {}\ndamping = 0.5\n\
         [inner]\ndrive = \"wrench\"\n{}\n\
         [outer]\ndrive = \"hinge\"\n{}\nmisalignment = {{ ry = {}, rz = {} }}\n\
         [solver]\nalpha_f = 0.05\ninitial_step = 1e-6\nmax_step = 1e-5\n\
         [load]\ninner_speed = {:?}\nouter_speed = {:?}\nx = {{ force = 1500.0 }}\ny = {{ force = 300.0 }}\n\
         z = {{ displacement = 2e-6 }}\nry = {{ moment = 2.0 }}\nrz = {{ rotation = 2e-4 }}\n",
        CONFORMITIES[0],
        CONFORMITIES[1],
        body(2),
        BRASS.0,
        BRASS.1,
        body(0),
        body(1),
        TILT[0],
        TILT[1],
        SPEEDS[0],
        SPEEDS[1],
    )
}

fn simulation(text: &str) -> Simulation {
    Simulation::new(&Scene::parse(text).unwrap()).unwrap()
}

fn body_of_ball(ball: &BallState) -> Body {
    Body {
        position: ball.position,
        orientation: UnitQuaternion::identity(),
        velocity: ball.velocity,
        omega: ball.angular_velocity,
    }
}

fn body_of(race: &BodyState) -> Body {
    Body {
        position: race.pose.position,
        orientation: race.pose.orientation,
        velocity: race.velocity,
        omega: race.pose.orientation * race.rate,
    }
}

/// [rad] of a ball's pocket in the cage.
fn azimuth(j: usize) -> f64 {
    FIRST + TAU * j as f64 / BALLS as f64
}

/// A state in general motion, and everything that the mechanics say of it.
struct Case {
    model: Model,
    state: State,
    outputs: Outputs,
    balls: Vec<[Contact; 2]>,
    pockets: Vec<(f64, Option<Contact>)>,
    lands: Option<[Land; 2]>,
    guide: Guide,
}

impl Case {
    fn of(model: &Model, state: &State, guide: Guide) -> Self {
        let races = Race::BOTH.map(|race| body_of(state.race(race)));
        let bearing = dimensions();
        let contacts = |ball: &BallState| {
            [0, 1].map(|race| bearing.ball_race(race, &body_of_ball(ball), &races[race]).unwrap())
        };
        let dimensions = cage_dimensions(guide);
        let cage = body_of(state.cage().unwrap());
        let pocket = |(j, ball): (usize, &BallState)| {
            let ball = body_of_ball(ball);
            let (approach, _) = dimensions.pocket_place(azimuth(j), &ball, &cage);
            (approach, dimensions.pocket(azimuth(j), &ball, &cage))
        };
        Self {
            model: model.clone(),
            state: state.clone(),
            outputs: Outputs::new(model, state, &Conditions::of_friction(0.07)),
            balls: state.balls.iter().map(contacts).collect(),
            pockets: state.balls.iter().enumerate().map(pocket).collect(),
            lands: dimensions.land(&cage, &races),
            guide,
        }
    }

    fn races(&self) -> [Body; 2] {
        Race::BOTH.map(|race| body_of(self.state.race(race)))
    }

    fn cage(&self) -> Body {
        body_of(self.state.cage().unwrap())
    }
}

/// States around a run of a millisecond: velocities of balls, races and cage changed by some vectors times a size, and
/// the cage pushed into pockets and lands.
fn cases() -> Vec<Case> {
    let mut cases = vec![];
    for (g, guide) in [Guide::Outer, Guide::Inner, Guide::Balls].into_iter().enumerate() {
        let mut simulation = simulation(&scene(guide));
        simulation.advance(1e-3).unwrap();
        for (k, size) in [0.003, 0.03, 0.3].into_iter().enumerate() {
            let mut state = simulation.state().clone();
            let seed = 100 * g + 1000 * k;
            for (j, ball) in state.balls.iter_mut().enumerate() {
                ball.velocity += vector(seed + 2 * j) * size;
                ball.angular_velocity += vector(seed + 2 * j + 1) * (300.0 * size);
                ball.position += vector(seed + j + 50) * 1e-7;
            }
            for (i, (_, race)) in state.bodies.iter_mut().take(2).enumerate() {
                race.velocity += vector(seed + 30 + i) * (0.3 * size);
                race.rate += vector(seed + 33 + i) * (100.0 * size);
                race.turned = 3.0 + i as f64;
            }
            let cage = state.bodies.get_mut(BodyName::Cage).unwrap();
            let push = 1.13 * 0.5 * CLEARANCE;
            let angle = 1.1 + 2.0 * k as f64;
            cage.pose.position += V::new(1e-5, push * angle.cos(), push * angle.sin());
            cage.pose.orientation = UnitQuaternion::new(V::new(2e-4, 3e-4, -2e-4)) * cage.pose.orientation;
            // Turned about its own axis until a ball is 2 um deep in its pocket.
            let depth = |cage: &BodyState| {
                let (cage, dimensions) = (body_of(cage), cage_dimensions(guide));
                let place = |(j, ball)| dimensions.pocket_place(azimuth(j), &body_of_ball(ball), &cage).0;
                state.balls.iter().enumerate().map(place).fold(f64::NEG_INFINITY, f64::max)
            };
            while depth(cage) < 2e-6 {
                cage.pose.orientation *= UnitQuaternion::new(V::x() * 1e-4);
            }
            cage.velocity += vector(seed + 40) * 0.1;
            cage.rate += vector(seed + 41) * 5.0;
            cage.turned = 7.0;
            state.bodies.iter_mut().for_each(|(_, body)| body.refresh_motion());
            cases.push(Case::of(simulation.model(), &state, guide));
        }
    }
    cases
}

#[track_caller]
fn close(what: &str, value: f64, expected: f64, tolerance: f64, scale: f64) {
    let error = (value - expected).abs();
    assert!(error <= tolerance * scale.abs().max(expected.abs()), "{what}: {value:e}, expected {expected:e}");
}

#[track_caller]
fn close_vector(what: &str, value: &V, expected: &V, tolerance: f64, scale: f64) {
    assert!(
        (value - expected).norm() <= tolerance * scale.abs().max(expected.norm()),
        "{what}: {value}, expected {expected}"
    );
}
