//! Stick and slip over the contacts of a running bearing, against closed forms and the forces of the simulation.

use roulement::analysis::stick_slip::{Field, field};
use roulement::model::Conditions;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::Simulation;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const RADIAL: &str = include_str!("../../scenes/radial.toml");

fn run(scene: &str, law: &str, bent: &str) -> Simulation {
    let effects = format!("{{ creep = \"{law}\", heathcote_slip = {bent}, damping = 0.02 }}");
    let scene = Scene::edited(scene, [("effects", effects)]).unwrap();
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.advance(1e-3).unwrap();
    simulation
}

fn of(simulation: &Simulation, ball: usize, race: Race) -> Field {
    field(simulation.model(), simulation.state(), &simulation.conditions(), (ball, race), 32)
        .unwrap()
        .unwrap()
}

#[test]
fn closed_form_pressure_and_tractions_of_the_field_add_up_to_load_and_forces() {
    for bent in ["false", "true"] {
        let simulation = run(THRUST, "kalker_table", bent);
        for race in Race::BOTH {
            let field = of(&simulation, 2, race);
            let contact = &simulation.outputs().balls[2][race];
            let sum = |get: &dyn Fn(usize) -> f64| -> f64 {
                (0..field.points.len()).map(|i| field.points[i].area * get(i)).sum()
            };
            // A staircase in place of an ellipse.
            let load = sum(&|i| field.points[i].pressure);
            assert!((load / contact.load - 1.0).abs() < 0.01, "{race:?}: {load} {}", contact.load);
            let [fx, fy] = [0, 1].map(|k: usize| sum(&|i| field.points[i].traction[k]));
            let limit = simulation.inputs().friction * contact.load;
            // The field is that of the ball on the race. Sums of cells are of first order in their size; the table is good to some
            // hundredths in the mean.
            for (ours, theirs) in [(fx, -contact.force_longitudinal), (fy, -contact.force_lateral)] {
                assert!((ours - theirs).abs() < 0.06 * limit, "{race:?} {bent}: {ours} {theirs} of {limit}");
            }
            assert!((fx / limit - field.forces.fx).abs() < 0.01, "{race:?}: {fx} {:?}", field.forces);
            assert!((field.semi_axes[0] / contact.semi_axis_rolling - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn invariant_cells_that_slide_are_at_the_friction_limit_and_against_their_slip() {
    // Thrust: balls spin, and slide nearly everywhere. Radial load at contact angle 0: bent grooves slip in bands, and stick between.
    for (scene, ball, least) in [(THRUST, 2, 0.0), (RADIAL, 0, 0.05)] {
        let simulation = run(scene, "saturated", "true");
        for race in Race::BOTH {
            let field = of(&simulation, ball, race);
            let friction = simulation.inputs().friction;
            let (mut stuck, mut power) = (0, 0.0);
            let fastest = field.points.iter().map(|p| p.slip[0].hypot(p.slip[1])).fold(0.0, f64::max);
            for point in &field.points {
                let [tx, ty] = point.traction;
                let limit = friction * point.pressure;
                assert!(tx.hypot(ty) <= limit * (1.0 + 1e-3), "{race:?}: {point:?}");
                let along = tx * point.slip[0] + ty * point.slip[1];
                power += along * point.area;
                if point.sticks {
                    stuck += 1;
                    // What the sweeps leave.
                    assert!(point.slip[0].hypot(point.slip[1]) < 0.02 * fastest, "{race:?}: {point:?}");
                } else {
                    assert!((tx.hypot(ty) / limit - 1.0).abs() < 1e-3, "{race:?}: {point:?}");
                    let slip = point.slip[0].hypot(point.slip[1]);
                    assert!(along > 0.99 * limit * slip - 1e-3 * limit * fastest, "{race:?}: {point:?}");
                }
            }
            assert!((f64::from(stuck) / field.points.len() as f64 - field.stick).abs() < 1e-12);
            assert!(field.stick >= least && field.stick < 1.0, "{race:?}: {}", field.stick);
            assert!(power > 0.0, "{race:?}: {power} W");
        }
    }
}

#[test]
fn a_contact_without_load_or_friction_has_no_field() {
    let simulation = Simulation::new(&Scene::parse(RADIAL).unwrap()).unwrap();
    let unloaded = (0..9).find(|&ball| simulation.outputs().balls[ball].inner.load == 0.0).unwrap();
    let conditions = simulation.conditions();
    let of =
        |ball, conditions| field(simulation.model(), simulation.state(), conditions, (ball, Race::Inner), 16);
    assert!(of(unloaded, &conditions).unwrap().is_none());
    assert!(of(0, &conditions).unwrap().is_some());
    let slick = Conditions { friction: 0.0, ..conditions };
    assert!(of(0, &slick).unwrap().is_none());
}
