//! What means of a run are made of, at every step: the same as its outputs have, and seen without a change of the motion.

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
