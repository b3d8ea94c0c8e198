//! Units of the variables.

/// A unit with its SI dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Name as written in the model description.
    pub name: &'static str,
    /// Exponents of kg, m, s, rad.
    pub exponents: [i8; 4],
    /// Display unit and how many of it make one unit, where another one is customary.
    pub display: Option<(&'static str, f64)>,
}

const fn unit(name: &'static str, exponents: [i8; 4]) -> Unit {
    Unit { name, exponents, display: None }
}

const fn shown(name: &'static str, exponents: [i8; 4], display: &'static str, factor: f64) -> Unit {
    Unit { name, exponents, display: Some((display, factor)) }
}

const DEGREE: f64 = 180.0 / std::f64::consts::PI;
/// Pure number.
pub const ONE: Unit = unit("1", [0, 0, 0, 0]);
/// Position.
pub const METRE: Unit = shown("m", [0, 1, 0, 0], "um", 1e6);
/// Velocity.
pub const METRE_PER_SECOND: Unit = unit("m/s", [0, 1, -1, 0]);
/// Angle.
pub const RADIAN: Unit = shown("rad", [0, 0, 0, 1], "deg", DEGREE);
/// Angular velocity.
pub const RADIAN_PER_SECOND: Unit = shown("rad/s", [0, 0, -1, 1], "rev/min", 30.0 / std::f64::consts::PI);
/// Force.
pub const NEWTON: Unit = unit("N", [1, 1, -2, 0]);
/// Moment.
pub const NEWTON_METRE: Unit = unit("N.m", [1, 2, -2, 0]);
/// Power.
pub const WATT: Unit = unit("W", [1, 2, -3, 0]);
/// Energy.
pub const JOULE: Unit = unit("J", [1, 2, -2, 0]);
/// Pressure.
pub const PASCAL: Unit = shown("Pa", [1, -1, -2, 0], "MPa", 1e-6);
/// Spin creepage.
pub const PER_METRE: Unit = unit("1/m", [0, -1, 0, 0]);
/// Time.
pub const SECOND: Unit = unit("s", [0, 0, 1, 0]);
/// Every unit, in the order of the model description.
pub const ALL: [Unit; 12] = [
    ONE,
    METRE,
    METRE_PER_SECOND,
    RADIAN,
    RADIAN_PER_SECOND,
    NEWTON,
    NEWTON_METRE,
    WATT,
    JOULE,
    PASCAL,
    PER_METRE,
    SECOND,
];
