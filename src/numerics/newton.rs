//! Newton's method with exact tangents, used sparingly, and a backtracking line search.

use serde::{Deserialize, Serialize};

/// [-] default of [`Equations::refactor_contraction`].
pub const REFACTOR_CONTRACTION: f64 = 0.3;

/// How long a solve goes on before it gives up.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// Largest number of residual evaluations.
    evaluations: u32,
    /// Halvings of one line search.
    halvings: u32,
}

impl Patience {
    /// A well-behaved step takes two or three evaluations: more than these tell that another guess may lead there sooner.
    pub const USUAL: Self = Self { evaluations: 25, halvings: 6 };
    /// Friction at rest turns round within micrometres a second, and a correction that comes from beyond sees next to no slope: it is halved until
    /// it ends within them, and again for each contact that turns round. A bearing at rest under an alternating load took 1.6 times the steps
    /// and twice the time without this, as one solve in eight failed.
    pub const ALL: Self = Self { evaluations: 200, halvings: 20 };
}

/// A system of equations to be solved for its unknowns.
pub trait Equations {
    /// Evaluates the residual at `unknowns`, and the tangent there if asked for.
    ///
    /// Returns the residual's norm in units of its tolerance: 1 or less is converged. Not finite is a failure.
    fn residual(&mut self, unknowns: &[f64], with_tangent: bool) -> f64;

    /// Is there a tangent of an earlier solve to begin with?
    fn has_tangent(&self) -> bool {
        false
    }

    /// Writes the Newton correction of the last residual with the last tangent; false if that is singular.
    fn correction(&mut self, correction: &mut [f64]) -> bool;

    /// [-] a correction that leaves more than this fraction of the residual asks for a new tangent.
    fn refactor_contraction(&self) -> f64 {
        REFACTOR_CONTRACTION
    }
}

/// Work of one or many solves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct NewtonWork {
    /// Corrections applied.
    pub iterations: u64,
    /// Tangents computed and factorised.
    pub factorisations: u64,
}

/// Why a solve ended without a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewtonFailure {
    /// The tangent is singular.
    Singular,
    /// The residual is not finite at the start.
    NotFinite,
    /// The line search found no descent, or the evaluations ran out.
    NoConvergence,
}

/// Buffers of [`solve`], kept between calls.
#[derive(Clone, Debug, Default)]
pub struct NewtonBuffers {
    correction: Vec<f64>,
    trial: Vec<f64>,
}

/// Solves the equations from the given start; on success `unknowns` is a point whose residual was evaluated last and
/// is converged. Never returns an unconverged point.
///
/// # Errors
/// See [`NewtonFailure`].
pub fn solve(
    equations: &mut impl Equations,
    unknowns: &mut [f64],
    buffers: &mut NewtonBuffers,
    work: &mut NewtonWork,
    patience: Patience,
) -> Result<(), NewtonFailure> {
    let NewtonBuffers { correction, trial } = buffers;
    correction.resize(unknowns.len(), 0.0);
    trial.resize(unknowns.len(), 0.0);

    let mut tangent_is_here = !equations.has_tangent();
    let mut norm = equations.residual(unknowns, tangent_is_here);
    work.factorisations += u64::from(tangent_is_here);
    let mut evaluations = 1;
    if !norm.is_finite() {
        return Err(NewtonFailure::NotFinite);
    }
    while norm > 1.0 {
        if !equations.correction(correction) {
            return Err(NewtonFailure::Singular);
        }
        work.iterations += 1;

        // full step first, then backtrack until the residual falls
        let mut length = 1.0;
        let mut halvings = 0;
        let trial_norm = loop {
            for ((t, u), c) in trial.iter_mut().zip(&*unknowns).zip(&*correction) {
                *t = u + length * c;
            }
            let trial_norm = equations.residual(trial, false);
            evaluations += 1;
            let descends = trial_norm < norm * (1.0 - 1e-4 * length);
            if trial_norm <= 1.0 || descends {
                break Some(trial_norm);
            }
            // No descent along an old tangent's direction says little: shorter steps are not tried.
            if halvings == patience.halvings || evaluations >= patience.evaluations || !tangent_is_here {
                break None;
            }
            halvings += 1;
            length *= 0.5;
        };
        let contraction = match trial_norm {
            Some(trial_norm) => {
                unknowns.copy_from_slice(trial);
                tangent_is_here = false;
                trial_norm / std::mem::replace(&mut norm, trial_norm)
            }
            None if !tangent_is_here && evaluations < patience.evaluations => f64::INFINITY,
            None => return Err(NewtonFailure::NoConvergence),
        };
        if norm > 1.0 && evaluations >= patience.evaluations {
            return Err(NewtonFailure::NoConvergence);
        }
        if norm > 1.0 && contraction > equations.refactor_contraction() {
            norm = equations.residual(unknowns, true);
            work.factorisations += 1;
            evaluations += 1;
            tangent_is_here = true;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x^3 = target.
    struct Cube {
        target: f64,
        residual: f64,
        slope: f64,
        /// Is the slope that of an earlier solve?
        old: bool,
    }

    impl Equations for Cube {
        fn residual(&mut self, x: &[f64], with_tangent: bool) -> f64 {
            self.residual = x[0].powi(3) - self.target;
            if with_tangent {
                self.slope = 3.0 * x[0] * x[0];
            }
            self.residual.abs() / 1e-12
        }
        fn has_tangent(&self) -> bool {
            self.old
        }
        fn correction(&mut self, correction: &mut [f64]) -> bool {
            correction[0] = -self.residual / self.slope;
            self.slope != 0.0
        }
    }

    #[test]
    fn closed_form_root_and_typed_failures() {
        let run = |target: f64, start: f64| {
            let mut x = [start];
            let mut work = NewtonWork::default();
            let mut equations = Cube { target, residual: 0.0, slope: 0.0, old: false };
            (
                solve(&mut equations, &mut x, &mut NewtonBuffers::default(), &mut work, Patience::USUAL),
                x[0],
                work,
            )
        };
        let (result, root, work) = run(8.0, 1.5);
        assert_eq!(result, Ok(()));
        assert!((root - 2.0).abs() < 1e-12 && work.iterations >= work.factorisations);
        assert_eq!(run(8.0, 0.0).0, Err(NewtonFailure::Singular));
        assert_eq!(run(8.0, f64::NAN).0, Err(NewtonFailure::NotFinite));
        // A residual that cannot reach its tolerance (its round-off is larger) is never accepted.
        assert_eq!(run(1e9 + 0.1, 1.0).0, Err(NewtonFailure::NoConvergence));
    }
    #[test]
    fn closed_form_root_by_an_old_tangent_as_long_as_it_leads_there() {
        let run = |slope: f64| {
            let mut x = [1.9];
            let mut work = NewtonWork::default();
            let mut equations = Cube { target: 8.0, residual: 0.0, slope, old: true };
            let result =
                solve(&mut equations, &mut x, &mut NewtonBuffers::default(), &mut work, Patience::USUAL);
            (result, (x[0] - 2.0).abs() < 1e-12, work.factorisations)
        };
        // 12 is the slope at the root: each correction leaves some percent.
        assert_eq!(run(12.0), (Ok(()), true, 0));
        // A slope that is too steep converges too slowly, one too flat or of the wrong sign diverges: then a new tangent is
        // computed, and one or two are enough.
        for useless in [120.0, 1.0, -12.0] {
            let (result, solved, factorisations) = run(useless);
            assert_eq!((result, solved), (Ok(()), true));
            assert!((1..=2).contains(&factorisations), "{useless}: {factorisations}");
        }
    }
}
