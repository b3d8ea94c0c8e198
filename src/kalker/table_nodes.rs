//! Nodes of the table of Kalker's nonlinear theory, from the half-space reference solver.

use std::f64::consts::{FRAC_PI_2, PI};

use super::half_space::{HalfSpace, HalfSpaceError, Tractions, cells, limit};
use super::linear::Scales;
use super::table::{MIDDLE, NODES, POISSON, SHAPE, Stretch};
use super::{Patch, ScaledCreepage};

/// Cells of the coarser grid over the geometric mean of the axes: of ellipses wide across rolling, and of those long
/// along it, whose grids are finer across.
const CELLS: [usize; 2] = [16, 20];
/// [rad] distance from an axis or plane of symmetry at which its limits are taken: near enough for an error below
/// 0.3 %, far enough for the solver's last digits not to count.
const ASIDE: f64 = 0.05;
/// Creepage |q| that stands for complete sliding.
const SLIDING: f64 = 1e3;

/// Stored values of all nodes of one axis ratio, t slowest, phi fastest. The row at rest, which is linear theory, is
/// left out of the computation.
///
/// # Errors
/// If the reference solver has no answer at a node.
pub fn build(axis_ratio: f64) -> Result<Vec<[f64; 3]>, HalfSpaceError> {
    let patch = Patch { axis_ratio, poisson_ratio: POISSON, rolling_angle: 0.0 };
    let scales = Scales::new(&patch)?;
    let stretch = Stretch::new(axis_ratio, &scales);
    let [along, across] = if axis_ratio > 0.99 { cells(&patch, CELLS[1]) } else { [CELLS[0]; 2] };
    let coarse = HalfSpace::with_cells(&patch, [along, across])?;
    let fine = HalfSpace::with_cells(&patch, [2 * along, 2 * across])?;
    let mut nodes = vec![[0.0; 3]; NODES];
    let index = |i: usize, j: usize, k: usize| (i * (SHAPE[1] + 1) + j) * SHAPE[2] + k;
    for j in 0..=SHAPE[1] {
        // On the axis, theta = 0, everything follows from two angles phi.
        let angles: Vec<usize> = if j == 0 { vec![0, SHAPE[2] / 2] } else { (0..SHAPE[2]).collect() };
        for k in angles {
            // On the axis and the plane of symmetry what would be divided by zero has its limit: a little beside them.
            let theta = (FRAC_PI_2 * j as f64 / SHAPE[1] as f64).clamp(ASIDE, FRAC_PI_2 - ASIDE);
            let phi = PI * k as f64 / SHAPE[2] as f64;
            let d = stretch.unscaled([theta.cos(), theta.sin() * phi.cos(), theta.sin() * phi.sin()]);
            let mut starts: [Option<Tractions>; 2] = [None, None];
            for i in 1..=SHAPE[0] {
                let t = i as f64 / SHAPE[0] as f64;
                let r = if i == SHAPE[0] { SLIDING } else { MIDDLE * t / (1.0 - t) };
                let creepage = ScaledCreepage {
                    x: r * d[0] / scales.c11,
                    y: r * d[1] / (scales.c22 * stretch.response[0]),
                    spin: r * d[2] * scales.moment / (scales.c33 * stretch.response[1]),
                    curvature: 0.0,
                };
                let solutions = [
                    coarse.solve(&creepage, starts[0].as_ref())?,
                    fine.solve(&creepage, starts[1].as_ref())?,
                ];
                let forces = limit(&solutions[0], &solutions[1]);
                nodes[index(i, j, k)] = [
                    forces.fx / (t * theta.cos()),
                    forces.fy / (t * theta.sin()),
                    forces.mz / (scales.moment * t * theta.sin()),
                ];
                starts = solutions.map(Some);
            }
        }
    }
    for i in 1..=SHAPE[0] {
        let (along, across) = (nodes[index(i, 0, 0)], nodes[index(i, 0, SHAPE[2] / 2)]);
        for k in 0..SHAPE[2] {
            let (sin, cos) = (PI * k as f64 / SHAPE[2] as f64).sin_cos();
            nodes[index(i, 0, k)] = [
                0.5 * (along[0] + across[0]),
                along[1] * cos + across[1] * sin,
                along[2] * cos + across[2] * sin,
            ];
        }
    }
    Ok(nodes)
}
