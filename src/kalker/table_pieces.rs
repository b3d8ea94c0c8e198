//! Cubic Hermite pieces of the table: where a coordinate lies, and the weights of the four nodes around it.

use crate::numerics::lanes::WIDTH;
use crate::numerics::scalar::Values;

/// Nodes of t from rest to sliding, in parts of [`PARTS`]. Closer where pure spin of an ellipse long along rolling
/// saturates the lateral force at a sharp peak.
const SIZES: [u8; 18] = [0, 4, 8, 12, 16, 18, 19, 20, 21, 22, 24, 26, 28, 32, 36, 40, 44, PARTS as u8];
/// Equal parts of t, each of which lies inside one piece.
const PARTS: usize = 48;
/// Parts in a step of t where nodes are not closer.
const STEP: u8 = 4;
/// Pieces of t.
pub(super) const COUNT: usize = SIZES.len() - 1;

/// t at a node.
pub(super) fn size(node: usize) -> f64 {
    f64::from(SIZES[node]) / PARTS as f64
}

/// Stencil of a node between the even steps of t: the four nodes at even steps around it, and its place between the inner
/// two. None for a node at an even step.
pub(super) fn between_steps(node: usize) -> Option<([usize; 4], f64)> {
    let (before, rest) = (SIZES[node] / STEP, SIZES[node] % STEP);
    let at = |offset: u8| SIZES.iter().position(|size| size + STEP == STEP * (before + offset)).unwrap_or(0);
    (rest != 0).then(|| ([0, 1, 2, 3].map(at), f64::from(rest) / f64::from(STEP)))
}

/// A piece of t.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    start: f64,
    /// Pieces of this length per unit of t.
    pub(super) density: f64,
    /// Slopes at both ends by the differences of the values before, here and behind: of the parabola through three nodes.
    slopes: [f64; 4],
}

/// Pieces of t, with room for every number of five bits.
static PIECES: [Piece; 32] = {
    // Beyond the ends the table goes on straight, with nodes as far apart.
    const fn length(piece: usize) -> f64 {
        (SIZES[piece + 1] - SIZES[piece]) as f64
    }
    let mut pieces = [Piece { start: 0.0, density: 0.0, slopes: [0.0; 4] }; 32];
    let mut i = 0;
    while i < COUNT {
        let here = length(i);
        let before = if i == 0 { here } else { length(i - 1) };
        let behind = if i == COUNT - 1 { here } else { length(i + 1) };
        pieces[i] = Piece {
            start: SIZES[i] as f64 / PARTS as f64,
            density: PARTS as f64 / here,
            slopes: [
                here * here / (before * (before + here)),
                before / (before + here),
                behind / (here + behind),
                here * here / (behind * (here + behind)),
            ],
        };
        i += 1;
    }
    pieces
};

/// Piece of every part, with room for every number of six bits.
static PIECE_OF: [u8; 64] = {
    let (mut pieces, mut part, mut piece) = ([0; 64], 0, 0);
    while part < PARTS {
        if part >= SIZES[piece + 1] as usize {
            piece += 1;
        }
        pieces[part] = piece as u8;
        part += 1;
    }
    pieces
};

/// 1.5 * 2^52: numbers near it are whole, and carry small whole numbers in their last digits.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// Whole number in [0, count) below a coordinate; 0 where there is no number.
#[inline(always)]
fn floor<V: Values>(x: V, count: usize) -> V {
    let whole = V::constant(WHOLE);
    // A whole number may also give the one before it: a piece ends where the next begins.
    (x - V::constant(0.5) + whole - whole).clamp_to(0.0, (count - 1) as f64)
}

/// Whole numbers from 0 to 2^32, as what counts in memory.
#[inline(always)]
pub(super) fn counts<V: Values>(x: V) -> [usize; WIDTH] {
    let x = x + V::constant(WHOLE);
    let mut counts = [0; WIDTH];
    for lane in 0..WIDTH {
        counts[lane] = (x.lane(lane).to_bits() & 0xffff_ffff) as usize;
    }
    counts
}

/// Pieces of t in [0, 1], and places in them.
#[inline(always)]
pub(super) fn locate_size<V: Values>(t: V) -> ([usize; WIDTH], V) {
    let parts = counts(floor(t.scale(PARTS as f64), PARTS));
    let mut pieces = parts;
    for piece in &mut pieces {
        *piece = usize::from(PIECE_OF[*piece % PIECE_OF.len()]);
    }
    let start = V::by_lane(|lane| piece(pieces[lane]).start);
    let density = V::by_lane(|lane| piece(pieces[lane]).density);
    (pieces, (t - start) * density)
}

/// A piece of t by its number.
#[inline(always)]
pub(super) fn piece(index: usize) -> &'static Piece {
    &PIECES[index % PIECES.len()]
}

/// Piece and place in it of a coordinate in [0, count] with nodes at whole numbers.
#[inline(always)]
pub(super) fn locate<V: Values>(x: V, count: usize) -> (V, V) {
    let piece = floor(x, count);
    (piece, x - piece)
}

/// Weights and their slopes of the cubic Hermite piece at `u` in [0, 1], whose slopes at the nodes are central
/// differences times `steepness`.
#[inline(always)]
pub(super) fn weights<V: Values>(u: V, steepness: f64) -> ([V; 4], [V; 4]) {
    let half = 0.5 * steepness;
    let Basis { step, first, last } = Basis::at(u);
    let (first, last) = (first.scale(half), last.scale(half));
    let slope = Basis::slopes(u);
    let (first_slope, last_slope) = (slope.first.scale(half), slope.last.scale(half));
    (
        [-first, V::one() - step - last, step + first, last],
        [-first_slope, -slope.step - last_slope, slope.step + first_slope, last_slope],
    )
}

/// Weights and their slopes at `u` in [0, 1] of pieces of t, next to which pieces may be longer or shorter.
#[inline(always)]
pub(super) fn weights_of_size<V: Values>(pieces: &[usize; WIDTH], u: V) -> ([V; 4], [V; 4]) {
    let at_ends = [
        V::by_lane(|lane| piece(pieces[lane]).slopes[0]),
        V::by_lane(|lane| piece(pieces[lane]).slopes[1]),
        V::by_lane(|lane| piece(pieces[lane]).slopes[2]),
        V::by_lane(|lane| piece(pieces[lane]).slopes[3]),
    ];
    let (values, slopes) = (Basis::at(u), Basis::slopes(u));
    (combined(at_ends, V::one() - values.step, values), combined(at_ends, -slopes.step, slopes))
}

/// Weights of the nodes from the slopes at both ends and the weights of the values and slopes there.
#[inline(always)]
fn combined<V: Values>([p, q, r, s]: [V; 4], start: V, Basis { step, first, last }: Basis<V>) -> [V; 4] {
    [-p * first, start + (p - q) * first - r * last, step + q * first + (r - s) * last, s * last]
}

/// Cubic Hermite functions of the value at the end, and of the slopes at start and end.
#[derive(Clone, Copy)]
struct Basis<V> {
    step: V,
    first: V,
    last: V,
}

impl<V: Values> Basis<V> {
    #[inline(always)]
    fn at(u: V) -> Self {
        let u2 = u * u;
        let u3 = u2 * u;
        Self { step: u2.scale(3.0) - u3.scale(2.0), first: u3 - u2.scale(2.0) + u, last: u3 - u2 }
    }

    /// Their slopes.
    #[inline(always)]
    fn slopes(u: V) -> Self {
        let u2 = u * u;
        Self {
            step: (u - u2).scale(6.0),
            first: u2.scale(3.0) - u.scale(4.0) + V::one(),
            last: u2.scale(3.0) - u.scale(2.0),
        }
    }
}
