//! Quasi-static equilibrium of the bearing: any mix of imposed loads and displacements of one race, the inner one but where
//! the outer race is under a wrench; the other race rests.
//!
//! Exact torus geometry at any tilt, exact Hertz, centrifugal force and gyroscopic moment of the balls after Jones
//! (1960) and Harris. All balls orbit with one cage speed, the mean of the speeds that each would take by itself,
//! weighted by the inner loads. Unknowns are the free displacements and the cage speed; balls are eliminated.

mod ball;
mod guess;
mod least_heat;
mod light_ball;
mod problem;
mod report;
mod trial;

use nalgebra::{SMatrix, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::effects::growth::Warmth;
use crate::effects::moving_frame::FrameMotion;
use crate::effects::reports::GrowthOutput;
use crate::effects::reports::LifeOutput;
use crate::effects::reports::Rises;
use crate::model::bearing::BeyondShoulder;
use crate::model::bodies::{PerRace, Race};
use crate::model::{Conditions, Model};
use crate::numerics::motion::Pose;
use crate::scene::{Condition, Scene};
use problem::{Found, Problem, Progress};
pub use report::BallReport;

/// [-] largest approach over ball diameter of an answer; steel yields at a tenth of that.
pub const MAX_APPROACH: f64 = 0.02;

/// How the gyroscopic moment of the balls is carried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gyroscopic {
    /// By friction at the outer race alone (Jones's outer race control), whatever it takes.
    OuterRaceControl,
    /// By friction at the inner race alone, on which balls do not spin then, whatever it takes.
    InnerRaceControl,
    /// By friction at the race where spin would cost more, for each ball: it spins on the other one (least heat; Harris's criterion of race
    /// control).
    LeastHeat,
    /// Ignored.
    None,
    /// By friction at both races in proportion to their loads, at most the friction limit: beyond, the ball pivots.
    Friction,
}

/// Load or displacement imposed in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prescribed {
    /// External force \[N] or moment [N m] on the race, world axes, about its own origin.
    Load(f64),
    /// Displacement \[m] or rotation vector component \[rad] of the race.
    Motion(f64),
}

/// A quasi-static problem.
#[derive(Clone, Debug)]
pub struct EquilibriumInput {
    /// The race that moves until it is in balance.
    pub race: Race,
    /// Its conditions, in the order x, y, z, ry, rz, in the bearing frame.
    pub conditions: [Prescribed; 5],
    /// [rad/s] spin of the inner race.
    pub inner_speed: f64,
    /// [rad/s] spin of the outer race.
    pub outer_speed: f64,
    /// [rad/s] speed at which the radial load turns about x, which the rating life depends on.
    pub load_speed: f64,
    /// Pose of the other race in the bearing frame, without its turn about its own axis; an outer race rests at the origin.
    pub resting: Pose,
    /// \[rad] how far each race has turned about its own axis.
    pub turned: PerRace<f64>,
    /// How the gyroscopic moment is carried.
    pub gyroscopic: Gyroscopic,
    /// Race on which each ball does not spin, for [`Gyroscopic::LeastHeat`], which finds them where there are none.
    pub controls: Vec<Race>,
    /// [-] friction coefficient, for [`Gyroscopic::Friction`].
    pub friction: f64,
    /// [-] degree of lubrication, for the same.
    pub lubrication: f64,
    /// \[K] rises of temperature; not used where growth is not simulated.
    pub rises: Rises,
    /// Motion of the frame that all of this is seen from, and gravity in it.
    pub frame: FrameMotion,
    /// \[m] where the bearing frame is in that frame.
    pub origin: Vector3<f64>,
    /// Pose in the bearing frame of the flange that the race which moves rests on by its flexible support; without one, that race
    /// is moved by its conditions alone.
    pub flange: Option<Pose>,
}

impl EquilibriumInput {
    /// Race on which a ball (0 is the first) does not spin.
    fn control(&self, ball: usize) -> Race {
        match self.gyroscopic {
            Gyroscopic::InnerRaceControl => Race::Inner,
            Gyroscopic::LeastHeat => self.controls.get(ball).copied().unwrap_or(Race::Outer),
            Gyroscopic::OuterRaceControl | Gyroscopic::None | Gyroscopic::Friction => Race::Outer,
        }
    }

    /// Conditions of every contact, without friction.
    pub fn surroundings(&self) -> Conditions {
        // Rings grow by what they turn in all.
        let spins = [self.inner_speed, self.outer_speed].map(|speed| speed + self.frame.angular_velocity.x);
        let warmth = Warmth { rises: self.rises, spins };
        Conditions { friction: 0.0, warmth, lubrication: 0.0 }
    }

    /// Conditions with friction, dry or oiled.
    pub fn with_friction(&self) -> Conditions {
        Conditions { friction: self.friction, lubrication: self.lubrication, ..self.surroundings() }
    }

    /// The problem of a scene at time 0.
    pub fn from_scene(scene: &Scene, gyroscopic: Gyroscopic) -> Self {
        Self::at(scene, gyroscopic, 0.0)
    }

    /// The problem of a scene at a time \[s] of its script.
    pub fn at(scene: &Scene, gyroscopic: Gyroscopic, time: f64) -> Self {
        let race = Race::loaded(scene);
        let (position, tilt) = match race {
            Race::Inner => {
                let misalignment = &scene.outer.misalignment;
                (Vector3::zeros(), [misalignment.ry.at(time), misalignment.rz.at(time)])
            }
            // A direction that nothing is given for is held at 0.
            Race::Outer => {
                let [x, y, z, ry, rz] = Race::Inner
                    .directions(scene)
                    .map(|direction| direction.motion.map_or(0.0, |motion| motion.at(time)));
                (Vector3::new(x, y, z), [ry, rz])
            }
        };
        let orientation = UnitQuaternion::new(Vector3::new(0.0, tilt[0], tilt[1]));
        let loads = race.load_at(scene, time);
        Self {
            race,
            conditions: std::array::from_fn(|i| match race.directions(scene)[i].condition() {
                Condition::Load(_) => Prescribed::Load(loads[i]),
                Condition::Motion(schedule) => Prescribed::Motion(schedule.at(time)),
            }),
            inner_speed: scene.load.inner_speed.at(time),
            outer_speed: scene.load.outer_speed.at(time),
            load_speed: load_speed(race, scene, time),
            resting: Pose { position, orientation },
            turned: PerRace::default(),
            gyroscopic,
            controls: vec![],
            friction: scene.friction.ball_race.at(time),
            lubrication: scene.effects.film.lubrication(time),
            rises: scene.effects.growth.rises(time).unwrap_or_default(),
            frame: scene.frame_at(time),
            origin: Vector3::zeros(),
            flange: None,
        }
    }
}

/// [rad/s] speed at which the radial load of a scene turns about x at a time \[s].
fn load_speed(race: Race, scene: &Scene, time: f64) -> f64 {
    // Short against a turn, long against the last digit of an angle.
    const SOON: f64 = 1e-6;
    let [[_, y0, z0, ..], [_, y1, z1, ..]] = [time, time + SOON].map(|time| race.load_at(scene, time));
    (y0 * z1 - z0 * y1).atan2(y0 * y1 + z0 * z1) / SOON
}

/// Why there is no solution.
#[derive(Clone, Debug, Error)]
pub enum EquilibriumError {
    /// A ball finds no balance.
    #[error("ball {ball} finds no balance at race displacement {displacement:?} [m, rad]")]
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
        /// \[m] approach.
        approach: f64,
        /// \[N] load.
        load: f64,
        /// [-] largest approach over ball diameter.
        limit: f64,
    },
    /// A contact lies where no groove is.
    #[error(
        "ball {ball} would touch the {race} race with {load:.3e} N at a contact angle of {angle:.3} rad: beyond {limit:.3} rad \
         there is no groove; {}",
        why_left(*load, *most)
    )]
    LeftGroove {
        /// Ball, counted from 1.
        ball: usize,
        /// Inner or outer.
        race: &'static str,
        /// \[N] load on the contact.
        load: f64,
        /// \[N] largest load of any contact of the bearing.
        most: f64,
        /// \[rad] contact angle.
        angle: f64,
        /// \[rad] contact angle that the groove ends at on this side.
        limit: f64,
    },
    /// A contact lies beyond the shoulder of its race.
    #[error("in equilibrium {0}")]
    BeyondShoulder(#[from] BeyondShoulder),
    /// A wave of a race that no contact can follow.
    #[error(
        "form.{race}: its shortest wave, of order {order}, is shorter than the contact of ball {ball}, whose half width is seen \
         from the axis under {span:.2e} rad: allowed are orders to {longest:.0}; take shorter waves out, as the contact does"
    )]
    ShortWave {
        /// Inner or outer.
        race: &'static str,
        /// [-] order.
        order: f64,
        /// Ball, counted from 1.
        ball: usize,
        /// \[rad] half width of its contact over the radius of the race.
        span: f64,
        /// [-] largest order that is allowed.
        longest: f64,
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
        /// \[N] its load on the outer race.
        load: f64,
        /// [-] friction coefficient that would hold it.
        friction: f64,
    },
    /// The displacements do not converge.
    #[error(
        "the equilibrium does not converge: residual {residual:.3e} of the load in direction {direction} after \
         {iterations} iterations, at race displacement {displacement:?} [m, rad] (is the bearing held in \
         every direction?)"
    )]
    NoConvergence {
        /// [-] residual over the load's size.
        residual: f64,
        /// Direction with the largest component of the residual.
        direction: &'static str,
        /// Iterations spent.
        iterations: u32,
        /// [m, rad] displacement reached.
        displacement: [f64; 5],
    },
}

/// [-] load over the largest one below which a ball counts as unloaded in what is said of it.
const UNLOADED: f64 = 1e-3;

/// Why a ball leaves its groove: one with next to no load stands where the race goes away from it.
fn why_left(load: f64, most: f64) -> &'static str {
    if load < UNLOADED * most {
        "the load moves this race away from a ball that carries next to nothing; more axial load or preload holds that ball in its \
         groove, or less radial load"
    } else {
        "the load, the displacement or the tilt is too large"
    }
}

impl EquilibriumError {
    /// Is it a limit of the bearing, and not just where the search ended?
    fn is_physical(&self) -> bool {
        !matches!(self, Self::Ball { .. } | Self::NoConvergence { .. })
    }
}

/// One ball in equilibrium, relative to the outer race.
#[derive(Clone, Debug, PartialEq)]
pub struct BallEquilibrium {
    /// \[rad] azimuth.
    pub azimuth: f64,
    /// \[m] centre, in the outer race's frame.
    pub position: Vector3<f64>,
    /// [m/s] velocity of the centre, same frame.
    pub velocity: Vector3<f64>,
    /// [rad/s] angular velocity of rolling, same frame.
    pub angular_velocity: Vector3<f64>,
    /// Reported quantities.
    pub report: BallReport,
}

/// A quasi-static solution.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// The race that moved: displacement, load and stiffness are of it.
    pub race: Race,
    /// [m, rad] displacement x, y, z and rotation vector ry, rz of the race in the bearing frame.
    pub displacement: [f64; 5],
    /// [N, N m] external load that holds the race, in world axes about its own origin: Fx, Fy, Fz, My, Mz.
    pub load: [f64; 5],
    /// Derivative of the external load by the displacement, cage speed following.
    pub stiffness: SMatrix<f64, 5, 5>,
    /// [N/m] negative stiffness of the free directions, angles times the size of the race, where the balance is unstable and no stable
    /// one was found beside it: the smallest blow ends it.
    pub unstable: Option<f64>,
    /// [rad/s] cage speed.
    pub cage_speed: f64,
    /// [-] largest residual over the size of the forces.
    pub residual: f64,
    /// Iterations on the displacements, after a guess.
    pub iterations: u32,
    /// The bearing as it has grown, where growth is simulated.
    pub growth: Option<GrowthOutput>,
    /// Rating life under these loads, where it is asked for.
    pub life: Option<LifeOutput>,
    /// Balls.
    pub balls: Vec<BallEquilibrium>,
}

/// Solves a quasi-static problem.
///
/// Newton's method from a guess; where that leads nowhere, as [`solve_without_guess`]. From an unstable balance it goes on to a stable
/// one beside it, if there is one; if not, [`Equilibrium::unstable`] says so.
///
/// # Errors
/// See [`EquilibriumError`]; an unconverged result is never returned.
pub fn solve(model: &Model, input: &EquilibriumInput) -> Result<Equilibrium, EquilibriumError> {
    if input.gyroscopic == Gyroscopic::LeastHeat && input.controls.is_empty() {
        return least_heat::solve_by_least_heat(model, input);
    }
    let problem = Problem::new(model, input);
    from_guess(&problem).map_or_else(|| from_centre(&problem), Ok)
}

/// Solves a quasi-static problem from the plain start, the centred race: the same in more time.
///
/// Newton's method from the centred race for a falling residual, then for a falling potential; then from the bearing at
/// rest through growing speeds; last from a race that its loads have pushed off the centre.
///
/// # Errors
/// As [`solve`].
pub fn solve_without_guess(model: &Model, input: &EquilibriumInput) -> Result<Equilibrium, EquilibriumError> {
    from_centre(&Problem::new(model, input))
}

/// The solution that a guess leads to, if it does.
fn from_guess(problem: &Problem<'_>) -> Option<Equilibrium> {
    let guess = guess::guess(problem)?;
    let found = problem.search(guess.unknowns, Some(&guess.trial.places), Progress::Residual).ok()?;
    problem.check(problem.finish(&problem.off_the_top(found))).ok()
}

fn from_centre(problem: &Problem<'_>) -> Result<Equilibrium, EquilibriumError> {
    let Problem { model, input, .. } = *problem;
    let downhill = |start| problem.search(start, None, Progress::Work);
    let mut failure = match problem.search(problem.centred(), None, Progress::Residual) {
        Ok(found) => return problem.check(problem.finish(&problem.off_the_top(found))),
        Err(why) => why,
    };
    let further: [&dyn Fn() -> Result<Found, EquilibriumError>; 3] =
        [&|| downhill(problem.centred()), &|| through_speeds(model, input), &|| downhill(problem.pushed())];
    for attempt in further {
        match attempt() {
            Ok(found) => return problem.check(problem.finish(&problem.off_the_top(found))),
            Err(why) if !failure.is_physical() => failure = why,
            Err(_) => {}
        }
    }
    Err(beyond_outer_race_control(model, input).unwrap_or(failure))
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
    let at = |fraction: f64| EquilibriumInput {
        inner_speed: fraction * input.inner_speed,
        outer_speed: fraction * input.outer_speed,
        ..input.clone()
    };
    let resting = at(0.0);
    let problem = Problem::new(model, &resting);
    let mut found = problem.search(problem.centred(), None, Progress::Work)?;
    let (mut fraction, mut increment) = (0.0, 0.25);
    while fraction < 1.0 {
        let next = f64::min(fraction + increment, 1.0);
        let slower = at(next);
        let problem = Problem::new(model, &slower);
        let mut start = found.unknowns;
        start[5] = if fraction > 0.0 { start[5] * next / fraction } else { problem.centred()[5] };
        match problem.search(start, Some(&found.trial.places), Progress::Residual) {
            Ok(further) => {
                found = further;
                fraction = next;
                increment *= 2.0;
            }
            Err(_) if increment > SMALLEST_INCREMENT => increment *= 0.25,
            Err(why) => return Err(why),
        }
    }
    Ok(found)
}
