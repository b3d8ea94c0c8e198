//! Single rolling contacts, as `roulement contact` evaluates them: a patch, its load and its creepages.

use std::str::FromStr;

use nalgebra::{Matrix3, Rotation2, Vector2, Vector3};
use serde::{Deserialize, Serialize};
use strum::{EnumMessage, VariantArray};
use thiserror::Error;

use super::stick_slip::FieldCause;
use crate::contact::creep::{self, CreepForces, Creepage, LinearTheory, saturation};
use crate::contact::identification::identify_by_table;
use crate::contact::oblique::{Across, Exchanged, exchanged};
use crate::contact::regularised::Parameters;
use crate::kalker::LinearError;
use crate::kalker::half_space::{HalfSpaceError, Refined, extrapolated, refined};
use crate::kalker::linear::creep_matrix;
use crate::kalker::nonlinear::{Kalker, KalkerError};
use crate::kalker::table::CreepTable;
use crate::kalker::{Patch, ScaledCreepage, ScaledForces};
use crate::numerics::elliptic::complete_elliptic_integrals;
use crate::scene::CreepLaw;

/// Degree of the nonlinear theory's polynomials in simulations, where nothing else is said.
const DEGREE: usize = 3;

/// A rolling contact; columns of a case table have these names.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub struct RollingContact {
    /// Name of the case.
    pub id: String,
    /// [-] Poisson's ratio of both bodies.
    pub poisson_ratio: f64,
    /// \[Pa] shear modulus of both bodies.
    pub shear_modulus: f64,
    /// [-] friction coefficient.
    pub friction: f64,
    /// \[Pa] peak of the Hertzian pressure.
    pub peak_pressure: f64,
    /// \[m] semi-axis along the ellipse's x axis.
    pub semi_axis_x: f64,
    /// \[m] semi-axis along its y axis.
    pub semi_axis_y: f64,
    /// \[rad] direction of rolling from the x axis.
    #[serde(default)]
    pub rolling_angle: f64,
    /// [-] creepage along x.
    pub creep_x: f64,
    /// [-] creepage along y.
    pub creep_y: f64,
    /// [1/m] spin creepage.
    pub spin: f64,
    /// [1/m2] slip `-curvature y^2` along x over the rolling speed, of a groove that bends across rolling (Heathcote).
    #[serde(default)]
    pub curvature: f64,
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
    /// The half-space reference solver on grids as fine as each contact needs.
    Exact,
}

impl Law {
    /// Names of all laws and what each is: those of the simulation from the poorest to the richest, then the half-space solver.
    pub fn names() -> impl Iterator<Item = (&'static str, &'static str)> {
        let simulated =
            CreepLaw::VARIANTS.iter().map(|law| (law.into(), law.get_documentation().unwrap_or_default()));
        simulated.chain([
            ("reference", "The half-space reference solver on two grids: slow."),
            ("exact", "The half-space reference solver on grids as fine as each contact needs: slower."),
        ])
    }

    /// The law of one of these names: `kalker` with polynomials of a degree, `reference` with `grid` cells across the ellipse of its
    /// coarser grid.
    pub fn named(name: &str, degree: usize, grid: usize) -> Option<Self> {
        match name {
            "kalker" => Some(Self::Kalker(degree)),
            "reference" => Some(Self::Reference(grid)),
            "exact" => Some(Self::Exact),
            _ => CreepLaw::from_str(name).ok().map(Self::Simulated),
        }
    }
}

/// A contact in Kalker's scale: what its forces over mu N depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledContact {
    /// Ellipse, material and direction of rolling.
    pub patch: Patch,
    /// Creepages.
    pub creepage: ScaledCreepage,
}

impl ScaledContact {
    /// Its forces by the half-space reference solver, on grids as fine as they need.
    ///
    /// # Errors
    /// See [`HalfSpaceError`].
    pub fn exact(&self) -> Result<Refined, HalfSpaceError> {
        refined(&self.patch, &self.creepage)
    }
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

/// Parameters of the regularised law, with or without its coupling.
fn parameters_of(law: CreepLaw, patch: &Patch) -> Result<Parameters, LinearError> {
    let parameters = identify_by_table(patch)?.parameters;
    Ok(if law == CreepLaw::Uncoupled { parameters.uncoupled() } else { parameters })
}

/// Is an ellipse slender enough to be seen along its axes where it rolls obliquely?
fn is_slender(patch: &Patch) -> bool {
    !(0.5..=2.0).contains(&patch.axis_ratio)
}

impl RollingContact {
    /// Mean errors of force over mu N and spin moment over mu N c that the table of the nonlinear theory is expected to have at
    /// this contact, where it rolls obliquely (`tests/kalker/oblique_net.rs`). None along an axis, and for other laws.
    pub fn expected_error(&self, law: Law) -> Option<[f64; 2]> {
        let (sin, cos) = self.rolling_angle.sin_cos();
        let oblique = sin.abs().min(cos.abs()) > 0.02;
        (law == Law::Simulated(CreepLaw::KalkerTable) && oblique).then_some([0.007, 0.005])
    }

    /// Evaluates the contact by a law.
    ///
    /// # Errors
    /// See [`ContactError`].
    pub fn evaluate(&self, law: Law) -> Result<RollingForces, ContactError> {
        self.check()?;
        let c = self.mean_semi_axis();
        let ScaledContact { patch, creepage } = self.in_scale();
        let ([fx, fy, mz, second_moment], stick) = match law {
            Law::Simulated(CreepLaw::Kalker) => return self.evaluate(Law::Kalker(DEGREE)),
            Law::Simulated(law) => (self.simulated(law, &patch, c)?, None),
            Law::Reference(cells) => {
                let failed = |why| ContactError::Reference(self.id.clone(), why);
                let f = extrapolated(&patch, &creepage, cells).map_err(failed)?;
                ([f.fx, f.fy, f.mz, f.second_moment], None)
            }
            Law::Exact => {
                let failed = |why| ContactError::Reference(self.id.clone(), why);
                return Ok(self.with_forces(&refined(&patch, &creepage).map_err(failed)?.forces));
            }
            Law::Kalker(degree) => {
                let failed = |why| ContactError::Kalker(self.id.clone(), why);
                let solution = Kalker::new(patch, degree)
                    .and_then(|kalker| kalker.solve(&creepage, None))
                    .map_err(failed)?;
                let f = solution.forces;
                ([f.fx, f.fy, f.mz, f.second_moment], Some(solution.stick))
            }
        };
        Ok(RollingForces { stick, ..self.with_forces(&ScaledForces { fx, fy, mz, second_moment }) })
    }

    /// The contact in Kalker's scale, for forces that are had elsewhere ([`Self::with_forces`]).
    ///
    /// # Errors
    /// If a number is out of range.
    pub fn scaled(&self) -> Result<ScaledContact, ContactError> {
        self.check()?;
        let contact = self.in_scale();
        contact.patch.check().map_err(|why| ContactError::Linear(self.id.clone(), why))?;
        Ok(contact)
    }

    /// Forces and power of the contact by its forces in Kalker's scale.
    pub fn with_forces(&self, forces: &ScaledForces) -> RollingForces {
        let c = self.mean_semi_axis();
        let ScaledForces { fx, fy, mz, second_moment } = *forces;
        let power = self.creep_x * fx + self.creep_y * fy + self.spin * c * mz
            - self.curvature * c * c * second_moment;
        RollingForces { id: self.id.clone(), fx, fy, mz, power, stick: None }
    }

    /// Cause of its field ([`FieldCause::field`]), at a rolling speed of 1 m/s: slip is that over the rolling speed.
    ///
    /// # Errors
    /// If a number is out of range.
    pub fn field_cause(&self) -> Result<FieldCause, ContactError> {
        let ScaledCreepage { x, y, spin, curvature } = self.scaled()?.creepage;
        Ok(FieldCause {
            semi_axes: [self.semi_axis_x, self.semi_axis_y],
            pressure: self.peak_pressure,
            friction: self.friction,
            creepage: [x, y, spin, curvature],
            poisson_ratio: self.poisson_ratio,
            shear_modulus: self.shear_modulus,
            rolling_speed: 1.0,
            rolling_angle: self.rolling_angle,
        })
    }

    /// \[m] `c = sqrt(a b)`.
    fn mean_semi_axis(&self) -> f64 {
        (self.semi_axis_x * self.semi_axis_y).sqrt()
    }

    fn in_scale(&self) -> ScaledContact {
        let c = self.mean_semi_axis();
        let scale = self.shear_modulus / (self.friction * self.peak_pressure);
        ScaledContact {
            patch: Patch {
                axis_ratio: self.semi_axis_x / self.semi_axis_y,
                poisson_ratio: self.poisson_ratio,
                rolling_angle: self.rolling_angle,
            },
            creepage: ScaledCreepage {
                x: self.creep_x * scale,
                y: self.creep_y * scale,
                spin: self.spin * c * scale,
                curvature: self.curvature * c * c * scale,
            },
        }
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
        for (name, value) in [
            ("creep_x", self.creep_x),
            ("creep_y", self.creep_y),
            ("spin", self.spin),
            ("curvature", self.curvature),
        ] {
            if !value.is_finite() {
                return refuse(name, value, "a finite number");
            }
        }
        Ok(())
    }

    /// Forces by one of the simulation's laws, over mu N and mu N c.
    fn simulated(&self, law: CreepLaw, patch: &Patch, c: f64) -> Result<[f64; 4], ContactError> {
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
            CreepLaw::Frictionless => [0.0; 4],
            CreepLaw::Linear => [linear.x, linear.y, linear.z, 0.0],
            CreepLaw::Saturated if self.curvature == 0.0 => {
                let q = Vector3::new(linear.x, linear.y, linear.z / moment_limit).norm();
                let forces = linear * saturation(q);
                [forces.x, forces.y, forces.z, 0.0]
            }
            CreepLaw::KalkerTable => self.along_axes(law, patch, limit, limit * c * moment_limit)?,
            CreepLaw::Regularised | CreepLaw::Uncoupled if is_slender(patch) => {
                self.along_axes(law, patch, limit, limit * c * moment_limit)?
            }
            _ => self.along_rolling(law, patch, &matrix, limit, limit * c * moment_limit)?,
        })
    }

    /// Laws that are known for rolling along an axis of the ellipse, in components along and across rolling: for ellipses that are nearly
    /// circles.
    fn along_rolling(
        &self,
        law: CreepLaw,
        patch: &Patch,
        matrix: &Matrix3<f64>,
        friction_limit: f64,
        moment_limit: f64,
    ) -> Result<[f64; 4], ContactError> {
        let failed = |why| ContactError::Linear(self.id.clone(), why);
        let (sin, cos) = self.rolling_angle.sin_cos();
        let along = 1.0 / (cos / self.semi_axis_x).hypot(sin / self.semi_axis_y);
        let half_width = 1.0 / (sin / self.semi_axis_x).hypot(cos / self.semi_axis_y);
        let c = self.mean_semi_axis();
        let seen = Patch { axis_ratio: along / half_width, rolling_angle: 0.0, ..*patch };
        let turn = Rotation2::new(self.rolling_angle);
        let axis = |turned: Vector2<f64>| Vector3::new(turned.x, turned.y, 0.0);
        let (x, y) = (axis(turn * Vector2::x()), axis(turn * Vector2::y()));
        let stiffness = self.shear_modulus * c * c;
        let theory = LinearTheory {
            longitudinal: stiffness * x.dot(&(matrix * x)),
            lateral: stiffness * y.dot(&(matrix * y)),
            coupling: stiffness * c * y.dot(&(matrix * Vector3::z())),
            spin: stiffness * c * c * matrix[(2, 2)],
            friction_limit,
            moment_limit,
            mean_semi_axis: c,
            half_width,
        };
        let creep = turn.inverse() * Vector2::new(self.creep_x, self.creep_y);
        let creepage = Creepage {
            longitudinal: creep.x,
            lateral: creep.y,
            spin: self.spin,
            curvature: (self.curvature != 0.0).then_some(self.curvature),
        };
        let forces = match law {
            CreepLaw::Regularised | CreepLaw::Uncoupled => {
                let parameters = parameters_of(law, &seen).map_err(failed)?;
                theory.forces(creep::Law::Regularised(&parameters), &creepage)
            }
            _ => theory.forces(creep::Law::Saturated, &creepage),
        };
        let force = turn * Vector2::new(forces.longitudinal, forces.lateral) / friction_limit;
        let moments = [forces.spin_moment / c, forces.second_moment / (c * c)].map(|m| m / friction_limit);
        Ok([force.x, force.y, moments[0], moments[1]])
    }

    /// Laws that are known for rolling along an axis of the ellipse: both are mixed as simulations do, and what the table lacks is added.
    fn along_axes(
        &self,
        law: CreepLaw,
        patch: &Patch,
        friction_limit: f64,
        moment_limit: f64,
    ) -> Result<[f64; 4], ContactError> {
        let failed = |why| ContactError::Linear(self.id.clone(), why);
        let aligned = Patch { rolling_angle: 0.0, ..*patch };
        let (sin, cos) = self.rolling_angle.sin_cos();
        let matrix = creep_matrix(&aligned).map_err(failed)?;
        let c = self.mean_semi_axis();
        let stiffness = self.shear_modulus * c * c;
        let theory = LinearTheory {
            longitudinal: stiffness * matrix[(0, 0)],
            lateral: stiffness * matrix[(1, 1)],
            coupling: stiffness * c * matrix[(1, 2)] * cos,
            spin: stiffness * c * c * matrix[(2, 2)],
            friction_limit,
            moment_limit,
            mean_semi_axis: c,
            half_width: self.semi_axis_y,
        };
        let creepage = Creepage {
            longitudinal: self.creep_x,
            lateral: self.creep_y,
            spin: self.spin,
            curvature: (self.curvature != 0.0).then_some(self.curvature),
        };
        let sides = [aligned, exchanged(patch)];
        let mixed = |[along, across]: [creep::Law<'_>; 2]| -> Result<CreepForces<f64>, LinearError> {
            let exchanged = Exchanged::new(&aligned)?;
            let forces = theory.forces(along, &creepage);
            Ok(Across { exchanged: &exchanged, law: across }.forces(&forces, &theory, [cos, sin], &creepage))
        };
        let forces = match law {
            CreepLaw::Regularised | CreepLaw::Uncoupled => {
                let [along, across] = sides.map(|patch| parameters_of(law, &patch));
                let parameters = [along.map_err(failed)?, across.map_err(failed)?];
                mixed(parameters.each_ref().map(creep::Law::Regularised))
            }
            _ => {
                let [along, across] = sides.map(|patch| CreepTable::new(&patch));
                let tables = [along.map_err(failed)?, across.map_err(failed)?];
                mixed(tables.each_ref().map(creep::Law::Table))
            }
        }
        .map_err(failed)?;
        let moments = [forces.spin_moment / c, forces.second_moment / (c * c)].map(|m| m / friction_limit);
        Ok([forces.longitudinal / friction_limit, forces.lateral / friction_limit, moments[0], moments[1]])
    }
}
