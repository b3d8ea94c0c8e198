//! A diagonally implicit Runge-Kutta method of order 3 whose stages are steps of backward Euler: ESDIRK3(2)4L\[2]SA.
//!
//! Coefficients are those of Kennedy and Carpenter (Appl. Numer. Math. 44, 2003, 139-181: the implicit half of ARK3(2)4L\[2]SA; NASA/TM-2016-219173,
//! section 5): four stages, of which the first is the start of the step, stage order 2, stiffly accurate, L-stable, with an embedded method of order 2.
//!
//! For `q' = v`, `v' = a(q, v, t)` stage i at `t + c_i h` is
//! ```text
//! v_i = V_i + g h a_i            V_i = v_0 + h sum_(j<i) A_ij a_j
//! q_i = Q_i + g h v_i            Q_i = q_0 + h sum_(j<i) A_ij v_j
//! ```
//! which is a step of backward Euler of the size `g h` from `Q_i`, `V_i`: all stages have one matrix. The last is the end of the step.

/// Stages, with the start of the step.
pub const STAGES: usize = 4;

/// [-] the diagonal: size of the stages over that of the step.
pub const DIAGONAL: f64 = 1_767_732_205_903.0 / 4_055_673_282_236.0;

/// [-] weights of earlier stages, by stage; those of the last are the method's own, with [`DIAGONAL`].
pub const EARLIER: [[f64; STAGES - 1]; STAGES] = [
    [0.0; 3],
    [DIAGONAL, 0.0, 0.0],
    [2_746_238_789_719.0 / 10_658_868_560_708.0, -640_167_445_237.0 / 6_845_629_431_997.0, 0.0],
    [
        1_471_266_399_579.0 / 7_840_856_788_654.0,
        -4_482_444_167_858.0 / 7_529_755_066_697.0,
        11_266_239_266_428.0 / 11_593_286_722_821.0,
    ],
];

/// [-] places of the stages in the step.
pub const PLACES: [f64; STAGES] = [0.0, 2.0 * DIAGONAL, 0.6, 1.0];

/// [-] weights of the embedded method.
const EMBEDDED: [f64; STAGES] = [
    2_756_255_671_327.0 / 12_835_298_489_170.0,
    -10_771_552_573_575.0 / 22_201_958_757_719.0,
    9_247_589_265_047.0 / 10_645_013_368_117.0,
    2_193_209_047_091.0 / 5_459_859_503_100.0,
];

/// [-] weights of the stages in a step.
pub const WEIGHTS: [f64; STAGES] = {
    let [first, second, third] = EARLIER[STAGES - 1];
    [first, second, third, DIAGONAL]
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
