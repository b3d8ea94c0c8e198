//! An outer race under a wrench on a machine: a ring that is loaded while its shaft runs, as in a test rig.

use nalgebra::{Matrix2, Matrix6, Vector3};
use roulement::Simulation;
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::{MachineEquilibrium, System, Whirl};

use crate::common::{assert_order_two, forces, imbalance, run, scene, stored, system};

/// [kg] mass of the loaded ring.
const MASS: f64 = 0.4;
/// \[N] load on it.
const LOAD: [f64; 3] = [200.0, 150.0, -3000.0];

/// A shaft on two 6205 that hold each other, and between them a 6206 whose outer ring is under a wrench: keys of `[bearing.set]`, and where its
/// axis points.
fn rig(load: &str, direction: &str) -> String {
    format!(
        r#"
[shaft]
speed = "3000 rpm"
mass = 1.5
polar_inertia = 5e-4
transverse_inertia = 4e-3
[[bearing]]
name = "left"
catalogue = "6205"
mounting = {{ position = -0.06, preload = {{ force = 300 }} }}
[[bearing]]
name = "right"
catalogue = "6205"
mounting = {{ position = 0.06, direction = "-x", preload = {{ force = 300 }} }}
[[bearing]]
name = "tested"
catalogue = "6206"
mounting = {{ position = 0.02, direction = "{direction}" }}
[bearing.set]
outer = {{ drive = "wrench", mass = {MASS}, inertia = [2e-4, 1.2e-4, 1.2e-4] }}
load = {{ {load} }}
[load]
duration = 0.01
output_interval = 1e-4
"#
    )
}

/// The load in the axes of a bearing.
fn constant(direction: &str) -> String {
    let sign = if direction == "+x" { 1.0 } else { -1.0 };
    let [x, y, z] = LOAD;
    format!(
        "outer = {{ x = {{ force = {} }}, y = {{ force = {} }}, z = {{ force = {z} }} }}",
        sign * x,
        sign * y
    )
}

fn found(text: &str) -> MachineEquilibrium {
    MachineEquilibrium::of(&scene(text), 0.0, 400.0).unwrap_or_else(|why| panic!("{why}"))
}

/// The shaft carries what the ring is loaded with, and both other bearings by their levers.
#[test]
fn closed_form_the_load_of_a_ring_is_that_of_the_shaft() {
    for direction in ["+x", "-x"] {
        let text = rig(&constant(direction), direction);
        let rest = found(&text);
        let [left, right, tested] = [0, 1, 2].map(|index| rest.bearings[index].force);
        let load = Vector3::from(LOAD);
        assert!((left + right + tested).norm() < 1e-6 * load.norm(), "{direction}: {left} {right} {tested}");
        // What keeps balls at their azimuths in a tilted bearing is not passed on.
        assert!((tested - load).norm() < 1e-3 * load.norm(), "{direction}: {tested}");
        // Moments about the left bearing, those that bearings hold themselves among them.
        let of = |place: f64, index: usize| {
            let bearing = &rest.bearings[index];
            Vector3::new(place, 0.0, 0.0).cross(&bearing.force) + bearing.moment
        };
        let moments = of(0.0, 0) + of(0.12, 1) + of(0.08, 2);
        assert!(moments.yz().norm() < 1e-6 * 0.08 * load.norm(), "{moments}");
        // 80 and 40 of 120 mm, but for the moments that three bearings hold.
        assert!(
            (right.z / 2000.0 - 1.0).abs() < 0.1 && (left.z / 1000.0 - 1.0).abs() < 0.2,
            "{left} {right}"
        );

        // A run stays there: in the mean, as a ring that nothing damps swings on its balls.
        let mut system = system(&text);
        let mut mean = Vector3::zeros();
        for row in 1..=200 {
            system.advance(f64::from(row) * 2e-5).unwrap();
            mean += forces(&system)[2] / 200.0;
        }
        assert!((mean - load).norm() < 5e-3 * load.norm(), "{direction}: {mean}");
    }
}

#[test]
fn closed_form_a_ring_weighs_on_its_shaft() {
    let text = format!("gravity = [0, 0, -9.81]\n{}", rig(&constant("+x"), "+x"));
    let [weighs, without] = [&text, &rig(&constant("+x"), "+x")].map(|text| {
        let found = found(text);
        let balls = &found.bearings[2].outputs.balls;
        (found.bearings[2].force.z, balls.len())
    });
    let system = system(&text);
    let ball = system.bearings().nth(2).unwrap().1.model().bearing.ball.mass;
    let expected = -9.81 * (MASS + ball * weighs.1 as f64);
    // Balls that carry no load hang on one race or the other.
    let off = (weighs.0 - without.0 - expected).abs();
    assert!(off < 9.81 * ball * weighs.1 as f64, "{} {expected}", weighs.0 - without.0);
}

/// The outer ring of a bearing whose shaft is held, by the program for one bearing whose inner race is held.
#[test]
fn independent_code_a_ring_on_a_shaft_that_is_held_moves_as_that_of_a_bearing_alone() {
    let solver = "{ max_step = \"4 us\", initial_step = \"4 us\", tolerance = 1e-2 }";
    let loads = [
        ("load.outer.x.force", "-1500.0"),
        ("load.outer.y.force", "[[0, 100], [\"0.5 ms\", 400], [\"1 ms\", -100]]"),
        ("load.outer.rz.moment", "2.0"),
        ("load.outer_speed", "[[0, -30], [\"1 ms\", -50]]"),
        ("outer.drive", "\"wrench\""),
        ("outer.mass", "0.3"),
        ("outer.inertia", "[2e-4, 1.5e-4, 1.5e-4]"),
    ];
    let folder = std::path::Path::new(roulement_tests::ROOT).join("scenes");
    let text = std::fs::read_to_string(folder.join("thrust.toml")).unwrap();
    let alone = [
        ("inner.drive", "\"fixed\""),
        ("inner.mass", ""),
        ("inner.inertia", ""),
        ("load.x", ""),
        ("load.inner_speed", "600.0"),
        ("solver", solver),
    ];
    let one = Scene::edited(&text, alone.into_iter().chain(loads)).unwrap();
    let mut one = Simulation::new(&one).unwrap();
    let set: String = loads.iter().map(|(key, value)| format!("{key} = {value}\n")).collect();
    let of_system = format!(
        "[shaft]\nspeed = 600\nmass = 0.4\npolar_inertia = 2e-4\ntransverse_inertia = 1.5e-4\n\
         [[shaft.load]]\nname = \"grip\"\nposition = 0.0\ndisplacement = {{ x = 0, y = 0, z = 0 }}\nrotation = {{ ry = 0, rz = 0 }}\n\
         [[bearing]]\nname = \"one\"\nscene = \"thrust.toml\"\nmounting = {{ position = 0.0 }}\n[bearing.set]\n{set}\
         [load]\nduration = \"2 ms\"\noutput_interval = \"100 us\"\n[solver]\nmax_step = \"4 us\"\ninitial_step = \"4 us\"\ntolerance = 1e-2\n"
    );
    let mut other = system(&of_system);
    let start = other.bearings().next().unwrap().1.outputs().outer.pose.position;
    for row in 0..=20 {
        let time = 1e-4 * f64::from(row);
        if row > 0 {
            one.advance_scripted(time).unwrap();
            other.advance(time).unwrap();
        }
        let (one, shaft) = (one.outputs(), other.outputs());
        let of_shaft = other.bearings().next().unwrap().1.outputs();
        let apart = (one.outer.pose.position - of_shaft.outer.pose.position).norm();
        let turned = one.outer.pose.orientation.angle_to(&of_shaft.outer.pose.orientation);
        // The ring goes by some 10 um and tilts by some mrad.
        assert!(apart < 1e-9 * 1e-5 && turned < 1e-9 * 1e-2, "{time}: {apart:e} m {turned:e} rad");
        for (one, other) in
            [(&one.inner.wrench, &of_shaft.inner.wrench), (&one.outer.wrench, &of_shaft.outer.wrench)]
        {
            let off = (one.force - other.force).norm() / one.force.norm();
            let off = off.max((one.moment - other.moment).norm() / one.moment.norm());
            assert!(off < 1e-9, "{time}: {off:e}");
        }
        assert!((one.work - of_shaft.work).abs() < 1e-9 * of_shaft.work.abs().max(1e-3), "{time}");
        // The grip holds the shaft against the bearing.
        let held = Vector3::from_column_slice(&shaft.holding[..3]);
        assert!((held + of_shaft.inner.wrench.force).norm() < 1e-6 * held.norm(), "{held}");
    }
    let moved = other.bearings().next().unwrap().1.outputs().outer.pose.position - start;
    assert!(moved.norm() > 1e-6, "{moved}");
}

/// A ring that is held in every direction is one that is fixed.
#[test]
fn limit_a_ring_that_is_held_in_every_direction_is_fixed() {
    let held = "outer = { x = { displacement = 0 }, y = { displacement = 0 }, z = { displacement = 0 }, ry = { rotation = 0 }, rz = { rotation = 0 } }";
    let pull = "[[shaft.load]]\nname = \"pull\"\nposition = 0.02\nforce = [400, 0, -6000]\n[[bearing]]\nname = \"left\"";
    let text = rig(held, "+x").replacen("[[bearing]]\nname = \"left\"", pull, 1);
    let fixed =
        text.replace("drive = \"wrench\"", "drive = \"fixed\"").replace(&format!("load = {{ {held} }}"), "");
    let [one, other] = [&text, &fixed].map(|text| run(text, 1e-3));
    for (a, b) in forces(&one).iter().zip(forces(&other)) {
        assert!((a - b).norm() < 1e-6 * b.norm(), "{a} {b}");
    }
    // At rest too, where the place of the shaft says what each bearing carries.
    let [one, other] = [&text, &fixed].map(|text| found(text));
    for (a, b) in one.bearings.iter().zip(&other.bearings) {
        assert!((a.force - b.force).norm() < 1e-6 * b.force.norm(), "{} {}", a.force, b.force);
    }
    assert!(one.bearings[2].force.norm() > 500.0);
}

#[test]
fn invariant_energy_of_shaft_and_bearings_balances_under_a_wrench_that_changes() {
    let text = rig(
        "outer = { x = { force = 200 }, z = { force = [[0, -3000], [\"2 ms\", -500], [\"4 ms\", -2000]] }, ry = { moment = [[0, 0], [\"3 ms\", 2]] } }, \
         outer_speed = [[0, 0], [\"5 ms\", 60]]",
        "+x",
    );
    let mut system = system(&text);
    let before = stored(&system);
    system.advance(5e-3).unwrap();
    let [shaft, bearings] = imbalance(&system, &before);
    assert!(shaft < 1e-6 && bearings < 1e-2, "{shaft:.2e} {bearings:.2e}");
    // The wrench does work: the ring goes with it.
    let outputs = system.bearings().nth(2).unwrap().1.outputs();
    assert!(outputs.outer.twist.angular_velocity.x > 50.0);
}

#[test]
fn order_of_convergence_of_a_ring_under_a_load_that_changes_is_two() {
    let text = rig(
        "outer = { x = { force = 200 }, z = { force = [[0, -500], [\"1 ms\", -300], [\"2 ms\", -400]] } }",
        "+x",
    )
    .replace("x = { force = 200 }", "x = { force = 3000 }");
    assert_order_two(&text, 1e-3, 2e-6, |system| {
        system.bearings().nth(2).unwrap().1.outputs().outer.pose.position
    });
}

#[test]
fn invariant_a_snapshot_amid_a_load_that_changes_goes_on_to_the_same_bits() {
    let text = rig("outer = { z = { force = [[0, -3000], [\"1 ms\", -1000]] }, x = { force = 100 } }", "+x");
    let mut one = run(&text, 4e-4);
    let snapshot = one.snapshot();
    let outer = |system: &System| system.bearings().nth(2).unwrap().1.outputs().outer.pose;
    one.advance(8e-4).unwrap();
    let there = (one.outputs().clone(), outer(&one));
    assert!(one.restore(&snapshot));
    one.advance(8e-4).unwrap();
    assert_eq!((one.outputs().clone(), outer(&one)), there);
    let mut other = system(&text);
    assert!(other.restore(&snapshot));
    // Communication points have no part in it.
    other.advance(6e-4).unwrap();
    other.advance(8e-4).unwrap();
    assert_eq!(other.outputs().time, one.outputs().time);
    let apart = (outer(&other).position - outer(&one).position).norm();
    assert!(apart < 1e-9, "{apart}");
}

/// Rows of equilibria follow the wrench.
#[test]
fn identity_rows_of_equilibria_have_the_wrench_of_their_time() {
    let text = rig("outer = { x = { force = 200 }, z = { force = [[0, -3000], [\"2 ms\", -1000]] } }", "+x")
        + "\n[solver]\nlevel = \"equilibrium\"\n";
    let mut system = system(&text);
    for (time, force) in [(1e-3, -2000.0), (2e-3, -1000.0)] {
        system.advance(time).unwrap();
        let on_shaft = forces(&system)[2];
        assert!((on_shaft.z - force).abs() < 2e-3 * force.abs(), "{time}: {on_shaft}");
        let there = System::starting_at(&scene(&text), time).unwrap();
        assert!((forces(&there)[2] - on_shaft).norm() < 1e-6 * force.abs());
    }
}

/// On a shaft that is held, a heavy ring swings as its mass on the stiffness of its bearing: across the axis and in its tilt, and along the axis.
#[test]
fn closed_form_natural_frequencies_of_a_heavy_ring_are_those_of_its_mass_on_its_bearing() {
    let (mass, inertia) = (20.0, 0.02);
    let text = format!(
        "[shaft]\nspeed = 0\nmass = 0.4\npolar_inertia = 2e-4\ntransverse_inertia = 1.5e-4\n\
         [[shaft.load]]\nname = \"grip\"\nposition = 0.0\ndisplacement = {{ x = 0, y = 0, z = 0 }}\nrotation = {{ ry = 0, rz = 0 }}\n\
         [[bearing]]\nname = \"one\"\nscene = \"thrust.toml\"\nmounting = {{ position = 0.0 }}\n[bearing.set]\n\
         outer = {{ drive = \"wrench\", mass = {mass}, inertia = [{inertia}, {inertia}, {inertia}] }}\n\
         load.outer.x.force = -1500\n[load]\nduration = \"2 ms\"\noutput_interval = \"100 us\"\n"
    );
    let found = found(&text);
    let k: &Matrix6<f64> = &found.bearings[0].stiffness;
    let root = |value: f64| value.sqrt() / std::f64::consts::TAU;
    // The thrust is symmetric about the axis: y goes with the tilt about z, z with that about y.
    let pair = |i: usize, j: usize| {
        let over = Matrix2::new(k[(i, i)] / mass, k[(i, j)] / mass, k[(j, i)] / inertia, k[(j, j)] / inertia);
        let (half, det) = (0.5 * over.trace(), over.determinant());
        let apart = (half * half - det).sqrt();
        [root(half - apart), root(half + apart)]
    };
    let mut expected = vec![root(k[(0, 0)] / mass)];
    expected.extend(pair(1, 5));
    expected.extend(pair(2, 4));
    expected.sort_by(f64::total_cmp);
    let swung: Vec<f64> = found.modes.iter().map(|mode| mode.frequency).collect();
    assert_eq!(swung.len(), expected.len(), "{swung:?} {expected:?}");
    for (ours, by_hand) in swung.iter().zip(&expected) {
        assert!((ours / by_hand - 1.0).abs() < 2e-3, "{swung:?} {expected:?}");
    }
    assert!(found.modes.iter().all(|mode| mode.place == "the outer ring of one"), "{:?}", found.modes);
    // One goes along the axis, the others across it.
    let axial = found.modes.iter().filter(|mode| mode.whirl == Whirl::Axial);
    let axial: Vec<f64> = axial.map(|mode| mode.frequency).collect();
    assert!(axial.len() == 1 && (axial[0] / root(k[(0, 0)] / mass) - 1.0).abs() < 1e-3, "{:?}", found.modes);
}

/// Balls condensed out, against the eigenvalues that keep every ball.
#[test]
fn independent_code_natural_frequencies_with_a_ring_are_those_of_all_balls() {
    let text = rig(&constant("+x"), "+x");
    let motions = system(&text).motions().unwrap();
    // Below, balls that were just started and creep swing along.
    let modes = found(&text).modes;
    let fast: Vec<_> = modes.iter().filter(|mode| mode.frequency > 2500.0).collect();
    assert!(fast.len() >= 4, "{modes:?}");
    for mode in fast {
        let near = |frequency: f64| (frequency / mode.frequency - 1.0).abs() < 0.01;
        assert!(motions.iter().any(|motion| near(motion.frequency)), "{mode:?} {motions:?}");
    }
    assert!(modes.iter().any(|mode| mode.place == "the outer ring of tested"), "{modes:?}");
}

/// A shaft and a ring that hold each other on a bearing swing against each other, as two masses on a spring do.
#[test]
fn closed_form_a_ring_and_a_shaft_swing_against_each_other() {
    // Along the axis the shaft is on a soft spring, far below.
    let (ring, shaft) = (0.8, 0.5);
    let text = format!(
        "[shaft]\nspeed = 1\nmass = {shaft}\npolar_inertia = 2e-4\ntransverse_inertia = 1.5e-4\n\
         [[bearing]]\nname = \"spring\"\nstiffness = {{ radial = 1e9, axial = 1e4, tilt = 1e7 }}\nmounting = {{ position = 0.0 }}\n\
         [[bearing]]\nname = \"one\"\nscene = \"thrust.toml\"\nmounting = {{ position = 0.0 }}\n[bearing.set]\n\
         outer = {{ drive = \"wrench\", mass = {ring}, inertia = [1e-3, 1e-3, 1e-3] }}\n\
         load.outer.x.force = -100\n[load]\nduration = \"2 ms\"\noutput_interval = \"100 us\"\n"
    );
    let found = found(&text);
    let k = found.bearings[0].stiffness[(0, 0)];
    let expected =
        (k * (1.0 / ring + 1.0 / shaft) + 1e4 / shaft * ring / (ring + shaft)).sqrt() / std::f64::consts::TAU;
    let near = found
        .modes
        .iter()
        .map(|mode| mode.frequency / expected - 1.0)
        .min_by(|a, b| a.abs().total_cmp(&b.abs()));
    assert!(near.unwrap().abs() < 5e-3, "{expected} {:?}", found.modes);
}

#[test]
fn what_a_ring_under_a_wrench_cannot_have_is_refused() {
    let text = rig(&constant("+x"), "+x");
    let held = "mounting = { position = -0.06, preload = { force = 300 } }";
    for (from, to, parts) in [
        (
            "direction = \"+x\" }\n[bearing.set]",
            "preload = { force = 100 } }\n[bearing.set]",
            ["bearing \"tested\": bearing.mounting.preload", "load.outer.x.force"],
        ),
        (
            "direction = \"+x\" }\n[bearing.set]",
            "axial = \"free\" }\n[bearing.set]",
            ["outer.drive", "mounting.axial"],
        ),
        (
            "direction = \"+x\" }\n[bearing.set]",
            "housing = \"case\" }\n[bearing.set]",
            ["mounting.housing = \"case\"", "no such [[housing]]"],
        ),
        ("drive = \"wrench\"", "drive = \"fixed\"", ["bearing.set.load.outer", "load.outer"]),
        ("x = { force = 200 }", "x = { force = 200, displacement = 0 }", ["load.outer.x", "at most one"]),
        ("load = { outer", "load = { x = { force = 3 }, outer", ["bearing.set.load.x", "those of the shaft"]),
        ("mass = 0.4, ", "", ["outer", "give its mass"]),
        (held, "mounting = { position = -0.06, axial = \"free\" }", ["", ""]),
    ] {
        assert!(text.contains(from), "{from}");
        let read = SystemScene::edited(&text.replacen(from, to, 1));
        if parts[0].is_empty() {
            read.unwrap();
            continue;
        }
        let why = read.unwrap_err().to_string();
        assert!(parts.iter().all(|part| why.contains(part)), "{why}\nshould name {parts:?}");
    }
    // Both others slide: the ring goes along, or holds the shaft where it is held itself.
    let slides = text.replace("preload = { force = 300 }", "axial = \"free\"");
    let why = SystemScene::edited(&slides).unwrap_err().to_string();
    for part in ["bearing \"tested\": outer.drive", "along its axis", "load.outer.x.displacement"] {
        assert!(why.contains(part), "{why}");
    }
    let held = slides.replace("x = { force = 200 }", "x = { displacement = 0 }");
    let found = found(&held);
    let [left, right, tested] = [0, 1, 2].map(|index| found.bearings[index].force);
    assert!(left.x.abs() + right.x.abs() < 1e-3 && tested.x.abs() < 1e-3, "{left} {right} {tested}");
    // Keys of a bearing alone at the top say where they stand on a machine.
    let why = SystemScene::edited(
        &text.replace("duration = 0.01", "duration = 0.01\nouter = { x = { force = 3 } }"),
    )
    .unwrap_err();
    assert!(why.to_string().contains("[bearing.set] load.outer"), "{why}");
}
