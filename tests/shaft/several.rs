//! Several shafts in one file: each does what it does alone, and what they share is shared.

use roulement::interface::variables::MachineVariables;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::common::{GEARBOX, ROTOR, forces, scene, system};

/// The rotor of the tests, as one of two shafts that turn at other speeds: the second one is placed elsewhere and loaded more.
fn two() -> String {
    let (shaft, rest) = ROTOR.split_once("[[bearing]]").unwrap();
    let (bearings, load) = rest.split_once("[load]").unwrap();
    let one = |name: &str, origin: &str| {
        let shaft = shaft.replace("[shaft]", &format!("[[shaft]]\nname = \"{name}\"\norigin = {origin}"));
        let bearings = format!("[[bearing]]{bearings}")
            .replace("[[bearing]]", &format!("[[bearing]]\nshaft = \"{name}\""));
        [shaft, bearings]
    };
    let second = one("low", "[\"30 mm\", \"80 mm\", \"-60 mm\"]");
    let second = second.map(|text| {
        text.replace("\"left\"", "\"fore\"").replace("\"right\"", "\"aft\"").replace("\"pull\"", "\"tug\"")
    });
    let second = second.map(|text| text.replace("600 rpm", "200 rpm").replace("100 N", "150 N"));
    [one("high", "[0, 0, 0]").concat(), second.concat(), format!("[load]{load}")].concat()
}

/// The second of them alone.
fn alone() -> String {
    ROTOR.replace("600 rpm", "200 rpm").replace("100 N", "150 N")
}

#[test]
fn invariant_shafts_that_share_nothing_start_and_run_as_they_do_alone() {
    let all = [ROTOR.to_string(), alone(), two()];
    let mut all = all.map(|text| system(&text));
    let compare = |[one, other, both]: &[System; 3], allowed: f64| {
        let apart = |alone: &System, from: usize| {
            let pairs =
                forces(alone).into_iter().zip(forces(both).into_iter().skip(from)).collect::<Vec<_>>();
            let largest = pairs.iter().map(|(force, _)| force.norm()).fold(0.0, f64::max);
            pairs.iter().map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
        };
        for (alone, from) in [(one, 0), (other, 2)] {
            let apart = apart(alone, from);
            assert!(apart < allowed, "{apart:e}");
        }
    };
    // The tolerance of the statics, over that of a force.
    compare(&all, 1e-8);
    for system in &mut all {
        system.advance(2e-3).unwrap();
    }
    // They take other steps than alone: what is apart are errors of steps.
    compare(&all, 1e-3);
    let speeds: Vec<f64> = all[2].outputs().shafts.iter().map(|shaft| shaft.spin.speed).collect();
    let rpm = std::f64::consts::TAU / 60.0;
    assert!((speeds[0] - 600.0 * rpm).abs() < 1e-12 && (speeds[1] - 200.0 * rpm).abs() < 1e-12, "{speeds:?}");
}

#[test]
fn variables_begin_with_the_name_of_their_shaft_and_stay_as_they_were_of_one() {
    let names = |text: &str| -> Vec<String> {
        MachineVariables::new(&system(text)).rows().iter().map(|row| row.name.clone()).collect()
    };
    let (one, two) = (names(ROTOR), names(&two()));
    for name in [
        "shaft.speed",
        "shaft.torque",
        "shaft.angle",
        "pull.force.y",
        "shaft.disc[1].mass",
        "shaft.energy.work",
    ] {
        assert!(one.iter().any(|own| own == name), "{name}");
    }
    for name in
        ["high.speed", "low.speed", "low.torque", "tug.force.y", "low.disc[1].mass", "high.energy.work"]
    {
        assert!(two.iter().any(|own| own == name), "{name}");
    }
    assert!(!two.iter().any(|name| name.starts_with("shaft.")));
}

#[test]
fn closed_form_a_housing_that_two_shafts_share_carries_both_where_they_lie() {
    // Two pinion shafts side by side in one rigid case on soft springs: it sinks and turns by the loads of both at their places.
    let (head, bearings) = GEARBOX.split_once("[[bearing]]").unwrap();
    let (bearings, load) = bearings.split_once("[load]").unwrap();
    let (top, shaft) = head.split_once("[shaft]").unwrap();
    let place = |name: &str, origin: &str| {
        let shaft = format!("[[shaft]]\nname = \"{name}\"\norigin = {origin}{shaft}")
            .replace("\"mesh\"", &format!("\"mesh-{name}\""));
        let bearings = format!("[[bearing]]{bearings}")
            .replace("[[bearing]]", &format!("[[bearing]]\nshaft = \"{name}\""))
            .replace("\"left\"", &format!("\"left-{name}\""))
            .replace("\"right\"", &format!("\"right-{name}\""))
            .replace("direction =", "housing = \"case\", direction =");
        shaft + &bearings
    };
    let case = "[[housing]]\nname = \"case\"\nmass = \"12 kg\"\ninertia = [0.06, 0.08, 0.08]\n\
                stiffness = [1e8, 1e8, 1e8, 1e6, 1e6, 1e6]\n[[housing.point]]\nname = \"middle\"\nposition = [0, 0, 0]\n";
    let text =
        [top, &place("a", "[0, 0.1, 0]"), &place("b", "[0, -0.2, 0.05]"), case, "[load]", load].concat();
    let system = system(&text);
    let middle = system.outputs().housings[0].points[0];
    // What acts on the case: the weight of all, and the loads of both meshes with their levers.
    let of = scene(&text);
    let mut force = nalgebra::Vector3::zeros();
    let mut moment = nalgebra::Vector3::zeros();
    for shaft in &of.shafts {
        let place = nalgebra::Vector3::from(shaft.place(0.0));
        let mesh = &shaft.load[0];
        let at = nalgebra::Vector3::from(shaft.place(mesh.position.0));
        let pull = mesh.force.at(0.0);
        // The drive holds the moment about the axis of a shaft: what is left of the force's own lever is that of the axis.
        let about = mesh.moment.at(0.0);
        moment += at.cross(&pull) + nalgebra::Vector3::new(0.0, about.y, about.z);
        let weight = of.gravity.at(0.0) * shaft.mass.unwrap().0;
        moment += place.cross(&weight);
        force += pull + weight;
    }
    let held = middle.displacement * 1e8 - of.gravity.at(0.0) * 12.0;
    let balls = of.bearings.len() as f64
        * system.bearings().next().unwrap().1.model().bearing.ball.mass
        * system.bearings().next().unwrap().1.state().balls.len() as f64;
    let force = force + of.gravity.at(0.0) * balls;
    assert!((held - force).norm() < 1e-3 * force.norm(), "{held} {force}");
    // Weights of balls and friction torques are of some N mm.
    let turned = middle.tilt * 1e6;
    assert!((turned - moment).norm() < 5e-3 * moment.norm(), "{turned} {moment}");
}

#[test]
fn refusals_name_the_shaft() {
    for (from, to, parts) in [
        ("shaft = \"low\"", "shaft = \"middle\"", &["bearing.shaft = \"middle\"", "high, low"][..]),
        ("shaft = \"low\"\n", "", &["\"fore\"", "bearing.shaft", "one of high, low"]),
        ("name = \"low\"", "name = \"high\"", &["high", "names of their own"]),
        ("name = \"low\"\n", "", &["name = \"\""]),
        ("outer_diameter = \"25 mm\"", "outer_diameter = \"-25 mm\"", &["shaft \"high\"", "outer_diameter"]),
    ] {
        let text = two().replacen(from, to, 1);
        assert_ne!(text, two(), "{from}");
        let refusal = SystemScene::parse(&text, None, std::path::Path::new("")).unwrap_err().to_string();
        for part in parts {
            assert!(refusal.contains(part), "{refusal}\nshould name {part}");
        }
    }
}
