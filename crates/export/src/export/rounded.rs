//! Numbers for people, without the digits of rounding errors.

/// As few digits as tell a number from its neighbours but for rounding.
pub fn rounded(value: f64) -> String {
    let text = format!("{value:.12e}");
    let short = text.parse::<f64>().unwrap_or(value);
    let text = format!("{short:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}
