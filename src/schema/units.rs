//! Numbers with units in scene files: a plain number in SI, or text such as `"9.525 mm"` or `"6000 rpm"`.
//!
//! Conversion and dimension check are done exactly by `fend-core`; this module only names the SI unit that each
//! field wants and turns the answer into an `f64`.

use serde::Deserialize;
use serde::de::{Deserializer, Error};

/// Longest accepted text; anything longer is not a number with a unit.
const MAX_TEXT: usize = 48;
/// [-] largest decimal exponent accepted, so that an exact calculator is not asked for a million digits.
const MAX_EXPONENT: i32 = 99;

/// A value as written: a number in SI or text with a unit.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a number in SI or text with a unit, such as \"9.525 mm\"")]
enum Written {
    Number(f64),
    Text(String),
}

/// Converts text such as `"9.525 mm"` to the SI unit `unit` (`"1"` for a pure number).
///
/// # Errors
/// A sentence naming the text and what was expected.
pub fn parse(text: &str, unit: &str) -> Result<f64, String> {
    let refuse = |why: &str| Err(format!("\"{text}\" is not a quantity in {unit}: {why}"));
    let allowed = |c: char| c.is_ascii_alphanumeric() || " .+-*/^()_µ°".contains(c);
    if text.len() > MAX_TEXT || !text.chars().all(allowed) || text.contains("^^") {
        return refuse("write a number and a unit, such as \"9.525 mm\"");
    }
    let mut parts = text.trim().splitn(2, |c: char| c.is_whitespace());
    let number = parts.next().unwrap_or_default();
    let Ok(number) = number.parse::<f64>() else {
        return refuse("it must begin with a number, then a space and a unit");
    };
    if !number.is_finite() || (number != 0.0 && number.abs().log10().abs() > f64::from(MAX_EXPONENT)) {
        return refuse("the number is out of range");
    }
    // "N.m" is the SI way to write a product; the calculator wants a star.
    let written_unit = parts.next().unwrap_or("").trim().replace('.', "*");
    if written_unit.is_empty() {
        return refuse("the unit is missing (a bare number in SI is written without quotes)");
    }
    if written_unit.chars().any(|c| c.is_ascii_digit() && !"123456".contains(c)) {
        return refuse("the unit is not known");
    }
    let question = format!("(1 {written_unit}) to 20 sf to {unit}");
    let answer = match fend_core::evaluate(&question, &mut fend_core::Context::new()) {
        Ok(answer) => answer.get_main_result().trim_start_matches("approx. ").to_string(),
        Err(why) => return refuse(&why),
    };
    // The calculator answers "factor unit", exactly for all units but those with pi.
    let factor = answer.split_whitespace().next().and_then(|word| word.parse::<f64>().ok());
    match factor {
        // A power of ten that divides exactly is divided by: 9.525 mm is then the f64 nearest to 0.009525.
        Some(factor) if factor < 1.0 && (1.0 / factor).fract() == 0.0 => Ok(number / (1.0 / factor)),
        Some(factor) => Ok(number * factor),
        None => refuse("the unit is not known"),
    }
}

fn convert<E: Error>(written: &Written, unit: &str) -> Result<f64, E> {
    match written {
        Written::Number(value) => Ok(*value),
        Written::Text(text) => parse(text, unit).map_err(E::custom),
    }
}

/// Defines one newtype per physical dimension, `f64` in the SI unit, deserialised from number or text.
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident = $unit:literal;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $name(pub f64);

        impl Quantity for $name {
            const UNIT: &'static str = $unit;
            fn si(self) -> f64 {
                self.0
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                Ok(Self(convert(&Written::deserialize(deserializer)?, $unit)?))
            }
        }
    )*};
}

/// A number of one physical dimension, in SI.
pub trait Quantity: Copy {
    /// Name of the SI unit.
    const UNIT: &'static str;
    /// Value in that unit.
    fn si(self) -> f64;
}

quantities! {
    /// [-]
    Ratio = "1";
    /// \[m]
    Length = "m";
    /// \[rad]
    Angle = "rad";
    /// \[Pa]
    Pressure = "Pa";
    /// [kg/m3]
    Density = "kg/m^3";
    /// \[kg]
    Mass = "kg";
    /// [kg m2]
    Inertia = "kg m^2";
    /// \[s]
    Time = "s";
    /// \[N]
    Force = "N";
    /// [N m]
    Moment = "N m";
    /// [rad/s]
    AngularVelocity = "rad/s";
    /// [m/s]
    Velocity = "m/s";
    /// [m/s2]
    Acceleration = "m/s^2";
    /// [s/m]
    DissipationFactor = "s/m";
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn closed_form_conversions_are_exact() {
        assert_eq!(parse("9.525 mm", "m"), Ok(9.525e-3));
        assert_eq!(parse("10 um", "m"), Ok(1e-5));
        assert_eq!(parse("206 GPa", "Pa"), Ok(206e9));
        assert_eq!(parse("1.5 kN", "N"), Ok(1500.0));
        assert_eq!(parse("2 N.m", "N m"), Ok(2.0));
        assert_eq!(parse("25 deg", "rad"), Ok(25.0 * (std::f64::consts::PI / 180.0)));
        let speed = parse("6000 rpm", "rad/s").unwrap();
        assert!((speed / (200.0 * std::f64::consts::PI) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn wrong_text_is_refused_with_its_reason() {
        for (text, unit, part) in [
            ("10 um", "N", "incompatible"),
            ("mm", "m", "begin with a number"),
            ("10", "m", "unit is missing"),
            ("1e999 m", "m", "out of range"),
            ("NaN m", "m", "out of range"),
            ("10 florps", "m", "florps"),
            ("2 @plain", "m", "write a number"),
        ] {
            let message = parse(text, unit).unwrap_err();
            assert!(message.contains(part) && message.contains(text), "{message}");
        }
    }
}
