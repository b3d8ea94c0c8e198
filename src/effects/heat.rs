//! Report of the heat of friction by the part that it goes into: means since the last communication point.
//!
//! All that [`losses`](crate::simulation::losses) has, but for contact damping and dampers of supports. Half of what a contact loses goes into each of both surfaces: they are of like materials, and pass through the contact alike.

use super::reports::HeatOutput;
use serde::{Deserialize, Serialize};

use super::effect::{Effect, Getter, Info, Row};
use super::keys::keys;
use crate::schema::variable_units::WATT;

keys! {
    /// Is the heat of friction reported by part (`heat.*`)?
    "heat_outputs" => on: bool = false,
}

/// What power is lost to: friction on the inner and on the outer race, in pockets, on lands, of balls among themselves; drag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ByContact {
    /// Balls on the inner and on the outer race.
    pub races: [f64; 2],
    /// Balls in their pockets.
    pub pockets: f64,
    /// Cage on the lands of its guide.
    pub lands: f64,
    /// Balls among themselves.
    pub balls: f64,
    /// Balls in the medium around them.
    pub medium: f64,
}

impl ByContact {
    /// Number by number with another.
    fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            races: [0, 1].map(|race: usize| f(self.races[race], other.races[race])),
            pockets: f(self.pockets, other.pockets),
            lands: f(self.lands, other.lands),
            balls: f(self.balls, other.balls),
            medium: f(self.medium, other.medium),
        }
    }
}

/// Energies since the start, and where they were at the last communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sums {
    /// \[W] powers now.
    powers: ByContact,
    /// \[J] energies.
    energies: ByContact,
    /// \[J] energies at the last communication point.
    marked: ByContact,
    /// \[s] time of that point.
    at: f64,
}

impl Sums {
    /// Takes the powers \[W] of this moment, at a time \[s] that no step has led to.
    pub fn begin(&mut self, powers: ByContact, time: f64) {
        self.powers = powers;
        self.mark(time);
    }

    /// Adds a step of `h` \[s] by the trapezoidal rule, as the energy balance does.
    pub fn add(&mut self, powers: ByContact, h: f64) {
        let mean = self.powers.zip(&powers, |before, now| 0.5 * h * (before + now));
        self.energies = self.energies.zip(&mean, |sum, step| sum + step);
        self.powers = powers;
    }

    /// From here on, at a time \[s], means are taken.
    pub fn mark(&mut self, time: f64) {
        (self.marked, self.at) = (self.energies, time);
    }

    /// The same from where others were at a time \[s] before this.
    pub fn mark_as(&mut self, then: &Self, time: f64) {
        (self.marked, self.at) = (then.energies, time);
    }

    /// \[W] mean powers since the last communication point, at a time \[s]; powers of this moment where that is now. `guide` is
    /// the race that guides the cage: 0 the inner, 1 the outer one.
    pub fn output(&self, time: f64, guide: Option<usize>) -> HeatOutput {
        let duration = time - self.at;
        let mean = if duration > 0.0 {
            self.energies.zip(&self.marked, |now, then| (now - then) / duration)
        } else {
            self.powers
        };
        let on_race =
            |race: usize| 0.5 * mean.races[race] + if guide == Some(race) { 0.5 * mean.lands } else { 0.0 };
        HeatOutput {
            inner: on_race(0),
            outer: on_race(1),
            balls: 0.5 * (mean.races[0] + mean.races[1] + mean.pockets) + mean.balls,
            cage: 0.5 * (mean.pockets + mean.lands),
            medium: mean.medium,
        }
    }
}

type FromHeat = fn(&HeatOutput) -> f64;

fn row(of: &str, (name, part, get): (&str, &str, FromHeat)) -> Row {
    Row {
        name: format!("heat.{name}"),
        unit: WATT,
        nominal: 1.0,
        description: format!("{of} that goes into {part}, mean since the last communication point"),
        get: Getter::new(move |reports| reports.heat.map_or(0.0, get)),
    }
}

/// What is reported beside the heat of friction where a medium is around the balls.
pub fn row_of_medium() -> Row {
    row("heat of drag", ("medium", "the medium around the balls", |heat| heat.medium))
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.heat_outputs",
        adds: "report of the heat of friction that goes into races, balls and cage, as means between communication points",
        states: "energies lost to friction, by contact",
        source: "energy balance of the contacts; half of a contact's heat to each surface",
        price: "0.5 % of a step (thrust case)",
        example: "[effects]\nheat_outputs = true\n",
    };

    fn setting(&self) -> Option<String> {
        self.on.then(|| "on".into())
    }

    fn rows(&self) -> Vec<Row> {
        let parts: [(&str, &str, FromHeat); 4] = [
            ("inner", "the inner race", |heat| heat.inner),
            ("outer", "the outer race", |heat| heat.outer),
            ("balls", "the balls", |heat| heat.balls),
            ("cage", "the cage", |heat| heat.cage),
        ];
        let of = "heat of friction";
        if self.on { parts.into_iter().map(|part| row(of, part)).collect() } else { vec![] }
    }
}
