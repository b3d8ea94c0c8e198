//! Difference of the nonlinear theory of rolling obliquely from a mixture of rolling along both axes of the ellipse.
//!
//! A net of two layers, trained on contacts of the half-space solver. Its arguments are those of the table, linear theory's forces without
//! coupling over their limits, `q = (F_x/(mu Q), F_y/(mu Q), M_z/M_max)`, and the direction of rolling; its results are forces over
//! mu Q and M_max. The half of `N(q) - N(-q)` makes it odd. All is seen in the quarter of the plane that the contact rolls to, in the frame of the
//! ellipse that is narrow along x. A factor makes the correction and its slope nothing along both axes.
//!
//! `scripts/oblique-net` makes the weights again.

use super::Patch;
use super::linear::Scales;
use super::patch::LinearError;
use crate::numerics::scalar::{Dual, Scalar, SmoothMap, Values};

/// [-] squares of the sine of the rolling direction where rolling across the x axis begins to have a share, and from where it is full.
pub const BEGIN: f64 = 0.01;
/// See [`BEGIN`].
pub const FULL: f64 = 0.04;
/// [-] cosine of the rolling direction below which the correction goes to nothing with its slope.
const NEARLY_ACROSS: f64 = 0.04;
/// [-] narrowest ellipse that the net was trained on; narrower ones count as this one.
const NARROWEST: f64 = 0.05;

/// [-] size of q beyond which there is no correction: products of it would be no numbers.
const LARGEST: f64 = 1e100;

/// How many arguments of the net change their sign with the creepages, and how many do not.
pub const ODD: usize = 8;
/// See [`ODD`].
pub const EVEN: usize = 6;
/// Units of a layer.
const UNITS: usize = 24;

/// Weights of the net.
struct Weights {
    /// Weights of the first layer, by argument and unit, and its constants.
    first: [[f32; UNITS]; ODD + EVEN],
    first_constant: [f32; UNITS],
    /// Weights of the second layer, by unit of the first and own unit, and its constants.
    second: [[f32; UNITS]; UNITS],
    second_constant: [f32; UNITS],
    /// Weights of the results, by result and unit.
    last: [[f32; UNITS]; 3],
}

static WEIGHTS: Weights = {
    let bytes = include_bytes!("oblique_net.bin");
    let (rows, rest) = bytes.as_chunks::<{ 4 * UNITS }>();
    assert!(rest.is_empty() && rows.len() == ODD + EVEN + 1 + UNITS + 1 + 3);
    Weights {
        first: matrix(rows, 0),
        first_constant: row(&rows[ODD + EVEN]),
        second: matrix(rows, ODD + EVEN + 1),
        second_constant: row(&rows[ODD + EVEN + 1 + UNITS]),
        last: matrix(rows, ODD + EVEN + 2 + UNITS),
    }
};

/// Numbers of the file, single precision, lowest byte first.
const fn row(bytes: &[u8; 4 * UNITS]) -> [f32; UNITS] {
    let (numbers, _) = bytes.as_chunks::<4>();
    let mut row = [0.0; UNITS];
    let mut unit = 0;
    while unit < UNITS {
        row[unit] = f32::from_le_bytes(numbers[unit]);
        unit += 1;
    }
    row
}

const fn matrix<const N: usize>(rows: &[[u8; 4 * UNITS]], first: usize) -> [[f32; UNITS]; N] {
    let mut matrix = [[0.0; UNITS]; N];
    let mut n = 0;
    while n < N {
        matrix[n] = row(&rows[first + n]);
        n += 1;
    }
    matrix
}

/// The correction for one ellipse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObliqueNet {
    /// Is the ellipse long along x? It is then seen with its axes exchanged.
    long: bool,
    /// [-] short semi-axis over the long one, within what the net was trained on.
    ratio: f64,
    /// [-] q of the narrow ellipse as it rolls along its short axis and along its long one, over q in hand.
    along: [f64; 3],
    across: [f64; 3],
}

/// Arguments of the net of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Features<S> {
    /// Arguments that change their sign with the creepages.
    pub odd: [S; ODD],
    /// Arguments that do not.
    pub even: [S; EVEN],
    /// [-] what results are multiplied by: nothing along the axes.
    pub factors: [S; 3],
    /// [-] size of q.
    size: S,
}

impl ObliqueNet {
    /// Net of a patch, whatever its direction of rolling.
    ///
    /// # Errors
    /// If the patch is out of range.
    pub fn new(patch: &Patch) -> Result<Self, LinearError> {
        let aligned = Patch { rolling_angle: 0.0, ..*patch };
        let here = Scales::new(&aligned)?;
        let there = Scales::new(&Patch { axis_ratio: 1.0 / patch.axis_ratio, ..aligned })?;
        let long = patch.axis_ratio > 1.0;
        let [x, y, z] = [there.c22 / here.c11, there.c11 / here.c22, there.c33 / here.c33];
        let (along, across) = if long { ([y, x, z], [1.0; 3]) } else { ([1.0; 3], [x, y, z]) };
        let ratio = patch.axis_ratio.min(1.0 / patch.axis_ratio).max(NARROWEST);
        Ok(Self { long, ratio, along, across })
    }

    /// Arguments of the net by q, cosine and sine of the rolling direction.
    #[inline(always)]
    pub fn features<S: Scalar>(&self, [x, y, z, cosine, sine]: [S; 5]) -> Features<S> {
        let (one, tiny) = (S::one(), S::constant(f64::MIN_POSITIVE));
        // Into the first quarter: mirrored at an axis, all but what points along it changes its sign.
        let sign_x = one.where_positive(cosine, -one);
        let sign_y = one.where_positive(sine, -one);
        let (q, speed) =
            ([sign_x * x, sign_y * y, sign_x * sign_y * z], (cosine.square() + sine.square() + tiny).sqrt());
        let (c, s) = (sign_x * cosine / speed, sign_y * sine / speed);
        let begun = (sine.square() - S::constant(BEGIN)).scale(1.0 / (FULL - BEGIN)).clamp_to(0.0, 1.0);
        let begun = begun.square() * (S::constant(3.0) - begun.scale(2.0));
        let ending = c.square() / (c.square() + S::constant(NEARLY_ACROSS * NEARLY_ACROSS)).sqrt();
        let factor = begun * s.scale(2.0) * ending;
        let factors = [factor * sign_x, factor * sign_y, factor * sign_x * sign_y];
        // Mirrored at the diagonal, axes are exchanged and the spin changes its sign.
        let ([x, y, z], c, s, factors) = match self.long {
            true => ([q[1], q[0], -q[2]], s, c, [factors[0], factors[1], -factors[2]]),
            false => (q, c, s, factors),
        };
        // The direction as it is where the ellipse is drawn out to a circle.
        let drawn = s.scale(self.ratio);
        let length = (c.square() + drawn.square()).sqrt();
        let (drawn_c, drawn_s) = (c / length, drawn / length);
        let scaled = |by: &[f64; 3], middle: f64| {
            let q = [x.scale(by[0]), y.scale(by[1]), z.scale(by[2])];
            let size = (q[0].square() + q[1].square() + q[2].square()).sqrt();
            (q.map(|q| q / (size + S::constant(middle))), size)
        };
        let ([x, y, z], size) = scaled(&self.along, 0.7);
        let ([across_x, across_y, across_z], _) = scaled(&self.across, 3.0);
        let turned = [x * drawn_c + y * drawn_s, y * drawn_c - x * drawn_s];
        Features {
            odd: [x, y, z, across_x, across_y, across_z, turned[0], turned[1]],
            even: [
                c,
                s,
                drawn_c,
                drawn_s,
                S::constant(self.ratio.ln() + 1.5),
                size / (size + S::constant(1.5)),
            ],
            factors,
            size,
        }
    }

    /// Place of the net's results x, y and z in forces.
    fn places(&self) -> [usize; 3] {
        if self.long { [1, 0, 2] } else { [0, 1, 2] }
    }

    /// Forces over mu Q, mu Q and M_max that a mixture lacks.
    fn evaluate(&self, x: [f64; 5]) -> [f64; 3] {
        let Features { odd, even, factors, size } = self.features(x);
        if factors[0] == 0.0 || size >= LARGEST {
            return [0.0; 3];
        }
        let results = Layers::new(&odd, &even).results();
        let places = self.places();
        std::array::from_fn(|m| factors[m] * results[places[m]])
    }
}

impl SmoothMap<5, 3> for ObliqueNet {
    #[inline(always)]
    fn values<V: Values>(&self, x: [V; 5]) -> [V; 3] {
        V::each(x, |x| self.evaluate(x))
    }

    fn with_gradient(&self, x: [f64; 5]) -> ([f64; 3], [[f64; 5]; 3]) {
        let x: [Dual<5>; 5] = std::array::from_fn(|k| Dual::variable(x[k], k, 1.0));
        let Features { odd, even, factors, size } = self.features(x);
        if factors[0].value == 0.0 || size.value >= LARGEST {
            return ([0.0; 3], [[0.0; 5]; 3]);
        }
        let layers = Layers::new(&odd.map(|x| x.value), &even.map(|x| x.value));
        let (results, places) = (layers.results(), self.places());
        let forces = places.map(|result| {
            let (by_odd, by_even) = layers.gradient(result);
            let arguments = odd.iter().zip(by_odd).chain(even.iter().zip(by_even));
            arguments.fold(Dual::constant(results[result]), |force, (argument, slope)| Dual {
                derivatives: std::array::from_fn(|k| force.derivatives[k] + slope * argument.derivatives[k]),
                ..force
            })
        });
        let forces: [Dual<5>; 3] = std::array::from_fn(|m| factors[m] * forces[m]);
        (forces.map(|force| force.value), forces.map(|force| force.derivatives))
    }
}

/// Units of both layers for the arguments as they are, and with the odd ones of the other sign.
struct Layers {
    first: [[Unit; UNITS]; 2],
    second: [[Unit; UNITS]; 2],
}

/// A unit: `z/sqrt(1 + z^2)`, which is the same number on every machine.
#[derive(Clone, Copy)]
struct Unit {
    value: f64,
    slope: f64,
}

impl Unit {
    #[inline(always)]
    fn new(z: f64) -> Self {
        let inverse = 1.0 / (1.0 + z * z).sqrt();
        Self { value: z * inverse, slope: inverse * inverse * inverse }
    }
}

/// Adds a number times its weights to all units of a layer.
#[inline(always)]
fn add(sums: &mut [f64; UNITS], number: f64, weights: &[f32; UNITS]) {
    for (sum, weight) in sums.iter_mut().zip(weights) {
        *sum += number * f64::from(*weight);
    }
}

impl Layers {
    #[inline(never)]
    fn new(odd: &[f64; ODD], even: &[f64; EVEN]) -> Self {
        let (mut changing, mut staying) = ([0.0; UNITS], WEIGHTS.first_constant.map(f64::from));
        let (of_odd, of_even) = WEIGHTS.first.split_at(ODD);
        odd.iter().zip(of_odd).for_each(|(number, weights)| add(&mut changing, *number, weights));
        even.iter().zip(of_even).for_each(|(number, weights)| add(&mut staying, *number, weights));
        let first =
            [1.0, -1.0].map(|sign| std::array::from_fn(|u| Unit::new(staying[u] + sign * changing[u])));
        let second = first.map(|units: [Unit; UNITS]| {
            let mut sums = WEIGHTS.second_constant.map(f64::from);
            units.iter().zip(&WEIGHTS.second).for_each(|(unit, weights)| add(&mut sums, unit.value, weights));
            sums.map(Unit::new)
        });
        Self { first, second }
    }

    /// The half of `N(q) - N(-q)`.
    fn results(&self) -> [f64; 3] {
        let [this, other] = &self.second;
        let half = |weights: &[f32; UNITS]| {
            let units = this.iter().zip(other).zip(weights);
            units.map(|((this, other), weight)| 0.5 * f64::from(*weight) * (this.value - other.value)).sum()
        };
        WEIGHTS.last.each_ref().map(half)
    }

    /// Derivatives of a result by the arguments.
    fn gradient(&self, result: usize) -> ([f64; ODD], [f64; EVEN]) {
        let last = &WEIGHTS.last[result];
        // by what each unit of the first layer is a function of, on both sides
        let sides: [[f64; UNITS]; 2] = std::array::from_fn(|side| {
            let (first, second) = (&self.first[side], &self.second[side]);
            let by_second: [f64; UNITS] = std::array::from_fn(|u| 0.5 * f64::from(last[u]) * second[u].slope);
            std::array::from_fn(|u| first[u].slope * sum(&by_second, &WEIGHTS.second[u]))
        });
        let [this, other] = &sides;
        let changing = std::array::from_fn(|u| this[u] + other[u]);
        let staying = std::array::from_fn(|u| this[u] - other[u]);
        (
            std::array::from_fn(|k| sum(&changing, &WEIGHTS.first[k])),
            std::array::from_fn(|k| sum(&staying, &WEIGHTS.first[ODD + k])),
        )
    }
}

fn sum(numbers: &[f64; UNITS], weights: &[f32; UNITS]) -> f64 {
    numbers.iter().zip(weights).map(|(number, weight)| number * f64::from(*weight)).sum()
}
