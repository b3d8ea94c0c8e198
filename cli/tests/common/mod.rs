//! What tests of the program share: scenes of the project, the program itself, directories to write into.
#![allow(dead_code)]

use std::path::PathBuf;
use std::process::{Command, Output};
use std::sync::atomic::{AtomicU32, Ordering};

use roulement::scene::Scene;

/// Runs the program.
pub fn roulement(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_roulement")).args(arguments).output().unwrap()
}

/// Path of a scene of the project.
pub fn scene(name: &str) -> String {
    format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

/// A scene of the project with keys changed.
pub fn edited(name: &str, changes: &[(&str, &str)]) -> Scene {
    Scene::edited(&std::fs::read_to_string(scene(name)).unwrap(), changes.iter().copied()).unwrap()
}

/// A directory of its own for a test, removed at the end.
pub struct Scratch(PathBuf);

impl Scratch {
    pub fn new(name: &str) -> Self {
        // Also where other threads of this process use the same name.
        static DIRECTORIES: AtomicU32 = AtomicU32::new(0);
        let number = DIRECTORIES.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("roulement-{name}-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Runs a scene into a directory in here.
    pub fn run(&self, scene: &Scene, to: &str, options: &[&str]) -> Output {
        std::fs::write(self.path("scene.toml"), &scene.source).unwrap();
        let arguments = ["run", &self.path("scene.toml"), "-o", &self.path(to)];
        roulement(&[&arguments, options].concat())
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
