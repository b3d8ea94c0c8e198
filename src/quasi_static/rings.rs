//! Two rings and the elements between them: from places of the rings to a wrench, and back through the geometry of each element's plane.
//!
//! An element at azimuth `psi` lies in the plane of the outer ring's axis `x` and the radial direction `e`, with `t` across. The inner ring's circle
//! (of groove centres) goes through that plane at a point `C`, with a tangent `T`. A displacement `dq = (dp, dw)` of the ring moves the point by
//!
//! ```text
//! dC = B dq + l T,   B = [1, -(C - p) x],   l = -(t.B dq)/(t.T)          in the plane: J = B_k - (T_k/T_t) B_t, k = x, e
//! ```
//! and with the force `f` in the plane the ring has `J^T f`: a force across the circle. Both derivatives are exact for any tilt; how far the
//! circle's tangent leans changes the depth of a contact by the square of the lean, some 1e-6.

use nalgebra::{Matrix2, Matrix2x6, Matrix3, Matrix6, RowVector6, Vector2, Vector3, Vector6};

use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::scalar::Scalar;

/// A circle on a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// \[m] its radius.
    pub radius: f64,
    /// \[m] place of its centre along the ring's axis.
    pub offset: f64,
}

/// The inner ring as seen from the outer one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// \[m] its origin.
    pub position: Vector3<f64>,
    /// [-] its axis.
    pub axis: Vector3<f64>,
}

/// Where the inner ring's circle goes through the plane of an element.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// [-] radial direction, and across the plane.
    pub directions: [Vector3<f64>; 2],
    /// \[m] the point, axial and radial, from the place of the outer ring's circle.
    pub place: Vector2<f64>,
    /// \[m] the point from the ring's origin.
    arm: Vector3<f64>,
    /// [-] from the circle's centre to the point.
    outward: Vector3<f64>,
    /// [-] the tangent.
    tangent: Vector3<f64>,
    /// \[m] radius of the circle.
    radius: f64,
}

/// Where a circle goes through planes.
struct Crossed {
    point: Vector3<Lanes>,
    outward: Vector3<Lanes>,
    tangent: Vector3<Lanes>,
}

/// Where the inner ring's circle goes through planes at azimuths. Compiled twice, as contacts are ([`crate::contact::many`]).
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn cross(cosines: Lanes, sines: Lanes, ring: &Placed, circle: &Circle) -> Crossed {
    let constant = |v: &Vector3<f64>| v.map(Lanes::constant);
    let (axis, centre) = (constant(&ring.axis), constant(&(ring.position + ring.axis * circle.offset)));
    let zero = Lanes::constant(0.0);
    let (radial, across) = (Vector3::new(zero, cosines, sines), Vector3::new(zero, -sines, cosines));
    let along_plane = radial - axis * radial.dot(&axis);
    let u = along_plane / along_plane.dot(&along_plane).sqrt();
    let v = axis.cross(&u);
    // `t.(centre + R (cos u + sin v)) = 0`
    let (along, beside) = (across.dot(&v), across.dot(&u));
    let off = across.dot(&centre) / Lanes::constant(circle.radius);
    let rest = |sine: Lanes| Lanes::one_minus(sine * sine).sqrt();
    let mut sine = -off / along;
    for _ in 0..2 {
        sine = -(off + beside * rest(sine)) / along;
    }
    let cosine = rest(sine);
    let outward = u * cosine + v * sine;
    let point = centre + outward * Lanes::constant(circle.radius);
    Crossed { point, outward, tangent: v * cosine - u * sine }
}

impl Crossing {
    /// In the planes of elements, for the circles of the inner and the outer ring; cosines and sines of their azimuths are given.
    pub fn of_group(
        cosines: Lanes,
        sines: Lanes,
        ring: &Placed,
        [inner, outer]: &[Circle; 2],
    ) -> [Self; WIDTH] {
        let crossed = cross(cosines, sines, ring, inner);
        std::array::from_fn(|lane| {
            let vector = |v: &Vector3<Lanes>| v.map(|component| component.0[lane]);
            let (cosine, sine) = (cosines.0[lane], sines.0[lane]);
            let radial = Vector3::new(0.0, cosine, sine);
            let point = vector(&crossed.point);
            Self {
                directions: [radial, Vector3::new(0.0, -sine, cosine)],
                place: Vector2::new(point.x - outer.offset, point.dot(&radial) - outer.radius),
                arm: point - ring.position,
                outward: vector(&crossed.outward),
                tangent: vector(&crossed.tangent),
                radius: inner.radius,
            }
        })
    }

    /// [-] how far the tangent leans out of the direction across the plane.
    fn lean(&self) -> Vector2<f64> {
        let [radial, across] = &self.directions;
        Vector2::new(self.tangent.x, self.tangent.dot(radial)) / self.tangent.dot(across)
    }

    /// Force and moment on the ring, about its origin, of a force in the plane.
    pub fn wrench(&self, force: &Vector2<f64>) -> Vector6<f64> {
        let [radial, across] = &self.directions;
        let force = Vector3::x() * force.x + radial * force.y - across * force.dot(&self.lean());
        let moment = self.arm.cross(&force);
        Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
    }

    /// Displacement in a direction at the point by one of the ring.
    fn by_ring(&self, direction: &Vector3<f64>) -> RowVector6<f64> {
        let turned = self.arm.cross(direction);
        RowVector6::new(direction.x, direction.y, direction.z, turned.x, turned.y, turned.z)
    }

    /// Displacement of the point in the plane by displacement and rotation of the ring.
    pub fn moved(&self) -> Matrix2x6<f64> {
        let [radial, across] = &self.directions;
        let lean = self.lean();
        let beside = self.by_ring(across);
        Matrix2x6::from_rows(&[
            self.by_ring(&Vector3::x()) - beside * lean.x,
            self.by_ring(radial) - beside * lean.y,
        ])
    }

    /// Derivative of the wrench by displacement and rotation of the ring, of a force that changes so with the place of the point.
    pub fn tangent(&self, force: &Vector2<f64>, by_place: &Matrix2<f64>) -> Matrix6<f64> {
        let [radial, across] = &self.directions;
        let moved = self.moved();
        let mut whole = moved.tr_mul(&(by_place * moved));
        // The arm moves under the force.
        let wrench = self.wrench(force);
        let on = wrench.fixed_rows::<3>(0).into_owned();
        let mut arm = Vector3::x() * moved.row(0) + radial * moved.row(1);
        let mut origin = arm.fixed_view_mut::<3, 3>(0, 0);
        origin -= Matrix3::identity();
        let mut moments = whole.fixed_view_mut::<3, 6>(3, 0);
        moments -= on.cross_matrix() * arm;
        // The tangent leans differently: it turns with the ring, and along the circle.
        let beside = self.by_ring(across);
        let of_tangent = self.tangent.dot(across);
        let turned = |direction: &Vector3<f64>| {
            let by_rotation = self.tangent.cross(direction);
            let along = beside * (self.outward.dot(direction) / (self.radius * of_tangent));
            RowVector6::new(0.0, 0.0, 0.0, by_rotation.x, by_rotation.y, by_rotation.z) + along
        };
        let lean = self.lean();
        let of_across = turned(across);
        let leans = [Vector3::x(), *radial].iter().zip([(force.x, lean.x), (force.y, lean.y)]).fold(
            RowVector6::zeros(),
            |sum, (direction, (force, lean))| {
                sum + (turned(direction) - of_across * lean) * (force / of_tangent)
            },
        );
        whole -= beside.transpose() * leans;
        whole
    }
}

/// Motion of the inner ring that does what a turn of the elements about the outer ring's axis does, backwards.
pub fn as_turned(ring: &Placed) -> Vector6<f64> {
    let moved = Vector3::x().cross(&ring.position);
    Vector6::new(moved.x, moved.y, moved.z, 1.0, 0.0, 0.0)
}

/// A wrench turned about the outer ring's axis: its derivative by the angle.
pub fn turned(wrench: &Vector6<f64>) -> Vector6<f64> {
    let [force, moment] = [0, 3].map(|from| Vector3::x().cross(&wrench.fixed_rows::<3>(from)));
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}
