//! Races on flexible supports against independent data (tests/data/effects/README.md), limits and invariants.

use nalgebra::{DMatrix, SMatrix, SVector, UnitQuaternion, Vector3};
use roulement::dynamics::{BodyLoad, Boundary, Workspace, make_consistent};
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic, Prescribed};
use roulement::model::Model;
use roulement::model::bodies::{PerRace, Race};
use roulement::numerics::motion::Pose;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use serde_json::Value;

use crate::energy::open_share;
use crate::scenes::scene;
use crate::stepping::step;

type V = Vector3<f64>;
type Five = SVector<f64, 5>;
type Stiffness = SMatrix<f64, 5, 5>;

const DATA: &str = include_str!("../data/effects/support.json");
const THRUST: &str = include_str!("../../scenes/thrust.toml");
const RADIAL: &str = include_str!("../../scenes/radial.toml");
/// Names of the directions: in the data, of loads there, and in scenes with their loads and motions.
const DIRECTIONS: [(&str, &str, &str, &str, &str); 5] = [
    ("ux", "Fx", "x", "force", "displacement"),
    ("uy", "Fy", "y", "force", "displacement"),
    ("uz", "Fz", "z", "force", "displacement"),
    ("ry", "My", "ry", "moment", "rotation"),
    ("rz", "Mz", "rz", "moment", "rotation"),
];

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn matrix(value: &Value) -> Stiffness {
    let rows: Vec<f64> = value.as_array().unwrap().iter().flat_map(numbers).collect();
    Stiffness::from_row_slice(&rows)
}

/// [m] along the axis from the race's origin to the point that the data count moments about and put the support at: the middle of
/// the inner groove.
fn arm(case: &Value) -> f64 {
    match case["bearing"].as_str().unwrap() {
        "7206" => 0.02 * 9.525e-3 * 25f64.to_radians().sin(),
        _ => 0.0,
    }
}

/// What turns displacements of the race's origin into those of that point.
fn to_point(case: &Value) -> Stiffness {
    let mut shift = Stiffness::identity();
    // u + r x p, with p along x.
    (shift[(1, 4)], shift[(2, 3)]) = (arm(case), -arm(case));
    shift
}

/// Stiffness of the support about the race's origin.
fn support_of(case: &Value) -> Stiffness {
    let spring = Stiffness::from_diagonal(&Five::from_vec(numbers(&case["support_stiffness"])));
    to_point(case).transpose() * spring * to_point(case)
}

/// A case of the data as a scene: balls with hardly any mass, frictionless, at rest, every step equal.
fn scene_of(case: &Value) -> Scene {
    let geometry = match case["bearing"].as_str().unwrap() {
        "7206" => "balls = 13\nball_diameter = 9.525e-3\npitch_diameter = 46e-3\ncontact_angle = \"25 deg\"",
        _ => "balls = 9\nball_diameter = 9.525e-3\npitch_diameter = 46e-3\ndiametral_clearance = \"10 um\"",
    };
    let support = support_of(case);
    let place = |i: usize| if i < 3 { Some(i) } else { i.checked_sub(1).filter(|k| *k > 2) };
    let row = |i: usize| -> Vec<f64> {
        let entry = |k: usize| match (place(i), place(k)) {
            (Some(i), Some(k)) => support[(i, k)],
            // The data leave the turn about the axis out.
            _ => {
                if i == k {
                    5e4
                } else {
                    0.0
                }
            }
        };
        (0..6).map(entry).collect()
    };
    let stiffness: Vec<Vec<f64>> = (0..6).map(row).collect();
    // The data have no balls that move; those under a radial load run away along their orbit the sooner, the lighter they are.
    let density = if case["bearing"] == "7206" { 78.0 } else { 200.0 };
    let (mass, inertia) = (&case["race_mass_kg"], &case["race_inertia_kg_m2"]);
    let mut load = String::new();
    for (held, loaded, direction, does, moves) in DIRECTIONS {
        if let Some(value) = case["load"].get(loaded) {
            load += &format!("{direction} = {{ {does} = {value} }}\n");
        } else if let Some(value) = case["held"].get(held) {
            load += &format!("{direction} = {{ {moves} = {value} }}\n");
        }
    }
    Scene::parse(&format!(
        "[bearing]\n{geometry}\ninner_conformity = 0.52\nouter_conformity = 0.53\n[ball]\ndensity = {density}\n\
         [effects]\ncreep = \"frictionless\"\ndamping = 0.0\n\
         [inner]\ndrive = \"pose\"\nshoulder_angle = [1.5, 1.5]\n\
         [inner.support]\nstiffness = {stiffness:?}\nmass = {mass}\n\
         inertia = [5e-5, {inertia}, {inertia}]\n\
         [outer]\nshoulder_angle = [1.5, 1.5]\n\
         [solver]\nalpha_f = 0.05\ninitial_step = 5e-7\nmax_step = 5e-7\n\
         [load]\n{load}"
    ))
    .unwrap()
}

fn cases() -> Vec<Value> {
    serde_json::from_str::<Value>(DATA).unwrap().as_array().unwrap().clone()
}

/// Displacements of a race and components of its rotation vector.
fn place(pose: &Pose) -> Five {
    let (position, turn) = (pose.position, pose.orientation.scaled_axis());
    Five::new(position.x, position.y, position.z, turn.y, turn.z)
}

/// What the flange has to be loaded with, the moment about the race's origin as in the data.
fn load_on_flange(simulation: &Simulation) -> Five {
    let wrench = simulation.outputs().inner.wrench;
    let arm = simulation.state().race(Race::Inner).pose.position - simulation.inputs().inner.pose.position;
    let moment = wrench.moment - arm.cross(&wrench.force);
    -Five::new(wrench.force.x, wrench.force.y, wrench.force.z, moment.y, moment.z)
}

#[test]
fn independent_data_places_of_race_and_flange_and_the_stiffness_at_the_flange() {
    for case in cases() {
        let id = case["id"].as_str().unwrap();
        let simulation = Simulation::new(&scene_of(&case)).unwrap();
        let race = place(&simulation.state().race(Race::Inner).pose);
        let expected = Five::from_vec(numbers(&case["displacement"]));
        assert!((race - expected).amax() < 1e-9, "{id}: {race} {expected}");
        // The flange is where its spring takes the load, or is held.
        let flange = place(&simulation.inputs().inner.pose);
        let spring = numbers(&case["support_stiffness"]);
        let carried = load_on_flange(&simulation);
        for (i, (held, loaded, ..)) in DIRECTIONS.into_iter().enumerate() {
            if case["held"].get(held).is_some() {
                assert_eq!(flange[i], 0.0, "{id} {held}");
            } else {
                let load = case["load"].get(loaded).map_or(0.0, |load| load.as_f64().unwrap());
                assert!((carried[i] - load).abs() < 1e-6, "{id} {loaded}: {} {load}", carried[i]);
                assert!((flange[i] - race[i] - load / spring[i]).abs() < 1e-12, "{id} {loaded}");
            }
        }
        // Stiffness by moving the flange: that of bearing and support in series, and that of the data.
        let held = EquilibriumInput {
            conditions: <[f64; 5]>::from(race).map(Prescribed::Motion),
            ..EquilibriumInput::from_scene(simulation.scene(), Gyroscopic::None)
        };
        let bearing = equilibrium::solve(simulation.model(), &held).unwrap().stiffness;
        let support = support_of(&case);
        let series = support - support * (support + bearing).try_inverse().unwrap() * support;
        // About the point of the data.
        let back = to_point(&case).try_inverse().unwrap();
        let series = back.transpose() * series * back;
        let reference = matrix(&case["flange_stiffness"]);
        let loads = |k: usize, by: f64| {
            let mut moved = simulation.clone();
            let mut inputs = *simulation.inputs();
            let mut to = flange;
            to[k] += by;
            inputs.inner.pose = Pose {
                position: V::new(to[0], to[1], to[2]),
                orientation: UnitQuaternion::new(V::new(0.0, to[3], to[4])),
            };
            moved.set_inputs(inputs);
            moved.initialise().unwrap();
            load_on_flange(&moved)
        };
        let long = carried.amax() / spring[..3].iter().copied().fold(f64::INFINITY, f64::min);
        let mut measured = Stiffness::zeros();
        for k in 0..5 {
            let by = if k < 3 { 5e-9 } else { 5e-7 };
            measured.set_column(k, &((loads(k, by) - loads(k, -by)) / (2.0 * by)));
        }
        let measured = back.transpose() * measured * back;
        for k in 0..5 {
            for i in 0..5 {
                let size = (reference[(i, i)] * reference[(k, k)]).sqrt();
                // In linear theory race and flange are at one place. Here the spring between them is some 10 um long under its load: a
                // flange that tilts turns that load, and its own centre of tilt is not the race's.
                let turned = match (i, k) {
                    (_, 0..3) => 0.0,
                    (0..3, _) => carried.amax(),
                    _ => long * series.view((0, k), (3, 1)).amax() + 1e-4 * carried.amax(),
                };
                let off = |expected: f64| ((measured[(i, k)] - expected).abs() - turned) / size;
                let resolved = if k < 3 { 1e-6 } else { 1e-5 };
                assert!(
                    off(series[(i, k)]) < resolved,
                    "{id} {i} {k}: {} {}",
                    measured[(i, k)],
                    series[(i, k)]
                );
                // The last digits of the reference's Hertz table, as in its other stiffnesses (equilibrium_reference.rs).
                assert!(
                    off(reference[(i, k)]) < 2e-5,
                    "{id} {i} {k}: {} {}",
                    measured[(i, k)],
                    reference[(i, k)]
                );
            }
        }
    }
}

/// [s] step.
const STEP: f64 = 5e-7;

/// Frequency \[Hz] at which a number crosses zero, by its first and last crossing in equal steps.
fn frequency(history: &[f64], h: f64) -> f64 {
    let crossings: Vec<f64> = (1..history.len())
        .filter(|&i| (history[i - 1] < 0.0) != (history[i] < 0.0))
        .map(|i| i as f64 - history[i] / (history[i] - history[i - 1]))
        .collect();
    0.5 * (crossings.len() - 1) as f64 / (h * (crossings[crossings.len() - 1] - crossings[0]))
}

#[test]
fn independent_data_eigenfrequencies_of_a_kicked_race() {
    for case in cases() {
        let id = case["id"].as_str().unwrap();
        let simulation = Simulation::new(&scene_of(&case)).unwrap();
        let mut model = Model::new(simulation.scene()).unwrap();
        model.solver.tolerance = f64::INFINITY;
        let mass = case["race_mass_kg"].as_f64().unwrap();
        let inertia = case["race_inertia_kg_m2"].as_f64().unwrap();
        let masses = Five::new(mass, mass, mass, inertia, inertia);
        let spring = support_of(&case);
        let root = Stiffness::from_diagonal(&masses.map(|m| 1.0 / m.sqrt()));
        let bearing = to_point(&case).transpose() * matrix(&case["bearing_stiffness"]) * to_point(&case);
        let stiffness = bearing + spring;
        let modes = DMatrix::from_iterator(5, 5, (root * stiffness * root).iter().copied()).symmetric_eigen();
        let mut frequencies = numbers(&case["eigenfrequencies_Hz"]);
        for mode in 0..5 {
            let shape = modes.eigenvectors.column(mode).clone_owned();
            let kicked = |direction: f64| -> Vec<f64> {
                let mut state = simulation.state().clone();
                let inner = &mut state.bodies[Race::Inner];
                // 0.1 mm/s at the pitch circle: 3 nm.
                let velocity = |i: usize| direction * 1e-4 * shape[i] * (mass / masses[i]).sqrt();
                inner.velocity += V::new(velocity(0), velocity(1), velocity(2));
                inner.rate += V::new(0.0, velocity(3), velocity(4));
                inner.refresh_motion();
                let inputs = simulation.inputs();
                let mut boundary = Boundary {
                    time: 0.0,
                    motion: PerRace::new(|race| (inputs[race].pose, inputs[race].twist)),
                    loads: PerRace::new(|_| BodyLoad::default()),
                    conditions: simulation.conditions(),
                    frame: Default::default(),
                    orientations: None,
                };
                make_consistent(&model, &mut state, &boundary);
                let mut workspace = Workspace::default();
                let moved = |_| {
                    boundary.time += STEP;
                    step(&model, &mut state, &boundary, STEP, &mut workspace);
                    let race = state.race(Race::Inner);
                    let (v, w) = (race.velocity, race.rate);
                    let moved = Five::new(v.x, v.y, v.z, w.y, w.z);
                    (0..5).map(|i| shape[i] * masses[i].sqrt() * moved[i]).sum()
                };
                (0..1200).map(moved).collect()
            };
            // Without friction nothing holds the balls along their orbit; what that does is the same after both kicks.
            let [plus, minus] = [1.0, -1.0].map(kicked);
            let history: Vec<f64> = plus.iter().zip(&minus).map(|(plus, minus)| plus - minus).collect();
            let found = frequency(&history, STEP);
            let nearest = (0..frequencies.len())
                .min_by(|&a, &b| (frequencies[a] - found).abs().total_cmp(&(frequencies[b] - found).abs()))
                .unwrap();
            let expected = frequencies.remove(nearest);
            assert!((found / expected - 1.0).abs() < 5e-3, "{id} mode {mode}: {found} Hz, {expected} Hz");
        }
    }
}

/// The thrust case with its inner race given, spinning.
fn given(changes: &[(&str, &str)]) -> Scene {
    let pose = [
        ("inner", "{ drive = \"pose\" }"),
        ("load.x", "{ displacement = 1.6e-5 }"),
        ("load.y", "{ displacement = 2e-6 }"),
        ("load.z", "{ displacement = 0.0 }"),
        ("load.ry", "{ rotation = 2e-4 }"),
        ("load.rz", "{ rotation = 0.0 }"),
        ("load.inner_speed", "\"3000 rpm\""),
    ];
    scene(THRUST, &[&pose[..], changes].concat())
}

fn support(stiffness: f64, damping: f64) -> String {
    let [t, r] = [stiffness, stiffness * 1e-3];
    let [dt, dr] = [damping, damping * 1e-3];
    format!(
        "{{ drive = \"pose\", support = {{ stiffness = [{t:?}, {t:?}, {t:?}, {r:?}, {r:?}, {r:?}], mass = 0.1, \
         inertia = [3e-5, 2e-5, 2e-5], damping = [{dt:?}, {dt:?}, {dt:?}, {dr:?}, {dr:?}, {dr:?}] }} }}"
    )
}

#[test]
fn limit_a_stiff_support_is_a_given_race() {
    let run = |scene: &Scene| {
        let mut simulation = Simulation::new(scene).unwrap();
        simulation.advance_scripted(1e-3).unwrap();
        simulation
    };
    let rigid = run(&given(&[]));
    let (one, mut last) = (rigid.outputs(), f64::INFINITY);
    for stiffness in [1e10, 1e12] {
        let held = support(stiffness, 1e-6 * stiffness);
        let stiff = run(&given(&[("inner", held.as_str())]));
        let other = stiff.outputs();
        let size = one.inner.wrench.force.norm();
        let off = (one.inner.wrench.force - other.inner.wrench.force).norm() / size;
        let turned = (one.inner.wrench.moment - other.inner.wrench.moment).norm() / (size * 23e-3);
        assert!(off < 3e8 / stiffness && turned < 3e8 / stiffness, "{stiffness:e}: {off:e} {turned:e}");
        assert!(off < last);
        last = off;
        for (a, b) in one.balls.iter().zip(&other.balls) {
            assert!((a.inner.load / b.inner.load - 1.0).abs() < 1e9 / stiffness);
        }
    }
}

#[test]
fn invariant_a_run_starts_in_balance_and_its_energy_closes() {
    // Inner race on a soft shaft, spinning; both races; a rotor in a flexible housing, under its weight.
    let soft = support(5e7, 300.0);
    let housing = soft.replace("\"pose\"", "\"fixed\"");
    let weight = "[0.0, -9.81, 0.0]";
    let small = [("solver.max_step", "1e-6"), ("solver.initial_step", "1e-6"), ("solver.alpha_f", "1e-5")];
    let inner = given(&[&small[..], &[("inner", soft.as_str())]].concat());
    let both = given(&[&small[..], &[("inner", soft.as_str()), ("outer", housing.as_str())]].concat());
    let rotor = [("outer", housing.as_str()), ("effects.gravity", weight), ("inner.mass", "20.0")];
    let rotor = scene(RADIAL, &[&small[..], &rotor].concat());
    for (name, scene) in [("inner", inner), ("both", both), ("rotor", rotor)] {
        let mut simulation = Simulation::new(&scene).unwrap();
        let before = simulation.outputs().clone();
        for race in Race::BOTH {
            let Some(support) = &simulation.state().supports[race] else {
                continue;
            };
            // Off balance by friction and damping of the contacts alone: the equilibrium knows neither.
            let body = simulation.state().race(race);
            let off = body.total.force.norm() / support.wrench.force.norm();
            assert!(off < 0.03, "{name} {race:?}: {off}");
        }
        simulation.advance(3e-3).unwrap();
        let after = simulation.outputs();
        let open = open_share(&before, after);
        assert!(open.abs() < 1e-4, "{name}: {open:e}");
        for race in Race::BOTH {
            if let (Some(then), Some(now)) = (&before.supports[race as usize], &after.supports[race as usize])
            {
                let moved = (now.displacement - then.displacement).norm();
                assert!(moved < 0.5 * then.displacement.norm() + 1e-6, "{name}: {moved}");
            }
        }
    }
}

#[test]
fn replay_a_supported_bearing_goes_on_from_a_snapshot_to_the_same_bits() {
    let soft = support(5e7, 300.0);
    let scene = given(&[("inner", soft.as_str())]);
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.advance(5e-4).unwrap();
    let snapshot = simulation.snapshot();
    simulation.advance(1e-3).unwrap();
    let mut other = Simulation::new(&scene).unwrap();
    assert!(other.restore(&snapshot));
    other.advance(1e-3).unwrap();
    assert!(other.state() == simulation.state() && other.outputs() == simulation.outputs());
}

#[test]
fn wrong_supports_are_refused_by_name_and_reason() {
    let refusal = |changes: &[(&str, &str)]| {
        let pose = [("inner", "{ drive = \"pose\" }"), ("load.x", "{ displacement = 1e-5 }")];
        let all: Vec<_> = pose.iter().chain(changes).copied().collect();
        Scene::edited(THRUST, all).unwrap_err().to_string()
    };
    let good = "mass = 0.1, inertia = [3e-5, 2e-5, 2e-5]";
    let with = |stiffness: &str| format!("{{ stiffness = {stiffness}, {good} }}");
    let lopsided = "[[1e8, 1e7, 0, 0, 0, 0], [0, 1e8, 0, 0, 0, 0], [0, 0, 1e8, 0, 0, 0], [0, 0, 0, 1e4, 0, 0], \
                    [0, 0, 0, 0, 1e4, 0], [0, 0, 0, 0, 0, 1e4]]";
    let giving = lopsided.replacen("[1e8, 1e7", "[1e8, 2e8", 1).replacen("[0, 1e8", "[2e8, 1e8", 1);
    for (support, parts) in [
        (with("[1e8, 1e8, 1e8, 1e4, 1e4, 0]"), &["inner.support.stiffness = 0", "(0, "][..]),
        (with("[1e8, 1e8, 1e8, 1e4, 1e4]"), &["inner.support", "six numbers"]),
        (
            with("[\"100 N/um\", \"1 N m\", 1e8, 1e4, 1e4, 1e4]"),
            &["inner.support", "1 N m", "measures something else"],
        ),
        (with(lopsided), &["inner.support.stiffness", "symmetric"]),
        (with(&giving), &["inner.support.stiffness", "must not give energy"]),
        (
            with("[1e8, 1e8, 1e8, 1e4, 1e4, 1e4]").replace("0.1", "-0.1"),
            &["inner.support.mass = -0.1", "(0, 100000] kg"],
        ),
    ] {
        let message = refusal(&[("inner.support", support.as_str())]);
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
    let support = with("[1e8, 1e8, 1e8, 1e4, 1e4, 1e4]");
    let message = Scene::edited(THRUST, [("inner.support", support.as_str())]).unwrap_err().to_string();
    assert!(message.contains("inner.support") && message.contains("wrench"), "{message}");
    let units = support
        .replace("[1e8, 1e8, 1e8, 1e4, 1e4, 1e4]", "[\"100 N/um\", 1e8, 1e8, \"10 kN m/rad\", 1e4, 1e4]");
    let pose = [("inner", "{ drive = \"pose\" }"), ("load.x", "{ displacement = 1e-5 }")];
    let scene = Scene::edited(THRUST, [pose[0], pose[1], ("inner.support", units.as_str())]).unwrap();
    let section = scene.effects.support.sections[0].as_ref().unwrap();
    assert_eq!(section.stiffness.diagonal(), [1e8, 1e8, 1e8, 1e4, 1e4, 1e4]);
}
