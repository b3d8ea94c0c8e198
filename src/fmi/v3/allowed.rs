//! Which function may be called in which phase of an instance (FMI 3.0, sections 2.3 and 4.2), as data.

use crate::fmi::state::Phase::{
    self, Error, Initialization, Instantiated, Intermediate, StepComplete, Terminated,
};
use crate::fmi::state_machine::{Call, Rules};

const RUNNING: &[Phase] = &[Initialization, StepComplete, Intermediate, Terminated, Error];
const BETWEEN_STEPS: &[Phase] = &[Instantiated, Initialization, StepComplete, Terminated, Error];

/// The standard's table for co-simulation. A step that was discarded leaves the instance where it was before.
pub static RULES: Rules = Rules {
    allowed: &[
        (Call::SetDebugLogging, BETWEEN_STEPS),
        (Call::EnterInitializationMode, &[Instantiated]),
        (Call::ExitInitializationMode, &[Initialization]),
        (Call::Terminate, &[StepComplete]),
        (Call::Reset, BETWEEN_STEPS),
        (Call::Get, RUNNING),
        (Call::Set, &[Instantiated, Initialization, StepComplete, Intermediate]),
        (Call::FmuState, BETWEEN_STEPS),
        (Call::GetDirectionalDerivative, &[Initialization, StepComplete, Terminated, Error]),
        (Call::GetAdjointDerivative, &[Initialization, StepComplete, Terminated, Error]),
        (Call::GetOutputDerivatives, &[StepComplete, Terminated, Error]),
        (Call::DoStep, &[StepComplete]),
        (Call::ContinueStep, &[Intermediate]),
        (Call::NotOffered, &[Instantiated, Initialization, StepComplete, Intermediate, Terminated, Error]),
    ],
    after_discarded_step: StepComplete,
};
