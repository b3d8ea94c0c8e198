//! A cage whose centre of mass lies beside its axis.

use super::*;

/// Nothing touches the cage for a while: wide pockets and lands, no weight.
const FREE: &Changes = &[
    ("effects.gravity", "[0, 0, 0]"),
    ("cage.pocket_clearance", "\"4.5 mm\""),
    ("cage.guidance_clearance", "\"2 mm\""),
    ("cage.unbalance", "\"2 g mm\""),
];

/// Neither weight nor radial load.
const SYMMETRIC: &Changes = &[("effects.gravity", "[0, 0, 0]"), ("load.z", "")];

#[test]
fn closed_form_a_free_cage_turns_about_its_centre_of_mass() {
    let (_, history) = run(&scene(CAGE, &[PURE_THRUST, FREE].concat()), 140);
    let first = cage(&history[0]);
    let spin = first.twist.angular_velocity;
    // 2 g mm of 20 g.
    let offset = first.pose.orientation * Vector3::y() * 1e-4;
    for outputs in &history {
        let (now, time) = (cage(outputs), outputs.time);
        assert!(
            (now.twist.angular_velocity - spin).norm() < 1e-6 * spin.norm(),
            "{}",
            now.twist.angular_velocity
        );
        // The centre of mass goes straight on.
        let turn = UnitQuaternion::from_scaled_axis(spin * time);
        let expected = offset + spin.cross(&offset) * time - turn * offset;
        let missed = (now.pose.position - first.pose.position - expected).norm();
        assert!(missed < 1e-9, "{missed} m at {time} s");
    }
    // A third of a millimetre in that time.
    assert!((cage(&history[140]).pose.position - first.pose.position).norm() > 3e-4);
}

#[test]
fn invariant_forces_on_a_cage_move_its_centre_of_mass() {
    let (mut simulation, _) = run(&scene(CAGE, &[("cage.unbalance", "\"2 g mm\"")]), 50);
    let (mass, alpha_f) = (0.02, 0.05);
    // Force on the cage less that which turns its centre of mass about its centre.
    let total = |simulation: &Simulation| {
        let outputs = simulation.outputs();
        let state = simulation.state().cage().unwrap();
        let offset = Vector3::y() * 1e-4;
        let turned = state.rate_derivative.cross(&offset) + state.rate.cross(&state.rate.cross(&offset));
        let weight = Vector3::z() * (-9.81 * mass);
        let forces = cage(outputs).pocket_force + cage(outputs).land_force + weight;
        (forces - state.pose.orientation * turned * mass, forces.norm())
    };
    let (mut compared, mut touched) = (0, 0);
    for _ in 0..400 {
        let (before, steps) = (total(&simulation).0, simulation.state().statistics.steps);
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        simulation.advance(simulation.time() + 1e-6).unwrap();
        if simulation.state().statistics.steps == steps + 1 {
            let (now, size) = total(&simulation);
            let inertial = simulation.state().cage().unwrap().acceleration * mass;
            let expected = now * (1.0 - alpha_f) + before * alpha_f;
            assert!((inertial - expected).norm() < 1e-5 + 1e-7 * size, "{inertial} {expected}");
            compared += 1;
            touched += u32::from(cage(simulation.outputs()).pocket_force.norm() > 0.0);
        }
    }
    assert!(compared > 100 && touched > 10, "{compared} {touched}");
}

#[test]
fn invariant_energy_balance_with_an_unbalance() {
    for guidance in [&[][..], BALL_GUIDED] {
        let changes = [guidance, SYMMETRIC, &[("cage.unbalance", "\"20 g mm\"")]].concat();
        let (_, history) = run(&scene(CAGE, &changes), 300);
        assert!(imbalance(&history) < 1e-3, "{}", imbalance(&history));
        // Nothing else moves it off its axis, and pockets or lands rub as it goes round.
        let rubs = |history: &[Outputs]| {
            history.iter().map(|o| cage(o).pocket_power + cage(o).land_power).sum::<f64>()
        };
        let (_, whole) = run(&scene(CAGE, &[guidance, SYMMETRIC].concat()), 300);
        assert!(rubs(&history) > 1e3 * rubs(&whole), "{} {}", rubs(&history), rubs(&whole));
    }
}

#[test]
fn an_unbalance_that_no_cage_has_is_refused() {
    let refused =
        |changes: &[(&str, &str)]| Scene::edited(CAGE, changes.iter().copied()).unwrap_err().to_string();
    for value in ["\"-1 g mm\"", "\"1 kg mm\""] {
        let why = refused(&[("cage.unbalance", value)]);
        assert!(why.contains("cage.unbalance") && why.contains("allowed") && why.contains("kg m"), "{why}");
    }
    let why = refused(&[("cage.unbalance", "\"1 mm\"")]);
    assert!(why.contains("cage.unbalance") && why.contains("g mm"), "{why}");
    let frame = ("effects.frame", "{ angular_velocity = [\"200 rpm\", 0, 0] }");
    let why = refused(&[("cage.unbalance", "\"1 g mm\""), frame]);
    assert!(why.contains("cage.unbalance") && why.contains("frame"), "{why}");
}
