//! Calls that need an instance, and which of them a version of the standard allows in which phase.

use super::outcome::Status;
use super::state::Phase;

/// All calls that need an instance, of all versions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Call {
    /// The log is switched.
    SetDebugLogging,
    /// Start and stop time are given, where that is a call of its own.
    SetupExperiment,
    /// Initialization begins.
    EnterInitializationMode,
    /// Initialization ends.
    ExitInitializationMode,
    /// The simulation ends.
    Terminate,
    /// Back to how it was when freshly instantiated.
    Reset,
    /// Values are read.
    Get,
    /// Values are set.
    Set,
    /// States are copied, set, freed, written and read.
    FmuState,
    /// Directional derivatives.
    GetDirectionalDerivative,
    /// Adjoint derivatives.
    GetAdjointDerivative,
    /// Derivatives of inputs by time.
    SetRealInputDerivatives,
    /// Derivatives of outputs by time.
    GetOutputDerivatives,
    /// A communication step.
    DoStep,
    /// A communication step goes on after the importer was asked for inputs.
    ContinueStep,
    /// A step in the background is given up, which never happens here.
    CancelStep,
    /// What is known of the last step.
    GetStatus,
    /// A function of something that packages do not offer.
    NotOffered,
}

/// What a version of the standard says of calls and phases.
#[derive(Debug)]
pub struct Rules {
    /// Phases in which each call is allowed.
    pub allowed: &'static [(Call, &'static [Phase])],
    /// Phase after a step that was discarded.
    pub after_discarded_step: Phase,
}

impl Rules {
    /// May this function be called in this phase?
    pub fn allow(&self, call: Call, phase: Phase) -> bool {
        self.allowed.iter().any(|(listed, phases)| *listed == call && phases.contains(&phase))
    }

    /// Phase after a call that ended with this status.
    pub fn after(&self, call: Call, status: Status, phase: Phase) -> Phase {
        match status {
            Status::Fatal => Phase::Fatal,
            // What is refused while the importer is asked for inputs changes nothing about the step that is under way.
            _ if phase == Phase::Intermediate => phase,
            // A value that was refused leaves the instance as it was, and so does an unwelcome call of no effect.
            Status::Error
                if matches!(call, Call::DoStep | Call::ContinueStep | Call::ExitInitializationMode) =>
            {
                Phase::Error
            }
            Status::Discard if matches!(call, Call::DoStep | Call::ContinueStep) => self.after_discarded_step,
            _ => phase,
        }
    }
}
