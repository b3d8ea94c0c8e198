//! Kalker's nonlinear theory as a smooth table, built from the half-space reference solver.
//!
//! Arguments are linear theory's forces without coupling over their limits, `q = (F_x/(mu Q), F_y/(mu Q), M_z/M_max)`
//! with `F_x = G c^2 C11 c_x`, `F_y = G c^2 C22 c_y`, `M_z = G c^4 C33 phi`; results are forces over mu Q and M_max. In
//! these, load, size and friction drop out and Poisson's ratio nearly does; the axis ratio is the table's fourth
//! axis, interpolated once per contact.
//!
//! Lateral creepage and spin are first scaled so that each alone has a linear response of size one, coupling
//! included. `t = |q|/(W + |q|)` then runs from rest to complete sliding. The direction is stretched so that both its
//! ends matter: near rest what counts is linear theory, in complete sliding whether spin outruns creepage inside the
//! ellipse. With theta the angle from the x axis and phi the angle from y towards z, what is stored is
//! `f_x/(t cos theta)`, `f_y/(t sin theta)`, `m_z/(t sin theta)`: smooth across rest, the poles and the planes of
//! symmetry. Interpolation is by cubic Hermite pieces in all three directions: continuous with its first derivatives. The
//! pieces of t are short where the lateral force of spin has a sharp peak.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;

use super::Patch;
use super::linear::Scales;
use super::packed::unpacked;
use super::patch::LinearError;
use super::table_pieces::{COUNT, weights};

/// Intervals from rest to sliding, from the x axis to the plane of y and spin, and of half a turn in that plane.
pub const SHAPE: [usize; 3] = [COUNT, 10, 16];
/// Intervals of ln(axis ratio), from 0.0184 to 54.3.
pub const RATIOS: usize = WITHIN + 2 * BEYOND;
/// Intervals of ln(axis ratio) from 0.05 to 20, and beyond at either end.
const WITHIN: usize = 12;
const BEYOND: usize = 2;
/// Poisson's ratio of the table.
pub const POISSON: f64 = 0.3;
/// [-] size |q| in the middle between rest and sliding.
pub(super) const MIDDLE: f64 = 1.5;
/// The shipped table, packed: `cargo run --release --example kalker_table` makes it.
const SHIPPED: &[u8] = include_bytes!("table.bin");

/// Nodes of one axis ratio at one t.
const AROUND: usize = (SHAPE[1] + 1) * SHAPE[2];
/// Nodes of one axis ratio: behind rest, where linear theory holds.
pub const NODES: usize = SHAPE[0] * AROUND;

/// Shape of the whole table: axis ratios, t behind rest, theta, phi, values of a node.
pub const GRID: [usize; 5] = [RATIOS + 1, SHAPE[0], SHAPE[1] + 1, SHAPE[2], 3];

/// Number of a node of one axis ratio behind rest, by t (from 1 on), theta and phi.
pub fn index(i: usize, j: usize, k: usize) -> usize {
    ((i - 1) * (SHAPE[1] + 1) + j) * SHAPE[2] + k
}

/// Shipped values of all nodes of one tabulated axis ratio, three a node.
pub fn shipped(ratio: usize) -> &'static [f32] {
    static PARSED: OnceLock<Vec<f32>> = OnceLock::new();
    let values = PARSED.get_or_init(|| unpacked(SHIPPED, GRID));
    &values[ratio * NODES * 3..(ratio + 1) * NODES * 3]
}

/// Tabulated axis ratio of a number from 0 to [`RATIOS`].
pub fn axis_ratio(index: usize) -> f64 {
    let (low, high) = (0.05f64.ln(), 20f64.ln());
    match index as f64 - BEYOND as f64 {
        0.0 => 0.05,
        step if step == WITHIN as f64 => 20.0,
        step => (low + (high - low) * step / WITHIN as f64).exp(),
    }
}

/// How creepages become directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    /// [-] size of the linear response to lateral creepage and spin, coupling included, over that without.
    pub(super) response: [f64; 2],
    /// [-] stretch of x and of spin against y in directions.
    pub(super) direction: [f64; 2],
}

impl Stretch {
    pub(super) fn new(axis_ratio: f64, scales: &Scales) -> Self {
        let Scales { c11, c22, c23, c33, moment } = *scales;
        let (a, b) = (axis_ratio.sqrt(), 1.0 / axis_ratio.sqrt());
        let lateral = c22.hypot(c23 / moment);
        let spin = c23.hypot(c33 / moment);
        // In sliding spin counts as `phi a` against c_y and as `phi b` against c_x: half way there.
        let by_lateral = (lateral * a / spin).sqrt();
        let by_longitudinal = (spin * by_lateral / (c11 * b)).sqrt();
        Self { response: [lateral / c22, spin * moment / c33], direction: [by_longitudinal, by_lateral] }
    }

    /// Unit vector of scaled creepages q at a direction of the table.
    pub(super) fn unscaled(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let d = [x / self.direction[0], y, z / self.direction[1]];
        let size = d[0].hypot(d[1]).hypot(d[2]);
        d.map(|component| component / size)
    }
}

/// Linear theory with its coupling, in units of q before scaling by the response.
fn linear_forces(scales: &Scales, stretch: &Stretch, d: [f64; 3]) -> [f64; 3] {
    let (y, z) = (d[1] / stretch.response[0], d[2] / stretch.response[1]);
    let Scales { c22, c23, c33, moment, .. } = *scales;
    [d[0], y + c23 * moment / c33 * z, z - c23 / (c22 * moment) * y]
}

/// The table of one contact: one axis ratio, padded so that every stencil lies inside.
#[derive(Clone, Debug, PartialEq)]
pub struct CreepTable {
    /// Stored functions by t, theta, number of the function and phi: four nodes along phi are one vector.
    pub(super) nodes: Vec<f64>,
    /// [-] linear theory's lateral force by spin and spin moment by lateral creepage, all over their limits without coupling.
    pub(super) coupling: [f64; 2],
    pub(super) stretch: Stretch,
}

/// Padded sizes: one node more on each side in t and theta, one before and two behind in phi.
pub(super) const PADDED: [usize; 3] = [SHAPE[0] + 3, SHAPE[1] + 3, SHAPE[2] + 3];

impl CreepTable {
    /// The table of a patch that rolls along an axis of its ellipse, from the shipped one.
    ///
    /// # Errors
    /// If the patch is out of range.
    pub fn new(patch: &Patch) -> Result<Self, LinearError> {
        let aligned = Patch { rolling_angle: 0.0, ..*patch };
        let scales = Scales::new(&aligned)?;
        // cubic in ln(axis ratio) between the tabulated ones, of which that of 0.05 is at 0
        let steps = (patch.axis_ratio / 0.05).ln() / (20f64 / 0.05).ln() * WITHIN as f64;
        let (first, end) = (-(BEYOND as f64), (WITHIN + BEYOND) as f64);
        let steps = steps.clamp(first, end);
        let piece = steps.floor().min(end - 1.0);
        let (first, u) = ((piece - first) as usize, steps - piece);
        let (w, _) = weights(u, 1.0);
        // Three values a node.
        let mut nodes = vec![0.0; 3 * NODES];
        for (offset, weight) in w.into_iter().enumerate() {
            let mut add = |ratio: usize, weight: f64| {
                for (value, stored) in nodes.iter_mut().zip(shipped(ratio)) {
                    *value += weight * f64::from(*stored);
                }
            };
            // Beyond the ends the table goes on straight.
            match (first + offset).checked_sub(1) {
                None => {
                    add(0, 2.0 * weight);
                    add(1, -weight);
                }
                Some(ratio) if ratio > RATIOS => {
                    add(RATIOS, 2.0 * weight);
                    add(RATIOS - 1, -weight);
                }
                Some(ratio) => add(ratio, weight),
            }
        }
        Ok(Self::padded(&nodes, &scales, Stretch::new(patch.axis_ratio, &scales)))
    }

    /// Pads the nodes of one axis ratio, three values each; the row at rest is linear theory's own.
    fn padded(stored: &[f64], scales: &Scales, stretch: Stretch) -> Self {
        let coupling = [scales.c23 * scales.moment / scales.c33, -scales.c23 / (scales.c22 * scales.moment)];
        let [n_t, n_theta, n_phi] = SHAPE;
        let mut rest = vec![[0.0; 3]; AROUND];
        for k in 0..n_phi {
            let (sin, cos) = (PI * k as f64 / n_phi as f64).sin_cos();
            let limits = [1.0 / stretch.direction[0], cos, sin / stretch.direction[1]];
            let forces = linear_forces(scales, &stretch, limits);
            for j in 0..=n_theta {
                let theta = FRAC_PI_2 * j as f64 / n_theta as f64;
                // size that a direction with these components has before it is made a unit vector
                let raw = [
                    theta.cos() / stretch.direction[0],
                    theta.sin() * cos,
                    theta.sin() * sin / stretch.direction[1],
                ];
                let size = raw[0].hypot(raw[1]).hypot(raw[2]);
                rest[j * n_phi + k] = forces.map(|force| MIDDLE * force / size);
            }
        }
        // Half a turn in phi changes the sign of what is odd in (y, spin).
        let around = [(n_phi - 1, -1.0)].into_iter().chain((0..n_phi).map(|k| (k, 1.0)));
        let around: Vec<(usize, f64)> = around.chain([(0, -1.0), (1, -1.0)]).collect();
        // Mirrored about the plane x = 0, and through the x axis: what is stored is even in theta. The stored theta at the ends lies a little
        // inside; the functions are even there, so that nothing is lost.
        let across = || [1].into_iter().chain(0..=n_theta).chain([n_theta - 1]);
        let mut nodes = Vec::with_capacity(3 * PADDED.iter().product::<usize>());
        for i in 0..PADDED[0] {
            for j in across() {
                for c in 0..3 {
                    nodes.extend(around.iter().map(|(k, sign)| {
                        let odd = if c == 0 { 1.0 } else { *sign };
                        let at = |i: usize| match i {
                            0 => odd * rest[j * n_phi + k][c],
                            i => odd * stored[3 * index(i, j, *k) + c],
                        };
                        match i {
                            0 => 2.0 * at(0) - at(1),
                            i if i > n_t + 1 => 2.0 * at(n_t) - at(n_t - 1),
                            i => at(i - 1),
                        }
                    }));
                }
            }
        }
        Self { nodes, coupling, stretch }
    }
}
