//! The scene's own script: what its tables say at a time, and which inputs they give in a step.
//!
//! A quantity whose schedule is no constant is evaluated where an internal step ends, and internal steps end where it has a kink.
//! A constant is no script: it is an input that stays as it is.

use nalgebra::{UnitQuaternion, Vector3};

use super::input_paths::{Anchor, InputPaths};
use super::inputs::{Inputs, RaceInput};
use super::orientation::tilt_of;
use crate::dynamics::Boundary;
use crate::effects::frame::FrameSection;
use crate::model::bodies::{PerRace, Race};
use crate::numerics::motion::{FrameInput, Pose, Twist, Wrench};
use crate::numerics::tilt;
use crate::scene::{Drive, Group, Groups, Machine, RaceSection, Scene, Schedule};

/// Inputs that the script of a scene gives in a step.
#[derive(Clone, Copy, Debug)]
pub struct Script {
    /// Wrenches on races that forces move.
    loads: PerRace<bool>,
    friction: bool,
    lubrication: bool,
    /// Temperatures of all parts, some of them by tables.
    temperatures: bool,
    /// Motion of the bearing's frame, and gravity.
    frame: bool,
    /// Speeds of races that forces move.
    speeds: PerRace<bool>,
    /// Motions of races that forces do not move.
    pub motions: PerRace<bool>,
    /// Does any of it swing?
    swings: bool,
}

/// Section and scripted speed of a race.
fn of_race(scene: &Scene, race: Race) -> (&RaceSection, &Schedule) {
    let speed = match race {
        Race::Inner => &scene.load.inner_speed,
        Race::Outer => &scene.load.outer_speed,
    };
    (race.section(scene), speed)
}

/// Applied forces and moments, in the order x, y, z, ry, rz; none where a direction is free or held.
fn load_schedules(scene: &Scene, race: Race) -> [Option<&Schedule>; 5] {
    race.directions(scene).map(|direction| direction.load)
}

/// Displacements and rotations, in the same order.
fn held_schedules(scene: &Scene, race: Race) -> [Option<&Schedule>; 5] {
    race.directions(scene).map(|direction| direction.motion)
}

/// Displacements and tilts, in the order x, y, z, ry, rz, that the scene gives a race without a body.
fn motion_schedules(scene: &Scene, race: Race) -> [Option<&Schedule>; 5] {
    let section = of_race(scene, race).0;
    match (race, section.drive) {
        (Race::Inner, Drive::Pose) => held_schedules(scene, race),
        (Race::Outer, Drive::Fixed | Drive::Pose) => {
            let misalignment = &section.misalignment;
            let [ry, rz] =
                [&misalignment.ry, &misalignment.rz].map(|tilt| Some(tilt).filter(|tilt| tilt.is_scripted()));
            [None, None, None, ry, rz]
        }
        _ => [None; 5],
    }
}

/// Does a table move this race, one without a body?
fn moves(scene: &Scene, race: Race) -> bool {
    let tables = motion_schedules(scene, race).into_iter().flatten().any(Schedule::is_scripted);
    tables || of_race(scene, race).1.is_scripted()
}

/// Does a table give the motion of the bearing's frame, or gravity in it?
fn has_scripted_frame(scene: &Scene) -> bool {
    let moves = scene.effects.frame.section.as_ref().is_some_and(FrameSection::is_scripted);
    moves || scene.effects.gravity.acceleration.is_scripted()
}

/// Does anything in a scene change by itself with time?
pub fn follows_time(scene: &Scene) -> bool {
    if has_scripted_frame(scene) {
        return true;
    }
    let load = &scene.load;
    let misalignment =
        [&scene.inner, &scene.outer].map(|race| [&race.misalignment.ry, &race.misalignment.rz]);
    let always = [&load.inner_speed, &load.outer_speed, &scene.friction.ball_race];
    let given = |race| load_schedules(scene, race).into_iter().chain(held_schedules(scene, race)).flatten();
    Race::BOTH
        .into_iter()
        .flat_map(given)
        .chain(always)
        .chain(misalignment.into_iter().flatten())
        .any(Schedule::is_scripted)
        || Race::loaded(scene).machine(scene).is_some_and(|machine| machine.follows_time())
        || scene.effects.growth.follows_time()
        || is_lubrication_scripted(scene)
}

/// Does a table give the degree of lubrication?
fn is_lubrication_scripted(scene: &Scene) -> bool {
    scene.effects.film.schedule().is_some_and(Schedule::is_scripted)
}

/// Groups of inputs for which a scene has a script; what has no input in a package, such as the speed of a race on a
/// hinge, is in none.
pub fn scripted_groups(scene: &Scene) -> Groups {
    let race = |race: Race| {
        let (section, speed) = of_race(scene, race);
        (
            section.drive == Drive::Pose && moves(scene, race),
            section.drive == Drive::Wrench && speed.is_scripted(),
        )
    };
    let [inner, outer] = Race::BOTH.map(race);
    Groups::default()
        .with(Group::Loads, Race::BOTH.into_iter().any(|race| has_scripted_load(scene, race)))
        .with(Group::Speeds, inner.1 || outer.1)
        .with(Group::Tilts, inner.0 || outer.0)
        .with(Group::Friction, scene.friction.ball_race.is_scripted())
        .with(Group::Lubrication, is_lubrication_scripted(scene))
        .with(Group::Temperatures, scene.effects.growth.follows_time())
        .with(Group::Frame, scene.effects.frame.section.is_some() && has_scripted_frame(scene))
}

/// Does a table give the wrench on this race?
fn has_scripted_load(scene: &Scene, race: Race) -> bool {
    let scripts = load_schedules(scene, race).into_iter().flatten().any(Schedule::is_scripted);
    let machine = race.machine(scene).is_some_and(|machine| machine.follows_time());
    (scripts || machine) && race.section(scene).drive == Drive::Wrench
}

impl Script {
    /// Inputs that the script gives where it may give these groups. A race that is fixed in its frame or hinged to it
    /// has no inputs: the script moves it anyway.
    pub fn new(scene: &Scene, groups: Groups) -> Self {
        let given = |group| groups.contains(group) && scripted_groups(scene).contains(group);
        let speed = |race| {
            let (section, speed) = of_race(scene, race);
            let played = section.drive == Drive::Hinge
                || section.drive == Drive::Wrench && groups.contains(Group::Speeds);
            played && speed.is_scripted()
        };
        let motion = |race| {
            let section = of_race(scene, race).0;
            let played = section.drive == Drive::Fixed
                || section.drive == Drive::Pose && groups.contains(Group::Tilts);
            played && moves(scene, race)
        };
        let mut script = Self {
            loads: PerRace::new(|race| groups.contains(Group::Loads) && has_scripted_load(scene, race)),
            friction: given(Group::Friction),
            lubrication: given(Group::Lubrication),
            temperatures: given(Group::Temperatures),
            // Gravity over time is no input where the frame does not move.
            frame: match scene.effects.frame.section {
                Some(_) => given(Group::Frame),
                None => has_scripted_frame(scene),
            },
            speeds: PerRace::new(speed),
            motions: PerRace::new(motion),
            swings: false,
        };
        let machine = |race: Race| script.loads[race] && race.machine(scene).is_some();
        script.swings =
            script.playing(scene).into_iter().any(Schedule::swings) || Race::BOTH.into_iter().any(machine);
        script
    }

    /// Does it give anything that an importer could have given, or a motion of a race without a body?
    pub fn gives_inputs(&self) -> bool {
        let of_race = |race: Race| self.loads[race] || self.speeds[race] || self.motions[race];
        self.friction
            || self.lubrication
            || self.temperatures
            || self.frame
            || Race::BOTH.into_iter().any(of_race)
    }

    /// \[s] shortest period in which something that it gives swings at a time \[s]; none where nothing does.
    pub fn shortest_period(&self, scene: &Scene, time: f64) -> Option<f64> {
        if !self.swings {
            return None;
        }
        let machine = Race::BOTH
            .into_iter()
            .filter(|race| self.loads[*race])
            .filter_map(|race| race.machine(scene).and_then(|machine| machine.shortest_period(time)));
        let playing = self.playing(scene);
        playing.into_iter().filter_map(|of| of.shortest_period(time)).chain(machine).reduce(f64::min)
    }

    /// Schedules that it follows.
    fn playing<'a>(&self, scene: &'a Scene) -> Vec<&'a Schedule> {
        let mut playing: Vec<&Schedule> = vec![];
        if self.friction {
            playing.push(&scene.friction.ball_race);
        }
        if self.lubrication {
            playing.extend(scene.effects.film.schedule());
        }
        if self.temperatures {
            playing.extend(scene.effects.growth.schedules().into_iter().flatten());
        }
        if self.frame {
            playing.extend(&scene.effects.gravity.acceleration.0);
            if let Some(frame) = &scene.effects.frame.section {
                playing.extend(frame.schedules());
            }
        }
        for race in Race::BOTH {
            let (section, speed) = of_race(scene, race);
            if self.loads[race] {
                playing.extend(load_schedules(scene, race).into_iter().flatten());
                playing.extend(race.machine(scene).into_iter().flat_map(Machine::schedules));
            }
            if self.speeds[race] || self.motions[race] {
                playing.push(speed);
            }
            if self.motions[race] {
                playing.extend(motion_schedules(scene, race).into_iter().flatten());
            }
            // Tables of constraints are played by the body itself.
            match section.drive {
                Drive::Wrench => playing.extend(held_schedules(scene, race).into_iter().flatten()),
                Drive::Hinge => playing.extend([&section.misalignment.ry, &section.misalignment.rz]),
                Drive::Fixed | Drive::Pose => {}
            }
        }
        playing
    }

    /// Does any schedule come to other values within a span \[s] of time?
    pub fn changes_within(&self, scene: &Scene, from: f64, to: f64) -> bool {
        self.playing(scene).into_iter().any(|schedule| schedule.changes_within(from, to))
    }

    /// \[s] times within a step at which a schedule has a kink.
    pub fn knots(&self, scene: &Scene, from: f64, to: f64) -> Vec<f64> {
        self.playing(scene).into_iter().flat_map(|schedule| schedule.knots(from, to)).collect()
    }

    /// Marks where scripted motions begin, and ends those that are none any more.
    pub fn begin(&self, paths: &mut InputPaths, time: f64) {
        for race in Race::BOTH {
            let pose = paths.races[race].at(time).0;
            let anchor = &mut paths.anchors[race];
            *anchor = self.motions[race].then(|| anchor.unwrap_or(Anchor { time, pose }));
        }
    }

    /// Puts what the script gives at the end of a step into its boundary conditions.
    pub fn impose(&self, scene: &Scene, paths: &InputPaths, boundary: &mut Boundary) {
        let time = boundary.time;
        for race in Race::BOTH {
            if let Some(anchor) = &paths.anchors[race] {
                boundary.motion[race] = motion(scene, race, anchor, time);
            }
            if self.speeds[race] {
                boundary.loads[race].speed = of_race(scene, race).1.at(time);
            }
            if self.loads[race] {
                boundary.loads[race].applied = applied(scene, race, time);
            }
        }
        if self.friction {
            boundary.conditions.friction = scene.friction.ball_race.at(time);
        }
        if self.lubrication {
            boundary.conditions.lubrication = scene.effects.film.lubrication(time);
        }
        if let (true, Some(rises)) = (self.temperatures, scene.effects.growth.rises(time)) {
            boundary.conditions.warmth.rises = rises;
        }
        if self.frame {
            boundary.frame = scene.frame_at(time);
        }
    }

    /// Puts what the script gives at a time \[s] into the inputs.
    pub fn set_inputs(&self, scene: &Scene, paths: &InputPaths, time: f64, inputs: &mut Inputs) {
        for race in Race::BOTH {
            let speed = of_race(scene, race).1;
            if let Some(anchor) = &paths.anchors[race] {
                let (pose, twist) = motion(scene, race, anchor, time);
                let speed = speed.at(time);
                inputs[race] = RaceInput { pose, twist, speed, axis: None, ..inputs[race] };
            }
            if self.speeds[race] {
                inputs[race].speed = speed.at(time);
            }
            if self.loads[race] {
                inputs[race].applied = applied(scene, race, time);
            }
        }
        if self.friction {
            inputs.friction = scene.friction.ball_race.at(time);
        }
        if self.lubrication {
            inputs.effects.lubrication = scene.effects.film.lubrication(time);
        }
        if self.temperatures {
            inputs.rises = scene.effects.growth.rises(time);
        }
        if self.frame {
            inputs.effects.frame.motion = scene.frame_at(time);
        }
    }
}

/// External wrench on a race at a time \[s].
pub fn applied(scene: &Scene, race: Race, time: f64) -> Wrench {
    let [x, y, z, ry, rz] = race.load_at(scene, time);
    Wrench { force: Vector3::new(x, y, z), moment: Vector3::new(0.0, ry, rz) }
}

/// Displacement and tilt of a race with their rates.
struct Imposed {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    tilt: Vector3<f64>,
    tilt_rate: Vector3<f64>,
}

impl Imposed {
    /// Those of the tables at a time \[s]; what no table gives rests at that of `pose`.
    fn at(scene: &Scene, race: Race, time: f64, pose: &Pose) -> Self {
        let (position, tilt) = (pose.position, tilt_of(pose));
        let mut imposed = Self { position, velocity: Vector3::zeros(), tilt, tilt_rate: Vector3::zeros() };
        for (direction, schedule) in motion_schedules(scene, race).into_iter().enumerate() {
            let Some((value, rate)) = schedule.map(|schedule| schedule.smooth_at(time)) else {
                continue;
            };
            if direction < 3 {
                (imposed.position[direction], imposed.velocity[direction]) = (value, rate);
            } else {
                (imposed.tilt[direction - 2], imposed.tilt_rate[direction - 2]) = (value, rate);
            }
        }
        imposed
    }
}

/// Pose and twist of a race at a time \[s] of its scripted motion: displaced and tilted as the tables say, turned about
/// its own axis by the integral of its speed.
fn motion(scene: &Scene, race: Race, anchor: &Anchor, time: f64) -> (Pose, Twist) {
    let speed = of_race(scene, race).1;
    let Imposed { position, velocity, tilt, tilt_rate } = Imposed::at(scene, race, time, &anchor.pose);
    let tilted = UnitQuaternion::new(tilt);
    // What is left of the orientation beyond its tilt is the turn about the race's own axis.
    let turned = UnitQuaternion::new(tilt_of(&anchor.pose)).inverse() * anchor.pose.orientation;
    let turn = UnitQuaternion::new(Vector3::x() * speed.integral(anchor.time, time));
    let orientation = UnitQuaternion::new_normalize((tilted * turn * turned).into_inner());
    let angular_velocity =
        tilt::angular_velocity(&tilt, &Vector3::new(speed.at(time), tilt_rate.y, tilt_rate.z));
    (Pose { position, orientation }, Twist { velocity, angular_velocity })
}

/// Pose at a time \[s] of a race on a hinge, whose frame is somewhere.
pub fn hinge(section: &RaceSection, frame: &FrameInput, time: f64) -> Pose {
    let [ry, rz] = [&section.misalignment.ry, &section.misalignment.rz].map(|tilt| tilt.smooth_at(time).0);
    let tilt = Vector3::new(0.0, ry, rz) + frame.tilt;
    Pose { position: frame.position, orientation: UnitQuaternion::new(tilt) }
}

/// Sets the pose and twist of a race from the scene's script at a time \[s], as an importer does that reads the script at
/// its communication points. `now` is where the race is: its turn about its own axis goes on from there.
pub fn script_motion(scene: &Scene, race: Race, time: f64, now: &Pose, input: &mut RaceInput) {
    let speed = input.speed;
    let Imposed { position, velocity, tilt, tilt_rate } = Imposed::at(scene, race, time, &input.pose);
    let tilted = UnitQuaternion::new(tilt);
    let turned = UnitQuaternion::new(tilt_of(now)).inverse() * now.orientation;
    let orientation = UnitQuaternion::new_normalize((tilted * turned).into_inner());
    input.pose = Pose { position, orientation };
    let angular_velocity = tilt::angular_velocity(&tilt, &Vector3::new(speed, tilt_rate.y, tilt_rate.z));
    input.twist = Twist { velocity, angular_velocity };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_scripted_twist_is_the_rate_of_the_scripted_pose() {
        let scene = Scene::edited(
            include_str!("../../scenes/misalignment.toml"),
            [
                ("load.ry.rotation", "[[0, 0], [\"2 ms\", 0.15], [\"5 ms\", -0.1]]"),
                ("load.rz.rotation", "[[0, 0.1], [\"3 ms\", -0.05]]"),
                ("load.y.displacement", "[[0, 0], [\"4 ms\", 1e-5]]"),
                ("load.inner_speed", "[[0, 100], [\"1 ms\", 700], [\"4 ms\", 200]]"),
            ],
        )
        .unwrap_or_else(|why| panic!("{why}"));
        let pose = Pose {
            position: Vector3::new(1e-5, 0.0, 2e-5),
            orientation: UnitQuaternion::new(Vector3::new(0.0, 0.0, 0.1))
                * UnitQuaternion::new(Vector3::x() * 0.7),
        };
        let anchor = Anchor { time: 0.0, pose };
        let d = 1e-8;
        for time in [3e-4, 1.3e-3, 2.4e-3, 4.6e-3, 6e-3] {
            let [(before, _), (_, twist), (after, _)] =
                [time - d, time, time + d].map(|time| motion(&scene, Race::Inner, &anchor, time));
            let turn = (after.orientation * before.orientation.inverse()).scaled_axis() / (2.0 * d);
            assert!((turn - twist.angular_velocity).norm() < 1e-5 * turn.norm(), "{time}: {turn} {twist:?}");
            let velocity = (after.position - before.position) / (2.0 * d);
            assert!((velocity - twist.velocity).norm() < 1e-9);
            // x is free to stay where it was, z is held at 0.
            assert_eq!((after.position.x, after.position.z), (1e-5, 0.0));
        }
        let (start, _) = motion(&scene, Race::Inner, &anchor, 0.0);
        assert!(start.orientation.angle_to(&pose.orientation) < 1e-15);
    }
}
