//! One ball in one trial step: motion from its unknown accelerations, pairs, residual and tangent blocks.

use nalgebra::{Matrix6, Vector3, Vector6};

use super::body::{BodyTrial, RaceSeen};
use super::cage::CageTrial;
use super::directions::{D, DIRECTIONS, by_first, by_second, constant_race, scale_moments, seed};
use super::reaction::Reaction;
use crate::contact::many::ContactGroup;
use crate::contact::pair::PairForces;
use crate::contact::{BallMotion, BallRaceContact, ContactModel, RaceMotion};
use crate::effects::ambient::Ambient;
use crate::forces::on_ball;
use crate::kalker::scaled_law::Difference;
use crate::model::Model;
use crate::model::bodies::{Bodies, Body, PerRace, Race};
use crate::model::cage::CageModel;
use crate::model::state::{BallState, stack};
use crate::numerics::arrowhead::{Block, SLOTS};
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::Dual;

/// Everything that a ball may touch in a trial step.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// The model.
    pub model: &'a Model,
    /// Contact with each race.
    pub contacts: &'a PerRace<ContactModel<'a>>,
    /// What acts from outside.
    pub ambient: &'a Ambient,
    /// Differences of Kalker's polynomials from the table, by ball.
    pub differences: &'a [PerRace<Difference>],
    /// Motion of each race.
    pub races: PerRace<RaceSeen<'a>>,
    /// Constants and motion of the cage.
    pub cage: Option<(&'a CageModel, &'a CageTrial)>,
}

impl<'a> Surroundings<'a> {
    /// Those of all balls: contacts with the races and what acts from outside; `bodies` are the motions of the races, the trials of
    /// bodies that forces move, and the cage.
    pub fn new(
        model: &'a Model,
        (contacts, ambient): (&'a PerRace<ContactModel<'a>>, &'a Ambient),
        differences: &'a [PerRace<Difference>],
        (races, moved, cage): (
            &'a PerRace<RaceMotion<f64>>,
            &'a Bodies<Option<BodyTrial>>,
            Option<&'a CageTrial>,
        ),
    ) -> Self {
        let races = PerRace::new(|race| RaceSeen::new(race, races, moved));
        Self { model, contacts, ambient, differences, races, cage: model.cage.as_ref().zip(cage) }
    }

    /// Evaluates the contacts of some balls, the first of them ball `first`, with both races.
    pub fn evaluate_group(
        &self,
        first: usize,
        motions: &[BallMotion<f64>],
        group: &mut PerRace<ContactGroup>,
    ) {
        for race in Race::BOTH {
            let (contact, seen) = (&self.contacts[race], self.races[race].motion);
            match self.differences.get(first..first + motions.len()) {
                None if contact.surface.tells_balls() => {
                    group[race].evaluate(&contact.of_ball(first, None), seen, motions);
                }
                None => group[race].evaluate(contact, seen, motions),
                Some(differences) => {
                    for (lane, (motion, of_ball)) in motions.iter().zip(differences).enumerate() {
                        let contact = contact.of_ball(first + lane, Some(&of_ball[race]));
                        group[race].set(lane, &contact.evaluate(motion, seen));
                    }
                }
            }
        }
    }
}

/// One ball in a trial step.
#[derive(Clone, Debug)]
pub struct BallTrial {
    /// [m/s2] centre acceleration, and [m/s2] angular acceleration times ball radius.
    pub unknowns: Vector6<f64>,
    /// Motion at the end of the step.
    pub motion: BallMotion<f64>,
    /// Contacts with the races at the end of the step.
    pub raceways: PerRace<PairForces>,
    /// All of these contacts where they were evaluated with derivatives; else they are in a lane of a group.
    pub contacts: Option<PerRace<BallRaceContact<f64>>>,
    /// Contact with the cage's pocket at the end of the step, where they touch.
    pub pocket: Option<PairForces>,
    /// What its neighbours do to it at the end of the step, where it touches one.
    pub pushed: Option<Push>,
    /// Total force and moment at the end of the step.
    pub total: Wrench,
    /// What is left of the equations of motion.
    pub remainder: Wrench,
    /// \[N] residual; moments over the ball radius.
    pub residual: Vector6<f64>,
    /// Tangent, with its couplings to the bodies.
    pub block: Block,
    /// Is its block of the matrix to be computed anew?
    pub renewed: bool,
    /// [-] largest component of its residual over the tolerance, before the last correction.
    pub before: f64,
    /// How far it was moved alone before a correction, where it was.
    pub repaired: Option<Vector6<f64>>,
    /// Reactions on the bodies with their derivatives, where those were asked for.
    reactions: [Option<Reaction>; SLOTS],
}

/// What the neighbours of a ball do to it in a trial step.
#[derive(Clone, Copy, Debug)]
pub struct Push {
    /// Force and moment.
    pub wrench: Wrench,
    /// Derivatives of force and moment (rows) by the ball's own unknowns.
    pub tangent: Matrix6<f64>,
}

impl Push {
    /// Nothing yet.
    pub fn none() -> Self {
        Self { wrench: Wrench::default(), tangent: Matrix6::zeros() }
    }
}

impl BallTrial {
    /// Buffers for a ball.
    pub fn new(ball: &BallState) -> Self {
        Self {
            unknowns: Vector6::zeros(),
            motion: ball.motion(),
            raceways: PerRace::new(|_| PairForces::none()),
            contacts: None,
            pocket: None,
            pushed: None,
            total: ball.total,
            remainder: Wrench::default(),
            residual: Vector6::zeros(),
            block: Block::default(),
            renewed: false,
            before: 0.0,
            repaired: None,
            reactions: [None; SLOTS],
        }
    }

    /// Moves the ball to the end of a step.
    pub fn move_to(&mut self, unknowns: Vector6<f64>, radius: f64, step: &HhtStep, start: &BallState) {
        self.unknowns = unknowns;
        let acceleration = Vector3::new(unknowns[0], unknowns[1], unknowns[2]);
        let angular_acceleration = Vector3::new(unknowns[3], unknowns[4], unknowns[5]) / radius;
        self.motion = BallMotion {
            position: start.position + step.displacement(&start.velocity, &start.acceleration, &acceleration),
            velocity: step.velocity(&start.velocity, &start.acceleration, &acceleration),
            angular_velocity: step.velocity(
                &start.angular_velocity,
                &start.angular_acceleration,
                &angular_acceleration,
            ),
        };
    }

    /// The pairs of this ball: the body that it touches, and the forces.
    pub fn pairs(&self) -> impl Iterator<Item = (Body, &PairForces)> {
        Body::ALL.into_iter().filter_map(|body| Some((body, self.pair(body)?)))
    }

    /// The forces between this ball and a body; none where it does not touch the cage.
    pub fn pair(&self, body: Body) -> Option<&PairForces> {
        match body {
            Body::Race(race) => Some(&self.raceways[race]),
            Body::Cage => self.pocket.as_ref(),
        }
    }

    /// Sets the couplings of a body to this ball, where they touch, from the derivatives of its reaction.
    pub fn couple_body(&mut self, body: Body, trial: &BodyTrial, step: &HhtStep, length: f64) {
        let slot = body.index();
        if let Some(reaction) = &self.reactions[slot] {
            self.block.left[slot] = trial.coupling(reaction, step, length);
            self.block.own[slot] = trial.own_coupling(reaction, step, length);
        }
    }

    /// Evaluates contacts, residual and their derivatives.
    pub fn evaluate_with_tangent(
        &mut self,
        index: usize,
        around: &Surroundings<'_>,
        step: &HhtStep,
        start: &BallState,
    ) {
        let mut tangent = self.contacts_with_tangent(index, around, step);
        self.evaluate_pocket(index, around, step, Some(&mut tangent));
        self.assemble(around.model, around.ambient, step, start, Some(&mut tangent));
    }

    /// Evaluates contacts, residual and their derivatives by the ball's own unknowns alone.
    pub fn evaluate_alone(
        &mut self,
        index: usize,
        around: &Surroundings<'_>,
        step: &HhtStep,
        start: &BallState,
    ) {
        let Surroundings { model, contacts, ambient, differences, races, cage } = around;
        let seeded = seed(&self.motion, step, model.bearing.ball.radius);
        let mut tangent = Matrix6::zeros();
        let values = PerRace::new(|race| {
            let contact = contacts[race].of_ball(index, differences.get(index).map(|of_ball| &of_ball[race]));
            let (value, by_ball) = by_ball_alone(&contact, &seeded, races[race].motion);
            tangent += by_ball;
            value
        });
        self.raceways = PerRace::new(|race| PairForces::from(&values[race]));
        self.contacts = Some(values);
        self.reactions = [None; SLOTS];
        if let Some((cage, trial)) = cage {
            self.pocket = cage.pocket_contact(index, &self.motion, &trial.value, trial.oil);
            if self.pocket.is_some()
                && let Some(forces) = cage.pocket_contact(index, &seeded, &trial.value.constant(), trial.oil)
            {
                tangent += by_first(&forces.force, &forces.moment);
            }
        }
        self.assemble(model, ambient, step, start, Some(&mut tangent));
    }

    /// Evaluates the contacts with the races and returns their derivatives.
    fn contacts_with_tangent(
        &mut self,
        index: usize,
        around: &Surroundings<'_>,
        step: &HhtStep,
    ) -> Matrix6<f64> {
        let Surroundings { model, contacts, differences, races, .. } = around;
        let radius = model.bearing.ball.radius;
        let mut tangent = Matrix6::zeros();
        self.reactions = [None; SLOTS];
        let values = PerRace::new(|race| {
            let contact = contacts[race].of_ball(index, differences.get(index).map(|of_ball| &of_ball[race]));
            match races[race].moved() {
                None => {
                    let seeded = seed(&self.motion, step, radius);
                    let (value, by_ball) = by_ball_alone(&contact, &seeded, races[race].motion);
                    tangent += by_ball;
                    value
                }
                Some(motion) => {
                    let seeded = seed(&self.motion, step, radius);
                    let contact = by_ball_and_race(&contact, &seeded, motion);
                    let forces = PairForces::from(&contact);
                    tangent += self.couple(race.into(), &forces, step, radius);
                    contact.values()
                }
            }
        });
        self.raceways = PerRace::new(|race| PairForces::from(&values[race]));
        self.contacts = Some(values);
        tangent
    }

    /// Takes over contacts with the races that were evaluated without derivatives, from a lane of a group.
    pub fn take_contacts(&mut self, group: &PerRace<ContactGroup>, lane: usize) {
        for race in Race::BOTH {
            self.raceways[race] = group[race].forces(lane);
        }
        self.contacts = None;
        self.reactions = [None; SLOTS];
    }

    /// Evaluates the contact with the cage, and adds its derivatives to a tangent if there is one.
    pub fn evaluate_pocket(
        &mut self,
        index: usize,
        around: &Surroundings<'_>,
        step: &HhtStep,
        tangent: Option<&mut Matrix6<f64>>,
    ) {
        let Some((cage, trial)) = around.cage else {
            return;
        };
        self.pocket = cage.pocket_contact(index, &self.motion, &trial.value, trial.oil);
        let Some(tangent) = tangent else {
            return;
        };
        let slot = Body::Cage.index();
        self.block.right[slot].fill(0.0);
        self.block.left[slot].fill(0.0);
        self.block.own[slot].fill(0.0);
        if self.pocket.is_some() {
            let radius = around.model.bearing.ball.radius;
            let seeded = seed::<DIRECTIONS>(&self.motion, step, radius);
            if let Some(forces) = cage.pocket_contact(index, &seeded, &trial.motion, trial.oil) {
                *tangent += self.couple(Body::Cage, &forces, step, radius);
            }
        }
    }

    /// Takes over the reaction of a pair and its derivatives by the body's unknowns; returns those by the ball's.
    fn couple(&mut self, body: Body, forces: &PairForces<D>, step: &HhtStep, radius: f64) -> Matrix6<f64> {
        let by_body = scale_moments(by_second(&forces.force, &forces.moment), radius);
        self.block.right[body.index()] = by_body * -(1.0 - step.alpha_f);
        self.reactions[body.index()] = Some(Reaction::on_second(forces));
        by_first(&forces.force, &forces.moment)
    }

    /// Residual of the ball whose pairs are evaluated, and its tangent if their derivatives are given.
    pub fn assemble(
        &mut self,
        model: &Model,
        ambient: &Ambient,
        step: &HhtStep,
        start: &BallState,
        mut tangent: Option<&mut Matrix6<f64>>,
    ) {
        let ball = &model.bearing.ball;
        let fraction = 1.0 - step.alpha_f;
        let outside = ambient.on_ball(&self.motion);
        self.total = on_ball(self.pairs().map(|(_, pair)| pair.on_first()), outside);
        if let (Some(tangent), true) = (&mut tangent, ambient.depends_on_motion()) {
            **tangent += by_motion(ambient, &seed(&self.motion, step, ball.radius));
        }
        if let Some(push) = &self.pushed {
            self.total = self.total.plus(push.wrench);
            tangent.iter_mut().for_each(|tangent| **tangent += push.tangent);
        }
        let blended = start.total.blend(&self.total, fraction);
        let acceleration = Vector3::new(self.unknowns[0], self.unknowns[1], self.unknowns[2]);
        let angular_acceleration =
            Vector3::new(self.unknowns[3], self.unknowns[4], self.unknowns[5]) / ball.radius;
        // What the last step left is made good here, as of the bodies.
        self.remainder = Wrench {
            force: acceleration * ball.mass - blended.force + start.remainder.force,
            moment: angular_acceleration * ball.inertia - blended.moment + start.remainder.moment,
        };
        self.residual = stack(&self.remainder.force, &(self.remainder.moment / ball.radius));
        if let Some(tangent) = tangent {
            let rotational = ball.inertia / (ball.radius * ball.radius);
            let inertia = stack(&Vector3::repeat(ball.mass), &Vector3::repeat(rotational));
            self.block.diagonal =
                Matrix6::from_diagonal(&inertia) - scale_moments(*tangent, ball.radius) * fraction;
        }
    }
}

/// Derivatives of what acts from outside by the ball's unknowns.
#[cold]
fn by_motion(ambient: &Ambient, ball: &BallMotion<Dual<6>>) -> Matrix6<f64> {
    let Wrench { force, moment } = ambient.on_ball(ball);
    by_first(&force, &moment)
}

/// A contact with a race of given motion, and derivatives of force and moment on the ball by the ball's unknowns.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn by_ball_alone(
    contact: &ContactModel<'_>,
    ball: &BallMotion<Dual<6>>,
    race: &RaceMotion<f64>,
) -> (BallRaceContact<f64>, Matrix6<f64>) {
    let contact = contact.evaluate(ball, &constant_race(race));
    (contact.values(), by_first(&contact.force, &contact.ball_moment))
}

/// A contact with a race that forces move, with derivatives by the unknowns of both.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn by_ball_and_race(
    contact: &ContactModel<'_>,
    ball: &BallMotion<D>,
    race: &RaceMotion<D>,
) -> BallRaceContact<D> {
    contact.evaluate(ball, race)
}
