//! Report of the heat of friction by the part that it goes into: means since the last communication point.
//!
//! All that [`losses`](crate::simulation::losses) has, but for contact damping and dampers of supports. Half of what a contact loses goes into each of both surfaces: they are of like materials, and pass through the contact alike.

use super::reports::HeatOutput;
use serde::{Deserialize, Serialize};

use super::effect::{Effect, Getter, Info, Row};
use super::keys::keys;
use super::since::{Numbers, Since};
use crate::schema::variable_units::WATT;

keys! {
    /// Is the heat of friction reported by part (`heat.*`)?
    "heat_outputs" => on: bool = false,
}

/// Powers by what they are lost to: friction on the inner and on the outer race, in pockets, on lands, of balls among themselves; drag.
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

impl Numbers for ByContact {
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

/// \[J] energies since the start.
pub type Sums = Since<ByContact>;

/// \[W] mean powers by the part that they heat; `guide` is the race that guides the cage: 0 the inner, 1 the outer one.
pub fn by_part(mean: &ByContact, guide: Option<usize>) -> HeatOutput {
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

/// Row that is reported beside the heat of friction where a medium is around the balls.
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
