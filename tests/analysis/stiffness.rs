//! Stiffness and damping of the running bearing, balls condensed out.

use nalgebra::{Matrix2, Matrix3, Matrix6, SMatrix, UnitQuaternion, Vector2, Vector3, Vector6};
use std::ops::AddAssign;

use roulement::analysis::condensed::Condensed;
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::interface::variables::Variables;
use roulement::model::Conditions;
use roulement::model::Model;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use serde_json::Value;

use crate::mechanics::{Body, Dimensions, V, grooves};
use crate::reference::{cases, number, scene_text};
use crate::scenes::{HELD, scene};
use crate::statics::load_differences;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
/// Rows and columns x, y, z, ry, rz of six.
const FIVE: [usize; 5] = [0, 1, 2, 4, 5];

/// A reference case at a fraction of its speeds, starting in its quasi-static equilibrium.
fn start(case: &Value, speed: f64, effects: &str) -> Simulation {
    let mut case = case.clone();
    for key in ["inner_speed", "outer_speed"] {
        case[key] = Value::from(number(&case[key]) * speed);
    }
    let text = format!(
        "[inner]\ndrive = \"wrench\"\nmass = 0.05\ninertia = [2e-5, 1e-5, 1e-5]\n[effects]\nstiffness_outputs = true\n{effects}\n"
    ) + &scene_text(&case);
    Simulation::new(&Scene::parse(&text).unwrap()).unwrap()
}

/// Largest difference of two stiffnesses, each component over the root of its diagonal ones.
fn difference(ours: &Matrix6<f64>, theirs: &SMatrix<f64, 5, 5>) -> f64 {
    let scale = |i: usize, k: usize| (theirs[(i, i)] * theirs[(k, k)]).abs().sqrt();
    let mut worst = 0.0f64;
    for (i, row) in FIVE.into_iter().enumerate() {
        for (k, column) in FIVE.into_iter().enumerate() {
            worst = worst.max((ours[(row, column)] - theirs[(i, k)]).abs() / scale(i, k));
        }
    }
    worst
}

#[test]
fn invariant_stiffness_at_rest_is_that_of_the_equilibrium() {
    for case in cases() {
        let simulation = start(&case, 0.0, "creep = \"frictionless\"");
        let ours = simulation.outputs().condensed.unwrap().stiffness;
        let model = Model::new(simulation.scene()).unwrap();
        let input = EquilibriumInput::from_scene(simulation.scene(), Gyroscopic::None);
        let here = equilibrium::solve(&model, &input).unwrap();
        let differences = load_differences(&model, &input, &here.displacement);
        let d = difference(&ours, &differences);
        println!("{} {d:.1e}", case["id"]);
        assert!(d < 1e-3, "{}: {d:e}", case["id"]);
    }
}

#[test]
fn closed_form_stiffness_at_speed_with_the_centrifugal_force_of_held_orbits() {
    // Statics by own formulas: each ball finds its place in its azimuthal plane between Hertz's forces and its centrifugal
    // force, at the azimuth and orbital speed that it has. Central differences of the load that holds the inner race.
    let text = "[bearing]\nballs = 7\nball_diameter = 0.0127\npitch_diameter = 0.06\ncontact_angle = 0.4\n\
                inner_conformity = 0.515\nouter_conformity = 0.525\n[friction]\nball_race = 0.0\n\
                [effects]\ncreep = \"frictionless\"\nstiffness_outputs = true\n\
                [inner]\ndrive = \"wrench\"\nmass = 0.05\ninertia = [2e-5, 1e-5, 1e-5]\n\
                [outer]\nmisalignment = { ry = 3e-4 }\n\
                [load]\ninner_speed = 2500.0\nx = { force = 900.0 }\ny = { force = 150.0 }\nrz = { rotation = 2e-4 }\n";
    let simulation = Simulation::new(&Scene::parse(text).unwrap()).unwrap();
    let ours = simulation.outputs().condensed.unwrap().stiffness;
    let (diameter, steel) = (0.0127, (206e9, 0.3));
    let dimensions = Dimensions {
        ball_radius: 0.5 * diameter,
        grooves: grooves(diameter, 0.06, 0.4, [0.515, 0.525]),
        materials: [steel; 2],
        friction: 0.0,
        damping: 0.0,
    };
    let mass = 7800.0 * std::f64::consts::PI / 6.0 * f64::powi(diameter, 3);
    let still = |position: V, orientation: UnitQuaternion<f64>| Body {
        position,
        orientation,
        velocity: V::zeros(),
        omega: V::zeros(),
    };
    let pose = simulation.outputs().inner.pose;
    let outer = still(V::zeros(), simulation.outputs().outer.pose.orientation);
    let axis = outer.axis();
    let mut ratio = 0.0f64;
    let mut load = |change: Vector6<f64>| {
        let turn = UnitQuaternion::new(change.fixed_rows::<3>(3).into_owned());
        let inner = still(pose.position + change.fixed_rows::<3>(0), turn * pose.orientation);
        let mut load = Vector6::zeros();
        for ball in &simulation.state().balls {
            let offset = ball.position - axis * ball.position.dot(&axis);
            let (radius, radial) = (offset.norm(), offset.normalize());
            let speed = ball.velocity.norm() / radius;
            let at = |place: &Vector2<f64>| {
                let ball = still(axis * place.x + radial * place.y, UnitQuaternion::identity());
                let on = |race, body| dimensions.ball_race(race, &ball, body).unwrap();
                let contacts = [on(0, &inner), on(1, &outer)];
                let centrifugal = mass * place.y * speed * speed;
                let sum = contacts[0].force + contacts[1].force + radial * centrifugal;
                (Vector2::new(sum.dot(&axis), sum.dot(&radial)), contacts, centrifugal)
            };
            let mut place = Vector2::new(ball.position.dot(&axis), radius);
            for _ in 0..8 {
                let h = 1e-9;
                let column = |k: usize| {
                    let change = Vector2::ith(k, h);
                    (at(&(place + change)).0 - at(&(place - change)).0) / (2.0 * h)
                };
                let slope = Matrix2::from_columns(&[column(0), column(1)]);
                place -= slope.lu().solve(&at(&place).0).unwrap();
            }
            let (rest, contacts, centrifugal) = at(&place);
            assert!(rest.norm() < 1e-7 * contacts[1].load, "{rest} {contacts:?}");
            ratio = ratio.max(centrifugal / contacts[0].load);
            load.fixed_rows_mut::<3>(0).add_assign(contacts[0].force);
            load.fixed_rows_mut::<3>(3).add_assign(-contacts[0].other_moment);
        }
        load
    };
    let mut differences = Matrix6::zeros();
    for k in 0..6 {
        let h = if k < 3 { 2e-9 } else { 1e-7 };
        let slope = (load(Vector6::ith(k, h)) - load(Vector6::ith(k, -h))) / (2.0 * h);
        differences.set_column(k, &slope);
    }
    assert!(ratio > 0.5, "centrifugal force over load {ratio}");
    // About the axis nothing resists but what tilts the moment.
    let scale = |i: usize| if i == 3 { differences[(4, 4)] } else { differences[(i, i)] }.abs();
    for i in 0..6 {
        for k in 0..6 {
            let error = (ours[(i, k)] - differences[(i, k)]).abs() / (scale(i) * scale(k)).sqrt();
            assert!(error < 1e-5, "{i} by {k}: {:e} {:e}", ours[(i, k)], differences[(i, k)]);
        }
    }
}

#[test]
fn independent_data_stiffness_of_the_reference_cases() {
    // Frictionless, where no gyroscopic moment is carried. At rest it is the same matrix. In the data the cage speed, and
    // with it the centrifugal force, follows the contact angles; here it is held: up to 18 % of the axial stiffness where
    // that force is as large as the load (P-10).
    for case in cases() {
        let simulation = start(&case, 1.0, "creep = \"frictionless\"");
        let ours = simulation.outputs().condensed.unwrap().stiffness;
        let reference = SMatrix::<f64, 5, 5>::from_fn(|i, k| number(&case["no_gyro"]["stiffness"][i][k]));
        let d = difference(&ours, &reference);
        println!("{} {} {d:.1e}", case["id"], number(&case["inner_speed"]));
        let bound = match number(&case["inner_speed"]) {
            0.0 => 1e-4,
            speed if speed < 350.0 => 1e-3,
            _ => 0.2,
        };
        assert!(d < bound, "{}: {d:e}", case["id"]);
    }
}

/// Largest asymmetry of a matrix over the root of its diagonal components, the rotations' own taken out: turning the
/// race by two rotations in either order differs by the moment that holds it.
fn asymmetry(stiffness: &Matrix6<f64>, moment: &Vector3<f64>) -> f64 {
    let mut rest = stiffness - stiffness.transpose();
    let mut rotations = rest.fixed_view_mut::<3, 3>(3, 3);
    rotations += moment.cross_matrix();
    let scale = |i: usize| if i == 3 { stiffness[(4, 4)] } else { stiffness[(i, i)] }.abs();
    Matrix6::from_fn(|i, k| rest[(i, k)].abs() / (scale(i) * scale(k)).sqrt()).amax()
}

#[test]
fn invariant_stiffness_is_symmetric_without_friction_and_damping_never_drives() {
    for case in cases() {
        let still = start(&case, 0.0, "creep = \"frictionless\"\ndamping = 0.02");
        let outputs = still.outputs();
        let Condensed { stiffness, damping } = outputs.condensed.unwrap();
        let a = asymmetry(&stiffness, &-outputs.inner.wrench.moment);
        let eigenvalues = |damping: &Matrix6<f64>| {
            // Rotations as displacements at the pitch circle.
            let length = still.model().race_length();
            let scale = |i: usize| if i < 3 { 1.0 } else { 1.0 / length };
            let scaled =
                Matrix6::from_fn(|i, k| 0.5 * (damping[(i, k)] + damping[(k, i)]) * scale(i) * scale(k));
            let eigen = scaled.symmetric_eigenvalues();
            (eigen.min(), eigen.max())
        };
        let (low, high) = eigenvalues(&damping);
        let rolling = start(&case, 1.0, "damping = 0.02").outputs().condensed.unwrap();
        let (low_rolling, high_rolling) = eigenvalues(&rolling.damping);
        println!(
            "{} asymmetry {a:.1e}, damping {low:.1e} to {high:.1e}, rolling {low_rolling:.1e} to {high_rolling:.1e}",
            case["id"]
        );
        // Hertz's stiffness depends on where the ball touches, so that loads have a potential only nearly.
        assert!(a < 1e-3, "{}: {a:e}", case["id"]);
        assert!(low > -1e-9 * high && high > 0.0, "{}: {low:e} {high:e}", case["id"]);
        assert!(low_rolling > -1e-6 * high_rolling, "{}: {low_rolling:e} {high_rolling:e}", case["id"]);
    }
}

/// The thrust case with the inner race's motion given, after 20 ms.
fn running() -> Simulation {
    let given = [
        ("effects.stiffness_outputs", "true"),
        ("inner", "{ drive = \"pose\" }"),
        ("load.x", "{ displacement = \"25 um\" }"),
    ];
    let mut simulation = Simulation::new(&scene(THRUST, &[&given[..], &HELD].concat())).unwrap();
    simulation.advance(20e-3).unwrap();
    simulation
}

/// Force on the inner race along a direction after it was moved that way by `velocity` [m/s] for a time [s].
fn force_after(simulation: &Simulation, direction: usize, velocity: f64, time: f64) -> f64 {
    let mut simulation = simulation.clone();
    for _ in 0..20 {
        let mut inputs = *simulation.inputs();
        let inner = &simulation.outputs().inner;
        inputs.inner.pose = inner.pose;
        inputs.inner.twist = inner.twist;
        inputs.inner.twist.velocity = Vector3::ith(direction, velocity);
        simulation.set_inputs(inputs);
        simulation.advance(simulation.time() + time / 20.0).unwrap();
    }
    simulation.outputs().inner.wrench.force[direction]
}

#[test]
fn closed_form_stiffness_against_slow_motions_of_the_running_bearing() {
    // 0.2 um in 10 ms either way, friction 0.08.
    let simulation = running();
    let stiffness = simulation.outputs().condensed.unwrap().stiffness;
    let (velocity, time) = (2e-5, 10e-3);
    for direction in [0, 1] {
        let [plus, minus] = [velocity, -velocity].map(|v| force_after(&simulation, direction, v, time));
        let seen = (minus - plus) / (2.0 * velocity * time);
        let ours = stiffness[(direction, direction)];
        println!("direction {direction}: stiffness {ours:.4e} seen {seen:.4e}");
        assert!((seen / ours - 1.0).abs() < 0.02, "direction {direction}: {ours:e} {seen:e}");
    }
}

#[test]
fn closed_form_damping_of_one_ball_between_two_contacts() {
    // The clearance leaves all load to the ball at azimuth 0. Two contacts in series share the velocity as their
    // stiffnesses 3/2 Q/delta ask for, and each damps by dissipation factor times load.
    let text = "[bearing]\nballs = 8\nball_diameter = 0.0095\npitch_diameter = 0.046\ndiametral_clearance = 1e-4\n\
                inner_conformity = 0.52\nouter_conformity = 0.52\n\
                [effects]\ncreep = \"frictionless\"\ndamping = 0.02\nstiffness_outputs = true\n\
                [inner]\ndrive = \"wrench\"\nmass = 0.05\ninertia = [2e-5, 1e-5, 1e-5]\n\
                [load]\nx = { displacement = 0.0 }\ny = { force = 50.0 }\nz = { displacement = 0.0 }\n\
                ry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n";
    let simulation = Simulation::new(&Scene::parse(text).unwrap()).unwrap();
    let (outputs, state) = (simulation.outputs(), simulation.state());
    assert_eq!(outputs.balls.iter().filter(|ball| ball.inner.load > 0.0).count(), 1);
    let stiffness = Race::BOTH.map(|race| {
        let contact = simulation.model().contact(race, &Conditions::of_friction(0.0));
        let contact = contact.evaluated(&state.balls[0].motion(), &state.race(race).motion());
        1.5 * contact.load / contact.geometry.approach
    });
    let sum = stiffness[0] + stiffness[1];
    let Condensed { stiffness: k, damping: c } = outputs.condensed.unwrap();
    let series = stiffness[0] * stiffness[1] / sum;
    // Hertz's stiffness depends a little on where the ball touches.
    assert!((k[(1, 1)] / series - 1.0).abs() < 1e-5, "{} {series}", k[(1, 1)]);
    let damped = 0.02 * 50.0 * (stiffness[0].powi(2) + stiffness[1].powi(2)) / (sum * sum);
    assert!((c[(1, 1)] / damped - 1.0).abs() < 1e-5, "{} {damped}", c[(1, 1)]);
}

#[test]
fn only_scenes_that_ask_for_it_have_it() {
    let plain = Scene::parse(THRUST).unwrap();
    let asked = scene(THRUST, &[("effects.stiffness_outputs", "true")]);
    let names = |scene: &Scene| -> Vec<String> {
        Variables::new(scene).rows().iter().map(|row| format!("{} {}", row.name, row.unit.name)).collect()
    };
    assert!(Simulation::new(&plain).unwrap().outputs().condensed.is_none());
    assert!(!names(&plain).iter().any(|name| name.starts_with("stiffness") || name.starts_with("damping.")));
    let names = names(&asked);
    for name in
        ["stiffness.x.y N/m", "stiffness.x.ry N/rad", "stiffness.rz.y N.m/m", "damping.ry.rz N.m.s/rad"]
    {
        assert!(names.iter().any(|one| one == name), "{name}");
    }
    let simulation = Simulation::new(&asked).unwrap();
    let table = Variables::new(&asked);
    let row = table.rows().iter().find(|row| row.name == "stiffness.y.rz").unwrap();
    let value = table.value(row, simulation.inputs(), simulation.outputs());
    assert_eq!(value, simulation.outputs().condensed.unwrap().stiffness[(1, 5)]);
    // An axis of symmetry: what turns about it meets no stiffness, and y is like z.
    let k = simulation.outputs().condensed.unwrap().stiffness;
    let turned =
        Matrix3::new(k[(0, 0)], k[(1, 1)] - k[(2, 2)], k[(3, 3)], k[(0, 1)], 0.0, 0.0, 0.0, 0.0, 0.0);
    assert!(turned.iter().skip(1).all(|c| c.abs() < 1e-6 * turned[0]), "{turned}");
}
