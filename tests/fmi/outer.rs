//! The outer race under a wrench in a package, of a bearing and of a shaft, through the C interface.

use nalgebra::{Matrix3, Vector3};
use roulement::Simulation;
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::fmi::v2::Status;
use roulement::interface::variables::Causality;
use roulement::scene::Scene;
use roulement::simulation::system::{Played, System};

use crate::fmi2_abi::*;
use crate::system::scene;

const STEP: f64 = 1e-4;

/// The small bearing with the outer race as the body.
fn text(changes: &[(&str, &str)]) -> String {
    let outer = [
        ("inner.drive", "\"fixed\""),
        ("outer.drive", "\"wrench\""),
        ("outer.mass", "0.3"),
        ("outer.inertia", "[3e-4, 2e-4, 2e-4]"),
        ("load.x", ""),
        ("load.outer.x.force", "\"-600 N\""),
        ("load.outer_speed", "\"500 rpm\""),
        // Steps that follow the scene's load would not be those of a master's load.
        ("solver.max_step", "\"10 us\""),
    ];
    let changes = outer.iter().chain(changes).copied();
    Scene::edited(&scene_text("wrench"), changes).unwrap().source
}

fn set(package: &Package, c: Component, name: &str, value: f64) {
    assert_eq!(unsafe { fmi2SetReal(c, &package.reference(name), 1, &value) }, Status::Ok, "{name}");
}

fn get(package: &Package, c: Component, name: &str) -> f64 {
    real(c, package.reference(name))
}

fn step(c: Component, k: u32) {
    assert_eq!(unsafe { fmi2DoStep(c, f64::from(k) * STEP, STEP, 0) }, Status::Ok);
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

#[test]
fn the_outer_race_has_the_variables_that_the_inner_one_has_under_a_wrench() {
    let package = Package::new("outer-names", &text(&[]));
    let inner = Package::new("inner-names", &scene_text("wrench"));
    let of_race = |package: &Package, race: &str| -> Vec<(String, Causality)> {
        let rows = package.rows.iter().filter_map(|row| Some((row.name.strip_prefix(race)?, row.causality)));
        let kept = rows.filter(|(_, causality)| *causality != Causality::Parameter);
        kept.map(|(name, causality)| (name.to_string(), causality)).collect()
    };
    let ours = of_race(&package, "outer.");
    assert_eq!(ours, of_race(&inner, "inner."));
    assert!(ours.contains(&("applied_force.x".into(), Causality::Input)));
    assert!(ours.contains(&("position.x".into(), Causality::Output)));
    assert!(ours.contains(&("drive_torque".into(), Causality::Output)));
    // Its numbers are parameters, and one of no frame.
    let names: Vec<&str> = package.rows.iter().map(|row| row.name.as_str()).collect();
    assert!(names.contains(&"outer.mass") && !names.contains(&"outer.misalignment.ry"));
}

#[test]
fn invariant_inputs_of_the_outer_race_are_those_of_a_scene() {
    // The wrench that a master sets before the start, and changes, against a native run.
    let package = Package::new("outer-inputs", &text(&[]));
    let c = initialising(&package);
    for (name, value) in
        [("applied_force.x", -900.0), ("applied_force.y", 80.0), ("applied_moment.z", 0.4), ("speed", -60.0)]
    {
        set(&package, c, &format!("outer.{name}"), value);
    }
    assert_eq!(unsafe { fmi2ExitInitializationMode(c) }, Status::Ok);
    let changes = [
        ("load.outer.x.force", "-900.0"),
        ("load.outer.y.force", "80.0"),
        ("load.outer.rz.moment", "0.4"),
        ("load.outer_speed", "-60.0"),
    ];
    let mut native = Simulation::new(&Scene::parse(&text(&changes)).unwrap()).unwrap();
    let same = |c: Component, native: &Simulation| {
        let race = &native.outputs().outer;
        for (name, value) in [
            ("position.x", race.pose.position.x),
            ("position.y", race.pose.position.y),
            ("velocity.x", race.twist.velocity.x),
            ("force.y", race.wrench.force.y),
            ("moment.z", race.wrench.moment.z),
            ("drive_torque", race.drive_torque),
        ] {
            let ours = get(&package, c, &format!("outer.{name}"));
            assert!((ours - value).abs() <= 1e-9 * value.abs(), "{name}: {ours} {value}");
        }
    };
    same(c, &native);
    assert!(native.outputs().outer.pose.position.y > 1e-7);
    for k in 0..10 {
        if k == 3 {
            set(&package, c, "outer.applied_force.y", -300.0);
            let mut inputs = *native.inputs();
            inputs.outer.applied.force.y = -300.0;
            native.set_inputs(inputs);
        }
        step(c, k);
        native.advance(f64::from(k) * STEP + STEP).unwrap();
        same(c, &native);
    }
    assert!(native.outputs().outer.pose.position.y < -1e-7, "it follows the load");
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_scripted_wrench_is_played_until_the_master_sets_one() {
    let table = [("load.outer.x.force", "[[0, -600], [\"1 ms\", -1500]]")];
    let package = Package::new("outer-script", &text(&table));
    let c = package.start();
    for k in 0..5 {
        step(c, k);
        let expected = -600.0 - 900.0 * 0.1 * f64::from(k + 1);
        assert!((get(&package, c, "outer.applied_force.x") - expected).abs() < 1e-6);
    }
    set(&package, c, "outer.applied_force.x", -700.0);
    step(c, 5);
    assert_eq!(get(&package, c, "outer.applied_force.x"), -700.0);
    unsafe { fmi2FreeInstance(c) };
    // Left to the master, it is not played.
    let left = [table[0], ("interface.inputs.loads", "\"master\"")];
    let package = Package::new("outer-master", &text(&left));
    let c = package.start();
    (0..3).for_each(|k| step(c, k));
    assert_eq!(get(&package, c, "outer.applied_force.x"), -600.0);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_state_of_an_outer_race_is_replayed_to_the_bit() {
    let table = [("load.outer.y.force", "[[0, 0], [\"1 ms\", 300]]")];
    let package = Package::new("outer-replay", &text(&table));
    let c = package.start();
    (0..4).for_each(|k| step(c, k));
    let mut state = std::ptr::null_mut();
    assert_eq!(unsafe { fmi2GetFMUstate(c, &mut state) }, Status::Ok);
    let run = |c: Component| {
        (4..10).for_each(|k| step(c, k));
        state_bytes(c)
    };
    let first = run(c);
    assert_eq!(unsafe { fmi2SetFMUstate(c, state) }, Status::Ok);
    assert_eq!(run(c), first);
    unsafe {
        fmi2FreeFMUstate(c, &mut state);
        fmi2FreeInstance(c);
    }
}

/// Derivatives of the position of the outer race by the applied force.
fn compliance(package: &Package, c: Component) -> Matrix3<f64> {
    let axes = ["x", "y", "z"];
    Matrix3::from_fn(|i, k| {
        let unknown = package.reference(&format!("outer.position.{}", axes[i]));
        let known = package.reference(&format!("outer.applied_force.{}", axes[k]));
        let mut derivative = f64::NAN;
        let status =
            unsafe { fmi2GetDirectionalDerivative(c, &unknown, 1, &known, 1, &1.0, &mut derivative) };
        assert_eq!(status, Status::Ok);
        derivative
    })
}

#[test]
fn closed_form_directional_derivatives_at_the_start_are_the_compliance_of_the_equilibrium() {
    let text = text(&[("load.outer.y.force", "100.0")]);
    let package = Package::new("outer-derivatives", &text);
    let c = initialising(&package);
    let ours = compliance(&package, c);
    let simulation = Simulation::new(&Scene::parse(&text).unwrap()).unwrap();
    let input = EquilibriumInput::from_scene(simulation.scene(), Gyroscopic::Friction);
    let solution = equilibrium::solve(simulation.model(), &input).unwrap();
    let expected = solution.stiffness.try_inverse().unwrap();
    for i in 0..3 {
        for k in 0..3 {
            let scale = (expected[(i, i)] * expected[(k, k)]).sqrt();
            let off = (ours[(i, k)] - expected[(i, k)]).abs() / scale;
            assert!(off < 1e-5, "{i} {k}: {} {}", ours[(i, k)], expected[(i, k)]);
        }
    }
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_directional_derivatives_of_a_step_are_its_differences() {
    let package = Package::new("outer-step", &text(&[]));
    let force = Vector3::new(-600.0, 0.0, 0.0);
    let run = |change: f64| {
        let c = package.start();
        (0..3).for_each(|k| step(c, k));
        set(&package, c, "outer.applied_force.y", force.y + change);
        step(c, 3);
        c
    };
    let [c, plus, minus] = [0.0, 1.0, -1.0].map(run);
    let ours = compliance(&package, c)[(1, 1)];
    let place = |c: Component| get(&package, c, "outer.position.y");
    let difference = (place(plus) - place(minus)) / 2.0;
    assert!((ours / difference - 1.0).abs() < 1e-3 && ours > 0.0, "{ours:e} {difference:e}");
    for c in [c, plus, minus] {
        unsafe { fmi2FreeInstance(c) };
    }
}

#[test]
fn regression_a_held_inner_race_starts_where_the_scene_says_whatever_the_place_of_the_hinge() {
    let hinge = [
        ("outer.drive", "\"hinge\""),
        ("outer.mass", "0.3"),
        ("outer.inertia", "[3e-4, 2e-4, 2e-4]"),
        ("load.y", "{ displacement = \"2 um\" }"),
    ];
    let text = Scene::edited(&scene_text("wrench"), hinge).unwrap().source;
    let package = Package::new("outer-hinge", &text);
    let c = initialising(&package);
    set(&package, c, "outer.frame.position.y", 5e-6);
    assert_eq!(unsafe { fmi2ExitInitializationMode(c) }, Status::Ok);
    assert_eq!(get(&package, c, "outer.position.y"), 5e-6);
    // It was at 7 um, from where the first step tore it back.
    let start = get(&package, c, "inner.position.y");
    assert!((start - 2e-6).abs() < 1e-12, "{start:e}");
    let before = get(&package, c, "inner.force.y");
    step(c, 0);
    assert!((get(&package, c, "inner.force.y") / before - 1.0).abs() < 0.1);
    unsafe { fmi2FreeInstance(c) };
}

/// A ring under a wrench between the bearings of a shaft.
fn rig(keys: &str) -> String {
    let bearing =
        |name: &str, keys: &str| format!("[[bearing]]\nname = \"{name}\"\ncatalogue = \"6205\"\n{keys}\n");
    format!(
        "[shaft]\nspeed = 300\nmass = 1.5\npolar_inertia = 5e-4\ntransverse_inertia = 4e-3\n{}{}{}[load]\nduration = 0.01\n\
         output_interval = 1e-4\n[solver]\nmax_step = 1e-5\n",
        bearing("left", "mounting = { position = -0.06, preload = { force = 300 } }"),
        bearing("right", "mounting = { position = 0.06, direction = \"-x\", preload = { force = 300 } }"),
        bearing(
            "tested",
            &format!(
                "mounting = {{ position = 0.02 }}\n[bearing.set]\nouter = {{ drive = \"wrench\", mass = 0.4, \
                 inertia = [2e-4, 1.2e-4, 1.2e-4] }}\n{keys}"
            )
        ),
    )
}

const CONSTANT: &str = "load.outer = { x = { force = 150 }, z = { force = -1500 } }";

#[test]
fn invariant_inputs_of_an_outer_race_on_a_shaft_are_those_of_its_file() {
    let package = Package::of_system("outer-shaft", &rig(CONSTANT));
    let c = initialising(&package);
    for (name, value) in
        [("applied_force.z", -900.0), ("applied_force.y", 80.0), ("applied_moment.z", 0.4), ("speed", -6.0)]
    {
        set(&package, c, &format!("tested.outer.{name}"), value);
    }
    assert_eq!(unsafe { fmi2ExitInitializationMode(c) }, Status::Ok);
    let file = "load = { outer = { x = { force = 150 }, y = { force = 80 }, z = { force = -900 }, rz = { moment = 0.4 } }, outer_speed = -6 }";
    let mut native = System::new(&scene(&rig(file))).unwrap();
    let same = |c: Component, native: &System| {
        let ring = &native.bearings().nth(2).unwrap().1.outputs().outer;
        for (name, value) in [
            ("outer.position.x", ring.pose.position.x),
            ("outer.position.z", ring.pose.position.z),
            ("outer.velocity.z", ring.twist.velocity.z),
            ("outer.force.z", ring.wrench.force.z),
            ("outer.moment.y", ring.wrench.moment.y),
            ("outer.drive_torque", ring.drive_torque),
        ] {
            let ours = get(&package, c, &format!("tested.{name}"));
            assert!((ours - value).abs() <= 1e-9 * value.abs().max(1e-9), "{name}: {ours} {value}");
        }
        let ours = get(&package, c, "left.inner.force.z");
        let theirs = native.bearings().next().unwrap().1.outputs().inner.wrench.force.z;
        assert!((ours - theirs).abs() <= 1e-9 * theirs.abs(), "{ours} {theirs}");
    };
    same(c, &native);
    for k in 0..10 {
        if k == 3 {
            set(&package, c, "tested.outer.applied_force.z", -2000.0);
            let mut inputs: Vec<_> = native.bearings().map(|(_, bearing)| *bearing.inputs()).collect();
            inputs[2].outer.applied.force.z = -2000.0;
            assert!(native.set_inputs(native.inputs().clone(), inputs));
        }
        step(c, k);
        native.advance_with(f64::from(k) * STEP + STEP, &Played::none(native.scene())).unwrap();
        same(c, &native);
    }
    // What the ring is loaded with, the other bearings carry in the mean: one of them alone some hundred newtons more than before.
    let ring = native.bearings().nth(2).unwrap().1.outputs();
    assert!(ring.outer.pose.position.z < -1e-7, "{}", ring.outer.pose.position.z);
    // Its numbers are parameters.
    let names: Vec<&str> = package.rows.iter().map(|row| row.name.as_str()).collect();
    assert!(names.contains(&"tested.outer.mass") && names.contains(&"tested.outer.inertia.y"));
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_wrench_on_a_shaft_that_a_table_gives_is_played_until_it_is_set_and_replayed_to_the_bit() {
    let table = "load.outer = { x = { force = 150 }, z = { force = [[0, -1500], [\"1 ms\", -500]] } }";
    let package = Package::of_system("outer-shaft-script", &rig(table));
    let c = package.start();
    for k in 0..3 {
        step(c, k);
        let expected = -1500.0 + 100.0 * f64::from(k + 1);
        assert!((get(&package, c, "tested.outer.applied_force.z") - expected).abs() < 1e-6);
    }
    crate::system::replay(&package, c, |c| (3..5).for_each(|k| step(c, k)));
    set(&package, c, "tested.outer.applied_force.z", -700.0);
    step(c, 5);
    assert_eq!(get(&package, c, "tested.outer.applied_force.z"), -700.0);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_derivatives_by_a_wrench_on_a_shaft_are_differences() {
    let package = Package::of_system("outer-shaft-derivatives", &rig(CONSTANT));
    let run = |change: f64| {
        let c = package.start();
        (0..3).for_each(|k| step(c, k));
        set(&package, c, "tested.outer.applied_force.z", -1500.0 + change);
        step(c, 3);
        c
    };
    let [c, plus, minus] = [0.0, 1.0, -1.0].map(run);
    for name in [
        "tested.outer.position.z",
        "tested.inner.force.z",
        "left.inner.force.z",
        "tested.seat.displacement.z",
    ] {
        let (unknown, known) = (package.reference(name), package.reference("tested.outer.applied_force.z"));
        let mut ours = f64::NAN;
        let status = unsafe { fmi2GetDirectionalDerivative(c, &unknown, 1, &known, 1, &1.0, &mut ours) };
        assert_eq!(status, Status::Ok);
        let difference = (get(&package, plus, name) - get(&package, minus, name)) / 2.0;
        assert!((ours / difference - 1.0).abs() < 2e-3 && ours != 0.0, "{name}: {ours:e} {difference:e}");
    }
    for c in [c, plus, minus] {
        unsafe { fmi2FreeInstance(c) };
    }
}
