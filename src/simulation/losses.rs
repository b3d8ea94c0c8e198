//! Losses of a bearing by part: together the power that its races have to bring.
//!
//! Powers of contacts are those of the forces that act: what a contact loses beside the sliding of its creep forces is rolling
//! resistance and what the material resists, so that all parts together are the whole to the last digits.

use super::outputs::Outputs;
use crate::contact::{ContactModel, RaceMotion};
use crate::dynamics::power_lost_around;
pub use crate::effects::LOSSES;
pub use crate::effects::losses::Losses;
use crate::effects::moving_frame::FrameMotion;
use crate::forces::{Contacts, Totals};
use crate::model::Model;
use crate::model::bodies::{PerRace, Race};
use crate::model::state::{BallState, State};
use crate::scene::Level;

impl Losses {
    /// Losses of a state with these contacts, their models, motion of the races and sums.
    pub(super) fn of(
        model: &Model,
        state: &State,
        contacts: &Contacts,
        (models, races): (&PerRace<ContactModel<'_>>, &PerRace<RaceMotion<f64>>),
        totals: &Totals,
    ) -> Self {
        let pockets = contacts.balls.iter().filter_map(|ball| ball.pocket);
        let cage = pockets.chain(contacts.lands.iter().flatten().copied());
        let cage = cage.fold(0.0, |sum, pair| sum + pair.friction_power);
        let (mut resisting, mut rolling) = (0.0, 0.0);
        for race in Race::BOTH.into_iter().filter(|race| models[*race].resists()) {
            let (of_race, oiled) = (&models[race], models[race].film.is_some_and(|film| film.resists()));
            for (ball, (contacts, state)) in contacts.balls.iter().zip(&state.balls).enumerate() {
                let contact = of_race.of_ball(ball, None);
                let contact = contact.completed(&contacts.raceways[race], &state.motion(), &races[race]);
                let lagging = of_race.resisting_power(&contact);
                resisting += lagging;
                if oiled {
                    rolling += contact.friction_power - contact.sliding_power() - lagging;
                }
            }
        }
        let support = state.supports.iter().flatten().fold(0.0, |sum, support| sum + support.lost);
        Self {
            sliding: totals.friction_power - cage - resisting - rolling,
            cage,
            resisting,
            rolling,
            drag: power_lost_around(
                &model.ambient(&FrameMotion::default()),
                state.balls.iter().map(BallState::motion),
            ),
            damping: totals.damping_power,
            support,
        }
    }

    /// [N m] torque that brings them at a speed [rad/s]; 0 where nothing turns.
    pub(super) fn torque(&self, speed: f64) -> f64 {
        let speed = speed.abs();
        if speed > 0.0 { self.total() / speed } else { 0.0 }
    }
}

impl Outputs {
    /// [rad/s] speed of the inner race against the outer one, about their own axes.
    pub fn relative_speed(&self) -> f64 {
        let spin = |race: Race| (self[race].pose.orientation.inverse() * self[race].twist.angular_velocity).x;
        spin(Race::Inner) - spin(Race::Outer)
    }

    /// [N m] torque that brings the losses of the bearing at its speed; 0 where it stands. At the start of a run its balls are in balance with their loads,
    /// but not yet with friction along their orbits: what speeds them up or slows them down is in the moment on the races of that instant, and
    /// in none of the torque that lasts.
    pub fn torque_of_losses(&self) -> f64 {
        self.losses.torque(self.relative_speed())
    }
}

/// [N m] friction torque of a state: against the rotation of the inner race as seen from the outer one; of an equilibrium, what brings its losses
/// ([`Outputs::torque_of_losses`]).
pub(super) fn friction_torque(model: &Model, state: &State, losses: impl FnOnce() -> Losses) -> f64 {
    let [inner, outer] = Race::BOTH.map(|race| state.race(race));
    let speed = inner.rate.x - outer.rate.x;
    if model.solver.level == Level::Equilibrium {
        return losses().torque(speed);
    }
    let against = -inner.bearing_wrench.moment.dot(&inner.motion().axis);
    if speed < 0.0 { -against } else { against }
}
