//! The units that are known, in one table with exact factors, and what a name stands for.

use super::Exponents;
use super::product::Product;
use crate::schema::explain::edits;

/// A unit with all its names.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Symbols, the usual one first; none where only words are in use.
    pub symbols: &'static [&'static str],
    /// Words, in small letters; a scene may write them with capital ones.
    pub words: &'static [&'static str],
    /// Exponents of m, kg, s, K and rad; an angle given in turns is one too.
    pub exponents: Exponents,
    /// Numerator and divisor of its size in SI, exactly; a turn counts as 1.
    pub factor: [u64; 2],
    /// Is it counted in turns, of 2 pi rad?
    pub turns: bool,
    /// Does its size in SI have the factor pi besides?
    pub pi: bool,
    /// Do prefixes stand before its symbols, and written out before its words?
    pub prefixes: bool,
}

const fn unit(
    symbols: &'static [&'static str],
    words: &'static [&'static str],
    exponents: Exponents,
    factor: [u64; 2],
) -> Known {
    Known { symbols, words, exponents, factor, turns: false, pi: false, prefixes: false }
}

impl Known {
    const fn prefixed(self) -> Self {
        Self { prefixes: true, ..self }
    }

    const fn in_turns(self) -> Self {
        Self { turns: true, ..self }
    }

    const fn times_pi(self) -> Self {
        Self { pi: true, ..self }
    }
}

const LENGTH: Exponents = [1, 0, 0, 0, 0];
const VOLUME: Exponents = [3, 0, 0, 0, 0];
const MASS: Exponents = [0, 1, 0, 0, 0];
const TIME: Exponents = [0, 0, 1, 0, 0];
const PER_TIME: Exponents = [0, 0, -1, 0, 0];
const TEMPERATURE: Exponents = [0, 0, 0, 1, 0];
const ANGLE: Exponents = [0, 0, 0, 0, 1];
const SPEED: Exponents = [0, 0, -1, 0, 1];
const FORCE: Exponents = [1, 1, -2, 0, 0];
const MOMENT: Exponents = [2, 1, -2, 0, 0];
const PRESSURE: Exponents = [-1, 1, -2, 0, 0];
const VISCOSITY: Exponents = [-1, 1, -1, 0, 0];
const KINEMATIC: Exponents = [2, 0, -1, 0, 0];
const NUMBER: Exponents = [0; 5];

// The inch is 25.4 mm, the pound 0.45359237 kg, standard gravity 9.80665 m/s2, all exactly; what follows from them is reduced.
/// Every known unit.
#[rustfmt::skip]
pub const KNOWN: [Known; 52] = [
    unit(&["m"], &["metre", "metres", "meter", "meters"], LENGTH, [1, 1]).prefixed(),
    unit(&[], &["micron", "microns"], LENGTH, [1, 1_000_000]),
    unit(&["in"], &["inch", "inches"], LENGTH, [127, 5000]),
    unit(&["ft"], &["foot", "feet"], LENGTH, [381, 1250]),
    unit(&["thou", "mil"], &["mils"], LENGTH, [127, 5_000_000]),
    unit(&["uin", "\u{b5}in", "\u{3bc}in"], &["microinch", "microinches"], LENGTH, [127, 5_000_000_000]),
    unit(&["rad"], &["radian", "radians"], ANGLE, [1, 1]),
    unit(&["mrad"], &["milliradian", "milliradians"], ANGLE, [1, 1000]),
    unit(&["urad", "\u{b5}rad", "\u{3bc}rad"], &["microradian", "microradians"], ANGLE, [1, 1_000_000]),
    unit(&["deg", "\u{b0}"], &["degs", "degree", "degrees"], ANGLE, [1, 180]).times_pi(),
    unit(&["arcmin"], &["arcminute", "arcminutes"], ANGLE, [1, 10_800]).times_pi(),
    unit(&["arcsec"], &["arcsecond", "arcseconds"], ANGLE, [1, 648_000]).times_pi(),
    unit(&["gon", "grd", "grad"], &["gradian", "gradians"], ANGLE, [1, 200]).times_pi(),
    unit(&["rev", "r"], &["turn", "turns", "revs", "revolution", "revolutions"], ANGLE, [1, 1]).in_turns(),
    unit(&["g"], &["gram", "grams"], MASS, [1, 1000]).prefixed(),
    unit(&["t"], &["tonne", "tonnes"], MASS, [1000, 1]),
    unit(&["lb", "lbm", "lbs"], &["pound", "pounds"], MASS, [45_359_237, 100_000_000]),
    unit(&["oz"], &["ounce", "ounces"], MASS, [45_359_237, 1_600_000_000]),
    unit(&["slug"], &["slugs"], MASS, [8_896_443_230_521, 609_600_000_000]),
    unit(&["s", "sec"], &["second", "seconds"], TIME, [1, 1]).prefixed(),
    unit(&["min"], &["minute", "minutes"], TIME, [60, 1]),
    unit(&["h", "hr"], &["hour", "hours"], TIME, [3600, 1]),
    unit(&["d"], &["day", "days"], TIME, [86_400, 1]),
    unit(&["Hz"], &["hertz"], PER_TIME, [1, 1]).prefixed(),
    unit(&["rpm"], &[], SPEED, [1, 60]).in_turns(),
    unit(&["K"], &["kelvin"], TEMPERATURE, [1, 1]).prefixed(),
    unit(&["degC", "\u{b0}C", "Cel"], &[], TEMPERATURE, [1, 1]),
    unit(&["degF", "\u{b0}F"], &[], TEMPERATURE, [5, 9]),
    unit(&["N"], &["newton", "newtons"], FORCE, [1, 1]).prefixed(),
    unit(&["dyn"], &["dyne", "dynes"], FORCE, [1, 100_000]),
    unit(&["gf"], &[], FORCE, [980_665, 100_000_000]),
    unit(&["kgf", "kp"], &[], FORCE, [980_665, 100_000]),
    unit(&["lbf"], &[], FORCE, [8_896_443_230_521, 2_000_000_000_000]),
    unit(&["ozf"], &[], FORCE, [8_896_443_230_521, 32_000_000_000_000]),
    unit(&["kip"], &["kips"], FORCE, [8_896_443_230_521, 2_000_000_000]),
    unit(&["Nm"], &[], MOMENT, [1, 1]).prefixed(),
    unit(&["Ncm"], &[], MOMENT, [1, 100]).prefixed(),
    unit(&["Nmm"], &[], MOMENT, [1, 1000]).prefixed(),
    unit(&["Pa"], &["pascal", "pascals"], PRESSURE, [1, 1]).prefixed(),
    unit(&["bar"], &["bars"], PRESSURE, [100_000, 1]).prefixed(),
    unit(&["atm"], &[], PRESSURE, [101_325, 1]),
    unit(&["psi"], &[], PRESSURE, [8_896_443_230_521, 1_290_320_000]).prefixed(),
    unit(&["ksi"], &[], PRESSURE, [8_896_443_230_521, 1_290_320]),
    unit(&["Msi"], &[], PRESSURE, [8_896_443_230_521_000, 1_290_320]),
    unit(&["P"], &["poise", "poises"], VISCOSITY, [1, 10]).prefixed(),
    unit(&["Pas"], &[], VISCOSITY, [1, 1]).prefixed(),
    unit(&["reyn"], &["reyns"], VISCOSITY, [8_896_443_230_521, 1_290_320_000]).prefixed(),
    unit(&["St"], &["stokes"], KINEMATIC, [1, 10_000]).prefixed(),
    unit(&["l", "L"], &["litre", "litres", "liter", "liters"], VOLUME, [1, 1000]).prefixed(),
    unit(&["cc"], &[], VOLUME, [1, 1_000_000]),
    unit(&["%"], &["percent"], NUMBER, [1, 100]),
    unit(&["ppm"], &[], NUMBER, [1, 1_000_000]),
];

/// SI prefixes: symbol, word, power of ten. Both signs for micro, and u, are one prefix.
pub const PREFIXES: [(&str, &str, i32); 14] = [
    ("k", "kilo", 3),
    ("M", "mega", 6),
    ("G", "giga", 9),
    ("m", "milli", -3),
    ("u", "micro", -6),
    ("\u{b5}", "micro", -6),
    ("\u{3bc}", "micro", -6),
    ("n", "nano", -9),
    ("c", "centi", -2),
    ("d", "deci", -1),
    ("da", "deca", 1),
    ("h", "hecto", 2),
    ("T", "tera", 12),
    ("p", "pico", -12),
];

impl Known {
    /// All names without prefixes.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.symbols.iter().chain(self.words).copied()
    }

    /// How much of SI it is.
    pub fn size(&self) -> f64 {
        Product::of(self, 0).map_or(f64::NAN, |unit| unit.factor())
    }

    fn has_word(&self, name: &str) -> bool {
        self.words.iter().any(|word| word.eq_ignore_ascii_case(name))
    }
}

/// The unit that a name stands for, and the power of ten of its prefix. A name without prefix comes first: `min` is a minute.
pub fn find(name: &str) -> Option<(&'static Known, i32)> {
    let whole = KNOWN.iter().find(|known| known.symbols.contains(&name) || known.has_word(name));
    if let Some(known) = whole {
        return Some((known, 0));
    }
    PREFIXES.iter().find_map(|(symbol, word, power)| {
        let mut prefixed = KNOWN.iter().filter(|known| known.prefixes);
        let of_symbol = name
            .strip_prefix(symbol)
            .and_then(|rest| prefixed.clone().find(|known| known.symbols.contains(&rest)));
        let of_word = || {
            let (head, rest) = name.split_at_checked(word.len())?;
            head.eq_ignore_ascii_case(word).then(|| prefixed.find(|known| known.has_word(rest)))?
        };
        of_symbol.or_else(of_word).map(|known| (known, *power))
    })
}

/// The name that an unknown one is meant for perhaps: the same with other capital letters, or with few other letters. Those in
/// `usual` texts come first.
pub fn nearest(unknown: &str, usual: &[&str]) -> Option<String> {
    let length = unknown.chars().count();
    let most = length / 3;
    let is_usual = |name: &str| usual.iter().any(|text| text.split([' ', '/', '^']).any(|word| word == name));
    let mut best: Option<((usize, bool, usize), String)> = None;
    let mut consider = |prefix: &str, name: &str| {
        if (prefix.chars().count() + name.chars().count()).abs_diff(length) > most {
            return;
        }
        let name = format!("{prefix}{name}");
        let letters = if name.eq_ignore_ascii_case(unknown) { 0 } else { edits(unknown, &name) };
        if letters > most {
            return;
        }
        let rank = (letters, !is_usual(&name), edits(unknown, &name));
        if best.as_ref().is_none_or(|(least, _)| rank < *least) {
            best = Some((rank, name));
        }
    };
    for known in &KNOWN {
        known.names().for_each(|name| consider("", name));
    }
    for (symbol, word, _) in &PREFIXES {
        for known in KNOWN.iter().filter(|known| known.prefixes) {
            known.symbols.iter().for_each(|name| consider(symbol, name));
            known.words.iter().for_each(|name| consider(word, name));
        }
    }
    best.map(|(_, name)| name)
}
