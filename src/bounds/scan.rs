//! Least and largest values over samples, as they come.

use super::range::Range;

/// Running bounds of every output at every time. Parts of a scan can be taken apart and merged in any order, with
/// the same result to the bit.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanBounds {
    outputs: usize,
    /// By time, then by output. Empty while lower > upper; not a number once any sample was.
    ranges: Vec<Range>,
}

const EMPTY: Range = Range { lower: f64::INFINITY, upper: f64::NEG_INFINITY };

/// Widens `range`; not a number wins over everything.
fn include(range: &mut Range, lower: f64, upper: f64) {
    if lower < range.lower || lower.is_nan() {
        range.lower = lower;
    }
    if upper > range.upper || upper.is_nan() {
        range.upper = upper;
    }
}

impl ScanBounds {
    /// Before the first sample.
    pub fn new(times: usize, outputs: usize) -> Self {
        Self { outputs, ranges: vec![EMPTY; times * outputs] }
    }

    /// One sample's value of an output at a time.
    pub fn observe(&mut self, time: usize, output: usize, value: f64) {
        include(&mut self.ranges[time * self.outputs + output], value, value);
    }

    /// Many samples' values of an output at a time.
    pub fn observe_all(&mut self, time: usize, output: usize, values: &[f64]) {
        let range = &mut self.ranges[time * self.outputs + output];
        values.iter().for_each(|&value| include(range, value, value));
    }

    /// All that another part of the same scan has seen.
    pub fn merge(&mut self, other: &Self) {
        assert_eq!((self.outputs, self.ranges.len()), (other.outputs, other.ranges.len()), "parts of different scans");
        for (range, other) in self.ranges.iter_mut().zip(&other.ranges) {
            include(range, other.lower, other.upper);
        }
    }

    /// Bounds of an output at a time; unknown before the first sample and after one that was not a number.
    pub fn range(&self, time: usize, output: usize) -> Range {
        let range = self.ranges[time * self.outputs + output];
        if range.lower <= range.upper { range } else { Range::UNKNOWN }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn not_a_number_stays() {
        let mut scan = ScanBounds::new(1, 2);
        assert!(scan.range(0, 0).lower.is_nan());
        scan.observe_all(0, 0, &[1.0, f64::NAN, 2.0]);
        scan.observe(0, 1, 3.0);
        let mut whole = ScanBounds::new(1, 2);
        whole.observe_all(0, 0, &[-1.0, 5.0]);
        whole.merge(&scan);
        whole.observe(0, 0, 9.0);
        assert!(whole.range(0, 0).lower.is_nan() && whole.range(0, 0).upper.is_nan());
        assert_eq!(whole.range(0, 1), Range { lower: 3.0, upper: 3.0 });
    }

    proptest! {
        #[test]
        fn parts_merge_to_the_whole(values in prop::collection::vec(-1e3..1e3_f64, 1..50), cut in 0..50_usize) {
            let cut = cut.min(values.len());
            let (mut whole, mut first, mut second) = (ScanBounds::new(1, 1), ScanBounds::new(1, 1), ScanBounds::new(1, 1));
            whole.observe_all(0, 0, &values);
            first.observe_all(0, 0, &values[..cut]);
            second.observe_all(0, 0, &values[cut..]);
            second.merge(&first);
            prop_assert_eq!(&whole, &second);
            prop_assert!(values.iter().all(|&value| whole.range(0, 0).contains(value)));
        }
    }
}
