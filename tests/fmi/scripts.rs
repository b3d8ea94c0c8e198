//! Scripts of the scene in its package, the stop time, foreign states, and messages as a C importer shows them.
#![allow(clippy::missing_transmute_annotations)] // the type of the logger stands beside

use std::f64::consts::{PI, TAU};
use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr;
use std::sync::Mutex;

use roulement::Simulation;
use roulement::fmi::v2::{CallbackFunctions, Status};
use roulement::scene::Scene;

use crate::fmi2_abi::*;

/// Messages of an instance: status and text.
type Messages = Mutex<Vec<(Status, String)>>;

unsafe extern "C" {
    fn snprintf(buffer: *mut c_char, size: usize, format: *const c_char, ...) -> c_int;
}

/// A logger in C's manner: the message is a format.
unsafe extern "C" fn logger(
    environment: *mut c_void,
    _instance: *const c_char,
    status: Status,
    _category: *const c_char,
    message: *const c_char,
) {
    let mut buffer = [0 as c_char; 1024];
    unsafe {
        snprintf(buffer.as_mut_ptr(), buffer.len(), message);
        let text = CStr::from_ptr(buffer.as_ptr()).to_string_lossy().into_owned();
        (*environment.cast::<Messages>()).lock().unwrap().push((status, text));
    }
}

/// A package whose messages are kept.
fn package(name: &str, text: &str) -> (Package, &'static Messages) {
    let messages: &'static Messages = Box::leak(Box::default());
    let mut package = Package::new(name, text);
    package.callbacks = CallbackFunctions {
        // A function without variable arguments, called with the leading ones alone: the same call on x86-64 and aarch64.
        logger: Some(unsafe { std::mem::transmute::<*const (), _>(logger as *const ()) }),
        component_environment: ptr::from_ref(messages).cast_mut().cast(),
        ..package.callbacks
    };
    (package, messages)
}

fn start(package: &Package, begin: f64, stop: Option<f64>) -> Component {
    let c = package.instantiate();
    unsafe {
        assert_eq!(fmi2SetDebugLogging(c, 1, 0, ptr::null()), Status::Ok);
        let status = fmi2SetupExperiment(c, 0, 0.0, begin, stop.is_some().into(), stop.unwrap_or(0.0));
        assert_eq!(status, Status::Ok);
        assert_eq!(fmi2EnterInitializationMode(c), Status::Ok);
        assert_eq!(fmi2ExitInitializationMode(c), Status::Ok);
    }
    c
}

fn set(c: Component, package: &Package, name: &str, value: f64) {
    assert_eq!(unsafe { fmi2SetReal(c, &package.reference(name), 1, &value) }, Status::Ok);
}

fn get(c: Component, package: &Package, name: &str) -> f64 {
    real(c, package.reference(name))
}

/// Messages of one status with a word in them.
fn count(messages: &Messages, status: Status, word: &str) -> usize {
    messages.lock().unwrap().iter().filter(|(of, text)| *of == status && text.contains(word)).count()
}

fn scripted(drive: &str, changes: &[(&str, &str)]) -> String {
    Scene::edited(&scene_text(drive), changes.iter().copied()).unwrap().source
}

const TABLES: [(&str, &str); 4] = [
    ("load.x.force", "[[0, 600], [\"1 ms\", 1500]]"),
    ("load.inner_speed", "[[0, 600], [\"1 ms\", 700]]"),
    ("friction.ball_race", "[[0, 0.08], [\"1 ms\", 0.02]]"),
    ("outer.misalignment.ry", "[[0, 0], [\"1 ms\", 1e-4]]"),
];

#[test]
fn a_package_with_an_error_goal_says_that_it_runs_once() {
    for (solver, told) in [("{ accuracy = { error = 1e-3 } }", 1), ("{ accuracy = \"balanced\" }", 0)] {
        let (package, messages) = package("goal", &scripted("wrench", &[("solver", solver)]));
        let c = start(&package, 0.0, None);
        assert_eq!(count(messages, Status::Ok, "solver.accuracy.error = 1e-3: this package runs once"), told);
        unsafe { fmi2FreeInstance(c) };
    }
}

/// A ring that one bearing does not hold (docs/holding-a-bearing.md), for a while after it was told.
#[test]
fn a_package_warns_once_of_a_motion_that_loads_do_not_explain() {
    let text = include_str!("../../scenes/error/high_speed.toml");
    for (text, told) in [(text.to_string(), 1), (text.replace("65217 rpm", "6000 rpm"), 0)] {
        let (package, messages) = package("whirls", &text);
        let c = start(&package, 0.0, None);
        for point in 0..400 {
            assert_eq!(unsafe { fmi2DoStep(c, f64::from(point) * 2e-5, 2e-5, 0) }, Status::Ok);
        }
        assert_eq!(count(messages, Status::Warning, "the inner race goes round forwards by up to"), told);
        unsafe { fmi2FreeInstance(c) };
    }
}

#[test]
fn invariant_a_package_plays_the_scripts_as_a_native_run_does() {
    let text = scripted("wrench", &TABLES);
    let (package, messages) = package("plays", &text);
    let c = start(&package, 0.0, None);
    for group in ["loads", "speeds", "friction"] {
        assert_eq!(count(messages, Status::Ok, &format!("script of {group} is played")), 1);
    }
    let mut native = Simulation::new(&Scene::parse(&text).unwrap()).unwrap();
    for point in 0..12 {
        let (time, end) = (f64::from(point) * 1e-4, f64::from(point + 1) * 1e-4);
        assert_eq!(unsafe { fmi2DoStep(c, time, end - time, 0) }, Status::Ok);
        native.advance_scripted(time + (end - time)).unwrap();
        let outputs = native.outputs();
        assert_eq!(get(c, &package, "inner.force.x"), outputs.inner.wrench.force.x);
        assert_eq!(get(c, &package, "friction_torque"), outputs.friction_torque);
        let s = (native.time() / 1e-3).min(1.0);
        for (name, expected) in [
            ("inner.applied_force.x", 600.0 + 900.0 * s),
            ("inner.speed", 600.0 + 100.0 * s),
            ("friction", 0.08 - 0.06 * s),
        ] {
            assert!((get(c, &package, name) - expected).abs() < 1e-10 * expected, "{name}");
        }
    }
    // Exported once, not at every step.
    assert_eq!(messages.lock().unwrap().iter().filter(|(_, text)| text.contains("script")).count(), 3);
    unsafe { fmi2FreeInstance(c) };
}

/// Every building block, gears and unbalance; friction and oil among them.
const BLOCKS: [(&str, &str); 9] = [
    ("load.y.force", "{ ramp = [0, 100], from = 0.0002, to = 0.0005 }"),
    ("load.z.force", "{ sum = [20, { amplitude = 10, frequency = 3000, begin = 0.00015 }] }"),
    ("load.x.force", "{ table = [[0, 0.6], [0.001, 1.5]], unit = \"kN\" }"),
    ("friction.ball_race", "{ step = [0.08, 0.02], at = 0.0004 }"),
    (
        "film",
        "{ iso_vg = 68, temperature = 70, lubrication = { mean = 0.5, amplitude = 0.5, frequency = 1000 } }",
    ),
    ("load.inner_speed", "{ mean = 650, amplitude = 50, frequency = 500, phase = -1.5707963267948966 }"),
    ("outer.misalignment.ry", "{ ramp = [0, 1e-4], to = 0.001 }"),
    (
        "load.gear",
        "[{ torque = { ramp = [1, 3], to = 0.001 }, pitch_radius = 0.0238, pressure_angle = 0.35, helix_angle = -0.26, \
         teeth = 23, ripple = 0.1, offset = 0.01 }]",
    ),
    ("load.rotating", "[{ unbalance = 1e-4, offset = -0.01 }]"),
];

#[test]
fn invariant_a_package_plays_building_blocks_as_a_native_run_does() {
    let text = scripted("wrench", &BLOCKS);
    let (package, messages) = package("blocks", &text);
    let c = start(&package, 0.0, None);
    for group in ["loads", "speeds", "friction", "lubrication"] {
        assert_eq!(count(messages, Status::Ok, &format!("script of {group} is played")), 1, "{group}");
    }
    let mut native = Simulation::new(&Scene::parse(&text).unwrap()).unwrap();
    let names = ["x", "y", "z"];
    for point in 0..10 {
        // What the inputs are by default, at the start too.
        let (given, outputs) = (native.inputs().inner.applied, native.outputs());
        for (axis, name) in names.into_iter().enumerate() {
            assert_eq!(
                get(c, &package, &format!("inner.applied_force.{name}")),
                given.force[axis],
                "{point}"
            );
            assert_eq!(get(c, &package, &format!("inner.force.{name}")), outputs.inner.wrench.force[axis]);
        }
        assert_eq!(get(c, &package, "inner.applied_moment.y"), given.moment.y, "{point}");
        assert_eq!(get(c, &package, "friction"), native.inputs().friction);
        assert_eq!(get(c, &package, "lubrication"), native.inputs().effects.lubrication);
        assert_eq!(get(c, &package, "friction_torque"), outputs.friction_torque);
        let (time, end) = (f64::from(point) * 1e-4, f64::from(point + 1) * 1e-4);
        assert_eq!(unsafe { fmi2DoStep(c, time, end - time, 0) }, Status::Ok);
        native.advance_scripted(time + (end - time)).unwrap();
    }
    // By hand at the end: ramp, sine since 0.15 ms, and the mesh at y = r.
    let (time, speed) = (native.time(), |t: f64| 650.0 * t - 50.0 / (1000.0 * PI) * (1000.0 * PI * t).sin());
    let torque = (1.0 + 2000.0 * time) * (1.0 + 0.1 * (23.0 * speed(time)).sin());
    let mesh = torque / 0.0238;
    let omega = 650.0 - 50.0 * (1000.0 * PI * time).cos();
    let slowing = 50.0 * 1000.0 * PI * (1000.0 * PI * time).sin();
    let (sin, cos) = speed(time).sin_cos();
    let z = 20.0
        + 10.0 * (TAU * 3000.0 * (time - 1.5e-4)).sin()
        + mesh
        + 1e-4 * (omega * omega * sin - slowing * cos);
    assert!((get(c, &package, "inner.applied_force.z") / z - 1.0).abs() < 1e-12, "{z}");
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_package_of_a_measured_file_needs_no_file() {
    let folder = std::env::temp_dir().join(format!("roulement-fmi2-measured-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("m.csv"), "t [us],F [kN]\n0,0.6\n250,0.9\n400,0.7\n").unwrap();
    let file = "{ file = \"m.csv\", time = \"t [us]\", value = \"F [kN]\" }";
    let text = Scene::edited_text(&scene_text("wrench"), [("load.x.force", file)]).unwrap();
    std::fs::write(folder.join("scene.toml"), text).unwrap();
    let scene = Scene::load(&folder.join("scene.toml")).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let package = Package::new("measured", &scene.source);
    let c = package.start();
    let mut native = Simulation::new(&scene).unwrap();
    for point in 0..5 {
        let time = f64::from(point) * 1e-4;
        assert_eq!(unsafe { fmi2DoStep(c, time, 1e-4, 0) }, Status::Ok);
        native.advance_scripted(time + 1e-4).unwrap();
        assert_eq!(get(c, &package, "inner.force.x"), native.outputs().inner.wrench.force.x);
        let s = native.time();
        let expected =
            if s <= 2.5e-4 { 600.0 + 1.2e6 * s } else { (900.0 - 200.0 * (s - 2.5e-4) / 1.5e-4).max(700.0) };
        assert!((get(c, &package, "inner.applied_force.x") / expected - 1.0).abs() < 1e-12, "{s}");
    }
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_an_input_that_is_set_ends_the_script_of_its_group() {
    let text = scripted("wrench", &TABLES);
    let (package, messages) = package("ends", &text);
    let c = start(&package, 0.0, None);
    unsafe { assert_eq!(fmi2DoStep(c, 0.0, 5e-4, 0), Status::Ok) };
    let mut sum = 0.0;
    for point in 0..20 {
        set(c, &package, "inner.applied_force.x", 900.0);
        let time = 5e-4 + f64::from(point) * 1e-4;
        unsafe { assert_eq!(fmi2DoStep(c, time, 1e-4, 0), Status::Ok) };
        sum += get(c, &package, "inner.force.x");
    }
    assert_eq!(get(c, &package, "inner.applied_force.x"), 900.0);
    // The race swings about the load that was set, not about the 1500 N of the script.
    assert!((sum / 20.0 + 900.0).abs() < 200.0, "{}", sum / 20.0);
    // The other groups go on.
    assert_eq!((get(c, &package, "inner.speed"), get(c, &package, "friction")), (700.0, 0.02));
    assert_eq!(
        count(messages, Status::Warning, "script of loads ends at 0.0005 s: inner.applied_force.x was set"),
        1
    );
    assert_eq!(count(messages, Status::Warning, ""), 1);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_the_key_leaves_a_group_to_the_master() {
    let tilt = ("load.ry.rotation", "[[0, 0], [\"1 ms\", 3e-3]]");
    let moment = |givers: &[(&str, &str)]| {
        let (package, messages) =
            package(&format!("key{}", givers.len()), &scripted("pose", &[&[tilt], givers].concat()));
        let c = start(&package, 0.0, None);
        for point in 0..20 {
            let status = unsafe { fmi2DoStep(c, f64::from(point) * 1e-4, 1e-4, 0) };
            assert_eq!(status, Status::Ok);
        }
        let (moment, axis) = (get(c, &package, "inner.moment.y"), get(c, &package, "inner.rotation.y"));
        let told = count(messages, Status::Ok, "interface.inputs.tilts = \"master\"");
        unsafe { fmi2FreeInstance(c) };
        (moment.abs(), axis, told)
    };
    let (scene, axis, told) = moment(&[]);
    assert!(scene > 1.0 && axis.abs() > 1e-5 && told == 0, "{scene} {axis}");
    let (master, axis, told) = moment(&[("interface.inputs.tilts", "\"master\"")]);
    assert!(master < 0.5 * scene && axis.abs() < 1e-9 && told == 1, "{master} {axis}");
    // Only what is an input can be left to the master.
    let refused = Scene::edited(&scene_text("pose"), [("interface.inputs.loads", "\"master\"")]).unwrap_err();
    assert!(refused.to_string().contains("interface.inputs.loads"), "{refused}");
}

#[test]
fn invariant_a_package_started_late_is_where_the_script_is() {
    let (package, _) =
        package("late", &scripted("pose", &[("load.ry.rotation", "[[0, 0], [\"1 ms\", 3e-3]]")]));
    let c = start(&package, 0.02, None);
    let before = get(c, &package, "inner.moment.y");
    assert!((get(c, &package, "inner.rotation.y") - 3e-3).abs() < 1e-6);
    assert_eq!(unsafe { fmi2DoStep(c, 0.02, 1e-5, 0) }, Status::Ok);
    assert!((get(c, &package, "inner.moment.y") / before - 1.0).abs() < 0.05 && before.abs() > 1.0);
    assert!(get(c, &package, "inner.rotation_rate.y").abs() < 5e-3);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_step_past_the_stop_time_is_an_error() {
    let (package, messages) = package("stop", &scene_text("wrench"));
    let c = start(&package, 0.0, Some(1e-3));
    for point in 0..10 {
        // Ten rounded tenths are no step past the stop time.
        assert_eq!(unsafe { fmi2DoStep(c, f64::from(point) * 1e-4, 1e-4, 0) }, Status::Ok);
    }
    assert_eq!(unsafe { fmi2DoStep(c, 1e-3, 1e-4, 0) }, Status::Error);
    assert_eq!(count(messages, Status::Error, "beyond the stop time 0.001 s"), 1);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_state_of_another_scene_is_refused_with_the_reason() {
    let (one, _) = package("state-one", &scene_text("wrench"));
    // The same variables and the same shape of state.
    let (other, messages) = package("state-other", &scene_text("wrench").replace("600 N", "700 N"));
    let (a, b) = (start(&one, 0.0, None), start(&other, 0.0, None));
    unsafe {
        let mut state = ptr::null_mut();
        assert_eq!(fmi2GetFMUstate(a, &mut state), Status::Ok);
        assert_eq!(fmi2SetFMUstate(b, state), Status::Error);
        assert_eq!(count(messages, Status::Error, "of another scene"), 1);
        assert_eq!(count(messages, Status::Error, one.guid.to_str().unwrap()), 1);
        let mut size = 0;
        assert_eq!(fmi2SerializedFMUstateSize(b, state, &mut size), Status::Error);
        assert_eq!(fmi2SetFMUstate(a, state), Status::Ok);
        let bytes = state_bytes(a);
        let mut read = ptr::null_mut();
        assert_eq!(fmi2DeSerializeFMUstate(b, bytes.as_ptr(), bytes.len(), &mut read), Status::Error);
        assert_eq!(count(messages, Status::Error, "another package"), 1);
        assert_eq!(fmi2DeSerializeFMUstate(a, bytes.as_ptr(), bytes.len(), &mut read), Status::Ok);
        assert_eq!(fmi2SetFMUstate(a, read), Status::Ok);
        fmi2FreeInstance(a);
        fmi2FreeInstance(b);
    }
}

#[test]
fn invariant_a_percent_sign_stays_one() {
    let (package, messages) = package("percent", &scene_text("wrench"));
    let made = unsafe {
        fmi2Instantiate(
            c"x".as_ptr(),
            1,
            package.guid.as_ptr(),
            c"http://a/100%d#1".as_ptr(),
            &package.callbacks,
            0,
            0,
        )
    };
    assert!(made.is_null());
    // Two hashes are one in a message.
    assert_eq!(count(messages, Status::Error, "\"http://a/100%d##1\" is not a file: URI"), 1);
}

#[test]
fn a_package_says_which_effects_are_on_and_which_would_matter() {
    let (package, messages) = package("effects", &scene_text("wrench"));
    let c = start(&package, 0.0, None);
    assert_eq!(count(messages, Status::Ok, "effects on: creep"), 1);
    assert_eq!(count(messages, Status::Ok, "off, would matter: growth by temperature: 10 K"), 1);
    assert_eq!(count(messages, Status::Ok, "off, would matter: rolling resistance"), 1);
    unsafe { fmi2FreeInstance(c) };
    // Without logging nothing is estimated and nothing told.
    messages.lock().unwrap().clear();
    let c = package.instantiate();
    unsafe {
        assert_eq!(fmi2SetDebugLogging(c, 0, 0, ptr::null()), Status::Ok);
        assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
        assert_eq!(fmi2EnterInitializationMode(c), Status::Ok);
        assert_eq!(fmi2ExitInitializationMode(c), Status::Ok);
        fmi2FreeInstance(c);
    }
    assert_eq!(count(messages, Status::Ok, "effects on"), 0);
}

#[test]
fn a_package_runs_with_the_effects_that_were_found_out() {
    let asked =
        scripted("wrench", &[("effects", "{ auto = true, auto_threshold = 1e-6, creep = \"saturated\" }")]);
    let (scene, notes) = roulement::analysis::auto::resolve(Scene::parse(&asked).unwrap()).unwrap();
    assert!(notes.iter().any(|note| note.starts_with("auto: effects.heathcote_slip = true")), "{notes:?}");
    let (package, messages) = package("auto", &scene.source);
    let c = start(&package, 0.0, None);
    assert_eq!(count(messages, Status::Ok, "heathcote_slip (on)"), 1);
    assert!(get(c, &package, "power.groove") > 0.0);
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn regression_a_start_outside_the_scripts_is_told() {
    let (plays, plain) = (scripted("wrench", &TABLES), scripted("wrench", &[]));
    let duration = Scene::parse(&plays).unwrap().load.duration.0;
    for (text, begin, told) in
        [(&plays, 0.5 * duration, 0), (&plays, 1000.0, 1), (&plays, -1.0, 1), (&plain, 1000.0, 0)]
    {
        let (package, messages) = package("outside", text);
        let c = start(&package, begin, None);
        assert_eq!(count(messages, Status::Warning, "is outside the scene's scripts"), told, "{begin}");
        unsafe { fmi2FreeInstance(c) };
    }
}
