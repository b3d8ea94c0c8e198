//! Evaluation of the table of Kalker's nonlinear theory: values, one or several at a time, and exact derivatives.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

use super::table::{CreepTable, MIDDLE, PADDED, SHAPE};
use super::table_pieces::{locate, locate_size, piece, weights};
use crate::numerics::lanes::Lanes;
use crate::numerics::scalar::{Scalar, SmoothMap, Values, within_limit};

/// [-] sizes |q| below which a contact is at rest, and above which squares are no numbers any more.
const REST: f64 = 1e-12;
const LARGEST: f64 = 1e150;

impl CreepTable {
    /// Where `q` lies in the table.
    #[inline(always)]
    fn place<V: Values>(&self, q: [V; 3]) -> Place<V> {
        let norm = |[x, y, z]: [V; 3]| (x * x + y * y + z * z).sqrt();
        let (one, minus) = (V::one(), -V::one());
        // into the quarter that is stored, with responses of size one
        let sign_x = minus.where_positive(-q[0], one);
        let sign_yz = minus.where_positive(-q[2], one.where_positive(q[2], minus.where_positive(-q[1], one)));
        let [response_y, response_z] = self.stretch.response;
        let scaled = [sign_x * q[0], (sign_yz * q[1]).scale(response_y), (sign_yz * q[2]).scale(response_z)];
        let size = norm(scaled);
        let [stretch_x, stretch_z] = self.stretch.direction;
        let (x, y, z) = (scaled[0].scale(stretch_x), scaled[1], scaled[2].scale(stretch_z));
        let across = (y * y + z * z).sqrt();
        let length = norm([x, y, z]);
        // On the x axis every phi is as good, and at rest every direction.
        let per_across = one / across.where_positive(across, one);
        let per_length = one / length.where_positive(length, one);
        Place {
            signs: [sign_x, sign_yz, sign_yz],
            scaled,
            size,
            length,
            t: size / (size + V::constant(MIDDLE)),
            theta: [x * per_length, across * per_length],
            phi: [(y * per_across).where_positive(across, one), z * per_across],
        }
    }

    /// Linear theory: what remains at rest.
    #[inline(always)]
    fn at_rest<V: Values>(&self, q: [V; 3]) -> [V; 3] {
        let [yz, zy] = self.coupling;
        [q[0], q[1] + q[2].scale(yz), q[2] + q[1].scale(zy)]
    }

    /// [-] lateral force over mu Q of a spin whose moment without coupling is M_max, in linear theory.
    pub fn spin_coupling(&self) -> f64 {
        self.coupling[0]
    }

    /// Forces over mu Q, mu Q and M_max at `[q_x, q_y, q_z, direction]`: the table rolls along +x, where the direction
    /// is 1. Against it, at -1, all is seen turned by half a turn; between, both are mixed.
    #[inline(always)]
    pub fn mixed_values<V: Values>(&self, [x, y, z, direction]: [V; 4]) -> [V; 3] {
        let settled = direction.all(|direction| direction.abs() == 1.0);
        let forwards = self.rolling([x, y, z], if settled { direction } else { V::one() });
        if settled { forwards } else { self.mix_in_backwards(forwards, [x, y, z, direction]) }
    }

    /// Forces of rolling along +x (1) or against it (-1).
    #[inline(always)]
    fn rolling<V: Values>(&self, [x, y, z]: [V; 3], sign: V) -> [V; 3] {
        let [x, y, z] = self.values([sign * x, sign * y, z]);
        [sign * x, sign * y, z]
    }

    // Seldom, and not worth a second copy of the table's evaluation.
    #[cold]
    #[inline(never)]
    fn mix_in_backwards<V: Values>(&self, forwards: [V; 3], [x, y, z, direction]: [V; 4]) -> [V; 3] {
        let backwards = self.rolling([x, y, z], -V::one());
        let weight = (direction + V::one()).scale(0.5);
        std::array::from_fn(|m| mix(forwards[m], backwards[m], weight))
    }

    /// Forces of [`Self::mixed_values`] with their derivatives by all four arguments: row by force.
    pub fn mixed(&self, [x, y, z, direction]: [f64; 4]) -> ([f64; 3], [[f64; 4]; 3]) {
        let rolling = |sign: f64| -> ([f64; 3], [[f64; 3]; 3]) {
            let (forces, gradient) = self.evaluate([sign * x, sign * y, z]);
            let signs = [sign, sign, 1.0];
            let slope = |m: usize, n: usize| signs[m] * signs[n] * gradient[m][n];
            (
                std::array::from_fn(|m| signs[m] * forces[m]),
                std::array::from_fn(|m| std::array::from_fn(|n| slope(m, n))),
            )
        };
        if direction.abs() == 1.0 {
            let (forces, gradient) = rolling(direction);
            return (forces, gradient.map(|[a, b, c]| [a, b, c, 0.0]));
        }
        let ((forwards, by_forwards), (backwards, by_backwards)) = (rolling(1.0), rolling(-1.0));
        let weight = 0.5 * (direction + 1.0);
        let mix = |forwards: f64, backwards: f64| mix(forwards, backwards, weight);
        let row = |m: usize| {
            let [a, b, c] = std::array::from_fn(|n| mix(by_forwards[m][n], by_backwards[m][n]));
            [a, b, c, 0.5 * (forwards[m] - backwards[m])]
        };
        (std::array::from_fn(|m| mix(forwards[m], backwards[m])), std::array::from_fn(row))
    }

    /// Forces over mu Q, mu Q and M_max at `q`.
    #[inline(always)]
    pub fn values<V: Values>(&self, q: [V; 3]) -> [V; 3] {
        let place = self.place(q);
        let stored = V::each(place.coordinates(), |coordinates| {
            let Lanes([x, y, z, _]) = interpolate(&self.nodes, &Stencil::new(coordinates));
            [x, y, z]
        });
        let [x, y, z] = place.forces(&stored);
        let [x, y] = within_limit(x, y);
        let rest = self.at_rest(q);
        let table = [x, y, z.clamp_to(-1.0, 1.0)];
        // at rest, and where there is no number
        let (moving, finite) = (place.size - V::constant(REST), V::constant(LARGEST) - place.size);
        std::array::from_fn(|m| table[m].where_positive(moving, rest[m]).where_positive(finite, rest[m]))
    }

    /// Forces over mu Q, mu Q and M_max at `q`, and their derivatives by q: row by force, column by q.
    pub fn evaluate(&self, q: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let place = self.place(q);
        if !(place.size > REST && place.size < LARGEST) {
            let [yz, zy] = self.coupling;
            return (self.at_rest(q), [[1.0, 0.0, 0.0], [0.0, 1.0, yz], [0.0, zy, 1.0]]);
        }
        let stencil = Stencil::new(place.coordinates());
        let [Lanes(value), Lanes(by_t), Lanes(by_theta), Lanes(by_phi)] =
            interpolate_with_slopes(&self.nodes, &stencil);

        // gradient: by t, theta and phi, and these by q
        let Place { signs, scaled, size, length, t, .. } = place;
        let ([cos_theta, sin_theta], [cos_phi, sin_phi]) = (place.theta, place.phi);
        let factor = [cos_theta, sin_theta, sin_theta];
        let factor_slope = [-sin_theta, cos_theta, cos_theta];
        let polar = [-sin_theta, cos_theta * cos_phi, cos_theta * sin_phi];
        let azimuthal = [0.0, -sin_phi, cos_phi];
        let t_slope = (1.0 - t) / (MIDDLE + size);
        let density = piece(stencil.piece[0]).density;
        let [stretch_x, stretch_z] = self.stretch.direction;
        let by_direction = [stretch_x, 1.0, stretch_z];
        let [response_y, response_z] = self.stretch.response;
        let by_response = [1.0, response_y, response_z];
        let [x, y, z, _] = value;
        let [x, y, z] = place.forces(&[x, y, z]);
        let mut gradient = [[0.0; 3]; 3];
        for m in 0..3 {
            let along = t_slope * factor[m] * (value[m] + t * by_t[m] * density);
            let down = t / length * (factor_slope[m] * value[m] + factor[m] * by_theta[m] * DENSITY[0]);
            // f_x does not depend on phi at the pole, the others carry sin(theta) in front
            let around = match m {
                0 if sin_theta < 1e-9 => 0.0,
                0 => t / length * cos_theta / sin_theta * by_phi[0] * DENSITY[1],
                _ => t / length * by_phi[m] * DENSITY[1],
            };
            for n in 0..3 {
                let turn = (down * polar[n] + around * azimuthal[n]) * by_direction[n];
                let slope = along * scaled[n] / size + turn;
                gradient[m][n] = signs[m] * signs[n] * slope * by_response[n];
            }
        }
        limit_gradient([x, y, z], &mut gradient);
        let [x, y] = within_limit(x, y);
        ([x, y, z.clamp_to(-1.0, 1.0)], gradient)
    }
}

/// Angle in [0, pi] of a unit vector, given by cosine and sine: tangents of half, a quarter and an eighth of it, whose arc
/// is a short series. Libraries have it for single numbers only.
#[inline(always)]
fn angle<V: Values>([cos, sin]: [V; 2]) -> V {
    const SERIES: [f64; 11] = {
        let mut series = [0.0; 11];
        let mut k = 0;
        while k < series.len() {
            series[k] = if k % 2 == 0 { 8.0 } else { -8.0 } / (2 * k + 1) as f64;
            k += 1;
        }
        series
    };
    let one = V::one();
    let half = sin / (one + cos.where_positive(cos, -cos));
    let quarter = half / (one + (one + half.square()).sqrt());
    let eighth = quarter / (one + (one + quarter.square()).sqrt());
    let acute = eighth * eighth.square().polynomial(&SERIES);
    acute.where_positive(cos, V::constant(PI) - acute)
}

/// Where creepages lie in the table.
#[derive(Clone, Copy, Debug)]
struct Place<V> {
    /// Signs of x and of y and spin against the quarter that is stored.
    signs: [V; 3],
    /// Creepages in that quarter with responses of size one, and their size.
    scaled: [V; 3],
    size: V,
    /// Size after stretching directions.
    length: V,
    t: V,
    /// Cosine and sine of theta.
    theta: [V; 2],
    /// Cosine and sine of phi.
    phi: [V; 2],
}

impl<V: Values> Place<V> {
    /// t, theta and phi.
    #[inline(always)]
    fn coordinates(&self) -> [V; 3] {
        [self.t, angle(self.theta), angle(self.phi)]
    }

    /// Forces from the stored functions.
    #[inline(always)]
    fn forces(&self, value: &[V; 3]) -> [V; 3] {
        let [cos_theta, sin_theta] = self.theta;
        let factor = [cos_theta, sin_theta, sin_theta];
        std::array::from_fn(|m| self.signs[m] * self.t * factor[m] * value[m])
    }
}

/// Pieces per unit of theta and phi.
const DENSITY: [f64; 2] = [SHAPE[1] as f64 / FRAC_PI_2, SHAPE[2] as f64 / PI];

/// The nodes around a place.
#[derive(Clone, Copy, Debug)]
struct Stencil {
    /// Piece by t, theta and phi, and where in it.
    piece: [usize; 3],
    within: [f64; 3],
}

impl Stencil {
    /// At t, theta and phi.
    #[inline(always)]
    fn new([t, theta, phi]: [f64; 3]) -> Self {
        let (i, u) = locate_size(t);
        let (j, v) = locate(theta * DENSITY[0], SHAPE[1]);
        let (k, w) = locate(phi * DENSITY[1], SHAPE[2]);
        Self { piece: [i, j, k], within: [u, v, w] }
    }

    /// The nodes around the place and those between them in memory: one range, so that nothing is left to check within it.
    #[inline(always)]
    fn around<'a>(&self, nodes: &'a [Lanes]) -> &'a [Lanes] {
        let [i, j, k] = self.piece;
        let first = (i * PADDED[1] + j) * PADDED[2] + k;
        &nodes[first..first + SPAN]
    }

    /// Weights along phi of the stored functions, and their slopes.
    #[inline(always)]
    fn weights_along_phi(&self) -> ([Lanes; 4], [Lanes; 4]) {
        // f_y and m_z go like sines and cosines of phi: with this steepness their slopes are exact, and the force is
        // smooth across the x axis, where all phi meet.
        static STEEPNESS: LazyLock<f64> = LazyLock::new(|| {
            let step = PI / SHAPE[2] as f64;
            step / step.sin()
        });
        let w = self.within[2];
        let (even, odd) = (weights(w, 1.0), weights(w, *STEEPNESS));
        let each = |even: [f64; 4], odd: [f64; 4]| -> [Lanes; 4] {
            std::array::from_fn(|c| Lanes([even[c], odd[c], odd[c], 0.0]))
        };
        (each(even.0, odd.0), each(even.1, odd.1))
    }
}

/// From the first to the last of the nodes around a place.
const SPAN: usize = (3 * PADDED[1] + 3) * PADDED[2] + 4;

/// The four nodes along phi, at step `a` along t and `b` along theta.
#[inline(always)]
fn row(around: &[Lanes], a: usize, b: usize) -> &[Lanes] {
    let first = (a * PADDED[1] + b) * PADDED[2];
    &around[first..first + 4]
}

/// Sum over the nodes along phi.
#[inline(always)]
fn line(weights: &[Lanes; 4], nodes: &[Lanes]) -> Lanes {
    weights[0] * nodes[0] + weights[1] * nodes[1] + weights[2] * nodes[2] + weights[3] * nodes[3]
}

/// Values of the stored functions.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn interpolate(nodes: &[Lanes], stencil: &Stencil) -> Lanes {
    let ((wt, _), (wv, _)) =
        (piece(stencil.piece[0]).weights(stencil.within[0]), weights(stencil.within[1], 1.0));
    let (ww, _) = stencil.weights_along_phi();
    let around = stencil.around(nodes);
    let mut value = Lanes::constant(0.0);
    for a in 0..4 {
        let mut plane = Lanes::constant(0.0);
        for b in 0..4 {
            plane += line(&ww, row(around, a, b)).scale(wv[b]);
        }
        value += plane.scale(wt[a]);
    }
    value
}

/// Values of the stored functions, and their slopes by t, theta and phi over the piece.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn interpolate_with_slopes(nodes: &[Lanes], stencil: &Stencil) -> [Lanes; 4] {
    let ((wt, dt), (wv, dv)) =
        (piece(stencil.piece[0]).weights(stencil.within[0]), weights(stencil.within[1], 1.0));
    let (ww, dw) = stencil.weights_along_phi();
    let around = stencil.around(nodes);
    let [mut value, mut by_t, mut by_theta, mut by_phi] = [Lanes::constant(0.0); 4];
    for a in 0..4 {
        let [mut plane, mut plane_by_theta, mut plane_by_phi] = [Lanes::constant(0.0); 3];
        for b in 0..4 {
            let nodes = row(around, a, b);
            let along = line(&ww, nodes);
            plane += along.scale(wv[b]);
            plane_by_theta += along.scale(dv[b]);
            plane_by_phi += line(&dw, nodes).scale(wv[b]);
        }
        value += plane.scale(wt[a]);
        by_t += plane.scale(dt[a]);
        by_theta += plane_by_theta.scale(wt[a]);
        by_phi += plane_by_phi.scale(wt[a]);
    }
    [value, by_t, by_theta, by_phi]
}

/// `forwards` at a weight of 1, `backwards` at 0.
#[inline(always)]
fn mix<V: Values>(forwards: V, backwards: V, weight: V) -> V {
    forwards * weight + backwards * (V::one() - weight)
}

/// Derivatives of forces that are kept within their limits: of the tangential force its size stays, the moment does.
fn limit_gradient([x, y, z]: [f64; 3], gradient: &mut [[f64; 3]; 3]) {
    let size = (x * x + y * y).sqrt();
    if size > 1.0 {
        let direction = [x / size, y / size];
        for n in 0..3 {
            let radial = direction[0] * gradient[0][n] + direction[1] * gradient[1][n];
            for m in 0..2 {
                gradient[m][n] = (gradient[m][n] - radial * direction[m]) / size;
            }
        }
    }
    if z.abs() > 1.0 {
        gradient[2] = [0.0; 3];
    }
}

impl SmoothMap<4, 3> for CreepTable {
    #[inline(always)]
    fn values<V: Values>(&self, x: [V; 4]) -> [V; 3] {
        self.mixed_values(x)
    }
    fn with_gradient(&self, x: [f64; 4]) -> ([f64; 3], [[f64; 4]; 3]) {
        self.mixed(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_angles() {
        for step in 0..=1000 {
            let expected = PI * f64::from(step) / 1000.0;
            let error = angle([expected.cos(), expected.sin().abs()]) - expected;
            assert!(error.abs() < 1e-15, "{expected}: {error:e}");
        }
    }
}
