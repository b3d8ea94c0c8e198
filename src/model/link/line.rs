//! The line along which a roller touches a race, at stations: how it falls off, and sums over all stations.

use std::array::from_fn;

use crate::numerics::elementary::ln;

/// [-] power of the approach of a line contact, and that of its stiffness.
pub(super) const POWER: f64 = 10.0 / 9.0;
/// Stations that are taken at a time.
const LANES: usize = 4;

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
    place: [f64; LANES],
    /// [-] shares of the load.
    share: [f64; LANES],
    /// \[m] drop of the profile.
    drop: [f64; LANES],
}

impl Stations {
    /// Place \[m], share and drop \[m] of each.
    pub(super) fn all(stations: &[[f64; 3]]) -> Vec<Self> {
        let of = |four: &[[f64; 3]]| {
            let number = |k: usize, none: f64| from_fn(|lane| four.get(lane).map_or(none, |of| of[k]));
            Self { place: number(0, 0.0), share: number(1, 0.0), drop: number(2, f64::INFINITY) }
        };
        stations.chunks(LANES).map(of).collect()
    }

    /// \[m] place of each, and drop there.
    pub(super) fn each(all: &[Self]) -> impl Iterator<Item = [f64; 2]> {
        let each = |of: &Self| from_fn::<_, LANES, _>(|k| [of.place[k], of.drop[k]]);
        all.iter().flat_map(each)
    }
}

/// Sums over stations at an approach \[m] in the middle of the line that changes by a `lean` along it, over the stiffness of the line: load, its couple
/// about the middle, their derivatives by approach and lean (three), energy over 9/19.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
pub(super) fn sums(stations: &[Stations], way: f64, lean: f64) -> [f64; 6] {
    let mut sums = [[0.0; LANES]; 6];
    for of in stations {
        let approach: [f64; LANES] = from_fn(|k| way + lean * of.place[k] - of.drop[k]);
        let roots = ninth_roots(approach);
        for k in 0..LANES {
            let (root, approach) = (of.share[k] * roots[k], approach[k]);
            // What is no number is no contact that is open: it stays in the sums.
            let (root, approach) = if approach <= 0.0 { (0.0, 0.0) } else { (root, approach) };
            let (own, slope, place) = (root * approach, POWER * root, of.place[k]);
            sums[0][k] += own;
            sums[1][k] += own * place;
            sums[2][k] += slope;
            sums[3][k] += slope * place;
            sums[4][k] += slope * place * place;
            sums[5][k] += own * approach;
        }
    }
    sums.map(|[a, b, c, d]| (a + b) + (c + d))
}

/// Ninth roots of normal numbers above 0: first guesses by their exponents, to 1 %, then three steps of Halley, each of which cubes the error. To the last
/// bits, in sums, products and quotients alone. Of what is not above 0, anything.
#[inline(always)]
fn ninth_roots(x: [f64; LANES]) -> [f64; LANES] {
    const BIAS: u64 = 1023 << 52;
    let mut roots = x.map(|x| f64::from_bits(x.to_bits() / 9 + BIAS / 9 * 8));
    for _ in 0..3 {
        roots = from_fn(|k| {
            let (root, x) = (roots[k], x[k]);
            let cube = root * root * root;
            let power = cube * cube * cube;
            root * ((4.0 * power + 5.0 * x) / (5.0 * power + 4.0 * x))
        });
    }
    roots
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
