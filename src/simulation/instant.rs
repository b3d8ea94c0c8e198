//! State of a bearing at an instant, as far as means of a run are made of it: less than all outputs, for every step.

use super::entering;
use super::losses::{Losses, friction_torque};
use super::outputs::{Outputs, RaceOutput, spin_free_frame};
use super::slip::RollingOrbit;
use crate::forces::{Contacts, Totals, stored_energy};
use crate::model::bodies::{PerRace, Race};
use crate::model::state::State;
use crate::model::{Conditions, Model};

/// A bearing at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// \[s] time.
    pub time: f64,
    /// Inner race.
    pub inner: RaceOutput,
    /// Outer race.
    pub outer: RaceOutput,
    /// The cage, where there is one.
    pub cage: Option<CageInstant>,
    /// See [`Outputs::cage_speed`].
    pub cage_speed: f64,
    /// See [`Outputs::rolling_speed`].
    pub rolling_speed: f64,
    /// See [`Outputs::cage_slip`].
    pub cage_slip: f64,
    /// See [`Outputs::ball_slip`].
    pub ball_slip: f64,
    /// See [`Outputs::entering_slip_load`].
    pub entering_slip_load: f64,
    /// See [`Outputs::friction_power`].
    pub friction_power: f64,
    /// See [`Outputs::damping_power`].
    pub damping_power: f64,
    /// See [`Outputs::friction_torque`].
    pub friction_torque: f64,
    /// See [`Outputs::losses`].
    pub losses: Losses,
    /// See [`Outputs::torque_power`].
    pub torque_power: f64,
    /// See [`Outputs::stored_energy`].
    pub stored_energy: f64,
    /// \[W] mean over the balls of the friction power on the inner and the outer race.
    pub power_per_ball: [f64; 2],
    /// \[N] largest load between two balls.
    pub between_balls: f64,
    /// \[Pa] peak pressure of the most loaded contact of each race.
    pub peak_pressure: [f64; 2],
}

/// A cage at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CageInstant {
    /// \[m] its centre off the axis of the race that guides it.
    pub eccentricity: f64,
    /// \[m] the same across that axis, y and z of the frame that tilts with the race but does not spin.
    pub centre: [f64; 2],
    /// \[N] largest load in a pocket.
    pub pocket_load: f64,
    /// \[N] largest load on a land.
    pub land_load: f64,
    /// \[W] friction power in the pockets.
    pub pocket_power: f64,
    /// \[W] friction power on the lands.
    pub land_power: f64,
}

impl Instant {
    /// Instant of a state whose contacts were evaluated.
    pub(super) fn of(model: &Model, state: &State, contacts: &Contacts, conditions: &Conditions) -> Self {
        let races = PerRace::new(|race| state.race(race).motion());
        let count = state.balls.len() as f64;
        let totals = Totals::of(contacts, state.balls.len());
        let models = model.contacts_oriented(conditions, state.orientations.as_ref());
        let rolling = RollingOrbit::mean(model, state, contacts, &races, models.inner.surface.ball_radius);
        let speeds = Race::BOTH.map(|race| state.race(race).rate.x);
        let cage_speed = state.cage_speed();
        let cage = model.cage.as_ref().zip(state.cage()).map(|(model, cage)| {
            let pockets = || contacts.balls.iter().filter_map(|of_ball| of_ball.pocket);
            let lands = || contacts.lands.iter().flatten();
            let guide = state.race(model.guide().unwrap_or(Race::Outer));
            let off = spin_free_frame(guide).inverse() * (cage.pose.position - guide.pose.position);
            CageInstant {
                eccentricity: off.yz().norm(),
                centre: off.yz().into(),
                pocket_load: pockets().map(|pair| pair.load).fold(0.0, f64::max),
                land_load: lands().map(|pair| pair.load).fold(0.0, f64::max),
                pocket_power: pockets().fold(0.0, |sum, pair| sum + pair.friction_power),
                land_power: lands().fold(0.0, |sum, pair| sum + pair.friction_power),
            }
        });
        let pressure = |race: Race| {
            let loads = contacts.balls.iter().map(|of_ball| of_ball.raceways[race].load).enumerate();
            let (ball, load) = loads.fold((0, 0.0), |most, one| if one.1 > most.1 { one } else { most });
            if load <= 0.0 {
                return 0.0;
            }
            let (pair, motion) = (&contacts.balls[ball].raceways[race], state.balls[ball].motion());
            let contact = models[race].of_ball(ball, None).completed(pair, &motion, &races[race]);
            let area = std::f64::consts::PI
                * contact.semi_axes[0]
                * contact.semi_axes[1]
                * contact.geometry.approach.max(0.0);
            if area > 0.0 { 1.5 * load / area } else { 0.0 }
        };
        let power = |race: Race| {
            contacts.balls.iter().map(|of_ball| of_ball.raceways[race].friction_power).sum::<f64>() / count
        };
        let [inner, outer] = Race::BOTH.map(|race| RaceOutput::new(state, model, race));
        let losses = Losses::of(model, state, contacts, (&models, &races), &totals);
        Self {
            time: state.time,
            friction_torque: friction_torque(model, state, || losses),
            losses,
            torque_power: inner.drive_torque * speeds[0] + outer.drive_torque * speeds[1],
            // Most steps look at it.
            stored_energy: match model.solver.energy_error > 0.0 {
                true => state.energies.stored,
                false => stored_energy(model, state, contacts),
            },
            inner,
            outer,
            cage,
            cage_speed,
            rolling_speed: rolling.rolling,
            cage_slip: rolling.slip_of(cage_speed),
            ball_slip: rolling.slip_of(rolling.orbit),
            entering_slip_load: entering::slip_load(state, contacts),
            friction_power: totals.friction_power,
            damping_power: totals.damping_power,
            power_per_ball: Race::BOTH.map(power),
            between_balls: contacts.ball_pairs.iter().map(|pair| pair.forces.load).fold(0.0, f64::max),
            peak_pressure: Race::BOTH.map(pressure),
        }
    }

    /// [rad/s] spin of a race about its own axis.
    pub fn spin(&self, race: Race) -> f64 {
        let of = match race {
            Race::Inner => &self.inner,
            Race::Outer => &self.outer,
        };
        (of.pose.orientation.inverse() * of.twist.angular_velocity).x
    }
}

impl From<&Outputs> for Instant {
    fn from(o: &Outputs) -> Self {
        let count = o.balls.len() as f64;
        let power = |race: Race| o.balls.iter().map(|ball| ball[race].power).sum::<f64>() / count;
        let pressure = |race: Race| {
            let contacts = o.balls.iter().map(|ball| &ball[race]);
            let most = contacts.reduce(|most, one| if one.load > most.load { one } else { most });
            most.map_or(0.0, |contact| contact.peak_pressure)
        };
        let pockets = || o.balls.iter().filter_map(|ball| ball.pocket);
        let cage = o.cage.as_ref().map(|cage| CageInstant {
            eccentricity: cage.eccentricity.yz().norm(),
            centre: cage.eccentricity.yz().into(),
            pocket_load: pockets().map(|pocket| pocket.load).fold(0.0, f64::max),
            land_load: cage.land_loads[0].max(cage.land_loads[1]),
            pocket_power: cage.pocket_power,
            land_power: cage.land_power,
        });
        Self {
            time: o.time,
            inner: o.inner,
            outer: o.outer,
            cage,
            cage_speed: o.cage_speed,
            rolling_speed: o.rolling_speed,
            cage_slip: o.cage_slip,
            ball_slip: o.ball_slip,
            entering_slip_load: o.entering_slip_load,
            friction_power: o.friction_power,
            damping_power: o.damping_power,
            friction_torque: o.friction_torque,
            losses: o.losses,
            torque_power: o.torque_power,
            stored_energy: o.stored_energy,
            power_per_ball: Race::BOTH.map(power),
            between_balls: o.neighbours.map_or(0.0, |neighbours| neighbours.largest_load),
            peak_pressure: Race::BOTH.map(pressure),
        }
    }
}
