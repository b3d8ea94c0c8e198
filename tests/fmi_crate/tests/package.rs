//! The package in the fmi crate: its high-level interface runs it, and every function is called through the prototypes
//! that the crate takes from the standard's headers.
#![allow(clippy::unwrap_used, non_snake_case)]

use std::collections::HashMap;
use std::ffi::CString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::ptr;

use fmi::fmi2::binding::{self, Fmi2Binding};
use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common};
use fmi::traits::FmiImport;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// A power of two: sums of steps are exact.
const STEP: f64 = 1.0 / 8192.0;

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

fn references(import: &Fmi2Import) -> HashMap<String, u32> {
    let variables = &import.model_description().model_variables;
    variables.variables.iter().map(|v| (v.name.clone(), v.value_reference)).collect()
}

#[test]
fn the_high_level_interface_gives_the_native_run() {
    let (folder, scene, package) = package("high_level");
    roulement(&["run", &scene, "-o", folder.to_str().unwrap()]);
    let table = std::fs::read_to_string(folder.join("results.csv")).unwrap();
    let mut lines = table.lines();
    let head: Vec<&str> =
        lines.next().unwrap().split(',').map(|name| name.split(" [").next().unwrap()).collect();
    let rows: Vec<HashMap<&str, f64>> = lines
        .map(|line| head.iter().copied().zip(line.split(',').map(|cell| cell.parse().unwrap())).collect())
        .collect();
    assert_eq!(rows.len(), 81);

    let import: Fmi2Import = fmi::import::from_path(&package).unwrap();
    assert_eq!(import.model_description().model_name, "thrust");
    let references = references(&import);
    let names =
        ["inner.force.x", "inner.position.x", "inner.drive_torque", "cage.speed", "energy.dissipated"];
    let wanted = names.map(|name| references[name]);
    let mut bearing = import.instantiate_cs("bearing", false, true).unwrap();
    assert_eq!((bearing.get_version(), bearing.get_types_platform()), ("2.0", "default"));
    bearing.setup_experiment(None, 0.0, None).unwrap();
    bearing.enter_initialization_mode().unwrap();
    bearing.exit_initialization_mode().unwrap();
    for (k, row) in rows.iter().enumerate() {
        if k > 0 {
            bearing.do_step((k - 1) as f64 * STEP, STEP, true).unwrap();
        }
        let mut values = [0.0; 5];
        bearing.get_real(&wanted, &mut values).unwrap();
        assert_eq!(values, names.map(|name| row[name]), "row {k}");
    }
    let mut derivative = [0.0];
    let known = [references["inner.applied_force.x"]];
    bearing
        .get_directional_derivative(&[references["inner.position.x"]], &known, &[1.0], &mut derivative)
        .unwrap();
    assert!(derivative[0] > 0.0);
    assert!(bearing.do_step(1.0, STEP, true).is_err());
    bearing.reset().unwrap();
}

#[test]
fn every_function_answers_through_the_standards_prototypes() {
    let (_, _, package) = package("prototypes");
    let import: Fmi2Import = fmi::import::from_path(&package).unwrap();
    let references = references(&import);
    let library = import.archive_path().join(import.shared_lib_path("thrust").unwrap());
    let callbacks = binding::fmi2CallbackFunctions {
        logger: None,
        allocateMemory: None,
        freeMemory: None,
        stepFinished: None,
        componentEnvironment: ptr::null_mut(),
    };
    let guid = CString::new(import.model_description().guid.as_str()).unwrap();
    let resources = CString::new(import.canonical_resource_path_string()).unwrap();
    let (ok, error, discard) =
        (binding::fmi2Status_fmi2OK, binding::fmi2Status_fmi2Error, binding::fmi2Status_fmi2Discard);
    // SAFETY: the library is a package of ours; all pointers live through their calls.
    unsafe {
        let fmu = Fmi2Binding::new(&library).unwrap();
        let kind = binding::fmi2Type_fmi2CoSimulation;
        let c = fmu.fmi2Instantiate(c"x".as_ptr(), kind, guid.as_ptr(), resources.as_ptr(), &callbacks, 0, 0);
        assert!(!c.is_null());
        assert_eq!(fmu.fmi2SetDebugLogging(c, 1, 1, [c"logStatusError".as_ptr()].as_ptr()), ok);
        assert_eq!(fmu.fmi2SetupExperiment(c, 0, 0.0, 0.0, 1, 1.0), ok);
        assert_eq!(fmu.fmi2EnterInitializationMode(c), ok);
        assert_eq!(fmu.fmi2ExitInitializationMode(c), ok);

        let (force, applied) = (references["inner.force.x"], references["inner.applied_force.x"]);
        let (mut real, mut integer, mut boolean, mut text) = (0.0, 0, 0, ptr::null());
        assert_eq!(fmu.fmi2SetReal(c, &applied, 1, &1400.0), ok);
        assert_eq!(fmu.fmi2GetReal(c, &applied, 1, &mut real), ok);
        assert_eq!(real, 1400.0);
        assert_eq!(fmu.fmi2GetInteger(c, &references["integrator.steps"], 1, &mut integer), ok);
        assert_eq!(integer, 0);
        assert_eq!(fmu.fmi2SetInteger(c, &references["integrator.steps"], 1, &1), error);
        assert_eq!(fmu.fmi2GetBoolean(c, &force, 1, &mut boolean), error);
        assert_eq!(fmu.fmi2SetBoolean(c, &force, 1, &1), error);
        assert_eq!(fmu.fmi2GetString(c, &force, 1, &mut text), error);
        assert_eq!(fmu.fmi2SetString(c, &force, 1, &c"x".as_ptr()), error);

        assert_eq!(fmu.fmi2SetRealInputDerivatives(c, &applied, 1, &1, &0.0), ok);
        assert_eq!(fmu.fmi2DoStep(c, 0.0, STEP, 0), ok);
        assert_eq!(fmu.fmi2GetRealOutputDerivatives(c, &force, 1, &1, &mut real), ok);
        assert!(real.is_finite() && real != 0.0);
        assert_eq!(fmu.fmi2GetDirectionalDerivative(c, &force, 1, &applied, 1, &1.0, &mut real), ok);
        assert!(real.is_finite() && real != 0.0);

        let (mut state, mut copy) = (ptr::null_mut(), ptr::null_mut());
        assert_eq!(fmu.fmi2GetFMUstate(c, &mut state), ok);
        let mut size = 0;
        assert_eq!(fmu.fmi2SerializedFMUstateSize(c, state, &mut size), ok);
        let mut bytes = vec![0; size];
        assert_eq!(fmu.fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr(), size), ok);
        assert_eq!(fmu.fmi2DeSerializeFMUstate(c, bytes.as_ptr(), size, &mut copy), ok);
        assert_eq!(fmu.fmi2DoStep(c, STEP, STEP, 0), ok);
        let mut first = 0.0;
        assert_eq!(fmu.fmi2GetReal(c, &force, 1, &mut first), ok);
        assert_eq!(fmu.fmi2SetFMUstate(c, copy), ok);
        assert_eq!(fmu.fmi2DoStep(c, STEP, STEP, 0), ok);
        assert_eq!(fmu.fmi2GetReal(c, &force, 1, &mut real), ok);
        assert_eq!(real, first);
        assert_eq!(fmu.fmi2FreeFMUstate(c, &mut state), ok);
        assert_eq!(fmu.fmi2FreeFMUstate(c, &mut copy), ok);
        assert!(state.is_null() && copy.is_null());

        let time = binding::fmi2StatusKind_fmi2LastSuccessfulTime;
        assert_eq!(fmu.fmi2GetRealStatus(c, time, &mut real), ok);
        assert_eq!(real, 2.0 * STEP);
        let terminated = binding::fmi2StatusKind_fmi2Terminated;
        assert_eq!(fmu.fmi2GetBooleanStatus(c, terminated, &mut boolean), ok);
        assert_eq!(boolean, 0);
        let mut status = ok;
        assert_eq!(fmu.fmi2GetStatus(c, binding::fmi2StatusKind_fmi2DoStepStatus, &mut status), discard);
        assert_eq!(fmu.fmi2GetIntegerStatus(c, time, &mut integer), discard);
        assert_eq!(fmu.fmi2GetStringStatus(c, binding::fmi2StatusKind_fmi2PendingStatus, &mut text), discard);
        assert_eq!(fmu.fmi2CancelStep(c), error);
        assert_eq!(fmu.fmi2Terminate(c), ok);
        assert_eq!(fmu.fmi2Reset(c), ok);
        fmu.fmi2FreeInstance(c);
    }
}
