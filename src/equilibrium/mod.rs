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
use ball::{BallBalance, N_SHARED, Place, SHARED, Shared, bottom_of_outer_groove, middle_of_gap, settle};
pub use report::BallReport;

type D = Dual<{ ball::DIRECTIONS }>;
type SharedVector = SVector<f64, N_SHARED>;
type SharedMatrix = SMatrix<f64, N_SHARED, N_SHARED>;

/// [-] accepted residual over the size of the forces at work.
const TOLERANCE: f64 = 1e-11;
/// [-] residual below which it is what falls, even where the potential leads.
const NEAR: f64 = 1e-4;
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
         groove; the load, the displacement or the tilt is too large"
    )]
    LeftGroove {
        /// Ball, counted from 1.
        ball: usize,
        /// Inner or outer.
        race: &'static str,
        /// [rad] contact angle.
        angle: f64,
    },
    /// Outer race control asks for more friction than there can be.
    #[error(
        "no equilibrium was found under outer race control, and there is one without gyroscopic moments: that of ball \
         {ball}, {moment:.3e} N m at an outer load of {load:.3e} N, would need a friction coefficient of {friction:.2} at \
         the outer race"
    )]
    OuterRaceControl {
        /// Ball with the largest need, counted from 1.
        ball: usize,
        /// [N m] its gyroscopic moment.
        moment: f64,
        /// [N] its load on the outer race.
        load: f64,
        /// [-] friction coefficient that would hold it.
        friction: f64,
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

/// What a step of the search has to achieve.
#[derive(Clone, Copy, PartialEq)]
enum Progress {
    /// A smaller residual: quick, but a residual can have minima where there is no balance.
    Residual,
    /// Work done by the unbalanced loads: the potential falls, which leads out of such minima.
    Work,
}

/// Where a search ended.
struct Found {
    unknowns: SharedVector,
    trial: Trial,
    /// [-] largest residual over the forces at work.
    residual: f64,
    iterations: u32,
}

/// Solves a quasi-static problem.
///
/// Newton's method first from the centred race for a falling residual, then for a falling potential, then from the
/// bearing at rest through growing speeds.
///
/// # Errors
/// See [`EquilibriumError`]; an unconverged result is never returned.
pub fn solve(model: &Model, input: &EquilibriumInput) -> Result<Equilibrium, EquilibriumError> {
    let problem = Problem::new(model, input);
    let checked = |found: Found| problem.check(problem.finish(&found));
    problem
        .search(problem.centred(), None, Progress::Residual)
        .or_else(|_| problem.search(problem.centred(), None, Progress::Work))
        .or_else(|_| through_speeds(model, input))
        .map_err(|why| beyond_outer_race_control(model, input).unwrap_or(why))
        .and_then(checked)
}

/// Why there is no solution, if that is Jones's hypothesis: that friction at the outer race carries the gyroscopic moment,
/// where more is needed than there is.
fn beyond_outer_race_control(model: &Model, input: &EquilibriumInput) -> Option<EquilibriumError> {
    if input.gyroscopic != Gyroscopic::OuterRaceControl {
        return None;
    }
    let without = EquilibriumInput { gyroscopic: Gyroscopic::None, ..input.clone() };
    let solution = solve(model, &without).ok()?;
    let need = |ball: &BallReport| {
        ball.gyroscopic_moment.abs() / (model.bearing.ball.radius * ball.outer_load.max(f64::MIN_POSITIVE))
    };
    let reports = solution.balls.iter().map(|ball| need(&ball.report)).enumerate();
    let (index, friction) = reports.max_by(|a, b| a.1.total_cmp(&b.1))?;
    if friction <= input.friction {
        return None;
    }
    let BallReport { gyroscopic_moment: moment, outer_load: load, .. } = solution.balls[index].report;
    Some(EquilibriumError::OuterRaceControl { ball: index + 1, moment, load, friction })
}

/// Follows the equilibrium from the bearing at rest to its speeds.
fn through_speeds(model: &Model, input: &EquilibriumInput) -> Result<Found, EquilibriumError> {
    const SMALLEST_INCREMENT: f64 = 1e-3;
    let at = |share: f64| EquilibriumInput {
        inner_speed: share * input.inner_speed,
        outer_speed: share * input.outer_speed,
        ..input.clone()
    };
    let resting = at(0.0);
    let problem = Problem::new(model, &resting);
    let mut found = problem.search(problem.centred(), None, Progress::Work)?;
    let (mut share, mut increment) = (0.0, 0.25);
    while share < 1.0 {
        let next = f64::min(share + increment, 1.0);
        let slower = at(next);
        let problem = Problem::new(model, &slower);
        let mut start = found.unknowns;
        start[5] = if share > 0.0 { start[5] * next / share } else { problem.centred()[5] };
        match problem.search(start, Some(&found.trial.places), Progress::Residual) {
            Ok(further) => {
                found = further;
                share = next;
                increment *= 2.0;
            }
            Err(_) if increment > SMALLEST_INCREMENT => increment *= 0.25,
            Err(why) => return Err(why),
        }
    }
    Ok(found)
}

/// A quasi-static problem with the sizes that make its residuals and steps comparable.
struct Problem<'a> {
    model: &'a Model,
    input: &'a EquilibriumInput,
    /// [m] ball diameter.
    diameter: f64,
    /// [rad/s] mean orbital speed of unloaded balls.
    epicyclic: f64,
    /// [rad/s] larger speed of the races.
    speed_scale: f64,
    /// [N] forces that are known beforehand: loads, inertia, and the smallest load worth resolving.
    known_force: f64,
    /// [N] the last of these: a ball loaded by an approach of a millionth of its diameter.
    smallest: f64,
}

impl<'a> Problem<'a> {
    fn new(model: &'a Model, input: &'a EquilibriumInput) -> Self {
        let bearing = &model.bearing;
        let length = model.race_length();
        let diameter = 2.0 * bearing.ball.radius;
        let epicyclic =
            bearing.epicyclic_speed(bearing.free_contact_angle, input.inner_speed, input.outer_speed);
        let smallest = model.contact(0, 0.0).shape.stiffness(0.0) * (1e-6 * diameter).powf(1.5);
        let inertia_force = bearing.ball.mass * epicyclic * epicyclic * length;
        let mut problem = Self {
            model,
            input,
            diameter,
            epicyclic,
            speed_scale: input.inner_speed.abs().max(input.outer_speed.abs()),
            known_force: inertia_force.max(smallest),
            smallest,
        };
        for i in 0..5 {
            if let Prescribed::Load(load) = input.conditions[i] {
                problem.known_force = problem.known_force.max(load.abs() / problem.size(i));
            }
        }
        problem
    }

    /// [-], [m] what turns a direction's load into a force and its displacement into a length.
    fn size(&self, direction: usize) -> f64 {
        if direction < 3 { 1.0 } else { self.model.race_length() }
    }

    /// The race in the middle but for what is imposed on it.
    fn centred(&self) -> SharedVector {
        let mut unknowns = SharedVector::zeros();
        for (i, condition) in self.input.conditions.iter().enumerate() {
            if let Prescribed::Motion(value) = condition {
                unknowns[i] = *value;
            }
        }
        unknowns[5] = self.epicyclic;
        unknowns
    }

    /// [N] size of the forces at work.
    fn reference(&self, trial: &Trial) -> f64 {
        self.known_force.max(trial.inner_load_sum)
    }

    /// Unbalanced load of every free direction.
    fn unbalanced(&self, trial: &Trial) -> SharedVector {
        SharedVector::from_fn(|i, _| match self.input.conditions.get(i) {
            Some(Prescribed::Load(load)) => load - trial.load[i],
            _ => 0.0,
        })
    }

    /// What has to vanish, over a force [N] and a load [N] that the cage speed is weighted with.
    fn residual_over(&self, trial: &Trial, scale: f64, weight: f64) -> SharedVector {
        let mut residual = self.unbalanced(trial);
        for i in 0..5 {
            residual[i] /= self.size(i) * scale;
        }
        if self.speed_scale > 0.0 {
            residual[5] = trial.cage_excess / (self.speed_scale * weight);
        }
        residual
    }

    /// The same over the forces at work.
    fn residual(&self, trial: &Trial) -> SharedVector {
        self.residual_over(trial, self.reference(trial), trial.inner_load_sum.max(1e-9 * self.smallest))
    }

    fn evaluate(&self, unknowns: &SharedVector, places: Option<&[Place]>) -> Result<Trial, EquilibriumError> {
        evaluate(self.model, self.input, unknowns, places, 0.01 * TOLERANCE * self.known_force)
    }

    /// Newton's method with a shift of the stiffness where a step makes no progress.
    fn search(
        &self,
        start: SharedVector,
        places: Option<&[Place]>,
        mut progress: Progress,
    ) -> Result<Found, EquilibriumError> {
        let downhill = progress == Progress::Work;
        let mut unknowns = start;
        let mut here = self.evaluate(&unknowns, places)?;
        let mut residual = self.residual(&here);
        let mut shift = 0.0;
        let mut iterations = 0;
        while residual.amax() > TOLERANCE {
            iterations += 1;
            let trial = self.newton_step(&here, shift).and_then(|mut step| {
                // At most a hundredth of a ball diameter at a time.
                let longest = (0..5).map(|i| step[i].abs() * self.size(i)).fold(0.0, f64::max);
                let limit = 0.01 * self.diameter;
                if longest > limit {
                    step *= limit / longest;
                }
                let moved = unknowns + step;
                self.evaluate(&moved, Some(&here.places)).ok().map(|trial| (moved, trial))
            });
            match trial.filter(|(moved, trial)| self.accepts(progress, &here, trial, &(moved - unknowns))) {
                Some((moved, trial)) => {
                    unknowns = moved;
                    residual = self.residual(&trial);
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
            if stalled && progress == Progress::Work {
                // The bottom of a potential with kinks: the residual may know the rest of the way.
                progress = Progress::Residual;
                shift = 0.0;
            } else if stalled || iterations == MAX_ITERATIONS {
                let found = Found { unknowns, trial: here, residual: residual.amax(), iterations };
                // Downhill all the way to where no bearing is: that is the reason.
                if downhill {
                    self.check(self.finish(&found))?;
                }
                return Err(EquilibriumError::NoConvergence {
                    residual: residual.amax(),
                    direction: DIRECTION_NAMES[residual.rows(0, 5).iamax()],
                    iterations,
                    displacement: std::array::from_fn(|i| unknowns[i]),
                });
            }
        }
        Ok(Found { unknowns, trial: here, residual: residual.amax(), iterations })
    }

    /// Is a step progress?
    fn accepts(&self, progress: Progress, here: &Trial, trial: &Trial, step: &SharedVector) -> bool {
        // A race that touches nothing yet moves without its residual falling.
        let touches = |trial: &Trial| trial.inner_load_sum > 1e-9 * self.reference(trial);
        if !touches(here) && !touches(trial) {
            return true;
        }
        // What has to fall is the residual over its own forces or with one scale for both: over its own forces alone, a
        // race that has to let go of its balls would seem further from balance the less it carries.
        let scale = self.reference(here);
        let merit = |trial: &Trial| self.residual_over(trial, scale, scale).norm();
        let falls = |now: f64, before: f64| now < before * (1.0 - 1e-6);
        let smaller = falls(self.residual(trial).norm(), self.residual(here).norm())
            || falls(merit(trial), merit(here));
        if progress == Progress::Residual || self.residual(here).amax() < NEAR {
            return smaller;
        }
        // Work of the unbalanced loads by the trapezoidal rule; the cage speed takes no part in it.
        let (before, after) = (self.unbalanced(here), self.unbalanced(trial));
        let work = 0.5 * (before + after).dot(step);
        let size = before.component_mul(step).abs().sum();
        if size == 0.0 { smaller } else { work > 1e-6 * size }
    }

    /// Newton step of the free directions and the cage speed, shifted by a share of a typical stiffness.
    fn newton_step(&self, here: &Trial, shift: f64) -> Option<SharedVector> {
        // [N/m] of a steel bearing's order; only its order matters.
        const TYPICAL_STIFFNESS: f64 = 1e7;
        let mut matrix = here.tangent;
        let mut rhs = self.unbalanced(here);
        for i in 0..5 {
            if let Prescribed::Load(_) = self.input.conditions[i] {
                matrix[(i, i)] += shift * TYPICAL_STIFFNESS * self.size(i) * self.size(i);
            } else {
                matrix.row_mut(i).fill(0.0);
                matrix[(i, i)] = 1.0;
            }
        }
        if self.speed_scale > 0.0 && here.inner_load_sum > 0.0 {
            rhs[5] = -here.cage_excess;
        } else {
            matrix.row_mut(5).fill(0.0);
            matrix[(5, 5)] = 1.0;
        }
        // Rows and columns of comparable size, so that pivoting compares like with like.
        let speed = self.speed_scale.max(1.0) / self.size(3);
        let column = SharedVector::from_fn(|i, _| if i < 5 { 1.0 / self.size(i) } else { speed });
        let scaled = matrix * SharedMatrix::from_diagonal(&column);
        let row = SharedVector::from_fn(|i, _| 1.0 / scaled.row(i).amax().max(f64::MIN_POSITIVE));
        let system = SharedMatrix::from_diagonal(&row) * scaled;
        let solution = system.lu().solve(&row.component_mul(&rhs))?;
        let step = column.component_mul(&solution);
        step.iter().all(|c| c.is_finite()).then_some(step)
    }

    fn finish(&self, found: &Found) -> Equilibrium {
        finish(self.model, self.input, &found.unknowns, &found.trial, found.residual, found.iterations)
    }

    /// Refuses contacts that Hertz's theory does not reach, or that lie where no groove is.
    fn check(&self, solution: Equilibrium) -> Result<Equilibrium, EquilibriumError> {
        for (index, ball) in solution.balls.iter().enumerate() {
            let b = &ball.report;
            let (approach, load) = (b.inner_approach.max(b.outer_approach), b.inner_load.max(b.outer_load));
            if approach > MAX_APPROACH * self.diameter {
                let ball = index + 1;
                return Err(EquilibriumError::Overload { ball, approach, load, limit: MAX_APPROACH });
            }
            let contacts = [
                ("inner", b.inner_load, b.inner_contact_angle),
                ("outer", b.outer_load, b.outer_contact_angle),
            ];
            for (race, load, angle) in contacts {
                if load > 0.0 && angle.abs() > FRAC_PI_2 {
                    return Err(EquilibriumError::LeftGroove { ball: index + 1, race, angle });
                }
            }
        }
        Ok(solution)
    }
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
        // From where it was, from between the races, or from the bottom of the outer groove.
        let kept = start.map(|places| places[j]);
        let fresh: [&dyn Fn() -> Place; 2] = [&|| middle_of_gap(model, &shared, azimuth), &|| {
            bottom_of_outer_groove(model, input, &shared, azimuth)
        }];
        let starts = kept.into_iter().chain(fresh.iter().map(|place| place()));
        let settled = starts.into_iter().find_map(|mut place| {
            settle(model, input, &shared, azimuth, &mut place, tolerance).map(|balance| (balance, place))
        });
        let Some((balance, place)) = settled else {
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
