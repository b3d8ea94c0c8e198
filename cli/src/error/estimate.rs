//! Estimate of the numerical error of a single run from its own local errors.
//!
//! Every step leaves a local error in the positions. Of what swings they add up to a phase, so that their sum over the run, over
//! the elastic approach of the balls, says how far loads are off. What a ball's even turn about the bearing axis leaves is
//! taken out: it shifts the ball along its orbit and loads nothing. How much of the rest is seen depends on the damping and on
//! what is looked at: the factors here are the middle of many runs, and single ones may be ten times above or below it
//! (`docs/accuracy-cost.md`). `--error` measures.

use nalgebra::Vector3;

use roulement::numerics::hht::HhtStep;
use roulement::scene::Scales;
use roulement::simulation::Simulation;

/// [-] errors of histories and of means over the sum of local errors over the approach: the middle of 90 runs of nine scenes with
/// tolerances from 1e-5 to 1e-9, of which five in six are within a factor of ten.
const FACTORS: [f64; 2] = [0.5, 0.012];
/// [-] part of a local error that is kept at least: even turns are known no better. With 0.01 histories at n dm of 3e6 mm/min, where
/// next to all of a local error is that of the turn, were up to 13 times as wrong as estimated.
const KEPT: f64 = 0.1;

/// Sum of the local errors of a run, from its rows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Estimate {
    time: Option<f64>,
    steps: u64,
    sum: f64,
    /// Rows in which neighbouring balls or a cage touched what they touch now and then, and rows in which they did not.
    touching: [u64; 2],
}

impl Estimate {
    /// Takes a row: its last step stands for all of them since the last row.
    pub fn push(&mut self, simulation: &Simulation) {
        let steps = simulation.state().statistics.steps;
        let (now, new) = (simulation.time(), steps - self.steps);
        if let (Some(before), true) = (self.time, new > 0) {
            let error = simulation.local_error();
            let turn = error_of_turn(simulation, (now - before) / new as f64);
            let swing = (error * error - turn * turn).max(0.0).sqrt().max(KEPT * error);
            self.sum += new as f64 * swing;
        }
        (self.time, self.steps) = (Some(now), steps);
        let outputs = simulation.outputs();
        let of_cage = outputs.cage.is_some_and(|cage| cage.land_loads != [0.0; 2])
            || outputs.balls.iter().any(|ball| ball.pocket.is_some_and(|pocket| pocket.load > 0.0));
        let touches = of_cage || outputs.neighbours.is_some_and(|neighbours| neighbours.touching > 0);
        self.touching[usize::from(touches)] += 1;
    }

    /// Do bodies strike each other, because nothing holds them together: neighbouring balls, or a cage and what it touches? A blow comes a
    /// little earlier or later with other steps, and errors of a few blows do not cancel in means.
    pub fn has_blows(&self) -> bool {
        self.touching.iter().all(|rows| *rows > 0)
    }

    /// [-] likely errors of histories and of means, over the sizes of the quantities; none before the first step. With blows means are
    /// known no better than histories.
    pub fn errors(&self, simulation: &Simulation) -> Option<[f64; 2]> {
        let approach = Scales::of(simulation.scene()).approach;
        let [histories, means] = FACTORS.map(|factor| factor * self.sum / approach);
        (self.sum > 0.0).then_some([histories, if self.has_blows() { histories } else { means }])
    }
}

/// [-] local error over the ball diameter that a step \[s] makes where balls do nothing but turn about the bearing axis: their
/// accelerations, and those of their spins, turn with them.
fn error_of_turn(simulation: &Simulation, step: f64) -> f64 {
    let (model, outputs) = (simulation.model(), simulation.outputs());
    let radius = model.bearing.ball.radius;
    let scheme = HhtStep::new(model.solver.alpha_f, step);
    let square =
        |change: f64| scheme.local_error(&Vector3::zeros(), &Vector3::new(change, 0.0, 0.0)).norm_squared();
    let of_ball = |ball: &roulement::simulation::outputs::BallOutput| {
        let turn = ball.orbital_speed;
        let orbit = (ball.position - outputs.outer.pose.position).yz().norm();
        square(turn.powi(3) * orbit * step)
            + square(turn * turn * ball.angular_velocity.yz().norm() * radius * step)
    };
    let sum: f64 = outputs.balls.iter().map(of_ball).sum();
    let bodies = outputs.balls.len() + model.bodies.iter().filter(|(_, body)| body.is_some()).count();
    (sum / (6.0 * bodies as f64)).sqrt() / (2.0 * radius)
}
