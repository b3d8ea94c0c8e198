//! Means over the second half of a run (or another last part of it), and whether they have settled: drift against noise.
//!
//! Rows go into blocks of equal length, at most 128: when there would be more, neighbours are joined, so that
//! memory does not grow with the run. The window is made of the blocks of the second half. It is divided into equal groups,
//! and a straight line is fitted through their means. A mean has settled if the drift of that line over the window is not
//! significant (Student's t, two-sided, 99 %) or less than [`NEGLIGIBLE`] of its size. Noise is the scatter of the group
//! means of the later half of the window about a line of their own: a decay that fills the window bends the line through all of
//! them, and its bend would pass for noise.

use std::borrow::Cow;
use std::io;
use std::path::Path;

use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;

use super::interval;
use super::quantities::{Parts, Size, Watched, of_bearing, values, weights};

/// [-] blocks of a run; even.
const MOST_BLOCKS: usize = 128;
/// [-] share of a run before the window, where nothing else is asked for.
const HALF: f64 = 0.5;
/// [-] groups of the window for the trend, at most and at least.
const GROUPS: usize = 16;
const FEWEST_GROUPS: usize = 8;
/// [-] drift over the window, over the size of the quantity, that does not matter: a tenth of a percent.
pub const NEGLIGIBLE: f64 = 1e-3;
/// Student's t, two-sided 99 %, for 1 to 6 degrees of freedom (Abramowitz and Stegun, table 26.10).
const STUDENT_T: [f64; GROUPS / 2 - 2] = [63.657, 9.925, 5.841, 4.604, 4.032, 3.707];
/// [-] run lengths further ahead than this are not foretold.
const FURTHEST: f64 = 100.0;

/// Largest values that are reported over the window: eccentricity of the cage \[m], pocket load \[N], land load \[N].
const LARGEST: [fn(&Outputs) -> f64; 3] = [
    |o| o.cage.map_or(0.0, |cage| cage.eccentricity.yz().norm()),
    |o| o.balls.iter().filter_map(|ball| ball.pocket).map(|pocket| pocket.load).fold(0.0, f64::max),
    |o| o.cage.map_or(0.0, |cage| cage.land_loads[0].max(cage.land_loads[1])),
];

#[derive(Clone, Debug)]
struct Block {
    rows: u64,
    /// \[s] times of the first and the last row.
    span: [f64; 2],
    /// Of weights, and of values times these.
    weights: Vec<f64>,
    sums: Vec<f64>,
    largest: [f64; 3],
}

impl Block {
    /// A row of values that count for so much.
    fn of_row(time: f64, values: &[f64], weights: Vec<f64>, largest: [f64; 3]) -> Self {
        let sums = values.iter().zip(&weights).map(|(value, weight)| value * weight).collect();
        Self { rows: 1, span: [time; 2], weights, sums, largest }
    }

    fn join(&mut self, later: &Self) {
        self.rows += later.rows;
        self.span[1] = later.span[1];
        for (sums, others) in [(&mut self.weights, &later.weights), (&mut self.sums, &later.sums)] {
            sums.iter_mut().zip(others).for_each(|(sum, other)| *sum += other);
        }
        self.largest.iter_mut().zip(&later.largest).for_each(|(one, other)| *one = one.max(*other));
    }
}

/// Sums of a run, block by block.
#[derive(Clone, Debug)]
pub struct Blocks {
    blocks: Vec<Block>,
    rows_per_block: u64,
    rows: u64,
    quantities: Vec<Watched>,
    /// \[m] what forces have a moment at.
    arm: f64,
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
    /// Its trend; none where the window has too few rows to tell.
    pub trend: Option<Trend>,
    /// \[unit] half of the interval in which the mean of a longer run lies, at 95 %, if the run goes on as in the window; none
    /// where the window has too few rows to tell.
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
    /// Means of all quantities that are shown.
    pub means: Vec<Mean>,
    /// Largest values of a cage: eccentricity \[m], pocket load \[N], land load \[N].
    pub largest: [f64; 3],
}

impl Blocks {
    /// None yet of these quantities; forces have a moment at an arm \[m].
    pub fn new(quantities: Vec<Watched>, arm: f64) -> Self {
        Self { blocks: vec![], rows_per_block: 1, rows: 0, quantities, arm }
    }

    /// None yet of a bearing.
    pub fn of_bearing(simulation: &Simulation) -> Self {
        let pitch_radius = 0.5 * simulation.model().bearing.pitch_diameter;
        Self::new(of_bearing(Parts::of(simulation)), pitch_radius)
    }

    /// Adds a row of a bearing.
    pub fn push(&mut self, outputs: &Outputs) {
        let largest = LARGEST.map(|get| get(outputs));
        self.add(Block::of_row(outputs.time, &values(outputs), weights(outputs).to_vec(), largest));
    }

    /// Adds a row of values, which all count the same.
    pub fn push_values(&mut self, time: f64, values: &[f64]) {
        self.add(Block::of_row(time, values, vec![1.0; values.len()], [0.0; 3]));
    }

    fn add(&mut self, row: Block) {
        self.rows += 1;
        match self.blocks.last_mut() {
            Some(last) if last.rows < self.rows_per_block => last.join(&row),
            _ => {
                if self.blocks.len() == MOST_BLOCKS {
                    for i in 0..MOST_BLOCKS / 2 {
                        let mut joined = self.blocks[2 * i].clone();
                        joined.join(&self.blocks[2 * i + 1]);
                        self.blocks[i] = joined;
                    }
                    self.blocks.truncate(MOST_BLOCKS / 2);
                    self.rows_per_block *= 2;
                }
                self.blocks.push(row);
            }
        }
    }

    /// The first row, from 0, of the window of a run of so many rows.
    pub fn window_begins(rows: u64) -> u64 {
        let mut each = 1;
        while rows.div_ceil(each) > MOST_BLOCKS as u64 {
            each *= 2;
        }
        let last = rows.div_ceil(each).saturating_sub(1);
        ((rows as f64 * HALF) as u64).div_ceil(each).min(last) * each
    }

    /// Means over the second half of what there is; none without a row.
    pub fn means(&self) -> Option<Means> {
        self.means_from(HALF)
    }

    /// Means over what comes after this share of the rows, in (0, 1); none without a row.
    pub fn means_from(&self, share: f64) -> Option<Means> {
        // The first block that begins after it.
        let first = ((self.rows as f64 * share) as u64).div_ceil(self.rows_per_block) as usize;
        let window = &self.blocks[first.min(self.blocks.len().checked_sub(1)?)..];
        let mut all = window[0].clone();
        window[1..].iter().for_each(|block| all.join(block));
        let mean = |i: usize| mean_of(all.sums[i], all.weights[i]);
        let quantities = &self.quantities;
        let largest_of = |size: Size| {
            let of = (0..quantities.len()).filter(|&i| quantities[i].size == size);
            of.map(|i| mean(i).abs()).fold(0.0, f64::max)
        };
        let size = |i: usize| match quantities[i].size {
            Size::Own => mean(i).abs(),
            Size::Moment => largest_of(Size::Force) * self.arm,
            Size::One => 1.0,
            size => largest_of(size),
        };
        let start = self.blocks[0].span[0];
        let there = (0..quantities.len()).filter(|&i| quantities[i].shown);
        let means = there.map(|i| {
            let each = window.len().div_ceil(GROUPS);
            let of_trend = groups(window, i, each, window.len() / each);
            let trend = Trend::of(&of_trend, [all.span[0] - start, all.span[1] - start], share, size(i));
            let interval = interval::of_mean(|n| {
                let each = (window.len() / n).max(1);
                groups(window, i, each, n.min(window.len()))
            });
            let (name, unit) = (quantities[i].name.clone(), quantities[i].unit);
            Mean { name, unit, mean: mean(i), trend, interval, error: None }
        });
        Some(Means { window: all.span, means: means.collect(), largest: all.largest })
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

/// A straight line through values at 0, 1, 2 ..: its slope, the sum of squares of the places about their mean, and that of
/// the values about the line.
fn line(values: &[f64]) -> (f64, f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let centred = |i: usize| i as f64 - 0.5 * (count - 1.0);
    let places: f64 = (0..values.len()).map(|i| centred(i) * centred(i)).sum();
    let slope = (0..values.len()).map(|i| centred(i) * values[i]).sum::<f64>() / places;
    let rest = |i: usize| values[i] - mean - slope * centred(i);
    (slope, places, (0..values.len()).map(|i| rest(i) * rest(i)).sum())
}

impl Trend {
    /// Trend through the means of equal groups of a window \[s], counted from the start of the run; the window begins at this
    /// share of it.
    fn of(groups: &[f64], window: [f64; 2], share: f64, size: f64) -> Option<Self> {
        let n = groups.len();
        if n < FEWEST_GROUPS {
            return None;
        }
        let count = n as f64;
        let mean = groups.iter().sum::<f64>() / count;
        let (slope, places, _) = line(groups);
        let later = &groups[n / 2..];
        let freedom = later.len().min(GROUPS / 2) - 2;
        let scatter = line(later).2 / freedom as f64;
        let noise = STUDENT_T[freedom - 1] * (scatter / places).sqrt() * count;
        let drift = slope * count;
        let allowed = noise.max(NEGLIGIBLE * size);
        let settled = drift.abs() <= allowed;
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
            (window[0] + time_constant * (whole / allowed).ln().max(0.0)) / share
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

    /// What has not settled.
    pub fn unsettled(&self) -> impl Iterator<Item = (&Mean, &Trend)> {
        let trends = self.means.iter().filter_map(|mean| Some((mean, mean.trend.as_ref()?)));
        trends.filter(|(_, trend)| !trend.settled)
    }

    /// Can the rows tell whether means have settled?
    pub fn can_tell(&self) -> bool {
        self.means.iter().all(|mean| mean.trend.is_some())
    }

    /// \[s] duration of a run in which all would have settled; none where one does not decay.
    pub fn needed(&self) -> Option<f64> {
        self.unsettled().try_fold(0.0, |longest, (_, trend)| Some(f64::max(longest, trend.needed?)))
    }

    /// Writes the means as a table.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
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
        let table = table.into_inner().map_err(|why| io::Error::other(why.to_string()))?;
        std::fs::write(path, table)
    }
}

#[cfg(test)]
mod tests {
    use super::super::quantities::COUNT;
    use super::*;

    /// Means of a run of 1 s whose quantities are all the same function of time.
    fn means(rows: u32, value: impl Fn(f64) -> f64) -> Means {
        run(rows, 1.0, value)
    }

    fn run(rows: u32, duration: f64, value: impl Fn(f64) -> f64) -> Means {
        let mut blocks = Blocks::new(of_bearing(Parts { cage: true, moving_outer: true }), 1.0);
        for row in 0..=rows {
            let time = duration * f64::from(row) / f64::from(rows);
            blocks.add(Block::of_row(time, &[value(time); COUNT], vec![1.0; COUNT], [value(time); 3]));
        }
        assert!(blocks.blocks.len() <= MOST_BLOCKS);
        blocks.means().unwrap_or_else(|| panic!("there are rows"))
    }

    fn trend(means: &Means) -> &Trend {
        means.means[0].trend.as_ref().unwrap_or_else(|| panic!("there are rows enough"))
    }

    #[test]
    fn closed_form_means_of_a_line_whatever_the_number_of_rows() {
        for rows in [20, 127, 128, 500, 5000, 100_000] {
            let means = means(rows, |time| 3.0 + time);
            // The window begins with a block: at most two of at least 64 blocks after the half.
            assert!(
                (means.window[0] - 0.5).abs() < 0.5 / f64::from(rows) + 1.0 / 32.0 && means.window[1] == 1.0
            );
            let middle = 0.5 * (means.window[0] + means.window[1]);
            assert!((means.means[0].mean - 3.0 - middle).abs() < 1e-12, "{rows}");
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
        let needed = short.needed().unwrap_or_else(|| panic!("it decays"));
        // The drift of the second half of a run of L is 5 exp(-L/0.8) (1 - exp(-L/0.8)); 0.01 is allowed: L = 4.97 s.
        assert!((needed / 4.97 - 1.0).abs() < 0.15, "{needed}");
        assert!(trend(&run(2000, 1.1 * needed, decay)).settled);
        assert!(!trend(&run(2000, 0.8 * needed, decay)).settled);
    }

    #[test]
    fn closed_form_a_mean_of_slip_is_by_the_speed_that_rolls() {
        // A speed of rolling 10 cos(t) that swings, and a body that stays behind by a tenth of it and 1e-3.
        let mut blocks = Blocks::new(of_bearing(Parts { cage: true, moving_outer: true }), 1.0);
        let (mut slips, mut rolls) = (0.0, 0.0);
        for row in 0..4000 {
            let time = f64::from(row) * 1e-2;
            let rolling = 10.0 * time.cos();
            let behind = 0.1 * rolling.abs() + 1e-3;
            blocks.add(Block::of_row(
                time,
                &[behind / rolling.abs(); COUNT],
                vec![rolling.abs(); COUNT],
                [0.0; 3],
            ));
            if blocks.rows > Blocks::window_begins(4000) {
                (slips, rolls) = (slips + behind, rolls + rolling.abs());
            }
        }
        let mean = blocks.means().unwrap().means[0].mean;
        assert!((mean - slips / rolls).abs() < 1e-12, "{mean} {}", slips / rolls);
        // Nothing rolls.
        let mut still = Blocks::new(of_bearing(Parts { cage: true, moving_outer: true }), 1.0);
        (0..50).for_each(|row| {
            still.add(Block::of_row(f64::from(row), &[0.0; COUNT], vec![0.0; COUNT], [0.0; 3]));
        });
        let still = still.means().unwrap();
        assert!(still.means.iter().all(|mean| mean.mean == 0.0) && still.unsettled().count() == 0);
    }

    #[test]
    fn few_rows_cannot_tell() {
        let few = means(4, |time| time);
        assert!(!few.can_tell() && few.means[0].trend.is_none() && few.unsettled().count() == 0);
    }
}
