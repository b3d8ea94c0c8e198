//! The reference of the accuracy study against an integrator that shares nothing with ours but the contact kernel:
//! DOP853, explicit, of order 8 (crate `ode_solvers`), at a tolerance of 1e-11.

use std::sync::atomic::AtomicBool;

use nalgebra::{UnitQuaternion, Vector3};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{DVector as Unknowns, Dop853, System};
use roulement::contact::{BallMotion, BallRaceContact, RaceMotion};
use roulement::model::bodies::Race;
use roulement::model::{Conditions, Model};
use roulement::scene::{Condition, Scene};
use roulement::simulation::Simulation;
use roulement_cli::cost::levers::{Setting, reference_steps};
use roulement_cli::cost::norms::{Comparison, Norm, errors};
use roulement_cli::cost::record::{Record, Sample, record};

const MISALIGNMENT: &str = include_str!("../../../scenes/cost/misalignment.toml");
const LOAD_ZONE: &str = include_str!("../../../scenes/cost/load_zone.toml");
/// Unknowns of a ball: position, velocity, angular velocity.
const WIDTH: usize = 9;
/// [1/s] scales velocities and angular velocities so that one tolerance fits all unknowns.
const RATE: f64 = 1e3;
const TOLERANCE: f64 = 1e-11;

/// The balls between races whose motion the scene's script gives.
struct Balls<'a> {
    scene: &'a Scene,
    model: &'a Model,
    inner_position: Vector3<f64>,
}

impl Balls<'_> {
    /// The inner race tilts about y and spins about its own axis.
    fn inner(&self, time: f64) -> RaceMotion<f64> {
        let Condition::Motion(tilt) = &self.scene.load.conditions()[3] else {
            panic!("the scene scripts a tilt")
        };
        let (angle, rate) = tilt.smooth_at(time);
        let axis = UnitQuaternion::new(Vector3::y() * angle) * Vector3::x();
        let angular_velocity = axis * self.scene.load.inner_speed.at(time) + Vector3::y() * rate;
        let across = Vector3::y();
        RaceMotion {
            position: self.inner_position,
            axis,
            across,
            velocity: Vector3::zeros(),
            angular_velocity,
        }
    }

    fn outer() -> RaceMotion<f64> {
        RaceMotion::resting(Vector3::zeros(), Vector3::x(), Vector3::y())
    }

    fn motion(&self, y: &[f64]) -> BallMotion<f64> {
        let length = self.model.bearing.ball.radius;
        BallMotion {
            position: Vector3::from_row_slice(&y[0..3]) * length,
            velocity: Vector3::from_row_slice(&y[3..6]) * (length * RATE),
            angular_velocity: Vector3::from_row_slice(&y[6..9]) * RATE,
        }
    }

    fn contacts(&self, time: f64, ball: &BallMotion<f64>) -> [BallRaceContact<f64>; 2] {
        let conditions = Conditions::of_friction(self.scene.friction.ball_race.at(0.0));
        let races = [(Race::Inner, self.inner(time)), (Race::Outer, Self::outer())];
        races.map(|(race, motion)| self.model.contact(race, &conditions).evaluated(ball, &motion))
    }

    /// Sample of a state, as the study compares them. The energy is not integrated.
    fn sample(&self, time: f64, y: &[f64]) -> Sample {
        let pitch_radius = self.model.race_length();
        let (mut force, mut moment, mut friction_power) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        let (mut race_power, mut spin_power, mut largest_load, mut peak_pressure) = ([0.0; 2], 0.0, 0.0, 0.0);
        let mut orbital_speed = Vec::new();
        for ball in y.chunks_exact(WIDTH).map(|y| self.motion(y)) {
            let contacts = self.contacts(time, &ball);
            force -= contacts[0].force;
            moment += contacts[0].race_moment;
            friction_power += contacts.iter().map(|contact| contact.friction_power).sum::<f64>();
            for (race, contact) in contacts.iter().enumerate() {
                race_power[race] += contact.friction_power;
                spin_power += contact.creep.spin_moment * contact.creepage.spin * contact.rolling_speed;
                largest_load = f64::max(largest_load, contact.load);
                let [a, b] = contact.semi_axes;
                let area = std::f64::consts::PI * a * b * contact.geometry.approach;
                peak_pressure = f64::max(peak_pressure, 1.5 * contact.load / area);
            }
            let (x, v) = (ball.position, ball.velocity);
            orbital_speed.push((x.y * v.z - x.z * v.y) / (x.y * x.y + x.z * x.z));
        }
        let axis = self.inner(time).axis;
        let position = self.inner_position;
        Sample {
            time,
            wrench: [force.x, force.y, force.z, moment.y / pitch_radius, moment.z / pitch_radius],
            displacement: [position.x, position.y, position.z, -axis.z * pitch_radius, axis.y * pitch_radius],
            friction_torque: -moment.dot(&axis),
            friction_power,
            race_power,
            spin_power,
            largest_load,
            peak_pressure,
            cage_speed: orbital_speed.iter().sum::<f64>() / orbital_speed.len() as f64,
            orbital_speed,
            dissipated: 0.0,
            unaccounted: 0.0,
        }
    }
}

impl System<f64, Unknowns<f64>> for &Balls<'_> {
    /// The last unknown is the time: `ode_solvers` 0.6.2 evaluates stage 12 of DOP853 at the start of the step (its C[11]
    /// is 0 where Hairer has 1), which an autonomous system does not notice.
    fn system(&self, _: f64, y: &Unknowns<f64>, rate: &mut Unknowns<f64>) {
        let n = y.len() - 1;
        let time = y[n] / RATE;
        rate[n] = RATE;
        let ball_model = &self.model.bearing.ball;
        let length = ball_model.radius;
        for (y, rate) in
            y.as_slice()[..n].chunks_exact(WIDTH).zip(rate.as_mut_slice().chunks_exact_mut(WIDTH))
        {
            let ball = self.motion(y);
            let [inner, outer] = self.contacts(time, &ball);
            let acceleration =
                (inner.force + outer.force) / ball_model.mass + self.scene.effects.gravity.at(time);
            let angular_acceleration = (inner.ball_moment + outer.ball_moment) / ball_model.inertia;
            rate[0..3].copy_from_slice((ball.velocity / length).as_slice());
            rate[3..6].copy_from_slice((acceleration / (length * RATE)).as_slice());
            rate[6..9].copy_from_slice((angular_acceleration / RATE).as_slice());
        }
    }
}

/// Integrates a scene by DOP853 from where our simulation starts; samples like those of `like`.
fn independent(scene: &Scene, like: &Record) -> Record {
    let simulation = Simulation::new(scene).unwrap();
    let model = simulation.model();
    let balls = Balls { scene, model, inner_position: simulation.state().race(Race::Inner).pose.position };
    let length = model.bearing.ball.radius;
    let start = simulation.state().balls.iter().flat_map(|ball| {
        let scaled = [ball.position / length, ball.velocity / (length * RATE), ball.angular_velocity / RATE];
        scaled.into_iter().flat_map(|v| [v.x, v.y, v.z])
    });
    let mut y = Unknowns::from_iterator(WIDTH * simulation.state().balls.len() + 1, start.chain([0.0]));
    let mut samples = vec![balls.sample(0.0, y.as_slice())];
    let mut step = 1e-7;
    let mut evaluations = 0;
    for pair in like.bearings[0].windows(2) {
        let (from, to) = (pair[0].time, pair[1].time);
        // Interval by interval: the script's breakpoints are communication points, and no step crosses one.
        let mut solver = Dop853::from_param(
            &balls,
            from,
            to,
            to - from,
            y,
            TOLERANCE,
            TOLERANCE,
            0.9,
            0.0,
            0.333,
            6.0,
            to - from,
            step,
            1_000_000,
            u32::MAX,
            OutputType::Sparse,
        );
        let work = solver.integrate().unwrap();
        evaluations += work.num_eval;
        step = 0.5 * (to - from) / f64::from(work.accepted_steps);
        assert!((solver.x_out().last().unwrap() - to).abs() < 1e-15);
        y = solver.y_out().last().unwrap().clone();
        samples.push(balls.sample(to, y.as_slice()));
    }
    println!("DOP853: {evaluations} evaluations of the right-hand side");
    Record { bearings: vec![samples], ..like.clone() }
}

/// Quantities that are compared.
const COMPARED: [Norm; 9] = [
    Norm::Wrench,
    Norm::FrictionTorque,
    Norm::Orbit,
    Norm::CageSpeed,
    Norm::InnerPower,
    Norm::OuterPower,
    Norm::SpinShare,
    Norm::LargestLoad,
    Norm::PeakPressure,
];

/// Both runs of the reference against DOP853: errors per norm of the tiny step, and error bars.
fn compare(scene: &Scene) -> [[f64; 2]; COMPARED.len()] {
    // Within a communication step we follow a cubic that meets the script at its ends: steps so short that it does not
    // matter.
    let communication = scene.load.output_interval.0 / 8.0;
    let machine = scene.clone().into();
    let runs = reference_steps(&machine).map(|step| {
        record(&Setting { communication, ..Setting::fixed_step(&machine, step) }, &AtomicBool::default())
            .unwrap()
    });
    let truth = independent(scene, &runs[0]);
    let window = 0.25 * scene.load.duration.0;
    let found = runs.each_ref().map(|run| errors(run, &truth, Comparison::Pointwise, window));
    let bar = errors(&runs[1], &runs[0], Comparison::Pointwise, window);
    COMPARED.map(|norm| {
        let [fine, coarse] = found.each_ref().map(|errors| errors.get(norm).unwrap());
        let bar = bar.get(norm).unwrap();
        println!("{:16} tiny step {fine:.2e}, twice that {coarse:.2e}, error bar {bar:.2e}", norm.name());
        [fine, bar]
    })
}

/// The misalignment scene without its cage, whose impacts let every two integrators part.
fn tilting(mut scene: Scene) -> Scene {
    scene.effects.cage = roulement::effects::cage::Settings::default();
    scene
}

/// The tilt of the scene in 4 ms instead of 16.
fn short() -> Scene {
    let changes =
        [("load.ry.rotation", "[[\"0.4 ms\", 0.0], [\"4.4 ms\", 1e-3]]"), ("load.duration", "\"5 ms\"")];
    tilting(Scene::edited(MISALIGNMENT, changes).unwrap())
}

#[test]
fn independent_integrator_confirms_the_reference() {
    for [error, bar] in compare(&short()) {
        assert!(error < 1e-7 && bar < 1e-7, "{error} {bar}");
    }
}

/// The error bar is the distance to twice the step: three times the error of a method of order 2, where rounding and the
/// tolerances of both integrators (1e-7) do not matter.
#[test]
#[ignore = "a minute"]
fn independent_integrator_confirms_the_reference_and_its_error_bar_of_whole_scenes() {
    for scene in [tilting(Scene::parse(MISALIGNMENT).unwrap()), Scene::parse(LOAD_ZONE).unwrap()] {
        println!("{}", scene.title);
        for [error, bar] in compare(&scene) {
            assert!(error < f64::max(1e-7, 0.5 * bar) && bar < 5e-6, "{error} {bar}");
        }
    }
}
