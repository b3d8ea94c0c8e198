//! Reference solution of one steadily rolling contact: tractions constant on the cells of a grid, half-space influence
//! functions, Coulomb's bound in every cell. Slow and simple: the reference for all other laws.
//!
//! Scaled as everything in [`crate::kalker`]: tractions over mu p0, slip times G/(mu p0), lengths over `c`. In steady
//! rolling the slip of a particle is its rigid slip plus the change of its elastic displacement from the place one
//! step upstream, where it comes from (backward difference along rolling; Vollebregt 2010). Cells are solved one by one
//! from the leading edge on, each exactly: sticking if its traction then is below the bound, else sliding along its
//! traction; sweeps are repeated until nothing changes.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use thiserror::Error;

use super::patch::LinearError;
use super::{Patch, ScaledCreepage, ScaledForces};

/// [-] change of a traction over mu p0 in a sweep that counts as none.
const TOLERANCE: f64 = 1e-5;
/// [-] relaxation factor: fraction of a cell's change that is applied. With the whole change adjacent sliding cells
/// oscillate for ever; with this fraction most reference cases converge in 15 to 40 sweeps, the slowest in some 200.
const RELAXATION: f64 = 0.5;
/// [-] change of a traction over mu p0 that need not be passed on: the sweeps end at a hundred times it.
const SILENT: f64 = 1e-7;
/// Sweeps after which a smaller factor is tried.
const PATIENCE: u32 = 50;
const MAX_SWEEPS: u32 = 1000;

/// Why there is no solution.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum HalfSpaceError {
    /// The patch is out of range.
    #[error(transparent)]
    Patch(#[from] LinearError),
    /// A grid too coarse or too fine.
    #[error("the grid of {0} cells across the ellipse is outside [4, 256]")]
    Grid(usize),
    /// A creepage that is NaN or infinite.
    #[error("the creepages {0:?} are not finite")]
    NotFinite(ScaledCreepage),
    /// The sweeps do not converge.
    #[error("the tractions still change by {change:.1e} of mu p0 after {sweeps} sweeps")]
    NoConvergence {
        /// [-] largest change in the last sweep.
        change: f64,
        /// Sweeps done.
        sweeps: u32,
    },
}

/// A cell of the grid.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Indices in the grid.
    i: usize,
    j: usize,
    /// Centre over c.
    x: f64,
    y: f64,
    /// Coulomb's bound over mu p0.
    bound: f64,
}

/// Change of displacement over one step along rolling, per unit traction of a cell, over the step: xx, xy, yy.
type Influence = [f64; 3];

/// A slip of every square of the grid, those outside of the ellipse included: rows along x stay contiguous. Single precision
/// holds two digits more than the sweeps ask for, and is twice as fast.
#[derive(Clone, Debug)]
struct Slips {
    x: Vec<f32>,
    y: Vec<f32>,
}

/// The problem of one patch on one grid.
#[derive(Clone, Debug)]
pub struct HalfSpace {
    /// Cells from the leading edge on.
    cells: Vec<Cell>,
    /// Influences xx, xy and yy by difference of indices, from -(n-1) to n-1 in both; along x from one to the next.
    influences: [Vec<f32>; 3],
    /// Cells along the axes x and y of the ellipse.
    n: [usize; 2],
    /// [-] area of a cell over c squared.
    cell_area: f64,
}

/// The solution at one creepage.
#[derive(Clone, Debug)]
pub struct Tractions {
    /// Tractions over mu p0, cell by cell.
    pub tractions: Vec<[f64; 2]>,
    /// Which cells stick.
    pub sticking: Vec<bool>,
    /// Net forces.
    pub forces: ScaledForces,
    /// [-] adhesion area over contact area.
    pub stick: f64,
    /// Sweeps spent.
    pub sweeps: u32,
}

/// State of a cell, for pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellState {
    /// [-] place of its centre over c.
    pub place: [f64; 2],
    /// [-] area over c squared.
    pub area: f64,
    /// [-] Coulomb's bound over mu p0: the pressure over p0.
    pub bound: f64,
    /// [-] traction over mu p0.
    pub traction: [f64; 2],
    /// [-] slip over the rolling speed, times G/(mu p0).
    pub slip: [f64; 2],
    /// Does it stick?
    pub sticks: bool,
}

/// Displacement at an offset from the centre of a rectangle of half sides (hx, hy) under unit traction, times G: the
/// integrals of Boussinesq and Cerruti in closed form, for the relative displacement of two like bodies.
fn displacement(x: f64, y: f64, (hx, hy): (f64, f64), nu: f64) -> Influence {
    let mut sum = [0.0; 3];
    for (sx, sy, sign) in [(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)] {
        let (u, v) = (x + sx * hx, y + sy * hy);
        let r = u.hypot(v);
        // ln(v + r) loses all digits where v is negative and u small; ln(u^2/(r - v)) does not.
        let log = |a: f64, b: f64| if b > 0.0 { (b + r).ln() } else { 2.0 * a.abs().ln() - (r - b).ln() };
        let p = if u == 0.0 { 0.0 } else { u * log(u, v) };
        let q = if v == 0.0 { 0.0 } else { v * log(v, u) };
        sum[0] += sign * ((1.0 - nu) * p + q);
        sum[1] -= sign * nu * r;
        sum[2] += sign * (p + (1.0 - nu) * q);
    }
    sum.map(|value| value / PI)
}

impl HalfSpace {
    /// Prepares a grid of `n` cells along each axis of the ellipse.
    ///
    /// # Errors
    /// If patch or grid are out of range.
    pub fn new(patch: &Patch, n: usize) -> Result<Self, HalfSpaceError> {
        Self::with_cells(patch, [n, n])
    }

    /// Prepares a grid with its own number of cells along the axes x and y of the ellipse.
    ///
    /// # Errors
    /// If patch or grid are out of range.
    pub fn with_cells(patch: &Patch, n: [usize; 2]) -> Result<Self, HalfSpaceError> {
        patch.check()?;
        if let Some(outside) = n.into_iter().find(|n| !(FEWEST..=256).contains(n)) {
            return Err(HalfSpaceError::Grid(outside));
        }
        let (a, b) = (patch.axis_ratio.sqrt(), 1.0 / patch.axis_ratio.sqrt());
        let (sin, cos) = patch.rolling_angle.sin_cos();
        let centre = |i: usize, n: usize| (2.0 * i as f64 + 1.0) / n as f64 - 1.0;
        let mut cells = vec![];
        for i in 0..n[0] {
            for j in 0..n[1] {
                let (x, y) = (centre(i, n[0]), centre(j, n[1]));
                let square = x * x + y * y;
                if square < 1.0 {
                    cells.push(Cell { i, j, x: a * x, y: b * y, bound: (1.0 - square).sqrt() });
                }
            }
        }
        cells.sort_by(|one, other| {
            let along = |cell: &Cell| cell.x * cos + cell.y * sin;
            along(other).total_cmp(&along(one))
        });
        let half = (a / n[0] as f64, b / n[1] as f64);
        // One cell along rolling: the smaller of the two crossings of a cell.
        let step = (2.0 * half.0 / cos.abs().max(1e-12)).min(2.0 * half.1 / sin.abs().max(1e-12));
        let mut influences = [const { Vec::new() }; 3];
        for dj in 0..2 * n[1] - 1 {
            for di in 0..2 * n[0] - 1 {
                let x = (di as f64 - (n[0] as f64 - 1.0)) * 2.0 * half.0;
                let y = (dj as f64 - (n[1] as f64 - 1.0)) * 2.0 * half.1;
                let here = displacement(x, y, half, patch.poisson_ratio);
                let upstream = displacement(x + step * cos, y + step * sin, half, patch.poisson_ratio);
                for (k, list) in influences.iter_mut().enumerate() {
                    list.push(((upstream[k] - here[k]) / step) as f32);
                }
            }
        }
        Ok(Self { cells, influences, n, cell_area: 4.0 * half.0 * half.1 })
    }

    /// Adds the slip that a change of traction of one cell makes everywhere.
    #[inline(always)]
    fn add(&self, slips: &mut Slips, by: &Cell, change: [f64; 2]) {
        let first = [self.n[1] - 1 - by.j, self.n[0] - 1 - by.i];
        add_slips(slips, &self.influences, self.n, first, change.map(|component| component as f32));
    }

    /// Solves for creepages, from zero tractions or from those at creepages nearby.
    ///
    /// # Errors
    /// See [`HalfSpaceError`].
    pub fn solve(
        &self,
        creepage: &ScaledCreepage,
        start: Option<&Tractions>,
    ) -> Result<Tractions, HalfSpaceError> {
        let components = [creepage.x, creepage.y, creepage.spin, creepage.curvature];
        if !components.iter().all(|component| component.is_finite()) {
            return Err(HalfSpaceError::NotFinite(*creepage));
        }
        let count = self.cells.len();
        let mut tractions = start.map_or_else(|| vec![[0.0; 2]; count], |start| start.tractions.clone());
        let mut sticking = vec![true; count];
        let [n, rows] = self.n;
        let centre = (rows - 1) * (2 * n - 1) + n - 1;
        // Own influence: a traction along the slip takes slip away.
        let flexibility = [0, 2].map(|k| -f64::from(self.influences[k][centre]));
        let mut slips = Slips { x: vec![0.0; rows * n], y: vec![0.0; rows * n] };
        for (cell, traction) in self.cells.iter().zip(&tractions) {
            if *traction != [0.0; 2] {
                self.add(&mut slips, cell, *traction);
            }
        }
        let mut change = f64::INFINITY;
        let mut relaxation = RELAXATION;
        for sweep in 1..=MAX_SWEEPS {
            change = 0.0;
            for (index, cell) in self.cells.iter().enumerate() {
                let (old, place) = (tractions[index], cell.j * n + cell.i);
                // slip without the cell's own traction
                let slip = [
                    creepage.x - (creepage.spin + creepage.curvature * cell.y) * cell.y
                        + f64::from(slips.x[place])
                        + flexibility[0] * old[0],
                    creepage.y + creepage.spin * cell.x + f64::from(slips.y[place]) + flexibility[1] * old[1],
                ];
                let (solved, sticks) = solve_cell(slip, flexibility, cell.bound);
                sticking[index] = sticks;
                let step = [0, 1].map(|k| relaxation * (solved[k] - old[k]));
                let size = step[0].abs().max(step[1].abs());
                change = change.max(size);
                if size > SILENT {
                    tractions[index] = [old[0] + step[0], old[1] + step[1]];
                    self.add(&mut slips, cell, step);
                }
            }
            if sweep % PATIENCE == 0 {
                relaxation *= RELAXATION;
            }
            if change < TOLERANCE {
                return Ok(self.finish(tractions, sticking, sweep));
            }
        }
        Err(HalfSpaceError::NoConvergence { change, sweeps: MAX_SWEEPS })
    }

    /// State of every cell of a solution at its creepages.
    pub fn states(&self, creepage: &ScaledCreepage, solution: &Tractions) -> Vec<CellState> {
        let [n, rows] = self.n;
        let mut slips = Slips { x: vec![0.0; rows * n], y: vec![0.0; rows * n] };
        for (cell, traction) in self.cells.iter().zip(&solution.tractions) {
            self.add(&mut slips, cell, *traction);
        }
        let state = |(cell, (traction, sticks)): (&Cell, (&[f64; 2], &bool))| {
            let place = cell.j * n + cell.i;
            CellState {
                place: [cell.x, cell.y],
                area: self.cell_area,
                bound: cell.bound,
                traction: *traction,
                slip: [
                    creepage.x - (creepage.spin + creepage.curvature * cell.y) * cell.y
                        + f64::from(slips.x[place]),
                    creepage.y + creepage.spin * cell.x + f64::from(slips.y[place]),
                ],
                sticks: *sticks,
            }
        };
        self.cells.iter().zip(solution.tractions.iter().zip(&solution.sticking)).map(state).collect()
    }

    fn finish(&self, tractions: Vec<[f64; 2]>, sticking: Vec<bool>, sweeps: u32) -> Tractions {
        // The cells' own sum of bounds stands for mu Q: what the staircase of the edge loses cancels.
        let limit: f64 = self.cells.iter().map(|cell| cell.bound).sum();
        let mut forces = ScaledForces::default();
        for (cell, f) in self.cells.iter().zip(&tractions) {
            forces.fx += f[0] / limit;
            forces.fy += f[1] / limit;
            forces.mz += (cell.x * f[1] - cell.y * f[0]) / limit;
            forces.second_moment += cell.y * cell.y * f[0] / limit;
        }
        let stick = sticking.iter().filter(|sticks| **sticks).count() as f64 / sticking.len() as f64;
        Tractions { tractions, sticking, forces, stick, sweeps }
    }
}

/// Adds the slip by a change of traction; its influence on the first cell stands in this row and column.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn add_slips(
    slips: &mut Slips,
    influences: &[Vec<f32>; 3],
    [n, rows]: [usize; 2],
    [row, column]: [usize; 2],
    change: [f32; 2],
) {
    let width = 2 * n - 1;
    let [xx, xy, yy] = influences;
    let first = row * width + column;
    let rows = slips.x.chunks_exact_mut(n).zip(slips.y.chunks_exact_mut(n)).take(rows);
    for (j, (x, y)) in rows.enumerate() {
        let span = first + j * width..first + j * width + n;
        let influences = xx[span.clone()].iter().zip(&xy[span.clone()]).zip(&yy[span]);
        for ((x, y), ((xx, xy), yy)) in x.iter_mut().zip(y).zip(influences) {
            *x += xx * change[0] + xy * change[1];
            *y += xy * change[0] + yy * change[1];
        }
    }
}

/// Traction of a cell whose slip without it is `slip`: sticking, or sliding with the slip that remains along it.
fn solve_cell(slip: [f64; 2], flexibility: [f64; 2], bound: f64) -> ([f64; 2], bool) {
    let sticking = [slip[0] / flexibility[0], slip[1] / flexibility[1]];
    if sticking[0].hypot(sticking[1]) <= bound {
        return (sticking, true);
    }
    // slip - L f = lambda f with |f| = bound: f_k = slip_k/(lambda + L_k). The size of f falls with lambda.
    let at = |lambda: f64| [0, 1].map(|k| slip[k] / (lambda + flexibility[k]));
    let size = slip[0].hypot(slip[1]);
    let mut lambda = (size / bound - flexibility[0].max(flexibility[1])).max(0.0);
    for _ in 0..50 {
        let f = at(lambda);
        let square = f[0] * f[0] + f[1] * f[1];
        let slope: f64 = (0..2).map(|k| f[k] * f[k] / (lambda + flexibility[k])).sum();
        // Newton on 1/|f| = 1/bound, which is nearly linear in lambda.
        let length = square.sqrt();
        let step = (length / bound - 1.0) * square / slope;
        lambda = (lambda + step).max(0.0);
        if step.abs() < 1e-14 * (lambda + flexibility[0]) {
            break;
        }
    }
    let f = at(lambda);
    let length = f[0].hypot(f[1]);
    (f.map(|component| component * bound / length), false)
}

/// Forces on grids of `n` and `2 n` cells, extrapolated to zero cell size (the method is of first order).
///
/// # Errors
/// See [`HalfSpaceError`].
pub fn extrapolated(
    patch: &Patch,
    creepage: &ScaledCreepage,
    n: usize,
) -> Result<ScaledForces, HalfSpaceError> {
    let [x, y] = cells(patch, n);
    let [coarse, fine] = [
        HalfSpace::with_cells(patch, [x, y])?.solve(creepage, None)?,
        HalfSpace::with_cells(patch, [2 * x, 2 * y])?.solve(creepage, None)?,
    ];
    Ok(limit(&coarse, &fine))
}

/// Forces on grids fine enough for them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// Forces at zero cell size.
    pub forces: ScaledForces,
    /// [-] largest change of a force over mu Q or of the moment over mu Q c against cells of twice the size.
    pub change: f64,
}

/// [-] change from grid to grid beyond which a finer one is taken. Errors against independent data are a third of it in the mean
/// (`tests/kalker/half_space.rs`).
pub const LARGEST_CHANGE: f64 = 0.02;
/// Cells of the first grid and of the finest: each is compared with the next.
const COARSEST: usize = 8;
const FINEST: usize = 64;
/// Fewest cells along an axis.
const FEWEST: usize = 4;

/// Forces at zero cell size, on grids that are made finer until they change by less than [`LARGEST_CHANGE`]: two grids of at least
/// 16 and 32 cells, at most 32 and 64, whatever the direction of rolling.
///
/// # Errors
/// See [`HalfSpaceError`].
pub fn refined(patch: &Patch, creepage: &ScaledCreepage) -> Result<Refined, HalfSpaceError> {
    patch.check()?;
    let [x, y] = cells(patch, COARSEST).map(|cells| cells.max(FEWEST));
    let solve = |factor: usize| HalfSpace::with_cells(patch, [factor * x, factor * y])?.solve(creepage, None);
    let mut factor = 2;
    let mut finest = solve(factor)?;
    let mut before = limit(&solve(1)?, &finest);
    loop {
        factor *= 2;
        let finer = solve(factor)?;
        let forces = limit(&finest, &finer);
        let changes = [forces.fx - before.fx, forces.fy - before.fy, forces.mz - before.mz];
        let change = changes.into_iter().fold(0.0f64, |most, change| most.max(change.abs()));
        if change <= LARGEST_CHANGE || factor * COARSEST >= FINEST {
            return Ok(Refined { forces, change });
        }
        (before, finest) = (forces, finer);
    }
}

/// Cells along the axes of an ellipse, about `n * n` in all. An ellipse that is long along rolling gets more cells along
/// it, as tractions grow fast from its leading edge.
pub fn cells(patch: &Patch, n: usize) -> [usize; 2] {
    let along_x = patch.rolling_angle.cos().abs() > FRAC_1_SQRT_2;
    let along = if along_x { patch.axis_ratio } else { 1.0 / patch.axis_ratio };
    let stretch = along.max(1.0).powf(0.25);
    let (along, across) = (n as f64 * stretch, n as f64 / stretch);
    let cells = [along, across].map(|count| count.round() as usize);
    if along_x { cells } else { [cells[1], cells[0]] }
}

/// Forces at zero cell size from those of a grid and of one of half its cell size.
pub fn limit(coarse: &Tractions, fine: &Tractions) -> ScaledForces {
    let limit = |get: fn(&ScaledForces) -> f64| 2.0 * get(&fine.forces) - get(&coarse.forces);
    ScaledForces {
        fx: limit(|f| f.fx),
        fy: limit(|f| f.fy),
        mz: limit(|f| f.mz),
        second_moment: limit(|f| f.second_moment),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_a_sliding_cell_has_the_slip_that_remains_along_its_traction() {
        // Just above the bound, far above it, and with unlike flexibilities: |f| = bound and (slip - L f) x f = 0.
        let flexibility = [0.02, 0.035];
        for (slip, bound) in [([0.003, 0.002], 0.15), ([0.0301, 0.0402], 1.88), ([-5.0, 2.0], 0.4)] {
            let (f, sticks) = solve_cell(slip, flexibility, bound);
            let rest = [0, 1].map(|k| slip[k] - flexibility[k] * f[k]);
            assert!(!sticks && (f[0].hypot(f[1]) / bound - 1.0).abs() < 1e-14);
            let sine = (rest[0] * f[1] - rest[1] * f[0]) / (slip[0].hypot(slip[1]) * bound);
            assert!(sine.abs() < 1e-12 && rest[0] * f[0] + rest[1] * f[1] >= 0.0, "{slip:?}: {sine:e}");
        }
        assert_eq!(solve_cell([0.002, 0.0], flexibility, 0.2), ([0.1, 0.0], true));
    }
}
