//! A guess of the equilibrium: the same search with balls that cost little.
//!
//! Near a place, a ball is held by two Hertzian forces of a known stiffness along the lines between its centre and the groove
//! centres, and by a force that stays what it is there: centrifugal force, friction, and what a form, a spall or growth
//! changes. What stays is taken from the whole balance of the ball at the last place, without derivatives; so the
//! guess comes to rest where the whole balance does. Its derivatives leave out the curvature of the races along their
//! circumference, of the order of ball over pitch diameter of what a contact holds across its normal.

use nalgebra::{Matrix2, Matrix2x5, Matrix2x6, RowSVector, Vector2, Vector3};

use super::ball::{
    BallBalance, IDLE_HOLD, Place, Shared, arc_radius, balance_value, bottom_of_outer_groove, middle_of_gap,
};
use super::problem::{Effort, Found, Problem, Progress};
use super::trial::{OuterAxes, SharedVector, Trial, shared};
use super::{EquilibriumError, EquilibriumInput};
use crate::contact::ContactModel;
use crate::model::bearing::azimuth_directions;
use crate::model::bodies::{PerRace, Race};

/// [-] residual that a guess is good for, where it does not get to its tolerance.
const USEFUL: f64 = 1e-6;
/// What a guess may take; a typical one takes 6 to 10 iterations. Its tolerance is below that of the whole search, which then has
/// nothing left to do: its last step would cost as much as five here.
const EFFORT: Effort = Effort { tolerance: 1e-12, enough: USEFUL, iterations: 40 };
/// [-] residual of a ball over the forces that are known: what is left is taken out to first order.
const BALL_TOLERANCE: f64 = 1e-9;
/// Iterations of one ball.
const BALL_ITERATIONS: u32 = 40;

/// What stays of a ball near its place.
#[derive(Clone, Copy, Debug)]
pub struct Stays {
    /// [N/m^1.5] Hertz stiffness, what spalls take off included.
    stiffness: PerRace<f64>,
    /// \[m] approach beyond that of a torus.
    deeper: PerRace<f64>,
    /// \[N] force beside those of the contacts, axial and radial.
    force: Vector2<f64>,
    /// \[m] where that is so.
    place: Place,
    /// Derivatives of the place of balance by displacements and cage speed.
    follows: Matrix2x6<f64>,
}

/// Hertzian force of a race on a ball in its azimuthal plane: axial and radial component.
#[derive(Clone, Copy)]
struct Held {
    /// \[N] force.
    force: Vector2<f64>,
    /// [N/m] its decrease as the ball moves.
    stiffness: Matrix2<f64>,
    /// [N/m] increase of the load as the ball moves.
    load_by: Vector2<f64>,
    /// [rad/m] increase of the angle of the normal as the ball moves.
    angle_by: Vector2<f64>,
}

/// A ball between the races.
struct Ball<'a> {
    contacts: &'a PerRace<ContactModel<'a>>,
    shared: &'a Shared<f64>,
    radial: Vector3<f64>,
    /// \[m] longest step.
    longest: f64,
    /// \[N] what balance leaves.
    tolerance: f64,
}

/// Balance of a ball at a place.
struct Balance {
    /// \[N] unbalanced force along the coordinates of the place.
    residual: Vector2<f64>,
    /// [N/m] its decrease as these grow.
    stiffness: Matrix2<f64>,
    /// Inner contact.
    inner: Held,
    /// [-] derivatives of the axial and radial position of the ball by its coordinates.
    directions: Matrix2<f64>,
    /// [-] directions that the residual is along.
    basis: Matrix2<f64>,
    /// Does the ball touch a race?
    touches: bool,
}

impl Ball<'_> {
    /// Approach \[m] to the torus of the inner race, its gradient, and the direction across times root of the distance's curvature.
    #[inline(always)]
    fn inner_approach(&self, at: &Vector2<f64>) -> (f64, Vector2<f64>, Vector2<f64>, f64) {
        let raceway = &self.contacts.inner.surface.raceway;
        let axis = &self.shared.axis;
        let offset = Vector3::x() * at.x + self.radial * at.y - self.shared.position;
        let axial = offset.dot(axis);
        let across = offset - axis * axial;
        let radius = across.norm();
        let by_axial = Vector2::new(axis.x, axis.dot(&self.radial));
        let by_radius = Vector2::new(across.x, across.dot(&self.radial)) / radius;
        let (out, along) = (radius - raceway.groove_circle_radius, axial - raceway.groove_offset);
        let distance = (out * out + along * along).sqrt().max(f64::MIN_POSITIVE);
        let (cos, sin) = (out / distance, along / distance);
        let normal = by_radius * cos + by_axial * sin;
        let along_groove = by_axial * cos - by_radius * sin;
        (distance - arc_radius(&self.contacts.inner), normal, along_groove, distance)
    }

    /// Force of the inner race.
    #[inline(always)]
    fn inner(&self, at: &Vector2<f64>, stays: &Stays) -> Held {
        let (approach, normal, along_groove, distance) = self.inner_approach(at);
        let depth = (approach + stays.deeper.inner).max(0.0);
        let slope = stays.stiffness.inner * depth.sqrt();
        let load = slope * depth;
        Held {
            force: -normal * load,
            stiffness: normal * normal.transpose() * (1.5 * slope)
                + along_groove * along_groove.transpose() * (load / distance),
            load_by: normal * (1.5 * slope),
            angle_by: along_groove / distance,
        }
    }

    /// Centre of the ball and the directions along its coordinates: along the outer groove and away from its centre.
    #[inline(always)]
    fn position(&self, place: &Place) -> (Vector2<f64>, Vector2<f64>, Vector2<f64>) {
        let outer = &self.contacts.outer.surface.raceway;
        let (sin, cos) = (place.x / arc_radius(&self.contacts.outer)).sin_cos();
        let centre = Vector2::new(outer.groove_offset, outer.groove_circle_radius);
        let away = Vector2::new(sin, cos);
        (centre + away * place.y, Vector2::new(cos, -sin), away)
    }

    #[inline(always)]
    fn outer_load(&self, place: &Place, stays: &Stays) -> (f64, f64) {
        let depth = (place.y - arc_radius(&self.contacts.outer) + stays.deeper.outer).max(0.0);
        let slope = stays.stiffness.outer * depth.sqrt();
        (slope * depth, 1.5 * slope)
    }

    /// What stays of the whole balance near a place.
    fn stays(&self, place: &Place, whole: &BallBalance<f64>) -> Stays {
        let (at, along, away) = self.position(place);
        let l = PerRace::new(|race| arc_radius(&self.contacts[race]));
        let (inner_approach, ..) = self.inner_approach(&at);
        let per = |load: f64, contact: f64, stiffness: f64| {
            let depth = contact.max(0.0);
            // A spall lessens the load of a depth.
            if load > 0.0 { load / (depth * depth.sqrt()) } else { stiffness }
        };
        let mut stays = Stays {
            stiffness: PerRace {
                inner: per(whole.inner_load, whole.inner.approach, whole.stiffness.inner),
                outer: per(whole.outer_load, whole.outer.approach, whole.stiffness.outer),
            },
            deeper: PerRace {
                inner: whole.inner.approach - inner_approach,
                outer: whole.outer.approach - (place.y - l.outer),
            },
            force: Vector2::zeros(),
            place: *place,
            follows: Matrix2x6::zeros(),
        };
        let contacts = self.inner(&at, &stays).force - away * self.outer_load(place, &stays).0;
        stays.force = along * whole.residual[0] + away * whole.residual[1] - contacts;
        stays
    }

    /// Balance at a place.
    #[inline(always)]
    fn balance(&self, place: &Place, stays: &Stays) -> Balance {
        let (at, along, away) = self.position(place);
        let inner = self.inner(&at, stays);
        let (outer_load, outer_stiffness) = self.outer_load(place, stays);
        // The outer race pushes straight back along the second coordinate.
        let force = inner.force + stays.force;
        let mut residual = Vector2::new(force.dot(&along), force.dot(&away) - outer_load);
        let l = arc_radius(&self.contacts.outer);
        let directions = Matrix2::from_columns(&[along * (place.y / l), away]);
        let basis = Matrix2::from_columns(&[along, away]);
        let mut stiffness = basis.transpose() * inner.stiffness * directions;
        stiffness[(1, 1)] += outer_stiffness;
        // The directions turn along the groove.
        stiffness[(0, 0)] += force.dot(&away) / l;
        stiffness[(1, 0)] -= force.dot(&along) / l;
        if self.shared.cage_speed == 0.0 {
            residual -= (place - stays.place) * IDLE_HOLD;
            stiffness += Matrix2::identity() * IDLE_HOLD;
        }
        let touches = outer_load > 0.0 || inner.force != Vector2::zeros();
        Balance { residual, stiffness, inner, directions, basis, touches }
    }

    /// Derivatives [1/s] of the ball's own orbital speed by the angles of its inner and outer normal \[rad], and that by its
    /// radius [1/(m s)].
    fn orbital_speed_by(&self, input: &EquilibriumInput, there: &BallBalance<f64>) -> [f64; 3] {
        let (inner, outer) = (&there.inner.normal, &there.outer.normal);
        let (inner_cos, inner_sin) = (inner.dot(&there.inner.radial), inner.dot(&self.shared.axis));
        let (outer_cos, outer_sin) = (outer.dot(&there.outer.radial), outer.x);
        let radius = there.centre[1];
        let over = self.contacts.outer.surface.ball_radius / radius;
        let below = 1.0 - inner_cos * outer_cos - inner_sin * outer_sin;
        let ratio = (1.0 + over * inner_cos) / below;
        let slope = ratio * (inner_sin * outer_cos - inner_cos * outer_sin);
        [-over * inner_sin - slope, slope, -over * inner_cos / radius]
            .map(|by| by * (input.inner_speed - input.outer_speed) / below)
    }

    /// Finds the place of balance from `place`, as [`super::ball::settle`] does.
    fn settle(&self, place: &mut Place, stays: &Stays) -> Option<Balance> {
        let mut here = self.balance(place, stays);
        let mut shift = 0.0;
        // From a thousandth of the stiffness at a micrometre upwards.
        let scale = 1.5e-3 * stays.stiffness.outer;
        for _ in 0..BALL_ITERATIONS {
            if here.residual.norm() <= self.tolerance {
                return Some(here);
            }
            let mut trial = None;
            if let Some(mut step) = solve(&(here.stiffness + Matrix2::identity() * shift), &here.residual) {
                let length = step.norm();
                if length > self.longest {
                    step *= self.longest / length;
                }
                let to = *place + step;
                trial = Some((to, self.balance(&to, stays)));
            }
            match trial {
                Some((to, there))
                    if there.residual.norm() < here.residual.norm() || !(here.touches || there.touches) =>
                {
                    *place = to;
                    here = there;
                    shift = if shift < 1e-3 { 0.0 } else { shift * 0.1 };
                }
                _ => {
                    shift = if shift == 0.0 { 1e-3 * scale } else { shift * 8.0 };
                    if shift > 1e9 * scale {
                        return None;
                    }
                }
            }
        }
        None
    }
}

/// Solution of two equations, where it is finite.
fn solve(matrix: &Matrix2<f64>, rhs: &Vector2<f64>) -> Option<Vector2<f64>> {
    let step = matrix.try_inverse()? * rhs;
    (step.x.is_finite() && step.y.is_finite()).then_some(step)
}

/// The guess, where one is found: displacements, cage speed, and places of the balls.
pub fn guess(problem: &Problem<'_>) -> Option<Found<Stays>> {
    let evaluate =
        |unknowns: &SharedVector, before: Option<&Trial<Stays>>| evaluate(problem, unknowns, before);
    if !problem.is_settled_by_thrust() {
        return None;
    }
    let found = problem.descend(problem.centred(), Progress::Residual, EFFORT, evaluate).ok()?;
    (found.residual <= USEFUL).then_some(found)
}

/// Settles all balls at these displacements.
fn evaluate(
    problem: &Problem<'_>,
    unknowns: &SharedVector,
    before: Option<&Trial<Stays>>,
) -> Result<Trial<Stays>, EquilibriumError> {
    let Problem { model, input, .. } = *problem;
    let with_derivatives = shared(model, input, unknowns);
    let shared = with_derivatives.fixed::<f64>();
    let outer = OuterAxes::new(input, unknowns).orientation();
    let contacts = model.contacts(&input.surroundings());
    let mut trial = Trial::empty(model, input, unknowns);
    for j in 0..model.bearing.n_balls {
        let azimuth = model.bearing.ball_azimuth(j);
        let (radial, _) = azimuth_directions(azimuth);
        let ball = Ball {
            contacts: &contacts,
            shared: &shared,
            radial,
            longest: 0.04 * model.bearing.ball.radius,
            tolerance: BALL_TOLERANCE * problem.known_force,
        };
        let whole = |place: &Place| balance_value(model, &contacts, input, &shared, j, place);
        let settled_from =
            |mut place: Place, stays: Stays| ball.settle(&mut place, &stays).map(|balance| (place, balance));
        let fresh = |place: Place| settled_from(place, ball.stays(&place, &whole(&place)));
        let settled = before
            .and_then(|before| {
                let step = before.balances[j].follows * (unknowns - before.unknowns);
                let step = if step.norm() < ball.longest { step } else { Vector2::zeros() };
                settled_from(before.places[j] + step, before.balances[j])
            })
            .or_else(|| fresh(middle_of_gap(&contacts, &shared, azimuth)))
            .or_else(|| fresh(bottom_of_outer_groove(model, &contacts, input, &with_derivatives, j)));
        let Some((mut place, balance)) = settled else {
            return Err(EquilibriumError::Ball {
                ball: j + 1,
                displacement: std::array::from_fn(|i| unknowns[i]),
            });
        };
        let there = whole(&place);
        // The place where the whole balance is, to first order.
        let residual = Vector2::new(there.residual[0], there.residual[1]);
        let rest = solve(&balance.stiffness, &residual).filter(|rest| rest.norm() < ball.longest);
        let rest = rest.unwrap_or_default();
        let held = &balance.inner;
        let rest_moved = balance.directions * rest;
        let [by_inner, by_outer, by_radius] = ball.orbital_speed_by(input, &there);
        let by_arc = by_outer / arc_radius(&contacts.outer);
        let inner_load = (there.inner_load + held.load_by.dot(&rest_moved)).max(0.0);
        let excess = there.own_orbital_speed
            + by_inner * held.angle_by.dot(&rest_moved)
            + by_arc * rest.x
            + by_radius * rest_moved.y
            - shared.cage_speed;
        let moved = held.stiffness * rest_moved;
        let unbalanced = balance.basis * residual;
        let mut stays = ball.stays(&place, &there);
        place += rest;

        // Rows in the bearing frame: external load and cage excess.
        let [axial, outward] = [Vector3::x(), radial].map(|direction| outer * direction);
        let in_world = |v: Vector2<f64>| axial * v.x + outward * v.y;
        let at = axial * there.centre[0] + outward * there.centre[1];
        let (arm, change) = match input.race {
            Race::Inner => (at - outer * shared.position, in_world(-moved)),
            Race::Outer => (at, in_world(moved - unbalanced)),
        };
        let force = outer * there.force + change;
        let moment = outer * there.moment + arm.cross(&change);
        for (load, row) in trial.load.iter_mut().zip([force.x, force.y, force.z, moment.y, moment.z]) {
            *load += row;
        }
        if inner_load > 0.0 {
            trial.cage_excess += inner_load * excess;
            trial.inner_load_sum += inner_load;
        }

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
            let grows =
                Vector2::new(0.0, 2.0 * model.bearing.ball.mass * there.centre[1] * shared.cage_speed);
            let give = give * balance.basis.transpose();
            stays.follows.fixed_columns_mut::<5>(0).copy_from(&(give * held.stiffness * by_race));
            stays.follows.set_column(5, &(give * grows));
            let moves = balance.directions * stays.follows;
            let mut relative = moves;
            let mut columns = relative.fixed_columns_mut::<5>(0);
            columns -= by_race;
            let mut force_by = -(held.stiffness * relative);
            if input.race == Race::Outer {
                force_by = -force_by;
                let mut column = force_by.column_mut(5);
                column -= grows;
            }
            let mut rows = trial.tangent.fixed_rows_mut::<5>(0);
            rows += by_race.transpose() * sign * force_by;
            if inner_load > 0.0 {
                let speed_by = held.angle_by.transpose() * relative * by_inner
                    + stays.follows.row(0) * by_arc
                    + moves.row(1) * by_radius;
                let mut row = trial.tangent.fixed_rows_mut::<1>(5);
                row += speed_by * inner_load + held.load_by.transpose() * relative * excess;
                trial.tangent[(5, 5)] -= inner_load;
            }
        }
        trial.balances.push(stays);
        trial.places.push(place);
    }
    Ok(trial)
}
