//! The bodies of a bearing: which there are, how each is driven, and lists with one entry per body.

use std::fmt;
use std::ops::{Index, IndexMut};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::effects::cage::CageSection;
use crate::numerics::scalar::Scalar;
use crate::scene::{Condition, Direction, Drive, RaceSection, Scene, Schedule};
pub use crate::schema::Race;
use crate::schema::SupportSection;

/// A body that balls touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// A race.
    Race(Race),
    /// The cage.
    Cage,
}

impl Body {
    /// All, in the order of every list.
    pub const ALL: [Self; 3] = [Self::Race(Race::Inner), Self::Race(Race::Outer), Self::Cage];

    /// Index of the body in every list.
    pub fn index(self) -> usize {
        match self {
            Self::Race(race) => race as usize,
            Self::Cage => 2,
        }
    }
}

impl From<Race> for Body {
    fn from(race: Race) -> Self {
        Self::Race(race)
    }
}

impl fmt::Display for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Race(race) => write!(f, "{} race", race.name()),
            Self::Cage => f.write_str("cage"),
        }
    }
}

/// A value for each race.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PerRace<T> {
    /// Value of the inner race.
    pub inner: T,
    /// Value of the outer race.
    pub outer: T,
}

impl<T> PerRace<T> {
    /// Values given by a function of the race.
    #[inline(always)]
    pub fn new(mut of: impl FnMut(Race) -> T) -> Self {
        Self { inner: of(Race::Inner), outer: of(Race::Outer) }
    }

    /// Values given by a function of the race that may fail.
    ///
    /// # Errors
    /// The first failure.
    pub fn try_new<E>(mut of: impl FnMut(Race) -> Result<T, E>) -> Result<Self, E> {
        Ok(Self { inner: of(Race::Inner)?, outer: of(Race::Outer)? })
    }

    /// Both, inner first.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        [&self.inner, &self.outer].into_iter()
    }
}

impl<T> Index<Race> for PerRace<T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, race: Race) -> &T {
        match race {
            Race::Inner => &self.inner,
            Race::Outer => &self.outer,
        }
    }
}

impl<T> IndexMut<Race> for PerRace<T> {
    #[inline(always)]
    fn index_mut(&mut self, race: Race) -> &mut T {
        match race {
            Race::Inner => &mut self.inner,
            Race::Outer => &mut self.outer,
        }
    }
}

/// A value for each body of a bearing: inner race, outer race, and the cage where it is simulated.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bodies<T>(Vec<T>);

impl<T> Bodies<T> {
    /// Values of both races and, where there is one, of the cage.
    pub fn new(races: PerRace<T>, cage: Option<T>) -> Self {
        Self([races.inner, races.outer].into_iter().chain(cage).collect())
    }

    /// Values for the same bodies, each given by a function of the body and its present value.
    pub fn map<U>(&self, mut of: impl FnMut(Body, &T) -> U) -> Bodies<U> {
        Bodies(self.iter().map(|(body, one)| of(body, one)).collect())
    }

    /// That of a body, where there is one.
    #[inline]
    pub fn get(&self, body: impl Into<Body>) -> Option<&T> {
        self.0.get(body.into().index())
    }

    /// That of a body, where there is one.
    #[inline]
    pub fn get_mut(&mut self, body: impl Into<Body>) -> Option<&mut T> {
        self.0.get_mut(body.into().index())
    }

    /// All with their bodies.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (Body, &T)> {
        Body::ALL.into_iter().zip(&self.0)
    }

    /// All with their bodies.
    #[inline]
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (Body, &mut T)> {
        Body::ALL.into_iter().zip(&mut self.0)
    }

    /// [-] number of bodies.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Are there none? Only before a list is filled.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<T> Index<Race> for Bodies<T> {
    type Output = T;
    #[inline]
    fn index(&self, race: Race) -> &T {
        &self.0[race as usize]
    }
}

impl<T> IndexMut<Race> for Bodies<T> {
    #[inline]
    fn index_mut(&mut self, race: Race) -> &mut T {
        &mut self.0[race as usize]
    }
}

/// A constraint on a body (paper eq. 1, 2, 24).
#[derive(Clone, Debug, PartialEq)]
pub enum Constraint {
    /// Holonomic: position along a world axis (0, 1, 2) follows a schedule \[m].
    Position(usize, Schedule),
    /// Holonomic: tilt about world y (1) or z (2) follows a schedule \[rad].
    Tilt(usize, Schedule),
    /// Non-holonomic: spin about the body's own axis has the prescribed speed (eq. 24).
    Spin,
}

/// A body with a mass, which forces move; other bodies have a prescribed motion.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// \[kg] mass.
    pub mass: f64,
    /// [kg m2] moments of inertia about the body's own axes.
    pub inertia: Vector3<f64>,
    /// [kg m] mass times the offset of the centre of mass from the origin, in the body's own axes; none where they are the same. The load
    /// on such a body is its weight alone.
    pub unbalance: Option<Vector3<f64>>,
    /// Constraints, in the order of their multipliers.
    pub constraints: Vec<Constraint>,
    /// Is it part of a structure that carries it, such as a shaft? It then has neither mass nor equations of its own.
    pub carried: bool,
}

impl RigidBody {
    /// A body that forces move, with a mass \[kg], moments of inertia about its own axes [kg m2], and constraints.
    pub fn new(mass: f64, inertia: Vector3<f64>, constraints: Vec<Constraint>) -> Self {
        Self { mass, inertia, unbalance: None, constraints, carried: false }
    }

    /// A race that a structure carries.
    pub fn carried() -> Self {
        Self { carried: true, ..Self::new(0.0, Vector3::zeros(), vec![]) }
    }

    /// [-] components along world z and y of the body's axis held at a time \[s], with the sign of their tilts about y and
    /// z: the axis of the rotation vector [0, ry, rz] of all scripted tilts and that of the frame \[rad].
    pub fn tilt_target(&self, axis: usize, time: f64, frame: &Vector3<f64>) -> f64 {
        let mut tilt = [frame.y, frame.z];
        for constraint in &self.constraints {
            if let Constraint::Tilt(axis, schedule) = constraint {
                tilt[axis - 1] += schedule.smooth_at(time).0;
            }
        }
        let angle = f64::hypot(tilt[0], tilt[1]);
        if angle == 0.0 { 0.0 } else { tilt[axis - 1] * (angle.sin() / angle) }
    }

    /// Rows in the Newton matrix: 6 of motion and one per constraint.
    pub fn rows(&self) -> usize {
        6 + self.constraints.len()
    }

    /// A cage; it has no constraints.
    pub(super) fn cage(section: &CageSection) -> Self {
        let inertia = Vector3::from(section.inertia.map(|moment| moment.0));
        let unbalance = section.unbalance.map(|product| Vector3::y() * product.0);
        Self { unbalance, ..Self::new(section.mass.0, inertia, vec![]) }
    }

    /// A race under a wrench, held where the scene's load gives motions.
    pub(super) fn under_wrench(race: Race, scene: &Scene) -> Option<Self> {
        let held = |(direction, given): (usize, Direction<'_>)| match given.condition() {
            Condition::Load(_) => None,
            Condition::Motion(schedule) if direction < 3 => Some(Constraint::Position(direction, schedule)),
            Condition::Motion(schedule) => Some(Constraint::Tilt(direction - 2, schedule)),
        };
        let held = race.directions(scene).into_iter().enumerate().filter_map(held);
        Self::of_race(race.section(scene), Drive::Wrench, held)
    }

    /// A race on a hinge to its frame (paper section 2: the outer race).
    pub(super) fn on_hinge(section: &RaceSection) -> Option<Self> {
        let place = (0..3).map(|axis| Constraint::Position(axis, Schedule::default()));
        let tilt = [&section.misalignment.ry, &section.misalignment.rz];
        let tilts = tilt.into_iter().enumerate().map(|(i, angle)| Constraint::Tilt(i + 1, angle.clone()));
        Self::of_race(section, Drive::Hinge, place.chain(tilts))
    }

    /// A race on a flexible support.
    pub(super) fn on_support(section: &SupportSection) -> Self {
        let inertia = Vector3::from(section.inertia.map(|moment| moment.0));
        Self::new(section.mass.0, inertia, vec![])
    }

    /// A race that turns at a prescribed speed under these constraints, if that is how it is driven.
    fn of_race(
        section: &RaceSection,
        drive: Drive,
        constraints: impl Iterator<Item = Constraint>,
    ) -> Option<Self> {
        let (true, Some(mass), Some(inertia)) = (section.drive == drive, section.mass, section.inertia)
        else {
            return None;
        };
        let inertia = Vector3::from(inertia.map(|moment| moment.0));
        Some(Self::new(mass.0, inertia, constraints.chain([Constraint::Spin]).collect()))
    }
}

/// World direction of the moment that holds the tilt of a body's axis about world y (1) or z (2): tilting about y moves
/// the axis towards -z, about z towards +y.
pub fn tilt_direction<S: Scalar>(about: usize, axis: &Vector3<S>) -> Vector3<S> {
    let (other, sign) = tilt_component(about);
    let toward = Vector3::from_fn(|i, _| S::constant(if i == other { sign } else { 0.0 }));
    axis.cross(&toward)
}

/// Component of a body's axis that shows its tilt about world y (1) or z (2), and its sign.
pub fn tilt_component(about: usize) -> (usize, f64) {
    if about == 1 { (2, -1.0) } else { (1, 1.0) }
}
