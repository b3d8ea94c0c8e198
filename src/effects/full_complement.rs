//! Report of the contacts of neighbouring balls ([`crate::contact::ball_ball`]), which act wherever there is no cage.

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::keys::keys;
use super::limits::{Limit, Quantity};
use super::per_ball::ball_row;
use super::reports::{BallOutput, NeighboursOutput};
use crate::schema::SceneError;
use crate::schema::variable_units::{METRE, NEWTON, ONE, Unit, WATT};

keys! {
    /// Are contacts of neighbouring balls reported (`neighbours.*`)? Balls without a cage touch all the same.
    "full_complement" => on: bool = false,
}

/// Limit of the loads between balls.
pub static LIMIT: Limit = Limit {
    title: "between balls",
    quantities: &[Quantity {
        name: BETWEEN_BALLS,
        column: "between_balls",
        unit: NEWTON,
        get: |reports| reports.neighbours.map_or(0.0, |neighbours| neighbours.largest_load),
        warning: None,
    }],
    shown: (1.0, 3),
    line: |largest| format!("up to {} N: they touch, as no cage keeps them apart", largest.concat()),
    subject: None,
};
/// Name of its quantity.
pub const BETWEEN_BALLS: &str = "between balls";

type FromNeighbours = fn(&NeighboursOutput) -> f64;
type FromBall = fn(&BallOutput) -> f64;

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.full_complement",
        adds: "report of the contacts of neighbouring balls, which act wherever there is no cage",
        states: "none",
        source: "Hertz 1882, two equal spheres; Coulomb friction",
        price: "none in a step",
        example: "[effects]\nfull_complement = true\n",
    };

    fn setting(&self) -> Option<String> {
        self.on.then(|| "on".into())
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        let given = [
            ("effects.full_complement", self.on),
            ("friction.ball_ball", setup.friction.ball_ball.is_some()),
        ];
        match given.into_iter().find(|(_, given)| *given && setup.kept_apart) {
            Some((key, _)) => {
                let why = "allowed without effects.cage only: a cage keeps the balls apart";
                Err(SceneError::conflict(key, why))
            }
            None => Ok(()),
        }
    }

    fn rows(&self) -> Vec<Row> {
        let quantities: [(&str, Unit, f64, &str, FromNeighbours); 4] = [
            ("touching", ONE, 1.0, "pairs of neighbouring balls that touch", |n| n.touching as f64),
            ("largest_load", NEWTON, 10.0, "largest normal load between two balls", |n| n.largest_load),
            ("gap", METRE, 1e-4, "smallest gap between neighbouring balls (negative is an approach)", |n| {
                n.gap
            }),
            ("power", WATT, 1.0, "power lost to friction between balls", |n| n.power),
        ];
        let row = |(name, unit, nominal, what, get): (&str, Unit, f64, &str, FromNeighbours)| {
            let get = Getter::new(move |reports| reports.neighbours.map_or(0.0, get));
            Row { name: format!("neighbours.{name}"), unit, nominal, description: what.into(), get }
        };
        if self.on { quantities.into_iter().map(row).collect() } else { vec![] }
    }

    fn ball_rows(&self, ball: usize) -> Vec<Row> {
        let quantities: [(&str, &str, FromBall); 4] = [
            ("load", "largest normal load", |b| b.neighbours_load),
            ("force.x", "force on the ball, x component, world axes,", |b| b.neighbours_force.x),
            ("force.y", "force on the ball, y component, world axes,", |b| b.neighbours_force.y),
            ("force.z", "force on the ball, z component, world axes,", |b| b.neighbours_force.z),
        ];
        let row = |(name, what, get): (&str, &str, FromBall)| {
            let description = format!("{what} of ball {} and its neighbours", ball + 1);
            ball_row(ball, &format!("neighbours.{name}"), NEWTON, 10.0, description, get)
        };
        if self.on { quantities.into_iter().map(row).collect() } else { vec![] }
    }
}
