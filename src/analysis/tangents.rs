//! Derivatives of the forces of a pair of bodies by the places and the velocities of both, exact as those of steps.

use nalgebra::{Matrix6, Vector3};

use crate::contact::motion::BodyMotion;
use crate::contact::pair::PairForces;
use crate::contact::{BallMotion, ContactModel, RaceMotion};
use crate::numerics::scalar::{Dual, constant_vector};

/// Directions of differentiation: translation (0 to 2) and rotation (3 to 5) of the first body, rotation of the second (6 to 8). Forces
/// depend on the relative translation alone.
const DIRECTIONS: usize = 9;
/// First direction of the rotation of the first and of the second body.
const ROTATIONS: [usize; 2] = [3, 6];
/// A number with its derivatives.
pub(crate) type D = Dual<DIRECTIONS>;

/// Derivatives of force and moment on a body (rows) by translation and rotation, or their rates (columns), of both.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByBoth {
    /// By those of the first body.
    pub first: Matrix6<f64>,
    /// By those of the second body.
    pub second: Matrix6<f64>,
}

/// Derivatives of the forces of a pair, about the origin of each body, world axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tangent {
    /// Derivatives of those on the first body.
    pub on_first: ByBoth,
    /// Derivatives of those on the second body.
    pub on_second: ByBoth,
}

/// Derivatives by places and by velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tangents {
    /// By translations and rotations, with which angular velocities turn.
    pub place: Tangent,
    /// By velocities and angular velocities.
    pub rate: Tangent,
}

/// A vector whose components are variables, from this direction on.
pub(super) fn variable<const N: usize>(v: &Vector3<f64>, first: usize) -> Vector3<Dual<N>> {
    Vector3::from_fn(|i, _| Dual::variable(v[i], first + i, 1.0))
}

/// A vector that turns with a body.
fn turning(v: &Vector3<f64>, first: usize) -> Vector3<D> {
    let mut turned: Vector3<D> = constant_vector(v);
    for k in 0..3 {
        let rate = Vector3::ith(k, 1.0).cross(v);
        turned.iter_mut().zip(&rate).for_each(|(c, rate)| c.derivatives[first + k] = *rate);
    }
    turned
}

/// A ball as a first body, by its place and by its velocities.
pub(crate) fn first_ball(ball: &BallMotion<f64>) -> [BallMotion<D>; 2] {
    let place = BallMotion {
        position: variable(&ball.position, 0),
        velocity: constant_vector(&ball.velocity),
        angular_velocity: constant_vector(&ball.angular_velocity),
    };
    [place, ball_by_rates(ball)]
}

/// The motion of a ball by its velocity and angular velocity.
pub(super) fn ball_by_rates<const N: usize>(ball: &BallMotion<f64>) -> BallMotion<Dual<N>> {
    BallMotion {
        position: constant_vector(&ball.position),
        velocity: variable(&ball.velocity, 0),
        angular_velocity: variable(&ball.angular_velocity, ROTATIONS[0]),
    }
}

/// A ball as a second body.
fn second_ball(ball: &BallMotion<f64>) -> [BallMotion<D>; 2] {
    let place = BallMotion {
        position: constant_vector(&ball.position),
        velocity: constant_vector(&ball.velocity),
        angular_velocity: constant_vector(&ball.angular_velocity),
    };
    [place, BallMotion { angular_velocity: variable(&ball.angular_velocity, ROTATIONS[1]), ..place }]
}

/// A race as a second body.
fn second_race(race: &RaceMotion<f64>) -> [RaceMotion<D>; 2] {
    let still = race.constant();
    let place = RaceMotion {
        axis: turning(&race.axis, ROTATIONS[1]),
        angular_velocity: turning(&race.angular_velocity, ROTATIONS[1]),
        ..still
    };
    [place, RaceMotion { angular_velocity: variable(&race.angular_velocity, ROTATIONS[1]), ..still }]
}

/// A cage as the first (0) or second (1) body.
fn cage(cage: &BodyMotion<f64>, which: usize) -> [BodyMotion<D>; 2] {
    let still: BodyMotion<D> = cage.constant();
    let rotation = ROTATIONS[which];
    let mut place = BodyMotion {
        axes: cage.axes.each_ref().map(|axis| turning(axis, rotation)),
        angular_velocity: turning(&cage.angular_velocity, rotation),
        ..still
    };
    let mut rate = BodyMotion { angular_velocity: variable(&cage.angular_velocity, rotation), ..still };
    if which == 0 {
        place.position = variable(&cage.position, 0);
        rate.velocity = variable(&cage.velocity, 0);
    }
    [place, rate]
}

impl Tangents {
    /// Tangents of a ball and a race.
    pub fn of_ball_and_race(
        contact: &ContactModel<'_>,
        ball: &BallMotion<f64>,
        race: &RaceMotion<f64>,
    ) -> Self {
        let (balls, races) = (first_ball(ball), second_race(race));
        let of = |k: usize| contact.differentiated(contact.path(false), &balls[k], &races[k]);
        Self::of([of(0), of(1)])
    }

    /// Tangents of a ball and the cage, by what evaluates their pocket; none where they do not touch.
    pub fn of_ball_and_cage(
        pocket: impl Fn(&BallMotion<D>, &BodyMotion<D>) -> Option<PairForces<D>>,
        ball: &BallMotion<f64>,
        body: &BodyMotion<f64>,
    ) -> Option<Self> {
        let (balls, cages) = (first_ball(ball), cage(body, 1));
        Some(Self::of([pocket(&balls[0], &cages[0])?, pocket(&balls[1], &cages[1])?]))
    }

    /// Tangents of the cage and a race, by what evaluates their land; none where they do not touch.
    pub fn of_cage_and_race(
        land: impl Fn(&BodyMotion<D>, &RaceMotion<D>) -> Option<PairForces<D>>,
        body: &BodyMotion<f64>,
        race: &RaceMotion<f64>,
    ) -> Option<Self> {
        let (cages, races) = (cage(body, 0), second_race(race));
        Some(Self::of([land(&cages[0], &races[0])?, land(&cages[1], &races[1])?]))
    }

    /// Tangents of two balls, by what evaluates their contact; none where they do not touch.
    pub fn of_balls(
        contact: impl Fn(&BallMotion<D>, &BallMotion<D>) -> Option<PairForces<D>>,
        [first, second]: [&BallMotion<f64>; 2],
    ) -> Option<Self> {
        let (first, second) = (first_ball(first), second_ball(second));
        Some(Self::of([contact(&first[0], &second[0])?, contact(&first[1], &second[1])?]))
    }

    fn of([place, rate]: [PairForces<D>; 2]) -> Self {
        Self { place: Tangent::of(&place), rate: Tangent::of(&rate) }
    }
}

impl Tangent {
    fn of(pair: &PairForces<D>) -> Self {
        let reaction = -pair.force;
        Self {
            on_first: ByBoth::of(&pair.force, &pair.moment),
            on_second: ByBoth::of(&reaction, &pair.other_moment),
        }
    }
}

/// Row i of derivatives of force (0 to 2) and moment (3 to 5).
#[inline(always)]
fn row<const N: usize>([force, moment]: [&Vector3<Dual<N>>; 2], i: usize) -> &[f64; N] {
    if i < 3 { &force[i].derivatives } else { &moment[i - 3].derivatives }
}

/// Derivatives of force and moment by the first body's motion: the first six directions.
#[inline(always)]
pub(crate) fn by_first<const N: usize>(force: &Vector3<Dual<N>>, moment: &Vector3<Dual<N>>) -> Matrix6<f64> {
    Matrix6::from_fn(|i, k| row([force, moment], i)[k])
}

impl ByBoth {
    fn of(force: &Vector3<D>, moment: &Vector3<D>) -> Self {
        let row = |i: usize| row([force, moment], i);
        Self {
            first: by_first(force, moment),
            second: Matrix6::from_fn(|i, k| if k < 3 { -row(i)[k] } else { row(i)[3 + k] }),
        }
    }
}
