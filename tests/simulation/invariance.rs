//! Invariance of results under turning the scene, the numbering of balls, units; and cost linear in the balls.

use std::f64::consts::{PI, TAU};

use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use roulement::scene::Scene;
use roulement::simulation::inputs::Inputs;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::{Simulation, Snapshot};

/// Scales of length, mass and time.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    mass: f64,
    time: f64,
}

const SI: Units = Units { length: 1.0, mass: 1.0, time: 1.0 };

/// A deep-groove bearing under a combined load whose radial part points to `direction` [rad], with ball 1 at `azimuth`.
fn scene(u: Units, balls: usize, pitch: f64, direction: f64, azimuth: f64) -> String {
    let Units { length, mass, time } = u;
    let (force, inertia) = (mass * length / (time * time), mass * length * length);
    let pressure = force / (length * length);
    let (radial, thrust) = (60.0 * balls as f64, 40.0 * balls as f64);
    format!(
        "[bearing]\nballs = {balls}\nball_diameter = {:e}\npitch_diameter = {:e}\ncontact_angle = 0.4\n\
         inner_conformity = 0.52\nouter_conformity = 0.52\nfirst_ball_azimuth = {azimuth}\n\
         [ball]\nyoungs_modulus = {:e}\ndensity = {:e}\n[race]\nyoungs_modulus = {:e}\n\
         [effects]\ndamping = {:e}\n\
         [inner]\ndrive = \"wrench\"\nmass = {:e}\ninertia = [{:e}, {:e}, {:e}]\n\
         [solver]\ninitial_step = {:e}\nmax_step = {:e}\nmin_step = {:e}\n\
         [load]\nduration = {:e}\noutput_interval = {:e}\ninner_speed = {:e}\n\
         x = {{ force = {:e} }}\ny = {{ force = {:e} }}\nz = {{ force = {:e} }}\n\
         ry = {{ rotation = 0.0 }}\nrz = {{ rotation = 0.0 }}\n",
        9.525e-3 * length,
        pitch * length,
        206e9 * pressure,
        7800.0 * mass / length.powi(3),
        206e9 * pressure,
        0.02 * time / length,
        0.2 * mass,
        6e-5 * inertia,
        4e-5 * inertia,
        4e-5 * inertia,
        1e-6 * time,
        1e-5 * time,
        1e-10 * time,
        1e-2 * time,
        1e-4 * time,
        600.0 / time,
        thrust * force,
        radial * direction.cos() * force,
        radial * direction.sin() * force,
    )
}

/// The scene after 2 ms of its time.
fn end(text: &str, time: f64) -> (Simulation, Outputs) {
    let mut simulation = Simulation::new(&Scene::parse(text).unwrap()).unwrap();
    for point in 1..=20 {
        simulation.advance(f64::from(point) * 1e-4 * time).unwrap();
    }
    let outputs = simulation.outputs().clone();
    (simulation, outputs)
}

/// Largest difference of two runs: loads over the largest load, and the race's displacement over its own size. The second
/// is turned back by `turn` [rad] about x, its ball `j + shift` is compared with ball j, and its lengths and forces
/// are divided by those of its units.
fn difference(one: &Outputs, other: &Outputs, turn: f64, shift: usize, u: Units) -> f64 {
    let force = u.mass * u.length / (u.time * u.time);
    let back = Rotation3::from_axis_angle(&Vector3::x_axis(), -turn);
    let n = one.balls.len();
    let largest = one.balls.iter().map(|ball| ball.inner.load).fold(0.0, f64::max);
    let mut worst = 0.0f64;
    for (j, ball) in one.balls.iter().enumerate() {
        let same = &other.balls[(j + shift) % n];
        worst = worst.max((same.inner.load / force - ball.inner.load).abs() / largest);
        worst = worst.max((same.outer.load / force - ball.outer.load).abs() / largest);
        let speed = back * same.angular_velocity * u.time - ball.angular_velocity;
        worst = worst.max(speed.norm() / ball.angular_velocity.norm());
    }
    let (here, there) = (one.inner.pose.position, back * other.inner.pose.position / u.length);
    worst.max((there - here).norm() / here.norm())
}

#[test]
fn invariant_turning_the_whole_scene_about_its_axis() {
    let (_, one) = end(&scene(SI, 9, 46e-3, 0.3, 0.1), 1.0);
    let (_, other) = end(&scene(SI, 9, 46e-3, 0.3 + 1.1, 0.1 + 1.1), 1.0);
    let d = difference(&one, &other, 1.1, 0, SI);
    assert!(d < 1e-6, "{d:e}");
}

/// The scene with both races moved by the importer.
fn given_races() -> Simulation {
    let text = scene(SI, 9, 46e-3, 0.3, 0.1);
    let given = "{ drive = \"pose\" }";
    Simulation::new(&Scene::edited(&text, [("inner", given), ("outer", given)]).unwrap()).unwrap()
}

/// Runs a simulation beside one that starts from and follows its inputs as `changed` makes them; its forces and places
/// are turned by `turn`.
fn assert_turned(changed: impl Fn(&Inputs) -> Inputs, turn: UnitQuaternion<f64>) {
    let mut one = given_races();
    let mut other = one.clone();
    other.set_inputs(changed(one.inputs()));
    other.initialise().unwrap();
    let largest = one.outputs().balls.iter().map(|ball| ball.inner.load).fold(0.0, f64::max);
    for point in 1..=20 {
        let inputs = one.scripted_inputs(one.time());
        one.set_inputs(inputs);
        other.set_inputs(changed(&inputs));
        one.advance(f64::from(point) * 1e-4).unwrap();
        other.advance(f64::from(point) * 1e-4).unwrap();
        for (a, b) in one.outputs().balls.iter().zip(&other.outputs().balls) {
            assert!(
                (a.inner.load - b.inner.load).abs() < 1e-6 * largest,
                "{} {}",
                a.inner.load,
                b.inner.load
            );
            assert!((turn * a.position - b.position).norm() < 1e-10, "{} {}", a.position, b.position);
        }
        let (a, b) = (&one.outputs().inner.wrench, &other.outputs().inner.wrench);
        assert!((turn * a.force - b.force).norm() < 1e-6 * a.force.norm(), "{} {}", a.force, b.force);
        assert!(
            (turn * a.moment - b.moment).norm() < 1e-6 * a.force.norm() * 23e-3,
            "{} {}",
            a.moment,
            b.moment
        );
    }
}

#[test]
fn invariant_turning_the_whole_scene_about_any_axis() {
    // The balls of a scene start at azimuths from the y axis tilted along: there is no turn about x in this one.
    let turn = UnitQuaternion::new(Vector3::new(0.0, -1.1, 0.4));
    let turned = |inputs: &Inputs| {
        let mut inputs = *inputs;
        for race in [&mut inputs.inner, &mut inputs.outer] {
            race.pose.position = turn * race.pose.position;
            race.pose.orientation = turn * race.pose.orientation;
            race.twist.velocity = turn * race.twist.velocity;
            race.twist.angular_velocity = turn * race.twist.angular_velocity;
        }
        inputs
    };
    assert_turned(turned, turn);
}

#[test]
fn invariant_turning_a_race_about_its_own_axis_changes_nothing() {
    let turned = |inputs: &Inputs| {
        let mut inputs = *inputs;
        inputs.outer.pose.orientation *= UnitQuaternion::new(Vector3::x() * 0.9);
        inputs
    };
    assert_turned(turned, UnitQuaternion::identity());
}

#[test]
fn invariant_shift_by_one_ball_pitch_only_renumbers_the_balls() {
    let (_, one) = end(&scene(SI, 9, 46e-3, 0.3, 0.1), 1.0);
    let (_, other) = end(&scene(SI, 9, 46e-3, 0.3, 0.1 - TAU / 9.0), 1.0);
    let d = difference(&one, &other, 0.0, 1, SI);
    assert!(d < 1e-6, "{d:e}");
}

#[test]
fn invariant_any_numbering_of_the_balls() {
    let (simulation, _) = end(&scene(SI, 9, 46e-3, 0.3, 0.1), 1.0);
    let numbering = [4, 7, 0, 8, 2, 5, 1, 6, 3];
    let mut snapshot = serde_json::to_value(simulation.snapshot()).unwrap();
    let balls = snapshot["state"]["balls"].as_array().unwrap().clone();
    snapshot["state"]["balls"] = numbering.map(|j: usize| balls[j].clone()).to_vec().into();
    let mut other = simulation.clone();
    assert!(other.restore(&serde_json::from_value::<Snapshot>(snapshot).unwrap()));
    let mut one = simulation;
    for point in 21..=40 {
        one.advance(f64::from(point) * 1e-4).unwrap();
        other.advance(f64::from(point) * 1e-4).unwrap();
    }
    let mut renumbered = other.outputs().clone();
    for (index, j) in numbering.into_iter().enumerate() {
        renumbered.balls[j] = other.outputs().balls[index];
    }
    assert_ne!(renumbered.balls[0].azimuth, other.outputs().balls[0].azimuth);
    let d = difference(one.outputs(), &renumbered, 0.0, 0, SI);
    assert!(d < 1e-6, "{d:e}");
}

#[test]
fn invariant_results_scale_with_the_units() {
    let (_, one) = end(&scene(SI, 9, 46e-3, 0.3, 0.1), 1.0);
    for u in [
        Units { length: 2.5, ..SI },
        Units { mass: 7.0, ..SI },
        Units { time: 1.6, ..SI },
        Units { length: 1.7, mass: 3.0, time: 1.3 },
    ] {
        let (_, other) = end(&scene(u, 9, 46e-3, 0.3, 0.1), u.time);
        let d = difference(&one, &other, 0.0, 0, u);
        // 1 mm/s in the rolling speed is the one size of the model that does not scale.
        assert!(d < 1e-5, "{d:e} at lengths {}, masses {}, times {}", u.length, u.mass, u.time);
    }
}

#[test]
fn invariant_work_is_linear_in_the_number_of_balls() {
    // The pitch circle holds 64 balls; loads grow with their number.
    let work = [8, 16, 32, 64].map(|balls| {
        let (simulation, _) = end(&scene(SI, balls, 0.25, 0.5 * PI, 0.1), 1.0);
        let s = simulation.state().statistics;
        // Every evaluation of the equations takes both contacts of every ball once; those with derivatives cost five.
        let evaluations = s.contact_values as f64 + 5.0 * s.contact_tangents as f64;
        assert!(evaluations > 2.0 * (balls as u64 * (s.steps + s.newton.iterations)) as f64);
        (evaluations / (s.steps as f64 * balls as f64), s.newton.iterations as f64 / s.steps as f64)
    });
    // The count per ball grows only as the corrections per step do: 2.1 at 8 balls, 2.6 at 64.
    for pair in work.windows(2) {
        let growth = pair[1].0 / pair[0].0;
        assert!(growth < 1.15, "evaluations per ball and step, corrections per step: {work:?}");
    }
}
