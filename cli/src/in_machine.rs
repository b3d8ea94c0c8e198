//! Bearings of the catalogue that a machine alone has, rollers and those of two rows, each in a machine of its own: a shaft that turns in it.

use roulement::catalogue::{CatalogueError, DoubleRow, rollers_of, rows_of, two_digits};
use roulement::scene::system::SystemScene;
use roulement::schema::SceneError;
use thiserror::Error;

/// [-] load of the machine over C.
const LOAD: f64 = 0.1;
/// [-] diameter of the shaft over that of the circle of the rolling elements.
const SHAFT: f64 = 0.7;

/// Why there is no machine.
#[derive(Debug, Error)]
pub enum InMachineError {
    /// There is no such bearing.
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    /// Its machine cannot be read.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// The machine of a designation, as the text of a file; none where it is a bearing that can be simulated alone.
///
/// # Errors
/// If its size is not known.
pub fn machine_of(designation: &str) -> Option<Result<String, InMachineError>> {
    let of_rollers = rollers_of(designation).map(|found| {
        let keys = found?;
        let about = "# Rollers: diameters are those of exchangeable rings, number and length are estimated (docs/catalogue.md). The same as\n\
             # catalogue in place of them.";
        let section = format!("{about}\n[bearing.rollers]\n{keys}");
        // With any load: ratings follow from the rollers.
        let machine = SystemScene::edited(&text(designation, &section, 0.02, (Load::Radial, 1.0)))?;
        let rollers = machine.springs.iter().find_map(|spring| spring.rollers.as_ref());
        let [pitch, rating] = rollers.map_or([0.02, 1.0], |rollers| {
            [rollers.geometry().pitch_diameter, rollers.ratings().dynamic_load_rating]
        });
        Ok(text(designation, &section, pitch, (Load::Radial, rating)))
    });
    let of_rows = || {
        let found = rows_of(designation)?;
        Some(found.map_err(InMachineError::from).and_then(|DoubleRow { scene, distance, dynamic_load_rating, .. }| {
            let row = roulement::Scene::parse(&scene)?;
            let section = format!(
                "# Two sets of balls on the same shaft and in the same seat: -1, at the smaller x if they lie apart, and -2.\ncatalogue = \"{designation}\""
            );
            // Sets at one place are made for thrusts.
            let load = if distance == 0.0 { Load::Thrust } else { Load::Radial };
            Ok(text(designation, &section, row.bearing.pitch_diameter.0, (load, dynamic_load_rating)))
        }))
    };
    of_rollers.or_else(of_rows)
}

/// Way of the example's load: across the axis or along it.
enum Load {
    Radial,
    Thrust,
}

/// A shaft in a bearing, with the keys of that, for a circle of its elements \[m], and its load by C \[N].
fn text(designation: &str, bearing: &str, pitch: f64, (load, rating): (Load, f64)) -> String {
    let name: String =
        designation.chars().map(|sign| if sign.is_ascii_alphanumeric() { sign } else { '_' }).collect();
    let millimetres = |length: f64| (1e4 * length).round() * 0.1;
    let (thick, half) = (millimetres(SHAFT * pitch), millimetres(pitch));
    let size = two_digits(LOAD * rating);
    let (along, load, held) = match load {
        Load::Radial => ("across", format!("[0, \"{size} N\", 0]"), "displacement = { x = 0 }\n"),
        Load::Thrust => ("along", format!("[\"{size} N\", 0, 0]"), ""),
    };
    format!(
        "title = \"{designation}, internal geometry estimated\"

# An example, to be changed: a shaft as thick as the inner ring takes it.
[[shaft]]
name = \"shaft\"
speed = \"1500 rpm\"

[[shaft.section]]
from = \"-{half} mm\"
to = \"{half} mm\"
outer_diameter = \"{thick} mm\"

# 0.1 C {along} the axis. What the bearing alone does not hold is held here: take out what another bearing holds.
[[shaft.load]]
name = \"load\"
position = 0
force = {load}
{held}rotation = {{ ry = 0, rz = 0 }}

[[bearing]]
name = \"{name}\"
mounting = {{ position = 0 }}
{bearing}

[load]
duration = \"20 ms\"
output_interval = \"100 us\"
"
    )
}
