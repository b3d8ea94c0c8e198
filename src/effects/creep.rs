//! Creep law of the ball-race contacts ([`crate::contact::creep`]).

use serde::Deserialize;
use strum::{EnumMessage, EnumString, IntoStaticStr, VariantArray};

use super::effect::{Effect, Info, Setup};
use super::keys::keys;
use crate::contact::regularised::Parameters;
use crate::schema::SceneError;
use crate::schema::numbers::{Number, Place, Range};

/// Creep laws, from the poorest to the richest: the one list, of which scenes, the program, Python and cost studies take names and
/// meanings.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Deserialize,
    EnumMessage,
    EnumString,
    IntoStaticStr,
    VariantArray,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum CreepLaw {
    /// No tangential force; normal contacts and the Newton matrix remain, more than half the cost of a step.
    Frictionless,
    /// Kalker's linear theory, unbounded.
    Linear,
    /// The paper's regularised law with spin coupling.
    Regularised,
    /// The regularised law without that coupling, with which the paper's run starts.
    Uncoupled,
    /// Linear theory, saturated as a vector.
    Saturated,
    /// Kalker's nonlinear theory in polynomials of degree `kalker_degree`: slow.
    Kalker,
    /// Kalker's nonlinear theory as a smooth table.
    #[default]
    KalkerTable,
}

impl CreepLaw {
    /// Is its force bounded by friction, and not always zero?
    pub fn saturates(self) -> bool {
        !matches!(self, Self::Frictionless | Self::Linear)
    }

    /// Share of friction that this law misses, with or without the slip of bent grooves (docs/creep-laws.md); nothing of the
    /// default.
    pub fn misses(self, groove_slip: bool) -> Option<&'static str> {
        match (self, groove_slip) {
            (Self::KalkerTable | Self::Kalker, true) => None,
            (Self::Frictionless, _) => {
                Some("has no friction at all: no torque, no loss, and balls keep the spin of the start")
            }
            (Self::Linear, _) => Some(
                "has unbounded forces: right for small creepages alone, a run beyond friction is refused",
            ),
            (Self::KalkerTable | Self::Kalker, false) => Some(
                "misses the slip of bent grooves: a percent of the friction power under thrust, nearly all of it under a radial load",
            ),
            (Self::Uncoupled, true) => {
                Some("misses the lateral force of spin, and a sixth of the friction power under thrust")
            }
            (Self::Uncoupled, false) => Some(
                "misses the lateral force of spin, and a sixth of the friction power under thrust, nearly all of it under a radial load",
            ),
            (Self::Regularised | Self::Saturated, true) => {
                Some("has the friction power within 6 %, that of inner and outer race may be exchanged")
            }
            (Self::Regularised | Self::Saturated, false) => Some(
                "misses 3 to 21 % of the friction power under thrust, nearly all of it under a radial load; that of inner and outer race \
                 may be exchanged",
            ),
        }
    }
}

/// Parameters of the law `regularised` on each raceway; identified for its axis ratio where not given.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Regularised {
    /// On the inner raceway.
    pub inner: Option<Parameters>,
    /// On the outer raceway.
    pub outer: Option<Parameters>,
}

keys! {
    /// Creep law: friction of a rolling contact by its slip.
    "creep" => law: CreepLaw = CreepLaw::default(),
    /// [-] degree of the traction polynomials of the law `kalker`.
    "kalker_degree" => kalker_degree: usize = 3,
    /// [-] change of a contact's creepages, over those of sliding, after which the law `kalker` solves its polynomials
    /// anew; between, what they add to the table is frozen.
    "epsilon_switch" => epsilon_switch: f64 = 0.01,
    ;
    /// The section `[regularised]`.
    regularised: Regularised = Regularised::default(),
}

/// Values of one kind in the parameters of a raceway.
fn read(given: Option<Parameters>, of: impl Fn(&Parameters) -> Vec<f64>) -> Place<'static> {
    Place::Read(given.as_ref().map(of).unwrap_or_default())
}

const FITTED: Range = Range::closed(-1e6, 1e6, "");

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.creep",
        adds: "tangential force and spin moment of the ball-race contacts by their creepages",
        states: "none; the law kalker keeps what its polynomials add to the table at each contact",
        source: "Kalker 1967 and 1990; Bovet et al. 2013, section 3.1 and appendix A",
        price: "32 % of a step without friction (thrust case, saturated)",
        example: "[effects]\ncreep = \"saturated\"\n",
    };

    const NUMBERS: &'static [Number<Self>] = &[
        Number::checked("effects.kalker_degree", Range::closed(1.0, 7.0, ""), |s| {
            Place::Read(vec![s.kalker_degree as f64])
        }),
        Number::checked("effects.epsilon_switch", Range::closed(0.0, 1.0, ""), |s| {
            Place::Value(Some(&mut s.epsilon_switch))
        }),
        Number::checked("regularised.inner.eta", FITTED, |s| read(s.regularised.inner, |p| p.eta.to_vec())),
        Number::checked("regularised.inner.beta", FITTED, |s| read(s.regularised.inner, |p| p.beta.to_vec())),
        Number::checked("regularised.inner.alpha", FITTED, |s| {
            read(s.regularised.inner, |p| p.alpha.to_vec())
        }),
        Number::checked("regularised.outer.eta", FITTED, |s| read(s.regularised.outer, |p| p.eta.to_vec())),
        Number::checked("regularised.outer.beta", FITTED, |s| read(s.regularised.outer, |p| p.beta.to_vec())),
        Number::checked("regularised.outer.alpha", FITTED, |s| {
            read(s.regularised.outer, |p| p.alpha.to_vec())
        }),
    ];

    fn setting(&self) -> Option<String> {
        let law: &str = self.law.into();
        match self.law {
            CreepLaw::Frictionless => None,
            CreepLaw::Kalker => Some(format!("{law}, degree {}", self.kalker_degree)),
            _ => Some(law.into()),
        }
    }

    fn agree(&self, _: &Setup<'_>) -> Result<(), SceneError> {
        for (race, parameters) in [("inner", self.regularised.inner), ("outer", self.regularised.outer)] {
            let Some(Parameters { eta, beta, alpha, .. }) = parameters else { continue };
            // Denominators without a zero at positive arguments, so that every creepage has a force.
            let positive = |linear: f64, square: f64| square > 0.0 && linear > -2.0 * square.sqrt();
            if !(positive(eta[1], eta[2]) && positive(beta[1], beta[0]) && positive(alpha[1], alpha[2])) {
                let why = "a denominator vanishes: eta_1 > -2 sqrt(eta_2), beta_1 > -2 sqrt(beta_0) and \
                           alpha_1 > -2 sqrt(alpha_2) with eta_2, beta_0, alpha_2 > 0 are needed";
                return Err(SceneError::conflict(format!("regularised.{race}"), why));
            }
        }
        Ok(())
    }
}
