//! Report of means since the last communication point: over the steps and over time, of what swings faster than an importer asks.

use super::effect::{Effect, Getter, Info, Row};
use super::keys::keys;
use super::reports::{Averaged, OfRace};
use super::since::{Numbers, Since};
use crate::schema::variable_units::{NEWTON, NEWTON_METRE, RADIAN_PER_SECOND, Unit, WATT};

keys! {
    /// Are means since the last communication point reported (`mean.*`)?
    "mean_outputs" => on: bool = false,
}

impl Numbers for Averaged {
    fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let race = |race: usize| {
            let (one, other) = (&self.races[race], &other.races[race]);
            OfRace {
                force: [0, 1, 2].map(|i: usize| f(one.force[i], other.force[i])),
                moment: [0, 1, 2].map(|i: usize| f(one.moment[i], other.moment[i])),
                drive_torque: f(one.drive_torque, other.drive_torque),
            }
        };
        Self {
            races: [race(0), race(1)],
            friction: f(self.friction, other.friction),
            lost: f(self.lost, other.lost),
            cage_speed: f(self.cage_speed, other.cage_speed),
        }
    }
}

/// Integrals since the start.
pub type Sums = Since<Averaged>;

fn row(
    name: &str,
    (unit, nominal): (Unit, f64),
    what: &str,
    get: impl Fn(&Averaged) -> f64 + Send + Sync + 'static,
) -> Row {
    Row {
        name: format!("mean.{name}"),
        unit,
        nominal,
        description: format!("{what}, mean since the last communication point"),
        get: Getter::new(move |reports| reports.means.map_or(0.0, &get)),
    }
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.mean_outputs",
        adds: "report of forces, moments, torques, losses and cage speed as means between communication points",
        states: "their integrals",
        source: "trapezoidal rule over the steps, as energies",
        price: "1.4 % of a step (thrust case)",
        example: "[effects]\nmean_outputs = true\n",
    };

    fn setting(&self) -> Option<String> {
        self.on.then(|| "on".into())
    }

    fn rows(&self) -> Vec<Row> {
        if !self.on {
            return vec![];
        }
        let mut rows = vec![];
        for (race, name) in ["inner", "outer"].into_iter().enumerate() {
            for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
                let what =
                    format!("force that the bearing exerts on the {name} race, {axis} component, world axes");
                rows.push(row(&format!("{name}.force.{axis}"), (NEWTON, 1000.0), &what, move |o| {
                    o.races[race].force[i]
                }));
            }
            for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
                let what = format!(
                    "moment that the bearing exerts on the {name} race, {axis} component, world axes"
                );
                let of = (NEWTON_METRE, 1.0);
                rows.push(row(&format!("{name}.moment.{axis}"), of, &what, move |o| o.races[race].moment[i]));
            }
            let what = format!("torque that keeps the {name} race at its prescribed speed");
            let of = (NEWTON_METRE, 0.1);
            rows.push(row(&format!("{name}.drive_torque"), of, &what, move |o| o.races[race].drive_torque));
        }
        let lost = "all power that the bearing loses";
        rows.push(row("friction_power", (WATT, 1.0), "power lost to friction in all contacts", |o| {
            o.friction
        }));
        rows.push(row("loss.total", (WATT, 1.0), lost, |o| o.lost));
        let cage = "speed of the cage about its axis; without a cage, mean orbital speed of the balls";
        rows.push(row("cage.speed", (RADIAN_PER_SECOND, 100.0), cage, |o| o.cage_speed));
        rows
    }
}
