//! Tables of the documents whose numbers are counts and states of runs: computed here, and compared with what is written.
//!
//! `scripts/tables` writes them: the same tests with `ROULEMENT_RENEW=1`. Counts are compared within 2 %, as another
//! system's sine may end in another last bit; residuals of balances are sizes and are compared within a factor of 3.

use std::ops::ControlFlow;

use roulement::Simulation;
use roulement::analysis::single_contact::{Law, RollingContact, ScaledContact};
use roulement::kalker::nonlinear::Kalker;
use roulement::simulation::play::{Rows, play};

use crate::scenes::scene;
use crate::tables::{Noise, Row, compare, count, row};

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const RADIAL: &str = include_str!("../../scenes/radial.toml");
const CAGE: &str = include_str!("../../scenes/cage.toml");

/// A run by the scene's script.
fn run(text: &str, changes: &[(&str, &str)], duration: f64) -> Simulation {
    let mut simulation = Simulation::new(&scene(text, changes)).unwrap();
    let rows = Rows::new(1e-3, duration);
    let _: ControlFlow<()> = play(&mut simulation, rows, |_| ControlFlow::Continue(())).unwrap();
    simulation
}

fn corrections(simulation: &Simulation) -> f64 {
    let statistics = simulation.state().statistics;
    statistics.newton.iterations as f64 / statistics.steps as f64
}

/// Residual of the energy balance over the work.
fn balance(simulation: &Simulation, at_start: f64) -> (String, Noise) {
    let outputs = simulation.outputs();
    let residual = outputs.work - outputs.dissipated - (outputs.stored_energy - at_start);
    (format!("{:.0e}", (residual / outputs.work).abs()), Noise::Size)
}

#[test]
fn regression_measured_counts_of_the_model() {
    let stored = |text: &str| Simulation::new(&scene(text, &[])).unwrap().outputs().stored_energy;
    let [thrust, radial, cage] = [THRUST, RADIAL, CAGE].map(|text| run(text, &[], 0.05));
    // The ball at 25 to 50 ms: the mean of ten rows.
    let mut powers = [0.0; 2];
    let mut simulation = Simulation::new(&scene(THRUST, &[])).unwrap();
    for step in 1..=20 {
        simulation.advance_scripted(f64::from(step) * 2.5e-3).unwrap();
        if step > 10 {
            let ball = &simulation.outputs().balls[0];
            powers[0] += 0.1 * ball.inner.power;
            powers[1] += 0.1 * ball.outer.power;
        }
    }
    let rows = [
        row(
            "`scenes/thrust.toml`, `radial.toml`, `cage.toml` over 50 ms: Newton corrections per step",
            [&thrust, &radial, &cage].map(|run| count(corrections(run), 2)).into(),
            "",
        ),
        row(
            "thrust and cage: residual of the energy balance over the work",
            vec![balance(&thrust, stored(THRUST)), balance(&cage, stored(CAGE))],
            "",
        ),
        row(
            "thrust, 25 to 50 ms: friction power of a ball on inner and outer race",
            powers.map(|power| count(power, 2)).into(),
            " W",
        ),
    ];
    compare("docs/model.md", "measured", "quantity | value", &rows);
}

#[test]
fn regression_corrections_by_number_of_balls() {
    // As scripts/measure ball-cost: pitch circle and loads grow with the balls, the surface speed is the same.
    let of = |cage: bool| {
        let of_balls = |balls: u32| {
            let changes = [
                ("bearing.balls", balls.to_string()),
                ("bearing.pitch_diameter", format!("\"{} mm\"", 5 * balls)),
                ("cage.land_diameter", format!("\"{} mm\"", 5 * balls + 6)),
                ("load.x.force", format!("\"{} N\"", 150 * balls)),
                ("load.z.force", format!("\"-{} N\"", 30 * balls)),
                ("load.inner_speed", format!("\"{} rpm\"", 60_000 / balls)),
            ];
            let mut changes: Vec<(&str, &str)> =
                changes.iter().map(|(key, value)| (*key, value.as_str())).collect();
            if !cage {
                changes.retain(|(key, _)| !key.starts_with("cage"));
                for key in ["effects.cage", "cage", "friction.ball_cage", "friction.cage_race"] {
                    changes.push((key, ""));
                }
            }
            count(corrections(&run(CAGE, &changes, 2e-3)), 2)
        };
        [8, 16, 32, 64].map(of_balls).into()
    };
    let rows = [row("without a cage", of(false), ""), row("with a cage", of(true), "")];
    let header = "Newton corrections per step | 8 / 16 / 32 / 64 balls";
    compare("docs/model.md", "balls", header, &rows);
}

/// Mean iterations of the polynomials over the contacts of `random.csv`, from nothing and from creepages 1 % smaller.
fn iterations(degree: usize) -> [f64; 2] {
    let file = format!("{}/tests/data/contact/random.csv", roulement_tests::ROOT);
    let (mut sums, mut cases) = ([0.0; 2], 0.0);
    for contact in csv::Reader::from_path(file).unwrap().deserialize() {
        let contact: RollingContact = contact.unwrap();
        let ScaledContact { patch, creepage } = contact.scaled().unwrap();
        let kalker = Kalker::new(patch, degree).unwrap();
        let nearby = kalker.solve(&creepage.times(0.99), None).unwrap();
        let starts = [None, Some(nearby.coefficients.as_slice())];
        for (sum, start) in sums.iter_mut().zip(starts) {
            *sum += f64::from(kalker.solve(&creepage, start).unwrap().iterations);
        }
        cases += 1.0;
    }
    sums.map(|sum| sum / cases)
}

/// Errors of `roulement contact --law kalker_table --exact` over a kind of contacts of `random.csv`.
fn exact_errors(kind: &str) -> Row {
    #[derive(serde::Deserialize)]
    struct Expected {
        kind: String,
        fx: f64,
        fy: f64,
        mz: f64,
    }
    let file = format!("{}/tests/data/contact/random.csv", roulement_tests::ROOT);
    let mut table = csv::Reader::from_path(file).unwrap();
    let headers = table.headers().unwrap().clone();
    let (mut mean, mut worst, mut cases) = ([0.0; 3], [0.0f64; 3], 0.0);
    for record in table.records() {
        let record = record.unwrap();
        let expected: Expected = record.deserialize(Some(&headers)).unwrap();
        if expected.kind != kind {
            continue;
        }
        let contact: RollingContact = record.deserialize(Some(&headers)).unwrap();
        let ours = contact.evaluate(Law::Exact).unwrap();
        let errors = [ours.fx - expected.fx, ours.fy - expected.fy, ours.mz - expected.mz].map(f64::abs);
        for k in 0..3 {
            mean[k] += errors[k];
            worst[k] = worst[k].max(errors[k]);
        }
        cases += 1.0;
    }
    let mut numbers: Vec<_> = mean.iter().map(|sum| count(sum / cases, 4)).collect();
    numbers.push(count(worst[0].max(worst[1]), 4));
    numbers.push(count(worst[2], 4));
    row(format!("{kind}, {cases} contacts"), numbers, "")
}

#[test]
fn independent_data_errors_of_exact_contacts() {
    let rows = ["general", "bearing", "oblique"].map(exact_errors);
    let header = "contacts | mean error of fx / fy / mz, largest of a force / of the moment";
    compare("docs/rolling-contact.md", "exact", header, &rows);
}

#[test]
fn regression_iterations_of_the_polynomials() {
    let row_of = |degree: usize| {
        let numbers = iterations(degree).map(|mean| count(mean, 1));
        row(degree.to_string(), numbers.into(), "")
    };
    let rows: Vec<Row> = (1..=5).map(row_of).collect();
    compare("docs/rolling-contact.md", "iterations", "M | iterations, cold / warm", &rows);
}

#[test]
fn regression_solutions_of_the_polynomials_in_a_run() {
    let solutions = |degree: &'static str| {
        let changes = [("effects.creep", "\"kalker\""), ("effects.kalker_degree", degree)];
        let statistics = run(THRUST, &changes, 0.01).state().statistics;
        // Two contacts of ten balls in every step.
        row(
            degree,
            vec![count(100.0 * statistics.polynomials as f64 / (20.0 * statistics.steps as f64), 1)],
            " %",
        )
    };
    let header = "M | solutions over those of one in every step";
    compare("docs/rolling-contact.md", "solutions", header, &["3", "5"].map(solutions));
}

#[test]
fn regression_effects_and_what_is_told_of_them() {
    let scene = scene(THRUST, &[]);
    let effects = scene.effects.each();
    let row_of = |effect: &&dyn roulement::effects::AnyEffect| {
        let info = effect.info();
        let example: Vec<String> = info.example.trim().lines().map(|line| format!("`{line}`")).collect();
        let words = [
            &format!("`{}`", info.key),
            info.adds,
            info.states,
            info.source,
            info.price,
            &example.join("<br>"),
        ];
        let estimate = if effect.estimate().is_empty() { "none" } else { effect.estimate() };
        row(format!("{} | {estimate}", words.join(" | ")), vec![], "")
    };
    let rows: Vec<Row> = effects.iter().map(row_of).collect();
    let header = "key | adds | states | source | price when on | example | estimate";
    compare("docs/effects.md", "effects", header, &rows);
}
