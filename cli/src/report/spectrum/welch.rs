//! Amplitudes over frequency of signals in equally spaced rows, by Welch's method with Hann's window, in bounded memory.
//!
//! Rows go into segments that overlap by half; each is freed of its mean, weighted by Hann's window and transformed, and the squares of
//! the amplitudes are averaged over the segments. A signal that fits into one segment has one: the finest resolution that it can
//! have. Amplitudes are those of a sine, `2 |X|/sum(w)`: one between two frequencies shows up to 15 % low on both, which [`peak`]
//! makes good; a sine fills four frequencies around its own.

use std::f64::consts::{PI, TAU};

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// [-] rows of a segment at most: 3 MB of six signals.
pub const MOST: usize = 1 << 16;
/// [-] rows below which there is no spectrum.
const FEWEST: usize = 16;

/// Segments of `N` signals.
pub struct Welch<const N: usize> {
    rows: Vec<[f64; N]>,
    /// [-] rows of a segment.
    segment: usize,
    done: Amplitudes<N>,
}

/// Amplitudes of `N` signals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Amplitudes<const N: usize> {
    /// One-sided amplitudes at the frequencies 0, 1, 2 .. over `rows` rows; the first is the size of the mean.
    pub at: Vec<[f64; N]>,
    /// [-] rows of a segment.
    pub rows: usize,
    /// [-] segments that they are averaged over.
    pub segments: u32,
}

impl<const N: usize> Welch<N> {
    /// For a signal of so many rows.
    pub fn new(rows: u64) -> Self {
        let segment = usize::try_from(rows).unwrap_or(MOST).clamp(FEWEST, MOST);
        Self { rows: vec![], segment, done: Amplitudes { at: vec![], rows: segment, segments: 0 } }
    }

    /// Adds a row.
    pub fn push(&mut self, row: [f64; N]) {
        self.rows.push(row);
        if self.rows.len() == self.segment {
            self.done.add(&self.rows);
            self.rows.drain(..self.segment.div_ceil(2));
        }
    }

    /// The amplitudes; those of a signal that ended before its first segment are of what there is. None of a handful of rows.
    pub fn finish(mut self) -> Option<Amplitudes<N>> {
        if self.done.segments == 0 {
            if self.rows.len() < FEWEST {
                return None;
            }
            self.done.rows = self.rows.len();
            self.done.add(&self.rows);
        }
        let count = f64::from(self.done.segments);
        self.done.at.iter_mut().flatten().for_each(|square| *square = (*square / count).sqrt());
        Some(self.done)
    }
}

impl<const N: usize> Amplitudes<N> {
    /// Adds the squares of the amplitudes of a segment.
    fn add(&mut self, rows: &[[f64; N]]) {
        let count = rows.len();
        self.segments += 1;
        self.at.resize(count / 2 + 1, [0.0; N]);
        let transform = FftPlanner::new().plan_fft_forward(count);
        for signal in 0..N {
            let values = || rows.iter().map(|row| row[signal]);
            self.add_signal(signal, &*transform, values().sum::<f64>() / count as f64, values());
        }
    }

    fn add_signal(
        &mut self,
        signal: usize,
        transform: &dyn Fft<f64>,
        mean: f64,
        values: impl Iterator<Item = f64>,
    ) {
        let count = transform.len();
        let hann = |i: usize| 0.5 - 0.5 * (TAU * i as f64 / count as f64).cos();
        let mut data: Vec<_> =
            values.enumerate().map(|(i, value)| Complex::new((value - mean) * hann(i), 0.0)).collect();
        transform.process(&mut data);
        // The window's sum is half of the rows; what stands at the highest frequency has no other side.
        let two_sided = 2.0 / count as f64;
        for (k, (sum, x)) in self.at.iter_mut().zip(&data).enumerate() {
            let amplitude = match k {
                0 => mean.abs(),
                _ if 2 * k == count => two_sided * x.norm(),
                _ => 2.0 * two_sided * x.norm(),
            };
            sum[signal] += amplitude * amplitude;
        }
    }
}

/// Frequency \[its number] and amplitude of a sine that has its largest amplitude at frequency `k` of these, by the window's own shape
/// (Grandke 1983, IEEE Trans. Instrum. Meas. 32, 350).
pub fn peak(amplitudes: impl Fn(usize) -> f64, k: usize) -> (f64, f64) {
    let (before, here, after) = (amplitudes(k - 1), amplitudes(k), amplitudes(k + 1));
    let ratio = before.max(after) / here;
    let by = ((2.0 * ratio - 1.0) / (ratio + 1.0)).clamp(0.0, 0.5);
    let side = if after > before { 1.0 } else { -1.0 };
    let lowered = if by > 1e-6 { (PI * by).sin() / (PI * by) / (1.0 - by * by) } else { 1.0 };
    (k as f64 + side * by, here / lowered)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sines of amplitudes at periods in so many rows, and a mean.
    fn sines(rows: usize, count: f64, of: &[(f64, f64)], mean: f64) -> Welch<1> {
        let mut welch = Welch::new(rows as u64);
        for i in 0..rows {
            let sine = |(amplitude, periods): &(f64, f64)| {
                amplitude * (TAU * periods * i as f64 / count + 0.7).sin()
            };
            welch.push([mean + of.iter().map(sine).sum::<f64>()]);
        }
        welch
    }

    #[test]
    fn closed_form_sines_have_their_amplitudes_at_their_frequencies() {
        for rows in [1000, 1024, 1999] {
            // On a frequency, between two, and the mean.
            let of = [(3.0, 100.0), (0.5, 200.3), (0.02, 250.5)];
            let spectrum = sines(rows, rows as f64, &of, -70.0).finish().unwrap();
            assert_eq!((spectrum.rows, spectrum.segments, spectrum.at.len()), (rows, 1, rows / 2 + 1));
            assert!((spectrum.at[0][0] - 70.0).abs() < 1e-2, "{}", spectrum.at[0][0]);
            assert!((spectrum.at[100][0] - 3.0).abs() < 1e-6);
            for (amplitude, periods) in of {
                let (at, size) = peak(|k| spectrum.at[k][0], f64::round(periods) as usize);
                assert!((at - periods).abs() < 2e-3 && (size / amplitude - 1.0).abs() < 2e-3, "{at} {size}");
            }
            // Beside them hardly anything: Hann's side lobes fall with the third power.
            assert!(spectrum.at[150][0] < 1e-5 && spectrum.at[400][0] < 1e-6);
        }
    }

    #[test]
    fn invariant_memory_is_bounded_and_averages_over_segments_keep_amplitudes() {
        let rows = 7 * MOST / 2 + 100;
        let mut welch = sines(rows, MOST as f64, &[(2.0, 1234.4)], 5.0);
        assert!(welch.rows.capacity() <= MOST && welch.rows.len() < MOST);
        welch.push([5.0]);
        let spectrum = welch.finish().unwrap();
        assert_eq!((spectrum.rows, spectrum.segments), (MOST, 6));
        let (at, size) = peak(|k| spectrum.at[k][0], 1234);
        assert!((at - 1234.4).abs() < 1e-3 && (size - 2.0).abs() < 1e-3, "{at} {size}");
        // A signal that ended early.
        let mut short = Welch::new(5000);
        (0..400).for_each(|i| short.push([(TAU * 0.1 * f64::from(i)).cos()]));
        let short = short.finish().unwrap();
        assert_eq!(short.rows, 400);
        assert!((short.at[40][0] - 1.0).abs() < 1e-9);
        assert!(sines(FEWEST - 1, 10.0, &[], 1.0).finish().is_none());
        assert!(Welch::<1>::new(0).finish().is_none());
    }
}
