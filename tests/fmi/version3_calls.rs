//! Every function of FMI 3.0 in every phase, and random and hostile calls of all of them.

use std::ffi::{CStr, c_char, c_void};
use std::ptr;
use std::sync::Mutex;

use roulement::fmi::v3::Status;
use roulement::interface::references::References;
use roulement::interface::variables::Causality;

use crate::fmi2_abi::*;
use crate::fmi3_abi::*;
use crate::random::Random;
use crate::scenes::scene;

type Call = fn(Handle, &Package) -> Status;

/// Phases of an instance.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    Instantiated,
    Initialization,
    StepMode,
    Terminated,
    Error,
}
use Phase::{Error, Initialization, Instantiated, StepMode, Terminated};

const PHASES: [Phase; 5] = [Instantiated, Initialization, StepMode, Terminated, Error];

fn instance_in(phase: Phase, package: &Package) -> Handle {
    let c = Slave::new(package).0;
    let ok = |status| assert_eq!(status, Status::Ok);
    unsafe {
        if phase != Instantiated {
            ok(fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0));
        }
        if matches!(phase, StepMode | Terminated | Error) {
            ok(fmi3ExitInitializationMode(c));
            ok(Slave(c).step(0.0, 1e-5).0);
        }
        match phase {
            Terminated => ok(fmi3Terminate(c)),
            Error => assert_eq!(Slave(c).step(1.0, 1e-5).0, Status::Error),
            _ => {}
        }
    }
    c
}

const ALWAYS: &[Phase] = &PHASES;
const NEVER: &[Phase] = &[];

/// Functions by name, with a call that is right but for its phase, and the phases in which the standard allows it (FMI 3.0, 2.3 and
/// 4.2; what packages do not offer is refused everywhere).
fn table() -> Vec<(&'static str, Call, &'static [Phase])> {
    macro_rules! rows {
        ($($phases:expr => { $($name:ident($c:ident, $p:ident) $call:expr;)* })*) => {
            vec![$($((stringify!($name), (|$c, $p| { let _ = $p; #[allow(unused_unsafe)] unsafe { $call } }) as Call, $phases),)*)*]
        };
    }
    const RUNNING: &[Phase] = &[Initialization, StepMode, Terminated, Error];
    const SETTABLE: &[Phase] = &[Instantiated, Initialization, StepMode];
    const STEPPED: &[Phase] = &[StepMode, Terminated, Error];
    fn force(p: &Package) -> u32 {
        p.reference("inner.applied_force.y")
    }
    fn with_state(c: Handle, work: impl Fn(Handle) -> Status) -> Status {
        let mut state = ptr::null_mut();
        let saved = unsafe { fmi3GetFMUState(c, &mut state) };
        if saved != Status::Ok {
            return saved;
        }
        let status = work(state);
        unsafe { fmi3FreeFMUState(c, &mut state) };
        status
    }
    rows! {
        ALWAYS => {
            fmi3SetDebugLogging(c, p) fmi3SetDebugLogging(c, false, 0, ptr::null());
            fmi3Reset(c, p) fmi3Reset(c);
            fmi3GetFMUState(c, p) with_state(c, |_| Status::Ok);
            fmi3SetFMUState(c, p) with_state(c, |state| fmi3SetFMUState(c, state));
            fmi3FreeFMUState(c, p) fmi3FreeFMUState(c, &mut ptr::null_mut());
            fmi3SerializedFMUStateSize(c, p) with_state(c, |state| fmi3SerializedFMUStateSize(c, state, &mut 0));
            fmi3SerializeFMUState(c, p) with_state(c, |state| {
                let mut size = 0;
                fmi3SerializedFMUStateSize(c, state, &mut size);
                fmi3SerializeFMUState(c, state, vec![0; size].as_mut_ptr(), size)
            });
            fmi3DeserializeFMUState(c, p) {
                let bytes = if c.is_null() { vec![] } else { Slave(c).state_bytes() };
                fmi3DeserializeFMUState(c, bytes.as_ptr(), bytes.len(), &mut ptr::null_mut())
            };
        }
        &[Instantiated] => {
            fmi3EnterInitializationMode(c, p) fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0);
        }
        &[Initialization] => {
            fmi3ExitInitializationMode(c, p) fmi3ExitInitializationMode(c);
        }
        &[StepMode] => {
            fmi3Terminate(c, p) fmi3Terminate(c);
            fmi3DoStep(c, p) Slave(c).step(1e-5, 1e-5).0;
        }
        RUNNING => {
            fmi3GetFloat64(c, p) fmi3GetFloat64(c, &force(p), 1, &mut 0.0, 1);
            fmi3GetInt64(c, p) fmi3GetInt64(c, &p.reference("integrator.steps"), 1, &mut 0, 1);
            fmi3GetFloat32(c, p) fmi3GetFloat32(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetInt8(c, p) fmi3GetInt8(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetUInt8(c, p) fmi3GetUInt8(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetInt16(c, p) fmi3GetInt16(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetUInt16(c, p) fmi3GetUInt16(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetInt32(c, p) fmi3GetInt32(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetUInt32(c, p) fmi3GetUInt32(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetUInt64(c, p) fmi3GetUInt64(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetBoolean(c, p) fmi3GetBoolean(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetString(c, p) fmi3GetString(c, ptr::null(), 0, ptr::null_mut(), 0);
            fmi3GetBinary(c, p) fmi3GetBinary(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut(), 0);
            fmi3GetClock(c, p) fmi3GetClock(c, ptr::null(), 0, ptr::null_mut());
        }
        SETTABLE => {
            fmi3SetFloat64(c, p) fmi3SetFloat64(c, &force(p), 1, &0.0, 1);
            fmi3SetInt64(c, p) fmi3SetInt64(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetFloat32(c, p) fmi3SetFloat32(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetInt8(c, p) fmi3SetInt8(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetUInt8(c, p) fmi3SetUInt8(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetInt16(c, p) fmi3SetInt16(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetUInt16(c, p) fmi3SetUInt16(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetInt32(c, p) fmi3SetInt32(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetUInt32(c, p) fmi3SetUInt32(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetUInt64(c, p) fmi3SetUInt64(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetBoolean(c, p) fmi3SetBoolean(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetString(c, p) fmi3SetString(c, ptr::null(), 0, ptr::null(), 0);
            fmi3SetBinary(c, p) fmi3SetBinary(c, ptr::null(), 0, ptr::null(), ptr::null(), 0);
            fmi3SetClock(c, p) fmi3SetClock(c, ptr::null(), 0, ptr::null());
            // There are no derivatives of a step that was refused.
        }
        &[Initialization, StepMode, Terminated] => {
            fmi3GetDirectionalDerivative(c, p) {
                let (unknown, known) = (p.reference("inner.position.y"), force(p));
                fmi3GetDirectionalDerivative(c, &unknown, 1, &known, 1, &1.0, 1, &mut 0.0, 1)
            };
            fmi3GetAdjointDerivative(c, p) {
                let (unknown, known) = (p.reference("inner.position.y"), force(p));
                fmi3GetAdjointDerivative(c, &unknown, 1, &known, 1, &1.0, 1, &mut 0.0, 1)
            };
        }
        STEPPED => {
            fmi3GetOutputDerivatives(c, p) {
                fmi3GetOutputDerivatives(c, &p.reference("inner.force.x"), 1, &1, &mut 0.0, 1)
            };
        }
        NEVER => {
            fmi3EnterEventMode(c, p) fmi3EnterEventMode(c);
            fmi3EnterStepMode(c, p) fmi3EnterStepMode(c);
            fmi3EnterConfigurationMode(c, p) fmi3EnterConfigurationMode(c);
            fmi3ExitConfigurationMode(c, p) fmi3ExitConfigurationMode(c);
            fmi3EvaluateDiscreteStates(c, p) fmi3EvaluateDiscreteStates(c);
            fmi3UpdateDiscreteStates(c, p) {
                let n = ptr::null_mut;
                fmi3UpdateDiscreteStates(c, n(), n(), n(), n(), n(), ptr::null_mut())
            };
            fmi3GetNumberOfVariableDependencies(c, p) fmi3GetNumberOfVariableDependencies(c, 0, &mut 0);
            fmi3GetVariableDependencies(c, p) {
                fmi3GetVariableDependencies(c, 0, ptr::null_mut(), ptr::null_mut(), ptr::null_mut(), ptr::null_mut(), 0)
            };
            fmi3GetIntervalDecimal(c, p) fmi3GetIntervalDecimal(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut());
            fmi3GetIntervalFraction(c, p) {
                fmi3GetIntervalFraction(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut(), ptr::null_mut())
            };
            fmi3GetShiftDecimal(c, p) fmi3GetShiftDecimal(c, ptr::null(), 0, ptr::null_mut());
            fmi3GetShiftFraction(c, p) fmi3GetShiftFraction(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut());
            fmi3SetIntervalDecimal(c, p) fmi3SetIntervalDecimal(c, ptr::null(), 0, ptr::null());
            fmi3SetIntervalFraction(c, p) fmi3SetIntervalFraction(c, ptr::null(), 0, ptr::null(), ptr::null());
            fmi3SetShiftDecimal(c, p) fmi3SetShiftDecimal(c, ptr::null(), 0, ptr::null());
            fmi3SetShiftFraction(c, p) fmi3SetShiftFraction(c, ptr::null(), 0, ptr::null(), ptr::null());
            fmi3EnterContinuousTimeMode(c, p) fmi3EnterContinuousTimeMode(c);
            fmi3CompletedIntegratorStep(c, p) fmi3CompletedIntegratorStep(c, false, &mut false, &mut false);
            fmi3SetTime(c, p) fmi3SetTime(c, 0.0);
            fmi3SetContinuousStates(c, p) fmi3SetContinuousStates(c, ptr::null(), 0);
            fmi3GetContinuousStateDerivatives(c, p) fmi3GetContinuousStateDerivatives(c, ptr::null_mut(), 0);
            fmi3GetEventIndicators(c, p) fmi3GetEventIndicators(c, ptr::null_mut(), 0);
            fmi3GetContinuousStates(c, p) fmi3GetContinuousStates(c, ptr::null_mut(), 0);
            fmi3GetNominalsOfContinuousStates(c, p) fmi3GetNominalsOfContinuousStates(c, ptr::null_mut(), 0);
            fmi3GetNumberOfEventIndicators(c, p) fmi3GetNumberOfEventIndicators(c, &mut 0);
            fmi3GetNumberOfContinuousStates(c, p) fmi3GetNumberOfContinuousStates(c, &mut 0);
            fmi3ActivateModelPartition(c, p) fmi3ActivateModelPartition(c, 0, 0.0);
        }
    }
}

#[test]
fn every_function_is_allowed_where_the_standard_allows_it() {
    let package = Package::new("v3-phases", &scene_text("wrench"));
    let table = table();
    // Beside these: the version, three instantiations, and the end of an instance.
    assert_eq!(table.len() + 5, 75);
    for (name, call, allowed) in &table {
        for phase in PHASES {
            let c = instance_in(phase, &package);
            let status = call(c, &package);
            let expected = if allowed.contains(&phase) { Status::Ok } else { Status::Error };
            assert_eq!(status, expected, "{name} in {phase:?}");
            // An unwelcome call but a step leaves the instance usable.
            assert_eq!(unsafe { fmi3Reset(c) }, Status::Ok, "{name} in {phase:?}");
            unsafe { fmi3FreeInstance(c) };
        }
        assert_eq!(call(ptr::null_mut(), &package), Status::Error, "{name} without an instance");
    }
}

type Lines = Mutex<Vec<(Status, String, String)>>;

unsafe extern "C" fn keep(lines: *mut c_void, status: Status, category: *const c_char, text: *const c_char) {
    let [category, text] =
        [category, text].map(|text| unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned());
    unsafe { &*lines.cast::<Lines>() }.lock().unwrap().push((status, category, text));
}

#[test]
fn refusals_are_one_line_in_the_log() {
    let package = Package::new("v3-log", &scene_text("wrench"));
    let lines = Lines::default();
    let environment = ptr::from_ref(&lines).cast_mut().cast();
    let slave = Slave::with(&package, environment, Some(keep), None);
    let told = |status: Status, what: &str| {
        let told = std::mem::take(&mut *lines.lock().unwrap());
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].0 == status && told[0].2.contains(what), "{told:?}");
        assert_eq!(told[0].1, "logStatusError");
    };
    unsafe {
        assert_eq!(fmi3EnterEventMode(slave.0), Status::Error);
        told(Status::Error, "fmi3EnterEventMode is not offered");
        assert_eq!(fmi3GetFloat32(slave.0, &0, 1, &mut 0.0, 1), Status::Error);
        told(Status::Error, "Get is not allowed in phase Instantiated");
        slave.initialise();
        lines.lock().unwrap().clear();
        assert_eq!(fmi3GetFloat32(slave.0, &0, 1, &mut 0.0, 1), Status::Error);
        told(Status::Error, "there are no Float32 variables");
        let force = package.reference("inner.force.x");
        assert_eq!(fmi3GetFloat64(slave.0, &force, 1, [0.0; 2].as_mut_ptr(), 2), Status::Error);
        told(Status::Error, "1 variables have 1 values, not 2");
        let time = time_of(&package);
        assert_eq!(slave.set(&[time], &[1.0]), Status::Error);
        told(Status::Error, "time is the independent variable");
        // A percent sign stands once: the message is no format.
        assert_eq!(slave.set(&[u32::MAX], &[1.0]), Status::Error);
        told(Status::Error, "there is no variable with value reference 4294967295");
        let (name, token, folder) = (c"b".as_ptr(), package.guid.as_ptr(), package.resources());
        let none = ptr::null();
        let made =
            fmi3InstantiateModelExchange(name, token, folder.as_ptr(), false, false, environment, Some(keep));
        assert!(made.is_null());
        told(Status::Error, "co-simulation only");
        let made = fmi3InstantiateScheduledExecution(
            name,
            token,
            folder.as_ptr(),
            false,
            false,
            environment,
            Some(keep),
            none,
            none,
            none,
        );
        assert!(made.is_null());
        told(Status::Error, "co-simulation only");
        for (token, events) in [(c"{}".as_ptr(), false), (token, true)] {
            let made = fmi3InstantiateCoSimulation(
                name,
                token,
                folder.as_ptr(),
                false,
                false,
                events,
                false,
                ptr::null(),
                0,
                environment,
                Some(keep),
                None,
            );
            // Whoever is ready for events has none to wait for.
            assert_eq!(made.is_null(), !events);
            let told = std::mem::take(&mut *lines.lock().unwrap());
            assert_eq!(told.len(), 1, "{told:?}");
            assert!(told[0].2.contains(if events { "no event mode" } else { "{}" }), "{told:?}");
            fmi3FreeInstance(made);
        }
        assert_eq!(CStr::from_ptr(fmi3GetVersion()), c"3.0");
    }
    slave.free();
    // What was freed is told from what lives, and a handle of one version is nothing to the other.
    assert_eq!(unsafe { fmi3Reset(slave.0) }, Status::Error);
    let (c, slave) = (package.instantiate(), Slave::new(&package));
    assert_eq!(unsafe { fmi3Reset(c) }, Status::Error);
    assert_eq!(unsafe { fmi2Reset(slave.0) }, roulement::fmi::v2::Status::Error);
    unsafe { fmi3FreeInstance(c) };
    assert_eq!(unsafe { fmi2Reset(c) }, roulement::fmi::v2::Status::Ok);
    unsafe { fmi2FreeInstance(c) };
    slave.free();
}

/// Random calls on one instance after another, of a package with arrays or without; how often each kind of answer was given.
fn random_calls(package: &Package, arrays: bool, calls: u32, seed: u64) -> [u32; 5] {
    let mut random = Random::new(seed);
    let table = table();
    let variables = References::of(&package.rows, arrays);
    // References of a causality, and of arrays of it.
    let of = |causality: Causality| -> Vec<u32> {
        let own = variables.arrays().filter(|(_, array)| {
            package.rows.get(array.elements[0] as usize).is_some_and(|row| row.causality == causality)
        });
        package.references(causality).into_iter().chain(own.map(|(reference, _)| reference as u32)).collect()
    };
    let mut statuses = [0; 5];
    let mut slave = Slave::new(package);
    let mut blobs: Vec<Vec<u8>> = vec![vec![], vec![0; 100]];
    for _ in 0..calls {
        let c = if random.below(20) == 0 {
            random.pick(&[ptr::null_mut(), ptr::without_provenance_mut(0xdead_beef)])
        } else {
            slave.0
        };
        let n = random.below(5);
        let wild = [u32::MAX, package.rows.len() as u32, package.rows.len() as u32 + 3, 1_000_000];
        let choice = random.below(14);
        // Mostly of the right kind.
        let causality = match choice {
            1 | 5 => Causality::Input,
            2 => Causality::Local,
            _ => Causality::Output,
        };
        let (right, known) = (of(causality), of(Causality::Input));
        let references: Vec<u32> = (0..n)
            .map(|_| if random.below(25) == 0 { random.pick(&wild) } else { random.pick(&right) })
            .collect();
        let others: Vec<u32> = (0..n).map(|_| random.pick(&known)).collect();
        let (o, outputs) = (others.as_ptr(), of(Causality::Output));
        let unknowns: Vec<u32> = (0..n).map(|_| random.pick(&outputs)).collect();
        let r = if random.below(15) == 0 { ptr::null() } else { references.as_ptr() };
        // Arrays have more values than one.
        let [all, seed_of_others, seed_of_unknowns] =
            [&references, &others, &unknowns].map(|list| variables.number(list));
        let values: Vec<f64> =
            (0..all.max(seed_of_others).max(seed_of_unknowns)).map(|_| random.number(1e-6)).collect();
        let mut results = vec![0.25; all];
        let mut some = |most: usize| if random.below(8) == 0 { random.below(6).min(most) } else { most };
        let (m, m_others, m_unknowns) = (some(all), some(seed_of_others), some(seed_of_unknowns));
        let (v, found) = (values.as_ptr(), results.as_mut_ptr());
        let status = unsafe {
            match choice {
                0 => fmi3GetFloat64(c, r, n, found, m),
                1 => fmi3SetFloat64(c, r, n, v, m),
                2 => fmi3GetInt64(c, r, n, vec![0; all].as_mut_ptr(), m),
                3 => fmi3GetOutputDerivatives(c, r, n, vec![1; n].as_ptr(), found, m),
                4 => fmi3GetDirectionalDerivative(c, r, n, o, n, v, m_others, found, m),
                5 => {
                    let u = unknowns.as_ptr();
                    fmi3GetAdjointDerivative(c, u, n, r, n, v, m_unknowns, found, m)
                }
                6 => {
                    let mut bytes = blobs[random.below(blobs.len())].clone();
                    let bad = random.below(2) == 0 && !bytes.is_empty();
                    if bad {
                        let at = random.below(bytes.len());
                        bytes[at] ^= 1 << random.below(8);
                    }
                    let mut state = ptr::null_mut();
                    let status = fmi3DeserializeFMUState(c, bytes.as_ptr(), bytes.len(), &mut state);
                    assert!(!(bad && status == Status::Ok), "an altered state was accepted");
                    let restored = fmi3SetFMUState(c, state);
                    assert!(restored == status || restored == Status::Error);
                    fmi3FreeFMUState(c, &mut state);
                    status
                }
                7 if c == slave.0 && blobs.len() < 8 => {
                    blobs.push(slave.state_bytes());
                    Status::Ok
                }
                // What takes a run forward comes more often than everything else.
                8..=11 => {
                    let size = random.pick(&[1e-6, 1e-5, 3e-5]);
                    let step = random.pick(&[size, size, size, size, 0.0, -size, f64::NAN, 1e-300]);
                    fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0);
                    fmi3ExitInitializationMode(c);
                    let mut now = f64::NAN;
                    fmi3GetFloat64(c, &time_of(package), 1, &mut now, 1);
                    let time = if random.below(9) == 0 { random.number(now) } else { now };
                    Slave(c).step(time, step).0
                }
                _ => {
                    let (name, call, _) = table[random.below(table.len())];
                    // The calls of the table that copy states expect an instance.
                    if c == slave.0 || !name.contains("State") { call(c, package) } else { Status::Error }
                }
            }
        };
        assert_ne!(status, Status::Fatal);
        if status == Status::Ok {
            assert!(results.iter().all(|value| value.is_finite()), "{references:?}: {results:?}");
        }
        statuses[status as usize] += 1;
        // A refused step leaves little to do but a reset.
        if status == Status::Error && c == slave.0 && (choice >= 8 || random.below(9) == 0) {
            unsafe { fmi3Reset(slave.0) };
        }
        if random.below(300) == 0 {
            slave.free();
            slave = Slave::new(package);
        }
    }
    slave.free();
    statuses
}

fn do_no_harm(calls: u32) {
    for arrays in [false, true] {
        let text =
            scene(&scene_text("wrench"), &[("interface.arrays", if arrays { "true" } else { "false" })]);
        let package = Package::new("v3-random", &text.source);
        let statuses = random_calls(&package, arrays, calls, 1);
        println!("{statuses:?}");
        assert!(statuses[Status::Ok as usize] > calls / 5 && statuses[Status::Error as usize] > calls / 10);
    }
}

#[test]
fn invariant_random_calls_do_no_harm() {
    do_no_harm(2000);
}

#[test]
#[ignore = "long"]
fn invariant_a_million_random_calls_do_no_harm() {
    do_no_harm(500_000);
}
