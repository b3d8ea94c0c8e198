//! Words of a summary on a spectrum.

use std::fmt::{self, Display, Formatter};

use super::lines::{MULTIPLES, Peak, largest, line_of, ring_of};
use super::welch::MOST;
use super::{SIGNALS, Spectrum};

/// [-] peaks of forces and of moments that are named, and share of the largest below which none is.
const FORCES: usize = 5;
const MOMENTS: usize = 2;
const SHARE: f64 = 0.1;
/// [-] turns of the cage that a window should have: lines of cage and races then stand apart.
const CAGE_TURNS: f64 = 4.0;
/// [-] turns of the cage over a window below which it stands: no duration would have enough of them.
const STANDS: f64 = 1e-3;
/// [-] lines in the last tenth over the largest: what goes on beyond them folds back as large.
const FOLDING: f64 = 0.1;
/// [-] rows in a period of the fastest line that is looked for.
const ROWS_PER_PERIOD: f64 = 2.5;

impl Display for Spectrum {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [begin, end] = self.window.map(|time| time * 1e3);
        let spacing = self.spacing();
        let of = match self.amplitudes.segments {
            1 => String::new(),
            count => {
                format!(", mean of {count} segments of {} rows that overlap by half", self.amplitudes.rows)
            }
        };
        writeln!(
            f,
            "spectrum         wrench on the {} race, {begin:.3} to {end:.3} ms{of}; Hann's window, {spacing:.3} Hz a line, up to \
             {:.0} Hz",
            self.race.name(),
            0.5 / self.interval
        )?;
        write!(f, "                 mean")?;
        for (name, frequency) in self.marked {
            write!(f, " {name} {frequency:.2},")?;
        }
        writeln!(f, " shaft {:.2} Hz", self.shaft)?;
        for (index, mesh) in self.meshes.iter().enumerate() {
            write!(
                f,
                "{} {} {:.2}",
                if index == 0 { "                 teeth" } else { "," },
                mesh.name,
                mesh.frequency
            )?;
        }
        if !self.meshes.is_empty() {
            writeln!(f, " Hz")?;
        }
        self.warn(f)?;
        for (signals, most) in [(0..3, FORCES), (3..6, MOMENTS)] {
            for peak in largest(&self.amplitudes, signals, spacing, most, SHARE) {
                self.name(f, &peak)?;
            }
        }
        Ok(())
    }
}

impl Spectrum {
    /// Limits of the lines.
    fn warn(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let says = "                 ";
        let fastest = self.fastest();
        let length = self.amplitudes.rows as f64 * self.interval;
        let [(_, cage), ..] = self.marked;
        if fastest > 0.5 / self.interval {
            let wanted = 1e6 / (ROWS_PER_PERIOD * f64::from(MULTIPLES) * fastest);
            writeln!(
                f,
                "{says}TOO COARSE: marked lines are above {:.1} Hz, half the frequency of the rows, and fold back; \
                 load.output_interval = \"{wanted:.0} us\" shows them",
                0.5 / self.interval
            )?;
        }
        if length * cage < CAGE_TURNS {
            let more = if self.amplitudes.rows < MOST {
                let wanted = 2e3 * CAGE_TURNS / cage;
                if length * cage > STANDS {
                    format!("load.duration = \"{wanted:.0} ms\" has {CAGE_TURNS}")
                } else {
                    "the cage stands".into()
                }
            } else {
                "a longer load.output_interval has more".into()
            };
            writeln!(
                f,
                "{says}SHORT: {:.2} turns of the cage; lines closer than {:.1} Hz run together; {more}",
                length * cage,
                2.0 * self.spacing()
            )?;
        }
        let largest = |from: usize| self.amplitudes.at[from..].iter().flatten().copied().fold(0.0, f64::max);
        if largest(self.amplitudes.at.len() * 9 / 10) > FOLDING * largest(1) {
            writeln!(
                f,
                "{says}FOLDED: lines go on to half the frequency of the rows, and what is faster folds back among them; a shorter \
                 load.output_interval shows which are real"
            )?;
        }
        if self.shaft_change * fastest > 2.0 * self.spacing() * self.shaft {
            writeln!(
                f,
                "{says}SMEARED: the shaft's speed changes by {:.2} Hz over the window, and lines with it",
                self.shaft_change
            )?;
        }
        Ok(())
    }

    /// A peak and the line that it is on, or the own frequency of the race that it is near.
    fn name(&self, f: &mut Formatter<'_>, peak: &Peak) -> fmt::Result {
        let (signal, unit) = SIGNALS[peak.signal];
        write!(f, "peak             {signal} {:.4} {unit} at {:.2} Hz", peak.amplitude, peak.frequency)?;
        if let Some(order) = self.order(peak.frequency) {
            write!(f, ", order {order:.3}")?;
        }
        let shaft = ("shaft", self.shaft);
        let [cage, outer, inner, ball] = self.marked;
        if let Some((name, line)) =
            line_of(&[cage, outer, inner, ball, shaft], &self.meshes, peak.frequency, self.spacing())
        {
            write!(f, "; {name} {:+.2} Hz", peak.frequency - line)?;
        } else if let Some(own) = ring_of(&self.own, peak.frequency, self.spacing()) {
            write!(f, "; own frequency of the race, {own:.0} Hz")?;
        }
        writeln!(f)
    }
}

#[cfg(test)]
mod tests {
    use roulement::model::bodies::Race;

    use super::*;
    use crate::report::spectrum::welch::Amplitudes;

    fn spectrum(rows: usize, interval: f64, cage: f64) -> Spectrum {
        let mut at = vec![[0.0; 6]; rows / 2 + 1];
        at[100] = [3.0, 0.0, 0.0, 0.0, 0.25, 0.0];
        Spectrum {
            race: Race::Inner,
            window: [0.5, 1.0],
            interval,
            amplitudes: Amplitudes { at, rows, segments: 1 },
            shaft: 50.0,
            shaft_change: 0.0,
            own: vec![310.0],
            meshes: vec![],
            marked: [("FTF", cage), ("BPFO", 9.0 * cage), ("BPFI", 14.0 * cage), ("BSF", 6.0 * cage)],
        }
    }

    #[test]
    fn words_name_peaks_and_what_the_lines_cannot_tell() {
        let mut fine = spectrum(5000, 1e-4, 22.2);
        fine.amplitudes.at[152][1] = 2.0;
        fine.amplitudes.at[270][2] = 1.0;
        let fine = fine.to_string();
        for part in [
            "2.000 Hz a line, up to 5000 Hz",
            "FTF 22.20",
            "peak             force.x 3.0000 N at 200.00 Hz, order 4.000; BPFO +0.20 Hz",
            "force.y 2.0000 N at 304.00 Hz, order 6.080; own frequency of the race, 310 Hz\n",
            "force.z 1.0000 N at 540.00 Hz, order 10.800\n",
            "moment.y 0.2500 N.m",
        ] {
            assert!(fine.contains(part), "{fine}\nshould have {part}");
        }
        let warns = |text: &str| ["TOO COARSE", "SHORT", "SMEARED", "FOLDED"].map(|word| text.contains(word));
        assert_eq!(warns(&fine), [false; 4], "{fine}");
        let coarse = spectrum(5000, 1e-4, 400.0).to_string();
        assert!(coarse.contains("output_interval = \"24 us\""), "{coarse}");
        assert_eq!(warns(&coarse), [true, false, false, false]);
        let short = spectrum(5000, 1e-4, 4.0).to_string();
        assert!(short.contains("2.00 turns") && short.contains("load.duration = \"2000 ms\""), "{short}");
        assert_eq!(warns(&short), [false, true, false, false]);
        let faster = Spectrum { shaft_change: 3.0, ..spectrum(5000, 1e-4, 22.0) }.to_string();
        assert_eq!(warns(&faster), [false, false, true, false], "{faster}");
        let mut blows = spectrum(5000, 1e-4, 22.0);
        blows.amplitudes.at[2400][1] = 0.4;
        assert_eq!(warns(&blows.to_string()), [false, false, false, true]);
        // What swings about rest has hardly any mean speed.
        for speed in [0.0, 1e-9] {
            let still = Spectrum { shaft: speed, ..spectrum(5000, 1e-4, speed) }.to_string();
            assert!(
                still.contains("the cage stands") && !still.contains("order") && !still.contains("NaN"),
                "{still}"
            );
        }
    }
}
