//! Contact of a ball with its cage pocket, slightly wider than the ball.
//!
//! Where lands guide the cage, a pocket is a cylinder about the radial direction: the ball is free along it. Where the
//! balls guide, it is a sphere, which holds the cage radially too (cylinders would not: balls that bunch together let the
//! cage go off centre without any force). Hertz contact of constant curvatures; Kalker's linear coefficients are
//! computed once, for rolling along a cylinder's axis (where the ball's own spin drags the surface), and saturated as a
//! vector at mu Q (design of the law `saturated`). In a sphere the patch is round and has no such direction:
//! longitudinal and lateral coefficient are both their mean, and spin does not couple.

use nalgebra::Vector3;

use super::REGULARISATION_SPEED;
use super::body::{BodyMotion, damped};
use super::creep::{Creepage, Law, LinearTheory};
use super::hertz::HertzContact;
use super::pair::PairForces;
use super::shape::ShapeAt;
use crate::contact::BallMotion;
use crate::contact::materials::Pair;
use crate::kalker::linear::LinearError;
use crate::numerics::scalar::{Scalar, Single, cross, dot};

/// [-] axis ratio of the most slender patch with creep coefficients. A tighter cylinder (clearance below 0.8 % of the ball)
/// takes those of this patch: the ball spins in its pocket and slides completely, where they hardly matter.
const MOST_SLENDER: f64 = 0.05;

/// What does not change in a ball-pocket contact.
#[derive(Clone, Copy, Debug)]
pub struct PocketModel {
    /// [m] half the diametral clearance: how far a ball moves from the pocket's axis before it touches.
    pub half_clearance: f64,
    /// [m] ball radius.
    ball_radius: f64,
    /// [m] radius of the circle of pocket centres, where pockets are spheres.
    sphere_circle: Option<f64>,
    shape: ShapeAt<f64>,
    /// [-] friction coefficient.
    friction: f64,
    /// [s/m] Hunt-Crossley dissipation factor.
    damping: f64,
}

impl PocketModel {
    /// A pocket of a diametral clearance [m]: a cylinder, or a sphere whose centre is at a radius [m] of the cage.
    ///
    /// # Errors
    /// If Kalker's linear theory has no answer for the materials.
    pub fn new(
        ball_radius: f64,
        clearance: f64,
        sphere_circle: Option<f64>,
        materials: &Pair,
        friction: f64,
        damping: f64,
    ) -> Result<Self, LinearError> {
        let half_clearance = 0.5 * clearance;
        let around = 1.0 / ball_radius - 1.0 / (ball_radius + half_clearance);
        let along = if sphere_circle.is_some() { around } else { 1.0 / ball_radius };
        let Pair { compliance, shear_modulus, poisson_ratio } = *materials;
        let hertz = HertzContact::new(along, around, compliance);
        let axis_ratio = (hertz.semi_axis_rolling / hertz.semi_axis_transverse).max(MOST_SLENDER);
        let mut shape = ShapeAt::with_creep_of(axis_ratio, &hertz, shear_modulus, poisson_ratio)?;
        if sphere_circle.is_some() {
            let mean = 0.5 * (shape.longitudinal + shape.lateral);
            (shape.longitudinal, shape.lateral, shape.coupling) = (mean, mean, 0.0);
        }
        Ok(Self { half_clearance, ball_radius, sphere_circle, shape, friction, damping })
    }

    /// [J] elastic energy at an approach [m].
    pub fn elastic_energy(&self, approach: f64) -> f64 {
        0.4 * self.shape.stiffness * approach.max(0.0).powf(2.5)
    }

    /// [m] approach of a ball and a pocket whose axis has these components [y, z] along the cage's axes; negative is a
    /// gap.
    pub fn approach(&self, ball: &BallMotion<f64>, cage: &BodyMotion<f64>, direction: [f64; 2]) -> f64 {
        let axis = pocket_axis(cage, direction);
        let offset = ball.position - cage.position;
        self.off_centre(&offset, &axis).norm() - self.half_clearance
    }

    /// Where a ball is off the pocket's axis or centre.
    #[inline(always)]
    fn off_centre<S: Scalar>(&self, offset: &Vector3<S>, axis: &Vector3<S>) -> Vector3<S> {
        let along = self.sphere_circle.map_or_else(|| dot(axis, offset), S::constant);
        offset - axis * along
    }

    /// Forces between ball (first) and cage (second); `None` where they do not touch.
    #[inline(always)]
    pub fn evaluate<S: Single>(
        &self,
        ball: &BallMotion<S>,
        cage: &BodyMotion<S>,
        direction: [f64; 2],
    ) -> Option<PairForces<S>> {
        // geometry: the pocket's axis, and where the ball is off it
        let axis = pocket_axis(cage, direction);
        let offset = ball.position - cage.position;
        let off_centre = self.off_centre(&offset, &axis);
        let distance = dot(&off_centre, &off_centre).sqrt();
        let approach = distance - S::constant(self.half_clearance);
        if approach.value() <= 0.0 {
            return None;
        }
        let normal = off_centre.map(|component| component / distance);

        // velocities of both surfaces at the contact point, and of the contact point itself
        let arm = normal.map(|component| component.scale(self.ball_radius));
        let cage_arm = offset + arm;
        let ball_surface = ball.velocity + cross(&ball.angular_velocity, &arm);
        let cage_surface = cage.velocity + cross(&cage.angular_velocity, &cage_arm);
        let slip = ball_surface - cage_surface;
        let approach_rate = dot(&normal, &slip);
        let seen = ball.velocity - cage.velocity - cross(&cage.angular_velocity, &offset);
        let mut around = seen - normal * dot(&normal, &seen);
        if self.sphere_circle.is_none() {
            around -= axis * dot(&axis, &seen);
        }
        let normal_rate =
            around.map(|component| component / distance) + cross(&cage.angular_velocity, &normal);
        let contact_point = ball.velocity + normal_rate.map(|component| component.scale(self.ball_radius));

        // normal load
        let root = approach.sqrt();
        let shape = &self.shape;
        let elastic = (approach * root).scale(shape.stiffness);
        let load = damped(elastic, approach_rate, self.damping);

        // creepage in the frame x along the pocket, z from the cage into the ball
        let x = if self.sphere_circle.is_some() { across(&normal, &axis, &cage.axes[0]) } else { axis };
        let y = cross(&x, &normal);
        let rolling = contact_point - (ball_surface + cage_surface).map(|c| c.scale(0.5));
        let (rolling_x, rolling_y) = (dot(&rolling, &x), dot(&rolling, &y));
        let floor = S::constant(REGULARISATION_SPEED * REGULARISATION_SPEED);
        let rolling_speed = (rolling_x.square() + rolling_y.square() + floor).sqrt();
        let per_speed = S::one() / rolling_speed;
        let (slip_x, slip_y) = (dot(&slip, &x), dot(&slip, &y));
        let spin = dot(&(cage.angular_velocity - ball.angular_velocity), &normal);
        let creepage = Creepage {
            longitudinal: slip_x * per_speed,
            lateral: slip_y * per_speed,
            spin: spin * per_speed,
            curvature: None,
        };
        let friction_limit = load.scale(self.friction);
        let theory = LinearTheory {
            longitudinal: approach.scale(shape.longitudinal),
            lateral: approach.scale(shape.lateral),
            coupling: (approach * root).scale(shape.coupling) * rolling_x * per_speed,
            spin: approach.square().scale(shape.spin),
            friction_limit,
            moment_limit: friction_limit * root.scale(shape.spin_arm),
            mean_semi_axis: root.scale(shape.mean_semi_axis),
            half_width: root.scale(shape.semi_axis_transverse),
        };
        let creep = theory.forces(Law::Saturated, &creepage);

        // wrenches
        let tangential = x * creep.longitudinal + y * creep.lateral;
        let force = -(normal * load + tangential);
        let contact_moment = normal * creep.spin_moment;
        Some(PairForces {
            approach,
            load,
            stiffness: S::constant(shape.stiffness),
            force,
            moment: contact_moment - cross(&arm, &tangential),
            other_moment: -cross(&cage_arm, &force) - contact_moment,
            friction_power: creep.longitudinal * slip_x + creep.lateral * slip_y + creep.spin_moment * spin,
            damping_power: (load - elastic) * approach_rate,
        })
    }
}

/// World direction of the axis of a pocket.
#[inline(always)]
fn pocket_axis<S: Scalar>(cage: &BodyMotion<S>, [y, z]: [f64; 2]) -> Vector3<S> {
    cage.axes[1].map(|component| component.scale(y)) + cage.axes[2].map(|component| component.scale(z))
}

/// A unit vector across a normal, in the plane of the normal and the axis, or of the other axis near the first.
#[inline(always)]
fn across<S: Single>(normal: &Vector3<S>, axis: &Vector3<S>, other: &Vector3<S>) -> Vector3<S> {
    let axis = if dot(normal, axis).value().abs() < 0.8 { axis } else { other };
    let across = axis - normal * dot(normal, axis);
    let length = dot(&across, &across).sqrt();
    across.map(|component| component / length)
}
