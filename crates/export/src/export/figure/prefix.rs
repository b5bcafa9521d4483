//! Units on a scale: with the prefix that makes its numbers short (kN, µm), or a power of ten if there is no such
//! prefix.

use crate::export::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;

/// Sizes that read well without a prefix.
const PLAIN: std::ops::Range<f64> = 0.1..1e4;

/// Powers of ten that a scale may take out; beyond them the power itself would under- or overflow.
const EXPONENTS: std::ops::RangeInclusive<i32> = -306..=306;

/// Prefixes and their powers of ten.
const PREFIXES: [(&str, i32); 9] =
    [("p", -12), ("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9), ("T", 12)];

/// Units that take prefixes: symbol, and the largest power of ten that is in use.
const PREFIXED: [(&str, i32); 10] = [
    ("N", 12),
    ("J", 12),
    ("W", 12),
    ("Pa", 12),
    ("V", 12),
    ("A", 12),
    // Nobody writes Mm, ks or krad.
    ("m", 3),
    ("g", 3),
    ("s", 0),
    ("rad", 0),
];

/// A unit on a scale.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleUnit {
    /// Text as in print: `kN·m`, `10³ rad/s`; empty for a number.
    pub text: String,
    /// Its value in SI.
    pub factor: f64,
}

impl ScaleUnit {
    /// The unit for values up to `size` in SI.
    pub fn of<'a>(unit: impl Into<ShownUnit<'a>>, size: f64) -> Self {
        let ShownUnit { text, si } = unit.into();
        let scaled = Self::prefixed(text, size / si);
        Self { factor: scaled.factor * si, ..scaled }
    }

    /// The unit for values up to `size` in `unit`; the factor is relative to `unit`.
    fn prefixed(unit: &str, size: f64) -> Self {
        if size == 0.0 || !size.is_finite() || PLAIN.contains(&size) {
            return Self { text: pretty_unit(unit), factor: 1.0 };
        }
        let (first, power, rest) = first_factor(unit);
        // A prefix of m² counts twice.
        let step = 3 * power;
        let exponent = step * (symdiff::math::log10(size) / f64::from(step)).floor() as i32;
        let is_short = size / 10f64.powi(exponent.clamp(*EXPONENTS.start(), *EXPONENTS.end())) < TUNING.long_number;
        if let Some(symbol) = prefixed(first, exponent / power).filter(|_| is_short) {
            return Self { text: pretty_unit(&format!("{symbol}{rest}")), factor: 10f64.powi(exponent) };
        }
        let thousands = (symdiff::math::log10(size) / 3.0).floor() as i32;
        let exponent = (3 * thousands).clamp(*EXPONENTS.start(), *EXPONENTS.end());
        let text = format!("10{} {}", superscript(exponent), pretty_unit(unit));
        Self { text: text.trim_end().to_owned(), factor: 10f64.powi(exponent) }
    }
}

/// The first factor of a unit without its power, its power if that is 1, 2 or 3, and the text behind the symbol.
fn first_factor(unit: &str) -> (&str, i32, &str) {
    let end = unit.find(|c: char| !c.is_alphabetic() && c != 'µ').unwrap_or(unit.len());
    let (first, rest) = unit.split_at(end);
    let power = match rest.strip_prefix('^').and_then(|power| power.chars().next()).or(rest.chars().next()) {
        Some('2' | '²') => 2,
        Some('3' | '³') => 3,
        _ => 1,
    };
    (first, power, rest)
}

/// A symbol that may have a prefix, multiplied by a power of ten: (`mm`, 3) → `m`.
fn prefixed(symbol: &str, exponent: i32) -> Option<String> {
    let known = PREFIXED.iter().flat_map(|unit| PREFIXES.iter().map(move |prefix| (prefix, unit)));
    let is_symbol = |prefix: &str, base: &str| {
        symbol.strip_prefix(prefix).or(symbol.strip_prefix('u').filter(|_| prefix == "µ")) == Some(base)
    };
    let ((_, from), (base, most)) = known.into_iter().find(|((prefix, _), (base, _))| is_symbol(prefix, base))?;
    let wanted = from + exponent;
    let (prefix, _) = PREFIXES.iter().find(|(_, exponent)| *exponent == wanted && wanted <= *most)?;
    Some(format!("{prefix}{base}"))
}

/// An integer as a superscript.
pub fn superscript(n: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = n.unsigned_abs().to_string().bytes().map(|b| DIGITS[usize::from(b - b'0')]).collect::<String>();
    if n < 0 { format!("⁻{digits}") } else { digits }
}

/// `N*s/m^2` as in print: `N·s/m²`.
pub fn pretty_unit(unit: &str) -> String {
    let mut text = String::new();
    let mut rest = unit;
    while let Some(at) = rest.find('^') {
        text.push_str(&rest[..at]);
        rest = &rest[at + 1..];
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '-').unwrap_or(rest.len());
        match rest[..end].parse() {
            Ok(power) => text.push_str(&superscript(power)),
            Err(_) => text.push_str(&format!("^{}", &rest[..end])),
        }
        rest = &rest[end..];
    }
    text.push_str(rest);
    text.replace('*', "·")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_typeset() {
        assert_eq!(pretty_unit("kg*m^2"), "kg·m²");
        assert_eq!(pretty_unit("rad*s^-1"), "rad·s⁻¹");
        assert_eq!(pretty_unit("m^x"), "m^x");
    }

    #[test]
    fn sizes_choose_a_prefix_where_the_unit_takes_one() {
        for (unit, size, text, factor) in [
            ("N", 25_000.0, "kN", 1e3),
            ("N", 9_000.0, "N", 1.0),
            ("m", 0.004, "mm", 1e-3),
            ("m", 4e-6, "µm", 1e-6),
            ("m", 2e4, "km", 1e3),
            ("m", 2e7, "10⁶ m", 1e6),
            ("m/s^2", 0.02, "mm/s²", 1e-3),
            ("N*m", 3e6, "MN·m", 1e6),
            ("kg*m^2", 2e-3, "g·m²", 1e-3),
            ("kg", 2e4, "10³ kg", 1e3),
            ("m^2", 2e-5, "mm²", 1e-6),
            ("m^3", 2e-5, "mm³", 1e-9),
            ("m^3", 2e-4, "10⁻⁶ m³", 1e-6),
            ("m^3", 2e-8, "mm³", 1e-9),
            ("rad/s", 2e4, "10³ rad/s", 1e3),
            ("rad", 2e-4, "µrad", 1e-6),
            ("1/s", 2e4, "10³ 1/s", 1e3),
            ("", 2e-4, "10⁻⁶", 1e-6),
            ("mm", 2e-4, "nm", 1e-6),
            ("um", 2e4, "mm", 1e3),
            ("kN", 0.02, "N", 1e-3),
            ("deg", 0.02, "10⁻³ deg", 1e-3),
            ("rpm", 2e4, "10³ rpm", 1e3),
            ("N*s/m", 0.0, "N·s/m", 1.0),
        ] {
            let found = ScaleUnit::prefixed(unit, size);
            assert_eq!(found.text, text, "{unit} {size}");
            assert!((found.factor / factor - 1.0).abs() < 1e-12, "{unit} {size}: {}", found.factor);
        }
    }
}
