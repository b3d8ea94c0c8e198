//! Effects that a scene asks to be found out: those that matter by their estimates, and that have all the data they need.
//!
//! The estimates need an equilibrium, so that [`crate::analysis::auto`] does it; here are the keys. `effects = "auto"` is short for
//! a section with `auto = true` alone.

use super::effect::{Effect, Info};
use super::estimate::THRESHOLD;
use super::keys::keys;
use crate::schema::numbers::{Number, Place, Range};

keys! {
    /// Are effects to be switched on where they matter?
    "auto" => on: bool = false,
    /// [-] share above which an effect matters; also for estimates that switch nothing.
    "auto_threshold" => given_threshold: Option<f64> = None,
    /// Findings, a sentence each, where it is done: the program writes it.
    "auto_found" => found: Vec<String> = vec![],
    ;
    /// Keys of `[effects]` that the scene has: they stay as they are.
    given: Vec<&'static str> = vec![],
}

impl Settings {
    /// [-] share above which an effect matters.
    pub fn threshold(&self) -> f64 {
        self.given_threshold.unwrap_or(THRESHOLD)
    }
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.auto",
        adds: "effects that matter by their estimates and have all the data they need",
        states: "none",
        source: "estimates of every effect (docs/effects.md)",
        price: "one equilibrium at the start",
        example: "[effects]\nauto = true\n",
    };

    const NUMBERS: &'static [Number<Self>] =
        &[Number::checked("effects.auto_threshold", Range::above(0.0, 1.0, ""), |s| {
            Place::Value(s.given_threshold.as_mut())
        })];

    fn setting(&self) -> Option<String> {
        self.on.then(|| format!("beyond {} %", 100.0 * self.threshold()))
    }
}
