//! Scenes with keys changed.
#![allow(dead_code)]

use roulement::scene::Scene;

/// Directions in which a thrust bearing cannot hold its inner race by itself are held at 0.
pub const HELD: [(&str, &str); 4] = [
    ("load.y", "{ displacement = 0.0 }"),
    ("load.z", "{ displacement = 0.0 }"),
    ("load.ry", "{ rotation = 0.0 }"),
    ("load.rz", "{ rotation = 0.0 }"),
];

/// A scene from its text with keys set to other values, or taken out by empty ones ([`Scene::edited`]).
pub fn scene(text: &str, changes: &[(&str, &str)]) -> Scene {
    Scene::edited(text, changes.iter().copied()).unwrap_or_else(|why| panic!("{why}"))
}
