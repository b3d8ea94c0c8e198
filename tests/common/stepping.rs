//! Single steps of a bearing alone.

use roulement::dynamics::system::{Joined, Part, StepBuffers, try_step};
use roulement::dynamics::{Boundary, Workspace};
use roulement::model::Model;
use roulement::model::state::State;

/// Takes a bearing one step of `h` \[s] on.
pub fn step(model: &Model, state: &mut State, boundary: &Boundary, h: f64, workspace: &mut Workspace) {
    let mut control = state.control;
    let mut part = [Part { model, state, boundary, workspace }];
    try_step(&mut part, &[], Joined::default(), (h, &[]), &mut control, &mut StepBuffers::default()).unwrap();
}
