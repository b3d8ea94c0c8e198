//! A value that swings.

use std::f64::consts::{PI, TAU};

/// A value that swings about its mean: `mean + amplitude sin(2 pi frequency (t - begin) + phase)`; held before it begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine {
    /// Value that it swings about, in SI.
    pub mean: f64,
    /// Largest distance from that, in the same unit.
    pub amplitude: f64,
    /// \[Hz] periods in a second.
    pub frequency: f64,
    /// \[rad] angle at the beginning, or at time 0 of one without.
    pub phase: f64,
    /// \[s] when it begins; one without swings at all times.
    pub begin: Option<f64>,
}

impl Sine {
    /// Value at a time \[s].
    pub fn at(&self, time: f64) -> f64 {
        self.mean + self.amplitude * self.angle(time).sin()
    }

    /// [1/s] rate of change of the value after a time \[s].
    pub fn rate(&self, time: f64) -> f64 {
        if self.swings(time) { self.rate_of_angle(self.angle(time)) } else { 0.0 }
    }

    /// [1/s] rate of change of the value just before a time \[s].
    pub fn rate_before(&self, time: f64) -> f64 {
        if self.begin == Some(time) { 0.0 } else { self.rate(time) }
    }

    /// Rate of change of that rate.
    pub fn acceleration(&self, time: f64) -> f64 {
        let pace = TAU * self.frequency;
        if self.swings(time) { -pace * pace * self.amplitude * self.angle(time).sin() } else { 0.0 }
    }

    /// Integral of the value from one time \[s] to another.
    pub fn integral(&self, from: f64, to: f64) -> f64 {
        let begin = self.begin.unwrap_or(f64::NEG_INFINITY);
        let held = to.min(begin) - from.min(begin);
        let middle = 0.5 * (self.angle(from) + self.angle(to));
        // Of the cosines at both ends, whose difference would lose digits over short times.
        let half = PI * self.frequency * (to.max(begin) - from.max(begin));
        let swung = middle.sin() * half.sin() / (PI * self.frequency);
        let held = if held.is_finite() { self.amplitude * self.phase.sin() * held } else { 0.0 };
        self.mean * (to - from) + held + self.amplitude * swung
    }

    /// Has it begun at a time \[s]?
    pub fn swings(&self, time: f64) -> bool {
        self.amplitude != 0.0 && self.begin.is_none_or(|begin| time >= begin)
    }

    /// Does it begin without a jump in speed, at one of its turning points?
    pub fn begins_at_rest(&self) -> bool {
        // Degrees become radians with rounding.
        self.amplitude == 0.0 || self.phase.cos().abs() < 1e-9
    }

    fn angle(&self, time: f64) -> f64 {
        let since = match self.begin {
            Some(begin) => (time - begin).max(0.0),
            None => time,
        };
        TAU * (self.frequency * since) + self.phase
    }

    fn rate_of_angle(&self, angle: f64) -> f64 {
        TAU * self.frequency * self.amplitude * angle.cos()
    }
}
