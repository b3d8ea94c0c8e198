//! Section of a cage that is estimated from the balls: of pressed steel, guided by the balls.

use std::f64::consts::PI;

use super::digits::short;
use crate::effects::rating::standard::Geometry;

/// [kg/m3] density of sheet steel.
const DENSITY: f64 = 7800.0;
/// [-] height of the strip over the ball diameter, along the radius.
const HEIGHT: f64 = 0.7;
/// [-] thickness of both halves over the ball diameter, along the axis: two sheets of 1 mm for balls of 8 mm.
const THICKNESS: f64 = 0.25;
/// [-] clearance of a ball in its pocket over its diameter.
const CLEARANCE: f64 = 0.02;

/// Lines of `[cage]`.
pub(super) fn section(geometry: &Geometry) -> Vec<String> {
    let (ball, pitch) = (geometry.ball_diameter, geometry.pitch_diameter);
    let mass = DENSITY * PI * pitch * (HEIGHT * ball) * (THICKNESS * ball);
    // A thin ring.
    let polar = 0.25 * mass * pitch * pitch;
    let [polar, transverse] = [polar, 0.5 * polar].map(|of| format!("\"{of:.2e} kg m^2\""));
    vec![
        "[cage]".into(),
        format!(
            "# Estimated as two halves of pressed steel around the pitch circle, {HEIGHT} D high and {THICKNESS} D thick together; spread a factor \
             of 2."
        ),
        format!("mass = \"{} g\"", short(1e3 * mass, 3)),
        format!("inertia = [{polar}, {transverse}, {transverse}]"),
        format!("# Estimated as {CLEARANCE} D; spread a factor of 2."),
        format!("pocket_clearance = \"{} um\"", short(1e6 * CLEARANCE * ball, 3)),
        "guided_by = \"balls\"            # chosen: as most of pressed steel are".into(),
        "damping = \"0.5 s/m\"            # chosen".into(),
        String::new(),
    ]
}
