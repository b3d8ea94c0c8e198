//! Whole bearings with a cage: motion, energy, cost, and scenes that are refused.

use super::*;

#[test]
fn invariant_pocket_and_land_forces_accelerate_the_cage() {
    for guidance in [&[][..], INNER_GUIDED, BALL_GUIDED] {
        let (mut simulation, _) = run(&braked(guidance, 1e-3, 8e-3), 50);
        let (mass, alpha_f) = (0.02, 0.05);
        let weight = Vector3::z() * (-9.81 * mass);
        let total = |o: &Outputs| cage(o).pocket_force + cage(o).land_force + weight;
        let (mut loaded, mut compared) = (0, 0);
        for _ in 0..400 {
            let (before, steps) = (simulation.outputs().clone(), simulation.state().statistics.steps);
            simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
            simulation.advance(simulation.time() + 1e-6).unwrap();
            // one step of the scheme: m a1 = (1 - alpha_f) g1 + alpha_f g0
            if simulation.state().statistics.steps == steps + 1 {
                let (force, last) = (total(simulation.outputs()), total(&before));
                let expected = force * (1.0 - alpha_f) + last * alpha_f;
                let inertial = simulation.state().cage().unwrap().acceleration * mass;
                let scale = 1e-5 + 1e-7 * pockets(simulation.outputs()).map(|p| p.load).sum::<f64>();
                assert!((inertial - expected).norm() < scale, "{inertial} {expected}");
                compared += 1;
                loaded += u32::from(pockets(simulation.outputs()).any(|pocket| pocket.load > 0.0));
            }
        }
        assert!(compared > 100 && loaded > 10, "{compared} steps compared, {loaded} with a loaded pocket");
    }
}

#[test]
fn closed_form_cage_runs_at_the_epicyclic_speed_under_thrust() {
    for guidance in [&[][..], INNER_GUIDED, BALL_GUIDED] {
        let (_, history) = run(&scene(CAGE, &[guidance, PURE_THRUST].concat()), 300);
        for outputs in &history[100..] {
            assert!(outputs.cage_slip.abs() < 1e-2, "{} at {} s", outputs.cage_slip, outputs.time);
        }
        // Balls stay in their pockets, so that on the mean the cage goes with them.
        let mean = |get: &dyn Fn(&Outputs) -> f64| history[100..].iter().map(get).sum::<f64>() / 201.0;
        let balls = mean(&|o| o.balls.iter().map(|b| b.orbital_speed).sum::<f64>() / o.balls.len() as f64);
        let turned = mean(&|o| o.cage_speed);
        assert!((turned / balls - 1.0).abs() < 5e-3, "{turned} {balls}");
        assert!(deepest_pocket(&history) < 2e-6, "{}", deepest_pocket(&history));
    }
}

#[test]
fn invariant_energy_balance_with_every_guidance() {
    for guidance in [&[][..], INNER_GUIDED, BALL_GUIDED] {
        let (simulation, history) = run(&braked(guidance, 10e-3, 20e-3), 300);
        let lands = simulation.scene().effects.cage.section.unwrap().guided_by != Guidance::Balls;
        // Asked for: 1 % of work plus friction.
        assert!(imbalance(&history) < 1e-3, "{}", imbalance(&history));
        for outputs in &history {
            let of_contacts: f64 = outputs.balls.iter().map(|b| b.inner.power + b.outer.power).sum();
            let parts = of_contacts + cage(outputs).pocket_power + cage(outputs).land_power;
            assert!((parts / outputs.friction_power - 1.0).abs() < 1e-9);
        }
        assert!(history.iter().any(|o| cage(o).pocket_power > 0.1), "the pockets never rubbed");
        assert_eq!(history.iter().any(|o| cage(o).land_power > 0.1), lands);
    }
}

#[test]
fn start_from_rest_takes_the_cage_along() {
    let speed = "[[0.0, 0.0], [0.02, \"6000 rpm\"]]";
    let (_, history) = run(&scene(CAGE, &[("load.inner_speed", speed)]), 300);
    assert_eq!(history[0].cage_speed, 0.0);
    let last = &history[300];
    assert!(last.cage_slip.abs() < 0.02, "{}", last.cage_slip);
    assert!(history.windows(2).all(|pair| pair[1].dissipated >= pair[0].dissipated));
    assert!(deepest_pocket(&history) < 5e-6 && cage(last).turned > 1.0);
    assert!(imbalance(&history) < 1e-2, "{}", imbalance(&history));
}

#[test]
fn invariant_balls_that_jump_in_their_pockets_stay_in_them() {
    let (simulation, history) = run(&braked(&[], 1e-3, 3e-3), 150);
    let touched = |o: &Outputs, j: usize| o.balls[j].pocket.unwrap().load > 0.0;
    let changes: usize =
        (0..10).map(|j| history.windows(2).filter(|w| touched(&w[0], j) != touched(&w[1], j)).count()).sum();
    assert!(changes >= 20, "{changes} changes of contact");
    // No deeper than if all balls' change of speed met the whole cage at one pocket without damping.
    let speed = 0.5 * 0.5 * 628.0 * 23e-3;
    let model = simulation.model().cage.as_ref().unwrap();
    let energy = model.pocket.elastic_energy(deepest_pocket(&history));
    assert!(energy < 0.5 * 0.02 * speed * speed, "{energy} J at {} m", deepest_pocket(&history));
    assert!(deepest_pocket(&history) > 0.0 && deepest_pocket(&history) < 0.1 * HALF_CLEARANCE);
    assert!(history[150].cage_slip.abs() < 0.03, "{}", history[150].cage_slip);
    assert!(imbalance(&history) < 1e-2, "{}", imbalance(&history));
}

#[test]
fn invariant_whirl_is_bounded_by_the_land_clearance() {
    // A cage under its weight and the friction of the land, in a bearing with radial load.
    for guidance in [&[][..], INNER_GUIDED] {
        let (_, history) = run(&scene(CAGE, guidance), 500);
        let mut touched = 0;
        for outputs in &history {
            let cage = cage(outputs);
            assert!(cage.land_approach < 3e-6, "{} at {}", cage.land_approach, outputs.time);
            assert!(cage.eccentricity.yz().norm() < HALF_CLEARANCE + 3e-6);
            touched += u32::from(cage.land_loads.iter().any(|load| *load > 0.0));
        }
        assert!(touched > 5, "the land was touched at {touched} points");
        assert!(imbalance(&history) < 1e-2, "{}", imbalance(&history));
    }
}

#[test]
fn invariant_spherical_pockets_carry_a_cage_without_lands() {
    let (_, history) = run(&scene(CAGE, BALL_GUIDED), 500);
    // The balls themselves run up to 20 um off the pitch circle under this load.
    let largest = history.iter().map(|o| cage(o).eccentricity.yz().norm()).fold(0.0, f64::max);
    assert!(largest > 0.5 * HALF_CLEARANCE && largest < HALF_CLEARANCE + 20e-6, "{largest}");
    assert!(deepest_pocket(&history) < 0.05 * HALF_CLEARANCE);
    assert!(history.iter().all(|o| cage(o).land_loads == [0.0; 2]));
}

#[test]
fn invariant_refined_steps_give_the_same_statistics() {
    let statistics = ["\"10 us\"", "\"2.5 us\""].map(|max_step| {
        let (simulation, history) = run(&scene(CAGE, &[("solver.max_step", max_step)]), 400);
        // Exact tangents: few corrections a step, a new block as five of them, and no step given up.
        let s = &simulation.state().statistics;
        let contacts = 2.0 * simulation.state().balls.len() as f64;
        let price = s.newton.iterations as f64 + 5.0 * s.contact_tangents as f64 / contacts;
        assert!(price <= 6.0 * s.steps as f64 && s.rejected_newton == 0, "{s:?}");
        let mean = |get: fn(&Outputs) -> f64| history[200..].iter().map(get).sum::<f64>() / 201.0;
        [
            mean(|o| o.cage_speed),
            mean(|o| cage(o).pocket_power),
            mean(|o| cage(o).land_power),
            mean(|o| cage(o).eccentricity.yz().norm()),
        ]
    });
    for (coarse, fine) in statistics[0].into_iter().zip(statistics[1]) {
        assert!((coarse / fine - 1.0).abs() < 1e-2, "{statistics:?}");
    }
}

#[test]
fn invariant_hard_cases_run_through_within_the_clearances() {
    let cases: [&Changes; 6] = [
        &[("cage.damping", "0")],
        &[("friction.ball_cage", "0.3"), ("friction.cage_race", "0.3")],
        &[("load.z", ""), ("load.ry.rotation", "\"0.5 deg\"")],
        &[("cage.mass", "\"1 g\""), ("cage.inertia", "[5.5e-7, 3e-7, 3e-7]")],
        &[("load.x.force", "\"20 N\""), ("load.z.force", "\"-3000 N\"")],
        &[("load.inner_speed", "[[0, \"6000 rpm\"], [0.02, \"-6000 rpm\"]]")],
    ];
    // Balls climb both flanks under some of these loads.
    let whole = [("inner.shoulder_angle", "[1.5, 1.5]"), ("outer.shoulder_angle", "[1.5, 1.5]")];
    for case in cases {
        let (_, history) = run(&scene(CAGE, &[case, &whole].concat()), 300);
        let pocket = deepest_pocket(&history) / HALF_CLEARANCE;
        let land = history.iter().map(|o| cage(o).land_approach).fold(f64::NEG_INFINITY, f64::max);
        assert!(pocket < 0.1 && land < 0.1 * HALF_CLEARANCE, "{case:?}: {pocket} {land}");
        assert!(imbalance(&history) < 1e-2, "{case:?}: {}", imbalance(&history));
        assert!(history[300].cage_slip.abs() < 0.05, "{case:?}: {}", history[300].cage_slip);
    }
}

#[test]
fn invariant_misaligned_inner_race_keeps_excursions_within_the_pockets() {
    let (_, history) = run(&scene(CAGE, &[("load.ry.rotation", "\"0.1 deg\"")]), 400);
    // Balls run ahead and behind once per orbit: they use up the clearance and push the cage.
    let last = &history[200..];
    let largest = last.iter().flat_map(pockets).map(|pocket| pocket.load).fold(0.0, f64::max);
    assert!(largest > 0.0 && deepest_pocket(last) > 0.0);
    assert!(deepest_pocket(&history) < 0.05 * HALF_CLEARANCE, "{}", deepest_pocket(&history));
    let speeds: Vec<f64> = history[400].balls.iter().map(|ball| ball.orbital_speed).collect();
    let spread = speeds.iter().fold(0.0f64, |s, v| s.max((v - speeds[0]).abs()));
    assert!(spread > 0.1, "{speeds:?}");
    assert!(imbalance(&history) < 1e-2, "{}", imbalance(&history));
}

#[test]
fn invariant_without_the_effect_there_is_no_cage() {
    let scene = Scene::parse(THRUST).unwrap();
    let simulation = Simulation::new(&scene).unwrap();
    assert!(simulation.state().cage().is_none() && simulation.outputs().cage.is_none());
    assert!(simulation.model().cage.is_none() && simulation.model().border_size() == 7);
    let names = |scene: &Scene| -> Vec<String> {
        Variables::moving(scene, true).rows().iter().map(|row| row.name.clone()).collect()
    };
    let (without, with) = (names(&scene), names(&Scene::parse(CAGE).unwrap()));
    let of_cage =
        |name: &&String| name.starts_with("cage.") || name.contains(".pocket.") || *name == "loss.cage";
    assert_eq!(without.iter().filter(of_cage).count(), 2);
    for name in ["cage.eccentricity.radius", "cage.land_force.y", "ball[10].pocket.load", "cage.position.z"] {
        assert!(with.iter().any(|given| given == name), "{name}");
    }
    assert_eq!(with.len() - without.len(), with.iter().filter(of_cage).count() - 2);
}

#[test]
fn invariant_a_snapshot_in_mid_contact_goes_on_to_the_same_bits() {
    let scene = braked(&[], 1e-3, 12e-3);
    let (mut simulation, _) = run(&scene, 60);
    let snapshot = simulation.snapshot();
    let first = go_on(&mut simulation, 40);
    let mut other = Simulation::new(&scene).unwrap();
    assert!(other.restore(&snapshot));
    let second = go_on(&mut other, 40);
    assert!(first == second && simulation.snapshot() == other.snapshot());
    assert!(first.iter().flat_map(pockets).any(|pocket| pocket.load > 0.0));
    // A state without a cage is of another bearing.
    assert!(!Simulation::new(&Scene::parse(THRUST).unwrap()).unwrap().restore(&snapshot));
}

#[test]
fn invariant_work_of_a_step_is_linear_in_the_number_of_balls() {
    // A ring of balls on a pitch circle that grows with their number: evaluations of contacts and corrections a step, counted.
    // Instructions are counted by scripts/measure ball-cost.
    let work = |balls: u32| {
        let changes = [
            ("bearing.balls", &*balls.to_string()),
            ("bearing.pitch_diameter", &format!("\"{} mm\"", 5 * balls)),
            ("cage.land_diameter", &format!("\"{} mm\"", 5 * balls + 6)),
            ("load.x.force", &format!("\"{} N\"", 150 * balls)),
        ];
        let (simulation, _) = run(&scene(CAGE, &changes), 10);
        let s = simulation.state().statistics;
        let contacts = (s.contact_values + s.contact_tangents) as f64 / f64::from(balls);
        [contacts / s.steps as f64, s.newton.iterations as f64 / s.steps as f64, s.steps as f64]
    };
    let [few, many] = [8, 64].map(work);
    println!("contacts per ball and step, corrections per step, steps; 8 balls: {few:?}, 64 balls: {many:?}");
    for (few, many) in few.into_iter().zip(many) {
        assert!(many < 1.6 * few, "{few} {many}");
    }
}

#[test]
fn wrong_sections_are_refused_by_name() {
    let cases = [
        ("effects.cage", "", &["cage", "effects.cage = true"][..]),
        ("cage.mass", "", &["cage.mass is missing", "20 g"]),
        ("cage.mass", "0", &["cage.mass = 0", "(0, 10000]"]),
        ("cage.mass", "\"20 mm\"", &["cage.mass", "20 mm", "mm measures something else"]),
        ("cage.inertia", "[-1.0, 6e-6, 6e-6]", &["cage.inertia.x = -1"]),
        ("cage.pocket_clearance", "0", &["cage.pocket_clearance = 0"]),
        ("cage.pocket_clearance", "\"4.75 mm\"", &["pockets overlap"]),
        ("cage.guided_by", "\"left\"", &["left", "inner"]),
        ("cage.guided_by", "\"balls\"", &["cage.guidance_clearance", "guided_by"]),
        ("cage.guidance_clearance", "", &["cage.guidance_clearance", "needed"]),
        ("cage.land_width", "", &["cage.land_width", "needed"]),
        ("cage.land_diameter", "\"20 mm\"", &["cage.land_diameter = 0.02"]),
        ("friction.ball_cage", "-1", &["friction.ball_cage = -1", "[0, 2]"]),
        ("cage.colour", "1", &["cage.colour is no known key", "guided_by"]),
    ];
    let refusal = |text, key, value| Scene::edited(text, [(key, value)]).unwrap_err().to_string();
    for (key, value, parts) in cases {
        let message = refusal(CAGE, key, value);
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
    assert!(refusal(THRUST, "effects.cage", "true").contains("effects.cage"));
    assert!(refusal(THRUST, "friction.ball_cage", "0.1").contains("friction.ball_cage"));
}
