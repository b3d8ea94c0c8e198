//! Contact of the cage with the lands of the race that guides it (paper section 4.2.2, after Gupta 1984).
//!
//! Two lands, one on either side of the balls. On each the cage, a ring, may touch the land, a cylinder, along a line:
//! Lundberg's empirical `delta = 3.84e-5 Q^0.9/l^0.8` (mm, N; steel), inverted, and friction of complete slip.

use crate::numerics::elementary::pow;
use nalgebra::Vector3;

use super::film::{self, Gap};
use crate::contact::motion::BodyMotion;
use crate::contact::motion::RaceMotion;
use crate::contact::normal::NormalLoad;
use crate::contact::pair::PairForces;
use crate::numerics::scalar::{Scalar, Single, cross, dot};

/// [m/s] sliding speed below which friction fades: `v/sqrt(v^2 + this^2)`. A cage slides on its land at metres per
/// second.
const SLIDING_FLOOR: f64 = 1e-2;
/// [-] exponent of the approach in Lundberg's law, inverted.
const EXPONENT: f64 = 1.0 / 0.9;

/// Constants of the contacts of the cage with the lands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LandModel {
    /// \[m] half the diametral clearance: how far the cage's centre moves before it touches.
    pub half_clearance: f64,
    /// \[m] radius of the race's land; negative on an inner race, which is touched on the side that the cage moved away
    /// from.
    radius: f64,
    /// \[m] width of one land.
    width: f64,
    /// \[m] axial positions of the lands' middles in the cage.
    pub positions: [f64; 2],
    /// [N/m^(10/9)] `Q = stiffness delta^(10/9)` of one land.
    stiffness: f64,
    /// [-] friction coefficient.
    friction: f64,
    /// [s/m] Hunt-Crossley dissipation factor.
    damping: f64,
}

/// Dimensions of the lands.
#[derive(Clone, Copy, Debug)]
pub struct Lands {
    /// Are they those of an inner race, which the cage lies around?
    pub inside: bool,
    /// \[m] diametral clearance.
    pub clearance: f64,
    /// \[m] diameter of the race's lands.
    pub diameter: f64,
    /// \[m] width of each of the two lands.
    pub width: f64,
    /// \[m] distance of the inner edges of the lands from the plane of the pockets.
    pub edge: f64,
}

impl LandModel {
    /// Lands with a friction coefficient and a dissipation factor [s/m].
    pub fn new(lands: &Lands, friction: f64, damping: f64) -> Self {
        let middle = lands.edge + 0.5 * lands.width;
        Self {
            half_clearance: 0.5 * lands.clearance,
            radius: if lands.inside { -0.5 } else { 0.5 } * lands.diameter,
            width: lands.width,
            positions: [-middle, middle],
            stiffness: lundberg_stiffness(lands.width),
            friction,
            damping,
        }
    }

    /// \[J] elastic energy of one land at an approach \[m].
    pub fn elastic_energy(&self, approach: f64) -> f64 {
        self.stiffness * pow(approach.max(0.0), EXPONENT + 1.0) / (EXPONENT + 1.0)
    }

    /// \[m] approach on the land at an axial position \[m] of the cage; negative is a gap.
    pub fn approach(&self, cage: &BodyMotion<f64>, race: &RaceMotion<f64>, position: f64) -> f64 {
        eccentricity(cage, race, position).1.norm() - self.half_clearance
    }

    /// Forces between cage (first) and race (second) on the land at an axial position \[m] of the cage, in oil of a viscosity [Pa s]
    /// or dry; `None` where they do not touch and nothing is between them.
    #[inline(always)]
    pub fn evaluate<S: Single>(
        &self,
        cage: &BodyMotion<S>,
        race: &RaceMotion<S>,
        position: f64,
        oil: f64,
    ) -> Option<PairForces<S>> {
        let touching = self.touching(cage, race, position);
        if oil <= 0.0 {
            return touching;
        }
        let dry = touching.unwrap_or_else(PairForces::none).map(S::apart);
        Some(self.in_oil(&cage.map(S::apart), &race.map(S::apart), position, oil, dry).map(S::back))
    }

    /// Forces of surfaces that touch, with those of the film between them.
    #[cold]
    #[inline(never)]
    fn in_oil<S: Scalar>(
        &self,
        cage: &BodyMotion<S>,
        race: &RaceMotion<S>,
        position: f64,
        oil: f64,
        mut forces: PairForces<S>,
    ) -> PairForces<S> {
        let (axial, eccentric) = eccentricity(cage, race, position);
        // Half way between both centres.
        let race_arm = race.axis * axial + eccentric.map(|component| component.scale(0.5));
        let cage_arm = race_arm + race.position - cage.position;
        let velocity = cage.velocity + cross(&cage.angular_velocity, &cage_arm)
            - race.velocity
            - cross(&race.angular_velocity, &race_arm);
        let velocity = velocity - race.axis * dot(&race.axis, &velocity);
        let spin = dot(&(cage.angular_velocity - race.angular_velocity), &race.axis);
        let gap = Gap { axis: race.axis, eccentricity: eccentric, velocity, clearance: self.half_clearance };
        let (force, friction) = film::land(&gap, oil, [self.width, self.radius.abs()], spin);
        let moment = race.axis * friction;
        forces.force += force;
        forces.moment += cross(&cage_arm, &force) + moment;
        forces.other_moment -= cross(&race_arm, &force) + moment;
        forces.friction_power -= dot(&force, &velocity) + friction * spin;
        forces
    }

    /// Forces of surfaces that touch; `None` where they do not.
    #[inline(always)]
    fn touching<S: Single>(
        &self,
        cage: &BodyMotion<S>,
        race: &RaceMotion<S>,
        position: f64,
    ) -> Option<PairForces<S>> {
        let (axial, eccentric) = eccentricity(cage, race, position);
        let eccentricity = dot(&eccentric, &eccentric).sqrt();
        let approach = eccentricity - S::constant(self.half_clearance);
        if approach.value() <= 0.0 {
            return None;
        }
        let outwards = eccentric.map(|component| component / eccentricity);

        let race_arm = race.axis * axial + outwards.map(|c| c.scale(self.radius));
        let cage_arm = race_arm + race.position - cage.position;
        let slip = cage.velocity + cross(&cage.angular_velocity, &cage_arm)
            - race.velocity
            - cross(&race.angular_velocity, &race_arm);
        let approach_rate = dot(&outwards, &slip);
        let sliding = slip - outwards * approach_rate;

        let elastic = approach.map_smooth(|d| {
            let load = self.stiffness * pow(d, EXPONENT);
            (load, EXPONENT * load / d)
        });
        let load = NormalLoad::damped(elastic, approach_rate, self.damping);
        let speed = (dot(&sliding, &sliding) + S::constant(SLIDING_FLOOR * SLIDING_FLOOR)).sqrt();
        let friction = sliding * (load.total.scale(self.friction) / speed);
        let force = -(outwards * load.total + friction);
        Some(PairForces {
            approach,
            load: load.total,
            stiffness: S::constant(self.stiffness),
            force,
            moment: cross(&cage_arm, &force),
            other_moment: -cross(&race_arm, &force),
            friction_power: dot(&friction, &sliding),
            damping_power: load.damping_power,
        })
    }
}

/// Centre of the cage's section at an axial position \[m] of the cage, seen from the race: along its axis and across.
#[inline(always)]
fn eccentricity<S: Scalar>(cage: &BodyMotion<S>, race: &RaceMotion<S>, position: f64) -> (S, Vector3<S>) {
    let section = cage.position + cage.axes[0].map(|c| c.scale(position)) - race.position;
    let axial = dot(&section, &race.axis);
    (axial, section - race.axis * axial)
}

/// [N/m^(10/9)] of a line of a length \[m]: `Q = (delta l^0.8/3.84e-5)^(1/0.9)` in mm and N.
fn lundberg_stiffness(length: f64) -> f64 {
    (1e3 * (1e3 * length).powf(0.8) / 3.84e-5).powf(EXPONENT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_line_contact_law_is_inverted() {
        for (load, length) in [(1.0f64, 1.0f64), (50.0, 2.5), (3000.0, 8.0)] {
            let approach = 1e-3 * 3.84e-5 * load.powf(0.9) / length.powf(0.8);
            let inverse = lundberg_stiffness(1e-3 * length) * approach.powf(EXPONENT);
            assert!((inverse / load - 1.0).abs() < 1e-12, "{inverse} {load}");
        }
    }
}
