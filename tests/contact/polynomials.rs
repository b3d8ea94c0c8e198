//! Kalker's polynomials in simulations: frozen for each step as a difference from the table.

use std::f64::consts::TAU;

use roulement::contact::creep::Law;
use roulement::kalker::linear::Scales;
use roulement::kalker::nonlinear::Kalker;
use roulement::kalker::scaled_law::{Difference, ScaledKalker};
use roulement::kalker::table::CreepTable;
use roulement::kalker::{Patch, ScaledCreepage};
use roulement::model::Conditions;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::Simulation;

use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");

/// The thrust case with polynomials of a degree, renewed after a change of creepages.
fn polynomials(degree: usize, epsilon_switch: f64) -> Scene {
    let changes = [
        ("effects.creep", "\"kalker\""),
        ("effects.kalker_degree", &degree.to_string()),
        ("effects.epsilon_switch", &epsilon_switch.to_string()),
    ];
    scene(THRUST, &changes)
}

fn run(scene: &Scene, duration: f64) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.advance(duration).unwrap();
    simulation
}

/// Contact forces over their limits with the frozen difference, and by the polynomials themselves.
fn forces(simulation: &Simulation, ball: usize, race: Race) -> [[f64; 3]; 2] {
    let (model, state) = (simulation.model(), simulation.state());
    let kalker = model.polynomials(race).unwrap();
    let frozen =
        model.contact(race, &Conditions::of_friction(0.08)).of_ball(ball, state.difference(ball, race));
    let direct = roulement::contact::ContactModel { law: Law::Kalker(kalker), ..frozen };
    [frozen, direct].map(|contact| {
        let contact = contact.evaluated(&state.balls[ball].motion(), &state.race(race).motion());
        let limit = 0.08 * contact.load;
        [contact.creep.longitudinal / limit, contact.creep.lateral / limit, contact.creep.spin_moment / limit]
    })
}

#[test]
fn invariant_frozen_polynomials_are_the_polynomials() {
    // Solved anew after every step, the difference makes the table the polynomials, but for minima beside the one that
    // a solution from scratch finds.
    let simulation = run(&polynomials(3, 0.0), 0.5e-3);
    for race in Race::BOTH {
        let [frozen, direct] = forces(&simulation, 0, race);
        let table = simulation.state().difference(0, race).unwrap().value;
        println!(
            "race {race:?}: frozen {frozen:.4?}, direct {direct:.4?}, difference from the table {table:.4?}"
        );
        for k in 0..3 {
            assert!((frozen[k] - direct[k]).abs() < 0.02, "race {race:?}: {frozen:?} {direct:?}");
        }
        assert!(table.iter().any(|value| value.abs() > 0.01), "the table alone: {table:?}");
    }
    let statistics = simulation.state().statistics;
    assert!(statistics.polynomials >= 20 * statistics.steps && statistics.polynomial_failures == 0);
}

#[test]
fn invariant_the_wrench_on_a_race_is_the_sum_of_the_reported_contact_forces() {
    let simulation = run(&polynomials(3, 0.01), 0.5e-3);
    let (model, state, outputs) = (simulation.model(), simulation.state(), simulation.outputs());
    for race in Race::BOTH {
        let contact = model.contact(race, &Conditions::of_friction(0.08));
        let motion = state.race(race).motion();
        let mut sum = -outputs[race].wrench.force;
        for (j, ball) in state.balls.iter().enumerate() {
            let forces = contact.of_ball(j, state.difference(j, race)).evaluated(&ball.motion(), &motion);
            let reported = &outputs.balls[j][race];
            let creep = forces.creep.longitudinal.hypot(forces.creep.lateral);
            let shown = reported.force_longitudinal.hypot(reported.force_lateral);
            assert!((creep - shown).abs() < 1e-9 && reported.load == forces.load, "{creep} {shown}");
            sum -= forces.force;
        }
        assert!(sum.norm() < 1e-6, "{race:?}: {} N are missing", sum.norm());
    }
}

#[test]
fn a_difference_belongs_to_its_polynomials_or_to_none() {
    let patch = Patch { axis_ratio: 0.2, poisson_ratio: 0.3, rolling_angle: 0.0 };
    let kalker = ScaledKalker::new(&patch, 3).unwrap();
    let number = Kalker::new(patch, 3).unwrap().coefficients();
    let of = |number: usize| Difference { coefficients: vec![0.1; number], ..Difference::default() };
    assert!(of(0).fits(None) && of(0).fits(Some(&kalker)) && of(number).fits(Some(&kalker)));
    assert!(!of(1).fits(None) && !of(number).fits(None) && !of(number - 1).fits(Some(&kalker)));
    let spoilt = Difference { value: [f64::NAN; 4], ..of(number) };
    assert!(!spoilt.fits(Some(&kalker)));
}

#[test]
fn invariant_rare_renewals_change_little_and_cost_less() {
    let [always, rarely] = [0.0, 0.01].map(|epsilon_switch| run(&polynomials(3, epsilon_switch), 0.5e-3));
    let [a, b] = [&always, &rarely].map(|simulation| simulation.outputs().friction_power);
    let [many, few] = [&always, &rarely].map(|simulation| simulation.state().statistics.polynomials);
    println!("friction power {a:.4} W with {many} solutions, {b:.4} W with {few}");
    assert!((b / a - 1.0).abs() < 0.02 && few < many / 2, "{a} W, {b} W, {many}, {few}");
}

#[test]
fn invariant_polynomials_and_table_run_alike() {
    let table = run(&scene(THRUST, &[("effects.creep", "\"kalker_table\"")]), 0.2e-3);
    let kalker = run(&polynomials(5, 0.01), 0.2e-3);
    let [a, b] = [&table, &kalker].map(|simulation| simulation.outputs().friction_power);
    println!("friction power {a:.4} W by the table, {b:.4} W by polynomials");
    assert!((b / a - 1.0).abs() < 0.05 && a != b, "{a} W, {b} W");
}

#[test]
fn invariant_replay_with_polynomials_gives_the_same_bits() {
    let mut simulation = run(&polynomials(2, 0.01), 0.3e-3);
    let saved = simulation.clone();
    simulation.advance(0.5e-3).unwrap();
    let mut again = saved;
    again.advance(0.5e-3).unwrap();
    assert!(simulation.state() == again.state());
    assert!(simulation.state().statistics.polynomials > 20);
}

#[test]
fn invariant_the_table_is_smooth_where_polynomials_jump() {
    // Why polynomials are frozen in a step: along a smooth path of creepages their forces jump, the table's do not.
    let patch = Patch { axis_ratio: 0.15, poisson_ratio: 0.3, rolling_angle: 0.0 };
    let scales = Scales::new(&patch).unwrap();
    let (table, kalker) = (CreepTable::new(&patch).unwrap(), Kalker::new(patch, 3).unwrap());
    let points = 2000;
    let path = (0..points).map(|i| {
        let s = TAU * f64::from(i) / f64::from(points);
        [0.8 * (3.0 * s).sin(), 0.5 * (2.0 * s + 1.0).cos() - 0.2, 1.5 + s.sin()]
    });
    let mut start: Option<Vec<f64>> = None;
    let forces: Vec<[[f64; 3]; 2]> = path
        .map(|q| {
            let spin = q[2] * scales.moment / scales.c33;
            let creepage =
                ScaledCreepage { x: q[0] / scales.c11, y: q[1] / scales.c22, spin, curvature: 0.0 };
            let solution = kalker.solve(&creepage, start.as_deref()).unwrap();
            let f = solution.forces;
            start = Some(solution.coefficients.as_slice().to_vec());
            [[f.fx, f.fy, f.mz / scales.moment], table.values(q)]
        })
        .collect();
    let [polynomials, table] = [0, 1].map(|law: usize| {
        let change = |pair: &[[[f64; 3]; 2]]| {
            (0..3).map(|m| (pair[1][law][m] - pair[0][law][m]).abs()).fold(0.0, f64::max)
        };
        let changes: Vec<f64> = forces.windows(2).map(change).collect();
        (changes.iter().filter(|change| **change > 0.01).count(), changes.into_iter().fold(0.0, f64::max))
    });
    println!("changes above 0.01 of mu Q, and the largest: polynomials {polynomials:?}, table {table:?}");
    assert!(polynomials.0 > 0 && table.0 == 0, "{polynomials:?} {table:?}");
}
