//! Peaks of an amplitude spectrum, and the frequencies that they may belong to.

use super::meshes::Mesh;
use super::welch::{Amplitudes, peak};

/// [-] multiples of a frequency that are looked for, and marked.
pub const MULTIPLES: u32 = 3;
/// [-] highest multiple of a frequency that a peak is recognised as: further up lines stand so close that a peak is near one anyway.
const HIGHEST: u32 = 10;
/// [-] how far from a line a peak may be, over the distance of two frequencies: its place is known to a hundredth of that, and with all of
/// it every second peak of a short run would be on some line by chance.
const ON: f64 = 0.5;
/// [-] how far a race rings from its own frequency at rest: contacts stiffen with load.
const RINGS: f64 = 0.03;

/// A frequency of a bearing or a mesh: its name and \[Hz].
pub type Named<'a> = (&'a str, f64);

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

/// The line that a frequency \[Hz] is on, `2 x BPFI - shaft`, and \[Hz] it; none where it is on none of those that are looked for.
///
/// `named` is FTF, BPFO, BPFI, BSF and the turns of the shaft. A place of the inner race comes round with the shaft and one of a ball with
/// the cage: multiples of BPFI and BSF have lines at these distances on either side, and teeth those of both of their shafts. On a line is what is within half of
/// `spacing` \[Hz] of it;
/// of several that is the lowest multiple, and lines in the middle come before those beside them.
pub fn line_of(
    named: &[Named<'_>; 5],
    meshes: &[Mesh],
    frequency: f64,
    spacing: f64,
) -> Option<(String, f64)> {
    let [cage, bpfo, bpfi, bsf, shaft] = *named;
    let mut lines: Vec<(bool, u32, String, f64)> = vec![];
    let of_bearing: [(Named<'_>, &[Named<'_>]); 5] =
        [(cage, &[]), (shaft, &[]), (bpfo, &[]), (bpfi, &[shaft]), (bsf, &[cage])];
    let turns: Vec<[Named<'_>; 2]> = meshes
        .iter()
        .map(|mesh| mesh.shafts.each_ref().map(|(name, turns)| (name.as_str(), *turns)))
        .collect();
    let of_meshes =
        meshes.iter().zip(&turns).map(|(mesh, turns)| ((mesh.name.as_str(), mesh.frequency), &turns[..]));
    for ((name, base), beside) in of_bearing.into_iter().chain(of_meshes) {
        // What turns less than once in the window has no lines.
        if base < spacing {
            continue;
        }
        // Where multiples stand closer than this, any frequency is on one.
        let most = if base < 8.0 * spacing { MULTIPLES } else { HIGHEST };
        for multiple in 1..=most {
            let text = if multiple == 1 { name.to_string() } else { format!("{multiple} x {name}") };
            let line = f64::from(multiple) * base;
            for (sign, by) in [(" + ", 1.0), (" - ", -1.0)] {
                for (other, distance) in beside {
                    lines.push((true, multiple, format!("{text}{sign}{other}"), line + by * distance));
                }
            }
            lines.push((false, multiple, text, line));
        }
    }
    let on = lines.into_iter().filter(|line| (line.3 - frequency).abs() <= ON * spacing);
    on.min_by_key(|line| (line.0, line.1)).map(|(_, _, text, line)| (text, line))
}

/// The own frequency \[Hz] of a race that a peak is near; none where it is near none of them.
pub fn ring_of(own: &[f64], frequency: f64, spacing: f64) -> Option<f64> {
    let far = |one: &f64| (one - frequency).abs();
    let near = own.iter().copied().filter(|one| far(one) <= (RINGS * one).max(spacing));
    near.min_by(|one, other| far(one).total_cmp(&far(other)))
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
        let mesh = Mesh {
            name: "gears".into(),
            frequency: 1127.0,
            shafts: [("one".into(), 49.0), ("two".into(), 16.1)],
        };
        let meshes = [mesh];
        let name = |frequency, spacing| line_of(&named, &meshes, frequency, spacing).map(|(name, _)| name);
        let on = |frequency, spacing| name(frequency, spacing).unwrap();
        for (frequency, name) in [
            (20.5, "FTF"),
            (48.6, "shaft"),
            (177.5, "BPFO"),
            (8.0 * 177.0, "8 x BPFO"),
            (2.0 * 264.0 + 49.0, "2 x BPFI + shaft"),
            (264.0 - 49.5, "BPFI - shaft"),
            (6.0 * 115.0 - 20.0, "6 x BSF - FTF"),
            (10.0 * 177.0, "10 x BPFO"),
            (7.0 * 49.0, "7 x shaft"),
            (1127.3, "gears"),
            (2.0 * 1127.0 + 16.1, "2 x gears + two"),
            (1127.0 - 49.0, "gears - one"),
        ] {
            assert_eq!(on(frequency, 1.0), name, "{frequency}");
        }
        // On none of them: 8 Hz from the next, and far up.
        for frequency in [48.4, 362.0, 3.0 * 264.0 + 197.0, 11.0 * 177.0, 40.0 * 115.0] {
            assert_eq!(name(frequency, 1.0), None, "{frequency}");
        }
        // Lines that stand too close to be told apart have their first multiples alone.
        assert_eq!(name(8.0 * 177.0, 30.0), None);
        assert_eq!(on(3.0 * 177.0, 30.0), "2 x BPFI");
        for still in [0.0, 1e-12] {
            assert_eq!(line_of(&named.map(|(name, _)| (name, still)), &[], 0.5, 1.0), None);
        }
        // A race rings near its own frequencies.
        let own = [412.0, 691.0];
        assert_eq!(
            [683.4, 418.0, 540.0].map(|peak| ring_of(&own, peak, 1.0)),
            [Some(691.0), Some(412.0), None]
        );
        assert_eq!(ring_of(&[], 683.4, 4.0), None);
    }
}
