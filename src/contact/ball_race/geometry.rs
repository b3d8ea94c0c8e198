//! Where a ball touches a raceway: exact for a torus at any finite tilt.

use nalgebra::Vector3;

use super::ball_spall::Damage;
use super::shift::{Shift, azimuth};
use super::surface::Surface;
use crate::contact::motion::RaceMotion;
use crate::numerics::scalar::{Scalar, cross, dot};

/// \[m] distance from the groove centre below which the contact normal fades to zero.
const DISTANCE_FLOOR: f64 = 1e-15;

/// Ball against raceway, in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrooveContact<S: Scalar> {
    /// \[m] approach; positive in contact.
    pub approach: S,
    /// [-] unit normal, from groove centre to ball centre: out of the ball into the raceway.
    pub normal: Vector3<S>,
    /// [-] unit radial direction of the race through the ball centre.
    pub radial: Vector3<S>,
    /// [-] circumferential direction: race axis x radial, and along the waves of a race that has some.
    pub circumferential: Vector3<S>,
    /// \[m] distance of the ball centre from the race axis.
    pub radius: S,
    /// \[m] distance of the ball centre from the groove centre.
    pub distance: S,
    /// [1/m] curvature of the raceway along its circumference at the contact; convex (inner race) positive.
    pub circumferential_curvature: S,
}

/// How the approach of a ball changes as it moves, where a race or a ball has spalls.
#[derive(Clone, Copy, Debug)]
pub struct Lean<S: Scalar> {
    /// [-] by a move along the normal; 1 but for spalls.
    pub gain: S,
    /// \[m] by a rotation of the ball, where balls have spalls.
    pub turning: Option<Vector3<S>>,
}

impl<S: Scalar> Lean<S> {
    /// That of a whole ball on a whole race.
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self { gain: S::one(), turning: None }
    }

    /// [m/s] rate of the approach, by that of the bodies along the normal, and the angular velocity [rad/s] of the ball less that of the
    /// race.
    #[inline(always)]
    pub(super) fn rate(&self, along: S, angular_velocity: impl FnOnce() -> Vector3<S>) -> S {
        let moved = self.gain * along;
        match &self.turning {
            None => moved,
            Some(turning) => moved + dot(turning, &angular_velocity()),
        }
    }

    /// [N m] moment of the edges of spalls on the ball, and the opposite on the race, for a load \[N] along the normal.
    #[inline(always)]
    pub fn moment(&self, load: S) -> Option<Vector3<S>> {
        let own = load / self.gain;
        self.turning.map(|turning| turning.map(|component| -(component * own)))
    }

    /// Adds this moment to those on ball and race.
    #[inline(always)]
    pub(super) fn turn(&self, load: S, [ball, race]: &mut [Vector3<S>; 2]) {
        if let Some(moment) = self.moment(load) {
            *ball += moment;
            *race -= moment;
        }
    }
}

impl<S: Scalar> GrooveContact<S> {
    /// Contact of a ball whose centre is at `offset` \[m] from the centre of a race; and how its approach changes there.
    #[inline(always)]
    pub fn new(surface: &Surface<'_>, offset: &Vector3<S>, race: &RaceMotion<S>) -> (Self, Lean<S>) {
        // None and not one of 0 where there is no form: the bits are then those of a plain torus, down to signs of zeros.
        let shift = surface.form.map(|form| form.under(offset, race));
        let mut contact = Self::on(surface, offset, race, shift.as_ref());
        let mut lean = Lean::none();
        if let Some(larger) = surface.of_balls(|size| size.larger) {
            contact.approach += larger;
        }
        if surface.has_spalls() {
            let mut apart = contact.map(S::apart);
            let shift = shift.unwrap_or_else(Shift::none).map(S::apart);
            let dropped = apart.drop_into(surface, &offset.map(S::apart), &race.map(S::apart), &shift);
            contact = apart.map(S::back);
            lean = Lean { gain: S::back(dropped.gain), turning: dropped.turning.map(|by| by.map(S::back)) };
        }
        (contact, lean)
    }

    /// Geometry by the general path, as a function of its own where a caller does much more than this.
    #[inline(never)]
    pub fn apart(surface: &Surface<'_>, offset: &Vector3<S>, race: &RaceMotion<S>) -> (Self, Lean<S>) {
        Self::new(surface, offset, race)
    }

    /// Geometry by the plain path: a torus under balls that are alike.
    #[inline(always)]
    pub(super) fn plain(surface: &Surface<'_>, offset: &Vector3<S>, race: &RaceMotion<S>) -> Self {
        Self::on(surface, offset, race, None)
    }

    /// Drops the ball into the spalls of the race, and into its own. A function of its own, as few scenes have some.
    #[cold]
    #[inline(never)]
    fn drop_into(
        &mut self,
        surface: &Surface<'_>,
        offset: &Vector3<S>,
        race: &RaceMotion<S>,
        shift: &Shift<S>,
    ) -> Lean<S> {
        let around = cross(&race.axis, &self.radial);
        let (cos, sin) = (dot(&self.normal, &self.radial), dot(&self.normal, &race.axis));
        let up = race.axis * cos - self.radial * sin;
        // The gradient of what is left of the approach.
        let mut gradient = self.normal;
        if let Some(spalls) = surface.spalls {
            let drop = spalls.under(azimuth(offset, race), sin, cos, self.approach);
            self.approach -= drop.depth;
            let along = drop.by_azimuth / self.radius
                + drop.by_angle * shift.turn(cos, sin) / (self.distance * self.radius);
            gradient = gradient * S::one_minus(drop.by_approach)
                - around * along
                - up * (drop.by_angle / self.distance);
        }
        // Whole balls beside a damaged one have to be the same bits as alone: theirs stays what it was.
        let mut changed = if surface.spalls.is_some() { S::one() } else { S::zero() };
        let mut turning = None;
        for (spall, orientation) in surface.damage.iter().flat_map(Damage::each) {
            let owner = spall.owner::<S>(surface.ball);
            if !owner.any_beyond(0.5, S::one()) {
                continue;
            }
            let normal = self.radial * cos + race.axis * sin;
            let drop = spall.under(owner, orientation, &normal, self.approach);
            self.approach -= drop.depth;
            // The normal turns with the azimuth of the ball, and with its place in the groove.
            let rest = S::one_minus(drop.by_approach);
            let by_angle = dot(&drop.by_normal, &up) / self.distance;
            let by_azimuth = dot(&drop.by_normal, &around) * cos;
            let along = (by_azimuth + by_angle * shift.turn(cos, sin)) / self.radius;
            gradient = gradient * rest - around * along - up * by_angle;
            let turned = cross(&normal, &drop.by_normal);
            turning = Some(turning.map_or(turned, |before: Vector3<S>| before * rest + turned));
            changed = S::one().where_positive(owner, changed);
        }
        if !changed.any_beyond(0.5, S::one()) {
            return Lean::none();
        }
        let gain = dot(&gradient, &gradient).sqrt();
        let normal = gradient.map(|component| component / gain);
        let across = self.circumferential - normal * dot(&self.circumferential, &normal);
        let length = dot(&across, &across).sqrt();
        let across = across.map(|component| component / length);
        let select = |new: &Vector3<S>, old: &Vector3<S>| {
            new.zip_map(old, |new, old| new.where_positive(changed, old))
        };
        self.normal = select(&normal, &self.normal);
        self.circumferential = select(&across, &self.circumferential);
        Lean { gain: gain.where_positive(changed, S::one()), turning }
    }

    /// Contact with a race whose groove circle is shifted where the ball is.
    #[inline(always)]
    fn on(
        surface: &Surface<'_>,
        offset: &Vector3<S>,
        race: &RaceMotion<S>,
        shift: Option<&Shift<S>>,
    ) -> Self {
        let Surface { raceway, ball_radius, .. } = surface;
        let axis = &race.axis;
        let axial = dot(offset, axis);
        let radial_vector = offset - axis * axial;
        let radius = dot(&radial_vector, &radial_vector).sqrt();
        let radial = radial_vector.map(|component| component / radius);
        // From the groove centre of this azimuth to the ball centre.
        let mut out = radius - S::constant(raceway.groove_circle_radius);
        let mut along = axial - S::constant(raceway.groove_offset);
        if let Some(shift) = shift {
            out -= shift.radial;
            along -= shift.axial;
        }
        // A ball on the groove centre touches nothing, in no direction: the floor, below rounding, spares a 0/0.
        let distance = (out.square() + along.square() + S::constant(DISTANCE_FLOOR * DISTANCE_FLOOR)).sqrt();
        let (cos, sin) = (out / distance, along / distance);
        // A torus's second principal curvature: cosine of the normal's angle over the radius of the contact point.
        let contact_radius = radius + cos.scale(*ball_radius);
        let mut normal = radial * cos + axis * sin;
        let mut circumferential = cross(axis, &radial);
        if let Some(shift) = shift {
            // The gradient of the approach, longer than 1 by half the square of the lean: 1e-8 for waves of a micrometre.
            let lean = (cos * shift.radial_slope + sin * shift.axial_slope) / radius;
            (normal, circumferential) = (normal - circumferential * lean, circumferential + normal * lean);
        }
        Self {
            approach: distance - S::constant(raceway.groove_radius - ball_radius),
            normal,
            radial,
            circumferential,
            radius,
            distance,
            circumferential_curvature: -cos / contact_radius,
        }
    }
}

impl<S: Scalar> GrooveContact<S> {
    /// The same in other numbers.
    #[inline(always)]
    fn map<T: Scalar>(&self, number: impl Fn(S) -> T) -> GrooveContact<T> {
        self.zip_with(self, |own, _| number(own))
    }

    /// Number by number from two contacts.
    #[inline(always)]
    pub fn zip_with<U: Scalar, T: Scalar>(
        &self,
        other: &GrooveContact<U>,
        mut f: impl FnMut(S, U) -> T,
    ) -> GrooveContact<T> {
        GrooveContact {
            approach: f(self.approach, other.approach),
            normal: self.normal.zip_map(&other.normal, &mut f),
            radial: self.radial.zip_map(&other.radial, &mut f),
            circumferential: self.circumferential.zip_map(&other.circumferential, &mut f),
            radius: f(self.radius, other.radius),
            distance: f(self.distance, other.distance),
            circumferential_curvature: f(self.circumferential_curvature, other.circumferential_curvature),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::raceway::Raceway;

    #[test]
    fn limit_a_ball_on_the_groove_centre_touches_nothing() {
        let raceway = Raceway { groove_radius: 6.6e-3, groove_circle_radius: 0.0625, groove_offset: 0.0 };
        let centre = Vector3::new(0.0, raceway.groove_circle_radius, 0.0);
        let (contact, _) = GrooveContact::new(
            &Surface::plain(raceway, 6.35e-3),
            &centre,
            &RaceMotion::resting(Vector3::zeros(), Vector3::x(), Vector3::y()),
        );
        assert!((contact.approach - (6.35e-3 - raceway.groove_radius)).abs() < 2.0 * DISTANCE_FLOOR);
        let numbers = contact.normal.iter().chain([&contact.circumferential_curvature]);
        assert!(numbers.into_iter().all(|number| number.is_finite()), "{contact:?}");
    }
}
