//! A diagonally implicit Runge-Kutta method of order 3 whose stages are steps of backward Euler: ESDIRK3(2)5L\[2]SA.
//!
//! Coefficients are those of Kennedy and Carpenter (NASA/TM-2016-219173, section 5): five stages, of which the first is the start of the step, stage
//! order 2, stiffly accurate, L-stable, with an embedded method of order 2. A swing of the frequency w loses little of its amplitude (at four
//! evaluations in 0.4/w 3e-5 a radian; the same authors' method of four stages loses 7e-4 at three in 0.3/w, and HHT 6e-6 at one in 0.1/w, where it
//! misses the phase by 1e-3).
//!
//! For `q' = v`, `v' = a(q, v, t)` stage i at `t + c_i h` is
//! ```text
//! v_i = V_i + g h a_i            V_i = v_0 + h sum_(j<i) A_ij a_j
//! q_i = Q_i + g h v_i            Q_i = q_0 + h sum_(j<i) A_ij v_j
//! ```
//! which is a step of backward Euler of the size `g h` from `Q_i`, `V_i`: all stages have one matrix. The last is the end of the step.

use std::f64::consts::SQRT_2;

/// Stages, with the start of the step.
pub const STAGES: usize = 5;

/// [-] the diagonal: size of the stages over that of the step.
pub const DIAGONAL: f64 = 9.0 / 40.0;

/// [-] weights of earlier stages, by stage; those of the last are the method's own, with [`DIAGONAL`].
pub const EARLIER: [[f64; STAGES - 1]; STAGES] = {
    let second = 9.0 * (1.0 + SQRT_2) / 80.0;
    let third = (22.0 + 15.0 * SQRT_2) / (80.0 * (1.0 + SQRT_2));
    let last = (2398.0 + 1205.0 * SQRT_2) / (2835.0 * (4.0 + 3.0 * SQRT_2));
    [
        [0.0; 4],
        [DIAGONAL, 0.0, 0.0, 0.0],
        [second, second, 0.0, 0.0],
        [third, third, -7.0 / (40.0 * (1.0 + SQRT_2)), 0.0],
        [last, last, -2374.0 * (1.0 + 2.0 * SQRT_2) / (2835.0 * (5.0 + 3.0 * SQRT_2)), 5827.0 / 7560.0],
    ]
};

/// [-] places of the stages in the step.
pub const PLACES: [f64; STAGES] = [0.0, 2.0 * DIAGONAL, 9.0 * (2.0 + SQRT_2) / 40.0, 0.6, 1.0];

/// [-] weights of the embedded method.
const EMBEDDED: [f64; STAGES] = [
    4_555_948_517_383.0 / 24_713_416_420_891.0,
    4_555_948_517_383.0 / 24_713_416_420_891.0,
    -7_107_561_914_881.0 / 25_547_637_784_726.0,
    30_698_249.0 / 44_052_120.0,
    49_563.0 / 233_080.0,
];

/// [-] weights of the stages in a step.
pub const WEIGHTS: [f64; STAGES] = {
    let [start, first, second, third] = EARLIER[STAGES - 1];
    [start, first, second, third, DIAGONAL]
};

/// [-] weights of the local error: the method less the embedded one.
pub const ERROR: [f64; STAGES] = {
    let mut error = WEIGHTS;
    let mut stage = 0;
    while stage < STAGES {
        error[stage] -= EMBEDDED[stage];
        stage += 1;
    }
    error
};

/// [-] weights with which the polynomial through values at some places goes on to another one (Lagrange).
pub fn extrapolation<const N: usize>(places: [f64; N], to: f64) -> [f64; N] {
    std::array::from_fn(|i| {
        let others = (0..N).filter(|k| *k != i);
        others.map(|k| (to - places[k]) / (places[i] - places[k])).product()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identity_conditions_of_order() {
        let places: [f64; STAGES] =
            std::array::from_fn(|i| EARLIER[i].iter().sum::<f64>() + if i > 0 { DIAGONAL } else { 0.0 });
        let all = |i: usize, j: usize| {
            if j < i { EARLIER[i][j] } else { DIAGONAL * f64::from(u8::from(i == j && i > 0)) }
        };
        let sum = |of: &dyn Fn(usize) -> f64| (0..STAGES).map(of).sum::<f64>();
        // Stage order 2: sum of A_ij c_j is c_i^2/2.
        let mean = |i: usize| sum(&|j| all(i, j) * places[j]);
        for i in 0..STAGES {
            assert!((places[i] - PLACES[i]).abs() < 1e-15, "{i}");
            assert!((mean(i) - places[i] * places[i] / 2.0).abs() < 1e-12, "{i}: {}", mean(i));
        }
        for (weights, order) in [(WEIGHTS, 3), (std::array::from_fn(|i| WEIGHTS[i] - ERROR[i]), 2)] {
            assert!((sum(&|i| weights[i]) - 1.0).abs() < 1e-15);
            assert!((sum(&|i| weights[i] * places[i]) - 0.5).abs() < 1e-15);
            let third = [
                sum(&|i| weights[i] * places[i].powi(2)) - 1.0 / 3.0,
                sum(&|i| weights[i] * mean(i)) - 1.0 / 6.0,
            ];
            let reached = third.iter().all(|error| error.abs() < 1e-15);
            assert_eq!(reached, order == 3, "{third:?}");
        }
    }

    #[test]
    fn closed_form_a_polynomial_goes_on() {
        let at = |t: f64| 2.0 - 3.0 * t + 0.5 * t * t;
        let places = [-1.0, 0.0, 0.6];
        let weights = extrapolation(places, 0.9);
        let sum: f64 = weights.iter().zip(places).map(|(weight, t)| weight * at(t)).sum();
        assert!((sum - at(0.9)).abs() < 1e-15);
    }
}
