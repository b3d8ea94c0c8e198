//! Motion of two surfaces that roll on each other, a ball's and that of a race or cage: from velocities to creepages, and
//! from creep forces to forces and moments on both bodies.

use nalgebra::Vector3;

use super::creep::{CreepForces, Creepage};
use super::motion::BallMotion;
use crate::numerics::scalar::{Scalar, cross, dot};

/// [m/s] rolling speed below which creepages are held finite: `V -> sqrt(V^2 + v^2)`. Forces stay linear in the slip
/// speed at rest; at 1 m/s it changes creepages by 5e-7.
pub const REGULARISATION_SPEED: f64 = 1e-3;

/// Ball and other body where they touch, in world axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surfaces<S: Scalar> {
    /// [-] unit normal, out of the ball.
    normal: Vector3<S>,
    /// \[m] contact point from the ball's centre and from the other body's origin.
    arms: [Vector3<S>; 2],
    /// [m/s] velocity of the ball's surface less that of the other one.
    slip: Vector3<S>,
    /// [m/s] speed at which the bodies approach.
    pub(super) approach_rate: S,
    /// [m/s] velocity of the contact point less the mean of both surfaces: the contact moves over the material opposite to
    /// the mean material velocity seen from it.
    rolling: Vector3<S>,
    /// [rad/s] angular velocity of the other body less that of the ball.
    relative: Vector3<S>,
}

/// \[m] contact point from the ball's centre, by the normal and the ball radius \[m], and from the other body's origin, by
/// the ball's offset from that \[m].
#[inline(always)]
pub(super) fn arms<S: Scalar>(
    normal: Vector3<S>,
    radius: f64,
    offset: &Vector3<S>,
) -> (Vector3<S>, Vector3<S>) {
    let arm = normal.map(|component| component.scale(radius));
    (arm, offset + arm)
}

/// [m/s] velocity of the ball's surface less that of a body of `[velocity, angular velocity]`, at both arms \[m].
#[inline(always)]
pub(super) fn slip<S: Scalar>(
    ball: &BallMotion<S>,
    [velocity, angular_velocity]: [&Vector3<S>; 2],
    [arm, other_arm]: [&Vector3<S>; 2],
) -> Vector3<S> {
    ball.velocity + cross(&ball.angular_velocity, arm) - (velocity + cross(angular_velocity, other_arm))
}

/// Rolling, slip and creepages in a contact frame whose z axis points into the ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rolling<S: Scalar> {
    /// [-] unit vectors of the frame's axes x and y.
    axes: [Vector3<S>; 2],
    /// [m/s] rolling speed, regularised.
    pub(super) speed: S,
    /// [-] cosine of the rolling direction against the x axis.
    pub(super) cosine: S,
    /// [m/s] component of the rolling velocity along y.
    pub(super) speed_across: S,
    /// [m/s] slip of the ball along x and y.
    slip: [S; 2],
    /// [rad/s] spin.
    spin: S,
    /// [rad/s] angular velocity of the ball about y less that of the other body.
    relative_rolling: S,
    /// [1/m] mean transverse curvature of both surfaces, 0 where its slip is left out.
    bend: f64,
    /// Creepages.
    pub(super) creepage: Creepage<S>,
}

/// State of rolling, as far as a film depends on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct RollingState<S: Scalar> {
    /// [m/s] rolling speed, regularised.
    pub(super) speed: S,
    /// [-] cosine of the rolling direction against the x axis.
    pub(super) cosine: S,
    /// Creepages.
    pub(super) creepage: Creepage<S>,
}

impl<S: Scalar> Rolling<S> {
    /// State of rolling, as far as a film depends on it.
    #[inline(always)]
    pub(super) fn state(&self) -> RollingState<S> {
        RollingState { speed: self.speed, cosine: self.cosine, creepage: self.creepage }
    }
}

/// Forces and moments of a contact, in world axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wrench<S: Scalar> {
    /// \[N] force on the ball; the other body's is the opposite.
    pub(super) force: Vector3<S>,
    /// [N m] moment on the ball about its centre.
    pub(super) ball_moment: Vector3<S>,
    /// [N m] moment on the other body about its origin.
    pub(super) other_moment: Vector3<S>,
    /// \[W] power lost to friction.
    pub(super) friction_power: S,
}

impl<S: Scalar> Surfaces<S> {
    /// A ball that touches another body: ball radius \[m], `[velocity, angular velocity]` of the body, offset \[m] of the ball
    /// from the body's origin, contact normal and its rate of change [1/s].
    #[inline(always)]
    pub(super) fn new(
        ball: &BallMotion<S>,
        radius: f64,
        [velocity, angular_velocity]: [&Vector3<S>; 2],
        offset: &Vector3<S>,
        normal: Vector3<S>,
        normal_rate: &Vector3<S>,
    ) -> Self {
        let (arm, other_arm) = arms(normal, radius, offset);
        let ball_surface = ball.velocity + cross(&ball.angular_velocity, &arm);
        let other_surface = velocity + cross(angular_velocity, &other_arm);
        let slip = ball_surface - other_surface;
        let contact_point = ball.velocity + normal_rate.map(|component| component.scale(radius));
        Self {
            normal,
            arms: [arm, other_arm],
            slip,
            approach_rate: dot(&normal, &slip),
            rolling: contact_point - (ball_surface + other_surface).map(|component| component.scale(0.5)),
            relative: angular_velocity - ball.angular_velocity,
        }
    }

    /// Rolling in the frame of a tangent x, on a surface bent across it [1/m] where that is simulated.
    #[inline(always)]
    pub(super) fn rolling(&self, x: Vector3<S>, bend: Option<f64>) -> Rolling<S> {
        let y = cross(&x, &self.normal);
        let (rolling_x, rolling_y) = (dot(&self.rolling, &x), dot(&self.rolling, &y));
        let floor = S::constant(REGULARISATION_SPEED * REGULARISATION_SPEED);
        let speed = (rolling_x.square() + rolling_y.square() + floor).sqrt();
        let slip = [dot(&self.slip, &x), dot(&self.slip, &y)];
        let spin = dot(&self.relative, &self.normal);
        let relative_rolling = -dot(&self.relative, &y);
        let per_speed = S::one() / speed;
        Rolling {
            axes: [x, y],
            speed,
            cosine: rolling_x / speed,
            speed_across: rolling_y,
            slip,
            spin,
            relative_rolling,
            bend: bend.unwrap_or(0.0),
            creepage: Creepage {
                longitudinal: slip[0] * per_speed,
                lateral: slip[1] * per_speed,
                spin: spin * per_speed,
                // The common surface lies at z = bend y^2, towards the ball, where the relative rolling speed adds slip.
                curvature: bend.map(|bend| (relative_rolling * per_speed).scale(-bend)),
            },
        }
    }

    /// Forces and moments of a normal load \[N] and of the creep forces of the ball on the other body.
    #[inline(always)]
    pub(super) fn wrench(&self, rolling: &Rolling<S>, load: S, creep: &CreepForces<S>) -> Wrench<S> {
        let ([x, y], [arm, other_arm]) = (rolling.axes, self.arms);
        let tangential = x * creep.longitudinal + y * creep.lateral;
        let force = -(self.normal * load + tangential);
        // Tractions along x at the height of the bent surface turn about y.
        let rolling_moment = creep.second_moment.scale(rolling.bend);
        let contact_moment = self.normal * creep.spin_moment - y * rolling_moment;
        Wrench {
            force,
            ball_moment: contact_moment - cross(&arm, &tangential),
            other_moment: -cross(&other_arm, &force) - contact_moment,
            friction_power: creep.longitudinal * rolling.slip[0]
                + creep.lateral * rolling.slip[1]
                + creep.spin_moment * rolling.spin
                + rolling_moment * rolling.relative_rolling,
        }
    }

    /// Adds rolling resistance: a force \[N] on each surface against its motion, and the pressure of the inlet that holds both, whose
    /// resultants go through the centres of curvature; and a moment against rolling [N m]. `ball_share` is the ball's share of the
    /// curvatures along rolling.
    #[inline(always)]
    pub(super) fn resist(
        &self,
        wrench: &mut Wrench<S>,
        rolling: &Rolling<S>,
        (force, ball_share): (S, S),
        moment: S,
    ) {
        let ([x, y], [arm, other_arm]) = (rolling.axes, self.arms);
        let per_speed = S::one() / rolling.speed;
        // Surfaces move against the direction in which the contact rolls on.
        let along = x * rolling.cosine + y * (rolling.speed_across * per_speed);
        let tangential = along * (force * (S::one() - ball_share.scale(2.0)));
        // The arm of the couple: the ball's radius times its share of the curvatures is the radius of both together.
        let couple =
            cross(&arm, &along) * (force * ball_share.scale(2.0)) + cross(&self.normal, &along) * moment;
        wrench.force += tangential;
        wrench.ball_moment += couple + cross(&arm, &tangential);
        wrench.other_moment -= couple + cross(&other_arm, &tangential);
        wrench.friction_power += dot(&couple, &self.relative) - dot(&tangential, &self.slip);
    }
}
