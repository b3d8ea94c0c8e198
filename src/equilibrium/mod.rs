//! Quasi-static equilibrium of the bearing: any mix of imposed loads and displacements of the inner race.
//!
//! Exact torus geometry at any tilt, exact Hertz, centrifugal force and gyroscopic moment of the balls after Jones
//! (1960) and Harris. All balls orbit with one cage speed, the mean of the speeds that each would take by itself,
//! weighted by the inner loads. Unknowns are the free displacements and the cage speed; balls are eliminated.

mod ball;
mod report;

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix2, SMatrix, SVector, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::bearing::azimuth_directions;
use crate::model::Model;
use crate::scalar::{Dual, Scalar, Single};
use crate::scene::{Condition, Scene};
use ball::{BallBalance, N_SHARED, Place, SHARED, Shared, middle_of_gap, settle};
pub use report::BallReport;

type D = Dual<{ ball::DIRECTIONS }>;
type SharedVector = SVector<f64, N_SHARED>;
type SharedMatrix = SMatrix<f64, N_SHARED, N_SHARED>;

/// [-] accepted residual over the size of the forces at work.
const TOLERANCE: f64 = 1e-11;
/// Iterations on the displacements; a typical solve takes 5 to 15.
const MAX_ITERATIONS: u32 = 400;
/// [-] largest approach over ball diameter of an answer; steel yields at a tenth of that.
pub const MAX_APPROACH: f64 = 0.02;
/// Names of the five directions.
const DIRECTION_NAMES: [&str; 5] = ["x", "y", "z", "ry", "rz"];

/// How the gyroscopic moment of the balls is carried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gyroscopic {
    /// By friction at the outer race alone (Jones's outer race control), whatever it takes.
    OuterRaceControl,
    /// Ignored.
    None,
    /// By friction at both races in proportion to their loads, at most the friction limit: beyond, the ball pivots.
    Friction,
}

/// What is imposed in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prescribed {
    /// External force [N] or moment [N m] on the inner race.
    Load(f64),
    /// Displacement [m] or rotation vector component [rad] of the inner race.
    Motion(f64),
}

/// A quasi-static problem.
#[derive(Clone, Debug)]
pub struct EquilibriumInput {
    /// Conditions of the inner race, in the order x, y, z, ry, rz, in the bearing frame.
    pub conditions: [Prescribed; 5],
    /// [rad/s] spin of the inner race.
    pub inner_speed: f64,
    /// [rad/s] spin of the outer race.
    pub outer_speed: f64,
    /// Orientation of the outer race in the bearing frame.
    pub outer_orientation: UnitQuaternion<f64>,
    /// How the gyroscopic moment is carried.
    pub gyroscopic: Gyroscopic,
    /// [-] friction coefficient, for [`Gyroscopic::Friction`].
    pub friction: f64,
}

impl EquilibriumInput {
    /// The problem of a scene at time 0.
    pub fn from_scene(scene: &Scene, gyroscopic: Gyroscopic) -> Self {
        let misalignment = &scene.outer.misalignment;
        Self {
            conditions: scene.load.conditions().map(|condition| match condition {
                Condition::Load(schedule) => Prescribed::Load(schedule.at(0.0)),
                Condition::Motion(schedule) => Prescribed::Motion(schedule.at(0.0)),
            }),
            inner_speed: scene.load.inner_speed.at(0.0),
            outer_speed: scene.load.outer_speed.at(0.0),
            outer_orientation: UnitQuaternion::new(Vector3::new(
                0.0,
                misalignment.ry.at(0.0),
                misalignment.rz.at(0.0),
            )),
            gyroscopic,
            friction: scene.friction.ball_race,
        }
    }
}

/// Why there is no solution.
#[derive(Clone, Debug, Error)]
pub enum EquilibriumError {
    /// A ball finds no balance.
    #[error("ball {ball} finds no balance at inner race displacement {displacement:?} [m, rad]")]
    Ball {
        /// Ball, counted from 1.
        ball: usize,
        /// [m, rad] displacement tried.
        displacement: [f64; 5],
    },
    /// A contact is deeper than Hertz's theory reaches.
    #[error(
        "ball {ball} would be pressed in by {approach:.3e} m at {load:.3e} N: more than {limit} of its diameter, far \
         beyond elastic Hertzian contact; the load is too large or the imposed displacement is"
    )]
    Overload {
        /// Ball, counted from 1.
        ball: usize,
        /// [m] approach.
        approach: f64,
        /// [N] load.
        load: f64,
        /// [-] largest approach over ball diameter.
        limit: f64,
    },
    /// A contact lies where no groove is.
    #[error(
        "ball {ball} would touch the {race} race at a contact angle of {angle:.3} rad: beyond a right angle there is no \
         groove; the displacement or the tilt is too large"
    )]
    LeftGroove {
        /// Ball, counted from 1.
        ball: usize,
        /// Inner or outer.
        race: &'static str,
        /// [rad] contact angle.
        angle: f64,
    },
    /// The displacements do not converge.
    #[error(
        "the equilibrium does not converge: residual {residual:.3e} of the load in direction {direction} after \
         {iterations} iterations, at inner race displacement {displacement:?} [m, rad] (is the bearing held in \
         every direction?)"
    )]
    NoConvergence {
        /// [-] residual over the load's size.
        residual: f64,
        /// Direction with the largest share.
        direction: &'static str,
        /// Iterations spent.
        iterations: u32,
        /// [m, rad] displacement reached.
        displacement: [f64; 5],
    },
}

/// One ball in equilibrium, relative to the outer race.
#[derive(Clone, Debug, PartialEq)]
pub struct BallEquilibrium {
    /// [rad] azimuth.
    pub azimuth: f64,
    /// [m] centre, in the outer race's frame.
    pub position: Vector3<f64>,
    /// [m/s] velocity of the centre, same frame.
    pub velocity: Vector3<f64>,
    /// [rad/s] angular velocity of rolling, same frame.
    pub angular_velocity: Vector3<f64>,
    /// What is reported.
    pub report: BallReport,
}

/// A quasi-static solution.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// [m, rad] displacement x, y, z and rotation vector ry, rz of the inner race in the bearing frame.
    pub displacement: [f64; 5],
    /// [N, N m] external load that holds the inner race: Fx, Fy, Fz, My, Mz.
    pub load: [f64; 5],
    /// Derivative of the external load by the displacement, cage speed following.
    pub stiffness: SMatrix<f64, 5, 5>,
    /// [rad/s] cage speed.
    pub cage_speed: f64,
    /// [-] largest residual over the size of the forces.
    pub residual: f64,
    /// Iterations on the displacements.
    pub iterations: u32,
    /// Balls.
    pub balls: Vec<BallEquilibrium>,
}

/// One evaluation at given displacements: all balls settled.
struct Trial {
    load: SVector<f64, 5>,
    /// [N rad/s] weighted excess of the balls' own orbital speed over the cage speed.
    cage_excess: f64,
    /// Derivatives of load and cage excess by displacements and cage speed, balls eliminated.
    tangent: SharedMatrix,
    inner_load_sum: f64,
    balances: Vec<BallBalance>,
    places: Vec<Place>,
}

/// Solves a quasi-static problem.
///
/// # Errors
/// See [`EquilibriumError`]; an unconverged result is never returned.
pub fn solve(model: &Model, input: &EquilibriumInput) -> Result<Equilibrium, EquilibriumError> {
    let bearing = &model.bearing;
    let length = model.race_length();
    let diameter = 2.0 * bearing.ball.radius;
    let free: [bool; 5] = input.conditions.map(|c| matches!(c, Prescribed::Load(_)));
    let mut unknowns = SharedVector::zeros();
    for (i, condition) in input.conditions.iter().enumerate() {
        if let Prescribed::Motion(value) = condition {
            unknowns[i] = *value;
        }
    }
    let epicyclic = bearing.epicyclic_speed(bearing.free_contact_angle, input.inner_speed, input.outer_speed);
    unknowns[5] = epicyclic;
    // Sizes that make residuals and steps comparable.
    let size = |i: usize| if i < 3 { 1.0 } else { length };
    let applied = (0..5)
        .filter_map(|i| match input.conditions[i] {
            Prescribed::Load(load) => Some(load.abs() / size(i)),
            Prescribed::Motion(_) => None,
        })
        .fold(0.0, f64::max);
    let speed_scale = input.inner_speed.abs().max(input.outer_speed.abs());
    let inertia_force = bearing.ball.mass * epicyclic * epicyclic * length;
    // A ball loaded by an approach of a millionth of its diameter is the smallest load worth resolving.
    let smallest = model.contact(0, 0.0).shape.stiffness(0.0) * (1e-6 * diameter).powf(1.5);

    let mut places: Option<Vec<Place>> = None;
    let reference = |trial: &Trial| applied.max(inertia_force).max(smallest).max(trial.inner_load_sum);
    let residual_over = |trial: &Trial, scale: f64, weight: f64| {
        let mut residual = SharedVector::zeros();
        for i in 0..5 {
            if let Prescribed::Load(load) = input.conditions[i] {
                residual[i] = (load - trial.load[i]) / (size(i) * scale);
            }
        }
        if speed_scale > 0.0 {
            residual[5] = trial.cage_excess / (speed_scale * weight);
        }
        residual
    };
    // What has to vanish: over the forces at work, the cage speed over the load that it is weighted with.
    let residual_of =
        |trial: &Trial| residual_over(trial, reference(trial), trial.inner_load_sum.max(1e-9 * smallest));
    let evaluate = |unknowns: &SharedVector, places: &Option<Vec<Place>>| {
        let tolerance = 0.01 * TOLERANCE * applied.max(inertia_force).max(smallest);
        evaluate(model, input, unknowns, places.as_deref(), tolerance)
    };

    let mut here = evaluate(&unknowns, &places)?;
    places = Some(here.places.clone());
    let mut residual = residual_of(&here);
    let mut shift = 0.0;
    let mut iterations = 0;
    while residual.amax() > TOLERANCE {
        iterations += 1;
        let trial = newton_step(&here, input, &free, size, shift, speed_scale).and_then(|mut step| {
            // At most a hundredth of a ball diameter at a time.
            let longest = (0..5).map(|i| step[i].abs() * size(i)).fold(0.0, f64::max);
            let limit = 0.01 * diameter;
            if longest > limit {
                step *= limit / longest;
            }
            let unknowns = unknowns + step;
            evaluate(&unknowns, &places).ok().map(|trial| (unknowns, trial))
        });
        // What has to fall is the residual over its own forces or with one scale for both: over its own forces alone, a
        // race that has to let go of its balls would seem further from balance the less it carries.
        let scale = reference(&here);
        let merit = |trial: &Trial| residual_over(trial, scale, scale).norm();
        let accepted = trial.filter(|(_, trial)| {
            // A race that touches nothing yet moves without its residual falling.
            let touches = |trial: &Trial| trial.inner_load_sum > 1e-9 * reference(trial);
            let untouched = !touches(&here) && !touches(trial);
            let falls = |now: f64, before: f64| now < before * (1.0 - 1e-6);
            untouched
                || falls(residual_of(trial).norm(), residual.norm())
                || falls(merit(trial), merit(&here))
        });
        match accepted {
            Some((moved, trial)) => {
                unknowns = moved;
                residual = residual_of(&trial);
                places = Some(trial.places.clone());
                here = trial;
                shift = if shift < 1e-9 { 0.0 } else { shift * 0.1 };
            }
            None => shift = if shift == 0.0 { 1e-9 } else { shift * 5.0 },
        }
        // Round-off of the balls' places bounds what can be reached.
        let stalled = shift > 1e12;
        if stalled && residual.amax() < 100.0 * TOLERANCE {
            break;
        }
        if stalled || iterations == MAX_ITERATIONS {
            let worst = residual.rows(0, 5).iamax();
            return Err(EquilibriumError::NoConvergence {
                residual: residual.amax(),
                direction: DIRECTION_NAMES[worst],
                iterations,
                displacement: std::array::from_fn(|i| unknowns[i]),
            });
        }
    }
    let solution = finish(model, input, &unknowns, &here, residual.amax(), iterations);
    for (index, ball) in solution.balls.iter().enumerate() {
        let b = &ball.report;
        let (approach, load) = (b.inner_approach.max(b.outer_approach), b.inner_load.max(b.outer_load));
        if approach > MAX_APPROACH * diameter {
            return Err(EquilibriumError::Overload { ball: index + 1, approach, load, limit: MAX_APPROACH });
        }
        let contacts =
            [("inner", b.inner_load, b.inner_contact_angle), ("outer", b.outer_load, b.outer_contact_angle)];
        for (race, load, angle) in contacts {
            if load > 0.0 && angle.abs() > FRAC_PI_2 {
                return Err(EquilibriumError::LeftGroove { ball: index + 1, race, angle });
            }
        }
    }
    Ok(solution)
}

/// Newton step of the free directions and the cage speed, shifted by a share of a typical stiffness.
fn newton_step(
    here: &Trial,
    input: &EquilibriumInput,
    free: &[bool; 5],
    size: impl Fn(usize) -> f64,
    shift: f64,
    speed_scale: f64,
) -> Option<SharedVector> {
    // [N/m] of a steel bearing's order; only its order matters.
    const TYPICAL_STIFFNESS: f64 = 1e7;
    let mut matrix = here.tangent;
    let mut rhs = SharedVector::zeros();
    for i in 0..5 {
        match input.conditions[i] {
            Prescribed::Load(load) if free[i] => {
                rhs[i] = load - here.load[i];
                matrix[(i, i)] += shift * TYPICAL_STIFFNESS * size(i) * size(i);
            }
            _ => {
                matrix.row_mut(i).fill(0.0);
                matrix[(i, i)] = 1.0;
            }
        }
    }
    if speed_scale > 0.0 && here.inner_load_sum > 0.0 {
        rhs[5] = -here.cage_excess;
    } else {
        matrix.row_mut(5).fill(0.0);
        matrix[(5, 5)] = 1.0;
    }
    // Rows and columns of comparable size, so that pivoting compares like with like.
    let column =
        SharedVector::from_fn(|i, _| if i < 5 { 1.0 / size(i) } else { speed_scale.max(1.0) / size(3) });
    let scaled = matrix * SharedMatrix::from_diagonal(&column);
    let row = SharedVector::from_fn(|i, _| 1.0 / scaled.row(i).amax().max(f64::MIN_POSITIVE));
    let system = SharedMatrix::from_diagonal(&row) * scaled;
    let solution = system.lu().solve(&row.component_mul(&rhs))?;
    let step = column.component_mul(&solution);
    step.iter().all(|c| c.is_finite()).then_some(step)
}

/// The inner race relative to the outer one, with derivatives.
fn shared(input: &EquilibriumInput, unknowns: &SharedVector) -> Shared {
    let variable = |i: usize| D::variable(unknowns[i], SHARED + i, 1.0);
    let (ry, rz) = (variable(3), variable(4));
    let square = ry.square() + rz.square();
    // cos(t) and sin(t)/t as smooth functions of t^2
    let cosine = square.map_smooth(|s| (s.sqrt().cos(), -0.5 * sinc(s)));
    let sine = square.map_smooth(|s| (sinc(s), sinc_slope(s)));
    let axis = Vector3::new(cosine, sine * rz, -(sine * ry));
    let position = Vector3::new(variable(0), variable(1), variable(2));
    let seen = |v: &Vector3<D>| turn(&input.outer_orientation.inverse(), v);
    Shared { position: seen(&position), axis: seen(&axis), cage_speed: variable(5) }
}

/// `sin(t)/t` with `s = t^2`.
fn sinc(s: f64) -> f64 {
    if s < 1e-6 { 1.0 - s / 6.0 + s * s / 120.0 } else { s.sqrt().sin() / s.sqrt() }
}

/// Derivative of [`sinc`] by s.
fn sinc_slope(s: f64) -> f64 {
    if s < 1e-6 { -1.0 / 6.0 + s / 60.0 } else { (s.sqrt().cos() - sinc(s)) / (2.0 * s) }
}

fn turn(q: &UnitQuaternion<f64>, v: &Vector3<D>) -> Vector3<D> {
    let m = q.to_rotation_matrix();
    Vector3::from_fn(|i, _| v[0].scale(m[(i, 0)]) + v[1].scale(m[(i, 1)]) + v[2].scale(m[(i, 2)]))
}

fn evaluate(
    model: &Model,
    input: &EquilibriumInput,
    unknowns: &SharedVector,
    start: Option<&[Place]>,
    tolerance: f64,
) -> Result<Trial, EquilibriumError> {
    let shared = shared(input, unknowns);
    let n = model.bearing.n_balls;
    let mut trial = Trial {
        load: SVector::zeros(),
        cage_excess: 0.0,
        tangent: SharedMatrix::zeros(),
        inner_load_sum: 0.0,
        balances: Vec::with_capacity(n),
        places: Vec::with_capacity(n),
    };
    for j in 0..n {
        let azimuth = model.bearing.ball_azimuth(j);
        let fresh = || middle_of_gap(model, &shared, azimuth);
        let mut place = start.map_or_else(fresh, |places| places[j]);
        // Round-off of the contact's own stiffness bounds the residual of a heavily loaded ball.
        let settled = settle(model, input, &shared, azimuth, &mut place, tolerance).or_else(|| {
            place = fresh();
            settle(model, input, &shared, azimuth, &mut place, tolerance)
        });
        let Some(balance) = settled else {
            return Err(EquilibriumError::Ball {
                ball: j + 1,
                displacement: std::array::from_fn(|i| unknowns[i]),
            });
        };
        // rows in the bearing frame: external load and cage excess
        let force = turn(&input.outer_orientation, &balance.inner_force);
        let moment = turn(&input.outer_orientation, &balance.inner_moment);
        let excess = balance.inner_load * (balance.own_orbital_speed - shared.cage_speed);
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
        trial.balances.push(balance);
        trial.places.push(place);
    }
    Ok(trial)
}

fn finish(
    model: &Model,
    input: &EquilibriumInput,
    unknowns: &SharedVector,
    trial: &Trial,
    residual: f64,
    iterations: u32,
) -> Equilibrium {
    let cage_speed = unknowns[5];
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
                report: BallReport::new(balance, &shared(input, unknowns).axis.map(D::value)),
            }
        })
        .collect();
    // With the cage speed following: eliminate the last unknown.
    let t = &trial.tangent;
    let pivot = t[(5, 5)];
    let stiffness = SMatrix::<f64, 5, 5>::from_fn(|i, k| {
        let follow = if pivot == 0.0 { 0.0 } else { t[(i, 5)] * t[(5, k)] / pivot };
        t[(i, k)] - follow
    });
    Equilibrium {
        displacement: std::array::from_fn(|i| unknowns[i]),
        load: std::array::from_fn(|i| trial.load[i]),
        stiffness,
        cage_speed,
        residual,
        iterations,
        balls,
    }
}
