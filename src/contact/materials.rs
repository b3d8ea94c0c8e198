//! Elastic constants of two bodies in contact.

/// Elastic constants of a pair of materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// [1/Pa] `(1 - nu1^2)/E1 + (1 - nu2^2)/E2`.
    pub compliance: f64,
    /// \[Pa] combined shear modulus.
    pub shear_modulus: f64,
    /// [-] combined Poisson's ratio.
    pub poisson_ratio: f64,
}

impl Pair {
    /// Two materials, each by Young's modulus \[Pa] and Poisson's ratio (combined as in Kalker 1967).
    pub fn new(materials: [(f64, f64); 2]) -> Self {
        let shear = materials.map(|(youngs, nu)| youngs / (2.0 * (1.0 + nu)));
        let shear_modulus = 2.0 / (1.0 / shear[0] + 1.0 / shear[1]);
        Self {
            compliance: materials.iter().map(|(youngs, nu)| (1.0 - nu * nu) / youngs).sum(),
            shear_modulus,
            poisson_ratio: shear_modulus * (materials[0].1 / shear[0] + materials[1].1 / shear[1]) / 2.0,
        }
    }
}
