//! What things cost. `cargo bench` prints wall times; for counts that do not depend on the machine's load run the
//! same work under `valgrind --tool=callgrind`.
#![allow(missing_docs, clippy::unwrap_used, unsafe_code)]

#[path = "../tests/fmi2_abi/mod.rs"]
mod fmi2_abi;

use divan::{Bencher, counter::ItemsCount};
use nalgebra::{Vector3, Vector6};
use roulement::contact::many::ContactGroup;
use roulement::contact::{BallMotion, RaceMotion};
use roulement::dynamics::{Boundary, make_consistent};
use roulement::effects::film::Section;
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::fmi::v2::Status;
use roulement::model::bodies::{PerRace, Race};
use roulement::model::link::roller::Profile;
use roulement::model::link::roller_friction::{Friction, Lubricant, Rubbing};
use roulement::model::link::rollers::{Geometry, Rollers, Taper};
use roulement::model::{Conditions, Model};
use roulement::numerics::lanes::WIDTH;
use roulement::numerics::scalar::Dual;
use roulement::scene::Scene;
use roulement::simulation::Simulation;

const THRUST: &str = include_str!("../scenes/thrust.toml");

fn main() {
    divan::main();
}

const PRESCRIBED: (&str, &str) = ("inner.drive", "\"pose\"");

const LAWS: [&str; 5] = ["frictionless", "linear", "regularised", "saturated", "kalker_table"];

/// The thrust case with a creep law, at its start.
fn simulation(law: &str) -> Simulation {
    // The law linear ends at mu Q: a large friction coefficient leaves it room, and changes nothing in what it costs.
    let friction = if law == "linear" { "2.0" } else { "0.08" };
    let law = format!("\"{law}\"");
    let changes = [PRESCRIBED, ("effects.creep", &*law), ("friction.ball_race", friction)];
    Simulation::new(&Scene::edited(THRUST, changes).unwrap()).unwrap()
}

/// The model of a scene: tables of its contacts and of its creep law.
#[divan::bench(args = LAWS.iter().chain(&["kalker", "cage"]))]
fn model_new(bencher: Bencher, law: &str) {
    let scene = match law {
        "cage" => Scene::parse(include_str!("../scenes/cage.toml")),
        law => Scene::edited(THRUST, [("effects.creep", format!("\"{law}\""))]),
    }
    .unwrap();
    bencher.bench_local(|| Model::new(divan::black_box(&scene)).unwrap());
}

/// One contact, value only.
#[divan::bench(args = LAWS)]
fn contact_value(bencher: Bencher, law: &str) {
    let simulation = simulation(law);
    let contact = simulation.model().contact(Race::Inner, &Conditions::of_friction(0.08));
    let (ball, race) = (simulation.state().balls[0].motion(), simulation.state().race(Race::Inner).motion());
    bencher.bench_local(|| contact.evaluate(divan::black_box(&ball), divan::black_box(&race)));
}

/// Four contacts in the lanes of one vector, values only.
#[divan::bench(args = LAWS)]
fn contact_values_together(bencher: Bencher, law: &str) {
    let simulation = simulation(law);
    let contact = simulation.model().contact(Race::Inner, &Conditions::of_friction(0.08));
    let race = simulation.state().race(Race::Inner).motion();
    let balls: [_; WIDTH] = std::array::from_fn(|lane| simulation.state().balls[lane].motion());
    let mut group = ContactGroup::filled(&contact.evaluate(&balls[0], &race));
    bencher.counter(ItemsCount::new(WIDTH)).bench_local(|| {
        group.evaluate(&contact, divan::black_box(&race), divan::black_box(&BallMotion::of_balls(&balls)));
        group.forces(0).load
    });
}

/// One contact with derivatives by the nine unknowns of ball and race body that a step has.
#[divan::bench(args = LAWS)]
fn contact_with_derivatives(bencher: Bencher, law: &str) {
    let simulation = simulation(law);
    let contact = simulation.model().contact(Race::Inner, &Conditions::of_friction(0.08));
    let (ball, race) = (simulation.state().balls[0].motion(), simulation.state().race(Race::Inner).motion());
    type D = Dual<9>;
    let seed = |v: &Vector3<f64>, first: usize| -> Vector3<D> {
        Vector3::from_fn(|k, _| Dual::variable(v[k], first + k, 1.0))
    };
    let constant = |v: &Vector3<f64>| v.map(|value| D { value, derivatives: [0.0; 9] });
    let ball = BallMotion {
        position: seed(&ball.position, 0),
        velocity: seed(&ball.velocity, 3),
        angular_velocity: seed(&ball.angular_velocity, 6),
    };
    let race = RaceMotion {
        position: constant(&race.position),
        axis: constant(&race.axis),
        across: race.across,
        velocity: constant(&race.velocity),
        angular_velocity: constant(&race.angular_velocity),
    };
    bencher.bench_local(|| contact.evaluate(divan::black_box(&ball), divan::black_box(&race)).force);
}

/// All forces and accelerations of the thrust case, once.
#[divan::bench]
fn force_assembly(bencher: Bencher) {
    let simulation = simulation("saturated");
    let motion = PerRace::new(|race| {
        let race = simulation.state().race(race);
        (race.pose, race.twist())
    });
    let conditions = Conditions::of_friction(0.08);
    let frame = roulement::effects::moving_frame::FrameMotion::default();
    let boundary =
        Boundary { time: 0.0, motion, loads: Default::default(), conditions, frame, orientations: None };
    bencher.with_inputs(|| simulation.state().clone()).bench_local_values(|mut state| {
        make_consistent(simulation.model(), &mut state, &boundary);
        state
    });
}

/// One accepted step of 1e-5 s by the scene's script, with a matrix of its own and the communication around it.
#[divan::bench(args = LAWS.iter().chain(&["kalker"]))]
fn accepted_step(bencher: Bencher, law: &str) {
    let mut start = simulation(law);
    start.advance_scripted(5e-3).unwrap();
    bencher.with_inputs(|| start.clone()).bench_local_values(|mut simulation| {
        simulation.advance_scripted(5e-3 + 1e-5).unwrap();
        simulation.state().statistics.steps
    });
}

/// All outputs of a communication point, after a step in pose drive.
#[divan::bench]
fn outputs(bencher: Bencher) {
    let mut start = simulation("saturated");
    start.advance_scripted(5e-3).unwrap();
    bencher.with_inputs(|| start.clone()).bench_local_refs(|simulation| simulation.outputs().friction_power);
}

/// A communication step of 100 us through the C interface, of ten own steps; time goes on, from where the balls' starting
/// bounce has gone.
#[divan::bench]
fn fmu_step(bencher: Bencher) {
    let package = fmi2_abi::Package::new("speed", &Scene::edited(THRUST, [PRESCRIBED]).unwrap().source);
    let component = package.start();
    let mut point = 0u32;
    let mut step = || {
        // SAFETY: a live instance.
        let status = unsafe { fmi2_abi::fmi2DoStep(component, f64::from(point) * 1e-4, 1e-4, 0) };
        point += 1;
        assert_eq!(status, Status::Ok);
    };
    (0..50).for_each(|_| step());
    bencher.bench_local(step);
    // SAFETY: a live instance, not used any more.
    unsafe { fmi2_abi::fmi2FreeInstance(component) };
}

/// The quasi-static equilibrium of the thrust case.
#[divan::bench]
fn equilibrium_solve(bencher: Bencher) {
    let scene = Scene::parse(THRUST).unwrap();
    let model = Model::new(&scene).unwrap();
    let input = EquilibriumInput::from_scene(&scene, Gyroscopic::OuterRaceControl);
    bencher.bench_local(|| equilibrium::solve(&model, &input).unwrap().iterations);
}

/// Force of a bearing of 17 rollers that slowly turn: without ribs, between ribs under a thrust, and tapered. Sought from nothing, or from where a step left
/// them that moved the shaft by 0.2 um; there in oil, too.
#[divan::bench(args = ["N", "NUP", "tapered"].into_iter().flat_map(|kind| ["", "from where it was", "from where it was, in oil"].map(|how| [kind, how])))]
fn rollers(bencher: Bencher, [kind, how]: [&str; 2]) {
    let taper = Taper { contact_angle: 0.245, roller_angle: 0.07, direction: 1.0 };
    let geometry = Geometry {
        count: 17,
        diameter: 7.2e-3,
        length: 10e-3,
        pitch_diameter: 46e-3,
        diametral_clearance: if kind == "tapered" { 0.0 } else { 20e-6 },
        profile: Profile::Logarithmic,
        ribs: [kind == "NUP"; 2],
        axial_clearance: 0.0,
        rib_stiffness: None,
        first_azimuth: 0.0,
        taper: (kind == "tapered").then_some(taper),
    };
    let mut bearing = Rollers::new(geometry, None);
    if how.ends_with("oil") {
        let oil = Lubricant { oil: Section::default().lubricant(), viscosity: 0.02, starvation: 0.0 };
        let given = Rubbing { oil: Some(oil), rib_friction: 0.08, rib_radius: None, around: None };
        bearing.friction = Some(Box::new(Friction::new(given, &geometry)));
    }
    let displaced = Vector6::new(20e-6, 25e-6, 5e-6, 0.0, 2e-4, -1e-4);
    let turning = Vector6::ith(3, 10.0);
    let before = displaced + Vector6::new(1e-7, -1e-7, 1e-7, -0.001, 0.0, 0.0);
    let left = if how.starts_with("from") { bearing.leave(&before, &turning, &[]).1 } else { vec![] };
    bencher.bench_local(|| bearing.force_near(divan::black_box(&displaced), &turning, &left));
}

/// 10 ms of the thrust case at a step cap of 1e-5 s: 1000 steps an iteration, so 1 ms here is 0.1 s per simulated s.
#[divan::bench(args = ["wrench", "pose"], sample_count = 20)]
fn ten_milliseconds(bencher: Bencher, drive: &str) {
    let scene = Scene::edited(THRUST, [("inner.drive", format!("\"{drive}\""))]).unwrap();
    let mut start = Simulation::new(&scene).unwrap();
    start.advance_scripted(5e-3).unwrap();
    bencher.counter(ItemsCount::new(1000u32)).with_inputs(|| start.clone()).bench_local_values(
        |mut simulation| {
            simulation.advance_scripted(15e-3).unwrap();
            simulation.state().statistics.steps
        },
    );
}
