//! What a shaft on its bearings does, and what their housings do: motion at points, drive, energies.

use nalgebra::{DVector, Vector3};

use super::{first_stations, housing_stations};
use crate::model::structure::{Carrier, Map, Spin, StructureEnergies, StructurePowers, StructureState};
use crate::scene::system::SystemScene;

/// Motion of a point of a structure, in the shaft's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointOutput {
    /// \[m] displacement.
    pub displacement: Vector3<f64>,
    /// [m/s] velocity.
    pub velocity: Vector3<f64>,
    /// \[rad] rotation; x is 0 of a shaft: its turn is no tilt.
    pub tilt: Vector3<f64>,
}

/// Outputs of a housing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HousingOutputs {
    /// Motion at the bearings that sit in it, in the order of the scene.
    pub seats: Vec<PointOutput>,
    /// Motion at its named loads.
    pub loads: Vec<PointOutput>,
    /// Motion at its named points.
    pub points: Vec<PointOutput>,
    /// Powers.
    pub powers: StructurePowers,
    /// Energies since the start.
    pub energies: StructureEnergies,
}

/// Outputs of the shaft and the housings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SystemOutputs {
    /// \[s] time.
    pub time: f64,
    /// Turn of the shaft.
    pub spin: Spin,
    /// [N m] torque that drives it.
    pub torque: f64,
    /// Motion at every bearing, in the order of the scene.
    pub seats: Vec<PointOutput>,
    /// Motion at every named load.
    pub loads: Vec<PointOutput>,
    /// Motion at every named point.
    pub points: Vec<PointOutput>,
    /// Powers of the shaft.
    pub powers: StructurePowers,
    /// Its energies since the start.
    pub energies: StructureEnergies,
    /// What the housings do, in the order of the scene.
    pub housings: Vec<HousingOutputs>,
    /// Energies since the start of rings that slide in bores of the ground; none where there are none.
    pub ground: Option<StructureEnergies>,
}

/// Motion of a station.
fn moved(map: &Map, state: &StructureState) -> PointOutput {
    let halves = |v: &DVector<f64>| -> [Vector3<f64>; 2] {
        let moved = map * v;
        [0, 3].map(|from| moved.fixed_rows::<3>(from).into_owned())
    };
    let ([displacement, tilt], [velocity, _]) = (halves(&state.coordinates), halves(&state.rates));
    PointOutput { displacement, velocity, tilt }
}

impl SystemOutputs {
    /// Those of states of the shaft and the housings at a time \[s].
    pub fn of(
        scene: &SystemScene,
        carriers: &[Carrier],
        states: &[StructureState],
        torque: f64,
        time: f64,
    ) -> Self {
        let (shaft, state) = (&carriers[0], &states[0]);
        let [loads, points, discs, _] = first_stations(scene);
        let on_shaft = |map: &Map| {
            let PointOutput { displacement, velocity, tilt } = moved(map, state);
            PointOutput { displacement, velocity, tilt: Vector3::new(0.0, tilt.y, tilt.z) }
        };
        let of = |range: std::ops::Range<usize>| shaft.stations[range].iter().map(on_shaft).collect();
        let housings = scene.housings.iter().zip(carriers[1..].iter().zip(&states[1..])).enumerate();
        let housings = housings.map(|(index, (_, (carrier, state)))| {
            let mut all = carrier.stations.iter().map(|map| moved(map, state));
            let [loads, points] = housing_stations(scene, index);
            HousingOutputs {
                seats: all.by_ref().take(loads).collect(),
                loads: all.by_ref().take(points - loads).collect(),
                points: all.collect(),
                powers: state.powers,
                energies: state.energies,
            }
        });
        Self {
            time,
            spin: state.spin,
            torque,
            seats: of(0..loads),
            loads: of(loads..points),
            points: of(points..discs),
            powers: state.powers,
            energies: state.energies,
            housings: housings.collect(),
            ground: states
                .get(scene.housings.len() + 1)
                .filter(|state| !state.coordinates.is_empty())
                .map(|state| state.energies),
        }
    }
}
