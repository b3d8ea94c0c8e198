//! Elliptical Hertz contact, exact: complete elliptic integrals by the arithmetic-geometric mean, no curve fits.

use std::f64::consts::PI;

use crate::numerics::elliptic::complete_elliptic_integrals;

/// Curvature difference that belongs to an ellipticity (long over short semi-axis) > 1, minus 0 at 1.
fn curvature_difference(ellipticity: f64) -> f64 {
    let k2 = ellipticity * ellipticity;
    let (first, second) = complete_elliptic_integrals(1.0 - 1.0 / k2);
    ((k2 + 1.0) * second - 2.0 * first) / ((k2 - 1.0) * second)
}

/// Dimensionless Hertz factors of an elliptical contact (Harris and Kotzalas 2006, ch. 6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzFactors {
    /// [-] long over short semi-axis, at least 1.
    pub ellipticity: f64,
    /// [-] `a*` of the long semi-axis.
    pub long: f64,
    /// [-] `b*` of the short semi-axis.
    pub short: f64,
    /// [-] `delta*` of the approach.
    pub approach: f64,
}

impl HertzFactors {
    /// Factors at a curvature difference F in [0, 1).
    pub fn new(difference: f64) -> Self {
        // F is 3/4 (k - 1) to first order; its closed form loses all digits there.
        const NEARLY_ROUND: f64 = 1e-6;
        let k = if difference < NEARLY_ROUND {
            1.0 + 4.0 / 3.0 * difference
        } else {
            solve_ellipticity(difference)
        };
        let (first, second) = complete_elliptic_integrals(1.0 - 1.0 / (k * k));
        Self {
            ellipticity: k,
            long: (2.0 * k * k * second / PI).cbrt(),
            short: (2.0 * second / (PI * k)).cbrt(),
            approach: 2.0 * first / PI * (PI / (2.0 * k * k * second)).cbrt(),
        }
    }
}

/// Inverts [`curvature_difference`] by bisection in ln k, finished by the secant rule inside the bracket.
fn solve_ellipticity(difference: f64) -> f64 {
    let (mut low, mut high) = (1e-9f64, 30.0f64);
    let mut residuals = (-difference, 1.0 - difference);
    let mut x = 0.5 * (low + high);
    for iteration in 0..200 {
        let residual = curvature_difference(x.exp()) - difference;
        if residual < 0.0 {
            (low, residuals.0) = (x, residual);
        } else {
            (high, residuals.1) = (x, residual);
        }
        let secant = low - residuals.0 * (high - low) / (residuals.1 - residuals.0);
        let next =
            if iteration % 2 == 0 && secant > low && secant < high { secant } else { 0.5 * (low + high) };
        if (high - low) < 1e-15 * high || next == x {
            break;
        }
        x = next;
    }
    x.exp()
}

/// Load-independent part of a Hertz contact: everything scales with powers of the approach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzContact {
    /// [N/m^1.5] `Q = stiffness delta^1.5` (paper eq. 8).
    pub stiffness: f64,
    /// [m^0.5] semi-axis along rolling = this times `sqrt(delta)`.
    pub semi_axis_rolling: f64,
    /// [m^0.5] semi-axis transverse to rolling = this times `sqrt(delta)`.
    pub semi_axis_transverse: f64,
}

impl HertzContact {
    /// Contact of relative curvatures [1/m] along and transverse to rolling (convex positive, sums of both bodies),
    /// with `compliance` = `(1 - nu1^2)/E1 + (1 - nu2^2)/E2` [1/Pa].
    pub fn new(curvature_rolling: f64, curvature_transverse: f64, compliance: f64) -> Self {
        let sum = curvature_rolling + curvature_transverse;
        let factors = HertzFactors::new((curvature_rolling - curvature_transverse).abs() / sum);
        // delta = delta* (1.5 Q c/S)^(2/3) S/2 and a = a* (1.5 Q c/S)^(1/3), hence a = a* sqrt(2 delta/(delta* S)).
        let per_root = (2.0 / (factors.approach * sum)).sqrt();
        let stiffness = per_root.powi(3) * sum / (1.5 * compliance);
        let (long, short) = (factors.long * per_root, factors.short * per_root);
        let (rolling, transverse) =
            if curvature_rolling > curvature_transverse { (short, long) } else { (long, short) };
        Self { stiffness, semi_axis_rolling: rolling, semi_axis_transverse: transverse }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[rustfmt::skip]
    fn independent_data_hertz_factors() {
        // F, kappa, a*, b*, d* of an independent solver (tests/data/bearing/README.md), printed to six decimals.
        let table = [
            [0.0, 1.0, 1.0, 1.0, 1.0],
            [0.10, 1.143113, 1.070359, 0.936354, 0.997768],
            [0.50, 2.071990, 1.485824, 0.717100, 0.937592],
            [0.80, 4.209643, 2.291549, 0.544357, 0.791812],
            [0.90, 6.713279, 3.092852, 0.460707, 0.679925],
            [0.94, 9.288373, 3.824011, 0.411699, 0.603103],
            [0.98, 18.080310, 5.937445, 0.328393, 0.459296],
            [0.99, 27.128720, 7.774234, 0.286568, 0.383904],
        ];
        for [difference, ellipticity, long, short, approach] in table {
            let factors = HertzFactors::new(difference);
            for (ours, theirs) in [
                (factors.ellipticity, ellipticity), (factors.long, long),
                (factors.short, short), (factors.approach, approach),
            ] {
                // Half of the last printed digit.
                assert!((ours - theirs).abs() < 5.01e-7, "F = {difference}: {ours} against {theirs}");
            }
        }
    }

    #[test]
    fn closed_form_sphere_on_plane() {
        // a^2 = R delta and Q = 4/3 E* sqrt(R) delta^1.5 with 1/E* = compliance (Hertz 1882).
        let (radius, compliance) = (6.35e-3, 2.0 * (1.0 - 0.09) / 206e9);
        let contact = HertzContact::new(1.0 / radius, 1.0 / radius, compliance);
        let stiffness = 4.0 / 3.0 / compliance * radius.sqrt();
        assert!((contact.stiffness / stiffness - 1.0).abs() < 1e-12);
        assert!((contact.semi_axis_rolling / radius.sqrt() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn closed_form_nearly_round_contacts() {
        // kappa - 1 = 4/3 F to first order, on both sides of where the series takes over; the closed form has lost ten digits
        // there.
        for difference in [1e-9, 0.99e-6, 1.01e-6, 1e-5] {
            let elongation = HertzFactors::new(difference).ellipticity - 1.0;
            assert!(
                (elongation / (4.0 / 3.0 * difference) - 1.0).abs() < 1e-4,
                "F = {difference}: {elongation}"
            );
        }
    }

    #[test]
    fn invariant_under_exchange_of_the_axes() {
        let (one, other) = (HertzContact::new(300.0, 8.0, 1e-11), HertzContact::new(8.0, 300.0, 1e-11));
        assert_eq!(one.stiffness, other.stiffness);
        assert_eq!(one.semi_axis_rolling, other.semi_axis_transverse);
    }

    #[test]
    fn elliptic_integrals_satisfy_legendre_relation() {
        for m in [1e-9, 0.1, 0.5, 0.9, 0.999, 1.0 - 1e-9] {
            let ((k, e), (kc, ec)) = (complete_elliptic_integrals(m), complete_elliptic_integrals(1.0 - m));
            assert!((e * kc + ec * k - k * kc - PI / 2.0).abs() < 1e-11, "m = {m}");
        }
    }
}
