//! Slip of grooves that bend across rolling ([`crate::contact::heathcote`]), with the laws that saturate.

use super::creep::CreepLaw;
use super::effect::{Effect, Getter, Info, Row, Setup};
use super::estimate::Estimate;
use super::keys::keys;
use super::losses::ContactPower;
use super::reports::BallOutput;
use super::twin::Twin;
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

/// Its power in a contact.
pub const POWER: ContactPower = ContactPower { name: "groove", get: |contact| contact.groove_power };

/// What it changes that a settled state does not have.
const TURNING: &str =
    "without how balls come to their axes, by which it changed the torque in a run by 1.3 %";

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: KEY,
        adds: "slip across contacts that are bent with the groove, and its friction",
        states: "none",
        source: "Heathcote 1921; Johnson 1985, section 8.5",
        price: "69 % of a step (thrust case)",
        example: "[effects]\nheathcote_slip = true\n",
    };
    const ESTIMATE: &'static str = "settled states with and without it; with a cage it matters always";

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

    fn twins(&self, estimate: &Estimate) -> Vec<Twin> {
        let on = self.on;
        let write = if estimate.saturates {
            "[effects] heathcote_slip = true"
        } else {
            "[effects] heathcote_slip = true, with a creep law that saturates"
        };
        // What does not saturate has none: the twin has the law that does.
        let saturates = estimate.saturates;
        let twin = Twin::new(KEY, "groove slip", on, move |effects| {
            effects.groove_slip.on = !on;
            if !on && !saturates {
                effects.creep.law = CreepLaw::default();
            }
        });
        // Changes of 0.4 % leave scenes/cage.toml with 62 W of losses, and 72 W without.
        let caged = if estimate.caged {
            "; and it changes how balls push the cage, which has no part in this"
        } else {
            ""
        };
        // It changes how balls come to their axes, too: 0.2 % of a settled torque went with 1.3 % in a run.
        vec![
            Twin { always_matters: estimate.caged, unsettled: Some(TURNING), ..twin.remarked(caged) }
                .written(write)
                .automatic(estimate.saturates.then_some(KEY)),
        ]
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
