//! The equilibrium of a shaft on its bearings: forces by hand, life, natural frequencies and critical speeds.

use std::f64::consts::TAU;

use nalgebra::{Matrix6, Vector3};
use roulement::simulation::system::{MachineEquilibrium, Whirl, campbell, largest_speed};
use serde_json::Value;

use crate::common::{GEARBOX, ROTOR, scene};

const RPM: f64 = TAU / 60.0;
/// A flexible shaft with a disc beside its middle, on two 6205.
const DISC: &str = include_str!("../data/shaft/rotor.toml");

fn equilibrium(text: &str) -> MachineEquilibrium {
    let scene = scene(text);
    MachineEquilibrium::of(&scene, 0.0, largest_speed(&scene)).unwrap_or_else(|why| panic!("{why}"))
}

#[test]
fn closed_form_bearing_forces_are_those_of_statics() {
    let found = equilibrium(GEARBOX);
    let [left, right] = [0, 1].map(|k| &found.bearings[k]);
    let load = Vector3::new(337.8, -475.0, 1260.5 - 9.81 * 1.8);
    assert!((left.force + right.force + load).norm() < 1e-6 * load.norm(), "{} {}", left.force, right.force);
    // Moments about the middle of the shaft: of the mesh at -10 mm, of both bearings at -+50 mm. That about x is the drive's.
    let given = Vector3::new(-0.01, 0.0, 0.0).cross(&(load + Vector3::new(0.0, 0.0, 9.81 * 1.8)))
        + Vector3::new(30.0, 0.0, -8.04);
    let of = |place: f64, k: usize| {
        let bearing = &found.bearings[k];
        Vector3::new(place, 0.0, 0.0).cross(&bearing.force) + bearing.moment
    };
    let left_over = given + of(-0.05, 0) + of(0.05, 1);
    assert!(left_over.yz().norm() < 1e-4 * given.norm(), "{left_over}");
}

#[test]
fn closed_form_bearings_of_one_life_live_shorter_together() {
    // A rotor that is loaded in its middle: both bearings alike, so that together they last 2^-0.9 of each.
    let text = ROTOR.replace("\"100 N\"", "\"1 kN\"");
    let found = equilibrium(&text);
    let [left, right] = [0, 1].map(|k| found.bearings[k].hours.unwrap()[0].unwrap());
    assert!((left / right - 1.0).abs() < 1e-3, "{left} {right}");
    let all = found.hours()[0].unwrap();
    assert!((all / left / 2f64.powf(-0.9) - 1.0).abs() < 1e-3, "{all} {left}");
    let million = found.bearings[0].outputs.life.unwrap().reference;
    assert!((left - million * 1e6 / 600.0 / 60.0).abs() < 1e-6 * left);
}

#[test]
fn independent_code_natural_frequencies_and_critical_speeds_are_those_of_ross() {
    let ross: Value = serde_json::from_str(include_str!("../data/shaft/ross.json")).unwrap();
    for row in ross["rows"].as_array().unwrap() {
        let rpm = row["rpm"].as_f64().unwrap();
        let found = equilibrium(&DISC.replace("9000 rpm", &format!("{rpm} rpm")));
        // The stiffness that its frequencies are of.
        for bearing in &found.bearings {
            let given = row["stiffness"][&bearing.name].as_array().unwrap();
            let given = Matrix6::from_fn(|i, k| given[i][k].as_f64().unwrap());
            assert!((given - bearing.stiffness).norm() < 1e-4 * given.norm(), "{rpm} {}", bearing.name);
        }
        for (theirs, ours) in row["frequencies"].as_array().unwrap().iter().zip(&found.modes) {
            let theirs = theirs.as_f64().unwrap();
            // Theirs are without the damping of contacts, which is up to 0.03 of critical.
            assert!((ours.frequency / theirs - 1.0).abs() < 6e-3, "{rpm} rpm: {} {theirs}", ours.frequency);
        }
    }
    let found = campbell(&scene(DISC), 0.0, 15000.0 * RPM).unwrap();
    let theirs: Vec<f64> =
        ross["critical_rpm"].as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect();
    assert_eq!(found.critical.len(), theirs.len());
    for (ours, theirs) in found.critical.iter().zip(theirs) {
        assert!((ours.speed / RPM / theirs - 1.0).abs() < 1e-3, "{} {theirs}", ours.speed / RPM);
    }
    // The disc beside the middle tilts: the first pair goes backwards, then forwards, and an unbalance drives the second of them alone.
    let whirls: Vec<Whirl> = found.critical.iter().map(|critical| critical.mode.whirl).collect();
    assert_eq!(whirls, [Whirl::Backward, Whirl::Forward]);
    assert!(!found.critical[0].is_driven_by_unbalance() && found.critical[1].is_driven_by_unbalance());
}

#[test]
fn closed_form_a_disc_on_a_shaft_without_weight_swings_by_its_static_stiffness() {
    let of = |force: &str| {
        let text = ROTOR
            .replace("force = [0, \"100 N\", 0]", &format!("force = [0, \"{force}\", 0]"))
            .replace("[load]", "[shaft.material]\ndensity = 10.0\n[load]");
        equilibrium(&text)
    };
    let [less, more] = ["-10 N", "10 N"].map(|force| of(force).outputs.loads[0].displacement.y);
    let expected = (20.0 / (more - less) / 2.0).sqrt() / TAU;
    let found = of("0 N");
    let lowest = found.modes.iter().find(|mode| mode.whirl != Whirl::Axial).unwrap();
    assert!((lowest.frequency / expected - 1.0).abs() < 2e-3, "{} {expected}", lowest.frequency);
    assert!(lowest.place.contains("pull") || lowest.place.contains("disc"), "{}", lowest.place);
}

#[test]
fn invariant_a_free_shaft_and_one_at_a_given_speed_swing_alike() {
    let given = equilibrium(&GEARBOX.replace("moment = [30.0, 0, -8.04]", "moment = [0, 0, -8.04]"));
    let free = GEARBOX
        .replace("moment = [30.0, 0, -8.04]", "moment = [0, 0, -8.04]")
        .replace("speed = \"6000 rpm\"", "torque = 0.0\nstart_speed = \"6000 rpm\"");
    let free = equilibrium(&free);
    assert_eq!(given.modes.len(), free.modes.len());
    for (given, free) in given.modes.iter().zip(&free.modes) {
        assert!(
            (given.frequency / free.frequency - 1.0).abs() < 1e-3,
            "{} {}",
            given.frequency,
            free.frequency
        );
    }
}
