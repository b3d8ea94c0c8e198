//! The scenes that are run: the scene itself, and it with each effect taken in or out.

use roulement::analysis::estimate::{self, EstimateError};
use roulement::effects::estimate::Estimate;
use roulement::effects::twin::{Switch, Twin};
use roulement::model::Model;
use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::simulation::system::System;

use super::in_runs;

/// An effect of a bearing, and the two scenes that differ in it.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The bearing, counted from 0.
    pub bearing: usize,
    /// Its name; empty of a bearing alone.
    pub name: String,
    /// Key of the effect.
    pub key: &'static str,
    /// Subject in a few words.
    pub subject: &'static str,
    /// Is it in the scene?
    pub on: bool,
    /// As what it is taken in; empty where it is simply on.
    pub setting: String,
    /// The scene without it, and the scene with it, counted from 0.
    pub without: usize,
    /// See `without`.
    pub with: usize,
}

/// All of them.
pub struct Pairs {
    /// Scenes, the scene itself first.
    pub scenes: Vec<MachineScene>,
    /// Effects.
    pub pairs: Vec<Pair>,
}

impl Pairs {
    /// Those of a scene whose subjects are wanted.
    ///
    /// # Errors
    /// If there are no estimates, which say how effects are taken in and out.
    pub fn of(scene: &MachineScene, wanted: impl Fn(&str) -> bool) -> Result<Self, String> {
        // Life is among what may change.
        let rated = |scene: &mut Scene| {
            scene.effects.rating.section.get_or_insert_default();
        };
        let mut all = Self { scenes: vec![scene.with(rated)], pairs: vec![] };
        let estimates = estimates(scene).map_err(|why| why.to_string())?;
        for (bearing, ((name, own), estimate)) in scene.bearings().into_iter().zip(&estimates).enumerate() {
            let twins = own.effects.twins(estimate).into_iter().chain(in_runs::twins(&own.effects, estimate));
            twins.filter(|twin| wanted(twin.subject)).for_each(|twin| all.push(bearing, name, &twin));
        }
        Ok(all)
    }

    fn push(&mut self, bearing: usize, name: &str, twin: &Twin) {
        let mut add = |switches: &[&Switch]| {
            let mut changed = self.scenes[0].clone();
            let scene: &mut Scene = match &mut changed {
                MachineScene::Bearing(scene) => scene,
                MachineScene::Shaft(system) => &mut system.bearings[bearing].scene,
            };
            switches.iter().for_each(|switch| switch(&mut scene.effects));
            self.scenes.push(changed);
            self.scenes.len() - 1
        };
        let common = twin.common.as_ref().map(|common| (common, add(&[common])));
        for (index, switch) in twin.switches.iter().enumerate() {
            let (without, with) = match (common, twin.on) {
                (Some((common, without)), _) => (without, add(&[common, switch])),
                (None, true) => (add(&[switch]), 0),
                (None, false) => (0, add(&[switch])),
            };
            let Twin { key, subject, on, ref setting, .. } = *twin;
            let name = name.to_string();
            let setting = match twin.ways.get(index) {
                Some(way) => format!("{setting} ({way})"),
                None => setting.clone(),
            };
            self.pairs.push(Pair { bearing, name, key, subject, on, setting, without, with });
        }
    }
}

/// Estimates of every bearing, which its twins are made by.
fn estimates(scene: &MachineScene) -> Result<Vec<Estimate>, EstimateError> {
    match scene {
        MachineScene::Bearing(scene) => Ok(vec![estimate::of(scene, &Model::new(scene)?)?]),
        MachineScene::Shaft(system) => {
            let system = System::new(system).map_err(|why| EstimateError::Start(why.to_string()))?;
            system.bearings().map(|(_, bearing)| estimate::on_shaft(bearing)).collect()
        }
    }
}
