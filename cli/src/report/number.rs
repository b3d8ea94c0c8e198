//! Numbers as text.

use std::io::Write;

/// Appends a number: the shortest decimal that reads back to the same bits, without an exponent. What `Display` writes, at a
/// third of its price; of two decimals that are equally near it takes the even one, `Display` the larger.
pub fn append(line: &mut Vec<u8>, number: f64) {
    if !number.is_finite() {
        // A vector takes everything.
        let _ = write!(line, "{number}");
        return;
    }
    let mut buffer = zmij::Buffer::new();
    let text = buffer.format_finite(number).as_bytes();
    let (sign, text) = text.split_at(usize::from(text.first() == Some(&b'-')));
    line.extend(sign);
    let Some(at) = text.iter().position(|&byte| byte == b'e') else {
        line.extend(text.strip_suffix(b".0").unwrap_or(text));
        return;
    };
    let (mantissa, exponent) = (&text[..at], &text[at + 1..]);
    let (down, exponent) = match exponent.split_first() {
        Some((b'-', digits)) => (true, digits),
        Some((b'+', digits)) => (false, digits),
        _ => (false, exponent),
    };
    let exponent = exponent.iter().fold(0, |sum, digit| 10 * sum + usize::from(digit - b'0'));
    let point = mantissa.iter().position(|&byte| byte == b'.').unwrap_or(mantissa.len());
    let (whole, rest) = (&mantissa[..point], mantissa.get(point + 1..).unwrap_or_default());
    let rest = if rest == b"0" { b"" } else { rest };
    if down {
        // One digit stands before the point.
        line.extend(b"0.");
        line.resize(line.len() + exponent - 1, b'0');
        line.extend(whole.iter().chain(rest));
    } else {
        line.extend(whole);
        line.extend(&rest[..exponent.min(rest.len())]);
        line.resize(line.len() + exponent.saturating_sub(rest.len()), b'0');
        if let Some(fraction) = rest.get(exponent..).filter(|fraction| !fraction.is_empty()) {
            line.push(b'.');
            line.extend(fraction);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identity_numbers_are_written_as_the_standard_library_does() {
        let mut ties = 0;
        let mut check = |number: f64| {
            let mut line = b"x".to_vec();
            append(&mut line, number);
            let (line, display) = (String::from_utf8_lossy(&line).into_owned(), format!("x{number}"));
            if line != display {
                // Of the smaller one the exact number is half a digit away.
                let exact = format!("x{number:.1100}").trim_end_matches('0').to_string();
                assert_eq!(
                    (&exact, line.len()),
                    (&format!("{line}5"), display.len()),
                    "{number:e} {display}"
                );
                assert_eq!(line[1..].parse(), Ok(number));
                ties += 1;
            }
        };
        let ends = [f64::MAX, f64::MIN_POSITIVE, 5e-324, f64::EPSILON, f64::INFINITY, f64::NAN, 0.0, 1e16];
        let halves = [9.5367431640625e-7, 9007199254740993.0, 1.5, 1e21, 1e22, 1e23, 123456789012345680.0];
        let powers = (-330..310).map(|power| 10f64.powi(power));
        // Every exponent with a mantissa that is different each time (a congruential generator, Knuth).
        let mut bits = 1u64;
        let random = (0..40_000).map(|_| {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(bits ^ bits >> 29)
        });
        for number in ends.into_iter().chain(halves).chain(powers).chain(random) {
            check(number);
            check(-number);
            check(number.next_up());
            // Few digits.
            check(f64::from(number as f32));
            check((number * 1e3).round() * 1e-3);
        }
        assert!((1..1000).contains(&ties), "{ties}");
    }
}
