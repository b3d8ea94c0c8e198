//! A ball bearing without states: the sum over its balls.

use std::f64::consts::TAU;

use nalgebra::{Matrix6, RowVector6, Vector2, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::ball::{Ball, Couple, Groove, Settled};
use super::rings::{Circle, Crossing, Placed, as_turned, turned};
use super::together::Found;
use crate::contact::ContactModel;
use crate::contact::normal::Damping;
use crate::model::bodies::{PerRace, Race};
use crate::model::{Conditions, Model};
use crate::numerics::lanes::{Lanes, WIDTH};

/// Rounds in which stiffnesses follow contact angles where a bearing is placed anew.
const PLACING_ROUNDS: u32 = 4;

/// A ball of a bearing as it was left: where it is looked for next, and the stiffness of its contacts at their angles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rested {
    /// \[m] its centre in its plane, from the outer groove's.
    pub place: Vector2<f64>,
    /// \[m] the inner groove's centre there.
    pub crossing: Vector2<f64>,
    /// [N/m^1.5] Hertz stiffness of inner and outer contact.
    pub stiffness: [f64; 2],
    /// \[N] loads on the inner and the outer ring.
    pub loads: [f64; 2],
    /// \[N] friction on the ball at both contacts that carries the gyroscopic couple.
    pub friction: [Vector2<f64>; 2],
    /// \[J] elastic energy.
    pub elastic: f64,
    /// \[N] force on the ball that is left.
    pub unbalanced: f64,
}

/// Motion of the inner ring as seen from the outer one, which does not spin in these axes.
#[derive(Clone, Copy, Debug)]
pub struct RingMotion {
    /// Where it is.
    pub placed: Placed,
    /// [m/s, rad/s] velocity of its origin, and angular velocity.
    pub twist: Vector6<f64>,
    /// \[rad, rad/s] turn of the elements since the start, and its rate.
    pub turn: [f64; 2],
}

/// Forces of a bearing on its inner ring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forces {
    /// \[N, N m] force and moment of the elements, about the ring's origin.
    pub wrench: Vector6<f64>,
    /// [N m] moment of the rings on the elements about the axis, which a cage of given speed takes and hands to the rings.
    pub turning: f64,
    /// \[J] elastic energy.
    pub elastic: f64,
    /// \[W] lost to damping.
    pub damped: f64,
}

/// Derivatives of the wrench.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangents {
    /// By displacement and rotation of the inner ring.
    pub by_displacement: Matrix6<f64>,
    /// By its twist.
    pub by_rate: Matrix6<f64>,
    /// By the turn of the elements.
    pub by_turn: Vector6<f64>,
}

/// The balls of a bearing under conditions.
#[derive(Clone, Copy, Debug)]
pub struct Balls {
    count: usize,
    first_azimuth: f64,
    /// [-] cosine and sine of the angle from one to the next.
    spacing: [f64; 2],
    /// Circles of groove centres.
    circles: [Circle; 2],
    ball: Ball,
    /// \[m] radius of a ball.
    radius: f64,
}

impl Balls {
    /// Those of a bearing whose cage turns at a speed [rad/s], its outer ring at another, under these conditions.
    pub fn new(model: &Model, conditions: &Conditions, [cage, outer]: [f64; 2]) -> Self {
        let contacts = model.contacts(conditions);
        let of = |race: Race| {
            let surface = &contacts[race].surface;
            let raceway = surface.raceway;
            let circle = Circle { radius: raceway.groove_circle_radius, offset: raceway.groove_offset };
            (circle, raceway.groove_radius - surface.ball_radius)
        };
        let [inner, outer_race] = Race::BOTH.map(of);
        let bearing = &model.bearing;
        let cosine = bearing.free_contact_angle.cos();
        let orbit = outer_race.0.radius + outer_race.1 * cosine;
        let (mass, inertia) = (bearing.ball.mass, bearing.ball.inertia);
        let radius = contacts.outer.surface.ball_radius;
        let couple = Couple {
            force: inertia * cage * (cage - outer) * orbit / (radius * radius),
            friction: conditions.friction,
        };
        let groove = |arc: f64| Groove { arc, stiffness: 0.0 };
        let (sine, cosine) = (TAU / bearing.n_balls as f64).sin_cos();
        Self {
            count: bearing.n_balls,
            spacing: [cosine, sine],
            first_azimuth: bearing.first_ball_azimuth,
            circles: [inner.0, outer_race.0],
            ball: Ball {
                grooves: [groove(inner.1), groove(outer_race.1)],
                centrifugal: mass * cage * cage * orbit,
                couple: (couple.force != 0.0 && couple.friction > 0.0).then_some(couple),
                damping: model.damping,
            },
            radius,
        }
    }

    /// Leaves the damping of the contacts to another.
    pub fn leave_damping(&mut self) {
        self.ball.damping = Damping::HuntCrossley(0.0);
    }

    /// \[rad] azimuth of a ball (0 is the first) after a turn \[rad].
    pub fn azimuth(&self, index: usize, turn: f64) -> f64 {
        self.first_azimuth + turn + TAU * index as f64 / self.count as f64
    }

    /// A ball with the stiffnesses that it was left with.
    fn ball(&self, rested: &Rested) -> Ball {
        let mut ball = self.ball;
        for (groove, stiffness) in ball.grooves.iter_mut().zip(rested.stiffness) {
            groove.stiffness = stiffness;
        }
        ball
    }

    /// Tells of each ball in balance, from where it was, and of where the inner ring's circle goes through its plane.
    fn settle(
        &self,
        motion: &RingMotion,
        rested: &[Rested],
        mut see: impl FnMut(usize, &Crossing, &Settled),
    ) {
        let (sine, cosine) = self.azimuth(0, motion.turn[0]).sin_cos();
        let mut direction = [cosine, sine];
        let [cosine, sine] = self.spacing;
        let mut next = |_| {
            let [c, s] = direction;
            direction = [c * cosine - s * sine, s * cosine + c * sine];
            [c, s]
        };
        for (group, rested) in rested.chunks(WIDTH).enumerate() {
            let directions: [[f64; 2]; WIDTH] = std::array::from_fn(&mut next);
            let [cosines, sines] = [0, 1].map(|k: usize| Lanes::from_fn(|lane| directions[lane][k]));
            let crossings = Crossing::of_group(cosines, sines, &motion.placed, &self.circles);
            let found = Found::near(&self.ball, rested, &crossings);
            for (lane, (rested, crossing)) in rested.iter().zip(&crossings).enumerate() {
                let alone = || self.ball(rested).settle(&crossing.place, &rested.place, &rested.friction);
                let settled = found.settled(&self.ball, lane).unwrap_or_else(alone);
                see(WIDTH * group + lane, crossing, &settled);
            }
        }
    }

    /// Forces on the inner ring, from where its balls were; `see` is told of each ball.
    pub fn forces(
        &self,
        motion: &RingMotion,
        rested: &[Rested],
        mut see: impl FnMut(usize, &Crossing, &Settled),
    ) -> Forces {
        let mut sum = Forces::default();
        let backwards = as_turned(&motion.placed);
        let seen = motion.twist - backwards * motion.turn[1];
        self.settle(motion, rested, |index, crossing, settled| {
            sum.elastic += settled.elastic;
            if settled.loads[0] > 0.0 {
                let mut force = settled.force;
                if settled.damping > 0.0 {
                    // A contact opens before it pulls.
                    let opening = settled.normal.dot(&(crossing.moved() * seen));
                    let held = (settled.damping * opening).min(settled.loads[0]);
                    force -= settled.normal * held;
                    sum.damped += held * opening;
                }
                sum.wrench += crossing.wrench(&force);
            }
            see(index, crossing, settled);
        });
        sum.turning = -backwards.dot(&sum.wrench);
        sum
    }

    /// Derivatives of the wrench there.
    pub fn tangents(&self, motion: &RingMotion, rested: &[Rested]) -> Tangents {
        let mut by_displacement = Matrix6::zeros();
        let mut by_rate = Matrix6::zeros();
        let elastic = RingMotion { twist: Vector6::zeros(), turn: [motion.turn[0], 0.0], ..*motion };
        let Forces { wrench, .. } = self.forces(&elastic, rested, |index, crossing, settled| {
            if settled.loads[0] > 0.0 {
                let by_place = self.ball(&rested[index]).tangent(settled, &crossing.place);
                by_displacement += crossing.tangent(&settled.force, &by_place);
                let along: RowVector6<f64> = settled.normal.transpose() * crossing.moved();
                by_rate -= along.tr_mul(&along) * settled.damping;
            }
        });
        let by_turn = turned(&wrench) - by_displacement * as_turned(&motion.placed);
        Tangents { by_displacement, by_rate, by_turn }
    }

    /// The balls as they are left at a place of the rings, with the stiffnesses of their contact angles there.
    pub fn rest(
        &self,
        model: &Model,
        conditions: &Conditions,
        motion: &RingMotion,
        rested: &mut [Rested],
    ) -> Forces {
        let before = rested.to_vec();
        let contacts = model.contacts(conditions);
        self.forces(motion, &before, |index, crossing, settled| {
            rested[index] = Rested {
                place: settled.place,
                crossing: crossing.place,
                stiffness: self.stiffness(&contacts, settled, &crossing.place),
                loads: settled.loads,
                friction: settled.friction,
                elastic: settled.elastic,
                unbalanced: settled.unbalanced,
            };
        })
    }

    /// Balls of which nothing is known yet, at a place of the rings.
    pub fn placed(&self, model: &Model, conditions: &Conditions, motion: &RingMotion) -> Vec<Rested> {
        let middle = Vector2::new(0.0, self.ball.grooves[1].arc);
        let stiffness = Race::BOTH.map(|race| {
            let contact = model.contact(race, conditions);
            contact.stiffness_of(contact.shape.stiffness(model.bearing.circumferential_curvature(race)))
        });
        let zero = Vector2::zeros();
        let fresh = Rested {
            place: middle,
            crossing: zero,
            stiffness,
            loads: [0.0; 2],
            friction: [zero; 2],
            elastic: 0.0,
            unbalanced: 0.0,
        };
        let mut rested = vec![fresh; self.count];
        for _ in 0..PLACING_ROUNDS {
            self.rest(model, conditions, motion, &mut rested);
        }
        rested
    }

    /// [N/m^1.5] Hertz stiffnesses at the contact angles of a ball.
    fn stiffness(&self, contacts: &PerRace<ContactModel<'_>>, of: &Settled, c: &Vector2<f64>) -> [f64; 2] {
        let orbit = self.circles[1].radius + of.place.y;
        let cosines = [(of.place - c).normalize().y, of.place.normalize().y];
        [0, 1].map(|k: usize| {
            let contact = &contacts[Race::BOTH[k]];
            let curvature = -cosines[k] / (orbit + self.radius * cosines[k]);
            contact.stiffness_of(contact.shape.stiffness(curvature))
        })
    }

    /// [rad/s] angular velocities of a ball, axial and radial, as it rolls without spin on the inner and on the outer ring, at speeds of cage, inner
    /// and outer ring [rad/s].
    fn rolls(&self, rested: &Rested, [cage, inner, outer]: [f64; 3]) -> [Vector2<f64>; 2] {
        let per_roll = (self.circles[1].radius + rested.place.y) / self.radius;
        let on = |arm: Vector2<f64>, speed: f64| {
            let (normal, roll) = (arm.normalize(), (cage - speed) * per_roll);
            Vector2::new(speed - roll * normal.y, roll * normal.x)
        };
        [on(rested.place - rested.crossing, inner), on(rested.place, outer)]
    }

    /// [-] share of the spin of balls that is on the outer ring, of the angular velocities [rad/s] that they have there, axial and radial: by what each
    /// carries. All of it is on the inner ring where nothing tells.
    pub fn spin_share(
        &self,
        rested: &[Rested],
        angular: impl Iterator<Item = Vector2<f64>>,
        speeds: [f64; 3],
    ) -> f64 {
        let (shared, all) = rested.iter().zip(angular).fold((0.0, 0.0), |(shared, all), (ball, angular)| {
            let [inner, outer] = self.rolls(ball, speeds);
            let between = inner - outer;
            (
                shared + ball.loads[0] * (angular - outer).dot(&between),
                all + ball.loads[0] * between.norm_squared(),
            )
        });
        if all > 0.0 { (shared / all).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// \[m] centre of a ball from the outer ring's origin, in the axes of that, at an azimuth \[rad]; and its angular velocity [rad/s] as it rolls
    /// at speeds of cage, inner and outer ring [rad/s], with a share of its spin on the outer ring.
    pub fn motion(
        &self,
        rested: &Rested,
        radial: &Vector3<f64>,
        speeds: [f64; 3],
        share: f64,
    ) -> [Vector3<f64>; 2] {
        let circle = &self.circles[1];
        let orbit = circle.radius + rested.place.y;
        let position = Vector3::x() * (circle.offset + rested.place.x) + radial * orbit;
        let [inner, outer] = self.rolls(rested, speeds);
        // What the inner ring does not press rolls on the outer one.
        let share = if rested.loads[0] > 0.0 { share } else { 0.0 };
        let angular = outer + (inner - outer) * share;
        [position, Vector3::x() * angular.x + radial * angular.y]
    }

    /// \[J] what keeps balls at the speed of the cage puts in between two places, beside what changes their speed: work of centrifugal forces and
    /// of the gyroscopic couple, by the trapezoidal rule.
    pub fn put_in(&self, before: &[Rested], after: &[Rested]) -> f64 {
        let of = |(before, after): (&Rested, &Rested)| {
            let moved = after.place - before.place;
            let seen = moved - (after.crossing - before.crossing);
            let friction = [0, 1].map(|k: usize| (before.friction[k] + after.friction[k]) * 0.5);
            self.ball.centrifugal * moved.y + friction[0].dot(&seen) + friction[1].dot(&moved)
        };
        before.iter().zip(after).map(of).fold(0.0, |sum, work| sum + work)
    }
}
