//! A scene file, whatever it describes: one bearing alone, or a shaft with its bearings.

use std::path::Path;

use super::system::{SystemScene, linked};
use super::{Scene, SceneError, Solver};
use crate::schema::{DutySection, PhaseSection, regular};

/// Machine that a scene file describes.
#[derive(Clone, Debug)]
pub enum MachineScene {
    /// One bearing, whose races are given.
    Bearing(Box<Scene>),
    /// A shaft with its bearings.
    Shaft(Box<SystemScene>),
}

impl MachineScene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// See [`SceneError`]; with the line.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        if regular::text(path).is_ok_and(|text| SystemScene::is_system(&text)) {
            return SystemScene::load(path).map(Self::from);
        }
        Scene::load(path).map(Self::from)
    }

    /// Reads the scene file of a package, a text that stands alone as [`MachineScene::source`] does; of machines errors name no lines.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn of_package(path: &Path) -> Result<Self, SceneError> {
        let text = regular::scene(path)?;
        if SystemScene::is_system(&text) {
            return SystemScene::of_package(&text).map(Self::from);
        }
        Scene::load(path).map(Self::from)
    }

    /// Reads a scene from its text.
    ///
    /// # Errors
    /// See [`SceneError`]; with the line.
    pub fn parse(text: &str) -> Result<Self, SceneError> {
        if SystemScene::is_system(text) {
            return SystemScene::parse(text, None, Path::new("")).map(Self::from);
        }
        Scene::parse(text).map(Self::from)
    }

    /// Reads a text that stands alone, as [`MachineScene::source`] does; errors name no lines, which nobody has written.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn edited(text: &str) -> Result<Self, SceneError> {
        if SystemScene::is_system(text) {
            return SystemScene::edited(text).map(Self::from);
        }
        Scene::edited(text, [("", ""); 0]).map(Self::from)
    }

    /// The shaft with its bearings, where it is one.
    pub fn shaft(&self) -> Option<&SystemScene> {
        match self {
            Self::Bearing(_) => None,
            Self::Shaft(scene) => Some(scene),
        }
    }

    /// The bearings by their names; that of a bearing alone is empty.
    pub fn bearings(&self) -> Vec<(&str, &Scene)> {
        match self {
            Self::Bearing(scene) => vec![("", scene)],
            Self::Shaft(scene) => {
                scene.bearings.iter().map(|mounted| (mounted.name.as_str(), &mounted.scene)).collect()
            }
        }
    }

    /// Their scenes, to be changed.
    pub fn bearings_mut(&mut self) -> impl Iterator<Item = &mut Scene> {
        let (alone, mounted) = match self {
            Self::Bearing(scene) => (Some(&mut **scene), None),
            Self::Shaft(scene) => (None, Some(scene.bearings.iter_mut().map(|mounted| &mut mounted.scene))),
        };
        alone.into_iter().chain(mounted.into_iter().flatten())
    }

    /// One line for plots and reports.
    pub fn title(&self) -> &str {
        match self {
            Self::Bearing(scene) => &scene.title,
            Self::Shaft(scene) => &scene.title,
        }
    }

    /// A text that stands alone and reads to the same scene.
    pub fn source(&self) -> &str {
        match self {
            Self::Bearing(scene) => &scene.source,
            Self::Shaft(scene) => &scene.source,
        }
    }

    /// Are variables of its package arrays, where FMI has them?
    pub fn has_arrays(&self) -> bool {
        match self {
            Self::Bearing(scene) => scene.interface.arrays,
            Self::Shaft(scene) => scene.interface.arrays,
        }
    }

    /// Notes for its reader, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        match self {
            Self::Bearing(scene) => scene.notes(),
            Self::Shaft(scene) => scene.notes(),
        }
    }

    /// \[s] simulated time.
    pub fn duration(&self) -> f64 {
        match self {
            Self::Bearing(scene) => scene.load.duration.0,
            Self::Shaft(scene) => scene.load.duration.0,
        }
    }

    /// \[s] distance of two rows of results.
    pub fn output_interval(&self) -> f64 {
        match self {
            Self::Bearing(scene) => scene.load.output_interval.0,
            Self::Shaft(scene) => scene.load.output_interval.0,
        }
    }

    /// Named windows of the run.
    pub fn phases(&self) -> &[PhaseSection] {
        match self {
            Self::Bearing(scene) => &scene.phase,
            Self::Shaft(scene) => &scene.phases,
        }
    }

    /// Loads over its life.
    pub fn duty(&self) -> &[DutySection] {
        match self {
            Self::Bearing(scene) => &scene.duty,
            Self::Shaft(scene) => &scene.duty,
        }
    }

    /// The scene under one of these loads.
    ///
    /// # Errors
    /// If a key cannot be changed so, or the scene is refused then.
    pub fn under(&self, load: &DutySection) -> Result<Self, SceneError> {
        Self::edited(&Scene::edited_text(self.source(), load.changes())?)
    }

    /// Settings of the integration: those that steps of all bearings need.
    pub fn solver(&self) -> Solver {
        match self {
            Self::Bearing(scene) => scene.solver,
            Self::Shaft(scene) => scene.solver(),
        }
    }

    /// Changes the scene of every bearing.
    pub fn change(&mut self, change: impl Fn(&mut Scene)) {
        self.bearings_mut().for_each(change);
    }

    /// Machine with changed scenes of its bearings.
    #[must_use]
    pub fn with(&self, change: impl Fn(&mut Scene)) -> Self {
        let mut scene = self.clone();
        scene.change(change);
        scene
    }

    /// Changes all settings of the integration.
    pub fn change_solver(&mut self, change: impl Fn(&mut Solver)) {
        match self {
            Self::Shaft(scene) if scene.bearings.is_empty() => change(&mut scene.of_links),
            _ => self.change(|scene| change(&mut scene.solver)),
        }
    }

    /// Machine with changed settings of the integration.
    #[must_use]
    pub fn with_solver(&self, change: impl Fn(&mut Solver)) -> Self {
        let mut scene = self.clone();
        scene.change_solver(change);
        scene
    }

    /// Checks every value against its range.
    ///
    /// # Errors
    /// See [`Scene::check`].
    pub fn check(&self) -> Result<(), SceneError> {
        match self {
            Self::Shaft(scene) if scene.bearings.is_empty() => linked::check(&scene.of_links),
            _ => self.bearings().into_iter().try_for_each(|(_, scene)| scene.check()),
        }
    }
}

impl From<Scene> for MachineScene {
    fn from(scene: Scene) -> Self {
        Self::Bearing(Box::new(scene))
    }
}

impl From<SystemScene> for MachineScene {
    fn from(scene: SystemScene) -> Self {
        Self::Shaft(Box::new(scene))
    }
}
