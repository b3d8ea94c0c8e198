//! Rolling elements that are in balance wherever the rings are: forces of a bearing without states of its own.
//!
//! The elements stand at azimuths that turn with the kinematic speed of the cage. Each is in balance in its own plane ([`ball`]); their
//! sum is a wrench between the rings with its exact derivatives ([`rings`]). At a given speed the forces derive from a potential, but for the
//! gyroscopic couple: what rings do against them is stored, and nothing depends on the way that led there.
//!
//! Rollers are a link between a shaft and what the outer ring sits in ([`crate::model::link::rollers`]).
//!
//! What this level does not know is what elements need time for: slip and skidding, a cage of its own, spin that lags behind, friction along
//! orbits, the weight of elements, and waves and spalls of the surfaces. Friction brakes rings by the power that rolling elements lose.

pub mod ball;
pub mod bearing;
pub mod rings;
mod together;
