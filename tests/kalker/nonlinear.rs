//! Kalker's nonlinear theory in polynomials against independent data, and what must hold for any creepage.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use roulement::kalker::half_space::extrapolated;
use roulement::kalker::linear::creep_matrix;
use roulement::kalker::nonlinear::{Kalker, KalkerError};
use roulement::kalker::{Patch, ScaledCreepage, ScaledForces};

use crate::common::{cases, curves};
use crate::printed::Printed;
use crate::random::Random;

/// Mean errors of fx, fy, mz and the largest force error, by kind of case.
fn errors(degree: usize) -> BTreeMap<String, ([f64; 3], f64, f64, f64)> {
    let mut table: BTreeMap<String, ([f64; 3], f64, f64, f64)> = BTreeMap::new();
    for case in cases() {
        let kalker = Kalker::new(case.patch, degree).unwrap();
        let solution = kalker.solve(&case.creepage, None).unwrap();
        let f = solution.forces;
        let row = table.entry(case.kind).or_default();
        for (i, (ours, theirs)) in [f.fx, f.fy, f.mz].into_iter().zip(case.expected).enumerate() {
            let error = (ours - theirs).abs();
            row.0[i] += error;
            if i < 2 {
                row.1 = row.1.max(error);
            }
        }
        row.2 += 1.0;
        row.3 += f64::from(solution.iterations);
    }
    for row in table.values_mut() {
        row.0 = row.0.map(|sum| sum / row.2);
        row.3 /= row.2;
    }
    table
}

#[test]
fn independent_data_by_degree() {
    let mut general = vec![];
    for degree in 1..=7 {
        for (kind, (mean, worst, _, iterations)) in errors(degree) {
            println!(
                "M = {degree} {kind:8} mean fx {:.4} fy {:.4} mz {:.4}, worst force {worst:.3}, {iterations:.1} iterations",
                mean[0], mean[1], mean[2]
            );
            let force = 0.5 * (mean[0] + mean[1]);
            if kind == "general" && [1, 3, 5].contains(&degree) {
                general.push(force);
            }
            // The goals for M = 5; other kinds and degrees are reported.
            let goal = match (degree, kind.as_str()) {
                (5, "general") => 0.03,
                (5, "bearing") => 0.012,
                _ => continue,
            };
            assert!(force < goal, "{kind}: mean force error {force}");
        }
    }
    assert!(
        general.windows(2).all(|pair| pair[1] < 0.7 * pair[0]),
        "errors fall with the degree: {general:?}"
    );
}

#[test]
fn independent_data_small_creepages() {
    // Rolling with a force up to 0.3 mu Q and half of the contact or more in adhesion, by creepage along or across: 3 % for
    // every degree from 3 on. (Spin of narrow ellipses has small forces up to complete sliding: `random.csv` has it.)
    let small = |force: f64| force > 0.0 && force < 0.305;
    for degree in 3..=7 {
        let (mut worst, mut count) = (0.0f64, 0);
        for case in curves() {
            let [x, y, _] = case.expected;
            if case.creepage.spin != 0.0 || !small(x.hypot(y)) || case.stick < 0.5 {
                continue;
            }
            let f = Kalker::new(case.patch, degree).unwrap().solve(&case.creepage, None).unwrap().forces;
            worst = worst.max((f.fx - x).hypot(f.fy - y) / x.hypot(y));
            count += 1;
        }
        println!("M = {degree}: {worst:.4} of {count} cases");
        assert!(count > 10 && worst < 0.03, "degree {degree}: {worst}");
    }
}

#[test]
fn regression_a_circle_from_rest_to_a_third_of_sliding() {
    // Against the reference solver, at creepages between those of the independent data and below.
    let patch = Patch { axis_ratio: 1.0, poisson_ratio: 0.3, rolling_angle: 0.0 };
    for x in [0.005, 0.02, 0.0505, 0.0841, 0.12, 0.15] {
        let creepage = ScaledCreepage { x, y: 0.0, spin: 0.0, curvature: 0.0 };
        let reference = extrapolated(&patch, &creepage, 24).unwrap().fx;
        for degree in 3..=7 {
            let error = kalker(1.0, degree).solve(&creepage, None).unwrap().forces.fx / reference - 1.0;
            println!("{x}: {reference:.4}, M = {degree}: {error:+.4}");
            assert!(error.abs() < 0.03, "{x}, degree {degree}: {error}");
        }
    }
}

fn kalker(axis_ratio: f64, degree: usize) -> Kalker {
    Kalker::new(Patch { axis_ratio, poisson_ratio: 0.3, rolling_angle: 0.0 }, degree).unwrap()
}

fn forces(kalker: &Kalker, x: f64, y: f64, spin: f64) -> [f64; 3] {
    let f = kalker.solve(&ScaledCreepage { x, y, spin, curvature: 0.0 }, None).unwrap().forces;
    [f.fx, f.fy, f.mz]
}

#[test]
fn closed_form_small_creepages_give_linear_theory() {
    // F/(mu Q) = G c^2 C cx/(mu Q) = 3/(2 pi) C hx.
    for ratio in [0.1, 1.0, 5.0] {
        let kalker = kalker(ratio, 5);
        let matrix =
            creep_matrix(&Patch { axis_ratio: ratio, poisson_ratio: 0.3, rolling_angle: 0.0 }).unwrap();
        let h = [2e-4, -1e-4, 1.5e-4];
        let ours = forces(&kalker, h[0], h[1], h[2]);
        for i in 0..3 {
            let linear: f64 = (0..3).map(|k| 1.5 / PI * matrix[(i, k)] * h[k]).sum();
            // Degree 5 against degree 9: 1 % of the size of the forces.
            assert!((ours[i] - linear).abs() < 0.01 * 1e-3, "{ratio} {i}: {} {linear}", ours[i]);
        }
    }
}

#[test]
fn invariant_derivatives_agree_with_differences() {
    // From nearly all sticking to nearly all sliding; by creepages and the curvature of the groove.
    for (ratio, degree) in [(0.15, 3), (2.0, 2)] {
        let kalker = kalker(ratio, degree);
        for [x, y, spin, curvature] in
            [[0.1, -0.05, 0.1, 0.02], [0.4, 0.3, -0.5, 0.1], [0.9, 0.6, 0.8, -0.2], [-0.3, 1.2, 2.0, 0.3]]
        {
            let creepage = |k: usize, step: f64| {
                let mut h = [x, y, spin, curvature];
                h[k] += step;
                ScaledCreepage { x: h[0], y: h[1], spin: h[2], curvature: h[3] }
            };
            let solution = kalker.solve(&creepage(0, 0.0), None).unwrap();
            let exact = kalker.derivatives(&solution, &creepage(0, 0.0)).unwrap();
            let size = exact.iter().flatten().fold(0.0f64, |size, d| size.max(d.abs()));
            for k in 0..4 {
                let step = 1e-5;
                let start = Some(solution.coefficients.as_slice());
                let at = |step: f64| {
                    let f = kalker.solve(&creepage(k, step), start).unwrap().forces;
                    [f.fx, f.fy, f.mz, f.second_moment]
                };
                let (after, before) = (at(step), at(-step));
                for i in 0..4 {
                    let slope = (after[i] - before[i]) / (2.0 * step);
                    let error = (slope - exact[i][k]).abs();
                    assert!(error < 1e-4 * size, "{ratio} force {i} by {k}: {slope} {}", exact[i][k]);
                }
            }
        }
    }
    // Nothing to do at rest: one step finds it.
    let rest = kalker(1.0, 3).solve(&ScaledCreepage::default(), None).unwrap();
    assert_eq!((rest.forces.fx, rest.forces.fy, rest.forces.mz, rest.iterations), (0.0, 0.0, 0.0, 1));
}

#[test]
fn closed_form_printed_objective_vanishes_in_full_adhesion() {
    // Eq. 13 as printed is zero for every traction that takes all slip away, bounded or not.
    for [x, y, spin] in [[0.02, 0.0, 0.0], [0.01, -0.02, 0.0], [0.01, 0.02, 0.03]] {
        let printed = Printed::new(Patch { axis_ratio: 0.5, poisson_ratio: 0.3, rolling_angle: 0.0 }, 4);
        let (_, objective) = printed.solve(&ScaledCreepage { x, y, spin, curvature: 0.0 });
        assert!(objective < 1e-16 * (x * x + y * y + spin * spin), "{x} {y} {spin}: {objective:e}");
    }
}

#[test]
fn invariant_symmetries() {
    for ratio in [0.15, 1.0, 3.0] {
        let kalker = kalker(ratio, 3);
        for (x, y, spin) in [(0.2, 0.1, 0.3), (0.05, -0.3, 1.0), (1.0, 0.4, -2.0)] {
            let [fx, fy, mz] = forces(&kalker, x, y, spin);
            // Exact symmetries of the problem; the iteration ends where the objective falls by less than 1e-7.
            let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3);
            assert!(close(forces(&kalker, -x, -y, -spin), [-fx, -fy, -mz]), "odd");
            assert!(close(forces(&kalker, x, -y, -spin), [fx, -fy, -mz]), "mirror");
        }
    }
}

#[test]
fn invariant_bounds_and_dissipation_from_rest_to_extremes() {
    let sizes = [0.0, 1e-300, 1e-9, 1e-3, 0.1, 1.0, 10.0, 1e4, 1e8, 1e300];
    for ratio in [0.08, 1.0] {
        let kalker = kalker(ratio, 3);
        for &x in &sizes {
            for &y in &[0.0, 0.3, -1e6] {
                for &spin in &sizes {
                    let creepage = ScaledCreepage { x, y, spin, curvature: 0.0 };
                    let solution = kalker.solve(&creepage, None).unwrap();
                    let f = solution.forces;
                    assert!(f.fx.is_finite() && f.fy.is_finite() && f.mz.is_finite(), "{creepage:?}");
                    assert!(f.fx.hypot(f.fy) <= 1.0, "{creepage:?}: {f:?}");
                    assert!((0.0..=1.0).contains(&solution.stick));
                    let size = x.abs().max(y.abs()).max(spin).max(f64::MIN_POSITIVE);
                    let power = f.fx * (x / size) + f.fy * (y / size) + f.mz * (spin / size);
                    assert!(power > -5e-3, "{creepage:?}: {power}");
                }
            }
        }
    }
    let kalker = kalker(1.0, 3);
    for wrong in [f64::NAN, f64::INFINITY] {
        let creepage = ScaledCreepage { x: wrong, y: 0.0, spin: 0.0, curvature: 0.0 };
        assert!(matches!(kalker.solve(&creepage, None), Err(KalkerError::NotFinite(_))));
    }
    let patch = Patch { axis_ratio: 1.0, poisson_ratio: 0.3, rolling_angle: 0.0 };
    assert!(matches!(Kalker::new(patch, 0), Err(KalkerError::Degree(0))));
    assert!(matches!(Kalker::new(patch, 8), Err(KalkerError::Degree(8))));
}

#[test]
fn invariant_warm_start_finds_the_cold_solution() {
    let kalker = kalker(0.2, 5);
    let near = kalker.solve(&ScaledCreepage { x: 0.2, y: 0.1, spin: 0.8, curvature: 0.0 }, None).unwrap();
    let creepage = ScaledCreepage { x: 0.203, y: 0.099, spin: 0.805, curvature: 0.0 };
    let (warm, cold) = (
        kalker.solve(&creepage, Some(near.coefficients.as_slice())).unwrap(),
        kalker.solve(&creepage, None).unwrap(),
    );
    assert!((warm.forces.fx - cold.forces.fx).abs() < 2e-3);
    assert!((warm.forces.fy - cold.forces.fy).abs() < 2e-3);
    assert!(warm.iterations < cold.iterations);
}

#[test]
fn invariant_a_solution_is_its_own_solution_from_rest_to_sliding() {
    // What is called a minimum has none below it: solved again from there it stays, for creepages of all sizes and directions.
    let mut random = Random::new(11);
    let mut worst = 0.0f64;
    for ratio in [0.05, 0.2, 1.0] {
        let kalker = kalker(ratio, 3);
        for _ in 0..150 {
            let size = 10f64.powf(random.between(-2.0, 1.5));
            let [x, y, spin] = [(); 3].map(|()| size * random.between(-1.0, 1.0));
            let creepage = ScaledCreepage { x, y, spin, curvature: 0.0 };
            let first = kalker.solve(&creepage, None).unwrap();
            let again = kalker.solve(&creepage, Some(first.coefficients.as_slice())).unwrap();
            let change = (again.forces.fx - first.forces.fx).hypot(again.forces.fy - first.forces.fy);
            worst = worst.max(change);
        }
    }
    println!("largest change {worst:.1e}");
    assert!(worst < 1e-5, "{worst:e}");
}

#[test]
fn invariant_a_start_that_is_none_changes_nothing() {
    let kalker = kalker(0.2, 3);
    let creepage = ScaledCreepage { x: 0.2, y: 0.1, spin: 0.8, curvature: 0.0 };
    let cold = kalker.solve(&creepage, None).unwrap();
    let number = cold.coefficients.len();
    for start in [vec![f64::NAN; number], vec![f64::INFINITY; number], vec![0.1; number - 1], vec![]] {
        assert_eq!(kalker.solve(&creepage, Some(&start)).unwrap().coefficients, cold.coefficients);
    }
}

#[test]
fn closed_form_power_of_forces() {
    // fx h_x + fy h_y + mz h_phi - second h_kappa
    let forces = ScaledForces { fx: 0.3, fy: -0.5, mz: 0.7, second_moment: 0.2 };
    let creepage = ScaledCreepage { x: 1.0, y: -2.0, spin: 3.0, curvature: 4.0 };
    assert!((forces.power(&creepage) - (0.3 + 1.0 + 2.1 - 0.8)).abs() < 1e-15);
}

#[test]
fn full_slip_reaches_the_friction_limit_and_stick_falls_from_one_to_none() {
    let kalker = kalker(1.0, 5);
    let at = |x: f64| kalker.solve(&ScaledCreepage { x, y: 0.0, spin: 0.0, curvature: 0.0 }, None).unwrap();
    assert!(at(1e-4).stick > 0.98 && at(10.0).stick < 0.02);
    assert!(at(10.0).forces.fx > 0.995);
}

/// Effect of the corrected objective. A linear traction (M = 1) is too poor for either: both objectives are off by
/// more than a tenth of the limits on average, the printed one by .174/.252/.308 and the repaired one by .132/.288/.346.
/// From M = 3 on the repaired one's errors are a third of the printed one's or less.
#[test]
fn independent_data_printed_objective_by_degree() {
    for degree in [1, 3, 5] {
        let (mut printed, mut repaired, mut count, mut vanishing) = ([0.0; 3], [0.0; 3], 0.0, vec![]);
        for case in cases().iter().filter(|case| case.kind == "general") {
            let (by_printed, objective) = Printed::new(case.patch, degree).solve(&case.creepage);
            let kalker = Kalker::new(case.patch, degree).unwrap();
            let by_repaired = kalker.solve(&case.creepage, None).unwrap().forces;
            for (sum, forces) in [(&mut printed, by_printed), (&mut repaired, by_repaired)] {
                for (sum, (ours, expected)) in
                    sum.iter_mut().zip([forces.fx, forces.fy, forces.mz].into_iter().zip(case.expected))
                {
                    *sum += (ours - expected).abs();
                }
            }
            count += 1.0;
            if objective < 1e-9 {
                let error = (by_printed.fx - case.expected[0]).hypot(by_printed.fy - case.expected[1]);
                vanishing.push(error);
            }
        }
        let [printed, repaired] = [printed, repaired].map(|sum| sum.map(|s| s / count));
        println!(
            "M = {degree}: printed {printed:.3?}, repaired {repaired:.3?}; of {count}, at a printed objective of 0, with errors {vanishing:.3?}"
        );
        for (printed, repaired) in printed.into_iter().zip(repaired) {
            if degree == 1 {
                assert!(printed > 0.1 && repaired > 0.1, "{printed} {repaired}");
            } else {
                assert!(repaired < 0.34 * printed, "M = {degree}: {repaired} {printed}");
            }
        }
        // The printed objective is zero at tractions that are not the contact's: .342, .369 and .184 off.
        assert!(vanishing.iter().any(|error| *error > 0.15), "{vanishing:?}");
    }
}
