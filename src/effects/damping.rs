//! Damping of the ball-race contacts ([`crate::contact::normal`]): a factor, or what it follows from.
//!
//! Every Hunt-Crossley law is the same force with another factor chi. A contact struck at a speed `v0` and left at `e v0` has, exactly,
//! `x - ln(1 + x) = -e x - ln(1 - e x)` with `x = chi v0`: the equation of motion of a nonlinear spring integrated once. Published laws
//! approximate the root, some badly: asked for e = 0.6, that of Hunt and Crossley gives 0.712, that of Lee and Wang 0.833.

use serde::Deserialize;
use serde::de::{Deserializer, Error};

use super::Effects;
use super::effect::{Effect, Info};
use super::keys::keys;
use super::losses::Part;
use crate::contact::normal::Damping;
use crate::schema::numbers::{DISSIPATION, Number, Place, Range};
use crate::schema::reader::{self, ReadError};
use crate::schema::units::{DissipationFactor, Time, Velocity};

const RESTITUTION: Range = Range::closed(0.01, 1.0, "");
const IMPACT: Range = Range::above(0.0, 100.0, "m/s");
const RETARDATION: Range = Range::closed(0.0, 1e-3, "s");

/// How the factor follows from a restitution: exactly, or by a published law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RestitutionLaw {
    /// The root of the exact equation.
    #[default]
    Exact,
    /// Hunt and Crossley 1975.
    HuntCrossley,
    /// Herbert and McWhannell 1977.
    HerbertMcwhannell,
    /// Lee and Wang 1983.
    LeeWang,
    /// Lankarani and Nikravesh 1990.
    LankaraniNikravesh,
    /// Gonthier and others 2004.
    Gonthier,
    /// Flores and others 2011.
    Flores,
    /// Hu and Guo 2015.
    HuGuo,
}

impl RestitutionLaw {
    /// [-] dissipation factor times impact speed for a restitution e in (0, 1]; names after Machado and others 2012.
    pub fn factor(self, e: f64) -> f64 {
        match self {
            Self::Exact => exact(e),
            Self::HuntCrossley => 1.5 * (1.0 - e),
            Self::HerbertMcwhannell => 6.0 * (1.0 - e) / ((2.0 * e - 1.0).powi(2) + 3.0),
            Self::LeeWang => 0.75 * (1.0 - e),
            Self::LankaraniNikravesh => 0.75 * (1.0 - e * e),
            Self::Gonthier => (1.0 - e * e) / e,
            Self::Flores => 1.6 * (1.0 - e) / e,
            Self::HuGuo => 1.5 * (1.0 - e) / e,
        }
    }
}

/// [-] `x` of `x - ln(1 + x) = -e x - ln(1 - e x)`, between 0 and `1/e`.
fn exact(e: f64) -> f64 {
    let lost = 1.0 - e;
    if lost < 1e-3 {
        // Both sides as series, over x^2: (1 - e^2)/2 - (1 + e^3) x/3 + (1 - e^4) x^2/4 - (1 + e^5) x^3/5
        let mut x = 1.5 * lost;
        for _ in 0..20 {
            let rest = (1.0 - e.powi(4)) * x * x / 4.0 - (1.0 + e.powi(5)) * x * x * x / 5.0;
            x = 3.0 * (0.5 * lost * (1.0 + e) + rest) / (1.0 + e.powi(3));
        }
        return x;
    }
    let excess = |x: f64| x - x.ln_1p() + e * x + (-e * x).ln_1p();
    let (mut low, mut high) = (0.0, 1.0 / e);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        // At the upper end the logarithm is minus infinity, or no number.
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Given quantity of the damping.
#[derive(Clone, Copy, Debug)]
pub enum Given {
    /// [s/m] Hunt-Crossley dissipation factor; 0 is off.
    Factor(DissipationFactor),
    /// Restitution at an impact speed.
    Restitution(RestitutionSection),
    /// \[s] retardation time of the material.
    Retardation(Time),
}

/// A restitution and what it holds for.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestitutionSection {
    /// [-] speed after an impact over that before it.
    pub restitution: f64,
    /// [m/s] speed before it.
    pub at: Velocity,
    /// How the factor follows.
    #[serde(default)]
    pub law: RestitutionLaw,
}

/// Viscoelastic bodies.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RetardationSection {
    /// \[s] retardation time: a contact has the elastic load that its approach would have after that time.
    retardation_time: Time,
}

impl<'de> Deserialize<'de> for Given {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(deserializer)?;
        let wrong = |why: ReadError| D::Error::custom(why.message());
        match &value {
            toml::Value::Table(table) if table.contains_key("retardation_time") => {
                let section = reader::read::<RetardationSection>(&value).map_err(wrong)?;
                Ok(Self::Retardation(section.retardation_time))
            }
            toml::Value::Table(_) => reader::read(&value).map(Self::Restitution).map_err(wrong),
            _ => reader::read(&value).map(Self::Factor).map_err(wrong),
        }
    }
}

keys! {
    /// Damping as it is given: a factor [s/m], `{ restitution, at, law }` or `{ retardation_time }`.
    "damping" => given: Given = Given::Factor(DissipationFactor(0.0)),
}

impl Settings {
    /// Law of damping that contacts read.
    pub fn law(&self) -> Damping {
        match self.given {
            Given::Factor(factor) => Damping::HuntCrossley(factor.0),
            Given::Restitution(RestitutionSection { restitution, at, law }) => {
                Damping::HuntCrossley(law.factor(restitution) / at.0)
            }
            Given::Retardation(time) => Damping::Viscoelastic(time.0),
        }
    }

    /// [s/m] dissipation factor of contacts that have no other; 0 with a retardation time, which is of the steel of balls and races.
    pub fn factor(&self) -> f64 {
        match self.law() {
            Damping::HuntCrossley(factor) => factor,
            Damping::Viscoelastic(_) => 0.0,
        }
    }
}

fn restitution(settings: &mut Settings) -> Option<&mut RestitutionSection> {
    match &mut settings.given {
        Given::Restitution(section) => Some(section),
        _ => None,
    }
}

/// Do contacts have dampers, those of a cage included?
fn damps(effects: &Effects) -> bool {
    let cage = effects.cage.section.as_ref().and_then(|cage| cage.damping);
    effects.damping.setting().is_some() || cage.is_some_and(|factor| factor.0 > 0.0)
}

/// Its part of the losses.
pub const LOSS: Part = Part {
    name: "loss.damping",
    description: "power lost to damping of all contacts",
    words: "damping of contacts",
    is_of: damps,
    get: |losses| losses.damping,
};

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.damping",
        adds: "loss of energy in the normal contacts of balls and races by their approach rate",
        states: "none",
        source: "Hunt and Crossley 1975; restitution exact, or by laws after Machado and others 2012; Kuwabara and Kono 1987",
        price: "below 1 % of a step",
        example: "[effects]\ndamping = \"0.02 s/m\"\n",
    };

    const NUMBERS: &'static [Number<Self>] = &[
        Number::tunable(
            "effects.damping",
            DISSIPATION,
            "dissipation factor of the contacts (Hunt-Crossley)",
            |s| {
                Place::Value(match &mut s.given {
                    Given::Factor(factor) => Some(&mut factor.0),
                    _ => None,
                })
            },
        ),
        Number::tunable(
            "effects.damping.restitution",
            RESTITUTION,
            "restitution of an impact of a ball on a race",
            |s| Place::Value(restitution(s).map(|section| &mut section.restitution)),
        ),
        Number::tunable("effects.damping.at", IMPACT, "speed of the impact that has the restitution", |s| {
            Place::Value(restitution(s).map(|section| &mut section.at.0))
        }),
        Number::tunable(
            "effects.damping.retardation_time",
            RETARDATION,
            "retardation time of the contacts (viscoelastic)",
            |s| {
                Place::Value(match &mut s.given {
                    Given::Retardation(time) => Some(&mut time.0),
                    _ => None,
                })
            },
        ),
    ];

    fn setting(&self) -> Option<String> {
        match self.given {
            Given::Factor(factor) => (factor.0 != 0.0).then(|| format!("{} s/m", factor.0)),
            Given::Restitution(RestitutionSection { restitution, at, law }) => Some(format!(
                "restitution {restitution} at {} m/s ({law:?}), {:.3e} s/m",
                at.0,
                self.factor()
            )),
            Given::Retardation(time) => (time.0 != 0.0).then(|| format!("retardation time {} s", time.0)),
        }
    }
}
