//! Links between two structures, or a structure and the ground: forces without mass, by the relative motion at a common place.
//!
//! ```text
//! d = u_1 - u_2          displacement and rotation of both ends at the place: maps of their coordinates
//! f = f(d, d')           force and moment at the place on the first end, -f on the second
//! ```
//! Both act at one place, so that forces and moments of a link are in balance. What is stored is a potential of `d`, what is damped is
//! never negative. Rollers between two shafts that turn have a turn of `d` that both have a share in: that of their cage.

mod force;
pub mod force_table;
pub mod gear_pair;
mod line;
pub mod one_sided;
pub mod roller;
pub mod roller_friction;
mod roller_oil;
pub mod rollers;
pub mod spring_bearing;
pub mod tooth_mesh;
pub mod variation;

use std::f64::consts::TAU;

use nalgebra::{DVector, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::structure::{Map, Spin, Structure, StructureState, Turning};
pub use force::LinkForce;
use rollers::{Left, Rollers};
use spring_bearing::SpringBearing;
use tooth_mesh::ToothMesh;
use variation::Variation;

/// An end of a link on a structure.
#[derive(Clone, Debug)]
pub struct LinkEnd {
    /// Index of the structure.
    pub structure: usize,
    /// Coordinates of the structure that move it.
    pub coordinates: Vec<usize>,
    /// Displacement and rotation at the place by these.
    pub map: Map,
    /// Displacement and rotation by a turn that is given; zero where that is a coordinate.
    pub turn: Vector6<f64>,
    /// [-] share of its turn about the axis that counts: 1, but of the outer ring of rollers, where that is on a shaft.
    share: f64,
}

impl LinkEnd {
    /// At a place that lies `arm` \[m] beside a station of a structure and goes with it.
    pub fn new(index: usize, structure: &Structure, station: &Map, arm: &Vector3<f64>) -> Self {
        let mut moved = station.clone();
        // `u + r x arm`
        let by_rotation = -arm.cross_matrix() * station.fixed_rows::<3>(3);
        let mut displacement = moved.fixed_rows_mut::<3>(0);
        displacement += by_rotation;
        let coordinates: Vec<usize> = (0..moved.ncols()).filter(|k| moved.column(*k).amax() > 0.0).collect();
        let map = Map::from_fn(coordinates.len(), |row, k| moved[(row, coordinates[k])]);
        let turn = match structure.turning {
            Turning::Given => {
                let sweep = Vector3::x().cross(arm);
                Vector6::new(sweep.x, sweep.y, sweep.z, 1.0, 0.0, 0.0)
            }
            Turning::Still | Turning::Free => Vector6::zeros(),
        };
        Self { structure: index, coordinates, map, turn, share: 1.0 }
    }

    /// The outer ring of rollers, on a shaft: where its turn stands still in the middle, that of the inner ring does all of the cage's.
    pub fn around(mut self, rollers: &Rollers) -> Self {
        self.share = rollers.share_of_outer();
        self.map.row_mut(3).scale_mut(self.share);
        self.turn[3] *= self.share;
        self
    }

    fn moved(&self, values: &DVector<f64>, turned: f64) -> Vector6<f64> {
        let columns = self.coordinates.iter().zip(self.map.column_iter());
        columns.fold(self.turn * turned, |sum, (k, column)| sum + column * values[*k])
    }

    /// Displacement and its rate at a state.
    fn motion(&self, state: &StructureState) -> [Vector6<f64>; 2] {
        let Spin { angle, speed, .. } = state.spin;
        [self.moved(&state.coordinates, angle), self.moved(&state.rates, speed)]
    }
}

/// Force law of a link.
#[derive(Clone, Debug)]
pub enum Law {
    /// Teeth in mesh.
    Mesh(ToothMesh),
    /// A bearing by its stiffness, or a coupling.
    Spring(SpringBearing),
    /// A roller bearing without states.
    Rollers(Rollers),
}

/// A link.
#[derive(Clone, Debug)]
pub struct Link {
    /// One end, or two; of one, the other is in the ground.
    pub ends: Vec<LinkEnd>,
    /// Its law.
    pub law: Law,
}

/// State of a link: its motion and force now, its energies since the start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinkState {
    /// \[m, rad] displacement of the first end against the second; of rollers on two shafts with the turn that [`Rollers::share_of_outer`] says.
    pub displacement: Vector6<f64>,
    /// [m/s, rad/s] its rate.
    pub rate: Vector6<f64>,
    /// \[N, N m] force and moment on the first end.
    pub force: Vector6<f64>,
    /// \[W] taken from its ends, and lost.
    pub powers: [f64; 2],
    /// \[J] stored.
    pub stored: f64,
    /// \[J] that at the start.
    pub at_start: f64,
    /// \[J] taken from its ends since the start.
    pub taken: f64,
    /// \[J] lost since the start.
    pub damped: f64,
    /// [-] force that is left on a body inside of it, over what may be ([`LinkForce::unbalanced`]).
    pub unbalanced: f64,
    /// Its rollers as they were left.
    pub rollers: Vec<Left>,
    /// [rad/s] speed of their outer ring, if that is on a shaft.
    pub outer_speed: Option<f64>,
}

impl LinkState {
    /// \[J] taken, but neither lost nor stored.
    pub fn unaccounted(&self) -> f64 {
        self.taken - self.damped - (self.stored - self.at_start)
    }
}

/// The sign with which an end counts.
pub fn sign(end: usize) -> f64 {
    if end == 0 { 1.0 } else { -1.0 }
}

impl Link {
    /// Displacement of the first end against the second, and its rate.
    pub fn motion<'a>(&self, state: impl Fn(usize) -> &'a StructureState) -> [Vector6<f64>; 2] {
        let zero = [Vector6::zeros(); 2];
        self.ends.iter().enumerate().fold(zero, |[d, rate], (index, end)| {
            let [own, own_rate] = end.motion(state(end.structure));
            [d + own * sign(index), rate + own_rate * sign(index)]
        })
    }

    /// Force at a displacement and a rate, near a state.
    pub fn force(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>, near: &LinkState) -> LinkForce {
        match &self.law {
            Law::Mesh(mesh) => mesh.force(displacement, rate, None),
            Law::Spring(bearing) => bearing.force(displacement, rate),
            Law::Rollers(bearing) => bearing.force_near(displacement, rate, &near.rollers),
        }
    }

    /// Force without what varies as the link turns, as statics and natural frequencies take it; of teeth that stay in contact on a flank, if one is named.
    pub fn mean_force(
        &self,
        displacement: &Vector6<f64>,
        rate: &Vector6<f64>,
        flank: Option<usize>,
    ) -> LinkForce {
        match &self.law {
            Law::Mesh(mesh) => mesh.mean_force(displacement, rate, flank),
            Law::Spring(bearing) => bearing.force(displacement, rate),
            Law::Rollers(bearing) => bearing.force(displacement, rate).without_turning(),
        }
    }

    /// \[s] shortest period of what varies as it turns at such a rate; none where nothing does.
    pub fn shortest_period(&self, rate: &Vector6<f64>) -> Option<f64> {
        let fastest = match &self.law {
            Law::Mesh(ToothMesh { turn, varying: Some(varying), .. }) => {
                let waves =
                    [&varying.stiffness, &varying.error].into_iter().filter_map(Variation::most_waves);
                waves.reduce(f64::max)? * turn * rate[3]
            }
            Law::Rollers(bearing) => bearing.passing(rate[3]),
            Law::Mesh(_) | Law::Spring(_) => return None,
        };
        (fastest != 0.0).then(|| TAU / fastest.abs())
    }

    /// State of the link while its ends are in these states, `h` \[s] after it did something else.
    pub fn reached<'a>(
        &self,
        before: &LinkState,
        h: f64,
        state: impl Fn(usize) -> &'a StructureState,
    ) -> LinkState {
        let [displacement, rate] = self.motion(&state);
        let (on, rollers) = match &self.law {
            Law::Rollers(bearing) => bearing.leave(&displacement, &rate, &before.rollers),
            Law::Mesh(_) | Law::Spring(_) => (self.force(&displacement, &rate, before), vec![]),
        };
        let LinkForce { force, stored, damped, unbalanced, .. } = on;
        let powers = [-force.dot(&rate), damped];
        let part = |k: usize| 0.5 * h * (before.powers[k] + powers[k]);
        let outer = self.ends.get(1).filter(|end| end.share != 1.0);
        LinkState {
            displacement,
            rate,
            force,
            powers,
            stored,
            at_start: before.at_start,
            taken: before.taken + part(0),
            damped: before.damped + part(1),
            unbalanced,
            rollers,
            outer_speed: outer.map(|end| end.motion(state(end.structure))[1][3] / end.share),
        }
    }

    /// State of the link at the start.
    pub fn started<'a>(&self, state: impl Fn(usize) -> &'a StructureState) -> LinkState {
        let start = self.reached(&LinkState::default(), 0.0, state);
        LinkState { at_start: start.stored, ..start }
    }
}
