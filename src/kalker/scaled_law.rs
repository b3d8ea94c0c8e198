//! Kalker's nonlinear theory in polynomials as a creep law, in the same variables as the table.
//!
//! Its minimum jumps where points of the grid change between sticking and sliding, so that an implicit step may have no
//! solution. In simulations it is therefore frozen for each step as a [`Difference`] from the smooth table.

use serde::{Deserialize, Serialize};

use super::linear::Scales;
use super::nonlinear::{Kalker, KalkerError};
use super::solution::Solution;
use super::{Patch, ScaledCreepage};
use crate::numerics::scalar::{SmoothMap, Values};

/// [-] change of q over `1 + |q|` beyond which the last solution is no start for the next.
const NEAR: f64 = 0.5;

/// Results of the polynomials less those of the table at one contact, frozen between renewals.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Arguments q of [`ScaledKalker::evaluate`] at the last renewal.
    pub place: [f64; 4],
    /// Results there less those of the table.
    pub value: [f64; 4],
    /// Coefficients of the traction polynomials there; none before the first renewal.
    pub coefficients: Vec<f64>,
}

impl Difference {
    /// Can these polynomials have this difference? A check for states that come from outside.
    pub fn fits(&self, kalker: Option<&ScaledKalker>) -> bool {
        let number = kalker.map_or(0, |kalker| kalker.kalker.coefficients());
        (self.coefficients.is_empty() || self.coefficients.len() == number)
            && self.place.iter().chain(&self.value).chain(&self.coefficients).all(|x| x.is_finite())
    }

    /// [-] largest change of q since the last renewal, over `1 + |q|`; infinite before the first.
    pub fn age(&self, q: &[f64; 4]) -> f64 {
        if self.coefficients.is_empty() {
            return f64::INFINITY;
        }
        let size = q.iter().fold(0.0f64, |size, q| size.max(q.abs()));
        let moved = q.iter().zip(&self.place).fold(0.0f64, |moved, (q, place)| moved.max((q - place).abs()));
        moved / (1.0 + size)
    }
}

/// [`ScaledKalker::evaluate`] from a start: coefficients at nearby creepages, or the linear solution.
#[derive(Clone, Copy, Debug)]
pub struct PolynomialsFrom<'a> {
    /// The theory.
    pub kalker: &'a ScaledKalker,
    /// Coefficients.
    pub start: Option<&'a [f64]>,
}

impl SmoothMap<4, 4> for PolynomialsFrom<'_> {
    fn values<V: Values>(&self, x: [V; 4]) -> [V; 4] {
        let Self { kalker, start } = *self;
        V::each(x, |q| {
            let solution = kalker.kalker.solve(&kalker.creepage(&q), start);
            solution.map_or([f64::NAN; 4], |solution| kalker.results(&solution))
        })
    }

    fn with_gradient(&self, x: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
        self.kalker.evaluate_from(x, self.start)
    }
}

/// The nonlinear theory of one patch that rolls along the x axis of its ellipse.
#[derive(Clone, Debug)]
pub struct ScaledKalker {
    kalker: Kalker,
    scales: Scales,
    /// [-] square of the semi-axis across rolling over c.
    width_square: f64,
}

impl ScaledKalker {
    /// Prepares the law for traction polynomials of a degree.
    ///
    /// # Errors
    /// See [`KalkerError`].
    pub fn new(patch: &Patch, degree: usize) -> Result<Self, KalkerError> {
        let aligned = Patch { rolling_angle: 0.0, ..*patch };
        let scales = Scales::new(&aligned)?;
        Ok(Self { kalker: Kalker::new(aligned, degree)?, scales, width_square: 1.0 / patch.axis_ratio })
    }

    /// Scaled creepages by q, and results by forces.
    fn factors(&self) -> ([f64; 4], [f64; 4]) {
        let Scales { c11, c22, c33, moment, .. } = self.scales;
        let by_q = [1.0 / c11, 1.0 / c22, moment / c33, 1.0 / (c11 * self.width_square)];
        (by_q, [1.0, 1.0, 1.0 / moment, 1.0 / self.width_square])
    }

    fn creepage(&self, q: &[f64; 4]) -> ScaledCreepage {
        let (by_q, _) = self.factors();
        let [x, y, spin, curvature] = std::array::from_fn(|k| q[k] * by_q[k]);
        ScaledCreepage { x, y, spin, curvature }
    }

    fn results(&self, solution: &Solution) -> [f64; 4] {
        let (_, by_force) = self.factors();
        let f = solution.forces;
        let forces = [f.fx, f.fy, f.mz, f.second_moment];
        std::array::from_fn(|m| forces[m] * by_force[m])
    }

    /// `(F_x/(mu Q), F_y/(mu Q), M_z/M_max)` and the second moment over mu Q b^2, with their derivatives.
    ///
    /// Arguments are linear theory's forces without coupling over the same limits, and the linear force over mu Q of
    /// the slip `kappa b^2`. Where the nonlinear problem does not converge the values are NaN, which no step accepts.
    pub fn evaluate(&self, q: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
        self.evaluate_from(q, None)
    }

    fn evaluate_from(&self, q: [f64; 4], start: Option<&[f64]>) -> ([f64; 4], [[f64; 4]; 4]) {
        let (by_q, by_force) = self.factors();
        let creepage = self.creepage(&q);
        let nothing = ([f64::NAN; 4], [[f64::NAN; 4]; 4]);
        let Ok(solution) = self.kalker.solve(&creepage, start) else {
            return nothing;
        };
        let Some(derivatives) = self.kalker.derivatives(&solution, &creepage) else {
            return nothing;
        };
        let slopes =
            std::array::from_fn(|m| std::array::from_fn(|n| derivatives[m][n] * by_force[m] * by_q[n]));
        (self.results(&solution), slopes)
    }

    /// Renews a difference at q, where the table gives `table`, from the last solution if that is near.
    ///
    /// # Errors
    /// See [`KalkerError`]; the difference then stays what it was.
    pub fn renew(
        &self,
        difference: &mut Difference,
        q: [f64; 4],
        table: [f64; 4],
    ) -> Result<(), KalkerError> {
        let start = (difference.age(&q) < NEAR).then_some(difference.coefficients.as_slice());
        let solution = self.kalker.solve(&self.creepage(&q), start)?;
        let results = self.results(&solution);
        *difference = Difference {
            place: q,
            value: std::array::from_fn(|m| results[m] - table[m]),
            coefficients: solution.coefficients.as_slice().to_vec(),
        };
        Ok(())
    }
}
