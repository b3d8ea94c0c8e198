//! Parameters that change between two steps, levels of bearings among them.

use std::sync::Arc;

use super::{Unit, scripts};
use crate::fmi::outcome::{Outcome, Status};
use crate::scene::Level;
use crate::scene::system::MountedScene;
use crate::schema::numbers::four;
use crate::simulation::machine::MachineError;
use crate::simulation::system::{LevelJump, System};

impl Unit {
    /// Goes on with the tunable parameters among these values; says what bearings did that begin at another level.
    ///
    /// # Errors
    /// If they contradict one another; a discarded step, with nothing changed, if a bearing has no equilibrium to begin at.
    pub fn tune(&mut self, values: &[f64]) -> Outcome<Vec<String>> {
        let scene = self.scene_with(values)?;
        let before: Vec<LevelJump> = self.level_jumps().map(|(_, jump)| *jump).collect();
        self.machine.tune(&scene).map_err(|why: MachineError| (Status::Discard, why.to_string()))?;
        self.scripts = scripts(&self.machine, &scene);
        self.scene = Arc::new(scene);
        let begun = self.level_jumps().zip(&before).filter(|((_, jump), before)| jump != before);
        let time = self.time();
        let said = begun.map(|((mounted, LevelJump { force, moment, .. }), _)| {
            let level = if mounted.level() == Level::Dynamic { "dynamic" } else { "equilibrium" };
            let (name, force, moment) = (&mounted.name, four(force), four(moment));
            format!(
                "bearing {name}: from {time} s on level = \"{level}\"; the force on its inner ring jumps by {force} N, the moment by {moment} N m"
            )
        });
        Ok(said.collect())
    }

    /// The bearings of a machine, and what changes of their levels did.
    fn level_jumps(&self) -> impl Iterator<Item = (&MountedScene, &LevelJump)> {
        fn of(system: &System) -> impl Iterator<Item = (&MountedScene, &LevelJump)> {
            system.scene().bearings.iter().zip(system.level_jumps())
        }
        self.machine.shaft().into_iter().flat_map(of)
    }
}
