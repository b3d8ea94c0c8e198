//! One implicit step of bearings together with the structures that carry their races: of a bearing alone, of several on a shaft.

mod border;
mod dense;
mod sensitivity;
mod step;
mod structure;

use super::accept::{accept, renew_polynomials};
use super::equations::BearingStep;
use super::{Boundary, Counted, StepFailure, Workspace};
use crate::model::Model;
use crate::model::state::{State, Statistics};
use crate::model::structure::{Spin, StructureEnergies, StructureState, Turning};
use crate::numerics::arrowhead::BLOCK;
use crate::numerics::hht::HhtStep;
use crate::numerics::newton::{self, NewtonBuffers, NewtonWork, Patience};
use crate::numerics::size::larger;
use crate::numerics::step_control::StepControl;
use border::Border;
pub use dense::{Stepped, within};
pub use sensitivity::{Perturbed, Started, advance_perturbed};
pub use step::{Joined, Joint, StructureStep, SystemStep};
pub use structure::{Seat, StructureLoad, StructureTrial};

/// A bearing of a system in a step.
pub struct Part<'a> {
    /// Its model.
    pub model: &'a Model,
    /// Its state.
    pub state: &'a mut State,
    /// Boundary of it at the end of the step.
    pub boundary: &'a Boundary,
    /// Its buffers.
    pub workspace: &'a mut Workspace,
}

/// Buffers of a step, beside those of its bearings, kept between steps.
#[derive(Clone, Debug, Default)]
pub struct StepBuffers {
    /// Unknowns of the last step.
    pub unknowns: Vec<f64>,
    newton: NewtonBuffers,
    border: Border,
}

/// Tries one step of `h` \[s] of bearings and the structures that carry their races; a bearing alone has none. On success states of bearings
/// are the new ones, and those of the structures are returned; otherwise only statistics, step control, kept matrices and differences to
/// the table have changed.
///
/// # Errors
/// The index of the bearing where the residual or the local error is largest, and what failed; the step control has then been told.
// A function of its own in programs, too: scripts/step-instructions counts what it takes.
#[inline(never)]
pub fn try_step(
    parts: &mut [Part<'_>],
    structures: &[StructureStep<'_>],
    joined: Joined<'_>,
    h: f64,
    control: &mut StepControl,
    workspace: &mut StepBuffers,
) -> Result<Vec<StructureState>, (usize, StepFailure)> {
    for Part { model, state, boundary, workspace } in &mut *parts {
        workspace.kept = std::mem::take(&mut state.matrix);
        workspace.factorised = false;
        // Here and not at the end of a step, so that a state keeps those that its forces were computed with.
        renew_polynomials(model, state, boundary);
    }
    let StepBuffers { unknowns, newton: buffers, border } = workspace;
    let mut work = NewtonWork::default();
    let mut second = 0;
    let mut equations = SystemStep::of_parts(parts, structures, joined, h, border);
    equations.list_near();
    equations.guess(unknowns, false);
    let mut solve = |equations: &mut SystemStep<'_>, unknowns: &mut [f64], patience| {
        newton::solve(equations, unknowns, buffers, &mut work, patience)?;
        // Each time around another pair of balls touches.
        while equations.list_touching() {
            newton::solve(equations, unknowns, buffers, &mut work, patience)?;
        }
        Ok(())
    };
    let mut solved = solve(&mut equations, unknowns, Patience::USUAL);
    if solved.is_err() {
        equations.forget_matrices();
        equations.guess(unknowns, true);
        solved = solve(&mut equations, unknowns, Patience::ALL);
        second = 1;
    }
    let tried = match solved {
        Err(failure) => {
            control.fail();
            Err(equations.unsolved(failure))
        }
        Ok(()) => {
            equations.correct_once_more(unknowns);
            let local = equations.local_error();
            let ends = equations.bearing_ends();
            let of_energy = equations.energy_error(&ends);
            match control.judge(larger(local, of_energy)) {
                true => Ok(ends),
                false => Err(equations.too_inaccurate()),
            }
        }
    };
    let step = equations.step;
    let trials = std::mem::take(&mut equations.trials);
    drop(equations);
    for Part { state, workspace, .. } in &mut *parts {
        state.matrix = std::mem::take(&mut workspace.kept);
        state.control = *control;
        count(&mut state.statistics, workspace.counted, work, second);
        match tried {
            Err((_, StepFailure::Newton(..))) => state.statistics.rejected_newton += 1,
            Err((_, StepFailure::Error(_))) => state.statistics.rejected_error += 1,
            Ok(_) => {}
        }
    }
    let mut rest = &unknowns[..];
    for (part, end) in parts.iter_mut().zip(&tried?) {
        let Part { model, state, boundary, workspace } = part;
        let (own, others) = rest.split_at(BLOCK * state.balls.len() + model.border_size());
        rest = others;
        workspace.follow_trend(model, &mut state.trend, own, h);
        accept(model, state, boundary, &step, (workspace, end));
    }
    Ok(structures.iter().zip(trials).map(|(one, trial)| finished(one, trial.end, &step)).collect())
}

/// Adds the work of a bearing in a step to what was done before.
fn count(statistics: &mut Statistics, of: Counted, work: NewtonWork, second: u64) {
    statistics.newton.iterations += work.iterations;
    statistics.newton.factorisations += work.factorisations + of.renewals;
    statistics.contact_values += of.contact_values;
    statistics.contact_tangents += of.contact_tangents;
    statistics.second_guesses += second;
}

/// The state of a structure after a step: its energies summed.
fn finished(one: &StructureStep<'_>, mut end: StructureState, step: &HhtStep) -> StructureState {
    let (before, after) = (&one.start.powers, &end.powers);
    let integral = |before: f64, after: f64| 0.5 * step.h * (before + after);
    let input = integral(before.input, after.input) + spun_up(one, &end, step) + sped_up(one, &end, step);
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

/// \[J] the same of coordinates whose motion is given.
fn sped_up(one: &StructureStep<'_>, end: &StructureState, step: &HhtStep) -> f64 {
    let of = |k: &usize| {
        let power = |state: &StructureState| state.accelerations[*k] * state.rates[*k];
        let (before, after) = (one.start.rates[*k], end.rates[*k]);
        let gained = 0.5 * (after * after - before * before);
        one.model.mass[(*k, *k)] * (gained - 0.5 * step.h * (power(one.start) + power(end)))
    };
    one.model.held.iter().map(of).sum()
}
