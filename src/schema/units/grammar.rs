//! How numbers with units are written. Nothing is computed but products of what the table of [`known`](super::known) units has:
//!
//! ```text
//! text    = number [blanks] unit                    9.525 mm
//! number  = ["+" | "-"] digits ["." [digits]] [("e" | "E") ["+" | "-"] digits], or with digits after the point alone
//! unit    = ["1"] "/" term { sign term }            1/min, /min
//!         | term { sign term }                      N s/m, lbf-in
//! sign    = "/" | "*" | "." | "·" | "⋅" | "×" | blanks | "-" before a letter
//! term    = (name | "(" unit ")") [power]           mm, (m K)
//! power   = ["^" | "**"] ["-"] digit                m^2, m2, m², s-1, s^(-1)
//! ```
//!
//! Products and quotients go from left to right, as in UCUM: `N/m s` is `N s/m`. A power is -4 to 4 and not 0. Blanks may stand
//! around signs and before `^`; an exponent of the number has no blank, and has digits: the e of `15e N` begins a name, and no
//! unit has it.

use super::known::find;
use super::product::Product;

/// Why a text is not read as a number with a unit.
pub(super) const NO_NUMBER: &str = "it does not begin with a number";

/// Longest accepted text \[bytes]; anything longer is no unit. It bounds brackets in brackets, too.
pub(super) const MAX_TEXT: usize = 48;

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

/// Why a text is no unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Problem<'a> {
    /// It is not written as units are, or its size has too many digits.
    Form,
    /// A name that is not known.
    Name(&'a str),
    /// A power that is no whole number from -4 to 4, or 0.
    Power,
}

/// The product of units that a text stands for.
///
/// # Errors
/// [`Problem`] with it.
pub(super) fn unit(text: &str) -> Result<Product, Problem<'_>> {
    if text.len() > MAX_TEXT {
        return Err(Problem::Form);
    }
    let mut reader = Reader { rest: text.trim() };
    let product = reader.unit()?;
    if reader.rest.is_empty() { Ok(product) } else { Err(Problem::Form) }
}

/// Rest of a text that is still to be read.
struct Reader<'a> {
    rest: &'a str,
}

/// Operator between two terms.
#[derive(PartialEq)]
enum Sign {
    Times,
    Over,
    End,
}

/// A letter of a name.
fn is_letter(c: char) -> bool {
    c.is_alphabetic() || c == '\u{b0}' || c == '%'
}

/// The number that a digit stands for, raised ones too.
fn digit(c: char) -> Option<i32> {
    match c {
        '0'..='9' => c.to_digit(10)?.try_into().ok(),
        '\u{b9}' => Some(1),
        '\u{b2}' => Some(2),
        '\u{b3}' => Some(3),
        '\u{2070}' | '\u{2074}'..='\u{2079}' => (u32::from(c) - 0x2070).try_into().ok(),
        _ => None,
    }
}

impl<'a> Reader<'a> {
    fn skip_blanks(&mut self) {
        self.rest = self.rest.trim_start();
    }

    /// Takes a sign, if the rest begins with one of these.
    fn takes(&mut self, signs: &[char]) -> bool {
        let rest = self.rest.strip_prefix(signs);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    /// A product of terms, up to the end or a closing bracket.
    fn unit(&mut self) -> Result<Product, Problem<'a>> {
        let mut product = Product::ONE;
        self.skip_blanks();
        let one = self.takes(&['1']);
        self.skip_blanks();
        let mut sign = if self.takes(&['/']) { Sign::Over } else { Sign::Times };
        if one && sign == Sign::Times {
            return Err(Problem::Form);
        }
        while sign != Sign::End {
            self.skip_blanks();
            let term = self.term()?;
            let term = if sign == Sign::Over { term.reciprocal() } else { term };
            product = product.times(term).ok_or(Problem::Form)?;
            sign = self.sign()?;
        }
        Ok(product)
    }

    fn sign(&mut self) -> Result<Sign, Problem<'a>> {
        let length = self.rest.len();
        self.skip_blanks();
        let blank = self.rest.len() < length;
        let mut ahead = self.rest.chars();
        let sign = match ahead.next() {
            None | Some(')') => return Ok(Sign::End),
            Some(next) if blank && (is_letter(next) || next == '(') => return Ok(Sign::Times),
            Some('/') => Sign::Over,
            Some('*' | '.' | '\u{b7}' | '\u{22c5}' | '\u{d7}') => Sign::Times,
            Some('-') if !blank && ahead.as_str().starts_with(is_letter) => Sign::Times,
            Some(_) => return Err(Problem::Form),
        };
        self.rest = ahead.as_str();
        Ok(sign)
    }

    /// A name or a product in brackets, with its power.
    fn term(&mut self) -> Result<Product, Problem<'a>> {
        let base = if self.takes(&['(']) {
            let inside = self.unit()?;
            if !self.takes(&[')']) {
                return Err(Problem::Form);
            }
            inside
        } else {
            let end = self.rest.find(|c| !is_letter(c)).unwrap_or(self.rest.len());
            let (name, rest) = self.rest.split_at(end);
            if name.is_empty() {
                return Err(Problem::Form);
            }
            let (known, ten) = find(name).ok_or(Problem::Name(name))?;
            self.rest = rest;
            Product::of(known, ten).ok_or(Problem::Form)?
        };
        match self.power()? {
            1 => Ok(base),
            power => base.power(power).ok_or(Problem::Form),
        }
    }

    fn power(&mut self) -> Result<i32, Problem<'a>> {
        let ahead = self.rest.trim_start();
        let raised = ahead.strip_prefix('^').or_else(|| ahead.strip_prefix("**"));
        let mut power = Reader { rest: raised.map_or(self.rest, str::trim_start) };
        let bracket = raised.is_some() && power.takes(&['(']);
        let minus = power.takes(&['-', '\u{2212}', '\u{207b}']);
        let end = power.rest.find(|c| digit(c).is_none()).unwrap_or(power.rest.len());
        let (digits, rest) = power.rest.split_at(end);
        power.rest = rest;
        let mut digits = digits.chars().filter_map(digit);
        let number = match (digits.next(), digits.next()) {
            // The minus belongs to what follows: "lbf-in".
            (None, _) if raised.is_none() => return Ok(1),
            (None, _) => return Err(Problem::Form),
            (Some(number @ 1..=4), None) => number,
            _ => return Err(Problem::Power),
        };
        if bracket && !power.takes(&[')']) {
            return Err(Problem::Form);
        }
        self.rest = power.rest;
        Ok(if minus { -number } else { number })
    }
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
    fn closed_form_products_quotients_and_powers() {
        let metre = |power: i32| unit("m").unwrap().power(power).unwrap();
        let over = |a: &str, b: &str| unit(a).unwrap().times(unit(b).unwrap().reciprocal()).unwrap();
        for (text, expected) in [
            ("m^2", metre(2)),
            ("m2", metre(2)),
            ("m\u{b2}", metre(2)),
            ("m**2", metre(2)),
            ("m ^ 2", metre(2)),
            ("m^(2)", metre(2)),
            ("m-4", metre(-4)),
            ("m\u{207b}\u{2074}", metre(-4)),
            ("m\u{2212}1", metre(-1)),
            ("1/m", metre(-1)),
            ("/ m", metre(-1)),
            ("(m m)/m", metre(1)),
            ("m/(m m)", metre(-1)),
            ("m/m/m", metre(-1)),
            ("m/m*m", metre(1)),
            ("m/m m", metre(1)),
            ("(m^2)^-2", metre(-4)),
            ("in-lb", over("in", "1/lb")),
            ("min", over("s", "s/min")),
            ("mm-2", unit("mm^-2").unwrap()),
        ] {
            assert_eq!(unit(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn what_is_not_of_this_form_is_refused() {
        for text in [
            "", "1", "/", "1/", "m/", "*m", "m*", "m..m", "m//m", "m*/m", "(m", "m)", "()", "(m))", "m^",
            "m^-", "m^(2", "m(m)", "m2m", "2 m", "m 2", "m -1", "m- m", "in.", "m^+2", "1 m", "11/m", "m^m",
            "m+m", "m,m", "m m^^2",
        ] {
            assert_eq!(unit(text), Err(Problem::Form), "{text}");
        }
        for text in ["m0", "m^5", "m22", "m^-9", "m\u{b2}\u{b2}", "m\u{2070}"] {
            assert_eq!(unit(text), Err(Problem::Power), "{text}");
        }
        for (text, name) in [
            ("e N", "e"),
            ("N per s", "per"),
            ("dozen N", "dozen"),
            ("N MM", "MM"),
            ("kkg", "kkg"),
            ("mmin", "mmin"),
        ] {
            assert_eq!(unit(text), Err(Problem::Name(name)), "{text}");
        }
        // Brackets in brackets end with the text, and sizes with 38 digits.
        assert_eq!(unit(&"(".repeat(100_000)), Err(Problem::Form));
        assert_eq!(unit("((((km^4)^4)^4)^4)"), Err(Problem::Form));
    }
}
