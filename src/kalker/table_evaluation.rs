//! Evaluation of the table of Kalker's nonlinear theory: values, one or several at a time, and exact derivatives.

use super::table::{CreepTable, MIDDLE};
use super::table_angle::{acute_angle, angle};
use super::table_pieces::piece;
use super::table_stencil::{DENSITY, Stencil, values_with_slopes};
use crate::numerics::lanes::Lanes;
use crate::numerics::scalar::{Scalar, SmoothMap, Values, within_limit};

/// [-] sizes |q| below which a contact is at rest, and above which products of three sizes are no numbers any more.
const REST: f64 = 1e-12;
const LARGEST: f64 = 1e100;
/// [-] square of a size that is as good as none, and whose root has an inverse. A force of that size stays where there is none, moves a ball
/// by as little, and places are squared: not so small that such squares are subnormal, which processors take many times longer for.
const NOTHING: f64 = 1e-200;

impl CreepTable {
    /// Where `q` lies in the table.
    #[inline(always)]
    fn place<V: Values>(&self, q: [V; 3]) -> Place<V> {
        let one = V::one();
        // into the quarter that is stored, with responses of size one
        let sign_x = one.with_sign_of(q[0]);
        let sign_yz = one.with_sign_of(q[2].where_positive(q[2].abs(), q[1]));
        let [response_y, response_z] = self.stretch.response;
        let scaled = [q[0].abs(), (sign_yz * q[1]).scale(response_y), (sign_yz * q[2]).scale(response_z)];
        let [x, y, z] = scaled;
        let size = (x * x + y * y + z * z).sqrt();
        let [stretch_x, stretch_z] = self.stretch.direction;
        let (x, z) = (x.scale(stretch_x), z.scale(stretch_z));
        let across_square = y * y + z * z + V::constant(NOTHING);
        let (across, length) = (across_square.sqrt(), (x * x + across_square).sqrt());
        // Three quotients at the price of one.
        let saturated = size + V::constant(MIDDLE);
        let inverse = one / (across * length * saturated);
        let per_across = inverse * (length * saturated);
        let per_length = inverse * (across * saturated);
        // On the x axis every phi is as good; ten times the root of nothing is beside it.
        let beside = across - V::constant(1e-99);
        Place {
            signs: [sign_x, sign_yz, sign_yz],
            scaled,
            size,
            length,
            t: size * (inverse * (across * length)),
            theta: [x * per_length, across * per_length],
            phi: [(y * per_across).where_positive(beside, one), z * per_across],
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
        if settled {
            return forwards;
        }
        let backwards = self.rolling([x, y, z], -V::one());
        let weight = (direction + V::one()).scale(0.5);
        std::array::from_fn(|m| mix(forwards[m], backwards[m], weight))
    }

    /// Forces of rolling along +x (1) or against it (-1).
    #[inline(always)]
    fn rolling<V: Values>(&self, [x, y, z]: [V; 3], sign: V) -> [V; 3] {
        let q = [sign * x, sign * y, z];
        let [x, y, z] = V::each_or_together(
            q,
            |q| values_of_one(self, q),
            |q| {
                let mut forces = [Lanes::constant(0.0); 3];
                values_together(self, &q, &mut forces);
                forces
            },
        );
        [sign * x, sign * y, z]
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
        let stored = Stencil::new(place.coordinates()).values(&self.nodes);
        let [x, y, z] = place.forces(&stored);
        let [x, y] = within_limit(x, y);
        let rest = self.at_rest(q);
        let table = [x, y, z.clamp_to(-1.0, 1.0)];
        // at rest, and where there is no number
        let known = (place.size - V::constant(REST)).at_most(V::constant(LARGEST) - place.size);
        [
            table[0].where_positive(known, rest[0]),
            table[1].where_positive(known, rest[1]),
            table[2].where_positive(known, rest[2]),
        ]
    }

    /// Forces over mu Q, mu Q and M_max at `q`, and their derivatives by q: row by force, column by q.
    pub fn evaluate(&self, q: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let place = self.place(q);
        if !(place.size > REST && place.size < LARGEST) {
            let [yz, zy] = self.coupling;
            return (self.at_rest(q), [[1.0, 0.0, 0.0], [0.0, 1.0, yz], [0.0, zy, 1.0]]);
        }
        let stencil = Stencil::new(place.coordinates());
        let [value, by_t, by_theta, by_phi] = values_with_slopes(&stencil, &self.nodes);

        // gradient: by t, theta and phi, and these by q
        let Place { signs, scaled, size, length, t, .. } = place;
        let ([cos_theta, sin_theta], [cos_phi, sin_phi]) = (place.theta, place.phi);
        let factor = [cos_theta, sin_theta, sin_theta];
        let factor_slope = [-sin_theta, cos_theta, cos_theta];
        let polar = [-sin_theta, cos_theta * cos_phi, cos_theta * sin_phi];
        let azimuthal = [0.0, -sin_phi, cos_phi];
        let t_slope = (1.0 - t) / (MIDDLE + size);
        let density = piece(stencil.size_piece()).density;
        let [stretch_x, stretch_z] = self.stretch.direction;
        let by_direction = [stretch_x, 1.0, stretch_z];
        let [response_y, response_z] = self.stretch.response;
        let by_response = [1.0, response_y, response_z];
        let [x, y, z] = place.forces(&value);
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
        [self.t, acute_angle(self.theta), angle(self.phi)]
    }

    /// Forces from the stored functions.
    #[inline(always)]
    fn forces(&self, value: &[V; 3]) -> [V; 3] {
        let [cos_theta, sin_theta] = self.theta;
        let [x, yz] = [self.signs[0] * self.t * cos_theta, self.signs[1] * self.t * sin_theta];
        [x * value[0], yz * value[1], yz * value[2]]
    }
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

/// Forces of one contact.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn values_of_one(table: &CreepTable, q: [f64; 3]) -> [f64; 3] {
    table.values(q)
}

/// Forces of several contacts. They go into memory lane by lane: compilers vectorise from the stores backwards.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn values_together(table: &CreepTable, q: &[Lanes; 3], forces: &mut [Lanes; 3]) {
    *forces = table.values(*q);
}
