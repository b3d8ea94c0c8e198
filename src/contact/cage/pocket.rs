//! Contact of a ball with its cage pocket, slightly wider than the ball.
//!
//! Where lands guide the cage, a pocket is a cylinder about the radial direction: the ball is free along it. Where the
//! balls guide, it is a sphere, which holds the cage radially too (cylinders would not: balls that bunch together let the
//! cage go off centre without any force). Hertz contact of constant curvatures; Kalker's linear coefficients are
//! computed once, for rolling along a cylinder's axis (where the ball's own spin drags the surface), and saturated as a
//! vector at mu Q (design of the law `saturated`). In a sphere the patch is round and has no such direction:
//! longitudinal and lateral coefficient are both their mean, and spin does not couple.

use crate::numerics::elementary::pow;
use nalgebra::Vector3;

use super::film::{self, Gap};
use crate::contact::creep::{Law, LinearTheory};
use crate::contact::hertz::HertzContact;
use crate::contact::kinematics::Surfaces;
use crate::contact::materials::Pair;
use crate::contact::motion::BallMotion;
use crate::contact::motion::BodyMotion;
use crate::contact::normal::NormalLoad;
use crate::contact::pair::PairForces;
use crate::contact::shape::ShapeAt;
use crate::kalker::LinearError;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::scalar::{Scalar, Single, constant_vector, cross, dot};

/// [-] axis ratio of the most slender patch with creep coefficients. A tighter cylinder (clearance below 0.8 % of the ball)
/// takes those of this patch: the ball spins in its pocket and slides completely, where they hardly matter.
const MOST_SLENDER: f64 = 0.05;

/// Constants of a ball-pocket contact.
#[derive(Clone, Copy, Debug)]
pub struct PocketModel {
    /// \[m] half the diametral clearance: how far a ball moves from the pocket's axis before it touches.
    pub half_clearance: f64,
    /// \[m] ball radius.
    ball_radius: f64,
    /// \[m] radius of the circle of pocket centres, where pockets are spheres.
    sphere_circle: Option<f64>,
    shape: ShapeAt<f64>,
    /// [-] friction coefficient.
    friction: f64,
    /// [s/m] Hunt-Crossley dissipation factor.
    damping: f64,
}

impl PocketModel {
    /// A pocket of a diametral clearance \[m]: a cylinder, or a sphere whose centre is at a radius \[m] of the cage.
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

    /// \[J] elastic energy at an approach \[m].
    pub fn elastic_energy(&self, approach: f64) -> f64 {
        0.4 * self.shape.stiffness * pow(approach.max(0.0), 2.5)
    }

    /// \[m] approach of a ball and a pocket whose axis has these components [y, z] along the cage's axes; negative is a
    /// gap.
    pub fn approach(&self, ball: &BallMotion<f64>, cage: &BodyMotion<f64>, direction: [f64; 2]) -> f64 {
        let axis = pocket_axis(cage, direction);
        let offset = ball.position - cage.position;
        self.off_centre(&offset, &axis).norm() - self.half_clearance
    }

    /// Which of four balls touch their pockets, or have oil of a viscosity [Pa s] between them?
    pub fn near(
        &self,
        balls: &BallMotion<Lanes>,
        cage: &BodyMotion<f64>,
        directions: &[[f64; 2]; WIDTH],
        oil: f64,
    ) -> [bool; WIDTH] {
        if oil > 0.0 && self.sphere_circle.is_none() {
            return [true; WIDTH];
        }
        let mut approach = Lanes::constant(0.0);
        approach_lanes(self, balls, cage, directions, &mut approach);
        // What is not a number is carried on.
        approach.0.map(|approach| approach > 0.0 || approach.is_nan())
    }

    /// Where a ball is off the pocket's axis or centre.
    #[inline(always)]
    fn off_centre<S: Scalar>(&self, offset: &Vector3<S>, axis: &Vector3<S>) -> Vector3<S> {
        let along = self.sphere_circle.map_or_else(|| dot(axis, offset), S::constant);
        offset - axis * along
    }

    /// Forces between ball (first) and cage (second), in oil of a viscosity [Pa s] or dry; `None` where they do not touch and nothing
    /// is between them. Spheres about a ball stay dry.
    #[inline(always)]
    pub fn evaluate<S: Single>(
        &self,
        ball: &BallMotion<S>,
        cage: &BodyMotion<S>,
        direction: [f64; 2],
        oil: f64,
    ) -> Option<PairForces<S>> {
        let touching = self.touching(ball, cage, direction);
        if oil <= 0.0 || self.sphere_circle.is_some() {
            return touching;
        }
        let dry = touching.unwrap_or_else(PairForces::none).map(S::apart);
        Some(self.in_oil(&ball.map(S::apart), &cage.map(S::apart), direction, oil, dry).map(S::back))
    }

    /// Forces of surfaces that touch, with those of the film between them.
    #[cold]
    #[inline(never)]
    fn in_oil<S: Scalar>(
        &self,
        ball: &BallMotion<S>,
        cage: &BodyMotion<S>,
        direction: [f64; 2],
        oil: f64,
        mut forces: PairForces<S>,
    ) -> PairForces<S> {
        let axis = pocket_axis(cage, direction);
        let offset = ball.position - cage.position;
        let eccentricity = self.off_centre(&offset, &axis);
        // Half way between both centres.
        let ball_arm = eccentricity.map(|component| component.scale(-0.5));
        let cage_arm = offset + ball_arm;
        let velocity = ball.velocity + cross(&ball.angular_velocity, &ball_arm)
            - cage.velocity
            - cross(&cage.angular_velocity, &cage_arm);
        let velocity = velocity - axis * dot(&axis, &velocity);
        let relative = ball.angular_velocity - cage.angular_velocity;
        let gap = Gap { axis, eccentricity, velocity, clearance: self.half_clearance };
        let (force, moment) = film::pocket(&gap, oil, self.ball_radius, &relative);
        forces.force += force;
        forces.moment += cross(&ball_arm, &force) + moment;
        forces.other_moment -= cross(&cage_arm, &force) + moment;
        forces.friction_power -= dot(&force, &velocity) + dot(&moment, &relative);
        forces
    }

    /// Forces of surfaces that touch; `None` where they do not.
    #[inline(always)]
    fn touching<S: Single>(
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

        let surfaces = Surfaces::new(
            ball,
            self.ball_radius,
            [&cage.velocity, &cage.angular_velocity],
            &offset,
            normal,
            &self.normal_rate(ball, cage, &offset, &axis, &normal, distance),
        );

        // normal load
        let root = approach.sqrt();
        let shape = self.shape.constant::<S>();
        let load =
            NormalLoad::hertz(shape.stiffness, approach, root, surfaces.approach_rate, self.damping.into());

        // creep forces of the ball on the cage, in the contact frame: x along the pocket
        let x = if self.sphere_circle.is_some() { across(&normal, &axis, &cage.axes[0]) } else { axis };
        let rolling = surfaces.rolling(x, None);
        let theory =
            LinearTheory::new(&shape, [approach, root], load.total.scale(self.friction), rolling.cosine);
        let creep = theory.forces(Law::Saturated, &rolling.creepage);

        let wrench = surfaces.wrench(&rolling, load.total, &creep);
        Some(PairForces {
            approach,
            load: load.total,
            stiffness: shape.stiffness,
            force: wrench.force,
            moment: wrench.ball_moment,
            other_moment: wrench.other_moment,
            friction_power: wrench.friction_power,
            damping_power: load.damping_power,
        })
    }

    /// [1/s] rate of change of the contact normal.
    #[inline(always)]
    fn normal_rate<S: Scalar>(
        &self,
        ball: &BallMotion<S>,
        cage: &BodyMotion<S>,
        offset: &Vector3<S>,
        axis: &Vector3<S>,
        normal: &Vector3<S>,
        distance: S,
    ) -> Vector3<S> {
        // Seen from the cage, the ball centre moves with this velocity.
        let relative = ball.velocity - cage.velocity - cross(&cage.angular_velocity, offset);
        let mut around = relative - normal * dot(normal, &relative);
        if self.sphere_circle.is_none() {
            around -= axis * dot(axis, &relative);
        }
        around.map(|component| component / distance) + cross(&cage.angular_velocity, normal)
    }
}

/// \[m] approaches of balls and pockets, to the bits of [`PocketModel::touching`]. Compiled twice, as contacts are
/// ([`crate::contact::many`]).
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn approach_lanes(
    pocket: &PocketModel,
    balls: &BallMotion<Lanes>,
    cage: &BodyMotion<f64>,
    directions: &[[f64; 2]; WIDTH],
    approach: &mut Lanes,
) {
    let axis = Lanes::vector(|lane| pocket_axis(cage, directions[lane]));
    let offset = balls.position - constant_vector::<Lanes>(&cage.position);
    let off_centre = pocket.off_centre(&offset, &axis);
    *approach = dot(&off_centre, &off_centre).sqrt() - Lanes::constant(pocket.half_clearance);
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
