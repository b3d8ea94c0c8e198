//! Motions that are given at points of a shaft and of a housing, as inputs of a package: against the same motions in its file

use std::ops::Range;
use std::ptr;

use roulement::fmi::v2::Status;
use roulement::interface::variables::{Causality, MachineVariables};
use roulement::schema::Schedule;
use roulement::simulation::system::System;

use crate::fmi2_abi::*;
use crate::system::{STEP, advance, bits, get, native_outputs, outputs, replay, run, scene, set};

/// A motion: load, component, name of its rate in a package, and values at communication points, by their number.
type Motion = (&'static str, &'static str, &'static str, &'static [(u32, f64)]);

const MOTIONS: [Motion; 3] = [
    ("press", "displacement.y", "velocity.y", &[(0, 0.0), (10, 3e-6), (30, 1e-6)]),
    ("press", "tilt.z", "tilt_rate.z", &[(0, 0.0), (20, 2e-5)]),
    ("shaker", "displacement.z", "velocity.z", &[(0, 0.0), (15, 2e-6), (25, -1e-6)]),
];

/// Table of a motion over time.
fn table(points: &[(u32, f64)]) -> Schedule {
    Schedule::Table(points.iter().map(|(point, value)| (f64::from(*point) * STEP, *value)).collect())
}

/// A shaft that is pressed, in a housing that is shaken.
fn text(motions: [&str; 3]) -> String {
    let [y, rz, z] = motions;
    format!(
        r#"
        [shaft]
        speed = "6000 rpm"
        mass = "1.8 kg"
        polar_inertia = "6e-4 kg m^2"
        transverse_inertia = "4e-3 kg m^2"
        [[shaft.load]]
        name = "press"
        position = "-10 mm"
        force = [337.8, 0, 1260.5]
        displacement = {{ y = {y} }}
        rotation = {{ rz = {rz} }}
        [[housing]]
        name = "case"
        mass = "4 kg"
        inertia = [0.02, 0.01, 0.01]
        centre = [0.05, 0, 0]
        stiffness = [1e8, 1e8, 1e8, 1e6, 1e6, 1e6]
        damping = [1e3, 1e3, 1e3, 10, 10, 10]
        [[housing.load]]
        name = "shaker"
        position = [0.05, 0, 0.02]
        displacement = {{ z = {z} }}
        [[bearing]]
        name = "left"
        catalogue = "7206 B"
        mounting = {{ position = "-50 mm", preload = {{ force = "1500 N" }} }}
        [[bearing]]
        name = "right"
        catalogue = "7206 B"
        mounting = {{ position = "50 mm", direction = "-x", preload = {{ force = "1500 N" }}, housing = "case" }}
        [load]
        duration = "1 ms"
        output_interval = "100 us"
        "#
    )
}

fn scripted() -> String {
    let tables = MOTIONS.map(|(.., points)| {
        let points =
            points.iter().map(|(point, value)| format!("[{:e}, {value:e}]", f64::from(*point) * STEP));
        let points: Vec<_> = points.collect();
        format!("[{}]", points.join(", "))
    });
    text([&tables[0], &tables[1], &tables[2]])
}

/// Steps in which a master gives the motions: at every communication point values and rates that lead to where the tables are at the next.
fn run_by_hand(package: &Package, c: Component, points: Range<u32>) {
    for k in points {
        let (now, next) = (f64::from(k) * STEP, f64::from(k + 1) * STEP);
        for (load, component, rate_of, points) in MOTIONS {
            let table = table(points);
            let ((_, rate), (end, end_rate)) = (table.smooth_at(now), table.smooth_at(next));
            let gain = end_rate - rate;
            let name = format!("{load}.{rate_of}");
            set(package, c, &format!("{load}.{component}"), end - (rate + 0.5 * gain) * STEP);
            set(package, c, &name, rate);
            let acceleration = gain / STEP;
            let status =
                unsafe { fmi2SetRealInputDerivatives(c, &package.reference(&name), 1, &1, &acceleration) };
            assert_eq!(status, Status::Ok, "{name}");
        }
        run(c, k..k + 1);
    }
}

/// Names, values and typical sizes of the outputs of a native run.
fn native(system: &System) -> Vec<(String, f64, f64)> {
    let table = MachineVariables::new(system);
    let rows = table.rows().iter().zip(table.values(system));
    let rows = rows.filter(|(row, _)| row.causality == Causality::Output);
    rows.map(|(row, value)| (row.name.clone(), value, row.nominal)).collect()
}

#[test]
fn invariant_a_motion_that_is_set_is_that_of_a_table() {
    let mut file = System::new(&scene(&scripted())).unwrap();
    let package = Package::of_system("given", &text(["0", "0", "0"]));
    let c = package.start();
    for k in 0..5 {
        let points = 8 * k..8 * (k + 1);
        advance(&mut file, points.clone());
        run_by_hand(&package, c, points);
        for (found, (name, wanted, nominal)) in outputs(&package, c).into_iter().zip(native(&file)) {
            let apart = (found - wanted).abs() / wanted.abs().max(nominal);
            assert!(apart < 1e-9, "{name} at {:e}: {found} {wanted}", file.time());
        }
    }
    // They hold something, and went there.
    assert!((get(&package, c, "press.displacement.y") - 1e-6).abs() < 1e-15);
    assert!(get(&package, c, "press.force.y").abs() > 1.0 && get(&package, c, "shaker.force.z").abs() > 1.0);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_table_of_a_motion_is_played_until_the_motion_is_set() {
    let package = Package::of_system("given-table", &scripted());
    let mut file = System::new(&scene(&scripted())).unwrap();
    let messages = Messages::default();
    let c = package.instantiate_logging(&messages);
    assert_eq!(unsafe { fmi2SetDebugLogging(c, 1, 0, ptr::null()) }, Status::Ok);
    initialise(c);
    run(c, 0..10);
    advance(&mut file, 0..10);
    assert_eq!(bits(&outputs(&package, c)), bits(&native_outputs(&file)));
    assert!((get(&package, c, "press.displacement.y") - 3e-6).abs() < 1e-15);
    set(&package, c, "press.displacement.y", 3e-6);
    let told = |word: &str| messages.lock().unwrap().iter().filter(|(.., text)| text.contains(word)).count();
    assert_eq!(told("script of press.displacement.y ends at 0.0002 s: press.displacement.y was set"), 1);
    run(c, 10..20);
    // The others go on.
    let at = |index: usize, time: f64| table(MOTIONS[index].3).smooth_at(time).0;
    assert!((get(&package, c, "press.displacement.y") - 3e-6).abs() < 1e-15);
    assert!((get(&package, c, "press.tilt.z") - at(1, 4e-4)).abs() < 1e-15);
    assert!((get(&package, c, "shaker.displacement.z") - at(2, 4e-4)).abs() < 1e-15);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn a_motion_that_contradicts_its_rate_is_told_once() {
    let package = Package::of_system("given-contradiction", &text(["0", "0", "0"]));
    let messages = Messages::default();
    let c = package.instantiate_logging(&messages);
    initialise(c);
    for k in 0..8 {
        // 0.1 m/s, without a word of it in its rate.
        set(&package, c, "press.displacement.y", 2e-6 * f64::from(k));
        run(c, k..k + 1);
    }
    let messages = messages.lock().unwrap();
    let told =
        messages.iter().filter(|(.., text)| text.contains("the pose of load press contradicts its twist"));
    assert_eq!(told.count(), 1, "{messages:?}");
    drop(messages);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_state_amid_a_motion_is_replayed_to_the_bit() {
    let package = Package::of_system("given-states", &text(["0", "0", "0"]));
    let c = package.start();
    run_by_hand(&package, c, 0..6);
    replay(&package, c, |c| run_by_hand(&package, c, 6..12));
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_derivatives_by_a_motion_are_differences() {
    let package = Package::of_system("given-derivatives", &text(["0", "0", "0"]));
    let c = package.start();
    run_by_hand(&package, c, 0..4);
    let mut saved = ptr::null_mut();
    unsafe { assert_eq!(fmi2GetFMUstate(c, &mut saved), Status::Ok) };
    let unknowns = ["press.force.y", "left.inner.force.y", "right.outer.force.z", "shaker.force.z"];
    for (known, change) in
        [("press.displacement.y", 1e-9), ("shaker.displacement.z", 1e-9), ("shaker.velocity.z", 1e-5)]
    {
        let of = |change: f64| -> Vec<f64> {
            unsafe { assert_eq!(fmi2SetFMUstate(c, saved), Status::Ok) };
            set(&package, c, known, get(&package, c, known) + change);
            run(c, 4..5);
            unknowns.iter().map(|unknown| get(&package, c, unknown)).collect()
        };
        let (plus, minus) = (of(change), of(-change));
        of(0.0);
        let references: Vec<u32> = unknowns.iter().map(|name| package.reference(name)).collect();
        let mut found = vec![0.0; unknowns.len()];
        let status = unsafe {
            fmi2GetDirectionalDerivative(
                c,
                references.as_ptr(),
                unknowns.len(),
                &package.reference(known),
                1,
                &1.0,
                found.as_mut_ptr(),
            )
        };
        assert_eq!(status, Status::Ok, "{known}");
        let differences: Vec<f64> =
            plus.iter().zip(&minus).map(|(plus, minus)| (plus - minus) / (2.0 * change)).collect();
        let size = differences.iter().fold(0.0f64, |size, value| size.max(value.abs()));
        assert!(size > 0.0, "{known}");
        for ((unknown, found), difference) in unknowns.iter().zip(found).zip(&differences) {
            assert!((found - difference).abs() < 5e-3 * size, "{unknown} by {known}: {found} {difference}");
        }
    }
    unsafe {
        assert_eq!(fmi2FreeFMUstate(c, &mut saved), Status::Ok);
        fmi2FreeInstance(c);
    }
}
