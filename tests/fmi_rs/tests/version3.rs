//! The package of FMI 3.0 in fmi-rs: its interface runs it as that of 2.0, and functions are called through the types that the crate has.
#![allow(clippy::unwrap_used, non_snake_case)]

use std::collections::HashMap;
use std::path::Path;
use std::process::Command;
use std::ptr;

use fmi_rs::fmi2::builder::FMU2Builder;
use fmi_rs::fmi2::types::{fmi2Status, fmi2True};
use fmi_rs::fmi3::builder::FMU3Builder;
use fmi_rs::fmi3::types::*;
use libloading::Library;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// A power of two: sums of steps are exact.
const STEP: f64 = 1.0 / 8192.0;
const NAMES: [&str; 5] =
    ["inner.force.x", "inner.position.x", "inner.drive_torque", "cage.speed", "energy.dissipated"];

/// The thrust case as a package of a version.
fn package(name: &str, version: &str) -> String {
    let program = std::env::var("ROULEMENT_BIN").expect("ROULEMENT_BIN names the roulement program to test");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}{version}"));
    std::fs::create_dir_all(&folder).unwrap();
    let package = folder.join("thrust.fmu").display().to_string();
    let scene = format!("{ROOT}/scenes/thrust.toml");
    let arguments = ["fmu", &scene, "-o", &package, "--fmi", version];
    assert!(Command::new(program).args(arguments).status().unwrap().success());
    package
}

fn ok(status: fmi3Status) {
    assert_eq!(status, fmi3Status::Ok);
}

#[test]
fn the_interface_of_3_0_gives_the_numbers_of_2_0() {
    let (second, third) = (package("alike", "2"), package("alike", "3"));
    let (second, third) = (FMU2Builder::new(&second).unwrap(), FMU3Builder::new(&third).unwrap());
    let variables = &second.model_description.modelVariables;
    // Rows have the same references in both.
    let references: HashMap<_, _> = variables.iter().map(|v| (v.name.clone(), v.valueReference)).collect();
    let references = NAMES.map(|name| references[name]);
    let (one, other) = (second.instantiate_cs("second").unwrap(), third.instantiate_cs("third").unwrap());
    assert_eq!(other.getVersion(), "3.0");
    for status in [
        one.setupExperiment(None, 0.0, None),
        one.enterInitializationMode(),
        one.exitInitializationMode(),
    ] {
        assert_eq!(status, fmi2Status::Ok);
    }
    ok(other.enterInitializationMode(None, 0.0, None));
    ok(other.exitInitializationMode());
    for k in 0..40 {
        let time = f64::from(k) * STEP;
        assert_eq!(one.doStep(time, STEP, fmi2True), fmi2Status::Ok);
        let (mut event, mut end, mut early, mut reached) = (true, true, true, 0.0);
        ok(other.doStep(time, STEP, true, &mut event, &mut end, &mut early, &mut reached));
        assert_eq!((event, end, early, reached), (false, false, false, time + STEP));
        let (mut first, mut values) = ([0.0; 5], [1.0; 5]);
        assert_eq!(one.getReal(&references, &mut first), fmi2Status::Ok);
        ok(other.getFloat64(&references, &mut values));
        assert_eq!(first, values, "step {k}");
    }
}

#[test]
fn functions_of_3_0_have_the_types_of_the_crate() {
    let file = package("types", "3");
    let package = FMU3Builder::new(&file).unwrap();
    let token = std::ffi::CString::new(package.model_description.instantiationToken.clone()).unwrap();
    let folder = Path::new(&file).with_extension("");
    let mut archive = Command::new("unzip");
    assert!(archive.args(["-oq", &file, "-d"]).arg(&folder).status().unwrap().success());
    let resources = std::ffi::CString::new(folder.join("resources").to_str().unwrap()).unwrap();
    let library = unsafe { Library::new(folder.join("binaries/x86_64-linux/thrust.so")) }.unwrap();
    macro_rules! function {
        ($name:ident: $type:ty) => {
            let $name = *unsafe { library.get::<$type>(stringify!($name).as_bytes()) }.unwrap();
        };
    }
    function!(fmi3InstantiateCoSimulation: fmi3InstantiateCoSimulationTYPE);
    function!(fmi3InstantiateModelExchange: fmi3InstantiateModelExchangeTYPE);
    function!(fmi3EnterInitializationMode: fmi3EnterInitializationModeTYPE);
    function!(fmi3ExitInitializationMode: fmi3ExitInitializationModeTYPE);
    function!(fmi3GetFloat64: fmi3GetFloat64TYPE);
    function!(fmi3SetFloat64: fmi3SetFloat64TYPE);
    function!(fmi3GetInt64: fmi3GetInt64TYPE);
    function!(fmi3GetBoolean: fmi3GetBooleanTYPE);
    function!(fmi3DoStep: fmi3DoStepTYPE);
    function!(fmi3GetFMUState: fmi3GetFMUStateTYPE);
    function!(fmi3FreeFMUState: fmi3FreeFMUStateTYPE);
    function!(fmi3GetDirectionalDerivative: fmi3GetDirectionalDerivativeTYPE);
    function!(fmi3GetAdjointDerivative: fmi3GetAdjointDerivativeTYPE);
    function!(fmi3GetOutputDerivatives: fmi3GetOutputDerivativesTYPE);
    function!(fmi3SetTime: fmi3SetTimeTYPE);
    function!(fmi3Reset: fmi3ResetTYPE);
    function!(fmi3Terminate: fmi3TerminateTYPE);
    function!(fmi3FreeInstance: fmi3FreeInstanceTYPE);
    // What it calls back has the types of the crate, too.
    unsafe extern "C" fn log(lines: fmi3InstanceEnvironment, _: fmi3Status, _: fmi3String, text: fmi3String) {
        let lines = unsafe { &mut *lines.cast::<Log>() };
        lines.texts.push(unsafe { std::ffi::CStr::from_ptr(text) }.to_string_lossy().into_owned());
    }
    unsafe extern "C" fn update(
        lines: fmi3InstanceEnvironment,
        time: f64,
        set: bool,
        get: bool,
        finished: bool,
        can_return: bool,
        _: *mut bool,
        _: *mut f64,
    ) {
        assert!(set && get && finished && !can_return);
        unsafe { &mut *lines.cast::<Log>() }.times.push(time);
    }
    #[derive(Default)]
    struct Log {
        texts: Vec<String>,
        times: Vec<f64>,
    }
    let mut lines = Log::default();
    let environment = ptr::from_mut(&mut lines).cast();
    let (message, update): (fmi3LogMessageCallback, fmi3IntermediateUpdateCallback) = (log, update);
    let variables = &package.model_description.modelVariables;
    let reference = |name: &str| variables.iter().find(|v| v.name == name).unwrap().valueReference;
    let [force, applied] = ["inner.force.x", "inner.applied_force.x"].map(reference);
    unsafe {
        // The crate has pointers to callbacks where the standard has the callbacks themselves, which are pointers.
        let (message, update) = (message as *const _, update as *const _);
        let (name, token, folder) = (c"x".as_ptr(), token.as_ptr(), resources.as_ptr());
        assert!(fmi3InstantiateModelExchange(name, token, folder, false, true, environment, message).is_null());
        let c = fmi3InstantiateCoSimulation(
            name, token, folder, false, true, false, false, [force].as_ptr(), 1, environment, message, update,
        );
        assert!(!c.is_null());
        ok(fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0));
        ok(fmi3ExitInitializationMode(c));
        let (mut event, mut end, mut early, mut reached) = (true, true, true, 0.0);
        ok(fmi3SetFloat64(c, &applied, 1, &1400.0, 1));
        ok(fmi3DoStep(c, 0.0, STEP, true, &mut event, &mut end, &mut early, &mut reached));
        assert_eq!((event, end, early, reached), (false, false, false, STEP));
        let (mut value, mut count, mut boolean) = (0.0, -1, false);
        ok(fmi3GetFloat64(c, &applied, 1, &mut value, 1));
        assert_eq!(value, 1400.0);
        ok(fmi3GetInt64(c, &reference("integrator.steps"), 1, &mut count, 1));
        assert!(count > 0);
        assert_eq!(fmi3GetBoolean(c, &force, 1, &mut boolean, 1), fmi3Status::Error);
        assert_eq!(fmi3SetTime(c, 1.0), fmi3Status::Error);
        let mut state = ptr::null_mut();
        ok(fmi3GetFMUState(c, &mut state));
        ok(fmi3FreeFMUState(c, &mut state));
        assert!(state.is_null());
        let (mut forward, mut adjoint) = (0.0, 0.0);
        ok(fmi3GetDirectionalDerivative(c, &force, 1, &applied, 1, &2.0, 1, &mut forward, 1));
        ok(fmi3GetAdjointDerivative(c, &force, 1, &applied, 1, &2.0, 1, &mut adjoint, 1));
        assert!(forward == adjoint && forward != 0.0);
        ok(fmi3GetOutputDerivatives(c, &force, 1, &1, &mut value, 1));
        ok(fmi3Terminate(c));
        ok(fmi3Reset(c));
        fmi3FreeInstance(c);
    }
    assert!(lines.times.len() > 5 && lines.times.last() == Some(&STEP), "{:?}", lines.times);
    assert!(lines.texts.iter().any(|text| text.contains("fmi3SetTime is not offered")), "{:?}", lines.texts);
}
