//! Contact of two neighbouring balls, where no cage keeps them apart.
//!
//! Hertz's contact of two equal spheres. Their surfaces move against each other, as both balls turn the same way, so that
//! friction is Coulomb's, against the slip at the middle of the contact. It is made smooth near standstill. What the
//! balls' pivoting about the common normal costs is left out: they turn alike.

use super::hertz::HertzContact;
use super::materials::Pair;
use super::motion::BallMotion;
use super::normal::{Damping, NormalLoad};
use super::pair::PairForces;
use crate::numerics::elementary::pow;
use crate::numerics::scalar::{Single, cross, dot};

/// [m/s] slip below which friction is viscous: `mu Q v/sqrt(v^2 + v_0^2)`. Turning balls slide at metres a second.
const REGULARISATION_SPEED: f64 = 1e-2;

/// Constants of the contact of two equal balls.
#[derive(Clone, Copy, Debug)]
pub struct BallBallModel {
    /// \[m] ball diameter.
    pub diameter: f64,
    /// [N/m^1.5] Hertz stiffness.
    pub stiffness: f64,
    /// [-] friction coefficient.
    pub friction: f64,
}

impl BallBallModel {
    /// Balls of a radius \[m], of one material: Young's modulus \[Pa] and Poisson's ratio.
    pub fn new(radius: f64, material: (f64, f64), friction: f64) -> Self {
        let curvature = 2.0 / radius;
        let hertz = HertzContact::new(curvature, curvature, Pair::new([material; 2]).compliance);
        Self { diameter: 2.0 * radius, stiffness: hertz.stiffness, friction }
    }

    /// \[J] elastic energy at an approach \[m].
    pub fn elastic_energy(&self, approach: f64) -> f64 {
        0.4 * self.stiffness * pow(approach.max(0.0), 2.5)
    }

    /// \[m] approach of two balls; negative is a gap.
    pub fn approach(&self, first: &BallMotion<f64>, second: &BallMotion<f64>) -> f64 {
        self.diameter - (second.position - first.position).norm()
    }

    /// Forces between two balls with some damping; a number is a Hunt-Crossley dissipation factor [s/m]. `None` where they do not touch.
    #[inline(always)]
    pub fn evaluate<S: Single>(
        &self,
        first: &BallMotion<S>,
        second: &BallMotion<S>,
        damping: impl Into<Damping>,
    ) -> Option<PairForces<S>> {
        let offset = second.position - first.position;
        let distance = dot(&offset, &offset).sqrt();
        let approach = S::constant(self.diameter) - distance;
        if approach.value() <= 0.0 {
            return None;
        }
        let normal = offset.map(|component| component / distance);
        // Both arms end in the middle of the contact, so that no angular momentum is made.
        let arm = offset.map(|component| component.scale(0.5));

        let relative = first.velocity - second.velocity;
        let stiffness = S::constant(self.stiffness);
        let load =
            NormalLoad::hertz(stiffness, approach, approach.sqrt(), dot(&normal, &relative), damping.into());

        let turning = first.angular_velocity + second.angular_velocity;
        let slip = relative + cross(&turning, &arm);
        let slip = slip - normal * dot(&normal, &slip);
        let squared = dot(&slip, &slip);
        let floor = S::constant(REGULARISATION_SPEED * REGULARISATION_SPEED);
        let per_speed = load.total.scale(self.friction) / (squared + floor).sqrt();
        let friction = slip * per_speed;
        // The arms are opposite, and so are the forces: both moments are the same.
        let moment = -cross(&arm, &friction);
        Some(PairForces {
            approach,
            load: load.total,
            stiffness,
            force: -(normal * load.total + friction),
            moment,
            other_moment: moment,
            friction_power: squared * per_speed,
            damping_power: load.damping_power,
        })
    }
}
