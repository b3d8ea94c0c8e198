//! Outputs through the C interface are those of their communication point, whenever they are asked for and however often.

use std::ptr;

use roulement::fmi::v2::Status;
use roulement::interface::variables::{Causality, Kind};
use roulement::scene::Scene;

use crate::fmi2_abi::*;

const STEP: f64 = 2e-5;

fn package(name: &str, drive: &str) -> Package {
    let changes = [("effects.per_ball_outputs", "true"), ("effects.heat_outputs", "true")];
    Package::new(name, &Scene::edited(&scene_text(drive), changes).unwrap().source)
}

/// All real outputs, read in one call.
fn outputs(package: &Package, c: Component) -> Vec<f64> {
    let references = reals(package);
    let mut values = vec![f64::NAN; references.len()];
    let status = unsafe { fmi2GetReal(c, references.as_ptr(), references.len(), values.as_mut_ptr()) };
    assert_eq!(status, Status::Ok);
    values
}

/// The same, one by one: those of races are read without the contacts.
fn alone(package: &Package, c: Component) -> Vec<f64> {
    reals(package).iter().map(|reference| real(c, *reference)).collect()
}

fn reals(package: &Package) -> Vec<u32> {
    let real = |reference: &u32| package.rows[*reference as usize].kind == Kind::Real;
    package.references(Causality::Output).into_iter().filter(real).collect()
}

/// Derivatives of all real outputs by time.
fn slopes(package: &Package, c: Component) -> Vec<f64> {
    let references = reals(package);
    let (orders, mut values) = (vec![1; references.len()], vec![f64::NAN; references.len()]);
    let (n, slopes) = (references.len(), values.as_mut_ptr());
    let status = unsafe { fmi2GetRealOutputDerivatives(c, references.as_ptr(), n, orders.as_ptr(), slopes) };
    assert_eq!(status, Status::Ok);
    values
}

fn step(c: Component, point: u32) {
    assert_eq!(unsafe { fmi2DoStep(c, f64::from(point) * STEP, STEP, 0) }, Status::Ok);
}

fn set(package: &Package, c: Component, name: &str, value: f64) {
    assert_eq!(unsafe { fmi2SetReal(c, &package.reference(name), 1, &value) }, Status::Ok);
}

#[test]
fn invariant_values_do_not_depend_on_when_they_are_read() {
    for drive in ["pose", "wrench"] {
        do_not_depend_on_when_they_are_read(&package(&format!("outputs_{drive}"), drive));
    }
}

fn do_not_depend_on_when_they_are_read(package: &Package) {
    let (read, silent) = (package.start(), package.start());
    let start = outputs(package, read);
    let mut before = start.clone();
    for point in 0..6 {
        // Inputs of the next step, set before anything is read, leave the values of this point as they are.
        let friction = 0.08 - 0.005 * f64::from(point);
        [read, silent].iter().for_each(|c| set(package, *c, "friction", friction));
        if point % 2 == 0 {
            assert_eq!(outputs(package, silent), before);
        }
        [read, silent].iter().for_each(|c| step(*c, point));
        let now = outputs(package, read);
        assert_ne!(now, before);
        assert_eq!(alone(package, silent), now);
        // The change over the step, by the time that the instance says it took.
        let time = |point: u32| f64::from(point) * STEP;
        let duration = (time(point) + STEP) - time(point);
        for ((slope, now), before) in slopes(package, silent).iter().zip(&now).zip(&before) {
            let change = (now - before) / duration;
            assert!((slope - change).abs() <= 1e-9 * change.abs(), "{slope} {change}");
        }
        assert_eq!(slopes(package, silent), slopes(package, read));
        before = now;
    }
    assert_eq!(state_bytes(read), state_bytes(silent));
    unsafe {
        assert_eq!(fmi2Reset(read), Status::Ok);
        initialise(read);
        assert_eq!(outputs(package, read), start);
        [read, silent].iter().for_each(|c| fmi2FreeInstance(*c));
    }
}

#[test]
fn invariant_restored_states_have_their_values_and_slopes() {
    let package = package("restored", "pose");
    let c = package.start();
    (0..3).for_each(|point| step(c, point));
    // Saved before anything was read.
    let mut state = ptr::null_mut();
    assert_eq!(unsafe { fmi2GetFMUstate(c, &mut state) }, Status::Ok);
    let bytes = state_bytes(c);
    let (values, slope) = (outputs(&package, c), slopes(&package, c));
    (3..5).for_each(|point| step(c, point));
    let further = outputs(&package, c);
    assert_ne!(further, values);
    unsafe {
        assert_eq!(fmi2SetFMUstate(c, state), Status::Ok);
        assert_eq!((outputs(&package, c), slopes(&package, c)), (values.clone(), slope.clone()));
        (3..5).for_each(|point| step(c, point));
        assert_eq!(outputs(&package, c), further);
        assert_eq!(fmi2FreeFMUstate(c, &mut state), Status::Ok);
        // In another instance, from bytes.
        let other = package.start();
        let mut state = ptr::null_mut();
        assert_eq!(fmi2DeSerializeFMUstate(other, bytes.as_ptr(), bytes.len(), &mut state), Status::Ok);
        assert_eq!(fmi2SetFMUstate(other, state), Status::Ok);
        assert_eq!((slopes(&package, other), outputs(&package, other)), (slope, values));
        assert_eq!(fmi2FreeFMUstate(other, &mut state), Status::Ok);
        [c, other].iter().for_each(|c| fmi2FreeInstance(*c));
    }
}

#[test]
fn invariant_a_parameter_of_the_next_step_leaves_values_and_their_slopes() {
    let package = package("tuned", "pose");
    let c = package.start();
    (0..3).for_each(|point| step(c, point));
    let twin = package.start();
    (0..3).for_each(|point| step(twin, point));
    let before = outputs(&package, twin);
    set(&package, c, "effects.damping", 0.1);
    assert_eq!(alone(&package, c), before);
    assert_eq!(outputs(&package, c), before);
    step(c, 3);
    let power = reals(&package).iter().position(|r| *r == package.reference("damping_power")).unwrap();
    let slope = slopes(&package, c);
    for (index, now) in outputs(&package, c).iter().enumerate() {
        let change = (now - before[index]) / STEP;
        assert!((slope[index] - change).abs() <= 1e-9 * change.abs(), "{} {change}", slope[index]);
    }
    // Damping that is five times as large is felt at once.
    step(twin, 3);
    assert!(outputs(&package, twin)[power] < outputs(&package, c)[power]);
    unsafe { [c, twin].iter().for_each(|c| fmi2FreeInstance(*c)) };
}

#[test]
fn invariant_a_bearing_that_stops_and_turns_back_has_numbers_in_all_outputs() {
    let text = include_str!("../data/rest/stop_and_reverse.toml");
    let reports = [("effects.stiffness_outputs", "true"), ("effects.frequency_outputs", "true")];
    let package = Package::new("stops", &Scene::edited(text, reports).unwrap().source);
    let c = package.start();
    let slips = ["cage.slip", "balls.slip"].map(|name| package.reference(name));
    let speed = package.reference("cage.speed");
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for point in 0..600 {
        assert_eq!(unsafe { fmi2DoStep(c, f64::from(point) * 2e-4, 2e-4, 0) }, Status::Ok);
        // What is no number is an error of the call.
        assert!(outputs(&package, c).iter().all(|value| value.is_finite()), "{point}");
        // Running has up to 8e-4.
        slips.iter().for_each(|slip| assert!(real(c, *slip).abs() < 1e-2, "{point}: {}", real(c, *slip)));
        (least, most) = (least.min(real(c, speed)), most.max(real(c, speed)));
    }
    assert!(most > 12.0 && least < -12.0, "{least} {most}");
    unsafe { fmi2FreeInstance(c) };
}
