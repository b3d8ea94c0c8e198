//! Peaks of an amplitude spectrum, and the frequencies that they may belong to.

use super::welch::{Amplitudes, peak};

/// [-] multiples of a frequency that are looked for, and marked.
pub const MULTIPLES: u32 = 3;
/// [-] highest multiple of a frequency of damage that a peak is recognised as: blows have many.
const HIGHEST: u32 = 60;

/// A frequency of a bearing: its name and \[Hz].
pub type Named = (&'static str, f64);

/// A peak of one signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Which signal.
    pub signal: usize,
    /// \[its unit] amplitude.
    pub amplitude: f64,
    /// \[Hz] frequency.
    pub frequency: f64,
}

/// The largest peaks of some signals, no smaller than a share of the largest; `spacing` \[Hz] from one frequency to the next.
pub fn largest<const N: usize>(
    spectrum: &Amplitudes<N>,
    signals: std::ops::Range<usize>,
    spacing: f64,
    most: usize,
    share: f64,
) -> Vec<Peak> {
    let mut peaks: Vec<Peak> = vec![];
    for signal in signals {
        let at = |k: usize| spectrum.at[k][signal];
        // What leaks from the mean's slow drift stands at the first frequency.
        for k in 2..spectrum.at.len().saturating_sub(1) {
            if at(k) > 0.0 && at(k) >= at(k - 1) && at(k) > at(k + 1) {
                let (place, amplitude) = peak(at, k);
                peaks.push(Peak { signal, amplitude, frequency: place * spacing });
            }
        }
    }
    peaks.sort_by(|one, other| other.amplitude.total_cmp(&one.amplitude));
    let least = peaks.first().map_or(0.0, |first| share * first.amplitude);
    peaks.truncate(most);
    peaks.retain(|peak| peak.amplitude >= least);
    peaks
}

/// The line that a frequency \[Hz] is on, or else the nearest of those that are looked for: `2 x BPFI - shaft`, and \[Hz] it; none where
/// all of them are 0.
///
/// `named` is FTF, BPFO, BPFI, BSF and the turns of the shaft. A place of the inner race comes round with the shaft and one of a ball with
/// the cage: multiples of BPFI and BSF have lines at these distances on either side. On a line is what is within `spacing` \[Hz] of it;
/// of several that is the lowest multiple, and lines in the middle come before those beside them.
pub fn nearest(named: &[Named; 5], frequency: f64, spacing: f64) -> Option<(String, f64)> {
    let [cage, bpfo, bpfi, bsf, shaft] = *named;
    let mut lines: Vec<(bool, u32, String, f64)> = vec![];
    for ((name, base), beside) in
        [(cage, None), (shaft, None), (bpfo, None), (bpfi, Some(shaft)), (bsf, Some(cage))]
    {
        // Where multiples stand closer than this, any frequency is on one.
        let most =
            if beside.is_none() && name != bpfo.0 || base < 8.0 * spacing { MULTIPLES } else { HIGHEST };
        let around = (frequency / base).round().clamp(1.0, f64::from(most)) as u32;
        for multiple in 1..=around {
            let text = if multiple == 1 { name.to_string() } else { format!("{multiple} x {name}") };
            let line = f64::from(multiple) * base;
            for (sign, by) in [(" + ", 1.0), (" - ", -1.0)] {
                if let Some((other, distance)) = beside {
                    lines.push((true, multiple, format!("{text}{sign}{other}"), line + by * distance));
                }
            }
            if base > 0.0 {
                lines.push((false, multiple, text, line));
            }
        }
    }
    let far = |line: f64| (line - frequency).abs();
    let on = lines.iter().filter(|line| far(line.3) <= spacing).min_by_key(|line| (line.0, line.1));
    let first = lines.iter().filter(|line| !line.0 && line.1 <= MULTIPLES);
    let near = first.min_by(|one, other| far(one.3).total_cmp(&far(other.3)));
    on.or(near).map(|(_, _, text, line)| (text.clone(), *line))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_are_the_largest_of_all_signals_and_lines_the_nearest() {
        let mut at = vec![[0.0; 2]; 40];
        at[10] = [4.0, 0.0];
        at[20] = [0.0, 3.0];
        at[30] = [1.0, 0.1];
        // A slope is no peak, and neither is what stands beside the mean.
        at[0] = [9.0, 9.0];
        at[1] = [5.0, 5.0];
        let spectrum = Amplitudes { at, rows: 78, segments: 1 };
        let peaks = largest(&spectrum, 0..2, 2.0, 5, 0.2);
        let seen: Vec<_> = peaks.iter().map(|peak| (peak.signal, peak.amplitude, peak.frequency)).collect();
        assert_eq!(seen, [(0, 4.0, 20.0), (1, 3.0, 40.0), (0, 1.0, 60.0)]);
        assert_eq!(largest(&spectrum, 0..2, 2.0, 2, 0.0).len(), 2);
        let named = [("FTF", 20.0), ("BPFO", 177.0), ("BPFI", 264.0), ("BSF", 115.0), ("shaft", 49.0)];
        let on = |frequency, spacing| nearest(&named, frequency, spacing).map(|(name, _)| name).unwrap();
        for (frequency, name) in [
            (20.5, "FTF"),
            (48.0, "shaft"),
            (177.5, "BPFO"),
            (8.0 * 177.0, "8 x BPFO"),
            (2.0 * 264.0 + 49.0, "2 x BPFI + shaft"),
            (264.0 - 49.5, "BPFI - shaft"),
            (6.0 * 115.0 - 20.0, "6 x BSF - FTF"),
            // On none of them.
            (362.0, "2 x BPFO"),
        ] {
            assert_eq!(on(frequency, 1.0), name, "{frequency}");
        }
        // Lines that stand too close to be told apart have their first multiples alone.
        assert_eq!(on(8.0 * 177.0, 30.0), "3 x BPFI");
        assert_eq!(nearest(&named.map(|(name, _)| (name, 0.0)), 175.0, 1.0), None);
    }
}
