//! Velocities of a ball at which friction is in balance: the start of a bearing that has run for long.
//!
//! For a ball that stays where it is, the velocity along the orbit and the angular velocity `u` are sought at which
//! friction along the orbit vanishes and the moments of both contacts, spin moments among them, give the gyroscopic
//! moment. From the velocities of rolling, where one contact carries all spin, `(M/tau - g_u) du = g` goes with growing
//! `tau` from implicit steps in time, which friction keeps stable, to Newton's method.

use nalgebra::{Matrix4, Matrix6, Vector4};

use crate::analysis::condensed::{Linear, Orbit};
use crate::contact::creep::Law;
use crate::contact::{BallMotion, ContactModel, RaceMotion};
use crate::model::Model;
use crate::model::bodies::{PerRace, Race};
use crate::numerics::size::largest;

/// \[s] first step in time: rolling takes microseconds.
const FIRST_STEP: f64 = 1e-6;
/// [-] residual that is left over the friction that the contacts can carry.
const TOLERANCE: f64 = 1e-9;
/// Iterations; balls of the thrust case with a radial load take 20 to 60.
const MAX_ITERATIONS: u32 = 3000;

/// The motion in balance, from a motion of the same place; none where there is none, or no balance is found.
pub fn balanced(
    model: &Model,
    contacts: &PerRace<ContactModel<'_>>,
    races: &PerRace<RaceMotion<f64>>,
    start: &BallMotion<f64>,
) -> Option<BallMotion<f64>> {
    // Without friction nothing decides how a ball turns.
    if matches!(contacts.inner.law, Law::Frictionless) {
        return None;
    }
    let (mass, radius) = (model.bearing.ball.mass, model.bearing.ball.radius);
    let inertia = model.bearing.ball.inertia / (radius * radius);
    let orbit = |motion: &BallMotion<f64>| Orbit::new(motion, &races.outer);
    let tangential = orbit(start).tangential;
    // Force along the orbit, and moments over the radius beyond the gyroscopic moment.
    let residual = |motion: &BallMotion<f64>| -> (Vector4<f64>, f64) {
        let [inner, outer] = Race::BOTH.map(|race| contacts[race].evaluate(motion, &races[race]));
        let moment = inner.ball_moment + outer.ball_moment + orbit(motion).gyroscopic_moment(model, motion);
        let moment = moment / radius;
        let force = (inner.force + outer.force).dot(&tangential);
        let limit = inner.load.min(outer.load) * contacts.inner.friction;
        (Vector4::new(force, moment.x, moment.y, moment.z), limit)
    };
    let mut motion = *start;
    let (mut here, limit) = residual(&motion);
    if limit <= 0.0 {
        return None;
    }
    let mut step = FIRST_STEP;
    for _ in 0..MAX_ITERATIONS {
        if largest(&here) <= TOLERANCE * limit {
            return Some(motion);
        }
        let contact = |race: Race| Linear::new(&contacts[race], &motion, &races[race]).ball_by_rate();
        let by_rate: Matrix6<f64> = contact(Race::Inner) + contact(Race::Outer);
        let by_orbit = orbit(&motion).inertia_by_rate(model, &motion);
        // First row and column along the orbit, the others of moments over the radius and velocities of the surface.
        let velocities = by_rate.fixed_columns::<3>(0) * tangential + by_orbit.column(2);
        let matrix = Matrix4::from_fn(|i, k| {
            let column = |row: usize| {
                if k == 0 {
                    velocities[row]
                } else {
                    (by_rate[(row, 2 + k)] + by_orbit[(row, 2 + k)]) / radius
                }
            };
            if i == 0 {
                let along: f64 = (0..3).map(|row| tangential[row] * column(row)).sum();
                (if k == 0 { mass / step } else { 0.0 }) - along
            } else {
                (if k == i { inertia / step } else { 0.0 }) - column(2 + i) / radius
            }
        });
        let change = matrix.lu().solve(&here)?;
        let trial = BallMotion {
            velocity: motion.velocity + tangential * change[0],
            angular_velocity: motion.angular_velocity + change.fixed_rows::<3>(1) / radius,
            ..motion
        };
        let (there, _) = residual(&trial);
        if there.norm() < 1.2 * here.norm() {
            (motion, here) = (trial, there);
            step *= 1.5;
        } else {
            step *= 0.3;
        }
    }
    None
}
