//! Machines whose bearings are all links: by rollers or by their stiffness.

use std::ops::ControlFlow;
use std::path::Path;

use roulement::scene::machine::MachineScene;
use roulement::scene::system::SystemScene;
use roulement::simulation::play::{Rows, play};
use roulement::simulation::system::{MachineEquilibrium, Played, System};

use crate::common::{run, scene, system};

/// A shaft on two tapered bearings face to face.
const TAPERED: &str = r#"
[[shaft]]
name = "shaft"
speed = "1500 rpm"

[[shaft.section]]
from = "-100 mm"
to = "100 mm"
outer_diameter = "30 mm"

[[shaft.load]]
name = "teeth"
position = "4 mm"
force = [[[0, 500], ["1 ms", 800]], "3 kN", "-2.4 kN"]

[[bearing]]
name = "left"
shaft = "shaft"
catalogue = "30206"
mounting = { position = "-80 mm" }

[[bearing]]
name = "right"
shaft = "shaft"
catalogue = "30206"
mounting = { position = "80 mm", direction = "-x" }

[load]
duration = "2 ms"
output_interval = "100 us"
"#;

/// Another shaft, on balls, that has nothing to do with the first.
const ON_BALLS: &str = r#"
[[shaft]]
name = "other"
speed = "600 rpm"
origin = [0, "1 m", 0]
mass = "1 kg"
polar_inertia = "5e-4 kg m^2"
transverse_inertia = "1e-3 kg m^2"

[[bearing]]
name = "front"
shaft = "other"
catalogue = "6205"
mounting = { position = "-30 mm", preload = { force = "200 N" } }

[[bearing]]
name = "rear"
shaft = "other"
catalogue = "6205"
mounting = { position = "30 mm", direction = "-x", preload = { force = "200 N" } }
"#;

/// A rigid shaft of 2 kg on two springs of 20 N/um each, which a load steps on.
const ON_SPRINGS: &str = r#"
[shaft]
speed = 0
mass = "2 kg"
polar_inertia = "1e-3 kg m^2"
transverse_inertia = "3e-3 kg m^2"

[[shaft.load]]
name = "pull"
position = 0
force = [0, [[0, 0], ["1 ns", 1000], [1, 1000]], 0]

[[bearing]]
name = "left"
mounting = { position = "-50 mm" }
stiffness = { radial = 2e7, axial = 1e7, tilt = 1e4 }

[[bearing]]
name = "right"
mounting = { position = "50 mm" }
stiffness = { radial = 2e7, axial = 1e7, tilt = 1e4 }

[load]
duration = "5 ms"
output_interval = "100 us"
"#;

/// Relative displacement over time of the shaft on springs, less than what is exact: `F/k (1 - cos w t)`.
fn error_of_swing(solver: &str) -> f64 {
    let mut system = system(&format!("{ON_SPRINGS}\n[solver]\n{solver}\n"));
    let (stiffness, mass) = (4e7f64, 2.0);
    let mut worst = 0.0f64;
    for row in 1..=50 {
        let time = 1e-4 * f64::from(row);
        system.advance(time).unwrap();
        let exact = 1000.0 / stiffness * (1.0 - ((stiffness / mass).sqrt() * time).cos());
        let found = system.outputs().loads[0].displacement.y;
        worst = worst.max((found - exact).abs() / (1000.0 / stiffness));
    }
    worst
}

#[test]
fn closed_form_and_order_of_convergence_a_shaft_swings_on_its_springs() {
    // Steps as they follow from nothing but the machine keep the promise of 2 % in histories over 3.6 periods.
    let usual = error_of_swing("");
    assert!(usual < 0.02, "{usual}");
    let fixed = |step: f64| {
        error_of_swing(&format!(
            "max_step = {step:e}\ninitial_step = {step:e}\ntolerance = 1e-2\nalpha_f = 1e-3"
        ))
    };
    let errors = [2e-5, 1e-5, 5e-6].map(fixed);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.8..2.2).contains(&order), "{errors:?}");
    }
}

#[test]
fn consistency_a_machine_of_rollers_does_what_it_does_beside_one_of_balls() {
    let both = TAPERED.replace("[load]", &format!("{ON_BALLS}\n[load]"));
    let of = |text: &str| MachineEquilibrium::of(&scene(text), 0.0, 1.0).unwrap();
    let (alone, beside) = (of(TAPERED), of(&both));
    for (one, other) in alone.outputs.links.iter().zip(&beside.outputs.links) {
        let (one, other) = (one.state.force, other.state.force);
        assert!((one - other).norm() < 1e-8 * one.norm(), "{one} {other}");
    }
    // In time by steps of their own: those beside balls are shorter.
    let [alone, beside] = [run(TAPERED, 2e-3), run(&both, 2e-3)];
    assert!(alone.statistics().steps < beside.statistics().steps / 2, "{:?}", alone.statistics());
    for (one, other) in alone.outputs().links.iter().zip(&beside.outputs().links) {
        let (one, other) = (one.state.force, other.state.force);
        assert!((one - other).norm() < 0.02 * other.norm(), "{one} {other}");
    }
}

#[test]
fn invariant_it_goes_on_to_the_same_bits_from_a_point_that_it_was_at() {
    let mut one = run(TAPERED, 0.7e-3);
    let point = one.snapshot();
    assert_eq!(point.time(), 0.7e-3);
    let run_on = |system: &mut System| {
        for row in 8..=15 {
            system.advance(1e-4 * f64::from(row)).unwrap();
        }
        (system.time(), system.outputs().clone(), *system.statistics())
    };
    let first = run_on(&mut one);
    assert!(one.restore(&point));
    assert_eq!(one.time(), 0.7e-3);
    assert_eq!(run_on(&mut one), first);
    // In another instance; a point of steps under other limits is refused.
    let mut other = system(TAPERED);
    assert!(other.restore(&point));
    assert_eq!(run_on(&mut other), first);
    let mut another = system(&format!("{TAPERED}\n[solver]\nmax_step = \"7 us\"\n"));
    let before = another.outputs().clone();
    assert!(!another.restore(&point));
    assert_eq!(another.outputs(), &before);
}

#[test]
fn invariant_rows_between_steps_leave_the_steps_as_they_are() {
    let played = |interval: f64| {
        let mut system = system(TAPERED);
        let mut forces = vec![];
        let row = |system: &System| {
            forces.push((system.time(), system.outputs().links[0].state.force));
            ControlFlow::<()>::Continue(())
        };
        assert!(
            play(&mut system, Rows { duration: 2e-3, interval, end_steps: false }, row)
                .unwrap()
                .is_continue()
        );
        (forces, system.outputs().links[0].state.clone(), *system.statistics())
    };
    let [(rows, end, steps), (fine_rows, fine_end, fine_steps)] = [1e-3, 1e-5].map(played);
    assert_eq!((end, steps), (fine_end, fine_steps));
    assert_eq!([rows.len(), fine_rows.len()], [3, 201]);
    assert_eq!([rows[1], rows[2]], [fine_rows[100], fine_rows[200]]);
    assert!(fine_rows.windows(2).all(|pair| pair[1].0 > pair[0].0 && pair[1].1 != pair[0].1));
}

#[test]
fn closed_form_what_slightly_other_loads_would_do_is_a_compliance() {
    // Twice the load from the start of a motion: twice the way.
    let mut system = system(ON_SPRINGS);
    let inputs = |force: f64| {
        let mut shaft = system.inputs().clone();
        shaft.loads[0].force.y = force;
        (shaft, vec![])
    };
    let others = [inputs(1000.0), inputs(2000.0)];
    let played = Played::none(system.scene());
    let ends = system.advance_perturbed(1e-4, &others, &played).unwrap();
    let [one, two] = [&ends[0], &ends[1]].map(|end| end.outputs().loads[0].displacement.y);
    // A load that grows from nothing over the time t: F t^2/(6 m), within 5 % by the few steps that it takes.
    let exact = 1000.0 * 1e-8 / (6.0 * 2.0);
    assert!((one / exact - 1.0).abs() < 0.05 && (two / one - 2.0).abs() < 1e-6, "{one} {two}");
    assert_eq!([ends[0].time(), system.time()], [1e-4; 2]);
}

#[test]
fn its_points_are_equilibria_where_the_level_says_so() {
    let text = format!("{TAPERED}\n[solver]\nlevel = \"equilibrium\"\n");
    let system = run(&text, 1e-3);
    let still = MachineEquilibrium::of(&scene(TAPERED), 1e-3, 1.0).unwrap();
    assert_eq!(system.time(), 1e-3);
    for (link, of) in system.outputs().links.iter().zip(&still.outputs.links) {
        let (one, other) = (link.state.force, of.state.force);
        assert!((one - other).norm() < 1e-6 * other.norm(), "{one} {other}");
    }
}

#[test]
fn settings_of_its_steps_are_looked_at_offered_and_changed() {
    let refused = |solver: &str| {
        let text = format!("{TAPERED}\n[solver]\n{solver}\n");
        SystemScene::parse(&text, None, Path::new("")).unwrap_err().to_string()
    };
    for (solver, parts) in [
        ("max_step = \"1 s\"", ["solver.max_step = 1", "0.01"]),
        ("min_step = \"1 ms\"\nmax_step = \"1 us\"", ["solver.min_step", "0.000001"]),
        ("tolerance = 1", ["solver.tolerance = 1", "0.01"]),
        ("alpha_f = 0.5", ["solver.alpha_f = 0.5", "0.3333"]),
        ("method = \"esdirk3\"", ["solver.method", "bearings with states"]),
        ("accuracy = { error = 1 }", ["solver.accuracy.error = 1", "0.5"]),
        ("maxstep = 1", ["maxstep", "max_step"]),
    ] {
        let why = refused(solver);
        assert!(parts.iter().all(|part| why.contains(part)), "{solver}: {why}");
    }
    let scene = MachineScene::from(scene(&format!("{TAPERED}\n[solver]\nmax_step = \"20 us\"\n")));
    let finer = scene.with_solver(|solver| *solver = solver.refined(1));
    assert_eq!([scene.solver().max_step.0, finer.solver().max_step.0], [2e-5, 1e-5]);
    let none = SystemScene::parse(&TAPERED.replace("[[bearing]]", "[[point]]"), None, Path::new(""));
    assert!(none.is_err());
}
