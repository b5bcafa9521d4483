//! Least and largest values over a grid of samples, as they come.
//!
//! Between two samples a response can go beyond both. Past an extreme along an axis, a smooth one by at most an eighth
//! of the second difference (that of the parabola through it and its neighbours); past an extreme at an axis' end, if
//! it bends back before it gets there. Where second differences stand out against those beside them, it is not smooth
//! there: at a kink between two samples it goes as far as the lines from both sides lead, at most a quarter of what
//! their second differences have too much; beside a jump, where these have either sign, half of the jump. The furthest
//! that any sample leads to in this way is the error stated of a scan. Where a sample is NaN, the others are bounded,
//! and the error is NaN.

use std::ops::Range as Rows;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::along::Along;
use super::range::Range;

/// Running bounds of every output at every time. Parts of a scan can be taken apart and merged in any order, with
/// the same result to the bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScanBounds {
    outputs: usize,
    /// Points along each axis, the last fastest.
    points: Vec<usize>,
    /// By time, then by output: least and largest. Empty while least > largest.
    extremes: Vec<[Extreme; 2]>,
    /// Whether a sample was NaN.
    gaps: Vec<bool>,
}

/// The least or largest value, and how far the response may go between the samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Extreme {
    value: f64,
    reach: f64,
}

const EMPTY: [Extreme; 2] = [
    Extreme { value: f64::INFINITY, reach: f64::INFINITY },
    Extreme { value: f64::NEG_INFINITY, reach: f64::NEG_INFINITY },
];

/// Widens `extremes`.
fn include([least, largest]: &mut [Extreme; 2], [low, high]: [Extreme; 2]) {
    *least = Extreme { value: least.value.min(low.value), reach: least.reach.min(low.reach) };
    *largest = Extreme { value: largest.value.max(high.value), reach: largest.reach.max(high.reach) };
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

    /// Adds what another part of the same scan found.
    ///
    /// # Panics
    /// If it has other rows or outputs.
    pub fn merge(&mut self, part: &Self) {
        assert_eq!(self.extremes.len(), part.extremes.len(), "parts of one scan");
        for (mine, &theirs) in self.extremes.iter_mut().zip(&part.extremes) {
            include(mine, theirs);
        }
        for (mine, theirs) in self.gaps.iter_mut().zip(&part.gaps) {
            *mine |= theirs;
        }
    }

    /// Values in some rows (row, output, sample) of so many of the grid's samples, from number `first` on.
    pub fn observe(&mut self, rows: Rows<usize>, first: usize, count: usize, values: &[f64]) {
        if count == 0 {
            return;
        }
        let lines = rows.start * self.outputs..rows.end * self.outputs;
        let points = &self.points;
        let extremes = self.extremes[lines.clone()].par_iter_mut().zip(&mut self.gaps[lines]);
        extremes.zip(values.par_chunks_exact(count)).for_each(|((extremes, gap), values)| {
            *gap |= values.iter().any(|value| value.is_nan());
            Line { points, first, values }.include_in(extremes);
        });
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
        (least.value - least.reach).max(largest.reach - largest.value)
    }
}

/// An output's values at some of the grid's samples.
#[derive(Clone, Copy)]
struct Line<'a> {
    /// Points of the grid along each axis.
    points: &'a [usize],
    /// Number of the first sample.
    first: usize,
    values: &'a [f64],
}

impl Line<'_> {
    /// Widens extremes by these samples, and by how far the response may go beyond them.
    fn include_in(&self, extremes: &mut [Extreme; 2]) {
        for &value in self.values.iter().filter(|value| !value.is_nan()) {
            include(extremes, [Extreme { value, reach: value }; 2]);
        }
        // Few samples are so near to an end that it matters how far the response goes beyond them.
        let most = self.most_beyond();
        for (index, &value) in self.values.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
            if value - most <= extremes[0].reach || value + most >= extremes[1].reach {
                let [below, above] = self.beyond(index);
                include(extremes, [Extreme { value, reach: value - below }, Extreme { value, reach: value + above }]);
            }
        }
    }

    /// More than [`beyond`](Self::beyond) can be anywhere: along each axis that is at most the largest second
    /// difference.
    fn most_beyond(&self) -> f64 {
        let (mut sum, mut largest, mut stride) = (0.0, 0.0_f64, 1);
        for &count in self.points.iter().rev() {
            if count > 2 {
                let values = self.values;
                let ends = values.get(2 * stride..).unwrap_or_default();
                // Some of these go around an axis' end, and only make the result larger.
                let bends = values.iter().zip(&values[stride.min(values.len())..]).zip(ends);
                let most = bends.map(|((a, b), c)| (a - 2.0 * b + c).abs()).fold(0.0, f64::max);
                (sum, largest) = (sum + most, largest.max(most));
            }
            stride *= count;
        }
        // Rounding of the sums apart.
        1.001 * (sum + self.points.len() as f64 * largest)
    }

    /// How far the response may go below and above the sample at `index`, between it and its neighbours along each
    /// axis. Along an axis whose neighbours are in another part of the scan, as far as along the others.
    fn beyond(&self, index: usize) -> [f64; 2] {
        let Self { first, values, .. } = *self;
        let (mut known, mut largest, mut unknown) = ([0.0; 2], 0.0_f64, 0.0);
        let mut stride = 1;
        for &count in self.points.iter().rev() {
            if count > 2 {
                let at = (first + index) / stride % count;
                let along = Along { values, index, stride, at, count };
                let smooth = along.smooth();
                if smooth.is_none() && at > 0 && at + 1 < count {
                    unknown += 1.0;
                }
                let (smooth, before, after) = (smooth.unwrap_or_default(), along.irregular(-1), along.irregular(1));
                let at_end = along.bending_back();
                let further = [0, 1].map(|end| smooth[end].max(before[end]).max(after[end]).max(at_end[end]));
                known = [known[0] + further[0], known[1] + further[1]];
                largest = largest.max(further[0]).max(further[1]);
            }
            stride *= count;
        }
        known.map(|known| known + unknown * largest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_is_not_a_number_leaves_the_others_and_no_error() {
        let mut scan = ScanBounds::new(1, 3, &[6]);
        assert!(scan.range(0, 0).lower.is_nan());
        let nan = f64::NAN;
        scan.observe(0..1, 0, 3, &[1.0, nan, 2.0, 3.0, 3.0, 3.0, nan, nan, nan]);
        scan.observe(0..1, 3, 2, &[-1.0, 5.0, 3.0, 3.0, nan, nan]);
        scan.observe(0..1, 5, 1, &[9.0, 3.0, nan]);
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
            scan.observe(0..1, 0, values.len(), &values);
            let (missed, error) = (1.0 - scan.range(0, 0).upper, scan.error(0, 0));
            assert!(missed <= error + 1e-12, "{shift}: {missed} of {error}");
            assert!(error < 0.041);
        }
    }

    fn of_line(f: impl Fn(f64) -> f64, count: usize) -> (Range, f64) {
        let values: Vec<f64> = (0..count).map(|i| f(2.0 * i as f64 / (count - 1) as f64 - 1.0)).collect();
        let mut scan = ScanBounds::new(1, 1, &[count]);
        scan.observe(0..1, 0, values.len(), &values);
        (scan.range(0, 0), scan.error(0, 0))
    }

    #[test]
    fn a_kink_between_samples_is_within_the_error() {
        for at in [-0.61, 0.0, 0.013, 0.05, 0.3] {
            let (range, error) = of_line(|x| (x - at).abs() + 0.1 * x * x, 20);
            // On either side it rises.
            let missed = range.lower - 0.1 * at * at;
            assert!(missed <= error + 2e-3 && error < 0.06, "{at}: {missed} of {error}");
        }
        // From a level part it leads no further than a parabola.
        let (range, error) = of_line(|x| (x - 0.31).max(0.0), 20);
        assert!(range.lower == 0.0 && error < 0.01, "{error}");
    }

    #[test]
    fn half_of_a_jump_is_an_error() {
        for at in [-0.95, 0.02, 0.5] {
            let (_, error) = of_line(|x| 0.1 * x + if x > at { 3.0 } else { 0.0 }, 15);
            assert!((1.0..=2.0).contains(&error), "{at}: {error}");
        }
        // A steep but smooth function has none.
        let (_, error) = of_line(|x| (3.0 * x).exp(), 15);
        assert!(error < 1e-12, "{error}");
    }

    #[test]
    fn a_narrow_peak_is_an_error_where_a_sample_stands_out() {
        for shift in [0.03, 0.05, 0.06] {
            let (range, error) = of_line(|x| 1.0 / (1.0 + ((x - shift) / 0.03).powi(2)), 20);
            assert!(error > 0.2 * range.upper, "{shift}: {range:?}, {error}");
        }
    }

    /// The peak lies nearer to the axis' end than to the next sample.
    #[test]
    fn a_peak_beside_an_end_is_within_the_error() {
        for (at, count) in [(-0.9, 3), (-0.6, 3), (-0.95, 5), (0.87, 5), (-0.99, 9)] {
            let (range, error) = of_line(|x| -(x - at).powi(2) + 0.1 * (x - at).powi(3), count);
            // The safety of errors is twofold.
            assert!(-range.upper <= 2.0 * error + 1e-12 && error < 0.4, "{at}: {range:?}, {error}");
        }
        // What leaves the box with a slope has none.
        let (_, error) = of_line(|x| (x + 2.0).powi(2), 5);
        assert_eq!(error, 0.0);
    }

    /// Every sample's reach, without a look at which of them may matter.
    #[test]
    fn no_sample_that_matters_is_passed_over() {
        for shift in [0.0, 0.3, 1.1] {
            let value = |i: usize, j: usize| {
                let (x, y) = (0.25 * i as f64 - 1.0, 0.2 * j as f64 - 1.0);
                (5.0 * x + shift).sin() * (3.0 * y).cos() + (x - shift * y).abs()
            };
            let values: Vec<f64> = (0..99).map(|index| value(index / 11, index % 11)).collect();
            let mut scan = ScanBounds::new(1, 1, &[9, 11]);
            scan.observe(0..1, 0, 99, &values);
            let line = Line { points: &[9, 11], first: 0, values: &values };
            let mut all = EMPTY;
            for (place, &value) in values.iter().enumerate() {
                let [below, above] = line.beyond(place);
                assert!(below.max(above) <= line.most_beyond());
                include(&mut all, [Extreme { value, reach: value - below }, Extreme { value, reach: value + above }]);
            }
            assert_eq!(scan.extremes[0], all);
        }
    }

    #[test]
    fn the_ends_of_the_axes_are_exact() {
        let values: Vec<f64> = (0..25).map(|index| (0.3 * index as f64).exp()).collect();
        let mut scan = ScanBounds::new(1, 1, &[5, 5]);
        scan.observe(0..1, 0, values.len(), &values);
        assert_eq!(scan.error(0, 0), 0.0);
    }

    proptest! {
        #[test]
        fn parts_give_the_range_of_the_whole(values in prop::collection::vec(-1e3..1e3_f64, 1..50), cut in 0..50_usize) {
            let cut = cut.min(values.len());
            let empty = || ScanBounds::new(1, 1, &[values.len()]);
            let (mut whole, mut parts) = (empty(), empty());
            whole.observe(0..1, 0, values.len(), &values);
            parts.observe(0..1, 0, cut, &values[..cut]);
            parts.observe(0..1, cut, values.len() - cut, &values[cut..]);
            prop_assert_eq!(whole.range(0, 0), parts.range(0, 0));
            prop_assert!(values.iter().all(|&value| whole.range(0, 0).contains(value)));
        }
    }
}
