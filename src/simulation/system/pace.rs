//! How a machine goes on in time: the steps that all its parts take together.

use serde::{Deserialize, Serialize};

use crate::model::state::Statistics;
use crate::numerics::step_control::StepControl;

/// Where a machine is in time, and how long its next step may be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    /// \[s] time.
    pub time: f64,
    /// Control of the step size.
    pub control: StepControl,
    /// Work of the steps since the start, without that of contacts.
    pub statistics: Statistics,
}
