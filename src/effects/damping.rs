//! Damping of the ball-race contacts ([`crate::contact::normal`]).

use super::effect::{Effect, Info};
use super::keys::keys;
use crate::schema::numbers::{DISSIPATION, Number, Place};
use crate::schema::units::DissipationFactor;

keys! {
    /// [s/m] Hunt-Crossley dissipation factor; 0 is off.
    "damping" => factor: DissipationFactor = DissipationFactor(0.0),
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.damping",
        adds: "loss of energy in the normal contacts of balls and races by their approach rate",
        states: "none",
        source: "Hunt and Crossley 1975",
        price: "below 1 % of a step",
        example: "[effects]\ndamping = \"0.02 s/m\"\n",
    };

    const NUMBERS: &'static [Number<Self>] = &[Number::tunable(
        "effects.damping",
        DISSIPATION,
        "dissipation factor of the contacts (Hunt-Crossley)",
        |s| Place::Value(Some(&mut s.factor.0)),
    )];

    fn setting(&self) -> Option<String> {
        (self.factor.0 != 0.0).then(|| format!("{} s/m", self.factor.0))
    }
}
