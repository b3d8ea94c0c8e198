//! Parameters of the regularised law's spin coupling against independent data.

use roulement::contact::identification::identify_by_table;
use roulement::contact::regularised::{Parameters, lateral_by_spin, moment_by_lateral, moment_by_spin};
use roulement::kalker::Patch;
use roulement::kalker::linear::Scales;

/// Largest and root mean square difference of phi_yz, phi_z, phi_zy from boundary elements.
fn differences(parameters: &Parameters, ratio: f64, scales: &Scales) -> [[f64; 2]; 3] {
    let mut sums = [[0.0f64, 0.0, 0.0]; 3];
    let mut table =
        csv::Reader::from_path(format!("{}/tests/data/contact/identification.csv", roulement_tests::ROOT))
            .unwrap();
    for record in table.records() {
        let record = record.unwrap();
        let number = |k: usize| record[k].parse::<f64>().unwrap();
        let (h, fy, mz) = (number(3), number(5), number(6) / scales.moment);
        let spin = &record[2] == "spin";
        if number(0) != ratio || h > if spin { 15.0 } else { 2.1 } {
            continue;
        }
        let mut add = |which: usize, difference: f64| {
            let [largest, square, count] = sums[which];
            sums[which] = [largest.max(difference.abs()), square + difference * difference, count + 1.0];
        };
        if spin {
            add(0, lateral_by_spin(parameters.eta, 0.5 * h * scales.c23) - fy);
            add(1, moment_by_spin(parameters.beta, h * scales.c33 / scales.moment) - mz);
        } else {
            add(2, moment_by_lateral(parameters.alpha, h * scales.c23 / scales.moment) + mz);
        }
    }
    sums.map(|[largest, square, count]| [largest, (square / count).sqrt()])
}

#[test]
fn independent_data_identified_functions() {
    for ratio in [1.0, 0.3, 0.1, 0.05] {
        let patch = Patch { axis_ratio: ratio, poisson_ratio: 0.3, rolling_angle: 0.0 };
        let found = identify_by_table(&patch).unwrap();
        let scales = Scales::new(&patch).unwrap();
        let differences = differences(&found.parameters, ratio, &scales);
        println!("axis ratio {ratio}: largest and rms of eta, beta, alpha {differences:.4?}");
        for ([largest, rms], own) in differences.into_iter().zip(found.residuals()) {
            // The data's own fits reach 0.008 rms (regularised_fit.csv); the table is off by 0.005, at 0.05 by up to 0.02.
            assert!(rms < 0.02 && largest < 0.04, "{ratio}: {largest} {rms}");
            assert!(own[0] <= own[1] && own[0] < 0.012, "{ratio}: {own:?}");
        }
    }
}

#[test]
fn independent_data_parameters_of_a_circle() {
    // regularised_fit.csv, set ab1.0: fitted to boundary elements by somebody else.
    let patch = Patch { axis_ratio: 1.0, poisson_ratio: 0.3, rolling_angle: 0.0 };
    let ours = identify_by_table(&patch).unwrap().parameters;
    let theirs = Parameters {
        eta: [0.20748, -0.74104, 4.6443],
        beta: [0.38646, 1.0293],
        alpha: [0.74558, 1.6009, 2.9051],
        coupling: 1.0,
    };
    let pairs = ours.eta.into_iter().zip(theirs.eta).chain(ours.beta.into_iter().zip(theirs.beta));
    for (mine, other) in pairs.chain(ours.alpha.into_iter().zip(theirs.alpha)) {
        assert!((mine - other).abs() < 0.2 * other.abs().max(0.5), "{ours:?}");
    }
}

#[test]
fn invariant_one_set_does_not_serve_all_axis_ratios() {
    let patch = |ratio| Patch { axis_ratio: ratio, poisson_ratio: 0.3, rolling_angle: 0.0 };
    let of_circle = identify_by_table(&patch(1.0)).unwrap().parameters;
    let scales = Scales::new(&patch(0.05)).unwrap();
    let [eta, _, alpha] = differences(&of_circle, 0.05, &scales);
    assert!(eta[1] > 0.05 && alpha[1] > 0.02, "{eta:?} {alpha:?}");
}
