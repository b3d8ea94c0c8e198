//! Numbers as scenes of the catalogue have them.

/// A number with so many digits at most, without zeros at its end.
pub(super) fn short(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let behind = (digits as i32 - 1 - value.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.behind$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// A number with two digits.
pub fn two_digits(value: f64) -> f64 {
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    (value / unit).round() * unit
}
