//! One implicit step of a system: several bearings, and structures that carry their races.

mod dense;
mod sensitivity;
mod step;
mod structure;

use super::accept::{StepEnd, accept, renew_polynomials};
use super::equations::BearingStep;
use super::{Boundary, StepFailure, Workspace, Worst};
use crate::model::Model;
use crate::model::state::{State, Statistics};
use crate::model::structure::{Spin, StructureEnergies, StructureState, Turning};
use crate::numerics::arrowhead::BLOCK;
use crate::numerics::hht::HhtStep;
use crate::numerics::newton::{self, NewtonBuffers, NewtonWork};
use crate::numerics::size::larger;
use crate::numerics::step_control::StepControl;
pub use dense::{Stepped, within};
pub use sensitivity::{Perturbed, Started, advance_perturbed};
pub use step::{Joint, StructureStep, SystemStep};
pub use structure::{Seat, StructureLoad, StructureTrial};

/// [-] damping parameter of a system without bearings.
const DEFAULT_ALPHA: f64 = 0.05;

/// A bearing of a system in a step.
pub struct Part<'a> {
    /// Its model.
    pub model: &'a Model,
    /// Its state.
    pub state: &'a mut State,
    /// What is imposed on it at the end of the step.
    pub boundary: &'a Boundary,
    /// Its buffers.
    pub workspace: &'a mut Workspace,
}

/// Buffers of a system's step, kept between steps.
#[derive(Clone, Debug, Default)]
pub struct SystemWorkspace {
    /// Unknowns of the last step.
    pub unknowns: Vec<f64>,
    newton: NewtonBuffers,
}

/// Tries one step of `h` \[s] of a system. On success states of bearings are the new ones, and those of the structures are returned;
/// otherwise only statistics, kept matrices and the step control have changed.
///
/// # Errors
/// The index of the bearing where the residual or the local error is largest, and what failed.
// A function of its own in programs, too: scripts/step-instructions counts what it takes.
#[inline(never)]
pub fn try_step(
    parts: &mut [Part<'_>],
    structures: &[StructureStep<'_>],
    joints: &[Joint],
    h: f64,
    control: &mut StepControl,
    workspace: &mut SystemWorkspace,
) -> Result<Vec<StructureState>, (usize, StepFailure)> {
    for part in &mut *parts {
        part.workspace.kept = std::mem::take(&mut part.state.matrix);
        part.workspace.factorised = false;
        renew_polynomials(part.model, part.state, part.boundary);
    }
    let SystemWorkspace { unknowns, newton: buffers } = workspace;
    let mut work = NewtonWork::default();
    let mut second = 0;
    let steps: Vec<_> = parts.iter_mut().map(|part| part.begin(h)).collect();
    let step = steps.first().map_or(HhtStep::new(DEFAULT_ALPHA, h), |step| step.step);
    let mut equations = SystemStep::new(steps, structures, joints, step);
    equations.guess(unknowns, false);
    let mut solve = |equations: &mut SystemStep<'_>, unknowns: &mut [f64]| {
        newton::solve(equations, unknowns, buffers, &mut work)?;
        // Each time around another pair of balls has met.
        while equations.list_met() {
            newton::solve(equations, unknowns, buffers, &mut work)?;
        }
        Ok(())
    };
    let mut solved = solve(&mut equations, unknowns);
    if solved.is_err() {
        equations.forget_matrices();
        equations.guess(unknowns, true);
        solved = solve(&mut equations, unknowns);
        second = 1;
    }
    let worst = equations.worst();
    let ends: Vec<_> = equations.bearings.iter().map(BearingEnd::of).collect();
    let trials: Vec<_> = equations.trials.iter().map(|trial| trial.end.clone()).collect();
    let local = equations.local_error();
    drop(equations);
    let mut energy = 0.0;
    let mut step_ends = vec![];
    for (part, end) in parts.iter_mut().zip(&ends) {
        let Part { model, state, boundary, workspace } = part;
        state.matrix = std::mem::take(&mut workspace.kept);
        end.count(&mut state.statistics, work, second);
        if solved.is_ok() {
            let end = StepEnd::new(model, state, boundary, h, workspace);
            energy = larger(energy, end.energy_error(model, state, boundary, h, workspace));
            step_ends.push(end);
        }
    }
    if let Err(failure) = solved {
        control.fail();
        parts.iter_mut().for_each(|part| part.state.statistics.rejected_newton += 1);
        return Err((worst, StepFailure::Newton(failure, ends[worst].residual)));
    }
    if !control.judge(larger(local, energy)) {
        parts.iter_mut().for_each(|part| part.state.statistics.rejected_error += 1);
        let worst = step::index_of_largest(ends.iter().map(|end| end.local));
        return Err((worst, StepFailure::Error(ends[worst].error)));
    }
    let mut rest = &unknowns[..];
    for (part, end) in parts.iter_mut().zip(&step_ends) {
        let Part { model, state, boundary, workspace } = part;
        let (own, others) = rest.split_at(BLOCK * state.balls.len() + model.border_size());
        rest = others;
        workspace.follow_trend(model, &mut state.trend, own, h);
        accept(model, state, boundary, &step, (workspace, end));
        state.control = *control;
    }
    let ends = structures.iter().zip(trials).map(|(one, end)| finished(one, end, &step));
    Ok(ends.collect())
}

/// What is kept of the equations of a bearing.
struct BearingEnd {
    renewals: u64,
    contact_values: u64,
    contact_tangents: u64,
    residual: Worst,
    error: Worst,
    local: f64,
}

impl BearingEnd {
    fn of(step: &BearingStep<'_>) -> Self {
        Self {
            renewals: step.renewals,
            contact_values: step.contact_values,
            contact_tangents: step.contact_tangents,
            residual: step.worst_residual(),
            error: step.worst_error(),
            local: step.local_error(),
        }
    }

    fn count(&self, statistics: &mut Statistics, work: NewtonWork, second: u64) {
        statistics.newton.iterations += work.iterations;
        statistics.newton.factorisations += work.factorisations + self.renewals;
        statistics.contact_values += self.contact_values;
        statistics.contact_tangents += self.contact_tangents;
        statistics.second_guesses += second;
    }
}

impl Part<'_> {
    /// The equations of a step of `h` \[s].
    fn begin(&mut self, h: f64) -> BearingStep<'_> {
        let Self { model, state, boundary, workspace } = self;
        let mut step = BearingStep::new(model, state, boundary, h, workspace);
        step.list_near();
        step
    }
}

/// The state of a structure after a step: its energies summed.
fn finished(one: &StructureStep<'_>, mut end: StructureState, step: &HhtStep) -> StructureState {
    let (before, after) = (&one.start.powers, &end.powers);
    let integral = |before: f64, after: f64| 0.5 * step.h * (before + after);
    let input = integral(before.input, after.input) + spun_up(one, &end, step);
    let energies = &one.start.energies;
    end.energies = StructureEnergies {
        input: energies.input + input,
        worked: energies.worked + input.abs(),
        bearings: energies.bearings + integral(before.bearings, after.bearings),
        damping: energies.damping + integral(before.damping, after.damping),
        stored: one.model.stored(&end.coordinates, &end.rates, &end.spin),
        at_start: energies.at_start,
    };
    end
}

/// \[J] what the trapezoidal rule misses of the work that a drive at a given speed does on the inertia of the spin: the torque jumps
/// where the script of the speed bends, but its work is the change of `1/2 I W^2`.
fn spun_up(one: &StructureStep<'_>, end: &StructureState, step: &HhtStep) -> f64 {
    if one.model.turning != Turning::Given {
        return 0.0;
    }
    let (before, after) = (&one.start.spin, &end.spin);
    let power = |spin: &Spin| spin.acceleration * spin.speed;
    let gained = 0.5 * (after.speed * after.speed - before.speed * before.speed);
    one.model.polar_inertia * (gained - 0.5 * step.h * (power(before) + power(after)))
}
