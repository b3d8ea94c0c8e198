//! Forces of a bearing at given displacements and cage speed, its balls settled.

use nalgebra::{Matrix2, SMatrix, SVector, UnitQuaternion, Vector3};

use super::ball::{
    BallBalance, D, N_SHARED, Place, SHARED, Shared, balance, bottom_of_outer_groove, middle_of_gap, settle,
};
use super::{BallEquilibrium, BallReport, Equilibrium, EquilibriumError, EquilibriumInput};
use crate::effects::moving_frame::MovingFrame;
use crate::effects::rating::Turning;
use crate::effects::support::{Relative, Support};
use crate::model::Model;
use crate::model::bearing::azimuth_directions;
use crate::model::bodies::{PerRace, Race};
use crate::numerics::motion::Pose;
use crate::numerics::rotation::{
    conformal_product, from_rotation_vector, rotate, tilt_to, to_quaternion, turn,
};
use crate::numerics::scalar::{Scalar, Single, constant_vector, cross, values};

/// Displacements x, y, z, ry, rz and cage speed.
pub type SharedVector = SVector<f64, N_SHARED>;
/// Derivatives by them.
pub type SharedMatrix = SMatrix<f64, N_SHARED, N_SHARED>;

/// One evaluation at given displacements: all balls settled. `B` is what is kept of each.
pub struct Trial<B = BallBalance> {
    /// Displacements and cage speed.
    pub unknowns: SharedVector,
    /// [N, N m] external load that holds the race that moves.
    pub load: SVector<f64, 5>,
    /// [N rad/s] weighted excess of the balls' own orbital speed over the cage speed.
    pub cage_excess: f64,
    /// [N, N m] what acts on that race from outside, beside its loads: weight and the moving frame.
    pub outside: [D; 5],
    /// Derivatives of load and cage excess by displacements and cage speed, balls eliminated.
    pub tangent: SharedMatrix,
    /// \[N] sum of the inner loads.
    pub inner_load_sum: f64,
    /// Balance of every ball.
    pub balances: Vec<B>,
    /// Place of every ball.
    pub places: Vec<Place>,
}

impl<B> Trial<B> {
    /// That of a bearing without balls, which are to be added.
    pub fn empty(model: &Model, input: &EquilibriumInput, unknowns: &SharedVector) -> Self {
        let n = model.bearing.n_balls;
        Self {
            unknowns: *unknowns,
            load: SVector::zeros(),
            outside: outside_of_race(model, input, unknowns),
            cage_excess: 0.0,
            tangent: SharedMatrix::zeros(),
            inner_load_sum: 0.0,
            balances: Vec::with_capacity(n),
            places: Vec::with_capacity(n),
        }
    }
}

/// Axes of the outer race in the bearing frame, those that balls are looked at in.
#[allow(clippy::large_enum_variant)] // one of an evaluation, never kept
pub enum OuterAxes {
    /// Axes of a race that rests.
    Resting(UnitQuaternion<f64>),
    /// Axes of a race that moves: conformal vector of its rotation.
    Moving(Vector3<D>),
}

impl OuterAxes {
    /// Those at these displacements.
    pub fn new(input: &EquilibriumInput, unknowns: &SharedVector) -> Self {
        match input.race {
            Race::Inner => Self::Resting(input.resting.orientation),
            Race::Outer => {
                let [ry, rz] = [3, 4].map(|i| variable(unknowns, i));
                Self::Moving(from_rotation_vector(&Vector3::new(D::constant(0.0), ry, rz)))
            }
        }
    }

    /// A vector of the bearing frame.
    fn seen(&self, v: &Vector3<D>) -> Vector3<D> {
        match self {
            Self::Resting(orientation) => turn(&orientation.inverse(), v),
            Self::Moving(rotation) => rotate(&-rotation, v),
        }
    }

    /// A vector of these axes.
    fn in_world(&self, v: &Vector3<D>) -> Vector3<D> {
        match self {
            Self::Resting(orientation) => turn(orientation, v),
            Self::Moving(rotation) => rotate(rotation, v),
        }
    }

    /// Their orientation in the bearing frame.
    pub fn orientation(&self) -> UnitQuaternion<f64> {
        match self {
            Self::Resting(orientation) => *orientation,
            Self::Moving(rotation) => to_quaternion(&values(rotation)),
        }
    }

    /// Gravity \[m/s2] in these axes.
    fn gravity(&self, gravity: &Vector3<f64>) -> Vector3<D> {
        match self {
            Self::Resting(orientation) => constant_vector(&(orientation.inverse() * gravity)),
            Self::Moving(_) => self.seen(&constant_vector(gravity)),
        }
    }
}

fn variable(unknowns: &SharedVector, i: usize) -> D {
    D::variable(unknowns[i], SHARED + i, 1.0)
}

/// The inner race relative to the outer one, with derivatives.
pub fn shared(model: &Model, input: &EquilibriumInput, unknowns: &SharedVector) -> Shared {
    let axes = OuterAxes::new(input, unknowns);
    let moved = Vector3::from_fn(|i, _| variable(unknowns, i));
    let (position, axis) = match input.race {
        Race::Inner => (moved, tilted_axis(variable(unknowns, 3), variable(unknowns, 4))),
        Race::Outer => (
            constant_vector(&input.resting.position) - moved,
            constant_vector(&(input.resting.orientation * Vector3::x())),
        ),
    };
    Shared {
        position: axes.seen(&position),
        axis: axes.seen(&axis),
        across: across(input, unknowns),
        cage_speed: variable(unknowns, 5),
        gravity: axes.gravity(&input.frame.gravity),
        frame: moving_frame(model, input, unknowns, &axes),
    }
}

/// The moving frame in the axes of the outer race, places counted from there.
fn moving_frame(
    model: &Model,
    input: &EquilibriumInput,
    unknowns: &SharedVector,
    axes: &OuterAxes,
) -> Option<MovingFrame<D>> {
    let frame = model.ambient(&input.frame).frame?;
    let mut outer = constant_vector::<D>(&input.origin);
    if input.race == Race::Outer {
        outer += Vector3::from_fn(|i, _| variable(unknowns, i));
    }
    let mut seen = frame.seen(|v| axes.seen(&constant_vector(v)));
    seen.arm += axes.seen(&outer);
    Some(seen)
}

/// Force and moment, world axes, of a support on the race that moves, which spins steadily.
fn held_by(
    support: &Support,
    flange: &Pose,
    input: &EquilibriumInput,
    unknowns: &SharedVector,
) -> [Vector3<D>; 2] {
    let speed = match input.race {
        Race::Inner => input.inner_speed,
        Race::Outer => input.outer_speed,
    };
    let tilt =
        from_rotation_vector(&Vector3::new(D::constant(0.0), variable(unknowns, 3), variable(unknowns, 4)));
    let axis = flange.orientation * Vector3::x();
    let upright = tilt_to(&axis);
    // Race and flange have turned by the same angle about their own axes.
    let turned = upright.inverse() * flange.orientation;
    let displacement =
        Vector3::from_fn(|i, _| variable(unknowns, i)) - constant_vector::<D>(&flange.position);
    let turning = constant_vector::<D>(&(axis * speed));
    let own = rotate(&tilt, &constant_vector(&(Vector3::x() * speed)));
    let held = support.holds(
        flange,
        &Relative {
            displacement,
            rotation: turn(&turned.inverse(), &conformal_product(&upright.inverse(), &tilt)),
            velocity: -cross(&turning, &displacement),
            angular_velocity: own - turning,
        },
    );
    let elastic = rotate(&tilt, &turn(&turned, &held.elastic_moment));
    [held.force, elastic + held.damping_moment]
}

/// Weight of the race that moves and the forces of inertia of a moving frame on it, where it is a body.
pub fn outside_of_race(model: &Model, input: &EquilibriumInput, unknowns: &SharedVector) -> [D; 5] {
    let Some(body) = model.bodies[input.race].as_ref() else {
        return [D::constant(0.0); 5];
    };
    let ambient = model.ambient(&input.frame);
    let mut force = constant_vector::<D>(&(ambient.gravity * body.mass));
    let mut moment = constant_vector(&Vector3::zeros());
    if let Some(frame) = &ambient.frame {
        let moved = Vector3::from_fn(|i, _| variable(unknowns, i)) + constant_vector::<D>(&input.origin);
        let field = frame.seen(constant_vector).field(&moved, &constant_vector(&Vector3::zeros()));
        force += field.map(|c| c.scale(body.mass));
        let tilt = Vector3::new(D::constant(0.0), variable(unknowns, 3), variable(unknowns, 4));
        let rotation = from_rotation_vector(&tilt);
        // A race that turns has the mean of its moments of inertia across its axis.
        let across = 0.5 * (body.inertia.y + body.inertia.z);
        let inertia = Vector3::new(body.inertia.x, across, across);
        let speed = match input.race {
            Race::Inner => input.inner_speed,
            Race::Outer => input.outer_speed,
        };
        let rate = constant_vector(&(Vector3::x() * speed));
        let in_body = frame.moment(&inertia, &rate, |v| rotate(&-rotation, &constant_vector(v)));
        moment = rotate(&rotation, &in_body);
    }
    if let (Some(support), Some(flange)) = (&model.supports[input.race], &input.flange) {
        let [held, turned] = held_by(support, flange, input, unknowns);
        force += held;
        moment += turned;
    }
    [force.x, force.y, force.z, moment.y, moment.z]
}

/// [-] y axes of both races in the frame of the outer one, which does not turn with it.
fn across(input: &EquilibriumInput, unknowns: &SharedVector) -> PerRace<Vector3<f64>> {
    let moved = UnitQuaternion::new(Vector3::new(0.0, unknowns[3], unknowns[4]));
    let tilts = match input.race {
        Race::Inner => PerRace { inner: moved, outer: input.resting.orientation },
        Race::Outer => PerRace { inner: input.resting.orientation, outer: moved },
    };
    let frame = tilts.outer.inverse();
    PerRace::new(|race| {
        let (sin, cos) = input.turned[race].sin_cos();
        frame * (tilts[race] * Vector3::new(0.0, cos, sin))
    })
}

/// Axis of a race of rotation vector [0, ry, rz].
fn tilted_axis(ry: D, rz: D) -> Vector3<D> {
    let square = ry.square() + rz.square();
    // cos(t) and sin(t)/t as smooth functions of t^2
    let cosine = square.map_smooth(|s| (s.sqrt().cos(), -0.5 * sinc(s)));
    let sine = square.map_smooth(|s| (sinc(s), sinc_slope(s)));
    Vector3::new(cosine, sine * rz, -(sine * ry))
}

/// `sin(t)/t` with `s = t^2`.
fn sinc(s: f64) -> f64 {
    if s < 1e-6 { 1.0 - s / 6.0 + s * s / 120.0 } else { s.sqrt().sin() / s.sqrt() }
}

/// Derivative of [`sinc`] by s.
fn sinc_slope(s: f64) -> f64 {
    if s < 1e-6 { -1.0 / 6.0 + s / 60.0 } else { (s.sqrt().cos() - sinc(s)) / (2.0 * s) }
}

/// Settles all balls at these displacements; `start` is where they were, `tolerance` \[N] what balance leaves of each.
pub fn evaluate(
    model: &Model,
    input: &EquilibriumInput,
    unknowns: &SharedVector,
    start: Option<&[Place]>,
    tolerance: f64,
) -> Result<Trial, EquilibriumError> {
    let shared = shared(model, input, unknowns);
    let axes = OuterAxes::new(input, unknowns);
    let contacts = model.contacts(&input.surroundings());
    let n = model.bearing.n_balls;
    let mut trial = Trial::empty(model, input, unknowns);
    for j in 0..n {
        let azimuth = model.bearing.ball_azimuth(j);
        // From where it was, from between the races, or from the bottom of the outer groove.
        let kept = start.map(|places| places[j]);
        let fresh: [&dyn Fn() -> Place; 2] = [&|| middle_of_gap(&contacts, &shared, azimuth), &|| {
            bottom_of_outer_groove(model, &contacts, input, &shared, j)
        }];
        let settled = |shared: &Shared| {
            let starts = kept.into_iter().chain(fresh.iter().map(|place| place()));
            starts.into_iter().find_map(|mut place| {
                settle(model, &contacts, input, shared, j, &mut place, tolerance).then_some(place)
            })
        };
        let (place, forces) = match settled(&shared) {
            Some(place) => (Some(place), shared),
            // A free ball that would fall off the side of a groove stays where it is, as if without weight.
            None => {
                let weighs = values(&shared.gravity) != Vector3::zeros() || shared.frame.is_some();
                let weightless =
                    Shared { gravity: constant_vector(&Vector3::zeros()), frame: None, ..shared };
                (weighs.then(|| settled(&weightless)).flatten(), weightless)
            }
        };
        let Some(place) = place else {
            return Err(EquilibriumError::Ball {
                ball: j + 1,
                displacement: std::array::from_fn(|i| unknowns[i]),
            });
        };
        trial.balances.push(balance(model, &contacts, input, &forces, j, &place));
        let balance = &trial.balances[j];
        // rows in the bearing frame: external load and cage excess
        let force = axes.in_world(&balance.force);
        let moment = axes.in_world(&balance.moment);
        // A free ball has no speed of its own: where its contact normals are opposite, it would be 0/0.
        let excess = if balance.inner_load.value > 0.0 {
            balance.inner_load * (balance.own_orbital_speed - shared.cage_speed)
        } else {
            D::constant(0.0)
        };
        let rows = [force.x, force.y, force.z, moment.y, moment.z, excess];
        // eliminate the ball: place' = -(dr/dplace)^-1 dr/dshared
        let by_place = Matrix2::from_fn(|i, k| balance.residual[i].derivatives[k]);
        let by_shared =
            SMatrix::<f64, 2, N_SHARED>::from_fn(|i, k| balance.residual[i].derivatives[SHARED + k]);
        let follow = by_place.lu().solve(&-by_shared).unwrap_or_else(SMatrix::zeros);
        for (i, row) in rows.iter().enumerate() {
            for k in 0..N_SHARED {
                trial.tangent[(i, k)] += row.derivatives[SHARED + k]
                    + row.derivatives[0] * follow[(0, k)]
                    + row.derivatives[1] * follow[(1, k)];
            }
        }
        for i in 0..5 {
            trial.load[i] += rows[i].value;
        }
        trial.cage_excess += excess.value;
        trial.inner_load_sum += balance.inner_load.value;
        trial.places.push(place);
    }
    Ok(trial)
}

/// A solution as it is reported.
pub fn finish(
    model: &Model,
    input: &EquilibriumInput,
    unknowns: &SharedVector,
    trial: &Trial,
    residual: f64,
    iterations: u32,
) -> Equilibrium {
    let cage_speed = unknowns[5];
    let axis = shared(model, input, unknowns).axis.map(D::value);
    let balls = (0..model.bearing.n_balls)
        .map(|j| {
            let azimuth = model.bearing.ball_azimuth(j);
            let (radial, tangential) = azimuth_directions(azimuth);
            let balance = &trial.balances[j];
            let [axial, radius] = balance.centre.map(D::value);
            let spin = balance.angular_velocity.map(D::value);
            BallEquilibrium {
                azimuth,
                position: Vector3::x() * axial + radial * radius,
                velocity: tangential * (cage_speed * radius),
                angular_velocity: Vector3::x() * spin[0] + radial * spin[1],
                report: BallReport::new(model, balance, &axis),
            }
        })
        .collect();
    let life = model.rating.as_ref().map(|rating| {
        let loads = trial.balances.iter().map(|ball| [ball.inner_load.value, ball.outer_load.value]);
        let turning = Turning {
            force: [trial.load[1], trial.load[2]],
            spins: [input.inner_speed, input.outer_speed],
            load_speed: input.load_speed,
        };
        rating.life(&rating.at(loads, turning).rates)
    });
    // With the cage speed following: eliminate the last unknown.
    let t = &trial.tangent;
    let pivot = t[(5, 5)];
    let stiffness = SMatrix::<f64, 5, 5>::from_fn(|i, k| {
        let follow = if pivot == 0.0 { 0.0 } else { t[(i, 5)] * t[(5, k)] / pivot };
        t[(i, k)] - follow
    });
    Equilibrium {
        race: input.race,
        displacement: std::array::from_fn(|i| unknowns[i]),
        load: std::array::from_fn(|i| trial.load[i]),
        stiffness,
        unstable: None,
        cage_speed,
        residual,
        iterations,
        growth: model.growth.as_ref().map(|growth| growth.output(&input.surroundings().warmth)),
        life,
        balls,
    }
}
