//! The package in fmi-rs, by the makers of FMPy: its interface runs it, one instance and two, and every function is called
//! through the types that the crate has of the standard's functions.
#![allow(clippy::unwrap_used, non_snake_case)]

use std::collections::HashMap;
use std::ffi::CString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::ptr;
use std::sync::Arc;

use fmi_rs::fmi2::builder::FMU2Builder;
use fmi_rs::fmi2::types::*;
use fmi_rs::fmi2::{CS, FMU2};
use libloading::Library;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// A power of two: sums of steps are exact.
const STEP: f64 = 1.0 / 8192.0;
const NAMES: [&str; 5] =
    ["inner.force.x", "inner.position.x", "inner.drive_torque", "cage.speed", "energy.dissipated"];

fn roulement(arguments: &[&str]) {
    let program = std::env::var("ROULEMENT_BIN").expect("ROULEMENT_BIN names the roulement program to test");
    assert!(Command::new(program).args(arguments).status().unwrap().success());
}

/// The thrust case with exact steps, in a folder of its own: scene and package.
fn package(name: &str) -> (PathBuf, String, String) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    let text = std::fs::read_to_string(format!("{ROOT}/scenes/thrust.toml")).unwrap();
    let text = text.replace("\"50 ms\"", "0.009765625").replace("\"100 us\"", "0.0001220703125");
    let [scene, package] = ["thrust.toml", "thrust.fmu"].map(|file| folder.join(file).display().to_string());
    std::fs::write(&scene, text).unwrap();
    roulement(&["fmu", &scene, "-o", &package]);
    (folder, scene, package)
}

fn references(package: &FMU2Builder) -> HashMap<String, u32> {
    let variables = &package.model_description.modelVariables;
    variables.iter().map(|v| (v.name.clone(), v.valueReference)).collect()
}

fn ok(status: fmi2Status) {
    assert_eq!(status, fmi2Status::Ok);
}

/// An instance at time 0.
fn started(package: &FMU2Builder, name: &str) -> Arc<FMU2<CS>> {
    let bearing = package.instantiate_cs(name).unwrap();
    ok(bearing.setupExperiment(None, 0.0, None));
    ok(bearing.enterInitializationMode());
    ok(bearing.exitInitializationMode());
    bearing
}

fn values(bearing: &FMU2<CS>, references: &HashMap<String, u32>) -> [f64; 5] {
    let mut values = [0.0; 5];
    ok(bearing.getReal(&NAMES.map(|name| references[name]), &mut values));
    values
}

/// The rows of a native run of the scene, in the order of the names.
fn native(folder: &Path, scene: &str) -> Vec<[f64; 5]> {
    roulement(&["run", scene, "-o", folder.to_str().unwrap(), "--steps-end-at-rows"]);
    let table = std::fs::read_to_string(folder.join("results.csv")).unwrap();
    let mut lines = table.lines();
    let head: Vec<&str> =
        lines.next().unwrap().split(',').map(|name| name.split(" [").next().unwrap()).collect();
    let columns = NAMES.map(|name| head.iter().position(|column| *column == name).unwrap());
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            columns.map(|column| cells[column].parse().unwrap())
        })
        .collect()
}

#[test]
fn the_interface_gives_the_native_run() {
    let (folder, scene, package) = package("interface");
    let rows = native(&folder, &scene);
    assert_eq!(rows.len(), 81);
    let package = FMU2Builder::new(&package).unwrap();
    assert_eq!(package.model_description.modelName, "thrust");
    let references = references(&package);
    let bearing = started(&package, "bearing");
    assert_eq!((bearing.getVersion().as_str(), bearing.getTypesPlatform().as_str()), ("2.0", "default"));
    for (k, row) in rows.iter().enumerate() {
        if k > 0 {
            ok(bearing.doStep((k - 1) as f64 * STEP, STEP, fmi2True));
        }
        assert_eq!(values(&bearing, &references), *row, "row {k}");
    }
    let mut derivative = [0.0];
    let (unknown, known) = ([references["inner.position.x"]], [references["inner.applied_force.x"]]);
    ok(bearing.getDirectionalDerivative(&unknown, &known, &[1.0], &mut derivative));
    assert!(derivative[0] > 0.0);
    assert_eq!(bearing.doStep(1.0, STEP, fmi2True), fmi2Status::Error);
    ok(bearing.reset());
}

#[test]
fn two_instances_under_loads_of_their_own_run_as_each_alone() {
    let (_, _, package) = package("two");
    let package = FMU2Builder::new(&package).unwrap();
    let references = references(&package);
    let force = [references["inner.applied_force.x"]];
    let step = |bearing: &FMU2<CS>, k: u32, load: f64| {
        ok(bearing.setReal(&force, &[load]));
        ok(bearing.doStep(f64::from(k) * STEP, STEP, fmi2True));
        values(bearing, &references)
    };
    let alone = [1500.0, 900.0].map(|load| {
        let bearing = started(&package, "alone");
        (0..20).map(|k| step(&bearing, k, load)).collect::<Vec<_>>()
    });
    let (left, right) = (started(&package, "left"), started(&package, "right"));
    for k in 0..20 {
        assert_eq!(step(&left, k, 1500.0), alone[0][k as usize]);
        assert_eq!(step(&right, k, 900.0), alone[1][k as usize]);
    }
    assert_ne!(alone[0], alone[1]);
}

/// Keeps nothing: messages are the business of other tests.
unsafe extern "C" fn deaf(
    _: fmi2ComponentEnvironment,
    _: fmi2String,
    _: fmi2Status,
    _: fmi2String,
    _: fmi2String,
) {
}

#[test]
fn every_function_answers_through_the_types_of_the_crate() {
    let (_, _, package) = package("prototypes");
    let package = FMU2Builder::new(&package).unwrap();
    let references = references(&package);
    let folder = package.unzipdir.path();
    let library = folder.join("binaries").join("linux64").join("thrust.so");
    let callbacks = fmi2CallbackFunctions {
        logger: deaf,
        allocateMemory: None,
        freeMemory: None,
        stepFinished: None,
        componentEnvironment: ptr::null_mut(),
    };
    let guid = CString::new(package.model_description.guid.as_str()).unwrap();
    let resources = CString::new(format!("file://{}", folder.join("resources").display())).unwrap();
    let (accepted, error, discard) = (fmi2Status::Ok, fmi2Status::Error, fmi2Status::Discard);
    // SAFETY: the library is a package of ours; all pointers live through their calls.
    unsafe {
        let library = Library::new(&library).unwrap();
        macro_rules! function {
            ($name:ident: $kind:ty) => {
                let $name = *library.get::<$kind>(stringify!($name).as_bytes()).unwrap();
            };
        }
        function!(fmi2CancelStep: fmi2CancelStepTYPE);
        function!(fmi2DeSerializeFMUstate: fmi2DeSerializeFMUstateTYPE);
        function!(fmi2DoStep: fmi2DoStepTYPE);
        function!(fmi2EnterInitializationMode: fmi2EnterInitializationModeTYPE);
        function!(fmi2ExitInitializationMode: fmi2ExitInitializationModeTYPE);
        function!(fmi2FreeFMUstate: fmi2FreeFMUstateTYPE);
        function!(fmi2FreeInstance: fmi2FreeInstanceTYPE);
        function!(fmi2GetBoolean: fmi2GetBooleanTYPE);
        function!(fmi2GetBooleanStatus: fmi2GetBooleanStatusTYPE);
        function!(fmi2GetDirectionalDerivative: fmi2GetDirectionalDerivativeTYPE);
        function!(fmi2GetFMUstate: fmi2GetFMUstateTYPE);
        function!(fmi2GetInteger: fmi2GetIntegerTYPE);
        function!(fmi2GetIntegerStatus: fmi2GetIntegerStatusTYPE);
        function!(fmi2GetReal: fmi2GetRealTYPE);
        function!(fmi2GetRealOutputDerivatives: fmi2GetRealOutputDerivativesTYPE);
        function!(fmi2GetRealStatus: fmi2GetRealStatusTYPE);
        function!(fmi2GetStatus: fmi2GetStatusTYPE);
        function!(fmi2GetString: fmi2GetStringTYPE);
        function!(fmi2GetStringStatus: fmi2GetStringStatusTYPE);
        function!(fmi2Instantiate: fmi2InstantiateTYPE);
        function!(fmi2Reset: fmi2ResetTYPE);
        function!(fmi2SerializeFMUstate: fmi2SerializeFMUstateTYPE);
        function!(fmi2SerializedFMUstateSize: fmi2SerializedFMUstateSizeTYPE);
        function!(fmi2SetBoolean: fmi2SetBooleanTYPE);
        function!(fmi2SetDebugLogging: fmi2SetDebugLoggingTYPE);
        function!(fmi2SetFMUstate: fmi2SetFMUstateTYPE);
        function!(fmi2SetInteger: fmi2SetIntegerTYPE);
        function!(fmi2SetReal: fmi2SetRealTYPE);
        function!(fmi2SetRealInputDerivatives: fmi2SetRealInputDerivativesTYPE);
        function!(fmi2SetString: fmi2SetStringTYPE);
        function!(fmi2SetupExperiment: fmi2SetupExperimentTYPE);
        function!(fmi2Terminate: fmi2TerminateTYPE);
        let c = fmi2Instantiate(
            c"x".as_ptr(),
            fmi2Type::CoSimulation,
            guid.as_ptr(),
            resources.as_ptr(),
            &callbacks,
            0,
            0,
        );
        assert!(!c.is_null());
        assert_eq!(fmi2SetDebugLogging(c, 1, 1, [c"logStatusError".as_ptr()].as_ptr()), accepted);
        assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 1, 1.0), accepted);
        assert_eq!(fmi2EnterInitializationMode(c), accepted);
        assert_eq!(fmi2ExitInitializationMode(c), accepted);

        let (force, applied) = (references["inner.force.x"], references["inner.applied_force.x"]);
        let (mut real, mut integer, mut boolean, mut text) = (0.0, 0, 0, ptr::null());
        assert_eq!(fmi2SetReal(c, &applied, 1, &1400.0), accepted);
        assert_eq!(fmi2GetReal(c, &applied, 1, &mut real), accepted);
        assert_eq!(real, 1400.0);
        assert_eq!(fmi2GetInteger(c, &references["integrator.steps"], 1, &mut integer), accepted);
        assert_eq!(integer, 0);
        assert_eq!(fmi2SetInteger(c, &references["integrator.steps"], 1, &1), error);
        assert_eq!(fmi2GetBoolean(c, &force, 1, &mut boolean), error);
        assert_eq!(fmi2SetBoolean(c, &force, 1, &1), error);
        assert_eq!(fmi2GetString(c, &force, 1, &mut text), error);
        assert_eq!(fmi2SetString(c, &force, 1, &c"x".as_ptr()), error);

        assert_eq!(fmi2SetRealInputDerivatives(c, &applied, 1, &1, &0.0), accepted);
        assert_eq!(fmi2DoStep(c, 0.0, STEP, 0), accepted);
        assert_eq!(fmi2GetRealOutputDerivatives(c, &force, 1, &1, &mut real), accepted);
        assert!(real.is_finite() && real != 0.0);
        assert_eq!(fmi2GetDirectionalDerivative(c, &force, 1, &applied, 1, &1.0, &mut real), accepted);
        assert!(real.is_finite() && real != 0.0);

        let (mut state, mut copy) = (ptr::null_mut(), ptr::null_mut());
        assert_eq!(fmi2GetFMUstate(c, &mut state), accepted);
        let mut size = 0;
        assert_eq!(fmi2SerializedFMUstateSize(c, state, &mut size), accepted);
        let mut bytes = vec![0; size];
        assert_eq!(fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr(), size), accepted);
        assert_eq!(fmi2DeSerializeFMUstate(c, bytes.as_ptr(), size, &mut copy), accepted);
        assert_eq!(fmi2DoStep(c, STEP, STEP, 0), accepted);
        let mut first = 0.0;
        assert_eq!(fmi2GetReal(c, &force, 1, &mut first), accepted);
        assert_eq!(fmi2SetFMUstate(c, copy), accepted);
        assert_eq!(fmi2DoStep(c, STEP, STEP, 0), accepted);
        assert_eq!(fmi2GetReal(c, &force, 1, &mut real), accepted);
        assert_eq!(real, first);
        assert_eq!(fmi2FreeFMUstate(c, &mut state), accepted);
        assert_eq!(fmi2FreeFMUstate(c, &mut copy), accepted);
        assert!(state.is_null() && copy.is_null());

        let time = fmi2StatusKind::LastSuccessfulTime;
        assert_eq!(fmi2GetRealStatus(c, time, &mut real), accepted);
        assert_eq!(real, 2.0 * STEP);
        let terminated = fmi2StatusKind::Terminated;
        assert_eq!(fmi2GetBooleanStatus(c, terminated, &mut boolean), accepted);
        assert_eq!(boolean, 0);
        let mut status = accepted;
        assert_eq!(fmi2GetStatus(c, fmi2StatusKind::DoStepStatus, &mut status), discard);
        assert_eq!(fmi2GetIntegerStatus(c, time, &mut integer), discard);
        assert_eq!(fmi2GetStringStatus(c, fmi2StatusKind::PendingStatus, &mut text), discard);
        assert_eq!(fmi2CancelStep(c), error);
        assert_eq!(fmi2Terminate(c), accepted);
        assert_eq!(fmi2Reset(c), accepted);
        fmi2FreeInstance(c);
    }
}
