//! Packages through FMI 3.0: the same numbers as through 2.0, and what that version alone has.

use std::ptr;

use roulement::fmi::v2;
use roulement::fmi::v3::Status;
use roulement::interface::references::{References, rate_row};
use roulement::interface::variables::{Causality, Kind};

use crate::fmi2_abi::*;
use crate::fmi3_abi::*;
use crate::random::Random;
use crate::scenes::scene;
use crate::system;

/// \[s] communication step: a power of two, so that sums of them are exact.
const STEP: f64 = 1.0 / 16384.0;

fn caged() -> String {
    let text = std::fs::read_to_string(format!("{}/scenes/cage.toml", roulement_tests::ROOT)).unwrap();
    scene(&text, &[("effects.per_ball_outputs", "true")]).source
}

/// Sets an input of both interfaces.
fn set_both((c, slave): (Component, Slave), reference: u32, value: f64) {
    assert_eq!(unsafe { fmi2SetReal(c, &reference, 1, &value) }, v2::Status::Ok);
    assert_eq!(slave.set(&[reference], &[value]), Status::Ok);
}

/// Runs a package through both interfaces, with inputs driven; all values are the same to the bit after every step, and derivatives, too.
fn runs_alike(package: &Package, steps: u32, drive: impl Fn((Component, Slave), f64)) {
    let both = (package.start(), Slave::new(package).initialise());
    let (c, slave) = both;
    let of = |kind: Kind| -> Vec<u32> {
        (0..package.rows.len() as u32).filter(|r| package.rows[*r as usize].kind == kind).collect()
    };
    let (reals, counts) = (of(Kind::Real), of(Kind::Integer));
    assert!(!counts.is_empty());
    let mut moved = 0;
    let mut last = vec![];
    for k in 0..steps {
        let time = f64::from(k) * STEP;
        drive(both, time);
        let (mut first, mut whole) = (vec![f64::NAN; reals.len()], vec![-1; counts.len()]);
        unsafe {
            assert_eq!(fmi2DoStep(c, time, STEP, 0), v2::Status::Ok);
            assert_eq!(fmi2GetReal(c, reals.as_ptr(), reals.len(), first.as_mut_ptr()), v2::Status::Ok);
            assert_eq!(fmi2GetInteger(c, counts.as_ptr(), counts.len(), whole.as_mut_ptr()), v2::Status::Ok);
        }
        let (status, said) = slave.step(time, STEP);
        assert_eq!(status, Status::Ok);
        assert_eq!(said, Stepped { event: false, end: false, early: false, reached: time + STEP });
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        let (first, second) = (bits(&first), bits(&slave.get(&reals)));
        let differs = first.iter().zip(&second).position(|(a, b)| a != b);
        assert!(differs.is_none(), "{} after {k} steps", package.rows[reals[differs.unwrap()] as usize].name);
        let whole: Vec<i64> = whole.into_iter().map(i64::from).collect();
        assert_eq!(whole, slave.counts(&counts));
        moved += usize::from(last != first);
        last = first;
    }
    assert_eq!(moved, steps as usize, "values change from step to step");
    assert_eq!(slave.get(&[time_of(package)]), [f64::from(steps) * STEP]);
    // Derivatives, too, and the states, but for the rates: in 3.0 they hold, in 2.0 they are of one step.
    let (unknowns, knowns) = (package.references(Causality::Output), package.references(Causality::Input));
    let seed: Vec<f64> = (0..knowns.len()).map(|k| 1e-6 * (1.0 + k as f64)).collect();
    let mut first = vec![f64::NAN; unknowns.len()];
    let (nu, nk) = (unknowns.len(), knowns.len());
    let status = unsafe {
        fmi2GetDirectionalDerivative(
            c,
            unknowns.as_ptr(),
            nu,
            knowns.as_ptr(),
            nk,
            seed.as_ptr(),
            first.as_mut_ptr(),
        )
    };
    assert_eq!(status, v2::Status::Ok);
    assert_eq!(first, slave.forward(&unknowns, &knowns, &seed));
    let orders = vec![1; nu];
    let mut second = vec![f64::NAN; nu];
    unsafe {
        let (u, o) = (unknowns.as_ptr(), orders.as_ptr());
        assert_eq!(fmi2GetRealOutputDerivatives(c, u, nu, o, first.as_mut_ptr()), v2::Status::Ok);
        assert_eq!(fmi3GetOutputDerivatives(slave.0, u, nu, o, second.as_mut_ptr(), nu), Status::Ok);
    }
    assert_eq!(first, second);
    unsafe { fmi2FreeInstance(c) };
    slave.free();
}

#[test]
fn invariant_a_bearing_runs_alike_under_a_wrench() {
    let package = Package::new("v3-wrench", &scene_text("wrench"));
    let force = package.reference("inner.applied_force.y");
    runs_alike(&package, 40, |both, time| set_both(both, force, 100.0 * (2e3 * time).sin()));
}

#[test]
fn invariant_a_bearing_runs_alike_by_its_pose_and_accelerations_are_derivatives_of_inputs() {
    let package = Package::new("v3-pose", &pose_text("shaft"));
    let [place, velocity] = ["inner.position.y", "inner.velocity.y"].map(|name| package.reference(name));
    let rate = rate_of(&package, "inner.velocity.y");
    runs_alike(&package, 40, |both, time| {
        // [m], [m/s], [m/s2] of a vibration of 2 um at 3000 rad/s.
        let (size, frequency) = (2e-6, 3e3);
        let (sine, cosine) = (frequency * time).sin_cos();
        set_both(both, place, size * sine);
        set_both(both, velocity, size * frequency * cosine);
        let acceleration = -size * frequency * frequency * sine;
        let status = unsafe { fmi2SetRealInputDerivatives(both.0, &velocity, 1, &1, &acceleration) };
        assert_eq!(status, v2::Status::Ok);
        assert_eq!(both.1.set(&[rate], &[acceleration]), Status::Ok);
        assert_eq!(both.1.get(&[rate]), [acceleration]);
    });
}

#[test]
fn invariant_a_bearing_runs_alike_by_its_angular_accelerations() {
    let package = Package::new("v3-turn", &pose_text("quaternion"));
    let [speed, rate] =
        [package.reference("inner.angular_velocity.x"), rate_of(&package, "inner.angular_velocity.x")];
    runs_alike(&package, 20, |both, time| {
        set_both(both, speed, 628.0 + 1e4 * time);
        let acceleration = 1e4;
        let status = unsafe { fmi2SetRealInputDerivatives(both.0, &speed, 1, &1, &acceleration) };
        assert_eq!(status, v2::Status::Ok);
        // Once: it holds.
        if time == 0.0 {
            assert_eq!(both.1.set(&[rate], &[acceleration]), Status::Ok);
        }
    });
}

#[test]
fn invariant_a_bearing_with_a_cage_runs_alike() {
    let package = Package::new("v3-cage", &caged());
    let friction = package.reference("friction");
    runs_alike(&package, 30, |both, time| set_both(both, friction, if time < 1e-3 { 0.1 } else { 0.02 }));
}

#[test]
fn invariant_a_shaft_with_its_bearings_runs_alike() {
    let package = Package::of_system("v3-shaft", &system::plain());
    let force = package.reference("mesh.force.z");
    runs_alike(&package, 20, |both, time| set_both(both, force, 1260.5 + 1e5 * time));
}

#[test]
fn invariant_a_state_goes_from_one_instance_to_another() {
    let package = Package::new("v3-state", &pose_text("quaternion"));
    let rate = rate_of(&package, "inner.velocity.x");
    let (one, other) = (Slave::new(&package).initialise(), Slave::new(&package));
    assert_eq!(one.set(&[rate], &[-1.0]), Status::Ok);
    let bytes = one.run(7, STEP).state_bytes();
    other.restore(&bytes);
    assert_eq!(other.state_bytes(), bytes);
    assert_eq!(other.get(&[rate]), [-1.0]);
    for slave in [one, other] {
        assert_eq!(slave.step(7.0 * STEP, STEP).0, Status::Ok);
    }
    assert_eq!(one.state_bytes(), other.state_bytes());
    assert_ne!(one.state_bytes(), bytes);
    // A state of 2.0 is one of the same instance.
    let c = package.start();
    let mut state = ptr::null_mut();
    unsafe {
        assert_eq!(fmi2DeSerializeFMUstate(c, bytes.as_ptr(), bytes.len(), &mut state), v2::Status::Ok);
        assert_eq!(fmi2SetFMUstate(c, state), v2::Status::Ok);
        assert_eq!(fmi2FreeFMUstate(c, &mut state), v2::Status::Ok);
        fmi2FreeInstance(c);
    }
    one.free();
    other.free();
}

/// All inputs with the rates of those that have one.
fn knowns(package: &Package) -> Vec<u32> {
    let rates = References::new(&package.rows).rates().map(|(rate, _)| rate as u32).collect::<Vec<_>>();
    package.references(Causality::Input).into_iter().chain(rates).collect()
}

#[test]
fn invariant_adjoint_derivatives_are_weights_times_the_matrix() {
    let mut random = Random::new(3);
    for (name, text, steps) in [
        ("v3-adjoint", pose_text("shaft"), 3),
        ("v3-adjoint-start", pose_text("cardan"), 0),
        ("v3-adjoint-wrench", scene_text("wrench"), 2),
    ] {
        let package = Package::new(name, &text);
        let slave = Slave::new(&package).initialise().run(steps, STEP);
        let (unknowns, knowns) = (package.references(Causality::Output), knowns(&package));
        let column = |k: usize| {
            let seed: Vec<f64> = (0..knowns.len()).map(|other| f64::from(u8::from(other == k))).collect();
            slave.forward(&unknowns, &knowns, &seed)
        };
        let matrix: Vec<_> = (0..knowns.len()).map(column).collect();
        let entries = matrix.iter().flatten().filter(|entry| **entry != 0.0).count();
        assert!(entries > 10 * knowns.len().min(9), "{name}: {entries} entries are not 0");
        for _ in 0..5 {
            let weights: Vec<f64> = unknowns.iter().map(|_| random.symmetric()).collect();
            let adjoint = slave.adjoint(&unknowns, &knowns, &weights);
            for (column, found) in matrix.iter().zip(&adjoint) {
                let exact: f64 = column.iter().zip(&weights).map(|(entry, weight)| entry * weight).sum();
                let size: f64 =
                    column.iter().zip(&weights).map(|(entry, weight)| (entry * weight).abs()).sum();
                assert!((found - exact).abs() <= 1e-12 * size, "{found} {exact}");
            }
        }
        slave.free();
    }
}

#[test]
fn independent_derivatives_by_accelerations_are_those_of_repeated_steps() {
    let package = Package::new("v3-rates", &pose_text("quaternion"));
    let slave = Slave::new(&package).initialise().run(3, STEP);
    let unknowns = ["inner.force.x", "inner.force.y"].map(|name| package.reference(name));
    let rate = rate_of(&package, "inner.velocity.x");
    let before = slave.state_bytes();
    assert_eq!(slave.step(3.0 * STEP, STEP).0, Status::Ok);
    let derivative = slave.forward(&unknowns, &[rate], &[1.0])[0];
    // [m/s2] a change that moves the race by some nanometres within the step.
    let change = 4.0;
    let [plus, minus] = [change, -change].map(|acceleration| {
        slave.restore(&before);
        assert_eq!(slave.set(&[rate], &[acceleration]), Status::Ok);
        assert_eq!(slave.step(3.0 * STEP, STEP).0, Status::Ok);
        slave.get(&unknowns)[0]
    });
    let quotient = (plus - minus) / (2.0 * change);
    assert!((derivative - quotient).abs() < 1e-3 * quotient.abs(), "{derivative} {quotient}");
    assert!(quotient.abs() > 1e-3, "{quotient}");
    slave.free();
}

#[test]
fn invariant_a_discarded_step_leaves_the_instance_where_it_was() {
    // No step below 8 us is allowed.
    let steps =
        [("solver.initial_step", "\"10 us\""), ("solver.min_step", "\"8 us\""), ("solver.tolerance", "1e-3")];
    let package = Package::new("v3-discard", &scene(&scene_text("wrench"), &steps).source);
    let force = package.reference("inner.applied_force.x");
    let outputs = package.references(Causality::Output);
    let [slave, other] = [(); 2].map(|()| Slave::new(&package).initialise());
    for slave in [slave, other] {
        assert_eq!(slave.step(0.0, 1e-4).0, Status::Ok);
        assert_eq!(slave.step(1e-4, 1e-4).0, Status::Ok);
    }
    let derivatives = slave.forward(&outputs, &[force], &[1.0]);
    // A force that grows too fast for that.
    assert_eq!(slave.set(&[force], &[1e8]), Status::Ok);
    let before = slave.state_bytes();
    let (status, said) = slave.step(2e-4, 1e-2);
    assert_eq!((status, said.reached, said.early), (Status::Discard, 2e-4, false));
    assert_eq!(slave.state_bytes(), before, "nothing is left of it");
    assert_eq!(slave.forward(&outputs, &[force], &[1.0]), derivatives);
    // It goes on from there, without a saved state.
    assert_eq!(slave.set(&[force], &[600.0]), Status::Ok);
    assert_eq!(other.set(&[force], &[600.0]), Status::Ok);
    for slave in [slave, other] {
        assert_eq!(slave.step(2e-4, 1e-4).0, Status::Ok);
    }
    assert_eq!(slave.state_bytes(), other.state_bytes());
    slave.free();
    other.free();
}

#[test]
fn names_of_rates_are_those_of_accelerations() {
    let package = Package::new("v3-names", &pose_text("shaft"));
    let names = |package: &Package| -> Vec<String> {
        let references = References::new(&package.rows);
        references.rates().map(|(_, row)| rate_row(&package.rows[row]).name).collect()
    };
    let expected = ["acceleration.x", "acceleration.y", "acceleration.z"]
        .into_iter()
        .chain(["rotation_acceleration.y", "rotation_acceleration.z", "speed_rate"])
        .map(|name| format!("inner.{name}"))
        .collect::<Vec<_>>();
    assert_eq!(names(&package), expected);
    // What forces move has no accelerations that are given.
    assert!(names(&Package::new("v3-names-wrench", &scene_text("wrench"))).is_empty());
}
