//! The contact of a ball with a race: the chain from motion to forces.
//!
//! The chain is written once, generic over the numbers, and compiled for two kinds of contact ([`Path`]). The plain one is what most
//! contacts of most scenes are: a ball that rolls along the circumference of a torus, dry, damped as usual. The general one
//! takes any contact; both give the same bits where the plain one holds. What runs when, and what it is compiled for:
//!
//! | numbers | plain contact | any other |
//! |---|---|---|
//! | four balls at a time ([`super::many`]) | plain, with vectors alone | general, with vectors alone |
//! | derivatives by ball and race ([`ContactModel::differentiated`]) | plain, nine directions | general, nine directions |
//! | derivatives by the ball alone ([`ContactModel::on_ball`]) | plain, six directions, with vectors alone | as by both |
//! | one ball ([`ContactModel::evaluate`]) | plain | general |
//!
//! Processors without vectors take balls one by one, and derivatives of the general path: same bits, for less of a library that hardly any of
//! them loads.
//!
//! Each entry costs 0.1 to 0.4 MB of the library and seconds of its build, so that there is one only where steps spend their time.

use crate::numerics::elementary::pow;
use std::f64::consts::PI;

use nalgebra::{UnitQuaternion, Vector3};

use super::film::{FilmForces, Loading, slip_of};
use super::geometry::{GrooveContact, Lean};
use super::{BallRaceContact, ContactModel, Resistance};
use crate::contact::creep::oblique::is_oblique;
use crate::contact::creep::{CreepForces, Creepage, Law, LinearTheory};
use crate::contact::kinematics::{self, RollingState, Surfaces};
use crate::contact::motion::{BallMotion, RaceMotion};
use crate::contact::normal::{Damping, NormalLoad};
use crate::contact::pair::PairForces;
use crate::contact::shape::ShapeAt;
use crate::kalker::nonlinear::KalkerError;
use crate::kalker::scaled_law::{Difference, ScaledKalker};
use crate::numerics::scalar::{Scalar, cross, dot};

/// Paths from motion to forces: see the head of this file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// Rolling along the circumference, on a plain torus with the usual damping.
    Plain,
    /// Any contact.
    General,
}

impl ContactModel<'_> {
    /// Evaluates the contact of a ball with the race: the whole chain from motion to forces, written once for values
    /// and for exact derivatives. Without friction only what forces need is computed; [`Self::completed`] adds the rest.
    #[inline(never)]
    pub fn evaluate<S: Scalar>(&self, ball: &BallMotion<S>, race: &RaceMotion<S>) -> BallRaceContact<S> {
        if matches!(self.law, Law::Frictionless) {
            return self.pressed::<S, true>(ball, race);
        }
        if self.path(false) == Path::Plain {
            let (contact, oblique) = self.rolling::<S, false>(ball, race);
            if !oblique {
                return contact;
            }
        }
        self.rolling_any(ball, race)
    }

    /// Forces and moments of an evaluated contact alone, which cost less than the whole of it; with derivatives.
    #[inline(never)]
    pub fn forces<S: Scalar>(&self, ball: &BallMotion<S>, race: &RaceMotion<S>) -> PairForces<S> {
        match self.law {
            Law::Frictionless => PairForces::from(&self.pressed::<S, true>(ball, race)),
            _ => PairForces::from(&self.rolling::<S, true>(ball, race).0),
        }
    }

    /// Forces and moments by the plain path, where [`Self::path`] says so; none where the contact turns out to need the general one.
    #[inline(never)]
    pub fn plain_forces<S: Scalar>(
        &self,
        ball: &BallMotion<S>,
        race: &RaceMotion<S>,
    ) -> Option<PairForces<S>> {
        if matches!(self.law, Law::Frictionless) {
            return None;
        }
        let (contact, oblique) = self.rolling::<S, false>(ball, race);
        (!oblique).then(|| PairForces::from(&contact))
    }

    /// The shortest path to its forces. `obliquely`: did it roll so when it was evaluated last
    /// ([`ContactGroup::rolled_obliquely`](super::many::ContactGroup::rolled_obliquely))? Whatever is said, results are the same, bit by bit.
    pub fn path(&self, obliquely: bool) -> Path {
        let plain = self.is_usual() && !obliquely;
        if plain { Path::Plain } else { Path::General }
    }

    /// A contact without friction with the ellipse, the creepages and the direction of rolling that no force depends on.
    pub fn completed(
        &self,
        contact: &BallRaceContact<f64>,
        ball: &BallMotion<f64>,
        race: &RaceMotion<f64>,
    ) -> BallRaceContact<f64> {
        match self.law {
            Law::Frictionless => ContactModel { across: None, ..*self }.rolling_any(ball, race),
            _ => *contact,
        }
    }

    /// Is the race a torus under balls that are alike, without anything against rolling, with the usual damping?
    #[inline(always)]
    pub(super) fn is_usual(&self) -> bool {
        self.surface.is_plain() && !self.resists() && matches!(self.damping, Damping::HuntCrossley(_))
    }

    /// Is there anything against rolling?
    #[inline(always)]
    pub fn resists(&self) -> bool {
        self.film.is_some() || self.resistance.factor > 0.0
    }

    /// [N/m^1.5] Hertz stiffness of these balls, of that of the shape where the contact is.
    #[inline(always)]
    pub fn stiffness_of<S: Scalar>(&self, of_shape: S) -> S {
        let stiffness = of_shape.scale(self.stiffening);
        match self.surface.of_balls::<S>(|size| size.stiffness) {
            None => stiffness,
            Some(factor) => stiffness * factor,
        }
    }

    /// Where the ball touches, and how its approach changes there ([`GrooveContact::new`]).
    #[inline(always)]
    fn touch<S: Scalar, const GENERAL: bool>(
        &self,
        offset: &Vector3<S>,
        race: &RaceMotion<S>,
    ) -> (GrooveContact<S>, Lean<S>) {
        match GENERAL {
            true => GrooveContact::new(&self.surface, offset, race),
            false => (GrooveContact::plain(&self.surface, offset, race), Lean::none()),
        }
    }

    /// Is the ball clear of the race? Nothing acts between them then, nor would a little nearer.
    pub fn is_open(&self, ball: &BallMotion<f64>, race: &RaceMotion<f64>) -> bool {
        let offset = ball.position - race.position;
        let (geometry, _) = match self.surface.is_plain() {
            true => self.touch::<_, false>(&offset, race),
            false => self.touch::<_, true>(&offset, race),
        };
        geometry.approach < 0.0
    }

    /// Hertz stiffness and normal load by the stiffness of the shape, the depth and its root, the approach rate along the normal,
    /// and how the approach changes: the load does the work along the normal of one that goes with the approach.
    #[inline(always)]
    fn normal_load<S: Scalar, const GENERAL: bool>(
        &self,
        of_shape: S,
        [depth, root]: [S; 2],
        rate: S,
        (lean, turning): (&Lean<S>, impl FnOnce() -> Vector3<S>),
    ) -> (S, NormalLoad<S>) {
        if GENERAL {
            let stiffness = self.stiffness_of(of_shape);
            let rate = lean.rate(rate, turning);
            let load = NormalLoad::hertz(stiffness, depth, root, rate, self.damping);
            (stiffness, NormalLoad { total: load.total * lean.gain, ..load })
        } else {
            let stiffness = of_shape.scale(self.stiffening);
            let (Damping::HuntCrossley(factor) | Damping::Viscoelastic(factor)) = self.damping;
            (stiffness, NormalLoad::damped(stiffness * depth * root, rate, factor))
        }
    }

    /// [1/m] sum of the curvatures of ball and race along the circumference.
    #[inline(always)]
    fn curvature_along<S: Scalar>(&self, of_race: S) -> S {
        of_race + S::constant(1.0 / self.surface.ball_radius)
    }

    /// Linear theory of a contact, and what a film does in it where there is one: its shape, the curvature of the race [1/m], depth
    /// \[m] and its root, load \[N].
    #[inline(always)]
    fn theory<S: Scalar, const GENERAL: bool>(
        &self,
        shape: &ShapeAt<S>,
        of_race: S,
        [depth, root]: [S; 2],
        load: S,
        rolling: &RollingState<S>,
    ) -> (LinearTheory<S>, Option<FilmForces<S>>) {
        let dry = |friction_limit: S| LinearTheory::new(shape, [depth, root], friction_limit, rolling.cosine);
        let film = if GENERAL { self.film.as_ref() } else { None };
        let Some(film) = film else {
            return (dry(load.scale(self.friction)), None);
        };
        let loading = loading(shape, self.curvature_along(of_race), depth, load, rolling);
        let forces = film.forces(&loading);
        (dry(load * forces.friction).in_series(&rolling.creepage, forces.viscous_share), Some(forces))
    }

    /// [N m] moment against rolling by the material, at a load \[N].
    #[inline(always)]
    pub fn resisting_moment<S: Scalar>(&self, load: S) -> S {
        let Resistance { factor, exponent } = self.resistance;
        load.map_smooth(|load| {
            let slope = pow(load, exponent - 1.0);
            (slope * load, exponent * slope)
        })
        .scale(factor)
    }

    /// \[W] power that this moment takes of an evaluated contact.
    pub fn resisting_power(&self, contact: &BallRaceContact<f64>) -> f64 {
        let curvature = self.curvature_along(contact.geometry.circumferential_curvature);
        self.resisting_moment(contact.load) * contact.rolling_speed * curvature
    }

    /// Load, speed, slip and size that the film of an evaluated contact depends on.
    pub fn film_loading(&self, contact: &BallRaceContact<f64>) -> Loading<f64> {
        let of_race = contact.geometry.circumferential_curvature;
        let depth = contact.geometry.approach.max(0.0);
        loading(
            &self.shape.at(of_race),
            self.curvature_along(of_race),
            depth,
            contact.load,
            &contact.rolling_state(),
        )
    }

    /// A contact that carries its normal load alone.
    #[inline(always)]
    pub(super) fn pressed<S: Scalar, const GENERAL: bool>(
        &self,
        ball: &BallMotion<S>,
        race: &RaceMotion<S>,
    ) -> BallRaceContact<S> {
        let offset = ball.position - race.position;
        let (geometry, lean) = self.touch::<S, GENERAL>(&offset, race);
        let depth = geometry.approach.positive_part();
        let of_shape = self.shape.stiffness(geometry.circumferential_curvature);
        let (arm, race_arm) = kinematics::arms(geometry.normal, self.surface.ball_radius, &offset);
        let rate = match self.damping.is_none() {
            true => S::zero(),
            false => {
                let bodies = [&race.velocity, &race.angular_velocity];
                dot(&geometry.normal, &kinematics::slip(ball, bodies, [&arm, &race_arm]))
            }
        };
        let turning = || ball.angular_velocity - race.angular_velocity;
        let (stiffness, load) =
            self.normal_load::<S, GENERAL>(of_shape, [depth, depth.sqrt()], rate, (&lean, turning));
        let (zero, none) = (S::zero(), Vector3::from_element(S::zero()));
        let force = -geometry.normal.map(|component| component * load.total);
        let mut moments = [none, -cross(&race_arm, &force)];
        if GENERAL {
            lean.turn(load.total, &mut moments);
        }
        let [ball_moment, race_moment] = moments;
        BallRaceContact {
            load: load.total,
            stiffness,
            semi_axes: [zero; 2],
            rolling_speed: zero,
            creepage: Creepage {
                longitudinal: zero,
                lateral: zero,
                spin: zero,
                curvature: self.groove_bend.map(|_| zero),
            },
            creep: CreepForces { longitudinal: zero, lateral: zero, spin_moment: zero, second_moment: zero },
            rolling_cosine: zero,
            force,
            ball_moment,
            race_moment,
            friction_power: zero,
            damping_power: load.damping_power,
            geometry,
        }
    }

    /// A contact with its creep forces, as a function of its own.
    #[inline(never)]
    fn rolling_any<S: Scalar>(&self, ball: &BallMotion<S>, race: &RaceMotion<S>) -> BallRaceContact<S> {
        self.rolling::<S, true>(ball, race).0
    }

    /// A contact with its creep forces; and whether it rolls obliquely, so that those across the circumference have a share. They are mixed
    /// in on the general path alone.
    #[inline(always)]
    pub(super) fn rolling<S: Scalar, const GENERAL: bool>(
        &self,
        ball: &BallMotion<S>,
        race: &RaceMotion<S>,
    ) -> (BallRaceContact<S>, bool) {
        let offset = ball.position - race.position;
        let (geometry, lean) = self.touch::<S, GENERAL>(&offset, race);
        let surfaces = Surfaces::new(
            ball,
            self.surface.ball_radius,
            [&race.velocity, &race.angular_velocity],
            &offset,
            geometry.normal,
            &normal_rate(&geometry, &offset, ball, race),
        );

        // normal load
        let depth = geometry.approach.positive_part();
        let root = depth.sqrt();
        let shape = self.shape.at(geometry.circumferential_curvature);
        let rate = surfaces.approach_rate;
        let turning = || ball.angular_velocity - race.angular_velocity;
        let (stiffness, load) =
            self.normal_load::<S, GENERAL>(shape.stiffness, [depth, root], rate, (&lean, turning));

        // creep forces of the ball on the race, in the contact frame: x along the circumference
        let rolling = surfaces.rolling(geometry.circumferential, self.groove_bend);
        let curvature = geometry.circumferential_curvature;
        let (theory, film) =
            self.theory::<S, GENERAL>(&shape, curvature, [depth, root], load.total, &rolling.state());
        let oblique = self.across.is_some() && is_oblique(rolling.speed, rolling.speed_across);
        let mut creep = match GENERAL {
            true => theory.forces_apart(self.law, &rolling.creepage),
            false => theory.forces(self.law, &rolling.creepage),
        };
        if GENERAL
            && oblique
            && let Some(across) = &self.across
        {
            let sine = rolling.speed_across / rolling.speed;
            creep = across.forces(&creep, &theory, [rolling.cosine, sine], &rolling.creepage);
        }

        let mut wrench = surfaces.wrench(&rolling, load.total, &creep);
        if GENERAL && self.resists() {
            let share = S::constant(1.0 / self.surface.ball_radius) / self.curvature_along(curvature);
            let force = film.map_or(S::zero(), |film| film.rolling_force);
            surfaces.resist(&mut wrench, &rolling, (force, share), self.resisting_moment(load.total));
        }
        let mut moments = [wrench.ball_moment, wrench.other_moment];
        if GENERAL {
            lean.turn(load.total, &mut moments);
        }
        let [ball_moment, race_moment] = moments;
        let contact = BallRaceContact {
            geometry,
            load: load.total,
            stiffness,
            semi_axes: [shape.semi_axis_rolling, shape.semi_axis_transverse],
            rolling_speed: rolling.speed,
            creepage: rolling.creepage,
            creep,
            rolling_cosine: rolling.cosine,
            force: wrench.force,
            ball_moment,
            race_moment,
            friction_power: wrench.friction_power,
            damping_power: load.damping_power,
        };
        (contact, oblique)
    }

    /// The contact of a ball (0 is the first), with its difference of Kalker's polynomials from the table, where they are
    /// simulated.
    pub fn of_ball<'b>(&self, ball: usize, difference: Option<&'b Difference>) -> ContactModel<'b>
    where
        Self: 'b,
    {
        ContactModel {
            surface: self.surface.under(ball),
            law: match (self.law, difference) {
                (Law::Table(table), Some(difference)) => Law::Frozen(table, &difference.value),
                (Law::Kalker(kalker), Some(last)) => Law::Continued(kalker, &last.coefficients),
                (law, _) => law,
            },
            ..*self
        }
    }

    /// Renews the difference of Kalker's polynomials from the table at an evaluated contact if its scaled creepages q have
    /// moved by more than a fraction of `1 + |q|` since the last time. Returns whether they had.
    ///
    /// # Errors
    /// If the nonlinear problem does not converge; the difference then stays what it was.
    pub fn renew(
        &self,
        kalker: &ScaledKalker,
        contact: &BallRaceContact<f64>,
        fraction: f64,
        difference: &mut Difference,
    ) -> Result<bool, KalkerError> {
        let (table, fraction) = match self.law {
            Law::Table(table) => (Some(table), fraction),
            // Nothing is frozen: the last solution is where the next one begins.
            Law::Kalker(_) => (None, 0.0),
            _ => return Ok(false),
        };
        if contact.load <= 0.0 {
            return Ok(false);
        }
        let shape = self.shape.at(contact.geometry.circumferential_curvature);
        let depth = contact.geometry.approach;
        let of_race = contact.geometry.circumferential_curvature;
        let (theory, _) = self.theory::<f64, true>(
            &shape,
            of_race,
            [depth, depth.sqrt()],
            contact.load,
            &contact.rolling_state(),
        );
        let (q, results) = theory.polynomial_scale(table, &contact.creepage);
        let old = difference.age(&q) > fraction;
        if old {
            kalker.renew(difference, q, results)?;
        }
        Ok(old)
    }
}

impl<'a> ContactModel<'a> {
    /// The contact of damaged balls of these orientations, where there are such.
    pub fn oriented(mut self, orientations: Option<&'a Vec<UnitQuaternion<f64>>>) -> Self {
        if let (Some(damage), Some(orientations)) = (&mut self.surface.damage, orientations) {
            damage.orientations = orientations;
        }
        self
    }
}

/// Quantities that the film of a contact depends on, from its shape, the sum of the curvatures along rolling [1/m], depth \[m] and load \[N].
#[inline(always)]
fn loading<S: Scalar>(
    shape: &ShapeAt<S>,
    curvature: S,
    depth: S,
    load: S,
    rolling: &RollingState<S>,
) -> Loading<S> {
    let RollingState { speed, creepage, .. } = rolling;
    let area = (shape.semi_axis_rolling * shape.semi_axis_transverse * depth).scale(PI);
    let bent = creepage
        .curvature
        .map_or(S::zero(), |curvature| curvature * shape.semi_axis_transverse.square() * depth * *speed);
    let slip = slip_of(
        [creepage.longitudinal * *speed, creepage.lateral * *speed],
        (creepage.spin * *speed, shape.mean_semi_axis * depth.sqrt()),
        bent,
    );
    Loading { load, speed: *speed, slip, curvature, area }
}

/// [1/s] rate of change of the contact normal.
#[inline(always)]
fn normal_rate<S: Scalar>(
    geometry: &GrooveContact<S>,
    offset: &Vector3<S>,
    ball: &BallMotion<S>,
    race: &RaceMotion<S>,
) -> Vector3<S> {
    // Seen from the race, whose axis is at rest, the ball centre moves with this velocity.
    let relative = ball.velocity - race.velocity - cross(&race.angular_velocity, offset);
    let radial_rate = dot(&relative, &geometry.radial);
    let around = dot(&relative, &geometry.circumferential) / geometry.radius;
    let axial_rate = dot(&relative, &race.axis);
    // The groove centre of the ball's azimuth turns with it; what remains turns the normal about the groove centre.
    let out = dot(&geometry.normal, &geometry.radial);
    let in_plane = geometry.radial * radial_rate + race.axis * axial_rate;
    let across = in_plane - geometry.normal * dot(&geometry.normal, &in_plane);
    across.map(|c| c / geometry.distance)
        + geometry.circumferential * (around * out)
        + cross(&race.angular_velocity, &geometry.normal)
}
