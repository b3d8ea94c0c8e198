//! Evaluates one contact many times, for counting instructions: `contact_evaluations LAW HEATHCOTE COUNT`, with HEATHCOTE
//! true or false. See `scripts/measure contact-instructions`.

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use nalgebra::Vector3;
use roulement::contact::{BallMotion, RaceMotion};
use roulement::model::Conditions;
use roulement::model::bodies::Race;
use roulement::numerics::scalar::Dual;
use roulement::scene::Scene;
use roulement::simulation::Simulation;

/// Directions of derivatives that a step uses.
type D = Dual<9>;

fn lift(v: &Vector3<f64>, first: usize) -> Vector3<D> {
    Vector3::from_fn(|k, _| Dual::variable(v[k], first + k, 1.0))
}

fn constant(v: &Vector3<f64>) -> Vector3<D> {
    v.map(|value| Dual { value, derivatives: [0.0; 9] })
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [law, heathcote, count] = &arguments[..] else {
        return Err("usage: contact_evaluations LAW HEATHCOTE COUNT".into());
    };
    // Room for the law `linear`, which ends at mu Q; the contact below has its own coefficient.
    let law = format!("\"{law}\"");
    let effects =
        [("effects.creep", &*law), ("effects.heathcote_slip", heathcote), ("friction.ball_race", "2.0")];
    let scene = Scene::edited(include_str!("../scenes/thrust.toml"), effects)?;
    let simulation = Simulation::new(&scene)?;
    let contact = simulation.model().contact(Race::Inner, &Conditions::of_friction(0.08));
    let (ball, race) = (simulation.state().balls[0].motion(), simulation.state().race(Race::Inner).motion());
    let dual_ball: BallMotion<D> = BallMotion {
        position: lift(&ball.position, 0),
        velocity: lift(&ball.velocity, 3),
        angular_velocity: lift(&ball.angular_velocity, 6),
    };
    let dual_race: RaceMotion<D> = RaceMotion {
        position: constant(&race.position),
        axis: constant(&race.axis),
        across: race.across,
        velocity: constant(&race.velocity),
        angular_velocity: constant(&race.angular_velocity),
    };
    let count: u32 = count.parse()?;
    let begin = Instant::now();
    for _ in 0..count {
        black_box(contact.evaluate(black_box(&ball), black_box(&race)));
    }
    let values = begin.elapsed();
    let begin = Instant::now();
    for _ in 0..count {
        black_box(contact.evaluate(black_box(&dual_ball), black_box(&dual_race)));
    }
    let per = |time: std::time::Duration| time.as_nanos() / u128::from(count.max(1));
    println!("{} {}", per(values), per(begin.elapsed()));
    Ok(())
}
