//! Contact between a ball and a raceway: geometry, Hertz, creepage, creep laws.

pub mod geometry;
pub mod hertz;
