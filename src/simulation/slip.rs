//! How far balls and cage stay behind the orbit of rolling.
//!
//! A ball that rolls without slip along both races has, for its own axis of rotation, one orbital speed. With `w` its
//! angular velocity seen from the orbit, `t` the direction of motion, and at each race the unit normal `n` and the radius `r`
//! of the contact point about the race's axis, rolling is `(omega - omega_m) r = R (w x n) t`. Both races together give
//! `omega_m = (omega_i r_i g_o - omega_o r_o g_i)/(r_i g_o - r_o g_i)`, `g = (w x n) t`: Harris's formula with contact angles
//! of its own at each race and the pitch angle that the ball has (Rolling Bearing Analysis, 4th edition, eq. 8.14). Where
//! both contact angles are the same the axis drops out.

use nalgebra::Vector3;

use crate::contact::{BallRaceContact, RaceMotion};
use crate::forces::Contacts;
use crate::model::Model;
use crate::model::bodies::{PerRace, Race};
use crate::model::state::{BallState, BodyState, State};

/// Orbital speeds of the balls that both races hold, weighted by their loads.
#[derive(Clone, Copy, Debug)]
pub(super) struct RollingOrbit {
    /// [rad/s] of rolling without slip.
    pub(super) rolling: f64,
    /// [rad/s] as they are.
    pub(super) orbit: f64,
}

impl RollingOrbit {
    /// Means over the balls of a radius \[m]; the unloaded bearing's without a loaded ball.
    pub(super) fn mean(
        model: &Model,
        state: &State,
        contacts: &Contacts,
        races: &PerRace<RaceMotion<f64>>,
        radius: f64,
    ) -> Self {
        let outer = state.race(Race::Outer);
        let speeds = PerRace::new(|race| state.race(race).rate.x);
        let (mut rolling, mut orbit, mut weight) = (0.0, 0.0, 0.0);
        for (ball, contacts) in state.balls.iter().zip(&contacts.balls) {
            let load = contacts.raceways.inner.load.min(contacts.raceways.outer.load);
            if load > 0.0 {
                let speed = orbital_speed(ball, outer);
                rolling += load * rolling_speed(ball, speed, &contacts.raceways, races, &speeds, radius);
                orbit += load * speed;
                weight += load;
            }
        }
        if weight > 0.0 {
            return Self { rolling: rolling / weight, orbit: orbit / weight };
        }
        let bearing = &model.bearing;
        let rolling = bearing.epicyclic_speed(bearing.free_contact_angle, speeds.inner, speeds.outer);
        let balls = state.balls.iter();
        let orbit = balls.map(|ball| orbital_speed(ball, outer)).sum::<f64>() / state.balls.len() as f64;
        Self { rolling, orbit }
    }

    /// [-] 1 - a speed over that of rolling; 0 where that is 0.
    pub(super) fn slip_of(&self, speed: f64) -> f64 {
        if self.rolling == 0.0 { 0.0 } else { 1.0 - speed / self.rolling }
    }
}

/// [rad/s] orbital speed at which a ball of an orbital speed [rad/s] would roll with its own axis of rotation.
fn rolling_speed(
    ball: &BallState,
    orbit: f64,
    contacts: &PerRace<BallRaceContact<f64>>,
    races: &PerRace<RaceMotion<f64>>,
    speeds: &PerRace<f64>,
    radius: f64,
) -> f64 {
    let arms = PerRace::new(|race| {
        let contact = &contacts[race].geometry;
        contact.radius + radius * contact.normal.dot(&contact.radial)
    });
    let by_axis = |axis: &Vector3<f64>| {
        PerRace::new(|race| {
            let contact = &contacts[race].geometry;
            axis.cross(&contact.normal).dot(&contact.circumferential)
        })
    };
    let mut surface = by_axis(&(ball.angular_velocity - races.outer.axis * orbit));
    // A ball that hardly turns, or about an axis beyond the contacts, rolls on neither: then about the axis between them.
    if surface.inner * surface.outer >= 0.0 {
        let between = contacts.outer.geometry.normal - contacts.inner.geometry.normal;
        surface = by_axis(&contacts.outer.geometry.circumferential.cross(&between));
    }
    let (inner, outer) = (arms.inner * surface.outer, arms.outer * surface.inner);
    (speeds.inner * inner - speeds.outer * outer) / (inner - outer)
}

/// [rad/s] orbital speed of a ball about the axis of the outer race.
pub(super) fn orbital_speed(ball: &BallState, outer: &BodyState) -> f64 {
    let frame = outer.pose.orientation.inverse();
    let offset = frame * (ball.position - outer.pose.position);
    let relative = frame * (ball.velocity - outer.velocity);
    (offset.y * relative.z - offset.z * relative.y) / (offset.y * offset.y + offset.z * offset.z)
}
