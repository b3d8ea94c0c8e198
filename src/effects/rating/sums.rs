//! Sums over the loads of a run: powers of loads over the turn of the races, turn of the load, used life.

use serde::{Deserialize, Serialize};

/// \[rad] turn of the races against each other from which on the turn of the load is that of the run, and not of its first shakes.
const KNOWN_AFTER: f64 = 1.0;

/// How the radial load and both races turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Turning {
    /// \[N] y and z component of the load on the bearing.
    pub force: [f64; 2],
    /// [rad/s] spins of the inner and the outer race.
    pub spins: [f64; 2],
    /// [rad/s] speed of the load's direction, as far as it is known from one instant.
    pub load_speed: f64,
}

impl Turning {
    /// [rad/s] speed of the races against each other.
    pub(super) fn relative(&self) -> f64 {
        self.spins[0] - self.spins[1]
    }
}

/// Means over the loads of a step, or of all steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// [rad/s] speed of the races against each other.
    pub speed: f64,
    /// [N^p] means over the balls of powers of their loads on the inner and the outer race: with p of a race that the load goes
    /// around, and of one that it stands still on.
    pub powers: [[f64; 2]; 2],
    /// [-] share of the turn of the races against each other in which the load goes with the inner race; none where nothing turns or
    /// the load points nowhere.
    pub with_inner: Option<f64>,
    /// \[N] largest load of a ball on the inner race.
    pub largest: f64,
    /// [1/s] rate at which the reference life is used up, for each race that the load may stand still on.
    pub ageing: [f64; 3],
}

/// Record of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sums {
    /// \[s] duration.
    duration: f64,
    /// \[rad] turn of the races against each other.
    turn: f64,
    /// [N^p rad] powers of loads over that turn.
    powers: [[f64; 2]; 2],
    /// [N2 rad] turn of the load from the outer race, and of the inner race from the outer one, weighted by the square of the load.
    turns: [f64; 2],
    /// \[N] largest load of a ball on the inner race so far.
    largest: f64,
    /// [-] part of the reference life that is used up: revolutions over the life under the loads that they had (Miner 1945); for each
    /// race that the load may stand still on.
    pub(super) damage: [f64; 3],
    /// Those of the last step.
    now: Rates,
    /// How load and races turned there; none where the load points nowhere.
    turning: Option<Turning>,
}

impl Sums {
    /// Takes what holds now without a step.
    pub fn begin(&mut self, now: Instant) {
        self.now = now.rates;
        self.turning = now.turning;
        self.largest = self.largest.max(now.rates.largest);
    }

    /// Adds a step of `h` \[s] by the trapezoidal rule.
    pub fn add(&mut self, now: Instant, h: f64) {
        let (before, rates) = (self.now, now.rates);
        self.duration += h;
        self.turn += 0.5 * h * (before.speed + rates.speed);
        for (sum, (before, now)) in self.damage.iter_mut().zip(before.ageing.into_iter().zip(rates.ageing)) {
            *sum += 0.5 * h * (before + now);
        }
        for (race, sums) in self.powers.iter_mut().enumerate() {
            for (power, sum) in sums.iter_mut().enumerate() {
                *sum += 0.5
                    * h
                    * (before.speed * before.powers[race][power] + rates.speed * rates.powers[race][power]);
            }
        }
        if let (Some(before), Some(now)) = (self.turning, now.turning) {
            let ([y0, z0], [y1, z1]) = (before.force, now.force);
            let weight = y0.hypot(z0) * y1.hypot(z1);
            let [inner, outer] = [0, 1].map(|race| 0.5 * h * (before.spins[race] + now.spins[race]));
            // A race that swings goes to and fro: what counts is whether the load follows. At rest nothing ages.
            let way = if inner == outer { 0.0 } else { weight * (inner - outer).signum() };
            let load = (y0 * z1 - z0 * y1).atan2(y0 * y1 + z0 * z1);
            self.turns[0] += way * (load - outer);
            self.turns[1] += way * (inner - outer);
        }
        self.begin(now);
    }

    /// Adds a step of `h` \[s] that ends where other sums have begun.
    pub fn add_until(&mut self, end: &Self, h: f64) {
        self.add(Instant { rates: end.now, turning: end.turning }, h);
    }

    /// Record since an earlier time of the same run. The largest load is that of the whole run.
    #[must_use]
    pub fn since(&self, earlier: &Self) -> Self {
        let mut since = *self;
        since.duration -= earlier.duration;
        since.turn -= earlier.turn;
        for (of_race, before) in since.powers.iter_mut().zip(&earlier.powers) {
            of_race.iter_mut().zip(before).for_each(|(sum, before)| *sum -= before);
        }
        since.turns.iter_mut().zip(&earlier.turns).for_each(|(sum, before)| *sum -= before);
        since.damage.iter_mut().zip(&earlier.damage).for_each(|(sum, before)| *sum -= before);
        since
    }

    /// Record up to a share of a step that ends with later sums: they grow evenly in it. The largest load is that of the step's end.
    #[must_use]
    pub fn within_step(&self, end: &Self, share: f64) -> Self {
        let mut here = *end;
        let mix = |here: &mut f64, begin: f64| *here = begin + share * (*here - begin);
        mix(&mut here.duration, self.duration);
        mix(&mut here.turn, self.turn);
        for (of_race, begin) in here.powers.iter_mut().zip(&self.powers) {
            of_race.iter_mut().zip(begin).for_each(|(sum, begin)| mix(sum, *begin));
        }
        here.turns.iter_mut().zip(&self.turns).for_each(|(sum, begin)| mix(sum, *begin));
        here.damage.iter_mut().zip(&self.damage).for_each(|(sum, begin)| mix(sum, *begin));
        here
    }

    /// \[N] largest load of a ball on the inner race where the last step ended.
    pub fn load_now(&self) -> f64 {
        self.now.largest
    }

    /// Sums with another largest load \[N]: that of a part of the run.
    #[must_use]
    pub fn with_largest(self, largest: f64) -> Self {
        Self { largest, ..self }
    }

    /// [rad/s] mean speed of the races against each other; none of no time.
    pub fn speed(&self) -> Option<f64> {
        (self.duration > 0.0).then(|| self.turn / self.duration)
    }

    /// Means over the revolutions; of a bearing that has not turned, what holds now.
    pub(super) fn means(&self) -> Rates {
        if self.turn > 0.0 {
            let powers = self.powers.map(|of_race| of_race.map(|sum| sum / self.turn));
            let [load, races] = self.turns;
            let known = self.turn >= KNOWN_AFTER && races > 0.0;
            let with_inner = if known { Some(load / races) } else { self.now.with_inner };
            Rates {
                speed: self.turn / self.duration,
                powers,
                with_inner,
                largest: self.largest,
                ageing: self.now.ageing,
            }
        } else {
            Rates { largest: self.largest, ..self.now }
        }
    }
}

/// Sums of the loads at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instant {
    /// Powers of loads, and speed.
    pub rates: Rates,
    /// How load and races turn; none where the load points nowhere.
    pub(super) turning: Option<Turning>,
}
