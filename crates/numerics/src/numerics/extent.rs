//! A function's range as found by a search: its ends, where they are, and how far they may be missed.

use super::range::{Range, least, most};
use super::tuning::TUNING;

/// A function's range.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// The least and the largest value found.
    pub range: Range,
    /// How far the search may have missed its ends.
    pub gap: f64,
    /// ξ of the least and of the largest value.
    pub places: [Vec<f64>; 2],
    /// Distances from these places within which nothing else was seen, along each axis.
    pub spacing: [Vec<f64>; 2],
}

impl Extent {
    /// Extent of a function that cannot be bounded.
    pub fn unknown(dimension: usize) -> Self {
        let zeros = || [vec![0.0; dimension], vec![TUNING.near_extreme; dimension]];
        let [place, spacing] = zeros();
        Self {
            range: Range::UNKNOWN,
            gap: f64::NAN,
            places: [place.clone(), place],
            spacing: [spacing.clone(), spacing],
        }
    }

    /// Extent found at these places.
    pub fn at(range: Range, gap: f64, places: [Vec<f64>; 2]) -> Self {
        let spacing = [vec![TUNING.near_extreme; places[0].len()], vec![TUNING.near_extreme; places[1].len()]];
        Self { range, gap, places, spacing }
    }

    /// Takes better ends from a search that went on from these.
    pub fn improve(&mut self, further: Self) {
        let is_better = [further.range.lower < self.range.lower, further.range.upper > self.range.upper];
        self.range = Range {
            lower: least(self.range.lower, further.range.lower),
            upper: most(self.range.upper, further.range.upper),
        };
        for (end, (index, spacing)) in further.places.into_iter().zip(further.spacing).enumerate() {
            if is_better[end] {
                (self.places[end], self.spacing[end]) = (index, spacing);
            }
        }
    }

    /// Takes in values at other points. What lies beyond the range had been missed.
    pub fn include(&mut self, points: &[Vec<f64>], values: &[f64]) {
        for (point, &value) in points.iter().zip(values) {
            let beyond = self.range.distance(value);
            if beyond > 0.0 {
                let end = usize::from(value > self.range.upper);
                self.range = Range { lower: least(self.range.lower, value), upper: most(self.range.upper, value) };
                self.places[end].clone_from(point);
                self.gap += beyond;
            }
        }
    }
}
