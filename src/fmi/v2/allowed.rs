//! Which function may be called in which phase of an instance (FMI 2.0.4, section 4.2.4), as data.

use crate::fmi::state::Phase::{
    self, Error, Initialization, Instantiated, StepComplete, StepFailed, Terminated,
};
use crate::fmi::state_machine::{Call, Rules};

const RUNNING: &[Phase] = &[Initialization, StepComplete, StepFailed, Terminated, Error];
const ALIVE: &[Phase] = &[Instantiated, Initialization, StepComplete, StepFailed, Terminated, Error];

/// The standard's table.
pub static RULES: Rules = Rules {
    allowed: &[
        (Call::SetDebugLogging, ALIVE),
        (Call::SetupExperiment, &[Instantiated]),
        (Call::EnterInitializationMode, &[Instantiated]),
        (Call::ExitInitializationMode, &[Initialization]),
        (Call::Terminate, &[StepComplete, StepFailed]),
        (Call::Reset, ALIVE),
        (Call::Get, RUNNING),
        (Call::Set, &[Instantiated, Initialization, StepComplete]),
        (Call::FmuState, ALIVE),
        (Call::GetDirectionalDerivative, RUNNING),
        (Call::SetRealInputDerivatives, &[Instantiated, Initialization, StepComplete]),
        (Call::GetOutputDerivatives, &[StepComplete, StepFailed, Terminated, Error]),
        (Call::DoStep, &[StepComplete]),
        (Call::CancelStep, &[]),
        (Call::GetStatus, &[StepComplete, StepFailed, Terminated]),
    ],
    after_discarded_step: StepFailed,
};
