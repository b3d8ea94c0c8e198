//! Ranges of the keys of a system that several of its checks share.

use crate::schema::numbers::Range;

/// Masses of shafts and discs.
pub const MASS: Range = Range::above(0.0, 1e6, "kg");
/// Their moments of inertia.
pub const INERTIA: Range = Range::above(0.0, 1e6, "kg m2");
/// Tilts of bores: what small tilts of structures are added to.
pub const BORE_TILT: Range = Range::closed(-0.05, 0.05, "rad");
/// Places of bores beside the axis of the shaft.
pub const BORE_OFFSET: Range = Range::closed(-0.01, 0.01, "m");
/// Positions along a shaft.
pub const POSITION: Range = Range::closed(-1e3, 1e3, "m");
/// Displacements of a point of a shaft that are given.
pub const GIVEN_DISPLACEMENT: Range = Range::closed(-0.1, 0.1, "m");
/// Tilts there: what shafts may tilt by.
pub const GIVEN_ROTATION: Range = Range::closed(-0.1, 0.1, "rad");
