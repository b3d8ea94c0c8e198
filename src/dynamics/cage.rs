//! The cage in one trial step, as balls and lands see it: its motion with all axes, and the lands that guide it.

use nalgebra::{Matrix6, Vector3};

use super::body::{BodyTrial, RaceSeen};
use super::directions::{D, exchange_bodies};
use super::reaction::Reaction;
use crate::contact::RaceMotion;
use crate::contact::land::LandModel;
use crate::contact::motion::BodyMotion;
use crate::contact::pair::PairForces;
use crate::model::cage::CageModel;
use crate::numerics::hht::HhtStep;

/// A cage in a trial step.
#[derive(Clone, Debug)]
pub struct CageTrial {
    /// Motion with derivatives by the cage's rotation, as asked for last.
    pub motion: BodyMotion<D>,
    /// Motion without derivatives.
    pub value: BodyMotion<f64>,
    /// [Pa s] viscosity of the oil around it; 0 where it is dry.
    pub oil: f64,
    /// Contacts with the lands at the end of the step, where they touch.
    pub lands: [Option<PairForces>; 2],
    /// Derivatives of the guiding race's residual by the cage's unknowns.
    pub race_by_cage: Matrix6<f64>,
    /// Derivatives of the cage's residual by the guiding race's unknowns.
    pub cage_by_race: Matrix6<f64>,
}

/// Reactions of one land contact on the cage and on the race.
#[derive(Clone, Copy, Debug)]
pub struct LandReactions {
    /// Reaction on the cage.
    pub on_cage: Reaction,
    /// Reaction on the race.
    pub on_race: Reaction,
}

impl CageTrial {
    /// A dry cage at the start of a step.
    pub fn new(body: &BodyTrial) -> Self {
        let value = body.body_motion_value();
        Self {
            motion: value.constant(),
            value,
            oil: 0.0,
            lands: [None; 2],
            race_by_cage: Matrix6::zeros(),
            cage_by_race: Matrix6::zeros(),
        }
    }

    /// Takes over the motion of the body at the end of a step.
    pub fn see(&mut self, body: &BodyTrial) {
        self.value = body.body_motion_value();
    }

    /// Takes over its derivatives.
    pub fn see_derivatives(&mut self, body: &BodyTrial) {
        if let Some(motion) = body.body_motion() {
            self.motion = motion;
        }
    }

    /// Evaluates the contacts with the lands.
    pub fn touch_lands(&mut self, model: &CageModel, race: &RaceMotion<f64>) {
        self.lands = model.land_contacts(&self.value, |_| *race, self.oil);
    }

    /// Reactions of the lands that it touches, with their derivatives.
    pub fn land_reactions(
        &self,
        model: &CageModel,
        race: &RaceSeen<'_>,
        step: &HhtStep,
    ) -> [Option<LandReactions>; 2] {
        let Some((_, land)) = &model.land else {
            return [None; 2];
        };
        if self.lands.iter().all(Option::is_none) {
            return [None; 2];
        }
        let race = race.with_derivatives();
        [0, 1].map(|side: usize| {
            self.lands[side].as_ref()?;
            self.with_derivatives(land, land.positions[side], &race, step)
        })
    }

    /// A land contact as a function of the unknowns of cage (first body) and race (second).
    fn with_derivatives(
        &self,
        land: &LandModel,
        position: f64,
        race: &RaceMotion<D>,
        step: &HhtStep,
    ) -> Option<LandReactions> {
        let translation = |v: &Vector3<f64>, gain: f64| Vector3::from_fn(|i, _| D::variable(v[i], i, gain));
        // As second bodies both have their rotation in the same directions.
        let cage = BodyMotion {
            position: translation(&self.value.position, step.position_gain()),
            axes: self.motion.axes.map(|axis| axis.map(exchange_bodies)),
            velocity: translation(&self.value.velocity, step.velocity_gain()),
            angular_velocity: self.motion.angular_velocity.map(exchange_bodies),
        };
        by_cage_and_race(land, &cage, race, (position, self.oil))
    }
}

/// Reactions of a land at a position \[m] of the cage, in oil of a viscosity [Pa s] or dry.
fn by_cage_and_race(
    land: &LandModel,
    cage: &BodyMotion<D>,
    race: &RaceMotion<D>,
    (position, oil): (f64, f64),
) -> Option<LandReactions> {
    let pair = land.evaluate(cage, race, position, oil)?;
    let on_cage = Reaction::on_first(&pair);
    Some(LandReactions {
        on_cage: Reaction {
            force: on_cage.force.map(exchange_bodies),
            moment: on_cage.moment.map(exchange_bodies),
        },
        on_race: Reaction::on_second(&pair),
    })
}
