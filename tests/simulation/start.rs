//! Where a simulation starts, and what a step that cannot be finished says.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::model::Model;
use roulement::model::bodies::{Body, Race};
use roulement::scene::Scene;
use roulement::simulation::{Simulation, SimulationError};

use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");

/// The thrust case with a radial load as well, its balls rolling or with their moments in balance.
fn combined(spin_balance: &str) -> Simulation {
    let changes = [("start.spin_balance", spin_balance), ("load.y.force", "\"300 N\"")];
    Simulation::new(&scene(THRUST, &changes)).unwrap()
}

/// Moment of all friction on a ball that its gyroscopic moment does not ask for [N m], and friction's limit there.
fn unbalanced(simulation: &Simulation, index: usize) -> (Vector3<f64>, f64) {
    let (model, state) = (simulation.model(), simulation.state());
    let ball = &state.balls[index];
    let contacts = Race::BOTH.map(|race| {
        model.contact(race, &simulation.conditions()).evaluated(&ball.motion(), &state.race(race).motion())
    });
    let orbit = Vector3::x() * simulation.outputs().balls[index].orbital_speed;
    let gyroscopic = orbit.cross(&ball.angular_velocity) * model.bearing.ball.inertia;
    let moment = contacts[0].ball_moment + contacts[1].ball_moment - gyroscopic;
    (moment, simulation.inputs().friction * contacts[0].load * model.bearing.ball.radius)
}

#[test]
fn closed_form_accelerations_and_multipliers_are_consistent_at_the_start() {
    for spin_balance in ["false", "true"] {
        let simulation = combined(spin_balance);
        let (model, state) = (simulation.model(), simulation.state());
        let mut on_race = Vector3::zeros();
        let mut about_axis = 0.0;
        for ball in &state.balls {
            let races = Race::BOTH.map(|race| state.race(race).motion());
            let [inner, outer] = Race::BOTH.map(|race| {
                let contact = model.contact(race, &simulation.conditions());
                contact.evaluated(&ball.motion(), &races[race as usize])
            });
            let force = inner.force + outer.force;
            assert!((ball.acceleration * model.bearing.ball.mass - force).norm() < 1e-9 * inner.load);
            let moment = inner.ball_moment + outer.ball_moment;
            assert!(
                (ball.angular_acceleration * model.bearing.ball.inertia - moment).norm() < 1e-12 * inner.load
            );
            on_race -= inner.force;
            about_axis += inner.race_moment.dot(&races[0].axis);
        }
        let race = state.race(Race::Inner);
        let applied = simulation.inputs().inner.applied.force;
        let mass = model.bodies[Race::Inner].as_ref().unwrap().mass;
        assert!((race.acceleration * mass - applied - on_race).norm() < 1e-6);
        // The drive torque carries all friction about the axis, so that the spin goes on as it is.
        assert!((simulation.outputs().inner.drive_torque + about_axis).abs() < 1e-9);
        assert!(race.rate_derivative.x.abs() < 1e-6);
    }
}

#[test]
fn closed_form_moments_are_in_balance_at_a_start_that_asks_for_it() {
    let excess = |simulation: &Simulation| {
        let of_ball = |j| {
            let (moment, limit) = unbalanced(simulation, j);
            moment.norm() / limit
        };
        (0..simulation.outputs().balls.len()).map(of_ball).fold(0.0, f64::max)
    };
    let (rolling, balanced) = (excess(&combined("false")), excess(&combined("true")));
    println!("unbalanced moment over friction's limit: rolling {rolling:.2e}, balanced {balanced:.2e}");
    assert!(balanced < 1e-8 && rolling > 1e-3, "{balanced:e} {rolling:e}");
    // What is in balance stays as it is: friction power after 20 ms against that at the start, pure thrust.
    let drift = |spin_balance: &str| {
        let scene = scene(THRUST, &[("start.spin_balance", spin_balance)]);
        let mut simulation = Simulation::new(&scene).unwrap();
        let power = |s: &Simulation| [s.outputs().balls[0].inner.power, s.outputs().balls[0].outer.power];
        let before = power(&simulation);
        simulation.advance(20e-3).unwrap();
        let after = power(&simulation);
        println!("balance {spin_balance}: {before:?} W at the start, {after:?} W after 20 ms");
        (after[0] / before[0] - 1.0).abs()
    };
    let (rolling, balanced) = (drift("false"), drift("true"));
    assert!(balanced < 0.02 && balanced < 0.3 * rolling, "{balanced} {rolling}");
    let both = [("start.spin_balance", "true"), ("start.orbital_speed", "100.0")];
    assert!(Scene::edited(THRUST, both).unwrap_err().to_string().contains("start.spin_balance"));
}

#[test]
fn regression_without_friction_balls_start_rolling_whatever_balance_is_asked_for() {
    let start = |spin_balance| {
        let changes = [("effects.creep", "\"frictionless\""), ("start.spin_balance", spin_balance)];
        Simulation::new(&scene(THRUST, &changes)).unwrap().state().balls.clone()
    };
    assert_eq!(start("true"), start("false"));
}

#[test]
fn a_step_that_cannot_be_finished_names_ball_and_contact() {
    // A shock towards one ball of a deep-groove bearing, through the inner race or through the outer one.
    let scene = |ball: f64, inner: &str, outer: &str, rest: &str| {
        let azimuth = -TAU * (ball - 1.0) / 8.0;
        let text = format!(
            "[bearing]\nballs = 8\nball_diameter = 0.0095\npitch_diameter = 0.046\ndiametral_clearance = 1e-5\n\
             inner_conformity = 0.52\nouter_conformity = 0.52\nfirst_ball_azimuth = {azimuth}\n\
             [effects]\ncreep = \"frictionless\"\n[inner]\n{inner}\n[outer]\n{outer}\n\
             [solver]\ninitial_step = 1e-6\nmin_step = 1e-6\nmax_step = 1e-6\ntolerance = 1e-9\n\
             [load]\nx = {{ displacement = 0.0 }}\nz = {{ displacement = 0.0 }}\nry = {{ rotation = 0.0 }}\nrz = {{ rotation = 0.0 }}\n{rest}"
        );
        Simulation::new(&Scene::parse(&text).unwrap()).unwrap()
    };
    let body = "drive = \"wrench\"\nmass = 0.05\ninertia = [2e-5, 1e-5, 1e-5]";
    for ball in [2.0, 5.0] {
        let mut shaken = scene(ball, body, "", "y = { force = 300.0 }");
        let mut inputs = *shaken.inputs();
        inputs.inner.applied.force.y = 3e3;
        shaken.set_inputs(inputs);
        // A force without end has no solution: one step, with both first guesses, at the smallest size.
        let mut nowhere = scene(ball, body, "", "y = { force = 300.0 }");
        let mut inputs = *nowhere.inputs();
        inputs.inner.applied.force.y = f64::INFINITY;
        nowhere.set_inputs(inputs);
        let why = nowhere.advance(1e-6).unwrap_err().to_string();
        assert!(why.contains("Newton"), "{why}");
        let s = nowhere.state().statistics;
        assert_eq!((s.steps, s.rejected_newton, s.second_guesses, s.rejected_error), (0, 1, 1, 0), "{s:?}");
        let mut struck = scene(ball, "drive = \"pose\"", "drive = \"pose\"", "y = { displacement = 1e-5 }");
        let mut inputs = *struck.inputs();
        inputs.outer.pose.position.y -= 20e-6;
        struck.set_inputs(inputs);
        for (simulation, expected) in
            [(&mut shaken, Body::Race(Race::Inner)), (&mut struck, Body::Race(Race::Outer))]
        {
            let why = simulation.advance(20e-6).unwrap_err();
            println!("{why}");
            let statistics = simulation.state().statistics;
            let rejected = statistics.rejected_newton + statistics.rejected_error;
            assert!(rejected > 0, "{statistics:?}");
            // Newton's method tries twice before it gives up; an error is found once per step.
            assert!(statistics.second_guesses >= statistics.rejected_newton, "{statistics:?}");
            assert_eq!(statistics.rejected_newton > 0, why.to_string().contains("Newton"), "{statistics:?}");
            let SimulationError::StepTooSmall { site, .. } = why else { panic!("{why}") };
            assert_eq!((site.ball as f64, site.contact), (ball, expected));
            // A force flings the race body; a pose that moves has only the balls to upset.
            let body = (expected == Body::Race(Race::Inner)).then_some(Body::Race(Race::Inner));
            assert_eq!(site.body, body);
            let names = match body {
                Some(body) => format!("worst at the {body}, at its contact with ball {ball} "),
                None => format!("worst at ball {ball} on the {expected} "),
            };
            let message = why.to_string();
            assert!(message.contains(&names), "{message}");
        }
    }
}

const RADIAL: &str = include_str!("../../scenes/radial.toml");

/// A rotor whose weight is all that loads the bearing: across its axis, or along it.
fn heavy(direction: usize, mass: f64) -> Simulation {
    let mut gravity = [0.0; 3];
    gravity[direction] = -9.81;
    let changes = [
        ("effects.gravity", format!("{gravity:?}")),
        ("inner.mass", format!("{mass}")),
        ("load.inner_speed", "\"1500 rpm\"".into()),
        ("load.y", "{ force = 0.0 }".into()),
        ("load.x", if direction == 0 { "{ force = 0.0 }" } else { "{ displacement = 0.0 }" }.into()),
    ];
    let changes: Vec<(&str, &str)> = changes.iter().map(|(key, value)| (*key, value.as_str())).collect();
    Simulation::new(&scene(RADIAL, &changes)).unwrap()
}

#[test]
fn closed_form_a_rotor_rests_on_the_bearing_at_the_start() {
    for (direction, mass) in [(1, 50.0), (0, 50.0), (1, 5.0)] {
        let mut simulation = heavy(direction, mass);
        let weight = -9.81 * mass;
        let carried = |simulation: &Simulation| -simulation.outputs().inner.wrench.force[direction];
        // Balls start on circles, so that damping adds its share where their approach changes along the orbit.
        assert!(
            (carried(&simulation) / weight - 1.0).abs() < 0.05,
            "at the start {} N",
            carried(&simulation)
        );
        let start = simulation.state().race(Race::Inner).pose.position[direction];
        let mut largest = 0.0f64;
        for step in 1..=200 {
            simulation.advance(f64::from(step) * 1e-4).unwrap();
            largest = largest.max((carried(&simulation) / weight - 1.0).abs());
        }
        // What is left is the change of stiffness as balls pass under the load.
        assert!(largest < 0.1, "{direction} {mass} kg: off by {largest}");
        let moved = simulation.state().race(Race::Inner).pose.position[direction] - start;
        assert!(moved.abs() < 2e-6, "{direction} {mass} kg: fell by {moved} m");
    }
}

#[test]
fn closed_form_weight_of_rotor_and_balls_in_the_equilibrium() {
    // The outer race carries what the inner one does and the balls' weight besides.
    let simulation = heavy(1, 50.0);
    let (scene, model) = (simulation.scene(), simulation.model());
    let solution =
        equilibrium::solve(model, &EquilibriumInput::from_scene(scene, Gyroscopic::Friction)).unwrap();
    assert!((solution.load[1] / (-9.81 * 50.0) - 1.0).abs() < 1e-9, "{:?}", solution.load);
    let bottom =
        solution.balls.iter().max_by(|a, b| a.report.outer_load.total_cmp(&b.report.outer_load)).unwrap();
    let down = -bottom.azimuth.cos();
    let report = &bottom.report;
    let weight = 9.81 * model.bearing.ball.mass * down;
    let surplus = report.outer_load - report.inner_load - report.centrifugal_force;
    assert!((surplus / weight - 1.0).abs() < 1e-3, "{surplus} N for {weight} N");
}

#[test]
fn regression_a_load_beyond_every_bearing_has_no_equilibrium() {
    let scene = scene(RADIAL, &[("load.y", "{ force = \"1000 kN\" }")]);
    let model = Model::new(&scene).unwrap();
    let why = equilibrium::solve(&model, &EquilibriumInput::from_scene(&scene, Gyroscopic::None))
        .map(|solution| solution.residual)
        .unwrap_err()
        .to_string();
    assert!(why.contains("beyond elastic") || why.contains("does not converge"), "{why}");
    assert!(!why.contains("NaN"), "{why}");
}

#[test]
fn regression_a_ball_that_turns_without_end_is_no_balance() {
    // A random scene whose first ball started at 4e156 rad/s: a ball that is infinitely fast has no creepage.
    let text = "[bearing]\nballs = 16\nball_diameter = 0.01998384707553198\npitch_diameter = 0.12008582231592382\n\
                inner_conformity = 0.5151678290431639\nouter_conformity = 0.5207428501843044\n\
                diametral_clearance = 0.0000068088034856446494\n[friction]\nball_race = 0.006256584487471672\n\
                [effects]\ncreep = \"kalker_table\"\n[inner]\ndrive = \"wrench\"\nmass = 0.5868501255173103\n\
                inertia = [0.0021156834226813775, 0.0012694100536088265, 0.0012694100536088265]\n\
                [load]\nduration = 0.005\ninner_speed = -126.81686614994825\nx = { displacement = 0.0 }\n\
                y = { force = 21022.89972210027 }\nry = { rotation = 0.00016718915892818928 }\nrz = { rotation = 0.0 }\n";
    let simulation = Simulation::new(&Scene::parse(text).unwrap()).unwrap();
    let outputs = simulation.outputs();
    assert!(outputs.stored_energy.is_finite() && outputs.friction_power.is_finite(), "{outputs:?}");
    let speeds = outputs.balls.iter().map(|ball| ball.angular_velocity.norm());
    let (low, high) = speeds.fold((f64::INFINITY, 0.0f64), |(low, high), w| (low.min(w), high.max(w)));
    assert!(low > 300.0 && high < 330.0, "{low} to {high} rad/s");
}
