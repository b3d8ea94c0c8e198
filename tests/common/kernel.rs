//! A contact held against itself: its derivatives against differences.

use nalgebra::Vector3;
use roulement::contact::{BallMotion, ContactModel, RaceMotion};
use roulement::numerics::scalar::Dual;

/// A motion with one of its nine numbers changed.
fn moved(ball: &BallMotion<f64>, k: usize, by: f64) -> BallMotion<f64> {
    let change = |at: usize| if k / 3 == at { Vector3::ith(k % 3, by) } else { Vector3::zeros() };
    BallMotion {
        position: ball.position + change(0),
        velocity: ball.velocity + change(1),
        angular_velocity: ball.angular_velocity + change(2),
    }
}

/// Derivatives of the force on a ball by place, velocity and angular velocity are central differences over a `step` \[m] of the
/// place, within parts of a typical size and of the derivative itself.
pub fn assert_derivatives_are_differences(
    contact: &ContactModel<'_>,
    ball: &BallMotion<f64>,
    race: &RaceMotion<f64>,
    step: f64,
    [of_size, of_itself]: [f64; 2],
) {
    let seed = |first: usize, v: &Vector3<f64>| Vector3::from_fn(|i, _| Dual::variable(v[i], first + i, 1.0));
    let seeded = BallMotion {
        position: seed(0, &ball.position),
        velocity: seed(3, &ball.velocity),
        angular_velocity: seed(6, &ball.angular_velocity),
    };
    let exact = contact.differentiated(contact.path(false), &seeded, &race.constant());
    for k in 0..9 {
        let step = if k < 3 { step } else { 1e-6 };
        let [before, after] = [-step, step].map(|by| contact.evaluated(&moved(ball, k, by), race));
        for i in 0..3 {
            let difference = (after.force[i] - before.force[i]) / (2.0 * step);
            let ours = exact.force[i].derivatives[k];
            let size = if k < 3 { 1e8 } else { 1e3 };
            let error = (ours - difference).abs();
            assert!(
                error < of_size * size + of_itself * ours.abs(),
                "number {k}, force {i}: {ours} {difference}"
            );
        }
    }
}
