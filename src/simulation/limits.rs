//! Limits of what is simulated: a state beyond them is refused.

use std::f64::consts::PI;

use super::outputs::towards_x;
use super::{Simulation, SimulationError};
use crate::contact::creep::Law;
use crate::dynamics::Boundary;
use crate::equilibrium::MAX_APPROACH;
use crate::model::bearing::neighbours;
use crate::model::bodies::Race;
use crate::scene::BearingSection;

/// [-] overlap of neighbouring balls over their diameter that a start may have: balls that just fit are moved by microns
/// where the load bends their orbit.
const START_OVERLAP: f64 = 1e-4;

impl Simulation {
    /// Refuses more balls than fit on the orbit that the equilibrium gives them. It knows nothing of their contacts.
    pub(super) fn check_room(&self) -> Result<(), SimulationError> {
        if self.model.cage.is_some() {
            return Ok(());
        }
        let bearing = &self.model.bearing;
        let diameter = 2.0 * bearing.ball.radius;
        let approach = |(first, second): (usize, usize)| {
            diameter - (self.state.balls[second].position - self.state.balls[first].position).norm()
        };
        let overlap = neighbours(self.state.balls.len()).map(approach).fold(f64::NEG_INFINITY, f64::max);
        if overlap <= START_OVERLAP * diameter {
            return Ok(());
        }
        let orbit = (diameter - overlap) / (PI / bearing.n_balls as f64).sin();
        let fit = BearingSection::most_balls(diameter, orbit);
        Err(SimulationError::TooManyBalls { balls: bearing.n_balls, fit, overlap })
    }

    /// Refuses contacts of the step that was accepted last which no material takes, or where no groove is.
    pub(super) fn check_contacts(&self) -> Result<(), SimulationError> {
        // Where the rings go they are looked at.
        if self.model.without_states {
            return Ok(());
        }
        let diameter = 2.0 * self.model.bearing.ball.radius;
        let thrust = self.model.bearing.is_thrust_bearing();
        let [least, most] = self.model.bearing.contact_angles();
        for race in Race::BOTH {
            let axis = self.state.race(race).motion().axis;
            for index in 0..self.state.balls.len() {
                let contact = self.workspace.touch(index, race);
                let (time, ball, approach) = (self.state.time, index + 1, contact.approach);
                // The groove of the inner race opens away from its axis, that of the outer race towards it.
                let out = if race == Race::Inner { -1.0 } else { 1.0 };
                let radial = out * contact.normal.dot(&contact.radial);
                let off = match thrust {
                    true => {
                        let angle = (out * contact.normal.dot(&axis)).atan2(radial);
                        !(least..=most).contains(&angle)
                    }
                    false => radial < 0.0,
                };
                if approach > 0.0 && off {
                    return Err(SimulationError::LeftGroove { time, ball, race: race.name(), approach });
                }
                if approach > MAX_APPROACH * diameter {
                    return Err(SimulationError::Overload { time, ball, race: race.name(), approach });
                }
            }
        }
        self.check_shoulders()?;
        for pair in self.workspace.touching_balls() {
            let (time, approach) = (self.state.time, pair.forces.approach);
            if approach > MAX_APPROACH * diameter {
                let (ball, next) = (pair.first + 1, pair.second + 1);
                return Err(SimulationError::BallsPressed { time, ball, next, approach });
            }
        }
        Ok(())
    }

    /// Refuses contacts that linear theory does not reach: their creep force is above what friction can carry.
    pub(super) fn check_creep(&self, boundary: &Boundary) -> Result<(), SimulationError> {
        if self.model.without_states || !matches!(self.model.law(Race::Inner), Law::Linear) {
            return Ok(());
        }
        let orientations = self.state.orientations.as_ref();
        let contacts = self.model.contacts_oriented(&boundary.conditions, orientations);
        for (index, ball) in self.state.balls.iter().enumerate() {
            for race in Race::BOTH {
                let contact = contacts[race]
                    .of_ball(index, None)
                    .evaluate(&ball.motion(), &self.state.race(race).motion());
                let force = contact.creep.longitudinal.hypot(contact.creep.lateral);
                let limit = contacts[race].friction * contact.load;
                if force > limit {
                    let (time, ball, race) = (self.state.time, index + 1, race.name());
                    return Err(SimulationError::BeyondLinear { time, ball, race, force, limit });
                }
            }
        }
        Ok(())
    }

    /// Refuses contacts beyond the shoulders of their race.
    fn check_shoulders(&self) -> Result<(), SimulationError> {
        for race in Race::BOTH {
            let axis = self.state.race(race).axes[0];
            let touch = |ball| self.workspace.touch(ball, race);
            let towards_x = |ball| towards_x(&touch(ball).normal, &touch(ball).radial, &axis);
            let balls = 0..self.state.balls.len();
            let clear = self.model.bearing.shoulders[race].clear();
            if balls.clone().all(|ball| clear(towards_x(ball))) {
                continue;
            }
            let angle = |ball| {
                let (sine, cosine) = towards_x(ball);
                sine.atan2(cosine)
            };
            self.model
                .bearing
                .check_shoulders(race, balls.map(|ball| touch(ball).load), angle)
                .map_err(|contact| SimulationError::BeyondShoulder { time: self.state.time, contact })?;
        }
        Ok(())
    }
}
