//! Spalls of balls: forces and moments against the slopes of the energy, impacts against the running frequency, and invariants.

use std::f64::consts::{PI, TAU};

use nalgebra::{UnitQuaternion, Vector3};
use roulement::contact::many::ContactGroup;
use roulement::contact::pair::PairForces;
use roulement::contact::{BallMotion, BallRaceContact, RaceMotion};
use roulement::model::bodies::Race;
use roulement::model::state::{BallState, State};
use roulement::model::{Conditions, Model};
use roulement::scene::Scene;
use roulement::simulation::Simulation;

/// The damaged ball (0 is the first).
const BALL: usize = 2;

/// A 6206 with contact angle under thrust by displacement, all balls loaded, with a spall on the third.
fn text(azimuth: f64, rest: &str) -> String {
    format!(
        "[bearing]\nballs = 9\nball_diameter = 9.525e-3\npitch_diameter = 46e-3\ninner_conformity = 0.52\n\
         outer_conformity = 0.53\ncontact_angle = \"25 deg\"\n\
         [[defect]]\non = \"ball\"\nball = 3\nazimuth = {azimuth}\nlength = 1e-3\nwidth = 3e-3\ndepth = 1e-4\n\
         [load]\ninner_speed = \"3000 rpm\"\nx = {{ displacement = \"10 um\" }}\nduration = \"50 ms\"\n{rest}"
    )
}

fn running(azimuth: f64, rest: &str) -> Scene {
    let effects = "[effects]\ncreep = \"saturated\"\ndamping = \"0.5 s/m\"\n";
    Scene::parse(&text(azimuth, &format!("{effects}{rest}"))).unwrap()
}

/// Times \[s] at which the load of the damaged ball falls below half of what it was at the start, \[Hz] mean BSF, and \[Hz] mean turns of
/// the ball seen from its orbit.
fn falls(scene: &Scene) -> (Vec<f64>, [f64; 2]) {
    let mut simulation = Simulation::new(scene).unwrap();
    let level = 0.5 * simulation.outputs().balls[BALL].outer.load;
    let interval = 1e-5;
    let (mut falls, mut before, mut turns) = (vec![], 2.0 * level, [0.0; 2]);
    for i in 1..=4500u32 {
        simulation.advance(f64::from(i) * interval).unwrap();
        let outputs = simulation.outputs();
        let ball = &outputs.balls[BALL];
        let seen = ball.angular_velocity - Vector3::x() * ball.orbital_speed;
        turns = [turns[0] + outputs.frequencies.ball / 4500.0, turns[1] + seen.norm() / TAU / 4500.0];
        let load = ball.outer.load;
        if before >= level && load < level {
            let time = (f64::from(i) - (level - load) / (before - load)) * interval;
            // Not when what the impact left behind still rings.
            if falls.last().is_none_or(|last| time - last > 2e-3) {
                falls.push(time);
            }
        }
        before = load;
    }
    (falls, turns)
}

#[test]
fn closed_form_a_spalled_ball_strikes_twice_in_each_of_its_turns() {
    let thrust = running(1.0, "");
    // With contact angles of 0: pressed between the races everywhere.
    let pressed = thrust.source.replace("contact_angle = \"25 deg\"", "diametral_clearance = \"-16 um\"");
    let pressed = Scene::parse(&pressed.replace("displacement = \"10 um\"", "displacement = 0")).unwrap();
    for (name, scene) in [("thrust", thrust), ("pressed", pressed)] {
        let (falls, [bsf, turns]) = falls(&scene);
        // Both races are met in turn: whole turns of the ball are between every second one.
        let pairs = (falls.len() - 1) / 2;
        let rate = pairs as f64 / (falls[2 * pairs] - falls[0]);
        println!("{name}: {} impacts, {rate:.4} Hz, BSF {bsf:.4} Hz, turns {turns:.4} Hz", falls.len());
        assert!(falls.len() >= 9 && (rate / turns - 1.0).abs() < 1e-3, "{name}");
        // BSF is of a ball that does not pivot. One under a contact angle does on both races, so that its axis leans.
        let pivots = if name == "thrust" { 1e-2 } else { 1e-3 };
        assert!((rate / bsf - 1.0).abs() < pivots, "{name}");
    }
}

#[test]
fn invariant_half_the_step_gives_the_same_peak() {
    let peak = |interval: f64| {
        let mut simulation = Simulation::new(&running(PI - 0.4, "")).unwrap();
        let mut peak = 0.0f64;
        for i in 1..=(6e-3 / interval).round() as u32 {
            simulation.advance(f64::from(i) * interval).unwrap();
            peak = simulation.outputs().balls.iter().map(|ball| ball.outer.load).fold(peak, f64::max);
        }
        peak
    };
    let [whole, half] = [4e-6, 2e-6].map(peak);
    println!("peak {whole:.2} N, with half the step {half:.2} N");
    assert!((whole / half - 1.0).abs() < 0.02, "{whole} {half}");
    // Left alone, steps over a spall are a third of a contact's half width: 3.4 m/s over 0.13 mm.
    let solver = "[solver]\nmax_step = 2e-4\ninitial_step = 1e-5\ntolerance = 1e-2\n";
    let mut simulation = Simulation::new(&running(0.6, solver)).unwrap();
    let (mut last, mut near, mut far) = (0, 0, 0);
    for i in 1..=250u32 {
        let facing = |state: &State| {
            let turned = state.orientations.as_ref().unwrap()[0];
            let out = turned * Vector3::new(0.0, 0.6f64.cos(), 0.6f64.sin());
            let position = state.balls[BALL].position;
            let radial = Vector3::new(0.0, position.y, position.z).normalize();
            let contact = radial * 25f64.to_radians().cos() + Vector3::x() * 25f64.to_radians().sin();
            out.dot(&contact).abs().min(1.0).acos()
        };
        let before = facing(simulation.state());
        simulation.advance(f64::from(i) * 4e-5).unwrap();
        let after = facing(simulation.state());
        let steps = simulation.outputs().statistics.steps;
        if before < 0.15 && after < 0.15 {
            near += 1;
            assert!(steps - last >= 3, "{} steps in 40 us over the spall", steps - last);
        } else if before > 0.6 && after > 0.6 {
            far += u32::from(steps - last <= 2);
        }
        last = steps;
    }
    assert!(near >= 4 && far >= 20, "{near} {far}");
}

#[test]
fn invariant_a_run_goes_on_from_a_snapshot_to_the_same_bits() {
    let scene = running(0.5, "");
    let mut simulation = Simulation::new(&scene).unwrap();
    // Within the spall, which it meets after half a radian at 730 rad/s.
    simulation.advance(0.7e-3).unwrap();
    let snapshot = simulation.snapshot();
    simulation.advance(6e-3).unwrap();
    let mut other = Simulation::new(&scene).unwrap();
    other.advance(1e-3).unwrap();
    assert!(other.restore(&snapshot));
    other.advance(6e-3).unwrap();
    assert!(other.state() == simulation.state() && other.outputs() == simulation.outputs());
    // A bearing with whole balls has no orientations, and does not take those of another.
    let whole = scene.source.replace("\"ball\"\nball = 3", "\"outer\"");
    let mut whole = Simulation::new(&Scene::parse(&whole).unwrap()).unwrap();
    assert!(whole.state().orientations.is_none() && !whole.restore(&snapshot));
}

#[test]
fn invariant_orientations_are_those_of_the_angular_velocity_and_stay_of_unit_length() {
    let mut simulation = Simulation::new(&running(1.0, "")).unwrap();
    let mut integral = Vector3::<f64>::zeros();
    let mut before = simulation.state().balls[BALL].angular_velocity.x;
    for i in 1..=2000u32 {
        simulation.advance(f64::from(i) * 1e-5).unwrap();
        let now = simulation.state().balls[BALL].angular_velocity;
        integral.x += 0.5e-5 * (before + now.x);
        before = now.x;
    }
    let orientation = simulation.state().orientations.as_ref().unwrap()[0];
    assert!((orientation.norm() - 1.0).abs() < 1e-14);
    // The same motion with a quarter of the steps' size ends at the same place.
    let mut finer = Simulation::new(&running(1.0, "[solver]\nmax_step = 1e-6\n")).unwrap();
    finer.advance(20e-3).unwrap();
    let fine = finer.state().orientations.as_ref().unwrap()[0];
    let apart = orientation.angle_to(&fine);
    println!("{:.1} rad about the axis, {apart:.1e} rad apart", integral.x);
    assert!(integral.x.abs() > 5.0 && apart < 5e-3, "{integral} {apart}");
}

/// Places of the damaged ball and orientations before, over and behind its spall, with its contact with a race.
struct Places {
    model: Model,
    race: Race,
    seen: RaceMotion<f64>,
    motion: BallMotion<f64>,
}

impl Places {
    fn new(race: Race, damping: &str) -> Self {
        let creep = format!("[effects]\ncreep = \"frictionless\"\ndamping = \"{damping}\"\n");
        let scene = Scene::parse(&text(if race == Race::Outer { 0.0 } else { PI }, &creep)).unwrap();
        let simulation = Simulation::new(&scene).unwrap();
        let state = simulation.state();
        let mut motion = state.balls[BALL].motion();
        // Deeper than the equilibrium over the hole, so that it always carries something.
        let radial = Vector3::new(0.0, motion.position.y, motion.position.z).normalize();
        let out = radial * 25f64.to_radians().cos() + Vector3::x() * 25f64.to_radians().sin();
        motion.position += out * if race == Race::Outer { 9e-6 } else { -9e-6 };
        Self { race, seen: state.race(race).motion(), motion, model: simulation.model().clone() }
    }

    /// The contact of the ball moved by an offset \[m] and turned by a rotation vector \[rad] after one about the axis that it rolls about.
    fn at(&self, rolled: f64, offset: Vector3<f64>, turned: Vector3<f64>) -> BallRaceContact<f64> {
        let motion = BallMotion { position: self.motion.position + offset, ..BallMotion::at_rest() };
        self.moving(rolled, turned, &motion, &self.seen)
    }

    fn moving(
        &self,
        rolled: f64,
        turned: Vector3<f64>,
        ball: &BallMotion<f64>,
        race: &RaceMotion<f64>,
    ) -> BallRaceContact<f64> {
        let start = self.model.damaged.as_ref().unwrap().at_start[0];
        let axis = start * Vector3::x();
        let orientation = vec![UnitQuaternion::new(turned) * UnitQuaternion::new(axis * rolled) * start];
        let contact =
            self.model.contact(self.race, &Conditions::of_friction(0.0)).oriented(Some(&orientation));
        contact.of_ball(BALL, None).evaluated(ball, race)
    }
}

/// \[J] elastic energy of a contact.
fn energy_of(contact: &BallRaceContact<f64>) -> f64 {
    PairForces::from(contact).elastic_energy()
}

/// Turns of the ball at which the spall stands before, over and behind the contact.
fn turns() -> impl Iterator<Item = f64> {
    (-20..=20).map(|i| 0.01 * f64::from(i))
}

#[test]
fn invariant_forces_and_moments_over_a_spall_are_the_slopes_of_the_energy() {
    for race in Race::BOTH {
        let places = Places::new(race, "0 s/m");
        let (mut worst, mut turning, mut least, mut most) = ([0.0f64; 2], 0.0f64, f64::INFINITY, 0.0f64);
        for rolled in turns() {
            for side in [0.0, 4e-6, -4e-6] {
                let aside = Vector3::x() * side;
                let turned = Vector3::new(0.0, 0.05, -0.03);
                let here = places.at(rolled, aside, turned);
                (least, most) = (least.min(here.load), most.max(here.load));
                turning = turning.max(here.ball_moment.norm());
                for k in 0..3 {
                    let energy = |offset, small: Vector3<f64>| {
                        let turned = (UnitQuaternion::new(small) * UnitQuaternion::new(turned)).scaled_axis();
                        energy_of(&places.at(rolled, aside + offset, turned))
                    };
                    let by_place = [-1e-9, 1e-9].map(|h| energy(Vector3::ith(k, h), Vector3::zeros()));
                    let by_turn = [-1e-6, 1e-6].map(|h| energy(Vector3::zeros(), Vector3::ith(k, h)));
                    let [force, moment] = [(by_place, 1e-9), (by_turn, 1e-6)]
                        .map(|([before, after], h)| (before - after) / (2.0 * h));
                    worst[0] = worst[0].max((here.force[k] - force).abs());
                    worst[1] = worst[1].max((here.ball_moment[k] - moment).abs());
                }
                // Nothing turns the pair as a whole, and nothing a torus about its own axis.
                let offset = places.motion.position + aside - places.seen.position;
                let whole = here.race_moment + offset.cross(&here.force) + here.ball_moment;
                assert!(whole.norm() < 1e-9, "{whole}");
                assert!(here.race_moment.dot(&places.seen.axis).abs() < 1e-9, "{}", here.race_moment);
            }
        }
        println!(
            "{}: {least:.0} to {most:.0} N, moments to {turning:.2e} N m; off the slopes by {:.1e} N, {:.1e} N m",
            race.name(),
            worst[0],
            worst[1]
        );
        assert!(least < 0.6 * most && turning > 1e-2, "{least} {most} {turning}");
        assert!(worst[0] < 1e-3 * most && worst[1] < 1e-3 * turning, "{worst:?}");
    }
}

#[test]
fn invariant_power_of_forces_and_moments_is_what_energy_and_damping_take() {
    for race in Race::BOTH {
        let places = Places::new(race, "0.5 s/m");
        let mut worst = 0.0f64;
        for rolled in turns() {
            // All bodies move and turn.
            let ball = BallMotion {
                velocity: Vector3::new(0.02, -0.03, 3.0),
                angular_velocity: Vector3::new(-600.0, 150.0, 20.0),
                ..places.motion
            };
            let moved = RaceMotion {
                velocity: Vector3::new(-0.01, 0.02, 0.015),
                angular_velocity: places.seen.axis * 300.0,
                ..places.seen
            };
            let energy = |h: f64| {
                let there = BallMotion { position: ball.position + ball.velocity * h, ..ball };
                let race = RaceMotion { position: moved.position + moved.velocity * h, ..moved };
                energy_of(&places.moving(rolled, ball.angular_velocity * h, &there, &race))
            };
            let h = 1e-9;
            let stored = (energy(h) - energy(-h)) / (2.0 * h);
            let here = places.moving(rolled, Vector3::zeros(), &ball, &moved);
            let given = -here.force.dot(&(ball.velocity - moved.velocity))
                - here.ball_moment.dot(&ball.angular_velocity)
                - here.race_moment.dot(&moved.angular_velocity);
            worst = worst.max((given - stored - here.damping_power).abs() / (stored.abs() + 10.0));
        }
        println!("{}: powers differ by {worst:.1e}", race.name());
        assert!(worst < 1e-3, "{worst:e}");
    }
}

#[test]
fn invariant_lanes_are_single_balls_to_the_bit() {
    // With whole races, and with a spall of each.
    let on_race = |race: &str| {
        format!("[[defect]]\non = \"{race}\"\nazimuth = 1.4\nlength = 1e-3\nwidth = 3e-3\ndepth = 1e-4\n")
    };
    for races in [String::new(), on_race("inner") + &on_race("outer")] {
        let scene = running(0.1, "").source + &races;
        let simulation = Simulation::new(&Scene::parse(&scene).unwrap()).unwrap();
        let orientations = simulation.state().orientations.clone();
        for race in Race::BOTH {
            let contact = simulation.model().contact(race, &Conditions::of_friction(0.08));
            let contact = contact.oriented(orientations.as_ref());
            let seen = simulation.state().race(race).motion();
            let motions: Vec<_> = simulation.state().balls.iter().map(BallState::motion).collect();
            let alone: Vec<_> =
                (0..9).map(|ball| contact.of_ball(ball, None).evaluated(&motions[ball], &seen)).collect();
            assert!(race == Race::Inner || alone[BALL].load < 0.9 * alone[BALL + 2].load);
            for first in [0, 4, 8] {
                let mut together = ContactGroup::filled(&alone[0]);
                let count = 4.min(9 - first);
                together.evaluate(
                    &contact.of_ball(first, None),
                    &seen,
                    &BallMotion::of_balls(&motions[first..first + count]),
                );
                for lane in 0..count {
                    assert_eq!(together.contact(lane), alone[first + lane], "{first} {lane}");
                }
            }
        }
    }
}

#[test]
fn invariant_energy_of_a_ball_that_drops_into_its_spall_closes_in_the_limit_of_small_steps() {
    // With and without friction, without damping: everything that an impact gives is to be found again.
    for creep in ["frictionless", "saturated"] {
        let imbalance = |step: f64| {
            let rest = format!(
                "[effects]\ncreep = \"{creep}\"\ndamping = \"0 s/m\"\n[solver]\nmax_step = {step:e}\n"
            );
            let mut simulation = Simulation::new(&Scene::parse(&text(PI - 0.4, &rest)).unwrap()).unwrap();
            let before = simulation.outputs().stored_energy;
            let spin =
                |simulation: &Simulation| simulation.outputs().balls[BALL].angular_velocity.norm_squared();
            let (mut last, mut exchanged, mut least) = (spin(&simulation), 0.0, f64::INFINITY);
            for i in 1..=400u32 {
                simulation.advance(f64::from(i) * 1e-5).unwrap();
                let now = spin(&simulation);
                exchanged += 0.5 * simulation.model().bearing.ball.inertia * (now - last).abs();
                last = now;
                least = simulation.outputs().balls[BALL].outer.load.min(least);
            }
            let after = simulation.outputs();
            assert!(least < 0.5 * after.balls[BALL + 1].outer.load, "{least}");
            let left = after.stored_energy - before + after.dissipated - after.work - after.stiffened;
            println!("{creep}, {step:.1e} s: {left:.1e} J of {exchanged:.1e} J that the spall gave and took");
            left / exchanged
        };
        let [coarse, fine] = [2e-6, 5e-7].map(imbalance);
        assert!(fine.abs() < 5e-3 && coarse.abs() < 5e-2, "{creep}: {coarse:e} {fine:e}");
        // What is left is that of the steps in time, of second order.
        assert!(coarse.abs() > 8.0 * fine.abs(), "{creep}: {coarse:e} {fine:e}");
    }
}

#[test]
fn a_ball_that_starts_on_its_spall_is_in_balance_there() {
    let force = text(0.0, "[effects]\ncreep = \"saturated\"\ndamping = \"0.5 s/m\"\n")
        .replace("displacement = \"10 um\"", "force = 500");
    let outputs = Simulation::new(&Scene::parse(&force).unwrap()).unwrap().outputs().clone();
    let loads: Vec<f64> = outputs.balls.iter().map(|ball| ball.outer.load).collect();
    assert!(loads[BALL] < 0.2 * loads[BALL + 3], "{loads:?}");
    assert!((outputs.outer.wrench.force.x - 500.0).abs() < 5.0, "{}", outputs.outer.wrench.force.x);
}

#[test]
fn wrong_balls_are_refused_by_key_value_and_range() {
    let given = text(0.0, "");
    for (from, to, parts) in [
        ("ball = 3\n", "ball = 10\n", &["defect[0].ball = 10", "[1, 9]"][..]),
        ("ball = 3\n", "ball = 0\n", &["defect[0].ball = 0"]),
        ("ball = 3\n", "", &["defect[0].ball", "1 to 9"]),
        ("on = \"ball\"", "on = \"inner\"", &["defect[0].ball", "on = \"ball\""]),
    ] {
        assert!(given.contains(from), "{from}");
        let message = Scene::parse(&given.replace(from, to)).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
}
