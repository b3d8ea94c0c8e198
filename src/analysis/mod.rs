//! Analyses of a model or a state without running it: stiffness and damping, single rolling contacts.

pub mod condensed;
pub mod single_contact;
