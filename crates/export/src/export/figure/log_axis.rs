//! A plot's logarithmic axis: whole decades at its ends, labels such as 10⁻³.

use super::prefix::superscript;
use crate::export::tuning::TUNING;

/// A tick: its position, and its label if it has one.
pub type Tick = (f64, Option<String>);

/// Axis from `10^first` to `10^last`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogAxis {
    first: i32,
    last: i32,
}

impl LogAxis {
    /// The axis for `values`; values that are not positive and finite are ignored.
    pub fn fit(values: impl Iterator<Item = f64>) -> Self {
        let exponents = values.filter(|x| x.is_normal() && *x > 0.0).map(symdiff::math::log10);
        let (low, high) =
            exponents.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if low > high {
            return Self { first: -1, last: 0 };
        }
        let first = low.floor() as i32;
        Self { first, last: (high.ceil() as i32).max(first + 1) }
    }

    /// Position of `x`: 0 at the lower end, 1 at the upper end; the lower end for values below the axis or not
    /// positive.
    pub fn place(&self, x: f64) -> f64 {
        let exponent = if x > 0.0 { symdiff::math::log10(x) } else { f64::NEG_INFINITY };
        ((exponent - f64::from(self.first)) / f64::from(self.last - self.first)).clamp(0.0, 1.0)
    }

    /// Ticks at each decade, labelled (every second, third, … if there are many), and at 2, 3, … 9 times it,
    /// unlabelled.
    pub fn ticks(&self) -> Vec<Tick> {
        let decades = self.last - self.first;
        let every = 1 + (decades - 1) / TUNING.many_decades;
        let mut ticks = Vec::new();
        for exponent in self.first..=self.last {
            let decade = f64::from(exponent - self.first) / f64::from(decades);
            let label = (exponent - self.first) % every == 0;
            ticks.push((decade, label.then(|| format!("10{}", superscript(exponent)))));
            if exponent < self.last && decades <= TUNING.many_decades {
                ticks.extend(
                    (2..10).map(|times| (decade + symdiff::math::log10(f64::from(times)) / f64::from(decades), None)),
                );
            }
        }
        ticks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_decades_are_shown() {
        let axis = LogAxis::fit([3e-4, 0.02, f64::NAN, 0.0, f64::INFINITY].into_iter());
        assert_eq!(axis, LogAxis { first: -4, last: -1 });
        assert!((axis.place(1e-4), axis.place(0.1)) == (0.0, 1.0) && (axis.place(1e-2) - 2.0 / 3.0).abs() < 1e-15);
        assert_eq!((axis.place(0.0), axis.place(1e9)), (0.0, 1.0));
        let labels: Vec<String> = axis.ticks().into_iter().filter_map(|(_, label)| label).collect();
        assert_eq!(labels, ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"]);
        assert_eq!(axis.ticks().len(), 4 + 3 * 8);
        assert!(axis.ticks().is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn axis_fits_one_value_no_values_and_many_decades() {
        assert_eq!(LogAxis::fit([1.0].into_iter()), LogAxis { first: 0, last: 1 });
        assert_eq!(LogAxis::fit([].into_iter()), LogAxis { first: -1, last: 0 });
        let wide = LogAxis::fit([1e-20, 1.0].into_iter()).ticks();
        assert!(wide.len() == 21 && wide.iter().filter(|(_, label)| label.is_some()).count() == 7, "{wide:?}");
    }
}
