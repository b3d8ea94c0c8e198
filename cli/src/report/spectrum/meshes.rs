//! Meshes of the machine that a bearing is in: teeth are heard in all of its bearings, with sidebands by the turns of both shafts.

use std::f64::consts::TAU;

use roulement::simulation::system::System;

/// A mesh over some rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Its name.
    pub name: String,
    /// \[Hz] teeth that come into mesh; a sum over rows while these are taken.
    pub frequency: f64,
    /// Shafts of both gears, and \[Hz] their turns, likewise.
    pub shafts: [(String, f64); 2],
}

/// The meshes of a machine, before any row.
pub fn of(system: &System) -> Vec<Mesh> {
    let scene = system.scene();
    let shaft = |index: usize| (scene.shafts[index].name.clone(), 0.0);
    let mesh = |of: &roulement::scene::system::mesh::SceneMesh| Mesh {
        name: of.section.name.clone(),
        frequency: 0.0,
        shafts: of.shafts.map(shaft),
    };
    scene.meshes.iter().map(mesh).collect()
}

/// \[Hz] teeth of every mesh, and turns of both of its shafts, at this moment, seen from the frame of the scene.
pub fn turns(system: &System) -> Vec<[f64; 3]> {
    let shafts = &system.outputs().shafts;
    let turns = |index: usize| shafts[index].spin.speed.abs() / TAU;
    let of = system.scene().meshes.iter().map(|mesh| {
        let [first, second] = mesh.shafts.map(turns);
        [f64::from(mesh.section.gears[0].teeth) * first, first, second]
    });
    of.collect()
}

impl Mesh {
    /// Takes a row.
    pub fn add(&mut self, [frequency, first, second]: [f64; 3]) {
        self.frequency += frequency;
        self.shafts[0].1 += first;
        self.shafts[1].1 += second;
    }

    /// Its means over these rows.
    pub fn over(self, rows: f64) -> Self {
        let shafts = self.shafts.map(|(name, sum)| (name, sum / rows));
        Self { frequency: self.frequency / rows, shafts, ..self }
    }
}
