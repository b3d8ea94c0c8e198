//! Velocities of a ball at which friction is in balance: the start of a bearing that has run for long.
//!
//! For a ball that stays where it is, the velocity along the orbit and the angular velocity `u` are sought at which
//! friction along the orbit vanishes and the moments of both contacts, spin moments among them, give the gyroscopic
//! moment. Balls under different loads would each go at a speed of their own: all then take the mean of these, weighted by
//! their loads, and a second search at that speed is for the moments alone. From the velocities of rolling, where one contact carries all spin, `(M/tau - g_u) du = g` goes with growing
//! `tau` from implicit steps in time, which friction keeps stable, to Newton's method.

use nalgebra::{Matrix4, Matrix6, Vector3, Vector4};

use crate::analysis::condensed::{Orbit, ball_by_rate};
use crate::contact::creep::Law;
use crate::contact::{BallMotion, ContactModel, RaceMotion};
use crate::effects::ambient::Ambient;
use crate::model::Model;
use crate::model::bodies::{PerRace, Race};
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::{Dual, constant_vector};
use crate::numerics::size::largest;

/// \[s] first step in time: rolling takes microseconds.
const FIRST_STEP: f64 = 1e-6;
/// [-] residual that is left over the friction that the contacts can carry.
const TOLERANCE: f64 = 1e-12;
/// [-] creepage beyond which a contact does not roll: friction too small for the gyroscopic moment has a balance, too, in which
/// balls slide or turn some other way, and a bearing does not start there.
const ROLLING: f64 = 0.02;
/// [-] growth of the step in time from one iteration to the next: at least so that it comes from microseconds to seconds in some 30
/// of them, at most so that two take it to where a step is Newton's.
const LEAST_GROWTH: f64 = 1.5;
const LARGEST_GROWTH: f64 = 100.0;
/// Iterations; balls of the thrust case with a radial load take 20 to 60.
const MAX_ITERATIONS: u32 = 3000;

/// The bearing whose balls are looked at.
pub struct Surroundings<'a> {
    /// The model.
    pub model: &'a Model,
    /// Contact with each race.
    pub contacts: PerRace<ContactModel<'a>>,
    /// Motion of each race.
    pub races: PerRace<RaceMotion<f64>>,
    /// Loads from outside: drag, and the moment of a frame that turns.
    pub ambient: Ambient,
}

/// Motions in balance of balls, from motions of the same places that roll. All keep theirs where one of those that are held by
/// both races has no balance near rolling: its gyroscopic moment is too large for friction.
pub fn balance(around: &Surroundings<'_>, balls: &mut [BallMotion<f64>]) {
    // Without friction nothing decides how a ball turns.
    if matches!(around.contacts.inner.law, Law::Frictionless) {
        return;
    }
    let load = |ball: usize, motion: &BallMotion<f64>, race: Race| {
        around.contacts[race].of_ball(ball, None).evaluate(motion, &around.races[race]).load
    };
    let is_held = |ball: usize| Race::BOTH.into_iter().all(|race| load(ball, &balls[ball], race) > 0.0);
    let held: Vec<usize> = (0..balls.len()).filter(|&ball| is_held(ball)).collect();
    let along =
        |motion: &BallMotion<f64>| motion.velocity.dot(&Orbit::new(motion, &around.races.outer).tangential);
    // Loads, and loads times own orbital speeds over those of rolling.
    let mut sums = [0.0; 2];
    let mut found = Vec::with_capacity(held.len());
    for &index in &held {
        let ball = &balls[index];
        let Some(own) = balanced(around, index, ball, Orbital::Own) else {
            return;
        };
        let weight = load(index, ball, Race::Inner) * along(ball).abs();
        sums = [sums[0] + weight, sums[1] + weight * along(&own) / along(ball)];
        found.push(own.angular_velocity);
    }
    // A bearing at rest has no speed to change.
    let faster = if sums[0] > 0.0 { sums[1] / sums[0] } else { 1.0 };
    if (faster - 1.0).abs() > ROLLING || faster.is_nan() {
        return;
    }
    let at_common_speed = |(&ball, known): (&usize, &Vector3<f64>)| {
        let common = BallMotion { velocity: balls[ball].velocity * faster, ..balls[ball] };
        Some((ball, balanced(around, ball, &common, Orbital::Given { known })?))
    };
    if let Some(found) = held.iter().zip(&found).map(at_common_speed).collect::<Option<Vec<_>>>() {
        for (ball, motion) in found {
            balls[ball] = motion;
        }
    }
}

/// The orbital speed of a ball in balance.
#[derive(Clone, Copy)]
enum Orbital<'a> {
    /// That at which friction along the orbit vanishes.
    Own,
    /// That of the start. An angular velocity \[rad/s] that is known from another search is taken where it is in balance. Nothing else
    /// begins there: with little friction there is more than one balance, and the one that rolling leads to is wanted.
    Given { known: &'a Vector3<f64> },
}

/// The motion of a ball (0 is the first) in balance, near one that rolls; none where no balance is found.
fn balanced(
    around: &Surroundings<'_>,
    ball: usize,
    start: &BallMotion<f64>,
    orbital: Orbital<'_>,
) -> Option<BallMotion<f64>> {
    let own_orbit = matches!(orbital, Orbital::Own);
    let Surroundings { model, races, ambient, .. } = around;
    let contacts = &PerRace::new(|race| around.contacts[race].of_ball(ball, None));
    let (mass, radius) = (model.bearing.ball.mass, model.bearing.ball.radius);
    let inertia = model.bearing.ball.inertia / (radius * radius);
    let orbit = |motion: &BallMotion<f64>| Orbit::new(motion, &races.outer);
    let tangential = orbit(start).tangential;
    // Force along the orbit, and moments over the radius beyond the gyroscopic moment.
    let residual = |motion: &BallMotion<f64>| -> (Vector4<f64>, f64) {
        let [inner, outer] = Race::BOTH.map(|race| contacts[race].evaluate(motion, &races[race]));
        let mut moment =
            inner.ball_moment + outer.ball_moment + orbit(motion).gyroscopic_moment(model, motion);
        let mut force = if own_orbit { (inner.force + outer.force).dot(&tangential) } else { 0.0 };
        if ambient.depends_on_motion() {
            let outside = ambient.against_rolling(motion);
            moment += outside.moment;
            force += if own_orbit { outside.force.dot(&tangential) } else { 0.0 };
        }
        let moment = moment / radius;
        let limit = inner.load.min(outer.load) * contacts.inner.friction;
        (Vector4::new(force, moment.x, moment.y, moment.z), limit)
    };
    // With no end to its speed a ball has no creepage either: such a balance is none.
    let fastest = start.angular_velocity.norm();
    let is_near =
        |motion: &BallMotion<f64>| (motion.angular_velocity - start.angular_velocity).norm() <= fastest;
    let in_balance = |(here, limit): &(Vector4<f64>, f64)| largest(here) <= TOLERANCE * limit;
    let known = match orbital {
        Orbital::Own => None,
        Orbital::Given { known } => Some(BallMotion { angular_velocity: *known, ..*start }),
    };
    let known = known.map(|motion| (motion, residual(&motion))).filter(|(_, found)| in_balance(found));
    let (mut motion, (mut here, limit)) = known.unwrap_or_else(|| (*start, residual(start)));
    if limit <= 0.0 {
        return None;
    }
    let mut step = FIRST_STEP;
    let mut by_rate_here = None;
    for _ in 0..MAX_ITERATIONS {
        if in_balance(&(here, limit)) {
            return rolls(contacts, races, &motion).then_some(motion);
        }
        // A trial that was refused leaves the motion as it was.
        let by_rate = *by_rate_here.get_or_insert_with(|| {
            let contact = |race: Race| ball_by_rate(&contacts[race], &motion, &races[race]);
            let by_rate: Matrix6<f64> = contact(Race::Inner) + contact(Race::Outer);
            match ambient.depends_on_motion() {
                true => by_rate + outside_by_rate(ambient, &motion),
                false => by_rate,
            }
        });
        let by_orbit = orbit(&motion).inertia_by_rate(model, &motion);
        // First row and column along the orbit, the others of moments over the radius and velocities of the surface.
        let velocities = by_rate.fixed_columns::<3>(0) * tangential + by_orbit.column(2);
        let matrix = Matrix4::from_fn(|i, k| {
            let column = |row: usize| {
                if k == 0 {
                    velocities[row]
                } else {
                    (by_rate[(row, 2 + k)] + by_orbit[(row, 2 + k)]) / radius
                }
            };
            if i == 0 && !own_orbit {
                if k == 0 { 1.0 } else { 0.0 }
            } else if i == 0 {
                let along: f64 = (0..3).map(|row| tangential[row] * column(row)).sum();
                (if k == 0 { mass / step } else { 0.0 }) - along
            } else {
                (if k == i { inertia / step } else { 0.0 }) - column(2 + i) / radius
            }
        });
        let change = matrix.lu().solve(&here)?;
        let trial = BallMotion {
            velocity: motion.velocity + tangential * change[0],
            angular_velocity: motion.angular_velocity + change.fixed_rows::<3>(1) / radius,
            ..motion
        };
        let (there, _) = residual(&trial);
        if is_near(&trial) && there.norm() < 1.2 * here.norm() {
            // Steps grow as the residual falls: near the balance this is Newton's method.
            step *= (here.norm() / there.norm()).clamp(LEAST_GROWTH, LARGEST_GROWTH);
            (motion, here, by_rate_here) = (trial, there, None);
        } else {
            step *= 0.3;
        }
    }
    None
}

/// Derivatives of what acts from outside on the rolling of a ball by its velocity and angular velocity.
fn outside_by_rate(ambient: &Ambient, motion: &BallMotion<f64>) -> Matrix6<f64> {
    let variable =
        |v: &Vector3<f64>, first: usize| Vector3::from_fn(|i, _| Dual::<6>::variable(v[i], first + i, 1.0));
    let Wrench { force, moment } = ambient.against_rolling(&BallMotion {
        position: constant_vector(&motion.position),
        velocity: variable(&motion.velocity, 0),
        angular_velocity: variable(&motion.angular_velocity, 3),
    });
    Matrix6::from_fn(|i, k| if i < 3 { force[i].derivatives[k] } else { moment[i - 3].derivatives[k] })
}

/// Does a ball roll on both races?
fn rolls(
    contacts: &PerRace<ContactModel<'_>>,
    races: &PerRace<RaceMotion<f64>>,
    motion: &BallMotion<f64>,
) -> bool {
    Race::BOTH.into_iter().all(|race| {
        let creepage = contacts[race].evaluate(motion, &races[race]).creepage;
        creepage.longitudinal.hypot(creepage.lateral) <= ROLLING
    })
}
