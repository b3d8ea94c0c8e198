//! Functions of an angle through equally spaced points: cubic splines that close on themselves.

use std::f64::consts::TAU;

/// Second derivatives of a closed cubic spline solve `c[i-1] + 4 c[i] + c[i+1] = r[i]`; the matrix is a product of two
/// recursions with this factor (Unser 1999).
const RECURSION: f64 = -0.267_949_192_431_122_7;

/// `M` functions of an angle, smooth to the second derivative, through the same equally spaced points of a turn.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicSpline<const M: usize> {
    /// By point, and by function: value, and a sixth of the second derivative times the square of the spacing.
    points: Vec<[[f64; 2]; M]>,
}

impl<const M: usize> PeriodicSpline<M> {
    /// Smallest number of points.
    pub const FEWEST: usize = 4;

    /// The splines through values at the angles `2 pi i/n`; none for fewer than [`Self::FEWEST`] points.
    pub fn through(values: &[[f64; M]]) -> Option<Self> {
        if values.len() < Self::FEWEST {
            return None;
        }
        let mut points: Vec<[[f64; 2]; M]> =
            values.iter().map(|values| values.map(|value| [value, 0.0])).collect();
        for function in 0..M {
            let column: Vec<f64> = values.iter().map(|values| values[function]).collect();
            for (point, bend) in points.iter_mut().zip(bends(&column)) {
                point[function][1] = bend;
            }
        }
        Some(Self { points })
    }

    /// Values, slopes and second derivatives of all functions at an angle \[rad].
    #[inline]
    pub fn at(&self, angle: f64) -> [[f64; 3]; M] {
        let count = self.points.len();
        let per_spacing = count as f64 / TAU;
        let place = (angle * per_spacing).rem_euclid(count as f64);
        // Rounding may give the whole turn; what is no number reads the first point and stays no number.
        let left = (place as usize).min(count - 1);
        let right = if left + 1 == count { 0 } else { left + 1 };
        let t = place - left as f64;
        let u = 1.0 - t;
        let (left, right) = (&self.points[left], &self.points[right]);
        std::array::from_fn(|function| {
            let ([a, p], [b, q]) = (left[function], right[function]);
            [
                u * a + t * b + p * (u * u * u - u) + q * (t * t * t - t),
                (b - a + p * (1.0 - 3.0 * u * u) + q * (3.0 * t * t - 1.0)) * per_spacing,
                6.0 * (p * u + q * t) * per_spacing * per_spacing,
            ]
        })
    }
}

/// A sixth of the second derivatives times the square of the spacing, of the closed spline through some values.
fn bends(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let at = |i: usize| values[i % n];
    let rest: Vec<f64> = (0..n).map(|i| at(i + n - 1) - 2.0 * at(i) + at(i + 1)).collect();
    let closing = 1.0 / (1.0 - RECURSION.powi(i32::try_from(n).unwrap_or(i32::MAX)));
    // Forwards, from the sum over all turns before; then backwards alike.
    let run = |order: &dyn Fn(usize) -> usize, values: Vec<f64>, gain: f64| {
        let mut last = (0..n).fold(0.0, |sum, i| sum * RECURSION + values[order(i)]) * closing;
        let mut filtered = vec![0.0; n];
        for i in 0..n {
            last = values[order(i)] + RECURSION * last;
            filtered[order(i)] = last * gain;
        }
        filtered
    };
    let forwards = run(&|i| i, rest, 1.0);
    run(&|i| n - 1 - i, forwards, -RECURSION)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waves(n: usize) -> PeriodicSpline<2> {
        let values: Vec<[f64; 2]> = (0..n)
            .map(|i| TAU * i as f64 / n as f64)
            .map(|angle| [(3.0 * angle - 0.4).cos(), (5.0 * angle).sin() + 2.0])
            .collect();
        PeriodicSpline::through(&values).unwrap()
    }

    #[test]
    fn invariant_points_are_met_and_derivatives_go_on_across_them() {
        for n in [4, 5, 7, 64] {
            let values: Vec<[f64; 1]> =
                (0..n).map(|i| [(f64::from(i) * 1.7).sin() + 0.1 * f64::from(i)]).collect();
            let spline = PeriodicSpline::through(&values).unwrap();
            for (i, [value]) in values.iter().enumerate() {
                let angle = TAU * i as f64 / f64::from(n);
                let [before, after] = [-1e-9, 1e-9].map(|off| spline.at(angle + off)[0][0]);
                assert!((before - value).abs() < 1e-7 && (after - value).abs() < 1e-7, "{n} {i}");
                let [[_, slope, bend]] = spline.at(angle - 1e-12);
                let [[_, next_slope, next_bend]] = spline.at(angle + 1e-12);
                assert!((slope - next_slope).abs() < 1e-8 * f64::from(n), "{n} {i}");
                assert!((bend - next_bend).abs() < 1e-7 * f64::from(n * n), "{n} {i}");
            }
        }
        assert!(PeriodicSpline::<1>::through(&[[0.0]; 3]).is_none());
    }

    #[test]
    fn closed_form_waves_are_met_to_the_fourth_order_of_the_spacing() {
        let error = |n: usize| {
            let spline = waves(n);
            (0..1000)
                .map(|i| 0.0123 * f64::from(i) - 5.0)
                .map(|angle| {
                    let [[w, slope, _], [v, ..]] = spline.at(angle);
                    let exact = [(3.0 * angle - 0.4).cos(), (5.0 * angle).sin() + 2.0];
                    assert!((slope + 3.0 * (3.0 * angle - 0.4).sin()).abs() < 0.05);
                    (w - exact[0]).abs().max((v - exact[1]).abs())
                })
                .fold(0.0, f64::max)
        };
        let [coarse, fine] = [error(100), error(200)];
        assert!(coarse < 1e-3 && (coarse / fine).log2() > 3.9, "{coarse:e} {fine:e}");
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let (spline, h) = (waves(40), 1e-6);
        for i in 0..50 {
            let angle = 0.3 * f64::from(i) - 4.0;
            let [before, here, after] = [-h, 0.0, h].map(|off| spline.at(angle + off));
            for function in 0..2 {
                let slope = (after[function][0] - before[function][0]) / (2.0 * h);
                let bend = (after[function][1] - before[function][1]) / (2.0 * h);
                assert!((here[function][1] - slope).abs() < 1e-7, "{angle}");
                assert!((here[function][2] - bend).abs() < 1e-5, "{angle}");
            }
        }
    }

    #[test]
    fn what_is_no_number_gives_none_and_whole_turns_do_not_matter() {
        let spline = waves(40);
        assert!(spline.at(f64::NAN).iter().flatten().take(2).all(|x| x.is_nan()));
        let [[a, ..], _] = spline.at(0.3);
        for turns in [-3.0, 1.0, 1e3] {
            assert!((spline.at(0.3 + turns * TAU)[0][0] - a).abs() < 1e-9);
        }
        assert!(spline.at(-1e-300).iter().flatten().all(|x| x.is_finite()));
    }
}
