//! Torsion of beams of circular cross-section: rods that twist, reduced to stations as their bending is.
//!
//! Twist counts from the place that the turn of the shaft is taken at, where it is 0: the turn is large, and twist stays small.

use nalgebra::{DMatrix, DVector};

use super::reduction::modes;

/// A shaft that twists, by the twist of its nodes.
#[derive(Clone, Debug)]
pub struct Torsion {
    /// Inertia, consistent.
    mass: DMatrix<f64>,
    /// Stiffness.
    stiffness: DMatrix<f64>,
}

/// Torsion by the twist of its stations and the amplitudes of modes between them.
#[derive(Clone, Debug)]
pub struct ReducedTorsion {
    /// Inertia of the coordinates.
    pub mass: DMatrix<f64>,
    /// Their stiffness.
    pub stiffness: DMatrix<f64>,
    /// [kg m2] inertia of the coordinates by an acceleration of the turn.
    pub by_turn: DVector<f64>,
    /// Twist of each station by the coordinates.
    pub stations: Vec<DVector<f64>>,
    /// Twist of each node by the coordinates.
    pub nodes: Vec<DVector<f64>>,
}

impl Torsion {
    /// Torsion of so many nodes.
    pub fn new(nodes: usize) -> Self {
        Self { mass: DMatrix::zeros(nodes, nodes), stiffness: DMatrix::zeros(nodes, nodes) }
    }

    /// Adds a rod from a node to the next: polar moment of inertia [kg m2] and stiffness [N m/rad] of it.
    pub fn add_rod(&mut self, node: usize, inertia: f64, stiffness: f64) {
        for (i, k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let at = (node + i, node + k);
            self.mass[at] += inertia / if i == k { 3.0 } else { 6.0 };
            self.stiffness[at] += if i == k { stiffness } else { -stiffness };
        }
    }

    /// Adds a disc [kg m2] at a node.
    pub fn add_disc(&mut self, node: usize, inertia: f64) {
        self.mass[(node, node)] += inertia;
    }

    /// Reduced to these nodes, with modes between them up to an angular frequency [rad/s]; the twist of the `reference` is 0, which is one
    /// of them.
    pub fn reduced(&self, stations: &[usize], reference: usize, highest: f64) -> ReducedTorsion {
        let mut outer: Vec<usize> = stations.to_vec();
        outer.sort_unstable();
        outer.dedup();
        outer.retain(|node| *node != reference);
        let size = self.mass.nrows();
        let inner: Vec<usize> =
            (0..size).filter(|node| *node != reference && !outer.contains(node)).collect();
        let part = |matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, k| matrix[(rows[i], columns[k])])
        };
        let (stiff, mass) = (part(&self.stiffness, &inner, &inner), part(&self.mass, &inner, &inner));
        let (amplitudes, frequencies) = modes(&stiff, &mass, highest);
        let by_stations = -stiff
            .lu()
            .solve(&part(&self.stiffness, &inner, &outer))
            .unwrap_or_else(|| DMatrix::zeros(inner.len(), outer.len()));
        let n = outer.len() + frequencies.len();
        let mut shapes = DMatrix::zeros(size, n);
        outer.iter().enumerate().for_each(|(k, node)| shapes[(*node, k)] = 1.0);
        for (k, node) in inner.iter().enumerate() {
            for column in 0..outer.len() {
                shapes[(*node, column)] = by_stations[(k, column)];
            }
            for column in 0..frequencies.len() {
                shapes[(*node, outer.len() + column)] = amplitudes[(k, column)];
            }
        }
        let whole = &self.mass * DVector::from_element(size, 1.0);
        let station = |node: &usize| shapes.row(*node).transpose();
        ReducedTorsion {
            mass: shapes.tr_mul(&(&self.mass * &shapes)),
            stiffness: shapes.tr_mul(&(&self.stiffness * &shapes)),
            by_turn: shapes.tr_mul(&whole),
            stations: stations.iter().map(&station).collect(),
            nodes: (0..size).map(|node| station(&node)).collect(),
        }
    }
}
