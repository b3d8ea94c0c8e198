//! A guess of the equilibrium: the same search with balls that cost little.
//!
//! Near a place, a ball is held by two Hertzian forces of a known stiffness along the lines between its centre and the groove
//! centres, and by a force that stays what it is there: centrifugal force, friction, and what a form, a spall or growth
//! changes. What stays is taken from the whole balance of the ball at the last place, without derivatives; so the
//! guess comes to rest where the whole balance does. Its derivatives leave out the curvature of the races along their
//! circumference, of the order of ball over pitch diameter of what a contact holds across its normal.

use nalgebra::{Matrix2x5, RowSVector, UnitQuaternion, Vector2, Vector3};

use super::EquilibriumError;
use super::ball::{
    BallBalance, Place, Shared, arc_radius, balance_value, bottom_of_outer_groove, middle_of_gap,
};
use super::light_ball::{Balance, LightBall, Stays, solve};
use super::problem::{Effort, Found, Problem, Progress};
use super::trial::{OuterAxes, SharedVector, Trial, shared};
use crate::contact::ContactModel;
use crate::model::bodies::{PerRace, Race};

/// [-] residual that a guess is good for, where it does not get to its tolerance.
const USEFUL: f64 = 1e-6;
/// Budget of a guess; a typical one takes 6 to 10 iterations. Its tolerance is below that of the whole search, which then has
/// nothing left to do: its last step would cost as much as five here.
const EFFORT: Effort = Effort { tolerance: 1e-12, enough: USEFUL, iterations: 40 };

/// The guess, where one is found: displacements, cage speed, and places of the balls.
pub fn guess(problem: &Problem<'_>) -> Option<Found<Stays>> {
    if !problem.is_settled_by_thrust() {
        return None;
    }
    let evaluate =
        |unknowns: &SharedVector, before: Option<&Trial<Stays>>| evaluate(problem, unknowns, before);
    let found = problem.descend(problem.centred(), Progress::Residual, EFFORT, evaluate).ok()?;
    (found.residual <= USEFUL).then_some(found)
}

/// Settles all balls at these displacements, from where they were `before`.
fn evaluate(
    problem: &Problem<'_>,
    unknowns: &SharedVector,
    before: Option<&Trial<Stays>>,
) -> Result<Trial<Stays>, EquilibriumError> {
    let Problem { model, input, .. } = *problem;
    let moved = shared(model, input, unknowns);
    let here = Here {
        problem,
        contacts: &model.contacts(&input.surroundings()),
        moved: &moved,
        shared: &moved.fixed(),
        outer: OuterAxes::new(input, unknowns).orientation(),
    };
    let mut trial = Trial::empty(model, input, unknowns);
    for j in 0..model.bearing.n_balls {
        let ball = here.ball(j);
        let Some((place, balance)) = here.settle(&ball, j, unknowns, before) else {
            let displacement = std::array::from_fn(|i| unknowns[i]);
            return Err(EquilibriumError::Ball { ball: j + 1, displacement });
        };
        here.add(&mut trial, &ball, j, place, &balance);
    }
    Ok(trial)
}

/// Displacements that balls are settled at.
struct Here<'a> {
    problem: &'a Problem<'a>,
    contacts: &'a PerRace<ContactModel<'a>>,
    /// The inner race with derivatives, and without.
    moved: &'a Shared,
    shared: &'a Shared<f64>,
    /// Orientation of the outer race in the bearing frame.
    outer: UnitQuaternion<f64>,
}

impl Here<'_> {
    fn ball(&self, index: usize) -> LightBall<'_> {
        let azimuth = self.problem.model.bearing.ball_azimuth(index);
        LightBall::new(self.contacts, self.shared, azimuth, self.problem.known_force)
    }

    /// The whole balance of a ball.
    fn whole(&self, index: usize, place: &Place) -> BallBalance<f64> {
        let Problem { model, input, .. } = *self.problem;
        balance_value(model, self.contacts, input, self.shared, index, place)
    }

    /// Place and balance of a ball: from where it goes with the race, from between the races, or from the bottom of the outer
    /// groove.
    fn settle(
        &self,
        ball: &LightBall<'_>,
        index: usize,
        unknowns: &SharedVector,
        before: Option<&Trial<Stays>>,
    ) -> Option<(Place, Balance)> {
        let Problem { model, input, .. } = *self.problem;
        let from =
            |mut place: Place, stays: &Stays| ball.settle(&mut place, stays).map(|balance| (place, balance));
        let fresh = |place: Place| from(place, &ball.stays(&place, &self.whole(index, &place)));
        let followed = before.and_then(|before| {
            let stays = &before.balances[index];
            let step = stays.follows * (unknowns - before.unknowns);
            let step = if step.norm() < ball.longest { step } else { Vector2::zeros() };
            from(before.places[index] + step, stays)
        });
        let azimuth = model.bearing.ball_azimuth(index);
        followed
            .or_else(|| fresh(middle_of_gap(self.contacts, self.shared, azimuth)))
            .or_else(|| fresh(bottom_of_outer_groove(model, self.contacts, input, self.moved, index)))
    }

    /// Adds a ball at a place where it is nearly in balance.
    fn add(
        &self,
        trial: &mut Trial<Stays>,
        ball: &LightBall<'_>,
        index: usize,
        place: Place,
        balance: &Balance,
    ) {
        let Problem { model, input, .. } = *self.problem;
        let there = self.whole(index, &place);
        let held = &balance.inner;
        // What is left to the place where the whole balance is, to first order.
        let residual = Vector2::from(there.residual);
        let rest = solve(&balance.stiffness, &residual).filter(|rest| rest.norm() < ball.longest);
        let rest = rest.unwrap_or_default();
        let way = balance.directions * rest;
        let inner_load = (there.inner_load + held.load_by.dot(&way)).max(0.0);
        let [by_inner, by_outer, by_radius] = ball.orbital_speed_by(input, &there);
        let by_arc = by_outer / arc_radius(&self.contacts.outer);
        let own_speed = there.own_orbital_speed
            + by_inner * held.angle_by.dot(&way)
            + by_arc * rest.x
            + by_radius * way.y;
        // A free ball has no speed of its own.
        let excess = if inner_load > 0.0 { own_speed - self.shared.cage_speed } else { 0.0 };

        // Rows in the bearing frame: external load and cage excess.
        let [axial, outward] = [Vector3::x(), ball.radial].map(|direction| self.outer * direction);
        let centre = axial * there.centre[0] + outward * there.centre[1];
        let given_way = held.stiffness * way;
        let (arm, change) = match input.race {
            Race::Inner => (centre - self.outer * self.shared.position, -given_way),
            Race::Outer => (centre, given_way - balance.basis * residual),
        };
        let change = axial * change.x + outward * change.y;
        let force = self.outer * there.force + change;
        let moment = self.outer * there.moment + arm.cross(&change);
        for (load, row) in trial.load.iter_mut().zip([force.x, force.y, force.z, moment.y, moment.z]) {
            *load += row;
        }
        trial.cage_excess += inner_load * excess;
        trial.inner_load_sum += inner_load;
        let mut stays = ball.stays(&place, &there);

        // The ball follows the race: two contacts in series.
        if let Some(give) = balance.stiffness.try_inverse() {
            let rows = [axial, outward].map(|direction| {
                let turn = arm.cross(&direction);
                RowSVector::from([direction.x, direction.y, direction.z, turn.y, turn.z])
            });
            // Displacement of the inner race where the ball is, relative to the outer one.
            let sign = if input.race == Race::Inner { 1.0 } else { -1.0 };
            let by_race = Matrix2x5::from_rows(&rows) * sign;
            // The centrifugal force grows with the cage speed.
            let growth = 2.0 * model.bearing.ball.mass * there.centre[1] * self.shared.cage_speed;
            let grows = Vector2::new(0.0, growth);
            let give = give * balance.basis.transpose();
            stays.follows.fixed_columns_mut::<5>(0).copy_from(&(give * held.stiffness * by_race));
            stays.follows.set_column(5, &(give * grows));
            let moves = balance.directions * stays.follows;
            let mut relative = moves;
            let mut columns = relative.fixed_columns_mut::<5>(0);
            columns -= by_race;
            let mut force_by = -(held.stiffness * relative) * sign;
            if input.race == Race::Outer {
                let mut column = force_by.column_mut(5);
                column -= grows;
            }
            let mut rows = trial.tangent.fixed_rows_mut::<5>(0);
            rows += by_race.transpose() * sign * force_by;
            let speed_by = held.angle_by.transpose() * relative * by_inner
                + stays.follows.row(0) * by_arc
                + moves.row(1) * by_radius;
            let mut row = trial.tangent.fixed_rows_mut::<1>(5);
            row += speed_by * inner_load + held.load_by.transpose() * relative * excess;
            trial.tangent[(5, 5)] -= inner_load;
        }
        trial.balances.push(stays);
        trial.places.push(place + rest);
    }
}
