//! Elastic hysteresis of rolling: what the material of ball and race loses as it passes through the contact, dry or oiled.

use super::effect::{Effect, Getter, Info, Row};
use super::estimate::Estimate;
use super::keys::keys;
use super::losses::{ContactPower, Part};
use super::reports::BallOutput;
use super::twin::Twin;
use crate::contact::Resistance;
use crate::schema::variable_units::WATT;

keys! {
    /// Is elastic hysteresis of rolling simulated?
    "hysteresis" => on: bool = false,
}

/// [-] exponent of the load in the moment (Houpert 1999).
const EXPONENT: f64 = 1.33;

impl Settings {
    /// Moment against rolling of a contact: radius of a ball \[m], curvatures of ball and race together, along and across rolling
    /// [1/m] (Houpert 1999, for bearing steel). None where it is not simulated.
    pub fn resistance(&self, radius: f64, [along, across]: [f64; 2]) -> Resistance {
        let slender = (along / across - 1.0).max(0.0);
        let factor = match self.on {
            true => 7.48e-7 * radius.powf(0.33) * (1.0 - 3.519e-3 * slender.powf(0.8063)),
            false => 0.0,
        };
        Resistance { factor, exponent: EXPONENT }
    }
}

const KEY: &str = "effects.hysteresis";

/// Its power in a contact.
pub const POWER: ContactPower = ContactPower { name: "hysteresis", get: |contact| contact.resisting_power };

/// Its part of the losses.
pub const LOSS: Part = Part {
    name: "loss.hysteresis",
    description: "power lost to the hysteresis of rolling",
    words: "hysteresis of rolling",
    is_of: |effects| effects.hysteresis.on,
    get: |losses| losses.resisting,
};

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: KEY,
        adds: "elastic hysteresis of rolling: a moment against rolling in every contact of balls and races",
        states: "none",
        source: "Houpert 1999; for bearing steel",
        price: "24 % of a step (thrust case)",
        example: "[effects]\nhysteresis = true\n",
    };

    const ESTIMATE: &'static str = "settled states with and without it";

    fn twins(&self, _: &Estimate) -> Vec<Twin> {
        let on = self.on;
        let twin = Twin::new(KEY, "hysteresis", on, move |effects| effects.hysteresis.on = !on);
        vec![twin.written("[effects] hysteresis = true").automatic(Some(KEY))]
    }

    fn setting(&self) -> Option<String> {
        self.on.then(|| "on".into())
    }

    fn switch(&mut self, key: &str, on: bool) {
        if key == KEY {
            self.on = on;
        }
    }

    fn headlines(&self) -> &'static [&'static str] {
        &["power.hysteresis"]
    }

    fn rows(&self) -> Vec<Row> {
        let power = |ball: &BallOutput| ball.inner.resisting_power + ball.outer.resisting_power;
        let row = || {
            Row {
            name: "power.hysteresis".into(),
            unit: WATT,
            nominal: 1.0,
            description: "power lost to the hysteresis of rolling in all contacts with the races, part of the friction power".into(),
            get: Getter::new(move |reports| reports.balls.iter().map(power).fold(0.0, |sum, power| sum + power)),
        }
        };
        if self.on { vec![row()] } else { vec![] }
    }
}
