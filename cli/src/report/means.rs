//! Means over the second half of a run (or another last part of it), and whether they have settled: drift against noise.
//!
//! Values are integrated over time from step to step, as energies are; rows have no part in it. Blocks of equal duration keep the sums, at
//! most 128: when there would be more, neighbours are joined, so that memory does not grow with the run. The window is made
//! of the blocks of the second half. It is divided into equal groups,
//! and a straight line is fitted through their means. A mean has settled if the drift of that line over the window is not
//! significant (Student's t, two-sided, 99 %) or less than [`NEGLIGIBLE`] of its size. Noise is the scatter of the group
//! means of the later half of the window about a line of their own: a decay that fills the window bends the line through all of
//! them, and its bend would pass for noise.

use std::borrow::Cow;
use std::io;
use std::path::Path;

use roulement::simulation::Simulation;
use roulement::simulation::instant::Instant;
use roulement::simulation::losses::LOSSES;

use super::interval;
use super::quantities::{Parts, Size, Watched, of_bearing, values, weights};

/// [-] blocks of a run; even.
const MOST_BLOCKS: usize = 128;
/// [-] blocks at the start for one of the end of a run that comes to its time.
const FINER: usize = 64;
/// [-] share of a run before the window, where nothing else is asked for.
const HALF: f64 = 0.5;
/// [-] groups of the window for the trend, at most and at least.
const GROUPS: usize = 16;
const FEWEST_GROUPS: usize = 8;
/// [-] drift over the window, over the size of the quantity, that does not matter: a tenth of a percent.
pub const NEGLIGIBLE: f64 = 1e-3;
/// [-] of the largest force, at the arm: a torque of no account.
const NOTHING: f64 = 1e-6;
/// [-] drift over the window, over the size of the quantity, that no noise excuses.
const MOST_DRIFT: f64 = 0.05;
/// Student's t, two-sided 99 %, for 1 to 6 degrees of freedom (Abramowitz and Stegun, table 26.10).
const STUDENT_T: [f64; GROUPS / 2 - 2] = [63.657, 9.925, 5.841, 4.604, 4.032, 3.707];
/// [-] run lengths further ahead than this are not foretold.
const FURTHEST: f64 = 100.0;

/// Largest values that are reported over the window: eccentricity of the cage \[m], pocket load \[N], land load \[N].
pub fn largest(instant: &Instant) -> [f64; 3] {
    instant.cage.map_or([0.0; 3], |cage| [cage.eccentricity, cage.pocket_load, cage.land_load])
}

#[derive(Clone, Debug)]
struct Block {
    /// Step ends in it.
    steps: u64,
    /// Integrals of weights, and of values times these.
    weights: Vec<f64>,
    sums: Vec<f64>,
    largest: [f64; 3],
}

impl Block {
    fn empty(quantities: usize) -> Self {
        let zero = vec![0.0; quantities];
        Self { steps: 0, weights: zero.clone(), sums: zero, largest: [0.0; 3] }
    }

    /// Adds the part of a step between two times \[s]: what goes linearly from one of its ends to the other.
    fn add(&mut self, [start, end]: [&Weighted; 2], [from, to]: [f64; 2]) {
        // The middle of the part is where its mean is.
        let share = (0.5 * (from + to) - start.time) / (end.time - start.time);
        let duration = to - from;
        let integral = |a: f64, b: f64| duration * (a + share * (b - a));
        for i in 0..self.sums.len() {
            self.sums[i] += integral(start.products[i], end.products[i]);
            self.weights[i] += integral(start.weights[i], end.weights[i]);
        }
    }

    fn join(&mut self, later: &Self) {
        self.steps += later.steps;
        for (sums, others) in [(&mut self.weights, &later.weights), (&mut self.sums, &later.sums)] {
            sums.iter_mut().zip(others).for_each(|(sum, other)| *sum += other);
        }
        self.largest.iter_mut().zip(&later.largest).for_each(|(one, other)| *one = one.max(*other));
    }
}

/// Weights of values at an instant, and products of both.
#[derive(Clone, Debug, Default)]
struct Weighted {
    time: f64,
    weights: Vec<f64>,
    products: Vec<f64>,
}

impl Weighted {
    fn take(&mut self, time: f64, values: &[f64], weights: &[f64]) {
        self.time = time;
        self.weights.clear();
        self.weights.extend_from_slice(weights);
        self.products.clear();
        self.products.extend(values.iter().zip(weights).map(|(value, weight)| value * weight));
    }
}

/// Integrals over a run, block by block.
#[derive(Clone, Debug)]
pub struct Blocks {
    blocks: Vec<Block>,
    /// \[s] of a block.
    length: f64,
    /// Where the last step ended; none before the start.
    last: Option<Weighted>,
    /// One that is not needed any more.
    spare: Option<Weighted>,
    /// \[s] of the start.
    begin: f64,
    quantities: Vec<Watched>,
    /// \[m] what forces have a moment at.
    arm: f64,
    /// \[s] times that count; all where there is none.
    window: Option<[f64; 2]>,
}

/// The mean of a quantity over the window.
#[derive(Clone, Debug, PartialEq)]
pub struct Mean {
    /// Name.
    pub name: Cow<'static, str>,
    /// Unit.
    pub unit: &'static str,
    /// \[unit] mean.
    pub mean: f64,
    /// Its trend; none where the window has too few steps to tell.
    pub trend: Option<Trend>,
    /// \[unit] half of the interval in which the mean of a longer run lies, at 95 %, if the run goes on as in the window; none
    /// where the window has too few steps to tell.
    pub interval: Option<f64>,
    /// Its numerical error, where that was measured.
    pub error: Option<MeasuredError>,
}

/// Numerical error of a quantity, measured with a run at twice the steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredError {
    /// \[unit] of the mean; with the interval of the mean where the quantity is chaotic.
    pub mean: f64,
    /// \[unit] of values at equal times, root mean square over the run; none where the quantity is chaotic.
    pub history: Option<f64>,
}

/// Trend of a quantity over the window.
#[derive(Clone, Debug, PartialEq)]
pub struct Trend {
    /// \[unit] standard error of the mean, from the scatter of the groups.
    pub error: f64,
    /// \[unit] drift over the window.
    pub drift: f64,
    /// \[unit] drift over the window that noise alone may show (99 %).
    pub noise: f64,
    /// Has the mean settled?
    pub settled: bool,
    /// \[s] duration of a run whose window has settled, if the drift goes on to decay as it does in the window; none
    /// where it does not decay.
    pub needed: Option<f64>,
}

/// Means over the last part of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Means {
    /// \[s] first and last time of the window.
    pub window: [f64; 2],
    /// Does the script come to other values inside the window? Means are then of no state.
    pub scripted: bool,
    /// Does a motion grow, or is it beyond what loads explain? Means are then those of that motion, and of no state that lasts.
    pub unstable: bool,
    /// Means of all quantities that are shown.
    pub means: Vec<Mean>,
    /// Largest values of a cage: eccentricity \[m], pocket load \[N], land load \[N].
    pub largest: [f64; 3],
}

impl Blocks {
    /// None yet of these quantities, of a run of a duration \[s]; forces have a moment at an arm \[m].
    pub fn new(quantities: Vec<Watched>, arm: f64, duration: f64) -> Self {
        let length = duration / (MOST_BLOCKS * FINER) as f64;
        Self { blocks: vec![], length, last: None, spare: None, begin: 0.0, quantities, arm, window: None }
    }

    /// None yet of a window \[s] of a run: of a step that is not all in it, the part that is counts.
    pub fn within(quantities: Vec<Watched>, arm: f64, window: [f64; 2]) -> Self {
        let [from, to] = window;
        Self { window: Some(window), ..Self::new(quantities, arm, to - from) }
    }

    /// Quantities that they are of.
    pub fn quantities(&self) -> &[Watched] {
        &self.quantities
    }

    /// None yet of a bearing.
    pub fn of_bearing(simulation: &Simulation) -> Self {
        let pitch_radius = 0.5 * simulation.model().bearing.pitch_diameter;
        let duration = simulation.scene().load.duration.0;
        Self::new(of_bearing(Parts::of(simulation)), pitch_radius, duration)
    }

    /// Goes on to where a step of a bearing has ended.
    pub fn push(&mut self, instant: &Instant) {
        self.add(instant.time, &values(instant), &weights(instant), largest(instant));
    }

    /// Goes on to a time \[s] with values, what they count for, and the largest values since the last time. A time that was there already adds
    /// nothing.
    pub fn add(&mut self, time: f64, values: &[f64], weights: &[f64], largest: [f64; 3]) {
        if self.last.as_ref().is_some_and(|last| last.time >= time) {
            return;
        }
        let mut now = self.spare.take().unwrap_or_default();
        now.take(time, values, weights);
        let [opens, closes] = self.window.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let until = time.min(closes);
        if let Some(last) = self.last.take() {
            let mut from = last.time.max(opens);
            while from < until {
                let index = self.block_at(from);
                let end = self.begin + (index + 1) as f64 * self.length;
                // What is left beyond the end by rounding belongs to the block before it; a block that ends where it is looked for, to
                // which rounding may lead in a short window of a long run, would never come to the end.
                let rest = self.rounding(until) * self.length;
                let to = if end >= until - rest || end <= from { until } else { end };
                self.blocks[index].add([&last, &now], [from, to]);
                from = to;
            }
            self.spare = Some(last);
        } else {
            self.begin = time.max(opens);
        }
        if (opens..=closes).contains(&time) {
            let index = self.block_before(time);
            let block = &mut self.blocks[index];
            block.steps += 1;
            block.largest.iter_mut().zip(largest).for_each(|(most, value)| *most = most.max(value));
        }
        self.last = Some(now);
    }

    /// [-] part of a block that is rounding at a time \[s].
    fn rounding(&self, time: f64) -> f64 {
        (4.0 * f64::EPSILON * time.abs() / self.length).max(1e-9)
    }

    /// The block that what comes after a time belongs to.
    fn block_at(&mut self, time: f64) -> usize {
        loop {
            let index = ((time - self.begin) / self.length + self.rounding(time)).max(0.0) as usize;
            if index < MOST_BLOCKS {
                while self.blocks.len() <= index {
                    self.blocks.push(Block::empty(self.quantities.len()));
                }
                return index;
            }
            let mut pairs = std::mem::take(&mut self.blocks).into_iter();
            while let Some(mut block) = pairs.next() {
                pairs.next().iter().for_each(|later| block.join(later));
                self.blocks.push(block);
            }
            self.length *= 2.0;
        }
    }

    /// The block that a time itself belongs to: the end of one, rather than the begin of the next.
    fn block_before(&mut self, time: f64) -> usize {
        let blocks = ((time - self.begin) / self.length - self.rounding(time)).max(0.0);
        let index = (blocks as usize).min(self.blocks.len().saturating_sub(1));
        if self.blocks.is_empty() {
            self.blocks.push(Block::empty(self.quantities.len()));
        }
        index
    }

    /// \[s] where the window of a run begins that ends at a time.
    pub fn window_begins(duration: f64) -> f64 {
        HALF * duration
    }

    /// Means over the second half of what there is; none without a step.
    pub fn means(&self) -> Option<Means> {
        self.means_from(HALF)
    }

    /// Means over all there is, or all of the window; none without a step in it. How long a run would settle them is not told: a window
    /// stays where it is.
    pub fn all(&self) -> Option<Means> {
        let mut means = self.means_from(0.0)?;
        means.means.iter_mut().filter_map(|mean| mean.trend.as_mut()).for_each(|trend| trend.needed = None);
        Some(means)
    }

    /// Means over what comes after this share of the time, in [0, 1); none without a step.
    pub fn means_from(&self, share: f64) -> Option<Means> {
        let end = self.last.as_ref()?.time;
        let end = self.window.map_or(end, |[_, closes]| end.min(closes));
        if end <= self.begin {
            return None;
        }
        // The first block that begins after it.
        let first = ((end - self.begin) * share / self.length - 1e-9).max(0.0).ceil() as usize;
        let window = &self.blocks[first.min(self.blocks.len().checked_sub(1)?)..];
        let mut all = window[0].clone();
        window[1..].iter().for_each(|block| all.join(block));
        let span = [self.begin + (self.blocks.len() - window.len()) as f64 * self.length, end];
        let steps = all.steps as usize;
        let mean = |i: usize| mean_of(all.sums[i], all.weights[i]);
        let quantities = &self.quantities;
        let largest_of = |size: Size| {
            let of = (0..quantities.len()).filter(|&i| quantities[i].size == size);
            of.map(|i| mean(i).abs()).fold(0.0, f64::max)
        };
        let losses = quantities.iter().position(|quantity| quantity.name == LOSSES[0].name);
        let size = |i: usize| match quantities[i].size {
            Size::Own => mean(i).abs(),
            Size::Losses => losses.map_or(0.0, |whole| mean(whole).abs()),
            Size::Moment => largest_of(Size::Force) * self.arm,
            Size::One => 1.0,
            size => largest_of(size),
        };
        // A drift of a torque or a power that is nothing is none.
        let nothing = |i: usize| {
            let torque = NOTHING * largest_of(Size::Force) * self.arm;
            match (quantities[i].size, quantities[i].unit) {
                (Size::Own | Size::Losses, "W") => torque * largest_of(Size::Speed),
                (Size::Own, _) => torque,
                _ => 0.0,
            }
        };
        let there = (0..quantities.len()).filter(|&i| quantities[i].shown);
        let means = there.map(|i| {
            // No more groups than steps, and nearly all blocks in them.
            let each = window.len().div_ceil(GROUPS.min(steps.max(1)));
            let of_trend = groups(window, i, each, window.len() / each);
            let trend =
                Trend::of(&of_trend, span.map(|time| time - self.begin), share, (size(i), nothing(i)));
            let interval = interval::of_mean(|n| {
                let each = (window.len() / n).max(1);
                groups(window, i, each, n.min(window.len()).min(steps))
            });
            let (name, unit) = (quantities[i].name.clone(), quantities[i].unit);
            Mean { name, unit, mean: mean(i), trend, interval, error: None }
        });
        Some(Means {
            window: span,
            scripted: false,
            unstable: false,
            means: means.collect(),
            largest: all.largest,
        })
    }
}

/// A mean by its sums of values times weights, and of weights; it lies between the values, however small these are. 0 where nothing
/// counts, as of the slip of a bearing that stands.
fn mean_of(sum: f64, weight: f64) -> f64 {
    if weight > 0.0 { sum / weight } else { 0.0 }
}

/// Means of a quantity in groups of so many of the window's blocks, `n` of them; the oldest blocks are left out where they do
/// not divide.
fn groups(window: &[Block], quantity: usize, each: usize, n: usize) -> Vec<f64> {
    let mean = |blocks: &[Block]| {
        let sum = |of: fn(&Block) -> &[f64]| blocks.iter().map(|block| of(block)[quantity]).sum::<f64>();
        mean_of(sum(|block| &block.sums), sum(|block| &block.weights))
    };
    window[window.len() - n * each..].chunks_exact(each).map(mean).collect()
}

/// A straight line through values at 0, 1, 2 ..
struct Line {
    slope: f64,
    /// Sum of squares of the places about their mean.
    places: f64,
    /// Sum of squares of the values about the line.
    rest: f64,
    /// That about a parabola.
    rest_of_parabola: f64,
}

impl Line {
    fn through(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let centred = |i: usize| i as f64 - 0.5 * (count - 1.0);
        let sum = |of: &dyn Fn(usize) -> f64| (0..values.len()).map(of).sum::<f64>();
        let places = sum(&|i| centred(i) * centred(i));
        let slope = sum(&|i| centred(i) * values[i]) / places;
        let rest = sum(&|i| (values[i] - mean - slope * centred(i)).powi(2));
        // Orthogonal to constants and to lines.
        let bend = |i: usize| centred(i) * centred(i) - places / count;
        let of_bend = sum(&|i| bend(i) * values[i]).powi(2) / sum(&|i| bend(i) * bend(i));
        Self { slope, places, rest, rest_of_parabola: (rest - of_bend).max(0.0) }
    }
}

impl Trend {
    /// Trend through the means of equal groups of a window \[s], counted from the start of the run; the window begins at this
    /// share of it.
    fn of(groups: &[f64], window: [f64; 2], share: f64, (size, nothing): (f64, f64)) -> Option<Self> {
        let n = groups.len();
        if n < FEWEST_GROUPS {
            return None;
        }
        let count = n as f64;
        let mean = groups.iter().sum::<f64>() / count;
        let all = Line::through(groups);
        let later = Line::through(&groups[n / 2..]);
        let freedom = (n - n / 2).min(GROUPS / 2) - 2;
        let drift_of = |rest: f64, freedom: usize| {
            STUDENT_T[freedom - 1] * (rest / freedom as f64 / all.places).sqrt() * count
        };
        let noise = drift_of(later.rest, freedom);
        let drift = all.slope * count;
        let allowed = noise.max(NEGLIGIBLE * size);
        // The bend of a decay, which passes for noise here, will be gone in a longer run.
        let noise_then = drift_of(later.rest_of_parabola, freedom - 1);
        let allowed_then = noise_then.min(noise).max(NEGLIGIBLE * size);
        // What noise hides is no small drift yet.
        let settled = drift.abs() <= allowed && drift.abs() <= (MOST_DRIFT * size).max(nothing);
        // An exponential approach: the drift of the second half of the window over that of the first.
        let quarter = |k: usize| {
            let part = &groups[k * n / 4..(k + 1) * n / 4];
            part.iter().sum::<f64>() / part.len() as f64
        };
        let ratio = (quarter(3) - quarter(2)) / (quarter(1) - quarter(0));
        let needed = (ratio > 0.0 && ratio < 1.0).then(|| {
            let time_constant = 0.5 * (window[1] - window[0]) / -ratio.ln();
            // A window that begins there drifts by no more than is allowed; it is the same part of its run, which is
            // longer than this one's: its drift is up to that of the whole rest of the approach.
            let whole = drift.abs() / (1.0 - ratio * ratio);
            (window[0] + time_constant * (whole / allowed_then).ln().max(0.0)) / share
        });
        let deviation =
            groups.iter().map(|group| (group - mean) * (group - mean)).sum::<f64>() / (count - 1.0);
        Some(Self {
            error: (deviation / count).sqrt(),
            drift,
            noise,
            settled,
            needed: needed.filter(|needed| !settled && *needed < FURTHEST * window[1]),
        })
    }
}

impl Means {
    /// The mean of a quantity by its name.
    pub fn find(&self, name: &str) -> Option<&Mean> {
        self.means.iter().find(|mean| mean.name == name)
    }

    /// The mean of a quantity by its name; not a number where it is not there.
    pub fn of(&self, name: &str) -> f64 {
        self.find(name).map_or(f64::NAN, |mean| mean.mean)
    }

    /// Means that have not settled.
    pub fn unsettled(&self) -> impl Iterator<Item = (&Mean, &Trend)> {
        let trends = self.means.iter().filter_map(|mean| Some((mean, mean.trend.as_ref()?)));
        trends.filter(|(_, trend)| !trend.settled)
    }

    /// Have all settled? None where that cannot be told.
    pub fn settled(&self) -> Option<bool> {
        match self.scripted || self.unstable {
            true => Some(false),
            false => self.can_tell().then(|| self.unsettled().next().is_none()),
        }
    }

    /// Can the steps tell whether means have settled?
    pub fn can_tell(&self) -> bool {
        self.means.iter().all(|mean| mean.trend.is_some())
    }

    /// \[s] duration of a run in which all would have settled; none where one does not decay.
    pub fn needed(&self) -> Option<f64> {
        self.unsettled().try_fold(0.0, |longest, (_, trend)| Some(f64::max(longest, trend.needed?)))
    }

    /// Writes the means as a table, and other numbers of the window below them: name, unit, value.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path, others: &[(&str, &str, f64)]) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(vec![]);
        let header = [
            "quantity",
            "unit",
            "window_begin [s]",
            "window_end [s]",
            "mean",
            "standard_error",
            "drift",
            "drift_of_noise",
            "settled",
            "needed_duration [s]",
            "interval_95",
            "error",
            "history_error",
        ];
        table.write_record(header)?;
        let text = |number: Option<f64>| number.map_or(String::new(), |number| number.to_string());
        for mean in &self.means {
            let trend = mean.trend.as_ref();
            let number = |get: fn(&Trend) -> f64| trend.map_or(String::new(), |trend| get(trend).to_string());
            table.write_record([
                mean.name.to_string(),
                mean.unit.to_string(),
                self.window[0].to_string(),
                self.window[1].to_string(),
                mean.mean.to_string(),
                number(|trend| trend.error),
                number(|trend| trend.drift),
                number(|trend| trend.noise),
                trend.map_or(String::new(), |trend| trend.settled.to_string()),
                trend.and_then(|trend| trend.needed).map_or(String::new(), |needed| needed.to_string()),
                text(mean.interval),
                text(mean.error.map(|error| error.mean)),
                text(mean.error.and_then(|error| error.history)),
            ])?;
        }
        for (name, unit, value) in others {
            let mut record = vec![String::new(); header.len()];
            record[0] = (*name).to_string();
            record[1] = (*unit).to_string();
            (record[2], record[3]) = (self.window[0].to_string(), self.window[1].to_string());
            record[4] = value.to_string();
            table.write_record(record)?;
        }
        let table = table.into_inner().map_err(|why| io::Error::other(why.to_string()))?;
        std::fs::write(path, table)
    }
}

#[cfg(test)]
mod tests {
    use super::super::quantities::{COUNT, QUANTITIES};
    use super::*;

    /// Means of a run of 1 s whose quantities are all the same function of time.
    fn means(rows: u32, value: impl Fn(f64) -> f64) -> Means {
        run(rows, 1.0, value)
    }

    fn run(rows: u32, duration: f64, value: impl Fn(f64) -> f64) -> Means {
        let mut blocks = Blocks::new(
            of_bearing(Parts { cage: true, moving_outer: true, losses: [true; LOSSES.len()] }),
            1.0,
            duration,
        );
        for row in 0..=rows {
            let time = duration * f64::from(row) / f64::from(rows);
            blocks.add(time, &[value(time); COUNT], &[1.0; COUNT], [value(time); 3]);
        }
        assert_eq!(blocks.blocks.len(), MOST_BLOCKS);
        blocks.means().unwrap_or_else(|| panic!("there are rows"))
    }

    fn trend(means: &Means) -> &Trend {
        means.means[0].trend.as_ref().unwrap_or_else(|| panic!("there are rows enough"))
    }

    #[test]
    fn closed_form_means_of_a_line_whatever_the_number_of_rows() {
        for rows in [20, 127, 128, 500, 5000, 100_000] {
            let means = means(rows, |time| 3.0 + time);
            assert!((means.window[0] - 0.5).abs() < 1e-12 && means.window[1] == 1.0, "{:?}", means.window);
            assert!((means.means[0].mean - 3.75).abs() < 1e-12, "{rows} {}", means.means[0].mean);
            assert!((means.largest[0] - 4.0).abs() < 1e-12);
            assert!(!trend(&means).settled && (trend(&means).drift - 0.5).abs() < 0.06);
            // A line does not decay: nothing is foretold.
            assert_eq!(means.needed().filter(|needed| *needed < 3.0), None);
        }
    }

    #[test]
    fn invariant_noise_is_no_drift_and_a_decay_is_one() {
        // Sines of ball passings with phases that do not fit the window.
        let swing = |time: f64| 0.3 * (97.3 * time).sin() + 0.2 * (233.1 * time + 1.0).cos();
        for rows in [100, 1000, 20_000] {
            assert!(trend(&means(rows, |time| 10.0 + swing(time))).settled, "{rows}");
            assert!(trend(&means(rows, |_| 10.0)).settled);
            let decaying = means(rows, |time| 10.0 + 5.0 * (-time / 0.4).exp() + 0.01 * swing(time));
            assert!(!trend(&decaying).settled, "{rows}");
        }
    }

    #[test]
    fn closed_form_the_run_that_is_needed_settles_and_a_shorter_one_does_not() {
        let decay = |time: f64| 10.0 + 5.0 * (-time / 0.4).exp();
        let short = means(2000, decay);
        let slip = QUANTITIES.iter().position(|quantity| quantity.size == Size::One).unwrap();
        // The drift of the second half of a run of L is 5 exp(-L/0.8) (1 - exp(-L/0.8)); 0.01 is allowed of a force of 10, 0.001 of a slip.
        for (quantity, expected) in [(0, 4.97), (slip, 6.81)] {
            let trend = |means: &Means| means.means[quantity].trend.clone().unwrap();
            let needed = trend(&short).needed.unwrap_or_else(|| panic!("it decays"));
            assert!((needed / expected - 1.0).abs() < 0.15, "{needed} {expected}");
            assert!(trend(&run(2000, 1.1 * needed, decay)).settled, "{quantity}");
            assert!(!trend(&run(2000, 0.8 * needed, decay)).settled, "{quantity}");
        }
        assert!(short.needed() >= short.means[slip].trend.as_ref().unwrap().needed);
    }

    #[test]
    fn closed_form_means_are_over_time_whatever_the_steps() {
        // A blow of a tenth of the time is a tenth of the mean, though most steps are in it; steps end where they like.
        let times = (0..=2000).map(|k| {
            let share = f64::from(k) / 2000.0;
            // Dense between 0.7 and 0.75, a tenth of the window.
            if share < 0.05 {
                share * 14.0
            } else if share < 0.95 {
                0.7 + (share - 0.05) / 18.0
            } else {
                0.75 + (share - 0.95) * 5.0
            }
        });
        let mut blocks = Blocks::new(
            of_bearing(Parts { cage: false, moving_outer: false, losses: [false; LOSSES.len()] }),
            1.0,
            1.0,
        );
        let value = |time: f64| if (0.7..0.75).contains(&time) { 5.0 } else { 1.0 };
        times.for_each(|time| blocks.add(time, &[value(time); COUNT], &[1.0; COUNT], [0.0; 3]));
        let mean = blocks.means().unwrap().means[0].mean;
        assert!((mean - 1.4).abs() < 0.03, "{mean}");
        // One that ends early has the second half of what there is, to a block.
        let mut early = Blocks::new(
            of_bearing(Parts { cage: false, moving_outer: false, losses: [false; LOSSES.len()] }),
            1.0,
            1.0,
        );
        for k in 0..=300 {
            let time = f64::from(k) * 1e-3;
            early.add(time, &[time; COUNT], &[1.0; COUNT], [0.0; 3]);
        }
        let means = early.means().unwrap();
        assert!((means.window[0] - 0.15).abs() < 0.3 / 64.0 && means.window[1] == 0.3, "{:?}", means.window);
        assert!((means.means[0].mean - 0.5 * (means.window[0] + 0.3)).abs() < 1e-12 && means.can_tell());
    }

    #[test]
    fn closed_form_a_mean_of_slip_is_by_the_speed_that_rolls() {
        // A speed of rolling 10 cos(t) that swings, and a body that stays behind by a tenth of it and 1e-3.
        let mut blocks = Blocks::new(
            of_bearing(Parts { cage: true, moving_outer: true, losses: [true; LOSSES.len()] }),
            1.0,
            40.0,
        );
        for row in 0..=40_000 {
            let time = f64::from(row) * 1e-3;
            let rolling = (10.0 * time.cos()).abs();
            let behind = 0.1 * rolling + 1e-3;
            blocks.add(time, &[behind / rolling; COUNT], &[rolling; COUNT], [0.0; 3]);
        }
        let mean = blocks.means().unwrap().means[0].mean;
        // Integral of |cos| from 20 to 40.
        let below = |t: f64| {
            let halves = ((t + std::f64::consts::FRAC_PI_2) / std::f64::consts::PI).floor();
            2.0 * halves + (-1f64).powf(halves) * t.sin()
        };
        let rolled = 10.0 * (below(40.0) - below(20.0));
        let expected = (0.1 * rolled + 1e-3 * 20.0) / rolled;
        assert!((mean - expected).abs() < 1e-6, "{mean} {expected}");
        // Nothing rolls.
        let mut still = Blocks::new(
            of_bearing(Parts { cage: true, moving_outer: true, losses: [true; LOSSES.len()] }),
            1.0,
            50.0,
        );
        (0..=50).for_each(|row| still.add(f64::from(row), &[0.0; COUNT], &[0.0; COUNT], [0.0; 3]));
        let still = still.means().unwrap();
        assert!(still.means.iter().all(|mean| mean.mean == 0.0) && still.unsettled().count() == 0);
    }

    #[test]
    fn closed_form_means_of_a_window_are_over_the_parts_of_steps_in_it() {
        // A line is integrated exactly, wherever the window begins and ends, and however short it is beside a step and its time.
        let windows = [
            [0.25, 0.75],
            [0.0, 1.0],
            [0.1234, 0.87654],
            [0.3001, 0.3002],
            [0.777_777, 0.777_778],
            [0.5, 0.5 + 1e-12],
        ];
        for start in [0.0, 1e3] {
            for window in windows {
                let quantities =
                    of_bearing(Parts { cage: true, moving_outer: true, losses: [true; LOSSES.len()] });
                let window: [f64; 2] = window.map(|time| start + time);
                let mut blocks = Blocks::within(quantities, 1.0, window);
                for row in 0..=70 {
                    let time = start + f64::from(row) / 70.0;
                    blocks.add(time, &[2.0 * (time - start); COUNT], &[1.0; COUNT], [0.0; 3]);
                }
                let found = blocks.all().unwrap();
                let exact = window[0] + window[1] - 2.0 * start;
                assert_eq!(found.window, window);
                assert!((found.means[0].mean - exact).abs() < 1e-12, "{window:?} {}", found.means[0].mean);
            }
        }
        // A run that ends before it, or in it.
        let mut blocks = Blocks::within(
            of_bearing(Parts { cage: true, moving_outer: true, losses: [true; LOSSES.len()] }),
            1.0,
            [0.6, 0.9],
        );
        for row in 0..=50 {
            blocks.add(0.01 * f64::from(row), &[0.01 * f64::from(row); COUNT], &[1.0; COUNT], [0.0; 3]);
        }
        assert_eq!(blocks.all(), None);
        blocks.add(0.7, &[0.7; COUNT], &[1.0; COUNT], [0.0; 3]);
        let found = blocks.all().unwrap();
        assert!(
            (found.means[0].mean - 0.65).abs() < 1e-12 && found.window == [0.6, 0.7],
            "{:?}",
            found.window
        );
    }

    #[test]
    fn few_rows_cannot_tell() {
        let few = means(4, |time| time);
        assert!(!few.can_tell() && few.means[0].trend.is_none() && few.unsettled().count() == 0);
    }
}
