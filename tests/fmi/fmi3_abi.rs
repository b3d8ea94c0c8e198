//! The C interface of FMI 3.0 as an importer sees it.
#![allow(dead_code, non_snake_case)]

use std::ffi::{c_char, c_int, c_void};
use std::ptr;

use roulement::fmi::v3::{IntermediateUpdate, LogMessage, Status};
use roulement::interface::references::References;

use crate::fmi2_abi::Package;

pub type Handle = *mut c_void;
type Refs = *const u32;
type Flag = *mut bool;

macro_rules! functions {
    ($($name:ident($($argument:ident: $type:ty),*);)*) => {
        unsafe extern "C" {
            $(pub fn $name(c: Handle, $($argument: $type),*) -> Status;)*
        }
    };
}

unsafe extern "C" {
    pub fn fmi3GetVersion() -> *const c_char;
    pub fn fmi3InstantiateModelExchange(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        environment: Handle,
        log: Option<LogMessage>,
    ) -> Handle;
    pub fn fmi3InstantiateCoSimulation(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        events: bool,
        early: bool,
        required: Refs,
        n: usize,
        environment: Handle,
        log: Option<LogMessage>,
        update: Option<IntermediateUpdate>,
    ) -> Handle;
    pub fn fmi3InstantiateScheduledExecution(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        environment: Handle,
        log: Option<LogMessage>,
        clock: *const c_void,
        lock: *const c_void,
        unlock: *const c_void,
    ) -> Handle;
    pub fn fmi3FreeInstance(c: Handle);
}

functions! {
    fmi3SetDebugLogging(on: bool, n: usize, categories: *const *const c_char);
    fmi3EnterInitializationMode(d: bool, t: f64, start: f64, s: bool, stop: f64);
    fmi3ExitInitializationMode();
    fmi3EnterEventMode();
    fmi3Terminate();
    fmi3Reset();
    fmi3GetFloat32(r: Refs, n: usize, v: *mut f32, m: usize);
    fmi3GetFloat64(r: Refs, n: usize, v: *mut f64, m: usize);
    fmi3GetInt8(r: Refs, n: usize, v: *mut i8, m: usize);
    fmi3GetUInt8(r: Refs, n: usize, v: *mut u8, m: usize);
    fmi3GetInt16(r: Refs, n: usize, v: *mut i16, m: usize);
    fmi3GetUInt16(r: Refs, n: usize, v: *mut u16, m: usize);
    fmi3GetInt32(r: Refs, n: usize, v: *mut i32, m: usize);
    fmi3GetUInt32(r: Refs, n: usize, v: *mut u32, m: usize);
    fmi3GetInt64(r: Refs, n: usize, v: *mut i64, m: usize);
    fmi3GetUInt64(r: Refs, n: usize, v: *mut u64, m: usize);
    fmi3GetBoolean(r: Refs, n: usize, v: Flag, m: usize);
    fmi3GetString(r: Refs, n: usize, v: *mut *const c_char, m: usize);
    fmi3GetBinary(r: Refs, n: usize, s: *mut usize, v: *mut *const u8, m: usize);
    fmi3GetClock(r: Refs, n: usize, v: Flag);
    fmi3SetFloat32(r: Refs, n: usize, v: *const f32, m: usize);
    fmi3SetFloat64(r: Refs, n: usize, v: *const f64, m: usize);
    fmi3SetInt8(r: Refs, n: usize, v: *const i8, m: usize);
    fmi3SetUInt8(r: Refs, n: usize, v: *const u8, m: usize);
    fmi3SetInt16(r: Refs, n: usize, v: *const i16, m: usize);
    fmi3SetUInt16(r: Refs, n: usize, v: *const u16, m: usize);
    fmi3SetInt32(r: Refs, n: usize, v: *const i32, m: usize);
    fmi3SetUInt32(r: Refs, n: usize, v: *const u32, m: usize);
    fmi3SetInt64(r: Refs, n: usize, v: *const i64, m: usize);
    fmi3SetUInt64(r: Refs, n: usize, v: *const u64, m: usize);
    fmi3SetBoolean(r: Refs, n: usize, v: *const bool, m: usize);
    fmi3SetString(r: Refs, n: usize, v: *const *const c_char, m: usize);
    fmi3SetBinary(r: Refs, n: usize, s: *const usize, v: *const *const u8, m: usize);
    fmi3SetClock(r: Refs, n: usize, v: *const bool);
    fmi3GetNumberOfVariableDependencies(r: u32, n: *mut usize);
    fmi3GetVariableDependencies(r: u32, d: *mut usize, i: *mut u32, e: *mut usize, k: *mut c_int, n: usize);
    fmi3GetFMUState(state: *mut Handle);
    fmi3SetFMUState(state: Handle);
    fmi3FreeFMUState(state: *mut Handle);
    fmi3SerializedFMUStateSize(state: Handle, size: *mut usize);
    fmi3SerializeFMUState(state: Handle, bytes: *mut u8, size: usize);
    fmi3DeserializeFMUState(bytes: *const u8, size: usize, state: *mut Handle);
    fmi3GetDirectionalDerivative(u: Refs, nu: usize, k: Refs, nk: usize, s: *const f64, ns: usize, r: *mut f64, nr: usize);
    fmi3GetAdjointDerivative(u: Refs, nu: usize, k: Refs, nk: usize, s: *const f64, ns: usize, r: *mut f64, nr: usize);
    fmi3EnterConfigurationMode();
    fmi3ExitConfigurationMode();
    fmi3GetIntervalDecimal(r: Refs, n: usize, i: *mut f64, q: *mut c_int);
    fmi3GetIntervalFraction(r: Refs, n: usize, c: *mut u64, s: *mut u64, q: *mut c_int);
    fmi3GetShiftDecimal(r: Refs, n: usize, s: *mut f64);
    fmi3GetShiftFraction(r: Refs, n: usize, c: *mut u64, s: *mut u64);
    fmi3SetIntervalDecimal(r: Refs, n: usize, i: *const f64);
    fmi3SetIntervalFraction(r: Refs, n: usize, c: *const u64, s: *const u64);
    fmi3SetShiftDecimal(r: Refs, n: usize, s: *const f64);
    fmi3SetShiftFraction(r: Refs, n: usize, c: *const u64, s: *const u64);
    fmi3EvaluateDiscreteStates();
    fmi3UpdateDiscreteStates(a: Flag, b: Flag, c1: Flag, d: Flag, e: Flag, t: *mut f64);
    fmi3EnterContinuousTimeMode();
    fmi3CompletedIntegratorStep(no: bool, event: Flag, end: Flag);
    fmi3SetTime(t: f64);
    fmi3SetContinuousStates(x: *const f64, n: usize);
    fmi3GetContinuousStateDerivatives(x: *mut f64, n: usize);
    fmi3GetEventIndicators(x: *mut f64, n: usize);
    fmi3GetContinuousStates(x: *mut f64, n: usize);
    fmi3GetNominalsOfContinuousStates(x: *mut f64, n: usize);
    fmi3GetNumberOfEventIndicators(n: *mut usize);
    fmi3GetNumberOfContinuousStates(n: *mut usize);
    fmi3EnterStepMode();
    fmi3GetOutputDerivatives(r: Refs, n: usize, o: *const i32, v: *mut f64, m: usize);
    fmi3DoStep(t: f64, h: f64, no: bool, event: Flag, end: Flag, early: Flag, last: *mut f64);
    fmi3ActivateModelPartition(clock: u32, t: f64);
}

/// What a step said beside its status.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stepped {
    pub event: bool,
    pub end: bool,
    pub early: bool,
    pub reached: f64,
}

/// An instance, by its handle.
#[derive(Clone, Copy)]
pub struct Slave(pub Handle);

impl Slave {
    /// Instantiated with an environment, a log and a callback, each of which may be absent.
    pub fn with(
        package: &Package,
        environment: Handle,
        log: Option<LogMessage>,
        update: Option<IntermediateUpdate>,
    ) -> Self {
        let resources = package.resources();
        let c = unsafe {
            fmi3InstantiateCoSimulation(
                c"bearing".as_ptr(),
                package.guid.as_ptr(),
                resources.as_ptr(),
                false,
                false,
                false,
                true,
                ptr::null(),
                0,
                environment,
                log,
                update,
            )
        };
        assert!(!c.is_null());
        Self(c)
    }

    pub fn new(package: &Package) -> Self {
        Self::with(package, ptr::null_mut(), None, None)
    }

    pub fn initialise(self) -> Self {
        unsafe {
            assert_eq!(fmi3EnterInitializationMode(self.0, false, 0.0, 0.0, false, 0.0), Status::Ok);
            assert_eq!(fmi3ExitInitializationMode(self.0), Status::Ok);
        }
        self
    }

    pub fn get(self, references: &[u32]) -> Vec<f64> {
        let (mut values, n) = (vec![f64::NAN; references.len()], references.len());
        let status = unsafe { fmi3GetFloat64(self.0, references.as_ptr(), n, values.as_mut_ptr(), n) };
        assert_eq!(status, Status::Ok);
        values
    }

    pub fn counts(self, references: &[u32]) -> Vec<i64> {
        let (mut values, n) = (vec![-1; references.len()], references.len());
        let status = unsafe { fmi3GetInt64(self.0, references.as_ptr(), n, values.as_mut_ptr(), n) };
        assert_eq!(status, Status::Ok);
        values
    }

    pub fn set(self, references: &[u32], values: &[f64]) -> Status {
        let n = references.len();
        unsafe { fmi3SetFloat64(self.0, references.as_ptr(), n, values.as_ptr(), values.len()) }
    }

    pub fn step(self, time: f64, step: f64) -> (Status, Stepped) {
        let mut said = Stepped { event: true, end: true, early: true, reached: f64::NAN };
        let Stepped { event, end, early, reached } = &mut said;
        let status = unsafe { fmi3DoStep(self.0, time, step, false, event, end, early, reached) };
        (status, said)
    }

    /// Steps of a size from the start.
    pub fn run(self, steps: u32, step: f64) -> Self {
        for k in 0..steps {
            assert_eq!(self.step(f64::from(k) * step, step).0, Status::Ok);
        }
        self
    }

    pub fn state_bytes(self) -> Vec<u8> {
        let (mut state, mut size) = (ptr::null_mut(), 0);
        unsafe {
            assert_eq!(fmi3GetFMUState(self.0, &mut state), Status::Ok);
            assert_eq!(fmi3SerializedFMUStateSize(self.0, state, &mut size), Status::Ok);
            let mut bytes = vec![0; size];
            assert_eq!(fmi3SerializeFMUState(self.0, state, bytes.as_mut_ptr(), size), Status::Ok);
            assert_eq!(fmi3FreeFMUState(self.0, &mut state), Status::Ok);
            bytes
        }
    }

    pub fn restore(self, bytes: &[u8]) {
        let mut state = ptr::null_mut();
        unsafe {
            assert_eq!(fmi3DeserializeFMUState(self.0, bytes.as_ptr(), bytes.len(), &mut state), Status::Ok);
            assert_eq!(fmi3SetFMUState(self.0, state), Status::Ok);
            assert_eq!(fmi3FreeFMUState(self.0, &mut state), Status::Ok);
        }
    }

    /// Derivatives of outputs by inputs along a seed.
    pub fn forward(self, unknowns: &[u32], knowns: &[u32], seed: &[f64]) -> Vec<f64> {
        let mut results = vec![f64::NAN; unknowns.len()];
        let (u, k, n) = (unknowns.as_ptr(), knowns.as_ptr(), unknowns.len());
        let status = unsafe {
            let results = results.as_mut_ptr();
            fmi3GetDirectionalDerivative(self.0, u, n, k, knowns.len(), seed.as_ptr(), seed.len(), results, n)
        };
        assert_eq!(status, Status::Ok);
        results
    }

    pub fn adjoint(self, unknowns: &[u32], knowns: &[u32], seed: &[f64]) -> Vec<f64> {
        let mut results = vec![f64::NAN; knowns.len()];
        let (u, k, n) = (unknowns.as_ptr(), knowns.as_ptr(), knowns.len());
        let status = unsafe {
            let results = results.as_mut_ptr();
            fmi3GetAdjointDerivative(self.0, u, unknowns.len(), k, n, seed.as_ptr(), seed.len(), results, n)
        };
        assert_eq!(status, Status::Ok);
        results
    }

    pub fn free(self) {
        unsafe { fmi3FreeInstance(self.0) };
    }
}

/// Reference of the independent variable.
pub fn time_of(package: &Package) -> u32 {
    References::new(&package.rows).time() as u32
}

/// Reference of the rate of an input.
pub fn rate_of(package: &Package, name: &str) -> u32 {
    let row = package.reference(name) as usize;
    References::new(&package.rows).rates().find(|(_, of)| *of == row).unwrap().0 as u32
}
