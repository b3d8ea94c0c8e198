//! Kalker's linear theory against independent data and published numbers.
#![allow(clippy::unwrap_used)]

use roulement::kalker::Patch;
use roulement::kalker::linear::{adhesion_tractions, creep_matrix, resultants};
use roulement::kalker::load_displacement::LoadDisplacement;

fn patch(axis_ratio: f64, poisson_ratio: f64, rolling_angle: f64) -> Patch {
    Patch { axis_ratio, poisson_ratio, rolling_angle }
}

#[test]
fn independent_data_within_half_a_percent() {
    let mut worst = (0.0, String::new());
    for line in include_str!("data/contact/creep_coefficients.csv").lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let ours = creep_matrix(&patch(row[1], row[0], 0.0)).unwrap();
        for (value, expected) in [
            (ours[(0, 0)], row[2]),
            (ours[(1, 1)], row[3]),
            (ours[(1, 2)], row[4]),
            (ours[(2, 1)], row[5]),
            (ours[(2, 2)], row[6]),
        ] {
            let error = (value / expected - 1.0f64).abs();
            if error > worst.0 {
                worst = (error, line.to_string());
            }
        }
        for (i, k) in [(0, 1), (0, 2), (1, 0), (2, 0)] {
            // Zero by symmetry.
            assert!(ours[(i, k)].abs() < 1e-13 * ours.amax(), "{line}: {ours}");
        }
    }
    println!("{worst:?}");
    assert!(worst.0 < 5e-3, "{worst:?}");
}

#[test]
fn order_slender_ellipses_within_half_a_percent_of_a_higher_degree() {
    // Beyond the independent data: degree 9 as it is used, against degree 13.
    let high = LoadDisplacement::new(13);
    let mut worst = 0.0f64;
    for ratio in [0.0185, 0.03, 33.0, 54.0] {
        let patch = patch(ratio, 0.3, 0.0);
        let (ours, tractions) = (creep_matrix(&patch).unwrap(), adhesion_tractions(&patch, &high).unwrap());
        let higher = resultants(&patch, high.basis()) * tractions;
        for place in [(0, 0), (1, 1), (1, 2), (2, 1), (2, 2)] {
            worst = worst.max((ours[place] / higher[place] - 1.0).abs());
        }
    }
    println!("{worst:.4}");
    assert!(worst < 5e-3, "{worst}");
}

/// Rounding alone: the same discrete problem solved with 50 digits. The condition number of the least squares on the edge
/// is below 3e6 here.
#[test]
fn fifty_digits_are_reached_to_rounding() {
    for line in include_str!("data/contact/linear_theory_digits.csv").lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let ours = creep_matrix(&patch(row[1], row[0], 0.0)).unwrap();
        let places = [(0, 0), (1, 1), (1, 2), (2, 1), (2, 2)];
        // Slender across rolling, b^9 is a million: 3e-13 there, 7e-15 elsewhere.
        let tolerance = if row[1] < 0.1 { 2e-12 } else { 5e-14 };
        for (place, expected) in places.into_iter().zip(&row[2..]) {
            let error = (ours[place] / expected - 1.0f64).abs();
            assert!(error < tolerance, "{line} {place:?}: {error:e}");
        }
        for place in [(0, 1), (0, 2), (1, 0), (2, 0)] {
            assert!(ours[place].abs() < 1e-13 * ours.amax(), "{line}: zero by symmetry, {ours}");
        }
    }
}

#[test]
fn published_numbers_of_the_circle() {
    // Kalker 1967, a/b = 1, nu = 0.25: C11 4.11, C22 3.67, C23 1.47, C33 1.19 (1.18 when solved to high order).
    let ours = creep_matrix(&patch(1.0, 0.25, 0.0)).unwrap();
    for (value, expected, digit) in [
        (ours[(0, 0)], 4.11, 0.01),
        (ours[(1, 1)], 3.67, 0.01),
        (ours[(1, 2)], 1.47, 0.01),
        (ours[(2, 2)], 1.18, 0.01),
    ] {
        assert!((value - expected).abs() < digit, "{value} against {expected}");
    }
}

#[test]
fn invariant_spin_coupling_is_skew_for_every_direction() {
    // C32 = -C23 is the reciprocity of the problem: rolling backwards transposes the matrix.
    for ratio in [0.1, 1.0, 4.0] {
        for angle in [0.0, 0.3, 1.2, 2.5] {
            let forward = creep_matrix(&patch(ratio, 0.3, angle)).unwrap();
            let backward = creep_matrix(&patch(ratio, 0.3, angle + std::f64::consts::PI)).unwrap();
            let difference = (forward - backward.transpose()).amax();
            assert!(difference < 2e-3 * forward.amax(), "{ratio} {angle}: {difference}");
        }
    }
}

#[test]
fn invariant_rolling_along_y_is_rolling_along_x_of_the_turned_ellipse() {
    let quarter = std::f64::consts::FRAC_PI_2;
    for ratio in [0.1, 0.5, 1.0, 3.0] {
        let along_y = creep_matrix(&patch(ratio, 0.3, quarter)).unwrap();
        let along_x = creep_matrix(&patch(1.0 / ratio, 0.3, 0.0)).unwrap();
        // New x is old y, new y is old -x.
        let pairs = [
            (along_y[(1, 1)], along_x[(0, 0)]),
            (along_y[(0, 0)], along_x[(1, 1)]),
            (-along_y[(0, 2)], along_x[(1, 2)]),
            (along_y[(2, 2)], along_x[(2, 2)]),
        ];
        for (one, other) in pairs {
            assert!((one / other - 1.0).abs() < 1e-6, "{ratio}: {one} {other}");
        }
    }
}

#[test]
fn invariant_a_circle_rolls_alike_in_all_directions() {
    let along = creep_matrix(&patch(1.0, 0.3, 0.0)).unwrap();
    for angle in [0.4f64, 1.0, 2.0] {
        let turned = creep_matrix(&patch(1.0, 0.3, angle)).unwrap();
        let (s, c) = angle.sin_cos();
        let turn = nalgebra::Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
        assert!((turn * along * turn.transpose() - turned).amax() < 1e-4 * along.amax());
    }
}

#[test]
fn patches_out_of_range_are_refused() {
    for (ratio, poisson, angle) in
        [(0.017, 0.3, 0.0), (56.0, 0.3, 0.0), (1.0, 0.6, 0.0), (1.0, 0.3, f64::NAN), (f64::NAN, 0.3, 0.0)]
    {
        assert!(creep_matrix(&patch(ratio, poisson, angle)).is_err());
    }
}
