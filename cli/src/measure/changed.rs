//! Changes by an effect, with error bars.

use roulement::effects::estimate::Changes;

/// Changes with their error bars.
#[derive(Clone, Copy, Debug)]
pub struct Changed {
    /// [-] changes of all quantities.
    pub changes: Changes,
    /// [-] their error bars.
    pub bars: Changes,
    /// [-] change of the CPU time of a run.
    pub cpu: f64,
}

impl Changed {
    /// The quantity that changes most beyond its error bar, its change and its bar; the largest change where none is beyond it.
    pub fn largest(&self) -> Option<(&'static str, f64, f64)> {
        let both = self.changes.known().zip(self.bars.known());
        let all = both.map(|((name, change), (_, bar))| (name, change, bar));
        let sure = |one: &(&str, f64, f64)| one.1.abs() - one.2;
        all.reduce(|most, other| if sure(&other) > sure(&most) { other } else { most })
    }

    /// Is a quantity changed by more than a threshold, whatever the error?
    pub fn surely_beyond(&self, threshold: f64) -> bool {
        self.largest().is_some_and(|(_, change, bar)| change.abs() - bar > threshold)
    }
}
