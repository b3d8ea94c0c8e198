//! Stiffness and damping of the running bearing against slow motions of the inner race, balls condensed out.
//!
//! Of each ball follow its place in its azimuthal plane `q` (along the axis, radial) and its velocities `u` (along the
//! orbit, and angular); its azimuth does not. With the forces and moments on the ball `g`, its inertia included, and the
//! wrench on the inner race `w`, a pose `r` of that race that moves slowly asks for
//!
//! `0 = g_q q + g_q' q' + g_u u + g_r r + g_r' r'`,   `w = w_q q + w_q' q' + w_u u + w_r r + w_r' r'`.
//!
//! With `s = (q, u)` and `s = S r + T r' + ...`, orders 0 and 1 in the rate of change give
//!
//! `g_s S = -g_r`,   `g_s T = -(g_r' + g_q' Q)`,   Q the rows of q in S,
//! `K = -(w_r + w_s S)`,   `C = -(w_r' + w_q' Q + w_s T)`.
//!
//! All derivatives are exact. The masses of balls enter by their centrifugal force and gyroscopic moment; what
//! resonates with them is much faster than these motions.

use nalgebra::{Matrix3, Matrix6, Matrix6x2, Vector3};

use crate::contact::{BallMotion, ContactModel, RaceMotion};
use crate::model::{INNER, Model, OUTER};
use crate::scalar::{Dual, constant_vector};
use crate::state::{BallState, State};

/// [s] time in which friction has to be able to change the velocities of a ball so that they follow. Rolling takes
/// microseconds; a ball that slides freely, or pivots against hardly any friction, does not follow.
const FOLLOWING_TIME: f64 = 1e-3;
/// Directions of differentiation, as in steps.
const DIRECTIONS: usize = 9;
type D = Dual<DIRECTIONS>;

/// What an external load on the inner race has to overcome, by components: rows force x, y, z and moment x, y, z,
/// columns translation x, y, z and rotation x, y, z of the inner race relative to the outer one; world axes, about the
/// inner race's origin. The race's own rotation turns with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condensed {
    /// [N/m, N/rad; N m/m, N m/rad] load by displacement.
    pub stiffness: Matrix6<f64>,
    /// [N s/m, N s/rad; N m s/m, N m s/rad] load by velocity.
    pub damping: Matrix6<f64>,
}

impl Condensed {
    /// Of a state, at a friction coefficient. Contacts of a cage are left out; so is a ball that does not touch both
    /// races.
    pub fn new(model: &Model, state: &State, friction: f64) -> Self {
        let contacts = [INNER, OUTER].map(|race| model.contact(race, friction));
        let races = [INNER, OUTER].map(|race| state.races[race].motion());
        let zero = Self { stiffness: Matrix6::zeros(), damping: Matrix6::zeros() };
        let add = |sum: Self, (index, ball): (usize, &BallState)| {
            let contacts = [INNER, OUTER].map(|race| contacts[race].of_ball(state.difference(index, race)));
            share(model, &contacts, &races, ball).map_or(sum, |one| Self {
                stiffness: sum.stiffness + one.stiffness,
                damping: sum.damping + one.damping,
            })
        };
        state.balls.iter().enumerate().fold(zero, add)
    }
}

/// Derivatives of force and moment (rows) by translation and rotation, or their rates (columns), of ball and race.
struct Derivatives {
    /// Of the ball's.
    by_ball: Matrix6<f64>,
    /// Of the race's.
    by_race: Matrix6<f64>,
}

/// Derivatives of the forces in one contact.
pub(crate) struct Linear {
    /// Of force and moment on the ball by places; a ball has no orientation.
    ball_by_place: Derivatives,
    /// Of force and moment on the ball by velocities.
    ball_by_rate: Derivatives,
    /// Of force and moment on the race by places.
    race_by_place: Derivatives,
    /// Of force and moment on the race by velocities.
    race_by_rate: Derivatives,
}

impl Linear {
    /// Of force and moment on the ball (rows) by its velocity and angular velocity (columns).
    pub(crate) fn ball_by_rate(&self) -> Matrix6<f64> {
        self.ball_by_rate.by_ball
    }

    /// Of a contact in motion.
    pub(crate) fn new(model: &ContactModel<'_>, ball: &BallMotion<f64>, race: &RaceMotion<f64>) -> Self {
        let fixed = |v: &Vector3<f64>| constant_vector::<D>(v);
        let variable =
            |v: &Vector3<f64>, first: usize| Vector3::from_fn(|i, _| D::variable(v[i], first + i, 1.0));
        // A vector that turns with the race.
        let turning = |v: &Vector3<f64>| {
            let mut turned = fixed(v);
            for k in 0..3 {
                let rate = Vector3::ith(k, 1.0).cross(v);
                turned.iter_mut().zip(&rate).for_each(|(c, rate)| c.derivatives[6 + k] = *rate);
            }
            turned
        };
        // Contacts depend on the relative translation alone: directions 0 to 2 serve ball and race.
        let places = model.evaluate(
            &BallMotion {
                position: variable(&ball.position, 0),
                velocity: fixed(&ball.velocity),
                angular_velocity: fixed(&ball.angular_velocity),
            },
            &RaceMotion {
                position: fixed(&race.position),
                axis: turning(&race.axis),
                velocity: fixed(&race.velocity),
                angular_velocity: turning(&race.angular_velocity),
            },
        );
        let rates = model.evaluate(
            &BallMotion {
                position: fixed(&ball.position),
                velocity: variable(&ball.velocity, 0),
                angular_velocity: variable(&ball.angular_velocity, 3),
            },
            &RaceMotion {
                position: fixed(&race.position),
                axis: fixed(&race.axis),
                velocity: fixed(&race.velocity),
                angular_velocity: variable(&race.angular_velocity, 6),
            },
        );
        let opposite = |force: &Vector3<D>| -force;
        Self {
            ball_by_place: derivatives(&places.force, &places.ball_moment),
            ball_by_rate: derivatives(&rates.force, &rates.ball_moment),
            race_by_place: derivatives(&opposite(&places.force), &places.race_moment),
            race_by_rate: derivatives(&opposite(&rates.force), &rates.race_moment),
        }
    }
}

fn derivatives(force: &Vector3<D>, moment: &Vector3<D>) -> Derivatives {
    let row = |i: usize| if i < 3 { &force[i].derivatives } else { &moment[i - 3].derivatives };
    Derivatives {
        by_ball: Matrix6::from_fn(|i, k| row(i)[k]),
        by_race: Matrix6::from_fn(|i, k| if k < 3 { -row(i)[k] } else { row(i)[3 + k] }),
    }
}

/// The share of one ball; none if it does not touch both races.
fn share(
    model: &Model,
    contacts: &[ContactModel<'_>; 2],
    races: &[RaceMotion<f64>; 2],
    state: &BallState,
) -> Option<Condensed> {
    let motion = state.motion();
    let touches = |race: usize| contacts[race].evaluate(&motion, &races[race]).load > 0.0;
    if !(touches(INNER) && touches(OUTER)) {
        return None;
    }
    let [inner, outer] = [INNER, OUTER].map(|race| Linear::new(&contacts[race], &motion, &races[race]));
    let ball_by_place = inner.ball_by_place.by_ball + outer.ball_by_place.by_ball;
    let ball_by_rate = inner.ball_by_rate.by_ball + outer.ball_by_rate.by_ball;
    let orbit = Orbit::new(&motion, &races[OUTER]);

    // derivatives by s: places along the axis and radially, velocities along the orbit and angular
    let by_s = |by_place: &Matrix6<f64>, by_rate: &Matrix6<f64>| {
        let mut by_s = *by_rate;
        by_s.set_column(0, &(by_place.fixed_columns::<3>(0) * orbit.axis));
        by_s.set_column(1, &(by_place.fixed_columns::<3>(0) * orbit.radial));
        by_s.set_column(2, &(by_rate.fixed_columns::<3>(0) * orbit.tangential));
        by_s
    };
    let in_plane = Matrix3::from_columns(&[orbit.axis, orbit.radial, Vector3::zeros()]);
    let by_plane_rate = |by_rate: &Matrix6<f64>| -> Matrix6x2<f64> {
        (by_rate.fixed_columns::<3>(0) * in_plane).fixed_columns::<2>(0).into_owned()
    };
    let mut g_s = by_s(&ball_by_place, &ball_by_rate) + orbit.inertia(model, &motion);
    let (g_r, g_rate) = (inner.ball_by_place.by_race, inner.ball_by_rate.by_race);
    let w_s = by_s(&inner.race_by_place.by_ball, &inner.race_by_rate.by_ball);
    let (w_r, w_rate) = (inner.race_by_place.by_race, inner.race_by_rate.by_race);

    // Moments over the ball radius, so that rows compare.
    let scaled = |mut rows: Matrix6<f64>| {
        rows.fixed_rows_mut::<3>(3).scale_mut(1.0 / model.bearing.ball.radius);
        rows
    };
    g_s = scaled(g_s);
    let g_s = g_s.lu();
    let follow = g_s.solve(&scaled(-g_r))?;
    let plane = follow.fixed_rows::<2>(0);
    let lag = g_s.solve(&scaled(-(g_rate + by_plane_rate(&ball_by_rate) * plane)))?;
    Some(Condensed {
        stiffness: -(w_r + w_s * follow),
        damping: -(w_rate + by_plane_rate(&inner.race_by_rate.by_ball) * plane + w_s * lag),
    })
}

/// A ball's way about the outer race's axis.
pub(crate) struct Orbit {
    axis: Vector3<f64>,
    radial: Vector3<f64>,
    /// [-] direction of growing azimuth.
    pub(crate) tangential: Vector3<f64>,
    /// [m] distance from the axis.
    radius: f64,
    /// [rad/s] orbital speed.
    speed: f64,
}

impl Orbit {
    /// Of a ball about the outer race.
    pub(crate) fn new(ball: &BallMotion<f64>, outer: &RaceMotion<f64>) -> Self {
        let offset = ball.position - outer.position;
        let across = offset - outer.axis * offset.dot(&outer.axis);
        let radius = across.norm();
        let radial = across / radius;
        let tangential = outer.axis.cross(&radial);
        let speed = (ball.velocity - outer.velocity).dot(&tangential) / radius;
        Self { axis: outer.axis, radial, tangential, radius, speed }
    }

    /// [N m] gyroscopic moment: what turning the ball's spin with its orbit costs, as a moment on it.
    pub(crate) fn gyroscopic_moment(&self, model: &Model, ball: &BallMotion<f64>) -> Vector3<f64> {
        self.axis.cross(&ball.angular_velocity) * (-model.bearing.ball.inertia * self.speed)
    }

    /// Derivatives of force and moment of inertia on the ball (rows; the force is the centrifugal one) by its velocity
    /// along the orbit and its angular velocity (columns 2 to 5).
    pub(crate) fn inertia_by_rate(&self, model: &Model, ball: &BallMotion<f64>) -> Matrix6<f64> {
        let (mass, inertia) = (model.bearing.ball.mass, model.bearing.ball.inertia);
        let mut by_rate = Matrix6::zeros();
        let mut column = by_rate.column_mut(2);
        column.fixed_rows_mut::<3>(0).copy_from(&(self.radial * (2.0 * mass * self.speed)));
        let turned = self.axis.cross(&ball.angular_velocity);
        column.fixed_rows_mut::<3>(3).copy_from(&(turned * (-inertia / self.radius)));
        let spin = self.axis.cross_matrix() * (-inertia * self.speed);
        by_rate.fixed_view_mut::<3, 3>(3, 3).copy_from(&spin);
        by_rate
    }

    /// Derivatives by s of centrifugal force and gyroscopic moment, and the inertia that friction has to overcome in
    /// the following time.
    fn inertia(&self, model: &Model, ball: &BallMotion<f64>) -> Matrix6<f64> {
        let (mass, inertia) = (model.bearing.ball.mass, model.bearing.ball.inertia);
        let mut by_s = self.inertia_by_rate(model, ball);
        let mut outwards = by_s.column_mut(1);
        outwards.fixed_rows_mut::<3>(0).copy_from(&(self.radial * (-mass * self.speed * self.speed)));
        let gyroscopic = self.gyroscopic_moment(model, ball) / -self.radius;
        outwards.fixed_rows_mut::<3>(3).copy_from(&gyroscopic);
        for i in 0..3 {
            by_s[(i, 2)] -= self.tangential[i] * (mass / FOLLOWING_TIME);
            by_s[(3 + i, 3 + i)] -= inertia / FOLLOWING_TIME;
        }
        by_s
    }
}
