//! Sample of a run, for comparison with another one.

use roulement::scene::Solver;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::outputs::Outputs;

use crate::report::figures::Figures;
use crate::report::means::Means;
use crate::report::quantities::{Size, Watched, values};

/// A row.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// \[s] time.
    pub time: f64,
    /// All quantities that are watched, in their order.
    pub values: Vec<f64>,
    /// \[N] largest load of a ball; 0 of a shaft.
    pub largest_load: f64,
}

impl Sample {
    /// Takes a row of a bearing.
    pub fn new(outputs: &Outputs) -> Self {
        let largest_load = outputs.loads().fold(0.0, f64::max);
        Self { time: outputs.time, values: values(&outputs.into()).to_vec(), largest_load }
    }
}

/// A run that has come to its end.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its settings.
    pub solver: Solver,
    /// \[s] CPU time.
    pub cpu: f64,
    /// Its bearings, then its shaft with the housings where there is one.
    pub parts: Vec<Course>,
}

/// How a bearing, or a shaft with its housings, went in a run.
#[derive(Clone, Debug)]
pub struct Course {
    /// Its name, which stands before the names of its quantities; none of a bearing alone and of a shaft.
    pub name: String,
    /// Quantities that were watched.
    pub quantities: Vec<Watched>,
    /// Rows, an even selection of a bounded number.
    pub samples: Vec<Sample>,
    /// Means over its second half.
    pub means: Option<Means>,
    /// Figures of its summary.
    pub figures: Figures,
    /// \[unit] size of every quantity that its error is related to.
    pub sizes: Vec<f64>,
}

impl Run {
    /// All quantities of all parts, one after the other, each by its part and its place there.
    pub fn quantities(&self) -> impl Iterator<Item = (&Course, usize)> {
        self.parts.iter().flat_map(|part| (0..part.quantities.len()).map(move |i| (part, i)))
    }

    /// Places of the first quantity of each part among all of them.
    pub fn firsts(&self) -> impl Iterator<Item = usize> {
        self.parts.iter().scan(0, |next, part| {
            let first = *next;
            *next += part.quantities.len();
            Some(first)
        })
    }

    /// \[s] its end.
    pub fn end(&self) -> f64 {
        self.parts.first().and_then(|part| part.samples.last()).map_or(0.0, |sample| sample.time)
    }
}

impl Course {
    /// Name of a quantity, with that of the part before it.
    pub fn name_of(&self, quantity: usize) -> String {
        let own = &self.quantities[quantity].name;
        if self.name.is_empty() { own.to_string() } else { format!("{}: {own}", self.name) }
    }
}

/// Lengths of a bearing; of a shaft, those of its smallest bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lengths {
    /// \[m] pitch radius.
    pub pitch_radius: f64,
    /// \[m] ball diameter.
    pub ball_diameter: f64,
}

/// [-] of a force, a moment, a displacement over the ball diameter or a power: where all of a kind are smaller, nobody asks how
/// exact they are.
const NOTHING: f64 = 1e-6;
/// [m/s] the same of a speed at the pitch radius: a bearing that stands creeps by far less.
const STANDS: f64 = 1e-6;
/// [m/s] speed at the pitch radius at which a torque that is nothing has a power that is nothing, at least: the speed below which creepages
/// are held finite.
const RESTS: f64 = 1e-3;
/// [-] part of the friction power by which the powers of a cage are measured at least.
const PART: f64 = 0.1;

/// \[unit] the size of every quantity that its error is related to: root mean squares over the run, of vectors as a whole. No torque
/// counts that is less than a given one [N m].
pub fn sizes(samples: &[Sample], quantities: &[Watched], lengths: Lengths, torque: f64) -> Vec<f64> {
    let mean_square = |get: &dyn Fn(&Sample) -> f64| {
        samples.iter().map(|sample| get(sample).powi(2)).sum::<f64>() / samples.len().max(1) as f64
    };
    let own = |i: usize| mean_square(&|sample| sample.values[i]).sqrt();
    let vector = |size: Size| {
        let parts = (0..quantities.len()).filter(|&i| quantities[i].size == size);
        parts.map(|i| mean_square(&|sample| sample.values[i])).sum::<f64>().sqrt()
    };
    let load = mean_square(&|sample| sample.largest_load).sqrt();
    let force = vector(Size::Force).max(vector(Size::Moment) / lengths.pitch_radius).max(load);
    let speed = (0..quantities.len()).filter(|&i| quantities[i].size == Size::Speed).map(own);
    let speed = speed.fold(STANDS / lengths.pitch_radius, f64::max);
    let rests = RESTS / lengths.pitch_radius;
    let of = |name: &str| quantities.iter().position(|quantity| quantity.name == name).map_or(0.0, own);
    let (friction, losses) = (of("friction power"), of(LOSSES[0].name));
    let position = vector(Size::Position).max(NOTHING * lengths.ball_diameter);
    let of = |(i, quantity): (usize, &Watched)| match quantity.size {
        Size::Force => force,
        Size::Moment => force * lengths.pitch_radius,
        Size::Position => position,
        Size::Speed => speed,
        // What tilts by no more than what it moves at a pitch radius does not tilt.
        Size::Tilt => vector(Size::Tilt).max(position / lengths.pitch_radius),
        Size::One => 1.0,
        Size::Own | Size::Losses => {
            let torque = (NOTHING * force * lengths.pitch_radius).max(torque);
            let nothing = if quantity.unit == "W" { torque * speed.max(rests) } else { torque };
            let of_cage = matches!(quantity.name.as_ref(), "pocket power" | "land power");
            let whole = if quantity.size == Size::Losses { losses } else { own(i) };
            whole.max(nothing).max(if of_cage { PART * friction } else { 0.0 })
        }
    };
    quantities.iter().enumerate().map(of).collect()
}
