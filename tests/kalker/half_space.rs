//! The project's own reference solver of rolling contact against independent data.

use roulement::kalker::half_space::{HalfSpace, HalfSpaceError, extrapolated, refined};
use roulement::kalker::linear::creep_matrix;
use roulement::kalker::{Patch, ScaledCreepage};

use crate::common::{Case, cases, curves};

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

/// Contacts on grids as fine as they need, against the goals of rolling along an axis: mean and largest errors of force and
/// moment, and the largest ones over the changes by which the grids are chosen.
fn check_refined<'a>(name: &str, cases: impl Iterator<Item = &'a Case>) {
    let (mut mean, mut worst, mut count, mut shares) = ([0.0; 3], [0.0f64; 3], 0.0, 0.0);
    for case in cases {
        let found = refined(&case.patch, &case.creepage).unwrap();
        let f = found.forces;
        let error = [f.fx - case.expected[0], f.fy - case.expected[1], f.mz - case.expected[2]].map(f64::abs);
        for k in 0..3 {
            mean[k] += error[k];
            worst[k] = worst[k].max(error[k]);
        }
        shares += error.into_iter().fold(0.0, f64::max) / found.change.max(0.005);
        count += 1.0;
    }
    let mean = mean.map(|sum| sum / count);
    println!("{name}: mean {mean:.4?} largest {worst:.4?} of {count}, over the change {:.2}", shares / count);
    assert!(mean[0].max(mean[1]) < 0.005 && worst[0].max(worst[1]) < 0.03, "{name}: {mean:?} {worst:?}");
    assert!(mean[2] < 0.01 && worst[2] < 0.05, "{name}: {mean:?} {worst:?}");
}

#[test]
fn independent_data_oblique_rolling_on_refined_grids() {
    check_refined("oblique", cases().iter().filter(|case| case.kind == "oblique"));
}

#[test]
#[ignore = "316 contacts, a quarter of a minute"]
fn independent_data_all_cases_and_curves_on_refined_grids() {
    for kind in ["general", "bearing", "oblique"] {
        check_refined(kind, cases().iter().filter(|case| case.kind == kind));
    }
    check_refined("curves", curves().iter());
}

#[test]
fn invariant_refined_grids_serve_the_whole_range_of_ellipses() {
    // At the ends the coarsest grid has fewest cells across the ellipse; turned by a quarter, the other ellipse is the same.
    for axis_ratio in [0.0183, 54.6] {
        let patch = Patch { axis_ratio, poisson_ratio: 0.3, rolling_angle: 0.0 };
        let across =
            Patch { axis_ratio: 1.0 / axis_ratio, rolling_angle: std::f64::consts::FRAC_PI_2, ..patch };
        let creepage = ScaledCreepage { x: 3.0, y: -2.0, spin: 0.5, curvature: 0.0 };
        let turned = ScaledCreepage { x: 2.0, y: 3.0, ..creepage };
        let [one, other] =
            [(patch, creepage), (across, turned)].map(|(p, h)| refined(&p, &h).unwrap().forces);
        let differences = [one.fx - other.fy, one.fy + other.fx, one.mz - other.mz];
        assert!(differences.iter().all(|difference| difference.abs() < 1e-3), "{one:?} {other:?}");
    }
    let wrong = Patch { axis_ratio: 0.01, poisson_ratio: 0.3, rolling_angle: 0.0 };
    assert!(matches!(refined(&wrong, &ScaledCreepage::default()), Err(HalfSpaceError::Patch(_))));
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
