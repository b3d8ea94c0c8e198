//! Bearings that change their level between two steps of a run, `level_changes = true`.

use nalgebra::Vector3;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::common::{ROTOR, forces, imbalance, stored, system};

/// [`ROTOR`], whose left bearing begins at a level that may change.
fn changing(level: &str) -> String {
    let own = "name = \"left\"\n";
    ROTOR.replace(own, &format!("{own}level = \"{level}\"\nlevel_changes = true\n"))
}

/// Brings the left bearing to a level.
fn set(system: &mut System, dynamic: f64) {
    let mut scene = system.scene().clone();
    scene.bearings[0].dynamic = Some(dynamic);
    system.tune(&scene).unwrap_or_else(|why| panic!("{why}"));
}

/// Azimuth of every ball of the left bearing \[rad].
fn azimuths(system: &System) -> Vec<f64> {
    let (_, left) = system.bearings().next().unwrap();
    left.outputs().balls.iter().map(|ball| ball.azimuth).collect()
}

#[test]
fn limit_a_change_before_the_first_step_is_a_start_at_that_level() {
    for (from, to, dynamic) in [("dynamic", "equilibrium", 0.0), ("equilibrium", "dynamic", 1.0)] {
        let (mut changed, mut started) = (system(&changing(from)), system(&changing(to)));
        set(&mut changed, dynamic);
        for end in [1e-3, 3e-3] {
            changed.advance(end).unwrap();
            started.advance(end).unwrap();
            for (own, other) in forces(&changed).iter().zip(forces(&started)) {
                assert!((own - other).norm() < 1e-5 * other.norm(), "{from} {end}: {own} {other}");
            }
        }
        let steps = [&changed, &started].map(|one| one.statistics().steps);
        assert!(steps[0].abs_diff(steps[1]) <= 2, "{steps:?}");
    }
}

#[test]
fn independent_means_between_two_changes_are_those_of_dynamics_and_energy_is_kept() {
    let mean = |system: &mut System, to: f64| {
        let from = system.time();
        let looks = 200;
        let mut sum = vec![Vector3::zeros(); 2];
        for look in 1..=looks {
            system.advance(from + (to - from) * f64::from(look) / f64::from(looks)).unwrap();
            sum.iter_mut().zip(forces(system)).for_each(|(sum, force)| *sum += force);
        }
        sum.into_iter().map(|sum| sum / f64::from(looks)).collect::<Vec<_>>()
    };
    let mut whole = system(ROTOR);
    whole.advance(10e-3).unwrap();
    let of_dynamics = mean(&mut whole, 20e-3);
    let largest = of_dynamics.iter().map(Vector3::norm).fold(0.0, f64::max);
    let mut system = system(&changing("equilibrium"));
    let before = stored(&system);
    for (end, level) in [(5e-3, 1.0), (7.5e-3, 0.0), (10e-3, 1.0)] {
        system.advance(end).unwrap();
        let places = azimuths(&system);
        let kept = stored(&system);
        let last = forces(&system)[0];
        set(&mut system, level);
        let jump = system.level_jumps()[0];
        let shown = (forces(&system)[0] - last).norm();
        // What is left is damping and the friction of balls with states, in the first moment more than soon afterwards, as at any start.
        assert!((jump.force - shown).abs() < 1e-9 * largest, "{} {shown}", jump.force);
        assert!(jump.force > 0.0 && jump.force < 0.05 * largest, "{} of {largest}", jump.force);
        // Balls go on from where they are, but for what parts them from even spacing.
        for (own, before) in azimuths(&system).iter().zip(&places) {
            let apart = (own - before + 1.0).rem_euclid(std::f64::consts::TAU) - 1.0;
            assert!(apart.abs() < 1e-3, "{end}: {apart}");
        }
        let stored = stored(&system);
        assert!((stored[0] - kept[0]).abs() < 0.02 * kept[0], "{stored:?} {kept:?}");
    }
    assert_eq!(system.level_jumps()[0].changes, 3);
    assert_eq!(system.level_jumps()[1].changes, 0);
    for (own, other) in mean(&mut system, 20e-3).iter().zip(&of_dynamics) {
        assert!((own - other).norm() < 0.01 * largest, "{own} {other}");
    }
    let [of_shaft, of_bearings] = imbalance(&system, &before);
    assert!(of_shaft < 1e-3 && of_bearings < 5e-3, "{of_shaft:.2e} {of_bearings:.2e}");
}

#[test]
fn invariant_a_replay_over_changes_and_what_goes_on_from_a_snapshot_are_the_same_bits() {
    let text = changing("equilibrium");
    let led = |end: f64| {
        let mut system = system(&text);
        for (at, dynamic) in [(1e-3, 1.0), (2e-3, 0.0), (2.5e-3, 1.0)] {
            if at < end {
                system.advance(at).unwrap();
                set(&mut system, dynamic);
            }
        }
        system.advance(end).unwrap();
        system
    };
    let (mut one, other) = (led(3e-3), led(3e-3));
    assert_eq!(one.snapshot(), other.snapshot());
    let saved = one.snapshot();
    // A system that has begun at the same levels, as an instance does whose parameters are those of the snapshot.
    let mut fresh = system(&changing("dynamic"));
    assert!(fresh.restore(&saved));
    assert!(!system(&text).restore(&saved), "it has other levels");
    // Without states what its balls damp is a part of the state.
    let (mut there, mut back) = (led(2.2e-3), system(&text));
    assert!(back.restore(&there.snapshot()));
    for (system, goes_on) in [(&mut one, &mut fresh), (&mut there, &mut back)] {
        let end = system.time() + 1e-3;
        system.advance(end).unwrap();
        goes_on.advance(end).unwrap();
        assert_eq!(system.snapshot(), goes_on.snapshot());
        assert_eq!(system.outputs(), goes_on.outputs());
    }
}

#[test]
fn a_change_without_an_equilibrium_changes_nothing() {
    let mut system = system(&changing("equilibrium"));
    system.advance(1e-3).unwrap();
    let before = system.snapshot();
    let mut inputs: Vec<_> = system.bearings().map(|(_, bearing)| *bearing.inputs()).collect();
    // No ball is in balance with a friction that is no number.
    let friction = std::mem::replace(&mut inputs[0].friction, f64::NAN);
    assert!(system.set_inputs(system.inputs().clone(), inputs.clone()));
    let mut scene = system.scene().clone();
    scene.bearings[0].dynamic = Some(1.0);
    let why = system.tune(&scene).unwrap_err().to_string();
    assert!(why.contains("bearing \"left\""), "{why}");
    assert_eq!((system.level_jumps()[0].changes, system.scene().bearings[0].dynamic), (0, Some(0.0)));
    inputs[0].friction = friction;
    assert!(system.set_inputs(system.inputs().clone(), inputs));
    assert_eq!(system.snapshot(), before);
    // It changes when it can.
    set(&mut system, 1.0);
    system.advance(1.2e-3).unwrap();
    assert_eq!(system.level_jumps()[0].changes, 1);
}

#[test]
fn refused_where_a_level_cannot_change() {
    let refusal = |text: &str| SystemScene::edited(text).map(drop).unwrap_err().to_string();
    let own = "creep = \"saturated\", heathcote_slip = false";
    let with = |more: &str| changing("dynamic").replacen(own, &format!("{own}, {more}"), 1);
    for (text, wanted) in [
        (changing("auto"), ["bearing \"left\"", "level_changes", "\"auto\" finds the level before the run"]),
        (with("cage = \"ideal\""), ["bearing \"left\"", "effects.cage", "an ideal cage"]),
        (with("mean_outputs = true"), ["bearing \"left\"", "effects.mean_outputs", "level_changes"]),
        (
            format!("{}\n[solver]\nlevel = \"equilibrium\"\n", changing("dynamic")),
            ["bearing \"left\"", "solver.level", "level_changes"],
        ),
        (
            format!("{}\n[solver]\nmethod = \"esdirk3\"\n", changing("dynamic")),
            ["bearing \"left\"", "solver.method", "level_changes"],
        ),
    ] {
        let said = refusal(&text);
        assert!(wanted.iter().all(|part| said.contains(part)), "{said}");
    }
}
