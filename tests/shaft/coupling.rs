//! Couplings between two shafts, and stiffnesses by tables.

use std::f64::consts::TAU;

use nalgebra::Vector6;
use roulement::interface::variables::{Causality, MachineVariables};
use roulement::model::link::force_table::ForceTable;
use roulement::model::link::spring_bearing::{AxialSupport, Spring, SpringBearing};
use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::common::{imbalance, stored, system};

/// [kg m2] inertias of both shafts.
const INERTIAS: [f64; 2] = [1e-3, 3e-3];

/// Two rigid shafts behind each other, each on two 6205, and a coupling between them: keys of both, and its springs.
fn drive(keys: [&str; 2], springs: &str) -> String {
    let shaft = |index: usize, name: &str, origin: &str| {
        let bearing = |side: &str, at: &str, way: &str| {
            format!(
                "[[bearing]]\nname = \"{name}-{side}\"\nshaft = \"{name}\"\ncatalogue = \"6205\"\n\
                 mounting = {{ position = \"{at}\", direction = \"{way}\", preload = {{ force = \"200 N\" }} }}\n\
                 [bearing.set]\neffects = {{ creep = \"saturated\", heathcote_slip = false }}\n"
            )
        };
        format!(
            "[[shaft]]\nname = \"{name}\"\norigin = [\"{origin}\", 0, 0]\nmass = 2\npolar_inertia = {}\ntransverse_inertia = 3e-3\n{}\n",
            INERTIAS[index], keys[index]
        ) + &bearing("left", "-40 mm", "+x")
            + &bearing("right", "40 mm", "-x")
    };
    shaft(0, "motor", "0 mm")
        + &shaft(1, "machine", "150 mm")
        + &format!(
            "[[coupling]]\nname = \"disc\"\nshafts = [\"motor\", \"machine\"]\nposition = \"75 mm\"\nstiffness = {{ {springs} }}\n\
             [load]\nduration = \"5 ms\"\noutput_interval = \"100 us\"\n"
        )
}

const SPRINGS: &str = "radial = 1e6, axial = 2e6, tilt = 300, torsion = 5e3, radial_damping = 20, axial_damping = 20, \
                       tilt_damping = 0.01, torsion_damping = 0.05";

/// Moment and force of the coupling on the first shaft.
fn force(system: &System) -> Vector6<f64> {
    system.outputs().links[0].state.force
}

#[test]
fn closed_form_a_coupling_carries_the_torque_and_twists_by_it() {
    let system = system(&drive(["speed = 100", "torque = -20"], SPRINGS));
    let on_motor = force(&system)[3];
    assert!((on_motor + 20.0).abs() < 1e-6, "{on_motor}");
    let twist = system.outputs().links[0].state.displacement[3];
    assert!((twist - 20.0 / 5e3).abs() < 1e-9, "{twist}");
    let outputs = system.outputs();
    assert!((outputs.shafts[1].spin.speed - 100.0).abs() < 1e-12, "{:?}", outputs.shafts[1].spin);
    assert!((outputs.shafts[0].torque - 20.0).abs() < 0.1, "{}", outputs.shafts[0].torque);
}

#[test]
fn closed_form_two_inertias_swing_against_each_other_through_a_coupling() {
    let system = system(&drive(["torque = 0\nstart_speed = 100", "torque = 0"], "torsion = 5e3"));
    let expected = (5e3 * INERTIAS.map(|inertia| 1.0 / inertia).iter().sum::<f64>()).sqrt() / TAU;
    let modes = system.modes().unwrap().unwrap();
    let nearest =
        modes.iter().map(|mode| (mode.frequency / expected - 1.0).abs()).fold(f64::INFINITY, f64::min);
    // Friction of the bearings damps it.
    assert!(nearest < 1e-4, "{nearest:e}, expected {expected} Hz");
}

#[test]
fn closed_form_a_coupling_is_loaded_by_how_far_its_shafts_lie_apart() {
    // The motor's bearings lie 0.1 mm lower: springs far softer than bearings are strained by all of it.
    let text = drive(["speed = 100", "torque = -20"], "radial = 1e4, torsion = 5e3");
    let lower = |text: String, at: &str| {
        let seat = format!("mounting = {{ position = \"{at}\", ");
        assert!(text.contains(&seat));
        text.replacen(&seat, &format!("{seat}offset = {{ z = \"-100 um\" }}, "), 1)
    };
    let text = lower(lower(text, "-40 mm"), "40 mm");
    let on_motor = force(&system(&text));
    assert!((on_motor[2] - 1.0).abs() < 0.02 && on_motor[1].abs() < 0.02, "{on_motor}");
}

#[test]
fn invariant_a_coupling_that_swings_keeps_its_energy() {
    let text = drive(["torque = 5\nstart_speed = 100", "torque = 0"], SPRINGS);
    let mut system = system(&text);
    let before = stored(&system);
    system.advance(3e-3).unwrap();
    let outputs = system.outputs();
    let turned_over: f64 = outputs.shafts.iter().map(|shaft| shaft.energies.worked).sum();
    let link = &outputs.links[0].state;
    assert!(link.damped > 0.0 && link.unaccounted().abs() < 1e-4 * turned_over, "{link:?}");
    for shaft in &outputs.shafts {
        assert!(shaft.energies.unaccounted().abs() < 1e-4 * turned_over, "{:?}", shaft.energies);
    }
    let [_, of_bearings] = imbalance(&system, &before);
    assert!(of_bearings < 1e-3, "{of_bearings:e}");
    // Both speed up together, by the torque over both inertias, less the friction of the bearings and what their balls take.
    let gained: f64 =
        outputs.shafts.iter().zip(INERTIAS).map(|(own, inertia)| (own.spin.speed - 100.0) * inertia).sum();
    assert!((0.9..1.001).contains(&(gained / (5.0 * 3e-3))), "{gained}");
}

/// Tangents of springs by tables are differences of their forces, and these of their energy.
#[test]
fn tangents_of_springs_by_tables_are_differences_of_their_forces_and_forces_those_of_a_potential() {
    let table = |points: &[[f64; 2]]| Spring::Table(ForceTable::through(points).unwrap());
    let springs = SpringBearing {
        stiffness: [
            table(&[[0.0, 0.0], [2e-6, 0.0], [5e-6, 200.0], [1e-5, 2000.0]]),
            table(&[[-1e-5, -300.0], [0.0, 0.0], [1e-5, 0.0]]),
            table(&[[0.0, 0.0], [1e-5, 0.2], [2e-5, 1.0]]),
        ],
        damping: [200.0, 100.0, 0.2],
        torsion: Some((table(&[[-1e-5, -2.0], [0.0, 0.0], [1e-5, 1.0]]), 0.1)),
        gap: 0.0,
        axial: AxialSupport::Both,
        rest: Vector6::new(0.0, 1e-6, -1e-6, 0.0, 1e-6, 0.0),
    };
    let directions = Vector6::new(-0.3, 0.8, 0.5, 0.6, -0.7, 0.4);
    let rate = Vector6::new(0.01, -0.02, 0.005, 0.3, 0.4, -0.1);
    for scale in [-9e-6, -3.04e-6, 4e-6, 7.05e-6, 2e-5] {
        let place = directions * scale;
        let own = springs.force(&place, &rate);
        for axis in 0..6 {
            let at = |step: f64| springs.force(&(place + Vector6::ith(axis, step)), &rate);
            let step = 1e-10;
            let [there, back] = [at(step), at(-step)];
            let difference = (there.force - back.force) / (2.0 * step);
            let error = (difference - own.by_displacement.column(axis)).amax();
            assert!(error < 1e-4 * own.by_displacement.amax(), "{scale} {axis}: {error}");
            let still = springs.force(&place, &Vector6::zeros());
            let fall = -(there.stored - back.stored) / (2.0 * step);
            assert!((fall - still.force[axis]).abs() < 1e-5 * still.force.amax().max(1.0), "{scale} {axis}");
        }
        assert!(own.damped > 0.0 && (own.by_rate + own.by_rate.transpose()).amax() > 0.0);
    }
}

#[test]
fn closed_form_a_bearing_by_a_table_of_a_line_is_one_by_its_stiffness_and_a_harder_one_gives_less() {
    let with = |radial: &str| {
        let text = drive(["speed = 100", "torque = -20"], SPRINGS)
            + &format!(
                "[[bearing]]\nname = \"third\"\nshaft = \"machine\"\nstiffness = {{ radial = {radial} }}\nmounting = {{ position = \"90 mm\" }}\n"
            );
        let text = text.replacen(
            "torque = -20",
            "torque = -20\n[[shaft.load]]\nname = \"pull\"\nposition = \"90 mm\"\nforce = [0, 0, -500]",
            1,
        );
        let system = system(&text);
        let index = system.scene().link_names().position(|name| name == "third").unwrap();
        system.outputs().links[index].state.clone()
    };
    let [number, line] = [with("5e7"), with("[[0, 0], [\"20 um\", \"1 kN\"]]")];
    assert!(
        (number.force - line.force).norm() < 1e-6 * number.force.norm(),
        "{} {}",
        number.force,
        line.force
    );
    assert!((number.stored / line.stored - 1.0).abs() < 1e-6);
    let hard = with("[[0, 0], [\"1 um\", 0], [\"3 um\", \"100 N\"], [\"6 um\", \"600 N\"]]");
    let table = ForceTable::through(&[[0.0, 0.0], [1e-6, 0.0], [3e-6, 100.0], [6e-6, 600.0]]).unwrap();
    let way = hard.displacement[1].hypot(hard.displacement[2]);
    assert!((table.at(way).force / hard.force[1].hypot(hard.force[2]) - 1.0).abs() < 1e-9, "{way}");
}

#[test]
fn what_a_coupling_or_a_table_cannot_have_is_refused() {
    let text = drive(["speed = 100", "torque = -20"], SPRINGS);
    for (from, to, parts) in [
        (
            "\"motor\", \"machine\"]",
            "\"motor\", \"mill\"]",
            &["coupling \"disc\"", "there are: motor, machine"][..],
        ),
        ("\"motor\", \"machine\"]", "\"motor\", \"motor\"]", &["joins two"]),
        ("[\"150 mm\", 0, 0]", "[\"150 mm\", 0.01, 0]", &["on one axis"]),
        ("torque = -20", "speed = 90", &["shaft \"machine\": the speed", "follows from that of \"motor\""]),
        ("torsion = 5e3", "torsion = -5", &["coupling.stiffness.torsion", "-5"]),
        ("tilt = 300", "tilt = 300, gap = 1e-5", &["play of a coupling is a table"]),
        (
            "radial = 1e6",
            "radial = [[0, 0], [1e-5, 100], [2e-5, 90]]",
            &["after [0.00001, 100] comes [0.00002, 90]"],
        ),
        (
            "radial = 1e6",
            "radial = [[0, 5], [1e-5, 100]]",
            &["coupling.stiffness.radial", "begins at [0, 0]"],
        ),
        ("axial = 2e6", "axial = [[1e-5, 5], [2e-5, 100]]", &["begins below 0"]),
        ("axial = 2e6", "axial = [[0, 0]]", &["two or more"]),
        ("axial = 2e6", "axial = \"5 mm\"", &["axial"]),
    ] {
        assert!(text.contains(from), "{from}");
        let why = SystemScene::edited(&text.replacen(from, to, 1)).unwrap_err().to_string();
        for part in parts {
            assert!(why.contains(part), "{why}\nshould have {part}");
        }
    }
    let by_stiffness = |keys: &str| {
        text.clone()
            + &format!(
                "[[bearing]]\nname = \"third\"\nshaft = \"motor\"\nstiffness = {{ {keys} }}\nmounting = {{ position = 0 }}\n"
            )
    };
    for (keys, part) in [
        ("axial = 1e6", "bearing.stiffness.radial"),
        ("radial = 1e6, torsion = 5", "[[coupling]]"),
        ("radial = [[0, 0], [1e-5, 50]], gap = 1e-6", "first points have the play"),
        ("radial = 1e6, axial = [[0, 0], [1e-5, 50]], axial_way = \"+x\"", "points on both sides"),
    ] {
        let why = SystemScene::edited(&by_stiffness(keys)).unwrap_err().to_string();
        assert!(why.contains(part), "{why}");
    }
}

#[test]
fn a_coupling_has_its_forces_moments_and_twist_as_outputs() {
    let system = system(&drive(["speed = 100", "torque = -20"], SPRINGS));
    let variables = MachineVariables::new(&system);
    for name in ["disc.force.x", "disc.moment.x", "disc.moment.z", "disc.twist", "disc.energy.dissipated"] {
        let found = variables.rows().iter().find(|row| row.name == name);
        assert!(found.is_some_and(|row| row.causality == Causality::Output), "{name}");
    }
}
