//! Which function may be called in which phase of an instance (FMI 2.0.4, section 4.2.4), as data.

use crate::fmi::outcome::Status;
use crate::fmi::state::Phase;
use Phase::{Error, Initialization, Instantiated, StepComplete, StepFailed, Terminated};

/// All calls that need an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Call {
    /// `fmi2SetDebugLogging`
    SetDebugLogging,
    /// `fmi2SetupExperiment`
    SetupExperiment,
    /// `fmi2EnterInitializationMode`
    EnterInitializationMode,
    /// `fmi2ExitInitializationMode`
    ExitInitializationMode,
    /// `fmi2Terminate`
    Terminate,
    /// `fmi2Reset`
    Reset,
    /// `fmi2GetReal`, `fmi2GetInteger`, `fmi2GetBoolean`, `fmi2GetString`
    Get,
    /// `fmi2SetReal`, `fmi2SetInteger`, `fmi2SetBoolean`, `fmi2SetString`
    Set,
    /// `fmi2GetFMUstate`, `fmi2SetFMUstate`, `fmi2FreeFMUstate` and their serialisation
    FmuState,
    /// `fmi2GetDirectionalDerivative`
    GetDirectionalDerivative,
    /// `fmi2SetRealInputDerivatives`
    SetRealInputDerivatives,
    /// `fmi2GetRealOutputDerivatives`
    GetRealOutputDerivatives,
    /// `fmi2DoStep`
    DoStep,
    /// `fmi2CancelStep`: only while a step runs in the background, which never happens here
    CancelStep,
    /// `fmi2GetStatus`, `fmi2GetRealStatus` and the like
    GetStatus,
}

const RUNNING: &[Phase] = &[Initialization, StepComplete, StepFailed, Terminated, Error];
const ALIVE: &[Phase] = &[Instantiated, Initialization, StepComplete, StepFailed, Terminated, Error];

/// The standard's table.
pub const ALLOWED: [(Call, &[Phase]); 15] = [
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
    (Call::GetRealOutputDerivatives, &[StepComplete, StepFailed, Terminated, Error]),
    (Call::DoStep, &[StepComplete]),
    (Call::CancelStep, &[]),
    (Call::GetStatus, &[StepComplete, StepFailed, Terminated]),
];

/// May this function be called in this phase?
pub fn allowed(call: Call, phase: Phase) -> bool {
    ALLOWED.iter().any(|(listed, phases)| *listed == call && phases.contains(&phase))
}

/// Phase after a call that ended with this status.
pub fn after(call: Call, status: Status, phase: Phase) -> Phase {
    match status {
        Status::Fatal => Phase::Fatal,
        // A value that was refused leaves the instance as it was, and so does an unwelcome call of no effect.
        Status::Error if call == Call::DoStep || call == Call::ExitInitializationMode => Phase::Error,
        Status::Discard if call == Call::DoStep => Phase::StepFailed,
        _ => phase,
    }
}
