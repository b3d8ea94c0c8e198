//! Equations of motion of a ball in one step, of one or of several at a time: where unknown accelerations take it, and what forces
//! leave of them.

use nalgebra::Vector3;

use crate::contact::BallMotion;
use crate::model::bearing::Ball;
use crate::model::state::BallState;
use crate::numerics::arrowhead::Six;
use crate::numerics::hht::HhtStep;
use crate::numerics::lanes::Lanes;
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::Scalar;

/// The equations of a ball in a step from a given state.
///
/// Unknowns are the acceleration of its centre [m/s2] and its angular acceleration times its radius [m/s2].
#[derive(Clone, Copy, Debug)]
pub struct BallEquations<S: Scalar = f64> {
    step: HhtStep,
    mass: f64,
    inertia: f64,
    radius: f64,
    /// Motion at the start.
    start: BallMotion<S>,
    /// \[m] displacement over the step at the velocity of the start.
    drift: Vector3<S>,
    /// Shares of the accelerations at the start in displacement and velocities.
    pull: Vector3<S>,
    gain: Vector3<S>,
    angular_gain: Vector3<S>,
    /// Share of force and moment at the start in those of the step.
    held: Wrench<S>,
    /// Remainder of the last step, which this one makes good, as that of bodies.
    carried_over: Wrench<S>,
}

/// A ball at the start of a step.
struct Start<S: Scalar> {
    motion: BallMotion<S>,
    acceleration: Vector3<S>,
    angular_acceleration: Vector3<S>,
    total: Wrench<S>,
    remainder: Wrench<S>,
}

impl BallEquations {
    /// Those of a step from a state.
    pub fn new(start: &BallState, ball: &Ball, step: &HhtStep) -> Self {
        let start = Start {
            motion: start.motion(),
            acceleration: start.acceleration,
            angular_acceleration: start.angular_acceleration,
            total: start.total,
            remainder: start.remainder,
        };
        Self::of(&start, ball, step)
    }
}

impl BallEquations<Lanes> {
    /// Those of steps from several states, by lane.
    #[inline(always)]
    pub fn of_lanes<'a>(start: impl Fn(usize) -> &'a BallState, ball: &Ball, step: &HhtStep) -> Self {
        let vector = |part: fn(&BallState) -> &Vector3<f64>| Lanes::vector(|lane| *part(start(lane)));
        let start = Start {
            motion: BallMotion {
                position: vector(|one| &one.position),
                velocity: vector(|one| &one.velocity),
                angular_velocity: vector(|one| &one.angular_velocity),
            },
            acceleration: vector(|one| &one.acceleration),
            angular_acceleration: vector(|one| &one.angular_acceleration),
            total: Wrench { force: vector(|one| &one.total.force), moment: vector(|one| &one.total.moment) },
            remainder: Wrench {
                force: vector(|one| &one.remainder.force),
                moment: vector(|one| &one.remainder.moment),
            },
        };
        Self::of(&start, ball, step)
    }
}

impl<S: Scalar> BallEquations<S> {
    #[inline(always)]
    fn of(start: &Start<S>, ball: &Ball, step: &HhtStep) -> Self {
        let scaled = |v: &Vector3<S>, factor: f64| vector(|i| v[i].scale(factor));
        let held = 1.0 - fraction(step);
        Self {
            step: *step,
            mass: ball.mass,
            inertia: ball.inertia,
            radius: ball.radius,
            start: start.motion,
            drift: scaled(&start.motion.velocity, step.h),
            pull: scaled(&start.acceleration, 0.5 - step.beta),
            gain: scaled(&start.acceleration, 1.0 - step.gamma),
            angular_gain: scaled(&start.angular_acceleration, 1.0 - step.gamma),
            held: Wrench {
                force: scaled(&start.total.force, held),
                moment: scaled(&start.total.moment, held),
            },
            carried_over: start.remainder,
        }
    }

    /// Acceleration and angular acceleration of unknowns.
    #[inline(always)]
    fn accelerations(&self, unknowns: &Six<S>) -> [Vector3<S>; 2] {
        let [ax, ay, az, bx, by, bz] = *unknowns;
        let radius = S::constant(self.radius);
        [Vector3::new(ax, ay, az), Vector3::new(bx / radius, by / radius, bz / radius)]
    }

    /// Motion at the end of the step.
    #[inline(always)]
    pub fn motion(&self, unknowns: &Six<S>) -> BallMotion<S> {
        let Self { start, step, .. } = self;
        let [acceleration, angular] = self.accelerations(unknowns);
        let (beta, gamma, h) = (step.beta, step.gamma, step.h);
        let moved = |i: usize| {
            start.position[i] + (self.drift[i] + (self.pull[i] + acceleration[i].scale(beta)).scale(h * h))
        };
        let faster = |from: S, gain: S, acceleration: S| from + (gain + acceleration.scale(gamma)).scale(h);
        BallMotion {
            position: Vector3::new(moved(0), moved(1), moved(2)),
            velocity: vector(|i| faster(start.velocity[i], self.gain[i], acceleration[i])),
            angular_velocity: vector(|i| faster(start.angular_velocity[i], self.angular_gain[i], angular[i])),
        }
    }

    /// Remainder of the equations under the total force and moment at the end of the step.
    #[inline(always)]
    pub fn remainder(&self, unknowns: &Six<S>, total: &Wrench<S>) -> Wrench<S> {
        let [acceleration, angular] = self.accelerations(unknowns);
        let fraction = fraction(&self.step);
        let left = |inertial: S, total: S, held: S, carried_over: S| {
            inertial - (total.scale(fraction) + held) + carried_over
        };
        let Self { held, carried_over, .. } = self;
        Wrench {
            force: vector(|i| {
                left(acceleration[i].scale(self.mass), total.force[i], held.force[i], carried_over.force[i])
            }),
            moment: vector(|i| {
                left(angular[i].scale(self.inertia), total.moment[i], held.moment[i], carried_over.moment[i])
            }),
        }
    }

    /// Total force and moment at the end of the step that leave nothing of the equations.
    #[inline(always)]
    pub fn total_in_balance(&self, unknowns: &Six<S>) -> Wrench<S> {
        let Wrench { force, moment } = self.remainder(unknowns, &Wrench::default());
        let total = |alone: &Vector3<S>| vector(|i| alone[i].scale(1.0 / fraction(&self.step)));
        Wrench { force: total(&force), moment: total(&moment) }
    }

    /// \[N] residual of what is left: moments over the radius.
    #[inline(always)]
    pub fn residual(&self, remainder: &Wrench<S>) -> Six<S> {
        let radius = S::constant(self.radius);
        let Wrench { force, moment } = remainder;
        [force.x, force.y, force.z, moment.x / radius, moment.y / radius, moment.z / radius]
    }
}

/// [-] share of the forces at the end of a step.
fn fraction(step: &HhtStep) -> f64 {
    1.0 - step.alpha_f
}

/// A vector by components.
#[inline(always)]
fn vector<S: Scalar>(of: impl Fn(usize) -> S) -> Vector3<S> {
    Vector3::new(of(0), of(1), of(2))
}
