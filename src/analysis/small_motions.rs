//! Small motions of balls, races, cages and what carries them about where they are: linear equations by the exact derivatives of all
//! forces, friction among them, and what grows or decays in them.
//!
//! ```text
//! bodies   M q'' + C q' + K q = sum over pairs J^T (f_place d + f_rate d'),    d = J q, or a ball's own
//! a ball   m p'' = f,   I w' = g      of the same forces
//! ```
//! No ball is condensed out: its inertia and the slip that friction acts against are part of a motion. As balls travel around, what a
//! ball does is a field over their places: with the passage of a ball to the place of the next one in `T`, all is as before, and a
//! motion is `u_k(t) = u(k + t/T) exp(lambda t)` in the axes of ball k, `u` a trigonometric polynomial through the Z balls. Its rate is
//!
//! `lambda u + (1/T) D u + W [x] u`,   `D u` the derivative of that polynomial, `W = 2 pi/(Z T)` the orbital speed.
//!
//! Where an ideal cage keeps balls apart, all are at one place along the orbit: `u` there is the same of all, and so is its rate.
//!
//! Under a thrust this is exact: seen from the balls nothing changes with time. Under other loads the balls are taken where they stand,
//! and what changes while one of them passes is left out.

use nalgebra::{Complex, DMatrix, DVector, DVectorView, Matrix3, Matrix6, Vector3};

use super::kept_apart::{Caged, OF_BALL, kept_apart};
use super::tangents::{Tangents, by_first, first_ball};
use crate::contact::BallMotion;
use crate::dynamics::carried::SeatMotion;
use crate::effects::moving_frame::FrameMotion;
use crate::model::bodies::{Body, PerRace, Race};
use crate::model::state::{BallState, BodyState, State};
use crate::model::structure::Map;
use crate::model::{Conditions, Model};
use crate::numerics::eigen::eigenpairs;
use crate::numerics::given::take_out;

/// [-] eigenvalues whose imaginary part is a smaller part of their size do not swing.
const SWINGS: f64 = 1e-6;

/// Linear equations of a body or structure without its bearings: `M q'' + C q' + K q = 0`.
#[derive(Clone, Debug)]
pub struct Mover {
    /// Mass matrix.
    pub mass: DMatrix<f64>,
    /// Damping and gyroscopic terms.
    pub damping: DMatrix<f64>,
    /// Stiffness.
    pub stiffness: DMatrix<f64>,
}

impl Mover {
    /// Adds to stiffness and damping, where there is something to be added.
    pub fn add(&mut self, matrices: Option<[DMatrix<f64>; 2]>) {
        if let Some([stiffness, damping]) = matrices {
            self.stiffness += stiffness;
            self.damping += damping;
        }
    }
}

/// Where a body of a bearing is on a mover.
#[derive(Clone, Debug)]
pub struct Seated {
    /// The body.
    pub body: Body,
    /// Its place and angles (turn, tilts) by the coordinates of all movers.
    pub map: Map,
    /// Its motion, in the bearing's frame.
    pub motion: SeatMotion,
    /// [N m] moment of forces on it that turn no more than the bearing's do, in that frame: it acts beside that of the pairs.
    pub applied: Vector3<f64>,
}

/// A bearing and where its bodies are; those that are not named have a given motion.
pub struct Running<'a> {
    /// Its model.
    pub model: &'a Model,
    /// Its state.
    pub state: &'a State,
    /// Conditions of every contact.
    pub conditions: Conditions,
    /// Motion of its frame, and gravity in it.
    pub frame: FrameMotion,
    /// Its bodies that move.
    pub seats: Vec<Seated>,
}

/// Linear equations of motion of all, `x' = A x`: coordinates, their rates, then place, velocity and angular velocity of each ball along its
/// own axes (axial, radial, along the orbit).
#[derive(Clone, Debug)]
pub struct SmallMotions {
    matrix: DMatrix<f64>,
    /// All unknowns by those of the matrix, where ideal cages keep balls apart.
    lift: Option<DMatrix<f64>>,
    /// Mass matrix of the coordinates.
    mass: DMatrix<f64>,
    /// \[kg] mass of each ball.
    balls: Vec<f64>,
}

/// A motion that grows or decays as `exp(value t)`.
#[derive(Clone, Debug)]
pub struct SmallMotion {
    /// [1/s] eigenvalue; its imaginary part is not negative.
    pub value: Complex<f64>,
    /// Amplitudes of the coordinates.
    pub shape: DVector<Complex<f64>>,
    /// [-] share of the balls in the kinetic energy, but for that of their spins.
    pub balls: f64,
}

impl SmallMotion {
    /// \[Hz] frequency; 0 where it does not swing.
    pub fn frequency(&self) -> f64 {
        self.value.im / std::f64::consts::TAU
    }

    /// [1/s] growth; negative where it decays.
    pub fn growth(&self) -> f64 {
        self.value.re
    }
}

impl SmallMotions {
    /// The equations of movers, and of bearings between them.
    pub fn new(movers: &[Mover], bearings: &[Running<'_>]) -> Self {
        let size = movers.iter().map(|mover| mover.mass.nrows()).sum();
        let n_balls: usize = bearings.iter().map(|bearing| bearing.state.balls.len()).sum();
        let mut mass = DMatrix::zeros(size, size);
        // Generalised forces by all unknowns: divided by the mass matrix when they are complete.
        let mut matrix = DMatrix::zeros(2 * size + OF_BALL * n_balls, 2 * size + OF_BALL * n_balls);
        let mut from = 0;
        for Mover { mass: own, damping, stiffness } in movers {
            let n = own.nrows();
            mass.view_mut((from, from), (n, n)).copy_from(own);
            matrix.view_mut((size + from, from), (n, n)).copy_from(&-stiffness);
            matrix.view_mut((size + from, size + from), (n, n)).copy_from(&-damping);
            from += n;
        }
        let mut first = 2 * size;
        let mut balls = vec![];
        for bearing in bearings {
            let ball = &bearing.model.bearing.ball;
            let mut rows = Rows { matrix: &mut matrix, size, first };
            rows.add_bearing(bearing);
            let count = bearing.state.balls.len();
            balls.extend(std::iter::repeat_n(ball.mass, count));
            first += OF_BALL * count;
        }
        let forces = matrix.rows(size, size).into_owned();
        let accelerations = mass.clone().lu().solve(&forces);
        // A mass matrix is positive definite; of one that is not, no eigenvalues are found.
        let accelerations = accelerations.unwrap_or_else(|| forces * f64::NAN);
        matrix.rows_mut(size, size).copy_from(&accelerations);
        matrix.view_mut((0, size), (size, size)).fill_with_identity();
        let apart = bearings.iter().map(|of| Caged {
            balls: of.state.balls.len(),
            speed: of.model.spacing.is_some().then(|| mean_orbital_speed(of.state)),
        });
        let (matrix, lift) = kept_apart(matrix, 2 * size, &apart.collect::<Vec<_>>());
        Self { matrix, mass, balls, lift }
    }

    /// With some coordinates, which inertia does not couple with others, that do not move.
    #[must_use]
    pub fn holding(mut self, coordinates: &[usize]) -> Self {
        // Of what ideal cages leave, coordinates and their rates come first, too.
        let size = self.mass.nrows();
        take_out(&mut self.matrix, coordinates.iter().flat_map(|k| [*k, size + k]), 0.0);
        self
    }

    /// Motions whose eigenvalue is `wanted`, the fastest growing first; one of each conjugate pair. None where eigenvalues are not found.
    pub fn motions(&self, wanted: impl Fn(Complex<f64>) -> bool) -> Option<Vec<SmallMotion>> {
        let size = self.mass.nrows();
        let swinging = |value: Complex<f64>| match value {
            value if value.im.abs() > SWINGS * value.norm() => value,
            value => Complex::from(value.re),
        };
        let mut found: Vec<SmallMotion> = eigenpairs(&self.matrix, |value| wanted(swinging(value)))?
            .into_iter()
            .map(|pair| {
                let vector = match &self.lift {
                    Some(lift) => lift.map(Complex::from) * &pair.vector,
                    None => pair.vector,
                };
                let rates = vector.rows(size, size);
                let of_bodies = self.energy_of_bodies(&rates);
                let of_balls = self.energy_of_balls(&vector.rows_range(2 * size..));
                let balls = of_balls / (of_bodies + of_balls).max(f64::MIN_POSITIVE);
                SmallMotion { value: swinging(pair.value), shape: vector.rows(0, size).into_owned(), balls }
            })
            .collect();
        found.sort_by(|a, b| b.value.re.total_cmp(&a.value.re));
        Some(found)
    }

    /// Four times the mean kinetic energy of the movers at these rates.
    fn energy_of_bodies(&self, rates: &DVectorView<'_, Complex<f64>>) -> f64 {
        let part = |of: fn(&Complex<f64>) -> f64| {
            let rates = rates.map(|rate| of(&rate));
            rates.dot(&(&self.mass * &rates))
        };
        part(|rate| rate.re) + part(|rate| rate.im)
    }

    /// Kinetic energy of the balls, but for that of their spins.
    fn energy_of_balls(&self, unknowns: &DVectorView<'_, Complex<f64>>) -> f64 {
        let square = |k: usize| unknowns.rows(OF_BALL * k + 3, 3).iter().map(Complex::norm_sqr).sum::<f64>();
        // None has none, and not -0.
        self.balls.iter().enumerate().fold(0.0, |sum, (k, mass)| sum + mass * square(k))
    }
}

/// The equations while they are filled: rows of generalised forces and of a bearing's balls.
struct Rows<'a> {
    matrix: &'a mut DMatrix<f64>,
    /// Number of coordinates.
    size: usize,
    /// First unknown of the bearing's balls.
    first: usize,
}

/// A body of a pair, as the equations have it.
#[derive(Clone, Copy)]
enum Side<'a> {
    /// A ball by its index.
    Ball(usize),
    /// A body on a seat: the motion of its origin and its rotation by all coordinates.
    Body(&'a Map),
    /// Its motion is given.
    Given,
}

impl Rows<'_> {
    fn add_bearing(&mut self, bearing: &Running<'_>) {
        let Running { model, state, conditions, frame, seats } = bearing;
        let axes = axes_of_balls(state);
        let worlds: Vec<(Body, Map)> = seats.iter().map(|seat| (seat.body, seat.world())).collect();
        let side = |body: Body| {
            let seat = worlds.iter().find(|(own, _)| *own == body);
            seat.map_or(Side::Given, |(_, world)| Side::Body(world))
        };
        let contacts = model.contacts_oriented(conditions, state.orientations.as_ref());
        let races = PerRace::new(|race| state.race(race).motion());
        let cage = model.cage.as_ref().zip(state.cage().map(BodyState::body_motion));
        let oil = model.oil_around_cage(conditions);
        let motions: Vec<BallMotion<f64>> = state.balls.iter().map(BallState::motion).collect();
        let ball = &model.bearing.ball;
        let inertia = [ball.mass, ball.inertia];
        for (k, motion) in motions.iter().enumerate() {
            for race in Race::BOTH {
                let contact = contacts[race].of_ball(k, state.difference(k, race));
                if !contact.is_open(motion, &races[race]) {
                    let pair = Tangents::of_ball_and_race(&contact, motion, &races[race]);
                    self.add_pair([Side::Ball(k), side(race.into())], &pair, (&axes, inertia));
                }
            }
            if let Some((cage, seen)) = &cage
                && let Some(pair) = Tangents::of_ball_and_cage(
                    |ball, body| cage.pocket_contact(k, ball, body, oil),
                    motion,
                    seen,
                )
            {
                self.add_pair([Side::Ball(k), side(Body::Cage)], &pair, (&axes, inertia));
            }
        }
        if let Some((cage, seen)) = &cage
            && let Some((guide, land)) = &cage.land
        {
            for position in land.positions {
                let of = |cage: &_, race: &_| land.evaluate(cage, race, position, oil);
                if let Some(pair) = Tangents::of_cage_and_race(of, seen, &races[*guide]) {
                    self.add_pair([side(Body::Cage), side((*guide).into())], &pair, (&axes, inertia));
                }
            }
        }
        if let Some(contact) = &model.ball_contact {
            for (first, second) in crate::model::bearing::neighbours(motions.len()) {
                let of = |first: &_, second: &_| contact.evaluate(first, second, model.damping);
                if let Some(pair) = Tangents::of_balls(of, [&motions[first], &motions[second]]) {
                    self.add_pair([Side::Ball(first), Side::Ball(second)], &pair, (&axes, inertia));
                }
            }
        }
        let ambient = model.ambient(frame);
        if ambient.depends_on_motion() {
            for (k, motion) in motions.iter().enumerate() {
                let [place, rate] = first_ball(motion).map(|seeded| {
                    let wrench = ambient.on_ball(&seeded);
                    by_first(&wrench.force, &wrench.moment)
                });
                self.add([Side::Ball(k); 2], [place, rate], (&axes, inertia));
            }
        }
        self.add_travel(&axes, mean_orbital_speed(state));
        for (seat, (_, world)) in seats.iter().zip(&worlds) {
            self.add_seat(bearing, seat, world);
        }
    }

    /// Adds both sides of a pair.
    fn add_pair(
        &mut self,
        [first, second]: [Side<'_>; 2],
        pair: &Tangents,
        balls: (&[Matrix3<f64>], [f64; 2]),
    ) {
        let Tangents { place, rate } = pair;
        self.add([first, first], [place.on_first.first, rate.on_first.first], balls);
        self.add([first, second], [place.on_first.second, rate.on_first.second], balls);
        self.add([second, first], [place.on_second.first, rate.on_second.first], balls);
        self.add([second, second], [place.on_second.second, rate.on_second.second], balls);
    }

    /// Adds force and moment on one body by place and rate of a body.
    fn add(
        &mut self,
        [on, by]: [Side<'_>; 2],
        [place, rate]: [Matrix6<f64>; 2],
        (axes, [mass, inertia]): (&[Matrix3<f64>], [f64; 2]),
    ) {
        // Columns: of what they are, and the first of them.
        let columns: Vec<(usize, DMatrix<f64>)> = match by {
            Side::Given => return,
            Side::Body(world) => {
                let whole = |block: Map| DMatrix::from_fn(6, block.ncols(), |i, k| block[(i, k)]);
                vec![(0, whole(place * world)), (self.size, whole(rate * world))]
            }
            Side::Ball(k) => {
                let turned = |matrix: &Matrix6<f64>, from: usize| {
                    let block = matrix.fixed_columns::<3>(from) * axes[k];
                    DMatrix::from_fn(6, 3, |i, k| block[(i, k)])
                };
                let at = self.first + OF_BALL * k;
                // A ball has no orientation.
                vec![(at, turned(&place, 0)), (at + 3, turned(&rate, 0)), (at + 6, turned(&rate, 3))]
            }
        };
        for (from, block) in columns {
            let (row, rows) = match on {
                Side::Given => return,
                Side::Body(world) => (self.size, world.transpose() * block),
                Side::Ball(k) => {
                    let mut rows = DMatrix::zeros(6, block.ncols());
                    for (part, by) in [(0, mass), (3, inertia)] {
                        let own = axes[k].transpose() * block.fixed_rows::<3>(part) / by;
                        rows.fixed_rows_mut::<3>(part).copy_from(&own);
                    }
                    (self.first + OF_BALL * k + 3, rows)
                }
            };
            let mut view = self.matrix.view_mut((row, from), rows.shape());
            view += rows;
        }
    }

    /// Adds what the way of the balls around is to their rates: `u' = ... - (1/T) D u - W [x] u`.
    fn add_travel(&mut self, axes: &[Matrix3<f64>], orbital_speed: f64) {
        let count = axes.len();
        // x cross (axial, radial, along): radial goes to along, along to minus radial.
        let turn = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0) * orbital_speed;
        for k in 0..count {
            let at = self.first + OF_BALL * k;
            for part in 0..3 {
                let from = at + 3 * part;
                let mut own = self.matrix.view_mut((from, from), (3, 3));
                own -= turn;
                for other in 0..count {
                    let by = derivative(count, k as isize - other as isize) * orbital_speed;
                    let to = self.first + OF_BALL * other + 3 * part;
                    for i in 0..3 {
                        self.matrix[(from + i, to + i)] -= by;
                    }
                }
            }
            for i in 0..3 {
                self.matrix[(at + i, at + 3 + i)] += 1.0;
            }
        }
    }

    /// Adds what turns with a seated body, and the support that holds it.
    fn add_seat(&mut self, bearing: &Running<'_>, seat: &Seated, world: &Map) {
        let wrench = &bearing.state.bodies.get(seat.body).map(|body| body.bearing_wrench);
        let moment = wrench.map_or(Vector3::zeros(), |wrench| wrench.moment) + seat.applied;
        let (_, by_angles) = seat.motion.generalised(&moment);
        let angles = seat.map.fixed_rows::<3>(3);
        let turned = angles.tr_mul(&(by_angles * angles));
        let mut view = self.matrix.view_mut((self.size, 0), turned.shape());
        view += turned;
        let Body::Race(race) = seat.body else {
            return;
        };
        let (Some(support), Some(held)) = (&bearing.model.supports[race], &bearing.state.supports[race])
        else {
            return;
        };
        let flange = held.flange.orientation.to_rotation_matrix();
        let mut turn = Matrix6::zeros();
        turn.fixed_view_mut::<3, 3>(0, 0).copy_from(flange.matrix());
        turn.fixed_view_mut::<3, 3>(3, 3).copy_from(flange.matrix());
        for (from, matrix) in [0, self.size].into_iter().zip(support.matrices()) {
            let own = world.tr_mul(&(turn * matrix * turn.transpose() * world));
            let mut view = self.matrix.view_mut((self.size, from), own.shape());
            view -= own;
        }
    }
}

impl Seated {
    /// Motion of the body's origin and its rotation, world axes, by all coordinates.
    fn world(&self) -> Map {
        let mut world = self.map.clone();
        let turned = self.motion.columns() * self.map.fixed_rows::<3>(3);
        world.fixed_rows_mut::<3>(3).copy_from(&turned);
        world
    }
}

/// Axes of each ball as columns: axial, radial, along the orbit.
fn axes_of_balls(state: &State) -> Vec<Matrix3<f64>> {
    let centre = state.race(Race::Outer).pose.position;
    let of = |ball: &BallState| {
        let offset = ball.position - centre;
        let radial = Vector3::new(0.0, offset.y, offset.z).normalize();
        Matrix3::from_columns(&[Vector3::x(), radial, Vector3::x().cross(&radial)])
    };
    state.balls.iter().map(of).collect()
}

/// [rad/s] mean orbital speed of the balls.
fn mean_orbital_speed(state: &State) -> f64 {
    let outer = state.race(Race::Outer);
    state.balls.iter().map(|ball| ball.orbital_speed(outer)).sum::<f64>() / state.balls.len() as f64
}

/// [1/rad] derivative at a node of the trigonometric polynomial that is 1 at a node `apart` before it, and 0 at the others of `count` around a
/// circle (Trefethen 2000, chapter 3).
fn derivative(count: usize, apart: isize) -> f64 {
    if apart == 0 {
        return 0.0;
    }
    let half = std::f64::consts::PI * apart as f64 / count as f64;
    let sign = if apart % 2 == 0 { 0.5 } else { -0.5 };
    if count.is_multiple_of(2) { sign / half.tan() } else { sign / half.sin() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_derivatives_of_waves_around_a_circle() {
        for count in [3usize, 8, 9, 15] {
            for wave in 0..=(count - 1) / 2 {
                let at = |k: usize| std::f64::consts::TAU * (wave * k) as f64 / count as f64;
                for k in 0..count {
                    let found: f64 = (0..count)
                        .map(|other| derivative(count, k as isize - other as isize) * at(other).sin())
                        .sum();
                    assert!((found - wave as f64 * at(k).cos()).abs() < 1e-12, "{count} {wave} {k} {found}");
                }
            }
        }
    }
}
