//! Gravity on balls, cage, and races that forces move.

use nalgebra::Vector3;

use super::Effects;
use super::effect::{Effect, Info};
use super::estimate::Estimate;
use super::keys::keys;
use super::twin::Twin;
use crate::schema::Components;
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::units::Acceleration;

/// [`Twin::unsettled`]: over 300 scenes of two seeds (cli/tests/studies/effect_verdicts.rs).
const UNSETTLED: &str = "without vibration, by which it changed the largest load in runs by up to 5.9 %";

/// Allowed components.
pub const GRAVITY: Range = Range::closed(-1e6, 1e6, "m/s2");

/// [m/s2] standard gravity.
const STANDARD: f64 = 9.80665;
const KEY: &str = "effects.gravity";

keys! {
    /// [m/s2] acceleration of gravity, components along x, y, z, each constant or a table; 0 is off.
    "gravity" => acceleration: Components<Acceleration> = Components::default(),
    ;
    /// Is it an input of a package, and no parameter? With a frame that moves.
    is_input: bool = false,
}

impl Settings {
    /// [m/s2] acceleration of gravity at a time \[s].
    pub fn at(&self, time: f64) -> Vector3<f64> {
        self.acceleration.at(time)
    }
}

fn is_parameter(settings: &Settings) -> bool {
    !settings.is_input
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: KEY,
        adds: "weight of the balls, of the cage, and of races that forces move",
        states: "none",
        source: "body force in the equations of motion; Bovet et al. 2013, section 2",
        price: "0.2 % of a step (thrust case)",
        example: "[effects]\ngravity = [0, -9.81, 0]\n",
    };
    const ESTIMATE: &'static str =
        "settled states with and without it; 9.81 m/s2 along each axis where it is off";

    const NUMBERS: &'static [Number<Self>] = &[
        Number::tunable_if(
            "effects.gravity.x",
            GRAVITY,
            "acceleration of gravity along x",
            is_parameter,
            |s| Place::Schedule(&mut s.acceleration.0[0]),
        ),
        Number::tunable_if(
            "effects.gravity.y",
            GRAVITY,
            "acceleration of gravity along y",
            is_parameter,
            |s| Place::Schedule(&mut s.acceleration.0[1]),
        ),
        Number::tunable_if(
            "effects.gravity.z",
            GRAVITY,
            "acceleration of gravity along z",
            is_parameter,
            |s| Place::Schedule(&mut s.acceleration.0[2]),
        ),
    ];

    fn twins(&self, estimate: &Estimate) -> Vec<Twin> {
        let on = self.acceleration.largest() != 0.0;
        let to = |components: [f64; 3]| {
            move |effects: &mut Effects| {
                effects.gravity.acceleration = components.into();
            }
        };
        let twin = match on {
            true => Twin::new(KEY, "gravity", on, to([0.0; 3])),
            false => {
                let [x, y, z] = [[-STANDARD, 0.0, 0.0], [0.0, -STANDARD, 0.0], [0.0, 0.0, -STANDARD]];
                Twin::new(KEY, "gravity", on, to(x))
                    .or(to(y))
                    .or(to(z))
                    .named(&["-x", "-y", "-z"])
                    .taken_as("9.81 m/s2 along one of the axes")
            }
        };
        // In runs it changed the life of deep-groove bearings under radial loads by 3 %, and the settled state by 0.1 %.
        let unheld = estimate.spacing.unheld;
        let falls =
            if unheld { "; and balls that no load holds fall, which has no part in this" } else { "" };
        let twin = Twin { always_matters: unheld, unsettled: Some(UNSETTLED), ..twin.remarked(falls) };
        vec![twin.written("[effects] gravity = [0, -9.81, 0]; its direction is not known here")]
    }

    fn setting(&self) -> Option<String> {
        let acceleration = &self.acceleration;
        let [x, y, z] = self.at(0.0).into();
        let over_time = if acceleration.is_scripted() { " at the start, then by a script" } else { "" };
        (acceleration.largest() != 0.0).then(|| format!("{:?} m/s2{over_time}", [x, y, z]))
    }
}
