//! Heat of friction by part, against the energy balance; spin and ellipses of the balls.

use roulement::interface::variables::Variables;
use roulement::scene::Scene;
use roulement::simulation::Simulation;

const CAGE: &str = include_str!("../../scenes/cage.toml");
const THRUST: &str = include_str!("../../scenes/thrust.toml");

#[test]
fn invariant_heat_of_all_parts_is_the_energy_lost_to_friction() {
    for (text, changes) in [
        (CAGE, &[("effects.heat_outputs", "true")][..]),
        (
            CAGE,
            &[
                ("effects.heat_outputs", "true"),
                ("cage.guided_by", "\"inner\""),
                ("cage.land_diameter", "\"40 mm\""),
            ],
        ),
        (THRUST, &[("effects.heat_outputs", "true")]),
    ] {
        let mut simulation = Simulation::new(&Scene::edited(text, changes.iter().copied()).unwrap()).unwrap();
        // At the start there is no duration to take a mean of.
        let (start, powers) = (simulation.outputs().clone(), simulation.state().powers);
        let sum = |simulation: &Simulation| {
            let heat = simulation.outputs().heat.unwrap();
            assert!(
                heat.inner >= 0.0 && heat.outer >= 0.0 && heat.balls >= 0.0 && heat.cage >= 0.0,
                "{heat:?}"
            );
            heat.inner + heat.outer + heat.balls + heat.cage
        };
        assert!((sum(&simulation) / powers.friction - 1.0).abs() < 1e-12, "{:?} {powers:?}", start.heat);
        let mut energy = simulation.state().energies.friction;
        for end in [1e-4, 2.5e-4, 2e-3, 2.01e-3] {
            let begin = simulation.time();
            simulation.advance_scripted(end).unwrap();
            let now = simulation.state().energies.friction;
            let mean = (now - energy) / (end - begin);
            // Differences of sums since the start: twelve digits of the largest.
            let rounding = 1e-12 * now / (end - begin);
            assert!((sum(&simulation) - mean).abs() <= rounding, "{end}: {} {mean}", sum(&simulation));
            energy = now;
        }
        let heat = simulation.outputs().heat.unwrap();
        assert_eq!(heat.cage > 0.0, text == CAGE, "{heat:?}");
        // Balls take half of what their contacts lose, the races the rest.
        let of_cage = simulation.outputs().cage.is_some();
        assert!(of_cage || (heat.inner + heat.outer - heat.balls).abs() < 1e-9 * heat.balls, "{heat:?}");
    }
}

#[test]
fn invariant_means_go_on_from_a_snapshot() {
    let scene =
        Scene::edited(CAGE, [("effects.heat_outputs", "true"), ("rating.reliability", "0.9")]).unwrap();
    let mut one = Simulation::new(&scene).unwrap();
    one.advance_scripted(1e-4).unwrap();
    let snapshot = one.snapshot();
    let mut other = Simulation::new(&scene).unwrap();
    assert!(other.restore(&snapshot));
    assert_eq!(one.outputs(), other.outputs());
    one.advance_scripted(3e-4).unwrap();
    other.advance_scripted(3e-4).unwrap();
    assert_eq!(one.outputs(), other.outputs());
    assert!(one.outputs().life.unwrap().reference > 0.0);
    // A snapshot of a bearing without these sums is of another scene.
    assert!(!Simulation::new(&Scene::parse(CAGE).unwrap()).unwrap().restore(&snapshot));
}

#[test]
fn regression_reports_leave_the_motion_as_it_is() {
    let with = [
        ("effects.heat_outputs", "true"),
        ("rating.reliability", "0.9"),
        ("effects.shoulder_outputs", "true"),
    ];
    let scenes = [Scene::parse(CAGE).unwrap(), Scene::edited(CAGE, with).unwrap()];
    let [plain, told] = scenes.map(|scene| {
        let mut simulation = Simulation::new(&scene).unwrap();
        simulation.advance_scripted(1e-3).unwrap();
        simulation
    });
    assert_eq!(plain.state().balls, told.state().balls);
    assert_eq!(plain.state().energies, told.state().energies);
    assert_eq!(plain.state().statistics, told.state().statistics);
}

#[test]
fn invariant_rows_of_balls_have_spin_and_ellipses() {
    let scene = Scene::edited(THRUST, [("effects.per_ball_outputs", "true")]).unwrap();
    let simulation = Simulation::new(&scene).unwrap();
    let rows = Variables::new(&scene);
    let value = |name: &str| {
        let row = rows.rows().iter().find(|row| row.name == name).unwrap_or_else(|| panic!("{name}"));
        rows.value(row, simulation.inputs(), simulation.outputs())
    };
    for ball in 1..=10 {
        let of = &simulation.outputs().balls[ball - 1];
        let spin =
            ["axial", "radial", "tangential"].map(|along| value(&format!("ball[{ball}].spin.{along}")));
        let size = spin.iter().map(|s| s * s).sum::<f64>().sqrt();
        assert!((size / of.angular_velocity.norm() - 1.0).abs() < 1e-12);
        assert!((spin[0] - of.angular_velocity.x).abs() < 1e-9 * size);
        // Hertz: peak pressure is 1.5 of the mean.
        for race in ["inner", "outer"] {
            let axes =
                ["rolling", "transverse"].map(|axis| value(&format!("ball[{ball}].{race}.semi_axis_{axis}")));
            let mean =
                value(&format!("ball[{ball}].{race}.load")) / (std::f64::consts::PI * axes[0] * axes[1]);
            let peak = value(&format!("ball[{ball}].{race}.peak_pressure"));
            assert!((1.5 * mean / peak - 1.0).abs() < 1e-12, "{mean} {peak}");
            assert!(axes[1] > axes[0] && axes[0] > 1e-5);
        }
    }
}
