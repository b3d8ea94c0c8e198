//! Texts with units: the table of known units, spellings that were read before, random texts, and scenes.

mod random;
mod recorded;
mod scenes;
mod table;

use roulement::scene::units::{self, Dimension, Quantity};

/// A dimension by the name of its type.
fn dimension(name: &str) -> Dimension {
    macro_rules! named {
        ($($of:ident)*) => {
            match name {
                $(stringify!($of) => units::$of::DIMENSION,)*
                _ => panic!("{name}"),
            }
        };
    }
    named!(Ratio Length Angle Pressure Density Mass Inertia Unbalance Time Force Moment AngularVelocity Frequency
        AngularAcceleration Viscosity TranslationalStiffness RotationalStiffness TranslationalDamping RotationalDamping
        Velocity Acceleration KinematicViscosity DissipationFactor TemperatureRise Celsius PressureViscosity
        ThermalExpansion)
}
