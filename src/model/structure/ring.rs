//! Outer rings that slide along their bores: a coordinate each, behind those of what the bores are in.
//!
//! The coordinate is the displacement `s` of the ring along the axis `a` of its bore. Across it the ring goes with the bore, which
//! moves by `u`: `(1 - a a^T) u + a s`. There is no friction in the seat, so that nothing but the inertia and the weight of the ring
//! stands against the force of its bearing along `a`. Across the axis the mass of the ring is that of the housing.

use nalgebra::{DMatrix, DVector, Dyn, OMatrix, U3, Vector3};

use super::{Carrier, Lump, Map, Structure, Turning};

/// An outer ring that slides.
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    /// Station of its bore.
    pub station: usize,
    /// \[kg] mass.
    pub mass: f64,
    /// \[m] its place in the axes of the machine.
    pub place: Vector3<f64>,
    /// Axis of the bore.
    pub axis: Vector3<f64>,
}

impl Carrier {
    /// Bores in the ground: stations that do not move.
    pub fn of_ground(stations: usize) -> Self {
        let none = DMatrix::zeros(0, 0);
        let structure = Structure {
            mass: none.clone().into(),
            damping: none.clone().into(),
            stiffness: none.clone().into(),
            gyroscopic: none.into(),
            polar_inertia: 0.0,
            by_spin: DVector::zeros(0),
            weights: OMatrix::zeros_generic(Dyn(0), U3),
            lumps: vec![],
            turning: Turning::Still,
            rings: 0,
            held: vec![],
        };
        Self { structure, stations: vec![Map::zeros(0); stations], sliding: vec![], modes: vec![] }
    }

    /// Carrier with rings that slide at some of its stations.
    #[must_use]
    pub fn with_rings(self, rings: &[Ring]) -> Self {
        if rings.is_empty() {
            return self;
        }
        let Self { structure, stations, modes, .. } = self;
        let first = structure.size();
        let size = first + rings.len();
        let wider = |matrix: &DMatrix<f64>| matrix.clone().resize(size, size, 0.0);
        let mut mass = wider(&structure.mass);
        let mut weights = structure.weights.clone().resize_vertically(size, 0.0);
        let stations: Vec<Map> = stations.into_iter().map(|map| map.resize_horizontally(size, 0.0)).collect();
        let mut sliding = vec![];
        let mut lumps: Vec<Lump> = structure.lumps.iter().cloned().map(|lump| lump.widened(size)).collect();
        for (index, Ring { station, mass: own, place, axis }) in rings.iter().enumerate() {
            let coordinate = first + index;
            mass[(coordinate, coordinate)] = *own;
            weights.row_mut(coordinate).copy_from(&(axis.transpose() * *own));
            let mut map = stations[*station].clone();
            let bore = map.fixed_rows::<3>(0).into_owned();
            let mut across = map.fixed_rows_mut::<3>(0);
            across -= axis * (axis.transpose() * &bore);
            map.fixed_view_mut::<3, 1>(0, coordinate).copy_from(axis);
            sliding.push((*station, map));
            let mut along = Map::zeros(size);
            along.fixed_view_mut::<3, 1>(0, coordinate).copy_from(axis);
            lumps.push(Lump { place: *place, mass: *own, inertia: Vector3::zeros(), map: along });
        }
        let structure = Structure {
            mass: mass.into(),
            damping: wider(&structure.damping).into(),
            stiffness: wider(&structure.stiffness).into(),
            gyroscopic: wider(&structure.gyroscopic).into(),
            by_spin: structure.by_spin.clone().resize_vertically(size, 0.0),
            weights,
            lumps,
            rings: rings.len(),
            ..structure
        };
        Self { structure, stations, sliding, modes }
    }

    /// Motion of the ring at a station by the coordinates: that of the station unless it slides there.
    pub fn ring_at(&self, station: usize) -> &Map {
        let slides = self.sliding.iter().find(|(at, _)| *at == station);
        slides.map_or(&self.stations[station], |(_, map)| map)
    }
}
