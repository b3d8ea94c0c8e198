//! Kalker's nonlinear theory in polynomials as a creep law of simulations, in the same variables as the table.

use super::linear::Scales;
use super::nonlinear::{Kalker, KalkerError};
use super::{Patch, ScaledCreepage};

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

    /// `(F_x/(mu Q), F_y/(mu Q), M_z/M_max)` and the second moment over mu Q b^2, with their derivatives.
    ///
    /// Arguments are linear theory's forces without coupling over the same limits, and the linear force over mu Q of
    /// the slip `kappa b^2`. Where the nonlinear problem does not converge the values are NaN, which no step accepts.
    pub fn evaluate(&self, q: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
        let Scales { c11, c22, c33, moment, .. } = self.scales;
        // scaled creepages by q, results by forces
        let by_q = [1.0 / c11, 1.0 / c22, moment / c33, 1.0 / (c11 * self.width_square)];
        let by_force = [1.0, 1.0, 1.0 / moment, 1.0 / self.width_square];
        let h: [f64; 4] = std::array::from_fn(|k| q[k] * by_q[k]);
        let creepage = ScaledCreepage { x: h[0], y: h[1], spin: h[2], curvature: h[3] };
        let nothing = ([f64::NAN; 4], [[f64::NAN; 4]; 4]);
        let Ok(solution) = self.kalker.solve(&creepage, None) else {
            return nothing;
        };
        let Some(derivatives) = self.kalker.derivatives(&solution, &creepage) else {
            return nothing;
        };
        let f = solution.forces;
        let forces = [f.fx, f.fy, f.mz, f.second_moment];
        (
            std::array::from_fn(|m| forces[m] * by_force[m]),
            std::array::from_fn(|m| std::array::from_fn(|n| derivatives[m][n] * by_force[m] * by_q[n])),
        )
    }
}
