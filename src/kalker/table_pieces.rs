//! Cubic Hermite pieces of the table: where a coordinate lies, and the weights of the four nodes around it.

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

const PIECES: [Piece; COUNT] = {
    // Beyond the ends the table goes on straight, with nodes as far apart.
    const fn length(piece: usize) -> f64 {
        (SIZES[piece + 1] - SIZES[piece]) as f64
    }
    let mut pieces = [Piece { start: 0.0, density: 0.0, slopes: [0.0; 4] }; COUNT];
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

/// Piece of every part.
const PIECE_OF: [u8; PARTS] = {
    let (mut pieces, mut part, mut piece) = ([0; PARTS], 0, 0);
    while part < PARTS {
        if part >= SIZES[piece + 1] as usize {
            piece += 1;
        }
        pieces[part] = piece as u8;
        part += 1;
    }
    pieces
};

/// Piece of t in [0, 1] and place in it.
#[inline(always)]
pub(super) fn locate_size(t: f64) -> (usize, f64) {
    let index = usize::from(PIECE_OF[((t * PARTS as f64) as usize).min(PARTS - 1)]);
    let Piece { start, density, .. } = PIECES[index];
    (index, (t - start) * density)
}

/// A piece of t by its number.
#[inline(always)]
pub(super) fn piece(index: usize) -> &'static Piece {
    &PIECES[index]
}

/// Piece and place in it of a coordinate in [0, count] with nodes at whole numbers.
#[inline(always)]
pub(super) fn locate(x: f64, count: usize) -> (usize, f64) {
    let piece = (x as usize).min(count - 1);
    (piece, x - piece as f64)
}

/// Weights and their slopes of the cubic Hermite piece at `u` in [0, 1], whose slopes at the nodes are central
/// differences times `steepness`.
#[inline(always)]
pub(super) fn weights(u: f64, steepness: f64) -> ([f64; 4], [f64; 4]) {
    let (u2, u3) = (u * u, u * u * u);
    let step = 3.0 * u2 - 2.0 * u3;
    let (first, last) = (0.5 * steepness * (u3 - 2.0 * u2 + u), 0.5 * steepness * (u3 - u2));
    let step_slope = 6.0 * (u - u2);
    let first_slope = 0.5 * steepness * (3.0 * u2 - 4.0 * u + 1.0);
    let last_slope = 0.5 * steepness * (3.0 * u2 - 2.0 * u);
    (
        [-first, 1.0 - step - last, step + first, last],
        [-first_slope, -step_slope - last_slope, step_slope + first_slope, last_slope],
    )
}

impl Piece {
    /// Weights and their slopes at `u` in [0, 1] of a piece of t, next to which pieces may be longer or shorter.
    #[inline(always)]
    pub(super) fn weights(&self, u: f64) -> ([f64; 4], [f64; 4]) {
        let (u2, u3) = (u * u, u * u * u);
        let step = 3.0 * u2 - 2.0 * u3;
        let step_slope = 6.0 * (u - u2);
        (
            self.combined(1.0 - step, step, u3 - 2.0 * u2 + u, u3 - u2),
            self.combined(-step_slope, step_slope, 3.0 * u2 - 4.0 * u + 1.0, 3.0 * u2 - 2.0 * u),
        )
    }

    /// Weights of the nodes from those of the values and slopes at both ends.
    #[inline(always)]
    fn combined(&self, start: f64, end: f64, first: f64, last: f64) -> [f64; 4] {
        let [p, q, r, s] = self.slopes;
        [-p * first, start + (p - q) * first - r * last, end + q * first + (r - s) * last, s * last]
    }
}
