//! Input of closed forms of effects: the equilibrium of a bearing under its load.

use nalgebra::Vector3;

use super::estimate::EstimateError;
use crate::contact::shoulder::{largest_share, least_margin};
use crate::effects::estimate::{Estimate, Outline, RingEstimate, Spacing};
use crate::effects::film::USUAL_DENSITY;
use crate::equilibrium::{self, BallEquilibrium, Equilibrium, EquilibriumInput, Gyroscopic};
use crate::model::Model;
use crate::model::bodies::Race;
use crate::scene::{Drive, Scene, Schedule};

/// \[rad] lead of a ball in a revolution that is rounding.
const ALIKE: f64 = 1e-12;

/// Input in an equilibrium that depends on how gyroscopic moments are carried.
pub(super) fn under(
    scene: &Scene,
    model: &Model,
    problem: impl Fn(Gyroscopic) -> EquilibriumInput,
) -> Result<Estimate, EstimateError> {
    // Where friction at the outer race cannot hold the balls, that at both does what it can.
    let input = problem(Gyroscopic::OuterRaceControl);
    let solution = equilibrium::solve(model, &input)
        .or_else(|_| equilibrium::solve(model, &problem(Gyroscopic::Friction)))?;
    // What throws balls and rings outwards is how they turn in all, not how they do in a frame.
    let turn = input.frame.angular_velocity.x;
    let speeds = [input.inner_speed, input.outer_speed].map(|speed| speed + turn);
    let most = solution.balls.iter().max_by(|a, b| a.report.inner_load.total_cmp(&b.report.inner_load));
    let most = most.filter(|ball| ball.report.inner_load > 0.0).ok_or(EstimateError::Unloaded)?;
    let depth =
        |ball: &BallEquilibrium| ball.report.inner_approach.max(0.0) + ball.report.outer_approach.max(0.0);
    let bearing = &model.bearing;
    let [inner, outer] = Race::BOTH.map(|race| shoulders(model, &input, &solution, race));
    let margin = |of: &[Shouldered]| least_margin(of.iter().map(|one| (one.load, one.margin)));
    let share = |of: &[Shouldered]| largest_share(of.iter().map(|one| (one.load, one.share)));
    let largest = |load: fn(&BallEquilibrium) -> f64| solution.balls.iter().map(load).fold(0.0, f64::max);
    let outline = outline(scene);
    let [of_inner, of_outer] = scene.bearing.raceways();
    let bottoms = [
        of_inner.groove_circle_radius - of_inner.groove_radius,
        of_outer.groove_circle_radius + of_outer.groove_radius,
    ];
    let viscosity = scene.effects.rating.section.as_ref().and_then(|section| section.viscosity);
    Ok(Estimate {
        threshold: scene.effects.auto.threshold(),
        deepest: solution.balls.iter().map(depth).fold(0.0, f64::max),
        loads: [largest(|ball| ball.report.inner_load), largest(|ball| ball.report.outer_load)],
        centrifugal_force: match turn {
            0.0 => most.report.centrifugal_force,
            turn => bearing.ball.mass * most.position.yz().norm() * (solution.cage_speed + turn).powi(2),
        },
        gyroscopic_moment: most.report.gyroscopic_moment,
        ball_radius: bearing.ball.radius,
        balls: bearing.n_balls,
        pitch_radius: 0.5 * bearing.pitch_diameter,
        orbital_velocity: 0.5 * bearing.pitch_diameter * solution.cage_speed.abs(),
        friction: input.friction,
        saturates: scene.effects.creep.law.saturates(),
        caged: scene.effects.cage.is_body(),
        spacing: spacing(scene, model, &input, &solution),
        shoulder_margin: margin(&inner).min(margin(&outer)),
        shoulder_share: share(&inner).max(share(&outer)),
        viscosity: viscosity.map(|viscosity| viscosity.0 * USUAL_DENSITY),
        youngs_modulus: scene.race.youngs_modulus.0,
        rings: [0, 1].map(|index| RingEstimate { bottom: bottoms[index], speed: speeds[index] }),
        flanged: [&scene.inner, &scene.outer].map(|race| matches!(race.drive, Drive::Fixed | Drive::Pose)),
        outline,
        oiled: scene.effects.film.lubrication(0.0) > 0.0,
        oil_conductance: scene.effects.heat_balance.section.as_ref().map_or(0.0, |balance| 3.0 * balance.oil),
        power: 0.0,
    })
}

/// [rad/s] speed of the largest size in a script.
pub(super) fn fastest(schedule: &Schedule) -> f64 {
    schedule
        .values()
        .into_iter()
        .fold(0.0, |most: f64, speed| if speed.abs() > most.abs() { speed } else { most })
}

/// A contact beside a shoulder.
struct Shouldered {
    load: f64,
    share: f64,
    margin: f64,
}

/// All contacts that carry load on a race.
fn shoulders(model: &Model, input: &EquilibriumInput, solution: &Equilibrium, race: Race) -> Vec<Shouldered> {
    let contacts = model.contacts(&input.surroundings());
    let radius = model.bearing.ball.radius;
    // The contact lies inside or outside of the ball's orbit.
    let side = if race == Race::Inner { -1.0 } else { 1.0 };
    let of = |ball: &BallEquilibrium| {
        let report = &ball.report;
        let (load, approach, angle) = match race {
            Race::Inner => (report.inner_load, report.inner_approach, report.inner_contact_angle),
            Race::Outer => (report.outer_load, report.outer_approach, report.outer_contact_angle),
        };
        let along = -side * angle.cos() / (ball.position.yz().norm() + side * radius * angle.cos());
        let semi_axis = contacts[race].shape.hertz(along).semi_axis_transverse * approach.max(0.0).sqrt();
        let (share, margin) = model.bearing.shoulder(race, side * angle, semi_axis);
        (load > 0.0).then_some(Shouldered { load, share, margin })
    };
    solution.balls.iter().filter_map(of).collect()
}

/// How balls keep their distance.
fn spacing(scene: &Scene, model: &Model, input: &EquilibriumInput, solution: &Equilibrium) -> Spacing {
    let bearing = &model.bearing;
    let orbit = 0.5 * bearing.pitch_diameter;
    let count = bearing.n_balls as f64;
    let is_held = |ball: &BallEquilibrium| ball.report.inner_load > 0.0 && ball.report.outer_load > 0.0;
    // Unloaded balls fly as they left the load.
    let own = |ball: &BallEquilibrium| match is_held(ball) {
        true => {
            let angle = 0.5 * (ball.report.inner_contact_angle + ball.report.outer_contact_angle);
            bearing.epicyclic_speed(angle, input.inner_speed, input.outer_speed)
        }
        false => solution.cage_speed,
    };
    let speeds: Vec<f64> = solution.balls.iter().map(own).collect();
    let mean = speeds.iter().sum::<f64>() / count;
    let (mut place, mut range) = (0.0f64, [0.0f64; 2]);
    for speed in &speeds {
        place += (speed - mean) / if mean == 0.0 { 1.0 } else { mean } * std::f64::consts::TAU / count;
        range = [range[0].min(place), range[1].max(place)];
    }
    let [least, most] = [f64::min, f64::max].map(|of| speeds.iter().copied().reduce(of).unwrap_or(0.0));
    let gap = bearing.pitch_diameter * (std::f64::consts::PI / count).sin() - 2.0 * bearing.ball.radius;
    // Two equal spheres of steel, Hertz: F = K d^1.5 and m v^2/4 = 2/5 K d^2.5.
    let stiffness = 4.0 / 3.0 / bearing.materials.compliance * (0.5 * bearing.ball.radius).sqrt();
    let blow = (0.625 * bearing.ball.mass).powf(0.6) * stiffness.powf(0.4);
    let gravity = Vector3::from(scene.effects.gravity.at(0.0)).yz().norm();
    let flies = orbit * solution.cage_speed * solution.cage_speed > gravity;
    let unheld = !solution.balls.iter().all(is_held);
    let falls = gravity > 0.0 && !flies && unheld;
    let starts = [&scene.load.inner_speed, &scene.load.outer_speed].map(|speed| speed.at(0.0));
    let limit = |(ball, speed): (&BallEquilibrium, &f64)| ball.report.inner_load * (speed - mean).abs();
    // Balls that roll alike differ by rounding.
    let span = range[1] - range[0];
    Spacing {
        lead: if span < ALIKE { 0.0 } else { span * orbit },
        gap,
        slipping: input.friction * orbit * solution.balls.iter().zip(&speeds).map(limit).sum::<f64>(),
        unheld,
        loose: gravity > 0.0 || unheld,
        difference: orbit * (most - least),
        blow,
        falling: if falls { (2.0 * gravity * orbit).sqrt() } else { 0.0 },
        from_rest: starts == [0.0; 2] && solution.cage_speed != 0.0,
    }
}

/// Outer dimensions: seats where they are given, usual ones elsewhere.
fn outline(scene: &Scene) -> Outline {
    let bearing = &scene.bearing;
    let usual = Outline::usual(bearing.pitch_diameter.0, bearing.ball_diameter.0);
    let seat = |partner: fn(&crate::effects::growth::Section) -> Option<f64>, usual: f64| {
        scene.effects.growth.section.as_ref().and_then(partner).unwrap_or(usual)
    };
    Outline {
        bore: seat(|section| section.shaft.as_ref().map(|shaft| shaft.diameter.0), usual.bore),
        outside: seat(|section| section.housing.as_ref().map(|housing| housing.diameter.0), usual.outside),
        ..usual
    }
}
