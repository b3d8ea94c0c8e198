//! Stiffness and damping of the running bearing, balls condensed out.
//!
//! Two sets of quantities of each ball follow the race: its place in its azimuthal plane `q` (along the axis, radial) and
//! its velocities `u` (along the orbit, and angular). Held are its azimuth and the orbital speed that gives the
//! centrifugal force. The stiffness is that of the normal contacts: with the wrench `w` on the inner race at pose `r`, and
//! the forces `f` on the ball in its plane,
//!
//! `K = -(w_r + w_q Q)`,   `f_q Q = -f_r`   (the ball stays in balance).
//!
//! The damping is that of the normal contacts and of creep while the places follow as `Q r'`: the velocities are those at
//! which the force along the orbit and the moments `g` do not change, and their effect in the plane shifts the ball,
//!
//! `C = -(w_r' + w_q' Q + w_u U + Q^T (f_r' + f_q' Q + f_u U))`,   `(g_u - M/tau) U = -(g_r' + g_q' Q)`.
//!
//! K is symmetric where no centrifugal force acts (but for the moment that turns with the race), and C never drives.
//! The derivatives of friction by places are left out of the stiffness: friction acts with a delay, not as a spring. All
//! derivatives are exact.

use nalgebra::{Matrix2, Matrix2x6, Matrix4, Matrix4x6, Matrix6, Matrix6x2, Matrix6x4, Vector3, Vector4};

use super::tangents::{Tangents, ball_by_rates, by_first};
use crate::contact::creep::Law;
use crate::contact::normal::Damping;
use crate::contact::{BallMotion, ContactModel, RaceMotion};
pub use crate::effects::reports::Condensed;
use crate::model::bodies::{PerRace, Race};
use crate::model::state::{BallState, State};
use crate::model::{Conditions, Model};

/// \[s] time in which friction has to be able to change the velocities of a ball so that they follow. Rolling takes
/// microseconds; a ball that slides freely, or pivots against hardly any friction, does not follow.
const FOLLOWING_TIME: f64 = 1e-3;

impl Condensed {
    /// Stiffness and damping in a state. Contacts of a cage and between balls are left out, and so are balls that do not touch both races.
    pub fn new(model: &Model, state: &State, conditions: &Conditions) -> Self {
        let contacts = model.contacts_oriented(conditions, state.orientations.as_ref());
        let races = PerRace::new(|race| state.race(race).motion());
        let zero = Self { stiffness: Matrix6::zeros(), damping: Matrix6::zeros() };
        let add = |sum: Self, (index, ball): (usize, &BallState)| {
            let contacts = PerRace::new(|race| contacts[race].of_ball(index, state.difference(index, race)));
            contribution(model, &contacts, &races, ball).map_or(sum, |one| Self {
                stiffness: sum.stiffness + one.stiffness,
                damping: sum.damping + one.damping,
            })
        };
        state.balls.iter().enumerate().fold(zero, add)
    }
}

/// Force and moment on a ball (rows) by its velocity and angular velocity (columns).
pub(crate) fn ball_by_rate(
    model: &ContactModel<'_>,
    ball: &BallMotion<f64>,
    race: &RaceMotion<f64>,
) -> Matrix6<f64> {
    let on_ball = model.on_ball(model.path(false), &ball_by_rates(ball), race);
    by_first(&on_ball.force, &on_ball.moment)
}

/// Contribution of one ball; none if it does not touch both races.
fn contribution(
    model: &Model,
    contacts: &PerRace<ContactModel<'_>>,
    races: &PerRace<RaceMotion<f64>>,
    state: &BallState,
) -> Option<Condensed> {
    let (ball, motion) = (&model.bearing.ball, state.motion());
    let touches = |race: Race| contacts[race].evaluate(&motion, &races[race]).load > 0.0;
    if !(touches(Race::Inner) && touches(Race::Outer)) {
        return None;
    }
    let linear =
        |model: &ContactModel<'_>, race: Race| Tangents::of_ball_and_race(model, &motion, &races[race]);
    let [inner, outer] = Race::BOTH.map(|race| linear(&contacts[race], race));
    let smooth = |race: Race| {
        linear(
            &ContactModel { law: Law::Frictionless, damping: Damping::HuntCrossley(0.0), ..contacts[race] },
            race,
        )
    };
    let [smooth_inner, smooth_outer] = Race::BOTH.map(smooth);
    let orbit = Orbit::new(&motion, &races.outer);

    // The directions of q and u among translation and rotation of a ball, and of f and g among force and moment on it.
    let mut plane = Matrix6x2::zeros();
    plane.fixed_view_mut::<3, 1>(0, 0).copy_from(&orbit.axis);
    plane.fixed_view_mut::<3, 1>(0, 1).copy_from(&orbit.radial);
    let mut rolling = Matrix6x4::zeros();
    rolling.fixed_view_mut::<3, 1>(0, 0).copy_from(&orbit.tangential);
    // Angular velocities times the radius and moments over it, so that rows and columns compare.
    rolling.fixed_view_mut::<3, 3>(3, 1).fill_with_identity();
    rolling.fixed_view_mut::<3, 3>(3, 1).scale_mut(1.0 / ball.radius);

    // stiffness
    let by_place = smooth_inner.place.on_first.first + smooth_outer.place.on_first.first;
    let mut f_q: Matrix2<f64> = plane.transpose() * by_place * plane;
    f_q[(1, 1)] += ball.mass * orbit.speed * orbit.speed;
    let f_q = f_q.lu();
    let w_q = smooth_inner.place.on_second.first * plane;
    let follow: Matrix2x6<f64> = f_q.solve(&-(plane.transpose() * smooth_inner.place.on_first.second))?;
    let stiffness = -(smooth_inner.place.on_second.second + w_q * follow);

    // damping
    let by_rate = inner.rate.on_first.first + outer.rate.on_first.first;
    let (g, f) = (rolling.transpose(), plane.transpose());
    let rotational = ball.inertia / (ball.radius * ball.radius);
    let inertia = Vector4::new(ball.mass, rotational, rotational, rotational) / FOLLOWING_TIME;
    let g_u = g * by_rate * rolling - Matrix4::from_diagonal(&inertia);
    let by_race = inner.rate.on_first.second + by_rate * plane * follow;
    let rates: Matrix4x6<f64> = g_u.lu().solve(&-(g * by_race))?;
    // Where the forces have a potential, w_q f_q^-1 is the transpose of -Q: written so, C is a sum of squares.
    let shift = follow.transpose() * (f * (by_race + by_rate * rolling * rates));
    let w_rate = inner.rate.on_second.first;
    let damping = -(inner.rate.on_second.second + w_rate * (plane * follow + rolling * rates) + shift);
    Some(Condensed { stiffness, damping })
}

/// A ball's way about the outer race's axis.
pub(crate) struct Orbit {
    axis: Vector3<f64>,
    radial: Vector3<f64>,
    /// [-] direction of growing azimuth.
    pub(crate) tangential: Vector3<f64>,
    /// \[m] distance from the axis.
    radius: f64,
    /// [rad/s] orbital speed.
    speed: f64,
}

impl Orbit {
    /// The orbit of a ball about the outer race.
    pub(crate) fn new(ball: &BallMotion<f64>, outer: &RaceMotion<f64>) -> Self {
        let offset = ball.position - outer.position;
        let across = offset - outer.axis * offset.dot(&outer.axis);
        let radius = across.norm();
        let radial = across / radius;
        let tangential = outer.axis.cross(&radial);
        let speed = (ball.velocity - outer.velocity).dot(&tangential) / radius;
        Self { axis: outer.axis, radial, tangential, radius, speed }
    }

    /// [N m] gyroscopic moment: the moment on the ball that its spin, turning with the orbit, asks for.
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
}
