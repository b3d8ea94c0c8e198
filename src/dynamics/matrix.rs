//! The Newton matrix of a step: balls, eliminated, and what they leave in the bodies' rows. Many steps share both.
//!
//! A ball's block turns with its orbit and changes with its load, and blocks are computed anew one by one ([`super::stale_blocks`]).

use nalgebra::{DMatrix, DVector, Matrix3, Vector3, Vector6};

use super::equations::BearingStep;
use super::group::Groups;
use super::{Workspace, stale_blocks};
use crate::model::bodies::{Body, Race};
use crate::model::state::{BlockRenewal, KeptBlock, KeptBorder};
use crate::numerics::arrowhead::{BLOCK, Block, Eliminated, Member, Offsets, Six};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::orbit_turn::OrbitTurn;
use crate::numerics::ring::Link;
use crate::numerics::scalar::constant_vector;

impl Workspace {
    /// Lists the bodies that forces move, as they are in the trial step.
    pub(super) fn list_members(&mut self, offsets: Offsets) {
        self.members.clear();
        for (body, trial) in self.bodies.iter() {
            if let (Some(from), Some(trial)) = (offsets[body.index()], trial) {
                self.members.push(Member { slot: body.index(), from, axes: trial.own_axes() });
            }
        }
    }
}

impl BearingStep<'_> {
    /// Eliminates the balls whose derivatives are new; without any matrix if one of them is singular.
    pub(super) fn eliminate_renewed(&mut self) {
        self.workspace.list_members(self.model.border_offsets());
        let origin = self.races_origin();
        let Workspace { balls, groups, kept, members, neighbours, factorised, .. } = &mut *self.workspace;
        if !neighbours.is_empty() {
            *factorised = false;
            return;
        }
        if kept.balls.len() != balls.len() || (kept.step - self.step.h).abs() > 1e-6 * self.step.h {
            kept.balls.clear();
        }
        let groups_of_balls = balls.len().div_ceil(WIDTH);
        let shares = self.model.spacing.is_some();
        kept.blocks.resize_with(groups_of_balls, || Eliminated::none(members.len(), shares));
        for (index, trial) in balls.iter().enumerate().filter(|(_, trial)| trial.renewed) {
            *factorised = false;
            if !kept.blocks[index / WIDTH].put(index % WIDTH, &trial.block, members) {
                kept.balls.clear();
                return;
            }
            let last = kept.balls.get(index).map(|kept| kept.renewal).unwrap_or_default();
            let renewal = BlockRenewal { price: 0.0, new: true, ..last };
            let new = KeptBlock { offset: groups.position(index) - origin, renewal };
            match kept.balls.get_mut(index) {
                Some(kept) => *kept = new,
                None => kept.balls.push(new),
            }
        }
        kept.step = self.step.h;
    }

    /// Factorises the rows of the bodies, with what the balls leave in them; the bodies have derivatives. Rows of races that are carried
    /// are left to what carries them, without the others.
    pub(super) fn factorise(&mut self) {
        self.assemble_blocks();
        self.workspace.list_members(self.model.border_offsets());
        let origin = self.races_origin();
        let guide = self.model.cage_guide().map(Body::from);
        let (offsets, rows) = (self.model.border_offsets(), self.model.border_size());
        let model = self.model;
        let Workspace {
            balls,
            groups,
            bodies,
            cage,
            kept,
            members,
            neighbours,
            arrowhead,
            ring,
            reduced: border,
            ..
        } = &mut *self.workspace;
        if border.nrows() == rows {
            border.as_mut_slice().fill(0.0);
        } else {
            *border = DMatrix::zeros(rows, rows);
        }
        for member in members.iter() {
            if let Some(trial) = Body::ALL.get(member.slot).and_then(|body| bodies.get(*body)?.as_ref()) {
                let own = trial.residual.len();
                for (k, column) in trial.block.as_slice().chunks_exact(own).enumerate() {
                    let from = rows * (member.from + k) + member.from;
                    border.as_mut_slice()[from..from + own].copy_from_slice(column);
                }
            }
        }
        if let (Some(cage), Some(guide)) = (cage, guide)
            && let (Some(race), Some(own)) = (offsets[guide.index()], offsets[Body::Cage.index()])
        {
            let size = (BLOCK, BLOCK);
            border.view_mut((race, own), size).copy_from(&cage.race_by_cage);
            border.view_mut((own, race), size).copy_from(&cage.cage_by_race);
        }
        if neighbours.is_empty() {
            arrowhead.place(turns(&kept.balls, groups, &origin), (members, model.spacing_row()));
            arrowhead.reduce(kept.blocks.iter(), border);
        } else {
            let blocks: Vec<&Block> = balls.iter().map(|trial| &trial.block).collect();
            let links: Vec<Link> = neighbours.iter().map(|pair| pair.link).collect();
            *border = ring.reduce(&blocks, &links, border, offsets);
        }
        let KeptBorder { rows, axes } = &mut kept.border;
        rows.clear();
        rows.extend_from_slice(border.as_slice());
        axes.clear();
        axes.extend(members.iter().map(|member| member.axes));
        self.workspace.factors_of.clear();
        self.renewed_rows = true;
        self.take_up_border();
    }

    /// Factorises the rows of the bodies as they are kept, unless that was done.
    pub(super) fn take_up_border(&mut self) {
        let (model, offsets) = (self.model, self.model.border_offsets());
        let Workspace { kept, factors_of, reduced, condensed, factorised, .. } = &mut *self.workspace;
        *factorised = true;
        if *factors_of == kept.border.rows {
            return;
        }
        factors_of.clone_from(&kept.border.rows);
        let size = model.border_size();
        if reduced.nrows() != size {
            *reduced = DMatrix::zeros(size, size);
        }
        reduced.copy_from_slice(factors_of);
        let carried = Race::BOTH.map(|race| {
            let first = offsets[Body::from(race).index()].filter(|_| model.is_carried(race));
            first.map(|first| first..first + BLOCK)
        });
        condensed.factorise(reduced, |row| !carried.iter().flatten().any(|rows| rows.contains(&row)));
    }

    /// \[m] what orbits are about: the centre of the outer race, or of an ideal cage.
    fn races_origin(&self) -> Vector3<f64> {
        self.workspace.spacing.as_ref().map_or(self.outer().position, |trial| trial.end.centre)
    }

    /// Writes the Newton correction of the present residual; false if the matrix is singular.
    pub(super) fn correct(&mut self, correction: &mut [f64]) -> bool {
        prepare_correction(std::slice::from_mut(self));
        if self.balls_are_independent() {
            let tolerance = self.force_tolerance;
            self.correct_balls(correction, |_, size| size > tolerance)
        } else {
            self.correct_all(correction)
        }
    }

    /// Computes blocks anew of balls that were brought back, and where all were looked at, of those that are marked.
    fn renew(&mut self, looked: bool) {
        let repaired = self.workspace.balls.iter().any(|trial| trial.repaired.is_some());
        if repaired {
            // Their blocks are for contacts as they were.
            for trial in self.workspace.balls.iter_mut() {
                trial.renewed = (looked && trial.renewed) || trial.repaired.is_some();
            }
            let sums = self.scatter();
            self.assemble_bodies(&sums);
        }
        if repaired || (looked && self.workspace.balls.iter().any(|trial| trial.renewed)) {
            self.workspace.counted.renewals += 1;
            self.differentiate_bodies();
            self.differentiate_renewed();
            self.eliminate_renewed();
            if !self.balls_are_independent() {
                self.factorise();
            }
        } else if looked && self.rows_are_stale() {
            self.differentiate_bodies();
            self.factorise();
        }
    }

    /// Corrections of those balls between races of prescribed motion that are `due`, by their numbers and residuals \[N]; the others stay
    /// where they are.
    pub(super) fn correct_balls(&self, correction: &mut [f64], due: impl Fn(usize, f64) -> bool) -> bool {
        let origin = self.races_origin();
        let Workspace { balls, groups, kept, .. } = &*self.workspace;
        let mut regular = kept.balls.len() == balls.len();
        correction.fill(0.0);
        let blocks = kept.blocks.iter().zip(kept.balls.chunks(WIDTH));
        let groups = groups.positions().zip(groups.residuals());
        let corrections = correction.chunks_mut(BLOCK * WIDTH);
        for (index, (((block, kept), (positions, (residual, size))), of_group)) in
            blocks.zip(groups).zip(corrections).enumerate()
        {
            let due = |lane: usize| due(WIDTH * index + lane, size.0[lane]);
            if !(0..kept.len()).any(due) {
                continue;
            }
            let mut x = negative(residual);
            block.solve(&turn_of_lanes(kept, positions, &origin), &mut x);
            let chunks = of_group.chunks_exact_mut(BLOCK).enumerate();
            for (lane, chunk) in chunks.filter(|(lane, _)| due(*lane)) {
                for k in 0..BLOCK {
                    chunk[k] = x[k].0[lane];
                    regular &= chunk[k].is_finite();
                }
            }
        }
        regular
    }

    /// Corrections of balls and bodies at once.
    fn correct_all(&mut self, correction: &mut [f64]) -> bool {
        self.eliminate() && self.substitute(correction)
    }

    /// Takes the right-hand sides of balls and bodies, and solves for them but for races that are carried, whose right-hand sides are
    /// left without them. False without a matrix, or where that is singular.
    pub(super) fn eliminate(&mut self) -> bool {
        let (offsets, shared, origin) =
            (self.model.border_offsets(), self.model.spacing_row(), self.races_origin());
        self.workspace.list_members(offsets);
        self.take_right_sides();
        let Workspace {
            balls,
            groups,
            kept,
            members,
            neighbours,
            arrowhead,
            ring,
            condensed,
            ball_corrections,
            group_corrections: x,
            border_correction: y,
            ..
        } = &mut *self.workspace;
        if !neighbours.is_empty() {
            ring.eliminate(ball_corrections, y, offsets);
        } else if kept.balls.len() == balls.len() {
            arrowhead.place(turns(&kept.balls, groups, &origin), (members, shared));
            arrowhead.eliminate(kept.blocks.iter(), x, y);
        } else {
            return false;
        }
        let turned = members.iter().zip(&kept.border.axes);
        turned.for_each(|(member, then)| turn_moments(y, member.from, &member.axes, then));
        condensed.eliminate(y)
    }

    /// Writes the correction of balls and bodies from that of carried races, after [`BearingStep::eliminate`]; false if it is not finite.
    pub(super) fn substitute(&mut self, correction: &mut [f64]) -> bool {
        let offsets = self.model.border_offsets();
        let Workspace {
            kept,
            members,
            neighbours,
            arrowhead,
            ring,
            condensed,
            ball_corrections,
            group_corrections,
            border_correction: y,
            ..
        } = &mut *self.workspace;
        condensed.substitute(y);
        let turned = members.iter().zip(&kept.border.axes);
        turned.for_each(|(member, then)| turn_moments(y, member.from, then, &member.axes));
        let solved = if neighbours.is_empty() {
            arrowhead.substitute(kept.blocks.iter(), group_corrections, y)
        } else {
            ring.substitute(ball_corrections, y, offsets)
        };
        self.give(correction);
        solved
    }

    /// Takes the right-hand sides of balls and bodies.
    fn take_right_sides(&mut self) {
        let rows = self.model.border_size();
        let Workspace {
            balls,
            groups,
            bodies,
            members,
            neighbours,
            spacing,
            ball_corrections,
            group_corrections,
            border_correction: y,
            ..
        } = &mut *self.workspace;
        group_corrections.clear();
        ball_corrections.clear();
        if neighbours.is_empty() {
            group_corrections.extend(groups.residuals().map(|(residual, _)| negative(residual)));
        } else {
            ball_corrections.extend((0..balls.len()).map(|ball| -groups.residual(ball)));
        }
        if y.len() != rows {
            y.resize_vertically_mut(rows, 0.0);
        }
        if let (Some(trial), Some(row)) = (spacing, self.model.spacing_row()) {
            y[row] = -trial.residual;
        }
        for member in members.iter() {
            if let Some(trial) = Body::ALL.get(member.slot).and_then(|body| bodies.get(*body)?.as_ref()) {
                let rows = y.as_mut_slice()[member.from..].iter_mut();
                rows.zip(&trial.residual).for_each(|(to, residual)| *to = -residual);
            }
        }
    }

    /// Writes the corrections of balls, with what they were moved alone, and of bodies.
    fn give(&self, correction: &mut [f64]) {
        let Workspace {
            balls, neighbours, ball_corrections, group_corrections, border_correction: y, ..
        } = &*self.workspace;
        let (of_balls, border) = correction.split_at_mut(BLOCK * balls.len());
        for (ball, (chunk, trial)) in of_balls.chunks_exact_mut(BLOCK).zip(balls.iter()).enumerate() {
            let x = if neighbours.is_empty() {
                let lanes = &group_corrections[ball / WIDTH];
                Vector6::from_fn(|k, _| lanes[k].0[ball % WIDTH])
            } else {
                ball_corrections[ball]
            };
            let x = trial.repaired.map_or(x, |moved| moved + x);
            chunk.copy_from_slice(x.as_slice());
        }
        border.copy_from_slice(y.as_slice());
    }
}

/// Brings balls of bearings that are corrected together back where they are far out of balance, and renews blocks that are out of date, before a
/// correction.
pub(super) fn prepare_correction(bearings: &mut [BearingStep<'_>]) {
    let alone = bearings.len() == 1;
    for step in bearings.iter_mut() {
        step.workspace.balls.iter_mut().for_each(|trial| trial.repaired = None);
        if step.keeps_matrices() && !step.balls_are_independent() {
            step.repair_balls(alone);
        }
    }
    let corrected = bearings.iter().any(|step| step.corrections > 0);
    if corrected {
        stale_blocks::mark(bearings);
    }
    for step in bearings {
        if step.keeps_matrices() {
            step.renew(corrected);
        }
        step.corrections += 1;
        step.of_bodies[1] = step.of_bodies[0];
        let tolerance = step.force_tolerance;
        let workspace = &mut *step.workspace;
        for (ball, trial) in workspace.balls.iter_mut().enumerate() {
            trial.before = workspace.groups.size(ball) / tolerance;
        }
    }
}

/// Turns the moments of a body whose rows begin at `first` from axes that it had to others: the rows of a race that spins stay what they are, as
/// the load zone does.
fn turn_moments(y: &mut DVector<f64>, first: usize, from: &Matrix3<f64>, to: &Matrix3<f64>) {
    if from != to {
        let moments = to * from.tr_mul(&y.fixed_rows::<3>(first + 3));
        y.fixed_rows_mut::<3>(first + 3).copy_from(&moments);
    }
}

/// Turns of all balls since their blocks were computed, by group.
fn turns<'a>(
    kept: &'a [KeptBlock],
    groups: &'a Groups,
    origin: &'a Vector3<f64>,
) -> impl Iterator<Item = OrbitTurn<Lanes>> + 'a {
    kept.chunks(WIDTH).zip(groups.positions()).map(|(kept, positions)| turn_of_lanes(kept, positions, origin))
}

/// The negative of a residual.
#[inline(always)]
fn negative(residual: &Six<Lanes>) -> Six<Lanes> {
    let mut negative = *residual;
    for lanes in &mut negative {
        *lanes = -*lanes;
    }
    negative
}

/// Turns of the balls of a group about the `origin` of their orbits since their blocks were computed. Compiled twice, as contacts are
/// ([`crate::contact::many`]).
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn turn_of_lanes(kept: &[KeptBlock], positions: &Vector3<Lanes>, origin: &Vector3<f64>) -> OrbitTurn<Lanes> {
    let offsets = Lanes::vector(|lane| kept[lane.min(kept.len() - 1)].offset);
    OrbitTurn::between(&offsets, &(positions - constant_vector::<Lanes>(origin)))
}
