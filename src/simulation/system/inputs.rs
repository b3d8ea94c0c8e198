//! Inputs from outside a system: loads of the shafts and their drives, and how they move within a communication step.

use nalgebra::{SVector, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::super::input_paths::FramePath;
use super::super::path::{Motion, MotionPath, Ramp};
use crate::effects::moving_frame::{FrameInputs, FrameMotion, MovingFrame};
use crate::model::state::stack;
use crate::model::structure::Spin;
use crate::numerics::motion::Wrench;
use crate::scene::system::{NamedLoad, SystemScene};
use crate::scene::{Groups, Schedule};
use crate::schema::{GivenMotion, ShaftSection};

/// Inputs of shafts and housings, valid at the last communication point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShaftInputs {
    /// Force \[N] and moment [N m] at every named load, in the order of [`SystemScene::loads`], in the shaft's axes.
    pub loads: Vec<Wrench>,
    /// [N m] torque about +x that the mesh of every gear exerts on its shaft, in the order of [`SystemScene::gears`].
    pub gears: Vec<f64>,
    /// Speed [rad/s] or torque [N m] of every shaft, whichever the scene drives it by.
    pub drives: Vec<f64>,
    /// Turn of every shaft whose flange gives angle and speed; none of others.
    pub flanges: Vec<Option<Motion>>,
    /// Motions that are given at named loads, in the order of [`SystemScene::motions`].
    pub motions: Vec<Motion>,
    /// Motion of the machine's frame, and gravity in it, where that may move.
    pub frame: Option<FrameInputs>,
}

impl ShaftInputs {
    /// Those of the scene's own script at a time \[s].
    pub fn scripted(scene: &SystemScene, time: f64) -> Self {
        let wrench =
            |load: NamedLoad<'_>| Wrench { force: load.force.at(time), moment: load.moment.at(time) };
        let drive = |shaft| drive_of(shaft).map_or(0.0, |drive| drive.at(time));
        let gears = scene.gears().map(|gear| gear.torque.at(time)).collect();
        let drives = scene.shafts.iter().map(drive).collect();
        let frame = scene.frame.as_ref().map(|section| FrameInputs {
            motion: scene.frame_at(time),
            rate: FrameMotion::default(),
            accelerates: section.angular_acceleration.is_some(),
        });
        let motions = scene.motions().map(|(_, given)| motion_at(given, time)).collect();
        let flange = |shaft: &ShaftSection| shaft.flange.then(|| turned(&scripted_spin(shaft, time)));
        let flanges = scene.shafts.iter().map(flange).collect();
        Self { loads: scene.loads().map(wrench).collect(), gears, drives, flanges, motions, frame }
    }

    /// Are these those of the same system?
    pub fn fits(&self, other: &Self) -> bool {
        self.loads.len() == other.loads.len()
            && self.gears.len() == other.gears.len()
            && self.drives.len() == other.drives.len()
            && same_flanges(&self.flanges, &other.flanges)
            && self.motions.len() == other.motions.len()
            && self.frame.is_some() == other.frame.is_some()
    }

    fn components(&self) -> impl Iterator<Item = Vector6<f64>> {
        self.loads.iter().map(|Wrench { force, moment }| stack(force, moment))
    }
}

/// Inputs that the scripts of a system give. A quantity that is no table is not scripted, whatever stands here.
#[derive(Clone, Debug, PartialEq)]
pub struct Played {
    /// Named loads.
    pub loads: Vec<bool>,
    /// Torques of gears.
    pub gears: Vec<bool>,
    /// Speed or torque of every shaft.
    pub drives: Vec<bool>,
    /// Motions that are given at named loads.
    pub motions: Vec<bool>,
    /// Motion of the machine's frame.
    pub frame: bool,
    /// Groups of inputs of every bearing.
    pub bearings: Vec<Groups>,
}

impl Played {
    /// Scripts of a bearing alone.
    pub fn of_bearing(groups: Groups) -> Self {
        Self {
            loads: vec![],
            gears: vec![],
            drives: vec![],
            motions: vec![],
            frame: false,
            bearings: vec![groups],
        }
    }

    /// No script.
    pub fn none(scene: &SystemScene) -> Self {
        Self {
            loads: vec![false; scene.loads().count()],
            gears: vec![false; scene.gears().count()],
            drives: vec![false; scene.shafts.len()],
            motions: vec![false; scene.motions().count()],
            frame: false,
            bearings: vec![Groups::default(); scene.bearings.len()],
        }
    }

    /// All scripts.
    pub fn all(scene: &SystemScene) -> Self {
        Self {
            loads: vec![true; scene.loads().count()],
            gears: vec![true; scene.gears().count()],
            drives: vec![true; scene.shafts.len()],
            motions: vec![true; scene.motions().count()],
            frame: true,
            bearings: vec![Groups::ALL; scene.bearings.len()],
        }
    }
}

/// Have the same shafts flanges that give their turn?
fn same_flanges<A, B>(one: &[Option<A>], other: &[Option<B>]) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(one, other)| one.is_some() == other.is_some())
}

/// A turn as a motion.
fn turned(spin: &Spin) -> Motion {
    Motion { value: spin.angle, rate: spin.speed, acceleration: spin.acceleration }
}

/// A motion as a turn.
pub fn spin_of(motion: &Motion) -> Spin {
    Spin { angle: motion.value, speed: motion.rate, acceleration: motion.acceleration }
}

/// Drive of a shaft.
fn drive_of(shaft: &ShaftSection) -> Option<&Schedule> {
    shaft.speed.as_ref().or(shaft.torque.as_ref())
}

/// Does a table give the speed or the torque of a shaft?
pub fn drive_is_scripted(shaft: &ShaftSection) -> bool {
    drive_of(shaft).is_some_and(Schedule::is_scripted)
}

/// Motion that the scene gives, at a time \[s].
fn motion_at((.., schedule): GivenMotion<'_>, time: f64) -> Motion {
    let (value, rate) = schedule.smooth_at(time);
    Motion { value, rate, acceleration: schedule.smooth_acceleration(time) }
}

/// Turn at a time \[s] of a shaft whose speed the scene gives.
pub fn scripted_spin(shaft: &ShaftSection, time: f64) -> Spin {
    shaft.speed.as_ref().map_or(Spin::default(), |speed| Spin {
        angle: speed.integral(0.0, time),
        speed: speed.at(time),
        acceleration: speed.slope(time),
    })
}

/// Turn of a shaft whose speed goes linearly from one value to another and is held afterwards.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct TurnPath {
    start_time: f64,
    duration: f64,
    angle: f64,
    from: f64,
    to: f64,
}

impl TurnPath {
    /// A steady turn from an angle \[rad] at a speed [rad/s].
    fn steady(start_time: f64, angle: f64, speed: f64) -> Self {
        Self { start_time, duration: 1.0, angle, from: speed, to: speed }
    }

    fn at(&self, time: f64) -> Spin {
        let Self { start_time, duration, angle, from, to } = *self;
        let t = time - start_time;
        if from == to {
            return Spin { angle: angle + to * t, speed: to, acceleration: 0.0 };
        }
        let acceleration = (to - from) / duration;
        if t > duration {
            let reached = angle + 0.5 * (from + to) * duration;
            return Spin { angle: reached + to * (t - duration), speed: to, acceleration: 0.0 };
        }
        let speed = if t == duration { to } else { from + acceleration * t };
        Spin { angle: angle + 0.5 * (from + speed) * t, speed, acceleration }
    }

    /// From where this path is at a time \[s] to a speed after `duration` \[s]; a steady turn just goes on.
    fn towards(&self, time: f64, speed: f64, duration: f64) -> Self {
        if self.from == self.to && self.to == speed {
            return *self;
        }
        let now = self.at(time);
        Self { start_time: time, duration, angle: now.angle, from: now.speed, to: speed }
    }
}

/// Loads and drives of shafts during a communication step: all change linearly, as applied wrenches of a single bearing do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShaftPaths {
    loads: Vec<Ramp<6>>,
    gears: Vec<Ramp<1>>,
    /// Torque of every shaft, where that is given.
    torques: Vec<Ramp<1>>,
    /// Speed of every shaft, where that is given.
    turns: Vec<TurnPath>,
    /// Turn of every shaft whose flange gives it.
    flanges: Vec<Option<MotionPath>>,
    /// Motions that are given at named loads.
    motions: Vec<MotionPath>,
    /// Motion of the machine's frame, where that may move.
    frame: Option<FramePath>,
}

/// Field of inertial forces and gravity on all mass of a machine at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// [m/s2] gravity less the acceleration of the origin of the machine's axes.
    pub acceleration: Vector3<f64>,
    /// The frame about that origin, where it turns.
    pub turning: Option<MovingFrame>,
}

impl ShaftPaths {
    /// Inputs that stay as they are, from a time \[s] and an angle \[rad] of every shaft on.
    pub fn steady(inputs: &ShaftInputs, time: f64, angles: &[f64]) -> Self {
        let turns = angles.iter().zip(&inputs.drives);
        Self {
            loads: inputs.components().map(Ramp::constant).collect(),
            gears: inputs.gears.iter().map(|torque| Ramp::constant(SVector::from([*torque]))).collect(),
            torques: inputs.drives.iter().map(|drive| Ramp::constant(SVector::from([*drive]))).collect(),
            turns: turns.map(|(angle, drive)| TurnPath::steady(time, *angle, *drive)).collect(),
            flanges: inputs
                .flanges
                .iter()
                .map(|turn| turn.as_ref().map(|turn| MotionPath::steady(time, turn)))
                .collect(),
            motions: inputs.motions.iter().map(|motion| MotionPath::steady(time, motion)).collect(),
            frame: inputs.frame.as_ref().map(FramePath::steady),
        }
    }

    /// Paths from here on, over a communication step.
    pub fn towards(&self, inputs: &ShaftInputs, time: f64, duration: f64) -> Self {
        let loads = self.loads.iter().zip(inputs.components());
        let gears = self.gears.iter().zip(&inputs.gears);
        let torques = self.torques.iter().zip(&inputs.drives);
        let turns = self.turns.iter().zip(&inputs.drives);
        let flanges = self.flanges.iter().zip(&inputs.flanges);
        let motions = self.motions.iter().zip(&inputs.motions);
        Self {
            loads: loads.map(|(now, next)| now.towards(time, next, duration)).collect(),
            gears: gears.map(|(now, next)| now.towards(time, SVector::from([*next]), duration)).collect(),
            torques: torques.map(|(now, next)| now.towards(time, SVector::from([*next]), duration)).collect(),
            turns: turns.map(|(now, next)| now.towards(time, *next, duration)).collect(),
            flanges: flanges
                .map(|(now, next)| now.as_ref().zip(next.as_ref()))
                .map(|both| both.map(|(now, next)| now.towards(time, next, duration)))
                .collect(),
            motions: motions.map(|(now, next)| now.towards(time, next, duration)).collect(),
            frame: self.frame.zip(inputs.frame).map(|(now, next)| now.towards(time, &next, duration)),
        }
    }

    /// [N m] torque of a shaft at a time \[s], where that is given.
    pub fn torque(&self, shaft: usize, time: f64) -> f64 {
        self.torques[shaft].at(time)[0]
    }

    /// Do they lead to as many loads and torques?
    pub fn fits(&self, inputs: &ShaftInputs) -> bool {
        self.loads.len() == inputs.loads.len()
            && self.gears.len() == inputs.gears.len()
            && [self.torques.len(), self.turns.len()] == [inputs.drives.len(); 2]
            && same_flanges(&self.flanges, &inputs.flanges)
            && self.motions.len() == inputs.motions.len()
            && self.frame.is_some() == inputs.frame.is_some()
    }
}

/// Loads on a shaft in a communication step: scripts where they are played, else inputs.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a> {
    /// The scene.
    pub scene: &'a SystemScene,
    /// Paths of the inputs.
    pub paths: &'a ShaftPaths,
    /// Inputs that the scripts give instead.
    pub played: &'a Played,
}

impl Given<'_> {
    /// Force \[N] and moment [N m] of a named load at a time \[s].
    pub fn load(&self, index: usize, time: f64) -> Vector6<f64> {
        match self.scene.loads().nth(index) {
            Some(load) if self.plays_load(index) => stack(&load.force.at(time), &load.moment.at(time)),
            _ => self.paths.loads[index].at(time),
        }
    }

    /// [N m] torque of a gear at a time \[s].
    pub fn gear(&self, index: usize, time: f64) -> f64 {
        match self.scene.gears().nth(index) {
            Some(gear) if self.plays_gear(index) => gear.torque.at(time),
            _ => self.paths.gears[index].at(time)[0],
        }
    }

    /// Turn of a shaft at a time \[s], where the speed is given.
    pub fn spin(&self, shaft: usize, time: f64) -> Spin {
        match self.plays_drive(shaft) {
            true => scripted_spin(&self.scene.shafts[shaft], time),
            false => match &self.paths.flanges[shaft] {
                Some(path) => spin_of(&path.at(time)),
                None => self.paths.turns[shaft].at(time),
            },
        }
    }

    /// [N m] torque of a shaft at a time \[s], where that is given.
    pub fn torque(&self, shaft: usize, time: f64) -> f64 {
        match (&self.scene.shafts[shaft].torque, self.plays_drive(shaft)) {
            (Some(torque), true) => torque.at(time),
            _ => self.paths.torque(shaft, time),
        }
    }

    /// Motion that is given at a named load, at a time \[s].
    pub fn motion(&self, index: usize, time: f64) -> Motion {
        match self.scene.motions().nth(index) {
            Some((_, given)) if self.plays_motion(index) => motion_at(given, time),
            _ => self.paths.motions[index].at(time),
        }
    }

    /// Field of gravity and of the motion of the frame at a time \[s].
    pub fn field(&self, time: f64) -> Field {
        let motion = match &self.paths.frame {
            Some(path) if !self.plays_frame() => path.at(time),
            _ => self.scene.frame_at(time),
        };
        let moving = self.scene.frame.as_ref().map(|section| MovingFrame::new(&motion, section.arm()));
        let origin = |frame: MovingFrame| frame.field(&Vector3::zeros(), &Vector3::zeros());
        Field {
            acceleration: motion.gravity + moving.map_or(Vector3::zeros(), origin),
            turning: moving.and_then(|frame| frame.about_origin()),
        }
    }

    /// Is the motion of the frame, and gravity in it, that of its tables?
    pub fn plays_frame(&self) -> bool {
        let SystemScene { frame, gravity, .. } = self.scene;
        self.played.frame && frame.as_ref().is_some_and(|own| own.is_scripted() || gravity.is_scripted())
    }

    /// Is a load that of its table?
    pub fn plays_load(&self, index: usize) -> bool {
        self.played.loads[index] && self.scene.loads().nth(index).is_some_and(|load| load.is_scripted())
    }

    /// Is the torque of a gear that of its table?
    pub fn plays_gear(&self, index: usize) -> bool {
        self.played.gears[index]
            && self.scene.gears().nth(index).is_some_and(|gear| gear.torque.is_scripted())
    }

    /// Is speed or torque of a shaft that of its table?
    pub fn plays_drive(&self, shaft: usize) -> bool {
        self.played.drives[shaft] && drive_is_scripted(&self.scene.shafts[shaft])
    }

    /// Is a given motion that of its table?
    pub fn plays_motion(&self, index: usize) -> bool {
        let scripted = |(_, (.., schedule)): (NamedLoad<'_>, GivenMotion<'_>)| schedule.is_scripted();
        self.played.motions[index] && self.scene.motions().nth(index).is_some_and(scripted)
    }

    /// Inputs and paths where a step ended that led to a time \[s]: those that scripts gave are where these are, and stay so.
    pub fn reached(&self, inputs: &ShaftInputs, time: f64) -> (ShaftInputs, ShaftPaths) {
        let (mut inputs, mut paths) = (inputs.clone(), self.paths.clone());
        let scripted = ShaftInputs::scripted(self.scene, time);
        for (index, ramp) in paths.loads.iter_mut().enumerate() {
            if self.plays_load(index) {
                inputs.loads[index] = scripted.loads[index];
                *ramp = Ramp::constant(self.load(index, time));
            }
        }
        for (index, ramp) in paths.gears.iter_mut().enumerate() {
            if self.plays_gear(index) {
                inputs.gears[index] = scripted.gears[index];
                *ramp = Ramp::constant(SVector::from([scripted.gears[index]]));
            }
        }
        for shaft in (0..self.scene.shafts.len()).filter(|shaft| self.plays_drive(*shaft)) {
            let drive = scripted.drives[shaft];
            inputs.drives[shaft] = drive;
            paths.torques[shaft] = Ramp::constant(SVector::from([drive]));
            paths.turns[shaft] = TurnPath::steady(time, self.spin(shaft, time).angle, drive);
            inputs.flanges[shaft] = scripted.flanges[shaft];
            paths.flanges[shaft] =
                scripted.flanges[shaft].as_ref().map(|turn| MotionPath::steady(time, turn));
        }
        for (index, path) in paths.motions.iter_mut().enumerate() {
            if self.plays_motion(index) {
                inputs.motions[index] = scripted.motions[index];
                *path = MotionPath::steady(time, &scripted.motions[index]);
            }
        }
        if self.plays_frame() {
            inputs.frame = scripted.frame;
            paths.frame = scripted.frame.as_ref().map(FramePath::steady);
        }
        (inputs, paths)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_a_turn_speeds_up_linearly_and_goes_on() {
        let steady = TurnPath::steady(0.0, 0.0, 600.0);
        assert_eq!(steady.towards(0.3, 600.0, 0.1), steady);
        let path = steady.towards(0.25, 700.0, 0.5);
        for (time, angle, speed, acceleration) in [
            (0.25, 150.0, 600.0, 200.0),
            (0.5, 306.25, 650.0, 200.0),
            (0.75, 475.0, 700.0, 200.0),
            (1.75, 1175.0, 700.0, 0.0),
        ] {
            assert_eq!(path.at(time), Spin { angle, speed, acceleration }, "{time}");
        }
        let on = path.towards(0.75, 700.0, 0.5);
        assert_eq!(on.at(1.75), path.at(1.75));
    }
}
