//! Contacts of many balls with a race at once: values alone, several balls in the lanes of one vector.

use nalgebra::Vector3;

use super::geometry::GrooveContact;
use super::{BallRaceContact, ContactModel, Path};
use crate::contact::creep::{CreepForces, Creepage, Law};
use crate::contact::motion::{BallMotion, RaceMotion};
use crate::contact::pair::PairForces;
use crate::kalker::scaled_law::Difference;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::scalar::Scalar;

/// Where a ball touches a race.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// \[m] approach; positive in contact.
    pub approach: f64,
    /// \[N] normal load.
    pub load: f64,
    /// [-] unit normal, out of the ball into the raceway.
    pub normal: Vector3<f64>,
    /// [-] unit radial direction of the race through the ball centre.
    pub radial: Vector3<f64>,
}

impl<S: Scalar> BallRaceContact<S> {
    #[inline(always)]
    fn touch_with(&self, of: impl Fn(&S) -> f64) -> Touch {
        let vector = |v: &Vector3<S>| Vector3::new(of(&v.x), of(&v.y), of(&v.z));
        Touch {
            approach: of(&self.geometry.approach),
            load: of(&self.load),
            normal: vector(&self.geometry.normal),
            radial: vector(&self.geometry.radial),
        }
    }

    /// Forces and moments of a contact, number by number.
    ///
    /// By reference: a lane picked from a copy would need the whole copy in memory.
    #[inline(always)]
    fn forces_with<T: Scalar>(&self, of: impl Fn(&S) -> T) -> PairForces<T> {
        let vector = |v: &Vector3<S>| Vector3::new(of(&v.x), of(&v.y), of(&v.z));
        PairForces {
            approach: of(&self.geometry.approach),
            load: of(&self.load),
            stiffness: of(&self.stiffness),
            force: vector(&self.force),
            moment: vector(&self.ball_moment),
            other_moment: vector(&self.race_moment),
            friction_power: of(&self.friction_power),
            damping_power: of(&self.damping_power),
        }
    }
}

impl BallRaceContact<f64> {
    /// Where ball and race touch.
    pub fn touch(&self) -> Touch {
        self.touch_with(|x| *x)
    }
}

impl<S: Scalar> From<&BallRaceContact<S>> for PairForces<S> {
    #[inline(always)]
    fn from(contact: &BallRaceContact<S>) -> Self {
        contact.forces_with(|x| *x)
    }
}

impl BallMotion<Lanes> {
    /// Motions of up to [`WIDTH`] balls, lane by lane; lanes without a ball repeat the last.
    pub fn of_balls(balls: &[BallMotion<f64>]) -> Self {
        let ball = |lane: usize| &balls[lane.min(balls.len() - 1)];
        Self {
            position: Lanes::vector(|lane| ball(lane).position),
            velocity: Lanes::vector(|lane| ball(lane).velocity),
            angular_velocity: Lanes::vector(|lane| ball(lane).angular_velocity),
        }
    }
}

/// Contacts of up to [`WIDTH`] balls with a race, lane by lane.
#[derive(Clone, Debug)]
pub struct ContactGroup {
    contacts: BallRaceContact<Lanes>,
    /// Did one of them roll obliquely when they were evaluated? It most likely does so again.
    obliquely: bool,
}

impl ContactGroup {
    /// A buffer to evaluate into.
    fn empty() -> Self {
        let zero = Lanes::constant(0.0);
        let none = Vector3::from_element(zero);
        let contacts = BallRaceContact {
            geometry: GrooveContact {
                approach: zero,
                normal: none,
                radial: none,
                circumferential: none,
                radius: zero,
                distance: zero,
                circumferential_curvature: zero,
            },
            load: zero,
            stiffness: zero,
            semi_axes: [zero; 2],
            rolling_speed: zero,
            creepage: Creepage { longitudinal: zero, lateral: zero, spin: zero, curvature: None },
            creep: CreepForces { longitudinal: zero, lateral: zero, spin_moment: zero, second_moment: zero },
            rolling_cosine: zero,
            force: none,
            ball_moment: none,
            race_moment: none,
            friction_power: zero,
            damping_power: zero,
        };
        Self { contacts, obliquely: false }
    }

    /// All lanes with one contact.
    pub fn filled(contact: &BallRaceContact<f64>) -> Self {
        Self { contacts: contact.zip_with(contact, |x, _| Lanes::constant(x)), obliquely: false }
    }

    /// Evaluates the contacts of [`WIDTH`] balls, to the same bits as [`ContactModel::evaluate`].
    pub fn evaluate(
        &mut self,
        contact: &ContactModel<'_>,
        race: &RaceMotion<f64>,
        balls: &BallMotion<Lanes>,
    ) {
        let path = contact.path(self.obliquely);
        let evaluate = match (contact.law, path) {
            (Law::Frictionless, Path::Plain) => press_lanes::<false>,
            (Law::Frictionless, Path::General) => press_lanes::<true>,
            (_, Path::Plain) => roll_lanes::<false>,
            (_, Path::General) => roll_lanes::<true>,
        };
        let Some(obliquely) = evaluate(contact, race, balls, &mut self.contacts) else {
            return self.evaluate_one_by_one(contact, race, balls);
        };
        self.obliquely = obliquely;
        if self.obliquely && path == Path::Plain {
            // Seldom: what the plain path would hand over would have to be in memory.
            roll_lanes::<true>(contact, race, balls, &mut self.contacts);
        }
    }

    /// That on processors without vectors of four numbers, for which nothing else is compiled: same bits.
    #[inline(never)]
    pub fn evaluate_one_by_one(
        &mut self,
        contact: &ContactModel<'_>,
        race: &RaceMotion<f64>,
        balls: &BallMotion<Lanes>,
    ) {
        for lane in 0..WIDTH {
            self.set(lane, &contact.evaluate(&balls.map(|number| number.0[lane]), race));
        }
    }

    /// All contacts, lane by lane.
    #[inline(always)]
    pub fn lanes(&self) -> &BallRaceContact<Lanes> {
        &self.contacts
    }

    /// Puts a contact into its lane; that of the first lane goes into all.
    pub fn set(&mut self, lane: usize, contact: &BallRaceContact<f64>) {
        *self = if lane == 0 {
            Self::filled(contact)
        } else {
            Self { contacts: self.contacts.zip_with(contact, |lanes, x| lanes.with(lane, x)), ..*self }
        };
    }

    /// The contact in a lane.
    pub fn contact(&self, lane: usize) -> BallRaceContact<f64> {
        // By a constant for each: one that varies takes a copy of every vector.
        match lane {
            0 => self.contact_in::<0>(),
            1 => self.contact_in::<1>(),
            2 => self.contact_in::<2>(),
            _ => self.contact_in::<3>(),
        }
    }

    #[inline(always)]
    fn contact_in<const LANE: usize>(&self) -> BallRaceContact<f64> {
        self.contacts.zip_with(&self.contacts, |lanes, _| lanes.0[LANE])
    }

    /// Where the ball in a lane touches the race.
    #[inline]
    pub fn touch(&self, lane: usize) -> Touch {
        self.contacts.touch_with(|lanes| lanes.0[lane])
    }

    /// Did one of the contacts roll obliquely when they were evaluated?
    #[inline]
    pub fn rolled_obliquely(&self) -> bool {
        self.obliquely
    }

    /// The forces in a lane.
    #[inline(always)]
    pub fn forces(&self, lane: usize) -> PairForces {
        self.contacts.forces_with(|lanes| lanes.0[lane])
    }
}

impl ContactModel<'_> {
    /// Contacts of all balls of a bearing with a race, [`WIDTH`] at a time; `difference` is that of Kalker's polynomials from the table
    /// of a ball (0 is the first), where they are simulated.
    pub fn evaluate_balls<'d>(
        &self,
        balls: &[BallMotion<f64>],
        race: &RaceMotion<f64>,
        difference: impl Fn(usize) -> Option<&'d Difference>,
    ) -> Vec<BallRaceContact<f64>> {
        let alone = |ball: usize| self.of_ball(ball, difference(ball)).evaluate(&balls[ball], race);
        if (0..balls.len()).any(|ball| difference(ball).is_some()) {
            return (0..balls.len()).map(alone).collect();
        }
        let mut contacts = Vec::with_capacity(balls.len());
        let mut group = ContactGroup::empty();
        for (index, balls) in balls.chunks(WIDTH).enumerate() {
            group.evaluate(&self.of_ball(WIDTH * index, None), race, &BallMotion::of_balls(balls));
            contacts.extend((0..balls.len()).map(|lane| group.contact(lane)));
        }
        contacts
    }
}

/// Contacts with friction, by the plain or the general path; does one of them roll obliquely? Compiled for processors with vectors of four
/// numbers, and for any without the feature of that name; the version is chosen at run time. None where it is not compiled for a processor.
///
/// Arguments and result lie in memory lane by lane, because compilers vectorise from the stores backwards.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn roll_lanes<const GENERAL: bool>(
    contact: &ContactModel<'_>,
    race: &RaceMotion<f64>,
    balls: &BallMotion<Lanes>,
    contacts: &mut BallRaceContact<Lanes>,
) -> Option<bool> {
    #[cfg(feature = "vectors")]
    if multiversion::target::target_cfg_f!(all(target_arch = "x86_64", not(target_feature = "avx2"))) {
        return None;
    }
    let (rolling, oblique) = contact.rolling::<_, GENERAL>(balls, &race.constant());
    *contacts = rolling;
    Some(oblique)
}

/// Contacts without friction, alike.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn press_lanes<const GENERAL: bool>(
    contact: &ContactModel<'_>,
    race: &RaceMotion<f64>,
    balls: &BallMotion<Lanes>,
    contacts: &mut BallRaceContact<Lanes>,
) -> Option<bool> {
    #[cfg(feature = "vectors")]
    if multiversion::target::target_cfg_f!(all(target_arch = "x86_64", not(target_feature = "avx2"))) {
        return None;
    }
    *contacts = contact.pressed::<_, GENERAL>(balls, &race.constant());
    Some(false)
}
