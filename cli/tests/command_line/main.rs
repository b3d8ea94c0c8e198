//! The command line as a user meets it.
#![allow(clippy::unwrap_used)]

mod accelerations;
mod alarms;
mod bearing;
mod cage;
mod check;
#[path = "../common/mod.rs"]
mod common;
mod contacts;
mod cost;
mod documents_run;
mod duty;
mod effects;
mod field;
mod help;
mod means;
mod modes;
mod packages;
mod phases;
mod rating;
mod refusals;
mod report;
mod rexs;
mod runs;
mod same_bits;
mod scene_keys;
mod shaft;
mod shaft_keeps;
mod shards;
mod signs;
mod spectrum;
mod sweep;
mod system;

use std::path::Path;
use std::process::Command;

use common::{Scratch, edited, roulement, scene};
use serde_json::Value;

/// Units of a picture in a pixel: more than one, so that curves have no stairs.
fn units_in_a_pixel(picture: &str) -> f64 {
    let size = |at: &str| -> f64 {
        let rest = &picture[picture.find(at).unwrap() + at.len()..];
        rest.split(['"', ' ']).next().unwrap().parse().unwrap()
    };
    size("viewBox=\"0 0 ") / size("<svg width=\"")
}
