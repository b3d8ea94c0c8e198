//! Sensitivities of a step: where it would have led from a slightly different start or under slightly different
//! boundaries, to first order.
//!
//! The step's equations `R(U, p) = 0` give `dU = -R_U^-1 R_p dp`. `R_U` is the Newton matrix at the solution, factorised
//! once for all perturbations by eliminating the balls; `R_p dp` is the residual of the perturbed step with the unknowns of
//! the step itself. What is left is of second order, and even: it cancels between two perturbations of opposite sign.

use super::accept::{StepEnd, accept};
use super::equations::BearingStep;
use super::{Boundary, Workspace};
use crate::model::Model;
use crate::model::state::State;
use crate::numerics::newton::Equations;

/// Takes perturbed states along a step of `h` \[s] from `start` that was `accepted` just now with that workspace; false if
/// the Newton matrix is singular.
#[must_use]
pub fn advance_perturbed<'a>(
    model: &Model,
    start: &State,
    boundary: &Boundary,
    h: f64,
    perturbed: impl Iterator<Item = (&'a mut State, Boundary)>,
    accepted: &Workspace,
    workspace: &mut Workspace,
) -> bool {
    let solution = &accepted.unknowns;
    let mut unknowns = vec![0.0; solution.len()];
    workspace.list_those_of(accepted);
    BearingStep::new(model, start, boundary, h, workspace).residual(solution, true);
    let mut regular = true;
    for (state, boundary) in perturbed {
        // The differences to the table are frozen in a step, in its perturbations too.
        state.differences.clone_from(&start.differences);
        let mut equations = BearingStep::new(model, state, &boundary, h, workspace);
        // No residual is small enough to be left alone: only its change counts.
        equations.force_tolerance = 0.0;
        equations.residual(solution, false);
        regular &= equations.correction(&mut unknowns);
        for (unknown, solved) in unknowns.iter_mut().zip(solution) {
            *unknown += solved;
        }
        equations.residual(&unknowns, false);
        let step = equations.step;
        let end = StepEnd::new(model, state, &boundary, h, workspace);
        accept(model, state, &boundary, &step, (workspace, &end));
    }
    regular
}
