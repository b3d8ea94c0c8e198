//! The equations of one trial step of bearings and the structures that carry their races: one Newton iteration for all.
//!
//! Balls, cages and races that nothing carries are eliminated bearing by bearing. What is left are the rows of the structures, the border.

use nalgebra::DVector;

use super::super::accept::StepEnd;
use super::super::equations::BearingStep;
use super::super::local_error::Allowed;
use super::super::matrix::prepare_correction;
use super::super::{StepFailure, Workspace, Worst};
use super::Part;
use super::border::{Border, CarriedRace};
use super::elements::{ElementStep, OnRaces, Seen};
use super::structure::{Seat, StructureLoad, StructureTrial};
use crate::dynamics::rest;
use crate::dynamics::stages::{Stage, Stages};
use crate::model::Model;
use crate::model::bodies::Race;
use crate::model::link::{Link, LinkForce, LinkState};
use crate::model::state::{KeptMatrix, State};
use crate::model::structure::{Structure, StructureState};
use crate::numerics::esdirk;
use crate::numerics::hht::HhtStep;
use crate::numerics::newton::{Equations, NewtonFailure, REFACTOR_CONTRACTION};
use crate::numerics::size::larger;
use crate::schema::Solver;

/// [-] contraction that asks for a new tangent where no bearing has states, over that of the settings. Such a tangent serves for many steps and takes as
/// long as three evaluations: the three-stage gearbox of the examples takes two corrections a step in place of three with it.
const RENEWED_EARLY: f64 = 0.03;

/// [-] share of a residual that a correction leaves at most with a border that serves for several steps: a new one takes as long as some corrections,
/// each of which leaves a tenth.
const BORDER_LEAVES: f64 = 0.1;

/// The scheme of a step of `h` \[s] of bearings in these states: that of their scenes, with more damping where all of them stand. Where none has states
/// it is that of the machine.
pub(super) fn scheme<'a>(
    bearings: impl Iterator<Item = (&'a Model, &'a State)> + Clone,
    joined: Joined<'_>,
    h: f64,
) -> HhtStep {
    let Some((first, _)) = bearings.clone().next() else {
        return HhtStep::new(joined.solver.map_or(Solver::default().alpha_f, |solver| solver.alpha_f), h);
    };
    let own = first.solver.alpha_f;
    let mut all = bearings;
    let stand = all.all(|(model, state)| rest::stands(model, rest::speeds(state)));
    HhtStep::new(if stand { own.max(rest::DAMPING) } else { own }, h)
}

/// A race of a bearing on a seat of a structure.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Index of the bearing.
    pub bearing: usize,
    /// The race.
    pub race: Race,
    /// Index of the structure.
    pub structure: usize,
    /// Where on it.
    pub seat: Seat,
}

/// Joints of the structures of a system: to races of its bearings, and to one another.
#[derive(Clone, Copy, Debug, Default)]
pub struct Joined<'a> {
    /// Races on their seats.
    pub joints: &'a [Joint],
    /// Links.
    pub links: &'a [Link],
    /// Their states at the start of the step.
    pub link_states: &'a [LinkState],
    /// Bearings without states.
    pub elements: &'a [ElementStep<'a>],
    /// Settings of the machine, if it is one.
    pub solver: Option<&'a Solver>,
    /// What a step may leave, where links are all that there is.
    pub of_links: Option<MayLeave>,
}

/// What a step may leave.
#[derive(Clone, Copy, Debug)]
pub struct MayLeave {
    /// \[N] residual.
    pub force: f64,
    /// Local error.
    pub error: Allowed,
}

/// A structure at the start of a step, and what acts on it.
#[derive(Clone, Copy, Debug)]
pub struct StructureStep<'a> {
    /// The structure.
    pub model: &'a Structure,
    /// [`Structure::scales`].
    pub scales: &'a DVector<f64>,
    /// State at the start.
    pub start: &'a StructureState,
    /// Loads from outside at the end.
    pub load: &'a StructureLoad,
}

/// The equations of a step of a system.
pub struct SystemStep<'a> {
    /// The bearings.
    pub bearings: Vec<BearingStep<'a>>,
    /// The structures.
    pub(super) structures: &'a [StructureStep<'a>],
    /// Their trials.
    pub trials: Vec<StructureTrial>,
    pub(super) joined: Joined<'a>,
    /// The scheme.
    pub step: HhtStep,
    /// Accelerations that are expected of the structures in a stage.
    expected: Option<&'a [DVector<f64>]>,
    /// First unknown of each bearing, then of each structure, and the end.
    first: Vec<usize>,
    /// First border row of each structure, and the end.
    pub(super) rows: Vec<usize>,
    /// Rows of it of coordinates whose motion is given.
    pub(super) held: Vec<usize>,
    pub(super) border: &'a mut Border,
    /// Is a new tangent asked for?
    asked: bool,
    /// [-] residual over its tolerance now, and where the last correction was found.
    norm: [f64; 2],
    /// [-] residual of each bearing over its tolerance.
    norms: Vec<f64>,
    /// Forces of links where the structures are.
    pub(super) link_forces: Vec<LinkForce>,
    /// Bearings without states where the structures are.
    pub(super) seen: Vec<(Seen, OnRaces)>,
    /// Carried races of each bearing.
    pub(super) carried: Vec<Vec<CarriedRace<'a>>>,
}

impl<'a> SystemStep<'a> {
    /// The equations of a step of `h` \[s] of bearings in these states, or of a stage of it.
    pub fn of_parts(
        parts: &'a mut [Part<'_>],
        stage: Option<&'a Stage<'a>>,
        structures: &'a [StructureStep<'a>],
        joined: Joined<'a>,
        h: f64,
        border: &'a mut Border,
    ) -> Self {
        let step = match stage {
            Some(_) => HhtStep::backward_euler(esdirk::DIAGONAL * h),
            None => scheme(parts.iter().map(|part| (part.model, &*part.state)), joined, h),
        };
        let of = |(index, part): (usize, &'a mut Part<'_>)| {
            let Part { model, state, boundary, workspace } = part;
            let Some(stage) = stage else {
                return BearingStep::new(model, state, boundary, step, workspace);
            };
            let boundary = stage.boundaries.map_or(*boundary, |boundaries| &boundaries[index]);
            let mut of_stage = BearingStep::new(model, &stage.starts[index], boundary, step, workspace);
            of_stage.before = state;
            of_stage.foreseen = Some(&stage.foreseen[index]);
            of_stage
        };
        let bearings: Vec<_> = parts.iter_mut().enumerate().map(of).collect();
        let expected = stage.map(|stage| stage.accelerations);
        Self { expected, ..Self::new(bearings, structures, joined, step, border) }
    }

    /// The equations of a step of bearings whose equations are these, with structures.
    pub fn new(
        bearings: Vec<BearingStep<'a>>,
        structures: &'a [StructureStep<'a>],
        joined: Joined<'a>,
        step: HhtStep,
        border: &'a mut Border,
    ) -> Self {
        let trials = structures.iter().map(|one| StructureTrial::new(one.start)).collect();
        let mut equations = Self {
            bearings,
            structures,
            trials,
            joined,
            step,
            expected: None,
            first: vec![],
            rows: vec![],
            held: vec![],
            border,
            asked: false,
            norm: [0.0, f64::INFINITY],
            norms: vec![],
            link_forces: vec![],
            seen: vec![],
            carried: vec![],
        };
        if equations.alone().is_none() {
            equations.lay_out();
        }
        equations
    }

    /// Finds the places of all unknowns and of the rows of the border.
    fn lay_out(&mut self) {
        let ends = |sizes: &mut dyn Iterator<Item = usize>| {
            let mut end = 0;
            [0].into_iter()
                .chain(sizes.map(|size| {
                    end += size;
                    end
                }))
                .collect::<Vec<_>>()
        };
        let of_structure = |one: &StructureStep<'_>| one.model.size();
        let of_structures = self.structures.iter().map(of_structure);
        self.rows = ends(&mut of_structures.clone());
        let held = |(one, at): (&'a StructureStep<'a>, usize)| one.model.held.iter().map(move |k| at + k);
        self.held = self.structures.iter().zip(self.rows.iter().copied()).flat_map(held).collect();
        self.first = ends(&mut self.bearings.iter().map(BearingStep::size).chain(of_structures));
        let bearings = self.bearings.iter().enumerate();
        let carried = |(index, step)| CarriedRace::of_bearing(index, step, self.joined.joints, &self.rows);
        self.carried = bearings.map(carried).collect();
    }

    /// A bearing that no structure carries has the equations of the step for itself: they need no border beside its own.
    fn alone(&mut self) -> Option<&mut BearingStep<'a>> {
        match &mut self.bearings[..] {
            [bearing] if self.structures.is_empty() => Some(bearing),
            _ => None,
        }
    }

    /// Lists the pairs of balls that may touch in the step.
    pub fn list_near(&mut self) {
        self.bearings.iter_mut().for_each(BearingStep::list_near);
    }

    /// Number of unknowns.
    fn size(&self) -> usize {
        self.first[self.first.len() - 1]
    }

    /// First guess: everything keeps its acceleration, balls along their orbits; those of bearings change as they did before.
    pub fn guess(&mut self, unknowns: &mut Vec<f64>, steady_velocity: bool) {
        let of = |bearing: &mut BearingStep<'_>, own: &mut Vec<f64>| match steady_velocity {
            true => bearing.guess_steady_velocity(own),
            false => bearing.guess_steady_trend(own),
        };
        if let Some(bearing) = self.alone() {
            return of(bearing, unknowns);
        }
        unknowns.clear();
        let mut own = vec![];
        for bearing in &mut self.bearings {
            of(bearing, &mut own);
            unknowns.extend(&own);
        }
        for (index, one) in self.structures.iter().enumerate() {
            let accelerations = self.expected.map_or(&one.start.accelerations, |expected| &expected[index]);
            unknowns.extend(accelerations.iter());
        }
    }

    /// Corrects balls once more without evaluation in a step that is solved, where no border joins them.
    pub fn correct_once_more(&mut self, unknowns: &mut [f64]) {
        if let Some(bearing) = self.alone() {
            bearing.correct_once_more(unknowns);
        }
    }

    /// Lists pairs of balls that touch in the solved step and were not listed; are there some?
    pub fn list_touching(&mut self) -> bool {
        // All of them look.
        let touching = self.bearings.iter_mut().filter_map(|step| step.list_touching().then_some(()));
        touching.count() > 0
    }

    /// Factorises the border where that which is there does not serve: it is of other steps or rows of bearings, a new tangent was asked for, or the last
    /// correction left too much.
    fn renew_border(&mut self) {
        let rows = self.bearings.iter().map(|step| step.workspace.reduced.as_slice());
        let left = self.norm[0] / self.norm[1];
        if self.asked || left > BORDER_LEAVES || !self.border.serves(self.step.force_gains(), rows) {
            self.factorise();
        }
        (self.asked, self.norm[1]) = (false, self.norm[0]);
    }

    /// Goes on without the matrices of earlier steps.
    pub fn forget_matrices(&mut self) {
        self.bearings.iter_mut().for_each(|step| step.workspace.kept = KeptMatrix::default());
    }

    /// Where the residual is largest after Newton's method gave up.
    pub fn unsolved(&self, failure: NewtonFailure) -> (usize, StepFailure) {
        let index = index_of_largest(self.norms.iter().copied());
        let worst = self.bearings.get(index).map_or(Worst::NOTHING, BearingStep::worst_residual);
        (index, StepFailure::Newton(failure, worst))
    }

    /// Where the local error is largest in a step that is refused for it.
    pub fn too_inaccurate(&self) -> (usize, StepFailure) {
        let index = index_of_largest(self.bearings.iter().map(BearingStep::local_error));
        (index, StepFailure::Error(self.bearings.get(index).map_or(Worst::NOTHING, BearingStep::worst_error)))
    }

    /// The ends of a solved step.
    pub fn bearing_ends(&mut self, h: f64, stages: Option<&Stages>) -> Vec<StepEnd> {
        for one in &mut self.bearings {
            let Workspace { spacing, groups, .. } = &mut *one.workspace;
            spacing.iter_mut().for_each(|trial| trial.press(groups));
        }
        let of = |(index, one): (usize, &BearingStep<'_>)| {
            let powers = stages.map(|stages| stages.powers(index));
            StepEnd::new(one.model, (one.before, powers.as_ref()), one.boundary, h, one.workspace)
        };
        self.bearings.iter().enumerate().map(of).collect()
    }

    /// [-] error of the step by the energy that its bearings leave unaccounted for, the largest.
    pub fn energy_error(&self, ends: &[StepEnd], h: f64) -> f64 {
        let of = |(one, end): (&BearingStep<'_>, &StepEnd)| {
            end.energy_error(one.model, one.before, one.boundary, h, one.workspace)
        };
        self.bearings.iter().zip(ends).map(of).fold(0.0, larger)
    }

    /// [-] local error over its tolerance: the largest of all bearings and structures, which are in these states before the step of `h` \[s].
    pub fn local_error(&self, before: &[StructureStep<'_>], (h, stages): (f64, Option<&Stages>)) -> f64 {
        let bearings = self.bearings.iter().map(BearingStep::local_error);
        let of_elements = self.joined.elements.iter().map(|element| element.may_leave.error);
        let of_links = self.joined.of_links.map(|may_leave| may_leave.error);
        let all = self.bearings.iter().map(BearingStep::allowed).chain(of_elements).chain(of_links);
        let allowed = all.reduce(Allowed::and);
        let structures = before.iter().zip(&self.trials).enumerate().map(|(index, (one, trial))| {
            let mut change = &trial.end.accelerations - &one.start.accelerations;
            one.model.held.iter().for_each(|k| change[*k] = 0.0);
            let size = |moved: DVector<f64>| (moved.norm_squared() / moved.len().max(1) as f64).sqrt();
            let error = match stages {
                Some(stages) => {
                    let mut error = stages.structure_error(index, h);
                    one.model.held.iter().for_each(|k| error[*k] = 0.0);
                    size(error.component_mul(one.scales))
                }
                None => {
                    let gain =
                        (self.step.beta - 0.5 * self.step.alpha_f - 1.0 / 6.0) * self.step.h * self.step.h;
                    size(change.component_mul(one.scales)) * gain.abs()
                }
            };
            let force = || [(&one.model.mass * &change).component_div(one.scales).amax()];
            // A system has a bearing at least, or links.
            allowed.map_or(0.0, |allowed| allowed.square([error * error], force).sqrt())
        });
        bearings.chain(structures).fold(0.0, larger)
    }
}

/// Index of the largest of some norms; what is not a number is the largest.
fn index_of_largest(norms: impl Iterator<Item = f64>) -> usize {
    let norm = |norm: f64| if norm.is_nan() { f64::INFINITY } else { norm };
    norms.enumerate().max_by(|a, b| norm(a.1).total_cmp(&norm(b.1))).map_or(0, |(index, _)| index)
}

impl Equations for SystemStep<'_> {
    fn residual(&mut self, unknowns: &[f64], with_tangent: bool) -> f64 {
        if let Some(bearing) = self.alone() {
            return bearing.residual(unknowns, with_tangent);
        }
        let count = self.bearings.len();
        for (index, (one, trial)) in self.structures.iter().zip(&mut self.trials).enumerate() {
            let own = &unknowns[self.first[count + index]..self.first[count + index + 1]];
            trial.move_to(one.model, own, one.start, &self.step, one.load);
        }
        self.see_structures();
        self.asked |= with_tangent;
        self.norms.clear();
        for (index, step) in self.bearings.iter_mut().enumerate() {
            let own = &unknowns[self.first[index]..self.first[index + 1]];
            self.norms.push(step.residual(own, with_tangent));
        }
        let structures = self.assemble_structures();
        self.norm[0] = self.norms.iter().fold(structures, |norm, own| larger(norm, *own));
        self.norm[0]
    }

    fn has_tangent(&self) -> bool {
        match self.bearings.is_empty() {
            true => self.border.serves(self.step.force_gains(), std::iter::empty()),
            false => self.bearings.iter().all(Equations::has_tangent),
        }
    }

    fn correction(&mut self, correction: &mut [f64]) -> bool {
        if let Some(bearing) = self.alone() {
            return bearing.correction(correction);
        }
        prepare_correction(&mut self.bearings);
        // Balls that were brought back press differently.
        if !self.bearings.is_empty() {
            self.assemble_structures();
        }
        self.renew_border();
        let border = &mut *self.border;
        border.right.resize_vertically_mut(self.rows[self.structures.len()], 0.0);
        for (trial, at) in self.trials.iter().zip(&self.rows) {
            border.right.rows_mut(*at, trial.residual.len()).copy_from(&-&trial.residual);
        }
        for (step, carried) in self.bearings.iter_mut().zip(&self.carried) {
            if !step.eliminate() {
                return false;
            }
            let own = &step.workspace.border_correction;
            carried.iter().for_each(|race| race.project(own, &mut border.right));
        }
        self.held.iter().for_each(|row| border.right[*row] = 0.0);
        if !border.solve() {
            return false;
        }
        let mut regular = true;
        for (index, (step, carried)) in self.bearings.iter_mut().zip(&self.carried).enumerate() {
            let own = &mut step.workspace.border_correction;
            carried.iter().for_each(|race| race.lift(&border.right, own));
            regular &= step.substitute(&mut correction[self.first[index]..self.first[index + 1]]);
        }
        correction[self.first[self.bearings.len()]..].copy_from_slice(border.right.as_slice());
        debug_assert_eq!(correction.len(), self.size());
        regular
    }

    fn refactor_contraction(&self) -> f64 {
        let contraction = |step: &BearingStep<'_>| step.model.solver.matrix_reuse;
        let of_machine =
            || RENEWED_EARLY * self.joined.solver.map_or(REFACTOR_CONTRACTION, |solver| solver.matrix_reuse);
        self.bearings.iter().map(contraction).reduce(f64::min).unwrap_or_else(of_machine)
    }
}
