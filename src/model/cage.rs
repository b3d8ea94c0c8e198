//! Contacts of the cage: a pocket for each ball and, where a race guides the cage, two lands.
//!
//! The cage frame has x along its own axis and its origin in the plane of the pockets.

use super::bearing::Bearing;
use super::bodies::Race;
use crate::contact::land::{LandModel, Lands};
use crate::contact::materials::Pair;
use crate::contact::motion::BodyMotion;
use crate::contact::pair::PairForces;
use crate::contact::pocket::PocketModel;
use crate::contact::{BallMotion, RaceMotion};
use crate::effects::cage::{CageSection, Guidance};
use crate::kalker::LinearError;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::scalar::Single;
use crate::scene::Scene;

/// A cage.
#[derive(Clone, Debug)]
pub struct CageModel {
    /// Contact of a ball and its pocket.
    pub pocket: PocketModel,
    /// Contact with the lands of the race that guides it.
    pub land: Option<(Race, LandModel)>,
    /// Components [y, z] of each pocket's axis in the cage.
    directions: Vec<[f64; 2]>,
}

impl CageModel {
    /// Builds the cage of a scene.
    ///
    /// # Errors
    /// If Kalker's linear theory has no answer for the materials of the pocket.
    pub fn new(section: &CageSection, scene: &Scene, bearing: &Bearing) -> Result<Self, LinearError> {
        let youngs = section.youngs_modulus.unwrap_or(scene.race.youngs_modulus).0;
        let poisson = section.poisson_ratio.unwrap_or(scene.race.poisson_ratio);
        let materials = [(scene.ball.youngs_modulus.0, scene.ball.poisson_ratio), (youngs, poisson)];
        let friction = |given: Option<f64>| given.unwrap_or_else(|| scene.friction.ball_race.at(0.0));
        let damping = section.damping.map_or(scene.effects.damping.factor(), |factor| factor.0);
        let clearance = section.pocket_clearance.0;
        let pocket = PocketModel::new(
            bearing.ball.radius,
            clearance,
            (section.guided_by == Guidance::Balls).then_some(0.5 * bearing.pitch_diameter),
            &Pair::new(materials),
            friction(scene.friction.ball_cage),
            damping,
        )?;
        let race = match section.guided_by {
            Guidance::Inner => Some(Race::Inner),
            Guidance::Outer => Some(Race::Outer),
            Guidance::Balls => None,
        };
        let dimensions = (race, section.guidance_clearance, section.land_diameter, section.land_width);
        let land = match dimensions {
            (Some(race), Some(guidance), Some(diameter), Some(width)) => {
                let lands = Lands {
                    inside: race == Race::Inner,
                    clearance: guidance.0,
                    diameter: diameter.0,
                    width: width.0,
                    edge: bearing.ball.radius + 0.5 * clearance,
                };
                Some((race, LandModel::new(&lands, friction(scene.friction.cage_race), damping)))
            }
            _ => None,
        };
        let direction = |index: usize| {
            let (sin, cos) = bearing.ball_azimuth(index).sin_cos();
            [cos, sin]
        };
        Ok(Self { pocket, land, directions: (0..bearing.n_balls).map(direction).collect() })
    }

    /// \[m] how far the cage's centre moves from the middle before its guide holds it: the lands or, without them, the balls.
    pub fn play(&self) -> f64 {
        self.land.as_ref().map_or(self.pocket.half_clearance, |(_, land)| land.half_clearance)
    }

    /// The race whose lands guide the cage; none where the balls do.
    pub fn guide(&self) -> Option<Race> {
        self.land.as_ref().map(|(race, _)| *race)
    }

    /// Forces between a ball (first, 0 is the first) and the cage, in oil of a viscosity [Pa s] or dry; `None` where they neither
    /// touch nor have oil between them.
    #[inline(never)]
    pub fn pocket_contact<S: Single>(
        &self,
        index: usize,
        ball: &BallMotion<S>,
        cage: &BodyMotion<S>,
        oil: f64,
    ) -> Option<PairForces<S>> {
        self.pocket.evaluate(ball, cage, self.directions[index], oil)
    }

    /// Which of four balls, of which the first is ball `first`, do something to their pockets, in oil of a viscosity [Pa s] or dry?
    pub fn near_pockets(
        &self,
        first: usize,
        balls: &BallMotion<Lanes>,
        cage: &BodyMotion<f64>,
        oil: f64,
    ) -> [bool; WIDTH] {
        let last = self.directions.len() - 1;
        let directions = std::array::from_fn(|lane| self.directions[(first + lane).min(last)]);
        self.pocket.near(balls, cage, &directions, oil)
    }

    /// \[m] approach of a ball and its pocket; negative is a gap.
    pub fn pocket_approach(&self, index: usize, ball: &BallMotion<f64>, cage: &BodyMotion<f64>) -> f64 {
        self.pocket.approach(ball, cage, self.directions[index])
    }

    /// Forces between cage (first) and the race that guides it on the lands at the cage's -x and +x side, in the same oil;
    /// `None` where they neither touch nor have oil between them.
    pub fn land_contacts(
        &self,
        cage: &BodyMotion<f64>,
        race: impl FnOnce(Race) -> RaceMotion<f64>,
        oil: f64,
    ) -> [Option<PairForces>; 2] {
        match &self.land {
            Some((guide, land)) => {
                let race = race(*guide);
                land.positions.map(|position| land.evaluate(cage, &race, position, oil))
            }
            None => [None; 2],
        }
    }
}
