//! Pairs of bodies other than ball and race.
#![allow(clippy::unwrap_used)]

mod ball_contact;
mod cage;
mod cage_start;
#[path = "../common/mechanics.rs"]
mod mechanics;
#[path = "../common/random.rs"]
mod random;
#[path = "../common/scenes.rs"]
mod scenes;
