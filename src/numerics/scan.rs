//! Least and largest values over a grid of samples, as they come.
//!
//! Between two samples a smooth response can go beyond both: past an extreme of the grid that is not at the box's edge by at
//! most an eighth of the second difference along each axis (that of the parabola through it and its neighbours). That is the
//! error stated of a scan. Where a sample is NaN, the others are bounded, and the error is NaN.

use super::range::Range;

/// Running bounds of every output at every time. Parts of a scan can be taken apart and merged in any order, with
/// the same result to the bit.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanBounds {
    outputs: usize,
    /// Points along each axis, the last fastest.
    points: Vec<usize>,
    /// By time, then by output: least and largest. Empty while least > largest.
    extremes: Vec<[Extreme; 2]>,
    /// Whether a sample was NaN.
    gaps: Vec<bool>,
}

/// A value, and how far the response may go beyond it beside its sample.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Extreme {
    value: f64,
    beyond: f64,
}

const EMPTY: [Extreme; 2] =
    [Extreme { value: f64::INFINITY, beyond: 0.0 }, Extreme { value: f64::NEG_INFINITY, beyond: 0.0 }];

/// Widens `extremes`; of equals the one with the larger error is taken.
fn include([least, largest]: &mut [Extreme; 2], [low, high]: [Extreme; 2]) {
    if low.value < least.value || (low.value == least.value && low.beyond > least.beyond) {
        *least = low;
    }
    if high.value > largest.value || (high.value == largest.value && high.beyond > largest.beyond) {
        *largest = high;
    }
}

impl ScanBounds {
    /// Before the first sample of a grid with so many points along each axis.
    pub fn new(times: usize, outputs: usize, points: &[usize]) -> Self {
        Self {
            outputs,
            points: points.to_vec(),
            extremes: vec![EMPTY; times * outputs],
            gaps: vec![false; times * outputs],
        }
    }

    /// Values of an output at a time for the grid's samples from number `first` on.
    pub fn observe(&mut self, time: usize, output: usize, first: usize, values: &[f64]) {
        let line = time * self.outputs + output;
        self.gaps[line] |= values.iter().any(|value| value.is_nan());
        let known = || (0..values.len()).filter(|&place| !values[place].is_nan());
        let least = known().reduce(|a, b| if values[b] < values[a] { b } else { a });
        let largest = known().reduce(|a, b| if values[b] > values[a] { b } else { a });
        let (Some(least), Some(largest)) = (least, largest) else { return };
        let extremes = [least, largest]
            .map(|place| Extreme { value: values[place], beyond: beyond(&self.points, first, values, place) });
        include(&mut self.extremes[line], extremes);
    }

    /// Bounds of an output at a time, over the samples that are numbers; unknown where none is.
    pub fn range(&self, time: usize, output: usize) -> Range {
        let [least, largest] = self.extremes[time * self.outputs + output];
        if least.value <= largest.value { Range { lower: least.value, upper: largest.value } } else { Range::UNKNOWN }
    }

    /// How far the response may go beyond those bounds between the samples; NaN where a sample is none.
    pub fn error(&self, time: usize, output: usize) -> f64 {
        if self.gaps[time * self.outputs + output] {
            return f64::NAN;
        }
        let [least, largest] = self.extremes[time * self.outputs + output];
        if least.beyond <= largest.beyond { largest.beyond } else { least.beyond }
    }
}

/// What the response may go beyond the sample at `place`: along each axis an eighth of the second difference, unless the
/// sample is at the axis' end. Along an axis whose neighbours are in another part of the scan, the largest of the others'.
fn beyond(points: &[usize], first: usize, values: &[f64], place: usize) -> f64 {
    let (mut known, mut largest, mut unknown) = (0.0, 0.0_f64, 0.0);
    let mut stride = 1;
    for &count in points.iter().rev() {
        if count > 2 {
            let at = (first + place) / stride % count;
            // The nearest sample that is not at the end.
            let middle = (place + stride * at.clamp(1, count - 2)).checked_sub(stride * at);
            let neighbours = middle.and_then(|middle| Some((middle.checked_sub(stride)?, middle)));
            let inside = at > 0 && at + 1 < count;
            match neighbours.filter(|(_, middle)| middle + stride < values.len()) {
                Some((before, middle)) => {
                    let bend = (values[before] - 2.0 * values[middle] + values[middle + stride]).abs() / 8.0;
                    known += if inside { bend } else { 0.0 };
                    largest = largest.max(bend);
                }
                _ if inside => unknown += 1.0,
                _ => (),
            }
        }
        stride *= count;
    }
    known + unknown * largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_is_not_a_number_leaves_the_others_and_no_error() {
        let mut scan = ScanBounds::new(1, 3, &[6]);
        assert!(scan.range(0, 0).lower.is_nan());
        scan.observe(0, 0, 0, &[1.0, f64::NAN, 2.0]);
        scan.observe(0, 1, 0, &[3.0]);
        scan.observe(0, 2, 0, &[f64::NAN; 3]);
        scan.observe(0, 0, 3, &[-1.0, 5.0]);
        scan.observe(0, 0, 5, &[9.0]);
        assert_eq!(scan.range(0, 0), Range { lower: -1.0, upper: 9.0 });
        assert!(scan.error(0, 0).is_nan() && scan.error(0, 1) == 0.0);
        assert_eq!(scan.range(0, 1), Range { lower: 3.0, upper: 3.0 });
        assert!(scan.range(0, 2).lower.is_nan() && scan.error(0, 2).is_nan());
    }

    /// The peak of a parabola lies wherever it likes between the samples.
    #[test]
    fn a_peak_between_samples_is_within_the_error() {
        for shift in [-0.1, -0.03, 0.0, 0.02, 0.07, 0.1] {
            let value = |i: usize, j: usize| {
                let (x, y) = (-1.0 + 0.2 * i as f64, -1.0 + 0.2 * j as f64);
                1.0 - (x - shift).powi(2) - 3.0 * (y - 2.0 * shift).powi(2)
            };
            let values: Vec<f64> = (0..121).map(|index| value(index / 11, index % 11)).collect();
            let mut scan = ScanBounds::new(1, 1, &[11, 11]);
            scan.observe(0, 0, 0, &values);
            let (missed, error) = (1.0 - scan.range(0, 0).upper, scan.error(0, 0));
            assert!(missed <= error + 1e-12, "{shift}: {missed} of {error}");
            assert!(error < 0.041);
        }
    }

    #[test]
    fn the_ends_of_the_axes_are_exact() {
        let values: Vec<f64> = (0..25).map(|index| (0.3 * index as f64).exp()).collect();
        let mut scan = ScanBounds::new(1, 1, &[5, 5]);
        scan.observe(0, 0, 0, &values);
        assert_eq!(scan.error(0, 0), 0.0);
    }

    proptest! {
        #[test]
        fn parts_give_the_range_of_the_whole(values in prop::collection::vec(-1e3..1e3_f64, 1..50), cut in 0..50_usize) {
            let cut = cut.min(values.len());
            let empty = || ScanBounds::new(1, 1, &[values.len()]);
            let (mut whole, mut parts) = (empty(), empty());
            whole.observe(0, 0, 0, &values);
            parts.observe(0, 0, 0, &values[..cut]);
            parts.observe(0, 0, cut, &values[cut..]);
            prop_assert_eq!(whole.range(0, 0), parts.range(0, 0));
            prop_assert!(values.iter().all(|&value| whole.range(0, 0).contains(value)));
        }
    }
}
