//! A contact of a ball in a groove, and every creep law for it; not every test asks for all.
#![allow(dead_code)]

use std::f64::consts::PI;

use roulement::contact::creep::{Law, LinearTheory};
use roulement::contact::identification::identify_by_table;
use roulement::contact::regularised::Parameters;
use roulement::kalker::Patch;
use roulement::kalker::linear::Scales;
use roulement::kalker::scaled_law::ScaledKalker;
use roulement::kalker::table::CreepTable;

const RATIO: f64 = 0.107;

/// Its patch, rolling along x.
pub fn patch() -> Patch {
    Patch { axis_ratio: RATIO, poisson_ratio: 0.3, rolling_angle: 0.0 }
}

/// A contact of a ball in a groove: 300 N on 1.6 GPa, friction 0.08.
pub fn theory() -> LinearTheory<f64> {
    theory_of(RATIO, 300.0, 1.6e9, 79e9, 0.08)
}

/// A contact of given axis ratio, load [N], peak pressure and shear modulus [Pa] and friction coefficient.
pub fn theory_of(ratio: f64, load: f64, pressure: f64, shear: f64, friction: f64) -> LinearTheory<f64> {
    let patch = Patch { axis_ratio: ratio, poisson_ratio: 0.3, rolling_angle: 0.0 };
    let scales = Scales::new(&patch).unwrap();
    let c = f64::sqrt(1.5 * load / (PI * pressure));
    let stiffness = shear * c * c * 2.0 * PI / 3.0;
    LinearTheory {
        longitudinal: stiffness * scales.c11,
        lateral: stiffness * scales.c22,
        coupling: stiffness * c * scales.c23,
        spin: stiffness * c * c * scales.c33,
        friction_limit: friction * load,
        moment_limit: friction * load * c * scales.moment,
        mean_semi_axis: c,
        half_width: c / ratio.sqrt(),
    }
}

/// Everything that the laws need.
pub struct Laws {
    pub parameters: Parameters,
    pub table: CreepTable,
    pub kalker: ScaledKalker,
}

impl Laws {
    pub fn new() -> Self {
        let patch = Patch { axis_ratio: RATIO, poisson_ratio: 0.3, rolling_angle: 0.0 };
        Self {
            parameters: identify_by_table(&patch).unwrap().parameters,
            table: CreepTable::new(&patch).unwrap(),
            kalker: ScaledKalker::new(&patch, 3).unwrap(),
        }
    }

    pub fn bounded(&self) -> [(&'static str, Law<'_>); 4] {
        [
            ("saturated", Law::Saturated),
            ("regularised", Law::Regularised(&self.parameters)),
            ("kalker_table", Law::Table(&self.table)),
            ("kalker", Law::Kalker(&self.kalker)),
        ]
    }
}
