//! The sections of a system: a shaft, what is on it, and how its bearings are mounted.

use nalgebra::Vector3;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use super::components::Components;
use super::machine::{GearSection, RotatingSection};
use super::matrices::StructureMatrices;
use super::schedule::{Schedule, some_schedule as some};
use super::sections::Material;
use super::units::*;

/// A shaft: a rigid body by its mass and moments of inertia, or beams by their sections; discs can be added to both.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ShaftSection {
    /// Name of one of several shafts: letters, digits, _ and -. A section `[shaft]` alone is called shaft.
    pub name: String,
    /// \[m] place x, y, z of the origin of its positions in the axes of all shafts, which are parallel; 0 if not given.
    pub origin: Option<[Length; 3]>,
    /// [rad/s] speed about the shaft's x axis; not with `torque`.
    #[serde(deserialize_with = "some::<AngularVelocity, _>")]
    pub speed: Option<Schedule>,
    /// [N m] torque that drives the shaft; not with `speed`.
    #[serde(deserialize_with = "some::<Moment, _>")]
    pub torque: Option<Schedule>,
    /// Is the shaft driven at a flange by another program? A package then has its angle as an input beside the speed, and follows both; the torque that the flange
    /// takes is an output. Needs `speed`; a shaft with `torque` has a flange as it is: torque in, angle and speed out.
    pub flange: bool,
    /// \[m] position at which speed or torque drives beams that twist, and that their turn is told of; the end of least position if not given.
    pub drive_position: Option<Length>,
    /// Do its beams twist? If not given, those of shafts with a mesh do.
    pub torsion: Option<bool>,
    /// [rad/s] speed at the start of a shaft under a torque.
    pub start_speed: Option<AngularVelocity>,
    /// \[kg] mass of a rigid shaft; not with `section`.
    pub mass: Option<Mass>,
    /// [kg m2] moment of inertia of a rigid shaft about its axis.
    pub polar_inertia: Option<Inertia>,
    /// [kg m2] moment of inertia of a rigid shaft about the y and z axes through its centre of mass.
    pub transverse_inertia: Option<Inertia>,
    /// \[m] position of a rigid shaft's centre of mass along its axis; 0 if not given.
    pub centre: Option<Length>,
    /// Beams of a flexible shaft, in any order; together they are one piece.
    pub section: Vec<BeamSection>,
    /// Rigid discs on the shaft; not with `matrices`.
    pub disc: Vec<Disc>,
    /// JSON file with the matrices of a shaft from another program (docs/shaft.md), or its keys; instead of `mass` and `section`.
    pub matrices: Option<toml::Value>,
    /// Matrices of that file.
    #[serde(skip)]
    pub read: Option<StructureMatrices>,
    /// Material of the beams.
    pub material: Material,
    /// \[s] retardation time of the beams: stiffness times this is their damping; 0 if not given.
    pub retardation_time: Option<Time>,
    /// \[Hz] modes of the shaft between its bearings up to this frequency are kept; 20 kHz if not given.
    pub modes_up_to: Option<Frequency>,
    /// Forces and moments at points of the shaft.
    pub load: Vec<PointLoad>,
    /// Meshes of helical gears on the shaft; `offset` is the place of the pitch point along it, and the ripple follows its turn.
    pub gear: Vec<GearSection>,
    /// Forces that turn with the shaft, or at a speed of their own; `offset` is the place of their plane along it.
    pub rotating: Vec<RotatingSection>,
    /// Points whose motion is reported.
    pub point: Vec<Point>,
}

/// \[m] how far axes that are one may be apart, by the digits of a file.
const ON_AXIS: f64 = 1e-9;

impl ShaftSection {
    /// \[m] place at a position \[m] along it.
    pub fn place(&self, position: f64) -> [f64; 3] {
        let [x, y, z] = self.origin.map_or([0.0; 3], |origin| origin.map(|length| length.0));
        [x + position, y, z]
    }

    /// Is its axis that of another shaft, up to the digits of a file?
    pub fn is_coaxial_with(&self, other: &Self) -> bool {
        let [one, other] = [self, other].map(|shaft| shaft.place(0.0));
        (1..3).all(|k| (one[k] - other[k]).abs() <= ON_AXIS)
    }

    /// \[m] positions of everything on it: loads, points, discs, gears and forces that turn.
    pub fn positions(&self) -> impl Iterator<Item = f64> {
        let loads = self.load.iter().map(|load| load.position.0);
        let points = self.point.iter().map(|point| point.position.0);
        let discs = self.disc.iter().map(|disc| disc.position.0);
        let gears = self.gear.iter().map(|gear| gear.offset.0);
        let rotating = self.rotating.iter().map(|part| part.offset.0);
        loads.chain(points).chain(discs).chain(gears).chain(rotating)
    }
}

/// The shafts of a file: one as a section `[shaft]`, or several `[[shaft]]`.
#[derive(Clone, Debug)]
pub struct Shafts(pub Vec<ShaftSection>);

impl<'de> Deserialize<'de> for Shafts {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMore;
        impl<'de> Visitor<'de> for OneOrMore {
            type Value = Shafts;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a section [shaft], or several [[shaft]]")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Shafts, A::Error> {
                let mut shaft = ShaftSection::deserialize(MapAccessDeserializer::new(map))?;
                if shaft.name.is_empty() {
                    shaft.name = "shaft".into();
                }
                Ok(Shafts(vec![shaft]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Shafts, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Shafts)
            }
        }
        deserializer.deserialize_any(OneOrMore)
    }
}

/// A beam of one cross-section.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeamSection {
    /// \[m] position of its left end along the shaft.
    pub from: Length,
    /// \[m] position of its right end.
    pub to: Length,
    /// \[m] outer diameter.
    pub outer_diameter: Length,
    /// \[m] diameter of its bore; 0 if not given.
    pub inner_diameter: Option<Length>,
}

/// A rigid disc.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// \[m] position along the shaft.
    pub position: Length,
    /// \[kg] mass.
    pub mass: Mass,
    /// [kg m2] moment of inertia about the shaft's axis.
    pub polar_inertia: Inertia,
    /// [kg m2] moment of inertia about a diameter.
    pub transverse_inertia: Inertia,
    /// [kg m] unbalance: mass times its distance from the axis; 0 if not given.
    pub unbalance: Option<Unbalance>,
    /// \[rad] azimuth of the unbalance at the start, from +y towards +z; 0 if not given.
    pub unbalance_azimuth: Option<Angle>,
}

/// Force and moment at a point of the shaft.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointLoad {
    /// Its name, for the inputs of a package.
    pub name: String,
    /// \[m] position along the shaft.
    pub position: Length,
    /// \[N] force, components along x, y, z, each constant or a table.
    #[serde(default)]
    pub force: Components<Force>,
    /// [N m] moment, components about x, y, z.
    #[serde(default)]
    pub moment: Components<Moment>,
    /// Displacement of the point, where that is given and not the force.
    #[serde(default)]
    pub displacement: PointDisplacement,
    /// Tilt of the shaft there, where that is given and not the moment.
    #[serde(default)]
    pub rotation: PointRotation,
}

/// Displacement of a point along some of the axes.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table { x = ..., y = ..., z = ... }")]
pub struct PointDisplacement {
    /// \[m] displacement along x, constant, or over time as a smooth motion through the points of a table; what holds it there is a result.
    #[serde(deserialize_with = "some::<Length, _>")]
    pub x: Option<Schedule>,
    /// \[m] the same along y.
    #[serde(deserialize_with = "some::<Length, _>")]
    pub y: Option<Schedule>,
    /// \[m] the same along z.
    #[serde(deserialize_with = "some::<Length, _>")]
    pub z: Option<Schedule>,
}

impl PointDisplacement {
    /// Components that are given: key, component and schedule.
    pub fn motion(&self) -> impl Iterator<Item = GivenMotion<'_>> {
        let Self { x, y, z } = self;
        given([("displacement.x", 0, x), ("displacement.y", 1, y), ("displacement.z", 2, z)])
    }
}

/// Component of a motion that is given: its key, which one (displacements 0 to 2, rotations 3 to 5), and over time.
pub type GivenMotion<'a> = (&'static str, usize, &'a Schedule);

/// Those of some components that are given.
pub(super) fn given<'a, const N: usize>(
    all: [(&'static str, usize, &'a Option<Schedule>); N],
) -> impl Iterator<Item = GivenMotion<'a>> {
    all.into_iter().filter_map(|(key, component, given)| Some((key, component, given.as_ref()?)))
}

/// Tilt at a point about some of the axes.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table { ry = ..., rz = ... }")]
pub struct PointRotation {
    /// \[rad] tilt about y, likewise.
    #[serde(deserialize_with = "some::<Angle, _>")]
    pub ry: Option<Schedule>,
    /// \[rad] tilt about z.
    #[serde(deserialize_with = "some::<Angle, _>")]
    pub rz: Option<Schedule>,
}

impl PointLoad {
    /// Components of its motion that are given.
    pub fn motion(&self) -> impl Iterator<Item = GivenMotion<'_>> {
        let PointRotation { ry, rz } = &self.rotation;
        self.displacement.motion().chain(given([("rotation.ry", 4, ry), ("rotation.rz", 5, rz)]))
    }
}

/// A point whose motion is reported.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Its name.
    pub name: String,
    /// \[m] position along the shaft.
    pub position: Length,
}

/// Level of a bearing's model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BearingLevel {
    /// Its motion in time, ball by ball.
    Dynamic,
    /// Elements in balance at every place of its rings, without states.
    Equilibrium,
    /// The one or the other, by whether something in it needs states.
    Auto,
}

/// How a bearing is mounted.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mounting {
    /// \[m] position of the bearing's centre along the shaft.
    pub position: Length,
    /// Where the bearing's x axis points: along the shaft's, or against it.
    #[serde(default)]
    pub direction: MountingDirection,
    /// Name of the housing that its outer race sits in; what its scene says of the outer race if not given.
    pub housing: Option<String>,
    /// Name of the shaft that its outer ring is a part of: a hub, a gear or a roller that turns on its bearings, or an outer shaft around an
    /// inner one. Not with `housing`, `axial`, `misalignment` or `offset`.
    pub outer_shaft: Option<String>,
    /// Does the seat hold the outer ring along the bore (`"held"`), or does the ring slide there without friction (`"free"`: a floating
    /// bearing, which takes no axial force)? The mass of a ring that slides is `outer.mass` of its scene, of a catalogue bearing an estimate.
    #[serde(default)]
    pub axial: AxialSeat,
    /// Tilt of the bore that the outer ring sits in, in the axes of the shaft.
    #[serde(default)]
    pub misalignment: BoreTilt,
    /// How far the middle of that bore lies beside the axis of the shaft.
    #[serde(default)]
    pub offset: BoreOffset,
    /// Preload of the bearing; at most one of both.
    #[serde(default)]
    pub preload: Preload,
}

impl Mounting {
    /// Does it say how the outer ring sits, in a housing, on a shaft or in the ground?
    pub fn seats_outer_ring(&self) -> bool {
        self.housing.is_some() || self.outer_shaft.is_some() || self.has_bore()
    }

    /// \[m, rad] place across the axis and tilt of the bore that its outer ring sits in, in the axes of the shaft.
    pub fn bore(&self) -> (Vector3<f64>, Vector3<f64>) {
        let [[y, z], [ry, rz]] = [self.offset.values(), self.misalignment.values()]
            .map(|values| values.map(|(_, value)| value.unwrap_or(0.0)));
        (Vector3::new(0.0, y, z), Vector3::new(0.0, ry, rz))
    }

    /// Does it say that the ring slides in its bore, or that the bore is tilted or lies off?
    pub fn has_bore(&self) -> bool {
        let Self { axial, misalignment, offset, .. } = self;
        let mut values = misalignment.values().into_iter().chain(offset.values());
        *axial == AxialSeat::Free || values.any(|(_, value)| value.is_some())
    }
}

/// Does a seat hold its ring along the bore?
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AxialSeat {
    /// It does, both ways.
    #[default]
    Held,
    /// The ring slides without friction.
    Free,
}

/// Tilt of a bore: rotation vector [0, ry, rz] of its axis.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table { ry = ..., rz = ... }")]
pub struct BoreTilt {
    /// \[rad] tilt about y, in the axes of the shaft, of the bore that its outer ring sits in; 0 if not given.
    pub ry: Option<Angle>,
    /// \[rad] tilt of that bore about z; 0 if not given.
    pub rz: Option<Angle>,
}

impl BoreTilt {
    /// Its numbers \[rad] by their keys.
    pub fn values(&self) -> [(&'static str, Option<f64>); 2] {
        [("ry", self.ry.map(|angle| angle.0)), ("rz", self.rz.map(|angle| angle.0))]
    }
}

/// Place of a bore across the axis of the shaft.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table { y = ..., z = ... }")]
pub struct BoreOffset {
    /// \[m] how far the middle of that bore lies beside the axis of the shaft, along y; 0 if not given. Along x, `position` and `preload` say
    /// where it is.
    pub y: Option<Length>,
    /// \[m] the same along z; 0 if not given.
    pub z: Option<Length>,
}

impl BoreOffset {
    /// Its numbers \[m] by their keys.
    pub fn values(&self) -> [(&'static str, Option<f64>); 2] {
        [("y", self.y.map(|length| length.0)), ("z", self.z.map(|length| length.0))]
    }
}

/// Where the x axis of a bearing points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum MountingDirection {
    /// Along the shaft's x axis.
    #[default]
    #[serde(rename = "+x")]
    Along,
    /// Against it: turned by half a turn about z.
    #[serde(rename = "-x")]
    Against,
}

impl MountingDirection {
    /// 1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Self::Along => 1.0,
            Self::Against => -1.0,
        }
    }
}

/// How far the inner race is pushed along the bearing's +x axis when it is mounted.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table { force = ... } or { displacement = ... }")]
pub struct Preload {
    /// \[N] axial force that it takes at rest.
    pub force: Option<Force>,
    /// \[m] way, such as what a spacer is ground by.
    pub displacement: Option<Length>,
}

impl Preload {
    /// Is one asked for?
    pub fn is_given(&self) -> bool {
        self.force.is_some() || self.displacement.is_some()
    }
}
