//! Units of the variables.

/// A unit with its SI dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Name as written in the model description.
    pub name: &'static str,
    /// Quantity measured in it: the name of the FMI type.
    pub quantity: &'static str,
    /// Exponents of kg, m, s, rad, K.
    pub exponents: [i8; 5],
    /// Display unit and how many of it make one unit, where another one is customary.
    pub display: Option<(&'static str, f64)>,
}

const fn unit(name: &'static str, quantity: &'static str, exponents: [i8; 4]) -> Unit {
    let [kilogram, metre, second, radian] = exponents;
    Unit { name, quantity, exponents: [kilogram, metre, second, radian, 0], display: None }
}

impl Unit {
    /// This unit with a display unit, `factor` of which make one.
    const fn shown(mut self, display: &'static str, factor: f64) -> Self {
        self.display = Some((display, factor));
        self
    }

    /// This unit times a power of the kelvin.
    const fn kelvin(mut self, exponent: i8) -> Self {
        self.exponents[4] = exponent;
        self
    }
}

const DEGREE: f64 = 180.0 / std::f64::consts::PI;
/// Pure number.
pub const ONE: Unit = unit("1", "Ratio", [0, 0, 0, 0]);
/// Position.
pub const METRE: Unit = unit("m", "Position", [0, 1, 0, 0]).shown("um", 1e6);
/// Dimension of a part.
pub const DIMENSION: Unit = unit("m", "Length", [0, 1, 0, 0]).shown("mm", 1e3);
/// Velocity.
pub const METRE_PER_SECOND: Unit = unit("m/s", "Velocity", [0, 1, -1, 0]);
/// Acceleration.
pub const METRE_PER_SECOND_SQUARED: Unit = unit("m/s2", "Acceleration", [0, 1, -2, 0]);
/// Angle.
pub const RADIAN: Unit = unit("rad", "Angle", [0, 0, 0, 1]).shown("deg", DEGREE);
/// Angular velocity.
pub const RADIAN_PER_SECOND: Unit =
    unit("rad/s", "AngularVelocity", [0, 0, -1, 1]).shown("rev/min", 30.0 / std::f64::consts::PI);
/// Angular acceleration.
pub const RADIAN_PER_SECOND_SQUARED: Unit = unit("rad/s2", "AngularAcceleration", [0, 0, -2, 1]);
/// Force.
pub const NEWTON: Unit = unit("N", "Force", [1, 1, -2, 0]);
/// Moment.
pub const NEWTON_METRE: Unit = unit("N.m", "Torque", [1, 2, -2, 0]);
/// Power.
pub const WATT: Unit = unit("W", "Power", [1, 2, -3, 0]);
/// Energy.
pub const JOULE: Unit = unit("J", "Energy", [1, 2, -2, 0]);
/// Pressure.
pub const PASCAL: Unit = unit("Pa", "Pressure", [1, -1, -2, 0]).shown("MPa", 1e-6);
/// Spin creepage.
pub const PER_METRE: Unit = unit("1/m", "SpinCreepage", [0, -1, 0, 0]);
/// Time.
pub const SECOND: Unit = unit("s", "Time", [0, 0, 1, 0]).shown("us", 1e6);
/// Mass.
pub const KILOGRAM: Unit = unit("kg", "Mass", [1, 0, 0, 0]);
/// Moment of inertia.
pub const KILOGRAM_METRE_SQUARED: Unit = unit("kg.m2", "MomentOfInertia", [1, 2, 0, 0]);
/// Density.
pub const KILOGRAM_PER_CUBIC_METRE: Unit = unit("kg/m3", "Density", [1, -3, 0, 0]);
/// Viscosity.
pub const PASCAL_SECOND: Unit = unit("Pa.s", "Viscosity", [1, -1, -1, 0]);
/// Dissipation factor of a contact.
pub const SECOND_PER_METRE: Unit = unit("s/m", "DissipationFactor", [0, -1, 1, 0]);
/// Stiffness, force by translation.
pub const NEWTON_PER_METRE: Unit = unit("N/m", "TranslationalStiffness", [1, 0, -2, 0]);
/// Stiffness, force by rotation.
pub const NEWTON_PER_RADIAN: Unit = unit("N/rad", "ForceByRotation", [1, 1, -2, -1]);
/// Stiffness, moment by translation.
pub const NEWTON_METRE_PER_METRE: Unit = unit("N.m/m", "MomentByTranslation", [1, 1, -2, 0]);
/// Stiffness, moment by rotation.
pub const NEWTON_METRE_PER_RADIAN: Unit = unit("N.m/rad", "RotationalStiffness", [1, 2, -2, -1]);
/// Damping, force by velocity.
pub const NEWTON_SECOND_PER_METRE: Unit = unit("N.s/m", "TranslationalDamping", [1, 0, -1, 0]);
/// Damping, force by angular velocity.
pub const NEWTON_SECOND_PER_RADIAN: Unit = unit("N.s/rad", "ForceByAngularVelocity", [1, 1, -1, -1]);
/// Damping, moment by velocity.
pub const NEWTON_METRE_SECOND_PER_METRE: Unit = unit("N.m.s/m", "MomentByVelocity", [1, 1, -1, 0]);
/// Damping, moment by angular velocity.
pub const NEWTON_METRE_SECOND_PER_RADIAN: Unit = unit("N.m.s/rad", "RotationalDamping", [1, 2, -1, -1]);
/// Difference of temperatures.
pub const KELVIN: Unit = unit("K", "TemperatureDifference", [0, 0, 0, 0]).kelvin(1);
/// Coefficient of thermal expansion.
pub const PER_KELVIN: Unit = unit("1/K", "ThermalExpansion", [0, 0, 0, 0]).kelvin(-1);
/// Kinematic viscosity.
pub const SQUARE_METRE_PER_SECOND: Unit = unit("m2/s", "KinematicViscosity", [0, 2, -1, 0]);
/// Frequency.
pub const HERTZ: Unit = unit("Hz", "Frequency", [0, 0, -1, 0]);
/// Every unit, in the order of the model description.
pub const ALL: [Unit; 32] = [
    ONE,
    METRE,
    DIMENSION,
    METRE_PER_SECOND,
    METRE_PER_SECOND_SQUARED,
    RADIAN,
    RADIAN_PER_SECOND,
    RADIAN_PER_SECOND_SQUARED,
    NEWTON,
    NEWTON_METRE,
    WATT,
    JOULE,
    PASCAL,
    PER_METRE,
    SECOND,
    KILOGRAM,
    KILOGRAM_METRE_SQUARED,
    KILOGRAM_PER_CUBIC_METRE,
    PASCAL_SECOND,
    SECOND_PER_METRE,
    NEWTON_PER_METRE,
    NEWTON_PER_RADIAN,
    NEWTON_METRE_PER_METRE,
    NEWTON_METRE_PER_RADIAN,
    NEWTON_SECOND_PER_METRE,
    NEWTON_SECOND_PER_RADIAN,
    NEWTON_METRE_SECOND_PER_METRE,
    NEWTON_METRE_SECOND_PER_RADIAN,
    KELVIN,
    PER_KELVIN,
    SQUARE_METRE_PER_SECOND,
    HERTZ,
];

/// Unit of a parameter of a scene, whose ranges name units as scene files write them.
pub fn of_parameter(name: &str) -> Unit {
    match name {
        "m" => DIMENSION,
        "kg m2" => KILOGRAM_METRE_SQUARED,
        other => ALL.into_iter().find(|unit| unit.name == other).unwrap_or(ONE),
    }
}
