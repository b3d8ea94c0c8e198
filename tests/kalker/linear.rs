//! Kalker's linear theory against independent data and published numbers.

use roulement::kalker::LinearError;
use roulement::kalker::Patch;
use roulement::kalker::creep_coefficients::{along_x, series, shipped};
use roulement::kalker::linear::{adhesion_tractions, creep_matrix, resultants};
use roulement::kalker::load_displacement::LoadDisplacement;

fn patch(axis_ratio: f64, poisson_ratio: f64, rolling_angle: f64) -> Patch {
    Patch { axis_ratio, poisson_ratio, rolling_angle }
}

#[test]
fn independent_data_within_half_a_percent() {
    let mut worst = (0.0, String::new());
    for line in include_str!("../data/contact/creep_coefficients.csv").lines().skip(1) {
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
    for line in include_str!("../data/contact/linear_theory_digits.csv").lines().skip(1) {
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

/// C11, C22, C23 and C33 by the solver.
fn solved(axis_ratio: f64, poisson_ratio: f64) -> Result<[f64; 4], LinearError> {
    let c = creep_matrix(&patch(axis_ratio, poisson_ratio, 0.0))?;
    Ok([c[(0, 0)], c[(1, 1)], c[(1, 2)], c[(2, 2)]])
}

#[test]
fn regression_series_of_creep_coefficients_against_the_solver() {
    // Corners, and places that fill the range evenly: multiples of the powers of the plastic number.
    let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)];
    let inside = (0..300).map(|k| {
        let multiple = |step: f64| (0.5 + step * f64::from(k)).fract();
        (multiple(0.754_877_666_246_693), multiple(0.569_840_290_998_053))
    });
    let mut worst = [0.0f64; 4];
    for (u, v) in corners.into_iter().chain(inside) {
        let (ratio, poisson) = ((0.018 * (55.0f64 / 0.018).powf(u)).clamp(0.018, 55.0), 0.5 * v);
        let expected = solved(ratio, poisson).unwrap();
        for (k, value) in along_x(&patch(ratio, poisson, 0.0)).unwrap().into_iter().enumerate() {
            worst[k] = worst[k].max((value / expected[k] - 1.0).abs());
        }
    }
    println!("{worst:?}");
    assert!(worst.into_iter().all(|error| error < 1e-10), "{worst:?}");
    for (ratio, poisson) in [(0.017, 0.3), (56.0, 0.3), (1.0, 0.6), (f64::NAN, 0.3)] {
        assert!(along_x(&patch(ratio, poisson, 0.0)).is_err());
    }
}

#[test]
fn regression_the_shipped_series_is_what_the_solver_gives() {
    let made = series(solved).unwrap();
    let shipped = shipped();
    assert_eq!(made.len(), shipped.len());
    for (made, shipped) in made.iter().flatten().zip(shipped.iter().flatten()) {
        // Rounding of coefficients up to 50; slender across rolling the solver has 3e-13 of it.
        assert!((made - shipped).abs() < 1e-10, "{made} {shipped}");
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
