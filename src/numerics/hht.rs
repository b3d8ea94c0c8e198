//! The HHT scheme (Hilber, Hughes, Taylor 1977) with the paper's damping parameter, accelerations as unknowns.
//!
//! With `alpha_f` in (0, 1/3]: `gamma = 1/2 + alpha_f`, `beta = (1 + alpha_f)^2/4`,
//! `M a1 = (1 - alpha_f) g1 + alpha_f g0`, where g is the total force at the end (1) and start (0) of a step.

use nalgebra::Vector3;

/// Coefficients of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HhtStep {
    /// \[s] step size.
    pub h: f64,
    /// [-] damping parameter.
    pub alpha_f: f64,
    /// [-] Newmark parameter of positions.
    pub beta: f64,
    /// [-] Newmark parameter of velocities.
    pub gamma: f64,
}

impl HhtStep {
    /// A step of size `h` \[s].
    pub fn new(alpha_f: f64, h: f64) -> Self {
        Self { h, alpha_f, beta: 0.25 * (1.0 + alpha_f).powi(2), gamma: 0.5 + alpha_f }
    }

    /// A step of backward Euler of size `h` \[s], of a motion that starts without acceleration: a stage of [`super::esdirk`].
    pub fn backward_euler(h: f64) -> Self {
        Self { h, alpha_f: 0.0, beta: 1.0, gamma: 1.0 }
    }

    /// \[m] displacement over the step from velocity and the accelerations at start and end.
    #[inline(always)]
    pub fn displacement(&self, v0: &Vector3<f64>, a0: &Vector3<f64>, a1: &Vector3<f64>) -> Vector3<f64> {
        v0 * self.h + (a0 * (0.5 - self.beta) + a1 * self.beta) * (self.h * self.h)
    }

    /// [m/s] velocity at the end of the step.
    #[inline(always)]
    pub fn velocity(&self, v0: &Vector3<f64>, a0: &Vector3<f64>, a1: &Vector3<f64>) -> Vector3<f64> {
        v0 + (a0 * (1.0 - self.gamma) + a1 * self.gamma) * self.h
    }

    /// \[s2] derivative of the end position by the end acceleration.
    #[inline(always)]
    pub fn position_gain(&self) -> f64 {
        self.beta * self.h * self.h
    }

    /// \[s] derivative of the end velocity by the end acceleration.
    #[inline(always)]
    pub fn velocity_gain(&self) -> f64 {
        self.gamma * self.h
    }

    /// [s2, s] derivatives of position and velocity by the end acceleration as forces at the end count: by `1 - alpha_f`.
    pub fn force_gains(&self) -> [f64; 2] {
        [self.position_gain(), self.velocity_gain()].map(|gain| (1.0 - self.alpha_f) * gain)
    }

    /// Local error of the position: `(beta - alpha_f/2 - 1/6) h^2 (a1 - a0)` (Geradin and Cardona 2001, ch. 11).
    #[inline(always)]
    pub fn local_error(&self, a0: &Vector3<f64>, a1: &Vector3<f64>) -> Vector3<f64> {
        (a1 - a0) * ((self.beta - 0.5 * self.alpha_f - 1.0 / 6.0) * self.h * self.h)
    }
}
