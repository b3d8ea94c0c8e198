//! What is kept of a run for comparison with another one.

use roulement::scene::Solver;
use roulement::simulation::outputs::Outputs;

use crate::report::figures::Figures;
use crate::report::means::Means;
use crate::report::quantities::{COUNT, QUANTITIES, Quantity, Size, values};

/// A row.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// \[s] time.
    pub time: f64,
    /// All quantities, in the order of [`QUANTITIES`].
    pub values: [f64; COUNT],
    /// \[N] largest load of a ball.
    pub largest_load: f64,
}

impl Sample {
    /// Takes a row.
    pub fn new(outputs: &Outputs) -> Self {
        let largest_load = outputs.loads().fold(0.0, f64::max);
        Self { time: outputs.time, values: values(outputs), largest_load }
    }
}

/// A run that has come to its end.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its settings.
    pub solver: Solver,
    /// \[s] CPU time.
    pub cpu: f64,
    /// Rows, an even selection of a bounded number.
    pub samples: Vec<Sample>,
    /// Means over its second half.
    pub means: Option<Means>,
    /// Figures of its summary.
    pub figures: Figures,
    /// Lengths that errors are related to.
    pub lengths: Lengths,
}

/// Lengths of a bearing.
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

/// \[unit] the size of every quantity that its error is related to: root mean squares over the run, of vectors as a whole.
pub fn sizes(samples: &[Sample], lengths: Lengths) -> [f64; COUNT] {
    let mean_square = |get: &dyn Fn(&Sample) -> f64| {
        samples.iter().map(|sample| get(sample).powi(2)).sum::<f64>() / samples.len().max(1) as f64
    };
    let own = |i: usize| mean_square(&|sample| sample.values[i]).sqrt();
    let vector = |size: Size| {
        let parts = (0..COUNT).filter(|&i| QUANTITIES[i].size == size);
        parts.map(|i| mean_square(&|sample| sample.values[i])).sum::<f64>().sqrt()
    };
    let load = mean_square(&|sample| sample.largest_load).sqrt();
    let force = vector(Size::Force).max(vector(Size::Moment) / lengths.pitch_radius).max(load);
    let speed = (0..COUNT).filter(|&i| QUANTITIES[i].size == Size::Speed).map(own);
    let speed = speed.fold(STANDS / lengths.pitch_radius, f64::max);
    let rests = RESTS / lengths.pitch_radius;
    let of_name = |name: &str| QUANTITIES.iter().position(|quantity| quantity.name == name).map_or(0.0, own);
    let friction = of_name("friction power");
    let of = |(i, quantity): (usize, &Quantity)| match quantity.size {
        Size::Force => force,
        Size::Moment => force * lengths.pitch_radius,
        Size::Position => vector(Size::Position).max(NOTHING * lengths.ball_diameter),
        Size::Speed => speed,
        Size::One => 1.0,
        Size::Own => {
            let torque = NOTHING * force * lengths.pitch_radius;
            let nothing = if quantity.unit == "W" { torque * speed.max(rests) } else { torque };
            own(i).max(nothing).max(if quantity.is_of_cage() { PART * friction } else { 0.0 })
        }
    };
    let mut sizes = [0.0; COUNT];
    QUANTITIES.iter().enumerate().for_each(|(i, quantity)| sizes[i] = of((i, quantity)));
    sizes
}
