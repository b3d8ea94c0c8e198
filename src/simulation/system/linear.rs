//! The linear equations of motion of a shaft, its housings and its bearings about where they are, and how they swing.
//!
//! ```text
//! M q'' + (C + W G) q' + K q = 0          W spin of the shaft
//! ```
//! In a frame that turns, Coriolis forces are in C and what depends on places in K.
//!
//! Coordinates are those of all structures, one after the other, then those of outer races under wrenches. Bearings are springs between their races, with the stiffness of their
//! quasi-static equilibrium, and dampers, with their balls condensed out ([`crate::analysis::condensed`]); what supports of a bearing's own
//! weigh and damp is left out. Dampers are those of rolling: where balls hardly roll there are none, as a contact that sticks is a spring
//! across its normal and no damper.

use nalgebra::{Complex, DMatrix, DVector, Matrix6};

use super::super::play::Scripted;
use super::links;
use super::statics::{Statics, of_link};
use super::{System, SystemError};
use crate::analysis::condensed::Condensed;
use crate::dynamics::system::StructureLoad;
use crate::model::bodies::{Race, RigidBody};
use crate::model::state::BodyState;
use crate::model::structure::{Carrier, Map, Structure, StructureState};
use crate::numerics::given::take_out;
use crate::numerics::modes::{Mode, modes};
use crate::scene::Drive;
use crate::simulation::motions::free;

/// [-] of the displacements of a mode: more along the axis is an axial one; less whirl goes to and fro.
const HALF: f64 = 0.5;

/// [m/s] rolling speed from which on contacts damp: above it some 0.1 mm of a contact are rolled over in the period of 1 kHz.
const ROLLS: f64 = 0.1;

/// Linear equations of motion.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Mass matrix.
    pub mass: DMatrix<f64>,
    /// Damping, and gyroscopic terms at the spin of the shaft.
    pub damping: DMatrix<f64>,
    /// Stiffness.
    pub stiffness: DMatrix<f64>,
}

/// How shafts, and rings under wrenches, go in a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whirl {
    /// Round its axis as it turns itself.
    Forward,
    /// Round its axis against its own turn.
    Backward,
    /// To and fro across its axis.
    Planar,
    /// Along its axis.
    Axial,
}

impl Whirl {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Backward => "backward",
            Self::Planar => "planar",
            Self::Axial => "axial",
        }
    }
}

/// A mode of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftMode {
    /// \[Hz] frequency.
    pub frequency: f64,
    /// [-] damping over critical damping.
    pub damping: f64,
    /// How the shaft goes.
    pub whirl: Whirl,
    /// Where the machine moves most.
    pub place: String,
}

/// An outer race under a wrench: a body beside the structures.
pub(super) struct Ring<'a> {
    bearing: usize,
    moved: &'a RigidBody,
    state: &'a BodyState,
    /// First of its coordinates among all.
    first: usize,
    /// Its free directions, one for each coordinate.
    free: Vec<usize>,
}

impl Ring<'_> {
    /// Its motion by so many coordinates of all.
    fn map(&self, size: usize) -> Map {
        let mut map = Map::zeros(size);
        self.free.iter().enumerate().for_each(|(k, row)| map[(*row, self.first + k)] = 1.0);
        map
    }
}

impl System {
    /// Linear equations of motion about the present state.
    ///
    /// # Errors
    /// If a bearing has no equilibrium where it is.
    pub fn linear(&self) -> Result<Linear, SystemError> {
        let mut bearings = self.bearings.clone();
        let of = |index: usize| {
            let (carrier, spin) = (&self.structures.carriers[index], self.structures.states[index].spin);
            StructureLoad {
                force: DVector::zeros(carrier.structure.size()),
                spin,
                axial_moment: 0.0,
                frame: None,
                held: vec![],
            }
        };
        let loads: Vec<_> = (0..self.structures.carriers.len()).map(of).collect();
        let condensed = |bearing: &super::Simulation| {
            let supported = bearing.model.supports.iter().any(Option::is_some);
            let of = || Condensed::new(&bearing.model, &bearing.state, &bearing.conditions()).damping;
            let rolls = bearing.outputs().rolling_speed.abs() > ROLLS;
            if rolls && !supported { of() } else { Matrix6::zeros() }
        };
        let mut dampers: Vec<_> = self.bearings.iter().map(condensed).collect();
        let rings = self.rings();
        let of_rings: Vec<_> = rings.iter().map(|ring| std::mem::take(&mut dampers[ring.bearing])).collect();
        let mut statics = Statics {
            scene: &self.structures.scene,
            time: self.time(),
            carriers: &self.structures.carriers,
            scales: &self.structures.scales,
            loads: &loads,
            joints: &self.structures.joints,
            links: &self.structures.links,
            flanks: vec![None; self.structures.links.len()],
            bearings: &mut bearings,
            friction: &mut vec![0.0; dampers.len()],
        };
        let (mut stiffness, of_bearings) = statics.stiffness(&self.structures.states)?;
        let mut damping = statics.spread(&dampers);
        for (link, state) in self.structures.links.iter().zip(&self.structures.link_states) {
            let map = of_link(link, &statics.first());
            damping -= map.tr_mul(&(link.mean_force(&state.displacement, &state.rate, None).by_rate * &map));
        }
        let mut mass = DMatrix::zeros(damping.nrows(), damping.nrows());
        for ((Carrier { structure, .. }, state), from) in
            self.structures.carriers.iter().zip(&self.structures.states).zip(statics.first())
        {
            let at = ((from, from), (structure.size(), structure.size()));
            mass.view_mut(at.0, at.1).copy_from(&structure.mass);
            let mut own = damping.view_mut(at.0, at.1);
            own += &*structure.damping + &*structure.gyroscopic * state.spin.speed;
            if let Some([stiff, coriolis]) = self.frame_matrices(structure, state) {
                own += coriolis;
                let mut own = stiffness.view_mut(at.0, at.1);
                own += stiff;
            }
        }
        let relative: Vec<Map> =
            rings.iter().map(|ring| statics.relative(ring.bearing, &statics.first())).collect();
        for (ring, relative) in rings.iter().zip(&relative) {
            // At rest it follows the structures; as a body it is no part of them.
            stiffness -= relative.tr_mul(&(of_bearings[ring.bearing] * relative));
        }
        let size = rings.last().map_or(mass.nrows(), |ring| ring.first + ring.free.len());
        let [mut mass, mut damping, mut stiffness] =
            [mass, damping, stiffness].map(|matrix| matrix.resize(size, size, 0.0));
        for ((ring, damper), relative) in rings.iter().zip(&of_rings).zip(relative) {
            let bearing = &self.bearings[ring.bearing];
            let across = relative.resize_horizontally(size, 0.0) - ring.map(size);
            let between = Condensed::new(&bearing.model, &bearing.state, &bearing.conditions()).stiffness;
            stiffness += across.tr_mul(&(between * &across));
            damping += across.tr_mul(&(damper * &across));
            let own = bearing.mover(ring.moved, ring.state);
            let at = ((ring.first, ring.first), (ring.free.len(), ring.free.len()));
            for (whole, own) in
                [(&mut mass, own.mass), (&mut damping, own.damping), (&mut stiffness, own.stiffness)]
            {
                let mut part = whole.view_mut(at.0, at.1);
                part += own;
            }
        }
        // What is given does not swing; inertia does not couple it with what does.
        for matrix in [&mut damping, &mut stiffness] {
            take_out(matrix, self.held(), 0.0);
        }
        Ok(Linear { mass, damping, stiffness })
    }

    /// Outer races under wrenches, where forces move them.
    pub(super) fn rings(&self) -> Vec<Ring<'_>> {
        let mut first = self.structures.carriers.iter().map(|carrier| carrier.structure.size()).sum();
        let all = self.bearings.iter().enumerate();
        let under_wrench = all.filter(|(_, bearing)| bearing.scene.outer.drive == Drive::Wrench);
        let moved = under_wrench.flat_map(|(index, bearing)| {
            let bodies = bearing.moving_bodies().filter(|(body, ..)| *body == Race::Outer.into());
            bodies.map(move |(_, moved, state)| (index, moved, state))
        });
        let ring = |(bearing, moved, state)| {
            let free = free(moved);
            let ring = Ring { bearing, moved, state, first, free };
            first += ring.free.len();
            ring
        };
        moved.map(ring).collect()
    }

    /// Stiffness and damping of a structure in a state by a frame of the machine that turns now.
    pub(super) fn frame_matrices(
        &self,
        structure: &Structure,
        state: &StructureState,
    ) -> Option<[DMatrix<f64>; 2]> {
        let frame = self.structures.given(&self.scripts()).field(self.time()).turning?;
        Some(structure.frame_matrices(&frame, [&state.coordinates, &state.rates], &state.spin))
    }

    /// Coordinates, of those of all structures, whose motion is given.
    pub(super) fn held(&self) -> Vec<usize> {
        let mut first = 0;
        let of = |carrier: &Carrier| {
            let from = first;
            first += carrier.structure.size();
            carrier.structure.held.iter().map(move |k| from + k).collect::<Vec<_>>()
        };
        self.structures.carriers.iter().flat_map(of).collect()
    }

    /// All modes about the present state, by their frequency; none where eigenvalues are not found.
    ///
    /// # Errors
    /// As [`System::linear`].
    pub fn modes(&self) -> Result<Option<Vec<ShaftMode>>, SystemError> {
        let Linear { mass, damping, stiffness } = self.linear()?;
        let found = modes(&mass, &damping, &stiffness);
        let rings = self.rings();
        Ok(found.map(|modes| modes.iter().map(|mode| self.describe(mode, &rings)).collect()))
    }

    /// Moving parts of a mode of the structures and of outer races under wrenches, in words.
    pub(super) fn describe(&self, mode: &Mode, rings: &[Ring<'_>]) -> ShaftMode {
        // Displacements at every station of every structure.
        let mut first = 0;
        let mut moved: Vec<(usize, usize, [Complex<f64>; 3])> = vec![];
        for (index, carrier) in self.structures.carriers.iter().enumerate() {
            let own = mode.shape.rows(first, carrier.structure.size());
            first += own.len();
            for station in 0..carrier.stations.len() {
                let map = carrier.ring_at(station);
                let along = |axis: usize| {
                    map.row(axis).iter().zip(own.iter()).map(|(by, amplitude)| amplitude * *by).sum()
                };
                moved.push((index, station, [along(0), along(1), along(2)]));
            }
        }
        let count = self.structures.carriers.len();
        for (index, ring) in rings.iter().enumerate() {
            let along = |axis: usize| {
                let at = ring.free.iter().position(|own| *own == axis);
                at.map_or(Complex::from(0.0), |at| mode.shape[ring.first + at])
            };
            moved.push((count + index, 0, [along(0), along(1), along(2)]));
        }
        let size = |d: &[Complex<f64>; 3]| d.iter().map(Complex::norm_sqr).sum::<f64>();
        let shafts = self.structures.scene.shafts.len();
        let going = || moved.iter().filter(|(part, ..)| *part < shafts || *part >= count);
        let all: f64 = going().map(|(.., d)| size(d)).sum();
        let along: f64 = going().map(|(.., d)| d[0].norm_sqr()).sum();
        // From y to z is forwards on a shaft that turns about +x.
        let turn = |(part, _, d): &(usize, usize, [Complex<f64>; 3])| {
            let spin = match part.checked_sub(count) {
                Some(ring) => self.bearings[rings[ring].bearing].state.race(Race::Inner).rate.x,
                None => self.structures.states[*part].spin.speed,
            };
            -2.0 * (d[1].conj() * d[2]).im * spin.signum()
        };
        let whirl = going().map(turn).sum::<f64>() / (all - along);
        let whirl = match whirl {
            _ if along > HALF * all => Whirl::Axial,
            whirl if whirl > HALF => Whirl::Forward,
            whirl if whirl < -HALF => Whirl::Backward,
            _ => Whirl::Planar,
        };
        let most = moved.iter().max_by(|a, b| size(&a.2).total_cmp(&size(&b.2)));
        let place =
            most.map_or(String::new(), |(structure, station, _)| match structure.checked_sub(count) {
                Some(ring) => self.name_of_ring(rings[ring].bearing),
                None => self.place(*structure, *station),
            });
        ShaftMode { frequency: mode.frequency(), damping: mode.damping(), whirl, place }
    }

    /// Name of the outer ring of a bearing.
    fn name_of_ring(&self, bearing: usize) -> String {
        format!("the outer ring of {}", self.structures.scene.bearings[bearing].name)
    }

    /// Name of a station of the shaft or a housing.
    fn place(&self, structure: usize, station: usize) -> String {
        let scene = &self.structures.scene;
        let named = |names: Vec<String>| names.get(station).cloned();
        let numbered =
            |what: &str, count: usize| (1..=count).map(move |k| format!("{what} {k}")).collect::<Vec<_>>();
        let own = match structure.checked_sub(scene.shafts.len()) {
            None => {
                let shaft = &scene.shafts[structure];
                let mut names: Vec<String> =
                    scene.bearings_on(structure).map(|of| scene.bearings[of].name.clone()).collect();
                names.extend(shaft.load.iter().map(|of| of.name.clone()));
                names.extend(shaft.point.iter().map(|of| of.name.clone()));
                names.extend(numbered("disc", shaft.disc.len()));
                names.extend(numbered("gear", shaft.gear.len()));
                names.extend(numbered("rotating force", shaft.rotating.len()));
                names.extend(links::names(scene, structure));
                let which = if scene.shafts.len() == 1 { "the shaft" } else { &shaft.name };
                named(names).map(|name| format!("{which} at {name}"))
            }
            Some(index)
                if self.structures.carriers[structure].sliding.iter().any(|(at, _)| *at == station) =>
            {
                let bearing = match index < scene.housings.len() {
                    true => scene.bearings_in(index).nth(station),
                    false => scene.bearings_in_ground().nth(station),
                };
                bearing.map(|bearing| self.name_of_ring(bearing))
            }
            // Bores in the ground that do not move are no places of a mode.
            Some(index) if index >= scene.housings.len() => None,
            Some(index) => {
                let housing = &scene.housings[index];
                let mut names: Vec<String> =
                    scene.bearings_in(index).map(|of| scene.bearings[of].name.clone()).collect();
                names.extend(housing.load.iter().map(|of| of.name.clone()));
                names.extend(housing.point.iter().map(|of| of.name.clone()));
                let springs = scene.springs.iter().filter(|spring| spring.housing == Some(index));
                names.extend(springs.map(|spring| spring.name.clone()));
                named(names).map(|name| format!("{} at {name}", housing.name))
            }
        };
        own.unwrap_or_default()
    }
}
