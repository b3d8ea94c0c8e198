//! Settings of the time integration: given one by one, or by the goal that the scene states.
//!
//! The settings of the named goals were chosen by measurement on the scenes of `roulement cost` (`docs/accuracy-cost.md`); they
//! promise nothing on other scenes. A goal that is an error is kept by `roulement run`, which measures it on the scene at hand;
//! the settings here are those that it begins with.

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, IntoDeserializer, MapAccess, Visitor};
use strum::{IntoStaticStr, VariantArray};

use super::units::{Quantity, Time};
use crate::numerics::esdirk;
use crate::numerics::newton::REFACTOR_CONTRACTION;

/// Settings that follow the bearing, until [`Solver::follow`] has set them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follows {
    /// Nothing: the settings are as they were given.
    Nothing,
    /// The step down to which energy is looked at.
    Energy,
    /// First and largest step, of an error goal.
    Steps,
    /// First and largest step and the tolerance: nothing was given. Is the first step given?
    All {
        /// Is the first step to follow, too?
        initial_step: bool,
    },
}

/// Time integration.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "SolverKeys")]
pub struct Solver {
    /// Method of the time integration.
    pub method: Method,
    /// [-] HHT damping, in (0, 1/3]; 0.05 is the paper's. A bearing that stands, where nothing is said about steps, has 0.1 at least.
    pub alpha_f: f64,
    /// [-] local error of a step over the ball diameter.
    pub tolerance: f64,
    /// [-] change of an inertia force in a step, over the largest load of a ball, that steps need not follow; over the cube root of the
    /// tolerance, so that it shrinks with the steps. [`Solver::follow`] sets it where nothing is said. 0 has all followed.
    pub unresolved: f64,
    /// \[s] first step.
    pub initial_step: Time,
    /// \[s] largest step.
    pub max_step: Time,
    /// \[s] smallest step; needing a smaller one is an error. As a default it follows the ball: see [`Solver::fit_to`].
    pub min_step: Time,
    /// [-] a Newton correction that leaves more than this fraction of the residual asks for a new matrix: 0 computes a
    /// matrix for every correction, 1 keeps one until it no longer lowers the residual.
    pub matrix_reuse: f64,
    /// [-] part of the energy that a run puts in, takes out or loses which it may leave unaccounted for: steps that would leave more are
    /// taken again, shorter; 0 does not look at energy. As a default 0.008, and 0 where the largest step, the
    /// tolerance or an error goal is given.
    pub energy_error: f64,
    /// \[s] steps up to this are not shortened for that.
    pub energy_step: Time,
    /// Error that `roulement run` measures and keeps, if the scene states one.
    pub goal: Option<ErrorGoal>,
    /// Settings that follow the bearing's own frequency and load: see [`Solver::follow`].
    pub follows: Follows,
    /// Level of the model.
    pub level: Level,
}

/// Method of the time integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, IntoStaticStr, VariantArray)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Method {
    /// The HHT scheme, of order 2: the paper's.
    #[default]
    Hht,
    /// A Runge-Kutta method of order 3, whose stages have HHT's own equations one after another.
    Esdirk3,
}

impl Method {
    /// [-] places in a step of its stages before the end.
    pub fn places(self) -> &'static [f64] {
        match self {
            Self::Hht => &[],
            Self::Esdirk3 => &esdirk::PLACES[1..esdirk::STAGES - 1],
        }
    }
}

/// Level of the model of a run: what it computes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// The motion in time.
    #[default]
    Dynamic,
    /// The quasi-static equilibrium under the inputs of each row or communication point, balls rolling at their places of the
    /// start: no inertia but centrifugal and gyroscopic, no contact damping, no history.
    Equilibrium,
}

/// A goal that is an error: `accuracy = { error = 1e-3 }`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ErrorGoal {
    /// [-] largest numerical error of any quantity, over its size.
    pub error: f64,
    /// Results whose error is meant.
    #[serde(default)]
    pub of: ErrorOf,
}

/// Results that an error goal is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum ErrorOf {
    /// Means over the second half of a run, and histories: values at equal times, root mean square over the run.
    #[default]
    All,
    /// Means alone.
    Means,
}

impl ErrorGoal {
    /// Goal that is easily kept, and the settings to begin with: those of `balanced`, for 1e-3.
    const USUAL: f64 = 1e-3;

    /// Settings to begin with. Errors of the method fall with the square of the step, local errors with its cube.
    fn solver(self) -> Solver {
        let balanced = Accuracy::Balanced.solver();
        // A goal that is out of range is refused later on.
        let steps = (self.error / Self::USUAL).clamp(1e-4, 16.0).sqrt();
        Solver {
            max_step: Time(balanced.max_step.0 * steps),
            tolerance: balanced.tolerance * steps.powi(3),
            // Errors are measured by comparing runs with steps of one ratio.
            energy_error: 0.0,
            goal: Some(self),
            follows: Follows::Steps,
            ..balanced
        }
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            method: Method::Hht,
            alpha_f: 0.05,
            tolerance: 1e-6,
            unresolved: 0.0,
            initial_step: Time(1e-6),
            max_step: Time(1e-5),
            min_step: Time(0.0),
            matrix_reuse: REFACTOR_CONTRACTION,
            energy_error: USUAL_ENERGY_ERROR,
            energy_step: Time(0.0),
            goal: None,
            follows: Follows::All { initial_step: true },
            level: Level::Dynamic,
        }
    }
}

/// [-] part of the energy put in, taken out or lost that a run may leave unaccounted for where nothing is said: below the 1 % of which it
/// is told.
pub const USUAL_ENERGY_ERROR: f64 = 8e-3;
/// Goal that a scene sets for the time integration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, IntoStaticStr, VariantArray)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Accuracy {
    /// Loads, torque and power of smooth runs, many of them.
    Fast,
    /// For most work, and the least for impacts.
    Balanced,
    /// Reference to judge other settings by.
    Reference,
}

impl Accuracy {
    /// Settings of a goal.
    pub fn solver(self) -> Solver {
        let steps = |max_step, tolerance| Solver {
            max_step: Time(max_step),
            tolerance,
            follows: Follows::Energy,
            ..Solver::default()
        };
        match self {
            Self::Fast => steps(2e-4, 1e-5),
            Self::Balanced => steps(5e-5, 1e-7),
            Self::Reference => steps(2e-6, 1e-9),
        }
    }

    /// [-] largest numerical error of the wrench measured with these settings on the smooth scenes of the study, rounded
    /// up.
    pub fn wrench_error(self) -> f64 {
        match self {
            Self::Fast => 2e-4,
            Self::Balanced => 1e-4,
            Self::Reference => 2e-5,
        }
    }

    /// The cheapest goal whose measured error of the wrench is at most `error`.
    fn for_wrench_error(error: f64) -> Option<Self> {
        Self::VARIANTS.iter().copied().find(|goal| goal.wrench_error() <= error)
    }
}

/// `accuracy` as written.
#[derive(Clone, Copy)]
enum Goal {
    Named(Accuracy),
    Error(ErrorGoal),
}

impl Goal {
    fn solver(self) -> Solver {
        match self {
            Self::Named(goal) => goal.solver(),
            Self::Error(goal) => goal.solver(),
        }
    }
}

/// A word or a table: an untagged choice would not say what is wrong with either.
fn some_goal<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Goal>, D::Error> {
    struct WordOrTable;
    impl<'de> Visitor<'de> for WordOrTable {
        type Value = Goal;

        fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            write!(f, "\"fast\", \"balanced\", \"reference\" or a table {{ error = 1e-3 }}")
        }

        fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<Goal, E> {
            Accuracy::deserialize(word.into_deserializer()).map(Goal::Named)
        }

        fn visit_map<M: MapAccess<'de>>(self, table: M) -> Result<Goal, M::Error> {
            ErrorGoal::deserialize(MapAccessDeserializer::new(table)).map(Goal::Error)
        }
    }
    deserializer.deserialize_any(WordOrTable).map(Some)
}

/// The section as written; what is left out comes from the goal.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct SolverKeys {
    /// `"fast"`, `"balanced"`, `"reference"`, or `{ error = 1e-3, of = "all" }`: an error that `roulement run` measures and reaches; `of = "means"` is
    /// about means alone.
    #[serde(deserialize_with = "some_goal")]
    accuracy: Option<Goal>,
    /// [-] error of the wrench that a goal by name has to keep: the cheapest one is taken; not with `accuracy`.
    wrench_error: Option<f64>,
    method: Method,
    alpha_f: Option<f64>,
    tolerance: Option<f64>,
    initial_step: Option<Time>,
    max_step: Option<Time>,
    min_step: Option<Time>,
    matrix_reuse: Option<f64>,
    energy_error: Option<f64>,
    level: Level,
}

impl TryFrom<SolverKeys> for Solver {
    type Error = String;

    fn try_from(keys: SolverKeys) -> Result<Self, String> {
        let goal = match (keys.accuracy, keys.wrench_error) {
            (Some(_), Some(_)) => return Err("give at most one of accuracy and wrench_error".into()),
            (accuracy, None) => accuracy.map_or_else(Self::default, Goal::solver),
            (None, Some(error)) => Accuracy::for_wrench_error(error)
                .ok_or_else(|| {
                    let least = Accuracy::Reference.wrench_error();
                    format!(
                        "wrench_error = {error} is out of range: the smallest that was measured is {least}"
                    )
                })?
                .solver(),
        };
        let max_step = keys.max_step.unwrap_or(goal.max_step);
        let limited = keys.max_step.is_some() || keys.tolerance.is_some();
        let usual_energy_error = if limited { 0.0 } else { goal.energy_error };
        let energy_error = keys.energy_error.unwrap_or(usual_energy_error);
        let follows = match goal.follows {
            Follows::All { .. } if !limited => Follows::All { initial_step: keys.initial_step.is_none() },
            Follows::Steps if !limited && keys.initial_step.is_none() => Follows::Steps,
            _ if energy_error > 0.0 => Follows::Energy,
            _ => Follows::Nothing,
        };
        Ok(Self {
            method: keys.method,
            alpha_f: keys.alpha_f.unwrap_or(goal.alpha_f),
            tolerance: keys.tolerance.unwrap_or(goal.tolerance),
            unresolved: goal.unresolved,
            // A goal's first step gives way to a smaller largest step.
            initial_step: keys.initial_step.unwrap_or(Time(goal.initial_step.si().min(max_step.si()))),
            max_step,
            min_step: keys.min_step.unwrap_or(Time(goal.min_step.si().min(max_step.si()))),
            matrix_reuse: keys.matrix_reuse.unwrap_or(goal.matrix_reuse),
            energy_error,
            energy_step: goal.energy_step,
            goal: goal.goal,
            follows,
            level: keys.level,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::SMALLEST_TOLERANCE;

    fn parse(text: &str) -> Result<Solver, String> {
        toml::from_str(text).map_err(|why: toml::de::Error| why.to_string())
    }

    #[test]
    fn a_goal_sets_what_is_left_out_and_explicit_settings_win() {
        assert_eq!(parse(""), Ok(Solver::default()));
        for goal in Accuracy::VARIANTS {
            let name: &str = goal.into();
            assert_eq!(parse(&format!("accuracy = \"{name}\"")), Ok(goal.solver()));
            let mixed = parse(&format!("accuracy = \"{name}\"\nmax_step = \"3 us\"\nalpha_f = 0.2")).unwrap();
            let expected = Solver {
                max_step: Time(3e-6),
                alpha_f: 0.2,
                initial_step: Time(goal.solver().initial_step.0.min(3e-6)),
                energy_error: 0.0,
                follows: Follows::Nothing,
                ..goal.solver()
            };
            assert_eq!(mixed, expected);
        }
        // A largest step below the goal's first step is no conflict, one below an explicit first step is kept for the
        // range check.
        assert_eq!(parse("max_step = 1e-7").unwrap().initial_step, Time(1e-7));
        assert_eq!(parse("max_step = 1e-7\ninitial_step = 1e-6").unwrap().initial_step, Time(1e-6));
    }

    #[test]
    fn energy_is_looked_at_unless_the_scene_sets_its_steps() {
        let looks = |text: &str| {
            let mut solver = parse(text).unwrap();
            if solver.follows != Follows::Nothing {
                solver.follow(50e3, 1e-3);
            }
            (solver.energy_error, solver.energy_step.0)
        };
        for text in
            ["", "accuracy = \"fast\"", "initial_step = 1e-7", "accuracy = \"balanced\"\nalpha_f = 0.1"]
        {
            assert_eq!(looks(text), (USUAL_ENERGY_ERROR, 1e-7), "{text}");
            assert_eq!(looks(&format!("{text}\nenergy_error = 0")).0, 0.0, "{text}");
        }
        for text in ["accuracy = { error = 1e-3 }", "max_step = 1e-7", "tolerance = 1e-6"] {
            assert_eq!(looks(text).0, 0.0, "{text}");
            assert_eq!(looks(&format!("{text}\nenergy_error = 0.01")), (0.01, 1e-7), "{text}");
        }
        // Half the steps leave an eighth of the energy.
        let usual = parse("").unwrap();
        assert_eq!(usual.refined(1).energy_error, usual.energy_error / 8.0);
    }

    #[test]
    fn goals_are_ordered_from_cheap_to_exact() {
        for pair in Accuracy::VARIANTS.windows(2) {
            assert!(pair[0].wrench_error() > pair[1].wrench_error());
            assert!(pair[0].solver().max_step.0 >= pair[1].solver().max_step.0);
        }
    }

    #[test]
    fn a_wrench_error_finds_the_cheapest_goal_that_was_measured_to_reach_it() {
        for goal in Accuracy::VARIANTS {
            assert_eq!(parse(&format!("wrench_error = {:e}", goal.wrench_error())), Ok(goal.solver()));
        }
        assert_eq!(parse("wrench_error = 0.5"), Ok(Accuracy::Fast.solver()));
        let message = parse("wrench_error = 1e-15").unwrap_err();
        assert!(
            message.contains("wrench_error = 0.000000000000001") && message.contains("smallest"),
            "{message}"
        );
        assert!(parse("wrench_error = nan").unwrap_err().contains("NaN"));
        assert!(parse("accuracy = \"fast\"\nwrench_error = 1e-3").unwrap_err().contains("at most one"));
        let message = parse("accuracy = \"quick\"").unwrap_err();
        assert!(message.contains("quick") && message.contains("balanced"), "{message}");
        let message = parse("accuracy = 3").unwrap_err();
        assert!(message.contains("balanced") && message.contains("{ error = 1e-3 }"), "{message}");
        let message = parse("accuracy = { eror = 1e-3 }").unwrap_err();
        assert!(message.contains("eror") && message.contains("error"), "{message}");
    }

    #[test]
    fn an_error_is_a_goal_whose_settings_are_those_to_begin_with() {
        let usual = parse("accuracy = { error = 1e-3 }").unwrap();
        let goal = ErrorGoal { error: 1e-3, of: ErrorOf::All };
        let follows = Follows::Steps;
        let energy_error = 0.0;
        assert_eq!(usual, Solver { goal: Some(goal), follows, energy_error, ..Accuracy::Balanced.solver() });
        let finer = parse("accuracy = { error = 2.5e-4, of = \"means\" }\nalpha_f = 0.1").unwrap();
        assert_eq!(finer.goal, Some(ErrorGoal { error: 2.5e-4, of: ErrorOf::Means }));
        assert_eq!((finer.max_step.0, finer.alpha_f), (25e-6, 0.1));
        assert!((finer.tolerance / usual.refined(1).tolerance - 1.0).abs() < 1e-12);
        // Half the steps whichever limit holds, down to what a scene may ask for.
        let refined = usual.refined(2);
        assert_eq!((refined.max_step.0, refined.tolerance), (50e-6 / 4.0, 1e-7 / 64.0));
        assert!(refined.initial_step.0 <= refined.max_step.0 && refined.min_step.0 <= refined.initial_step.0);
        assert_eq!(usual.refined(20).tolerance, SMALLEST_TOLERANCE);
    }
}
