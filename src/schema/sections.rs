//! The sections of a scene file, one struct each; defaults stand beside their fields.

use serde::Deserialize;

use super::inputs::InputGivers;
use super::machine::{GearSection, Machine, RotatingSection};
use super::schedule::{self, Schedule};
use super::support::SupportSection;
use super::units::*;
use crate::contact::raceway::Raceway;

/// Internal geometry of the bearing.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BearingSection {
    /// [-] number of balls, 1 to 200.
    pub balls: usize,
    /// \[m] ball diameter D.
    pub ball_diameter: Length,
    /// \[m] pitch diameter dm: circle through the ball centres of the unloaded bearing.
    pub pitch_diameter: Length,
    /// \[rad] free contact angle; exactly one of this and `diametral_clearance` is given.
    pub contact_angle: Option<Angle>,
    /// \[m] diametral clearance; negative is interference.
    pub diametral_clearance: Option<Length>,
    /// [-] inner groove radius over ball diameter; that of most catalogue bearings if not given.
    #[serde(default = "default_inner_conformity")]
    pub inner_conformity: f64,
    /// [-] outer groove radius over ball diameter; that of most catalogue bearings if not given.
    #[serde(default = "default_outer_conformity")]
    pub outer_conformity: f64,
    /// \[rad] azimuth of ball 1, from +y towards +z.
    #[serde(default = "zero_angle")]
    pub first_ball_azimuth: Angle,
}

impl BearingSection {
    /// Inner and outer raceway (design conventions: groove centres from contact angle or clearance).
    pub fn raceways(&self) -> [Raceway; 2] {
        let (diameter, pitch) = (self.ball_diameter.0, self.pitch_diameter.0);
        let (f_i, f_o) = (self.inner_conformity, self.outer_conformity);
        // Distance A of the groove centres of a bearing without clearance.
        let centre_distance = (f_i + f_o - 1.0) * diameter;
        let (inner_circle, inner_offset, outer_circle, outer_offset) = match self.contact_angle {
            Some(angle) => {
                let (sin, cos) = angle.0.sin_cos();
                let outer_circle = pitch / 2.0 - (f_o - 0.5) * diameter * cos;
                let offsets = ((f_i - 0.5) * diameter * sin, -(f_o - 0.5) * diameter * sin);
                (outer_circle + centre_distance * cos, offsets.0, outer_circle, offsets.1)
            }
            None => {
                let clearance = self.diametral_clearance.map_or(0.0, |clearance| clearance.0);
                let outer_circle = (pitch + diameter) / 2.0 + clearance / 4.0 - f_o * diameter;
                (outer_circle + centre_distance - clearance / 2.0, 0.0, outer_circle, 0.0)
            }
        };
        let raceway = |conformity: f64, groove_circle_radius: f64, groove_offset: f64| Raceway {
            groove_radius: conformity * diameter,
            groove_circle_radius,
            groove_offset,
        };
        [raceway(f_i, inner_circle, inner_offset), raceway(f_o, outer_circle, outer_offset)]
    }

    /// Largest number of balls of a diameter \[m] that fit on an orbit of another diameter \[m] side by side.
    pub fn most_balls(ball: f64, orbit: f64) -> usize {
        let half_angle = (ball / orbit).min(1.0).asin();
        // Balls that just fit are not lost in rounding.
        (std::f64::consts::PI / half_angle * (1.0 + 1e-12)) as usize
    }
}

fn zero_angle() -> Angle {
    Angle(0.0)
}

fn default_inner_conformity() -> f64 {
    0.52
}

fn default_outer_conformity() -> f64 {
    0.53
}

/// An elastic material; bearing steel by default.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// \[Pa] Young's modulus.
    pub youngs_modulus: Pressure,
    /// [-] Poisson's ratio.
    pub poisson_ratio: f64,
    /// [kg/m3] density.
    pub density: Density,
    /// [1/K] coefficient of thermal expansion.
    pub thermal_expansion: ThermalExpansion,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            youngs_modulus: Pressure(206e9),
            poisson_ratio: 0.3,
            density: Density(7800.0),
            thermal_expansion: ThermalExpansion(12e-6),
        }
    }
}

/// Coulomb friction coefficients.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Friction {
    /// [-] ball on race, constant or a table.
    #[serde(deserialize_with = "schedule::deserialize::<Ratio, _>")]
    pub ball_race: Schedule,
    /// [-] ball on cage; that of `ball_race` at time 0 if not given.
    pub ball_cage: Option<f64>,
    /// [-] cage on the race that guides it; that of `ball_race` at time 0 if not given.
    pub cage_race: Option<f64>,
    /// [-] ball on ball, without a cage; that of `ball_race` at time 0 if not given.
    pub ball_ball: Option<f64>,
}

impl Default for Friction {
    fn default() -> Self {
        // The paper's dry estimate (section 5).
        Self { ball_race: Schedule::Constant(0.08), ball_cage: None, cage_race: None, ball_ball: None }
    }
}

/// How a race gets its motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
    /// Rests in its frame, spinning at the prescribed speed.
    #[default]
    Fixed,
    /// Pose and twist are given from outside.
    Pose,
    /// A rigid body under an applied wrench, with prescribed spin speed.
    Wrench,
    /// A rigid body on a hinge: its axis is held in a frame that is misaligned constantly or by a script, and it spins
    /// at the prescribed speed.
    Hinge,
}

/// One race.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RaceSection {
    /// How the race gets its motion.
    pub drive: Drive,
    /// \[kg] mass; needed when the race is a body.
    pub mass: Option<Mass>,
    /// [kg m2] moments of inertia about the race's x, y and z axes; needed when the race is a body.
    pub inertia: Option<[Inertia; 3]>,
    /// Misalignment of the frame of a fixed or hinged race; a race under a wrench has no frame.
    pub misalignment: Misalignment,
    /// \[rad] turn of the race about its own axis at the start, which places its waves and spalls against balls and load.
    pub turn: Option<Angle>,
    /// \[m] heights of the shoulders over the groove's bottom at the race's -x and +x side; not with `shoulder_angle`.
    pub shoulder_height: Option<[Length; 2]>,
    /// \[rad] contact angles at which the groove ends at the race's -x and +x side; not with `shoulder_height`.
    pub shoulder_angle: Option<[Angle; 2]>,
    /// A flexible support of the race on its flange, until it joins its effect.
    pub(crate) support: Option<SupportSection>,
}

/// Rotation vector [0, ry, rz] of a race's frame, constant or a scripted motion.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table { ry = ..., rz = ... }")]
pub struct Misalignment {
    /// \[rad] about y.
    #[serde(deserialize_with = "schedule::deserialize::<Angle, _>")]
    pub ry: Schedule,
    /// \[rad] about z.
    #[serde(deserialize_with = "schedule::deserialize::<Angle, _>")]
    pub rz: Schedule,
}

/// Where the balls start; what is left out is that of rolling in the quasi-static equilibrium.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Start {
    /// [rad/s] speed at which the balls orbit about the outer race's axis.
    pub orbital_speed: Option<AngularVelocity>,
    /// [rad/s] angular velocity of the balls: components axial, radial, and along the orbit.
    pub ball_angular_velocity: Option<[AngularVelocity; 3]>,
    /// Do balls start at the velocities at which the moments of friction on each are in balance, spin moments among them,
    /// instead of those of rolling with all spin on the inner race? By default unless velocities are given.
    pub spin_balance: Option<bool>,
    /// [m/s] velocity of the inner race's origin, where that is a body.
    pub inner_velocity: Option<[Velocity; 3]>,
}

impl Start {
    /// Are velocities of the balls given?
    fn gives_velocities(&self) -> bool {
        self.orbital_speed.is_some() || self.ball_angular_velocity.is_some()
    }

    /// Are moments of friction balanced though velocities are given?
    pub fn contradicts(&self) -> bool {
        self.spin_balance == Some(true) && self.gives_velocities()
    }

    /// Do balls start with moments of friction in balance?
    pub fn balances_spin(&self) -> bool {
        self.spin_balance.unwrap_or(!self.gives_velocities())
    }
}

/// One translational direction of a race: a force or a displacement.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table { force = ... } or { displacement = ... }")]
pub struct Translation {
    /// \[N] external force on the race.
    #[serde(deserialize_with = "schedule::some_schedule::<Force, _>")]
    pub force: Option<Schedule>,
    /// \[m] displacement of the race from the bearing centre.
    #[serde(deserialize_with = "schedule::some_schedule::<Length, _>")]
    pub displacement: Option<Schedule>,
}

/// One tilt direction of a race: a moment or a rotation.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table { moment = ... } or { rotation = ... }")]
pub struct Tilt {
    /// [N m] external moment on the race.
    #[serde(deserialize_with = "schedule::some_schedule::<Moment, _>")]
    pub moment: Option<Schedule>,
    /// \[rad] component of the rotation vector.
    #[serde(deserialize_with = "schedule::some_schedule::<Angle, _>")]
    pub rotation: Option<Schedule>,
}

/// Duration, speeds, and the load of the inner race per direction; a direction left out is free of load. Under a wrench on
/// the outer race the inner one is held, and where a direction is left out, at 0.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// \[s] simulated time.
    #[serde(default = "default_duration")]
    pub duration: Time,
    /// \[s] distance of two rows of results; the motion does not depend on it.
    #[serde(default = "default_output_interval")]
    pub output_interval: Time,
    /// [rad/s] spin of the inner race about its own axis.
    #[serde(default, deserialize_with = "schedule::deserialize::<AngularVelocity, _>")]
    pub inner_speed: Schedule,
    /// [rad/s] spin of the outer race about its own axis.
    #[serde(default, deserialize_with = "schedule::deserialize::<AngularVelocity, _>")]
    pub outer_speed: Schedule,
    /// Along x, the bearing axis.
    #[serde(default)]
    pub x: Translation,
    /// Along y.
    #[serde(default)]
    pub y: Translation,
    /// Along z.
    #[serde(default)]
    pub z: Translation,
    /// About y.
    #[serde(default)]
    pub ry: Tilt,
    /// About z.
    #[serde(default)]
    pub rz: Tilt,
    /// Five such directions of an outer race under a wrench.
    pub outer: Option<RaceLoad>,
    /// Forces that turn, added to the loads of the race that a wrench moves.
    #[serde(default)]
    pub rotating: Vec<RotatingSection>,
    /// Meshes of gears on the shaft, added to the same loads.
    #[serde(default)]
    pub gear: Vec<GearSection>,
}

/// Load of a race per direction; a direction left out is free of load.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table of x, y, z, ry, rz")]
pub struct RaceLoad {
    /// Along x, the bearing axis.
    pub x: Translation,
    /// Along y.
    pub y: Translation,
    /// Along z.
    pub z: Translation,
    /// About y.
    pub ry: Tilt,
    /// About z.
    pub rz: Tilt,
}

fn default_duration() -> Time {
    Time(0.05)
}

fn default_output_interval() -> Time {
    Time(1e-4)
}

/// Condition for one of the five directions x, y, z, ry, rz of a race.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// External force \[N] or moment [N m].
    Load(Schedule),
    /// Imposed displacement \[m] or rotation vector component \[rad].
    Motion(Schedule),
}

/// Load or motion that a scene gives for a direction of a race.
#[derive(Clone, Copy, Debug, Default)]
pub struct Direction<'a> {
    /// \[N, N m] external force or moment.
    pub load: Option<&'a Schedule>,
    /// \[m, rad] displacement or rotation vector component.
    pub motion: Option<&'a Schedule>,
}

impl Direction<'_> {
    /// The condition; a direction that nothing is given for is free of load.
    pub fn condition(&self) -> Condition {
        match self.motion {
            Some(motion) => Condition::Motion(motion.clone()),
            None => Condition::Load(self.load.cloned().unwrap_or_default()),
        }
    }
}

/// Directions in the order x, y, z, ry, rz.
fn directions<'a>([x, y, z]: [&'a Translation; 3], [ry, rz]: [&'a Tilt; 2]) -> [Direction<'a>; 5] {
    let along = |of: &'a Translation| Direction { load: of.force.as_ref(), motion: of.displacement.as_ref() };
    let about = |of: &'a Tilt| Direction { load: of.moment.as_ref(), motion: of.rotation.as_ref() };
    [along(x), along(y), along(z), about(ry), about(rz)]
}

impl Load {
    /// Parts of the machine on a race of this speed [rad/s].
    pub fn machine<'a>(&'a self, speed: &'a Schedule) -> Machine<'a> {
        Machine { rotating: &self.rotating, gears: &self.gear, speed }
    }

    /// The five directions of the inner race, in the order x, y, z, ry, rz.
    pub fn of_inner(&self) -> [Direction<'_>; 5] {
        directions([&self.x, &self.y, &self.z], [&self.ry, &self.rz])
    }

    /// Those of the outer race; nothing is given for them where the scene has no such section.
    pub fn of_outer(&self) -> [Direction<'_>; 5] {
        match &self.outer {
            Some(RaceLoad { x, y, z, ry, rz }) => directions([x, y, z], [ry, rz]),
            None => [Direction::default(); 5],
        }
    }

    /// The conditions of the five directions of the inner race, in the order x, y, z, ry, rz.
    pub fn conditions(&self) -> [Condition; 5] {
        self.of_inner().map(|direction| direction.condition())
    }
}

/// How the FMU writes an orientation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Orientation {
    /// Rotation vector of the race's axis, components y and z, and the spin speed about that axis; the spin angle is
    /// integrated inside.
    #[default]
    Shaft,
    /// Unit quaternion, components w, x, y, z.
    Quaternion,
    /// Cardan angles y, z, x: the axis tilts about y and z, then the race turns about it by x.
    Cardan,
}

/// Meaning of the FMU's lists of dependencies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dependencies {
    /// Outputs at a communication point by the inputs set at that point: none, as outputs wait for the next step. For
    /// masters that look for algebraic loops.
    #[default]
    Point,
    /// Outputs at the end of a step by the inputs that it was given: where `fmi2GetDirectionalDerivative` can be other than
    /// zero. For masters that take the lists as sparsity.
    Step,
}

/// Interface of the FMU. A machine has arrays alone of it; all else is of each bearing.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Interface {
    /// How orientations are written.
    pub orientation: Orientation,
    /// Span that the lists of dependencies are about; those of a shaft with its bearings are always about the communication point.
    pub dependencies: Dependencies,
    /// Are variables that differ in the number of a ball or in a component one array (`inner.force` in place of `inner.force.x`, `.y`, `.z`)? In packages of
    /// FMI 3.0 alone, as 2.0 has no arrays. For masters that know them: some do not.
    pub arrays: bool,
    /// Who gives each group of inputs: the scene's script or the master.
    pub inputs: InputGivers,
}
