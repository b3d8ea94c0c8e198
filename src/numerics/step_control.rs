//! Automatic step size: PI control on the local error, quantised so that a settled run keeps one step size.

use serde::{Deserialize, Serialize};

use super::elementary::{log2, pow};
use super::scalar::Values;

/// [-] error aimed at, over the tolerance.
const SAFETY: f64 = 0.9;
/// Exponents of the PI controller for a second-order method (local error of order 3; Gustafsson 1991).
const PROPORTIONAL: f64 = 0.4 / 3.0;
const INTEGRAL: f64 = 0.7 / 3.0;
/// Step sizes (notches) per factor of 2.
const NOTCHES_PER_OCTAVE: f64 = 4.0;
/// [-] steps within an octave, over the smallest: powers of `2^(1/4)`.
const WITHIN_OCTAVE: [f64; 4] = [1.0, 1.189_207_115_002_721, std::f64::consts::SQRT_2, 1.681_792_830_507_429];
/// Largest growth and shrinkage of one step, in notches.
const MAX_GROWTH: i32 = 4;
const MAX_SHRINKAGE: i32 = 12;
/// [-] a rejected step is tried again with no less than this part of it.
pub const LARGEST_CUT: f64 = 0.125;
/// [-] an accepted step with an error below this keeps its size or grows. When a contact closes the error jumps from almost
/// zero, and the proportional part would cut the step. A step cut in the middle of an impact breaks the symmetry between
/// approach and rebound: a bearing with bouncing balls gained 2.7 % of energy in 1e5 steps.
const KEPT_BELOW: f64 = 0.3;
/// A step whose Newton iteration failed is tried again this many notches smaller (a factor of 4).
const FAILURE_NOTCHES: i32 = 8;
/// Steps without growth after a rejection.
const STEPS_WITHOUT_GROWTH: u8 = 2;

/// State of the step control. Step sizes are `max_step 2^(notch/4)` with `notch <= 0`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepControl {
    max_step: f64,
    min_step: f64,
    notch: i32,
    last_error: f64,
    growth_blocked: u8,
}

impl StepControl {
    /// Begins with the largest quantised step not above `initial_step` \[s].
    pub fn new(initial_step: f64, min_step: f64, max_step: f64) -> Self {
        let notch = notch_below(initial_step, max_step);
        Self { max_step, min_step, notch, last_error: 1.0, growth_blocked: 0 }
    }

    /// Goes on with the largest quantised step not above a limit \[s], where the present one is; but not with one below the
    /// smallest allowed.
    pub fn cap(&mut self, limit: f64) {
        let lowest = (log2(self.min_step / self.max_step) * NOTCHES_PER_OCTAVE - 1e-9).ceil().min(0.0) as i32;
        self.notch = self.notch.min(notch_below(limit, self.max_step).max(lowest));
    }

    /// \[s] present step size.
    pub fn step(&self) -> f64 {
        if self.notch == 0 {
            return self.max_step;
        }
        let (octaves, notches) = (self.notch.div_euclid(4), self.notch.rem_euclid(4));
        self.max_step * (WITHIN_OCTAVE[notches as usize] * f64::from(octaves).power_of_two())
    }

    /// \[s] next step on the way to a point `remaining` \[s] ahead; the last few steps before it are made even.
    pub fn step_within(&self, remaining: f64) -> f64 {
        const EVEN_STEPS: f64 = 4.0;
        let steps = (remaining / self.step() * (1.0 - 1e-9)).ceil().max(1.0);
        if steps <= EVEN_STEPS { remaining / steps } else { self.step() }
    }

    /// \[s] the next step is shorter than this.
    pub fn longest(&self) -> f64 {
        self.step() * (1.0 + 1e-6)
    }

    /// After a converged step with this local error in units of its tolerance: is it accepted? Sets the next step.
    pub fn judge(&mut self, error: f64) -> bool {
        // An error of exactly zero must not ask for an infinite step.
        let error = if error < 1e-10 { 1e-10 } else { error };
        if error.is_nan() || error > 1.0 {
            let notches = NOTCHES_PER_OCTAVE * log2(SAFETY * pow(error, -1.0 / 3.0));
            self.shrink((-notches).ceil() as i32);
            return false;
        }
        let ceiling = if self.growth_blocked > 0 { 0 } else { MAX_GROWTH };
        let floor = if error < KEPT_BELOW { 0 } else { -MAX_SHRINKAGE };
        // The largest step that is not cut stays whatever the powers are.
        if self.notch < 0 || floor < 0 {
            let factor = SAFETY * pow(error, -INTEGRAL) * pow(self.last_error, PROPORTIONAL);
            let change = (NOTCHES_PER_OCTAVE * log2(factor)).floor() as i32;
            self.notch = (self.notch + change.clamp(floor, ceiling)).min(0);
        }
        self.growth_blocked = self.growth_blocked.saturating_sub(1);
        self.last_error = error;
        true
    }

    /// After a step whose equations could not be solved.
    pub fn fail(&mut self) {
        self.shrink(FAILURE_NOTCHES);
    }

    fn shrink(&mut self, notches: i32) {
        self.notch -= notches.clamp(1, MAX_SHRINKAGE);
        self.growth_blocked = STEPS_WITHOUT_GROWTH;
    }

    /// Can a run with these settings be at this point? For states that come from outside.
    pub fn fits(&self, settings: &Self) -> bool {
        // No range of steps that a scene may give is wider.
        const MAX_NOTCHES: i32 = 1000;
        self.max_step == settings.max_step
            && self.min_step == settings.min_step
            && (-MAX_NOTCHES..=0).contains(&self.notch)
            && self.last_error.is_finite()
            && self.last_error > 0.0
            && self.growth_blocked <= STEPS_WITHOUT_GROWTH
    }

    /// [-] local error of the step that was accepted last over its tolerance; 1 before the first.
    pub fn last_error(&self) -> f64 {
        self.last_error
    }

    /// [-] place of the present step between the least (0) and the largest (1) allowed, on a logarithmic scale; 0 where these are the same.
    pub fn margin(&self) -> f64 {
        let range = (self.max_step / self.min_step).ln();
        if range > 0.0 { ((self.step() / self.min_step).ln() / range).max(0.0) } else { 0.0 }
    }

    /// Is the present step still allowed?
    pub fn above_minimum(&self) -> bool {
        self.step() >= self.min_step
    }
}

/// The largest quantised step not above a step \[s].
fn notch_below(step: f64, max_step: f64) -> i32 {
    (log2(step / max_step) * NOTCHES_PER_OCTAVE + 1e-9).floor().min(0.0) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cap_takes_the_next_quantised_step_below_and_growth_goes_on_from_there() {
        let mut control = StepControl::new(1e-5, 1e-9, 1e-5);
        control.cap(f64::INFINITY);
        assert_eq!(control.step(), 1e-5);
        control.cap(3e-6);
        let capped = control.step();
        assert!(capped <= 3e-6 && capped > 2.5e-6, "{capped}");
        control.cap(4e-6);
        assert_eq!(control.step(), capped);
        assert!(control.judge(1e-6) && control.step() > capped);
        control.cap(0.0);
        assert!(control.above_minimum() && control.step() < 1.2e-9);
    }

    #[test]
    fn invariant_steps_are_quantised_bounded_and_end_at_the_point() {
        let mut control = StepControl::new(1e-6, 1e-10, 1e-5);
        assert!(control.step() <= 1e-6 && control.step() > 0.8e-6);
        for error in [1e-3, 0.5, 3.0, 0.2, 0.2, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9] {
            let before = control.step();
            assert_eq!(control.judge(error), error <= 1.0);
            let octaves = (control.step() / before).log2() * 4.0;
            assert!((octaves - octaves.round()).abs() < 1e-9 && octaves <= 4.0);
        }
        assert_eq!(control.step(), 1e-5);
        let mut remaining = 3.37e-5;
        while remaining > 1e-18 {
            let step = control.step_within(remaining);
            assert!(step <= 1e-5 * (1.0 + 1e-8) && step > 0.4e-5);
            remaining -= step;
        }
    }

    #[test]
    fn a_step_well_inside_its_tolerance_is_not_cut() {
        let mut control = StepControl::new(1e-5, 1e-10, 1e-5);
        assert!(control.judge(1e-10));
        for error in [0.01, 0.1, 0.29, 1e-10, 0.29] {
            assert!(control.judge(error) && control.step() == 1e-5, "{error}");
        }
        assert!(control.judge(0.9) && control.step() < 1e-5);
    }

    #[test]
    fn no_growth_for_two_steps_after_a_rejection() {
        let mut control = StepControl::new(1e-6, 1e-10, 1e-5);
        assert!(!control.judge(10.0));
        let step = control.step();
        assert!(control.judge(1e-6) && control.step() == step);
        assert!(control.judge(1e-6) && control.step() == step);
        assert!(control.judge(1e-6) && control.step() > step);
    }
}
