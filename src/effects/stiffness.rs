//! Report of stiffness and damping of the running bearing, balls condensed out ([`crate::analysis::condensed`]).

use nalgebra::Matrix6;

use super::effect::{Effect, Getter, Info, Row};
use super::keys::keys;
use super::reports::Condensed;
use crate::schema::variable_units::{self as units, Unit};

keys! {
    /// Are stiffness and damping of the running bearing reported (`stiffness.*`, `damping.*`)?
    "stiffness_outputs" => on: bool = false,
}

/// Loads and motions by their components: translations first.
const DIRECTIONS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];
const AXES: [&str; 3] = ["x", "y", "z"];

/// Unit and typical size of a component, by whether it is of a force and by a translation.
type UnitOf = fn(bool, bool) -> (Unit, f64);

fn stiffness_unit(force: bool, translation: bool) -> (Unit, f64) {
    match (force, translation) {
        (true, true) => (units::NEWTON_PER_METRE, 1e8),
        (true, false) => (units::NEWTON_PER_RADIAN, 1e6),
        (false, true) => (units::NEWTON_METRE_PER_METRE, 1e6),
        (false, false) => (units::NEWTON_METRE_PER_RADIAN, 1e4),
    }
}

fn damping_unit(force: bool, translation: bool) -> (Unit, f64) {
    match (force, translation) {
        (true, true) => (units::NEWTON_SECOND_PER_METRE, 1e4),
        (true, false) => (units::NEWTON_SECOND_PER_RADIAN, 1e2),
        (false, true) => (units::NEWTON_METRE_SECOND_PER_METRE, 1e2),
        (false, false) => (units::NEWTON_METRE_SECOND_PER_RADIAN, 1.0),
    }
}

/// One row per component of a matrix: what the load does, names of translation and rotation, and what is to be known of it.
fn components(
    name: &str,
    unit_of: UnitOf,
    [does, translation, rotation, note]: [&str; 4],
    matrix: fn(&Condensed) -> &Matrix6<f64>,
) -> Vec<Row> {
    let of = |i: usize, k: usize| {
        let (unit, nominal) = unit_of(i < 3, k < 3);
        let load = if i < 3 { "force" } else { "moment" };
        let by = if k < 3 { translation } else { rotation };
        let (row, column) = (AXES[i % 3], AXES[k % 3]);
        Row {
            name: format!("{name}.{}.{}", DIRECTIONS[i], DIRECTIONS[k]),
            unit,
            nominal,
            description: format!(
                "external {load} {row} that {does} the inner race by its {by} {column} relative to the outer race{note}"
            ),
            get: Getter::new(move |reports| reports.condensed.map_or(0.0, |c| matrix(c)[(i, k)])),
        }
    };
    (0..36).map(|index| of(index / 6, index % 6)).collect()
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.stiffness_outputs",
        adds: "report of the stiffness and damping of the running bearing, 6 x 6 each, balls condensed out",
        states: "none",
        source: "exact derivatives of the contact laws, condensed (docs/model.md)",
        price: "42 % of a run with rows every ten steps (thrust case)",
        example: "[effects]\nstiffness_outputs = true\n",
    };

    fn setting(&self) -> Option<String> {
        self.on.then(|| "on".into())
    }

    fn headlines(&self) -> &'static [&'static str] {
        &["stiffness.x.x", "stiffness.y.y", "stiffness.z.z"]
    }

    fn rows(&self) -> Vec<Row> {
        if !self.on {
            return vec![];
        }
        let words = ["holds", "translation", "rotation", ""];
        let mut rows = components("stiffness", stiffness_unit, words, |c| &c.stiffness);
        // Creep forces are linear in slip over rolling speed: their damping grows as one over that speed.
        let note = "; grows as the bearing slows down, and at rest is that of the creep law's 1e-3 m/s, no property of the bearing";
        let words = ["moves", "velocity", "angular velocity", note];
        rows.extend(components("damping", damping_unit, words, |c| &c.damping));
        rows
    }
}
