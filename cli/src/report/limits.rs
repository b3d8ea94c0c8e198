//! Limits of a bearing that a run met: pressure, and what effects tell of.

use std::collections::BTreeMap;

use roulement::effects::LIMITS;
use roulement::effects::full_complement::BETWEEN_BALLS;
use roulement::effects::limits::{Limit, Quantity};
use roulement::simulation::instant::Instant;
use roulement::simulation::outputs::Outputs;

/// Largest values over a run.
#[derive(Clone, Debug, Default)]
pub struct Limits {
    /// \[Pa] peak pressure of a contact.
    pub peak_pressure: f64,
    /// \[unit] largest values of the quantities of all limits, by their names.
    largest: BTreeMap<&'static str, f64>,
}

impl Limits {
    /// Takes where a step has ended.
    pub fn step(&mut self, instant: &Instant) {
        self.peak_pressure = instant.peak_pressure.into_iter().fold(self.peak_pressure, f64::max);
        self.raise(BETWEEN_BALLS, instant.between_balls);
    }

    /// Takes a row.
    pub fn push(&mut self, outputs: &Outputs) {
        let contacts = outputs.balls.iter().flat_map(|ball| [&ball.inner, &ball.outer]);
        self.peak_pressure = contacts.map(|contact| contact.peak_pressure).fold(self.peak_pressure, f64::max);
        let reports = outputs.reports();
        quantities().for_each(|quantity| self.raise(quantity.name, (quantity.get)(&reports)));
    }

    fn raise(&mut self, name: &'static str, value: f64) {
        let largest = self.largest.entry(name).or_default();
        *largest = largest.max(value);
    }

    /// \[unit] largest value of a quantity.
    fn of(&self, quantity: &Quantity) -> f64 {
        self.largest.get(quantity.name).copied().unwrap_or(0.0)
    }

    /// Quantities of all limits with their largest values.
    pub fn all(&self) -> impl Iterator<Item = (&'static Quantity, f64)> + '_ {
        quantities().map(|quantity| (quantity, self.of(quantity)))
    }

    /// Limits that were met.
    pub fn met(&self) -> impl Iterator<Item = &'static Limit> + '_ {
        LIMITS.into_iter().filter(|limit| limit.quantities.iter().any(|quantity| self.of(quantity) > 0.0))
    }

    /// Warnings, a sentence each.
    pub fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        let met = self.all().filter(|(_, largest)| *largest > 0.0);
        met.filter_map(|(quantity, largest)| quantity.warning.map(|warning| warning(largest)))
    }
}

fn quantities() -> impl Iterator<Item = &'static Quantity> {
    LIMITS.into_iter().flat_map(|limit| limit.quantities)
}
