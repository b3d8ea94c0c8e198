//! The command line as a user meets it.
#![allow(clippy::unwrap_used)]

mod contacts;
mod cost;
mod refusals;
mod runs;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use roulement::scene::Scene;
use serde_json::Value;

fn roulement(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_roulement")).args(arguments).output().unwrap()
}

fn scene(name: &str) -> String {
    format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

/// Text of a scene with keys changed.
fn edited(name: &str, changes: &[(&str, &str)]) -> String {
    let text = std::fs::read_to_string(scene(name)).unwrap();
    Scene::edited(&text, changes.iter().copied()).unwrap().source
}

/// A directory of its own for a test, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("roulement-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
