//! Quantities that vary as a gear turns: sums of waves and of tables over a tooth or over a turn.

use std::f64::consts::TAU;

use crate::numerics::periodic_spline::PeriodicSpline;

/// A term of a variation.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// `amplitude cos(times angle - phase)`.
    Wave {
        /// [-] waves in a turn of the first gear; a whole number for waves of the teeth, and of that gear.
        times: f64,
        /// Amplitude, in the unit of the quantity.
        amplitude: f64,
        /// \[rad] phase.
        phase: f64,
    },
    /// A closed curve through points.
    Table {
        /// [-] closed curves in a turn of the first gear; negative where it is passed through backwards.
        times: f64,
        /// The curve.
        curve: PeriodicSpline<1>,
        /// [-] its points.
        points: usize,
    },
}

impl Term {
    /// Value, slope and second derivative by an angle of the first gear \[rad].
    fn at(&self, angle: f64) -> [f64; 3] {
        match self {
            Self::Wave { times, amplitude, phase } => {
                let (sin, cos) = (times * angle - phase).sin_cos();
                [amplitude * cos, -amplitude * times * sin, -amplitude * times * times * cos]
            }
            Self::Table { times, curve, .. } => {
                let [[value, slope, bend]] = curve.at(times * angle);
                [value, slope * times, bend * times * times]
            }
        }
    }
}

/// A quantity that varies with the angle of a gear.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variation(pub Vec<Term>);

impl Variation {
    /// Value, slope and second derivative by the angle of the first gear \[rad].
    pub fn at(&self, angle: f64) -> [f64; 3] {
        self.0.iter().fold([0.0; 3], |sum, term| {
            let own = term.at(angle);
            [0, 1, 2].map(|k| sum[k] + own[k])
        })
    }

    /// [-] shortest waves in a turn of the first gear; none where nothing varies. A table of `n` points has `n/4` of them.
    pub fn most_waves(&self) -> Option<f64> {
        let waves = self.0.iter().map(|term| match term {
            Term::Wave { times, .. } => times.abs(),
            Term::Table { times, points, .. } => times.abs() * (*points as f64 / 4.0).max(1.0),
        });
        waves.reduce(f64::max)
    }

    /// Largest and smallest value, by its own points: waves at sixteen points of the shortest, over one turn.
    pub fn range(&self) -> [f64; 2] {
        let Some(waves) = self.most_waves() else { return [0.0; 2] };
        let count = (16.0 * waves).ceil().clamp(16.0, 1e6) as usize;
        let values = (0..count).map(|k| self.at(TAU * k as f64 / count as f64)[0]);
        values
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_slopes_of_waves_and_tables_are_those_of_the_function() {
        let points: Vec<[f64; 1]> = (0..64).map(|k| [(TAU * f64::from(k) / 64.0).cos()]).collect();
        let curve = PeriodicSpline::through(&points).unwrap();
        let wave = Variation(vec![Term::Wave { times: -3.0, amplitude: 2.0, phase: 0.4 }]);
        let table = Variation(vec![Term::Table { times: -3.0, curve, points: 64 }]);
        for angle in [0.0, 0.3, 1.7, 40.2] {
            let [value, slope, bend] = wave.at(angle);
            let of = -3.0 * angle - 0.4;
            assert!((value - 2.0 * of.cos()).abs() < 1e-12);
            assert!((slope - 6.0 * of.sin()).abs() < 1e-12);
            assert!((bend + 18.0 * of.cos()).abs() < 1e-12);
            let [value, slope, bend] = table.at(angle);
            assert!((value - (3.0 * angle).cos()).abs() < 1e-6);
            assert!((slope + 3.0 * (3.0 * angle).sin()).abs() < 1e-4);
            assert!((bend + 9.0 * (3.0 * angle).cos()).abs() < 1e-2);
        }
        assert_eq!([wave.most_waves(), table.most_waves()], [Some(3.0), Some(48.0)]);
        assert!(wave.range().iter().zip([-2.0, 2.0]).all(|(found, exact)| (found - exact).abs() < 0.04));
    }
}
