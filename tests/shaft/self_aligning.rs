//! Self-aligning ball bearings of a machine: two rows in one sphere.

use roulement::catalogue::rows_of;
use roulement::scene::Scene;
use roulement::simulation::system::MachineEquilibrium;

use crate::common::{forces, held, run, system};
use nalgebra::Vector3;

/// A rigid shaft in a self-aligning bearing alone, held against what that does not hold.
const ALONE: &str = r#"
[shaft]
speed = "1500 rpm"
mass = "2 kg"
polar_inertia = "1e-3 kg m^2"
transverse_inertia = "3e-3 kg m^2"

[[shaft.load]]
name = "pull"
position = "20 mm"
force = ["0 N", "900 N", "-1200 N"]
rotation = { ry = 0, rz = 0 }

[[bearing]]
name = "both"
catalogue = "1206"
mounting = { position = "20 mm" }

[load]
duration = "1 ms"
output_interval = "100 us"
"#;

/// Force and moment on the shaft of both rows together, about the middle of the bearing, which stays where it is.
fn of_both(text: &str) -> [Vector3<f64>; 2] {
    let system = system(text);
    let places = system.scene().bearings.iter().map(|row| row.mounting.position.0 - 0.02);
    let zero = Vector3::zeros();
    let moved = system.outputs().loads[0].displacement;
    held(&system).iter().zip(places).fold([zero; 2], |[force, moment], ([of, about], place)| {
        [force + of, moment + about + (Vector3::x() * place + moved).cross(of)]
    })
}

#[test]
fn closed_form_a_sphere_hands_on_no_moment_however_the_ring_is_tilted() {
    let load = Vector3::new(0.0, 900.0, -1200.0);
    let thrust = Vector3::x() * 400.0;
    for (tilt, pushed) in [(0.0, false), (2e-3, false), (20e-3, false), (20e-3, true)] {
        let text = ALONE.replace(
            "position = \"20 mm\" }",
            &format!("position = \"20 mm\", misalignment = {{ rz = {tilt} }} }}"),
        );
        // All forces of a sphere go through its middle, but for those of friction and of balls that turn.
        let text = text
            .replace("1500 rpm", "10 rpm")
            .replace("[load]", "[bearing.set]\neffects = { creep = \"frictionless\" }\n[load]");
        let text = if pushed { text.replace("\"0 N\"", "\"400 N\"") } else { text };
        let [force, moment] = of_both(&text);
        let load = if pushed { load + thrust } else { load };
        assert!((force + load).norm() < 1e-6 * load.norm(), "{tilt}: {force}");
        // A tilt shifts the spheres of both rows along the axis by its square, of a place 4 mm beside the middle.
        let shifted = 0.5 * tilt * tilt * 4e-3;
        let across = moment.y.hypot(moment.z);
        assert!(across < (1e-6 * 0.023 + shifted) * load.norm(), "{tilt}: {moment}");
    }
    // Rows of other bearings stand against it.
    let [_, stiff] = of_both(
        &ALONE
            .replace("1206", "3206 A")
            .replace("position = \"20 mm\" }", "position = \"20 mm\", misalignment = { rz = \"1 mrad\" } }"),
    );
    assert!(stiff.norm() > 0.01 * 0.023 * load.norm(), "{stiff}");
}

#[test]
fn consistency_its_life_under_a_radial_load_is_that_of_its_rating() {
    let rows = rows_of("1206").unwrap().unwrap();
    let found = MachineEquilibrium::of(system(ALONE).scene(), 0.0, 1.0).unwrap();
    let lives = found.bearings.iter().map(|row| row.outputs.life.unwrap().reference);
    let both = lives.map(|life| life.powf(-10.0 / 9.0)).sum::<f64>().powf(-0.9);
    let by_rating = (rows.dynamic_load_rating / 1500.0).powi(3);
    // ISO/TS 16281 sums up contacts, ISO 281 has one load: within 3 % at no clearance.
    assert!((both / by_rating - 1.0).abs() < 0.03, "{both} {by_rating}");
}

#[test]
fn invariant_it_runs_with_its_balls_at_both_levels() {
    let still = held(&system(ALONE));
    for level in ["dynamic", "equilibrium"] {
        let text = ALONE.replace("catalogue = ", &format!("level = \"{level}\"\ncatalogue = "));
        let system = run(&text, 1e-3);
        for (own, [force, _]) in forces(&system).iter().zip(&still) {
            let [across, resting] = [own, force].map(|of| of.y.hypot(of.z));
            assert!((across / resting - 1.0).abs() < 0.02, "{level}: {own} {force}");
        }
        let names: Vec<&str> = system.scene().bearings.iter().map(|row| row.name.as_str()).collect();
        assert_eq!(names, ["both-1", "both-2"]);
    }
}

#[test]
fn a_sphere_is_the_only_outer_race_that_is_wider_than_a_groove() {
    let rows = rows_of("2208").unwrap().unwrap();
    let scene = Scene::parse(&rows.scene).unwrap();
    let [_, outer] = scene.bearing.raceways();
    assert!(outer.groove_circle_radius.abs() < 1e-12, "{}", outer.groove_circle_radius);
    // Both rows have the same one.
    assert!(
        (outer.groove_offset + 0.5 * rows.distance).abs() < 1e-12 && !rows.back_to_back,
        "{}",
        outer.groove_offset
    );
    let more = scene.bearing.outer_conformity * 1.001;
    let why =
        Scene::edited(&rows.scene, [("bearing.outer_conformity", more.to_string().as_str())]).unwrap_err();
    let why = why.to_string();
    assert!(
        why.contains("bearing.outer_conformity")
            && why.contains(&format!("{:.4}", scene.bearing.outer_conformity)[..5]),
        "{why}"
    );
}
