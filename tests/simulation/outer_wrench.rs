//! The outer race as a rigid body under a wrench, while the inner race is held.

use nalgebra::{UnitQuaternion, Vector3};
use roulement::equilibrium::{self, Equilibrium, EquilibriumInput, Gyroscopic, Prescribed};
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::outputs::Outputs;
use roulement::{Model, Simulation};

use crate::scenes::{HELD, scene};
use crate::statics::load_differences;

type V = Vector3<f64>;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
/// The outer race as the body, the inner one held at the origin.
const MOVES: [(&str, &str); 7] = [
    ("inner.drive", "\"fixed\""),
    ("inner.mass", ""),
    ("inner.inertia", ""),
    ("outer.drive", "\"wrench\""),
    ("outer.mass", "0.2"),
    ("outer.inertia", "[6e-5, 4e-5, 4e-5]"),
    ("load.x", ""),
];

/// The thrust scene with the outer race under these loads.
fn outer(changes: &[(&str, &str)]) -> Scene {
    scene(THRUST, &[&MOVES[..], changes].concat())
}

fn solve(scene: &Scene, gyroscopic: Gyroscopic) -> Equilibrium {
    equilibrium::solve(&Model::new(scene).unwrap(), &EquilibriumInput::from_scene(scene, gyroscopic)).unwrap()
}

fn advanced(scene: &Scene, points: u32, interval: f64) -> Vec<Outputs> {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut history = vec![simulation.outputs().clone()];
    for point in 1..=points {
        simulation.advance_scripted(f64::from(point) * interval).unwrap();
        history.push(simulation.outputs().clone());
    }
    history
}

fn tilted(ry: f64, rz: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::new(V::new(0.0, ry, rz))
}

#[test]
fn invariant_the_outer_race_finds_the_place_that_the_inner_one_finds_from_it() {
    // At rest, without friction and weight, loads alone act: what the inner race needs, turned round, holds the outer one.
    let still =
        [("load.inner_speed", "0.0"), ("effects.creep", "\"frictionless\""), ("friction.ball_race", "0.0")];
    let loads =
        [("load.y", "{ force = 200.0 }"), ("load.ry", "{ moment = 3.0 }"), ("load.rz", "{ moment = -2.0 }")];
    let inner = solve(&scene(THRUST, &[&still[..], &loads].concat()), Gyroscopic::None);
    assert_eq!(inner.race, Race::Inner);
    let [x, y, z, ry, rz] = inner.displacement;
    assert!(ry.abs() > 1e-4 && x > 5e-6, "{:?}", inner.displacement);
    let (position, to_inner) = (V::new(x, y, z), tilted(ry, rz).inverse());
    // What the balls exert on the resting race, by the test's own sum, turned into axes of the inner race.
    let (force, moment) = on_outer(&inner);
    // The inner race passes it on but for what keeps balls at their azimuths, which the tilt gives.
    assert!((force.x - 1500.0).abs() < 1e-2 && (force.y - 200.0).abs() < 1.0, "{force}");
    let (force, moment) = (to_inner * -force, to_inner * -moment);
    let written = [
        ("load.outer.x.force", force.x),
        ("load.outer.y.force", force.y),
        ("load.outer.z.force", force.z),
        ("load.outer.ry.moment", moment.y),
        ("load.outer.rz.moment", moment.z),
    ]
    .map(|(key, value)| (key, format!("{value:e}")));
    let written: Vec<(&str, &str)> = written.iter().map(|(key, value)| (*key, value.as_str())).collect();
    let moved = solve(&outer(&[&still[..], &written].concat()), Gyroscopic::None);
    assert_eq!(moved.race, Race::Outer);
    let [x, y, z, ry, rz] = moved.displacement;
    // Newton's method ends at 1e-11 of the load: 1e-16 m and 1e-14 rad.
    let expected = to_inner * -position;
    assert!((V::new(x, y, z) - expected).norm() < 1e-14, "{:?} {expected}", moved.displacement);
    let off = (tilted(ry, rz) * V::x() - to_inner * V::x()).norm();
    assert!(off < 1e-12, "{off:e}");
    // Stiffness of the running bearing is that of the inner race against the outer one, whichever moves.
    let reported = [("effects.stiffness_outputs", "true")];
    let running = Simulation::new(&outer(&[&still[..], &written, &reported].concat())).unwrap();
    let condensed = running.outputs().condensed.unwrap().stiffness;
    for i in 0..3 {
        for k in 0..3 {
            let scale = (condensed[(i, i)] * condensed[(k, k)]).sqrt();
            let off = (condensed[(i, k)] - moved.stiffness[(i, k)]).abs() / scale;
            assert!(off < 1e-3, "{i} {k}: {off:e}");
        }
    }
    for (one, other) in inner.balls.iter().zip(&moved.balls) {
        assert!((one.report.inner_load / other.report.inner_load - 1.0).abs() < 1e-9);
        assert!((one.report.outer_load / other.report.outer_load - 1.0).abs() < 1e-9);
    }
}

/// Force of all balls on the outer race and their moment about its origin, in its own axes; no friction.
fn on_outer(solution: &Equilibrium) -> (V, V) {
    const RADIUS: f64 = 0.5 * 9.525e-3;
    let (mut force, mut moment) = (V::zeros(), V::zeros());
    for ball in &solution.balls {
        let (sine, cosine) = ball.report.outer_contact_angle.sin_cos();
        let normal = V::new(sine, cosine * ball.azimuth.cos(), cosine * ball.azimuth.sin());
        let push = normal * ball.report.outer_load;
        force += push;
        moment += (ball.position + normal * RADIUS).cross(&push);
    }
    (force, moment)
}

/// A loaded, tilted, spinning, heavy case: both races turn, the inner one is displaced and tilted.
const HEAVY: [(&str, &str); 11] = [
    ("effects.gravity", "[0.0, -3000.0, 500.0]"),
    ("load.inner_speed", "\"9000 rpm\""),
    ("load.outer_speed", "\"-3000 rpm\""),
    ("load.x.displacement", "\"20 um\""),
    ("load.y.displacement", "\"-5 um\""),
    ("load.ry.rotation", "2e-3"),
    ("load.outer.x.force", "-1500.0"),
    ("load.outer.y.force", "300.0"),
    ("load.outer.z.force", "-200.0"),
    ("load.outer.ry.moment", "1.0"),
    ("load.outer.rz.moment", "-2.0"),
];

#[test]
fn closed_form_contact_forces_on_the_outer_race_carry_load_and_weight_about_its_own_origin() {
    let scene = outer(&HEAVY);
    let solution = solve(&scene, Gyroscopic::None);
    let [x, y, z, ry, rz] = solution.displacement;
    let orientation = tilted(ry, rz);
    let (force, moment) = on_outer(&solution);
    let (force, moment) = (orientation * force, orientation * moment);
    let applied = V::new(-1500.0, 300.0, -200.0) + V::new(0.0, -3000.0, 500.0) * 0.2;
    assert!((force + applied).norm() < 1e-8 * applied.norm(), "{force} {applied}");
    assert!((moment.y + 1.0).abs() < 1e-8 && (moment.z - 2.0).abs() < 1e-8, "{moment}");
    let loads = [-1500.0, 300.0 - 600.0, -200.0 + 100.0, 1.0, -2.0];
    for (load, expected) in solution.load.iter().zip(loads) {
        assert!((load - expected).abs() < 1e-7, "{:?}", solution.load);
    }
    // It lies beside the inner race, which is where the scene says.
    let apart = V::new(x, y, z) - V::new(20e-6, -5e-6, 0.0);
    assert!(apart.norm() < 1e-4 && (ry - 2e-3).abs() < 5e-3, "{:?}", solution.displacement);

    // Seen from the outer race the inner one is where the same balance needs it to be.
    let input = EquilibriumInput::from_scene(&scene, Gyroscopic::None);
    let place = orientation.inverse() * (input.resting.position - V::new(x, y, z));
    let lean = (orientation.inverse() * (input.resting.orientation * V::x())).normalize();
    let lean = UnitQuaternion::rotation_between(&V::x(), &lean).unwrap().scaled_axis();
    let gravity = orientation.inverse() * scene.effects.gravity.at(0.0);
    let written = format!("[{:e}, {:e}, {:e}]", gravity.x, gravity.y, gravity.z);
    let held = scene_of_inner(&[("effects.gravity", &written)]);
    let conditions = [place.x, place.y, place.z, lean.y, lean.z].map(Prescribed::Motion);
    let input = EquilibriumInput { conditions, ..EquilibriumInput::from_scene(&held, Gyroscopic::None) };
    let seen = equilibrium::solve(&Model::new(&held).unwrap(), &input).unwrap();
    assert!((seen.cage_speed / solution.cage_speed - 1.0).abs() < 1e-9);
    for (one, other) in seen.balls.iter().zip(&solution.balls) {
        assert!((one.report.inner_load - other.report.inner_load).abs() < 1e-6);
        assert!((one.report.outer_load - other.report.outer_load).abs() < 1e-6);
    }
}

/// The thrust scene at the speeds of the heavy case.
fn scene_of_inner(changes: &[(&str, &str)]) -> Scene {
    let speeds = [("load.inner_speed", "\"9000 rpm\""), ("load.outer_speed", "\"-3000 rpm\"")];
    scene(THRUST, &[&speeds[..], changes].concat())
}

#[test]
fn invariant_the_stiffness_is_the_difference_of_loads_of_displaced_outer_races() {
    let scene = outer(&HEAVY);
    let model = Model::new(&scene).unwrap();
    for gyroscopic in [Gyroscopic::None, Gyroscopic::Friction] {
        let input = EquilibriumInput::from_scene(&scene, gyroscopic);
        let here = equilibrium::solve(&model, &input).unwrap();
        let differences = load_differences(&model, &input, &here.displacement);
        let scale = |i: usize, k: usize| (differences[(i, i)] * differences[(k, k)]).abs().sqrt();
        for i in 0..5 {
            for k in 0..5 {
                let off = (here.stiffness[(i, k)] - differences[(i, k)]).abs() / scale(i, k);
                assert!(off < 1e-5, "{gyroscopic:?} {i} {k}: {off:e}");
            }
        }
    }
}

#[test]
fn invariant_a_heavy_outer_race_swings_about_the_inner_one_as_the_inner_one_about_it() {
    // Without friction and much heavier than the balls; a load falls by a tenth within 10 us.
    let still = [
        ("load.inner_speed", "0.0"),
        ("effects.creep", "\"frictionless\""),
        ("friction.ball_race", "0.0"),
        ("effects.damping", ""),
        ("solver.max_step", "\"5 us\""),
    ];
    let drop = |sign: f64| format!("[[0, {}], [1e-5, {}]]", sign * 1500.0, sign * 1350.0);
    let (towards, back) = (drop(1.0), drop(-1.0));
    let body = [("inner.mass", "20.0"), ("inner.inertia", "[6e-3, 4e-3, 4e-3]"), ("load.x.force", &towards)];
    let inner = advanced(&scene(THRUST, &[&still[..], &body, &HELD].concat()), 60, 1e-4);
    let body = [
        ("outer.mass", "20.0"),
        ("outer.inertia", "[6e-3, 4e-3, 4e-3]"),
        ("load.outer.x.force", back.as_str()),
        ("load.outer.y.displacement", "0.0"),
        ("load.outer.z.displacement", "0.0"),
        ("load.outer.ry.rotation", "0.0"),
        ("load.outer.rz.rotation", "0.0"),
    ];
    let outer = advanced(&outer(&[&still[..], &body].concat()), 60, 1e-4);
    let place = |outputs: &Outputs| outputs.inner.pose.position.x - outputs.outer.pose.position.x;
    let swing = |history: &[Outputs]| {
        let places: Vec<f64> = history.iter().map(place).collect();
        places.iter().fold(0.0f64, |most, x| most.max((x - places[0]).abs()))
    };
    let size = swing(&inner);
    assert!(size > 5e-7, "{size:e}");
    for (one, other) in inner.iter().zip(&outer) {
        // The balls, two thousandths of the mass, move with the other race.
        assert!((place(one) - place(other)).abs() < 5e-3 * size, "{} s", one.time);
    }
}

#[test]
fn invariant_energy_of_a_run_with_a_scripted_wrench_on_the_outer_race() {
    let script = [
        ("load.outer_speed", "\"-3000 rpm\""),
        ("load.outer.x.force", "[[0, -1500], [\"1 ms\", -2500], [\"2 ms\", -1000]]"),
        ("load.outer.y.force", "[[0, 0], [\"1.5 ms\", 400]]"),
        ("load.outer.rz.moment", "[[0, 0], [\"1 ms\", 2]]"),
        ("effects.gravity", "[0, 0, -9.81]"),
    ];
    let history = advanced(&outer(&script), 30, 1e-4);
    let (first, last) = (&history[0], &history[30]);
    let balance = last.work - last.dissipated - (last.stored_energy - first.stored_energy);
    assert!(balance.abs() < 1e-3 * last.work.abs().max(last.dissipated), "{balance} of {}", last.work);
    assert!(last.dissipated > 0.0);
    // The constraint holds the speed, and its torque carries the friction of the bearing.
    let axis = last.outer.pose.orientation * V::x();
    assert!((last.outer.twist.angular_velocity.dot(&axis) + 100.0 * std::f64::consts::PI).abs() < 1e-7);
    assert!(last.outer.drive_torque < 0.0 && last.outer.pose.position.norm() > 1e-6);
    assert_eq!(last.inner.pose.position, V::zeros());
}

#[test]
fn invariant_the_wrench_does_not_depend_on_the_distance_of_rows() {
    let step = [
        ("solver.max_step", "7.62939453125e-6"),
        ("solver.initial_step", "7.62939453125e-6"),
        ("solver.tolerance", "1e-2"),
    ];
    // The outer race alone turns: the path of one that is held is laid anew in every row.
    let table = [
        ("load.outer.x.force", "[[0, -1500], [0.001953125, -2500]]"),
        ("load.inner_speed", "0.0"),
        ("load.outer_speed", "600.0"),
    ];
    let scene = outer(&[&step[..], &table].concat());
    let interval = f64::from_bits(0x3ee0_0000_0000_0000);
    let (fine, coarse) = (advanced(&scene, 256, 2.0 * interval), advanced(&scene, 4, 128.0 * interval));
    assert!(fine[256] == coarse[4]);
}

#[test]
fn closed_form_the_weight_of_the_outer_race_rests_on_the_balls_at_the_start() {
    // A housing on a shaft: only its weight loads the bearing, along y.
    const RADIAL: &str = include_str!("../../scenes/radial.toml");
    let changes = [
        ("load.inner_speed", "\"1500 rpm\""),
        ("effects.gravity", "[0.0, -9.81, 0.0]"),
        ("outer.mass", "50.0"),
        ("load.y", ""),
        ("load.outer.x.displacement", "0.0"),
        ("load.outer.ry.rotation", "0.0"),
        ("load.outer.rz.rotation", "0.0"),
    ];
    let mut simulation = Simulation::new(&scene(RADIAL, &[&MOVES[..], &changes].concat())).unwrap();
    let weight = 9.81 * 50.0;
    let start = simulation.outputs().outer.pose.position.y;
    // It hangs on the balls at its top.
    assert!(start < -1e-6, "{start:e}");
    let mut largest = 0.0f64;
    for step in 1..=200 {
        simulation.advance(f64::from(step) * 1e-4).unwrap();
        largest = largest.max((simulation.outputs().outer.wrench.force.y / weight - 1.0).abs());
    }
    // What is left is the change of stiffness as balls pass over the load, as for a rotor (tests/simulation/start.rs).
    assert!(largest < 0.1, "off by {largest}");
    let moved = simulation.outputs().outer.pose.position.y - start;
    assert!(moved.abs() < 2e-6, "fell by {moved} m");
}

#[test]
fn regression_what_makes_no_sense_is_refused_with_key_value_and_reason() {
    let refused = |changes: &[(&str, &str)], parts: &[&str]| {
        let message = Scene::edited(THRUST, changes.iter().copied()).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{message}\nshould say {part}");
        }
    };
    let with = |changes: &[(&'static str, &'static str)]| [&MOVES[..], changes].concat();
    refused(
        &[("outer.drive", "\"wrench\""), ("outer.mass", "0.2"), ("outer.inertia", "[1e-5, 1e-5, 1e-5]")],
        &["outer.drive", "inner.drive = \"wrench\"", "nothing would hold the bearing"],
    );
    refused(&with(&[("load.y.force", "300.0")]), &["load.y.force", "300", "held", "load.outer.y"]);
    refused(&[("load.outer.x.force", "300.0")], &["load.outer", "outer.drive = \"wrench\""]);
    refused(
        &with(&[("outer.misalignment.ry", "1e-4")]),
        &["outer.misalignment.ry", "0.0001", "load.outer.ry"],
    );
    refused(
        &with(&[("load.outer.x", "{ force = 1.0, displacement = 0.0 }")]),
        &["load.outer.x", "at most one"],
    );
    refused(
        &with(&[("load.outer.x.force", "1e10")]),
        &["load.outer.x.force = 10000000000", "[-1000000000, 1000000000] N"],
    );
    refused(&with(&[("load.outer.rx.moment", "1.0")]), &["load.outer.rx"]);
    refused(&with(&[("outer.mass", "")]), &["outer", "give its mass"]);
}
