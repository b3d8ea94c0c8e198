//! Nodes of the table of Kalker's nonlinear theory, from the half-space reference solver.

use std::f64::consts::{FRAC_PI_2, PI};

use super::half_space::{HalfSpace, HalfSpaceError, Tractions, cells, limit};
use super::linear::Scales;
use super::table::{MIDDLE, NODES, POISSON, SHAPE, Stretch, index};
use super::table_pieces::{between_steps, size, weights};
use super::{Patch, ScaledCreepage};

/// Cells of the coarser grid over the geometric mean of the axes: of ellipses wide across rolling, and of those long
/// along it, whose grids are finer across.
const CELLS: [usize; 2] = [16, 20];
/// \[rad] distance from an axis or plane of symmetry at which its limits are taken: near enough for an error below
/// 0.3 %, far enough for the solver's last digits not to count.
const ASIDE: f64 = 0.05;
/// Creepage |q| that stands for complete sliding.
const SLIDING: f64 = 1e3;

/// The reference solver of one axis ratio on both grids.
#[derive(Clone, Debug)]
pub struct NodeSolver {
    scales: Scales,
    stretch: Stretch,
    coarse: HalfSpace,
    fine: HalfSpace,
    /// Whether there is a peak between the even steps of t.
    peaked: bool,
}

impl NodeSolver {
    /// Prepares both grids.
    ///
    /// # Errors
    /// If the axis ratio is out of range.
    pub fn new(axis_ratio: f64) -> Result<Self, HalfSpaceError> {
        let patch = Patch { axis_ratio, poisson_ratio: POISSON, rolling_angle: 0.0 };
        let scales = Scales::new(&patch)?;
        let long = axis_ratio > 0.99;
        let [along, across] = if long { cells(&patch, CELLS[1]) } else { [CELLS[0]; 2] };
        Ok(Self {
            scales,
            stretch: Stretch::new(axis_ratio, &scales),
            coarse: HalfSpace::with_cells(&patch, [along, across])?,
            fine: HalfSpace::with_cells(&patch, [2 * along, 2 * across])?,
            peaked: long,
        })
    }

    /// Stored values from rest to sliding at one node of theta and phi, each from the solution before. The one at rest,
    /// which is linear theory, is left out of the computation. Of ellipses wide across rolling, which have no peak there,
    /// nodes between the even steps of t lie on the cubic through the others.
    ///
    /// # Errors
    /// If the reference solver has no answer at a node.
    pub fn from_rest_to_sliding(
        &self,
        j: usize,
        k: usize,
    ) -> Result<[[f64; 3]; SHAPE[0] + 1], HalfSpaceError> {
        let Self { scales, stretch, coarse, fine, peaked } = self;
        // On the axis and the plane of symmetry the stored quotients are 0/0: their limits are taken a little beside them.
        let theta = (FRAC_PI_2 * j as f64 / SHAPE[1] as f64).clamp(ASIDE, FRAC_PI_2 - ASIDE);
        let phi = PI * k as f64 / SHAPE[2] as f64;
        let d = stretch.unscaled([theta.cos(), theta.sin() * phi.cos(), theta.sin() * phi.sin()]);
        let mut values = [[0.0; 3]; SHAPE[0] + 1];
        let mut starts: [Option<Tractions>; 2] = [None, None];
        for (i, value) in values.iter_mut().enumerate().skip(1) {
            if !peaked && between_steps(i).is_some() {
                continue;
            }
            let t = size(i);
            let r = if i == SHAPE[0] { SLIDING } else { MIDDLE * t / (1.0 - t) };
            let creepage = ScaledCreepage {
                x: r * d[0] / scales.c11,
                y: r * d[1] / (scales.c22 * stretch.response[0]),
                spin: r * d[2] * scales.moment / (scales.c33 * stretch.response[1]),
                curvature: 0.0,
            };
            let solutions =
                [coarse.solve(&creepage, starts[0].as_ref())?, fine.solve(&creepage, starts[1].as_ref())?];
            let forces = limit(&solutions[0], &solutions[1]);
            *value = [
                forces.fx / (t * theta.cos()),
                forces.fy / (t * theta.sin()),
                forces.mz / (scales.moment * t * theta.sin()),
            ];
            starts = solutions.map(Some);
        }
        if !peaked {
            for i in 0..=SHAPE[0] {
                if let Some((around, u)) = between_steps(i) {
                    let (w, _) = weights(u, 1.0);
                    values[i] = std::array::from_fn(|m| (0..4).map(|n| w[n] * values[around[n]][m]).sum());
                }
            }
        }
        Ok(values)
    }
}

/// Stored values of all nodes of one axis ratio behind rest, t slowest, phi fastest.
///
/// # Errors
/// If the reference solver has no answer at a node.
pub fn build(axis_ratio: f64) -> Result<Vec<[f64; 3]>, HalfSpaceError> {
    let solver = NodeSolver::new(axis_ratio)?;
    let mut nodes = vec![[0.0; 3]; NODES];
    // On the axis, theta = 0, everything follows from two angles phi.
    let (along, across) = (solver.from_rest_to_sliding(0, 0)?, solver.from_rest_to_sliding(0, SHAPE[2] / 2)?);
    for k in 0..SHAPE[2] {
        let (sin, cos) = (PI * k as f64 / SHAPE[2] as f64).sin_cos();
        for (i, (along, across)) in along.iter().zip(&across).enumerate().skip(1) {
            nodes[index(i, 0, k)] = [
                0.5 * (along[0] + across[0]),
                along[1] * cos + across[1] * sin,
                along[2] * cos + across[2] * sin,
            ];
        }
        for j in 1..=SHAPE[1] {
            for (i, value) in solver.from_rest_to_sliding(j, k)?.into_iter().enumerate().skip(1) {
                nodes[index(i, j, k)] = value;
            }
        }
    }
    Ok(nodes)
}
