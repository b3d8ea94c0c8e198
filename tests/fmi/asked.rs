//! Derivatives by the inputs that are asked for, whatever else was.

use std::ptr;

use roulement::fmi::v2::Status;

use crate::fmi2_abi::*;
use crate::system::{get, run, set};

const SHAFT: &str = include_str!("../../scenes/shafts/pinion.toml");

/// Derivatives of the pinion's place and a bearing's force by inputs, each asked for alone.
fn derivatives(package: &Package, c: Component, knowns: &[&str]) -> Vec<[f64; 2]> {
    let unknowns = ["mesh.displacement.y", "left.inner.force.z"].map(|name| package.reference(name));
    let of = |known: &&str| {
        let (mut found, known) = ([0.0; 2], package.reference(known));
        let status = unsafe {
            fmi2GetDirectionalDerivative(c, unknowns.as_ptr(), 2, &known, 1, &1.0, found.as_mut_ptr())
        };
        assert_eq!(status, Status::Ok);
        found
    };
    knowns.iter().map(of).collect()
}

#[test]
fn invariant_a_derivative_does_not_depend_on_what_else_is_asked_for() {
    let package = Package::of_system("asked", SHAFT);
    let c = package.start();
    let all = ["mesh.force.y", "mesh.moment.z", "left.friction", "mesh.force.z"];
    // Nothing was asked for before the first point: one by one. At the second point, all that was asked for at the first comes together.
    run(c, 0..2);
    derivatives(&package, c, &all);
    let mut saved = ptr::null_mut();
    unsafe { assert_eq!(fmi2GetFMUstate(c, &mut saved), Status::Ok) };
    run(c, 2..3);
    let together = derivatives(&package, c, &all);
    assert!(together.iter().flatten().all(|value| *value != 0.0), "{together:?}");
    // From here on only two are asked for: the others are no longer expected, but are the same when they come.
    let again = |knowns: &[&str]| {
        unsafe { assert_eq!(fmi2SetFMUstate(c, saved), Status::Ok) };
        run(c, 2..3);
        derivatives(&package, c, knowns)
    };
    assert_eq!(again(&all[2..]), together[2..]);
    assert_eq!(
        again(&[all[0], all[3], all[0], all[1]]),
        [together[0], together[3], together[0], together[1]]
    );
    // Another instance, which was asked for nothing before.
    let fresh = package.start();
    run(fresh, 0..3);
    assert_eq!(derivatives(&package, fresh, &all[1..2]), together[1..2]);
    unsafe {
        fmi2FreeFMUstate(c, &mut saved);
        fmi2FreeInstance(c);
        fmi2FreeInstance(fresh);
    }
}

#[test]
fn invariant_derivatives_beside_bearings_without_states_are_differences() {
    let level = |name: &str, text: &str| {
        let own = format!("name = \"{name}\"\n");
        text.replacen(&own, &format!("{own}level = \"equilibrium\"\n"), 1)
    };
    let (one, both) = (level("left", SHAFT), level("right", &level("left", SHAFT)));
    for (name, text) in [("one", one), ("both", both)] {
        let package = Package::of_system(&format!("without-states-{name}"), &text);
        let c = package.start();
        run(c, 0..4);
        let mut saved = ptr::null_mut();
        unsafe { assert_eq!(fmi2GetFMUstate(c, &mut saved), Status::Ok) };
        let unknowns = ["mesh.displacement.y", "left.inner.force.z"];
        for known in ["mesh.force.y", "mesh.force.z"] {
            let of = |change: f64| {
                unsafe { assert_eq!(fmi2SetFMUstate(c, saved), Status::Ok) };
                let value = get(&package, c, known);
                set(&package, c, known, value + change);
                run(c, 4..5);
                unknowns.map(|unknown| get(&package, c, unknown))
            };
            let (plus, minus) = (of(2.0), of(-2.0));
            of(0.0);
            let found = derivatives(&package, c, &[known])[0];
            for (k, unknown) in unknowns.iter().enumerate() {
                let difference = (plus[k] - minus[k]) / 4.0;
                // By a force across the other axis next to nothing moves in one step.
                let size = [1e-9, 1e-4][k];
                let off = (found[k] - difference).abs();
                assert!(
                    off < 5e-3 * difference.abs().max(size),
                    "{name} {unknown} by {known}: {} {difference}",
                    found[k]
                );
            }
        }
        unsafe {
            fmi2FreeFMUstate(c, &mut saved);
            fmi2FreeInstance(c);
        }
    }
}

#[test]
fn refusals_derivatives_that_are_no_numbers() {
    let package = Package::of_system("asked-too-much", SHAFT);
    let c = package.start();
    run(c, 0..2);
    // Within a step inertia takes most of a force, a bearing a hundredth of it. A thousand changes as large as numbers go are beyond them together.
    let (unknown, known) = (package.reference("left.inner.force.z"), package.reference("mesh.force.z"));
    let by = |changes: &[f64]| {
        let (mut found, knowns) = ([0.0], vec![known; changes.len()]);
        let status = unsafe {
            fmi2GetDirectionalDerivative(
                c,
                &unknown,
                1,
                knowns.as_ptr(),
                knowns.len(),
                changes.as_ptr(),
                found.as_mut_ptr(),
            )
        };
        (status, found[0])
    };
    let (status, one) = by(&[1.0]);
    assert!(status == Status::Ok && one.abs() > 0.01, "{one}");
    assert_eq!(by(&[1e308; 1000]).0, Status::Error);
    // The instance is none the worse for it.
    assert_eq!(by(&[1.0]), (Status::Ok, one));
    run(c, 2..3);
    unsafe { fmi2FreeInstance(c) };
}
