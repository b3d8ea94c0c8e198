//! Small motions of a bearing about where it is: which grow, which decay, and what moves in them.

use nalgebra::{Complex, DMatrix, DVector, Vector3};

use super::Simulation;
use crate::analysis::small_motions::{Mover, Running, Seated, SmallMotion, SmallMotions};
use crate::dynamics::carried::SeatMotion;
use crate::effects::moving_frame::MovingFrame;
use crate::model::bodies::{Body, Constraint, RigidBody};
use crate::model::state::BodyState;
use crate::model::structure::{Lump, Map, Spin, Turning, frame_matrices};
use crate::numerics::tilt;

/// [-] of the kinetic energy of a body: less is not named.
const NAMED: f64 = 0.2;
/// [-] of a motion across the axis: less whirl goes to and fro.
const WHIRLS: f64 = 0.5;
/// [-] share of the balls in the kinetic energy from which on a motion is one of balls.
const OF_BALLS: f64 = 0.95;
/// [-] share of bodies in the kinetic energy below which a motion is one of balls alone.
const BODIES: f64 = 1e-3;
/// [-] damping over critical damping, or growth, beyond which a motion hardly swings: so do contacts that are open most of the time, as of a
/// cage that rattles, and what they do where they just touch lasts no longer than that.
const HARDLY: f64 = 0.3;
/// [1/s] growth from which on a motion of bodies is said to grow, and one of balls: nothing holds these along their orbits, and a state
/// that is not quite steady shows there as growth or decay of some 1/s.
const GROWS: [f64; 2] = [1.0, 30.0];

/// [-] lengths of a contact that are rolled over in a period: below that it is no creep of steady rolling that acts, which growth comes from
/// here, but a contact that sticks, and that growth is none. The gearbox of examples/gearbox at 175 rpm, whose output bearings roll at 3 mm/s,
/// has an eigenvalue of +73 1/s at 1490 Hz; in its run that decays by 46 1/s.
const ROLLED_OVER: f64 = 1.0;

/// A motion of a bearing, or of a shaft with its bearings, that grows or decays.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// \[Hz] frequency; 0 where it does not swing.
    pub frequency: f64,
    /// [1/s] growth; negative where it decays.
    pub growth: f64,
    /// [-] share of the balls in its kinetic energy, but for that of their spins.
    pub balls: f64,
    /// [-] lengths of its contacts that the bearing which moves most rolls over in a period.
    pub rolled_over: f64,
    /// Moving parts, in words.
    pub shape: String,
}

impl Motion {
    /// [-] damping over critical damping; negative where it grows.
    pub fn damping(&self) -> f64 {
        -self.growth / self.growth.hypot(std::f64::consts::TAU * self.frequency)
    }

    /// Does it grow?
    pub fn grows(&self) -> bool {
        self.rolled_over > ROLLED_OVER && self.growth > GROWS[usize::from(self.balls > OF_BALLS)]
    }
}

/// Is an eigenvalue that of a motion that swings: not of one that creeps back, nor grows at once?
pub(super) fn swings(value: Complex<f64>) -> bool {
    value.im > 0.0 && value.re.abs() < HARDLY * value.norm()
}

/// Motions of bodies among those that swing, by their frequency. What balls do alone, each for itself, is left out. `moves_most` is
/// [`Simulation::rolls_over`] of the bearing that moves most.
pub(super) fn worth_telling(
    found: &[SmallMotion],
    name: impl Fn(&SmallMotion) -> String,
    moves_most: impl Fn(&SmallMotion) -> Option<f64>,
) -> Vec<Motion> {
    let described = |motion: &SmallMotion| Motion {
        frequency: motion.frequency(),
        growth: motion.growth(),
        balls: motion.balls,
        rolled_over: moves_most(motion).map_or(f64::INFINITY, |rolls| rolls / motion.frequency()),
        shape: name(motion),
    };
    let is_listed = |motion: &Motion| motion.balls < OF_BALLS || motion.grows();
    let with_bodies = found.iter().filter(|motion| motion.balls < 1.0 - BODIES).map(described);
    let mut motions: Vec<Motion> = with_bodies.filter(is_listed).collect();
    motions.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    motions
}

/// Coordinates of a body that forces move, among place (0 to 2), turn (3) and tilts (4, 5).
pub(super) fn free(body: &RigidBody) -> Vec<usize> {
    let held = |constraint: &Constraint| match constraint {
        Constraint::Position(axis, _) => *axis,
        Constraint::Spin => 3,
        Constraint::Tilt(about, _) => 3 + about,
    };
    let held: Vec<usize> = body.constraints.iter().map(held).collect();
    (0..6).filter(|coordinate| !held.contains(coordinate)).collect()
}

/// The equations of a rigid body in its free coordinates. Its moments of inertia across the axis count as their mean: their difference
/// turns with it.
fn mover(body: &RigidBody, spin: f64) -> Mover {
    let across = 0.5 * (body.inertia.y + body.inertia.z);
    let own = [body.mass, body.mass, body.mass, body.inertia.x, across, across];
    let free = free(body);
    let of = |entry: &dyn Fn(usize, usize) -> f64| {
        DMatrix::from_fn(free.len(), free.len(), |i, k| entry(free[i], free[k]))
    };
    let gyroscopic = |i: usize, k: usize| match (i, k) {
        (4, 5) => spin * body.inertia.x,
        (5, 4) => -spin * body.inertia.x,
        _ => 0.0,
    };
    Mover {
        mass: of(&|i, k| if i == k { own[i] } else { 0.0 }),
        damping: of(&gyroscopic),
        stiffness: DMatrix::zeros(free.len(), free.len()),
    }
}

/// Where a rigid body is by `size` coordinates, of which its own begin at `first`.
pub(super) fn seated(
    (body, moved): (Body, &RigidBody),
    state: &BodyState,
    applied: Vector3<f64>,
    (first, size): (usize, usize),
) -> Seated {
    let mut map = Map::zeros(size);
    for (k, row) in free(moved).into_iter().enumerate() {
        map[(row, first + k)] = 1.0;
    }
    let motion = SeatMotion {
        position: state.pose.position,
        velocity: state.velocity,
        acceleration: Vector3::zeros(),
        angles: tilt::coordinates(&state.pose.orientation),
        rates: Vector3::x() * state.rate.x,
    };
    Seated { body, map, motion, applied }
}

impl Simulation {
    /// Bodies that forces move, and their states; none that a structure carries.
    pub(super) fn moving_bodies(&self) -> impl Iterator<Item = (Body, &RigidBody, &BodyState)> {
        let bodies = self.model.bodies.iter().zip(self.state.bodies.iter());
        bodies.filter_map(|((body, moved), (_, state))| {
            let moved = moved.as_ref()?;
            (!moved.carried && !free(moved).is_empty()).then_some((body, moved, state))
        })
    }

    /// Do forces move none of its bodies?
    pub fn is_held(&self) -> bool {
        self.moving_bodies().next().is_none()
    }

    /// [N m] moment that is applied to a body from outside.
    pub(super) fn applied_moment(&self, body: Body) -> Vector3<f64> {
        match body {
            Body::Race(race) => self.inputs[race].applied.moment,
            Body::Cage => Vector3::zeros(),
        }
    }

    /// The bearing as linear equations have it.
    pub(super) fn running(&self, seats: Vec<Seated>) -> Running<'_> {
        Running {
            model: &self.model,
            state: &self.state,
            conditions: self.conditions(),
            frame: self.inputs.effects.frame.motion,
            seats,
        }
    }

    /// The equations of one of its bodies in a state, in a frame that may turn.
    pub(super) fn mover(&self, moved: &RigidBody, state: &BodyState) -> Mover {
        let mut own = mover(moved, state.rate.x);
        let in_frame = |frame: MovingFrame| {
            let free = free(moved);
            let mut map = Map::zeros(free.len());
            free.iter().enumerate().for_each(|(k, row)| map[(*row, k)] = 1.0);
            let across = 0.5 * (moved.inertia.y + moved.inertia.z);
            let inertia = Vector3::new(moved.inertia.x, across, across);
            let lump = Lump { place: state.pose.position, mass: moved.mass, inertia, map };
            let still = DVector::zeros(free.len());
            let turn = Spin { speed: state.rate.x, ..Spin::default() };
            frame_matrices(&[lump], &frame, [&still, &still], (Turning::Given, &turn))
        };
        own.add(self.model.ambient(&self.inputs.effects.frame.motion).frame.map(in_frame));
        own
    }

    /// Motions of rings and cage about the present state that swing, by their frequency; in a frame that moves, as they are seen from it.
    /// None where eigenvalues are not found.
    pub fn motions(&self) -> Option<Vec<Motion>> {
        let bodies: Vec<_> = self.moving_bodies().collect();
        if self.is_held() {
            return Some(vec![]);
        }
        let size = bodies.iter().map(|(_, moved, _)| free(moved).len()).sum();
        let mut first = 0;
        let (mut movers, mut seats) = (vec![], vec![]);
        for (body, moved, state) in &bodies {
            movers.push(self.mover(moved, state));
            seats.push(seated((*body, moved), state, self.applied_moment(*body), (first, size)));
            first += free(moved).len();
        }
        let motions = SmallMotions::new(&movers, &[self.running(seats)]).motions(swings)?;
        let name = |motion: &SmallMotion| {
            let mut first = 0;
            let parts = bodies.iter().map(|(body, moved, state)| {
                let own = free(moved);
                let shape = motion.shape.rows(first, own.len()).into_owned();
                first += own.len();
                Part::new(*body, moved, state.rate.x, (&own, &shape))
            });
            named(&parts.collect::<Vec<_>>())
        };
        Some(worth_telling(&motions, name, |_| self.rolls_over()))
    }

    /// [1/s] lengths of its longest contact that it rolls over in a second; none where nothing is pressed.
    pub(super) fn rolls_over(&self) -> Option<f64> {
        let contacts = self.outputs().balls.iter().flat_map(|ball| [&ball.inner, &ball.outer]);
        let longest = contacts.map(|contact| 2.0 * contact.semi_axis_rolling).fold(0.0, f64::max);
        (longest > 0.0).then(|| self.outputs().rolling_speed.abs() / longest)
    }
}

/// Motion of a body.
pub(super) struct Part {
    name: String,
    /// Kinetic energy along the axis, across it, about it, and of tilts, over that of a unit amplitude of the rates.
    energies: [f64; 4],
    /// [-] how round a motion across the axis and one of tilts goes: 1 forwards, -1 backwards.
    turns: [f64; 2],
}

impl Part {
    /// From the amplitudes of its free coordinates.
    pub fn new(
        body: Body,
        moved: &RigidBody,
        spin: f64,
        (free, shape): (&[usize], &DVector<Complex<f64>>),
    ) -> Self {
        let amplitude = |coordinate: usize| {
            let at = free.iter().position(|own| *own == coordinate);
            at.map_or(Complex::from(0.0), |at| shape[at])
        };
        let square = |coordinate: usize| amplitude(coordinate).norm_sqr();
        let across = 0.5 * (moved.inertia.y + moved.inertia.z);
        // From y to z is forwards for a body that turns about +x.
        let round = |y: Complex<f64>, z: Complex<f64>| {
            -2.0 * (y.conj() * z).im / (y.norm_sqr() + z.norm_sqr()).max(f64::MIN_POSITIVE)
                * if spin < 0.0 { -1.0 } else { 1.0 }
        };
        Self {
            name: match body {
                Body::Race(race) => format!("{} ring", race.name()),
                Body::Cage => "cage".into(),
            },
            energies: [
                moved.mass * square(0),
                moved.mass * (square(1) + square(2)),
                moved.inertia.x * square(3),
                across * (square(4) + square(5)),
            ],
            // The axis goes to (tilt about z, minus tilt about y).
            turns: [round(amplitude(1), amplitude(2)), round(amplitude(5), -amplitude(4))],
        }
    }

    /// Body of a bearing with a name.
    pub fn of(self, bearing: &str) -> Self {
        Self { name: format!("{} of {bearing}", self.name), ..self }
    }

    /// Kinetic energy, as of [`Part::energies`].
    pub fn energy(&self) -> f64 {
        self.energies.iter().sum()
    }

    /// Description of its motion, where that is a part of the kinetic energy of all.
    fn describe(&self, all: f64) -> Option<String> {
        let [along, across, about, tilt] = self.energies.map(|energy| energy > NAMED * all);
        let turn = |turn: f64| match turn {
            turn if turn > WHIRLS => " forward",
            turn if turn < -WHIRLS => " backward",
            _ => " to and fro",
        };
        let mut phrases = vec![];
        match (tilt, across) {
            (true, true) if turn(self.turns[0]) == turn(self.turns[1]) => {
                phrases.push(format!("tilts and shifts{}", turn(self.turns[0])));
            }
            _ => {
                phrases.extend(tilt.then(|| format!("tilts{}", turn(self.turns[1]))));
                phrases.extend(across.then(|| format!("shifts{}", turn(self.turns[0]))));
            }
        }
        phrases.extend(along.then(|| "shifts along its axis".to_string()));
        phrases.extend(about.then(|| "turns".to_string()));
        (!phrases.is_empty()).then(|| format!("{} {}", self.name, phrases.join(", ")))
    }
}

/// A motion in words.
pub(super) fn named(parts: &[Part]) -> String {
    let all: f64 = parts.iter().map(Part::energy).sum();
    let descriptions: Vec<String> = parts.iter().filter_map(|part| part.describe(all)).collect();
    descriptions.join("; ")
}
