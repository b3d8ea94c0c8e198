//! Parts of the machine that load a race: the entries `[[load.rotating]]` and `[[load.gear]]`. Their mechanics is in
//! [`crate::loads`].

use std::f64::consts::TAU;

use serde::Deserialize;

use super::error::SceneError;
use super::numbers::Range;
use super::schedule::some_schedule;
use super::schedule::{self, Schedule};
use super::units::{Angle, AngularVelocity, Force, Length, Moment, Unbalance};
use crate::loads::{Mesh, Ripple, radial_force, unbalance};
use crate::numerics::motion::Wrench;

/// \[N] largest force, as of all loads of a scene.
const FORCE: Range = Range::closed(-1e9, 1e9, "N");
const MOMENT: Range = Range::closed(-1e8, 1e8, "N m");
const SPEED: Range = Range::closed(-1e5, 1e5, "rad/s");
const UNBALANCE: Range = Range::closed(0.0, 1e3, "kg m");
const ANGLE: Range = Range::closed(-7.0, 7.0, "rad");
const PRESSURE_ANGLE: Range = Range::closed(0.0, 1.2, "rad");
const HELIX_ANGLE: Range = Range::closed(-1.2, 1.2, "rad");
const OFFSET: Range = Range::closed(-10.0, 10.0, "m");
const RADIUS: Range = Range::closed(1e-4, 10.0, "m");
const TEETH: Range = Range::closed(1.0, 1e4, "");
const RIPPLE: Range = Range::closed(0.0, 1.0, "");

/// A force that turns with the shaft: an unbalance, or a force of a given size; an entry `[[load.rotating]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotatingSection {
    /// [kg m] mass times its distance from the axis: its force follows the speed. Exactly one of this and `force` is given.
    pub unbalance: Option<Unbalance>,
    /// \[N] size of the force.
    #[serde(default, deserialize_with = "some_schedule::<Force, _>")]
    pub force: Option<Schedule>,
    /// [rad/s] speed at which it turns; that of the loaded race in the scene if not given.
    #[serde(default, deserialize_with = "some_schedule::<AngularVelocity, _>")]
    pub speed: Option<Schedule>,
    /// \[rad] its azimuth at time 0, from +y towards +z.
    #[serde(default = "no_angle")]
    pub phase: Angle,
    /// \[m] place of its plane along x, from the middle of the bearing.
    #[serde(default = "no_length")]
    pub offset: Length,
}

/// The mesh of a helical gear on the shaft: three forces at the pitch point; an entry `[[load.gear]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GearSection {
    /// [N m] torque about +x that the mesh exerts on the shaft; a gear that drives another one is held back: against its speed.
    #[serde(deserialize_with = "schedule::deserialize::<Moment, _>")]
    pub torque: Schedule,
    /// \[m] radius of the pitch point.
    pub pitch_radius: Length,
    /// \[rad] pressure angle in the normal section.
    pub pressure_angle: Angle,
    /// \[rad] helix angle, positive for right-hand teeth as in a mesh (ISO 21771): a torque on the shaft about +x then comes with a force along -x.
    #[serde(default = "no_angle")]
    pub helix_angle: Angle,
    /// \[rad] azimuth of the pitch point, from +y towards +z.
    #[serde(default = "no_angle")]
    pub position: Angle,
    /// \[m] place of the pitch point along x, from the middle of the bearing.
    #[serde(default = "no_length")]
    pub offset: Length,
    /// [-] teeth of the gear on the shaft; needed with a ripple.
    pub teeth: Option<u32>,
    /// [-] part of the torque that swings at mesh frequency, teeth times speed.
    #[serde(default)]
    pub ripple: f64,
    /// \[rad] angle of that swing at time 0.
    #[serde(default = "no_angle")]
    pub phase: Angle,
    /// [rad/s] speed of the shaft for the mesh frequency; that of the loaded race in the scene if not given.
    #[serde(default, deserialize_with = "some_schedule::<AngularVelocity, _>")]
    pub speed: Option<Schedule>,
}

fn no_angle() -> Angle {
    Angle(0.0)
}

fn no_length() -> Length {
    Length(0.0)
}

/// Largest size of a value over time.
fn largest(schedule: &Schedule) -> f64 {
    schedule.values().into_iter().map(f64::abs).fold(0.0, f64::max)
}

fn check_all(range: Range, key: &str, schedule: &Schedule) -> Result<(), SceneError> {
    schedule.values().into_iter().try_for_each(|value| range.check(key, value))
}

/// Angle \[rad], speed [rad/s] and its rate [rad/s2] at a time \[s] of what turns at a given speed.
fn turn_by(speed: &Schedule, time: f64) -> [f64; 3] {
    [speed.integral(0.0, time), speed.at(time), speed.slope(time)]
}

/// \[s] period of what happens so many times in a turn, at a speed [rad/s]; none at rest.
fn period(times: f64, speed: f64) -> Option<f64> {
    let rate = (times * speed).abs();
    (rate > 0.0).then(|| TAU / rate)
}

impl RotatingSection {
    /// Wrench at a time \[s] about the middle of the bearing; `own` is the speed of the race.
    pub fn at(&self, own: &Schedule, time: f64) -> Wrench {
        self.turned(turn_by(self.speed(own), time), self.offset.0, time)
    }

    /// Wrench at a time \[s] about the point of a shaft's axis that is in its plane; `own` is the shaft's angle \[rad], speed [rad/s] and its
    /// rate [rad/s2].
    pub fn on_shaft(&self, own: [f64; 3], time: f64) -> Wrench {
        let turn = self.speed.as_ref().map_or(own, |speed| turn_by(speed, time));
        self.turned(turn, 0.0, time)
    }

    fn turned(&self, [angle, speed, rate]: [f64; 3], offset: f64, time: f64) -> Wrench {
        let azimuth = self.phase.0 + angle;
        match (&self.force, self.unbalance) {
            (Some(force), _) => radial_force(force.at(time), azimuth, offset),
            (None, of) => unbalance(of.map_or(0.0, |of| of.0), azimuth, speed, rate, offset),
        }
    }

    /// Schedules of its own.
    pub fn schedules(&self) -> impl Iterator<Item = &Schedule> {
        self.force.iter().chain(&self.speed)
    }

    fn speed<'a>(&'a self, own: &'a Schedule) -> &'a Schedule {
        self.speed.as_ref().unwrap_or(own)
    }

    fn follows_time(&self, own: &Schedule) -> bool {
        self.force.as_ref().is_some_and(Schedule::is_scripted) || largest(self.speed(own)) > 0.0
    }

    /// Checks every value against its range; `key` is that of the entry, `own` the speed of what it is on.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    pub fn check(&self, key: &str, own: &Schedule) -> Result<(), SceneError> {
        let of = |name: &str| format!("{key}.{name}");
        if self.unbalance.is_some() == self.force.is_some() {
            return Err(SceneError::conflict(key, "give exactly one of unbalance and force"));
        }
        if let Some(speed) = &self.speed {
            check_all(SPEED, &of("speed"), speed)?;
        }
        if let Some(force) = &self.force {
            check_all(FORCE, &of("force"), force)?;
        }
        if let Some(product) = self.unbalance {
            let fastest = largest(self.speed(own)).max(1.0);
            let high = UNBALANCE.high.min(FORCE.high / (fastest * fastest));
            Range { high, ..UNBALANCE }.check(&of("unbalance"), product.0)?;
        }
        ANGLE.check(&of("phase"), self.phase.0)?;
        OFFSET.check(&of("offset"), self.offset.0)
    }
}

impl GearSection {
    /// Wrench at a time \[s] about the middle of the bearing; `own` is the speed of the race.
    pub fn at(&self, own: &Schedule, time: f64) -> Wrench {
        let torque = self.torque.at(time);
        let factor = match self.ripple() {
            Some(ripple) => ripple.factor(self.speed(own).integral(0.0, time)),
            None => 1.0,
        };
        self.mesh().wrench(torque * factor)
    }

    /// Geometry of the mesh.
    pub fn mesh(&self) -> Mesh {
        Mesh {
            pitch_radius: self.pitch_radius.0,
            pressure_angle: self.pressure_angle.0,
            helix_angle: self.helix_angle.0,
            position: self.position.0,
            offset: self.offset.0,
        }
    }

    /// How its torque swings, if it does.
    pub fn ripple(&self) -> Option<Ripple> {
        let teeth = f64::from(self.teeth?);
        (self.ripple != 0.0).then_some(Ripple { teeth, amplitude: self.ripple, phase: self.phase.0 })
    }

    fn speed<'a>(&'a self, own: &'a Schedule) -> &'a Schedule {
        self.speed.as_ref().unwrap_or(own)
    }

    fn follows_time(&self, own: &Schedule) -> bool {
        self.torque.is_scripted() || self.ripple().is_some() && largest(self.speed(own)) > 0.0
    }

    /// Checks every value against its range; `key` is that of the entry.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    pub fn check(&self, key: &str) -> Result<(), SceneError> {
        let of = |name: &str| format!("{key}.{name}");
        RADIUS.check(&of("pitch_radius"), self.pitch_radius.0)?;
        PRESSURE_ANGLE.check(&of("pressure_angle"), self.pressure_angle.0)?;
        HELIX_ANGLE.check(&of("helix_angle"), self.helix_angle.0)?;
        ANGLE.check(&of("position"), self.position.0)?;
        ANGLE.check(&of("phase"), self.phase.0)?;
        OFFSET.check(&of("offset"), self.offset.0)?;
        // Of the three components the tangential one counts; the others are at most some times as large.
        let most = MOMENT.high.min(FORCE.high * self.pitch_radius.0);
        check_all(Range { low: -most, high: most, ..MOMENT }, &of("torque"), &self.torque)?;
        RIPPLE.check(&of("ripple"), self.ripple)?;
        match self.teeth {
            Some(teeth) => TEETH.check(&of("teeth"), f64::from(teeth))?,
            None if self.ripple != 0.0 => {
                let why = format!("{} needs teeth: the mesh frequency is teeth times speed", self.ripple);
                return Err(SceneError::conflict(of("ripple"), why));
            }
            None => {}
        }
        self.speed.iter().try_for_each(|speed| check_all(SPEED, &of("speed"), speed))
    }
}

/// Parts of the machine on one race.
#[derive(Clone, Copy, Debug)]
pub struct Machine<'a> {
    /// Forces that turn.
    pub rotating: &'a [RotatingSection],
    /// Meshes.
    pub gears: &'a [GearSection],
    /// [rad/s] speed of the race in the scene's script.
    pub speed: &'a Schedule,
}

impl<'a> Machine<'a> {
    /// Sum of all wrenches at a time \[s] about the race's origin.
    pub fn at(&self, time: f64) -> Wrench {
        let rotating = self.rotating.iter().map(|part| part.at(self.speed, time));
        let gears = self.gears.iter().map(|part| part.at(self.speed, time));
        rotating.chain(gears).fold(Wrench::default(), Wrench::plus)
    }

    /// Is there no part?
    pub fn is_empty(&self) -> bool {
        self.rotating.is_empty() && self.gears.is_empty()
    }

    /// Does the sum change with time?
    pub fn follows_time(&self) -> bool {
        self.rotating.iter().any(|part| part.follows_time(self.speed))
            || self.gears.iter().any(|part| part.follows_time(self.speed))
    }

    /// Schedules with whose kinks it has kinks.
    pub fn schedules(self) -> impl Iterator<Item = &'a Schedule> {
        let (rotating, gears, speed) = (self.rotating, self.gears, self.speed);
        let rotating = rotating.iter().flat_map(move |part| part.force.iter().chain([part.speed(speed)]));
        rotating.chain(gears.iter().flat_map(move |part| [&part.torque, part.speed(speed)]))
    }

    /// \[s] shortest period in which it swings at a time \[s] by turning; none where it does not.
    pub fn shortest_period(&self, time: f64) -> Option<f64> {
        let turns = self.rotating.iter().filter_map(|part| period(1.0, part.speed(self.speed).at(time)));
        let meshes = self.gears.iter().filter_map(|part| {
            part.ripple().and_then(|ripple| period(ripple.teeth, part.speed(self.speed).at(time)))
        });
        turns.chain(meshes).reduce(f64::min)
    }

    /// \[N, N, N m] bounds of its thrust, radial force and tilting moment, an estimate for scales.
    pub fn largest(&self) -> [f64; 3] {
        let rotating = self.rotating.iter().map(|part| {
            let speed = largest(part.speed(self.speed));
            let force = part.force.as_ref().map_or(0.0, largest)
                + part.unbalance.map_or(0.0, |product| product.0 * speed * speed);
            [0.0, force, force * part.offset.0.abs()]
        });
        let gears = self.gears.iter().map(|part| {
            let wrench = part.mesh().wrench(largest(&part.torque) * (1.0 + part.ripple));
            [wrench.force.x.abs(), wrench.force.yz().norm(), wrench.moment.yz().norm()]
        });
        rotating.chain(gears).fold([0.0; 3], |sum, part| [0, 1, 2].map(|i| sum[i] + part[i]))
    }

    /// Checks every value against its range.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    pub fn check(&self) -> Result<(), SceneError> {
        for (place, part) in self.rotating.iter().enumerate() {
            part.check(&format!("load.rotating[{place}]"), self.speed)?;
        }
        self.gears.iter().enumerate().try_for_each(|(place, part)| part.check(&format!("load.gear[{place}]")))
    }
}
