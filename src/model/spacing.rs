//! Balls that an ideal cage keeps apart: without mass, play and friction, it holds them at even spacing around the bearing.
//!
//! All balls share one turn. The forces of the pockets act along the orbit, and their moments about the axis add up to nothing, as what has
//! no mass has no moment of its own. The axis is the x axis through the centre of the outer race, whose motion is given.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::ball_state::BallState;
use super::bearing::Bearing;
use crate::numerics::hermite::Hermite;

/// Places of the balls.
#[derive(Clone, Debug)]
pub struct Spacing {
    /// Cosine and sine of the azimuth of each ball where the common turn is 0.
    pub azimuths: Vec<[f64; 2]>,
}

impl Spacing {
    /// Even spacing around a bearing.
    pub fn new(bearing: &Bearing) -> Self {
        let azimuth = |index: usize| {
            let (sin, cos) = bearing.ball_azimuth(index).sin_cos();
            [cos, sin]
        };
        Self { azimuths: (0..bearing.n_balls).map(azimuth).collect() }
    }
}

/// The turn that all balls share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CommonTurn {
    /// \[m] centre.
    pub centre: Vector3<f64>,
    /// [m/s] its velocity.
    pub velocity: Vector3<f64>,
    /// \[rad] angle, in [-pi, pi].
    pub angle: f64,
    /// [rad/s] its rate: the speed of the cage.
    pub speed: f64,
    /// [rad/s2] its second derivative.
    pub acceleration: f64,
    /// [rad/s2] what the forces on all balls ask of it, the `g` of the HHT scheme.
    pub total: f64,
    /// [rad/s2] what the last step left of its equation, within the tolerance.
    pub remainder: f64,
    /// \[N] force of each pocket on its ball along the orbit.
    pub pockets: Vec<f64>,
}

/// Where the common turn has a ball: unit vectors along the radius and along the orbit.
#[derive(Clone, Copy, Debug)]
pub struct Directions {
    /// Away from the axis.
    pub radial: Vector3<f64>,
    /// Along the orbit.
    pub tangential: Vector3<f64>,
}

impl Directions {
    /// Those of a ball whose azimuth has this cosine and sine where the turn is 0, by the sine and cosine of the turn.
    pub fn turned((sin, cos): (f64, f64), [c, s]: [f64; 2]) -> Self {
        let (cos, sin) = (cos * c - sin * s, sin * c + cos * s);
        Self { radial: Vector3::new(0.0, cos, sin), tangential: Vector3::new(0.0, -sin, cos) }
    }
}

impl CommonTurn {
    /// A turn with this centre \[m] and velocity [m/s] that balls nearly follow; they are to be placed there ([`CommonTurn::place`]).
    pub fn of_balls(
        spacing: &Spacing,
        balls: &[BallState],
        centre: Vector3<f64>,
        velocity: Vector3<f64>,
    ) -> Self {
        let (mut cos, mut sin, mut momentum, mut inertia) = (0.0, 0.0, 0.0, 0.0);
        for (ball, [c, s]) in balls.iter().zip(&spacing.azimuths) {
            let (at, v) = (ball.position - centre, ball.velocity - velocity);
            cos += c * at.y + s * at.z;
            sin += c * at.z - s * at.y;
            momentum += at.y * v.z - at.z * v.y;
            inertia += at.y * at.y + at.z * at.z;
        }
        Self {
            centre,
            velocity,
            angle: sin.atan2(cos),
            speed: momentum / inertia,
            acceleration: 0.0,
            total: 0.0,
            remainder: 0.0,
            pockets: vec![0.0; balls.len()],
        }
    }

    /// Directions of a ball whose azimuth has this cosine and sine where the turn is 0.
    pub fn directions(&self, azimuth: [f64; 2]) -> Directions {
        Directions::turned(self.angle.sin_cos(), azimuth)
    }

    /// Puts balls where the turn has them, at their distances from the axis.
    pub fn place(&self, spacing: &Spacing, balls: &mut [BallState]) {
        let turn = self.angle.sin_cos();
        for (ball, azimuth) in balls.iter_mut().zip(&spacing.azimuths) {
            let Directions { radial, tangential } = Directions::turned(turn, *azimuth);
            let (at, v) = (ball.position - self.centre, ball.velocity - self.velocity);
            let radius = at.dot(&radial);
            let (axial, rate) = (Vector3::x() * at.x, Vector3::x() * v.x + radial * v.dot(&radial));
            ball.position = self.centre + axial + radial * radius;
            ball.velocity = self.velocity + rate + tangential * (radius * self.speed);
        }
    }

    /// Sum of all its numbers: not finite if one is not.
    pub fn sum(&self) -> f64 {
        let Self { centre, velocity, angle, speed, acceleration, total, remainder, pockets } = self;
        let vectors = centre.sum() + velocity.sum();
        vectors + angle + speed + acceleration + total + remainder + pockets.iter().sum::<f64>()
    }

    /// The turn within a step from this one to another.
    pub fn within(&self, end: &Self, between: Hermite) -> Self {
        let turned = wrapped(end.angle - self.angle);
        Self {
            centre: between.at([self.centre, end.centre], [self.velocity, end.velocity]),
            velocity: between.linear([self.velocity, end.velocity]),
            angle: wrapped(self.angle + between.at([0.0, turned], [self.speed, end.speed])),
            speed: between.linear([self.speed, end.speed]),
            ..self.clone()
        }
    }
}

/// An angle \[rad] of at most a turn more than half a turn, in [-pi, pi].
pub fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if angle > PI {
        angle - TAU
    } else if angle < -PI {
        angle + TAU
    } else {
        angle
    }
}
