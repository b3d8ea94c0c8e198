//! Scenes of the hard cases: two bearings whose sections are written anew where a case differs.

use roulement::scene::Scene;

/// Angular-contact bearing under thrust, inner race a body.
pub const ANGULAR: &str = include_str!("../../scenes/thrust.toml");
/// Deep-groove bearing like a 6206, inner race a body.
pub const GROOVE: &str = include_str!("../../scenes/radial.toml");

/// The angular-contact bearing with a brass cage on lands of the outer race.
pub const CAGE: &str = include_str!("../../scenes/cage.toml");

/// Angular-contact bearing as above, with its inner race moved by the importer.
pub const POSE: &str = "[inner]\ndrive = \"pose\"";

/// The inner race of both bearings with a groove that reaches to both sides, so that balls may climb either.
pub const WHOLE_INNER: &str = "[inner]\ndrive = \"wrench\"\nmass = \"0.2 kg\"\n\
                               inertia = [\"6e-5 kg m^2\", \"4e-5 kg m^2\", \"4e-5 kg m^2\"]\n\
                               shoulder_angle = [1.5, 1.5]\n";
/// The same of the outer race.
pub const WHOLE_OUTER: &str = "[outer]\nshoulder_angle = [1.5, 1.5]\n";

/// Balls that roll at the start, all spin on the inner race.
pub const ROLLING_START: &str = "[start]\nspin_balance = false\n";

/// Directions in which a bearing cannot hold its inner race by itself are held at 0.
pub const HELD: &str = "y = { displacement = 0.0 }\nz = { displacement = 0.0 }\n\
                        ry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n";

/// A scene of `base` in which every section of `changes` takes the place of the one with its name.
pub fn scene(base: &str, changes: &str) -> Scene {
    let sections: toml::Table = changes.parse().unwrap_or_else(|why| panic!("{why}\n{changes}"));
    let sections = sections.iter().map(|(name, section)| (name, section.to_string()));
    Scene::edited(base, sections).unwrap_or_else(|why| panic!("{why}\n{changes}"))
}

/// Section `[load]` with `rows` after the usual duration [ms] and speed of the inner race [rpm].
pub fn load(milliseconds: f64, rpm: f64, rows: &str) -> String {
    format!("[load]\nduration = \"{milliseconds} ms\"\ninner_speed = \"{rpm} rpm\"\n{rows}\n")
}

/// Section `[load]` as [`load`], the inner race's speed a table.
pub fn ramp(milliseconds: f64, speed: &str, rows: &str) -> String {
    format!("[load]\nduration = \"{milliseconds} ms\"\ninner_speed = {speed}\n{rows}\n")
}

/// Axial motion and tilt held at 0: what a deep-groove bearing under radial load leaves loose.
pub const FLAT: &str = "x = { displacement = 0.0 }\nry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n";

/// The deep-groove bearing with another diametral clearance [um] and conformity.
pub fn groove(micrometres: f64, conformity: f64) -> String {
    format!(
        "[bearing]\nballs = 9\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
         diametral_clearance = \"{micrometres} um\"\ninner_conformity = {conformity}\n\
         outer_conformity = {conformity}\n"
    )
}
