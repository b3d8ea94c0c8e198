//! A ball in balance between two grooves, in its plane through the axis of the outer ring.
//!
//! Coordinates are axial and radial, from the centre of the outer groove: `u` of the ball, `c` of the inner groove's centre. With the distances
//! `|u - c|` and `|u|` from the centres of the grooves, less those at which a ball touches without load, the approaches are
//!
//! ```text
//! d_i = |u - c| - l_i,   d_o = |u| - l_o,   Q = k d^1.5          normals n_i = (u - c)/|u - c|, n_o = u/|u|
//! V(u, c) = 0.4 k_i d_i^2.5 + 0.4 k_o d_o^2.5 - (F_c e_r + G).u
//! ```
//! A distance is a convex function of `u`, and so are rising convex functions of it: `V` has one minimum, and Newton's method with a line
//! search on `V` cannot miss it. The force on the inner ring is `f = n_i Q_i` at `c`, its stiffness that of both contacts in series, `K_i (K_i + K_o)^-1 K_o`.
//!
//! The gyroscopic couple is carried by friction at both contacts in proportion to their loads, at most at the friction limit, as in
//! [`crate::equilibrium`]; `G` is what it does to the ball. (Unknowns are places and not the load vector, whose inverse problem is closed: a
//! compliance is infinite where a contact opens, and places need no guard there.)

use nalgebra::{Matrix2, Vector2};

use crate::contact::normal::Damping;
use crate::numerics::scalar::{Dual, Scalar};

/// Iterations of one ball: from the place of the last step two are usual.
const MAX_ITERATIONS: u32 = 100;
/// Rounds in which the gyroscopic couple follows the place of the ball.
const MAX_ROUNDS: u32 = 12;
/// [-] unbalanced force over the loads at work up to which a search goes on from where the ball was.
const NEAR: f64 = 0.3;
/// [-] unbalanced force over the loads at work that is rounding.
pub(super) const TOLERANCE: f64 = 1e-12;
/// [-] units in the last place of a ball's coordinates that are rounding.
pub(super) const ROUND_OFF_UNITS: f64 = 8.0;
/// Halvings of a step of Newton's method.
const MAX_HALVINGS: u32 = 30;

/// A groove as a ball sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// \[m] distance of the ball's centre from that of the groove where it touches without load.
    pub arc: f64,
    /// [N/m^1.5] Hertz stiffness.
    pub stiffness: f64,
}

impl Groove {
    /// Load \[N], stiffness along the normal [N/m], and energy \[J] at a distance \[m] of the centres.
    #[inline]
    fn at(&self, distance: f64) -> [f64; 3] {
        let approach = distance - self.arc;
        if approach <= 0.0 {
            return [0.0; 3];
        }
        let root = approach.sqrt();
        let slope = 1.5 * self.stiffness * root;
        let load = self.stiffness * approach * root;
        [load, slope, 0.4 * load * approach]
    }

    /// \[m] approach under a load \[N].
    fn approach(&self, load: f64) -> f64 {
        (load / self.stiffness).powf(2.0 / 3.0)
    }
}

/// The gyroscopic couple of balls, in a direction of their contact angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Couple {
    /// \[N] force at the surface of a ball that carries the couple at a contact angle of 90 degrees: `J w_m w_roll/r`, with its sign.
    pub force: f64,
    /// [-] friction coefficient.
    pub friction: f64,
}

/// A kind of balls between two grooves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Inner and outer groove.
    pub grooves: [Groove; 2],
    /// \[N] centrifugal force.
    pub centrifugal: f64,
    /// The gyroscopic couple; none at rest.
    pub couple: Option<Couple>,
    /// How contacts lose energy.
    pub damping: Damping,
}

/// A ball in balance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// \[m] its centre.
    pub place: Vector2<f64>,
    /// \[N] loads on the inner and the outer ring.
    pub loads: [f64; 2],
    /// \[N] force on the inner ring, axial and radial.
    pub force: Vector2<f64>,
    /// \[N] friction on the ball at the inner and the outer contact that carries the gyroscopic couple.
    pub friction: [Vector2<f64>; 2],
    /// \[J] elastic energy.
    pub elastic: f64,
    /// [N s/m] damping along the inner normal.
    pub damping: f64,
    /// [-] the inner normal, from the groove's centre to the ball.
    pub normal: Vector2<f64>,
    /// \[N] force on the ball that is left: 0 to rounding where the search came to its end.
    pub unbalanced: f64,
}

/// Both contacts at a place.
#[derive(Clone, Copy)]
pub(super) struct Contacts {
    pub normals: [Vector2<f64>; 2],
    pub distances: [f64; 2],
    pub loads: [f64; 2],
    pub slopes: [f64; 2],
    pub elastic: f64,
}

impl Contacts {
    /// Stiffness of a contact.
    fn stiffness(&self, contact: usize) -> Matrix2<f64> {
        let n = self.normals[contact];
        let along = n * n.transpose();
        along * self.slopes[contact]
            + (Matrix2::identity() - along) * (self.loads[contact] / self.distances[contact])
    }
}

impl Ball {
    /// \[m] where a ball lies that the inner ring does not touch: at the bottom of the outer groove, or in the middle of its gap at rest.
    fn at_rest(&self, c: &Vector2<f64>) -> Vector2<f64> {
        let [inner, outer] = &self.grooves;
        if self.centrifugal > 0.0 {
            return Vector2::new(0.0, outer.arc + outer.approach(self.centrifugal));
        }
        let length = c.norm();
        let way = if length > 0.0 { c / length } else { Vector2::y() };
        way * (outer.arc + 0.5 * (length - inner.arc - outer.arc))
    }

    fn contacts(&self, u: &Vector2<f64>, c: &Vector2<f64>) -> Contacts {
        let arms = [u - c, *u];
        let distances = arms.map(|arm| arm.norm().max(f64::MIN_POSITIVE));
        let each = [0, 1].map(|k: usize| self.grooves[k].at(distances[k]));
        Contacts {
            normals: [arms[0] / distances[0], arms[1] / distances[1]],
            distances,
            loads: each.map(|of| of[0]),
            slopes: each.map(|of| of[1]),
            elastic: each[0][2] + each[1][2],
        }
    }

    /// The ball in balance with the inner groove's centre at `c` \[m], sought from a place and the friction \[N] of both contacts there.
    pub fn settle(&self, c: &Vector2<f64>, from: &Vector2<f64>, before: &[Vector2<f64>; 2]) -> Settled {
        let rest = self.at_rest(c);
        let apart = (rest - c).norm() - self.grooves[0].arc;
        if apart <= 0.0 {
            return self.settled(rest, &self.contacts(&rest, c), [Vector2::zeros(); 2]);
        }
        if self.centrifugal <= 0.0 {
            let place = self.between(c);
            return self.settled(place, &self.contacts(&place, c), [Vector2::zeros(); 2]);
        }
        let mut place = self.start(c, from, &rest);
        let mut friction = if self.couple.is_some() { *before } else { [Vector2::zeros(); 2] };
        for _ in 0..MAX_ROUNDS {
            place = self.minimum(place, c, &(friction[0] + friction[1]), &rest);
            let Some(couple) = &self.couple else { break };
            let before = friction[0] + friction[1];
            friction = self.friction(couple, [place.x, place.y], [c.x, c.y]).map(|[x, r]| Vector2::new(x, r));
            let loads = self.contacts(&place, c).loads;
            if (friction[0] + friction[1] - before).norm() <= 10.0 * TOLERANCE * (loads[0] + loads[1]) {
                break;
            }
        }
        self.settled(place, &self.contacts(&place, c), friction)
    }

    /// \[m] where the search begins: where the ball was, if it is nearly in balance there, else the lower of two guesses.
    fn start(&self, c: &Vector2<f64>, from: &Vector2<f64>, rest: &Vector2<f64>) -> Vector2<f64> {
        let outside = Vector2::new(0.0, self.centrifugal);
        let here = self.contacts(from, c);
        let [inner, outer] = here.loads;
        let left = outside - here.normals[0] * inner - here.normals[1] * outer;
        let near = NEAR * (inner + outer + self.centrifugal);
        if inner > 0.0 && left.norm_squared() <= near * near {
            return *from;
        }
        if c.norm() <= self.grooves[0].arc + self.grooves[1].arc {
            return *rest;
        }
        let between = self.between(c);
        let potential = |place: &Vector2<f64>| self.contacts(place, c).elastic - outside.dot(place);
        if potential(&between) < potential(rest) { between } else { *rest }
    }

    /// \[m] place of a ball without weight, on the line of both centres.
    fn between(&self, c: &Vector2<f64>) -> Vector2<f64> {
        let [inner, outer] = &self.grooves;
        let length = c.norm();
        let both = length - inner.arc - outer.arc;
        let part = (inner.stiffness / outer.stiffness).powf(2.0 / 3.0);
        c / length * (outer.arc + both * part / (1.0 + part))
    }

    /// \[m] place of least potential, under a given force beside the centrifugal one.
    fn minimum(
        &self,
        from: Vector2<f64>,
        c: &Vector2<f64>,
        given: &Vector2<f64>,
        rest: &Vector2<f64>,
    ) -> Vector2<f64> {
        let outside = Vector2::new(0.0, self.centrifugal) + given;
        let residual = |at: &Contacts| outside - at.normals[0] * at.loads[0] - at.normals[1] * at.loads[1];
        let mut place = from;
        let mut here = self.contacts(&place, c);
        let mut r = residual(&here);
        for _ in 0..MAX_ITERATIONS {
            let size = here.loads[0] + here.loads[1] + self.centrifugal;
            let rounding = ROUND_OFF_UNITS
                * f64::EPSILON
                * (here.slopes[0] * here.distances[0] + here.slopes[1] * here.distances[1]);
            if r.norm() <= (TOLERANCE * size).max(rounding) {
                break;
            }
            let stiffness = here.stiffness(0) + here.stiffness(1);
            let Some(step) = inverse(&stiffness).map(|compliance| compliance * r) else {
                // Off both grooves there is no slope: from the resting place on.
                place = *rest;
                here = self.contacts(&place, c);
                r = residual(&here);
                continue;
            };
            let mut part = 1.0;
            let mut moved = None;
            for _ in 0..MAX_HALVINGS {
                let trial = place + step * part;
                let there = self.contacts(&trial, c);
                let next = residual(&there);
                let falls = there.elastic - here.elastic < outside.dot(&step) * part;
                if falls || next.norm_squared() < r.norm_squared() {
                    moved = Some((trial, there, next));
                    break;
                }
                part *= 0.5;
            }
            // No descent is left to find: rounding.
            let Some(next) = moved else { break };
            (place, here, r) = next;
        }
        place
    }

    /// Friction on the ball at both contacts that carries the gyroscopic couple \[N].
    fn friction<S: Scalar>(&self, couple: &Couple, u: [S; 2], c: [S; 2]) -> [[S; 2]; 2] {
        let arms = [[u[0] - c[0], u[1] - c[1]], u];
        let distances = arms.map(|[x, r]| (x.square() + r.square()).sqrt());
        let normals = [0, 1].map(|k: usize| arms[k].map(|of| of / distances[k]));
        let loads = [0, 1].map(|k: usize| {
            let Groove { arc, stiffness } = self.grooves[k];
            let approach = (distances[k] - S::constant(arc)).positive_part();
            (approach * approach.sqrt()).scale(stiffness)
        });
        self.carried(couple, &normals, &loads)
    }

    /// The same of contacts with these normals and loads \[N].
    #[inline(always)]
    pub(super) fn carried<S: Scalar>(
        &self,
        couple: &Couple,
        normals: &[[S; 2]; 2],
        loads: &[S; 2],
    ) -> [[S; 2]; 2] {
        let total = loads[0] + loads[1] + S::constant(f64::MIN_POSITIVE);
        let needed = normals[1][0].scale(couple.force);
        let limit = total.scale(couple.friction) + S::constant(1e-12);
        let x = needed / limit;
        let carried = needed / (S::one() + x.square().square()).sqrt().sqrt();
        // Along the normal turned towards the axis: normal x direction of the orbit.
        [0, 1].map(|k: usize| {
            let own = carried * loads[k] / total;
            [-(normals[k][1] * own), normals[k][0] * own]
        })
    }

    /// The ball at a place.
    pub(super) fn settled(&self, place: Vector2<f64>, at: &Contacts, friction: [Vector2<f64>; 2]) -> Settled {
        let normal = at.normals[0];
        let contacts = normal * at.loads[0] + at.normals[1] * at.loads[1];
        let unbalanced = (Vector2::new(0.0, self.centrifugal) + friction[0] + friction[1] - contacts).norm();
        let damping = match (self.damping, at.loads[0] > 0.0) {
            (Damping::HuntCrossley(0.0), _) | (_, false) => 0.0,
            (law, true) => {
                let of = |k: usize| match law {
                    Damping::HuntCrossley(chi) => chi * at.loads[k],
                    Damping::Viscoelastic(time) => time * at.slopes[k],
                };
                let [inner, outer] = at.slopes;
                (of(0) * outer * outer + of(1) * inner * inner) / ((inner + outer) * (inner + outer))
            }
        };
        Settled {
            place,
            loads: at.loads,
            force: normal * at.loads[0] - friction[0],
            friction,
            elastic: at.elastic,
            damping,
            normal,
            unbalanced,
        }
    }

    /// [N/m] derivative of the force on the inner ring by the place of its groove's centre.
    pub fn tangent(&self, of: &Settled, c: &Vector2<f64>) -> Matrix2<f64> {
        if of.loads[0] <= 0.0 {
            return Matrix2::zeros();
        }
        let at = self.contacts(&of.place, c);
        let inner = at.stiffness(0);
        // Derivatives of the unbalanced force on the ball, and of the force on the ring, by `u` and `c`.
        let mut residual = [-(inner + at.stiffness(1)), inner];
        let mut force = [inner, -inner];
        if let Some(couple) = &self.couple {
            type D = Dual<4>;
            let variable = |value: f64, k: usize| D::variable(value, k, 1.0);
            let u = [variable(of.place.x, 0), variable(of.place.y, 1)];
            let friction = self.friction(couple, u, [variable(c.x, 2), variable(c.y, 3)]);
            for (k, from) in [0, 2].into_iter().enumerate() {
                let part = |which: usize| {
                    Matrix2::from_fn(|row, column| friction[which][row].derivatives[from + column])
                };
                residual[k] += part(0) + part(1);
                force[k] -= part(0);
            }
        }
        let follows = inverse(&residual[0]).map_or_else(Matrix2::zeros, |inverse| -(inverse * residual[1]));
        force[1] + force[0] * follows
    }
}

/// Inverse of a matrix that is not singular to rounding.
fn inverse(of: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    let determinant = of[(0, 0)] * of[(1, 1)] - of[(0, 1)] * of[(1, 0)];
    let size = of.amax();
    (determinant.abs() > 1e-14 * size * size)
        .then(|| Matrix2::new(of[(1, 1)], -of[(0, 1)], -of[(1, 0)], of[(0, 0)]) / determinant)
}
