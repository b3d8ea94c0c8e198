//! Motion of all inputs during a communication step.

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

use super::inputs::{Inputs, RaceInput};
use super::path::{RacePath, Ramp};
use crate::dynamics::{BodyLoad, Boundary};
use crate::effects::growth::Warmth;
use crate::model::Conditions;
use crate::model::bodies::PerRace;
use crate::model::state::State;
use crate::numerics::motion::{FrameInput, Pose, Wrench};

/// Where a race was when its scripted motion began.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Anchor {
    /// \[s] when.
    pub time: f64,
    /// Its pose then: what no table gives stays so, and its own turn is counted from there.
    pub pose: Pose,
}

/// Paths of all inputs during a communication step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InputPaths {
    /// Pose and twist of races with prescribed motion.
    pub races: PerRace<RacePath>,
    /// Applied force, applied moment, speed.
    loads: PerRace<Ramp<7>>,
    /// Position and tilt of the frame of a race on a hinge.
    frames: PerRace<Ramp<6>>,
    /// Rises of temperature; none where growth is not simulated.
    rises: Option<Ramp<5>>,
    /// Where scripted motions of races began; none where there is no script or it is not played.
    pub anchors: PerRace<Option<Anchor>>,
}

impl InputPaths {
    /// Boundary conditions at a time \[s], with a friction coefficient. Spins of races are left to
    /// [`Boundary::see_spins`].
    pub fn boundary(&self, time: f64, friction: f64) -> Boundary {
        let rises = self.rises.map_or([0.0; 5], |rises| rises.at(time).into());
        let conditions = Conditions { friction, warmth: Warmth { rises, ..Warmth::default() } };
        Boundary {
            time,
            motion: PerRace::new(|race| self.races[race].at(time)),
            loads: PerRace::new(|race| {
                let [fx, fy, fz, mx, my, mz, speed] = self.loads[race].at(time).into();
                let applied = Wrench { force: Vector3::new(fx, fy, fz), moment: Vector3::new(mx, my, mz) };
                let [x, y, z, rx, ry, rz] = self.frames[race].smooth_at(time).into();
                let frame = FrameInput { position: Vector3::new(x, y, z), tilt: Vector3::new(rx, ry, rz) };
                BodyLoad { frame, applied, speed }
            }),
            conditions,
        }
    }

    /// Paths of a state that goes on as it is.
    pub fn steady(inputs: &Inputs, state: &State) -> Self {
        Self {
            races: PerRace::new(|race| {
                RacePath::steady(state.time, &state.race(race).pose, &state.race(race).twist())
            }),
            loads: PerRace::new(|race| Ramp::constant(load_components(&inputs[race]))),
            anchors: PerRace::new(|_| None),
            frames: PerRace::new(|race| Ramp::constant(frame_components(&inputs[race]))),
            rises: inputs.rises.map(|rises| Ramp::constant(rises.into())),
        }
    }

    /// Paths that go on as these end, once a script has moved the state to where it is.
    pub fn after_script(&self, inputs: &Inputs, state: &State) -> Self {
        Self { anchors: self.anchors, ..Self::steady(inputs, state) }
    }

    /// Paths from here on, over a communication step.
    pub fn towards(&self, inputs: &Inputs, time: f64, duration: f64) -> Self {
        Self {
            races: PerRace::new(|race| {
                let (pose, twist) = self.races[race].at(time);
                let input = &inputs[race];
                let target = (&input.pose, &input.twist, &input.twist_rate);
                let path = RacePath::towards(time, (&pose, &twist), target.0, target.1, target.2, duration);
                match &input.axis {
                    Some(axis) => path.with_axis((&pose, &twist), axis, duration),
                    None => path,
                }
            }),
            loads: PerRace::new(|race| {
                self.loads[race].towards(time, load_components(&inputs[race]), duration)
            }),
            anchors: self.anchors,
            frames: PerRace::new(|race| {
                self.frames[race].smooth_towards(time, frame_components(&inputs[race]), duration)
            }),
            rises: self.rises.zip(inputs.rises).map(|(now, next)| now.towards(time, next.into(), duration)),
        }
    }
}

/// Applied force, applied moment and speed as one vector.
fn load_components(input: &RaceInput) -> SVector<f64, 7> {
    let (force, moment) = (input.applied.force, input.applied.moment);
    SVector::from([force.x, force.y, force.z, moment.x, moment.y, moment.z, input.speed])
}

/// Position and tilt of a race's frame as one vector.
fn frame_components(input: &RaceInput) -> SVector<f64, 6> {
    let (position, tilt) = (input.frame.position, input.frame.tilt);
    SVector::from([position.x, position.y, position.z, tilt.x, tilt.y, tilt.z])
}
