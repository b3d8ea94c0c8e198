//! Numbers of shoulders as parameters of a package, through the C interface.

use roulement::fmi::v2::Status;
use roulement::interface::variables::{Causality, Kind};
use roulement::scene::Scene;

use crate::fmi2_abi::*;

const STEP: f64 = 1e-4;
/// Shoulders so low that contact ellipses reach over them, by angles inside and by heights outside.
const SHOULDERS: [(&str, &str); 4] = [
    ("effects.shoulder_outputs", "true"),
    ("load.x.force", "\"1500 N\""),
    ("inner.shoulder_angle", "[0.62, 0.5]"),
    ("outer.shoulder_height", "[\"1 mm\", \"0.9 mm\"]"),
];

fn text(changes: &[(&str, &str)]) -> String {
    Scene::edited(&scene_text("wrench"), SHOULDERS.iter().chain(changes).copied()).unwrap().source
}

fn set(package: &Package, c: Component, name: &str, value: f64) -> Status {
    unsafe { fmi2SetReal(c, &package.reference(name), 1, &value) }
}

/// Sets up and starts an instance; what the last call said.
fn start(c: Component) -> Status {
    unsafe {
        assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
        match fmi2EnterInitializationMode(c) {
            Status::Ok => fmi2ExitInitializationMode(c),
            refused => refused,
        }
    }
}

/// References of all real outputs.
fn reals(package: &Package) -> Vec<u32> {
    let of = |reference: &u32| package.rows[*reference as usize].kind == Kind::Real;
    package.references(Causality::Output).into_iter().filter(of).collect()
}

/// All outputs at the start and after some steps.
fn outputs(package: &Package, c: Component) -> Vec<f64> {
    let now = || reals(package).into_iter().map(|reference| real(c, reference));
    let mut values: Vec<f64> = now().collect();
    for k in 0..5 {
        assert_eq!(unsafe { fmi2DoStep(c, f64::from(k) * STEP, STEP, 0) }, Status::Ok);
    }
    values.extend(now());
    values
}

#[test]
fn invariant_a_changed_shoulder_is_that_of_the_changed_scene() {
    let package = Package::new("shoulders", &text(&[]));
    let plain = package.start();
    let before = outputs(&package, plain);
    for (changes, scene) in [
        (&[("inner.shoulder_angle.minus_x", 0.59)][..], ("inner.shoulder_angle", "[0.59, 0.5]")),
        (
            &[("outer.shoulder_height.plus_x", 0.85e-3), ("outer.shoulder_height.minus_x", 0.5e-3)],
            ("outer.shoulder_height", "[0.5e-3, 0.85e-3]"),
        ),
    ] {
        let c = package.instantiate();
        for (name, value) in changes {
            assert_eq!(set(&package, c, name, *value), Status::Ok, "{name}");
        }
        assert_eq!(start(c), Status::Ok);
        let changed = outputs(&package, c);
        let other = Package::new("shoulders-scene", &text(&[scene]));
        let c_other = other.start();
        assert_eq!(changed, outputs(&other, c_other), "{changes:?}");
        // More of the load is over the shoulder, and the motion is the same: the ellipse stays whole.
        let race = changes[0].0.split('.').next().unwrap();
        let share = package.reference(&format!("shoulder.{race}.share"));
        let share = reals(&package).iter().position(|&at| at == share).unwrap();
        assert!(changed[share] > before[share] + 1e-4, "{} {}", changed[share], before[share]);
        unsafe {
            fmi2FreeInstance(c);
            fmi2FreeInstance(c_other);
        }
    }
    unsafe { fmi2FreeInstance(plain) };
}

#[test]
fn regression_a_shoulder_out_of_range_is_refused_with_key_value_and_range() {
    let package = Package::new("shoulders-refused", &text(&[]));
    for (name, value, parts) in [
        ("inner.shoulder_angle.plus_x", 1.6, &["inner.shoulder_angle.plus_x = 1.6 rad", "[0, 1.57"][..]),
        ("outer.shoulder_height.minus_x", -1e-3, &["outer.shoulder_height.minus_x = -0.001 m", "[0, "]),
        // Beyond the groove's radius of 0.52 ball diameters.
        ("outer.shoulder_height.plus_x", 6e-3, &["outer.shoulder_height.plus_x = 0.006 m", "[0, 0.004953"]),
        // In range, and too low for the load.
        ("inner.shoulder_angle.minus_x", 0.2, &["inner race", "beyond the shoulder", "0.200 rad"]),
    ] {
        let messages = Messages::default();
        let c = package.instantiate_logging(&messages);
        let said = set(&package, c, name, value);
        let refused = said != Status::Ok || start(c) != Status::Ok;
        let texts: Vec<String> = messages.lock().unwrap().iter().map(|(_, _, text)| text.clone()).collect();
        assert!(refused, "{name} = {value}: {texts:?}");
        for part in parts {
            assert!(texts.iter().any(|text| text.contains(part)), "{texts:?}\nshould say {part}");
        }
        unsafe { fmi2FreeInstance(c) };
    }
}

#[test]
fn shoulders_that_a_scene_leaves_to_their_defaults_are_no_parameters() {
    let package = Package::new("shoulders-none", &scene_text("wrench"));
    let mut parameters = package.rows.iter().filter(|row| row.causality == Causality::Parameter);
    assert!(parameters.all(|row| !row.name.contains("shoulder")));
}
