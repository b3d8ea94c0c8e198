//! Sensitivities of a step: where it would have led from a slightly different start or under slightly different
//! boundaries, to first order.
//!
//! The step's equations `R(U, p) = 0` give `dU = -R_U^-1 R_p dp`. `R_U` is the Newton matrix at the solution, factorised
//! once for all perturbations by eliminating the balls; `R_p dp` is the residual of the perturbed step with the unknowns of
//! the step itself. What is left is of second order, and even: it cancels between two perturbations of opposite sign.

use super::border::Border;
use super::step::{Joined, StructureStep, SystemStep, scheme};
use super::{BearingStep, finished};
use crate::dynamics::accept::accept;
use crate::dynamics::{Boundary, Workspace};
use crate::model::Model;
use crate::model::state::State;
use crate::model::structure::StructureState;
use crate::numerics::newton::Equations;

/// A bearing of a system at the start of a step, and what was imposed on it at its end.
pub struct Started<'a> {
    /// Its model.
    pub model: &'a Model,
    /// Its state at the start.
    pub start: &'a State,
    /// Boundary that was imposed.
    pub boundary: &'a Boundary,
    /// Its buffers as the accepted step left them.
    pub accepted: &'a Workspace,
}

/// A system under slightly different inputs.
pub struct Perturbed<'a> {
    /// State of every bearing at the start of the step, then at its end.
    pub states: Vec<&'a mut State>,
    /// Boundary of each at the end.
    pub boundaries: &'a [Boundary],
    /// Structures at the start, and what acts on them.
    pub structures: Vec<StructureStep<'a>>,
}

/// Takes perturbed systems along a step of `h` \[s] whose accepted unknowns are a solution; gives the states of their structures. None if
/// the Newton matrix is singular.
pub fn advance_perturbed<'a>(
    bearings: &[Started<'_>],
    structures: &[StructureStep<'_>],
    joined: Joined<'_>,
    (h, solution): (f64, &[f64]),
    perturbed: impl Iterator<Item = Perturbed<'a>>,
    aside: &mut Vec<Workspace>,
) -> Option<Vec<Vec<StructureState>>> {
    aside.resize_with(bearings.len(), Workspace::default);
    for (own, bearing) in aside.iter_mut().zip(bearings) {
        own.list_those_of(bearing.accepted);
    }
    let step = scheme(bearings.iter().map(|of| (of.model, of.start)), joined, h);
    let steps = bearings.iter().zip(aside.iter_mut());
    let steps: Vec<_> = steps
        .map(|(of, workspace)| BearingStep::new(of.model, of.start, of.boundary, step, workspace))
        .collect();
    SystemStep::new(steps, structures, joined, step, &mut Border::default()).residual(solution, true);
    let mut unknowns = vec![0.0; solution.len()];
    let mut ends = vec![];
    for Perturbed { mut states, boundaries, structures } in perturbed {
        // The differences to the table are frozen in a step, in its perturbations too.
        for (state, bearing) in states.iter_mut().zip(bearings) {
            state.differences.clone_from(&bearing.start.differences);
        }
        let parts = bearings.iter().zip(&states).zip(boundaries).zip(aside.iter_mut());
        let steps = parts.map(|(((bearing, state), boundary), workspace)| {
            let mut own = BearingStep::new(bearing.model, state, boundary, step, workspace);
            // No residual is small enough to be left alone: only its change counts.
            own.force_tolerance = 0.0;
            own
        });
        // Its tangent is its own.
        let mut border = Border::default();
        let mut equations = SystemStep::new(steps.collect(), &structures, joined, step, &mut border);
        equations.residual(solution, false);
        if !equations.correction(&mut unknowns) {
            return None;
        }
        for (unknown, solved) in unknowns.iter_mut().zip(solution) {
            *unknown += solved;
        }
        equations.residual(&unknowns, false);
        let ended =
            equations.trials.iter().zip(&structures).map(|(trial, one)| trial.clone().ended(one.model));
        let trials: Vec<_> = ended.collect();
        let of_bearings = equations.bearing_ends(h, None);
        drop(equations);
        let parts = bearings.iter().zip(&mut states).zip(boundaries).zip(aside.iter_mut());
        for ((((bearing, state), boundary), workspace), end) in parts.zip(&of_bearings) {
            accept(bearing.model, state, boundary, (h, &step), (workspace, end));
        }
        ends.push(structures.iter().zip(trials).map(|(one, end)| finished(one, end, h)).collect());
    }
    Some(ends)
}
