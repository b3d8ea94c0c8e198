//! Machinery that the effects share: what an effect is, its keys, its reports, and how it is estimated.

pub mod effect;
pub mod estimate;
pub mod inherent;
pub mod keys;
pub mod limits;
pub mod losses;
pub mod moving_frame;
pub mod reports;
pub mod since;
pub mod twin;
