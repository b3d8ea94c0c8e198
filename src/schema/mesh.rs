//! The section of two gears in mesh, `[[mesh]]`, and of a bearing by its stiffness, `[bearing.stiffness]`.

use serde::Deserialize;

use super::units::*;

/// Two gears in mesh, with outside teeth, each on a shaft of its own.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshSection {
    /// Its name: letters, digits, _ and -.
    pub name: String,
    /// \[m] normal module.
    pub normal_module: Length,
    /// \[rad] normal pressure angle; 20 degrees if not given.
    pub pressure_angle: Option<Angle>,
    /// \[rad] helix angle of the first gear, positive for right-hand teeth (ISO 21771); the other one has the other hand. 0 if not given.
    pub helix_angle: Option<Angle>,
    /// Both gears.
    pub gears: [MeshGear; 2],
    /// [N/m] stiffness along the normal of the teeth; the mean one of ISO 6336-1 if not given.
    pub stiffness: Option<TranslationalStiffness>,
    /// [-] damping over critical damping of both shafts turning against each other; 0.05 if not given.
    pub damping_ratio: Option<f64>,
    /// \[m] play along the normal between both flanks; what profile shifts and centre distance leave if not given.
    pub backlash: Option<Length>,
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
    /// [-] profile shift, of the normal module; 0 if not given.
    #[serde(default)]
    pub profile_shift: f64,
    /// \[m] diameter over the tips, for the contact ratio of the mean stiffness; the usual one if not given.
    pub tip_diameter: Option<Length>,
}

/// A bearing that is not simulated: springs and dampers between the shaft and what its outer ring sits in.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StiffnessSection {
    /// [N/m] stiffness across the axis.
    pub radial: TranslationalStiffness,
    /// [N/m] stiffness along it; none if not given.
    pub axial: Option<TranslationalStiffness>,
    /// Which forces of the shaft along its axis it takes: `"both"`, `"+x"` or `"-x"`.
    #[serde(default)]
    pub axial_way: AxialTaken,
    /// [N m/rad] stiffness of a tilt; none if not given.
    pub tilt: Option<RotationalStiffness>,
    /// \[m] play across the axis: how far the shaft goes from the middle before it is held; 0 if not given.
    pub gap: Option<Length>,
    /// [N s/m] damping across the axis; none if not given.
    pub radial_damping: Option<TranslationalDamping>,
    /// [N s/m] damping along it; none if not given.
    pub axial_damping: Option<TranslationalDamping>,
    /// [N m s/rad] damping of a tilt; none if not given.
    pub tilt_damping: Option<RotationalDamping>,
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
