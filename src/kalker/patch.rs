//! The contact patch that Kalker's theories are solved for, and its ranges.

use thiserror::Error;

/// Ranges of the axis ratio and of Poisson's ratio.
pub(super) const RATIO: (f64, f64) = (0.018, 55.0);
pub(super) const POISSON: (f64, f64) = (0.0, 0.5);

/// A rolling contact patch as Kalker's theory knows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// [-] semi-axis along the ellipse's x axis over the one along y, 0.018 to 55.
    pub axis_ratio: f64,
    /// [-] Poisson's ratio of both bodies, 0 to 0.5.
    pub poisson_ratio: f64,
    /// \[rad] direction of rolling measured from the ellipse's x axis; 0 is rolling along x.
    pub rolling_angle: f64,
}

/// Why there is no solution.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum LinearError {
    /// Axis ratio out of range.
    #[error("axis ratio {0} of the contact ellipse (rolling over transverse) is outside [0.018, 55]")]
    AxisRatio(f64),
    /// Poisson's ratio out of range.
    #[error("Poisson's ratio {0} is outside [0, 0.5]")]
    PoissonRatio(f64),
    /// Rolling direction that is not a number.
    #[error("rolling direction {0} rad is not a finite number")]
    RollingAngle(f64),
    /// The linear system is singular, which no valid patch leads to.
    #[error("the linear theory has no solution for {0:?}")]
    Singular(Patch),
}

impl Patch {
    /// Checks the ranges of a patch.
    ///
    /// # Errors
    /// Names the value that is out of range.
    pub fn check(&self) -> Result<(), LinearError> {
        if !(RATIO.0..=RATIO.1).contains(&self.axis_ratio) {
            return Err(LinearError::AxisRatio(self.axis_ratio));
        }
        if !(POISSON.0..=POISSON.1).contains(&self.poisson_ratio) {
            return Err(LinearError::PoissonRatio(self.poisson_ratio));
        }
        if !self.rolling_angle.is_finite() {
            return Err(LinearError::RollingAngle(self.rolling_angle));
        }
        Ok(())
    }
}
