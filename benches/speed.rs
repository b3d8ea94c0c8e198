//! What things cost. `cargo bench` prints wall times; for counts that do not depend on the machine's load run the
//! same work under `valgrind --tool=callgrind`.
#![allow(missing_docs, clippy::unwrap_used)]

use divan::{Bencher, counter::ItemsCount};
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::model::{INNER, Model};
use roulement::scene::Scene;
use roulement::simulation::Simulation;

const THRUST: &str = include_str!("../scenes/thrust.toml");

fn main() {
    divan::main();
}

fn prescribed() -> String {
    THRUST.replace("drive = \"wrench\"", "drive = \"pose\"")
}

/// One contact, value only.
#[divan::bench(args = ["frictionless", "linear", "regularised", "saturated", "kalker_table"])]
fn contact_value(bencher: Bencher, law: &str) {
    let scene = Scene::parse(&THRUST.replace("\"saturated\"", &format!("\"{law}\""))).unwrap();
    let simulation = Simulation::new(&scene).unwrap();
    let contact = simulation.model().contact(INNER, 0.08);
    let (ball, race) = (simulation.state().balls[0].motion(), simulation.state().races[INNER].motion());
    bencher.bench_local(|| contact.evaluate(divan::black_box(&ball), divan::black_box(&race)));
}

/// The quasi-static equilibrium of the thrust case.
#[divan::bench]
fn equilibrium_solve(bencher: Bencher) {
    let scene = Scene::parse(THRUST).unwrap();
    let model = Model::new(&scene).unwrap();
    let input = EquilibriumInput::from_scene(&scene, Gyroscopic::OuterRaceControl);
    bencher.bench_local(|| equilibrium::solve(&model, &input).unwrap().iterations);
}

/// 10 ms of the thrust case at a step cap of 1e-5 s: 1000 steps an iteration, so 1 ms here is 0.1 s per simulated s.
#[divan::bench(args = ["wrench", "pose"], sample_count = 20)]
fn ten_milliseconds(bencher: Bencher, drive: &str) {
    let text = if drive == "wrench" { THRUST.to_string() } else { prescribed() };
    let mut start = Simulation::new(&Scene::parse(&text).unwrap()).unwrap();
    start.advance(5e-3).unwrap();
    bencher.counter(ItemsCount::new(1000u32)).with_inputs(|| start.clone()).bench_local_values(
        |mut simulation| {
            simulation.advance(15e-3).unwrap();
            simulation.state().statistics.steps
        },
    );
}
