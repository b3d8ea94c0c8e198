//! Gravity on balls, cage, and races that forces move.

use nalgebra::Vector3;

use super::effect::{Effect, Info};
use super::keys::keys;
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::units::Acceleration;

const GRAVITY: Range = Range::closed(-1e6, 1e6, "m/s2");

keys! {
    /// [m/s2] acceleration of gravity, components along x, y, z; 0 is off.
    "gravity" => acceleration: [Acceleration; 3] = [Acceleration(0.0); 3],
}

impl Settings {
    /// [m/s2] acceleration of gravity.
    pub fn vector(&self) -> Vector3<f64> {
        Vector3::from(self.acceleration.map(|component| component.0))
    }
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.gravity",
        adds: "weight of the balls, of the cage, and of races that forces move",
        states: "none",
        source: "body force in the equations of motion; Bovet et al. 2013, section 2",
        price: "0.3 % of a step (thrust case)",
        example: "[effects]\ngravity = [0, -9.81, 0]\n",
    };

    const NUMBERS: &'static [Number<Self>] = &[
        Number::tunable("effects.gravity.x", GRAVITY, "acceleration of gravity along x", |s| {
            Place::Value(Some(&mut s.acceleration[0].0))
        }),
        Number::tunable("effects.gravity.y", GRAVITY, "acceleration of gravity along y", |s| {
            Place::Value(Some(&mut s.acceleration[1].0))
        }),
        Number::tunable("effects.gravity.z", GRAVITY, "acceleration of gravity along z", |s| {
            Place::Value(Some(&mut s.acceleration[2].0))
        }),
    ];

    fn setting(&self) -> Option<String> {
        let components = self.acceleration.map(|component| component.0);
        (components != [0.0; 3]).then(|| format!("{components:?} m/s2"))
    }
}
