//! Steady states of whole runs against independent quasi-static data and closed forms.

use std::f64::consts::TAU;

use nalgebra::{Matrix2, Vector2};
use roulement::contact::geometry::GrooveContact;
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;
use serde_json::{Value, json};

use crate::reference::{cases, scene_text};
use crate::scenes::{HELD, scene};

const THRUST: &str = include_str!("../../scenes/thrust.toml");

/// Runs a scene for a time [s], with outputs every `interval` [s].
fn run(scene: &Scene, duration: f64, interval: f64) -> (Simulation, Vec<Outputs>) {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut history = vec![simulation.outputs().clone()];
    for point in 1..=(duration / interval).round() as u32 {
        simulation.advance(f64::from(point) * interval).unwrap();
        history.push(simulation.outputs().clone());
    }
    (simulation, history)
}

/// A reference case at a friction coefficient, after 10 ms: the inner race under its load, or held where the data say.
fn reference_run(case: &Value, friction: f64, held: bool) -> Simulation {
    let mut case = case.clone();
    let body = "drive = \"wrench\"\nmass = 0.05\ninertia = [2e-5, 1e-5, 1e-5]";
    if held {
        for (key, kind) in [
            ("x", "displacement"),
            ("y", "displacement"),
            ("z", "displacement"),
            ("ry", "rotation"),
            ("rz", "rotation"),
        ] {
            case["conditions"][key] = json!({ kind: case["no_gyro"]["displacement"][key] });
        }
    }
    // Steps of 10 us damp the swing of balls that enter the load, which statics know nothing of.
    let text = format!(
        "[solver]\ntolerance = 1e-6\nmax_step = 1e-5\n[inner]\n{}\n[friction]\nball_race = {friction}\n[effects]\ncreep = \"saturated\"\ndamping = 0.02\n{}",
        if held { "drive = \"pose\"" } else { body },
        scene_text(&case)
    );
    let mut simulation = Simulation::new(&Scene::parse(&text).unwrap()).unwrap();
    for point in 1..=20 {
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        simulation.advance(f64::from(point) * 0.5e-3).unwrap();
    }
    simulation
}

/// Largest distance of a loaded ball from the band of the two hypotheses, where 1 is its edge: their difference plus 1 %
/// of the ball's load, about either. Each ball is compared where it is.
fn distance_in_bands(simulation: &Simulation) -> f64 {
    let now = simulation.outputs();
    let mut worst = 0.0f64;
    for (j, ball) in now.balls.iter().enumerate() {
        // The bearing with this ball where it is, and the others evenly spaced.
        let mut model = simulation.model().clone();
        model.bearing.first_ball_azimuth = ball.azimuth - TAU * j as f64 / now.balls.len() as f64;
        let [control, none] = [Gyroscopic::OuterRaceControl, Gyroscopic::None].map(|gyroscopic| {
            let input = EquilibriumInput::from_scene(simulation.scene(), gyroscopic);
            equilibrium::solve(&model, &input).unwrap().balls[j].report
        });
        if none.inner_load <= 0.0 || control.inner_load <= 0.0 {
            continue;
        }
        let loads = [
            (ball.inner.load, control.inner_load, none.inner_load),
            (ball.outer.load, control.outer_load, none.outer_load),
        ];
        for (seen, control, none) in loads {
            let away = (seen - none).abs().min((seen - control).abs());
            worst = worst.max(away / ((control - none).abs() + 0.01 * none));
        }
    }
    worst
}

/// Loads of a ball on inner and outer race by statics alone: in its azimuthal plane Hertz's forces balance the
/// centrifugal force and a fraction of the lateral friction; with the inertia of its swing across the groove, all of that of
/// its acceleration. Races, speed and friction are those of the run.
fn static_loads(simulation: &Simulation, index: usize, fraction: f64, swing: bool) -> [f64; 2] {
    let (model, ball) = (simulation.model(), &simulation.state().balls[index]);
    let contacts = Race::BOTH.map(|race| model.contact(race, &simulation.conditions()));
    let races = Race::BOTH.map(|race| simulation.state().race(race).motion());
    let (axis, offset) = (races[1].axis, ball.position - races[1].position);
    let across = offset - axis * offset.dot(&axis);
    let radial = across.normalize();
    let speed = ball.velocity.dot(&axis.cross(&radial));
    let steady = -radial * (speed * speed / across.norm());
    let centrifugal = -(if swing { ball.acceleration } else { steady }) * model.bearing.ball.mass;
    // Transverse to rolling, which is along the circumference.
    let transverse = |contact: &GrooveContact<f64>| contact.circumferential.cross(&contact.normal);
    let friction = [0, 1].map(|race: usize| {
        let contact = contacts[race].evaluated(&ball.motion(), &races[race]);
        let tangential = contact.force + contact.geometry.normal * contact.load;
        fraction * tangential.dot(&transverse(&contact.geometry))
    });
    let forces = |place: &Vector2<f64>| {
        let position = races[1].position + axis * place.x + radial * place.y;
        let (mut sum, mut loads) = (centrifugal, [0.0; 2]);
        for race in 0..2 {
            let (contact, _) =
                GrooveContact::new(&contacts[race].surface, &(position - races[race].position), &races[race]);
            let stiffness = contacts[race].shape.stiffness(contact.circumferential_curvature);
            loads[race] = stiffness * contact.approach.max(0.0).powf(1.5);
            sum += transverse(&contact) * friction[race] - contact.normal * loads[race];
        }
        (Vector2::new(sum.dot(&axis), sum.dot(&radial)), loads)
    };
    let mut place = Vector2::new(offset.dot(&axis), across.norm());
    for _ in 0..30 {
        let (force, _) = forces(&place);
        let column = |k: usize| {
            let change = Vector2::ith(k, 1e-10);
            (forces(&(place + change)).0 - forces(&(place - change)).0) / 2e-10
        };
        let step = Matrix2::from_columns(&[column(0), column(1)]).lu().solve(&-force).unwrap();
        place += step * (1e-6 / step.norm()).min(1.0);
    }
    forces(&place).1
}

/// Largest difference of a ball's loads from statics in percent of them, over the balls that a given fraction of the bearing's
/// largest load presses on the inner race.
fn percent_from_statics(simulation: &Simulation, friction_fraction: f64, swing: bool, least: f64) -> f64 {
    let balls = &simulation.outputs().balls;
    let largest = balls.iter().map(|ball| ball.inner.load).fold(0.0, f64::max);
    let loaded = balls.iter().enumerate().filter(|(_, ball)| ball.inner.load > least * largest);
    loaded.fold(0.0, |worst: f64, (j, ball)| {
        let [inner, outer] = static_loads(simulation, j, friction_fraction, swing);
        let [inner, outer] = [ball.inner.load / inner - 1.0, ball.outer.load / outer - 1.0];
        worst.max(100.0 * inner.abs().max(outer.abs()))
    })
}

#[test]
fn invariant_cases_at_rest_under_thrust_and_radial_load_lie_in_the_band() {
    // Under their loads, friction 0.08. The other eight do not: the next two tests say why.
    let steady =
        ["P-01", "P-02", "P-03", "P-05", "P-06", "P-09", "P-10", "P-12", "P-13", "P-16", "P-17", "P-18"];
    for case in cases().iter().filter(|case| steady.contains(&case["id"].as_str().unwrap())) {
        let own = distance_in_bands(&reference_run(case, 0.08, false));
        assert!(own <= 1.0, "{}: {own}", case["id"]);
    }
}

#[test]
fn invariant_all_but_one_lie_in_the_band_at_the_pose_of_the_data_under_light_friction() {
    // Under a load the race follows all balls, which do not stay evenly spaced without a cage; held where the data say,
    // it leaves each ball to itself. P-04 is 26 % outside at 0.01, by its most lightly loaded balls.
    for case in cases() {
        let own = distance_in_bands(&reference_run(&case, 0.01, true));
        let edge = if case["id"] == "P-04" { 1.5 } else { 1.0 };
        assert!(own <= edge, "{}: {own}", case["id"]);
    }
}

#[test]
fn invariant_loads_are_those_of_statics_with_the_lateral_friction_of_the_run() {
    // What neither hypothesis has is friction across rolling, up to 7 % of the load at a friction coefficient of 0.08. With
    // it statics give the loads; balls that carry less than 2 % of the largest load are thrown about and left out.
    // P-04 and P-15: 1.5 and 1.1 %, from balls that enter the load.
    let mut without_friction = 0.0f64;
    for case in cases() {
        let simulation = reference_run(&case, 0.08, true);
        // Held where the data say, the run leaves the band in three cases, for that friction alone.
        if !["P-04", "P-08", "P-14"].contains(&case["id"].as_str().unwrap()) {
            let own = distance_in_bands(&simulation);
            assert!(own <= 1.0, "{}: {own}", case["id"]);
        }
        let percent = percent_from_statics(&simulation, 1.0, false, 0.02);
        let edge = if ["P-04", "P-15"].contains(&case["id"].as_str().unwrap()) { 2.0 } else { 1.0 };
        assert!(percent <= edge, "{}: {percent} %", case["id"]);
        without_friction = without_friction.max(percent_from_statics(&simulation, 0.0, false, 0.02));
    }
    assert!(without_friction > 20.0, "{without_friction} %");
}

#[test]
fn invariant_what_light_friction_leaves_is_the_inertia_of_swinging_balls() {
    // Under their loads, where friction does not hold them, balls swing across the groove as they go round: statics with the
    // lateral friction of the run are percents off, and right with the force of that acceleration.
    let mut without = 0.0f64;
    for case in
        cases().iter().filter(|case| ["P-04", "P-11", "P-14", "P-15"].contains(&case["id"].as_str().unwrap()))
    {
        let simulation = reference_run(case, 0.01, false);
        let [steady, swinging] =
            [false, true].map(|swing| percent_from_statics(&simulation, 1.0, swing, 0.02));
        println!("{}: {steady} % without, {swinging} % with", case["id"]);
        without = without.max(steady);
        assert!(swinging < 0.3, "{}: {swinging} %", case["id"]);
    }
    assert!(without > 1.0, "{without} %");
}

#[test]
fn closed_form_cage_and_ball_speed_under_light_friction() {
    let slow = [
        ("load.inner_speed", "\"600 rpm\""),
        ("friction.ball_race", "0.01"),
        ("start.spin_balance", "false"),
    ];
    let slow = scene(THRUST, &slow);
    let (simulation, history) = run(&slow, 20e-3, 1e-3);
    let (last, bearing) = (history.last().unwrap(), &simulation.model().bearing);
    let speed = last.inner.twist.angular_velocity.x;
    let ball = &last.balls[0];
    let (a_i, a_o) = (ball.inner.contact_angle, ball.outer.contact_angle);
    let gamma = 2.0 * bearing.ball.radius / bearing.pitch_diameter;
    let control = (1.0 - gamma * a_i.cos()) / (1.0 + (a_i - a_o).cos());
    assert!((last.cage_speed / speed / control - 1.0).abs() < 5e-4, "{} {control}", last.cage_speed / speed);
    let angle = 0.5 * (a_i + a_o);
    let spin = speed * (1.0 - (gamma * angle.cos()).powi(2)) / (2.0 * gamma);
    let relative = (ball.angular_velocity - nalgebra::Vector3::x() * last.cage_speed).norm();
    assert!((relative / spin - 1.0).abs() < 1e-3, "{relative} {spin}");
}

#[test]
fn invariant_ball_speed_varies_once_per_orbit_under_thrust_and_tilt() {
    let changes = [&[("outer.misalignment.ry", "\"0.01 deg\"")][..], &HELD].concat();
    let (_, history) = run(&scene(THRUST, &changes), 30e-3, 0.1e-3);
    // Harmonics of one ball's orbital speed over its azimuth during its last orbit.
    let speeds: Vec<(f64, f64)> =
        history.iter().map(|o| (o.balls[0].azimuth, o.balls[0].orbital_speed)).collect();
    let orbit = (TAU / history.last().unwrap().cage_speed / 0.1e-3).round() as usize;
    let last = &speeds[speeds.len() - orbit..];
    let mean = last.iter().map(|(_, speed)| speed).sum::<f64>() / orbit as f64;
    let harmonic = |k: f64| {
        let sum = last.iter().fold((0.0, 0.0), |(c, s), (azimuth, speed)| {
            (c + (speed - mean) * (k * azimuth).cos(), s + (speed - mean) * (k * azimuth).sin())
        });
        2.0 * f64::hypot(sum.0, sum.1) / orbit as f64
    };
    let (first, second) = (harmonic(1.0), harmonic(2.0));
    assert!(first > 0.05 && first > 3.0 * second, "{first} {second} rad/s");
}

#[test]
fn invariant_drive_power_is_dissipated_power_in_steady_state() {
    let changes =
        [("load.inner_speed", "\"3000 rpm\""), ("friction.ball_race", "0.05"), ("load.x.force", "\"800 N\"")];
    let (_, history) = run(&scene(THRUST, &changes), 50e-3, 1e-3);
    let late = &history[40..];
    let drive: f64 = late.iter().map(|o| o.inner.drive_torque * o.inner.twist.angular_velocity.x).sum();
    let lost: f64 = late.iter().map(|o| o.friction_power + o.damping_power).sum();
    assert!((drive / lost - 1.0).abs() < 5e-3, "{drive} {lost}");
}
