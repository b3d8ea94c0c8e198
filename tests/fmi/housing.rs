//! A shaft whose bearings share a housing in a package, through the C interface.

use std::ptr;

use roulement::fmi::v2::Status;
use roulement::interface::variables::{Causality, MachineVariables};
use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::fmi2_abi::*;

const STEP: f64 = 2e-5;

/// A shaft on two bearings, one of them in a housing on three feet that is hit.
fn text(shock: &str) -> String {
    format!(
        r#"
        gravity = [0, 0, -9.81]
        [shaft]
        speed = "6000 rpm"
        mass = "1.8 kg"
        polar_inertia = "6e-4 kg m^2"
        transverse_inertia = "4e-3 kg m^2"
        [[shaft.load]]
        name = "mesh"
        position = "-10 mm"
        force = [337.8, -475.0, 1260.5]
        [[housing]]
        name = "end-shield"
        mass = "4 kg"
        inertia = [0.02, 0.01, 0.01]
        centre = [0.05, 0, 0]
        foot = [
            {{ position = [0.05, 0.1, 0], stiffness = [1e8, 1e8, 1e8], damping = [1e3, 1e3, 1e3] }},
            {{ position = [0.05, -0.05, 0.09], stiffness = [1e8, 1e8, 1e8], damping = [1e3, 1e3, 1e3] }},
            {{ position = [0.05, -0.05, -0.09], stiffness = [1e8, 1e8, 1e8], damping = [1e3, 1e3, 1e3] }},
        ]
        [[housing.load]]
        name = "shock"
        position = [0.05, 0, 0.08]
        force = [0, 0, {shock}]
        [[housing.point]]
        name = "sensor"
        position = [0.05, 0, 0.1]
        [[bearing]]
        name = "left"
        catalogue = "7206 B"
        mounting = {{ position = "-50 mm", preload = {{ force = "1500 N" }} }}
        [[bearing]]
        name = "right"
        catalogue = "7206 B"
        mounting = {{ position = "50 mm", direction = "-x", preload = {{ force = "1500 N" }}, housing = "end-shield" }}
        [load]
        duration = "5 ms"
        output_interval = "100 us"
        "#
    )
}

fn outputs(package: &Package, c: Component) -> Vec<u64> {
    package.references(Causality::Output).into_iter().map(|reference| real(c, reference).to_bits()).collect()
}

fn native_outputs(system: &System) -> Vec<u64> {
    let table = MachineVariables::new(system);
    let rows = table.rows().iter().zip(table.values(system));
    rows.filter(|(row, _)| row.causality == Causality::Output).map(|(_, value)| value.to_bits()).collect()
}

fn step(c: Component, k: u32) -> Status {
    unsafe { fmi2DoStep(c, f64::from(k) * STEP, STEP, 0) }
}

fn get(package: &Package, c: Component, name: &str) -> f64 {
    real(c, package.reference(name))
}

#[test]
fn invariant_a_package_with_a_housing_makes_the_steps_of_the_native_system() {
    let text = text("[[0, 0], [\"0.2 ms\", -3000], [\"0.4 ms\", 0]]");
    let package = Package::of_system("housing-steps", &text);
    let c = package.start();
    let mut native = System::new(&SystemScene::parse(&text, None, "".as_ref()).unwrap()).unwrap();
    assert_eq!(outputs(&package, c), native_outputs(&native));
    for k in 0..30 {
        assert_eq!(step(c, k), Status::Ok);
        native.advance(f64::from(k) * STEP + STEP).unwrap();
        assert_eq!(outputs(&package, c), native_outputs(&native), "step {k}");
    }
    let moved = native.outputs().housings[0].points[0].displacement.z;
    assert_eq!(get(&package, c, "sensor.displacement.z"), moved);
    // The race moves with its seat; its axes are those of the bearing, turned by half a turn about z.
    for (axis, sign) in [("x", -1.0), ("y", -1.0), ("z", 1.0)] {
        let seat = get(&package, c, &format!("right.housing.displacement.{axis}"));
        let race = get(&package, c, &format!("right.outer.position.{axis}"));
        assert!((race - sign * seat).abs() < 1e-15, "{axis}: {race} {seat}");
    }
    unsafe { fmi2FreeInstance(c) };
}

/// A ring that slides in the housing goes along its own way, and across it with the seat.
#[test]
fn invariant_a_package_with_a_floating_bearing_makes_the_steps_of_the_native_system() {
    let preload = ", preload = { force = \"1500 N\" }";
    let text = text("[[0, 0], [\"0.2 ms\", -3000], [\"0.4 ms\", 0]]")
        .replace("7206 B", "6205")
        .replacen(preload, "", 1)
        .replacen(preload, ", axial = \"free\"", 1);
    let package = Package::of_system("housing-floating", &text);
    let c = package.start();
    let mut native = System::new(&SystemScene::parse(&text, None, "".as_ref()).unwrap()).unwrap();
    for k in 0..30 {
        assert_eq!(step(c, k), Status::Ok);
        native.advance(f64::from(k) * STEP + STEP).unwrap();
        assert_eq!(outputs(&package, c), native_outputs(&native), "step {k}");
    }
    for (axis, sign) in [("y", -1.0), ("z", 1.0)] {
        let seat = get(&package, c, &format!("right.housing.displacement.{axis}"));
        let race = get(&package, c, &format!("right.outer.position.{axis}"));
        assert!((race - sign * seat).abs() < 1e-15, "{axis}: {race} {seat}");
    }
    let along = ["right.housing.displacement.x", "right.outer.position.x"].map(|name| get(&package, c, name));
    assert!((along[0] + along[1]).abs() > 1e-7, "{along:?}");
    assert!(get(&package, c, "right.outer.force.x").abs() < 30.0);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn loads_of_a_housing_are_inputs_and_its_race_is_not() {
    let package = Package::of_system("housing-inputs", &text("0"));
    let inputs: Vec<&str> = package
        .references(Causality::Input)
        .into_iter()
        .map(|reference| package.rows[reference as usize].name.as_str())
        .collect();
    assert!(inputs.contains(&"shock.force.z") && inputs.contains(&"shock.moment.x"), "{inputs:?}");
    assert!(!inputs.iter().any(|name| name.starts_with("right.outer")), "{inputs:?}");
    let c = package.start();
    let before = get(&package, c, "sensor.displacement.z");
    for k in 0..10 {
        assert_eq!(unsafe { fmi2SetReal(c, &package.reference("shock.force.z"), 1, &-3000.0) }, Status::Ok);
        assert_eq!(step(c, k), Status::Ok);
    }
    // It begins to fall by force over mass, while springs hardly hold it: 3 kN on 4 kg in 0.2 ms make 15 um.
    let fallen = get(&package, c, "sensor.displacement.z") - before;
    assert!((-16e-6..-5e-6).contains(&fallen), "{fallen}");
    let refused = unsafe { fmi2SetReal(c, &package.reference("shock.force.z"), 1, &f64::NAN) };
    assert!(refused == Status::Error || step(c, 10) == Status::Error);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_state_with_a_housing_is_replayed_to_the_bit_elsewhere() {
    let package =
        Package::of_system("housing-replay", &text("[[0, 0], [\"0.2 ms\", -3000], [\"0.4 ms\", 0]]"));
    let c = package.start();
    (0..12).for_each(|k| assert_eq!(step(c, k), Status::Ok));
    let bytes = state_bytes(c);
    let go_on = |c: Component| {
        (12..25).for_each(|k| assert_eq!(step(c, k), Status::Ok));
        outputs(&package, c)
    };
    let there = go_on(c);
    let other = package.start();
    let mut state = ptr::null_mut();
    unsafe {
        assert_eq!(fmi2DeSerializeFMUstate(other, bytes.as_ptr(), bytes.len(), &mut state), Status::Ok);
        assert_eq!(fmi2SetFMUstate(other, state), Status::Ok);
    }
    assert_eq!(go_on(other), there);
    unsafe {
        assert_eq!(fmi2FreeFMUstate(other, &mut state), Status::Ok);
        [c, other].into_iter().for_each(|c| fmi2FreeInstance(c));
    }
}
