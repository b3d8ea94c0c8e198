//! The section of a cylindrical or tapered roller bearing of a machine, `[bearing.rollers]`.

use serde::Deserialize;

use super::mesh::AxialTaken;
use super::units::*;

/// A roller bearing of one row: rollers in balance wherever its rings are.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RollersSection {
    /// [-] number of rollers.
    pub count: usize,
    /// \[m] diameter of a roller.
    pub diameter: Length,
    /// \[m] effective length of a roller: without its rounded ends.
    pub length: Length,
    /// \[m] diameter of the circle of roller centres.
    pub pitch_diameter: Length,
    /// \[m] play of the shaft across the axis, from end to end; negative is a preload, 0 if not given.
    pub diametral_clearance: Option<Length>,
    /// How rollers fall off towards their ends: `"logarithmic"` (ISO/TS 16281, if not given) or `"straight"`.
    #[serde(default)]
    pub profile: RollerProfile,
    /// \[m] radius of a crown in place of that.
    pub crown_radius: Option<Length>,
    /// Which forces of the shaft along the bearing's x axis its ribs take: `"both"` (NUP), `"+x"` or `"-x"` (NJ); none if not given (N, NU).
    pub axial_way: Option<AxialTaken>,
    /// \[m] play of the shaft along the axis between the ribs, from end to end; of a tapered bearing how far the inner ring goes along x before it touches, negative is a
    /// preload. 0 if not given.
    pub axial_clearance: Option<Length>,
    /// \[rad] angle between the axis and the line on the outer race of a tapered bearing, which a force of the shaft along the bearing's x axis presses together; none of
    /// cylindrical rollers.
    pub contact_angle: Option<Angle>,
    /// \[rad] angle between both lines of a tapered roller; goes with it.
    pub roller_angle: Option<Angle>,
    /// [N/m] stiffness of a roller between the ribs of both rings; that of punches of a twentieth of its diameter if not given.
    pub rib_stiffness: Option<TranslationalStiffness>,
    /// \[N] basic dynamic load rating C; by ISO 281 if not given.
    pub dynamic_load_rating: Option<Force>,
    /// [N s/m] damping across the axis; none if not given.
    pub radial_damping: Option<TranslationalDamping>,
    /// [N s/m] damping along it; none if not given.
    pub axial_damping: Option<TranslationalDamping>,
    /// [N m s/rad] damping of a tilt; none if not given.
    pub tilt_damping: Option<RotationalDamping>,
}

/// How rollers fall off towards their ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RollerProfile {
    /// By the logarithm of ISO/TS 16281.
    #[default]
    Logarithmic,
    /// Not at all.
    Straight,
}
