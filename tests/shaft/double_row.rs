//! Double-row angular contact ball bearings of a machine: two rows of balls on common rings.

use std::path::Path;

use nalgebra::Vector3;
use roulement::catalogue::rows_of;
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::{MachineEquilibrium, System};

use crate::common::{held, run, scene, system};

/// A rigid shaft that one double-row bearing holds, with a load beside it and a thrust.
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

[[bearing]]
name = "both"
catalogue = "3206 A"
mounting = { position = "20 mm" }

[load]
duration = "1 ms"
output_interval = "100 us"
"#;

#[test]
fn closed_form_rows_share_a_radial_load_and_one_takes_a_thrust() {
    let rows = held(&system(ALONE));
    let load = Vector3::new(0.0, 900.0, -1200.0);
    let [one, other] = [rows[0][0], rows[1][0]];
    assert!((one + other + load).norm() < 1e-6 * load.norm(), "{one} {other}");
    // In the middle of both: halves, that push apart.
    let mut half = (one - other) * 0.5;
    let apart = std::mem::replace(&mut half.x, 0.0);
    // Within 1e-3, as the second row is turned by half a turn, and its balls begin at other azimuths.
    assert!(half.norm() < 1e-3 * load.norm() && apart.abs() > 0.1 * load.norm(), "{one} {other}");
    // A thrust goes to the row that takes it, the other one is loaded less.
    let pushed = held(&system(&ALONE.replace("\"0 N\"", "\"2 kN\"")));
    let [left, right] = [pushed[0][0], pushed[1][0]];
    assert!((left.x + right.x + 2000.0).abs() < 1e-3, "{left} {right}");
    assert!(left.x.abs() > right.x.abs() && left.y.hypot(left.z) > right.y.hypot(right.z), "{left} {right}");
}

#[test]
fn consistency_rows_are_two_single_bearings_at_their_distance() {
    let rows = rows_of("3206 A").unwrap().unwrap();
    let mut scene: toml::Table = rows.scene.parse().unwrap();
    scene["effects"].as_table_mut().unwrap().remove("cage");
    let mut text: toml::Table = ALONE.parse().unwrap();
    let one = |name: &str, side: f64, direction: &str| {
        let mut keys = toml::Table::new();
        keys.insert("name".into(), name.into());
        keys.insert("scene".into(), scene.clone().into());
        let at = 0.02 + 0.5 * side * rows.distance;
        keys.insert("mounting".into(), toml::toml! { position = at  direction = direction }.into());
        toml::Value::Table(keys)
    };
    text.insert("bearing".into(), vec![one("both-1", -1.0, "+x"), one("both-2", 1.0, "-x")].into());
    let [named, written] = [run(ALONE, 0.5e-3), run(&text.to_string(), 0.5e-3)];
    assert_eq!(named.outputs(), written.outputs());
    let names: Vec<&str> = named.scene().bearings.iter().map(|mounted| mounted.name.as_str()).collect();
    assert_eq!(names, ["both-1", "both-2"]);
    // A package has both rows, and no catalogue.
    let again = SystemScene::of_package(&named.scene().source).unwrap();
    let mut again = System::new(&again).unwrap();
    again.advance(0.5e-3).unwrap();
    assert_eq!(named.outputs(), again.outputs());
}

#[test]
fn closed_form_a_tilted_bore_takes_both_rows_along() {
    let tilted = scene(&ALONE.replace(
        "{ position = \"20 mm\" }",
        "{ position = \"20 mm\", misalignment = { ry = \"1 mrad\", rz = \"-2 mrad\" }, offset = { y = \"3 um\" } }",
    ));
    let distance = rows_of("3206 A").unwrap().unwrap().distance;
    for (mounted, side) in tilted.bearings.iter().zip([-0.5, 0.5]) {
        let (offset, tilt) = mounted.bore();
        let arm = Vector3::new(side * distance, 0.0, 0.0);
        let place = Vector3::new(0.0, 3e-6, 0.0) + tilt.cross(&arm);
        assert!((offset - place).norm() < 1e-12 && tilt.z == -2e-3, "{offset} {place}");
    }
    // The shaft follows the bore: what it carries stays.
    let all: Vector3<f64> = held(&System::new(&tilted).unwrap()).iter().map(|[force, _]| force).sum();
    assert!((all + Vector3::new(0.0, 900.0, -1200.0)).norm() < 1e-3, "{all}");
}

#[test]
fn consistency_balls_of_every_size_give_the_ratings_of_the_table() {
    let table = include_str!("../../src/catalogue/double_row.csv");
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |place: usize| cells[place].parse::<f64>().unwrap();
        for name in [format!("{} A", cells[0]), format!("SKF {}-2Z", cells[0]), cells[0].to_owned()] {
            let rows = rows_of(&name).unwrap().unwrap_or_else(|why| panic!("{name}: {why}"));
            let scene = Scene::parse(&rows.scene).unwrap();
            let ball = scene.bearing.ball_diameter.0;
            // Rows pass each other, and fit into the width.
            assert!(
                rows.distance > 0.95 * ball && rows.distance + ball < 1.02e-3 * number(3),
                "{name}: {} {ball}",
                rows.distance
            );
            let rating = scene.effects.rating.section.as_ref().unwrap();
            let own = rating.dynamic_load_rating.unwrap().0;
            assert!((own * 2f64.powf(0.7) / (1e3 * number(4)) - 1.0).abs() < 1e-3, "{name}: {own}");
        }
    }
    assert!(rows_of("32206").is_none() && rows_of("7206 B").is_none());
}

#[test]
fn independent_the_friction_torque_of_an_equilibrium_is_that_of_a_run() {
    // Balls of a radially loaded row have contact angles of their own, and so speeds of their own: what friction does to them in the moment of the start is no
    // torque that lasts. It drove the shaft, by twice as much as the bearing brakes it.
    for text in [ALONE.to_string(), ALONE.replace("\"0 N\"", "\"500 N\"")] {
        let found = MachineEquilibrium::of(system(&text).scene(), 0.0, 1.0).unwrap();
        let torques: Vec<f64> = found.bearings.iter().map(|row| row.outputs.torque_of_losses()).collect();
        let held = found.outputs.shafts[0].torque;
        let sum: f64 = torques.iter().sum();
        assert!(torques.iter().all(|torque| *torque > 0.0), "{torques:?}");
        // Nothing else brakes it: loads go through its axis.
        assert!((held / sum - 1.0).abs() < 0.02, "{held} {torques:?}");
        let mut running = system(&text);
        let mut mean = 0.0;
        for look in 1..=40 {
            running.advance(1e-3 * f64::from(look)).unwrap();
            mean += if look > 20 { running.outputs().shafts[0].torque / 20.0 } else { 0.0 };
        }
        // Balls that a run has settled slip otherwise than those that just roll: by 16 % of the torque under a radial load alone, 2 % with a thrust.
        assert!((held / mean - 1.0).abs() < 0.2, "{held} {mean}");
    }
}

#[test]
fn refusals_of_double_rows_name_the_key() {
    let refuse = |from: &str, to: &str| {
        SystemScene::parse(&ALONE.replace(from, to), None, Path::new("")).unwrap_err().to_string()
    };
    let why = refuse("position = \"20 mm\" }", "position = \"20 mm\", axial = \"free\" }");
    assert!(
        why.contains("\"both\"") && why.contains("bearing.mounting.axial") && why.contains("two rows"),
        "{why}"
    );
    let why = refuse("3206 A", "3299 A");
    assert!(why.contains("bearing.catalogue") && why.contains("that the table lacks"), "{why}");
    let why = refuse("position = \"20 mm\" }", "position = \"20 kg\" }");
    assert!(why.contains("position") && why.contains("20 kg"), "{why}");
}
