//! What a shaft on its bearings does: motion at its points, drive, energies.

use nalgebra::{DVector, Vector3};

use super::first_stations;
use crate::model::structure::{Map, Shaft, Spin, StructureEnergies, StructurePowers, StructureState};
use crate::scene::system::SystemScene;

/// Motion of a point of the shaft, in the shaft's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointOutput {
    /// \[m] displacement.
    pub displacement: Vector3<f64>,
    /// [m/s] velocity.
    pub velocity: Vector3<f64>,
    /// \[rad] tilt of the axis about y and z; x is 0.
    pub tilt: Vector3<f64>,
}

/// Outputs of the shaft.
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
    /// Powers.
    pub powers: StructurePowers,
    /// Energies since the start.
    pub energies: StructureEnergies,
}

impl SystemOutputs {
    /// Those of a state at a time \[s].
    pub fn of(scene: &SystemScene, shaft: &Shaft, state: &StructureState, torque: f64, time: f64) -> Self {
        let at = |map: &Map| {
            let halves = |v: &DVector<f64>| -> [Vector3<f64>; 2] {
                let moved = map * v;
                [0, 3].map(|from| moved.fixed_rows::<3>(from).into_owned())
            };
            let ([displacement, tilt], [velocity, _]) = (halves(&state.coordinates), halves(&state.rates));
            PointOutput { displacement, velocity, tilt: Vector3::new(0.0, tilt.y, tilt.z) }
        };
        let [loads, points, discs, _] = first_stations(scene);
        let of = |range: std::ops::Range<usize>| shaft.stations[range].iter().map(at).collect();
        Self {
            time,
            spin: state.spin,
            torque,
            seats: of(0..loads),
            loads: of(loads..points),
            points: of(points..discs),
            powers: state.powers,
            energies: state.energies,
        }
    }
}
