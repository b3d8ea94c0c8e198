//! A roller in balance between two races, in its plane through the axis of the outer ring.
//!
//! Its motion in that plane is `q = (a, v, phi)`: along the axis, along the radius, and its tilt, by which a point further along the axis goes
//! outwards. That of the inner race as a body is `p`, likewise, about the same point; the outer race stands still. A contact has a normal from the
//! roller into the race. With the lever of that about the roller's centre it is a row `w`, and its approach
//!
//! ```text
//! d = w.q - gap           on the outer race
//! d = w.(q - p) - gap     on the inner race
//! V(q, p) = sum of c g 9/19 (d - drop)^(19/9) at the stations of both lines, and of k s(d) at the ribs, - F_c v
//! ```
//! with `Q = c d^(10/9)` of a line (ISO/TS 16281), shares `g` of its stations, and the drop of the profile there. All is convex in `q` and `p`
//! together: `V` has one minimum over `q`, and Newton's method with a line search cannot miss it. The force on the inner race is `-dV/dp`, its
//! stiffness that of both races in series, `H_i - H_i (H_i + H_o)^-1 H_i`. Without centrifugal force and ribs a roller is midway, `q = p/2`, at once.

use nalgebra::{Cholesky, Const, Matrix3, Vector3};

pub use super::line::Profile;
use super::line::{POWER, Stations, gauss, sums};
use super::one_sided::OneSided;
use crate::numerics::elementary::pow;

/// [N/mm^(10/9) mm^(8/9)] load of a roller of steel between two races over `l^(8/9) d^(10/9)` (ISO/TS 16281: 2008, 6.2); of one contact, whose
/// approach is a half, 2^(10/9) of that.
const LINE: f64 = 35948.0;
/// Stations along a line, those of Gauss: forces of a bearing are those of 400 to 1e-3, and to 4e-3 at a tilt of 10 mrad (`order_` in
/// `tests/equilibrium/rollers.rs`). As many laminae of one length are no better, and edges of partly loaded lines no point suits.
const STATIONS: usize = 16;
/// Iterations of one roller.
const MAX_ITERATIONS: u32 = 100;
/// [-] part of a line that carries where next to nothing presses it, a guess.
const FEW: f64 = 0.2;
/// \[m] longest step of a roller.
const LONGEST_STEP: f64 = 1e-5;
/// Trials along a step of Newton's method.
const MAX_TRIALS: u32 = 30;
/// [-] a trial this near to where the next contact comes in says nothing about that contact.
const NEAR: f64 = 0.9;
/// [-] unbalanced force over the loads at work up to which a search goes on from where the roller was.
const NEAR_BALANCE: f64 = 0.3;
/// [-] unbalanced force over the loads at work that is rounding.
const TOLERANCE: f64 = 1e-12;
/// [-] part of the expected fall of the potential that is enough, and part of the potential that is its rounding.
const ENOUGH: f64 = 1e-4;
const ROUNDED: f64 = 1e-13;
/// \[N] force that is nothing: ribs that just touch let go by halves.
const NOTHING: f64 = 1e-9;
/// [-] units in the last place of places that are rounding.
const ROUND_OFF_UNITS: f64 = 16.0;
/// [-] stiffness over the largest one that holds what nothing holds: a roller between ribs with play.
const NO_STIFFNESS: f64 = 1e-13;

/// The line along which a roller touches a race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// [-, -, m] normal into the race, axial and radial, and its lever in the middle of the line.
    pub normal: Vector3<f64>,
    /// [-] lever over the way along the line: 1 on the outer race, -1 on the inner one.
    pub side: f64,
    /// \[m] approach at which it begins to touch in the middle.
    pub gap: f64,
    /// [N/m^(10/9)] its stiffness.
    pub stiffness: f64,
}

/// A rib that an end of a roller touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rib {
    /// Race that it is on: 0 is the inner one.
    pub race: usize,
    /// [-, -, m] normal into the race, axial and radial, and its lever.
    pub normal: Vector3<f64>,
    /// \[m] approach at which it begins to touch.
    pub gap: f64,
    /// [N/m] its stiffness.
    pub stiffness: f64,
}

/// A kind of rollers between two races.
#[derive(Clone, Debug, PartialEq)]
pub struct Roller {
    /// Lines on the inner and the outer race.
    pub lines: [Line; 2],
    /// Ribs.
    pub ribs: Vec<Rib>,
    /// \[m] half of its effective length.
    half: f64,
    stations: Vec<Stations>,
}

/// A roller in balance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// \[m, m, rad] its motion.
    pub place: Vector3<f64>,
    /// \[N] loads of its lines on the inner and the outer race.
    pub loads: [f64; 2],
    /// \[N] largest force of a rib.
    pub rib: f64,
    /// \[N, N, N m] force and moment on the inner race.
    pub force: Vector3<f64>,
    /// Derivative of its motion by that of the inner race.
    pub follows: Matrix3<f64>,
    /// Derivative of the force by the motion of the inner race, with the opposite sign.
    pub stiffness: Matrix3<f64>,
    /// [-, -, m] derivative of the force by the centrifugal force.
    pub by_centrifugal: Vector3<f64>,
    /// \[J] potential.
    pub stored: f64,
    /// \[N] force that is left on it: 0 to rounding where the search came to its end.
    pub unbalanced: f64,
}

/// All contacts of a roller at a place.
#[derive(Clone, Copy)]
struct Contacts {
    loads: [f64; 2],
    rib: f64,
    /// Forces on the races, by motions along which they are.
    pressed: [Vector3<f64>; 2],
    stiffness: [Matrix3<f64>; 2],
    elastic: f64,
}

impl Roller {
    /// [N/m^(10/9)] stiffness of a line of a length \[m] on one race.
    pub fn line_stiffness(length: f64) -> f64 {
        LINE * pow(2.0 * 1e3, POWER) * pow(1e3 * length, 8.0 / 9.0)
    }

    /// Of a diameter and an effective length \[m], with a profile, as many stations as are asked for or the usual ones.
    pub fn new(
        lines: [Line; 2],
        ribs: Vec<Rib>,
        [diameter, length]: [f64; 2],
        profile: Profile,
        stations: Option<usize>,
    ) -> Self {
        let half = 0.5 * length;
        let station =
            |[at, weight]: [f64; 2]| [half * at, 0.5 * weight, profile.drop(half * at, diameter, length)];
        let stations: Vec<_> = gauss(stations.unwrap_or(STATIONS)).into_iter().map(station).collect();
        Self { lines, ribs, half, stations: Stations::all(&stations) }
    }

    fn at(&self, q: &Vector3<f64>, p: &Vector3<f64>) -> Contacts {
        let mut of = Contacts {
            loads: [0.0; 2],
            rib: 0.0,
            pressed: [Vector3::zeros(); 2],
            stiffness: [Matrix3::zeros(); 2],
            elastic: 0.0,
        };
        let moved = [q - p, *q];
        for (race, line) in self.lines.iter().enumerate() {
            let way = line.normal.dot(&moved[race]) - line.gap;
            let lean = line.side * moved[race].z;
            if way + (lean * self.half).abs() <= 0.0 {
                continue;
            }
            let [load, couple, k, bend, tilt, elastic] =
                sums(&self.stations, way, lean).map(|sum| line.stiffness * sum);
            let lever = Vector3::z() * line.side;
            let n = &line.normal;
            of.loads[race] = load;
            of.pressed[race] = n * load + lever * couple;
            let cross = n * lever.transpose() * bend;
            of.stiffness[race] =
                n * n.transpose() * k + cross + cross.transpose() + lever * lever.transpose() * tilt;
            of.elastic += elastic / (1.0 + POWER);
        }
        for rib in &self.ribs {
            let OneSided { way, slope, potential, .. } =
                OneSided::at(rib.normal.dot(&moved[rib.race]) - rib.gap);
            let load = rib.stiffness * way;
            of.rib = of.rib.max(load);
            of.pressed[rib.race] += rib.normal * load;
            of.stiffness[rib.race] += rib.normal * rib.normal.transpose() * (rib.stiffness * slope);
            of.elastic += rib.stiffness * potential;
        }
        of
    }

    /// The roller in balance with the inner race at `p` \[m, m, rad], under a centrifugal force \[N], sought from about where it is, if that is known.
    pub fn settle(&self, p: &Vector3<f64>, centrifugal: f64, about: Option<Vector3<f64>>) -> Settled {
        let outside = Vector3::y() * centrifugal;
        // Moments count by the force at its ends.
        let sized = |r: &Vector3<f64>| Vector3::new(r.x, r.y, r.z / self.half);
        let residual = |at: &Contacts| outside - at.pressed[0] - at.pressed[1];
        let weight = |at: &Contacts| at.loads[0] + at.loads[1] + at.rib + centrifugal;
        let near = about.map(|place| (place, self.at(&place, p)));
        let near = near.filter(|(_, at)| sized(&residual(at)).norm() <= NEAR_BALANCE * weight(at));
        let (mut place, mut here) = near.unwrap_or_else(|| self.start(p, centrifugal));
        let mut r = residual(&here);
        for _ in 0..MAX_ITERATIONS {
            let stiffness = here.stiffness[0] + here.stiffness[1];
            let size = weight(&here);
            let ways = place.x.abs() + place.y.abs() + (self.half * place.z).abs();
            let rounding = ROUND_OFF_UNITS * f64::EPSILON * self.largest(&stiffness) * ways;
            if sized(&r).norm() <= (TOLERANCE * size).max(rounding).max(NOTHING) {
                break;
            }
            // What nothing holds goes far, and nothing holds a roller off all contacts.
            let factors = self.factors(&stiffness);
            let whole = factors.map_or_else(|| r * (LONGEST_STEP / r.norm()), |factors| factors.solve(&r));
            let far = whole.x.abs().max(whole.y.abs()).max((self.half * whole.z).abs());
            let step = whole * (LONGEST_STEP / far.max(LONGEST_STEP));
            let mut part = 1.0;
            let mut moved = None;
            let down = r.dot(&step);
            // Most steps are taken whole: what comes in on the way is asked for after that.
            let mut on_the_way = None;
            let mut soft = true;
            for _ in 0..MAX_TRIALS {
                let trial = place + step * part;
                let there = self.at(&trial, p);
                let next = residual(&there);
                let change = there.elastic - here.elastic - outside.dot(&step) * part;
                // Where the potential changes by its rounding, the force says more.
                let rounded = change.abs() <= ROUNDED * (here.elastic + centrifugal * ways);
                let falls = change < -ENOUGH * part * down;
                if falls || rounded && sized(&next).norm_squared() < sized(&r).norm_squared() {
                    moved = Some((trial, there, next));
                    break;
                }
                let free = *on_the_way.get_or_insert_with(|| self.free_part(&place, p, &step));
                let left = down * (1.0 - free * step.norm() / whole.norm());
                let up = -next.dot(&step);
                part = if free < NEAR * part && left > 0.0 && up > 0.0 {
                    // What comes in there turns the slope round, softly or at once: both are tried in turn.
                    let share = left / (left + up);
                    let share = if soft { share.sqrt() } else { share };
                    soft = !soft;
                    free + (part - free) * share.min(0.5)
                } else {
                    0.5 * part
                };
            }
            // No descent is left to find: rounding.
            let Some(next) = moved else { break };
            (place, here, r) = next;
        }
        let [inner, outer] = &here.stiffness;
        let factors = self.factors(&(inner + outer));
        let follows = factors.map_or_else(Matrix3::zeros, |factors| factors.solve(inner));
        Settled {
            place,
            loads: here.loads,
            rib: here.rib,
            force: here.pressed[0],
            follows,
            stiffness: inner - inner * follows,
            by_centrifugal: follows.tr_mul(&Vector3::y()),
            stored: here.elastic - outside.dot(&place),
            unbalanced: sized(&r).norm(),
        }
    }

    /// Where a search begins that nothing is known for: midway, or where the inner race does not press, whichever is lower.
    fn start(&self, p: &Vector3<f64>, centrifugal: f64) -> (Vector3<f64>, Contacts) {
        let midway = p * 0.5;
        let here = self.at(&midway, p);
        if centrifugal > 0.0 || !self.ribs.is_empty() {
            let rest = self.at_rest(p, centrifugal);
            let there = self.at(&rest, p);
            if there.elastic - centrifugal * rest.y < here.elastic - centrifugal * midway.y {
                return (rest, there);
            }
        }
        (midway, here)
    }

    /// \[m, m, rad] about where a roller is that the inner race does not press: tilted by as much as lets go of ribs, on the outer race if it is pressed there.
    fn at_rest(&self, p: &Vector3<f64>, centrifugal: f64) -> Vector3<f64> {
        let mut rest = p * 0.5;
        rest.z = 0.0;
        for rib in &self.ribs {
            // Both ends alike, as the roller is midway along the axis.
            let moved = if rib.race == 0 { rest - p } else { rest };
            let way = rib.normal.dot(&moved) - rib.gap;
            if way > 0.0 {
                rest.z -= way / rib.normal.z;
            }
        }
        if centrifugal <= 0.0 {
            return rest;
        }
        let outer = &self.lines[1];
        let along = outer.normal.x * rest.x;
        let touches = Stations::each(&self.stations)
            .map(|[place, drop]| outer.gap + drop - along - outer.side * rest.z * place);
        let first = touches.fold(f64::INFINITY, f64::min);
        rest.y = (first + pow(centrifugal / (FEW * outer.stiffness), 1.0 / POWER)) / outer.normal.y;
        rest
    }

    /// [-] part of a step on which nothing touches that did not before: so far its fall is the expected one.
    fn free_part(&self, q: &Vector3<f64>, p: &Vector3<f64>, step: &Vector3<f64>) -> f64 {
        let moved = [q - p, *q];
        let mut free: f64 = 1.0;
        let mut comes_in = |gap: f64, way: f64| {
            if gap > 0.0 && gap < free * way {
                free = gap / way;
            }
        };
        for (race, line) in self.lines.iter().enumerate() {
            let (gap, way) = (line.gap - line.normal.dot(&moved[race]), line.normal.dot(step));
            for [place, drop] in Stations::each(&self.stations) {
                let lever = line.side * place;
                comes_in(gap + drop - lever * moved[race].z, way + lever * step.z);
            }
        }
        for rib in &self.ribs {
            comes_in(rib.gap - rib.normal.dot(&moved[rib.race]), rib.normal.dot(step));
        }
        free
    }

    /// [N/m] largest stiffness of all motions, tilts by the way of the ends.
    fn largest(&self, stiffness: &Matrix3<f64>) -> f64 {
        let of_tilt = stiffness[(2, 2)] / (self.half * self.half);
        stiffness[(0, 0)].max(stiffness[(1, 1)]).max(of_tilt)
    }

    /// Factors of a stiffness, which next to nothing is added to; none where there is none.
    fn factors(&self, stiffness: &Matrix3<f64>) -> Option<Cholesky<f64, Const<3>>> {
        let least = NO_STIFFNESS * self.largest(stiffness);
        let scale = Vector3::new(1.0, 1.0, self.half * self.half);
        let held = stiffness + Matrix3::from_diagonal(&(scale * least));
        held.cholesky()
    }

    /// \[m] approaches of a roller at a place \[m] along both lines, by the motions of it and the inner race; 0 where it does not touch.
    pub fn approaches(&self, [q, p]: [&Vector3<f64>; 2], place: f64, drop: f64) -> [f64; 2] {
        let moved = [q - p, *q];
        [0, 1].map(|race: usize| {
            let line = &self.lines[race];
            let way = line.normal.dot(&moved[race]) - line.gap + line.side * moved[race].z * place;
            (way - drop).max(0.0)
        })
    }
}
