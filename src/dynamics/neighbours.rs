//! Contacts of neighbouring balls in a trial step, where no cage keeps them apart.
//!
//! Most steps have none: at the start of a step those pairs are listed that may touch before its end, and only these are
//! looked at. Should another pair touch in the solved step, it joins the list and the step is solved again.

use nalgebra::{Matrix6, Vector3};

use super::Workspace;
use super::ball::{BallTrial, Push};
use super::directions::{D, SECOND_ROTATION, by_first, by_second, scale_moments, seed};
use super::equations::BearingStep;
use crate::contact::BallMotion;
use crate::contact::ball_ball::BallBallModel;
use crate::contact::normal::Damping;
use crate::contact::pair::PairForces;
use crate::forces::BallPair;
use crate::model::Model;
use crate::model::bearing::neighbours;
use crate::model::state::{KeptMatrix, State};
use crate::numerics::hht::HhtStep;
use crate::numerics::ring::Link;
use crate::numerics::scalar::constant_vector;

/// [-] gap over the ball diameter beyond which balls are not looked at any closer.
const FAR: f64 = 0.1;
/// [-] gap over the ball diameter, now or at the end of the step at the present velocities, within which a pair is listed.
/// A gap that closes faster than that is found when the step is solved.
const NEAR: f64 = 1e-3;

/// A listed pair in a trial step.
#[derive(Clone, Debug)]
pub struct NeighbourTrial {
    first: usize,
    second: usize,
    /// Forces at the end of the step, where they touch.
    forces: Option<PairForces>,
    /// Couplings of both balls in the Newton matrix.
    pub link: Link,
}

impl NeighbourTrial {
    fn new((first, second): (usize, usize)) -> Self {
        let zero = Matrix6::zeros();
        let link = Link { block: first, forward: zero, backward: zero };
        Self { first, second, forces: None, link }
    }

    /// The pair, where the balls touch.
    pub fn touching(&self) -> Option<BallPair> {
        let (first, second) = (self.first, self.second);
        self.forces.map(|forces| BallPair { first, second, forces })
    }

    /// Evaluates the contact of two balls that have moved to the end of a step; with their derivatives if asked for.
    fn evaluate(
        &mut self,
        (contact, damping): (&BallBallModel, Damping),
        motions: &[BallMotion<f64>; 2],
        balls: &mut [BallTrial],
        step: &HhtStep,
        with_tangent: bool,
    ) {
        self.forces = contact.evaluate(&motions[0], &motions[1], damping);
        let mut own = [Matrix6::zeros(); 2];
        if with_tangent {
            let radius = 0.5 * contact.diameter;
            (self.link.forward, self.link.backward) = (Matrix6::zeros(), Matrix6::zeros());
            let seeded = seed(&motions[0], step, radius);
            if let Some(pair) = contact.evaluate(&seeded, &seed_second(&motions[1], step, radius), damping) {
                let reaction = -pair.force;
                let fraction = -(1.0 - step.alpha_f);
                own = [by_first(&pair.force, &pair.moment), by_second(&reaction, &pair.other_moment)];
                let forward = by_second(&pair.force, &pair.moment);
                let backward = by_first(&reaction, &pair.other_moment);
                self.link.forward = scale_moments(forward, radius) * fraction;
                self.link.backward = scale_moments(backward, radius) * fraction;
            }
        }
        if let Some(pair) = self.touching() {
            for (ball, tangent) in [self.first, self.second].into_iter().zip(own) {
                if let Some(wrench) = pair.on(ball) {
                    let push = balls[ball].pushed.get_or_insert(Push::none());
                    push.wrench = push.wrench.plus(wrench);
                    push.tangent += tangent;
                }
            }
        }
    }
}

/// The second ball of a pair as a function of its own rotation; that of its translation is minus the first's.
fn seed_second(motion: &BallMotion<f64>, step: &HhtStep, radius: f64) -> BallMotion<D> {
    let gain = step.velocity_gain() / radius;
    let spin = motion.angular_velocity;
    BallMotion {
        position: constant_vector(&motion.position),
        velocity: constant_vector(&motion.velocity),
        angular_velocity: Vector3::from_fn(|i, _| D::variable(spin[i], SECOND_ROTATION + i, gain)),
    }
}

/// Pairs that may touch within a step of `h` \[s], by their first balls.
fn near(model: &Model, state: &State, h: f64) -> Vec<(usize, usize)> {
    let Some(contact) = &model.ball_contact else {
        return vec![];
    };
    let is_near = |(first, second): &(usize, usize)| {
        let [first, second] = [first, second].map(|ball| &state.balls[*ball]);
        let offset = second.position - first.position;
        let squared = offset.norm_squared();
        if squared > ((1.0 + FAR) * contact.diameter).powi(2) {
            return false;
        }
        let distance = squared.sqrt();
        let approach_rate = offset.dot(&(first.velocity - second.velocity)) / distance;
        distance - approach_rate.max(0.0) * h < (1.0 + NEAR) * contact.diameter
    };
    neighbours(state.balls.len()).filter(is_near).collect()
}

impl Workspace {
    /// Lists these pairs.
    fn list(&mut self, pairs: impl Iterator<Item = (usize, usize)>) {
        self.neighbours.clear();
        self.neighbours.extend(pairs.map(NeighbourTrial::new));
        if !self.neighbours.is_empty() {
            // The blocks of balls that may touch are coupled: there is nothing to keep.
            self.kept = KeptMatrix::default();
        }
        self.balls.iter_mut().for_each(|trial| trial.pushed = None);
    }

    /// Lists the pairs that another workspace has.
    pub(super) fn list_those_of(&mut self, other: &Self) {
        self.list(other.neighbours.iter().map(|pair| (pair.first, pair.second)));
    }
}

impl BearingStep<'_> {
    /// Lists the pairs that may touch in this step.
    pub fn list_near(&mut self) {
        let none_before = self.workspace.neighbours.is_empty();
        self.workspace.list(near(self.model, self.start, self.step.h).into_iter());
        // A matrix of an earlier stage is of the pairs that it had.
        self.workspace.factorised &= none_before && self.workspace.neighbours.is_empty();
    }

    /// Lists pairs too that touch in the solved step and were not listed; are there some?
    pub fn list_touching(&mut self) -> bool {
        let Some(contact) = &self.model.ball_contact else {
            return false;
        };
        let workspace = &mut *self.workspace;
        let is_listed = |first: usize| workspace.neighbours.iter().any(|neighbour| neighbour.first == first);
        let touching = |(first, second): (usize, usize)| {
            let [first, second] = [first, second].map(|ball| workspace.groups.position(ball));
            (second - first).norm_squared() < contact.diameter * contact.diameter
        };
        let pairs = || neighbours(workspace.balls.len());
        if !pairs().any(|pair| touching(pair) && !is_listed(pair.0)) {
            return false;
        }
        let all: Vec<_> = pairs().filter(|pair| is_listed(pair.0) || touching(*pair)).collect();
        workspace.list(all.into_iter());
        true
    }

    /// Evaluates the listed pairs of the balls that have moved to the end of the step; with derivatives if asked for.
    pub(super) fn evaluate_neighbours(&mut self, with_tangent: bool) {
        let Some(contact) = &self.model.ball_contact else {
            return;
        };
        let Workspace { balls, groups, neighbours, .. } = &mut *self.workspace;
        if neighbours.is_empty() {
            return;
        }
        balls.iter_mut().for_each(|trial| trial.pushed = None);
        for pair in neighbours {
            let motions = [pair.first, pair.second].map(|ball| groups.motion(ball));
            pair.evaluate((contact, self.model.damping), &motions, balls, &self.step, with_tangent);
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector6;

    use super::super::ball_equations::BallEquations;
    use super::*;
    use crate::model::bearing::Ball;
    use crate::model::bodies::PerRace;
    use crate::model::state::BallState;
    use crate::numerics::motion::Wrench;

    /// Motions of two balls that press on each other, after a step with these unknowns.
    fn moved(unknowns: &[Vector6<f64>; 2], step: &HhtStep) -> [BallMotion<f64>; 2] {
        let ball = Ball { radius: 5e-3, mass: 4e-3, inertia: 4e-8 };
        [0, 1].map(|index: usize| {
            let side = if index == 0 { -1.0 } else { 1.0 };
            let start = BallState {
                position: Vector3::new(1e-3, side * 4e-3 * 0.9999, side * 3e-3 * 0.9999),
                velocity: Vector3::new(0.1, -0.2 * side, 0.05),
                angular_velocity: Vector3::new(-900.0, 50.0 * side, 120.0),
                acceleration: Vector3::new(30.0, -20.0, 10.0 * side),
                angular_acceleration: Vector3::new(1e4, -2e4 * side, 3e4),
                total: Wrench::default(),
                remainder: Wrench::default(),
                pressed: PerRace::default(),
            };
            BallEquations::new(&start, &ball, step).motion(&unknowns[index].into())
        })
    }

    #[test]
    fn identity_the_tangent_of_a_pair_agrees_with_differences() {
        let (contact, step) = (BallBallModel::new(5e-3, (206e9, 0.3), 0.08), HhtStep::new(0.05, 1e-5));
        let at =
            [Vector6::new(10.0, -20.0, 30.0, 5.0, 15.0, -8.0), Vector6::new(-4.0, 7.0, 9.0, 2.0, 3.0, 1.0)];
        let evaluate = |unknowns: &[Vector6<f64>; 2], with_tangent: bool| {
            let mut balls = [BallTrial::new(), BallTrial::new()];
            let mut pair = NeighbourTrial::new((0, 1));
            let motions = moved(unknowns, &step);
            pair.evaluate((&contact, 0.02.into()), &motions, &mut balls, &step, with_tangent);
            (pair, balls.map(|ball| ball.pushed.unwrap()))
        };
        let force = |push: &Push| -> Vector6<f64> {
            crate::model::state::stack(&push.wrench.force, &push.wrench.moment)
        };
        let (pair, pushes) = evaluate(&at, true);
        let fraction = -(1.0 - step.alpha_f);
        // Residuals have moments over the radius.
        let own = |ball: usize| scale_moments(pushes[ball].tangent, 5e-3) * fraction;
        let matrices = [[own(0), pair.link.forward], [pair.link.backward, own(1)]];
        for (by, column) in (0..2).flat_map(|by| (0..6).map(move |column| (by, column))) {
            let shifted = |size: f64| {
                let mut unknowns = at;
                unknowns[by][column] += size;
                evaluate(&unknowns, false).1
            };
            let (size, plus, minus) = (1.0, shifted(1.0), shifted(-1.0));
            for on in 0..2 {
                let mut difference = (force(&plus[on]) - force(&minus[on])) * (0.5 * fraction / size);
                difference.fixed_rows_mut::<3>(3).scale_mut(1.0 / 5e-3);
                let exact = matrices[on][by].column(column).into_owned();
                let largest = matrices[on][by].amax();
                assert!(
                    (exact - difference).amax() < 1e-6 * largest,
                    "{on} {by} {column}: {exact} {difference}"
                );
                assert!(largest > 0.0);
            }
        }
    }
}
