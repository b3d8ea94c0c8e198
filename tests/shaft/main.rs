//! Several bearings on one shaft.

mod common;
mod hard;
mod motion;
mod statics;
