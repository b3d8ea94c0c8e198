//! One contact, from motion to forces: what all pairs of bodies share, then a room or file for each kind of pair.
//!
//! | room | contents |
//! |---|---|
//! | `motion`, `pair` | what goes in and comes out: motions of both bodies, forces between them |
//! | `hertz`, `materials`, `raceway`, `shape`, `normal`, `kinematics` | load and ellipse of an approach; slip of two surfaces |
//! | `creep` | forces of rolling and sliding: the creep laws and what they are made of |
//! | `ball_race` | balls on raceways, with films, form and damage |
//! | `ball_ball` | neighbouring balls |
//! | `cage` | pockets and lands of a cage |

pub mod ball_ball;
mod ball_race;
mod cage;
pub mod creep;
pub mod hertz;
pub(crate) mod kinematics;
pub mod materials;
pub mod motion;
pub mod normal;
pub mod pair;
pub mod raceway;
pub mod shape;

pub use ball_race::{BallRaceContact, ContactModel, Path, Resistance};
pub use ball_race::{ball_spall, film, form, geometry, many, shoulder, spall, surface};
pub use cage::{film as cage_film, land, pocket};
pub use creep::{heathcote, identification, linear_theory, oblique, regularised};
pub use kinematics::REGULARISATION_SPEED;
pub use motion::{BallMotion, RaceMotion};
