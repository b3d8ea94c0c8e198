//! The command line as a user meets it.
#![allow(clippy::unwrap_used)]

mod bearing;
#[path = "../common/mod.rs"]
mod common;
mod contacts;
mod cost;
mod effects;
mod field;
mod refusals;
mod report;
mod runs;
mod scene_keys;
mod spectrum;
mod sweep;

use std::path::Path;
use std::process::Command;

use common::{Scratch, edited, roulement, scene};
use serde_json::Value;
