//! One implicit step of bearings together with the structures that carry their races: of a bearing alone, of several on a shaft.

pub mod border;
mod dense;
pub mod elements;
mod joined;
mod sensitivity;
mod step;
mod structure;

use super::accept::{accept, renew_polynomials};
use super::equations::BearingStep;
use super::stages::{Stages, Starts};
use super::{Boundary, Counted, StepFailure, Workspace};
use crate::model::Model;
use crate::model::state::{State, Statistics};
use crate::model::structure::{Spin, StructureEnergies, StructureState, Turning};
use crate::numerics::arrowhead::BLOCK;
use crate::numerics::newton::{self, NewtonBuffers, NewtonFailure, NewtonWork, Patience};
use crate::numerics::size::larger;
use crate::numerics::step_control::StepControl;
use border::Border;
pub use border::KeptBorder;
pub use dense::{Stepped, within};
pub use sensitivity::{Perturbed, Started, advance_perturbed};
pub use step::{Joined, Joint, MayLeave, StructureStep, SystemStep};
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
    /// Matrix of the structures.
    pub border: Border,
    stages: Stages,
    starts: Starts,
    /// Work of the last trial.
    work: StepWork,
}

/// What is imposed at the end of a stage of a step, before that of the step.
#[derive(Clone, Debug)]
pub struct StageBounds {
    /// Boundary of each bearing.
    pub boundaries: Vec<Boundary>,
    /// Loads on each structure.
    pub loads: Vec<StructureLoad>,
}

/// Tries one step of `h` \[s] of bearings and the structures that carry their races; a bearing alone has none, and of bearings without states no part
/// is among them. `before_end` has the bounds of the
/// stages before the last, of which HHT has none. On success states of bearings
/// are the new ones, and those of the structures are returned; otherwise only statistics, step control, kept matrices and differences to
/// the table have changed.
///
/// # Errors
/// The index among the parts of the bearing where the residual or the local error is largest, and what failed; the step control has then been told.
// A function of its own in programs, too: scripts/measure step-instructions counts what it takes.
#[inline(never)]
pub fn try_step(
    parts: &mut [Part<'_>],
    structures: &[StructureStep<'_>],
    joined: Joined<'_>,
    (h, before_end): (f64, &[StageBounds]),
    control: &mut StepControl,
    workspace: &mut StepBuffers,
) -> Result<Vec<StructureState>, (usize, StepFailure)> {
    for Part { model, state, boundary, workspace } in &mut *parts {
        workspace.kept = std::mem::take(&mut state.matrix);
        workspace.factorised = false;
        workspace.counted = Counted::default();
        // Here and not at the end of a step, so that a state keeps those that its forces were computed with.
        renew_polynomials(model, state, boundary);
    }
    let StepBuffers { unknowns, newton, border, stages, starts, work: last_work } = workspace;
    let mut work = Work { newton: NewtonWork::default(), second: 0, buffers: newton };
    let mut stopped = None;
    if !before_end.is_empty() {
        stages.begin(parts, structures, starts);
    }
    for (stage, StageBounds { boundaries, loads }) in (1..).zip(before_end) {
        stages.prepare(stage, (parts, structures), h, starts);
        let at = starts.stage(Some(boundaries));
        let from = starts.structure_steps(structures, Some(loads));
        let mut equations = SystemStep::of_parts(parts, Some(&at), &from, joined, h, border);
        if let Err(failure) = work.solve(&mut equations, unknowns) {
            stopped = Some(equations.unsolved(failure));
            break;
        }
        equations.correct_once_more(unknowns);
        stages.reach(stage, &equations, unknowns);
    }
    let tried = match stopped {
        Some(stopped) => {
            control.fail();
            Err(stopped)
        }
        None => {
            // The last stage, and the only one of HHT, ends with the step.
            let last = (!before_end.is_empty()).then(|| before_end.len() + 1);
            if let Some(last) = last {
                stages.prepare(last, (parts, structures), h, starts);
            }
            let at = last.map(|_| starts.stage(None));
            let from = at.as_ref().map(|_| starts.structure_steps(structures, None));
            let own = from.as_deref().unwrap_or(structures);
            let mut equations = SystemStep::of_parts(parts, at.as_ref(), own, joined, h, border);
            match work.solve(&mut equations, unknowns) {
                Err(failure) => {
                    control.fail();
                    Err(equations.unsolved(failure))
                }
                Ok(()) => {
                    equations.correct_once_more(unknowns);
                    if let Some(last) = last {
                        stages.reach(last, &equations, unknowns);
                        stages.judge(&mut equations, h);
                    }
                    let reached = last.map(|_| &*stages);
                    let local = equations.local_error(structures, (h, reached));
                    let ends = equations.bearing_ends(h, reached);
                    let of_energy = equations.energy_error(&ends, h);
                    match control.judge(larger(local, of_energy)) {
                        true => Ok((ends, equations.step, std::mem::take(&mut equations.trials))),
                        false => Err(equations.too_inaccurate()),
                    }
                }
            }
        }
    };
    let done = StepWork {
        newton: work.newton,
        second: work.second,
        failure: tried.as_ref().err().map(|(_, failure)| *failure),
    };
    for Part { state, workspace, .. } in &mut *parts {
        state.matrix = std::mem::take(&mut workspace.kept);
        state.control = *control;
        done.count(&mut state.statistics, workspace.counted);
    }
    *last_work = done;
    let (ends, step, trials) = tried?;
    let mut rest = &unknowns[..];
    for (index, (part, end)) in parts.iter_mut().zip(&ends).enumerate() {
        let Part { model, state, boundary, workspace } = part;
        let (own, others) = rest.split_at(BLOCK * state.balls.len() + model.border_size());
        rest = others;
        match before_end.is_empty() {
            true => workspace.follow_trend(model, &mut state.trend, own, h),
            false => stages.follow(index, state, h),
        }
        accept(model, state, boundary, (h, &step), (workspace, end));
    }
    Ok(structures.iter().zip(trials).map(|(one, trial)| finished(one, trial.ended(one.model), h)).collect())
}

/// Work of the solves of a step, and their buffers.
struct Work<'a> {
    newton: NewtonWork,
    /// Solves that began anew.
    second: u64,
    buffers: &'a mut NewtonBuffers,
}

impl Work<'_> {
    /// Solves the equations of a step, or of a stage of it, from their first guess, or from the second one.
    fn solve(
        &mut self,
        equations: &mut SystemStep<'_>,
        unknowns: &mut Vec<f64>,
    ) -> Result<(), NewtonFailure> {
        equations.list_near();
        equations.guess(unknowns, false);
        let mut solve = |equations: &mut SystemStep<'_>, unknowns: &mut [f64], patience| {
            newton::solve(equations, unknowns, self.buffers, &mut self.newton, patience)?;
            // Each time around another pair of balls touches.
            while equations.list_touching() {
                newton::solve(equations, unknowns, self.buffers, &mut self.newton, patience)?;
            }
            Ok(())
        };
        solve(equations, unknowns, Patience::USUAL).or_else(|_: NewtonFailure| {
            equations.forget_matrices();
            equations.guess(unknowns, true);
            self.second += 1;
            solve(equations, unknowns, Patience::ALL)
        })
    }
}

/// Work of a trial of a step, which all bearings share.
#[derive(Clone, Copy, Debug, Default)]
struct StepWork {
    newton: NewtonWork,
    /// Solves that began anew.
    second: u64,
    /// Why the step was not taken.
    failure: Option<StepFailure>,
}

impl StepWork {
    /// Adds it to what was done before, with that of a bearing alone.
    fn count(&self, statistics: &mut Statistics, of: Counted) {
        statistics.newton.iterations += self.newton.iterations;
        statistics.newton.factorisations += self.newton.factorisations + of.renewals;
        statistics.contact_values += of.contact_values;
        statistics.contact_tangents += of.contact_tangents;
        statistics.second_guesses += self.second;
        match self.failure {
            Some(StepFailure::Newton(..)) => statistics.rejected_newton += 1,
            Some(StepFailure::Error(_)) => statistics.rejected_error += 1,
            None => {}
        }
    }
}

impl StepBuffers {
    /// Adds the work of the last trial to what was done before, for a bearing that was no part of it.
    pub fn count(&self, statistics: &mut Statistics) {
        self.work.count(statistics, Counted::default());
    }
}

/// The state of a structure after a step, where what it stores is known: its energies summed.
fn finished(one: &StructureStep<'_>, mut end: StructureState, h: f64) -> StructureState {
    let (before, after) = (&one.start.powers, &end.powers);
    let integral = |before: f64, after: f64| 0.5 * h * (before + after);
    let input = integral(before.input, after.input) + spun_up(one, &end, h) + sped_up(one, &end, h);
    let energies = &one.start.energies;
    end.energies = StructureEnergies {
        input: energies.input + input,
        worked: energies.worked + input.abs(),
        bearings: energies.bearings + integral(before.bearings, after.bearings),
        damping: energies.damping + integral(before.damping, after.damping),
        stored: end.energies.stored,
        at_start: energies.at_start,
    };
    end
}

/// \[J] what the trapezoidal rule misses of the work that a drive at a given speed does on the inertia of the spin: the torque jumps
/// where the script of the speed bends, but its work is the change of `1/2 I W^2`.
fn spun_up(one: &StructureStep<'_>, end: &StructureState, h: f64) -> f64 {
    if one.model.turning != Turning::Given {
        return 0.0;
    }
    let (before, after) = (&one.start.spin, &end.spin);
    let power = |spin: &Spin| spin.acceleration * spin.speed;
    let gained = 0.5 * (after.speed * after.speed - before.speed * before.speed);
    one.model.polar_inertia * (gained - 0.5 * h * (power(before) + power(after)))
}

/// \[J] the same of coordinates whose motion is given.
fn sped_up(one: &StructureStep<'_>, end: &StructureState, h: f64) -> f64 {
    let of = |k: &usize| {
        let power = |state: &StructureState| state.accelerations[*k] * state.rates[*k];
        let (before, after) = (one.start.rates[*k], end.rates[*k]);
        let gained = 0.5 * (after * after - before * before);
        one.model.mass[(*k, *k)] * (gained - 0.5 * h * (power(one.start) + power(end)))
    };
    one.model.held.iter().map(of).sum()
}
