//! A linear axis: a unit that makes its numbers short, ticks at 1, 2 or 5 times a power of ten, labels of equal
//! precision.

use super::prefix::ScaleUnit;
use crate::export::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;

/// A linear axis. Data in SI is divided by the unit's factor before it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Unit of its numbers.
    pub unit: ScaleUnit,
    /// Lower end, in `unit`.
    pub min: f64,
    /// Upper end, in `unit`, above `min`.
    pub max: f64,
    /// Distance between ticks.
    step: f64,
    /// Whether all data are one value.
    pub is_constant: bool,
}

impl Axis {
    /// The axis for `values` in SI, shown in a unit, with about `ticks` ticks; `padding` is the part of the range that
    /// stays free at each end. Values that are not finite are ignored. A range below `noise` is a constant.
    pub fn fit<'a>(
        values: impl Iterator<Item = f64>,
        unit: impl Into<ShownUnit<'a>>,
        ticks: usize,
        padding: f64,
        noise: f64,
    ) -> Self {
        let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
        for x in values.filter(|x| x.is_finite()) {
            min = min.min(x);
            max = max.max(x);
        }
        if min > max {
            (min, max) = (0.0, 1.0);
        }
        let extreme = min.abs().max(max.abs());
        let is_zero = extreme <= noise;
        let unit = ScaleUnit::of(unit, if is_zero { 0.0 } else { extreme });
        // Scaled first: the difference of the unscaled ends could overflow.
        (min, max) = (min / unit.factor, max / unit.factor);
        let size = min.abs().max(max.abs());
        let is_constant = is_zero || max - min <= (TUNING.rounding_of_motion * size).max(noise / unit.factor);
        if is_constant {
            // In the middle, with some room.
            let room = if is_zero || size == 0.0 { 1.0 } else { 0.1 * size };
            let middle = if is_zero { 0.0 } else { 0.5 * min + 0.5 * max };
            (min, max) = (middle - room, middle + room);
        } else {
            let room = padding * (max - min);
            (min, max) = (min - room, max + room);
        }
        Self { unit, min, max, step: round_step((max - min) / ticks.max(1) as f64), is_constant }
    }

    /// Position of `x`: 0 at the lower end, 1 at the upper end.
    pub fn place(&self, x: f64) -> f64 {
        (x / self.unit.factor - self.min) / (self.max - self.min)
    }

    /// The ticks: their positions, and their labels.
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

    /// `name [unit]`: `x3 [mm]`.
    pub fn title(&self, name: &str) -> String {
        if self.unit.text.is_empty() { name.to_owned() } else { format!("{name} [{}]", self.unit.text) }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_of_equal_precision() {
        let axis = Axis::fit([-0.11, 0.32].into_iter(), "m", 5, 0.0, 0.0);
        assert_eq!(labels(&axis), ["−0.1", "0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(labels(&Axis::fit([0.0, 2.0].into_iter(), "s", 5, 0.0, 0.0)), ["0.0", "0.5", "1.0", "1.5", "2.0"]);
        assert_eq!(axis.title("x3"), "x3 [m]");
        assert_eq!(labels(&Axis::fit([-43.0, 41.0].into_iter(), "N", 4, 0.0, 0.0)), ["−40", "−20", "0", "20", "40"]);
    }

    #[test]
    fn units_have_prefixes() {
        let small = Axis::fit([-4e-6, 4e-6].into_iter(), "N*s/m^2", 4, 0.0, 0.0);
        assert_eq!(labels(&small), ["−4", "−2", "0", "2", "4"]);
        assert_eq!(small.title("deviation"), "deviation [µN·s/m²]");
        let large = Axis::fit([0.0, 25_000.0].into_iter(), "", 5, 0.0, 0.0);
        assert_eq!(large.title("F"), "F [10³]");
        assert_eq!(labels(&large), ["0", "5", "10", "15", "20", "25"]);
    }

    #[test]
    fn requested_unit_is_kept() {
        let degrees = ShownUnit { text: "deg", si: std::f64::consts::PI / 180.0 };
        let axis = Axis::fit([0.0, std::f64::consts::PI].into_iter(), degrees, 4, 0.0, 0.0);
        assert_eq!(
            (axis.title("angle"), labels(&axis)),
            ("angle [deg]".into(), ["0", "50", "100", "150"].map(String::from).into())
        );
        assert!((axis.place(0.5 * std::f64::consts::PI) - 0.5).abs() < 1e-15);
        let millimetres = ShownUnit { text: "mm", si: 1e-3 };
        assert_eq!(Axis::fit([0.0, 0.15].into_iter(), millimetres, 4, 0.0, 0.0).title("x"), "x [mm]");
        assert_eq!(Axis::fit([0.0, 4e-6].into_iter(), millimetres, 4, 0.0, 0.0).title("x"), "x [µm]");
    }

    #[test]
    fn axis_fits_constants_extremes_and_empty_data() {
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
            let axis = Axis::fit(values.iter().copied(), "m", 5, 0.04, 0.0);
            let ticks = axis.ticks();
            assert!((2..=12).contains(&ticks.len()), "{values:?}: {ticks:?}");
            assert!(ticks.iter().all(|(at, _)| (-1e-6..=1.0 + 1e-6).contains(at)), "{values:?}: {ticks:?}");
            for x in values.iter().filter(|x| x.is_finite()) {
                assert!((0.0..=1.0).contains(&axis.place(*x)), "{values:?}");
            }
        }
    }

    #[test]
    fn noise_is_a_constant() {
        let zero = Axis::fit([-3e-13, 2e-13].into_iter(), "N", 5, 0.04, 1e-12);
        assert!(zero.is_constant && (zero.min, zero.max) == (-1.0, 1.0) && zero.unit.text == "N", "{zero:?}");
        let value = Axis::fit([20e3, 20e3 + 1e-7].into_iter(), "N", 5, 0.04, 1e-6);
        assert!(value.is_constant && value.unit.text == "kN" && (value.min - 18.0).abs() < 1e-6, "{value:?}");
        assert!(!Axis::fit([-3e-13, 2e-13].into_iter(), "N", 5, 0.04, 0.0).is_constant);
    }
}
