//! Slip of grooves that bend across rolling ([`crate::contact::heathcote`]), with the laws that saturate.

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::estimate::{Estimate, Verdict, digits, percent};
use super::keys::keys;
use super::reports::BallOutput;
use super::sliding::{powers_alone, powers_together};
use crate::schema::SceneError;
use crate::schema::variable_units::WATT;

keys! {
    /// Is the slip of contacts that are bent with the groove simulated? With the default creep law by default; a scene that names its law has it where it says so.
    "heathcote_slip" => on: bool = true,
}

impl Settings {
    /// [1/m] mean transverse curvature of a ball and its groove over 2, from their radii \[m], where the slip is simulated.
    pub fn bend(&self, ball_radius: f64, groove_radius: f64) -> Option<f64> {
        self.on.then_some(0.25 * (1.0 / ball_radius + 1.0 / groove_radius))
    }
}

const KEY: &str = "effects.heathcote_slip";

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: KEY,
        adds: "slip across contacts that are bent with the groove, and its friction",
        states: "none",
        source: "Heathcote 1921; Johnson 1985, section 8.5",
        price: "69 % of a step (thrust case)",
        example: "[effects]\nheathcote_slip = true\n",
    };
    const ESTIMATE: &'static str =
        "part of the power of complete sliding that it adds, spin and groove slip acting together";

    fn setting(&self) -> Option<String> {
        self.on.then(|| "on".into())
    }

    fn rows(&self) -> Vec<Row> {
        if !self.on {
            return vec![];
        }
        let what =
            "power of the slip of bent grooves in all contacts with the races, part of their friction power";
        let of_ball = |ball: &BallOutput| ball.inner.groove_power + ball.outer.groove_power;
        vec![Row {
            name: "power.groove".into(),
            unit: WATT,
            nominal: 1.0,
            description: what.into(),
            get: Getter::new(move |reports| {
                reports.balls.iter().map(of_ball).fold(0.0, |sum, power| sum + power)
            }),
        }]
    }

    fn matters(&self, estimate: &Estimate) -> Vec<Verdict> {
        let [without, with] = powers_together(estimate);
        let share = if with > 0.0 { ((with - without) / with).max(0.0) } else { 0.0 };
        let [spin, groove] = powers_alone(estimate);
        let sentence = format!(
            "slip of bent grooves makes {}{} of the friction power; alone it would take {} W, and spin {} W{}",
            // Balls that friction does not hold turn, and lose power by that which is no part of the estimate.
            if estimate.gyroscopic() > 1.0 { "up to " } else { "" },
            percent(share),
            digits(groove),
            digits(spin),
            if estimate.caged {
                "; and it changes how balls push the cage, which has no part in this"
            } else {
                ""
            }
        );
        let write = if estimate.saturates {
            "[effects] heathcote_slip = true"
        } else {
            "[effects] heathcote_slip = true, with a creep law that saturates"
        };
        // With a share of 0.4 % scenes/cage.toml loses 62 W, and 72 W without.
        let threshold = if estimate.caged { 0.0 } else { estimate.threshold };
        let verdict = Verdict::share(KEY, "groove slip", self.on, (share, threshold), sentence);
        vec![verdict.written(write).automatic(estimate.saturates.then_some(KEY))]
    }

    fn switch(&mut self, key: &str, on: bool) {
        if key == KEY {
            self.on = on;
        }
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        if self.on && !setup.saturates {
            let why = "needs a creep law that saturates: regularised, saturated, kalker_table or kalker";
            return Err(SceneError::conflict(KEY, why));
        }
        Ok(())
    }
}
