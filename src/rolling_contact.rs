//! Single rolling contacts, as `roulement contact` evaluates them: a patch, its load and its creepages.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::contact::creep::{self, Creepage, LinearTheory, saturation};
use crate::contact::hertz::complete_elliptic_integrals;
use crate::kalker::half_space::{HalfSpaceError, extrapolated};
use crate::kalker::linear::{LinearError, creep_matrix};
use crate::kalker::nonlinear::{Kalker, KalkerError};
use crate::kalker::table::CreepTable;
use crate::kalker::{Patch, ScaledCreepage};
use crate::scene::CreepLaw;

/// A rolling contact; columns of a case table have these names.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub struct RollingContact {
    /// Name of the case.
    pub id: String,
    /// [-] Poisson's ratio of both bodies.
    pub poisson_ratio: f64,
    /// [Pa] shear modulus of both bodies.
    pub shear_modulus: f64,
    /// [-] friction coefficient.
    pub friction: f64,
    /// [Pa] peak of the Hertzian pressure.
    pub peak_pressure: f64,
    /// [m] semi-axis along the ellipse's x axis.
    pub semi_axis_x: f64,
    /// [m] semi-axis along its y axis.
    pub semi_axis_y: f64,
    /// [rad] direction of rolling from the x axis.
    #[serde(default)]
    pub rolling_angle: f64,
    /// [-] creepage along x.
    pub creep_x: f64,
    /// [-] creepage along y.
    pub creep_y: f64,
    /// [1/m] spin creepage.
    pub spin: f64,
}

/// Forces of body 1 on body 2.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RollingForces {
    /// Name of the case.
    pub id: String,
    /// [-] force along x over mu N.
    pub fx: f64,
    /// [-] force along y over mu N.
    pub fy: f64,
    /// [-] spin moment over mu N c.
    pub mz: f64,
    /// [-] dissipated power over mu N V.
    pub power: f64,
    /// [-] adhesion area over contact area, where the law knows it.
    pub stick: Option<f64>,
}

/// A law for single contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// A law of the simulation.
    Simulated(CreepLaw),
    /// Kalker's nonlinear theory with polynomials of this degree.
    Kalker(usize),
    /// The half-space reference solver, extrapolated from grids of this many cells and twice as many.
    Reference(usize),
}

/// Why a contact could not be evaluated.
#[derive(Debug, Error, PartialEq)]
pub enum ContactError {
    /// A value that must be positive is not, or one that must be finite is not.
    #[error("case {id}: {name} = {value} is out of range: {range}")]
    Range {
        /// Case.
        id: String,
        /// Column.
        name: &'static str,
        /// Value.
        value: f64,
        /// Allowed range.
        range: &'static str,
    },
    /// The linear theory refuses the patch.
    #[error("case {0}: {1}")]
    Linear(String, LinearError),
    /// The reference solver has no answer.
    #[error("case {0}: {1}")]
    Reference(String, HalfSpaceError),
    /// The nonlinear theory has no answer.
    #[error("case {0}: {1}")]
    Kalker(String, KalkerError),
}

impl RollingContact {
    /// Evaluates the contact by a law.
    ///
    /// # Errors
    /// See [`ContactError`].
    pub fn evaluate(&self, law: Law) -> Result<RollingForces, ContactError> {
        self.check()?;
        let patch = Patch {
            axis_ratio: self.semi_axis_x / self.semi_axis_y,
            poisson_ratio: self.poisson_ratio,
            rolling_angle: self.rolling_angle,
        };
        let c = (self.semi_axis_x * self.semi_axis_y).sqrt();
        let ([fx, fy, mz], stick) = match law {
            Law::Simulated(law) => (self.simulated(law, &patch, c)?, None),
            Law::Reference(cells) => {
                let failed = |why| ContactError::Reference(self.id.clone(), why);
                let f = extrapolated(&patch, &self.scaled(c), cells).map_err(failed)?;
                ([f.fx, f.fy, f.mz], None)
            }
            Law::Kalker(degree) => {
                let creepage = self.scaled(c);
                let failed = |why| ContactError::Kalker(self.id.clone(), why);
                let solution = Kalker::new(patch, degree)
                    .and_then(|kalker| kalker.solve(&creepage, None))
                    .map_err(failed)?;
                let f = solution.forces;
                ([f.fx, f.fy, f.mz], Some(solution.stick))
            }
        };
        let power = self.creep_x * fx + self.creep_y * fy + self.spin * c * mz;
        Ok(RollingForces { id: self.id.clone(), fx, fy, mz, power, stick })
    }

    /// Creepages in Kalker's scale.
    fn scaled(&self, c: f64) -> ScaledCreepage {
        let scale = self.shear_modulus / (self.friction * self.peak_pressure);
        ScaledCreepage { x: self.creep_x * scale, y: self.creep_y * scale, spin: self.spin * c * scale }
    }

    fn check(&self) -> Result<(), ContactError> {
        let refuse =
            |name, value, range| Err(ContactError::Range { id: self.id.clone(), name, value, range });
        for (name, value) in [
            ("shear_modulus", self.shear_modulus),
            ("friction", self.friction),
            ("peak_pressure", self.peak_pressure),
            ("semi_axis_x", self.semi_axis_x),
            ("semi_axis_y", self.semi_axis_y),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return refuse(name, value, "a positive number");
            }
        }
        for (name, value) in [("creep_x", self.creep_x), ("creep_y", self.creep_y), ("spin", self.spin)] {
            if !value.is_finite() {
                return refuse(name, value, "a finite number");
            }
        }
        Ok(())
    }

    /// Forces by one of the simulation's laws, over mu N and mu N c.
    fn simulated(&self, law: CreepLaw, patch: &Patch, c: f64) -> Result<[f64; 3], ContactError> {
        let matrix = creep_matrix(patch).map_err(|why| ContactError::Linear(self.id.clone(), why))?;
        let (a, b) = (self.semi_axis_x, self.semi_axis_y);
        let load = std::f64::consts::TAU / 3.0 * a * b * self.peak_pressure;
        let limit = self.friction * load;
        let (long, short) = (a.max(b), a.min(b));
        let (_, second) = complete_elliptic_integrals(1.0 - (short / long).powi(2));
        let moment_limit = 0.375 * long * second / c;
        // linear theory over mu N (mu N c)
        let linear = matrix
            * Vector3::new(self.creep_x, self.creep_y, self.spin * c)
            * (self.shear_modulus * c * c / limit);
        Ok(match law {
            CreepLaw::Frictionless => [0.0; 3],
            CreepLaw::Linear => linear.into(),
            CreepLaw::Saturated => {
                let q = Vector3::new(linear.x, linear.y, linear.z / moment_limit).norm();
                (linear * saturation(q)).into()
            }
            CreepLaw::KalkerTable => {
                // Along the rolling direction and across it, on an ellipse that is as long in both directions: exact
                // for rolling along an axis, an approximation (see the tests) for oblique rolling.
                let (sin, cos) = self.rolling_angle.sin_cos();
                let along = 1.0 / (cos / a).hypot(sin / b);
                let across = 1.0 / (sin / a).hypot(cos / b);
                let seen = Patch { axis_ratio: along / across, rolling_angle: 0.0, ..*patch };
                let failed = |why| ContactError::Linear(self.id.clone(), why);
                let table = CreepTable::new(&seen).map_err(failed)?;
                let coefficients = creep_matrix(&seen).map_err(failed)?;
                let turn = nalgebra::Rotation2::new(self.rolling_angle);
                let creep = turn.inverse() * nalgebra::Vector2::new(self.creep_x, self.creep_y);
                let scale = self.shear_modulus * c * c / limit;
                let q = [
                    coefficients[(0, 0)] * creep.x * scale,
                    coefficients[(1, 1)] * creep.y * scale,
                    coefficients[(2, 2)] * self.spin * c * scale / moment_limit,
                ];
                let ([x, y, z], _) = table.evaluate(q);
                let force = turn * nalgebra::Vector2::new(x, y);
                [force.x, force.y, z * moment_limit]
            }
            CreepLaw::Regularised => {
                // The law is written for rolling along an axis: components along and across the rolling direction.
                let (sin, cos) = self.rolling_angle.sin_cos();
                let turn = nalgebra::Rotation2::new(self.rolling_angle);
                let along = Vector3::new(cos, sin, 0.0);
                let across = Vector3::new(-sin, cos, 0.0);
                let stiffness = self.shear_modulus * c * c;
                let theory = LinearTheory {
                    longitudinal: stiffness * along.dot(&(matrix * along)),
                    lateral: stiffness * across.dot(&(matrix * across)),
                    coupling: stiffness * c * across.dot(&(matrix * Vector3::z())),
                    spin: stiffness * c * c * matrix[(2, 2)],
                    friction_limit: limit,
                    moment_limit: limit * c * moment_limit,
                    mean_semi_axis: c,
                };
                let creep = turn.inverse() * nalgebra::Vector2::new(self.creep_x, self.creep_y);
                let creepage = Creepage { longitudinal: creep.x, lateral: creep.y, spin: self.spin };
                let f = theory.forces(creep::Law::Regularised, &creepage);
                let force = turn * nalgebra::Vector2::new(f.longitudinal, f.lateral) / limit;
                [force.x, force.y, f.spin_moment / (limit * c)]
            }
        })
    }
}
