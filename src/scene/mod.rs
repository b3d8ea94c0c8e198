//! The scene file: one bearing, its load, and what is to be simulated.
//!
//! A scene is TOML; every number is SI or text with a unit ([`crate::scene::units`]). Unknown keys, missing keys and values
//! out of range are errors that name the key, the value and the allowed range.

mod edit;
pub mod machine;
mod notes;
mod numbers;
mod race;
pub mod ranges;
mod scales;
pub mod system;
mod typical;
mod validate;

use std::path::Path;

use serde::Deserialize;

use crate::effects;
pub use crate::effects::Effects;
pub use crate::effects::cage::{CageSection, Guidance};
pub use crate::effects::creep::{CreepLaw, Regularised};
use crate::effects::defects::DefectSection;
use crate::effects::form::FormSection;
pub use crate::effects::moving_frame::FrameMotion;
use crate::effects::{film, growth, rating};
pub use crate::schema::{
    Accuracy, BearingSection, Components, Condition, Dependencies, Direction, Drive, DutySection, ErrorGoal,
    ErrorOf, Friction, GearSection, Giver, Group, Groups, InputGivers, Interface, Level, Load, Machine,
    Material, Misalignment, Orientation, PhaseSection, RaceLoad, RaceSection, RotatingSection, SceneError,
    Schedule, Sine, Solver, Start, Tilt, Translation, schedule, units,
};
use crate::schema::{Follows, explain, regular};
pub use ranges::Ranges;
pub use scales::Scales;

/// A bearing, its load and its simulation, as described by a scene file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line for plots and reports.
    #[serde(default)]
    pub title: String,
    /// Internal geometry.
    pub bearing: BearingSection,
    /// Ball material.
    #[serde(default)]
    pub ball: Material,
    /// Race material.
    #[serde(default)]
    pub race: Material,
    /// Coulomb friction coefficients.
    #[serde(default)]
    pub friction: Friction,
    /// Which effects are simulated.
    #[serde(default)]
    pub effects: Effects,
    /// The section of the creep law `regularised`, until it joins its effect.
    #[serde(default)]
    regularised: Regularised,
    /// The section of the cage, until it joins its effect.
    cage: Option<CageSection>,
    /// The section of the form of races and balls, until it joins its effect.
    #[serde(default)]
    form: FormSection,
    /// The section of temperatures and fits, until it joins its effect.
    growth: Option<growth::Section>,
    /// The section of the rating life, until it joins its effect.
    rating: Option<rating::Section>,
    /// The section of the oil, until it joins its effect.
    film: Option<film::Section>,
    /// Damage of races, until it joins its effect.
    #[serde(default)]
    defect: Vec<DefectSection>,
    /// Inner race.
    #[serde(default)]
    pub inner: RaceSection,
    /// Outer race.
    #[serde(default)]
    pub outer: RaceSection,
    /// Velocities at the start.
    #[serde(default)]
    pub start: Start,
    /// Time integration.
    #[serde(default)]
    pub solver: Solver,
    /// Duration, speeds and loads of the races.
    pub load: Load,
    /// Named windows of the run, which have means and lives of their own.
    #[serde(default)]
    pub phase: Vec<PhaseSection>,
    /// Loads over its life, each with its part of the time: `roulement rating` adds up what they take of it.
    #[serde(default)]
    pub duty: Vec<DutySection>,
    /// Interface of the FMU.
    #[serde(default)]
    pub interface: Interface,
    /// Keys of this file, each with the two ends of the range that a package can meet; `effects.auto` of a package is judged at all their corners.
    #[serde(default)]
    pub ranges: Ranges,
    /// The text the scene was read from.
    #[serde(skip)]
    pub source: String,
}

impl Scene {
    /// Reads a scene from its text.
    ///
    /// # Errors
    /// See [`SceneError`]; with the line.
    pub fn parse(text: &str) -> Result<Self, SceneError> {
        Self::parse_of(text, None, Path::new(""))
    }

    /// Reads a scene from the text of a file.
    fn parse_of(text: &str, file: Option<&str>, folder: &Path) -> Result<Self, SceneError> {
        Self::read(text, folder).map_err(|(error, spot)| explain::with_place(error, text, spot, file))
    }

    /// Reads a scene whose files are in a folder; an error with the spot \[bytes] where the text cannot be read.
    fn read(text: &str, folder: &Path) -> Result<Self, (SceneError, Option<usize>)> {
        match Self::with_files(text, folder) {
            // Lines of the text with the tables are not those that the reader of a message has.
            Ok(Some(text)) => Self::read_whole(&text, folder).map_err(|(why, _)| (why, None)),
            Ok(None) => Self::read_whole(text, folder),
            Err(why) => Err((why, None)),
        }
    }

    /// The text with the tables of measured files in their place; none if it names no such file.
    fn with_files(text: &str, folder: &Path) -> Result<Option<String>, SceneError> {
        if !text.contains("file") {
            return Ok(None);
        }
        // What is no TOML is refused where it is read.
        let Ok(table) = toml::from_str::<toml::Table>(text) else { return Ok(None) };
        let mut scene = toml::Value::Table(table);
        let found = schedule::files::embed(&mut scene, folder, "")?;
        Ok(scene.as_table().filter(|_| found).map(ToString::to_string))
    }

    /// Reads a scene whose schedules name no files.
    fn read_whole(text: &str, folder: &Path) -> Result<Self, (SceneError, Option<usize>)> {
        let mut scene: Self = explain::read(text)?;
        scene.source = text.to_string();
        scene.effects.creep.regularised = std::mem::take(&mut scene.regularised);
        scene.effects.cage.section = scene.cage.take();
        scene.effects.support.sections = [scene.inner.support.take(), scene.outer.support.take()];
        scene.effects.gravity.is_input = scene.effects.frame.section.is_some();
        scene.effects.form.section = std::mem::take(&mut scene.form);
        scene.effects.defects.sections = std::mem::take(&mut scene.defect);
        scene.read_files(folder).map_err(|why| (why, None))?;
        scene.effects.growth.section = scene.growth.take();
        scene.effects.rating.section = scene.rating.take();
        scene.effects.film.section = scene.film.take();
        if scene.solver.follows != Follows::Nothing {
            let Scales { approach, frequency } = Scales::of(&scene);
            scene.solver.follow(frequency, approach);
        }
        scene.solver.fit_to(scene.bearing.ball_diameter.0);
        scene.check().map_err(|why| (why, None))?;
        let again = |text: &str| Self::read_whole(text, folder).map_or_else(|(why, _)| Err(why), |_| Ok(()));
        scene.ranges.check(&scene.source, again).map_err(|why| (why, None))?;
        Ok(scene)
    }

    /// Reads the files that the scene names. Its text then has their numbers in their place, so that it stands alone.
    fn read_files(&mut self, folder: &Path) -> Result<(), SceneError> {
        let files = self.effects.form.section.read_files(folder)?;
        if files.is_empty() {
            return Ok(());
        }
        let mut table = explain::table(&self.source).map_err(|(why, _)| why)?;
        for (race, profile) in files {
            let shape = table.get_mut("form").and_then(|form| form.get_mut(race)?.get_mut("profile"));
            if let Some(shape) = shape {
                *shape = profile;
            }
        }
        self.source = table.to_string();
        Ok(())
    }

    /// Checks every value against its range, and the keys against one another.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn check(&self) -> Result<(), SceneError> {
        validate::validate(self)
    }

    /// Motion of the bearing's frame at a time \[s], and gravity in it.
    pub fn frame_at(&self, time: f64) -> FrameMotion {
        let motion = self.effects.frame.section.as_ref().map(|section| section.at(time)).unwrap_or_default();
        FrameMotion { gravity: self.effects.gravity.at(time), ..motion }
    }

    /// Setup that effects may have to agree with.
    fn setup(&self) -> effects::Setup<'_> {
        let saturates = self.effects.creep.law.saturates();
        let turns = |race: &RaceSection, speed: &Schedule| {
            race.drive == Drive::Pose || speed.values().into_iter().any(|speed| speed != 0.0)
        };
        effects::Setup {
            bearing: &self.bearing,
            friction: &self.friction,
            saturates,
            grows: self.effects.growth.section.is_some(),
            rises_follow_time: self.effects.growth.follows_time(),
            cage: self.effects.cage.is_body(),
            kept_apart: self.effects.cage.is_body() || self.effects.cage.is_ideal(),
            oiled: self.effects.film.section.is_some(),
            drives: [self.inner.drive, self.outer.drive],
            turning: [turns(&self.inner, &self.load.inner_speed), turns(&self.outer, &self.load.outer_speed)],
            expansions: [&self.ball, &self.race].map(|material| material.thermal_expansion.0),
        }
    }

    /// Reads a scene file.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let text = regular::scene(path)?;
        Self::parse_of(&text, Some(&path.display().to_string()), path.parent().unwrap_or(Path::new("")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THRUST: &str = include_str!("../../scenes/thrust.toml");

    #[test]
    fn the_shipped_scenes_are_read() {
        let scene = Scene::parse(THRUST).unwrap();
        assert_eq!(scene.load.conditions()[0], Condition::Load(Schedule::Constant(1500.0)));
        Scene::parse(include_str!("../../scenes/radial.toml")).unwrap();
        Scene::parse(include_str!("../../scenes/cage.toml")).unwrap();
    }

    #[test]
    fn errors_name_key_value_and_allowed_range() {
        let cases = [
            ("balls = 10 ", "balls = 0 ", &["bearing.balls = 0", "[1, 200]"][..]),
            ("balls = 10 ", "bals = 10 ", &["bearing.bals", "did you mean balls?", "line 6"]),
            ("balls = 10 ", "", &["bearing.balls is missing", "balls = 10", "line 5"]),
            (
                "\"9.525 mm\"",
                "\"9.525 kg\"",
                &["bearing.ball_diameter", "9.525 kg", "kg measures something else", "9.525 mm", "line 7"],
            ),
            ("alpha_f = 0.05", "alpha_f = 0.4", &["solver.alpha_f = 0.4", "(0, 0.3333333333333333]"]),
            ("alpha_f = 0.05", "alpha_f = nan", &["solver.alpha_f", "NaN"]),
            (
                "x = { force = \"1500 N\" }",
                "x = { force = \"1 mm\" }",
                &["load.x.force", "1 mm", "mm measures something else", "1.5 kN"],
            ),
            (
                "x = { force = \"1500 N\" }",
                "x = { force = 1.0, displacement = 0.0 }",
                &["load.x", "at most one"],
            ),
            ("x = { force = \"1500 N\" }", "x = { force = [[0, 1], [0, 2]] }", &["times must grow"]),
            ("mass = \"0.2 kg\"", "", &["inner", "give its mass"]),
            ("contact_angle = \"25 deg\"", "", &["exactly one of contact_angle"]),
        ];
        for (from, to, parts) in cases {
            assert!(THRUST.contains(from));
            let message = Scene::parse(&THRUST.replace(from, to)).unwrap_err().to_string();
            for part in parts {
                assert!(message.contains(part), "{message}\nshould name {part}");
            }
        }
    }

    #[test]
    fn schedules_interpolate_and_hold() {
        let table = "[[0.0, 0.0], [\"1 ms\", \"1 kN\"], [0.003, 0.0]]";
        let scene = Scene::edited(THRUST, [("load.x.force", table)]).unwrap();
        let Condition::Load(force) = scene.load.conditions()[0].clone() else { panic!("a load was written") };
        assert_eq!([force.at(-1.0), force.at(0.0005), force.at(0.001)], [0.0, 500.0, 1000.0]);
        assert_eq!([force.at(0.002), force.at(0.003), force.at(9.0)], [500.0, 0.0, 0.0]);
        // The smooth path passes the points, rests at the ends and does not overshoot.
        assert_eq!([force.smooth_at(0.0), force.smooth_at(0.001)], [(0.0, 0.0), (1000.0, 0.0)]);
        assert_eq!(force.smooth_at(0.0005), (500.0, 1.5e6));
    }
}
