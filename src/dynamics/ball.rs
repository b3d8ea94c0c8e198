//! One ball in one trial step: what only some balls have, and the tangent of its residual.

use nalgebra::{Matrix6, Vector3, Vector6};

use super::ball_equations::BallEquations;
use super::body::{BodyTrial, RaceSeen};
use super::cage::CageTrial;
use super::directions::{D, by_first, scale_moments, seed};
use super::group::{BallGroup, Groups};
use super::reaction::{PairTangent, Reaction};
use super::spacing::Apart;
use crate::contact::pair::PairForces;
use crate::contact::{BallMotion, ContactModel, RaceMotion};
use crate::effects::ambient::Ambient;
use crate::kalker::scaled_law::Difference;
use crate::model::Model;
use crate::model::bodies::{Bodies, Body, PerRace, Race};
use crate::model::cage::CageModel;
use crate::model::state::stack;
use crate::numerics::arrowhead::{BLOCK, Block, SLOTS};
use crate::numerics::hht::HhtStep;
use crate::numerics::lanes::Lanes;
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::{Dual, values};

/// Everything that a ball may touch in a trial step.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// The model.
    pub model: &'a Model,
    /// Contact with each race.
    pub contacts: &'a PerRace<ContactModel<'a>>,
    /// Loads from outside: gravity, frame, medium.
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

    /// Contact of a ball with a race.
    fn contact(&self, ball: usize, race: Race) -> ContactModel<'_> {
        self.contacts[race].of_ball(ball, self.differences.get(ball).map(|of_ball| &of_ball[race]))
    }

    /// Evaluates all pairs of a group of balls that have moved, the first of them ball `first`, and what they leave of their equations.
    pub fn evaluate_group(&self, first: usize, trials: &mut [BallTrial], group: &mut BallGroup) {
        for race in Race::BOTH {
            let (contact, seen) = (&self.contacts[race], self.races[race].motion);
            match self.differences.get(first..first + trials.len()) {
                None if contact.surface.tells_balls() => {
                    group.evaluate(race, &contact.of_ball(first, None), seen);
                }
                None => group.evaluate(race, contact, seen),
                Some(differences) => {
                    for (lane, of_ball) in differences.iter().enumerate() {
                        let contact = contact.of_ball(first + lane, Some(&of_ball[race]));
                        group.set(race, lane, &contact.evaluate(&group.motion(lane), seen));
                    }
                }
            }
        }
        if let Some((cage, seen)) = self.cage {
            let near = cage.near_pockets(first, group.motions(), &seen.value, seen.oil);
            for (lane, trial) in trials.iter_mut().enumerate() {
                trial.pocket = match near[lane] {
                    true => cage.pocket_contact(first + lane, &group.motion(lane), &seen.value, seen.oil),
                    false => None,
                };
            }
        }
        let touched = trials.iter().any(|trial| trial.pocket.is_some() || trial.pushed.is_some());
        group.balance(self.ambient, touched.then(|| by_lane(trials)).as_ref());
    }
}

/// Forces of pockets and neighbours on the balls of a group.
fn by_lane(trials: &[BallTrial]) -> [Wrench<Lanes>; 2] {
    let mut of = [Wrench::<Lanes>::default(); 2];
    for (lane, trial) in trials.iter().enumerate() {
        let pocket = trial.pocket.as_ref().map(PairForces::on_first);
        let pushed = trial.pushed.as_ref().map(|push| push.wrench);
        for (lanes, wrench) in of.iter_mut().zip([pocket, pushed]) {
            let Wrench { force, moment } = wrench.unwrap_or_default();
            for i in 0..3 {
                lanes.force[i].0[lane] = force[i];
                lanes.moment[i].0[lane] = moment[i];
            }
        }
    }
    of
}

/// Trial of one ball, beside its lane of a group ([`super::group`]).
#[derive(Clone, Debug)]
pub struct BallTrial {
    /// Contact with the cage's pocket at the end of the step, where they touch.
    pub pocket: Option<PairForces>,
    /// Push of its neighbours at the end of the step, where it touches one.
    pub pushed: Option<Push>,
    /// Tangent, with its couplings to the bodies.
    pub block: Block,
    /// Is its block of the matrix to be computed anew?
    pub renewed: bool,
    /// [-] largest component of its residual over the tolerance, before the last correction in this step; 0 where there was none.
    pub before: f64,
    /// How far it was moved alone before a correction, where it was.
    pub repaired: Option<Vector6<f64>>,
    /// Is it to be brought back alone?
    pub out: bool,
    /// Reactions on the bodies with their derivatives, where those were asked for.
    reactions: [Option<Reaction>; SLOTS],
}

/// Push of the neighbours of a ball in a trial step.
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
    pub fn new() -> Self {
        Self {
            pocket: None,
            pushed: None,
            block: Block::default(),
            renewed: false,
            before: 0.0,
            repaired: None,
            out: false,
            reactions: [None; SLOTS],
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

    /// Tangent of the residual of a ball of the groups, as it was evaluated last, with its couplings to the bodies. Returns how many
    /// contacts with races have been evaluated with derivatives.
    pub fn differentiate(
        &mut self,
        index: usize,
        groups: &Groups,
        around: &Surroundings<'_>,
        step: &HhtStep,
    ) -> u64 {
        let motion = &groups.motion(index);
        let (mut tangent, evaluated) = self.contacts_with_tangent((index, motion), groups, around, step);
        self.uncouple(Body::Cage);
        if let (Some((cage, trial)), Some(_)) = (around.cage, &self.pocket) {
            let radius = around.model.bearing.ball.radius;
            if let Some(pair) = by_ball_and_cage((cage, index), &seed(motion, step, radius), trial) {
                tangent += self.couple(Body::Cage, &pair, step, radius);
            }
        }
        if let Some(push) = &self.pushed {
            tangent += push.tangent;
        }
        self.block.diagonal = around.tangent_of_residual(tangent, motion, step);
        evaluated
    }

    /// Derivatives of the contacts with the races, and how many of these touch.
    fn contacts_with_tangent(
        &mut self,
        (index, motion): (usize, &BallMotion<f64>),
        groups: &Groups,
        around: &Surroundings<'_>,
        step: &HhtStep,
    ) -> (Matrix6<f64>, u64) {
        let radius = around.model.bearing.ball.radius;
        let (mut tangent, mut touching) = (Matrix6::zeros(), 0);
        self.reactions = [None; SLOTS];
        for race in Race::BOTH {
            if groups.pressed(index, race).0 < 0.0 {
                self.uncouple(race.into());
                continue;
            }
            touching += 1;
            let (contact, seen) = (around.contact(index, race), &around.races[race]);
            let obliquely = groups.rolled_obliquely(index, race);
            tangent += match seen.moved() {
                None => by_ball_alone(obliquely, &contact, &seed(motion, step, radius), seen.motion).1,
                Some(moved) => {
                    let pair = by_ball_and_race(obliquely, &contact, &seed(motion, step, radius), &moved);
                    self.couple(race.into(), &pair, step, radius)
                }
            };
        }
        (tangent, touching)
    }

    /// Takes the couplings of a body out that the ball does not touch.
    fn uncouple(&mut self, body: Body) {
        let slot = body.index();
        let Block { right, left, own, .. } = &mut self.block;
        for couplings in [right, left, own] {
            couplings[slot].fill(0.0);
        }
    }

    /// Takes over the reaction of a pair and its derivatives by the body's unknowns; returns those by the ball's.
    fn couple(&mut self, body: Body, pair: &PairTangent, step: &HhtStep, radius: f64) -> Matrix6<f64> {
        self.block.right[body.index()] = scale_moments(pair.by_second, radius) * -(1.0 - step.alpha_f);
        self.reactions[body.index()] = Some(pair.on_second);
        pair.by_first
    }
}

/// A ball by itself, with all bodies where they are.
#[derive(Clone, Copy, Debug)]
pub struct BallAlone {
    /// \[N] residual.
    pub residual: Vector6<f64>,
    /// Its derivatives by the ball's own unknowns.
    pub tangent: Matrix6<f64>,
    /// Races that it touches.
    pub touching: u64,
}

impl BallAlone {
    /// The ball `index` with these unknowns, `apart` where an ideal cage keeps it; `obliquely`: on which races did it roll so when it was evaluated last?
    pub fn new(
        index: usize,
        ((equations, apart), unknowns): ((&BallEquations, Option<&Apart<f64>>), &Vector6<f64>),
        obliquely: &PerRace<bool>,
        around: &Surroundings<'_>,
        step: &HhtStep,
    ) -> Self {
        let Surroundings { model, ambient, races, cage, .. } = around;
        let unknowns: [f64; BLOCK] = (*unknowns).into();
        let mut motion = equations.motion(&unknowns);
        if let Some(apart) = apart {
            apart.move_to(&unknowns, &mut motion);
        }
        let radius = model.bearing.ball.radius;
        let (mut tangent, mut touching) = (Matrix6::zeros(), 0);
        let mut total = ambient.on_ball(&motion);
        for race in Race::BOTH {
            let (contact, seen) = (around.contact(index, race), races[race].motion);
            if contact.is_open(&motion, seen) {
                continue;
            }
            touching += 1;
            let (wrench, by_ball) =
                by_ball_alone(obliquely[race], &contact, &seed(&motion, step, radius), seen);
            total = total.plus(wrench);
            tangent += by_ball;
        }
        if let Some((cage, trial)) = cage
            && let Some(pocket) = cage.pocket_contact(index, &motion, &trial.value, trial.oil)
        {
            total = total.plus(pocket.on_first());
            let seeded: BallMotion<D> = seed(&motion, step, radius);
            if let Some(forces) = cage.pocket_contact(index, &seeded, &trial.value.constant(), trial.oil) {
                tangent += by_first(&forces.force, &forces.moment);
            }
        }
        let mut remainder = equations.remainder(&unknowns, &total);
        let mut residual = equations.residual(&remainder);
        let mut tangent = around.tangent_of_residual(tangent, &motion, step);
        if let Some(apart) = apart {
            apart.balance(&unknowns, &mut total, &mut remainder, &mut residual);
            tangent = apart.tangent_alone(tangent);
        }
        Self { residual: residual.into(), tangent, touching }
    }
}

impl Surroundings<'_> {
    /// Tangent of a ball's residual from that of its pairs.
    fn tangent_of_residual(
        &self,
        mut tangent: Matrix6<f64>,
        motion: &BallMotion<f64>,
        step: &HhtStep,
    ) -> Matrix6<f64> {
        let ball = &self.model.bearing.ball;
        if self.ambient.depends_on_motion() {
            tangent += by_motion(self.ambient, &seed(motion, step, ball.radius));
        }
        let rotational = ball.inertia / (ball.radius * ball.radius);
        let inertia = stack(&Vector3::repeat(ball.mass), &Vector3::repeat(rotational));
        Matrix6::from_diagonal(&inertia) - scale_moments(tangent, ball.radius) * (1.0 - step.alpha_f)
    }
}

/// Derivatives of what acts from outside by the ball's unknowns.
#[cold]
fn by_motion(ambient: &Ambient, ball: &BallMotion<Dual<6>>) -> Matrix6<f64> {
    let Wrench { force, moment } = ambient.on_ball(ball);
    by_first(&force, &moment)
}

/// Derivatives of a contact with a race that forces move, by the unknowns of both. `obliquely`: did it roll so when it was evaluated last?
fn by_ball_and_race(
    obliquely: bool,
    contact: &ContactModel<'_>,
    ball: &BallMotion<D>,
    race: &RaceMotion<D>,
) -> PairTangent {
    PairTangent::of(&contact.differentiated(contact.path(obliquely), ball, race))
}

/// Forces of a contact with a race of given motion on the ball, and their derivatives by the ball's unknowns.
fn by_ball_alone(
    obliquely: bool,
    contact: &ContactModel<'_>,
    ball: &BallMotion<Dual<6>>,
    race: &RaceMotion<f64>,
) -> (Wrench, Matrix6<f64>) {
    let Wrench { force, moment } = contact.on_ball(contact.path(obliquely), ball, race);
    (Wrench { force: values(&force), moment: values(&moment) }, by_first(&force, &moment))
}

/// Derivatives of a contact with the cage, by the unknowns of both; none where they do not touch.
fn by_ball_and_cage(
    (cage, index): (&CageModel, usize),
    ball: &BallMotion<D>,
    trial: &CageTrial,
) -> Option<PairTangent> {
    let pair = cage.pocket_contact(index, ball, &trial.motion, trial.oil)?;
    Some(PairTangent::of(&pair))
}
