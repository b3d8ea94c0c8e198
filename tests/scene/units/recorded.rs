//! Spellings that were read by an exact calculator before, to the bit.

use super::dimension;

/// Unit, and the factor or divisor to SI, by dimension (`tests/data/units`).
const RECORDED: &str = include_str!("../../data/units/recorded.csv");

/// Numbers whose decimals no f64 has, and one that every f64 has.
const NUMBERS: [f64; 4] = [1.0, 9.525, 0.3, 1234.567];

#[test]
fn regression_every_spelling_that_was_read_before_has_the_same_bits() {
    let (mut seen, mut wrong) = (0, vec![]);
    for row in RECORDED.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let [of, unit, way, factor] = cells[..] else { panic!("{row}") };
        let factor: f64 = factor.parse().unwrap();
        for number in NUMBERS {
            let expected = if way == "over" { number / factor } else { number * factor };
            let read = dimension(of).parse(&format!("{number} {unit}"));
            if read.as_ref().ok().map(|value| value.to_bits()) != Some(expected.to_bits()) {
                wrong.push(format!("{row}: {number} gives {read:?}"));
            }
        }
        seen += 1;
    }
    assert!(wrong.is_empty(), "{} of {seen}\n{}", wrong.len(), wrong.join("\n"));
    assert!(seen > 2000, "{seen}");
}
