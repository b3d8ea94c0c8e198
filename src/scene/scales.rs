//! Scales of a bearing in its scene: what the most loaded ball carries, how far that presses it into the races, and how fast it
//! then swings between them. Steps of the time integration follow them where nothing else is said.
//!
//! They are estimates from the scene alone, before there is a model: textbook shares of the load (Stribeck's factor of 5 for
//! radial loads, 4 for tilting moments), good to a factor of two.

use std::f64::consts::{PI, TAU};

use super::{Condition, Drive, Scene, Schedule};
use crate::contact::hertz::HertzContact;
use crate::effects::frame::FrameSection;
use crate::schema::Race;

/// [-] approach of unloaded balls over their diameter: a bearing that carries next to nothing.
const LEAST_APPROACH: f64 = 1e-5;
/// \[rad] contact angle that balls of a bearing with clearance have at least under thrust.
const LEAST_ANGLE: f64 = 0.2;

/// Scales of a bearing in its scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// [-] elastic approach of the most loaded ball and a race over the ball diameter.
    pub approach: f64,
    /// \[Hz] natural frequency of that ball between its races.
    pub frequency: f64,
}

impl Scales {
    /// Scales of a scene. Numbers that are out of range give numbers without a meaning, and no panic.
    pub fn of(scene: &Scene) -> Self {
        let section = &scene.bearing;
        let (diameter, pitch) = (section.ball_diameter.0, section.pitch_diameter.0);
        let mass = scene.ball.density.0 * PI / 6.0 * diameter.powi(3);
        let angle = match section.contact_angle {
            Some(angle) => angle.0,
            None => {
                let clearance = section.diametral_clearance.map_or(0.0, |clearance| clearance.0);
                let centres = (section.inner_conformity + section.outer_conformity - 1.0) * diameter;
                (1.0 - 0.5 * clearance / centres).clamp(0.0, 1.0).acos()
            }
        };
        let [thrust, radial, tilt, pressed] = loads(scene);
        let (sin, cos) = (angle.max(LEAST_ANGLE).sin(), angle.cos().max(LEAST_ANGLE.sin()));
        let balls = section.balls as f64;
        let orbit = 0.5 * (largest(&scene.load.inner_speed) + largest(&scene.load.outer_speed));
        let load = thrust / (balls * sin)
            + 5.0 * radial / (balls * cos)
            + 4.0 * tilt / (balls * 0.5 * pitch * sin)
            + mass * orbit * orbit * 0.5 * pitch;
        let interference = section.diametral_clearance.map_or(0.0, |clearance| -0.5 * clearance.0).max(0.0);

        let contact = {
            let inner = 0.5 * (pitch - diameter * angle.cos());
            let compliance: f64 = [&scene.ball, &scene.race]
                .map(|material| {
                    (1.0 - material.poisson_ratio * material.poisson_ratio) / material.youngs_modulus.0
                })
                .iter()
                .sum();
            let along = 2.0 / diameter + 1.0 / inner.max(0.1 * diameter);
            HertzContact::new(along, (2.0 - 1.0 / section.inner_conformity) / diameter, compliance)
        };
        // Both races share what presses them together.
        let approach = (load / contact.stiffness)
            .powf(2.0 / 3.0)
            .max(0.5 * pressed.max(interference))
            .max(LEAST_APPROACH * diameter);
        let spring = 2.0 * 1.5 * contact.stiffness * approach.sqrt();
        Self { approach: approach / diameter, frequency: (spring / mass).sqrt() / TAU }
    }
}

/// Largest size of a number over time.
fn largest(schedule: &Schedule) -> f64 {
    schedule.values().into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// \[N], \[N], [N m], \[m] largest thrust, radial load and tilting moment on a race, and displacement along the contacts where
/// a race is held.
fn loads(scene: &Scene) -> [f64; 4] {
    let arms = [1.0, 1.0, 1.0, 0.5 * scene.bearing.pitch_diameter.0, 0.5 * scene.bearing.pitch_diameter.0];
    let mut pressed = 0.0f64;
    let mut loads = [0.0; 5];
    for of_race in [scene.load.of_inner(), scene.load.of_outer()] {
        for ((direction, arm), load) in of_race.iter().zip(arms).zip(&mut loads) {
            match direction.condition() {
                Condition::Load(schedule) => *load += largest(&schedule),
                Condition::Motion(schedule) => pressed = pressed.max(arm * largest(&schedule)),
            }
        }
    }
    let moved = [&scene.inner, &scene.outer].into_iter().find(|race| race.drive == Drive::Wrench);
    let weight = moved.and_then(|race| race.mass).map_or(0.0, |mass| mass.0);
    let [gx, gy, gz] = scene.effects.gravity.acceleration.0.each_ref().map(largest);
    // In which direction a moving frame presses a race is not looked at.
    let moving = scene.effects.frame.section.as_ref().map_or(0.0, FrameSection::largest_acceleration);
    let machine = Race::loaded(scene).machine(scene).map_or([0.0; 3], |machine| machine.largest());
    [
        loads[0] + weight * gx + machine[0],
        (loads[1] + weight * (gy + moving)).hypot(loads[2] + weight * gz) + machine[1],
        loads[3].hypot(loads[4]) + machine[2],
        pressed,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const THRUST: &str = include_str!("../../scenes/thrust.toml");

    fn scales(changes: &[(&str, &str)]) -> Scales {
        Scales::of(&Scene::edited(THRUST, changes.iter().copied()).unwrap())
    }

    #[test]
    fn closed_form_scales_follow_size_and_load() {
        let usual = scales(&[]);
        // The bounce of its balls is at 37 kHz (scenes/thrust.toml), the approach some microns.
        assert!((usual.frequency / 37e3 - 1.0).abs() < 0.3, "{usual:?}");
        assert!(usual.approach > 3e-4 && usual.approach < 2e-3, "{usual:?}");
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
        // Loads on the outer race count alike.
        let turned_round = scales(&[
            ("inner.drive", "\"fixed\""),
            ("load.x", ""),
            ("outer", "{ drive = \"wrench\", mass = 0.2, inertia = [6e-5, 4e-5, 4e-5] }"),
            ("load.outer", "{ x = { force = -1500.0 } }"),
        ]);
        assert_eq!(turned_round, usual);
        // At rest: approach as load^(2/3), frequency as load^(1/6).
        let rest = ("load.inner_speed", "0.0");
        let (one, eight) = (scales(&[rest]), scales(&[rest, ("load.x.force", "12e3")]));
        close(eight.approach, 4.0 * one.approach);
        close(eight.frequency, 8f64.powf(1.0 / 6.0) * one.frequency);
        // A tenth of the size at the same pressure: the same shape, ten times as fast.
        let small = scales(&[
            rest,
            ("bearing.ball_diameter", "0.9525e-3"),
            ("bearing.pitch_diameter", "4.6e-3"),
            ("load.x.force", "15.0"),
        ]);
        close(small.approach, one.approach);
        close(small.frequency, 10.0 * one.frequency);
    }

    #[test]
    fn scales_are_numbers_whatever_the_load() {
        for change in [
            ("load.x.force", "0.0"),
            ("load.x", "{ displacement = 2e-5 }"),
            ("load.y.force", "[[0, 0], [1, 1e8]]"),
        ] {
            let Scales { approach, frequency } = scales(&[change]);
            assert!(approach >= LEAST_APPROACH && frequency > 1e3 && frequency.is_finite(), "{change:?}");
        }
    }
}
