//! The line along which a roller touches a race, at stations: how it falls off, and sums over all stations.

use std::array::from_fn;

use crate::numerics::elementary::ln;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::scalar::Scalar;

/// [-] power of the approach of a line contact, and that of its stiffness.
pub(super) const POWER: f64 = 10.0 / 9.0;

/// Fours of stations that are summed up together.
const PART: usize = 4;

/// How the line of a roller falls off towards its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Profile {
    /// Not at all.
    Straight,
    /// By a logarithm (ISO/TS 16281: 2008).
    Logarithmic,
    /// As a circle of this radius \[m].
    Crowned(f64),
}

impl Profile {
    /// \[m] drop at a place \[m] along a roller from its middle.
    pub fn drop(self, place: f64, diameter: f64, length: f64) -> f64 {
        match self {
            Self::Straight => 0.0,
            Self::Crowned(radius) => 0.5 * place * place / radius,
            Self::Logarithmic => {
                // Long rollers are straight but for the length of 2.5 diameters.
                let (factor, straight) = match length - 2.5 * diameter {
                    long if long > 0.0 => (0.0005, long),
                    _ => (0.00035, 0.0),
                };
                let part = ((2.0 * place.abs() - straight) / (length - straight)).max(0.0);
                -factor * diameter * ln(1.0 - part * part)
            }
        }
    }
}

/// Stations of the lines of a roller, by fours: what is done with them is done with four numbers at a time. Those that fill up the last four never
/// touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stations {
    /// \[m] places along the roller.
    place: Lanes,
    /// [-] shares of the load.
    share: Lanes,
    /// \[m] drop of the profile.
    drop: Lanes,
}

impl Stations {
    /// Place \[m], share and drop \[m] of each.
    pub(super) fn all(stations: &[[f64; 3]]) -> Vec<Self> {
        let of = |four: &[[f64; 3]]| {
            let number = |k: usize, none: f64| Lanes::from_fn(|lane| four.get(lane).map_or(none, |of| of[k]));
            Self { place: number(0, 0.0), share: number(1, 0.0), drop: number(2, f64::INFINITY) }
        };
        stations.chunks(WIDTH).map(of).collect()
    }

    /// \[m] place of each, and drop there.
    pub(super) fn each(all: &[Self]) -> impl Iterator<Item = [f64; 2]> {
        let each = |of: &Self| from_fn::<_, WIDTH, _>(|k| [of.place.0[k], of.drop.0[k]]);
        all.iter().flat_map(each)
    }
}

/// Sums over stations at an approach \[m] in the middle of the line that changes by a `lean` along it, over the stiffness of the line: load, its couple
/// about the middle, their derivatives by approach and lean (three), energy over 9/19.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
pub(super) fn sums(stations: &[Stations], way: f64, lean: f64) -> [f64; 6] {
    let zero = Lanes::constant(0.0);
    let mut sums = [zero; 6];
    // One thing after another for all stations of a part, from and to memory: compilers make vectors of that alone.
    let (mut approaches, mut roots) = ([zero; PART], [zero; PART]);
    for part in stations.chunks(PART) {
        for (of, (approach, root)) in part.iter().zip(approaches.iter_mut().zip(&mut roots)) {
            *approach = of.place * Lanes::constant(lean) - of.drop + Lanes::constant(way);
            *root = first_ninth_root(*approach);
        }
        for (approach, root) in approaches.iter().zip(&mut roots) {
            *root = ninth_root(*approach, *root);
        }
        for (of, (approach, root)) in part.iter().zip(approaches.iter().zip(&roots)) {
            // What is no number is no contact that is open: it stays in the sums.
            let touching = |number: f64, approach: f64| if approach <= 0.0 { 0.0 } else { number };
            let root = (of.share * *root).zip(*approach, touching);
            let approach = approach.zip(*approach, touching);
            let (own, slope) = (root * approach, root * Lanes::constant(POWER));
            let bend = slope * of.place;
            let each = [own, own * of.place, slope, bend, bend * of.place, own * approach];
            sums.iter_mut().zip(each).for_each(|(sum, own)| *sum += own);
        }
    }
    sums.map(|Lanes([a, b, c, d])| (a + b) + (c + d))
}

/// First guess at the ninth root of normal numbers above 0, to 1 %: by their exponents.
#[inline(always)]
fn first_ninth_root(x: Lanes) -> Lanes {
    x.map(|x| {
        // The upper half of the bits over nine, as a number: no vectors divide integers. Those of 2^52 hold an integer in their lower half.
        const LARGE: f64 = 4_503_599_627_370_496.0;
        const BIAS: u64 = (1023 << 52) / 9 * 8;
        let upper = f64::from_bits(LARGE.to_bits() | (x.to_bits() >> 32)) - LARGE;
        f64::from_bits(((upper * (1.0 / 9.0) + LARGE).to_bits() << 32).wrapping_add(BIAS))
    })
}

/// Ninth roots from first guesses to 1 %: three steps of Halley, each of which cubes the error. To the last bits, in sums, products and quotients alone.
/// Of what is not above 0, anything.
#[inline(always)]
fn ninth_root(x: Lanes, guess: Lanes) -> Lanes {
    let [four, five] = [4.0, 5.0].map(Lanes::constant);
    let mut root = guess;
    for _ in 0..3 {
        let cube = root * root * root;
        let power = cube * cube * cube;
        root *= (power * four + x * five) / (power * five + x * four);
    }
    root
}

/// Points of Gauss between -1 and 1, with their weights: roots of Legendre's polynomial.
pub(super) fn gauss(count: usize) -> Vec<[f64; 2]> {
    let n = count as f64;
    let of = |k: usize| {
        let mut x = -(std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..20 {
            let (mut before, mut value) = (1.0, x);
            for order in 2..=count {
                let j = order as f64;
                (before, value) = (value, ((2.0 * j - 1.0) * x * value - (j - 1.0) * before) / j);
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        [x, 2.0 / ((1.0 - x * x) * slope * slope)]
    };
    (0..count).map(of).collect()
}
