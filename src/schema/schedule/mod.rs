//! A scripted quantity: constant, a table of time and value, a sine, or a sum of these.

mod blocks;
pub mod files;
mod sine;

pub(in crate::schema) use blocks::some_schedule;
pub use blocks::{deserialize, is_block, of_value};
pub use sine::Sine;

/// A value over time.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// One value at all times.
    Constant(f64),
    /// Piecewise linear through `(time [s], value)`, held before and after: strictly growing times, at least one.
    Table(Vec<(f64, f64)>),
    /// A value that swings.
    Sine(Sine),
    /// The sum of several.
    Sum(Vec<Self>),
}

impl Schedule {
    /// Value at a time \[s].
    pub fn at(&self, time: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(points) => {
                let next = points.partition_point(|&(t, _)| t <= time);
                let (Some(&(t1, v1)), Some(&(t0, v0))) = (points.get(next), points.get(next.wrapping_sub(1)))
                else {
                    return points[next.min(points.len() - 1)].1;
                };
                v0 + (v1 - v0) * ((time - t0) / (t1 - t0))
            }
            Self::Sine(sine) => sine.at(time),
            Self::Sum(parts) => parts.iter().map(|part| part.at(time)).sum(),
        }
    }

    /// The opposite at all times.
    #[must_use]
    pub fn negated(&self) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(-value),
            Self::Table(points) => Self::Table(points.iter().map(|(time, value)| (*time, -value)).collect()),
            Self::Sine(sine) => Self::Sine(Sine { mean: -sine.mean, amplitude: -sine.amplitude, ..*sine }),
            Self::Sum(parts) => Self::Sum(parts.iter().map(Self::negated).collect()),
        }
    }

    /// Value and rate at a time \[s] of a smooth motion: through the points of a table monotone cubic (Fritsch and
    /// Carlson 1980), at rest at both ends, so that a scripted displacement has no jump in speed; a sine is what it is.
    pub fn smooth_at(&self, time: f64) -> (f64, f64) {
        match self {
            Self::Constant(value) => (*value, 0.0),
            Self::Table(points) => {
                smooth(points, time).map_or((self.at(time), 0.0), |[value, rate, _]| (value, rate))
            }
            Self::Sine(sine) => (sine.at(time), sine.rate(time)),
            Self::Sum(parts) => parts
                .iter()
                .map(|part| part.smooth_at(time))
                .fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1)),
        }
    }

    /// Rate of change of that rate just before a time \[s]: at a point of a table it jumps.
    pub fn smooth_acceleration(&self, time: f64) -> f64 {
        match self {
            Self::Constant(_) => 0.0,
            Self::Table(points) => {
                let next = points.partition_point(|&(t, _)| t < time);
                piece(points, next, time).map_or(0.0, |[_, _, acceleration]| acceleration)
            }
            Self::Sine(sine) => sine.acceleration(time),
            Self::Sum(parts) => parts.iter().map(|part| part.smooth_acceleration(time)).sum(),
        }
    }

    /// \[1/s] rate of change of the value just before a time \[s]; before a table and after it, 0.
    pub fn slope(&self, time: f64) -> f64 {
        match self {
            Self::Constant(_) => 0.0,
            Self::Table(points) => {
                let next = points.partition_point(|&(t, _)| t < time);
                match (points.get(next), points.get(next.wrapping_sub(1))) {
                    (Some(&(t1, v1)), Some(&(t0, v0))) => (v1 - v0) / (t1 - t0),
                    _ => 0.0,
                }
            }
            Self::Sine(sine) => sine.rate_before(time),
            Self::Sum(parts) => parts.iter().map(|part| part.slope(time)).sum(),
        }
    }

    /// Integral of the value from one time \[s] to another, exact for the straight pieces of a table and for sines.
    pub fn integral(&self, from: f64, to: f64) -> f64 {
        match self {
            Self::Constant(value) => value * (to - from),
            Self::Table(points) => area(points, to) - area(points, from),
            Self::Sine(sine) => sine.integral(from, to),
            Self::Sum(parts) => parts.iter().map(|part| part.integral(from, to)).sum(),
        }
    }

    /// Does the value come from a script: from anything but a constant?
    pub fn is_scripted(&self) -> bool {
        !matches!(self, Self::Constant(_))
    }

    /// \[s] times after `from` and before `to` at which it has a kink: where a table bends or a sine begins. Those of a sum
    /// are not in their order.
    pub fn knots(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        let mut knots = vec![];
        for part in self.parts() {
            match part {
                Self::Table(points) => {
                    let first = points.partition_point(|&(time, _)| time <= from);
                    let last = points.partition_point(|&(time, _)| time < to).max(first);
                    knots.extend(points[first..last].iter().map(|&(time, _)| time));
                }
                Self::Sine(sine) => {
                    knots.extend(sine.begin.filter(|&begin| begin > from && begin < to));
                }
                Self::Constant(_) | Self::Sum(_) => {}
            }
        }
        knots.into_iter()
    }

    /// Does it come to other values within a span \[s] of time? A swing about one value does not.
    pub fn changes_within(&self, from: f64, to: f64) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Sine(sine) => sine.begin.is_some_and(|begin| begin > from && begin < to),
            Self::Table(_) => {
                let places = [from, to].into_iter().chain(self.knots(from, to));
                let values: Vec<f64> = places.map(|time| self.at(time)).collect();
                let (low, high) =
                    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                        (low.min(*value), high.max(*value))
                    });
                high - low > 1e-9 * high.abs().max(low.abs())
            }
            Self::Sum(parts) => parts.iter().any(|part| part.changes_within(from, to)),
        }
    }

    /// \[s] shortest period in which it swings at a time \[s]; none where it does not.
    pub fn shortest_period(&self, time: f64) -> Option<f64> {
        let of = |part: &Self| match part {
            Self::Sine(sine) if sine.swings(time) => Some(1.0 / sine.frequency),
            _ => None,
        };
        self.parts().iter().filter_map(of).reduce(f64::min)
    }

    /// Does it swing, now or later?
    pub fn swings(&self) -> bool {
        self.parts().iter().any(|part| matches!(part, Self::Sine(_)))
    }

    /// Is it a motion that begins without a jump in speed?
    pub fn begins_at_rest(&self) -> bool {
        self.parts().iter().all(|part| match part {
            Self::Sine(sine) => sine.begins_at_rest(),
            _ => true,
        })
    }

    /// The value, to be changed, of a schedule that is the same at all times.
    pub fn constant_mut(&mut self) -> Option<&mut f64> {
        match self {
            Self::Constant(value) => Some(value),
            Self::Table(_) | Self::Sine(_) | Self::Sum(_) => None,
        }
    }

    /// Values that all others lie between, for range checks: those of the points of a table, both ends of a sine. Those of a sum
    /// are bounds between each two kinks: sines need not come to their ends at once.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::Constant(value) => vec![*value],
            Self::Table(points) => points.iter().map(|&(_, value)| value).collect(),
            Self::Sine(sine) => vec![sine.mean - sine.amplitude, sine.mean + sine.amplitude],
            Self::Sum(parts) => sum_values(&parts.iter().map(|part| (1.0, part)).collect::<Vec<_>>()),
        }
    }

    /// Values of the difference to another.
    pub fn values_of_difference(&self, other: &Self) -> Vec<f64> {
        let signed = |sign: f64, of| Self::parts(of).iter().map(move |part| (sign, part));
        sum_values(&signed(1.0, self).chain(signed(-1.0, other)).collect::<Vec<_>>())
    }

    /// Terms of a sum; a schedule that is none is its own one term.
    fn parts(&self) -> &[Self] {
        match self {
            Self::Sum(parts) => parts,
            single => std::slice::from_ref(single),
        }
    }
}

impl Default for Schedule {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

/// Bounds of a sum of parts, each times its sign, between all kinks of the parts.
fn sum_values(parts: &[(f64, &Schedule)]) -> Vec<f64> {
    const ALL: f64 = f64::INFINITY;
    let mut kinks: Vec<f64> = parts.iter().flat_map(|(_, part)| part.knots(-ALL, ALL)).collect();
    kinks.sort_by(f64::total_cmp);
    kinks.dedup();
    let of_piece = |from: f64, to: f64| -> [f64; 4] {
        let mut ends = [[0.0; 2]; 2];
        for (sign, part) in parts {
            let [low, high] = match part {
                Schedule::Sine(sine) if sine.swings(from) => [[-1.0; 2], [1.0; 2]]
                    .map(|of| of.map(|side: f64| sign * sine.mean + side * sine.amplitude.abs())),
                part => [[from, to].map(|time| sign * part.at(time)); 2],
            };
            for i in 0..2 {
                ends[0][i] += low[i];
                ends[1][i] += high[i];
            }
        }
        [ends[0][0], ends[0][1], ends[1][0], ends[1][1]]
    };
    let (Some(&first), Some(&last)) = (kinks.first(), kinks.last()) else {
        return of_piece(0.0, 0.0).to_vec();
    };
    // Before the first kink and after the last, all but sines is as it is there.
    let outside = [of_piece(-f64::MAX, first), of_piece(last, last)];
    let between = kinks.windows(2).map(|pair| of_piece(pair[0], pair[1]));
    outside.into_iter().chain(between).flatten().collect()
}

/// Value, rate and acceleration of a smooth motion through points between their ends.
fn smooth(points: &[(f64, f64)], time: f64) -> Option<[f64; 3]> {
    piece(points, points.partition_point(|&(t, _)| t <= time), time)
}

/// Those of the piece that ends at a point.
fn piece(points: &[(f64, f64)], next: usize, time: f64) -> Option<[f64; 3]> {
    let (&(t1, v1), &(t0, v0)) = (points.get(next)?, points.get(next.wrapping_sub(1))?);
    // Harmonic mean of the secants on both sides; 0 at extrema and at the ends.
    let slope = |i: usize| -> f64 {
        if i == 0 || i + 1 == points.len() {
            return 0.0;
        }
        let secant = |j: usize| (points[j + 1].1 - points[j].1) / (points[j + 1].0 - points[j].0);
        let (left, right) = (secant(i - 1), secant(i));
        if left * right <= 0.0 { 0.0 } else { 2.0 * left * right / (left + right) }
    };
    let (duration, s) = (t1 - t0, (time - t0) / (t1 - t0));
    let (m0, m1) = (slope(next - 1) * duration, slope(next) * duration);
    let rise = v1 - v0;
    let value = v0 + s * (m0 + s * (3.0 * rise - 2.0 * m0 - m1 + s * (m0 + m1 - 2.0 * rise)));
    let rate = m0 + s * (2.0 * (3.0 * rise - 2.0 * m0 - m1) + 3.0 * s * (m0 + m1 - 2.0 * rise));
    let acceleration = 2.0 * (3.0 * rise - 2.0 * m0 - m1) + 6.0 * s * (m0 + m1 - 2.0 * rise);
    Some([value, rate / duration, acceleration / (duration * duration)])
}

/// Area below a table from its first point to a time \[s]; negative before that point.
fn area(points: &[(f64, f64)], time: f64) -> f64 {
    let (first, last) = (points[0], points[points.len() - 1]);
    let mut sum = first.1 * (time.min(first.0) - first.0);
    for pair in points.windows(2) {
        let ((t0, v0), (t1, v1)) = (pair[0], pair[1]);
        if time <= t0 {
            break;
        }
        let end = time.min(t1);
        let value = v0 + (v1 - v0) * ((end - t0) / (t1 - t0));
        sum += 0.5 * (v0 + value) * (end - t0);
    }
    sum + last.1 * (time.max(last.0) - last.0)
}
