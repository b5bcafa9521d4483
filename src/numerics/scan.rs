//! Least and largest values over a grid of samples, as they come.
//!
//! Between two samples a response can go beyond both. Past an extreme along an axis, a smooth one by at most an eighth of the second
//! difference (that of the parabola through it and its neighbours); past an extreme at an axis' end, if it bends back before it gets
//! there. Where second differences stand out against those beside them,
//! it is not smooth there: at a kink between two samples it goes as far as the lines from both sides lead, at most a quarter of what
//! their second differences have too much; beside a jump, where these have either sign, half of the jump. The furthest that any sample
//! leads to in this way is the error stated of a scan. Where a sample is NaN, the others are bounded, and the error is NaN.

use std::ops::Range as Rows;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::domain::{ParameterBox, Sample};
use super::range::Range;
use super::samples::TensorGrid;

/// Fewest and most samples that are simulated at once.
const SHARD: usize = 2048;
const LARGEST_SHARD: usize = 16384;

/// The samples of a scan, in shards of consecutive ones.
#[derive(Clone, Debug)]
pub struct ScanGrid {
    grid: TensorGrid,
    points: Vec<usize>,
    shard: usize,
}

impl ScanGrid {
    /// With so many points along each axis, both ends included.
    pub fn new(points: &[usize]) -> Self {
        let grid = TensorGrid::full_factorial(points);
        // Slabs of the first axis stay together, so that neighbours do.
        let slab = grid.len() / points.first().copied().unwrap_or(1);
        let shard = slab.saturating_mul(3).clamp(SHARD, LARGEST_SHARD);
        Self { grid, points: points.to_vec(), shard }
    }

    /// Points along each axis, the last fastest.
    pub fn points(&self) -> &[usize] {
        &self.points
    }

    /// Number of samples.
    #[allow(clippy::len_without_is_empty)] // every axis has a point
    pub fn len(&self) -> usize {
        self.grid.len()
    }

    /// Number of the first sample of each shard.
    pub fn shards(&self) -> std::iter::StepBy<Rows<usize>> {
        (0..self.grid.len()).step_by(self.shard)
    }

    /// The samples of the shard that begins with number `first`.
    pub fn samples(&self, first: usize, domain: &ParameterBox) -> Vec<Sample> {
        let end = (first + self.shard).min(self.grid.len());
        (first..end).map(|index| domain.sample(&self.grid.sample(index))).collect()
    }
}

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
    pub fn observe(&mut self, rows: Rows<usize>, (first, count): (usize, usize), values: &[f64]) {
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
        for (place, &value) in self.values.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
            if value - most <= extremes[0].reach || value + most >= extremes[1].reach {
                let [below, above] = self.beyond(place);
                include(extremes, [Extreme { value, reach: value - below }, Extreme { value, reach: value + above }]);
            }
        }
    }

    /// More than [`beyond`](Self::beyond) can be anywhere: along each axis that is at most the largest second difference.
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

    /// How far the response may go below and above the sample at `place`, between it and its neighbours along each axis. Along an axis
    /// whose neighbours are in another part of the scan, as far as along the others.
    fn beyond(&self, place: usize) -> [f64; 2] {
        let Self { first, values, .. } = *self;
        let (mut known, mut largest, mut unknown) = ([0.0; 2], 0.0_f64, 0.0);
        let mut stride = 1;
        for &count in self.points.iter().rev() {
            if count > 2 {
                let at = (first + place) / stride % count;
                let along = Along { values, place, stride, at, count };
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

/// A sample among those along one axis.
struct Along<'a> {
    values: &'a [f64],
    place: usize,
    stride: usize,
    at: usize,
    count: usize,
}

/// Second differences may grow so much from one sample to the next where the response is smooth, and so much more where those before
/// grow, as far as that goes.
const GROWTH: f64 = 1.5;
const MOST_GROWTH: f64 = 8.0;

/// The slope at the first of a row of samples is known to this share of their second difference, or better; and so is the second difference of three.
const UNSURE: f64 = 0.25;

impl Along<'_> {
    /// The value so many samples further; `None` beyond the axis' ends, and in another part of the scan.
    fn value(&self, away: isize) -> Option<f64> {
        let at = self.at.checked_add_signed(away).filter(|&at| at < self.count)?;
        let place = (self.place + self.stride * at).checked_sub(self.stride * self.at)?;
        self.values.get(place).copied()
    }

    /// The second difference so many samples further.
    fn bend(&self, away: isize) -> Option<f64> {
        Some(self.value(away - 1)? - 2.0 * self.value(away)? + self.value(away + 1)?)
    }

    /// How far a smooth response may go below and above an inner sample; `None` at the ends.
    fn smooth(&self) -> Option<[f64; 2]> {
        let (here, before, after) = (self.value(0)?, self.value(-1)?, self.value(1)?);
        // Three samples do not tell how the second difference changes between them.
        let unsure = if self.count == 3 { 1.0 + UNSURE } else { 1.0 };
        let height = unsure * (before - 2.0 * here + after).abs() / 8.0;
        let lowest = here <= before && here <= after;
        let highest = here >= before && here >= after;
        Some([if lowest { height } else { 0.0 }, if highest { height } else { 0.0 }])
    }

    /// How far below and above a sample at the axis' end a response may go that bends back between it and its neighbour: the parabola through it
    /// and the two next to it, as far as that may turn by what is not known of its slope.
    fn bending_back(&self) -> [f64; 2] {
        let side = match self.at {
            0 => 1,
            last if last + 1 == self.count => -1,
            _ => return [0.0; 2],
        };
        let (Some(here), Some(there), Some(bend)) = (self.value(0), self.value(side), self.bend(side)) else {
            return [0.0; 2];
        };
        // Differences forwards: Δ − Δ²/2 + Δ³/3.
        let third = self.bend(2 * side).map(|next| next - bend);
        let slope = there - here - bend / 2.0 + third.unwrap_or_default() / 3.0;
        let unsure = third.map_or(f64::INFINITY, |third| third.abs() / 3.0).min(UNSURE * bend.abs());
        // Towards the neighbour it rises if it bends upwards, and falls if it bends downwards.
        let back = unsure - slope * bend.signum();
        let is_end = (there - here) * bend >= 0.0;
        let depth = if is_end && back > 0.0 { 0.5 * bend.abs() * (back / bend.abs()).min(1.0).powi(2) } else { 0.0 };
        if bend > 0.0 { [depth, 0.0] } else { [0.0, depth] }
    }

    /// How far below and above the sample and its neighbour on one side a response that is not smooth between them may go.
    fn irregular(&self, side: isize) -> [f64; 2] {
        let (Some(here), Some(there)) = (self.value(0), self.value(side)) else { return [0.0; 2] };
        let excess = |away: isize, others: [isize; 2]| {
            let bend = self.bend(away)?;
            let expected = others.into_iter().filter_map(|other| self.expected(bend, away, other)).reduce(f64::max)?;
            Some(bend.signum() * (bend.abs() - expected).max(0.0))
        };
        let outer = [-side, 2 * side];
        let excess = [excess(0, outer), excess(side, outer)];
        let share = if excess.contains(&None) { 0.5 } else { 0.25 };
        let [a, b] = excess.map(Option::unwrap_or_default);
        if a * b < 0.0 {
            return [share * (a.abs() + b.abs()); 2];
        }
        let total = share * (a + b);
        // Lines through the pairs on both sides meet at a kink's tip.
        let tip = || {
            let (left, right) = (here - self.value(-side)?, there - self.value(2 * side)?);
            let at = (there + right - here) / (left + right);
            // To rounding, where it is at one of the two.
            (-0.01..=1.01).contains(&at).then_some(here + at.clamp(0.0, 1.0) * left)
        };
        let most = |beyond: Option<f64>| beyond.map_or(total.abs(), |beyond| beyond.clamp(0.0, total.abs()));
        if total > 0.0 {
            [most(tip().map(|tip| here.min(there) - tip)), 0.0]
        } else if total < 0.0 {
            [0.0, most(tip().map(|tip| tip - here.max(there)))]
        } else {
            [0.0; 2]
        }
    }

    /// The largest second difference `away` from here that a smooth response has, by those beyond, from number `outer` on; of the same
    /// sign, since one that changes it is too short a wave to tell.
    fn expected(&self, bend: f64, away: isize, outer: isize) -> Option<f64> {
        let (beside, beyond) = (self.bend(outer)?, self.bend(outer + (outer - away).signum())?);
        let growth = (beside / beyond).abs().clamp(1.0, MOST_GROWTH);
        let growth = if growth.is_nan() { 1.0 } else { growth };
        let distance = (outer - away).unsigned_abs() as i32;
        Some(if beside * bend < 0.0 { 0.0 } else { GROWTH * beside.abs() * growth.powi(distance) })
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
        scan.observe(0..1, (0, 3), &[1.0, nan, 2.0, 3.0, 3.0, 3.0, nan, nan, nan]);
        scan.observe(0..1, (3, 2), &[-1.0, 5.0, 3.0, 3.0, nan, nan]);
        scan.observe(0..1, (5, 1), &[9.0, 3.0, nan]);
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
            scan.observe(0..1, (0, values.len()), &values);
            let (missed, error) = (1.0 - scan.range(0, 0).upper, scan.error(0, 0));
            assert!(missed <= error + 1e-12, "{shift}: {missed} of {error}");
            assert!(error < 0.041);
        }
    }

    fn of_line(f: impl Fn(f64) -> f64, count: usize) -> (Range, f64) {
        let values: Vec<f64> = (0..count).map(|i| f(2.0 * i as f64 / (count - 1) as f64 - 1.0)).collect();
        let mut scan = ScanBounds::new(1, 1, &[count]);
        scan.observe(0..1, (0, values.len()), &values);
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
        // From what is level it leads no further than a parabola.
        let (range, error) = of_line(|x| (x - 0.31).max(0.0), 20);
        assert!(range.lower == 0.0 && error < 0.01, "{error}");
    }

    #[test]
    fn half_of_a_jump_is_an_error() {
        for at in [-0.95, 0.02, 0.5] {
            let (_, error) = of_line(|x| 0.1 * x + if x > at { 3.0 } else { 0.0 }, 15);
            assert!((1.0..=2.0).contains(&error), "{at}: {error}");
        }
        // What is steep, but smooth, has none.
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
            scan.observe(0..1, (0, 99), &values);
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
        scan.observe(0..1, (0, values.len()), &values);
        assert_eq!(scan.error(0, 0), 0.0);
    }

    proptest! {
        #[test]
        fn parts_give_the_range_of_the_whole(values in prop::collection::vec(-1e3..1e3_f64, 1..50), cut in 0..50_usize) {
            let cut = cut.min(values.len());
            let empty = || ScanBounds::new(1, 1, &[values.len()]);
            let (mut whole, mut parts) = (empty(), empty());
            whole.observe(0..1, (0, values.len()), &values);
            parts.observe(0..1, (0, cut), &values[..cut]);
            parts.observe(0..1, (cut, values.len() - cut), &values[cut..]);
            prop_assert_eq!(whole.range(0, 0), parts.range(0, 0));
            prop_assert!(values.iter().all(|&value| whole.range(0, 0).contains(value)));
        }
    }
}
