//! The cage in one trial step: a rigid body like a race, with the lands that guide it.

use nalgebra::{Matrix6, Vector3};

use super::ball::{DIRECTIONS, RACE_ROTATION, RaceSeen};
use super::race::RaceTrial;
use super::reaction::RaceReaction;
use crate::contact::body::{BodyContact, BodyMotion};
use crate::contact::land::LandModel;
use crate::dynamics::state::RaceState;
use crate::model::cage::CageModel;
use crate::numerics::hht::HhtStep;
use crate::numerics::scalar::{Dual, values};

type D = Dual<DIRECTIONS>;

/// First direction of the rotation of the body that a ball is, or that stands for it.
const BALL_ROTATION: usize = 3;

/// A cage in a trial step.
#[derive(Clone, Debug)]
pub struct CageTrial {
    /// The body's motion, residual and tangent.
    pub body: RaceTrial,
    /// Motion as the balls see it, with derivatives by the cage's rotation.
    pub motion: BodyMotion<D>,
    /// The same without derivatives.
    pub value: BodyMotion<f64>,
    /// Contacts with the lands at the end of the step, where they touch.
    pub lands: [Option<BodyContact<f64>>; 2],
    /// Derivatives of the guiding race's residual by the cage's unknowns, and the other way round.
    pub race_by_cage: Matrix6<f64>,
    /// See there.
    pub cage_by_race: Matrix6<f64>,
}

/// Reactions of a land contact on race (by index) and cage.
type LandReaction = (usize, RaceReaction, RaceReaction);

impl CageTrial {
    /// Buffers for a cage, as at the start of a step.
    pub fn new(model: &CageModel, start: &RaceState) -> Self {
        let body = RaceTrial::new(&model.body, start);
        Self {
            motion: body.body_motion(),
            value: start.body_motion(),
            body,
            lands: [None; 2],
            race_by_cage: Matrix6::zeros(),
            cage_by_race: Matrix6::zeros(),
        }
    }

    /// Motion at the end of the step, see [`RaceTrial::move_to`].
    pub fn move_to(&mut self, unknowns: &[f64], start: &RaceState, step: &HhtStep, length: f64) {
        self.body.move_to(unknowns, start, step, length);
        self.motion = self.body.body_motion();
        self.value = BodyMotion {
            position: values(&self.motion.position),
            axes: self.motion.axes.each_ref().map(values),
            velocity: values(&self.motion.velocity),
            angular_velocity: values(&self.motion.angular_velocity),
        };
    }

    /// Evaluates the contacts with the lands and returns their reactions, with derivatives if asked for.
    pub fn touch_lands(
        &mut self,
        model: &CageModel,
        races: [RaceSeen<'_>; 2],
        step: &HhtStep,
        with_tangent: bool,
    ) -> [Option<LandReaction>; 2] {
        self.race_by_cage.fill(0.0);
        self.cage_by_race.fill(0.0);
        self.lands = model.land_contacts(&self.value, races.map(|race| race.motion));
        let Some(land) = &model.land else {
            return [None; 2];
        };
        [0, 1].map(|side: usize| {
            let contact = self.lands[side].as_ref()?;
            let constant = (land.race, RaceReaction::opposite(contact), RaceReaction::direct(contact));
            if !with_tangent {
                return Some(constant);
            }
            let contact = self.with_derivatives(land, land.positions[side], &races[land.race], step);
            Some(contact.unwrap_or(constant))
        })
    }

    /// A land contact as a function of the unknowns of cage and race. The cage takes the ball's part: its translation
    /// is directions 0 to 2, its rotation 3 to 5.
    fn with_derivatives(
        &self,
        land: &LandModel,
        position: f64,
        race: &RaceSeen<'_>,
        step: &HhtStep,
    ) -> Option<LandReaction> {
        let translation = |v: &Vector3<f64>, gain: f64| Vector3::from_fn(|i, _| D::variable(v[i], i, gain));
        let cage = BodyMotion {
            position: translation(&self.value.position, step.position_gain()),
            axes: self.motion.axes.map(|axis| axis.map(exchange_parts)),
            velocity: translation(&self.value.velocity, step.velocity_gain()),
            angular_velocity: self.motion.angular_velocity.map(exchange_parts),
        };
        let contact = land.evaluate(&cage, &race.with_derivatives(), position)?;
        let on_race = RaceReaction { force: -contact.force, moment: contact.other_moment };
        let on_cage = RaceReaction {
            force: contact.force.map(exchange_parts),
            moment: contact.moment.map(exchange_parts),
        };
        Some((land.race, on_race, on_cage))
    }
}

/// The same number with the parts of ball and race body exchanged: the relative translation changes sign, and the
/// rotations change places.
fn exchange_parts(x: D) -> D {
    let mut exchanged = x;
    for i in 0..3 {
        exchanged.derivatives[i] = -x.derivatives[i];
        exchanged.derivatives[BALL_ROTATION + i] = x.derivatives[RACE_ROTATION + i];
        exchanged.derivatives[RACE_ROTATION + i] = x.derivatives[BALL_ROTATION + i];
    }
    exchanged
}
