//! Steps and derivatives.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::c_void;

use super::guarded;
use crate::fmi::pointers::{self, list, list_mut};
use crate::fmi::state_machine::Call;
use crate::fmi::v3::types::Status;

/// Changes of outputs for a change of inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetDirectionalDerivative(
    instance: *mut c_void,
    unknowns: *const u32,
    n_unknowns: usize,
    knowns: *const u32,
    n_knowns: usize,
    seed: *const f64,
    n_seed: usize,
    sensitivity: *mut f64,
    n_sensitivity: usize,
) -> Status {
    guarded(instance, Call::GetDirectionalDerivative, |slave| {
        // SAFETY: the importer's contract.
        let (unknowns, knowns) = unsafe { (list(unknowns, n_unknowns)?, list(knowns, n_knowns)?) };
        // SAFETY: the importer's contract.
        let (seed, results) = unsafe { (list(seed, n_seed)?, list_mut(sensitivity, n_sensitivity)?) };
        slave.directional_derivative(unknowns, knowns, seed, results)
    })
}

/// Weights of outputs times their derivatives by inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetAdjointDerivative(
    instance: *mut c_void,
    unknowns: *const u32,
    n_unknowns: usize,
    knowns: *const u32,
    n_knowns: usize,
    seed: *const f64,
    n_seed: usize,
    sensitivity: *mut f64,
    n_sensitivity: usize,
) -> Status {
    guarded(instance, Call::GetAdjointDerivative, |slave| {
        // SAFETY: the importer's contract.
        let (unknowns, knowns) = unsafe { (list(unknowns, n_unknowns)?, list(knowns, n_knowns)?) };
        // SAFETY: the importer's contract.
        let (seed, results) = unsafe { (list(seed, n_seed)?, list_mut(sensitivity, n_sensitivity)?) };
        slave.adjoint_derivative(unknowns, knowns, seed, results)
    })
}

/// First derivatives of outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetOutputDerivatives(
    instance: *mut c_void,
    references: *const u32,
    n: usize,
    orders: *const i32,
    values: *mut f64,
    n_values: usize,
) -> Status {
    guarded(instance, Call::GetOutputDerivatives, |slave| {
        // SAFETY: the importer's contract.
        let (references, orders, values) =
            unsafe { (list(references, n)?, list(orders, n)?, list_mut(values, n_values)?) };
        slave.output_derivatives(references, orders, values)
    })
}

/// Advances to the next communication point. A step that cannot be finished is discarded: the instance is then where it was before.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    time: f64,
    step: f64,
    _no_set_state_prior: bool,
    event_handling_needed: Option<&mut bool>,
    terminate_simulation: Option<&mut bool>,
    early_return: Option<&mut bool>,
    last_successful_time: Option<&mut f64>,
) -> Status {
    let mut question = None;
    let mut early = false;
    let (mut reached, mut reached_place, mut early_place) = (f64::NAN, None, None);
    let mut status = guarded(instance, Call::DoStep, |slave| {
        // The model has no events, and never ends a simulation by itself.
        for (place, what) in [
            (event_handling_needed, "the need of event handling"),
            (terminate_simulation, "the end of the simulation"),
        ] {
            *pointers::place(place, what)? = false;
        }
        early_place = Some(pointers::place(early_return, "an early return")?);
        reached_place = Some(pointers::place(last_successful_time, "the last successful time")?);
        let done = match slave.updates {
            None => slave.instance.do_whole_step(time, step),
            Some(_) => slave.begin_updated_step(time, step),
        };
        (question, reached) = (slave.question(), slave.instance.time());
        done
    });
    // The importer may call the instance while it is asked: nothing of it is in use then.
    while let Some(asked) = question.take() {
        let answer = asked.ask();
        status = guarded(instance, Call::ContinueStep, |slave| {
            let done = slave.continue_updated_step(answer);
            (question, reached) = (slave.question(), slave.instance.time());
            if question.is_none() {
                early = slave.end_updated_step();
            }
            done
        });
    }
    if let (Some(early_place), Some(reached_place)) = (early_place, reached_place) {
        (*early_place, *reached_place) = (early, reached);
    }
    status
}
