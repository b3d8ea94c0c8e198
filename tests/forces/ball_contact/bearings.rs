//! Whole bearings without a cage: motion, energy, snapshots, and scenes that are refused.

use super::*;

/// Six frictionless balls under thrust, of which the first is faster by some speed [m/s] than the others.
fn one_faster(faster: f64, friction: &str) -> Simulation {
    let changes = [
        ("bearing.balls", "6"),
        ("effects.creep", "\"frictionless\""),
        ("effects.damping", "0.0"),
        ("friction.ball_ball", friction),
        ("load.inner_speed", "\"3000 rpm\""),
        ("load.y", "{ displacement = 0.0 }"),
        ("load.z", "{ displacement = 0.0 }"),
        ("load.ry", "{ rotation = 0.0 }"),
        ("load.rz", "{ rotation = 0.0 }"),
        ("solver.max_step", "\"1 us\""),
    ];
    faster_first(faster, &changes)
}

/// The thrust case with these changes, its first ball faster by some speed [m/s] than the others.
fn faster_first(faster: f64, changes: &[(&str, &str)]) -> Simulation {
    let mut simulation = Simulation::new(&scene(THRUST, changes)).unwrap();
    let mut value = serde_json::to_value(simulation.snapshot()).unwrap();
    let place = &mut value["state"]["balls"][0]["velocity"];
    let velocity: Vector3<f64> = serde_json::from_value(place.clone()).unwrap();
    *place = serde_json::to_value(velocity + velocity.normalize() * faster).unwrap();
    let snapshot: Snapshot = serde_json::from_value(value).unwrap();
    assert!(simulation.restore(&snapshot));
    simulation
}

/// [kg m2/s] angular momentum of all balls about the bearing axis, and the orbital speeds [m/s].
fn angular_momentum(simulation: &Simulation) -> (f64, Vec<f64>) {
    let inertia = 0.4 * MASS * RADIUS * RADIUS;
    let balls = &simulation.state().balls;
    let orbital = |p: &Vector3<f64>, v: &Vector3<f64>| p.y * v.z - p.z * v.y;
    let momentum = balls
        .iter()
        .map(|ball| MASS * orbital(&ball.position, &ball.velocity) + inertia * ball.angular_velocity.x)
        .sum();
    let speed = |p: &Vector3<f64>, v: &Vector3<f64>| orbital(p, v) / p.y.hypot(p.z);
    (momentum, balls.iter().map(|ball| speed(&ball.position, &ball.velocity)).collect())
}

#[test]
fn closed_form_a_ball_that_catches_up_hands_its_speed_on() {
    // Equal masses exchange their speeds (Huygens). Races bend a little under the blow, which costs some of it.
    let faster = 0.5;
    let mut simulation = one_faster(faster, "0.0");
    let (before, speeds) = angular_momentum(&simulation);
    assert!((speeds[0] - speeds[1] - faster).abs() < 1e-6);
    // The gap to the next ball is closed within 27 ms, that of the next pair later.
    let mut loads = vec![];
    while simulation.outputs().neighbours.unwrap().gap > 0.0 || loads.is_empty() {
        go_on(&mut simulation, 1, 5e-6);
        loads.push(simulation.outputs().neighbours.unwrap().largest_load);
        assert!(loads.len() < 10_000);
    }
    go_on(&mut simulation, 40, 5e-6);
    let (after, now) = angular_momentum(&simulation);
    let exchanged = MASS * 23e-3 * faster;
    assert!((after - before).abs() < 1e-4 * exchanged, "{before} {after}");
    assert!(((now[1] - now[0]) / faster - 1.0).abs() < 0.1, "{now:?}");
    assert!((now[2] - speeds[2]).abs() < 1e-3 * faster, "{now:?}");
}

#[test]
fn invariant_angular_momentum_with_friction_between_balls() {
    // Friction turns orbital motion into spin. Races without friction do not take any of it.
    let mut simulation = one_faster(0.5, "0.3");
    let (before, _) = angular_momentum(&simulation);
    let spin = |simulation: &Simulation| simulation.state().balls[0].angular_velocity.x;
    let spin_before = spin(&simulation);
    let mut touched = 0;
    while touched < 3 {
        go_on(&mut simulation, 1, 5e-6);
        touched += usize::from(simulation.outputs().neighbours.unwrap().touching > 0);
        assert!(simulation.time() < 50e-3);
    }
    go_on(&mut simulation, 40, 5e-6);
    let (after, _) = angular_momentum(&simulation);
    let exchanged = 0.4 * MASS * RADIUS * RADIUS * (spin(&simulation) - spin_before).abs();
    assert!((after - before).abs() < 1e-3 * exchanged, "{before} {after} {exchanged}");
}

/// [rad] smallest angle between neighbouring balls.
fn smallest_angle(outputs: &Outputs) -> f64 {
    let azimuths: Vec<f64> = outputs.balls.iter().map(|ball| ball.azimuth).collect();
    let next = azimuths.iter().cycle().skip(1);
    azimuths.iter().zip(next).map(|(a, b)| (b - a).rem_euclid(2.0 * PI)).fold(PI, f64::min)
}

#[test]
fn regression_balls_do_not_run_through_each_other() {
    // They overlapped from 23 ms on, under every law and goal, and touch at 2 asin(D/dm) = 23.9 deg.
    let touching = 2.0 * (9.525f64 / 46.0).asin();
    let cases: [&[(&str, &str)]; 3] = [
        &[],
        &[("effects.creep", "\"kalker_table\""), ("solver.accuracy", "\"fast\"")],
        // Without unknowns of a race, balls are coupled by their contacts alone.
        &[("inner.drive", "\"pose\""), ("solver.accuracy", "\"fast\"")],
    ];
    for (case, changes) in cases.into_iter().enumerate() {
        let mut simulation = Simulation::new(&scene(COMBINED, changes)).unwrap();
        let history = go_on(&mut simulation, 300, 0.2e-3);
        let neighbours = || history.iter().map(|outputs| outputs.neighbours.unwrap());
        assert!(neighbours().any(|n| n.touching > 0), "{case}");
        // A micron belongs to 7 N.
        let modulus = STEEL.0 / (2.0 * (1.0 - STEEL.1 * STEEL.1));
        for n in neighbours() {
            let approach = (n.largest_load / (4.0 / 3.0 * modulus * (0.5 * RADIUS).sqrt())).powf(2.0 / 3.0);
            assert!(n.gap > -2.0 * approach.max(1e-8), "{case}: {n:?}");
        }
        let angle = history.iter().map(smallest_angle).fold(PI, f64::min);
        assert!(angle > touching - 5e-3, "{case}: {} deg", angle.to_degrees());
        let (first, last) = (&history[0], &history[history.len() - 1]);
        let imbalance = last.work - last.dissipated - (last.stored_energy - first.stored_energy);
        assert!(imbalance.abs() < 1e-2 * (last.work.abs() + last.dissipated), "{case}: {imbalance}");
        let statistics = last.statistics;
        assert!(statistics.rejected_newton * 100 < statistics.steps, "{case}: {statistics:?}");
    }
}

/// A simulation in which balls touch.
fn touching(changes: &[(&str, &str)]) -> Simulation {
    let mut simulation = Simulation::new(&scene(COMBINED, changes)).unwrap();
    while simulation.outputs().neighbours.unwrap().touching == 0 {
        go_on(&mut simulation, 1, 20e-6);
        assert!(simulation.time() < 60e-3);
    }
    simulation
}

#[test]
fn invariant_a_restored_state_goes_on_to_the_same_bits() {
    for changes in [&[][..], &[("inner.drive", "\"pose\"")]] {
        let mut simulation = touching(changes);
        let saved = simulation.snapshot();
        let history = go_on(&mut simulation, 20, 20e-6);
        let mut other = Simulation::new(simulation.scene()).unwrap();
        assert!(other.restore(&saved));
        assert_eq!(other.outputs().balls, history[0].balls);
        let again = go_on(&mut other, 20, 20e-6);
        assert_eq!(again, history);
        assert_eq!(other.snapshot(), simulation.snapshot());
    }
}

#[test]
fn invariant_sensitivities_are_those_of_runs_beside() {
    // Equal steps, so that differences of runs are smooth.
    let steps = [("solver.max_step", "\"2 us\""), ("solver.initial_step", "\"2 us\"")];
    let mut simulation = touching(&steps);
    let force = |outputs: &Outputs| -> Vec<Vector3<f64>> {
        let of_balls = outputs.balls.iter().map(|ball| ball.neighbours_force);
        of_balls.chain([outputs.inner.wrench.force]).collect()
    };
    let end = simulation.time() + 20e-6;
    let inputs = [1.0, -1.0].map(|size| {
        let mut inputs = *simulation.inputs();
        inputs.inner.applied.force += Vector3::new(5.0, 20.0, 20.0) * size;
        inputs
    });
    let run = |inputs| {
        let mut beside = simulation.clone();
        beside.set_inputs(inputs);
        beside.advance(end).unwrap();
        force(beside.outputs())
    };
    let runs = inputs.map(run);
    let sensitive = simulation.advance_perturbed(end, &inputs, Groups::default()).unwrap();
    let sensitive = [0, 1].map(|i: usize| force(sensitive[i].outputs()));
    let difference = |[plus, minus]: &[Vec<Vector3<f64>>; 2]| -> Vec<Vector3<f64>> {
        plus.iter().zip(minus).map(|(plus, minus)| (plus - minus) * 0.5).collect()
    };
    let (exact, expected) = (difference(&sensitive), difference(&runs));
    let pushed = expected[..13].iter().map(Vector3::norm).fold(0.0, f64::max);
    assert!(pushed > 1e-4, "{pushed}");
    for (exact, expected) in exact[..13].iter().zip(&expected) {
        assert!((exact - expected).norm() < 1e-2 * pushed, "{exact} {expected}");
    }
    assert!((exact[13] - expected[13]).norm() < 1e-3 * expected[13].norm(), "{} {}", exact[13], expected[13]);
}

#[test]
fn closed_form_reported_forces_are_those_of_the_pairs() {
    let scene = scene(COMBINED, &[("effects.full_complement", "true"), ("effects.per_ball_outputs", "true")]);
    let variables = Variables::new(&scene);
    let simulation = touching(&[("effects.full_complement", "true"), ("effects.per_ball_outputs", "true")]);
    let values = variables.values(simulation.inputs(), simulation.outputs());
    let value = |name: &str| values[variables.rows().iter().position(|row| row.name == name).unwrap()];
    let model = BallBallModel::new(RADIUS, STEEL, 0.08);
    let balls = &simulation.state().balls;
    let (mut count, mut largest, mut power) = (0.0, 0.0f64, 0.0);
    let mut forces = vec![Vector3::zeros(); 13];
    for first in 0..13 {
        let second = (first + 1) % 13;
        if let Some(pair) = model.evaluate(&balls[first].motion(), &balls[second].motion(), 0.02) {
            count += 1.0;
            largest = largest.max(pair.load);
            power += pair.friction_power;
            forces[first] += pair.force;
            forces[second] -= pair.force;
        }
    }
    assert!(count > 0.0);
    assert_eq!(value("neighbours.touching"), count);
    assert_eq!(value("neighbours.largest_load"), largest);
    assert_eq!(value("neighbours.power"), power);
    assert!(value("neighbours.gap") < 0.0);
    for (ball, force) in forces.iter().enumerate() {
        for (axis, component) in ["x", "y", "z"].into_iter().zip(force.iter()) {
            assert_eq!(value(&format!("ball[{}].neighbours.force.{axis}", ball + 1)), *component);
        }
        let load = value(&format!("ball[{}].neighbours.load", ball + 1));
        assert_eq!(load > 0.0, force.norm() > 0.0);
    }
    // They are in the bearing's power and in the balance of every ball, which has no weight here.
    assert!(simulation.outputs().friction_power > power);
    let contacts = Contacts::new(simulation.model(), simulation.state(), &simulation.conditions());
    for (index, (ball, of_races)) in balls.iter().zip(&contacts.balls).enumerate() {
        let races = of_races.raceways.inner.force + of_races.raceways.outer.force;
        let expected = races + forces[index];
        assert!((ball.total.force - expected).norm() < 1e-9 * expected.norm() + 1e-9);
    }
}

// refusals

fn refusal(text: &str, changes: &[(&str, &str)]) -> String {
    Scene::edited(text, changes.iter().copied()).unwrap_err().to_string()
}

#[test]
fn more_balls_than_fit_are_refused() {
    // pi/asin(9.525/46) = 15.03
    scene(THRUST, &[("bearing.balls", "15")]);
    let message = refusal(THRUST, &[("bearing.balls", "16")]);
    for part in ["bearing.balls", "16 balls", "[1, 15]"] {
        assert!(message.contains(part), "{message}");
    }
    // Balls that just fit on the pitch circle do not where clearance and conformities put them.
    let pitch = format!("{}", 9.525e-3 / (PI / 15.0).sin() * (1.0 + 1e-9));
    let tight = [("bearing.balls", "15"), ("bearing.pitch_diameter", pitch.as_str())];
    Simulation::new(&scene(THRUST, &tight)).unwrap();
    let loose = [("bearing.contact_angle", ""), ("bearing.diametral_clearance", "\"0.3 mm\"")];
    let open = [("bearing.outer_conformity", "0.56")];
    let scene = scene(THRUST, &[&tight[..], &loose, &open].concat());
    let why = Simulation::new(&scene).unwrap_err();
    assert!(matches!(why, SimulationError::TooManyBalls { balls: 15, fit: 14, .. }), "{why}");
    for part in ["bearing.balls = 15", "[1, 14]", "overlap"] {
        assert!(why.to_string().contains(part), "{why}");
    }
}

#[test]
fn keys_of_balls_without_a_cage_are_refused_with_one() {
    let cage = include_str!("../../../scenes/cage.toml");
    for (key, value) in [("friction.ball_ball", "0.1"), ("effects.full_complement", "true")] {
        let message = refusal(cage, &[(key, value)]);
        assert!(message.contains(key) && message.contains("effects.cage"), "{message}");
    }
    assert!(refusal(THRUST, &[("friction.ball_ball", "3")]).contains("friction.ball_ball = 3"));
}

#[test]
fn a_step_that_fails_between_balls_says_so() {
    // Steps of 20 us cannot follow a blow of 30 us, and may not be smaller.
    let changes = [
        ("effects.creep", "\"frictionless\""),
        ("effects.damping", "0.0"),
        ("load.y", "{ displacement = 0.0 }"),
        ("load.z", "{ displacement = 0.0 }"),
        ("load.ry", "{ rotation = 0.0 }"),
        ("load.rz", "{ rotation = 0.0 }"),
        ("solver.max_step", "\"20 us\""),
        ("solver.initial_step", "\"20 us\""),
        ("solver.min_step", "\"20 us\""),
        ("solver.tolerance", "1e-6"),
    ];
    let mut simulation = faster_first(1.0, &changes);
    let why = loop {
        assert!(simulation.time() < 50e-3);
        if let Err(why) = simulation.advance(simulation.time() + 1e-4) {
            break why.to_string();
        }
    };
    assert!(why.contains("between its neighbours"), "{why}");
}
