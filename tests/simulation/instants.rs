//! What means of a run are made of, at every step: the same as its outputs have, and seen without a change of the motion.

use roulement::interface::variables::Variables;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::instant::Instant;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::play::Scripted;

fn scene(name: &str, changes: &[(&str, &str)]) -> Scene {
    let path = format!("{}/scenes/{name}.toml", roulement_tests::ROOT);
    Scene::edited(&std::fs::read_to_string(path).unwrap(), changes.iter().copied()).unwrap()
}

/// Numbers of an instant that are sums over balls, in another order than outputs have.
fn sums(of: &Instant) -> Vec<f64> {
    let cage = of
        .cage
        .map_or(vec![], |c| vec![c.eccentricity, c.pocket_load, c.land_load, c.pocket_power, c.land_power]);
    let own = [of.cage_speed, of.rolling_speed, of.friction_power, of.friction_torque, of.between_balls];
    let losses =
        LOSSES.map(|part| (part.get)(&of.losses)).into_iter().chain([of.torque_power, of.stored_energy]);
    own.into_iter().chain(of.power_per_ball).chain(of.peak_pressure).chain(cage).chain(losses).collect()
}

#[test]
fn invariant_an_instant_has_what_outputs_have() {
    for (name, changes) in [
        ("thrust", &[][..]),
        ("radial", &[]),
        ("cage", &[("load.duration", "\"3 ms\"")]),
        ("effects/full_complement", &[]),
        ("effects/loss_of_lubrication", &[]),
        ("effects/oil_mist", &[]),
    ] {
        let mut simulation = Simulation::new(&scene(name, changes)).unwrap();
        for point in 0..4 {
            // Before anybody asks for outputs.
            let (own, of) = (simulation.instant(), Instant::from(simulation.outputs()));
            assert_eq!((own.time, &own.inner, &own.outer), (of.time, &of.inner, &of.outer), "{name}");
            assert_eq!((own.cage_slip, own.ball_slip), (of.cage_slip, of.ball_slip), "{name} {point}");
            for (k, (own, of)) in sums(&own).into_iter().zip(sums(&of)).enumerate() {
                assert!((own - of).abs() <= 1e-12 * of.abs(), "{name} {point} {k}: {own} {of}");
            }
            simulation.advance_scripted(simulation.time() + 2e-4).unwrap();
        }
    }
}

#[test]
fn invariant_a_value_that_is_asked_for_alone_has_the_bits_that_it_has_among_all() {
    for (name, changes) in [
        ("thrust", &[][..]),
        ("radial", &[("effects.creep", "\"kalker_table\""), ("effects.heathcote_slip", "true")]),
        ("radial", &[("effects.creep", "\"frictionless\"")]),
        ("cage", &[]),
        ("misalignment", &[]),
        ("effects/full_complement", &[]),
        ("effects/oil_mist", &[]),
        ("effects/heat", &[]),
    ] {
        let scene = scene(name, changes);
        let table = Variables::moving(&scene, true);
        let mut simulation = Simulation::new(&scene).unwrap();
        for point in 0..4 {
            // Nobody has asked for outputs.
            let (bare, all) = (simulation.clone(), simulation.clone());
            for row in table.rows() {
                let among_all = table.value(row, all.inputs(), all.outputs()).to_bits();
                let alone = bare.clone();
                assert_eq!(table.value_of(row, &alone).to_bits(), among_all, "{name} {point}: {}", row.name);
            }
            // One after another, those that are in the sums before the others.
            for row in table.rows() {
                let among_all = table.value(row, all.inputs(), all.outputs()).to_bits();
                assert_eq!(table.value_of(row, &bare).to_bits(), among_all, "{name} {point}: {}", row.name);
            }
            // A step that ends after a last correction without evaluation, and one that does not.
            simulation.advance_scripted(simulation.time() + [1e-5, 2e-4][point % 2]).unwrap();
        }
    }
}

#[test]
fn invariant_whoever_sees_the_steps_changes_nothing() {
    for name in ["thrust", "radial", "cage", "effects/loss_of_lubrication", "misalignment"] {
        let start = Simulation::new(&scene(name, &[])).unwrap();
        let (mut seen, mut alone) = (start.clone(), start);
        let mut times = vec![];
        for row in 1..=5 {
            let end = 1.7e-4 * f64::from(row);
            let mut course = seen.begin(end).unwrap();
            while seen.time() < end {
                seen.step(&mut course, f64::INFINITY).unwrap();
                times.push(seen.instant().time);
            }
            seen.end(course, true);
            alone.advance_scripted(end).unwrap();
            assert_eq!((seen.state(), seen.inputs()), (alone.state(), alone.inputs()), "{name}");
            assert_eq!(seen.outputs(), alone.outputs(), "{name}");
            assert_eq!(times.last(), Some(&end), "{name}");
        }
        assert_eq!(times.len() as u64, seen.state().statistics.steps, "{name}");
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{name}");
    }
}
