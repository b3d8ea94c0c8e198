//! Numbers with units in scene files: a plain number in SI, or text such as `"9.525 mm"` or `"6000 rpm"`.
//!
//! `grammar` says how they are written, `known` has the units in one table, `product` their sizes as exact fractions; this
//! module has the dimensions of a scene with their SI units, and turns a text into an `f64`.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};

mod grammar;
pub mod known;
mod product;

use super::reader;
use grammar::Problem;

/// Exponents of m, kg, s, K and rad.
pub type Exponents = [i8; 5];

/// [-] largest decimal exponent accepted: no number of a scene is larger.
const MAX_EXPONENT: i32 = 99;

/// Dimension of a number, for conversions and messages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimension {
    /// Name with its article.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Exponents of that unit.
    pub exponents: Exponents,
    /// Two texts that a scene may have.
    pub examples: [&'static str; 2],
}

impl Dimension {
    /// Sentence that says what to write.
    fn wanted(&self) -> String {
        let Self { name, unit, examples: [first, second], .. } = self;
        format!("{name} is a number in {unit} or text with a unit, such as \"{first}\" or \"{second}\"")
    }

    /// Converts text such as `"9.525 mm"` to the SI unit.
    ///
    /// # Errors
    /// A sentence naming the text, what is wrong with it, and what was expected.
    pub fn parse(&self, text: &str) -> Result<f64, String> {
        let refuse = |why: &str| Err(format!("\"{text}\" is not {}: {why}; {}", self.name, self.wanted()));
        if text.len() > grammar::MAX_TEXT {
            return refuse("it is too long");
        }
        let (number, written) = match grammar::split(text) {
            Ok(parts) => parts,
            Err(why) => return refuse(why),
        };
        if !number.is_finite() || (number != 0.0 && number.abs().log10().abs() > f64::from(MAX_EXPONENT)) {
            return refuse("the number is out of range");
        }
        if written.is_empty() {
            return refuse("the unit is missing (a bare number in SI is written without quotes)");
        }
        self.unit(written).map(|unit| unit.si(number)).or_else(|why| refuse(&why))
    }

    /// A number in SI, or text with a unit.
    ///
    /// # Errors
    /// One sentence.
    pub fn read(&'static self, value: &toml::Value) -> Result<f64, String> {
        reader::read_with(Written(self), value).map_err(|why| why.message().to_string())
    }

    /// A unit of it as it is written, such as `mm`.
    ///
    /// # Errors
    /// Why it is none.
    pub(crate) fn unit(&self, written: &str) -> Result<Unit, String> {
        if self.unit == Ratio::DIMENSION.unit && written == self.unit {
            return Ok(Unit::Times(1.0));
        }
        if self.unit == Celsius::DIMENSION.unit {
            return match written {
                "degC" | "\u{b0}C" | "C" | "Cel" => Ok(Unit::Times(1.0)),
                "K" => Ok(Unit::Kelvin),
                "degF" | "\u{b0}F" => Ok(Unit::Fahrenheit),
                _ => Err(format!("{written} is no unit of it: write degC or K, or degF")),
            };
        }
        if self.unit == TemperatureRise::DIMENSION.unit
            && ["degC", "\u{b0}C", "Cel", "degF", "\u{b0}F"].contains(&written)
        {
            return Err(format!(
                "{written} is that of a temperature, with a zero of its own; a difference is written in K"
            ));
        }
        let mut product = grammar::unit(written).map_err(|problem| self.in_words(problem, written))?;
        let [.., angle] = &mut product.exponents;
        if self.unit == AngularVelocity::DIMENSION.unit {
            // Catalogues write revolutions per minute as 1/min.
            if product.exponents == [0, 0, -1, 0, 0] && (product.numerator, product.divisor) == (1, 60) {
                (product.exponents[4], product.turns) = (1, 1);
            }
            if product.exponents[4] != 1 {
                return Err(format!("{written} does not say through which angle: write rpm, rad/s or deg/s"));
            }
        } else if self.unit == Frequency::DIMENSION.unit {
            // A revolution is a period; another angle is none.
            if product.turns != *angle || !(0..=1).contains(angle) {
                return Err(format!("{written} counts angles, no periods: write Hz or rpm"));
            }
            (*angle, product.turns) = (0, 0);
        }
        let [lengths @ .., angle] = product.exponents;
        let [wanted @ .., wanted_angle] = self.exponents.map(i32::from);
        // An angle may be left out, as the radian is 1 in SI.
        if lengths != wanted || (angle != wanted_angle && angle != 0) {
            return Err(format!("{written} measures something else"));
        }
        let factor = product.factor();
        if !factor.is_normal() {
            return Err(self.in_words(Problem::Form, written));
        }
        let divisor = 1.0 / factor;
        // A power of ten that divides exactly is divided by: 9.525 mm is then the f64 nearest to 0.009525.
        let divides = factor < 1.0 && divisor.fract() == 0.0;
        Ok(if divides { Unit::Over(divisor) } else { Unit::Times(factor) })
    }

    /// Why a text is no unit.
    fn in_words(&self, problem: Problem<'_>, written: &str) -> String {
        match problem {
            Problem::Form => format!("{written} is not known as a unit"),
            Problem::Power => {
                format!("{written} is not known as a unit: powers are whole numbers from -4 to 4")
            }
            Problem::Name(name) => {
                let meant = known::nearest(name, &self.examples);
                let meant = meant.map_or(String::new(), |meant| format!(" (did you mean {meant}?)"));
                format!("{name} is not known as a unit{meant}")
            }
        }
    }
}

/// The number that a text begins with and the unit behind it, which may be none; nothing where there is no number.
pub fn split(text: &str) -> Option<(f64, &str)> {
    grammar::split(text).ok()
}

/// A unit by what makes SI of its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unit {
    /// SI is so many times the number.
    Times(f64),
    /// SI is the number over this.
    Over(f64),
    /// A temperature \[K] from its absolute zero; in degC it is so much less.
    Kelvin,
    /// A temperature \[degF]; 32 is 0 degC.
    Fahrenheit,
}

impl Unit {
    /// A number of this unit in SI, a temperature in degC.
    pub(crate) fn si(self, number: f64) -> f64 {
        match self {
            Self::Times(factor) => number * factor,
            Self::Over(divisor) => number / divisor,
            Self::Kelvin => number - 273.15,
            Self::Fahrenheit => (number - 32.0) * 5.0 / 9.0,
        }
    }
}

/// Reads a number in SI, or text with a unit.
struct Written(&'static Dimension);

impl Visitor<'_> for Written {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Dimension { name, unit, examples: [first, second], .. } = self.0;
        write!(f, "{name}, a number in {unit} or text with a unit such as \"{first}\" or \"{second}\"")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
        Ok(value)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<f64, E> {
        self.0.parse(text).map_err(E::custom)
    }
}

/// Defines one newtype per physical dimension, `f64` in the SI unit, deserialised from number or text.
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident = $unit:literal, $exponents:expr, $called:literal, $examples:expr;)*) => {
        /// Every dimension of a scene.
        pub const DIMENSIONS: &[Dimension] = &[$($name::DIMENSION),*];
    $(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $name(pub f64);

        impl Quantity for $name {
            const DIMENSION: Dimension =
                Dimension { name: $called, unit: $unit, exponents: $exponents, examples: $examples };
            fn si(self) -> f64 {
                self.0
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(Written(&Self::DIMENSION)).map(Self)
            }
        }
    )*};
}

/// A number of one physical dimension, in SI.
pub trait Quantity: Copy {
    /// Its dimension.
    const DIMENSION: Dimension;
    /// Value in that unit.
    fn si(self) -> f64;
}

quantities! {
    /// [-]
    Ratio = "1", [0, 0, 0, 0, 0], "a number without unit", ["8 %", "800 ppm"];
    /// \[m]
    Length = "m", [1, 0, 0, 0, 0], "a length", ["9.525 mm", "10 um"];
    /// \[rad]
    Angle = "rad", [0, 0, 0, 0, 1], "an angle", ["25 deg", "0.5 mrad"];
    /// \[Pa]
    Pressure = "Pa", [-1, 1, -2, 0, 0], "a pressure", ["206 GPa", "1500 MPa"];
    /// [kg/m3]
    Density = "kg/m^3", [-3, 1, 0, 0, 0], "a density", ["7800 kg/m^3", "7.8 g/cm^3"];
    /// \[kg]
    Mass = "kg", [0, 1, 0, 0, 0], "a mass", ["0.2 kg", "200 g"];
    /// [kg m2]
    Inertia = "kg m^2", [2, 1, 0, 0, 0], "a moment of inertia", ["6e-5 kg m^2", "60 kg mm^2"];
    /// [kg m] mass times its distance from an axis.
    Unbalance = "kg m", [1, 1, 0, 0, 0], "an unbalance", ["20 g mm", "1e-5 kg m"];
    /// \[s]
    Time = "s", [0, 0, 1, 0, 0], "a time", ["50 ms", "100 us"];
    /// \[N]
    Force = "N", [1, 1, -2, 0, 0], "a force", ["1500 N", "1.5 kN"];
    /// [N m]
    Moment = "N m", [2, 1, -2, 0, 0], "a moment", ["2 N m", "500 N mm"];
    /// [rad/s]
    AngularVelocity = "rad/s", [0, 0, -1, 0, 1], "an angular velocity", ["6000 rpm", "36000 deg/s"];
    /// \[Hz]
    Frequency = "Hz", [0, 0, -1, 0, 0], "a frequency", ["50 Hz", "2.3 kHz"];
    /// [rad/s2]
    AngularAcceleration = "rad/s^2", [0, 0, -2, 0, 1], "an angular acceleration", ["10 rad/s^2", "500 deg/s^2"];
    /// [Pa s]
    Viscosity = "Pa s", [-1, 1, -1, 0, 0], "a viscosity", ["18 uPa s", "20 mPa s"];
    /// [N/m]
    TranslationalStiffness = "N/m", [0, 1, -2, 0, 0], "a stiffness", ["1e8 N/m", "100 N/um"];
    /// [N m/rad]
    RotationalStiffness = "N m/rad", [2, 1, -2, 0, -1], "a stiffness against rotation", ["5e4 N m/rad", "50 kN m/rad"];
    /// [N s/m]
    TranslationalDamping = "N s/m", [0, 1, -1, 0, 0], "a damping", ["500 N s/m", "0.5 N s/mm"];
    /// [N m s/rad]
    RotationalDamping = "N m s/rad", [2, 1, -1, 0, -1], "a damping against rotation", ["0.5 N m s/rad", "500 N mm s/rad"];
    /// [m/s]
    Velocity = "m/s", [1, 0, -1, 0, 0], "a velocity", ["2 m/s", "500 mm/s"];
    /// [m/s2]
    Acceleration = "m/s^2", [1, 0, -2, 0, 0], "an acceleration", ["9.81 m/s^2", "9810 mm/s^2"];
    /// [m2/s]
    KinematicViscosity = "m^2/s", [2, 0, -1, 0, 0], "a kinematic viscosity", ["68 mm^2/s", "6.8e-5 m^2/s"];
    /// [s/m]
    DissipationFactor = "s/m", [-1, 0, 1, 0, 0], "a dissipation factor", ["0.02 s/m", "20 s/km"];
    /// \[K] difference of two temperatures.
    TemperatureRise = "K", [0, 0, 0, 1, 0], "a difference of temperatures", ["40 K", "500 mK"];
    /// \[degC] temperature, with a zero that depends on the unit: nothing but viscosities follows it.
    Celsius = "degC", [0, 0, 0, 1, 0], "a temperature", ["70 degC", "343.15 K"];
    /// [1/Pa]
    PressureViscosity = "1/Pa", [1, -1, 2, 0, 0], "a growth of viscosity with pressure", ["22 1/GPa", "2.2e-8 1/Pa"];
    /// [1/K]
    ThermalExpansion = "1/K", [0, 0, 0, -1, 0], "a coefficient of thermal expansion", ["12e-6 1/K", "0.012 1/kK"];
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse<Q: Quantity>(text: &str) -> Result<f64, String> {
        Q::DIMENSION.parse(text)
    }

    #[test]
    fn closed_form_conversions_are_exact() {
        assert_eq!(parse::<Length>("9.525 mm"), Ok(9.525e-3));
        assert_eq!(parse::<Length>("10 um"), Ok(1e-5));
        assert_eq!([parse::<Celsius>("70 degC"), parse::<Celsius>("343.15 K")], [Ok(70.0), Ok(70.0)]);
        assert!(parse::<Celsius>("70 F").unwrap_err().contains("write degC or K"));
        for text in ["22 1/GPa", "2.2e-8 1/Pa", "2.2e-8 Pa^-1", "2.2e-8 / Pa"] {
            assert!((parse::<PressureViscosity>(text).unwrap() / 2.2e-8 - 1.0).abs() < 1e-15, "{text}");
        }
        for text in ["12e-6 1/K", "0.012 1/kK"] {
            assert!((parse::<ThermalExpansion>(text).unwrap() / 12e-6 - 1.0).abs() < 1e-15, "{text}");
        }
        assert_eq!(parse::<Pressure>("206 GPa"), Ok(206e9));
        assert_eq!(parse::<Force>("1.5 kN"), Ok(1500.0));
        assert_eq!(parse::<Moment>("2 N.m"), Ok(2.0));
        assert_eq!(parse::<Angle>("25 deg"), Ok(25.0 * (std::f64::consts::PI / 180.0)));
        let speed = parse::<AngularVelocity>("6000 rpm").unwrap();
        assert!((speed / (200.0 * std::f64::consts::PI) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn closed_form_units_as_catalogues_write_them() {
        for text in ["0.01mm", "10 \u{b5}m", "10 \u{3bc}m", "10\u{b5}m", "1e-5 m", "1e-5m"] {
            assert_eq!(parse::<Length>(text), Ok(1e-5), "{text}");
        }
        for text in
            ["2 Nm", "2 N\u{b7}m", "2 N\u{22c5}m", "2 N m", "2 N*m", "2000 Nmm", "2000 N mm", "0.002 kNm"]
        {
            assert_eq!(parse::<Moment>(text), Ok(2.0), "{text}");
        }
        for text in ["3 mrad", "3mrad", "3000 urad", "3000 \u{b5}rad", "3000 \u{3bc}rad", "0.003 rad"] {
            assert_eq!(parse::<Angle>(text), Ok(0.003), "{text}");
        }
        for text in ["0.25 kg m\u{b2}", "0.25 kg\u{b7}m\u{b2}", "0.25 kg m^2", "0.25 kg m2", "0.25 kg.m2"] {
            assert_eq!(parse::<Inertia>(text), Ok(0.25), "{text}");
        }
        for text in ["7800 kg/m\u{b3}", "7800 kg/m^3", "7800 kg/m3"] {
            assert_eq!(parse::<Density>(text), Ok(7800.0), "{text}");
        }
        assert_eq!(parse::<Angle>("25\u{b0}"), parse::<Angle>("25 deg"));
        for text in ["10 mm/s", "10 mm s^-1", "10 mm s\u{207b}\u{b9}", "10 mm s-1"] {
            assert_eq!(parse::<Velocity>(text), Ok(0.01), "{text}");
        }
    }

    #[test]
    fn closed_form_frequencies_count_periods() {
        for (text, hertz) in [("2.3 kHz", 2300.0), ("50 1/s", 50.0), ("50 Hz", 50.0)] {
            assert_eq!(parse::<Frequency>(text), Ok(hertz), "{text}");
        }
        for text in ["6000 rpm", "6000 1/min", "6000 /min"] {
            assert!((parse::<Frequency>(text).unwrap() / 100.0 - 1.0).abs() < 1e-15, "{text}");
        }
        for text in ["314 rad/s", "18000 deg/s", "2 rev^2/s"] {
            let message = parse::<Frequency>(text).unwrap_err();
            assert!(message.contains("write Hz or rpm") && message.contains(text), "{message}");
        }
        assert_eq!([parse::<Unbalance>("20 g mm"), parse::<Unbalance>("20 g*mm")], [Ok(2e-5), Ok(2e-5)]);
    }

    #[test]
    fn regression_a_number_per_minute_is_a_speed_and_a_frequency_is_none() {
        let speed = parse::<AngularVelocity>("3000 rpm").unwrap();
        assert!((speed / (100.0 * std::f64::consts::PI) - 1.0).abs() < 1e-15);
        for text in [
            "3000 min^-1",
            "3000 /min",
            "3000/min",
            "3000 1/min",
            "3000 1 / min",
            "3000 min-1",
            "3000 min\u{207b}\u{b9}",
            "3000 r/min",
            "3000 rev/min",
        ] {
            assert_eq!(parse::<AngularVelocity>(text), Ok(speed), "{text}");
        }
        assert!((parse::<AngularVelocity>("18000 deg/s").unwrap() / speed - 1.0).abs() < 1e-15);
        assert_eq!(parse::<AngularVelocity>("2 krad/s").ok(), None);
        assert_eq!(parse::<AngularVelocity>("314 rad/s"), Ok(314.0));
        assert_eq!(parse::<AngularVelocity>("314 rad s^-1"), Ok(314.0));
        for text in ["50 Hz", "50 1/s", "50 /s", "50 s^-1", "3000 1/(60 s)", "3 kHz", "50 rad^2/s"] {
            let message = parse::<AngularVelocity>(text).unwrap_err();
            assert!(message.contains(text), "{message}");
            assert!(text == "3000 1/(60 s)" || message.contains("rpm, rad/s or deg/s"), "{message}");
        }
    }

    #[test]
    fn wrong_text_is_refused_with_its_reason_and_examples() {
        let length = parse::<Length>;
        for (message, text, part) in [
            (parse::<Force>("10 um"), "10 um", "um measures something else"),
            (length("mm"), "mm", "begin with a number"),
            (length("10"), "10", "unit is missing"),
            (length("1e999 m"), "1e999 m", "out of range"),
            (length("NaN m"), "NaN m", "begin with a number"),
            (length("10 florps"), "10 florps", "florps is not known"),
            (length("2 @plain"), "2 @plain", "@plain is not known"),
            (length("2 m^^3"), "2 m^^3", "not known"),
            (length("2 m^66"), "2 m^66", "not known"),
            (length("2 (m"), "2 (m", "not known"),
            (length("2 to mm"), "2 to mm", "to is not known"),
        ] {
            let message = message.unwrap_err();
            let example = if message.contains("force") { "1.5 kN" } else { "9.525 mm" };
            for part in [part, text, example] {
                assert!(message.contains(part), "{message}\nshould name {part}");
            }
            // Nothing of the calculator.
            for word in ["base units", "identifier", "parse", "expected", "evaluat"] {
                assert!(!message.contains(word), "{message}");
            }
        }
    }
}
