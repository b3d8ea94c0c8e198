//! The section of two gears in mesh, `[[mesh]]`, of a bearing by its stiffness, `[bearing.stiffness]`, and of a coupling, `[[coupling]]`.

use serde::Deserialize;

use super::stiffness::Stiffness;
use super::units::*;

/// Two gears in mesh, each on a shaft of its own.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshSection {
    /// Its name: letters, digits, _ and -.
    pub name: String,
    /// \[m] normal module.
    pub normal_module: Length,
    /// \[rad] normal pressure angle; 20 degrees if not given.
    pub pressure_angle: Option<Angle>,
    /// \[rad] helix angle of the first gear, positive for right-hand teeth (ISO 21771); another outside gear has the other hand, inside teeth the same. 0 if not given.
    pub helix_angle: Option<Angle>,
    /// Both gears.
    pub gears: [MeshGear; 2],
    /// [N/m] stiffness along the normal of the teeth; the mean one of ISO 6336-1 if not given.
    pub stiffness: Option<TranslationalStiffness>,
    /// [-] damping over critical damping of both shafts turning against each other; 0.05 if not given.
    pub damping_ratio: Option<f64>,
    /// \[m] play along the normal between both flanks; what profile shifts and centre distance leave if not given.
    pub backlash: Option<Length>,
    /// [-] what of the mean stiffness is added as teeth come and go: waves and curves, whose sum counts; statics and natural frequencies take the mean.
    #[serde(default)]
    pub stiffness_variation: Vec<Varies<Ratio>>,
    /// \[m] transmission error along the normal: how far the second gear is pushed on, where the first one drives as it turns about +x; a list as that of the stiffness.
    #[serde(default)]
    pub transmission_error: Vec<Varies<Length>>,
    /// [-] mean coefficient of friction between the teeth; no friction if not given.
    pub friction: Option<f64>,
}

/// Over what a term of a variation closes on itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Over {
    /// A tooth.
    #[default]
    Tooth,
    /// A turn of the first gear.
    First,
    /// A turn of the second gear.
    Second,
}

/// A term of a variation: a wave, `amplitude cos(order a - phase)`, or a closed curve through `values`, over the angle a from 0 to a whole turn while a
/// tooth passes, or a gear turns about +x.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Varies<Q> {
    /// Over what it closes on itself: `"tooth"`, a turn of the `"first"` gear or of the `"second"`; a tooth if not given.
    #[serde(default)]
    pub over: Over,
    /// [-] waves over that; 1 if not given.
    pub order: Option<u32>,
    /// Amplitude of a wave.
    pub amplitude: Option<Q>,
    /// \[rad] phase of a wave; 0 if not given.
    pub phase: Option<Angle>,
    /// Points of a curve at equal distances, the first at 0; or `{ file = "te.csv", column = "error [um]" }`.
    pub values: Option<Vec<Q>>,
}

/// A gear of a mesh.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshGear {
    /// Name of its shaft.
    pub shaft: String,
    /// \[m] position of the middle of its teeth along that shaft.
    pub position: Length,
    /// [-] teeth.
    pub teeth: u32,
    /// \[m] width of its teeth.
    pub face_width: Length,
    /// Are its teeth inside a ring? Of the second gear alone.
    #[serde(default)]
    pub inside: bool,
    /// [-] profile shift, of the normal module; 0 if not given. ISO 21771's of inside teeth: positive makes a ring's teeth thicker, its tip circle smaller.
    #[serde(default)]
    pub profile_shift: f64,
    /// \[m] diameter over the tips, for the contact ratio of the mean stiffness; the usual one if not given.
    pub tip_diameter: Option<Length>,
}

/// A stiffness along or across an axis, or a table of its force.
pub type WayStiffness = Stiffness<TranslationalStiffness, Length, Force>;

/// A stiffness of a tilt or a twist, or a table of its moment.
pub type TurnStiffness = Stiffness<RotationalStiffness, Angle, Moment>;

/// Springs and dampers between two shafts on one axis: a coupling, a spline, a flexible disc.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CouplingSection {
    /// Its name: letters, digits, _ and -.
    pub name: String,
    /// Names of both shafts, which are on one axis.
    pub shafts: [String; 2],
    /// \[m] position along the first of them.
    pub position: Length,
    /// Its springs and dampers: keys of `bearing.stiffness` but for `gap` and `axial_way`, each none if not given, and `torsion`.
    pub stiffness: StiffnessSection,
}

/// A bearing that is not simulated: springs and dampers between the shaft and what its outer ring sits in.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StiffnessSection {
    /// [N/m] stiffness across the axis, or a table of displacement and force, `[[0, 0], ["5 um", "1 kN"], ...]`, the same in all directions.
    pub radial: Option<WayStiffness>,
    /// [N/m] stiffness along it, or a table, which holds both ways alike from `[0, 0]` on, or begins below 0; none if not given.
    pub axial: Option<WayStiffness>,
    /// Which forces of the shaft along its axis it takes: `"both"`, `"+x"` or `"-x"`.
    pub axial_way: AxialTaken,
    /// [N m/rad] stiffness of a tilt, or a table of angle and moment; none if not given.
    pub tilt: Option<TurnStiffness>,
    /// [N m/rad] stiffness of a twist, or a table of angle and moment, of a coupling alone; none if not given: its shafts turn freely against each other.
    pub torsion: Option<TurnStiffness>,
    /// \[m] play across the axis: how far the shaft goes from the middle before it is held; 0 if not given.
    pub gap: Option<Length>,
    /// [N s/m] damping across the axis; none if not given.
    pub radial_damping: Option<TranslationalDamping>,
    /// [N s/m] damping along it; none if not given.
    pub axial_damping: Option<TranslationalDamping>,
    /// [N m s/rad] damping of a tilt; none if not given.
    pub tilt_damping: Option<RotationalDamping>,
    /// [N m s/rad] damping of a twist, of a coupling alone; none if not given.
    pub torsion_damping: Option<RotationalDamping>,
}

/// Which forces along its axis a bearing takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum AxialTaken {
    /// Both ways.
    #[default]
    #[serde(rename = "both")]
    Both,
    /// Along +x.
    #[serde(rename = "+x")]
    Along,
    /// Along -x.
    #[serde(rename = "-x")]
    Against,
}
