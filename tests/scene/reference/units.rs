//! The tables of units, as the library has them.

use std::fmt::Write as _;

use roulement::scene::units::known::{KNOWN, Known, PREFIXES};
use roulement::scene::units::{DIMENSIONS, Dimension, Exponents};

const HEAD: &str = "\
A text is a number and a unit: a product or a quotient of the units below, with powers from -4 to 4. `N m`, `N*m`, `N.m`, `N·m` and \
`lbf-in` are products, `m^2`, `m2`, `m²`, `s^-1` and `s-1` powers, `N s/m`, `1/min` and `um/(m K)` quotients. Products and quotients \
go from left to right. Nothing else is computed: `\"1.5 e3 N\"` is refused. `1/min` of an angular velocity are revolutions.\n";

/// The section of a page.
pub fn section() -> String {
    let mut text = format!("\n## Units\n\n<!-- begin units -->\n{HEAD}");
    text += "\n| what is measured | SI unit | units of its own | examples |\n|---|---|---|---|\n";
    for dimension in DIMENSIONS {
        let Dimension { name, unit, exponents, examples: [first, second] } = dimension;
        let reads = |symbol: &&str| dimension.parse(&format!("1 {symbol}")).is_ok();
        let own: Vec<&str> =
            KNOWN.iter().filter(|of| of.exponents == *exponents).flat_map(shown).filter(reads).collect();
        let _ = writeln!(text, "| {name} | {unit} | {} | `{first}`, `{second}` |", own.join(", "));
    }
    text += "\n| unit | in words | size | with prefixes |\n|---|---|---|---|\n";
    for known in &KNOWN {
        let size = format!("{:?} {}", known.size(), si(known.exponents));
        let prefixes = if known.prefixes { "yes" } else { "" };
        let (symbols, words) = (known.symbols.join(", "), known.words.join(", "));
        let _ = writeln!(text, "| {symbols} | {words} | {} | {prefixes} |", size.trim_end());
    }
    let prefixes: Vec<String> =
        PREFIXES.iter().map(|(symbol, word, power)| format!("{symbol} ({word}, 1e{power})")).collect();
    let _ = write!(text, "\nPrefixes: {}.\n<!-- end -->\n", prefixes.join(", "));
    text
}

/// Symbols of a unit; its first word, where it has none.
fn shown(known: &Known) -> impl Iterator<Item = &'static str> {
    if known.symbols.is_empty() { &known.words[..1] } else { known.symbols }.iter().copied()
}

/// The SI unit with some exponents: that of a dimension, or powers; none of a number without unit.
fn si(exponents: Exponents) -> String {
    let dimension = DIMENSIONS.iter().find(|dimension| dimension.exponents == exponents);
    let powers = || {
        let names = ["m", "kg", "s", "K", "rad"].into_iter().zip(exponents);
        let powers = names.filter(|(_, power)| *power != 0).map(|(name, power)| format!("{name}^{power}"));
        powers.collect::<Vec<_>>().join(" ")
    };
    match dimension {
        Some(dimension) if exponents != [0; 5] => dimension.unit.to_string(),
        _ => powers(),
    }
}
