//! Minimum of the objective of Kalker's nonlinear problem: Newton's method where the objective is convex, Levenberg's and
//! Marquardt's elsewhere.

use nalgebra::{Cholesky, DVector, Dyn};

use super::ScaledCreepage;
use super::nonlinear::{Kalker, KalkerError};
use super::objective::{Expansion, Fields, Objective};
use super::solution::Solution;

/// Iterations of one solve; 6 to 10 are usual.
const MAX_ITERATIONS: u32 = 200;
/// [-] relative decrease of the objective, predicted or reached by Newton's step, that ends the iteration with it.
const DECREASE: f64 = 1e-11;
/// [-] fraction of that decrease below which Newton's step may take the matrix of the step before: a predicted decrease of
/// 1e-13 of the objective is a step of 3e-7 of the solution, of which an old matrix gets a small part wrong.
const NEARLY_NOTHING: f64 = 1e-2;
/// [-] objective over the square of creepages (up to sliding) at which Coulomb's law holds to twelve digits of traction.
const NEGLIGIBLE: f64 = 1e-24;
/// [-] relative decrease that is enough after `PATIENCE` iterations.
const IDLE_DECREASE: f64 = 1e-7;
const PATIENCE: u32 = 30;
/// [-] scaled creepage beyond which a contact slides as a whole, to within this number's inverse; larger ones are
/// scaled back to it.
const LARGEST_CREEPAGE: f64 = 1e5;

/// How a step of a method ended.
enum Step {
    /// At a lower objective.
    Lower,
    /// At the minimum to rounding.
    Minimum,
    /// Without progress.
    Failed,
}

/// The iteration at one creepage.
struct Iteration<'a> {
    problem: &'a Objective<'a>,
    /// Coefficients of the traction polynomials, the fields that they give and the objective there.
    z: DVector<f64>,
    fields: Fields,
    objective: f64,
    /// Levenberg's and Marquardt's damping of the second derivative.
    damping: f64,
    /// Factorised second derivative of the last step, if that was Newton's.
    factor: Option<Cholesky<f64, Dyn>>,
    count: u32,
}

impl<'a> Iteration<'a> {
    fn new(problem: &'a Objective<'a>, z: DVector<f64>) -> Self {
        let fields = problem.fields_at(&z);
        let objective = problem.objective(&z, &fields);
        Self { problem, z, fields, objective, damping: 1e-3, factor: None, count: 0 }
    }

    /// Newton's own step, where the objective is convex: it ends the iteration at the minimum to rounding, so that
    /// results are a smooth function of the creepages. A decrease of `enough` is the last.
    fn newton(&mut self, Expansion { gradient, sliding, .. }: &Expansion, enough: f64) -> Step {
        let predicted = |step: &DVector<f64>| 0.5 * gradient.dot(step);
        // Where nearly nothing is left, the last step's matrix serves.
        let reused = self.factor.take().map(|factor| factor.solve(gradient));
        let step = reused.filter(|step| predicted(step) <= NEARLY_NOTHING * enough).or_else(|| {
            self.factor = self.problem.curvature(sliding, true).cholesky();
            self.factor.as_ref().map(|factor| factor.solve(gradient))
        });
        let Some(step) = step else {
            return Step::Failed;
        };
        // Below this, rounding decides whether the objective falls.
        let last = predicted(&step) <= enough;
        let trial = &self.z - step;
        let fields = self.problem.fields_at(&trial);
        let reached = self.problem.objective(&trial, &fields);
        let before = self.objective;
        if last {
            if reached <= before + enough {
                self.accept(trial, fields, reached);
            }
            return Step::Minimum;
        }
        if reached >= before || reached.is_nan() {
            return Step::Failed;
        }
        self.accept(trial, fields, reached);
        if before - reached <= enough { Step::Minimum } else { Step::Lower }
    }

    /// Levenberg's and Marquardt's step: Gauss's and Newton's matrix, damped until the objective falls.
    fn levenberg_marquardt(&mut self, Expansion { gradient, sliding, .. }: &Expansion) -> Step {
        self.factor = None;
        let gauss_newton = self.problem.curvature(sliding, false);
        loop {
            let mut damped = gauss_newton.clone();
            for i in 0..damped.nrows() {
                damped[(i, i)] += self.damping * (gauss_newton[(i, i)] + 1e-12);
            }
            let trial = damped.cholesky().map(|factor| {
                let trial = &self.z - factor.solve(gradient);
                let fields = self.problem.fields_at(&trial);
                (self.problem.objective(&trial, &fields), trial, fields)
            });
            if let Some((reached, trial, fields)) = trial
                && reached < self.objective
            {
                self.accept(trial, fields, reached);
                return Step::Lower;
            }
            self.damping *= 10.0;
            self.count += 1;
            if self.damping > 1e12 {
                // No direction leads down.
                return Step::Minimum;
            }
            if self.count >= MAX_ITERATIONS {
                return Step::Failed;
            }
        }
    }

    fn accept(&mut self, z: DVector<f64>, fields: Fields, objective: f64) {
        (self.z, self.fields, self.objective) = (z, fields, objective);
        self.damping = (self.damping * 0.1).max(1e-12);
    }

    fn finish(self) -> Solution {
        self.problem.kalker.finish(self.z, &self.fields, self.count)
    }
}

impl Kalker {
    /// Solves for creepages, from the linear solution or from the coefficients at creepages near these.
    ///
    /// # Errors
    /// See [`KalkerError`]; for every finite creepage there is a result or an error, never a NaN.
    pub fn solve(&self, creepage: &ScaledCreepage, start: Option<&[f64]>) -> Result<Solution, KalkerError> {
        let components = [creepage.x, creepage.y, creepage.spin, creepage.curvature];
        if !components.iter().all(|component| component.is_finite()) {
            return Err(KalkerError::NotFinite(*creepage));
        }
        let size = components.iter().fold(0.0f64, |size, component| size.max(component.abs()));
        let shrink = if size > LARGEST_CREEPAGE { LARGEST_CREEPAGE / size } else { 1.0 };
        let [x, y, spin, curvature] = components.map(|component| component * shrink);
        let scaled = ScaledCreepage { x, y, spin, curvature };
        // A start that belongs to another problem, or is not finite, is not used.
        let usable =
            |start: &&[f64]| start.len() == self.coefficients() && start.iter().all(|z| z.is_finite());
        let z = match start.filter(usable) {
            Some(start) => DVector::from_column_slice(start),
            None => self.linear_start(&scaled),
        };
        let problem = Objective::new(self, &scaled);
        let mut at = Iteration::new(&problem, z);
        while at.count < MAX_ITERATIONS {
            let expansion = problem.expand(&at.z, &at.fields);
            let before = at.objective;
            let enough = DECREASE * before + NEGLIGIBLE * size.min(1.0).powi(2);
            at.count += 1;
            match at.newton(&expansion, enough) {
                Step::Minimum => return Ok(at.finish()),
                Step::Lower => continue,
                Step::Failed => {}
            }
            // Where points change between sticking and sliding for ever, the last digits are not worth more steps.
            let idle =
                |at: &Iteration| at.count > PATIENCE && before - at.objective <= IDLE_DECREASE * before;
            match at.levenberg_marquardt(&expansion) {
                Step::Failed => break,
                Step::Lower if !idle(&at) => {}
                Step::Lower | Step::Minimum => return Ok(at.finish()),
            }
        }
        Err(KalkerError::NoConvergence(*creepage))
    }

    /// Coefficients of the linear solution, brought down where it is far above the bound.
    fn linear_start(&self, h: &ScaledCreepage) -> DVector<f64> {
        // The curvature slip at its mean over the pressure: y^2 = b^2/5.
        let mean = h.x - h.curvature / (5.0 * self.patch.axis_ratio);
        let linear = &self.adhesion * DVector::from_column_slice(&[mean, h.y, h.spin]);
        let excess = linear.amax();
        linear * if excess > 1.0 { 1.0 / excess } else { 1.0 }
    }
}
