//! Gears in mesh, and bearings by their stiffness: forces by hand, frequencies, derivatives, energy.

use std::path::Path;

use nalgebra::{Vector3, Vector6};
use roulement::model::link::spring_bearing::{AxialSupport, Spring, SpringBearing};
use roulement::model::link::tooth_mesh::{ToothFriction, ToothMesh, Varying};
use roulement::model::link::variation::{Term, Variation};
use roulement::model::link::{Law, Link, LinkState};
use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::common::{LIGHT, MODULE, gear_pair, scene, system};

/// Teeth of the pair.
const TEETH: [f64; 2] = [20.0, 40.0];

/// Two outside gears: keys of the first shaft, of the second, of the mesh, helix angle \[deg], keys of both, and direction of the second axis.
fn pair(keys: [&str; 3], helix: f64, masses: &str, direction: f64) -> String {
    gear_pair(keys, masses, false, helix, [direction, -5e-3])
}

/// Force on the first gear.
fn on_first(system: &System) -> Vector3<f64> {
    system.outputs().links[0].state.force.fixed_rows::<3>(0).into_owned()
}

#[test]
fn closed_form_forces_of_a_helical_pair_of_both_hands_and_directions_driving_and_driven() {
    for helix in [20.0, -20.0] {
        for turns in [1.0, -1.0] {
            // The torque on the second shaft brakes it, or drives it.
            for brakes in [1.0, -1.0] {
                // The second shaft turns the other way; what brakes it acts as the first one turns.
                let torque = 30.0 * turns * brakes;
                let keys = [
                    &format!("speed = \"{} rpm\"", 300.0 * turns),
                    &format!("torque = {torque}"),
                    "damping_ratio = 0.1",
                ];
                let system = system(&pair([keys[0], keys[1], keys[2]], helix, LIGHT, 1.0));
                let angle = f64::to_radians(helix);
                let radius = 0.5 * MODULE * TEETH[1] / angle.cos();
                // By hand, with the teeth of ISO 21771 on their reference cylinders: the second gear is at +z of the first, whose tooth there
                // goes along -y as it turns about +x. It presses the second along its way where that is braked, and is pressed back.
                let tangential = torque / radius;
                let y = tangential;
                let z = -tangential.abs() * 20f64.to_radians().tan() / angle.cos();
                // A right-hand gear that drives about +x is pushed along +x.
                let x = tangential * angle.tan();
                let found = on_first(&system);
                let hand = Vector3::new(x, y, z);
                assert!(
                    (found - hand).norm() < 1e-6 * hand.norm(),
                    "{helix} {turns} {brakes}: {found} {hand}"
                );
                let speeds: Vec<f64> = system.outputs().shafts.iter().map(|shaft| shaft.spin.speed).collect();
                assert!((speeds[1] + 0.5 * speeds[0]).abs() < 1e-12 * speeds[0].abs());
            }
        }
    }
}

#[test]
fn closed_form_two_inertias_swing_against_each_other_through_the_teeth() {
    // So heavy that nothing else moves; the torque presses the teeth together, where their stiffness is linear.
    let heavy = "mass = 1e6\npolar_inertia = 1e-4\ntransverse_inertia = 1e6";
    let keys = ["torque = 0\nstart_speed = 0", "torque = 30", "stiffness = 2e8\ndamping_ratio = 0"];
    let system = system(&pair(keys, 0.0, heavy, 1.0));
    let base = TEETH.map(|teeth| 0.5 * MODULE * teeth * 20f64.to_radians().cos());
    let expected =
        (2e8 * base.map(|radius| radius * radius / 1e-4).iter().sum::<f64>()).sqrt() / std::f64::consts::TAU;
    let modes = system.modes().unwrap().unwrap();
    let nearest =
        modes.iter().map(|mode| (mode.frequency / expected - 1.0).abs()).fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-6, "{nearest:e}, expected {expected} Hz");
}

/// Largest error of the tangents of a law against central differences, over the tangents.
fn of_tangents(link: &Link, displacement: Vector6<f64>, rate: Vector6<f64>) -> f64 {
    let own = link.force(&displacement, &rate, &LinkState::default());
    let mut worst = 0.0f64;
    for axis in 0..6 {
        let mut by = |steps: [f64; 2], exact: Vector6<f64>, scale: f64| {
            let at = |sign: f64| {
                let mut moved = [displacement, rate];
                moved[0][axis] += sign * steps[0];
                moved[1][axis] += sign * steps[1];
                link.force(&moved[0], &moved[1], &LinkState::default()).force
            };
            let difference = (at(1.0) - at(-1.0)) / (2.0 * (steps[0] + steps[1]));
            worst = worst.max((difference - exact).amax() / scale);
        };
        by([1e-10, 0.0], own.by_displacement.column(axis).into_owned(), own.by_displacement.amax());
        by([0.0, 1e-6], own.by_rate.column(axis).into_owned(), own.by_rate.amax());
    }
    worst
}

#[test]
fn tangents_of_links_are_differences_of_their_forces_and_forces_those_of_a_potential() {
    let unit = Vector3::new(0.3, -0.8, -0.5).normalize();
    let mesh = ToothMesh {
        normals: [unit, Vector3::new(-0.3, 0.8, -0.5).normalize()],
        arms: [Vector3::zeros(); 2],
        stiffness: 2e8,
        damping: 900.0,
        backlash: 2e-6,
        turn: 0.6,
        varying: None,
        friction: None,
    };
    let wave = |times, amplitude| Variation(vec![Term::Wave { times, amplitude, phase: 0.3 }]);
    let varying = ToothMesh {
        varying: Some(Varying { turned: 0.0, stiffness: wave(23.0, 0.2), error: wave(46.0, 3e-6) }),
        ..mesh.clone()
    };
    let rubbing = ToothMesh { friction: Some(ToothFriction { arm: 0.004, slow: 0.5 }), ..varying.clone() };
    let bearing = SpringBearing {
        stiffness: [3e8, 1e8, 1e3].map(Spring::Linear),
        torsion: None,
        damping: [200.0, 100.0, 0.2],
        gap: 5e-6,
        rest: Vector6::zeros(),
        axial: AxialSupport::Along,
    };
    for law in [Law::Mesh(mesh), Law::Mesh(varying), Law::Mesh(rubbing), Law::Spring(bearing)] {
        let link = Link { ends: vec![], law };
        for scale in [-9e-6, -1.04e-6, 3e-6, 1.05e-6, 8e-6] {
            let d = Vector6::new(-0.3, 0.8, 0.5, 0.1, -0.7, 0.4) * scale;
            let rate = Vector6::new(0.01, -0.02, 0.005, 0.3, 0.4, -0.1);
            let worst = of_tangents(&link, d, rate);
            // Forces of kN to 1e-13 over steps of 0.1 nm.
            assert!(worst < 3e-4, "{worst:e} at {scale:e}");
            // Without damping it is the slope of what is stored.
            let still = link.force(&d, &Vector6::zeros(), &LinkState::default());
            for axis in 0..6 {
                let at = |sign: f64| {
                    let mut moved = d;
                    moved[axis] += sign * 1e-9;
                    link.force(&moved, &Vector6::zeros(), &LinkState::default()).stored
                };
                let slope = -(at(1.0) - at(-1.0)) / 2e-9;
                assert!(
                    (slope - still.force[axis]).abs() < 1e-3 * still.force.amax().max(1.0),
                    "{slope} {}",
                    still.force[axis]
                );
            }
            assert!(link.force(&d, &rate, &LinkState::default()).damped >= 0.0);
        }
    }
}

#[test]
fn hard_case_a_torque_that_reverses_through_the_backlash_makes_no_energy() {
    let torque = "torque = [[0, 20], [\"1 ms\", 20], [\"1.2 ms\", -20], [\"5 ms\", -20]]";
    let keys = ["speed = \"300 rpm\"", torque, "backlash = \"40 um\"\ndamping_ratio = 0.05"];
    let mut system = system(&pair(keys, 20.0, LIGHT, -1.0));
    let (mut least, mut most, mut free) = (f64::INFINITY, f64::NEG_INFINITY, 0);
    for step in 1..=100 {
        system.advance(5e-5 * f64::from(step)).unwrap();
        let force = system.outputs().links[0].teeth.normal_force;
        (least, most) = (least.min(force), most.max(force));
        free += usize::from(force == 0.0);
    }
    // One flank, none, the other one.
    assert!(most > 300.0 && least < -300.0 && free > 3, "{least} {most} {free}");
    let outputs = system.outputs();
    let mesh = &outputs.links[0].state;
    let turned_over: f64 =
        outputs.shafts.iter().map(|shaft| shaft.energies.turned_over()).fold(0.0, f64::max);
    assert!(mesh.damped > 0.0);
    for unaccounted in [
        mesh.unaccounted(),
        outputs.shafts[0].energies.unaccounted(),
        outputs.shafts[1].energies.unaccounted(),
    ] {
        assert!(unaccounted.abs() < 1e-2 * turned_over, "{unaccounted:e} of {turned_over:e}");
    }
}

#[test]
fn invariant_a_saved_state_of_a_train_goes_on_to_the_same_bits() {
    let keys = ["speed = \"300 rpm\"", "torque = 20", ""];
    let mut one = system(&pair(keys, 20.0, LIGHT, 1.0));
    one.advance(2e-4).unwrap();
    let saved = one.snapshot();
    one.advance(4e-4).unwrap();
    let mut other = system(&pair(keys, 20.0, LIGHT, 1.0));
    assert!(other.restore(&saved));
    other.advance(4e-4).unwrap();
    assert_eq!(one.outputs(), other.outputs());
}

#[test]
fn closed_form_a_bearing_by_its_stiffness_carries_its_share() {
    // A rigid shaft on one 6205 and, across its axis, on a spring: moments about the ball bearing.
    let text = "[shaft]\nspeed = \"300 rpm\"\nmass = 2\npolar_inertia = 1e-3\ntransverse_inertia = 3e-3\n\
                [[shaft.load]]\nname = \"pull\"\nposition = \"60 mm\"\nforce = [0, 400, -300]\n\
                [[bearing]]\nname = \"ball\"\ncatalogue = \"6205\"\nmounting = { position = 0 }\n\
                [[bearing]]\nname = \"roller\"\nstiffness = { radial = \"300 N/um\", gap = \"3 um\" }\nmounting = { position = \"100 mm\" }\n\
                [load]\nduration = \"1 ms\"\noutput_interval = \"100 us\"\n";
    let system = system(text);
    let force = system.outputs().links[0].state.force;
    let [_, moment] = crate::common::held(&system)[0];
    // Moment about the middle of the ball bearing: 0.06 F + 0.1 R + M = 0.
    let y = -(0.06 * 400.0 + moment.z) / 0.1;
    let z = -(0.06 * -300.0 - moment.y) / 0.1;
    assert!((force[1] - y).abs() < 1e-6 * 240.0 && (force[2] - z).abs() < 1e-6 * 240.0, "{force} {y} {z}");
    let way = system.outputs().links[0].state.displacement;
    let expected = 3e-6 + force[1].hypot(force[2]) / 3e8 + 5e-8;
    assert!((way[1].hypot(way[2]) - expected).abs() < 1e-12, "{way} {expected}");
}

#[test]
fn independent_data_statics_of_the_public_three_stage_gearbox() {
    let folder = Path::new(roulement_tests::ROOT).join("examples/gearbox");
    let scene = SystemScene::load(&folder.join("three_stage.toml")).unwrap();
    let system = System::new(&scene).unwrap();
    // Torques on the first gears by the numbers of teeth, from 500 N m out; base radii and angles of ISO 21771 from the true centre distances.
    // (teeth, teeth, module [mm], helix [deg], centre distance [mm]), and the force on the driver as an independent script gives it [N].
    let meshes = [
        (23.0, 67.0, 1.0, 30.0, 53.0, [205.42, -307.45, -233.28]),
        (13.0, 76.0, 1.25, -10.0, 57.0, [294.14, -1688.35, -558.85]),
        (14.0, 87.0, 1.5, 10.0, 77.0, [1330.64, -746.39, 8010.63]),
    ];
    let mut torque = 500.0;
    for (index, (z1, z2, module, helix, distance, script)) in meshes.into_iter().enumerate().rev() {
        let helix = f64::to_radians(helix);
        let transverse = (20f64.to_radians().tan() / helix.cos()).atan();
        let base = 0.5e-3 * module * z2 / helix.cos() * transverse.cos();
        let base_helix = (helix.sin() * 20f64.to_radians().cos()).asin();
        let normal = torque / base / base_helix.cos();
        let link = &system.outputs().links[index];
        assert!(
            (link.teeth.normal_force.abs() / normal - 1.0).abs() < 1e-6,
            "{} {normal}",
            link.teeth.normal_force
        );
        let cosine = 0.5 * module * (z1 + z2) / helix.cos() * transverse.cos() / distance;
        let along = (
            torque / base * cosine,
            torque / base * (1.0 - cosine * cosine).sqrt(),
            normal * base_helix.sin().abs(),
        );
        let found = link.state.force.fixed_rows::<3>(0).into_owned();
        let size = along.0.hypot(along.1).hypot(along.2);
        assert!((found.norm() / size - 1.0).abs() < 1e-6, "{found} {along:?}");
        // As printed, to two digits behind the point, for a torque of 4.7246 N m in place of 500 N m out.
        assert!((found - Vector3::from(script)).amax() < 0.005 + 1e-6 * size, "{found} {script:?}");
        torque *= z1 / z2;
    }
    // Three shafts are in balance with the moments that their bearings report.
    let held = crate::common::held(&system);
    let at = |index: usize| {
        Vector3::from(
            scene.shafts[scene.bearings[index].shaft].place(scene.bearings[index].mounting.position.0),
        )
    };
    let meshed = |mesh: usize, gear: usize| {
        let sign = if gear == 0 { 1.0 } else { -1.0 };
        (scene.meshes[mesh].place(&scene), system.outputs().links[mesh].state.force.fixed_rows::<3>(0) * sign)
    };
    // And radial loads of rigid, simple supports, by an independent script (beams, no weight), from the bearings with their moments taken out [N].
    for (bearings, teeth, script) in [
        ([0, 1], vec![meshed(0, 0)], [402.00, 786.13]),
        ([2, 3], vec![meshed(0, 1), meshed(1, 0)], [131.93, 1287.04]),
        ([6, 7], vec![meshed(2, 1)], [6243.38, 2021.39]),
    ] {
        let mut force = Vector3::zeros();
        let mut moment = Vector3::zeros();
        for (place, on) in &teeth {
            force += on;
            moment += place.cross(on);
        }
        for bearing in bearings {
            force += held[bearing][0];
            moment += at(bearing).cross(&held[bearing][0]) + held[bearing][1];
        }
        let size = held[bearings[1]][0].norm();
        assert!(force.norm() < 1e-3 * size, "{force} {size}");
        assert!(moment.yz().norm() < 1e-3 * size * 0.1, "{moment} {size}");
        // A couple of forces across the axis over the distance of both bearings takes the place of their moments.
        let [left, right] = bearings.map(|bearing| (at(bearing), held[bearing]));
        let moments = left.1[1] + right.1[1];
        let couple = Vector3::x().cross(&moments) / (right.0.x - left.0.x);
        for ((held, sign), expected) in [(left.1, 1.0), (right.1, -1.0)].into_iter().zip(script) {
            let radial = (held[0] + couple * sign).yz().norm();
            assert!((radial / expected - 1.0).abs() < 0.01, "{radial} {expected}");
        }
    }
}

#[test]
fn refusals_of_meshes_name_key_value_and_allowed_range() {
    let good = pair(["speed = 10", "torque = 5", ""], 20.0, LIGHT, 1.0);
    scene(&good);
    for (from, to, parts) in [
        ("teeth = 20", "teeth = 24", &["mesh \"mesh\"", "axes are", "allowed"][..]),
        ("shaft = \"two\", position = 0,", "shaft = \"two\", position = 0.5,", &["face widths"]),
        ("{ shaft = \"two\"", "{ shaft = \"none\"", &["mesh.gears.shaft = \"none\"", "one, two"]),
        ("{ shaft = \"two\"", "{ shaft = \"one\"", &["each needs its own"]),
        ("torque = 5", "speed = 5", &["shaft \"two\"", "follows from that of \"one\""]),
        ("normal_module = 0.002", "normal_module = -1", &["normal_module", "-1 m"]),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from}");
        let refusal = SystemScene::parse(&text, None, Path::new("")).unwrap_err().to_string();
        for part in parts {
            assert!(refusal.contains(part), "{refusal}\nshould name {part}");
        }
    }
}
