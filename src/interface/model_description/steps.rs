//! Communication steps that packages recommend.

use crate::analysis::condensed::Condensed;
use crate::scene::Drive;
use crate::simulation::Simulation;

/// The recommended communication step resolves the passing of the balls with twenty points, and is not longer than the
/// scene's own output interval. Where the pose of the inner race is an input, it also is short enough for a shaft that its
/// master moves by leapfrog (`docs/coupling.md`): half the reciprocal of its angular frequency on the bearing, a quarter of
/// what is stable. The shaft has the mass that the scene gives, or 1 kg.
pub fn recommended_step(simulation: &Simulation) -> f64 {
    const SHAFT_MASS: f64 = 1.0; // [kg]
    const FREQUENCY_BY_STEP: f64 = 0.5; // [rad]
    let scene = simulation.scene();
    let mut step = scene.load.output_interval.0.min(passing_step(simulation));
    if scene.inner.drive == Drive::Pose {
        let condensed = Condensed::new(simulation.model(), simulation.state(), &simulation.conditions());
        let stiffness = (0..3).map(|axis| condensed.stiffness[(axis, axis)]).fold(0.0, f64::max);
        let mass = scene.inner.mass.map_or(SHAFT_MASS, |mass| mass.0);
        if stiffness > 0.0 {
            step = step.min(round_down(FREQUENCY_BY_STEP * (mass / stiffness).sqrt()));
        }
    }
    step
}

/// \[s] communication step that resolves the passing of the balls; infinite where they do not pass.
pub fn passing_step(simulation: &Simulation) -> f64 {
    const POINTS_PER_PASSAGE: f64 = 20.0;
    let outputs = simulation.outputs();
    let balls = simulation.scene().bearing.balls as f64;
    // Balls pass a point of a race at their speed relative to it.
    let speeds = [outputs.inner.twist.angular_velocity.x, outputs.outer.twist.angular_velocity.x];
    let passing = speeds.map(|speed| balls * (speed - outputs.cage_speed).abs() / std::f64::consts::TAU);
    let frequency = passing[0].max(passing[1]);
    if frequency > 0.0 { round_down(1.0 / (POINTS_PER_PASSAGE * frequency)) } else { f64::INFINITY }
}

/// The next number below of 1, 2, 5, 10 and so on.
fn round_down(x: f64) -> f64 {
    let exponent = x.log10().floor() as i32;
    let mantissa = x / 10f64.powi(exponent);
    let digit = if mantissa >= 5.0 {
        5.0
    } else if mantissa >= 2.0 {
        2.0
    } else {
        1.0
    };
    // Written in decimals and read again, so that it is the number nearest to what it says.
    format!("{digit}e{exponent}").parse().unwrap_or(x)
}
