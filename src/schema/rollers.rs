//! The section of a cylindrical or tapered roller bearing of a machine, `[bearing.rollers]`, with its oil and what is around its rollers.

use serde::Deserialize;

use super::mesh::AxialTaken;
use super::units::*;
use crate::effects::film::Supplied;

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
    /// [-] friction coefficient of roller ends on ribs where no oil parts them; without `film` none if not given, with it 0.08.
    pub rib_friction: Option<f64>,
    /// \[m] radius of the ball that touches a plane as a roller's end touches a rib, for the film there; 10 diameters if not given, an estimate.
    pub rib_radius: Option<Length>,
    /// Oil between rollers, races and ribs: rolling resistance, and friction of films on ribs. Dry if not given.
    pub film: Option<RollerFilm>,
    /// What rollers move through: drag, and the moment against their spin. None if not given.
    pub ambient: Option<RollerAmbient>,
}

/// Oil of a roller bearing, and the surfaces that it parts. Keys are those of `[film]` of a ball bearing.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { iso_vg = 68, temperature = \"70 degC\" }")]
pub struct RollerFilm {
    /// [mm2/s] ISO viscosity grade: kinematic viscosity at 40 degC of a mineral oil with a viscosity index of 95.
    pub iso_vg: Option<f64>,
    /// \[degC] temperature of the oil where it enters the contacts; goes with the grade.
    pub temperature: Option<Celsius>,
    /// [Pa s] dynamic viscosity where the oil enters the contacts, instead of grade and temperature.
    pub viscosity: Option<Viscosity>,
    /// [kg/m3] density; 880 if not given.
    pub density: Option<Density>,
    /// [1/Pa] growth of the viscosity with pressure; 2.2e-8 if not given.
    pub pressure_viscosity: Option<PressureViscosity>,
    /// [1/K] fall of the viscosity with temperature; that of the grade if not given, 0.035 with `viscosity`.
    pub temperature_viscosity: Option<f64>,
    /// [W/(m K)] thermal conductivity; 0.14 if not given.
    pub conductivity: Option<f64>,
    /// \[Pa] Eyring stress; 6 MPa if not given.
    pub eyring_stress: Option<Pressure>,
    /// [-] largest shear stress over pressure; 0.08 if not given.
    pub limiting_shear: Option<f64>,
    /// \[m] roughness of both surfaces together, root mean square, of races and of ribs; 0.1 um if not given.
    pub roughness: Option<Length>,
    /// How oil comes back to where rollers have pushed it away: `"bath"` (if not given), `"oil_air"` or `"flooded"`.
    pub supply: Option<Supplied>,
    /// \[m] bore of the inner ring, for that; usual if not given.
    pub bore: Option<Length>,
    /// \[m] outside diameter of the outer ring, for that; usual if not given.
    pub outside: Option<Length>,
}

/// What the rollers of a bearing move through. Keys are those of `[effects.ambient]` of a ball bearing.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RollerAmbient {
    /// [kg/m3] density: 1.2 of air, 10 to 100 of a mist of oil, 850 of oil.
    pub density: Density,
    /// [Pa s] dynamic viscosity: 18e-6 of air.
    pub viscosity: Viscosity,
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
