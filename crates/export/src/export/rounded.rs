//! Numbers for people, without the digits of rounding errors.

use crate::grammar::display_unit::ShownUnit;

/// A value rounded to `digits` significant digits, 1 or more.
pub fn significant(value: f64, digits: usize) -> f64 {
    format!("{value:.0$e}", digits - 1).parse().unwrap_or(value)
}

/// A value (SI) in a unit, with six significant digits and the unit.
pub fn shown(unit: ShownUnit, value: f64) -> String {
    format!("{} {}", rounded(significant(unit.of_si(value), 6)), unit.text).trim_end().to_owned()
}

/// The fewest digits that distinguish a number from its neighbours except for rounding.
pub fn rounded(value: f64) -> String {
    let text = format!("{value:.12e}");
    let short = text.parse::<f64>().unwrap_or(value);
    let text = format!("{short:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let unit = ShownUnit { text: "mm", si: 1e-3 };
        assert_eq!(shown(unit, 0.001_234_567_8), "1.23457 mm");
    }
}
