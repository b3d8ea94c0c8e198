//! Steps, derivatives, and what is known of the last step.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::{c_char, c_int, c_void};

use super::guarded;
use crate::fmi::outcome::{self, Outcome};
use crate::fmi::pointers::{list, list_mut, place};
use crate::fmi::state_machine::Call;
use crate::fmi::v2::types::{Boolean, Status};

/// Changes of outputs for a change of inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    component: *mut c_void,
    unknowns: *const u32,
    n_unknowns: usize,
    knowns: *const u32,
    n_knowns: usize,
    known_changes: *const f64,
    unknown_changes: *mut f64,
) -> Status {
    guarded(component, Call::GetDirectionalDerivative, |instance| {
        // SAFETY: the importer's contract.
        let (unknowns, knowns) = unsafe { (list(unknowns, n_unknowns)?, list(knowns, n_knowns)?) };
        // SAFETY: the importer's contract.
        let (changes, results) =
            unsafe { (list(known_changes, n_knowns)?, list_mut(unknown_changes, n_unknowns)?) };
        instance.directional_derivative(unknowns, knowns, changes, results)
    })
}

/// First derivatives of inputs, for the next step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    orders: *const c_int,
    values: *const f64,
) -> Status {
    guarded(component, Call::SetRealInputDerivatives, |instance| {
        // SAFETY: the importer's contract.
        let (references, orders, values) =
            unsafe { (list(references, n)?, list(orders, n)?, list(values, n)?) };
        instance.set_input_derivatives(references, orders, values)
    })
}

/// First derivatives of outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    orders: *const c_int,
    values: *mut f64,
) -> Status {
    guarded(component, Call::GetOutputDerivatives, |instance| {
        // SAFETY: the importer's contract.
        let (references, orders, values) =
            unsafe { (list(references, n)?, list(orders, n)?, list_mut(values, n)?) };
        instance.output_derivatives(references, orders, values)
    })
}

/// Advances to the next communication point.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(
    component: *mut c_void,
    time: f64,
    step: f64,
    _no_set_state_prior: Boolean,
) -> Status {
    guarded(component, Call::DoStep, |instance| instance.do_step(time, step))
}

/// Steps are synchronous: there is none to cancel.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2CancelStep(component: *mut c_void) -> Status {
    guarded(component, Call::CancelStep, |_| Ok(()))
}

/// Status of an asynchronous step: there is none.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStatus(component: *mut c_void, _kind: c_int, _value: *mut Status) -> Status {
    guarded(component, Call::GetStatus, |_| discard_status())
}

/// `fmi2LastSuccessfulTime`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetRealStatus(component: *mut c_void, kind: c_int, value: Option<&mut f64>) -> Status {
    const LAST_SUCCESSFUL_TIME: c_int = 2;
    guarded(component, Call::GetStatus, |instance| {
        let value = place(value, "the status")?;
        if kind != LAST_SUCCESSFUL_TIME {
            return discard_status();
        }
        *value = instance.time();
        Ok(())
    })
}

/// There is no integer status.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetIntegerStatus(component: *mut c_void, _kind: c_int, _value: *mut c_int) -> Status {
    guarded(component, Call::GetStatus, |_| discard_status())
}

/// `fmi2Terminated`: the model never ends a simulation by itself.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetBooleanStatus(
    component: *mut c_void,
    kind: c_int,
    value: Option<&mut Boolean>,
) -> Status {
    const TERMINATED: c_int = 3;
    guarded(component, Call::GetStatus, |_| {
        let value = place(value, "the status")?;
        if kind != TERMINATED {
            return discard_status();
        }
        *value = 0;
        Ok(())
    })
}

/// There is no pending status to describe.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStringStatus(
    component: *mut c_void,
    _kind: c_int,
    _value: *mut *const c_char,
) -> Status {
    guarded(component, Call::GetStatus, |_| discard_status())
}

fn discard_status() -> Outcome {
    Err((outcome::Status::Discard, "steps are synchronous: there is no such status".into()))
}
