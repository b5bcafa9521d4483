//! A plot's axis: a round power of ten taken out, ticks at 1, 2 or 5 times a power of ten, labels of equal precision.

/// Powers of a thousand that an axis may take out; beyond them the power itself would under- or overflow.
const EXPONENTS: std::ops::RangeInclusive<i32> = -306..=306;

/// A linear axis. Data in the model's unit is divided by `10^exponent` before it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    /// A multiple of three.
    exponent: i32,
    /// Lower end, in units of `10^exponent`.
    min: f64,
    /// Upper end, in units of `10^exponent`, above `min`.
    max: f64,
    /// Between ticks.
    step: f64,
}

impl Axis {
    /// The axis for `values` with about `ticks` ticks; `padding` is the part of the range that stays free at each
    /// end. Whatever is not finite is passed over.
    pub fn fit(values: impl Iterator<Item = f64>, ticks: usize, padding: f64) -> Self {
        let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
        for x in values.filter(|x| x.is_finite()) {
            min = min.min(x);
            max = max.max(x);
        }
        if min > max {
            (min, max) = (0.0, 1.0);
        }
        let exponent = exponent(min.abs().max(max.abs()));
        // Scaled first: the difference of the unscaled ends could overflow.
        (min, max) = (scaled(min, exponent), scaled(max, exponent));
        let size = min.abs().max(max.abs());
        if max - min <= 1e-12 * size || size == 0.0 {
            // A constant (to rounding): in the middle, with some room.
            let room = if size == 0.0 { 1.0 } else { 0.1 * size };
            (min, max) = (min - room, max + room);
        } else {
            let room = padding * (max - min);
            (min, max) = (min - room, max + room);
        }
        Self { exponent, min, max, step: round_step((max - min) / ticks.max(1) as f64) }
    }

    /// Where `x` lies: 0 at the lower end, 1 at the upper end.
    pub fn place(&self, x: f64) -> f64 {
        (scaled(x, self.exponent) - self.min) / (self.max - self.min)
    }

    /// The ticks: their places, and their labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let decimals = (-symdiff::math::log10(self.step).floor()).clamp(0.0, 17.0) as usize;
        // Multiples of the step, counted in whole numbers so that no rounding adds up.
        let first = (self.min / self.step - 1e-9).ceil();
        let count = ((self.max / self.step + 1e-9).floor() - first).clamp(0.0, 100.0) as usize;
        (0..=count)
            .map(|i| {
                let value = (first + i as f64) * self.step;
                ((value - self.min) / (self.max - self.min), label(value, decimals))
            })
            .collect()
    }

    /// `name [unit]`, with the power of ten that was taken out: `x3 [10⁻³ m]`.
    pub fn title(&self, name: &str, unit: &str) -> String {
        let unit = pretty_unit(unit);
        let power = if self.exponent == 0 { String::new() } else { format!("10{}", superscript(self.exponent)) };
        match (power.is_empty(), unit.is_empty()) {
            (true, true) => name.to_owned(),
            (true, false) => format!("{name} [{unit}]"),
            (false, true) => format!("{name} [{power}]"),
            (false, false) => format!("{name} [{power} {unit}]"),
        }
    }
}

/// The power of ten to take out of an axis that reaches to `size`: none for sizes that read well as they are.
fn exponent(size: f64) -> i32 {
    if size == 0.0 || (1e-2..1e4).contains(&size) {
        return 0;
    }
    let thousands = (symdiff::math::log10(size) / 3.0).floor() as i32;
    (3 * thousands).clamp(*EXPONENTS.start(), *EXPONENTS.end())
}

/// x / 10^exponent.
fn scaled(x: f64, exponent: i32) -> f64 {
    if exponent == 0 { x } else { x / 10f64.powi(exponent) }
}

/// The one of 1, 2, 5 times a power of ten that is nearest to `step` in ratio.
fn round_step(step: f64) -> f64 {
    let power = symdiff::math::pow(10.0, symdiff::math::log10(step).floor());
    // Halfway between 1 and 2 is √2, and so on.
    let factor = match step / power {
        x if x < 2f64.sqrt() => 1.0,
        x if x < 10f64.sqrt() => 2.0,
        x if x < 50f64.sqrt() => 5.0,
        _ => 10.0,
    };
    factor * power
}

/// A tick's label, with a true minus sign and no negative zero.
fn label(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let zero = text.bytes().all(|b| b == b'0' || b == b'.');
    if value < 0.0 && !zero { format!("−{text}") } else { text }
}

pub(super) fn superscript(n: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = n.unsigned_abs().to_string().bytes().map(|b| DIGITS[usize::from(b - b'0')]).collect::<String>();
    if n < 0 { format!("⁻{digits}") } else { digits }
}

/// `N*s/m^2` as print has it: `N·s/m²`.
fn pretty_unit(unit: &str) -> String {
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

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_of_equal_precision() {
        let axis = Axis::fit([-0.11, 0.32].into_iter(), 5, 0.0);
        assert_eq!(labels(&axis), ["−0.1", "0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(labels(&Axis::fit([0.0, 2.0].into_iter(), 5, 0.0)), ["0.0", "0.5", "1.0", "1.5", "2.0"]);
        assert_eq!(axis.title("x3", "m"), "x3 [m]");
        assert_eq!(labels(&Axis::fit([-43.0, 41.0].into_iter(), 4, 0.0)), ["−40", "−20", "0", "20", "40"]);
    }

    #[test]
    fn powers_of_a_thousand_are_taken_out() {
        let small = Axis::fit([-4e-6, 4e-6].into_iter(), 4, 0.0);
        assert_eq!(labels(&small), ["−4", "−2", "0", "2", "4"]);
        assert_eq!(small.title("deviation", "N*s/m^2"), "deviation [10⁻⁶ N·s/m²]");
        let large = Axis::fit([0.0, 25_000.0].into_iter(), 5, 0.0);
        assert_eq!(large.title("F", ""), "F [10³]");
        assert_eq!(labels(&large), ["0", "5", "10", "15", "20", "25"]);
    }

    #[test]
    fn constants_extremes_and_nothing_have_an_axis() {
        let nothing: [f64; 0] = [];
        let cases: [&[f64]; 9] = [
            &nothing,
            &[f64::NAN, f64::INFINITY],
            &[0.0, 0.0],
            &[5.0, 5.0],
            &[0.3, 0.1 + 0.2],
            &[-f64::MAX, f64::MAX],
            &[5e-324, 1e-310],
            &[1e9, 1e9 + 1.0],
            &[-1e-300, 1e300],
        ];
        for values in cases {
            let axis = Axis::fit(values.iter().copied(), 5, 0.04);
            let ticks = axis.ticks();
            assert!((2..=12).contains(&ticks.len()), "{values:?}: {ticks:?}");
            assert!(ticks.iter().all(|(at, _)| (-1e-6..=1.0 + 1e-6).contains(at)), "{values:?}: {ticks:?}");
            for x in values.iter().filter(|x| x.is_finite()) {
                assert!((0.0..=1.0).contains(&axis.place(*x)), "{values:?}");
            }
        }
    }

    #[test]
    fn units_are_set_as_in_print() {
        assert_eq!(pretty_unit("kg*m^2"), "kg·m²");
        assert_eq!(pretty_unit("rad*s^-1"), "rad·s⁻¹");
        assert_eq!(pretty_unit("m^x"), "m^x");
    }
}
