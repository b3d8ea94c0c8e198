//! Functions of what packages do not offer: model exchange, scheduled execution, events, clocks, configuration, dependencies by element.
#![allow(unsafe_code)]

use std::ffi::{c_char, c_int, c_void};

use super::guarded;
use crate::fmi::log::Log;
use crate::fmi::outcome::{self, error};
use crate::fmi::state_machine::Call;
use crate::fmi::v3::logger::{Environment, sink};
use crate::fmi::v3::types::{LogMessage, Status};

/// Tells that a package is for co-simulation, and makes nothing.
fn co_simulation_only(environment: *mut c_void, log_message: Option<LogMessage>) -> *mut c_void {
    let log = Log::new(sink(Environment(environment), log_message), true);
    log.write(outcome::Status::Error, "this package offers co-simulation only");
    std::ptr::null_mut()
}

/// Not offered.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    _token: *const c_char,
    _resource_path: *const c_char,
    _visible: bool,
    _logging_on: bool,
    environment: *mut c_void,
    log_message: Option<LogMessage>,
) -> *mut c_void {
    co_simulation_only(environment, log_message)
}

/// Not offered.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resource_path: *const c_char,
    _visible: bool,
    _logging_on: bool,
    environment: *mut c_void,
    log_message: Option<LogMessage>,
    _clock_update: *const c_void,
    _lock_preemption: *const c_void,
    _unlock_preemption: *const c_void,
) -> *mut c_void {
    co_simulation_only(environment, log_message)
}

macro_rules! not_offered {
    ($($name:ident($($argument:ident: $type:ty),*);)*) => {$(
        /// Not offered.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(instance: *mut c_void, $($argument: $type),*) -> Status {
            $(let _ = $argument;)*
            guarded(instance, Call::NotOffered, |_| error(concat!(stringify!($name), " is not offered")))
        }
    )*};
}

type References = *const u32;

not_offered! {
    fmi3EnterEventMode();
    fmi3EnterStepMode();
    fmi3EnterConfigurationMode();
    fmi3ExitConfigurationMode();
    fmi3EvaluateDiscreteStates();
    fmi3UpdateDiscreteStates(
        need_update: *mut bool,
        terminate: *mut bool,
        nominals_changed: *mut bool,
        values_changed: *mut bool,
        next_event_defined: *mut bool,
        next_event: *mut f64
    );
    fmi3GetNumberOfVariableDependencies(reference: u32, n: *mut usize);
    fmi3GetVariableDependencies(
        reference: u32,
        dependent_elements: *mut usize,
        independents: *mut u32,
        independent_elements: *mut usize,
        kinds: *mut c_int,
        n: usize
    );
    fmi3GetIntervalDecimal(references: References, n: usize, intervals: *mut f64, qualifiers: *mut c_int);
    fmi3GetIntervalFraction(
        references: References,
        n: usize,
        counters: *mut u64,
        resolutions: *mut u64,
        qualifiers: *mut c_int
    );
    fmi3GetShiftDecimal(references: References, n: usize, shifts: *mut f64);
    fmi3GetShiftFraction(references: References, n: usize, counters: *mut u64, resolutions: *mut u64);
    fmi3SetIntervalDecimal(references: References, n: usize, intervals: *const f64);
    fmi3SetIntervalFraction(references: References, n: usize, counters: *const u64, resolutions: *const u64);
    fmi3SetShiftDecimal(references: References, n: usize, shifts: *const f64);
    fmi3SetShiftFraction(references: References, n: usize, counters: *const u64, resolutions: *const u64);
    fmi3EnterContinuousTimeMode();
    fmi3CompletedIntegratorStep(no_set_state_prior: bool, enter_event_mode: *mut bool, terminate: *mut bool);
    fmi3SetTime(time: f64);
    fmi3SetContinuousStates(states: *const f64, n: usize);
    fmi3GetContinuousStates(states: *mut f64, n: usize);
    fmi3GetContinuousStateDerivatives(derivatives: *mut f64, n: usize);
    fmi3GetNominalsOfContinuousStates(nominals: *mut f64, n: usize);
    fmi3GetNumberOfContinuousStates(n: *mut usize);
    fmi3GetEventIndicators(indicators: *mut f64, n: usize);
    fmi3GetNumberOfEventIndicators(n: *mut usize);
    fmi3ActivateModelPartition(clock: u32, time: f64);
}
