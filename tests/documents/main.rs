//! Documents and the project itself.
#![allow(clippy::unwrap_used)]

mod columns;
mod contributing;
mod counts;
mod dependencies;
mod links;
#[path = "../common/scenes.rs"]
mod scenes;
mod scripts;
#[path = "../common/tables.rs"]
mod tables;
#[path = "../common/whole.rs"]
mod whole;
