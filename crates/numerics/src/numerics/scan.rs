//! Least and largest values over a grid of samples, as they come.
//!
//! Between two samples a response can go beyond both. Past an extreme along an axis, a smooth one by at most an eighth
//! of the second difference (that of the parabola through it and its neighbours); past an extreme at an axis' end, if
//! it bends back before it gets there. Where second differences stand out against their neighbours, it is not smooth
//! there: at a kink between two samples it goes as far as the lines from both sides lead, at most a quarter of the
//! excess of their second differences; next to a jump, where these differ in sign, half of the jump. The largest such
//! distance of any sample is the stated error of a scan. Where a sample is NaN, the others are bounded, and the error
//! is NaN.

use std::ops::Range as Rows;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::along::Along;
use super::range::Range;

/// Values that are compared at a time.
const LANES: usize = 8;

/// Running bounds of every output at every time. Parts of a scan can be taken apart and merged in any order, with
/// the same result to the bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScanBounds {
    outputs: usize,
    /// Points along each axis, the last fastest.
    points: Vec<usize>,
    /// Least and largest, by time, then by output. Empty while least > largest.
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
    /// Bounds before the first sample of a grid with `points[i]` points along axis i.
    pub fn new(times: usize, outputs: usize, points: &[usize]) -> Self {
        Self {
            outputs,
            points: points.to_vec(),
            extremes: vec![EMPTY; times * outputs],
            gaps: vec![false; times * outputs],
        }
    }

    /// Merges another part of the same scan.
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

    /// Takes in values in some rows (row, output, sample) of `count` of the grid's samples, from number `first` on.
    pub fn observe(&mut self, rows: Rows<usize>, first: usize, count: usize, values: &[f64]) {
        if count == 0 {
            return;
        }
        let lines = rows.start * self.outputs..rows.end * self.outputs;
        let points = &self.points;
        let extremes = self.extremes[lines.clone()].par_iter_mut().zip(&mut self.gaps[lines]);
        extremes.zip(values.par_chunks_exact(count)).for_each_init(
            Reach::default,
            |reach, ((extremes, gap), values)| {
                *gap |= values.iter().any(|value| value.is_nan());
                Line { points, first, values }.include_in(extremes, reach);
            },
        );
    }

    /// Bounds of an output at a time, over the samples that are numbers; unknown if none is.
    pub fn range(&self, time: usize, output: usize) -> Range {
        let [least, largest] = self.extremes[time * self.outputs + output];
        if least.value <= largest.value { Range { lower: least.value, upper: largest.value } } else { Range::UNKNOWN }
    }

    /// How far the response may go beyond those bounds between the samples; NaN if a sample is NaN.
    pub fn error(&self, time: usize, output: usize) -> f64 {
        if self.gaps[time * self.outputs + output] {
            return f64::NAN;
        }
        let [least, largest] = self.extremes[time * self.outputs + output];
        (least.value - least.reach).max(largest.reach - largest.value)
    }
}

/// The least and the largest of those values that are numbers; an infinite range if none is.
fn ends(values: &[f64]) -> [f64; 2] {
    let (mut low, mut high) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    let (chunks, rest) = values.as_chunks::<LANES>();
    // Written so that NaN changes nothing.
    let mut widen = |lane: usize, value: f64| {
        low[lane] = if value < low[lane] { value } else { low[lane] };
        high[lane] = if value > high[lane] { value } else { high[lane] };
    };
    chunks.iter().for_each(|chunk| (0..LANES).for_each(|lane| widen(lane, chunk[lane])));
    rest.iter().for_each(|&value| widen(0, value));
    [low.into_iter().fold(f64::INFINITY, f64::min), high.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

/// More than the response can go beyond each of a line's samples.
#[derive(Default)]
struct Reach {
    /// Second differences along an axis at each sample, without sign.
    along: Vec<f64>,
    /// Their sum over the axes, and the largest of them.
    sum: Vec<f64>,
    largest: Vec<f64>,
}

impl Reach {
    /// Fills in the reach at samples of a grid: along each axis it is at most the largest of the second differences at
    /// a sample and at its two neighbours.
    fn of(&mut self, points: &[usize], values: &[f64]) {
        let Self { along, sum, largest } = self;
        for of_all in [&mut *sum, largest] {
            of_all.clear();
            of_all.resize(values.len(), 0.0);
        }
        let mut stride = 1;
        for &count in points.iter().rev() {
            if count > 2 && values.len() > 2 * stride {
                along.clear();
                along.resize(values.len(), 0.0);
                // Some of these go around an axis' end, and only make the result larger.
                let ends = values.iter().zip(&values[stride..]).zip(&values[2 * stride..]);
                let bends = ends.map(|((a, b), c)| (a - 2.0 * b + c).abs());
                along[stride..].iter_mut().zip(bends).for_each(|(along, bend)| *along = bend);
                let last = values.len() - stride;
                let widen = |sum: &mut f64, largest: &mut f64, most: f64| {
                    *sum += most;
                    *largest = largest.max(most);
                };
                for index in (0..stride).chain(last..values.len()) {
                    let beside = if index < stride { along[index + stride] } else { along[index - stride] };
                    let other =
                        if index >= stride && index + stride < values.len() { along[index + stride] } else { 0.0 };
                    widen(&mut sum[index], &mut largest[index], along[index].max(beside).max(other));
                }
                let inner = stride..last.max(stride);
                let beside = along.iter().zip(&along[stride..]).zip(&along[2 * stride..]);
                let of_inner = sum[inner.clone()].iter_mut().zip(&mut largest[inner]);
                of_inner.zip(beside).for_each(|((sum, largest), ((a, b), c))| widen(sum, largest, a.max(*b).max(*c)));
            }
            stride *= count;
        }
    }

    /// Reach at a sample; rounding of the sums aside.
    fn at(&self, index: usize, axes: usize) -> f64 {
        1.001 * (self.sum[index] + axes as f64 * self.largest[index])
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
    fn include_in(&self, extremes: &mut [Extreme; 2], reach: &mut Reach) {
        let mut widen = |value: f64| include(extremes, [Extreme { value, reach: value }; 2]);
        let [least, largest] = ends(self.values);
        if least == 0.0 || largest == 0.0 {
            // One of several zeros may be negative: the first counts.
            self.values.iter().copied().filter(|value| !value.is_nan()).for_each(widen);
        } else if least <= largest {
            widen(least);
            widen(largest);
        }
        // Few samples are so near to an end that it matters how far the response goes beyond them.
        reach.of(self.points, self.values);
        for (index, &value) in self.values.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
            let most = reach.at(index, self.points.len());
            if value - most <= extremes[0].reach || value + most >= extremes[1].reach {
                let [below, above] = self.beyond(index);
                include(extremes, [Extreme { value, reach: value - below }, Extreme { value, reach: value + above }]);
            }
        }
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
                let along = Along::new(values, index, stride, at, count);
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
    fn nan_keeps_the_other_values_and_makes_the_error_unknown() {
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
    fn error_at_a_jump_is_half_of_it() {
        for at in [-0.95, 0.02, 0.5] {
            let (_, error) = of_line(|x| 0.1 * x + if x > at { 3.0 } else { 0.0 }, 15);
            assert!((1.0..=2.0).contains(&error), "{at}: {error}");
        }
        // A steep but smooth function has none.
        let (_, error) = of_line(|x| (3.0 * x).exp(), 15);
        assert!(error < 1e-12, "{error}");
    }

    #[test]
    fn narrow_peak_at_an_outlying_sample_is_an_error() {
        for shift in [0.03, 0.05, 0.06] {
            let (range, error) = of_line(|x| 1.0 / (1.0 + ((x - shift) / 0.03).powi(2)), 20);
            assert!(error > 0.2 * range.upper, "{shift}: {range:?}, {error}");
        }
    }

    /// The peak lies nearer to the axis' end than to the next sample.
    #[test]
    fn peak_near_an_end_is_within_the_error() {
        for (at, count) in [(-0.9, 3), (-0.6, 3), (-0.95, 5), (0.87, 5), (-0.99, 9)] {
            let (range, error) = of_line(|x| -(x - at).powi(2) + 0.1 * (x - at).powi(3), count);
            // The safety of errors is twofold.
            assert!(-range.upper <= 2.0 * error + 1e-12 && error < 0.4, "{at}: {range:?}, {error}");
        }
        // A function that leaves the box with a slope has none.
        let (_, error) = of_line(|x| (x + 2.0).powi(2), 5);
        assert_eq!(error, 0.0);
    }

    /// Every sample's reach, without a look at which of them may matter.
    #[test]
    fn no_relevant_sample_is_skipped() {
        for shift in [0.0, 0.3, 1.1] {
            let value = |i: usize, j: usize| {
                let (x, y) = (0.25 * i as f64 - 1.0, 0.2 * j as f64 - 1.0);
                (5.0 * x + shift).sin() * (3.0 * y).cos() + (x - shift * y).abs()
            };
            let values: Vec<f64> = (0..99).map(|index| value(index / 11, index % 11)).collect();
            let mut scan = ScanBounds::new(1, 1, &[9, 11]);
            scan.observe(0..1, 0, 99, &values);
            let line = Line { points: &[9, 11], first: 0, values: &values };
            let (mut all, mut reach) = (EMPTY, Reach::default());
            reach.of(line.points, line.values);
            for (place, &value) in values.iter().enumerate() {
                let [below, above] = line.beyond(place);
                assert!(below.max(above) <= reach.at(place, 2));
                include(&mut all, [Extreme { value, reach: value - below }, Extreme { value, reach: value + above }]);
            }
            assert_eq!(scan.extremes[0], all);
        }
    }

    proptest! {
        /// However rough the values are, and wherever a part of the grid begins.
        #[test]
        fn a_reach_is_not_exceeded(values in prop::collection::vec(-1e3..1e3_f64, 1..90), first in 0..60_usize) {
            let line = Line { points: &[5, 3, 10], first, values: &values };
            let mut reach = Reach::default();
            reach.of(line.points, line.values);
            for place in 0..values.len() {
                let [below, above] = line.beyond(place);
                prop_assert!(below.max(above) <= reach.at(place, 3), "{}: {} {}", place, below, above);
            }
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
