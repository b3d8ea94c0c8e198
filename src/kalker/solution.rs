//! A solution of Kalker's nonlinear problem: net forces, their derivatives, and the state of every point.

use nalgebra::DVector;

use super::nonlinear::Kalker;
use super::objective::{Fields, Objective, norm, project};
use super::{ScaledCreepage, ScaledForces};

/// The solution at one creepage.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Coefficients of the traction polynomials over mu p0: x components, then y.
    pub coefficients: DVector<f64>,
    /// Net forces; never above 1.
    pub forces: ScaledForces,
    /// [-] adhesion area over contact area.
    pub stick: f64,
    /// Iterations spent.
    pub iterations: u32,
}

/// Local state at a point of the grid, for pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalState {
    /// [-] X = x/a, Y = y/b.
    pub place: [f64; 2],
    /// [-] area on the unit disc that the point stands for.
    pub weight: f64,
    /// [-] traction over mu p0, within the Coulomb bound.
    pub traction: [f64; 2],
    /// [-] slip velocity over V, times G/(mu p0).
    pub slip: [f64; 2],
    /// [-] Coulomb bound over mu p0.
    pub bound: f64,
}

impl Kalker {
    /// Traction and slip at every point.
    fn fields(&self, z: &DVector<f64>, h: &ScaledCreepage) -> Vec<([f64; 2], [f64; 2])> {
        let n = self.monomials;
        let (fx, fy) =
            (self.monomial_values.tr_mul(&z.rows(0, n)), self.monomial_values.tr_mul(&z.rows(n, n)));
        let elastic = &self.slips * z;
        let rows = self.points.len();
        self.points
            .iter()
            .enumerate()
            .map(|(i, point)| {
                let rigid = self.rigid(h, point);
                ([fx[i], fy[i]], [rigid[0] + elastic[i], rigid[1] + elastic[rows + i]])
            })
            .collect()
    }

    pub(super) fn finish(&self, z: DVector<f64>, fields: &Fields, iterations: u32) -> Solution {
        let net = &self.resultants * &z;
        let mut forces = ScaledForces { fx: net[0], fy: net[1], mz: net[2], second_moment: net[3] };
        // A polynomial may overstep the bound by its own error: a sliding contact stays at the friction limit.
        let size = forces.fx.hypot(forces.fy);
        if size > 1.0 {
            forces.fx /= size * (1.0 + f64::EPSILON);
            forces.fy /= size * (1.0 + f64::EPSILON);
        }
        let (mut stick, mut area) = (0.0, 0.0);
        let v = &fields.arguments;
        for (i, point) in self.points.iter().enumerate() {
            area += point.weight;
            if norm([v[2 * i], v[2 * i + 1]]) <= point.bound {
                stick += point.weight;
            }
        }
        Solution { coefficients: z, forces, stick: stick / area, iterations }
    }

    /// Derivatives of the forces (fx, fy, mz, second moment) by the scaled creepages (x, y, spin, curvature).
    ///
    /// By implicit differentiation of the minimum: where its gradient stays zero, the coefficients follow.
    /// None where the minimum is not isolated.
    pub fn derivatives(&self, solution: &Solution, creepage: &ScaledCreepage) -> Option<[[f64; 4]; 4]> {
        let z = &solution.coefficients;
        let problem = Objective::new(self, creepage);
        let fields = problem.fields_at(z);
        let expansion = problem.expand(z, &fields);
        let by_creepage = problem.by_creepage(&fields, &expansion);
        let follow = problem.curvature(&expansion.sliding, true).lu().solve(&-by_creepage)?;
        let net = &self.resultants * follow;
        Some(std::array::from_fn(|i| std::array::from_fn(|k| net[(i, k)])))
    }

    /// Traction and slip at the points of the grid.
    pub fn local_states(&self, solution: &Solution, creepage: &ScaledCreepage) -> Vec<LocalState> {
        self.points
            .iter()
            .zip(self.fields(&solution.coefficients, creepage))
            .map(|(point, (f, slip))| LocalState {
                place: [point.x, point.y],
                weight: point.weight,
                traction: project(f, point.bound).0,
                slip,
                bound: point.bound,
            })
            .collect()
    }
}
