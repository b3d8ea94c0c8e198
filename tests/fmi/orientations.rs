//! The forms in which a package takes the orientation of a race: axis and spin speed, quaternion, Cardan angles.

use nalgebra::{UnitQuaternion, Vector3};
use roulement::fmi::v2::Status;

use crate::fmi2_abi::*;

const SPEED: f64 = 628.0;
const STEP: f64 = 1e-4;

fn set(package: &Package, c: Component, values: &[(String, f64)]) {
    let references: Vec<u32> = values.iter().map(|(name, _)| package.reference(name)).collect();
    let values: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
    assert_eq!(unsafe { fmi2SetReal(c, references.as_ptr(), values.len(), values.as_ptr()) }, Status::Ok);
}

fn get(package: &Package, c: Component, name: &str) -> f64 {
    real(c, package.reference(name))
}

fn step(c: Component, k: u32) {
    assert_eq!(unsafe { fmi2DoStep(c, f64::from(k) * STEP, STEP, 0) }, Status::Ok);
}

fn vector(name: &str, axes: &str, values: &[f64]) -> Vec<(String, f64)> {
    axes.chars().zip(values).map(|(axis, value)| (format!("inner.{name}.{axis}"), *value)).collect()
}

/// A motion of the race: place along the axis, tilt about z that sets in smoothly within 1 ms, a growing spin speed.
struct Motion {
    x: f64,
    tilt: f64,
    tilt_rate: f64,
    speed: f64,
    turned: f64,
}

fn motion(x: f64, t: f64) -> Motion {
    let (s, rise) = ((t / 1e-3).min(1.0), 1e-3);
    let tilt_rate = if s < 1.0 { rise * 6.0 * s * (1.0 - s) / 1e-3 } else { 0.0 };
    Motion {
        x,
        tilt: rise * s * s * (3.0 - 2.0 * s),
        tilt_rate,
        speed: SPEED + 2e3 * t,
        turned: SPEED * t + 1e3 * t * t,
    }
}

/// Inputs of a form of orientation.
fn inputs(form: &str, m: &Motion) -> Vec<(String, f64)> {
    let tilted = UnitQuaternion::new(Vector3::z() * m.tilt);
    let omega = tilted * Vector3::x() * m.speed + Vector3::z() * m.tilt_rate;
    let mut values = vector("position", "x", &[m.x]);
    if form == "shaft" {
        values.extend(vector("rotation", "yz", &[0.0, m.tilt]));
        values.extend(vector("rotation_rate", "yz", &[0.0, m.tilt_rate]));
        values.push(("inner.speed".into(), m.speed));
        return values;
    }
    values.extend(vector("angular_velocity", "xyz", omega.as_slice()));
    if form == "cardan" {
        values.extend(vector("angle", "xyz", &[m.turned, 0.0, m.tilt]));
    } else {
        let q = tilted * UnitQuaternion::new(Vector3::x() * m.turned);
        values.extend(vector("orientation", "wxyz", &[q.w, q.i, q.j, q.k]));
    }
    values
}

/// Moments about y and z after 20 steps of the motion above and as many of steady turning, every other step of the latter.
fn moments(form: &str) -> Vec<[f64; 2]> {
    let package = Package::new(&format!("motion-{form}"), &pose_text(form));
    let messages = Messages::default();
    let c = package.instantiate_logging(&messages);
    initialise(c);
    let x = get(&package, c, "inner.position.x");
    let mut history = vec![];
    for k in 0..40 {
        set(&package, c, &inputs(form, &motion(x, f64::from(k) * STEP)));
        step(c, k);
        if k >= 20 && k % 2 == 0 {
            history.push(["y", "z"].map(|axis| get(&package, c, &format!("inner.moment.{axis}"))));
        }
    }
    unsafe { fmi2FreeInstance(c) };
    assert_eq!(*messages.lock().unwrap(), []);
    history
}

#[test]
fn invariant_every_form_of_orientation_gives_the_same_moments() {
    let shaft = moments("shaft");
    let largest = shaft.iter().flatten().fold(0.0, |most: f64, moment| most.max(moment.abs()));
    assert!(largest > 0.5, "{largest}");
    for form in ["quaternion", "cardan"] {
        for (one, other) in moments(form).iter().zip(&shaft) {
            for (one, other) in one.iter().zip(other) {
                // The paths within the steps in which the race tilts differ a little, and the spin speed's with them.
                assert!((one - other).abs() < 2e-3 * largest, "{form}: {one} {other}");
            }
        }
    }
}

#[test]
fn regression_a_held_cardan_tilt_does_not_whirl_with_the_shaft() {
    // The moment about z holds the tilt about z, all around the turn.
    for form in ["cardan", "shaft"] {
        for [about_y, about_z] in &moments(form)[5..] {
            assert!(*about_z < -0.5 && about_y.abs() < 0.6 * about_z.abs(), "{form}: {about_y} {about_z}");
        }
    }
}

#[test]
fn the_shaft_is_the_form_of_a_package_that_asks_for_none() {
    let package = Package::new("default", &scene_text("pose"));
    let names: Vec<&str> = package.rows.iter().map(|row| row.name.as_str()).collect();
    for name in
        ["inner.rotation.y", "inner.rotation.z", "inner.rotation_rate.y", "inner.speed", "inner.turned"]
    {
        assert!(names.contains(&name), "{name}");
    }
    for name in ["inner.orientation.w", "inner.angle.x", "inner.angular_velocity.x", "inner.rotation.x"] {
        assert!(!names.contains(&name), "{name}");
    }
}

#[test]
fn zeros_are_a_start_and_the_race_turns_by_itself() {
    let package = Package::new("zeros", &pose_text("shaft"));
    let c = package.instantiate();
    let mut zeros = vector("position", "xyz", &[0.0; 3]);
    zeros.extend(vector("velocity", "xyz", &[0.0; 3]));
    zeros.extend(vector("rotation", "yz", &[0.0; 2]));
    zeros.extend(vector("rotation_rate", "yz", &[0.0; 2]));
    zeros.push(("inner.speed".into(), 0.0));
    set(&package, c, &zeros);
    initialise(c);
    // Nothing but rounding: balls are in balance in the middle of their grooves.
    assert!(get(&package, c, "inner.force.x").abs() < 1e-12);
    step(c, 0);
    // The shaft takes the race to its place and up to its speed.
    let (x, speed) = (2e-5, 100.0);
    for k in 1..=20 {
        let share = f64::from(k).min(10.0) / 10.0;
        set(&package, c, &vector("position", "x", &[x * share]));
        set(&package, c, &[("inner.speed".into(), speed * share)]);
        step(c, k);
    }
    assert!(get(&package, c, "inner.force.x") < -100.0);
    // Speed is linear within a step to what was announced at its start: the angle is that of a trapezoid.
    let turned = speed * STEP * (0.5 * 10.0 + 10.0);
    let got = get(&package, c, "inner.turned");
    assert!((got - turned).abs() < 1e-12 * turned, "{got} {turned}");
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn regression_a_quaternion_of_zeros_is_no_rotation_and_told_once() {
    let package = Package::new("unconnected", &pose_text("quaternion"));
    let messages = Messages::default();
    let (zeros, plain) = (package.instantiate_logging(&messages), package.instantiate());
    set(&package, zeros, &vector("orientation", "wxyz", &[0.0; 4]));
    set(&package, plain, &vector("orientation", "wxyz", &[1.0, 0.0, 0.0, 0.0]));
    for c in [zeros, plain] {
        initialise(c);
        step(c, 0);
        step(c, 1);
    }
    for name in ["inner.force.x", "inner.moment.y", "friction_power"] {
        let (one, other) = (get(&package, zeros, name), get(&package, plain, name));
        // One of them was started anew from the inputs that it was given.
        assert!((one - other).abs() < 1e-9 * other.abs().max(1.0), "{name} {one} {other}");
    }
    {
        let told = messages.lock().unwrap();
        assert_eq!(told.iter().filter(|(_, _, text)| text.contains("all zeros")).count(), 1, "{told:?}");
        assert!(told[0].0 == Status::Warning && told[0].1 == "logStatusWarning");
        assert!(told[0].2.starts_with("inner.orientation"), "{told:?}");
    }
    unsafe {
        fmi2FreeInstance(zeros);
        fmi2FreeInstance(plain);
    }
}

#[test]
fn regression_a_pose_that_contradicts_its_twist_is_told_once_with_both_numbers() {
    let package = Package::new("contradiction", &pose_text("quaternion"));
    let messages = Messages::default();
    let c = package.instantiate_logging(&messages);
    initialise(c);
    let agrees = get(&package, c, "friction_power");
    // The orientation is held, the angular velocity is that of the spin.
    let speed = get(&package, c, "inner.angular_velocity.x");
    for k in 0..10 {
        step(c, k);
    }
    assert!(get(&package, c, "friction_power") > 10.0 * agrees);
    let told = std::mem::take(&mut *messages.lock().unwrap());
    assert_eq!(told.len(), 1, "{told:?}");
    let (status, category, text) = &told[0];
    assert!(*status == Status::Warning && category == "logStatusWarning");
    let numbers = format!("turns at 0.000000 rad/s, by its velocities at {speed:.6} rad/s");
    assert!(text.contains("inner race") && text.contains(&numbers), "{text}");
    unsafe { fmi2FreeInstance(c) };
}
