//! What can be asked of a model or a state beside running it: stiffness and damping, single rolling contacts.

pub mod condensed;
pub mod single_contact;
