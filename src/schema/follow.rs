//! Settings of the time integration that follow the bearing, where nothing is said of them, and those of finer runs.

use super::accuracy::{Follows, Solver};
use super::units::Time;

/// [-] smallest step that energy asks for, in periods of a ball between its races: an impact takes half a period.
const ENERGY_PERIODS: f64 = 0.005;

/// [-] tolerance where nothing is said, of what has to be followed: the cheapest that kept means within 1 % and histories but that of the
/// torque within 2 % in scenes of all kinds, but for chaotic ones (`docs/accuracy-cost.md`).
const USUAL_TOLERANCE: f64 = 5e-9;
/// [-] the same over the approach of the most loaded ball, for bearings that carry little: their motions are as small.
const TOLERANCE_OF_APPROACH: f64 = 5e-5;
/// [-] change of an inertia force over the largest load that need not be followed at the usual tolerance: it moves loads by as much at
/// most. Found with the tolerance.
const USUAL_UNRESOLVED: f64 = 5e-3;
/// [-] approach over the ball diameter below which that is less: friction of balls that their own weight and orbit press alone counts more
/// where the others carry little, too.
const APPROACH_OF_LOADED: f64 = 1e-3;
/// [-] tolerance of bearings without states over the usual one: no balls swing that would ask for less, but shafts swing that nothing damps. With it the
/// swing of a shaft on springs is right to 2 % over 3.6 periods (`tests/shaft/rollers_alone.rs`; with ten times as much it is not to 5 %), and
/// means and histories of a rotor and of the machines of scenes and examples are those of fine steps to 0.5 %.
const WITHOUT_STATES: f64 = 20.0;
/// [-] largest and first step where nothing is said, in periods of a ball between its races. The tolerance holds steps down where
/// balls swing; where nothing does, steps beyond some periods are no cheaper.
const PERIODS: [f64; 2] = [4.0, 0.03];

/// \[s] default smallest step for balls of `LARGE_BALL` \[m] and more. What has to be followed gets shorter with the mass of a
/// smaller ball, which friction brings to its speed: below 1e-13 s for a ball of a millimetre near standstill. A step much
/// smaller than needed would only make a run crawl that has gone wrong.
const SMALLEST_STEP: f64 = 1e-10;
const LARGE_BALL: f64 = 0.01;

impl Solver {
    /// Takes the default smallest step, where none is given (0), for balls of a diameter \[m].
    pub fn fit_to(&mut self, ball_diameter: f64) {
        if self.min_step.0 == 0.0 {
            let mass = (ball_diameter / LARGE_BALL).min(1.0).powi(3);
            self.min_step = Time((SMALLEST_STEP * mass).max(1e-15).min(self.max_step.0));
        }
    }

    /// Sets what follows the bearing: the natural frequency \[Hz] of its most loaded ball and the approach of that ball over
    /// its diameter.
    pub fn follow(&mut self, frequency: f64, approach: f64) {
        let [max_step, initial_step] = PERIODS.map(|periods| (periods / frequency).clamp(1e-9, 1e-3));
        self.energy_step = Time(ENERGY_PERIODS / frequency);
        match std::mem::replace(&mut self.follows, Follows::Nothing) {
            Follows::Nothing | Follows::Energy => {}
            Follows::Steps => {
                self.max_step = Time(self.max_step.0.min(max_step));
                self.initial_step = Time(self.initial_step.0.min(initial_step));
            }
            Follows::All { initial_step: first } => {
                self.tolerance =
                    USUAL_TOLERANCE.min(TOLERANCE_OF_APPROACH * approach).max(SMALLEST_TOLERANCE);
                self.unresolved =
                    USUAL_UNRESOLVED / USUAL_TOLERANCE.cbrt() * (approach / APPROACH_OF_LOADED).min(1.0);
                if first {
                    self.initial_step = Time(initial_step.max(self.min_step.0));
                }
                // What was given has room.
                self.max_step = Time(max_step.max(self.initial_step.0).max(self.min_step.0));
            }
        }
    }

    /// [-] tolerance of the local error, over the size of a rolling element, where bearings have no states.
    pub fn tolerance_without_states(&self) -> f64 {
        // That of the usual settings alone leaves something unresolved.
        if self.unresolved > 0.0 { WITHOUT_STATES * self.tolerance } else { self.tolerance }
    }

    /// [-] change of an inertia force in a step over the largest load of a ball that need not be followed.
    pub fn unresolved_share(&self) -> f64 {
        self.unresolved * self.tolerance.cbrt()
    }

    /// Settings that take half the steps, and again, `halvings` times: the local error that is allowed falls with the cube of
    /// the step, so that both limits ask for half.
    pub fn refined(&self, halvings: u32) -> Self {
        let part = f64::from(halvings).exp2().recip();
        let max_step = Time(self.max_step.0 * part);
        Self {
            tolerance: (self.tolerance * part.powi(3)).max(SMALLEST_TOLERANCE),
            initial_step: Time(self.initial_step.0 * part),
            max_step,
            min_step: Time(self.min_step.0.min(self.initial_step.0 * part)),
            // Numerical losses fall with the cube of the step, too.
            energy_error: self.energy_error * part.powi(3),
            energy_step: Time(self.energy_step.0 * part),
            ..*self
        }
    }
}

/// [-] smallest tolerance that a scene may have.
pub const SMALLEST_TOLERANCE: f64 = 1e-14;

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Solver, String> {
        toml::from_str(text).map_err(|why: toml::de::Error| why.to_string())
    }

    #[test]
    fn regression_the_smallest_step_follows_the_ball_unless_it_is_given() {
        let fitted = |text: &str, diameter: f64| {
            let mut solver = parse(text).unwrap();
            solver.fit_to(diameter);
            solver.min_step.0
        };
        assert!((fitted("", 1e-3) / 1e-13 - 1.0).abs() < 1e-12);
        assert_eq!((fitted("", 0.01), fitted("", 0.5)), (1e-10, 1e-10));
        assert_eq!(fitted("min_step = \"1 ns\"", 1e-3), 1e-9);
        assert_eq!(fitted("max_step = 1e-14", 0.05), 1e-14);
    }

    #[test]
    fn closed_form_what_is_not_said_follows_the_bearing() {
        let followed = |text: &str, frequency: f64, approach: f64| {
            let mut solver = parse(text).unwrap();
            solver.follow(frequency, approach);
            (solver.max_step.0, solver.initial_step.0, solver.tolerance)
        };
        // Four periods of a ball, and 3 % of one; a tolerance that is small against its approach.
        assert_eq!(followed("", 40e3, 1e-3), (1e-4, 0.75e-6, 5e-9));
        assert_eq!(followed("", 400e3, 1e-5), (1e-5, 0.075e-6, 5e-10));
        assert_eq!(followed("alpha_f = 0.2\ninitial_step = 2e-6", 40e3, 1e-3), (1e-4, 2e-6, 5e-9));
        assert_eq!(followed("initial_step = 2e-4", 40e3, 1e-3), (2e-4, 2e-4, 5e-9));
        // One limit that is given is enough to be followed alone.
        assert_eq!(followed("max_step = 1e-5", 40e3, 1e-3), (1e-5, 1e-6, 1e-6));
        assert_eq!(followed("tolerance = 1e-5", 40e3, 1e-3), (1e-5, 1e-6, 1e-5));
        assert_eq!(followed("accuracy = \"balanced\"", 400e3, 1e-5), (5e-5, 1e-6, 1e-7));
        // An error goal begins with no larger steps than the bearing takes.
        assert_eq!(followed("accuracy = { error = 1e-3 }", 400e3, 1e-3), (1e-5, 0.075e-6, 1e-7));
        assert_eq!(followed("accuracy = { error = 1e-3 }\nmax_step = 4e-5", 400e3, 1e-3), (4e-5, 1e-6, 1e-7));
    }
    #[test]
    fn closed_form_what_need_not_be_followed_shrinks_with_the_steps_and_is_nothing_where_they_are_given() {
        let share = |text: &str, approach: f64, halvings: u32| {
            let mut solver = parse(text).unwrap();
            solver.follow(40e3, approach);
            solver.refined(halvings).unresolved_share()
        };
        let near = |share: f64, expected: f64| assert!((share / expected - 1.0).abs() < 1e-12, "{share}");
        near(share("", 1e-3, 0), 5e-3);
        near(share("", 1e-3, 3), 5e-3 / 8.0);
        // A tenth by the approach, and the cube root of a tolerance that is a tenth.
        near(share("", 1e-5, 0), 5e-5 * 0.1f64.cbrt());
        for given in
            ["tolerance = 1e-5", "max_step = 1e-5", "accuracy = \"fast\"", "accuracy = { error = 1e-3 }"]
        {
            assert_eq!(share(given, 1e-3, 0), 0.0, "{given}");
        }
    }
}
