//! Least heat: each ball keeps from spinning on the race where spin would cost more, and spins on the other.

use super::{Equilibrium, EquilibriumError, EquilibriumInput, solve};
use crate::contact::shape::ContactShape;
use crate::model::bodies::{PerRace, Race};
use crate::model::{Conditions, Model};
use crate::numerics::elliptic::complete_elliptic_integrals;

/// Solves with the races given on which balls do not spin, and gives those races anew by the heat there, until they stay.
///
/// At each ball both ways are compared at the place that it has: complete sliding has the spin moment 3/8 mu Q a E (Jones 1959), a the
/// longer semi-axis; friction is the same on both races and drops out. A ball that would go back to its first race has nearly the same
/// heat either way and stays, so that the search ends.
pub fn solve_by_least_heat(model: &Model, input: &EquilibriumInput) -> Result<Equilibrium, EquilibriumError> {
    let balls = model.bearing.n_balls;
    let mut trial = EquilibriumInput { controls: vec![Race::Outer; balls], ..input.clone() };
    let mut changed = vec![false; balls];
    loop {
        let solution = solve(model, &trial)?;
        let mut stays = true;
        for (index, ball) in solution.balls.iter().enumerate() {
            let race = cheaper(model, input, &solution, index);
            if race != trial.controls[index] && !changed[index] && ball.report.inner_load > 0.0 {
                (trial.controls[index], changed[index], stays) = (race, true, false);
            }
        }
        if stays {
            return Ok(solution);
        }
    }
}

/// The race on which a ball does not spin where that costs less.
fn cheaper(model: &Model, input: &EquilibriumInput, solution: &Equilibrium, index: usize) -> Race {
    let ball = &solution.balls[index];
    let report = &ball.report;
    let (sin_inner, cos_inner) = report.inner_contact_angle.sin_cos();
    let (sin_outer, cos_outer) = report.outer_contact_angle.sin_cos();
    let (radius, orbit) = (model.bearing.ball.radius, ball.position.yz().norm());
    let per_roll = orbit / radius;
    let rolls = PerRace {
        inner: (solution.cage_speed - input.inner_speed) * per_roll,
        outer: (solution.cage_speed - input.outer_speed) * per_roll,
    };
    let between = input.inner_speed - input.outer_speed;
    let apart = sin_inner * cos_outer - cos_inner * sin_outer;
    // Spin on the other race, with the ball rolling about the tangent of the one that it does not spin on.
    let on_inner = -between * sin_inner - rolls.outer * apart;
    let on_outer = between * sin_outer - rolls.inner * apart;
    let contacts = model.contacts(&Conditions::default());
    let heat = |shape: &ContactShape, load: f64, approach: f64, curvature: f64, spin: f64| {
        let hertz = shape.hertz(curvature);
        let (one, other) = (hertz.semi_axis_rolling, hertz.semi_axis_transverse);
        let (long, short) = (one.max(other), one.min(other));
        let (_, second) = complete_elliptic_integrals(1.0 - (short / long).powi(2));
        (load * long * approach.max(0.0).sqrt() * second * spin).abs()
    };
    let by_outer = heat(
        contacts.inner.shape,
        report.inner_load,
        report.inner_approach,
        cos_inner / (orbit - radius * cos_inner),
        on_inner,
    );
    let by_inner = heat(
        contacts.outer.shape,
        report.outer_load,
        report.outer_approach,
        -cos_outer / (orbit + radius * cos_outer),
        on_outer,
    );
    if by_inner < by_outer { Race::Inner } else { Race::Outer }
}
