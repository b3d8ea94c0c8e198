//! Damaged balls: the only ones with an orientation.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::bearing::{Bearing, azimuth_directions};
use super::bodies::{PerRace, Race};
use super::state::{BallState, normalised};
use crate::contact::ball_spall::{BallSpalls, OnBall};
use crate::contact::spall::{Spall, Whole};

/// The damaged balls of a bearing and their spalls.
#[derive(Clone, Debug, PartialEq)]
pub struct DamagedBalls {
    /// Damaged balls (0 is the first).
    pub balls: Vec<usize>,
    /// Their orientations at the start, seen from an outer race that has not turned. Their own axes: y through the middle of the outer
    /// contact at the free contact angle, z along the orbit, and x, about which a ball rolls, completes them; towards +x of the bearing.
    pub at_start: Vec<UnitQuaternion<f64>>,
    /// Spalls as each race meets them.
    pub spalls: PerRace<BallSpalls>,
}

impl DamagedBalls {
    /// Damage by spalls, each with its ball; none without any. `whole` is a contact of the balls with each race.
    pub fn new(spalls: &[(usize, Spall)], bearing: &Bearing, whole: &PerRace<Whole>) -> Option<Self> {
        let mut balls: Vec<usize> = spalls.iter().map(|(ball, _)| *ball).collect();
        balls.sort_unstable();
        balls.dedup();
        let spalls_on = |race: Race| {
            let of = |(ball, spall): &(usize, Spall)| {
                let damaged = balls.iter().position(|other| other == ball)?;
                OnBall::new([*ball, damaged], spall, bearing.ball.radius, whole[race])
            };
            BallSpalls(spalls.iter().filter_map(of).collect())
        };
        let spalls_of = PerRace::new(spalls_on);
        let at_start = balls.iter().map(|&ball| axes_at_start(bearing, ball)).collect();
        (!spalls.is_empty()).then_some(Self { balls, at_start, spalls: spalls_of })
    }

    /// Orientations at the end of a step of `h` \[s], by what is known at its start: no derivatives, as the angular velocity of a ball
    /// changes little within a step, and the difference is made good in the next.
    pub fn turned(
        &self,
        orientations: &[UnitQuaternion<f64>],
        balls: &[BallState],
        h: f64,
    ) -> Vec<UnitQuaternion<f64>> {
        let turned = |(orientation, &ball): (&UnitQuaternion<f64>, &usize)| {
            let BallState { angular_velocity, angular_acceleration, .. } = &balls[ball];
            let turn = (angular_velocity + angular_acceleration * (0.5 * h)) * h;
            normalised(UnitQuaternion::new(turn) * orientation)
        };
        orientations.iter().zip(&self.balls).map(turned).collect()
    }
}

/// See [`DamagedBalls::at_start`].
fn axes_at_start(bearing: &Bearing, ball: usize) -> UnitQuaternion<f64> {
    let (radial, tangential) = azimuth_directions(bearing.ball_azimuth(ball));
    let (sine, cosine) = bearing.free_contact_angle.sin_cos();
    let out = radial * cosine + Vector3::x() * sine;
    let axes = Matrix3::from_columns(&[out.cross(&tangential), out, tangential]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes))
}
