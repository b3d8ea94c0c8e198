//! The numbers of a scene: a row each, with its range, where it stands, and whether a package offers it as an FMI
//! parameter. A key's range stands here alone; limits that depend on other keys are checked beside.

use super::error::SceneError;
use super::schedule::Schedule;

/// Bounds of a value; an open bound is not itself allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower bound.
    pub low: f64,
    /// Is the lower bound not allowed itself?
    pub low_open: bool,
    /// Upper bound, allowed.
    pub high: f64,
    /// SI unit.
    pub unit: &'static str,
    /// Are whole numbers allowed alone?
    pub whole: bool,
}

impl Range {
    /// Both bounds are allowed.
    pub const fn closed(low: f64, high: f64, unit: &'static str) -> Self {
        Self { low, low_open: false, high, unit, whole: false }
    }

    /// The lower bound is not allowed.
    pub const fn above(low: f64, high: f64, unit: &'static str) -> Self {
        Self { low, low_open: true, high, unit, whole: false }
    }

    /// Whole numbers, both bounds among them.
    pub const fn whole(low: f64, high: f64) -> Self {
        Self { low, low_open: false, high, unit: "", whole: true }
    }

    /// Is a value allowed? NaN never is.
    pub fn contains(&self, value: f64) -> bool {
        let above = if self.low_open { value > self.low } else { value >= self.low };
        above && value <= self.high && (!self.whole || value.fract() == 0.0)
    }

    /// Checks a value.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    pub fn check(&self, key: &str, value: f64) -> Result<(), SceneError> {
        if self.contains(value) {
            return Ok(());
        }
        Err(SceneError::Range { key: key.to_string(), value, unit: self.unit, range: self.to_string() })
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let bracket = if self.low_open { "(" } else { "[" };
        let space = if self.unit.is_empty() { "" } else { " " };
        let whole = if self.whole { "whole numbers in " } else { "" };
        write!(f, "{whole}{bracket}{}, {}]{space}{}", self.low, self.high, self.unit)
    }
}

/// A number in the four digits that a message has of what was computed, never as a power of ten but where it is very small or large.
pub fn four(value: &f64) -> String {
    let rounded = format!("{value:.3e}").parse().unwrap_or(*value);
    if rounded == 0.0 || (1e-4..1e6).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// Young's moduli.
pub const YOUNGS_MODULUS: Range = Range::closed(1e6, 1e13, "Pa");
/// Poisson's ratios.
pub const POISSON_RATIO: Range = Range::closed(0.0, 0.5, "");
/// Friction coefficients: no surface has a larger one.
pub const FRICTION: Range = Range::closed(0.0, 2.0, "");
/// Hunt-Crossley dissipation factors.
pub const DISSIPATION: Range = Range::closed(0.0, 10.0, "s/m");

/// When a parameter of a package may be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// Before the start only: the model is built from it.
    Fixed,
    /// Between communication steps too.
    Tunable,
}

/// A number of a scene that a package offers as an FMI parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Section and key, as in the scene file.
    pub key: &'static str,
    /// Allowed values; others may be narrower because of other keys.
    pub range: Range,
    /// When a package's importer may set it.
    pub variability: Variability,
    /// One sentence.
    pub description: &'static str,
    /// Its value in the scene.
    pub start: f64,
}

/// Where a number stands.
#[derive(Debug)]
pub enum Place<'a> {
    /// A number, if it was given.
    Value(Option<&'a mut f64>),
    /// A number over time.
    Schedule(&'a mut Schedule),
    /// Numbers that can only be read: several of one key, or of another type.
    Read(Vec<f64>),
}

impl<'a> Place<'a> {
    fn values(&self) -> Vec<f64> {
        match self {
            Self::Value(value) => value.iter().map(|value| **value).collect(),
            Self::Schedule(schedule) => schedule.values(),
            Self::Read(values) => values.clone(),
        }
    }

    /// The number itself, where there is one that can be set.
    fn value(self) -> Option<&'a mut f64> {
        match self {
            Self::Value(value) => value,
            Self::Schedule(schedule) => schedule.constant_mut(),
            Self::Read(_) => None,
        }
    }
}

/// A row: a number of `T`, which is a scene or the keys of an effect.
#[derive(Debug)]
pub struct Number<T: 'static> {
    /// Section and key, as in the scene file.
    pub key: &'static str,
    /// Allowed values.
    pub range: Range,
    place: fn(&mut T) -> Place<'_>,
    offer: Option<Offer<T>>,
}

/// How a package offers a number.
#[derive(Debug)]
struct Offer<T: 'static> {
    variability: Variability,
    description: &'static str,
    /// Does the scene make use of it?
    used: fn(&T) -> bool,
}

impl<T> Number<T> {
    /// A number that is checked, and that a package does not offer.
    pub const fn checked(key: &'static str, range: Range, place: fn(&mut T) -> Place<'_>) -> Self {
        Self { key, range, place, offer: None }
    }

    /// A parameter that the model is built from.
    pub const fn fixed(
        key: &'static str,
        range: Range,
        description: &'static str,
        place: fn(&mut T) -> Place<'_>,
    ) -> Self {
        Self::fixed_if(key, range, description, |_| true, place)
    }

    /// A parameter that the model is built from, offered where the scene makes use of it.
    pub const fn fixed_if(
        key: &'static str,
        range: Range,
        description: &'static str,
        used: fn(&T) -> bool,
        place: fn(&mut T) -> Place<'_>,
    ) -> Self {
        Self { key, range, place, offer: Some(Offer { variability: Variability::Fixed, description, used }) }
    }

    /// A parameter that each step reads.
    pub const fn tunable(
        key: &'static str,
        range: Range,
        description: &'static str,
        place: fn(&mut T) -> Place<'_>,
    ) -> Self {
        Self::tunable_if(key, range, description, |_| true, place)
    }

    /// A parameter that each step reads, offered where the scene makes use of it.
    pub const fn tunable_if(
        key: &'static str,
        range: Range,
        description: &'static str,
        used: fn(&T) -> bool,
        place: fn(&mut T) -> Place<'_>,
    ) -> Self {
        let offer = Offer { variability: Variability::Tunable, description, used };
        Self { key, range, place, offer: Some(offer) }
    }

    /// Checks all values that it has.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    pub fn check(&self, of: &mut T) -> Result<(), SceneError> {
        (self.place)(of).values().into_iter().try_for_each(|value| self.range.check(self.key, value))
    }

    /// As a parameter, where it is offered and given.
    pub fn parameter(&self, of: &mut T) -> Option<Parameter> {
        let Offer { variability, description, used } = self.offer.as_ref()?;
        let start = used(of).then(|| (self.place)(of).value()).flatten().copied()?;
        let (key, range) = (self.key, self.range);
        Some(Parameter { key, range, variability: *variability, description, start })
    }

    /// Its place, to be changed.
    pub fn value<'a>(&self, of: &'a mut T) -> Option<&'a mut f64> {
        (self.place)(of).value()
    }
}
