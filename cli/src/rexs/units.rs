//! Units of REXS files, as its specification writes them.

/// Size of a unit in SI; of angles in radians, of temperatures 1: they are numbers in degrees Celsius.
const UNITS: &[(&str, f64)] = &[
    ("", 1.0),
    ("none", 1.0),
    ("%", 0.01),
    ("1 / min", std::f64::consts::TAU / 60.0),
    ("rad / s", 1.0),
    ("C", 1.0),
    ("K", 1.0),
    ("deg", std::f64::consts::PI / 180.0),
    ("°", std::f64::consts::PI / 180.0),
    ("rad", 1.0),
    ("h", 3600.0),
    ("s", 1.0),
    ("kg", 1.0),
    ("kg / dm^3", 1e3),
    ("kg m^2", 1.0),
    ("1e-6 / C", 1e-6),
    ("kN", 1e3),
    ("N", 1.0),
    ("kW", 1e3),
    ("W", 1.0),
    ("m / s^2", 1.0),
    ("mm", 1e-3),
    ("mum", 1e-6),
    ("mm^2 / s", 1e-6),
    ("MPa", 1e6),
    ("N / mm^2", 1e6),
    ("Pa", 1.0),
    ("N / m", 1.0),
    ("N / mm", 1e3),
    ("N / (mm mum)", 1e9),
    ("N m", 1.0),
    ("N mm / rad", 1e-3),
    ("N / rad", 1.0),
];

/// Size of a unit in SI, if it is one of those that this program reads.
pub fn size(unit: &str) -> Option<f64> {
    UNITS.iter().find(|(name, _)| *name == unit.trim()).map(|(_, size)| *size)
}
