//! Effects on demand. One that is off has no state and no variables, and a step does not evaluate it.
//!
//! Work that an effect shares with others stays, though: a step without friction (`creep = "frictionless"`) still has the normal
//! contacts, their derivatives and the Newton matrix, which are 64 % of the instructions of a step with `saturated` under
//! prescribed races and 56 % with a race as a body (`scripts/measure step-cost`).
//!
//! Each has a file: the struct of its keys with units and defaults, what is told about it ([`Info`]), its
//! numbers with their ranges, its checks, its outputs, and what the model takes from it. To add one:
//!
//! 1. Write `src/effects/NAME.rs`: its keys of `[effects]` by the macro `keys!` (a section of many keys is one key whose type
//!    is a struct: `[effects.NAME]` in a scene; one that stands by itself, `[NAME]`, is a field of `Scene` that moves into
//!    `Settings` where a scene is read), and `impl Effect for Settings`.
//! 2. `INFO` says what it adds, which states it has, where it is from and what it costs; its `example` must start (`tests/effects/list.rs`).
//! 3. `NUMBERS` has a row per number: the range stands there alone, and makes it an FMI parameter if a package offers it.
//! 4. `agree` refuses keys that do not go together. What it has to know of the rest of the scene is in [`Setup`].
//! 5. `inputs` are what a master sets while it is on; their values join [`EffectInputs`]. `rows` and `ball_rows` are its outputs, empty while it is off; what they
//!    read joins [`Reports`]. A part of the
//!    losses is its `LOSS`, a power of contacts its `POWER`, a largest value that a run is told of its `LIMIT`: named once in [`LOSSES`],
//!    [`CONTACT_POWERS`] and [`LIMITS`] below, from which tables, summaries, warnings and pages have them.
//! 6. Add `pub mod NAME;` and the word `NAME` to the list below. Validation, variables, parameters and the page of a
//!    package come from that list. Value references follow its order: add at the end.
//! 7. The physics hangs on at most one hook: `Model` takes from `scene.effects.NAME` what a step reads, as an `Option`.
//! 8. `twins` says how it is taken in and out, with `ESTIMATE` in words: estimates compare settled states of both ([`twin`]), and
//!    `tests/effects/estimates.rs` compares that with runs. `matters` is for what has no settled state. `switch` is for effects that `effects.auto` can switch on.
//! 9. Everything that moves the balls must be in the equilibrium too, or a run starts with a bounce.

pub mod ambient;
pub mod auto;
pub mod cage;
pub mod creep;
pub mod damping;
pub mod defects;
pub mod film;
pub mod form;
pub mod frame;
pub mod full_complement;
pub mod gravity;
pub mod groove_slip;
pub mod growth;
pub mod heat;
pub mod heat_balance;
pub mod hysteresis;
mod machinery;
pub mod means;
pub mod per_ball;
pub mod rating;
pub mod shoulder;
pub mod stiffness;
pub mod support;

use std::fmt;
use std::sync::LazyLock;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};

use crate::schema::SceneError;
use crate::schema::numbers::Parameter;
use estimate::{Estimate, Verdict};
use keys::Keys;
use limits::Limit;
use losses::{ContactPower, Part};
pub use machinery::effect::{AnyEffect, Effect, EffectInputs, Getter, Info, InputRow, Row, Setup};
pub use machinery::reports::Reports;
pub use machinery::{effect, estimate, inherent, keys, limits, losses, moving_frame, reports, since, twin};
use twin::Twin;

/// Makes [`Effects`] of a list of modules.
macro_rules! effects {
    ($($effect:ident),* $(,)?) => {
        /// All effects as a scene has them; the section `[effects]`, and sections of their own.
        #[derive(Clone, Debug, Default)]
        pub struct Effects {
            $(#[doc = concat!("See [`", stringify!($effect), "`].")] pub $effect: $effect::Settings,)*
        }

        /// All keys of `[effects]`.
        static NAMES: LazyLock<Vec<&'static str>> =
            LazyLock::new(|| [$($effect::Settings::NAMES),*].concat());

        impl Effects {
            /// All of them, in the order of the list.
            pub fn each(&self) -> Vec<&dyn AnyEffect> {
                vec![$(&self.$effect),*]
            }

            /// All of them, to be changed.
            pub(crate) fn each_mut(&mut self) -> Vec<&mut dyn AnyEffect> {
                vec![$(&mut self.$effect),*]
            }

            fn read<'de, A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<(), A::Error> {
                $(if $effect::Settings::NAMES.contains(&key) {
                    self.$effect.read(key, map)?;
                })*
                Ok(())
            }
        }
    };
}

effects! {
    creep, groove_slip, damping, gravity, stiffness, cage, per_ball, full_complement, shoulder, form, growth, rating, heat, means, defects,
    frame, ambient, support, auto, film, hysteresis, heat_balance,
}

/// Losses of a bearing: the whole, then its parts.
pub const LOSSES: [Part; 8] = [
    losses::TOTAL,
    losses::SLIDING,
    cage::LOSS,
    hysteresis::LOSS,
    film::LOSS,
    ambient::LOSS,
    damping::LOSS,
    support::LOSS,
];
/// Powers of contacts with the races that effects report.
pub const CONTACT_POWERS: [ContactPower; 3] = [groove_slip::POWER, film::POWER, hysteresis::POWER];
/// Limits that are told of.
pub static LIMITS: [&Limit; 2] = [&shoulder::LIMIT, &full_complement::LIMIT];
/// The one of the moment against rolling.
pub const RESISTING: ContactPower = hysteresis::POWER;

impl Effects {
    /// Checks all numbers against their ranges.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    pub fn check_numbers(&self) -> Result<(), SceneError> {
        self.each().into_iter().try_for_each(AnyEffect::check_numbers)
    }

    /// Checks keys against one another and against the rest of the scene.
    ///
    /// # Errors
    /// Names the key.
    pub fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        self.each().into_iter().try_for_each(|effect| effect.agree(setup))
    }

    /// Numbers that a package offers.
    pub fn parameters(&self) -> Vec<Parameter> {
        self.each().into_iter().flat_map(AnyEffect::parameters).collect()
    }

    /// Place of the number of a key, if it is one of an effect.
    pub fn number(&mut self, key: &str) -> Option<&mut f64> {
        self.each_mut().into_iter().find_map(|effect| effect.number(key))
    }

    /// Which effects are simulated and how they are set, in one line.
    pub fn simulated(&self) -> String {
        let of = |effect: &dyn AnyEffect| {
            let key = effect.info().key;
            effect
                .setting()
                .map(|setting| format!("{} ({setting})", key.strip_prefix("effects.").unwrap_or(key)))
        };
        let on: Vec<String> = self.each().into_iter().filter_map(of).collect();
        format!("effects on: {}", if on.is_empty() { "none".into() } else { on.join(", ") })
    }

    /// Twins of all effects that estimates compare.
    pub fn twins(&self, estimate: &Estimate) -> Vec<Twin> {
        self.each().into_iter().flat_map(|effect| effect.twins(estimate)).collect()
    }

    /// Verdicts of closed forms on effects that have no twins, in their order, then of what no scene switches.
    pub fn verdicts(&self, estimate: &Estimate) -> Vec<Verdict> {
        let mut verdicts: Vec<Verdict> =
            self.each().into_iter().flat_map(|effect| effect.matters(estimate)).collect();
        verdicts.extend(inherent::verdicts(estimate));
        verdicts
    }

    /// Inputs of a package.
    pub fn inputs(&self) -> Vec<InputRow> {
        self.each().into_iter().flat_map(AnyEffect::inputs).collect()
    }

    /// Outputs of the effects that are on, of which the summary of a run has a line each.
    pub fn headlines(&self) -> Vec<Row> {
        let of = |effect: &dyn AnyEffect| {
            let names = effect.headlines();
            effect.rows().into_iter().filter(move |row| names.contains(&row.name.as_str()))
        };
        self.each().into_iter().flat_map(of).collect()
    }

    /// Outputs of a bearing with a number of balls, with or without every ball.
    pub fn rows(&self, balls: usize, every_ball: bool) -> Vec<Row> {
        let mut rows: Vec<Row> = self.each().into_iter().flat_map(AnyEffect::rows).collect();
        // Two effects have it together.
        if self.heat.on && self.ambient.section.is_some() {
            rows.push(heat::row_of_medium());
        }
        for ball in 0..if every_ball { balls } else { 0 } {
            rows.extend(per_ball::motion_rows(ball));
            rows.extend(self.each().into_iter().flat_map(|effect| effect.ball_rows(ball)));
            rows.extend(per_ball::contact_rows(ball));
        }
        rows
    }
}

/// A key of `[effects]`.
struct Key(&'static str);

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let written = String::deserialize(deserializer)?;
        let known = NAMES.iter().find(|name| **name == written);
        known.map(|name| Self(name)).ok_or_else(|| D::Error::unknown_field(&written, &NAMES))
    }
}

impl<'de> Deserialize<'de> for Effects {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Table;
        impl<'de> Visitor<'de> for Table {
            type Value = Effects;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table of effects or \"auto\"")
            }

            fn visit_str<E: Error>(self, written: &str) -> Result<Effects, E> {
                if written != "auto" {
                    return Err(E::unknown_variant(written, &["auto"]));
                }
                let mut effects = Effects::default();
                effects.auto.on = true;
                Ok(effects)
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Effects, A::Error> {
                let mut effects = Effects::default();
                let mut given = vec![];
                while let Some(Key(key)) = map.next_key()? {
                    effects.read(key, &mut map)?;
                    given.push(key);
                }
                effects.auto.given.clone_from(&given);
                // A scene that names its creep law names all that it adds.
                if given.contains(&"creep") && !given.contains(&"heathcote_slip") {
                    effects.groove_slip.on = false;
                }
                Ok(effects)
            }
        }
        deserializer.deserialize_any(Table)
    }
}
