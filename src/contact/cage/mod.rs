//! Contacts of the cage: pockets around balls, lands on a race, and the oil film of both.

pub mod film;
pub mod land;
pub mod pocket;
