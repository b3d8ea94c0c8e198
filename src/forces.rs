//! Forces of all pairs of bodies that touch, and their sums.

use crate::contact::pair::PairForces;
use crate::contact::{BallMotion, BallRaceContact};
use crate::effects::reports::SupportState;
use crate::model::bearing::{Ball, neighbours};
use crate::model::bodies::{Body, PerRace, Race, RigidBody};
use crate::model::state::{BallState, BodyState, State};
use crate::model::{Conditions, Model};
use crate::numerics::motion::Wrench;

/// The contacts of one ball.
#[derive(Clone, Copy, Debug)]
pub struct BallContacts {
    /// Contacts with the races.
    pub raceways: PerRace<BallRaceContact<f64>>,
    /// Contact with its pocket of the cage, where they touch.
    pub pocket: Option<PairForces>,
}

/// Two neighbouring balls that touch.
#[derive(Clone, Copy, Debug)]
pub struct BallPair {
    /// The first (0 is the first ball).
    pub first: usize,
    /// The next one around the bearing.
    pub second: usize,
    /// Forces between them.
    pub forces: PairForces,
}

impl BallPair {
    /// Force and moment on a ball, if it is one of the two.
    pub fn on(&self, ball: usize) -> Option<Wrench> {
        let PairForces { force, moment, other_moment, .. } = self.forces;
        if ball == self.first {
            Some(Wrench { force, moment })
        } else {
            (ball == self.second).then(|| Wrench { force: -force, moment: other_moment })
        }
    }
}

/// All contacts of a bearing in a state.
#[derive(Clone, Debug)]
pub struct Contacts {
    /// Contacts of every ball.
    pub balls: Vec<BallContacts>,
    /// Neighbouring balls that touch.
    pub ball_pairs: Vec<BallPair>,
    /// Contacts of the cage with the lands at its -x and +x side, where they touch.
    pub lands: [Option<PairForces>; 2],
    /// The race that these lands are on, where there are some.
    guide: Option<Race>,
}

impl Contacts {
    /// Contacts that were evaluated elsewhere.
    pub fn from_parts(
        model: &Model,
        balls: Vec<BallContacts>,
        ball_pairs: Vec<BallPair>,
        lands: [Option<PairForces>; 2],
    ) -> Self {
        Self { balls, ball_pairs, lands, guide: model.cage_guide() }
    }

    /// Evaluates the contacts of a state.
    pub fn new(model: &Model, state: &State, conditions: &Conditions) -> Self {
        let contacts = model.contacts_oriented(conditions, state.orientations.as_ref());
        let races = PerRace::new(|race| state.race(race).motion());
        let cage = model.cage.as_ref().zip(state.cage().map(BodyState::body_motion));
        let oil = model.oil_around_cage(conditions);
        let balls: Vec<_> = state.balls.iter().map(BallState::motion).collect();
        let raceways = PerRace::new(|race| {
            contacts[race].evaluate_balls(&balls, &races[race], |ball| state.difference(ball, race))
        });
        let of_ball = |(index, motion): (usize, &BallMotion<f64>)| BallContacts {
            raceways: PerRace::new(|race| raceways[race][index]),
            pocket: cage.as_ref().and_then(|(cage, seen)| cage.pocket_contact(index, motion, seen, oil)),
        };
        let lands =
            cage.as_ref().map_or([None; 2], |(cage, seen)| cage.land_contacts(seen, |race| races[race], oil));
        let balls = balls.iter().enumerate().map(of_ball).collect();
        Self::from_parts(model, balls, touching_balls(model, state), lands)
    }

    /// Force and moment of all its pairs on a ball, on top of `start`.
    pub fn on_ball(&self, ball: usize, start: Wrench) -> Wrench {
        let mut sum = start;
        self.of_ball(ball, |_, pair| sum = sum.plus(pair.on_first()));
        self.neighbours_on(ball).fold(sum, Wrench::plus)
    }

    /// Force and moment on a ball of each neighbour that it touches.
    pub fn neighbours_on(&self, ball: usize) -> impl Iterator<Item = Wrench> {
        self.ball_pairs.iter().filter_map(move |pair| pair.on(ball))
    }

    /// Forces between all balls and races.
    pub fn raceway_pairs(&self) -> impl Iterator<Item = PairForces> {
        self.balls.iter().flat_map(|ball| ball.raceways.iter().map(PairForces::from))
    }
}

/// Neighbouring balls that touch in a state.
fn touching_balls(model: &Model, state: &State) -> Vec<BallPair> {
    let Some(contact) = &model.ball_contact else {
        return vec![];
    };
    let touching = |(first, second): (usize, usize)| {
        let motions = [first, second].map(|ball| state.balls[ball].motion());
        let forces = contact.evaluate(&motions[0], &motions[1], model.damping)?;
        Some(BallPair { first, second, forces })
    };
    neighbours(state.balls.len()).filter_map(touching).collect()
}

/// Pairs of bodies that touch, in one order for all sums: by ball, between balls, then between bodies.
pub trait Pairs {
    /// Shows the pairs of a ball, each with the body that it touches. No iterator: its items would have to be in memory, and sums over
    /// all balls need few of their numbers.
    fn of_ball(&self, ball: usize, see: impl FnMut(Body, &PairForces));

    /// Pairs of two balls.
    fn between_balls(&self) -> impl Iterator<Item = BallPair>;

    /// Pairs of two bodies.
    fn between_bodies(&self) -> impl Iterator<Item = (Body, Body, PairForces)>;
}

impl Pairs for Contacts {
    #[inline(always)]
    fn of_ball(&self, ball: usize, mut see: impl FnMut(Body, &PairForces)) {
        let BallContacts { raceways, pocket } = &self.balls[ball];
        for race in Race::BOTH {
            see(race.into(), &PairForces::from(&raceways[race]));
        }
        if let Some(pair) = pocket {
            see(Body::Cage, pair);
        }
    }

    fn between_balls(&self) -> impl Iterator<Item = BallPair> {
        self.ball_pairs.iter().copied()
    }

    fn between_bodies(&self) -> impl Iterator<Item = (Body, Body, PairForces)> {
        between_cage_and_lands(self.guide, &self.lands)
    }
}

/// The pairs of the cage and the lands of its guide.
pub fn between_cage_and_lands(
    guide: Option<Race>,
    lands: &[Option<PairForces>; 2],
) -> impl Iterator<Item = (Body, Body, PairForces)> {
    let pairs = lands.iter().flatten();
    guide.into_iter().flat_map(move |race| pairs.clone().map(move |pair| (Body::Cage, race.into(), *pair)))
}

/// \[J] elastic energy of all pairs of a bearing with `n_balls` balls.
pub fn elastic_energy(model: &Model, pairs: &impl Pairs, n_balls: usize) -> f64 {
    let of_body = |body: Body, pair: &PairForces| match body {
        Body::Race(_) => pair.elastic_energy(),
        Body::Cage => model.cage.as_ref().map_or(0.0, |cage| cage.pocket.elastic_energy(pair.approach)),
    };
    let mut energy = 0.0;
    for ball in 0..n_balls {
        pairs.of_ball(ball, |body, pair| energy += of_body(body, pair));
    }
    pairs.between_balls().for_each(|pair| energy += pair.forces.elastic_energy());
    if let Some((_, land)) = model.cage.as_ref().and_then(|cage| cage.land.as_ref()) {
        pairs.between_bodies().for_each(|(_, _, pair)| energy += land.elastic_energy(pair.approach));
    }
    energy
}

/// \[J] kinetic energy of a ball.
pub fn kinetic_energy_of(ball: &Ball, motion: &BallMotion<f64>) -> f64 {
    0.5 * ball.mass * motion.velocity.norm_squared()
        + 0.5 * ball.inertia * motion.angular_velocity.norm_squared()
}

/// \[J] kinetic energy of balls and of the bodies that forces move.
pub fn kinetic_energy<'a>(
    model: &Model,
    balls: impl Iterator<Item = BallMotion<f64>>,
    bodies: impl Iterator<Item = (&'a RigidBody, &'a BodyState)>,
) -> f64 {
    let of_ball = |motion: BallMotion<f64>| kinetic_energy_of(&model.bearing.ball, &motion);
    let of_body = |(body, state): (&RigidBody, &BodyState)| {
        let own = 0.5 * body.mass * state.velocity.norm_squared()
            + 0.5 * state.rate.component_mul(&body.inertia).dot(&state.rate);
        match &body.unbalance {
            Some(unbalance) => {
                own + state.velocity.dot(&(state.pose.orientation * state.rate.cross(unbalance)))
            }
            None => own,
        }
    };
    balls.map(of_ball).chain(bodies.map(of_body)).fold(0.0, |sum, energy| sum + energy)
}

/// \[J] kinetic and elastic energy of a state with these contacts, that of supports included.
pub fn stored_energy(model: &Model, state: &State, contacts: &Contacts) -> f64 {
    let bodies = model.bodies.iter().zip(state.bodies.iter());
    let moved = bodies.filter_map(|((_, body), (_, state))| Some((body.as_ref()?, state)));
    kinetic_energy(model, state.balls.iter().map(BallState::motion), moved)
        + elastic_energy(model, contacts, state.balls.len())
        + supports_energy(&state.supports)
}

/// \[J] energy stored in the flexible supports of the races.
pub fn supports_energy(supports: &PerRace<Option<SupportState>>) -> f64 {
    supports.iter().flatten().fold(0.0, |sum, support| sum + support.energy)
}

/// Sums over all pairs of a bearing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Totals {
    bodies: [Wrench; 3],
    /// \[W] power lost to friction.
    pub friction_power: f64,
    /// \[W] power lost to contact damping.
    pub damping_power: f64,
}

impl Totals {
    /// Sums over the pairs of `n_balls` balls and those between bodies.
    pub fn of(pairs: &impl Pairs, n_balls: usize) -> Self {
        let mut totals = Self::default();
        for ball in 0..n_balls {
            pairs.of_ball(ball, |body, pair| totals.add_to_second(body, pair));
        }
        for BallPair { forces, .. } in pairs.between_balls() {
            totals.friction_power += forces.friction_power;
            totals.damping_power += forces.damping_power;
        }
        for (first, second, pair) in pairs.between_bodies() {
            let wrench = &mut totals.bodies[first.index()];
            wrench.force += pair.force;
            wrench.moment += pair.moment;
            totals.add_to_second(second, &pair);
        }
        totals
    }

    #[inline(always)]
    fn add_to_second(&mut self, body: Body, pair: &PairForces) {
        let wrench = &mut self.bodies[body.index()];
        wrench.force -= pair.force;
        wrench.moment += pair.other_moment;
        self.friction_power += pair.friction_power;
        self.damping_power += pair.damping_power;
    }

    /// Adds what no pair does to a body.
    pub fn add(&mut self, body: Body, wrench: Wrench) {
        let sum = &mut self.bodies[body.index()];
        *sum = sum.plus(wrench);
    }

    /// Force and moment of all its pairs on a body, about its origin, world axes.
    pub fn on(&self, body: Body) -> Wrench {
        self.bodies[body.index()]
    }
}
