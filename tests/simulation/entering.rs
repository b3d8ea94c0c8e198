//! Slip under load of balls that enter the load zone: of a bearing that skids, against the velocities of its bodies.

use nalgebra::Vector3;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;

/// A light load on fast balls whose friction is low, and a medium that holds them back: they lose speed outside of the zone. Grooves without slip of their own.
fn scene(changes: &[(&str, &str)]) -> Scene {
    let text = include_str!("../../scenes/radial.toml");
    let base = [
        ("load.inner_speed", "\"12000 rpm\""),
        ("load.y.force", "200.0"),
        ("friction.ball_race", "0.004"),
        ("effects.creep", "\"saturated\""),
        ("effects.heathcote_slip", "false"),
        ("effects.ambient", "{ density = 60.0, viscosity = 2e-5 }"),
    ];
    Scene::edited(text, base.into_iter().chain(changes.iter().copied())).unwrap()
}

/// Outputs every 50 us.
fn outputs(scene: &Scene) -> Vec<Outputs> {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut at = |point: i32| {
        simulation.advance(f64::from(point) * 50e-6).unwrap();
        simulation.outputs().clone()
    };
    (1..=100).map(&mut at).collect()
}

/// [W] the same from positions and angular velocities, of balls that move along their orbit.
fn by_hand(of: &Outputs) -> f64 {
    let radius = 0.5 * 9.525e-3;
    let along = |ball: &roulement::simulation::outputs::BallOutput| {
        let offset = ball.position - of.outer.pose.position;
        Vector3::new(0.0, offset.y, offset.z).normalize()
    };
    let load: Vector3<f64> = of.balls.iter().map(|ball| along(ball) * ball.inner.load).sum();
    let mut most: f64 = 0.0;
    for ball in &of.balls {
        let out = along(ball);
        let round = Vector3::x().cross(&out);
        if round.dot(&load) * ball.orbital_speed <= 0.0 {
            continue;
        }
        let offset = (ball.position - of.outer.pose.position).yz().norm();
        let velocity = round * (ball.orbital_speed * offset);
        for (race, contact, side) in [(&of.inner, &ball.inner, -1.0), (&of.outer, &ball.outer, 1.0)] {
            let arm = out * (side * radius);
            let of_ball = velocity + ball.angular_velocity.cross(&arm);
            let point = ball.position + arm - race.pose.position;
            let of_race = race.twist.velocity + race.twist.angular_velocity.cross(&point);
            let slip = (of_ball - of_race).dot(&round).hypot((of_ball - of_race).x);
            most = most.max(contact.load * slip);
        }
    }
    most
}

#[test]
fn independent_slip_load_is_that_of_the_velocities_of_both_surfaces() {
    let mut largest: f64 = 0.0;
    for of in outputs(&scene(&[])) {
        let by_hand = by_hand(&of);
        // Contacts by hand lie on the radius: no approach, no contact angle, no middle of both surfaces.
        let far = (of.entering_slip_load - by_hand).abs();
        assert!(far <= 0.02 * by_hand.max(0.1), "{} {by_hand} at {}", of.entering_slip_load, of.time);
        largest = largest.max(by_hand);
    }
    assert!(largest > 1.0, "{largest}");
}

#[test]
fn invariant_slip_load_of_a_bearing_that_turns_the_other_way_and_none_under_thrust() {
    let most = |changes: &[(&str, &str)]| {
        outputs(&scene(changes)).iter().map(|of| of.entering_slip_load).fold(0.0, f64::max)
    };
    // Balls stand alike on both sides of the load.
    let (there, back) = (most(&[]), most(&[("load.inner_speed", "\"-12000 rpm\"")]));
    assert!((back / there - 1.0).abs() < 0.02, "{back} {there}");
    for of in outputs(&Scene::parse(include_str!("../../scenes/thrust.toml")).unwrap()) {
        assert_eq!(of.entering_slip_load, 0.0);
    }
}
