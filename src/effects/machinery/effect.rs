//! Interface of an effect: its keys, description, numbers, checks and variables.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::estimate::{Estimate, Verdict};
use super::moving_frame::FrameInputs;
use super::reports::Reports;
use super::twin::Twin;
use crate::schema::numbers::{Number, Parameter, Range};
use crate::schema::variable_units::Unit;
use crate::schema::{BearingSection, Drive, Friction, Group, SceneError};

/// Description of an effect.
#[derive(Clone, Copy, Debug)]
pub struct Info {
    /// Key that switches it, with its section.
    pub key: &'static str,
    /// Physics that it adds, in one sentence.
    pub adds: &'static str,
    /// Which states it has.
    pub states: &'static str,
    /// Author and year, or section of the paper.
    pub source: &'static str,
    /// Cost when on, measured: instructions of a step more than without it (`scripts/measure step-instructions` counts alike).
    pub price: &'static str,
    /// Part of a scene that switches it on.
    pub example: &'static str,
}

/// Setup that the keys of an effect may have to agree with.
#[derive(Clone, Copy, Debug)]
pub struct Setup<'a> {
    /// Internal geometry.
    pub bearing: &'a BearingSection,
    /// Friction coefficients.
    pub friction: &'a Friction,
    /// Does the creep law of the ball-race contacts saturate?
    pub saturates: bool,
    /// Is growth simulated?
    pub grows: bool,
    /// Does a table give one of its temperatures?
    pub rises_follow_time: bool,
    /// Is there a cage that is a body?
    pub cage: bool,
    /// Does a cage, that or an ideal one, keep the balls apart?
    pub kept_apart: bool,
    /// Is there the oil of a film?
    pub oiled: bool,
    /// How both races get their motion, inner first.
    pub drives: [Drive; 2],
    /// May the inner and the outer race turn by the scene's script?
    pub turning: [bool; 2],
    /// [1/K] coefficients of thermal expansion of balls and races.
    pub expansions: [f64; 2],
}

/// How the value of a variable is found in what is reported.
#[derive(Clone)]
pub struct Getter(Arc<dyn Fn(&Reports<'_>) -> f64 + Send + Sync>);

impl Getter {
    /// By a function.
    pub fn new(get: impl Fn(&Reports<'_>) -> f64 + Send + Sync + 'static) -> Self {
        Self(Arc::new(get))
    }

    /// The value.
    pub fn get(&self, reports: &Reports<'_>) -> f64 {
        (self.0)(reports)
    }
}

impl fmt::Debug for Getter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Getter")
    }
}

/// An output that an effect adds to the table of variables.
#[derive(Clone, Debug)]
pub struct Row {
    /// Structured name.
    pub name: String,
    /// Unit.
    pub unit: Unit,
    /// \[unit] typical size.
    pub nominal: f64,
    /// One sentence.
    pub description: String,
    /// Its value.
    pub get: Getter,
}

/// Inputs of effects; those of an effect that is off stay as the scene has them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EffectInputs {
    /// Motion of the bearing's frame, and gravity.
    pub frame: FrameInputs,
    /// [-] degree of lubrication.
    pub lubrication: f64,
}

/// An input that an effect adds to the table of variables.
#[derive(Clone, Debug)]
pub struct InputRow {
    /// Structured name.
    pub name: String,
    /// Unit.
    pub unit: Unit,
    /// \[unit] typical size.
    pub nominal: f64,
    /// \[unit] a small change, for derivatives.
    pub change: f64,
    /// One sentence.
    pub description: String,
    /// Group that it is given with.
    pub group: Group,
    /// Allowed values, where not every number is.
    pub range: Option<Range>,
    /// Which of the numbers that the functions below reach.
    pub place: usize,
    /// Value as set last.
    pub get: fn(&EffectInputs, usize) -> f64,
    /// [unit/s] rate as set last.
    pub rate: fn(&EffectInputs, usize) -> f64,
    /// Sets value and rate.
    pub set: fn(&mut EffectInputs, usize, f64, f64),
}

/// An effect, by the struct of its keys; by default without numbers, checks and variables.
pub trait Effect: Clone + 'static {
    /// Description of it.
    const INFO: &'static Info;
    /// Numbers among its keys.
    const NUMBERS: &'static [Number<Self>] = &[];
    /// Quantity that is estimated to tell whether it matters; empty where nothing is.
    const ESTIMATE: &'static str = "";

    /// How it is set, such as "0.02 s/m"; none if it is off.
    fn setting(&self) -> Option<String>;

    /// Checks keys against one another; their ranges were checked before.
    ///
    /// # Errors
    /// Names the key.
    fn agree(&self, _setup: &Setup<'_>) -> Result<(), SceneError> {
        Ok(())
    }

    /// Inputs of a package.
    fn inputs(&self) -> Vec<InputRow> {
        vec![]
    }

    /// How it is taken in and out; nothing where no settled state tells of it.
    fn twins(&self, _estimate: &Estimate) -> Vec<Twin> {
        vec![]
    }

    /// Does it matter, by a closed form, as it is set or if it were on? Nothing where there is none.
    fn matters(&self, _estimate: &Estimate) -> Vec<Verdict> {
        vec![]
    }

    /// Switches it on or off by a key that one of its verdicts names ([`Verdict::auto`]).
    fn switch(&mut self, _key: &str, _on: bool) {}

    /// Outputs of the bearing as a whole.
    fn rows(&self) -> Vec<Row> {
        vec![]
    }

    /// Names of those of these outputs that the summary of a run has.
    fn headlines(&self) -> &'static [&'static str] {
        &[]
    }

    /// Outputs of a ball (0 is the first), where every ball is reported.
    fn ball_rows(&self, _ball: usize) -> Vec<Row> {
        vec![]
    }
}

/// Any effect: [`Effect`] as the list has it.
pub trait AnyEffect {
    /// See [`Effect::INFO`].
    fn info(&self) -> &'static Info;
    /// See [`Effect::ESTIMATE`].
    fn estimate(&self) -> &'static str;
    /// See [`Effect::setting`].
    fn setting(&self) -> Option<String>;
    /// Checks its numbers against their ranges.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    fn check_numbers(&self) -> Result<(), SceneError>;
    /// See [`Effect::agree`].
    ///
    /// # Errors
    /// Names the key.
    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError>;
    /// Its numbers that a package offers.
    fn parameters(&self) -> Vec<Parameter>;
    /// Place of the number of a key, if it is one of its own.
    fn number(&mut self, key: &str) -> Option<&mut f64>;
    /// See [`Effect::inputs`].
    fn inputs(&self) -> Vec<InputRow>;
    /// See [`Effect::twins`].
    fn twins(&self, estimate: &Estimate) -> Vec<Twin>;
    /// See [`Effect::matters`].
    fn matters(&self, estimate: &Estimate) -> Vec<Verdict>;
    /// See [`Effect::switch`].
    fn switch(&mut self, key: &str, on: bool);
    /// See [`Effect::rows`].
    fn rows(&self) -> Vec<Row>;
    /// See [`Effect::headlines`].
    fn headlines(&self) -> &'static [&'static str];
    /// See [`Effect::ball_rows`].
    fn ball_rows(&self, ball: usize) -> Vec<Row>;
}

impl<T: Effect> AnyEffect for T {
    fn info(&self) -> &'static Info {
        T::INFO
    }

    fn estimate(&self) -> &'static str {
        T::ESTIMATE
    }

    fn setting(&self) -> Option<String> {
        Effect::setting(self)
    }

    fn check_numbers(&self) -> Result<(), SceneError> {
        let mut copy = self.clone();
        T::NUMBERS.iter().try_for_each(|number| number.check(&mut copy))
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        Effect::agree(self, setup)
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut copy = self.clone();
        T::NUMBERS.iter().filter_map(|number| number.parameter(&mut copy)).collect()
    }

    fn number(&mut self, key: &str) -> Option<&mut f64> {
        T::NUMBERS.iter().find(|number| number.key == key)?.value(self)
    }

    fn inputs(&self) -> Vec<InputRow> {
        Effect::inputs(self)
    }

    fn twins(&self, estimate: &Estimate) -> Vec<Twin> {
        Effect::twins(self, estimate)
    }

    fn matters(&self, estimate: &Estimate) -> Vec<Verdict> {
        Effect::matters(self, estimate)
    }

    fn switch(&mut self, key: &str, on: bool) {
        Effect::switch(self, key, on);
    }

    fn rows(&self) -> Vec<Row> {
        Effect::rows(self)
    }

    fn headlines(&self) -> &'static [&'static str] {
        Effect::headlines(self)
    }

    fn ball_rows(&self, ball: usize) -> Vec<Row> {
        Effect::ball_rows(self, ball)
    }
}
