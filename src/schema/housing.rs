//! The section of a housing that outer races of a system sit in.

use serde::Deserialize;

use super::components::Components;
use super::matrices::StructureMatrices;
use super::schedule::{Schedule, some_schedule as some};
use super::shaft::{GivenMotion, PointDisplacement, given};
use super::support::DirectionMatrix;
use super::units::*;

/// A housing: a rigid body on springs, or a flexible one by its matrices. Places are in the axes of the shaft.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HousingSection {
    /// Its name: letters, digits, _ and -.
    pub name: String,
    /// \[kg] mass; not with `matrices`.
    pub mass: Option<Mass>,
    /// [kg m2] moments of inertia about axes along x, y, z through its centre of mass.
    pub inertia: Option<[Inertia; 3]>,
    /// \[m] its centre of mass; the origin if not given.
    pub centre: Option<[Length; 3]>,
    /// [N/m, N m/rad] stiffness along and about x, y, z that holds it at its centre of mass: six numbers, or six rows of six.
    #[serde(default)]
    pub stiffness: DirectionMatrix<TranslationalStiffness, RotationalStiffness>,
    /// [N s/m, N m s/rad] damping, likewise; none if not given.
    #[serde(default)]
    pub damping: DirectionMatrix<TranslationalDamping, RotationalDamping>,
    /// Feet that it stands on; with `stiffness` or instead of it.
    #[serde(default)]
    pub foot: Vec<Foot>,
    /// JSON file with the matrices of a housing from another program (docs/shaft.md), or its keys; instead of `mass` and what holds it.
    pub matrices: Option<toml::Value>,
    /// Matrices of that file.
    #[serde(skip)]
    pub read: Option<StructureMatrices>,
    /// Forces and moments at points of the housing.
    #[serde(default)]
    pub load: Vec<HousingLoad>,
    /// Points whose motion is reported.
    #[serde(default)]
    pub point: Vec<HousingPoint>,
}

/// A foot of a housing: springs and dampers to the ground.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Foot {
    /// \[m] its place.
    pub position: [Length; 3],
    /// [N/m] stiffness along x, y, z.
    pub stiffness: [TranslationalStiffness; 3],
    /// [N s/m] damping along x, y, z; 0 if not given.
    pub damping: Option<[TranslationalDamping; 3]>,
}

/// Force and moment at a point of a housing.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HousingLoad {
    /// Its name, for the inputs of a package.
    pub name: String,
    /// \[m] its place.
    pub position: [Length; 3],
    /// \[N] force, components along x, y, z, each constant or a table.
    #[serde(default)]
    pub force: Components<Force>,
    /// [N m] moment, components about x, y, z.
    #[serde(default)]
    pub moment: Components<Moment>,
    /// Displacement of the point, where that is given and not the force.
    #[serde(default)]
    pub displacement: PointDisplacement,
    /// Rotation of the housing there, where that is given and not the moment.
    #[serde(default)]
    pub rotation: HousingRotation,
}

/// Rotation of a housing about some of the axes.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table { rx = ..., ry = ..., rz = ... }")]
pub struct HousingRotation {
    /// \[rad] rotation about x, constant, or over time as a smooth motion through the points of a table; what holds it there is a result.
    #[serde(deserialize_with = "some::<Angle, _>")]
    pub rx: Option<Schedule>,
    /// \[rad] the same about y.
    #[serde(deserialize_with = "some::<Angle, _>")]
    pub ry: Option<Schedule>,
    /// \[rad] the same about z.
    #[serde(deserialize_with = "some::<Angle, _>")]
    pub rz: Option<Schedule>,
}

impl HousingLoad {
    /// Components of its motion that are given.
    pub fn motion(&self) -> impl Iterator<Item = GivenMotion<'_>> {
        let HousingRotation { rx, ry, rz } = &self.rotation;
        let rotations = given([("rotation.rx", 3, rx), ("rotation.ry", 4, ry), ("rotation.rz", 5, rz)]);
        self.displacement.motion().chain(rotations)
    }
}

/// A point of a housing whose motion is reported.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HousingPoint {
    /// Its name.
    pub name: String,
    /// \[m] its place.
    pub position: [Length; 3],
}
