//! Where a cage starts: centred among the balls, or where its contacts are least if it touches there.
//!
//! Balls of tilted races lie in a tilted plane, which the cage follows. Sought is the pose whose largest distance from the middle
//! of a clearance, over that clearance, is smallest: weighted least squares, whose weights grow where the distance is large
//! (Lawson 1961).

use nalgebra::{Matrix6, UnitQuaternion, Vector3, Vector6};

use super::SimulationError;
use crate::model::bodies::{PerRace, Race};
use crate::model::cage::CageModel;
use crate::model::state::{BallState, BodyState};
use crate::numerics::motion::{Pose, Twist};

/// Rounds of weighting; the largest distance settles within a few.
const ROUNDS: usize = 60;
/// [-] overlap over clearance that is left to the contacts: half a micrometre of a tenth of a millimetre.
const OVERLAP: f64 = 0.01;
/// [-] step of differences over the smallest clearance: distances are nearly linear in the pose.
const DIFFERENCE: f64 = 1e-3;

/// Bodies that the cage is placed among.
struct Surroundings<'a> {
    cage: &'a CageModel,
    balls: &'a [BallState],
    races: &'a PerRace<BodyState>,
}

impl Surroundings<'_> {
    /// [-] distances from the middle of the clearances over these: pockets, then lands. Above 1 they touch.
    fn distances(&self, pose: &Pose) -> Vec<f64> {
        let motion = BodyState::new(*pose, &Twist::default(), 0).body_motion();
        let pocket = self.cage.pocket.half_clearance;
        let over = |approach: f64, clearance: f64| 1.0 + approach / clearance;
        let pockets = self
            .balls
            .iter()
            .enumerate()
            .map(|(index, ball)| over(self.cage.pocket_approach(index, &ball.motion(), &motion), pocket));
        let lands = self.cage.land.iter().flat_map(|(guide, land)| {
            let race = self.races[*guide].motion();
            land.positions.map(|x| over(land.approach(&motion, &race, x), land.half_clearance))
        });
        pockets.chain(lands).collect()
    }

    /// \[m] smallest clearance of one side.
    fn clearance(&self) -> f64 {
        let land = self.cage.land.as_ref().map_or(f64::INFINITY, |(_, land)| land.half_clearance);
        self.cage.pocket.half_clearance.min(land)
    }
}

/// Pose and motion of a cage that turns about its own axis at a speed [rad/s]; `centred` is its pose where nothing is tilted.
///
/// # Errors
/// If the cage would be pressed onto balls or lands wherever it is.
pub fn place(
    cage: &CageModel,
    balls: &[BallState],
    races: &PerRace<BodyState>,
    centred: Pose,
    radius: f64,
    speed: f64,
) -> Result<BodyState, SimulationError> {
    let around = Surroundings { cage, balls, races };
    let pose =
        if worst(&around.distances(&centred)).1 <= 1.0 { centred } else { least(&around, centred, radius) };
    let (place, distance) = worst(&around.distances(&pose));
    let fits = distance <= 1.0 + OVERLAP;
    if !fits {
        let clearance = cage.land.iter().map(|(_, land)| land.half_clearance);
        let (contact, clearance) = match balls.get(place) {
            Some(_) => (format!("the pocket of ball {}", place + 1), cage.pocket.half_clearance),
            None => (format!("a land of the {} race", guide_name(cage)), clearance.fold(0.0, f64::max)),
        };
        let overlap = (distance - 1.0) * clearance;
        return Err(SimulationError::CageDoesNotFit { contact, overlap, clearance: 2.0 * clearance });
    }
    let velocity = races.outer.velocity;
    let angular_velocity = pose.orientation * Vector3::x() * speed;
    Ok(BodyState::new(pose, &Twist { velocity, angular_velocity }, 0))
}

fn guide_name(cage: &CageModel) -> &'static str {
    cage.guide().map_or("", Race::name)
}

/// Place of the largest number and the number; NaN if one is.
fn worst(distances: &[f64]) -> (usize, f64) {
    let larger = |best: (usize, f64), (i, &d): (usize, &f64)| if d <= best.1 { best } else { (i, d) };
    distances.iter().enumerate().fold((0, 0.0), larger)
}

/// The pose with the least largest distance that is found from `start`; `radius` \[m] turns angles into displacements.
fn least(around: &Surroundings<'_>, start: Pose, radius: f64) -> Pose {
    let moved = |pose: &Pose, by: &Vector6<f64>| {
        let turn = UnitQuaternion::new(by.fixed_rows::<3>(3).into_owned() / radius);
        let position = pose.position + pose.orientation * by.fixed_rows::<3>(0).into_owned();
        Pose { position, orientation: pose.orientation * turn }
    };
    let step = DIFFERENCE * around.clearance();
    let mut pose = start;
    let mut best = (worst(&around.distances(&start)).1, start);
    let mut weights = vec![1.0; around.distances(&start).len()];
    for _ in 0..ROUNDS {
        let merit = |pose: &Pose| -> f64 {
            around.distances(pose).iter().zip(&weights).map(|(d, weight)| weight * d * d).sum()
        };
        // Squares of distances are quadratic in the pose but for the turn: differences give gradient and curvature.
        let at = |i: usize, k: usize, signs: [f64; 2]| {
            let mut by = Vector6::zeros();
            by[i] += signs[0] * step;
            by[k] += signs[1] * step;
            merit(&moved(&pose, &by))
        };
        let gradient = Vector6::from_fn(|i, _| (at(i, i, [1.0, 0.0]) - at(i, i, [-1.0, 0.0])) / (2.0 * step));
        let curvature = Matrix6::from_fn(|i, k| {
            let sum =
                at(i, k, [1.0, 1.0]) + at(i, k, [-1.0, -1.0]) - at(i, k, [1.0, -1.0]) - at(i, k, [-1.0, 1.0]);
            sum / (4.0 * step * step)
        });
        // What nothing holds (the turn of a cage without lands about a diameter of balls) stays.
        let hold = Matrix6::identity() * (1e-6 * curvature.trace());
        let Some(change) = (curvature + hold).cholesky().map(|factor| factor.solve(&-gradient)) else {
            break;
        };
        pose = moved(&pose, &change);
        let distances = around.distances(&pose);
        let (_, largest) = worst(&distances);
        if largest < best.0 {
            best = (largest, pose);
        }
        let mean = distances.iter().zip(&weights).map(|(d, weight)| weight * d).sum::<f64>();
        if mean <= 0.0 || mean.is_nan() {
            break;
        }
        let count = weights.len() as f64;
        for (weight, distance) in weights.iter_mut().zip(&distances) {
            *weight *= (distance / mean * count).clamp(0.1, 10.0);
        }
        let total: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight *= count / total);
    }
    best.1
}
