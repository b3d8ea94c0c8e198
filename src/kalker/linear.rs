//! Kalker's linear theory: creep coefficients, interpolated in a table of the solved linear problem.
//!
//! The table (`creep_coefficients.csv`, origin in tests/data/contact/README.md) holds a high-order polynomial
//! solution with the traction vanishing at the leading edge. Between its points, logarithms are interpolated by
//! four-point Lagrange polynomials in ln(axis ratio) and Poisson's ratio.

use std::sync::OnceLock;

use thiserror::Error;

use super::Patch;

/// Creep coefficients of rolling along an ellipse axis (paper eq. 14); `C32 = -C23`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CreepCoefficients {
    /// [-] longitudinal.
    pub c11: f64,
    /// [-] lateral.
    pub c22: f64,
    /// [-] lateral force by spin.
    pub c23: f64,
    /// [-] spin moment by spin.
    pub c33: f64,
}

/// Why there are no coefficients.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum LinearError {
    /// Axis ratio outside the table.
    #[error("axis ratio {0} of the contact ellipse (rolling over transverse) is outside [0.05, 20]")]
    AxisRatio(f64),
    /// Poisson's ratio outside the table.
    #[error("Poisson's ratio {0} is outside [0, 0.5]")]
    PoissonRatio(f64),
    /// Rolling direction that the table does not have.
    #[error("creep coefficients are tabulated for rolling along an ellipse axis, not at {0} rad")]
    RollingAngle(f64),
}

/// The table: axes and logarithms of the four coefficients.
struct Table {
    /// Poisson's ratios, ascending.
    poisson: Vec<f64>,
    /// Logarithms of the axis ratios, ascending.
    log_ratio: Vec<f64>,
    /// `[poisson][ratio]`.
    log_coefficients: Vec<Vec<[f64; 4]>>,
}

const TABLE: &str = include_str!("creep_coefficients.csv");

impl Table {
    /// Parses the table that is compiled in; its form is checked by a test.
    fn parse(text: &str) -> Self {
        let mut table = Self {
            poisson: vec![],
            log_ratio: vec![],
            log_coefficients: vec![],
        };
        for line in text.lines().skip(1) {
            let row: Vec<f64> = line
                .split(',')
                .filter_map(|field| field.trim().parse().ok())
                .collect();
            let [poisson, ratio, c11, c22, c23, _, c33, _] = row[..] else {
                continue;
            };
            if table.poisson.last() != Some(&poisson) {
                table.poisson.push(poisson);
                table.log_coefficients.push(vec![]);
            }
            if table.poisson.len() == 1 {
                table.log_ratio.push(ratio.ln());
            }
            if let Some(rows) = table.log_coefficients.last_mut() {
                rows.push([c11, c22, c23, c33].map(f64::ln));
            }
        }
        table
    }
}

/// Four neighbouring points of an axis and their Lagrange weights at x.
fn stencil(axis: &[f64], x: f64) -> (usize, [f64; 4]) {
    let above = axis.partition_point(|&point| point < x);
    let first = above.saturating_sub(2).min(axis.len() - 4);
    let points = &axis[first..first + 4];
    let weights = std::array::from_fn(|i| {
        (0..4)
            .filter(|&k| k != i)
            .map(|k| (x - points[k]) / (points[i] - points[k]))
            .product()
    });
    (first, weights)
}

/// Creep coefficients of a patch.
///
/// # Errors
/// If the patch is outside the table or rolls obliquely.
pub fn creep_coefficients(patch: Patch) -> Result<CreepCoefficients, LinearError> {
    static PARSED: OnceLock<Table> = OnceLock::new();
    let table = PARSED.get_or_init(|| Table::parse(TABLE));
    if !(0.05..=20.0).contains(&patch.axis_ratio) {
        return Err(LinearError::AxisRatio(patch.axis_ratio));
    }
    if !(0.0..=0.5).contains(&patch.poisson_ratio) {
        return Err(LinearError::PoissonRatio(patch.poisson_ratio));
    }
    if patch.rolling_angle != 0.0 {
        return Err(LinearError::RollingAngle(patch.rolling_angle));
    }
    let (ratio, ratio_weights) = stencil(&table.log_ratio, patch.axis_ratio.ln());
    let (poisson, poisson_weights) = stencil(&table.poisson, patch.poisson_ratio);
    let mut logs = [0.0; 4];
    for (i, poisson_weight) in poisson_weights.iter().enumerate() {
        for (k, ratio_weight) in ratio_weights.iter().enumerate() {
            for (log, value) in logs
                .iter_mut()
                .zip(table.log_coefficients[poisson + i][ratio + k])
            {
                *log += poisson_weight * ratio_weight * value;
            }
        }
    }
    let [c11, c22, c23, c33] = logs.map(f64::exp);
    Ok(CreepCoefficients { c11, c22, c23, c33 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(axis_ratio: f64, poisson_ratio: f64) -> CreepCoefficients {
        creep_coefficients(Patch {
            axis_ratio,
            poisson_ratio,
            rolling_angle: 0.0,
        })
        .unwrap()
    }

    #[test]
    fn independent_data_is_reproduced_at_its_points() {
        let mut rows = 0;
        for line in TABLE.lines().skip(1) {
            let row: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
            let ours = at(row[1], row[0]);
            for (value, expected) in [
                (ours.c11, row[2]),
                (ours.c22, row[3]),
                (ours.c23, row[4]),
                (ours.c33, row[6]),
            ] {
                assert!((value / expected - 1.0).abs() < 1e-12, "{line}");
            }
            rows += 1;
        }
        assert_eq!(rows, 115);
    }

    #[test]
    fn published_numbers_of_the_circle() {
        // Kalker's table at a/b = 1, nu = 0.25: 4.11, 3.67, 1.47, 1.19 (C33 1.18 when solved to high order).
        let ours = at(1.0, 0.25);
        assert!((ours.c11 - 4.11).abs() < 0.01 && (ours.c22 - 3.67).abs() < 0.01);
        assert!((ours.c23 - 1.47).abs() < 0.01 && (ours.c33 - 1.18).abs() < 0.015);
    }

    #[test]
    fn interpolation_error_is_below_half_a_percent_when_every_other_point_is_left_out() {
        // Interpolating with twice the spacing errs 16 times more than the table itself does.
        let table = Table::parse(TABLE);
        let coarse: Vec<f64> = table.log_ratio.iter().copied().step_by(2).collect();
        for rows in &table.log_coefficients {
            for (i, &x) in table.log_ratio.iter().enumerate() {
                if x > *coarse.last().unwrap() {
                    continue;
                }
                let (first, weights) = stencil(&coarse, x);
                for c in 0..4 {
                    let value: f64 = (0..4).map(|k| weights[k] * rows[2 * (first + k)][c]).sum();
                    assert!((value - rows[i][c]).abs() < 5e-3, "point {i}, coefficient {c}");
                }
            }
        }
    }

    #[test]
    fn values_outside_are_refused() {
        for (ratio, poisson, angle) in [
            (0.04, 0.3, 0.0),
            (21.0, 0.3, 0.0),
            (1.0, 0.6, 0.0),
            (1.0, 0.3, 0.1),
            (f64::NAN, 0.3, 0.0),
        ] {
            let patch = Patch {
                axis_ratio: ratio,
                poisson_ratio: poisson,
                rolling_angle: angle,
            };
            assert!(creep_coefficients(patch).is_err());
        }
    }
}
