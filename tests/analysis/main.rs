//! Stiffness, damping and sensitivities of a bearing.
#![allow(clippy::unwrap_used)]

#[path = "../common/mechanics.rs"]
mod mechanics;
#[path = "../common/reference.rs"]
mod reference;
#[path = "../common/scenes.rs"]
mod scenes;
mod sensitivity;
mod small_motions;
#[path = "../common/statics.rs"]
mod statics;
mod stiffness;
