//! A structure that carries races: a rigid or flexible shaft, or a housing, as linear equations of motion.
//!
//! ```text
//! M q'' + (C + W G) q' + 1/2 W' G q + K q + m W' = f          W spin of the shaft [rad/s], f loads and bearings
//! ```
//! Coordinates `q` are displacements from a frame that does not turn: lengths, angles, or amplitudes of modes. `G` is that of a spin of
//! 1 rad/s and skew; half of it stands with `W'` as the equations come from the energy `1/2 W q'^T G q` (they do no work then). Tilts
//! are taken as small: a shaft in bearings tilts by some mrad, what is left out is of their square.

mod beam;
mod held;
mod housing;
mod lump;
mod own_forces;
mod reduction;
mod ring;
mod shaft;
mod torsion;

pub use lump::{FrameForce, Lump, frame_matrices};
use nalgebra::{DVector, Dyn, OMatrix, U6, Vector3};
pub use own_forces::OwnForces;
pub use ring::Ring;
use serde::{Deserialize, Serialize};

use crate::numerics::sparse::Sparse;

/// Vectors of any length as lists of numbers.
mod list {
    use nalgebra::DVector;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(vector: &DVector<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        vector.as_slice().serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVector<f64>, D::Error> {
        Vec::deserialize(deserializer).map(DVector::from_vec)
    }
}

/// How a structure turns about the x axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turning {
    /// Not at all: a housing.
    Still,
    /// At a speed that is given.
    Given,
    /// By its torque: the angle is the last coordinate.
    Free,
}

/// Where something acts on a structure: displacement (0 to 2) and rotation (3 to 5) there, world axes, by the coordinates.
pub type Map = OMatrix<f64, U6, Dyn>;

/// A linear structure.
#[derive(Clone, Debug)]
pub struct Structure {
    /// Mass matrix of the coordinates.
    pub mass: Sparse,
    /// Damping matrix.
    pub damping: Sparse,
    /// Stiffness matrix.
    pub stiffness: Sparse,
    /// Gyroscopic matrix of a spin of 1 rad/s.
    pub gyroscopic: Sparse,
    /// [kg m2] polar moment of inertia.
    pub polar_inertia: f64,
    /// Inertia of the coordinates by an acceleration of the spin; zero where the angle is a coordinate.
    pub by_spin: DVector<f64>,
    /// Generalised force of an acceleration of 1 m/s2 of the frame along x, y, z, by column: weights.
    pub weights: OMatrix<f64, Dyn, nalgebra::U3>,
    /// Rigid parts that have its mass; none of one by matrices, which do not say where it is.
    pub lumps: Vec<Lump>,
    /// How it turns.
    pub turning: Turning,
    /// How many of its last coordinates are displacements of rings that slide along their bores.
    pub rings: usize,
    /// Coordinates whose motion is given ([`Carrier::holding`]); inertia does not couple them with others.
    pub held: Vec<usize>,
}

/// A structure that carries races, and what its stations do: places where races sit, loads act or motion is reported.
#[derive(Clone, Debug)]
pub struct Carrier {
    /// The structure.
    pub structure: Structure,
    /// Displacement and rotation at each station, by the coordinates.
    pub stations: Vec<Map>,
    /// Stations at which the outer ring slides along its bore, and the motion of that ring by the coordinates.
    pub sliding: Vec<(usize, Map)>,
    /// \[Hz] frequencies of the modes that were kept between stations that are held; none of a rigid structure, or of matrices.
    pub modes: Vec<f64>,
}

/// Motion of a structure, and what it takes to go on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StructureState {
    /// Coordinates \[m, rad or 1].
    #[serde(with = "list")]
    pub coordinates: DVector<f64>,
    /// Their rates.
    #[serde(with = "list")]
    pub rates: DVector<f64>,
    /// Rates of these.
    #[serde(with = "list")]
    pub accelerations: DVector<f64>,
    /// Total generalised force, the `g` of the HHT scheme.
    #[serde(with = "list")]
    pub total: DVector<f64>,
    /// Remainder of the equations of motion that the last step left, within their tolerance.
    #[serde(with = "list")]
    pub remainder: DVector<f64>,
    /// Turn and its rates.
    pub spin: Spin,
    /// [N m] torque that drives it: that given, or that which holds the given speed.
    pub torque: f64,
    /// \[N, N m] what holds each coordinate whose motion is given.
    pub holding: Vec<f64>,
    /// Powers now.
    pub powers: StructurePowers,
    /// Energies since the start.
    pub energies: StructureEnergies,
}

/// Turn of a structure about the x axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spin {
    /// \[rad] angle since the start.
    pub angle: f64,
    /// [rad/s] speed.
    pub speed: f64,
    /// [rad/s2] acceleration.
    pub acceleration: f64,
}

/// Powers of a structure at one instant \[W].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StructurePowers {
    /// Put in by loads, weight and drive.
    pub input: f64,
    /// Taken out by its bearings and links.
    pub bearings: f64,
    /// Lost to its damping.
    pub damping: f64,
}

/// Energies of a structure \[J]: sums since the start, and what is stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StructureEnergies {
    /// Work of loads, weight and drive.
    pub input: f64,
    /// Sum of the sizes of that work over the steps, whether it was put in or taken out.
    pub worked: f64,
    /// Given to its bearings and links.
    pub bearings: f64,
    /// Lost to its damping.
    pub damping: f64,
    /// Kinetic and elastic energy.
    pub stored: f64,
    /// That at the start.
    pub at_start: f64,
}

impl StructureEnergies {
    /// \[J] put in, but neither given on, lost nor stored.
    pub fn unaccounted(&self) -> f64 {
        self.input - self.bearings - self.damping - (self.stored - self.at_start)
    }

    /// \[J] what errors of the energy are measured by: all that was put in and taken out since the start.
    pub fn turned_over(&self) -> f64 {
        self.worked.max(self.damping)
    }
}

impl StructureState {
    /// Can a structure with that many coordinates, of which so many are given, be in this state?
    pub fn fits(&self, size: usize, held: usize) -> bool {
        let Self { coordinates, rates, accelerations, total, remainder, .. } = self;
        [coordinates, rates, accelerations, total, remainder]
            .iter()
            .all(|list| list.len() == size && list.iter().all(|value| value.is_finite()))
            && self.holding.len() == held
    }
}

impl Structure {
    /// Number of coordinates.
    pub fn size(&self) -> usize {
        self.mass.nrows()
    }

    /// Puts the coordinates that are given where they are: value, rate and its rate of each.
    pub fn hold(&self, state: &mut StructureState, given: &[[f64; 3]]) {
        for (k, [value, rate, acceleration]) in self.held.iter().zip(given) {
            state.coordinates[*k] = *value;
            state.rates[*k] = *rate;
            state.accelerations[*k] = *acceleration;
        }
    }

    /// \[m] size of a unit of each coordinate: root mean square, over the mass of the structure, of what it moves. Residuals times these
    /// compare with forces, errors of coordinates with lengths.
    pub fn scales(&self) -> DVector<f64> {
        let mass = (0..3).map(|axis| self.total_mass(axis)).fold(f64::MIN_POSITIVE, f64::max);
        let first_ring = self.size() - self.rings;
        DVector::from_fn(
            self.size(),
            |i, _| if i < first_ring { (self.mass[(i, i)] / mass).sqrt() } else { 1.0 },
        )
    }

    /// \[kg] mass that an acceleration along an axis meets, where rigid displacements are among the coordinates: `t^T M t`.
    fn total_mass(&self, axis: usize) -> f64 {
        if self.size() == 0 {
            return 0.0;
        }
        let weights = self.weights.column(axis);
        // `M t = w`, hence `t^T M t = w^T M^-1 w`.
        let solved = (*self.mass).clone().lu().solve(&weights.into_owned());
        solved.map_or(0.0, |t| weights.dot(&t))
    }

    /// Generalised force of gravity [m/s2].
    pub fn weight(&self, gravity: &Vector3<f64>) -> DVector<f64> {
        &self.weights * gravity
    }

    /// Turn at a state of the coordinates; `given` where that is not one of them.
    pub fn spin(&self, state: [&DVector<f64>; 3], given: Spin) -> Spin {
        match self.turning {
            Turning::Free => {
                let last = self.size() - 1;
                Spin { angle: state[0][last], speed: state[1][last], acceleration: state[2][last] }
            }
            Turning::Still | Turning::Given => given,
        }
    }
}
