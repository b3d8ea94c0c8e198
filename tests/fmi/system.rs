//! A shaft with its bearings in a package, through the C interface.

use std::ptr;

use nalgebra::Vector3;
use roulement::fmi::v2::Status;
use roulement::interface::documentation::system_page;
use roulement::interface::model_description::{all, render};
use roulement::interface::variables::{Causality, Kind, MachineVariables};
use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::fmi2_abi::*;

/// \[s] communication step.
pub const STEP: f64 = 2e-5;
/// [N] force at the mesh in the file.
const MESH: [f64; 3] = [337.8, -475.0, 1260.5];
/// [kg] mass of the shaft.
const MASS: f64 = 1.8;
/// [-] imbalance over the load at a start, where balls have one common speed and creep, and once that has faded.
const AT_START: f64 = 0.02;
const SETTLED: f64 = 2e-3;

/// A gearbox shaft on two bearings back to back, with other keys of `[shaft]`, of the load and of the bearing at the left.
fn text(shaft: &str, mesh: &str, left: &str) -> String {
    format!(
        r#"
        gravity = [0, 0, -9.81]
        [shaft]
        {shaft}
        mass = "{MASS} kg"
        polar_inertia = "6e-4 kg m^2"
        transverse_inertia = "4e-3 kg m^2"
        [[shaft.load]]
        name = "mesh"
        position = "-10 mm"
        {mesh}
        [[shaft.load]]
        name = "fan-end"
        position = "80 mm"
        [[shaft.point]]
        name = "middle"
        position = 0.0
        [[bearing]]
        name = "left"
        catalogue = "7206 B"
        mounting = {{ position = "-50 mm", direction = "+x", preload = {{ force = "1500 N" }} }}
        {left}
        [[bearing]]
        name = "right"
        catalogue = "7206 B"
        mounting = {{ position = "50 mm", direction = "-x", preload = {{ force = "1500 N" }} }}
        [load]
        duration = "5 ms"
        output_interval = "100 us"
        "#
    )
}

const SPEED: &str = "speed = \"6000 rpm\"";
const CONSTANT: &str = "force = [337.8, -475.0, 1260.5]\nmoment = [30.0, 0, -8.04]";

pub fn plain() -> String {
    text(SPEED, CONSTANT, "")
}

pub fn scene(text: &str) -> SystemScene {
    SystemScene::parse(text, None, "".as_ref()).unwrap()
}

pub fn set(package: &Package, c: Component, name: &str, value: f64) {
    assert_eq!(unsafe { fmi2SetReal(c, &package.reference(name), 1, &value) }, Status::Ok, "{name}");
}

pub fn get(package: &Package, c: Component, name: &str) -> f64 {
    real(c, package.reference(name))
}

fn vector(package: &Package, c: Component, name: &str) -> Vector3<f64> {
    Vector3::from(["x", "y", "z"].map(|axis| get(package, c, &format!("{name}.{axis}"))))
}

/// Steps from one communication point to another.
pub fn run(c: Component, points: std::ops::Range<u32>) {
    for k in points {
        assert_eq!(unsafe { fmi2DoStep(c, f64::from(k) * STEP, STEP, 0) }, Status::Ok, "{k}");
    }
}

pub fn advance(system: &mut System, points: std::ops::Range<u32>) {
    points.for_each(|k| system.advance(f64::from(k) * STEP + STEP).unwrap());
}

/// All real outputs.
pub fn outputs(package: &Package, c: Component) -> Vec<f64> {
    let references = package.references(Causality::Output);
    let mut values = vec![f64::NAN; references.len()];
    let status = unsafe { fmi2GetReal(c, references.as_ptr(), references.len(), values.as_mut_ptr()) };
    assert_eq!(status, Status::Ok);
    values
}

/// The same outputs of a native run.
pub fn native_outputs(system: &System) -> Vec<f64> {
    let table = MachineVariables::new(system);
    let rows = table.rows().iter().zip(table.values(system));
    rows.filter(|(row, _)| row.causality == Causality::Output).map(|(_, value)| value).collect()
}

pub fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Goes on from the present state, once more from it as it was kept, and in another instance from its bytes, which are returned: all have
/// the same outputs, to the bit.
pub fn replay(package: &Package, c: Component, go_on: impl Fn(Component)) -> Vec<u8> {
    let played = |c: Component| {
        go_on(c);
        bits(&outputs(package, c))
    };
    let (mut state, bytes) = (ptr::null_mut(), state_bytes(c));
    unsafe { assert_eq!(fmi2GetFMUstate(c, &mut state), Status::Ok) };
    let before = bits(&outputs(package, c));
    let there = played(c);
    assert_ne!(there, before);
    unsafe { assert_eq!(fmi2SetFMUstate(c, state), Status::Ok) };
    assert_eq!(bits(&outputs(package, c)), before);
    assert_eq!(played(c), there);
    let other = package.start();
    let mut read = ptr::null_mut();
    unsafe {
        assert_eq!(fmi2DeSerializeFMUstate(other, bytes.as_ptr(), bytes.len(), &mut read), Status::Ok);
        assert_eq!(fmi2SetFMUstate(other, read), Status::Ok);
    }
    assert_eq!(played(other), there);
    unsafe {
        assert_eq!(fmi2FreeFMUstate(c, &mut state), Status::Ok);
        assert_eq!(fmi2FreeFMUstate(other, &mut read), Status::Ok);
        fmi2FreeInstance(other);
    }
    bytes
}

/// Instantiated and in initialization mode.
fn initialising(package: &Package) -> Component {
    let c = package.instantiate();
    unsafe {
        assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
        assert_eq!(fmi2EnterInitializationMode(c), Status::Ok);
    }
    c
}

/// Force of both bearings on the shaft, in its axes: those of the right one are turned by half a turn about z.
fn of_bearings(package: &Package, c: Component) -> Vector3<f64> {
    let right = vector(package, c, "right.inner.force");
    vector(package, c, "left.inner.force") + Vector3::new(-right.x, -right.y, right.z)
}

#[test]
fn invariant_a_package_makes_the_steps_of_the_native_system() {
    let tables = "force = [337.8, [[0, -475], [\"0.31 ms\", -900], [\"0.7 ms\", -475]], 1260.5]";
    let driven = "speed = [[0, \"6000 rpm\"], [\"1 ms\", \"6100 rpm\"]]";
    let free = "torque = \"0.3 N m\"\nstart_speed = \"6000 rpm\"";
    let growing = "set = { effects = { per_ball_outputs = true } }";
    let of_order_3 = text(driven, tables, "") + "[solver]\nmethod = \"esdirk3\"\n";
    let all = [plain(), text(driven, tables, growing), text(free, tables, ""), of_order_3];
    for (index, text) in all.into_iter().enumerate() {
        let package = Package::of_system(&format!("system-steps-{index}"), &text);
        let c = package.start();
        let mut native = System::new(&scene(&text)).unwrap();
        assert_eq!(bits(&outputs(&package, c)), bits(&native_outputs(&native)), "start {index}");
        for k in 0..40 {
            run(c, k..k + 1);
            advance(&mut native, k..k + 1);
            assert_eq!(bits(&outputs(&package, c)), bits(&native_outputs(&native)), "{index}, step {k}");
        }
        // The table has come back to where it began.
        let expected = MESH[1];
        assert!((get(&package, c, "mesh.force.y") - expected).abs() < 1e-9);
        replay(&package, c, |c| run(c, 40..50));
        unsafe { fmi2FreeInstance(c) };
    }
}

#[test]
fn closed_form_bearings_carry_what_is_set() {
    let package = Package::of_system("system-statics", &plain());
    let c = initialising(&package);
    assert_eq!(vector(&package, c, "mesh.force"), Vector3::from(MESH), "start values are those of the file");
    assert_eq!(get(&package, c, "mesh.moment.x"), 30.0);
    let weight = Vector3::new(0.0, 0.0, -9.81 * MASS);
    let open = |load: Vector3<f64>| {
        let size = (load + weight).norm();
        (of_bearings(&package, c) + load + weight).norm() / size
    };
    let at_first = open(Vector3::from(MESH));
    assert!(at_first < AT_START, "{at_first}");
    // Set before the start.
    for (name, value) in [("mesh.force.x", -200.0), ("mesh.force.z", 500.0), ("'fan-end'.force.y", 90.0)] {
        set(&package, c, name, value);
    }
    assert_eq!(unsafe { fmi2ExitInitializationMode(c) }, Status::Ok);
    let load = Vector3::new(-200.0, MESH[1] + 90.0, 500.0);
    assert!(open(load) < AT_START, "{}", open(load));
    run(c, 0..50);
    assert!(open(load) < SETTLED, "{}", open(load));
    // Moments about the middle along y and z: force times arm, that of the shaft's weight is none.
    let radial =
        |name: &str, sign: f64| vector(&package, c, name).component_mul(&Vector3::new(sign, sign, 1.0));
    let (left, right) = (radial("left.inner.force", 1.0), radial("right.inner.force", -1.0));
    let own = radial("left.inner.moment", 1.0) + radial("right.inner.moment", -1.0);
    let arm = |position: f64, force: Vector3<f64>| Vector3::new(position, 0.0, 0.0).cross(&force);
    let seats = ["left", "right"].map(|name| vector(&package, c, &format!("{name}.seat.displacement")));
    // Wrenches of bearings act where the races are.
    let at = |position: f64, seat: Vector3<f64>, force: Vector3<f64>| {
        (Vector3::new(position, 0.0, 0.0) + seat).cross(&force)
    };
    let moment = at(-0.05, seats[0], left)
        + at(0.05, seats[1], right)
        + own
        + arm(-0.01, Vector3::new(-200.0, MESH[1], 500.0))
        + arm(0.08, Vector3::new(0.0, 90.0, 0.0))
        + Vector3::new(0.0, 0.0, -8.04);
    let tolerance = SETTLED * 0.05 * (left.norm() + right.norm());
    assert!(moment.y.abs() < tolerance && moment.z.abs() < tolerance, "{moment} {tolerance}");
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_load_that_is_set_goes_there_as_a_table_does() {
    // Its multiples are exact: at a time one rounding behind the end of a table nothing speeds up any more.
    const STEP: f64 = 1.0 / 65536.0;
    let ramp = |from: f64, to: f64| {
        let (begin, end) = (10.0 * STEP, 11.0 * STEP);
        format!("[[{begin:?}, {from:?}], [{end:?}, {to:?}]]")
    };
    let (z, speed) = (ramp(MESH[2], 2000.0), ramp(628.0, 640.0));
    let tables = text(
        &format!("speed = {speed}"),
        &format!("force = [337.8, -475.0, {z}]\nmoment = [30.0, 0, -8.04]"),
        "",
    );
    let mut native = System::new(&scene(&tables)).unwrap();
    // The largest step follows the speed that the file begins with.
    let package = Package::of_system("system-ramp", &text("speed = 628.0", CONSTANT, ""));
    let c = package.start();
    for k in 0..60 {
        if k == 10 {
            set(&package, c, "mesh.force.z", 2000.0);
            set(&package, c, "shaft.speed", 640.0);
        }
        let time = f64::from(k) * STEP;
        assert_eq!(unsafe { fmi2DoStep(c, time, STEP, 0) }, Status::Ok);
        native.advance(time + STEP).unwrap();
        let pairs = outputs(&package, c).into_iter().zip(native_outputs(&native));
        for ((ours, theirs), reference) in pairs.zip(package.references(Causality::Output)) {
            let row = &package.rows[reference as usize];
            // Rounding, amplified by stiff contacts.
            let tolerance = 1e-6 * theirs.abs().max(row.nominal);
            assert!((ours - theirs).abs() <= tolerance, "step {k}, {}: {ours} {theirs}", row.name);
        }
    }
    assert!((get(&package, c, "left.inner.turned") - get(&package, c, "shaft.angle")).abs() < 1e-9);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_state_is_replayed_to_the_bit_here_and_elsewhere() {
    let table = "force = [337.8, [[0, -475], [\"1 ms\", -900]], 1260.5]";
    let package = Package::of_system("system-replay", &text(SPEED, table, ""));
    let c = package.start();
    run(c, 0..10);
    set(&package, c, "shaft.speed", 640.0);
    set(&package, c, "left.friction", 0.05);
    run(c, 10..15);
    let bytes = replay(&package, c, |c| {
        run(c, 15..20);
        set(&package, c, "mesh.force.z", 900.0);
        run(c, 20..30);
    });
    // That of another system is none of this one.
    let elsewhere = Package::of_system("system-elsewhere", &plain());
    let stranger = elsewhere.start();
    let (mut state, mut read) = (ptr::null_mut(), ptr::null_mut());
    unsafe {
        assert_eq!(fmi2GetFMUstate(c, &mut state), Status::Ok);
        assert_eq!(fmi2SetFMUstate(stranger, state), Status::Error);
        assert_eq!(fmi2DeSerializeFMUstate(stranger, bytes.as_ptr(), bytes.len(), &mut read), Status::Error);
        assert_eq!(fmi2FreeFMUstate(c, &mut state), Status::Ok);
        [c, stranger].into_iter().for_each(|c| fmi2FreeInstance(c));
    }
}

#[test]
fn invariant_after_a_reset_everything_is_as_at_first() {
    let package = Package::of_system("system-reset", &plain());
    let c = package.start();
    run(c, 0..5);
    let first = bits(&outputs(&package, c));
    set(&package, c, "mesh.force.x", 0.0);
    run(c, 5..8);
    assert_eq!(unsafe { fmi2Reset(c) }, Status::Ok);
    initialise(c);
    run(c, 0..5);
    assert_eq!(bits(&outputs(&package, c)), first);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn a_script_is_played_until_its_load_is_set() {
    let table = "force = [337.8, [[0, -475], [\"1 ms\", -1475]], 1260.5]";
    let left = "set = { friction = { ball_race = [[0, 0.1], [\"1 ms\", 0.05]] }, interface = { inputs = { friction = \"master\" } } }";
    let package = Package::of_system("system-scripts", &text(SPEED, table, left));
    let messages = Messages::default();
    let c = package.instantiate_logging(&messages);
    assert_eq!(unsafe { fmi2SetDebugLogging(c, 1, 0, ptr::null()) }, Status::Ok);
    initialise(c);
    let told = |status: Status, word: &str| {
        messages.lock().unwrap().iter().filter(|(of, _, text)| *of == status && text.contains(word)).count()
    };
    assert_eq!(told(Status::Ok, "script of mesh is played until one of these inputs is set"), 1);
    assert_eq!(told(Status::Ok, "script of friction of left is not played: interface.inputs.friction"), 1);
    assert_eq!(told(Status::Ok, "script"), 2);
    run(c, 0..10);
    assert!((get(&package, c, "mesh.force.y") + 675.0).abs() < 1e-9);
    assert_eq!(get(&package, c, "left.friction"), 0.1);
    set(&package, c, "mesh.force.x", 300.0);
    assert_eq!(told(Status::Warning, "script of mesh ends at 0.0002 s: mesh.force.x was set"), 1);
    run(c, 10..20);
    // Its other components stay where they were.
    assert!((get(&package, c, "mesh.force.y") + 675.0).abs() < 1e-9);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn bad_calls_are_refused_and_say_why() {
    let package = Package::of_system("system-refusals", &plain());
    let messages = Messages::default();
    let c = package.instantiate_logging(&messages);
    initialise(c);
    let told = |word: &str| messages.lock().unwrap().iter().any(|(_, _, text)| text.contains(word));
    let refused = |name: &str, value: f64| {
        assert_eq!(unsafe { fmi2SetReal(c, &package.reference(name), 1, &value) }, Status::Error, "{name}");
    };
    refused("shaft.torque", 1.0);
    refused("left.inner.position.x", 1e-5);
    refused("mesh.force.x", f64::NAN);
    let (mut value, beyond) = (0.0, package.rows.len() as u32);
    unsafe {
        assert_eq!(fmi2GetReal(c, &beyond, 1, &mut value), Status::Error);
        let (unknown, known) = (package.reference("left.inner.force.x"), package.reference("shaft.torque"));
        let status = fmi2GetDirectionalDerivative(c, &unknown, 1, &known, 1, &1.0, &mut value);
        assert_eq!(status, Status::Error);
        assert!(told("shaft.torque cannot be a known of a directional derivative"));
    }
    // Parameters of the start, and beyond their range.
    refused("shaft.mass", 2.0);
    assert!(told("shaft.mass is fixed: it can be set before the start only"));
    refused("solver.tolerance", 1.0);
    assert!(told("solver.tolerance = 1") && told("is out of range: allowed is "), "{messages:?}");
    run(c, 0..2);
    // A force that pushes balls through the races.
    let before = outputs(&package, c);
    set(&package, c, "mesh.force.z", 1e9);
    assert_eq!(unsafe { fmi2DoStep(c, 2.0 * STEP, 10.0 * STEP, 0) }, Status::Discard);
    assert!(told("bearing \"left\"") || told("bearing \"right\"") || told("tilted"), "{messages:?}");
    assert!(outputs(&package, c).iter().all(|value| value.is_finite()) && before.len() > 100);
    let mut reached = f64::NAN;
    unsafe {
        assert_eq!(fmi2GetRealStatus(c, LAST_SUCCESSFUL_TIME, &mut reached), Status::Ok);
        assert!((2.0 * STEP..12.0 * STEP).contains(&reached), "{reached}");
        fmi2FreeInstance(c);
    }
    // An input out of its range: named with its bearing.
    let c = package.instantiate_logging(&messages);
    initialise(c);
    set(&package, c, "right.friction", -1.0);
    assert_eq!(unsafe { fmi2DoStep(c, 0.0, STEP, 0) }, Status::Error);
    assert!(told("bearing right: friction = -1 is out of range"), "{messages:?}");
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn the_pose_of_a_housing_is_an_input_where_its_race_has_one() {
    for (name, set_left, inputs) in [
        (
            "pose",
            "set = { outer = { drive = \"pose\" } }",
            ["left.outer.position.z", "left.outer.rotation.y"],
        ),
        (
            "hinge",
            "set = { outer = { drive = \"hinge\", mass = 0.2, inertia = [2e-4, 1e-4, 1e-4] } }",
            ["left.outer.frame.position.z", "left.outer.frame.rotation.y"],
        ),
    ] {
        let package = Package::of_system(&format!("system-{name}"), &text(SPEED, CONSTANT, set_left));
        let c = initialising(&package);
        let before = get(&package, c, "left.seat.displacement.z");
        let tilt = get(&package, c, "left.seat.tilt.y");
        set(&package, c, inputs[0], 5e-5);
        assert_eq!(unsafe { fmi2ExitInitializationMode(c) }, Status::Ok, "{name}");
        // The shaft goes along with its housing, about the other bearing.
        let moved = get(&package, c, "left.seat.displacement.z") - before;
        assert!((moved - 5e-5).abs() < 1e-5, "{name}: {moved}");
        let turned = get(&package, c, "left.seat.tilt.y") - tilt;
        assert!((turned - 5e-5 / 0.1).abs() < 2e-4, "{name}: {turned}");
        run(c, 0..50);
        let load = Vector3::from(MESH) - Vector3::z() * (9.81 * MASS);
        let open = (of_bearings(&package, c) + load).norm() / load.norm();
        assert!(open < 2.0 * SETTLED, "{name}: {open}");
        set(&package, c, inputs[1], 1e-4);
        run(c, 50..60);
        assert!(outputs(&package, c).iter().all(|value| value.is_finite()));
        unsafe { fmi2FreeInstance(c) };
    }
}

#[test]
fn names_units_and_abilities_are_told() {
    let every_ball = "set = { effects = { per_ball_outputs = true } }";
    let scene = scene(&text(SPEED, CONSTANT, every_ball));
    let system = System::new(&scene).unwrap();
    let table = MachineVariables::new(&system);
    let row =
        |name: &str| table.rows().iter().find(|row| row.name == name).unwrap_or_else(|| panic!("{name}"));
    for (name, unit, causality) in [
        ("mesh.force.x", "N", Causality::Input),
        ("mesh.moment.z", "N.m", Causality::Input),
        ("'fan-end'.force.y", "N", Causality::Input),
        ("shaft.speed", "rad/s", Causality::Input),
        ("shaft.torque", "N.m", Causality::Output),
        ("shaft.angle", "rad", Causality::Output),
        ("middle.displacement.x", "m", Causality::Output),
        ("mesh.velocity.z", "m/s", Causality::Output),
        ("right.seat.tilt.y", "rad", Causality::Output),
        ("left.friction", "1", Causality::Input),
        ("left.inner.force.x", "N", Causality::Output),
        ("left.inner.rotation.y", "rad", Causality::Output),
        ("left.ball[1].inner.load", "N", Causality::Output),
        ("right.friction_torque", "N.m", Causality::Output),
    ] {
        assert_eq!((row(name).unit.name, row(name).causality), (unit, causality), "{name}");
    }
    let mut names: Vec<&str> = table.rows().iter().map(|row| row.name.as_str()).collect();
    assert!(!names.iter().any(|name| name.starts_with("right.ball[")), "asked of the left one alone");
    assert!(!names.contains(&"left.inner.speed") && !names.contains(&"shaft.tilt.x"));
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
    let values = table.values(&system);
    assert!(values.len() == count && values.iter().all(|value| value.is_finite()));
    let real = |reference: usize| table.rows()[reference].kind == Kind::Real;
    assert!(
        (0..count).filter(|&r| real(r)).all(|r| table.value(r, &system).to_bits() == values[r].to_bits())
    );

    let description = render(&system, "gear", &all).unwrap();
    for word in [
        "canGetAndSetFMUstate=\"true\"",
        "canSerializeFMUstate=\"true\"",
        "providesDirectionalDerivative=\"true\"",
        "modelIdentifier=\"gear\"",
    ] {
        assert!(description.xml.contains(word), "{word}");
    }
    assert!(system_page(&system, &all).contains("Here this is so of: right."));
}

#[test]
fn regression_the_text_in_a_package_stands_alone_and_gives_the_same_system() {
    let text = text(SPEED, CONSTANT, "set = { friction = { ball_race = 0.07 } }");
    let first = scene(&text);
    assert!(!first.source.contains("catalogue") && !first.source.contains("7206 B\"\nmounting"));
    let again = scene(&first.source);
    assert_eq!(again.source, first.source);
    let systems = [first, again].map(|scene| {
        let mut system = System::new(&scene).unwrap();
        advance(&mut system, 0..3);
        bits(&native_outputs(&system))
    });
    assert_eq!(systems[0], systems[1]);
}

/// A gear in place of the mesh, whose torque is an input.
fn geared(torque: &str) -> String {
    let gear = "[[shaft.gear]]\ntorque = TORQUE\npitch_radius = \"24 mm\"\npressure_angle = \"20 deg\"\nhelix_angle = \"-15 deg\"\n\
                offset = \"-10 mm\"\nposition = \"90 deg\"\n[[shaft.load]]\nname = \"fan-end\"";
    text(SPEED, CONSTANT, "")
        .replace("[[shaft.load]]\n        name = \"fan-end\"", &gear.replace("TORQUE", torque))
}

/// A shaft of these bearings as one on deep groove bearings, of which the left one floats in a bore that is tilted and lies off.
fn seated(text: &str) -> String {
    let preload = ", preload = { force = \"1500 N\" }";
    let left =
        ", axial = \"free\", misalignment = { ry = 4e-4, rz = -2e-4 }, offset = { y = 1e-5, z = -2e-5 }";
    text.replace("7206 B", "6205").replacen(preload, left, 1).replacen(preload, "", 1)
}

#[test]
fn invariant_derivatives_of_a_step_are_its_differences() {
    let free = text("torque = \"0.3 N m\"\nstart_speed = \"6000 rpm\"", CONSTANT, "");
    let knowns = ["mesh.force.y", "mesh.force.z", "mesh.moment.z", "'fan-end'.force.y", "left.friction"];
    for (name, text, more, change) in [
        ("given", geared("25.0"), &["shaft.speed", "shaft.gear[1].torque"][..], [1e-2, 0.05]),
        ("free", free, &["shaft.torque"][..], [0.05, 0.0]),
        ("floating", seated(&geared("25.0")), &["shaft.speed", "shaft.gear[1].torque"][..], [1e-2, 0.05]),
    ] {
        let package = Package::of_system(&format!("system-derivatives-{name}"), &text);
        let c = package.start();
        run(c, 0..4);
        let mut saved = ptr::null_mut();
        unsafe { assert_eq!(fmi2GetFMUstate(c, &mut saved), Status::Ok) };
        let unknowns = [
            "mesh.displacement.y",
            "mesh.displacement.z",
            "left.inner.force.y",
            "right.inner.force.x",
            "shaft.angle",
        ];
        let of = |known: &str, change: f64| -> Vec<f64> {
            unsafe { assert_eq!(fmi2SetFMUstate(c, saved), Status::Ok) };
            let value = get(&package, c, known);
            set(&package, c, known, value + change);
            run(c, 4..5);
            unknowns.iter().map(|unknown| get(&package, c, unknown)).collect()
        };
        // Contacts near the limit of friction bend: a small change of it.
        let changes = [2.0, 2.0, 0.1, 2.0, 1e-4].into_iter().chain(change);
        for (known, change) in knowns.iter().chain(more).zip(changes) {
            let (plus, minus) = (of(known, change), of(known, -change));
            of(known, 0.0);
            let differences: Vec<f64> =
                plus.iter().zip(&minus).map(|(plus, minus)| (plus - minus) / (2.0 * change)).collect();
            let angle = get(&package, c, "shaft.angle").abs();
            let mut found = vec![0.0; unknowns.len()];
            let references: Vec<u32> = unknowns.iter().map(|name| package.reference(name)).collect();
            let known_reference = package.reference(known);
            let status = unsafe {
                fmi2GetDirectionalDerivative(
                    c,
                    references.as_ptr(),
                    5,
                    &known_reference,
                    1,
                    &1.0,
                    found.as_mut_ptr(),
                )
            };
            assert_eq!(status, Status::Ok, "{known}");
            for (index, unknown) in unknowns.iter().enumerate() {
                // Of quantities of a kind, the largest has the size.
                let alike = if index < 2 {
                    0..2
                } else if index < 4 {
                    2..4
                } else {
                    4..5
                };
                let size = alike.map(|k| differences[k].abs()).fold(1e-12, f64::max);
                let off = (found[index] - differences[index]).abs();
                // The unit takes differences, too: of changes of some 5e-4 N m, which an angle knows to some of its last digits.
                let resolution = if index == 4 { 4.0 * f64::EPSILON * angle / 1e-3 } else { 0.0 };
                assert!(
                    off < 5e-3 * size + resolution,
                    "{name} {unknown} by {known}: {} {}",
                    found[index],
                    differences[index]
                );
            }
            assert!(differences.iter().any(|value| *value != 0.0), "{known}");
        }
        unsafe {
            assert_eq!(fmi2FreeFMUstate(c, &mut saved), Status::Ok);
            fmi2FreeInstance(c);
        }
    }
}

#[test]
fn invariant_the_torque_of_a_gear_is_an_input_and_a_table_of_it_a_script() {
    // Set from outside it is that of another file.
    let (package, other) = (
        Package::of_system("system-gear", &geared("25.0")),
        Package::of_system("system-gear-more", &geared("30.0")),
    );
    let c = initialising(&package);
    assert_eq!(get(&package, c, "shaft.gear[1].torque"), 25.0);
    set(&package, c, "shaft.gear[1].torque", 30.0);
    assert_eq!(unsafe { fmi2ExitInitializationMode(c) }, Status::Ok);
    let c_other = other.start();
    run(c, 0..5);
    run(c_other, 0..5);
    assert_eq!(bits(&outputs(&package, c)), bits(&outputs(&other, c_other)));
    // A table is played, as in a native run, until it is set.
    let table = geared("[[0, 25], [\"50 us\", 30]]");
    let scripted = Package::of_system("system-gear-table", &table);
    let c_scripted = scripted.start();
    let mut native = System::new(&scene(&table)).unwrap();
    run(c_scripted, 0..5);
    advance(&mut native, 0..5);
    assert_eq!(bits(&outputs(&scripted, c_scripted)), bits(&native_outputs(&native)));
    assert_eq!(get(&scripted, c_scripted, "shaft.gear[1].torque"), 30.0);
    for c in [c, c_other, c_scripted] {
        unsafe { fmi2FreeInstance(c) };
    }
}

/// A gearbox shaft in a frame that moves with an acceleration along y.
fn framed(acceleration: &str) -> String {
    format!("frame = {{ acceleration = [0, {acceleration}, 0] }}\n{}", plain())
}

#[test]
fn invariant_the_motion_of_the_frame_is_an_input_of_the_machine_and_a_table_of_it_a_script() {
    // Set from outside it is that of another file, in the bearings too.
    let (package, other) = (
        Package::of_system("system-frame", &framed("10.0")),
        Package::of_system("system-frame-more", &framed("60.0")),
    );
    let c = initialising(&package);
    assert_eq!(get(&package, c, "frame.acceleration.y"), 10.0);
    assert_eq!(get(&package, c, "frame.gravity.z"), -9.81);
    assert!(!package.rows.iter().any(|row| row.name.contains("left.frame")));
    set(&package, c, "frame.acceleration.y", 60.0);
    assert_eq!(unsafe { fmi2ExitInitializationMode(c) }, Status::Ok);
    let c_other = other.start();
    run(c, 0..5);
    run(c_other, 0..5);
    assert_eq!(bits(&outputs(&package, c)), bits(&outputs(&other, c_other)));
    // Led there by its rate, it goes the same way as to what is set.
    let led = [(0.0, 1e7), (200.0, 0.0)].map(|(value, rate)| {
        let c = package.start();
        set(&package, c, "frame.acceleration.y", 10.0 + value);
        let reference = package.reference("frame.acceleration.y");
        assert_eq!(unsafe { fmi2SetRealInputDerivatives(c, &reference, 1, &1, &rate) }, Status::Ok);
        run(c, 0..1);
        let found = outputs(&package, c);
        unsafe { fmi2FreeInstance(c) };
        found
    });
    let apart = led[0]
        .iter()
        .zip(&led[1])
        .map(|(by_rate, by_value)| (by_rate - by_value).abs() / by_value.abs().max(1e-6));
    assert!(apart.fold(0.0, f64::max) < 1e-9);
    let c = package.start();
    run(c, 0..1);
    assert!((outputs(&package, c)[0] - led[0][0]).abs() > 1e-9, "it went somewhere");
    unsafe { fmi2FreeInstance(c) };
    // A table is played, as in a native run, until it is set.
    let table = framed("[[0, 0], [\"100 us\", 100]]");
    let scripted = Package::of_system("system-frame-table", &table);
    let c_scripted = scripted.start();
    let mut native = System::new(&scene(&table)).unwrap();
    run(c_scripted, 0..4);
    advance(&mut native, 0..4);
    assert_eq!(bits(&outputs(&scripted, c_scripted)), bits(&native_outputs(&native)));
    assert!((get(&scripted, c_scripted, "frame.acceleration.y") - 80.0).abs() < 1e-9);
    set(&scripted, c_scripted, "frame.acceleration.x", 1.0);
    run(c_scripted, 4..6);
    assert!((get(&scripted, c_scripted, "frame.acceleration.y") - 80.0).abs() < 1e-9, "no table any more");
    for c in [c, c_other, c_scripted] {
        unsafe { fmi2FreeInstance(c) };
    }
}

/// Parameters of a package: each set to a value, against the file in which a text stands in place of another.
fn parameters_are_those_of_the_file(
    tag: &str,
    plain: &str,
    package: &Package,
    cases: &[(&str, f64, &str, &str)],
) {
    for (name, value, from, to) in cases {
        let c = initialising(package);
        assert_eq!(unsafe { fmi2FreeInstance(c) }, ());
        let c = package.instantiate();
        set(package, c, name, *value);
        initialise(c);
        let changed = plain.replacen(from, to, 1);
        assert_ne!(changed, plain, "{name}");
        let other = Package::of_system(&format!("{tag}-{}", name.replace(['.', '[', ']'], "-")), &changed);
        let c_other = other.start();
        run(c, 0..4);
        run(c_other, 0..4);
        let (ours, theirs) = (outputs(package, c), outputs(&other, c_other));
        let off = ours
            .iter()
            .zip(&theirs)
            .map(|(a, b)| (a - b).abs() / a.abs().max(b.abs()).max(1e-9))
            .fold(0.0, f64::max);
        assert!(off == 0.0, "{name}: {off}");
        unsafe {
            fmi2FreeInstance(c);
            fmi2FreeInstance(c_other);
        }
    }
}

#[test]
fn invariant_a_parameter_of_a_seat_is_that_of_the_changed_file() {
    let solver = "[solver]\nmax_step = 2e-5\ninitial_step = 1e-6\ntolerance = 1e-7\n[load]";
    let mass = "mounting = { position = \"-50 mm\"";
    let plain = seated(&plain()).replace("[load]", solver).replacen(
        mass,
        &format!("set = {{ outer = {{ mass = 0.05 }} }}\n{mass}"),
        1,
    );
    let package = Package::of_system("system-seats", &plain);
    let cases = [
        ("left.mounting.misalignment.ry", -3e-4, "ry = 4e-4", "ry = -3e-4"),
        ("left.mounting.misalignment.rz", 1e-4, "rz = -2e-4", "rz = 1e-4"),
        ("left.mounting.offset.y", 3e-5, "y = 1e-5", "y = 3e-5"),
        ("left.mounting.offset.z", 1e-5, "z = -2e-5", "z = 1e-5"),
        ("left.outer.mass", 0.08, "mass = 0.05", "mass = 0.08"),
    ];
    parameters_are_those_of_the_file("system-seats", &plain, &package, &cases);
    let names = package.rows.iter().map(|row| row.name.as_str());
    assert!(!names.clone().any(|name| name.starts_with("right.mounting.offset")));
    // Nothing moves the outer ring from outside.
    assert!(
        !package
            .references(Causality::Input)
            .into_iter()
            .any(|reference| { package.rows[reference as usize].name.starts_with("left.outer") })
    );
}

#[test]
fn invariant_a_parameter_is_that_of_the_changed_file() {
    let disc = "[[shaft.disc]]\nposition = 0.0\nmass = 0.5\npolar_inertia = 2e-4\ntransverse_inertia = 1e-4\nunbalance = \"2 g mm\"\n[[shaft.point]]";
    // Steps that follow the bearing would follow the changed file.
    let solver = "[solver]\nmax_step = 2e-5\ninitial_step = 1e-6\ntolerance = 1e-7\n[load]";
    let plain = plain().replace("[[shaft.point]]", disc).replace("[load]", solver);
    let package = Package::of_system("system-parameters", &plain);
    let cases = [
        ("shaft.mass", 2.5, "mass = \"1.8 kg\"", "mass = 2.5"),
        ("shaft.disc[1].unbalance", 4e-6, "\"2 g mm\"", "4e-6"),
        ("left.mounting.preload.force", 1200.0, "\"1500 N\"", "1200.0"),
        ("right.mounting.position", 0.06, "position = \"50 mm\"", "position = 0.06"),
        (
            "left.bearing.inner_conformity",
            0.53,
            "[[bearing]]\n        name = \"right\"",
            "set = { bearing = { inner_conformity = 0.53 } }\n[[bearing]]\nname = \"right\"",
        ),
        ("solver.max_step", 1e-5, "max_step = 2e-5", "max_step = 1e-5"),
    ];
    parameters_are_those_of_the_file("system-parameters", &plain, &package, &cases);
    // A tunable one counts from the next step on.
    let of = |tolerance: Option<f64>| {
        let c = package.start();
        run(c, 0..2);
        tolerance.into_iter().for_each(|value| set(&package, c, "solver.tolerance", value));
        run(c, 2..12);
        let mut steps = 0;
        assert_eq!(
            unsafe { fmi2GetInteger(c, &package.reference("left.integrator.steps"), 1, &mut steps) },
            Status::Ok
        );
        unsafe { fmi2FreeInstance(c) };
        steps
    };
    assert!(of(Some(1e-12)) > 2 * of(None), "{} {}", of(Some(1e-12)), of(None));
    assert_eq!(of(None), of(None));
}

#[test]
fn a_package_of_a_shaft_tells_what_would_matter_to_each_bearing_and_what_an_error_goal_means() {
    let goal = text(SPEED, CONSTANT, "")
        .replace("gravity = ", "solver = { accuracy = { error = 1e-2 } }\ngravity = ");
    let package = Package::of_system("system-tells", &goal);
    let messages = Messages::default();
    let component = package.instantiate_logging(&messages);
    // SAFETY: made above.
    unsafe { assert_eq!(fmi2SetDebugLogging(component, 1, 0, ptr::null()), Status::Ok) };
    initialise(component);
    // SAFETY: made above.
    unsafe { fmi2FreeInstance(component) };
    let told = messages.lock().unwrap();
    let count = |start: &str| told.iter().filter(|(.., text)| text.starts_with(start)).count();
    assert_eq!(count("solver.accuracy.error = 1e-2: this package runs once"), 1, "{told:?}");
    for name in ["left", "right"] {
        assert_eq!(count(&format!("{name}: effects on")), 1, "{told:?}");
        assert!(count(&format!("{name}: off, would matter: ")) > 0, "{told:?}");
    }
}
