//! Linear theory, interpolated in a short table (placeholder until solved).

use super::Patch;

/// Creep coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CreepCoefficients {
    /// C11
    pub c11: f64,
    /// C22
    pub c22: f64,
    /// C23
    pub c23: f64,
    /// C33
    pub c33: f64,
}

/// Error.
#[derive(Debug, thiserror::Error)]
#[error("no creep coefficients for {0:?}")]
pub struct LinearError(Patch);

/// Coefficients.
pub fn creep_coefficients(patch: Patch) -> Result<CreepCoefficients, LinearError> {
    let rows = [
        [0.05f64, 3.527, 2.487, 0.4182, 17.60],
        [0.1, 3.541, 2.529, 0.5093, 8.839],
        [0.2, 3.590, 2.640, 0.6345, 4.511],
        [0.5, 3.821, 3.039, 0.9526, 1.986],
        [1.0, 4.294, 3.728, 1.4962, 1.1794],
        [2.0, 5.274, 5.030, 2.687, 0.788],
        [20.0, 19.07, 22.34, 35.10, 0.424],
    ];
    let x = patch.axis_ratio.ln();
    for pair in rows.windows(2) {
        let (x0, x1) = (pair[0][0].ln(), pair[1][0].ln());
        if x <= x1 + 1e-9 {
            let t = (x - x0) / (x1 - x0);
            let f = |i: usize| (pair[0][i].ln() * (1.0 - t) + pair[1][i].ln() * t).exp();
            return Ok(CreepCoefficients {
                c11: f(1),
                c22: f(2),
                c23: f(3),
                c33: f(4),
            });
        }
    }
    Err(LinearError(patch))
}
