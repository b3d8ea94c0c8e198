//! Motion of all inputs during a communication step.

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

use super::inputs::{Inputs, RaceInput};
use super::path::{RacePath, Ramp};
use crate::dynamics::{BodyLoad, Boundary};
use crate::effects::growth::Warmth;
use crate::effects::moving_frame::{FrameInputs, FrameMotion};
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
    /// Motion of the bearing's frame, and gravity.
    frame: FramePath,
    /// Where scripted motions of races began; none where there is no script or it is not played.
    pub anchors: PerRace<Option<Anchor>>,
}

impl InputPaths {
    /// Boundary conditions at a time \[s], with friction and lubrication of the inputs. Spins of races are left to
    /// [`Boundary::see_spins`], damaged balls to [`Boundary::turn_balls`].
    pub fn boundary(&self, time: f64, inputs: &Inputs) -> Boundary {
        let rises = self.rises.map_or([0.0; 5], |rises| rises.at(time).into());
        let conditions = Conditions {
            friction: inputs.friction,
            warmth: Warmth { rises, ..Warmth::default() },
            lubrication: inputs.effects.lubrication,
        };
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
            frame: self.frame.at(time),
            orientations: None,
        }
    }

    /// Takes another motion of the bearing's frame from now on.
    pub fn set_frame(&mut self, inputs: &Inputs) {
        self.frame = FramePath::steady(&inputs.effects.frame);
    }

    /// Paths of a state that goes on as it is.
    pub fn steady(inputs: &Inputs, state: &State) -> Self {
        Self {
            races: PerRace::new(|race| {
                let (pose, twist) = state.given_motion(race);
                RacePath::steady(state.time, &pose, &twist)
            }),
            loads: PerRace::new(|race| Ramp::constant(load_components(&inputs[race]))),
            anchors: PerRace::new(|_| None),
            frame: FramePath::steady(&inputs.effects.frame),
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
            frame: self.frame.towards(time, &inputs.effects.frame, duration),
            frames: PerRace::new(|race| {
                self.frames[race].smooth_towards(time, frame_components(&inputs[race]), duration)
            }),
            rises: self.rises.zip(inputs.rises).map(|(now, next)| now.towards(time, next.into(), duration)),
        }
    }
}

/// Motion of the frame of a bearing or a machine during a communication step: all components change linearly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FramePath {
    components: Ramp<12>,
    /// Is the angular acceleration that by which the angular velocity changes?
    derived: bool,
}

impl FramePath {
    /// A motion that stays as it is.
    pub fn steady(inputs: &FrameInputs) -> Self {
        Self { components: Ramp::constant(inputs.motion.components()), derived: false }
    }

    /// From where this path is at a time \[s] to the inputs after `duration` \[s].
    pub fn towards(&self, time: f64, inputs: &FrameInputs, duration: f64) -> Self {
        let target = inputs.motion.components() + inputs.rate.components() * duration;
        Self { components: self.components.towards(time, target, duration), derived: !inputs.accelerates }
    }

    /// Motion at a time \[s].
    pub fn at(&self, time: f64) -> FrameMotion {
        let motion = FrameMotion::of_components(&self.components.at(time));
        match self.derived {
            true => FrameMotion {
                angular_acceleration: FrameMotion::of_components(&self.components.slope()).angular_velocity,
                ..motion
            },
            false => motion,
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
