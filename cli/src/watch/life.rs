//! Rating life under what a window of a run has seen.

use std::f64::consts::TAU;

use roulement::effects::rating::Sums;
use roulement::effects::reports::LifeOutput;
use roulement::model::Model;

/// The rating life under what a window of a run has seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Life {
    /// In million revolutions, with all that goes with it.
    pub life: LifeOutput,
    /// \[h] reference life at the mean speed of the window; none where nothing turns.
    pub hours: Option<f64>,
    /// \[h] modified life.
    pub modified_hours: Option<f64>,
}

impl Life {
    /// Names, units and values of its numbers, for the table of means.
    pub fn numbers(&self) -> Vec<(&'static str, &'static str, f64)> {
        let Self { life, hours, modified_hours } = self;
        let all = [
            ("life L10r", "1e6", Some(life.reference)),
            ("life L10r in hours", "h", *hours),
            ("modified life", "1e6", life.modified),
            ("modified life in hours", "h", *modified_hours),
            ("equivalent load", "N", Some(life.equivalent_load)),
            ("static safety", "1", Some(life.static_safety)),
        ];
        all.into_iter().filter_map(|(name, unit, value)| Some((name, unit, value?))).collect()
    }

    /// Under what was seen.
    pub fn of(sums: &Sums, model: &Model) -> Option<Self> {
        let life = model.rating.as_ref()?.after(sums);
        let speed = sums.speed().filter(|speed| *speed > 0.0);
        let hours = |million: f64| speed.map(|speed| million * 1e6 * TAU / speed / 3600.0);
        Some(Self { life, hours: hours(life.reference), modified_hours: life.modified.and_then(hours) })
    }

    /// Over a window \[s], from what was seen up to times \[s].
    pub fn over(window: [f64; 2], rated: &[(f64, Sums)], model: &Model) -> Option<Self> {
        let (_, end) = rated.last()?;
        let before = rated.iter().rev().find(|(time, _)| *time <= window[0]).unwrap_or(&rated[0]);
        Self::of(&end.since(&before.1), model)
    }
}
