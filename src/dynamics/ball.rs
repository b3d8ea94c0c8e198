//! One ball in one trial step: motion from its unknown accelerations, contacts, residual and tangent blocks.

use nalgebra::{Matrix6, Vector3, Vector6};

use super::cage::CageTrial;
use super::race::RaceTrial;
use super::reaction::RaceReaction;
use crate::contact::body::BodyContact;
use crate::contact::many::ContactEffect;
use crate::contact::{BallMotion, BallRaceContact, ContactModel, RaceMotion};
use crate::dynamics::arrowhead::BallBlock;
use crate::dynamics::state::{BallState, stack};
use crate::kalker::scaled_law::Difference;
use crate::model::cage::CageModel;
use crate::model::{CAGE, Model};
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::{Dual, Scalar, constant_vector};

/// Directions of differentiation: translation (0 to 2) and rotation (3 to 5) of the ball, rotation of a race body
/// (6 to 8). A contact depends on the relative translation alone, so that of the race is minus that of the ball: nine
/// directions do the work of twelve.
pub const DIRECTIONS: usize = 9;

/// A race as the balls see it in a trial step.
#[derive(Clone, Copy, Debug)]
pub struct RaceSeen<'a> {
    /// Its motion.
    pub motion: &'a RaceMotion<f64>,
    /// The same with derivatives by the rotation, where the race is a body.
    pub of_body: Option<&'a RaceMotion<Dual<DIRECTIONS>>>,
}

impl<'a> RaceSeen<'a> {
    /// Race by index, of motions and of those that are bodies.
    pub fn new(race: usize, motions: &'a [RaceMotion<f64>; 2], bodies: &'a [Option<RaceTrial>; 2]) -> Self {
        Self { motion: &motions[race], of_body: bodies[race].as_ref().map(|trial| &trial.motion) }
    }

    /// Motion with derivatives by the rotation, all zero where it is prescribed.
    pub fn with_derivatives(&self) -> RaceMotion<Dual<DIRECTIONS>> {
        self.of_body.copied().unwrap_or_else(|| constant_race(self.motion))
    }
}

/// One ball in a trial step.
#[derive(Clone, Debug)]
pub struct BallTrial {
    /// [m/s2] centre acceleration, and [m/s2] angular acceleration times ball radius.
    pub unknowns: Vector6<f64>,
    /// Motion at the end of the step.
    pub motion: BallMotion<f64>,
    /// Contacts at the end of the step.
    pub contacts: [ContactEffect; 2],
    /// Total force and moment at the end of the step.
    pub total: Wrench,
    /// [N] residual; moments over the ball radius.
    pub residual: Vector6<f64>,
    /// Tangent.
    pub block: BallBlock,
    /// Reactions on race bodies with their derivatives.
    pub reactions: [Option<RaceReaction>; 2],
    /// Contact with the cage's pocket at the end of the step, where they touch, and its reaction on the cage.
    pub pocket: Option<(BodyContact<f64>, RaceReaction)>,
}

impl BallTrial {
    /// A ball as it is.
    pub fn new(ball: &BallState, contacts: &[ContactModel<'_>; 2], races: [&RaceMotion<f64>; 2]) -> Self {
        let motion = ball.motion();
        Self {
            unknowns: Vector6::zeros(),
            motion,
            contacts: [0, 1]
                .map(|race: usize| ContactEffect::from(&contacts[race].evaluate(&motion, races[race]))),
            total: ball.total,
            residual: Vector6::zeros(),
            block: BallBlock::default(),
            reactions: [None; 2],
            pocket: None,
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

    /// Evaluates the contacts with the races and returns their derivatives.
    pub fn contacts_with_tangent(
        &mut self,
        index: usize,
        around: &Surroundings<'_>,
        step: &HhtStep,
    ) -> Matrix6<f64> {
        let Surroundings { model, contacts, differences, races, .. } = *around;
        let radius = model.bearing.ball.radius;
        let mut tangent = Matrix6::zeros();
        for race in 0..2 {
            self.reactions[race] = None;
            let contact_model = contacts[race].of_ball(differences.get(index).map(|of_ball| &of_ball[race]));
            self.contacts[race] = match races[race].of_body {
                None => {
                    let seeded = seed(&self.motion, step, radius);
                    let (effect, by_ball) = by_ball_alone(&contact_model, &seeded, races[race].motion);
                    tangent += by_ball;
                    effect
                }
                Some(motion) => {
                    let seeded = seed(&self.motion, step, radius);
                    let contact = by_ball_and_race(&contact_model, &seeded, motion);
                    tangent += by_ball(&contact.force, &contact.ball_moment);
                    let by_race = by_race(&contact.force, &contact.ball_moment);
                    self.block.right[race] = scale_moments(by_race, radius) * -(1.0 - step.alpha_f);
                    let reaction = RaceReaction { force: -contact.force, moment: contact.race_moment };
                    self.reactions[race] = Some(reaction);
                    ContactEffect::from(&contact.values())
                }
            };
        }
        tangent
    }

    /// Takes over contacts with the races that were evaluated without derivatives.
    pub fn take_contacts(&mut self, contacts: [ContactEffect; 2]) {
        self.contacts = contacts;
        self.reactions = [None; 2];
    }

    /// Residual of the ball whose contacts with the races are evaluated, and its tangent if their derivatives are given.
    pub fn assemble(
        &mut self,
        index: usize,
        around: &Surroundings<'_>,
        step: &HhtStep,
        start: &BallState,
        mut tangent: Option<Matrix6<f64>>,
    ) {
        let Surroundings { model, cage, .. } = *around;
        let ball = &model.bearing.ball;
        let share = 1.0 - step.alpha_f;
        self.total = Wrench { force: model.gravity * ball.mass, moment: Vector3::zeros() };
        for contact in &self.contacts {
            self.total.force += contact.force;
            self.total.moment += contact.ball_moment;
        }
        if let Some((model, cage)) = cage {
            let pocket = Pocket { model, cage, index };
            self.evaluate_pocket(&pocket, step, ball.radius, tangent.as_mut());
        }
        let blended = start.total.blend(&self.total, share);
        let acceleration = Vector3::new(self.unknowns[0], self.unknowns[1], self.unknowns[2]);
        let angular_acceleration =
            Vector3::new(self.unknowns[3], self.unknowns[4], self.unknowns[5]) / ball.radius;
        self.residual = stack(
            &(acceleration * ball.mass - blended.force),
            &((angular_acceleration * ball.inertia - blended.moment) / ball.radius),
        );
        if let Some(tangent) = tangent {
            let rotational = ball.inertia / (ball.radius * ball.radius);
            let inertia = stack(&Vector3::repeat(ball.mass), &Vector3::repeat(rotational));
            self.block.diagonal =
                Matrix6::from_diagonal(&inertia) - scale_moments(tangent, ball.radius) * share;
        }
    }
}

impl BallTrial {
    /// Adds the contact with the cage, and its derivatives if there is a tangent.
    fn evaluate_pocket(
        &mut self,
        seen: &Pocket<'_>,
        step: &HhtStep,
        radius: f64,
        tangent: Option<&mut Matrix6<f64>>,
    ) {
        let touching = seen.model.pocket_contact(seen.index, &self.motion, &seen.cage.value);
        if tangent.is_some() {
            self.block.right[CAGE].fill(0.0);
            self.block.left[CAGE].fill(0.0);
        }
        self.pocket = touching.map(|contact| {
            self.total.force += contact.force;
            self.total.moment += contact.moment;
            let mut reaction = RaceReaction::opposite(&contact);
            if let Some(tangent) = tangent {
                let seeded = seed::<DIRECTIONS>(&self.motion, step, radius);
                if let Some(contact) = seen.model.pocket_contact(seen.index, &seeded, &seen.cage.motion) {
                    *tangent += by_ball(&contact.force, &contact.moment);
                    let by_cage = scale_moments(by_race(&contact.force, &contact.moment), radius);
                    self.block.right[CAGE] = by_cage * -(1.0 - step.alpha_f);
                    reaction = RaceReaction { force: -contact.force, moment: contact.other_moment };
                }
            }
            (contact, reaction)
        });
    }
}

/// A ball's pocket in a trial step.
#[derive(Clone, Copy, Debug)]
struct Pocket<'a> {
    model: &'a CageModel,
    cage: &'a CageTrial,
    index: usize,
}

/// What a ball may touch in a trial step.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// The model.
    pub model: &'a Model,
    /// Contact with each race.
    pub contacts: &'a [ContactModel<'a>; 2],
    /// What Kalker's polynomials add at each ball.
    pub differences: &'a [[Difference; 2]],
    /// Motion of each race.
    pub races: [RaceSeen<'a>; 2],
    /// Constants and motion of the cage.
    pub cage: Option<(&'a CageModel, &'a CageTrial)>,
}

/// A contact with a race of given motion, and derivatives of force and moment on the ball by the ball's unknowns.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn by_ball_alone(
    contact: &ContactModel<'_>,
    ball: &BallMotion<Dual<6>>,
    race: &RaceMotion<f64>,
) -> (ContactEffect, Matrix6<f64>) {
    let contact = contact.evaluate(ball, &constant_race(race));
    (ContactEffect::from(&contact.values()), by_ball(&contact.force, &contact.ball_moment))
}

/// A contact with a race body, with derivatives by the unknowns of both.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn by_ball_and_race(
    contact: &ContactModel<'_>,
    ball: &BallMotion<Dual<DIRECTIONS>>,
    race: &RaceMotion<Dual<DIRECTIONS>>,
) -> BallRaceContact<Dual<DIRECTIONS>> {
    contact.evaluate(ball, race)
}

/// A ball's motion as a function of its own unknowns.
fn seed<const N: usize>(motion: &BallMotion<f64>, step: &HhtStep, radius: f64) -> BallMotion<Dual<N>> {
    let variable = |v: &Vector3<f64>, first: usize, gain: f64| {
        Vector3::from_fn(|i, _| Dual::variable(v[i], first + i, gain))
    };
    BallMotion {
        position: variable(&motion.position, 0, step.position_gain()),
        velocity: variable(&motion.velocity, 0, step.velocity_gain()),
        angular_velocity: variable(&motion.angular_velocity, 3, step.velocity_gain() / radius),
    }
}

/// A race's motion without derivatives, as numbers that could have some.
#[inline(always)]
pub fn constant_race<S: Scalar>(motion: &RaceMotion<f64>) -> RaceMotion<S> {
    RaceMotion {
        position: constant_vector(&motion.position),
        axis: constant_vector(&motion.axis),
        velocity: constant_vector(&motion.velocity),
        angular_velocity: constant_vector(&motion.angular_velocity),
    }
}

/// Derivatives of force (rows 0 to 2) and moment (rows 3 to 5) by the ball's unknowns.
#[inline(always)]
pub fn by_ball<const N: usize>(force: &Vector3<Dual<N>>, moment: &Vector3<Dual<N>>) -> Matrix6<f64> {
    Matrix6::from_fn(|i, k| {
        let row = if i < 3 { &force[i] } else { &moment[i - 3] };
        row.derivatives[k]
    })
}

/// Derivatives of force (rows 0 to 2) and moment (rows 3 to 5) by the unknowns of a race body.
fn by_race(force: &Vector3<Dual<DIRECTIONS>>, moment: &Vector3<Dual<DIRECTIONS>>) -> Matrix6<f64> {
    Matrix6::from_fn(|i, k| by_race_unknown(if i < 3 { &force[i] } else { &moment[i - 3] }, k))
}

/// Derivative by unknown k of a race body: translation (0 to 2), rotation (3 to 5).
pub fn by_race_unknown(x: &Dual<DIRECTIONS>, k: usize) -> f64 {
    if k < 3 { -x.derivatives[k] } else { x.derivatives[RACE_ROTATION + k - 3] }
}

/// First direction of a race body's rotation.
pub const RACE_ROTATION: usize = 6;

/// Divides the moment rows by a length.
fn scale_moments(mut matrix: Matrix6<f64>, length: f64) -> Matrix6<f64> {
    matrix.fixed_rows_mut::<3>(3).scale_mut(1.0 / length);
    matrix
}
