//! Numbers as hexadecimal floats, to the bit: `-0x1.8p-3` is −0.1875, as C's `%a` writes it.

use std::fmt::Write as _;

/// Bits of a mantissa behind the point.
const BITS: u32 = 52;

/// A finite number's text.
pub(super) fn write(value: f64) -> String {
    let mut text = String::new();
    append(value, &mut text);
    text
}

/// Appends a finite number's text.
pub(super) fn append(value: f64, text: &mut String) {
    let bits = value.to_bits();
    text.push_str(if value.is_sign_negative() { "-0" } else { "0" });
    let (exponent, fraction) = ((bits >> BITS) & 0x7ff, bits & ((1 << BITS) - 1));
    if exponent == 0 && fraction == 0 {
        return;
    }
    let (leading, exponent) = if exponent == 0 { ("x0", -1022) } else { ("x1", exponent as i64 - 1023) };
    text.push_str(leading);
    if fraction != 0 {
        text.push('.');
        // Digits from the left, without zeros at the end.
        let (mut rest, mut shift) = (fraction, BITS);
        while rest != 0 {
            shift -= 4;
            text.push(char::from(b"0123456789abcdef"[(rest >> shift) as usize]));
            rest &= (1 << shift) - 1;
        }
    }
    // A text takes all that is written to it.
    let _ = write!(text, "p{exponent}");
}

/// The number of a text that [`write`] makes; `None` of any other.
pub(super) fn read(text: &str) -> Option<f64> {
    let (sign, rest) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    if rest == "0" {
        return Some(sign * 0.0);
    }
    let (mantissa, exponent) = rest.strip_prefix("0x")?.split_once('p')?;
    let (leading, digits) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent: i64 = exponent.parse().ok()?;
    let is_wrong = digits.len() > 13 || digits.chars().any(|digit| !digit.is_ascii_hexdigit());
    if is_wrong || !(-1022..=1023).contains(&exponent) {
        return None;
    }
    let fraction = u64::from_str_radix(&format!("{digits:0<13}"), 16).ok()?;
    let biased = match leading {
        "1" => (exponent + 1023) as u64,
        "0" if exponent == -1022 => 0,
        _ => return None,
    };
    Some(sign * f64::from_bits((biased << BITS) | fraction))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn texts_match_those_that_c_prints() {
        for (value, text) in [(1.0, "0x1p0"), (-0.1875, "-0x1.8p-3"), (0.1, "0x1.999999999999ap-4"), (0.0, "0")] {
            assert_eq!(write(value), text);
        }
        for wrong in ["", "1.5", "0x1", "0x2p0", "0x1p1024", "nan", "inf", "0x1.gp0", "0x1.00000000000000p0"] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }

    proptest! {
        #[test]
        fn numbers_are_read_to_the_bit(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            prop_assert_eq!(read(&write(value)).map(f64::to_bits), Some(bits));
        }
    }
}
