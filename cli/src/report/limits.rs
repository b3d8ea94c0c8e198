//! Limits of a bearing that a run met: pressure, shoulders, neighbouring balls.

use roulement::contact::shoulder::largest_share;
use roulement::simulation::instant::Instant;
use roulement::simulation::outputs::Outputs;

/// Largest values over the rows of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limits {
    /// \[Pa] peak pressure of a contact.
    pub peak_pressure: f64,
    /// [-] share of a load beyond the shoulders of the inner and the outer race.
    pub over_shoulders: [f64; 2],
    /// \[N] load between neighbouring balls.
    pub between_balls: f64,
}

impl Limits {
    /// Takes where a step has ended.
    pub fn step(&mut self, instant: &Instant) {
        self.peak_pressure = instant.peak_pressure.into_iter().fold(self.peak_pressure, f64::max);
        self.between_balls = self.between_balls.max(instant.between_balls);
    }

    /// Takes a row.
    pub fn push(&mut self, outputs: &Outputs) {
        let contacts = outputs.balls.iter().flat_map(|ball| [&ball.inner, &ball.outer]);
        self.peak_pressure = contacts.map(|contact| contact.peak_pressure).fold(self.peak_pressure, f64::max);
        let balls = || outputs.balls.iter();
        let shares = [
            largest_share(balls().map(|ball| (ball.inner.load, ball.inner.shoulder_share))),
            largest_share(balls().map(|ball| (ball.outer.load, ball.outer.shoulder_share))),
        ];
        for (most, share) in self.over_shoulders.iter_mut().zip(shares) {
            *most = most.max(share);
        }
        let load = outputs.neighbours.map_or(0.0, |neighbours| neighbours.largest_load);
        self.between_balls = self.between_balls.max(load);
    }
}
