//! Machines in a frame that moves: forces of inertia on shafts, housings, rings and what is in the bearings.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use roulement::interface::variables::{Causality, MachineVariables};
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement::simulation::motions::Motion;
use roulement::simulation::system::System;

use crate::common::{forces, held, imbalance, stored, system};

/// \[kg, kg m2] the rigid shaft.
const MASS: f64 = 1.8;
const POLAR: f64 = 6e-4;
/// \[m] its centre of mass.
const CENTRE: f64 = -0.01;
/// \[rad/s] its speed.
const SPEED: f64 = 300.0;

const RIGID: &str = "mass = 1.8\ncentre = -0.01\npolar_inertia = 6e-4\ntransverse_inertia = 4e-3\n";
const BEAMS: &str = "[[shaft.section]]\nfrom = -0.07\nto = 0.08\nouter_diameter = 0.03\n\
                     [[shaft.disc]]\nposition = 0.02\nmass = 0.5\npolar_inertia = 3e-4\ntransverse_inertia = 2e-4\n";

/// A shaft on two 6206 whose axes point away from each other, with some lines before it.
fn pair(first: &str, shaft: &str, housing: &str) -> String {
    let seat = if housing.is_empty() { "" } else { "housing = \"case\", " };
    format!(
        r#"{first}
[shaft]
speed = {SPEED}
{shaft}
[[shaft.load]]
name = "mesh"
position = 0.02
force = [100, -475.0, 260.5]
{housing}
[[bearing]]
name = "left"
catalogue = "6206"
mounting = {{ {seat}position = -0.05, direction = "+x", preload = {{ force = 300 }} }}
[bearing.set]
effects = {{ creep = "saturated", heathcote_slip = false }}
[[bearing]]
name = "right"
catalogue = "6206"
mounting = {{ {seat}position = 0.05, direction = "-x", preload = {{ force = 300 }} }}
[bearing.set]
effects = {{ creep = "saturated", heathcote_slip = false }}
[load]
duration = 0.002
output_interval = 0.0002
"#
    )
}

const CASE: &str = "[[housing]]\nname = \"case\"\nmass = 12\ninertia = [0.06, 0.08, 0.09]\ncentre = [0.01, 0, -0.02]\n\
                    stiffness = [2e8, 2e8, 2e8, 1e6, 1e6, 1e6]\ndamping = [2e3, 2e3, 2e3, 5, 5, 5]\n";

/// The bearings at the left and the right hold the shaft with this force and this moment about the origin.
fn hold(system: &System) -> [Vector3<f64>; 2] {
    let all = held(system).into_iter().zip([-0.05, 0.05]);
    all.fold([Vector3::zeros(); 2], |[force, moment], ([own, turned], x)| {
        [force + own, moment + turned + Vector3::new(x, 0.0, 0.0).cross(&own)]
    })
}

/// What the load of the scene does about the origin.
fn load() -> [Vector3<f64>; 2] {
    let force = Vector3::new(100.0, -475.0, 260.5);
    [force, Vector3::new(0.02, 0.0, 0.0).cross(&force)]
}

#[test]
fn closed_form_a_frame_that_accelerates_is_weight_against_its_acceleration() {
    for (shaft, housing) in [(RIGID, ""), (RIGID, CASE), (BEAMS, CASE)] {
        let [mut moved, mut weighed] =
            ["[frame]\nacceleration = [30.0, -20.0, 98.1]", "gravity = [-30.0, 20.0, -98.1]"]
                .map(|first| system(&pair(first, shaft, housing)));
        for time in [0.0, 1e-3] {
            if time > 0.0 {
                moved.advance(time).unwrap();
                weighed.advance(time).unwrap();
            }
            for (one, other) in forces(&moved).iter().zip(forces(&weighed)) {
                assert!((one - other).norm() < 1e-9 * other.norm(), "{time}: {one} {other}");
            }
        }
    }
}

#[test]
fn closed_form_a_steady_carrier_loads_the_shaft_by_its_mass_times_arm_times_speed_squared() {
    let (turn, arm) = (20.0, 0.3);
    let first = format!("[frame]\nangular_velocity = [0, 0, {turn}]\narm = [0, {arm}, 0]");
    let system = system(&pair(&first, RIGID, ""));
    let outputs = system.outputs();
    let [force, moment] = hold(&system);
    let [load, of_load] = load();
    // Where the centre of mass has gone to: in the middle of the bearings but for 10 mm.
    let [left, right] = [&outputs.seats[0], &outputs.seats[1]].map(|seat| seat.displacement);
    let gone = left + (right - left) * 0.4;
    let centrifugal = Vector3::new(CENTRE + gone.x, arm + gone.y, 0.0) * (MASS * turn * turn);
    let apart = (force + load + centrifugal).norm();
    assert!(apart < 1e-6 * centrifugal.norm(), "{force} {centrifugal}: {apart}");
    // It turns about +x with 300 rad/s, and its axis is turned towards y with the carrier: `-W x J w = -(0, W J w, 0)`.
    let gyroscopic = Vector3::new(0.0, -POLAR * SPEED * turn, 0.0);
    let all = moment + of_load + Vector3::new(CENTRE, 0.0, 0.0).cross(&centrifugal) + gyroscopic;
    let size = gyroscopic.norm();
    assert!(all.y.abs() < 1e-3 * size && all.z.abs() < 1e-3 * size, "{all} of {size}");
}

#[test]
fn closed_form_beams_in_a_carrier_weigh_and_turn_as_one_body() {
    let (turn, arm) = (20.0, 0.3);
    let first = format!("[frame]\nangular_velocity = [0, 0, {turn}]\narm = [0, {arm}, 0]");
    let system = system(&pair(&first, BEAMS, ""));
    let rod = 7800.0 * std::f64::consts::PI * 0.25 * 0.03f64.powi(2) * 0.15;
    let polar = 0.125 * rod * 0.03f64.powi(2) + 3e-4;
    let [force, moment] = hold(&system);
    let [load, of_load] = load();
    // Its parts go by micrometres, which is 1e-5 of the arm.
    let along = rod * 0.005 + 0.5 * 0.02;
    let centrifugal = Vector3::new(along, arm * (rod + 0.5), 0.0) * (turn * turn);
    assert!((force + load + centrifugal).norm() < 1e-4 * centrifugal.norm(), "{force} {centrifugal}");
    let gyroscopic = polar * SPEED * turn;
    let about_z = along * arm * turn * turn;
    let all = moment + of_load;
    assert!((all.y - gyroscopic).abs() < 1e-3 * gyroscopic, "{all} {gyroscopic}");
    assert!((all.z + about_z).abs() < 1e-3 * about_z, "{all} {about_z}");
}

/// A carrier whose turn changes: shaft, bearings and housing give on and store what the frame puts in.
#[test]
fn invariant_energy_closes_in_a_frame_that_turns_faster_and_faster() {
    let first = "gravity = [0, 0, -9.81]\n[frame]\nangular_velocity = [[[0, 0], [0.002, 20]], 3, [[0, 5], [0.001, -5]]]\n\
                 acceleration = [0, { amplitude = 50, frequency = 2000 }, 0]\narm = [0, 0.3, 0.1]";
    for (shaft, housing) in [(RIGID, ""), (BEAMS, CASE)] {
        let mut system = system(&pair(first, shaft, housing));
        let before = stored(&system);
        let input = |system: &System| system.outputs().shafts[0].energies.worked;
        for row in 1..=10 {
            system.advance(2e-4 * f64::from(row)).unwrap();
        }
        let [of_shaft, of_bearings] = imbalance(&system, &before);
        assert!(of_shaft < 1e-5 && of_bearings < 1e-2, "{of_shaft} {of_bearings}");
        assert!(input(&system) > 1e-4, "the frame did nothing");
        for housing in &system.outputs().housings {
            let left = housing.energies.unaccounted().abs();
            assert!(left < 1e-3 * housing.energies.turned_over().max(1e-9), "{left}");
        }
    }
}

/// The same bearing by the program for one: its inner race has the mass and the inertia of the shaft.
#[test]
fn independent_code_a_shaft_on_one_bearing_moves_in_a_carrier_as_a_race_under_a_wrench() {
    let folder = std::path::Path::new(roulement_tests::ROOT).join("scenes");
    let text = std::fs::read_to_string(folder.join("thrust.toml")).unwrap();
    let frame = "{ angular_velocity = [15, [[0, 0], [0.001, 8]], 12], acceleration = [3, 0, -40], arm = [0.02, 0.3, 0.1] }";
    let changes = [
        ("solver", "{ max_step = \"4 us\", initial_step = \"4 us\", tolerance = 1e-2 }"),
        ("inner.mass", "0.4"),
        ("inner.inertia", "[2e-4, 1.5e-4, 1.5e-4]"),
        ("load.inner_speed", "600.0"),
        ("load.x.force", "1500.0"),
        ("load.y.force", "100.0"),
        ("effects.frame", frame),
    ];
    let mut alone = Simulation::new(&Scene::edited(&text, changes).unwrap()).unwrap();
    // The bearing lies beside the origin of the machine: its arm is the same.
    let frame = frame.replace("arm = [0.02,", "arm = [-0.01,");
    let of_system = format!(
        "frame = {frame}\n[shaft]\nspeed = 600\nmass = 0.4\ncentre = 0.03\npolar_inertia = 2e-4\ntransverse_inertia = 1.5e-4\n\
         [[shaft.load]]\nname = \"all\"\nposition = 0.03\nforce = [1500.0, 100.0, 0]\n\
         [[bearing]]\nname = \"one\"\nscene = \"thrust.toml\"\nmounting = {{ position = 0.03 }}\n\
         [solver]\nmax_step = \"4 us\"\ninitial_step = \"4 us\"\ntolerance = 1e-2\n[load]\nduration = 0.002\noutput_interval = 0.0001\n"
    );
    let mut system = system(&of_system);
    let start = system.outputs().seats[0].displacement;
    for row in 0..=20 {
        let time = 1e-4 * f64::from(row);
        if row > 0 {
            alone.advance_scripted(time).unwrap();
            system.advance(time).unwrap();
        }
        let (one, other) = (alone.outputs(), system.bearings().next().unwrap().1.outputs());
        let apart = (one.inner.pose.position - other.inner.pose.position).norm();
        assert!(apart < 1e-9, "{time}: {apart} m");
        let force = (one.inner.wrench.force - other.inner.wrench.force).norm();
        assert!(force < 1e-4 * one.inner.wrench.force.norm(), "{time}: {force} N");
        let torque = one.inner.drive_torque - system.outputs().shafts[0].torque;
        assert!(torque.abs() < 2e-3 * 1500.0 * 0.023, "{time}: {torque} N m");
    }
    assert!((system.outputs().seats[0].displacement - start).norm() > 1e-6);
}

/// Inputs of a package: one frame, of the machine, that its bearings have in their own axes.
#[test]
fn identity_a_frame_that_is_set_acts_as_one_by_the_script() {
    let [rests, moves] = ["[0, 0, 0]", "[5, -30, 60]"]
        .map(|a| pair(&format!("[frame]\nangular_velocity = [0, 10, 0]\nacceleration = {a}"), RIGID, ""));
    let scripted = system(&moves);
    let mut machine = Machine::Shaft(Box::new(system(&rests)));
    let table = MachineVariables::new(&machine);
    let names: Vec<_> = table.rows().iter().filter(|row| row.causality == Causality::Input).collect();
    assert!(names.iter().any(|row| row.name == "frame.gravity.z"));
    assert!(
        !table
            .rows()
            .iter()
            .any(|row| row.name.starts_with("left.frame") || row.name.contains("effects.frame"))
    );
    let mut values = table.values(&machine);
    for (axis, value) in [("x", 5.0), ("y", -30.0), ("z", 60.0)] {
        let name = format!("frame.acceleration.{axis}");
        values[table.rows().iter().position(|row| row.name == name).unwrap()] = value;
    }
    let inputs = table.inputs(&values, &table.rates(&machine), &machine).unwrap();
    assert!(machine.set_inputs(inputs));
    machine.initialise().unwrap();
    let Machine::Shaft(set) = &machine else { panic!("it is a shaft") };
    for (one, other) in forces(set).iter().zip(forces(&scripted)) {
        assert!((one - other).norm() < 1e-9 * other.norm(), "{one} {other}");
    }
}

#[test]
fn what_a_bearing_on_a_shaft_has_not_of_its_own_says_so() {
    let own =
        pair("", RIGID, "").replacen("effects = {", "effects = { frame = { acceleration = [1, 0, 0] },", 1);
    let large = pair("[frame]\nacceleration = [1e7, 0, 0]", RIGID, "");
    let of_shaft =
        pair("", RIGID, "").replacen("[bearing.set]", "[bearing.set]\nload = { x = { force = 3 } }", 1);
    for (text, parts) in [
        (of_shaft, ["bearing.set.load.x", "[[shaft.load]]"]),
        (own, ["effects.frame", "[frame]"]),
        (large, ["frame.acceleration.x", "1000000"]),
    ] {
        let why = SystemScene::edited(&text).unwrap_err().to_string();
        assert!(parts.iter().all(|part| why.contains(part)), "{why}");
    }
}

/// A machine whose outer rings turn, and the same one seen from these: what swings forwards or backwards is slower or faster by the turn
/// of the frame, what goes along the axis is as fast, and all decays alike. Nothing else differs, balls and cages included.
#[test]
fn identity_seen_from_a_frame_that_turns_motions_are_slower_or_faster_by_its_turn() {
    let (speed, turn) = (3000.0, 90.0);
    let machine = |first: &str, speed: f64, outer: f64| {
        let text = pair(first, RIGID, "").replace("speed = 300", &format!("speed = {speed}"));
        let text = text.replace("force = [100, -475.0, 260.5]", "force = [100, 0, 0]");
        let text =
            text.replacen("[bearing.set]", &format!("[bearing.set]\nload = {{ outer_speed = {outer} }}"), 1);
        let (left, right) = text.split_once("name = \"right\"").unwrap();
        let right = right.replacen(
            "[bearing.set]",
            &format!("[bearing.set]\nload = {{ outer_speed = {} }}", -outer),
            1,
        );
        system(&format!("{left}name = \"right\"{right}"))
    };
    let mut still = machine("", speed, turn);
    let mut seen = machine(&format!("[frame]\nangular_velocity = [{turn}, 0, 0]"), speed - turn, 0.0);
    let shift = turn / TAU;
    let by_whirl = |whirl: &str| match whirl {
        "forward" => -shift,
        "backward" => shift,
        _ => 0.0,
    };
    let found = seen.modes().unwrap().unwrap();
    let modes = still.modes().unwrap().unwrap();
    assert_eq!([modes.len(), found.len()], [5; 2]);
    for mode in &modes {
        let expected = mode.frequency + by_whirl(mode.whirl.name());
        let apart = found.iter().map(|own| (own.frequency - expected).abs()).fold(f64::INFINITY, f64::min);
        assert!(apart < 1e-5 * expected, "{mode:?} {found:?}");
    }
    for system in [&mut still, &mut seen] {
        system.advance(1e-3).unwrap();
    }
    let found = seen.motions().unwrap();
    let motions = still.motions().unwrap();
    assert!(motions.len() >= 4, "{motions:?}");
    for motion in &motions {
        let whirl = motion.shape.rsplit(", ").next().unwrap();
        let expected = motion.frequency + by_whirl(whirl);
        let away = |own: &&Motion| (own.frequency - expected).abs();
        let nearest = found.iter().min_by(|a, b| away(a).total_cmp(&away(b))).unwrap();
        assert!(away(&nearest) < 1e-3 * expected, "{motion:?} {nearest:?}");
        assert!(
            (nearest.growth - motion.growth).abs() < 0.02 * motion.growth.abs() + 1.0,
            "{motion:?} {nearest:?}"
        );
    }
}
