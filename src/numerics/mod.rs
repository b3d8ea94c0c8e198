//! Numerical methods that know nothing of bearings: numbers with derivatives, rigid-body motion, Newton's method, HHT steps.

pub mod arrowhead;
pub mod called;
pub mod condensed;
pub mod eigen;
pub mod elementary;
pub mod elliptic;
pub mod esdirk;
pub mod given;
pub mod hermite;
pub mod hht;
pub mod kept_lu;
pub mod lanes;
pub mod modes;
pub mod motion;
pub mod newton;
pub mod orbit_turn;
pub mod periodic_spline;
pub mod ring;
pub mod rotation;
pub mod scalar;
pub mod size;
pub mod sparse;
pub mod step_control;
pub mod tilt;
