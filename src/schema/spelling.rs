//! Spellings of units that people and catalogues use, turned into those of the exact calculator.

/// Why a text is not read as a number with a unit.
pub(super) const NO_NUMBER: &str = "it does not begin with a number";

/// Signs that stand for others: both Greek mu (micro sign and letter), products, powers, degrees, and the minus sign.
const SIGNS: [(char, &str); 14] = [
    ('\u{b5}', "u"),
    ('\u{3bc}', "u"),
    ('\u{b7}', "*"),
    ('\u{22c5}', "*"),
    ('\u{d7}', "*"),
    // "N.m" is a product, too.
    ('.', "*"),
    ('\u{b0}', "deg"),
    ('\u{2212}', "-"),
    ('\u{207b}', "-"),
    ('\u{b9}', "1"),
    ('\u{b2}', "2"),
    ('\u{b3}', "3"),
    ('\u{2074}', "4"),
    ('\u{a0}', " "),
];

/// Units by words that the calculator lacks or takes for others.
const WORDS: [(&str, &str); 9] = [
    ("mrad", "(1/1000 rad)"),
    ("urad", "(1/1000000 rad)"),
    ("Nm", "(N m)"),
    ("kNm", "(kN m)"),
    ("mNm", "(mN m)"),
    ("uNm", "(uN m)"),
    ("MNm", "(MN m)"),
    ("Nmm", "(N mm)"),
    ("kNmm", "(kN mm)"),
];

/// Words for an angle or a turn, with which an angular velocity begins.
const ANGLES: [&str; 10] =
    ["rad", "mrad", "urad", "deg", "degree", "degrees", "rev", "revolution", "revolutions", "turn"];

/// Ways to write revolutions per minute, as catalogues do.
const PER_MINUTE: [&str; 7] = ["rpm", "/min", "1/min", "min^-1", "r/min", "rev/min", "(1/min)"];

/// The number that a text begins with, and the rest without the space around it.
///
/// # Errors
/// If there is no number.
pub(super) fn split(text: &str) -> Result<(f64, &str), &'static str> {
    let text = text.trim();
    let bytes = text.as_bytes();
    let digits = |from: usize| from + bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let whole = digits(usize::from(text.starts_with(['+', '-'])));
    let mut end = if bytes.get(whole) == Some(&b'.') { digits(whole + 1) } else { whole };
    // An exponent has digits: the e of "3e" belongs to a unit.
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let begin = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if begin <= bytes.len() && digits(begin) > begin {
            end = digits(begin);
        }
    }
    let number = text[..end].parse().map_err(|_| NO_NUMBER)?;
    Ok((number, text[end..].trim()))
}

/// A unit as the calculator spells it; none if it has signs that no unit has.
pub(super) fn plain(unit: &str) -> Option<String> {
    let mut spelled = String::new();
    for sign in unit.chars() {
        let replaced = SIGNS.iter().find(|(from, _)| *from == sign);
        let word = replaced.map_or_else(|| sign.to_string(), |(_, to)| (*to).to_string());
        // "m2", "m²" and "min-1" are powers.
        let after_word = spelled.ends_with(|last: char| last.is_ascii_alphabetic());
        if after_word && word.starts_with(|first: char| first.is_ascii_digit() || first == '-') {
            spelled.push('^');
        }
        spelled.push_str(&word);
    }
    let allowed = |c: char| c.is_ascii_alphanumeric() || " +-*/^()_".contains(c);
    // A power is a digit: the calculator is exact, and would compute a large one in full.
    let mut numbers = spelled.split(|c: char| !c.is_ascii_digit()).filter(|digits| !digits.is_empty());
    let small = numbers.all(|digits| digits.len() == 1 && "123456".contains(digits));
    (small && spelled.chars().all(allowed) && !spelled.contains("^^") && closed(&spelled)).then_some(spelled)
}

/// Does every bracket close?
fn closed(text: &str) -> bool {
    let step = |open: i32, sign: char| match sign {
        '(' => Some(open + 1),
        ')' => (open > 0).then_some(open - 1),
        _ => Some(open),
    };
    text.chars().try_fold(0, step) == Some(0)
}

/// A plain unit with each word that the calculator does not know in its own terms.
pub(super) fn calculable(plain: &str) -> String {
    let mut text = String::new();
    let mut word = String::new();
    for sign in plain.chars().chain([' ']) {
        if sign.is_ascii_alphabetic() || sign == '_' {
            word.push(sign);
            continue;
        }
        let known = WORDS.iter().find(|(from, _)| *from == word);
        text.push_str(known.map_or(&word, |(_, to)| to));
        word.clear();
        text.push(sign);
    }
    let text = text.trim();
    match text {
        _ if text.starts_with('/') => format!("(1 {text})"),
        // "1 1/K" would be a mixed number.
        _ if text.starts_with("1/") => format!("({text})"),
        _ => text.to_string(),
    }
}

/// A plain unit as one of angular velocity: revolutions per minute in all spellings, and angles over time. None for what
/// does not say which angle.
pub(super) fn of_angular_velocity(plain: &str) -> Option<String> {
    let dense: String = plain.chars().filter(|c| !c.is_whitespace()).collect();
    if PER_MINUTE.contains(&dense.as_str()) {
        return Some("rpm".to_string());
    }
    let mut words = plain.split(|c: char| !c.is_ascii_alphabetic()).filter(|word| !word.is_empty());
    let first = words.next()?;
    let is_angle = |word: &str| ANGLES.contains(&word);
    let once = words.all(|word| !is_angle(word) && word != "rpm") && !dense[first.len()..].starts_with('^');
    let leads = dense.starts_with(first) && (is_angle(first) || first == "rpm");
    (leads && once).then(|| plain.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_ends_where_its_unit_begins() {
        for (text, number, unit) in [
            ("0.01mm", 0.01, "mm"),
            (" -1.5e-3 m ", -1.5e-3, "m"),
            ("3000 /min", 3000.0, "/min"),
            ("3000/min", 3000.0, "/min"),
            ("+2E3kg m²", 2e3, "kg m²"),
            ("5.", 5.0, ""),
            (".5 m", 0.5, "m"),
            ("2 eV", 2.0, "eV"),
            ("2eV", 2.0, "eV"),
        ] {
            assert_eq!(split(text), Ok((number, unit)), "{text}");
        }
        for text in ["", "mm", "-", "e3 m", "NaN m", "inf m", "µm"] {
            assert_eq!(split(text), Err(NO_NUMBER), "{text}");
        }
    }

    #[test]
    fn only_angles_over_time_are_angular_velocities() {
        for unit in ["rad/s", "deg / s", "rpm", "1 / min", "min^-1", "/min", "rev/s", "mrad/ms", "rad s^-1"] {
            assert!(of_angular_velocity(unit).is_some(), "{unit}");
        }
        for unit in ["Hz", "1/s", "s^-1", "/s", "kHz", "rad^2/s", "rad/(s rad)", "1/rad/s", "m/s", "", "min"]
        {
            let angle = of_angular_velocity(unit);
            assert!(angle.is_none(), "{unit}");
        }
    }
}
