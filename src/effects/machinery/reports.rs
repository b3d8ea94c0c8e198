//! Reports of effects on a state, beside the races and the totals of every bearing.

use nalgebra::{Matrix6, Vector3};
use serde::{Deserialize, Serialize};

use crate::numerics::motion::{Pose, Twist, Wrench};

/// All of it, as the outputs of a state have it; an effect that is off reports nothing.
#[derive(Clone, Copy, Debug)]
pub struct Reports<'a> {
    /// Balls.
    pub balls: &'a [BallOutput],
    /// The cage.
    pub cage: Option<&'a CageOutput>,
    /// Contacts of neighbouring balls.
    pub neighbours: Option<&'a NeighboursOutput>,
    /// Stiffness and damping of the running bearing.
    pub condensed: Option<&'a Condensed>,
    /// The bearing as it has grown.
    pub growth: Option<&'a GrowthOutput>,
    /// Rating life.
    pub life: Option<&'a LifeOutput>,
    /// Heat of friction by part.
    pub heat: Option<&'a HeatOutput>,
    /// Means since the last communication point.
    pub means: Option<&'a Averaged>,
    /// Frequencies of cage and damage.
    pub frequencies: &'a Frequencies,
    /// \[W] power that the balls lose to the medium around them.
    pub drag_power: f64,
    /// [Pa s] viscosity of the oil at the inner and at the outer race.
    pub oil: Option<[f64; 2]>,
    /// Temperatures, where the heat of friction gives them.
    pub warm: Option<&'a Warm>,
    /// Flexible supports of inner and outer race.
    pub supports: [Option<&'a SupportState>; 2],
}

/// A ball-race contact. Longitudinal is along the rolling direction, lateral transverse to it (frame C).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactOutput {
    /// \[N] normal load.
    pub load: f64,
    /// \[rad] contact angle relative to the race; positive under axial load of the inner race along +x.
    pub contact_angle: f64,
    /// [-] longitudinal creepage.
    pub creepage_longitudinal: f64,
    /// [-] lateral creepage.
    pub creepage_lateral: f64,
    /// [1/m] spin creepage.
    pub creepage_spin: f64,
    /// \[N] longitudinal creep force on the ball.
    pub force_longitudinal: f64,
    /// \[N] lateral creep force on the ball.
    pub force_lateral: f64,
    /// [N m] spin moment on the ball.
    pub spin_moment: f64,
    /// \[W] power lost to friction.
    pub power: f64,
    /// \[W] part of it by the spin moment.
    pub spin_power: f64,
    /// \[W] part of it by the slip of a bent groove.
    pub groove_power: f64,
    /// \[m] semi-axis of the contact ellipse along rolling.
    pub semi_axis_rolling: f64,
    /// \[m] semi-axis of the contact ellipse transverse to rolling.
    pub semi_axis_transverse: f64,
    /// [-] share of the load beyond the shoulders of the race.
    pub shoulder_share: f64,
    /// \[Pa] peak pressure.
    pub peak_pressure: f64,
    /// \[rad] distance of the ellipse from the nearer end of the groove; negative where it is cut.
    pub shoulder_margin: f64,
    /// \[W] power of the moment against rolling in the material; 0 where nothing resists.
    pub resisting_power: f64,
    /// Its film; all 0 where it is dry.
    pub film: FilmOutput,
}

/// The film of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilmOutput {
    /// \[m] central film.
    pub thickness: f64,
    /// [-] least film over the roughness of both surfaces.
    pub ratio: f64,
    /// [-] friction coefficient of film and roughness together.
    pub friction: f64,
    /// \[W] power of rolling resistance, part of the friction power.
    pub rolling_power: f64,
}

/// A ball's contact with its cage pocket.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PocketOutput {
    /// \[N] normal load; 0 while they do not touch.
    pub load: f64,
    /// \[N] force of the pocket on the ball, world axes.
    pub force: Vector3<f64>,
    /// \[m] approach; negative is a gap.
    pub approach: f64,
    /// \[W] power lost to friction.
    pub power: f64,
}

/// Contacts of neighbouring balls, where no cage keeps them apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighboursOutput {
    /// [-] pairs that touch.
    pub touching: usize,
    /// \[N] largest normal load.
    pub largest_load: f64,
    /// \[m] smallest gap; negative is an approach. That of a single ball is infinite.
    pub gap: f64,
    /// \[W] power lost to friction.
    pub power: f64,
}

/// The cage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CageOutput {
    /// Pose.
    pub pose: Pose,
    /// Twist.
    pub twist: Twist,
    /// \[m] centre relative to the race that guides the cage (the outer race if the balls do), along that race's axis
    /// (x) and across it (y, z of the frame that tilts with the race but does not spin).
    pub eccentricity: Vector3<f64>,
    /// \[rad] turned about the own axis since the start, without limit.
    pub turned: f64,
    /// \[N] force of all pockets on the cage, world axes.
    pub pocket_force: Vector3<f64>,
    /// \[N] force of the lands on the cage, world axes.
    pub land_force: Vector3<f64>,
    /// \[N] normal load on the lands at the cage's -x and +x side.
    pub land_loads: [f64; 2],
    /// \[m] deepest approach on the lands; negative is a gap. Minus infinity where the balls guide.
    pub land_approach: f64,
    /// \[W] power lost to friction in the pockets.
    pub pocket_power: f64,
    /// \[W] power lost to friction on the lands.
    pub land_power: f64,
}

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallOutput {
    /// \[rad] azimuth about the outer race's axis, in (-pi, pi].
    pub azimuth: f64,
    /// [rad/s] orbital speed about the outer race's axis.
    pub orbital_speed: f64,
    /// \[m] centre, world axes.
    pub position: Vector3<f64>,
    /// [rad/s] angular velocity, world axes.
    pub angular_velocity: Vector3<f64>,
    /// [rad/s] angular velocity along the outer race's axis, radially away from it, and along the orbit.
    pub spin: Vector3<f64>,
    /// Contact with the inner race.
    pub inner: ContactOutput,
    /// Contact with the outer race.
    pub outer: ContactOutput,
    /// Contact with the cage, where there is one.
    pub pocket: Option<PocketOutput>,
    /// \[N] largest normal load between the ball and a neighbour.
    pub neighbours_load: f64,
    /// \[N] force of its neighbours on the ball, world axes.
    pub neighbours_force: Vector3<f64>,
}

/// Stiffness or damping that an external load on the inner race has to overcome, by components: rows force x, y, z and moment x, y, z,
/// columns translation x, y, z and rotation x, y, z of the inner race relative to the outer one; world axes, about the
/// inner race's origin. The race's own rotation turns with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condensed {
    /// [N/m, N/rad; N m/m, N m/rad] load by displacement.
    pub stiffness: Matrix6<f64>,
    /// [N s/m, N s/rad; N m s/m, N m s/rad] load by velocity.
    pub damping: Matrix6<f64>,
}

/// Frequencies \[Hz] of cage and damage by the speeds of cage and races as they are; of a bearing whose balls roll without slip
/// they are those of its geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequencies {
    /// Turns of the cage (FTF).
    pub cage: f64,
    /// Balls over a place of the outer race (BPFO).
    pub outer: f64,
    /// Balls over a place of the inner race (BPFI).
    pub inner: f64,
    /// Turns of a ball about its own axis, seen from the cage (BSF): a place of it meets a race twice in each.
    pub ball: f64,
}

/// The bearing as it has grown, without load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GrowthOutput {
    /// \[m] diametral clearance; negative is interference of balls and raceways.
    pub clearance: f64,
    /// \[rad] free contact angle; 0 without clearance.
    pub contact_angle: f64,
    /// \[m] diametral interference of the inner ring on its shaft and of the outer ring in its housing; negative is a gap.
    pub interference: [f64; 2],
    /// \[Pa] pressure on these seats.
    pub seat_pressure: [f64; 2],
}

/// \[W] heat of friction by part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeatOutput {
    /// Inner race.
    pub inner: f64,
    /// Outer race.
    pub outer: f64,
    /// Balls.
    pub balls: f64,
    /// Cage.
    pub cage: f64,
    /// The medium around the balls.
    pub medium: f64,
}

/// Life and safety of a bearing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LifeOutput {
    /// [million revolutions] reference rating life L_10r; at most [`crate::effects::rating::LONGEST`].
    pub reference: f64,
    /// [million revolutions] modified reference rating life L_nmr; none without viscosity and contamination.
    pub modified: Option<f64>,
    /// \[N] dynamic equivalent reference load P_ref.
    pub equivalent_load: f64,
    /// [-] static safety: load of a ball that would leave a mark over the largest load on the inner race; at most [`crate::effects::rating::SAFEST`].
    pub static_safety: f64,
    /// [-] part of the reference life that was used up since the start.
    pub damage: f64,
    /// The race that the load stands still on, by the scene or as it was found.
    pub load_rests_on: LoadRests,
    /// Race that the load was found to rest on, where the scene says otherwise.
    pub contradiction: Option<LoadRests>,
}

impl LifeOutput {
    /// A warning where the scene names another race than the one that the load stands still on.
    pub fn warning(&self) -> Option<String> {
        let (given, found) = (self.load_rests_on.name(), self.contradiction?.words());
        Some(format!(
            "warning: rating.load_rests_on = \"{given}\", but {found}, by the speeds of the load's direction and of both races: \
             the life is that of the key; leave it out"
        ))
    }
}

/// A support at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SupportState {
    /// Pose of the flange.
    pub flange: Pose,
    /// Its twist.
    pub flange_twist: Twist,
    /// Force and moment of the support on the flange, about its origin, world axes.
    pub wrench: Wrench,
    /// \[m] displacement of the race from the flange, in the flange's axes.
    pub displacement: Vector3<f64>,
    /// \[rad] rotation vector of the race relative to the flange, in the flange's axes.
    pub rotation: Vector3<f64>,
    /// \[J] energy stored.
    pub energy: f64,
    /// \[W] power lost in the dampers.
    pub lost: f64,
}

/// Parts that have a temperature, in the order of [`Rises`].
pub const PARTS: [&str; 5] = ["inner", "outer", "balls", "shaft", "housing"];

/// \[K] rises of temperature of all [`PARTS`].
pub type Rises = [f64; 5];

/// Temperatures as a run has them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Warm {
    /// \[K] rises of temperature of all parts.
    pub rises: Rises,
    /// \[W] heat that goes out to the surroundings, the oil included.
    pub out: f64,
}

/// Quantities that have means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Averaged {
    /// Means of the inner and the outer race.
    pub races: [OfRace; 2],
    /// \[W] lost to friction in all contacts.
    pub friction: f64,
    /// \[W] all losses.
    pub lost: f64,
    /// [rad/s] speed of the cage.
    pub cage_speed: f64,
}

/// Quantities of a race that have means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OfRace {
    /// \[N] force of the bearing on it.
    pub force: [f64; 3],
    /// [N m] moment.
    pub moment: [f64; 3],
    /// [N m] torque that keeps it at its speed.
    pub drive_torque: f64,
}

/// The race that the load stands still on; the other one turns against it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoadRests {
    /// The inner race.
    Inner,
    /// The outer race.
    #[default]
    Outer,
    /// Neither: both turn against it.
    Neither,
}
