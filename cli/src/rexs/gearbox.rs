//! A gearbox as a machine's file can have it, in SI and with x along all shafts.

use roulement::catalogue::rollers_of;

/// A gearbox.
#[derive(Debug, Default)]
pub struct Gearbox {
    /// Its title.
    pub title: String,
    /// [m/s2] acceleration of gravity.
    pub gravity: Option<[f64; 3]>,
    /// Oil of its ball bearings, if the file has one.
    pub oil: Option<Oil>,
    /// Its shafts.
    pub shafts: Vec<Shaft>,
    /// Its meshes.
    pub meshes: Vec<Mesh>,
    /// Its bearings.
    pub bearings: Vec<Bearing>,
    /// Springs between two shafts.
    pub couplings: Vec<Coupling>,
    /// Loads over its life.
    pub duty: Vec<Duty>,
}

/// A shaft of beams.
#[derive(Clone, Debug, Default)]
pub struct Shaft {
    /// Number in the file.
    pub id: u64,
    /// Its name in the machine.
    pub name: String,
    /// \[m] where its positions count from.
    pub origin: [f64; 3],
    /// Does it point along x in its file (1), or against it (-1)?
    pub way: f64,
    /// \[m] position in the machine of where its file counts from.
    pub begin: f64,
    /// [rad/s] speed, if it is given.
    pub speed: Option<f64>,
    /// [N m] torque about x, if it is given or follows from that of others.
    pub torque: Option<f64>,
    /// \[m] where speed or torque drives it.
    pub drive_position: Option<f64>,
    /// Its material, if the file has one.
    pub material: Option<Material>,
    /// Its sections, by growing position.
    pub sections: Vec<Section>,
    /// Discs, such as the bodies of its gears.
    pub discs: Vec<Disc>,
    /// Forces and moments.
    pub loads: Vec<Load>,
}

/// A material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// \[Pa] Young's modulus.
    pub youngs_modulus: f64,
    /// [-] Poisson's ratio.
    pub poisson_ratio: f64,
    /// [kg/m3] density.
    pub density: f64,
}

/// What a machine's shafts are made of, where their file says nothing.
pub const STEEL: Material = Material { youngs_modulus: 206e9, poisson_ratio: 0.3, density: 7800.0 };
/// [kg/m3] density of gears on shafts whose material is not given.
const GEAR_STEEL: f64 = 7850.0;

impl Shaft {
    /// \[m] position in the machine of one in its file.
    pub fn position(&self, own: f64) -> f64 {
        self.begin + own * self.way
    }

    /// [kg/m3] density of the gears on it.
    pub fn gear_density(&self) -> f64 {
        self.material.map_or(GEAR_STEEL, |material| material.density)
    }
}

/// A cylindrical piece of a shaft; lengths in m.
#[derive(Clone, Copy, Debug, Default)]
pub struct Section {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Outer diameter.
    pub outer: f64,
    /// Bore.
    pub inner: f64,
}

/// A rigid disc.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disc {
    /// \[m] position.
    pub position: f64,
    /// \[kg] mass.
    pub mass: f64,
    /// [kg m2] moment of inertia about the axis.
    pub polar: f64,
    /// [kg m2] moment of inertia about a diameter.
    pub transverse: f64,
}

/// A force and a moment at a point of a shaft.
#[derive(Clone, Debug, Default)]
pub struct Load {
    /// Number in the file.
    pub id: u64,
    /// Its name in the machine.
    pub name: String,
    /// \[m] position.
    pub position: f64,
    /// \[N] force.
    pub force: [f64; 3],
    /// [N m] moment; about x none, which is torque.
    pub moment: [f64; 3],
}

/// Two gears in mesh.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Its name in the machine.
    pub name: String,
    /// \[m] normal module.
    pub module: f64,
    /// [rad] normal pressure angle.
    pub pressure_angle: f64,
    /// [rad] helix angle of the first gear, positive for right-hand teeth.
    pub helix_angle: f64,
    /// Its gears.
    pub gears: [Gear; 2],
}

/// A gear of a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gear {
    /// Index of its shaft.
    pub shaft: usize,
    /// \[m] position of the middle of its teeth.
    pub position: f64,
    /// [-] teeth.
    pub teeth: u32,
    /// Are they inside a ring?
    pub inside: bool,
    /// \[m] width of its teeth.
    pub face_width: f64,
    /// [-] profile shift.
    pub profile_shift: f64,
}

impl Mesh {
    /// [-] turns of the second shaft in one turn of the first.
    pub fn ratio(&self) -> f64 {
        let [one, other] = &self.gears;
        let way = if other.inside { 1.0 } else { -1.0 };
        way * f64::from(one.teeth) / f64::from(other.teeth)
    }
}

/// A bearing.
#[derive(Clone, Debug, Default)]
pub struct Bearing {
    /// Its name in the machine.
    pub name: String,
    /// Index of its shaft.
    pub shaft: usize,
    /// Index of the shaft that its outer ring is a part of.
    pub outer_shaft: Option<usize>,
    /// \[m] position.
    pub position: f64,
    /// What it is.
    pub kind: Kind,
    /// Does its seat hold it along the axis?
    pub held: bool,
    /// Is its x axis against that of the shaft?
    pub reversed: bool,
    /// \[m] displacement of preload.
    pub preload: f64,
    /// \[m] offset of its bore along y and z.
    pub offset: [f64; 2],
    /// [rad] tilt of its bore about y and z.
    pub misalignment: [f64; 2],
    /// \[m] play across the axis, if the file has it and not the catalogue.
    pub clearance: Option<f64>,
    /// What the comment beside it says.
    pub comment: String,
}

/// What a bearing is.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A designation of the catalogue.
    Catalogue(String),
    /// A designation of the catalogue's rollers.
    Rollers(String),
    /// Keys of a scene, in one line of TOML.
    Scene(String),
    /// Springs.
    Springs(Springs),
}

impl Default for Kind {
    fn default() -> Self {
        Self::Springs(Springs::default())
    }
}

impl Bearing {
    /// Key of its oil in what is set of it; none of springs, and of rollers between two shafts, whose friction is not simulated.
    pub fn film(&self) -> Option<&'static str> {
        match self.kind {
            Kind::Catalogue(_) | Kind::Scene(_) => Some("film"),
            Kind::Rollers(_) if self.outer_shaft.is_none() => Some("rollers.film"),
            Kind::Rollers(_) | Kind::Springs(_) => None,
        }
    }
}

impl Kind {
    /// Its designation; none of what has none.
    pub fn name(&self) -> &str {
        match self {
            Self::Catalogue(name) | Self::Rollers(name) => name,
            Self::Scene(_) | Self::Springs(_) => "",
        }
    }

    /// Is it a tapered roller bearing, which takes axial forces one way?
    pub fn is_tapered(&self) -> bool {
        matches!(self, Self::Rollers(name) if matches!(rollers_of(name), Some(Ok(keys)) if keys.contains("contact_angle")))
    }

    /// Is it a ball bearing, whose seat may slide?
    pub fn has_balls(&self) -> bool {
        matches!(self, Self::Catalogue(_) | Self::Scene(_))
    }
}

/// Springs; those of 0 are none.
#[derive(Clone, Copy, Debug, Default)]
pub struct Springs {
    /// [N/m] across the axis.
    pub radial: f64,
    /// [N/m] along it.
    pub axial: f64,
    /// Which forces of the shaft along x they take: both (0), along x (1), against it (-1).
    pub way: f64,
    /// [N m/rad] of a tilt.
    pub tilt: f64,
    /// [N m/rad] of a twist, of a coupling alone.
    pub torsion: f64,
}

/// Oil by its viscosity [m2/s] at 40 and 100 degrees, its density [kg/m3] at 15, and its temperature [degC].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oil {
    /// [m2/s] at 40 and at 100 degC.
    pub viscosity: [f64; 2],
    /// [kg/m3] at 15 degC.
    pub density: f64,
    /// [degC] temperature.
    pub temperature: f64,
}

/// Springs between two shafts on one axis.
#[derive(Clone, Debug, Default)]
pub struct Coupling {
    /// Its name in the machine.
    pub name: String,
    /// Indices of its shafts.
    pub shafts: [usize; 2],
    /// \[m] position along the first.
    pub position: f64,
    /// Its springs.
    pub springs: Springs,
    /// What the comment beside it says.
    pub comment: String,
}

/// A load over the gearbox's life.
#[derive(Clone, Debug, Default)]
pub struct Duty {
    /// Its name.
    pub name: String,
    /// [-] share of the time.
    pub share: f64,
    /// Keys of the machine and their values, as a file has them.
    pub set: Vec<(String, String)>,
}
