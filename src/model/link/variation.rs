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
    /// [-] how often it closes on itself in a turn of the first gear, with a sign.
    fn times(&self) -> f64 {
        let (Self::Wave { times, .. } | Self::Table { times, .. }) = self;
        *times
    }

    /// [-] shortest waves in a turn of the first gear: of a table of `n` points there are `n/4`.
    fn waves(&self) -> f64 {
        let own = match self {
            Self::Wave { .. } => 1.0,
            Self::Table { points, .. } => (*points as f64 / 4.0).max(1.0),
        };
        own * self.times().abs()
    }

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

    /// [-] shortest waves in a turn of the first gear; none where nothing varies.
    pub fn most_waves(&self) -> Option<f64> {
        self.0.iter().map(Term::waves).reduce(f64::max)
    }

    /// Smallest value at sixteen points of every shortest wave, wherever teeth of both gears meet: what closes over a turn of the first gear at its least,
    /// and what closes over `turns` of it, as over a turn of the second gear, at its own.
    pub fn least(&self, turns: f64) -> f64 {
        let (of_first, of_second): (Vec<&Term>, Vec<&Term>) =
            self.0.iter().partition(|term| term.times().fract() == 0.0);
        let least = |terms: &[&Term], turns: f64| {
            let waves = terms.iter().map(|term| term.waves()).fold(1.0, f64::max);
            let count = (16.0 * waves * turns).ceil().clamp(16.0, 1e6) as usize;
            let at = |k: usize| {
                let angle = TAU * turns * k as f64 / count as f64;
                terms.iter().fold(0.0, |sum, term| sum + term.at(angle)[0])
            };
            (0..count).map(at).fold(f64::INFINITY, f64::min)
        };
        least(&of_first, 1.0) + least(&of_second, turns)
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
        assert!((wave.least(1.0) + 2.0).abs() < 0.04);
        // A wave of each gear, of 20 and 30 teeth: their troughs meet in the second turn of the first gear.
        let both = [1.0, -2.0 / 3.0].map(|times| Term::Wave { times, amplitude: 1.0, phase: 0.0 });
        assert!((Variation(both.into()).least(1.5) + 2.0).abs() < 0.04);
    }
}
