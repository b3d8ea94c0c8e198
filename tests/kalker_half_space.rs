//! The project's own reference solver of rolling contact against independent data.
#![allow(clippy::unwrap_used)]

mod common;

use common::cases;
use roulement::kalker::half_space::{HalfSpace, HalfSpaceError, extrapolated};
use roulement::kalker::linear::creep_matrix;
use roulement::kalker::{Patch, ScaledCreepage};

/// Mean and largest error of forces and moment over some of the cases, on grids of n and 2 n cells.
fn errors(every: usize, n: usize) -> [(f64, f64); 2] {
    let (mut force, mut moment, mut count) = ((0.0, 0.0f64), (0.0, 0.0f64), 0.0);
    for case in cases().iter().step_by(every) {
        let f = extrapolated(&case.patch, &case.creepage, n).unwrap();
        let error = [f.fx - case.expected[0], f.fy - case.expected[1], f.mz - case.expected[2]].map(f64::abs);
        force = (force.0 + 0.5 * (error[0] + error[1]), force.1.max(error[0]).max(error[1]));
        moment = (moment.0 + error[2], moment.1.max(error[2]));
        count += 1.0;
    }
    [(force.0 / count, force.1), (moment.0 / count, moment.1)]
}

fn check(every: usize, n: usize) {
    let [force, moment] = errors(every, n);
    println!("force mean {:.4} max {:.4}, moment mean {:.4} max {:.4}", force.0, force.1, moment.0, moment.1);
    assert!(force.0 < 0.005 && force.1 < 0.03, "{force:?}");
    assert!(moment.0 < 0.01 && moment.1 < 0.05, "{moment:?}");
}

#[test]
fn independent_data_every_fourth_case() {
    check(4, 16);
}

/// All cases on finer grids; `scripts/soak` runs it.
#[test]
#[ignore = "takes a minute"]
fn independent_data_all_cases_long() {
    check(1, 24);
}

#[test]
fn closed_form_full_adhesion_is_linear_theory() {
    // Small creepages: 3/(2 pi) C h. Cells of 1/32 of the ellipse resolve the singular trailing edge to a few percent.
    let patch = Patch { axis_ratio: 1.0, poisson_ratio: 0.3, rolling_angle: 0.0 };
    let matrix = creep_matrix(&patch).unwrap();
    let h = 1e-3;
    for (creepage, row, column) in [
        (ScaledCreepage { x: h, y: 0.0, spin: 0.0, curvature: 0.0 }, 0, 0),
        (ScaledCreepage { x: 0.0, y: h, spin: 0.0, curvature: 0.0 }, 1, 1),
        (ScaledCreepage { x: 0.0, y: 0.0, spin: h, curvature: 0.0 }, 1, 2),
    ] {
        let f = extrapolated(&patch, &creepage, 16).unwrap();
        let ours = [f.fx, f.fy, f.mz][row];
        let linear = 1.5 / std::f64::consts::PI * matrix[(row, column)] * h;
        assert!((ours / linear - 1.0).abs() < 0.02, "{ours} {linear}");
    }
}

#[test]
fn closed_form_full_slip_under_pure_spin() {
    // 3 pi/16 on a circle; 1.20487 at axis ratio 0.1 (tests/data/contact/README.md, contact of complete slip).
    for (axis_ratio, expected) in [(1.0, 3.0 * std::f64::consts::PI / 16.0), (0.1, 1.20487)] {
        let patch = Patch { axis_ratio, poisson_ratio: 0.3, rolling_angle: 0.0 };
        let f =
            extrapolated(&patch, &ScaledCreepage { x: 0.0, y: 0.0, spin: 1e4, curvature: 0.0 }, 16).unwrap();
        assert!((f.mz / expected - 1.0).abs() < 5e-3 && f.fx.abs() < 1e-6 && f.fy.abs() < 2e-2, "{f:?}");
    }
}

#[test]
fn wrong_input_is_refused() {
    let patch = Patch { axis_ratio: 1.0, poisson_ratio: 0.3, rolling_angle: 0.0 };
    assert!(matches!(HalfSpace::new(&patch, 2), Err(HalfSpaceError::Grid(2))));
    let solver = HalfSpace::new(&patch, 8).unwrap();
    let creepage = ScaledCreepage { x: f64::NAN, y: 0.0, spin: 0.0, curvature: 0.0 };
    assert!(matches!(solver.solve(&creepage, None), Err(HalfSpaceError::NotFinite(_))));
}
