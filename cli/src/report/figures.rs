//! The figures of a summary by their names, and their error bars.

use std::borrow::Cow;
use std::collections::BTreeMap;

use roulement::model::bodies::Race;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::{BallOutput, Outputs};

use super::energy::EnergyWatch;
use super::limits::Limits;
use super::means::Means;
use crate::watch::phases::Phase;

/// Figures by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures(BTreeMap<Cow<'static, str>, f64>);

impl Figures {
    /// All figures of a run that has come to its end; those of means, too.
    pub fn of(simulation: &Simulation, means: Option<&Means>, limits: &Limits, energy: &EnergyWatch) -> Self {
        let now = simulation.outputs();
        let race = &now[Race::loaded(simulation.scene())];
        let (force, moment, position) = (race.wrench.force, race.wrench.moment, race.pose.position);
        let balls = |get: fn(&BallOutput) -> f64| {
            let values = now.balls.iter().map(get);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
        };
        let (inner, outer) = (balls(|b| b.inner.load), balls(|b| b.outer.load));
        let inner_angle = balls(|b| b.inner.contact_angle.to_degrees());
        let outer_angle = balls(|b| b.outer.contact_angle.to_degrees());
        let mut figures: Self = [
            ("end force.x", force.x),
            ("end force.y", force.y),
            ("end force.z", force.z),
            ("end moment.x", moment.x),
            ("end moment.y", moment.y),
            ("end moment.z", moment.z),
            ("end position.x", position.x),
            ("end position.y", position.y),
            ("end position.z", position.z),
            ("least inner load", inner.0),
            ("largest inner load", inner.1),
            ("least outer load", outer.0),
            ("largest outer load", outer.1),
            ("least inner angle", inner_angle.0),
            ("largest inner angle", inner_angle.1),
            ("least outer angle", outer_angle.0),
            ("largest outer angle", outer_angle.1),
            ("end eccentricity", eccentricity(now)),
            ("work", now.work),
            ("lost", now.dissipated),
            ("stored", now.stored_energy),
            ("balance", energy.balance(now)),
        ]
        .into_iter()
        .collect();
        limits.all().for_each(|(quantity, largest)| figures.set(quantity.name, largest));
        if let Some(means) = means {
            figures.add_means(means);
            let names = ["largest eccentricity", "largest pocket load", "largest land load"];
            names.into_iter().zip(means.largest).for_each(|(name, value)| figures.set(name, value));
        }
        figures
    }

    /// Takes all means by their names.
    pub fn add_means(&mut self, means: &Means) {
        self.0.extend(means.means.iter().map(|mean| (mean.name.clone(), mean.mean)));
    }

    /// Takes all means of a phase, by its name and theirs.
    pub fn add_phase(&mut self, phase: &Phase) {
        phase.means.means.iter().for_each(|mean| self.set(phase.figure(&mean.name), mean.mean));
    }

    /// A figure; not a number where it is not there.
    pub fn get(&self, name: &str) -> f64 {
        self.0.get(name).copied().unwrap_or(f64::NAN)
    }

    /// All of them with their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, f64)> {
        self.0.iter().map(|(name, value)| (name.as_ref(), *value))
    }

    /// Gives a figure another value.
    pub fn set(&mut self, name: impl Into<Cow<'static, str>>, value: f64) {
        self.0.insert(name.into(), value);
    }

    /// How far figures are from those of another run; what one of them does not have is left out.
    pub fn distance(&self, other: &Self) -> Self {
        let both = self.0.iter().filter_map(|(name, value)| Some((name.clone(), value - other.0.get(name)?)));
        Self(both.map(|(name, difference)| (name, difference.abs())).collect())
    }

    /// All of them times a factor.
    #[must_use]
    pub fn times(mut self, factor: f64) -> Self {
        self.0.values_mut().for_each(|value| *value *= factor);
        self
    }
}

impl FromIterator<(&'static str, f64)> for Figures {
    fn from_iter<I: IntoIterator<Item = (&'static str, f64)>>(figures: I) -> Self {
        Self(figures.into_iter().map(|(name, value)| (name.into(), value)).collect())
    }
}

/// \[m] the cage's centre off the axis.
fn eccentricity(now: &Outputs) -> f64 {
    now.cage.as_ref().map_or(0.0, |cage| cage.eccentricity.yz().norm())
}

/// Figures with their error bars, where they were measured.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// Figures.
    pub figures: Figures,
    /// Their error bars.
    pub bars: Option<Figures>,
}

impl Shown {
    /// A figure times a factor with so many digits, and its error bar.
    pub fn text(&self, name: &str, factor: f64, digits: usize) -> String {
        let value = self.figures.get(name) * factor;
        match self.bars.as_ref().map(|bars| bars.get(name) * factor) {
            Some(bar) => format!("{value:.digits$} (+- {bar:.1e})"),
            None => format!("{value:.digits$}"),
        }
    }
}
