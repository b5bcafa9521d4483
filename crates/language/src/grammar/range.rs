//! Intervals in other notations than that of a model file: `0.49 - 0.51 m`, which is read as a difference, `0.49 ..
//! 0.51 m`.

use super::unit::{Unit, number_and_unit};
use crate::grammar::tuning::TUNING;

/// Separators of the ends of an interval in other notations.
const BETWEEN: [&str; 8] = ["–", "—", "…", "...", "..", " to ", " bis ", "-"];

/// Two numbers with a separator between them, the smaller first.
pub struct Range {
    /// The range in the notation of intervals.
    pub interval: String,
    /// Whether the text is a difference of two numbers with units, or of two without.
    pub is_difference: bool,
}

/// Reads a range in another notation than that of intervals. A difference is one only if its numbers are near each
/// other, or if only one of them has a unit.
pub fn range(text: &str) -> Option<Range> {
    let text = text.trim();
    let parts = |sign: &str| {
        let (at, _) = text.char_indices().skip(1).find(|&(at, _)| text[at..].starts_with(sign))?;
        Some([&text[..at], &text[at + sign.len()..]].map(str::trim))
    };
    let end = |text: &str| match number_and_unit(text) {
        Some((number, name, _)) => Unit::parse(name).ok().map(|unit| (number, Some((name.to_owned(), unit)))),
        None => text.parse().ok().filter(|number: &f64| number.is_finite()).map(|number| (number, None)),
    };
    let is_plain = |text: &str| text.starts_with(|letter: char| letter.is_ascii_digit() || letter == '.');
    let (sign, [first, second], [(low, of_low), (high, of_high)]) = BETWEEN.into_iter().find_map(|sign| {
        let [first, second] = parts(sign)?;
        let ends = [end(first)?, end(second)?];
        (is_plain(second) && (sign != "-" || is_plain(first))).then_some((sign, [first, second], ends))
    })?;
    let [low, high] = match (&of_low, &of_high) {
        (Some((_, one)), Some((_, other))) if one.dimension == other.dimension => [one.to_si(low), other.to_si(high)],
        (Some(_), Some(_)) => return None,
        _ => [low, high],
    };
    let is_difference = sign == "-" && of_low.is_some() == of_high.is_some();
    if low >= high || is_difference && low < TUNING.near * high {
        return None;
    }
    let interval = match (of_low, of_high) {
        (None, Some((unit, _))) => format!("[{first}, {}] {unit}", second[..second.len() - unit.len()].trim()),
        (Some((unit, _)), None) => format!("[{}, {second}] {unit}", first[..first.len() - unit.len()].trim()),
        _ => format!("[{first}, {second}]"),
    };
    Some(Range { interval, is_difference })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_in_other_notations_are_found() {
        for (written, wanted) in [
            ("0.49 - 0.51 m", "[0.49, 0.51] m"),
            ("10-12 mm", "[10, 12] mm"),
            ("0.49 m - 0.51", "[0.49, 0.51] m"),
            ("0.49–0.51 m", "[0.49, 0.51] m"),
            ("-0.51 .. -0.49", ""),
            ("0.49 .. 0.51", "[0.49, 0.51]"),
            ("490 mm … 0.51 m", "[490 mm, 0.51 m]"),
            ("0.49 to 0.51 m", "[0.49, 0.51] m"),
            ("0.49 m - 0.51 m", "[0.49 m, 0.51 m] ?"),
            ("490 mm - 0.51 m", "[490 mm, 0.51 m] ?"),
            ("1.9-2.1", "[1.9, 2.1] ?"),
            // Differences.
            ("2 - 3 mm - 1", ""),
            ("0.51 - 0.49 m", ""),
            ("1 - 10", ""),
            ("1e-3", ""),
            ("-1 - 2", ""),
            ("1 m - 2 s", ""),
            ("2*l - 3*l", ""),
            ("3", ""),
            ("", ""),
        ] {
            let found = range(written)
                .map_or(String::new(), |found| found.interval + if found.is_difference { " ?" } else { "" });
            assert_eq!(found, wanted, "{written}");
        }
    }
}
