//! How far balls and cage stay behind the orbit of rolling.
//!
//! A ball that rolls without slip along both races has, for its own axis of rotation, one orbital speed. With `w` its
//! angular velocity seen from the orbit, `t` the direction of motion, and at each race the unit normal `n` and the radius `r`
//! of the contact point about the race's axis, rolling is `(omega - omega_m) r = R (w x n) t`. Both races together give
//! `omega_m = (omega_i r_i g_o - omega_o r_o g_i)/(r_i g_o - r_o g_i)`, `g = (w x n) t`: Harris's formula with contact angles
//! of its own at each race and the pitch angle that the ball has (Rolling Bearing Analysis, 4th edition, eq. 8.14). Where
//! both contact angles are the same the axis drops out.
//!
//! Slip is the speed by which a body stays behind that orbit, over the speed of rolling. The latter goes through zero where a bearing
//! stops, turns back or swings, and the quotient would be of any size there. So its divisor is never less than half of the body's
//! own speed, nor than the speed below which creepages, too, are held finite.

use nalgebra::Vector3;

use crate::contact::kinematics::REGULARISATION_SPEED;
use crate::contact::{BallRaceContact, RaceMotion};
use crate::forces::Contacts;
use crate::model::Model;
use crate::model::bodies::{PerRace, Race};
use crate::model::state::{BallState, State};

/// [-] part of its own speed that the slip of a body is divided by where this is faster than rolling.
const OWN: f64 = 0.5;

/// Orbital speeds of the balls that both races hold, weighted by their loads.
#[derive(Clone, Copy, Debug)]
pub(super) struct RollingOrbit {
    /// [rad/s] of rolling without slip.
    pub(super) rolling: f64,
    /// [rad/s] as they are.
    pub(super) orbit: f64,
    /// [rad/s] below which nothing is said to roll.
    floor: f64,
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
        let floor = 2.0 * REGULARISATION_SPEED / model.bearing.pitch_diameter;
        let outer = state.race(Race::Outer);
        let speeds = PerRace::new(|race| state.race(race).rate.x);
        let (mut rolling, mut orbit, mut weight) = (0.0, 0.0, 0.0);
        for (ball, contacts) in state.balls.iter().zip(&contacts.balls) {
            let load = contacts.raceways.inner.load.min(contacts.raceways.outer.load);
            if load > 0.0 {
                let speed = ball.orbital_speed(outer);
                rolling += load * rolling_speed(ball, speed, &contacts.raceways, races, &speeds, radius);
                orbit += load * speed;
                weight += load;
            }
        }
        if weight > 0.0 {
            return Self { rolling: rolling / weight, orbit: orbit / weight, floor };
        }
        let bearing = &model.bearing;
        let rolling = bearing.epicyclic_speed(bearing.free_contact_angle, speeds.inner, speeds.outer);
        let balls = state.balls.iter();
        let orbit = balls.map(|ball| ball.orbital_speed(outer)).sum::<f64>() / state.balls.len() as f64;
        Self { rolling, orbit, floor }
    }

    /// [-] slip of a body of an orbital speed [rad/s], in [-2, 3]: 1 - that speed over the speed of rolling, from the floor on and up to
    /// twice the speed of rolling. Below the floor it fades to 0.
    pub(super) fn slip_of(&self, speed: f64) -> f64 {
        let rolls = self.rolling.abs().max(self.floor);
        // Of rolling; +-1 from the floor on.
        let direction = self.rolling / rolls;
        let scale = rolls.max(OWN * speed.abs());
        direction * self.rolling / scale - direction * speed / scale
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

#[cfg(test)]
mod tests {
    use super::*;

    fn slip(rolling: f64, speed: f64) -> f64 {
        RollingOrbit { rolling, orbit: speed, floor: 0.04 }.slip_of(speed)
    }

    #[test]
    fn closed_form_slip_of_what_rolls_has_the_bits_of_its_quotient() {
        for rolling in [0.04, -0.04, 0.3, 12.54, -12.55, 1e4, -7e5] {
            for part in [0.0, 0.3, 0.9993, 1.0, 1.0 + 1e-9, 1.7, -0.4, -2.0] {
                let speed = part * rolling;
                assert_eq!(
                    slip(rolling, speed).to_bits(),
                    (1.0 - speed / rolling).to_bits(),
                    "{rolling} {speed}"
                );
            }
        }
    }

    #[test]
    fn invariant_slip_is_bounded_and_goes_to_nothing_where_nothing_rolls() {
        let sizes = [0.0, 1e-300, 1e-64, 1e-12, 1e-6, 0.039, 0.04, 0.041, 1.0, 1e3, 1e9];
        let all = || sizes.into_iter().flat_map(|size| [size, -size]);
        for rolling in all() {
            for speed in all() {
                let slip = slip(rolling, speed);
                assert!((-2.0..=3.0).contains(&slip), "{slip}: {rolling} {speed}");
                assert!(slip.abs() <= 3.0 * rolling.abs() / 0.04, "{slip}: {rolling} {speed}");
            }
        }
        // No jumps: where the floor begins, where a body overruns, and where rolling turns back.
        for speed in [0.0, 0.01, 0.04, 0.2, -0.2, 30.0] {
            for rolling in [0.04, 0.5 * speed, -0.5 * speed, 0.0] {
                let apart = slip(rolling + 1e-9, speed) - slip(rolling - 1e-9, speed);
                assert!(apart.abs() < 1e-6, "{apart}: {rolling} {speed}");
            }
        }
    }
}
