//! Every entry of the table of units against factors from elsewhere.

use roulement::scene::units::known::{KNOWN, PREFIXES, find};
use roulement::scene::units::{DIMENSIONS, Exponents};

use super::dimension;

/// Inch \[m], pound \[kg], standard gravity \[m/s2]: exact by definition (NIST SP 811, appendix B).
const INCH: f64 = 0.0254;
const POUND: f64 = 0.453_592_37;
const GRAVITY: f64 = 9.806_65;
const PI: f64 = std::f64::consts::PI;

/// Units with a name for each, the dimension that has them, and the factor to SI: as it follows from definitions, and as NIST SP 811
/// (2008), appendix B, prints it in seven digits, or UCUM for those that are exact there.
// The printed digits are data, near constants as they are.
#[allow(clippy::approx_constant)]
pub const FACTORS: [(&str, &str, f64, f64); 52] = [
    ("m", "Length", 1.0, 1.0),
    ("micron", "Length", 1e-6, 1e-6),
    ("in", "Length", INCH, 2.54e-2),
    ("ft", "Length", 12.0 * INCH, 3.048e-1),
    ("thou", "Length", 1e-3 * INCH, 2.54e-5),
    ("uin", "Length", 1e-6 * INCH, 2.54e-8),
    ("rad", "Angle", 1.0, 1.0),
    ("mrad", "Angle", 1e-3, 1e-3),
    ("urad", "Angle", 1e-6, 1e-6),
    ("deg", "Angle", PI / 180.0, 1.745_329e-2),
    ("arcmin", "Angle", PI / 180.0 / 60.0, 2.908_882e-4),
    ("arcsec", "Angle", PI / 180.0 / 3600.0, 4.848_137e-6),
    ("gon", "Angle", PI / 200.0, 1.570_796e-2),
    ("rev", "Angle", 2.0 * PI, 6.283_185),
    ("g", "Mass", 1e-3, 1e-3),
    ("t", "Mass", 1e3, 1e3),
    ("lb", "Mass", POUND, 4.535_924e-1),
    ("oz", "Mass", POUND / 16.0, 2.834_952e-2),
    ("slug", "Mass", POUND * GRAVITY / (12.0 * INCH), 1.459_390e1),
    ("s", "Time", 1.0, 1.0),
    ("min", "Time", 60.0, 6e1),
    ("h", "Time", 3600.0, 3.6e3),
    ("d", "Time", 86_400.0, 8.64e4),
    ("Hz", "Frequency", 1.0, 1.0),
    ("rpm", "AngularVelocity", 2.0 * PI / 60.0, 1.047_198e-1),
    ("K", "TemperatureRise", 1.0, 1.0),
    // A difference alone is not written in these: a temperature may be meant.
    ("degC", "Expansion", 1.0, 1.0),
    ("degF", "Expansion", 1.0 / 1.8, 5.555_556e-1),
    ("N", "Force", 1.0, 1.0),
    ("dyn", "Force", 1e-5, 1e-5),
    ("gf", "Force", 1e-3 * GRAVITY, 9.806_65e-3),
    ("kgf", "Force", GRAVITY, 9.806_65),
    ("lbf", "Force", POUND * GRAVITY, 4.448_222),
    ("ozf", "Force", POUND * GRAVITY / 16.0, 2.780_139e-1),
    ("kip", "Force", 1000.0 * POUND * GRAVITY, 4.448_222e3),
    ("Nm", "Moment", 1.0, 1.0),
    ("Ncm", "Moment", 1e-2, 1e-2),
    ("Nmm", "Moment", 1e-3, 1e-3),
    ("Pa", "Pressure", 1.0, 1.0),
    ("bar", "Pressure", 1e5, 1e5),
    ("atm", "Pressure", 101_325.0, 1.013_25e5),
    ("psi", "Pressure", POUND * GRAVITY / (INCH * INCH), 6.894_757e3),
    ("ksi", "Pressure", 1e3 * POUND * GRAVITY / (INCH * INCH), 6.894_757e6),
    ("Msi", "Pressure", 1e6 * POUND * GRAVITY / (INCH * INCH), 6.894_757e9),
    ("P", "Viscosity", 0.1, 1e-1),
    ("Pas", "Viscosity", 1.0, 1.0),
    // A reyn is a pound-force second per square inch.
    ("reyn", "Viscosity", POUND * GRAVITY / (INCH * INCH), 6.894_757e3),
    ("St", "KinematicViscosity", 1e-4, 1e-4),
    ("l", "Volume", 1e-3, 1e-3),
    ("cc", "Volume", 1e-6, 1e-6),
    ("%", "Ratio", 1e-2, 1e-2),
    ("ppm", "Ratio", 1e-6, 1e-6),
];

/// Products of them that catalogues write: text, dimension, and the value in SI.
const TRADE: [(&str, &str, f64); 36] = [
    ("0.3125 in", "Length", 0.3125 * INCH),
    ("0.4 thou", "Length", 0.4e-3 * INCH),
    ("2 lbf in", "Moment", 2.0 * POUND * GRAVITY * INCH),
    ("2 lbf-in", "Moment", 2.0 * POUND * GRAVITY * INCH),
    ("2 in\u{b7}lbf", "Moment", 2.0 * POUND * GRAVITY * INCH),
    ("3 lbf ft", "Moment", 36.0 * POUND * GRAVITY * INCH),
    ("5 ozf in", "Moment", 5.0 / 16.0 * POUND * GRAVITY * INCH),
    ("1 daNm", "Moment", 10.0),
    ("5 cNm", "Moment", 0.05),
    ("2 mN m", "Moment", 0.002),
    ("5 oz in", "Unbalance", 5.0 / 16.0 * POUND * INCH),
    ("7 lb in^2", "Inertia", 7.0 * POUND * INCH * INCH),
    ("7 lbm in2", "Inertia", 7.0 * POUND * INCH * INCH),
    ("7 lbf in s^2", "Inertia", 7.0 * POUND * GRAVITY * INCH),
    ("0.283 lb/in^3", "Density", 0.283 * POUND / (INCH * INCH * INCH)),
    ("0.87 kg/l", "Density", 870.0),
    ("0.87 g/mL", "Density", 870.0),
    ("0.87 g/cc", "Density", 870.0),
    ("68 cSt", "KinematicViscosity", 68e-6),
    ("68 mm2/s", "KinematicViscosity", 68e-6),
    ("18 cP", "Viscosity", 0.018),
    ("18 mPas", "Viscosity", 0.018),
    ("2 ureyn", "Viscosity", 2e-6 * POUND * GRAVITY / (INCH * INCH)),
    ("1.5 1/ksi", "PressureViscosity", 1.5e-3 * INCH * INCH / (POUND * GRAVITY)),
    ("22 mm^2/kN", "PressureViscosity", 22e-9),
    ("30 Mpsi", "Pressure", 30e6 * POUND * GRAVITY / (INCH * INCH)),
    ("1 lbf/in^2", "Pressure", POUND * GRAVITY / (INCH * INCH)),
    ("300 kgf/mm2", "Pressure", 3e8 * GRAVITY),
    ("1 lbf/in", "TranslationalStiffness", POUND * GRAVITY / INCH),
    ("1 lbf s/in", "TranslationalDamping", POUND * GRAVITY / INCH),
    ("1 lbf in/deg", "RotationalStiffness", POUND * GRAVITY * INCH * 180.0 / PI),
    ("100 in/s", "Velocity", 100.0 * INCH),
    ("386.4 in/s2", "Acceleration", 386.4 * INCH),
    ("12 um/(m K)", "ThermalExpansion", 12e-6),
    ("12 ppm/\u{b0}C", "ThermalExpansion", 12e-6),
    ("6.7e-6 in/(in degF)", "ThermalExpansion", 6.7e-6 * 1.8),
];

/// Rounding of a few products.
const ROUNDING: f64 = 1e-15;

#[test]
fn closed_form_and_published_number_every_known_unit() {
    assert_eq!(FACTORS.len(), KNOWN.len());
    for (known, (name, of, factor, printed)) in KNOWN.iter().zip(FACTORS) {
        assert!(known.names().any(|other| other == name), "{name} is not {known:?}");
        assert!((factor / printed - 1.0).abs() <= 5.1e-7, "{name}: {factor} and {printed}");
        for name in known.names() {
            let (text, dimension) = match of {
                "Volume" => (format!("1 kg/{name}"), dimension("Density")),
                "Expansion" => (format!("1 1/{name}"), dimension("ThermalExpansion")),
                _ => (format!("1 {name}"), dimension(of)),
            };
            let factor = if matches!(of, "Volume" | "Expansion") { 1.0 / factor } else { factor };
            let read = dimension.parse(&text).unwrap_or_else(|why| panic!("{why}"));
            assert!((read / factor - 1.0).abs() < ROUNDING, "{text}: {read} and {factor}");
        }
        assert!((known.size() / factor - 1.0).abs() < ROUNDING, "{name}: {}", known.size());
    }
}

#[test]
fn closed_form_units_of_the_trade() {
    for (text, of, expected) in TRADE {
        let read = dimension(of).parse(text).unwrap_or_else(|why| panic!("{why}"));
        assert!((read / expected - 1.0).abs() < ROUNDING, "{text}: {read} and {expected}");
    }
}

/// Prefixes of SI (SI brochure, table 7).
#[test]
fn closed_form_prefixes_stand_before_those_that_take_them() {
    let powers = [
        ("T", "tera", 1e12),
        ("G", "giga", 1e9),
        ("M", "mega", 1e6),
        ("k", "kilo", 1e3),
        ("h", "hecto", 1e2),
        ("da", "deca", 1e1),
        ("d", "deci", 1e-1),
        ("c", "centi", 1e-2),
        ("m", "milli", 1e-3),
        ("u", "micro", 1e-6),
        ("\u{b5}", "micro", 1e-6),
        ("\u{3bc}", "micro", 1e-6),
        ("n", "nano", 1e-9),
        ("p", "pico", 1e-12),
    ];
    assert_eq!(powers.len(), PREFIXES.len());
    for (known, (_, of, factor, _)) in KNOWN.iter().zip(FACTORS) {
        let of = match of {
            "Volume" => continue,
            "Expansion" => "TemperatureRise",
            of => of,
        };
        for (symbol, word, power) in powers {
            let symbols = known.symbols.iter().map(|name| format!("{symbol}{name}"));
            let words = known.words.iter().map(|name| format!("{word}{name}"));
            for name in symbols.chain(words) {
                let read = dimension(of).parse(&format!("1 {name}"));
                let other = KNOWN.iter().any(|other| other.names().any(|exact| exact == name));
                match read {
                    Ok(read) if known.prefixes => {
                        assert!((read / (power * factor) - 1.0).abs() < ROUNDING, "{name}: {read}");
                    }
                    read => assert!(!known.prefixes && (read.is_err() || other), "{name}: {read:?}"),
                }
            }
        }
    }
}

/// A name that could be read in two ways would be read in one of them without a word.
#[test]
fn invariant_every_name_stands_for_one_unit() {
    let mut names: Vec<String> = KNOWN.iter().flat_map(|known| known.names().map(str::to_string)).collect();
    for known in KNOWN.iter().filter(|known| known.prefixes) {
        for (symbol, word, _) in PREFIXES {
            names.extend(known.symbols.iter().map(|name| format!("{symbol}{name}")));
            // The words of both signs for micro are the same.
            if symbol.is_ascii() {
                names.extend(known.words.iter().map(|name| format!("{word}{name}")));
            }
        }
    }
    for name in &names {
        assert!(find(name).is_some(), "{name}");
    }
    names.sort();
    let twice: Vec<&[String]> = names.windows(2).filter(|pair| pair[0] == pair[1]).collect();
    assert!(twice.is_empty(), "{twice:?}");
}

#[test]
fn closed_form_temperatures_with_their_zeros() {
    let celsius = dimension("Celsius");
    for (text, expected) in [
        ("32 degF", 0.0),
        ("212 \u{b0}F", 100.0),
        ("-40 degF", -40.0),
        ("70 \u{b0}C", 70.0),
        ("70 Cel", 70.0),
    ] {
        assert_eq!(celsius.parse(text), Ok(expected), "{text}");
    }
    // A difference has no zero: with that of a temperature something else may be meant.
    let rise = dimension("TemperatureRise");
    assert_eq!(rise.parse("40 K"), Ok(40.0));
    for text in ["40 degC", "40 \u{b0}C", "40 Cel", "90 degF"] {
        assert!(rise.parse(text).unwrap_err().contains("is written in K"), "{text}");
    }
}

#[test]
fn every_dimension_has_its_exponents_and_reads_its_unit_and_examples() {
    for dimension in DIMENSIONS {
        assert_eq!(dimension.parse(&format!("1.5 {}", dimension.unit)), Ok(1.5), "{dimension:?}");
        for text in dimension.examples {
            assert!(dimension.parse(text).is_ok(), "{:?}", dimension.parse(text));
        }
    }
    // A dimension refuses the units of all others, but for angles that may be left out and for zeros of temperatures.
    let without_angle = |[exponents @ .., _]: Exponents| exponents;
    for one in DIMENSIONS {
        for other in
            DIMENSIONS.iter().filter(|other| without_angle(other.exponents) != without_angle(one.exponents))
        {
            assert!(one.parse(&format!("1 {}", other.unit)).is_err(), "{one:?} {other:?}");
        }
    }
}
