//! Contact of a ball and a raceway: constants of a step, forces, and what they came from.

pub mod ball_spall;
mod compiled;
mod evaluate;
pub mod film;
pub mod form;
pub mod geometry;
pub mod many;
mod shift;
pub mod shoulder;
pub mod spall;
pub mod surface;

use nalgebra::Vector3;

use crate::contact::creep::oblique::Across;
use crate::contact::creep::{CreepForces, Creepage, Law};
use crate::contact::kinematics::RollingState;
use crate::contact::normal::Damping;
use crate::contact::shape::ContactShape;
use crate::numerics::scalar::{Scalar, Single};
pub use evaluate::Path;
use film::Film;
use geometry::GrooveContact;
use surface::Surface;

/// Moment against rolling that the material of both bodies sets: a power of the load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resistance {
    /// [N m/N^exponent] moment over that power of the load; 0 where nothing resists.
    pub factor: f64,
    /// [-] exponent of the load.
    pub exponent: f64,
}

/// Constants of a ball-race contact during a step.
#[derive(Clone, Copy, Debug)]
pub struct ContactModel<'a> {
    /// Surface that the balls roll on, and their size.
    pub surface: Surface<'a>,
    /// Shape of its contacts: stiffness, ellipse and creep coefficients over the approach.
    pub shape: &'a ContactShape,
    /// [-] Hertz stiffness over that of `shape`, whose dimensions growth has changed since.
    pub stiffening: f64,
    /// Creep law of rolling along the circumference.
    pub law: Law<'a>,
    /// Rolling across it; none where there is no friction.
    pub across: Option<Across<'a>>,
    /// [-] friction coefficient of dry surfaces.
    pub friction: f64,
    /// The film between ball and race; none where surfaces are dry.
    pub film: Option<Film<'a>>,
    /// Moment against rolling in the material of ball and race.
    pub resistance: Resistance,
    /// How energy is lost to the approach rate.
    pub damping: Damping,
    /// [1/m] mean transverse curvature `1/(2 R)` of ball and groove where its slip (Heathcote) is simulated.
    pub groove_bend: Option<f64>,
}

/// Forces of one ball-race contact and the quantities they came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallRaceContact<S: Scalar> {
    /// Geometry of the contact.
    pub geometry: GrooveContact<S>,
    /// \[N] normal load.
    pub load: S,
    /// [N/m^1.5] Hertz stiffness.
    pub stiffness: S,
    /// [m^0.5] semi-axes of the ellipse along and transverse to rolling over the root of the approach.
    pub semi_axes: [S; 2],
    /// [m/s] rolling speed, regularised.
    pub rolling_speed: S,
    /// Creepages in the contact frame whose x axis is the circumferential direction of the race.
    pub creepage: Creepage<S>,
    /// Creep forces of the ball on the race, same frame.
    pub creep: CreepForces<S>,
    /// [-] cosine of the rolling direction against the circumferential direction, near +-1.
    pub rolling_cosine: S,
    /// \[N] force on the ball, world axes.
    pub force: Vector3<S>,
    /// [N m] moment on the ball about its centre, world axes.
    pub ball_moment: Vector3<S>,
    /// [N m] moment on the race about its origin, world axes.
    pub race_moment: Vector3<S>,
    /// \[W] power lost to friction.
    pub friction_power: S,
    /// \[W] power lost to contact damping.
    pub damping_power: S,
}

impl BallRaceContact<f64> {
    /// How it rolls.
    fn rolling_state(&self) -> RollingState<f64> {
        RollingState { speed: self.rolling_speed, cosine: self.rolling_cosine, creepage: self.creepage }
    }

    /// \[W] part of the friction power by its creep forces: all of it where nothing is against rolling.
    pub fn sliding_power(&self) -> f64 {
        self.rolling_speed * self.creep.power(&self.creepage)
    }
}

impl<S: Scalar> BallRaceContact<S> {
    /// Number by number from two contacts.
    #[inline(always)]
    pub fn zip_with<U: Scalar, T: Scalar>(
        &self,
        other: &BallRaceContact<U>,
        mut f: impl FnMut(S, U) -> T,
    ) -> BallRaceContact<T> {
        BallRaceContact {
            geometry: self.geometry.zip_with(&other.geometry, &mut f),
            load: f(self.load, other.load),
            stiffness: f(self.stiffness, other.stiffness),
            semi_axes: [0, 1].map(|i: usize| f(self.semi_axes[i], other.semi_axes[i])),
            rolling_speed: f(self.rolling_speed, other.rolling_speed),
            creepage: self.creepage.zip_with(&other.creepage, &mut f),
            creep: self.creep.zip_with(&other.creep, &mut f),
            rolling_cosine: f(self.rolling_cosine, other.rolling_cosine),
            force: self.force.zip_map(&other.force, &mut f),
            ball_moment: self.ball_moment.zip_map(&other.ball_moment, &mut f),
            race_moment: self.race_moment.zip_map(&other.race_moment, &mut f),
            friction_power: f(self.friction_power, other.friction_power),
            damping_power: f(self.damping_power, other.damping_power),
        }
    }
}

impl<S: Single> BallRaceContact<S> {
    /// Values without derivatives.
    #[inline(always)]
    pub fn values(&self) -> BallRaceContact<f64> {
        self.zip_with(self, |x, _| x.value())
    }
}
