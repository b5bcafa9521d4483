//! Ends of an output's range with the error of each, and which of them are a corner's.

use crate::numerics::{Extent, Range, SAFETY_OF_SURROGATE, error_of_larger};

/// An output's range in a part of the box.
#[derive(Clone, Debug)]
pub(super) struct Ends {
    pub extent: Extent,
    /// How far the polynomials' errors move either end.
    pub errors: [f64; 2],
    /// Whether either end is at a corner of the box, however the polynomials err.
    pub is_corner: [bool; 2],
}

/// A place that is looked at beside an end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rival {
    /// How far its value is within the end.
    pub within: f64,
    /// How far the polynomials' errors move it.
    pub error: f64,
    /// By how many times themselves errors change on the way to the end's place.
    pub change: f64,
}

impl Rival {
    /// Whether it is within an end that errors move so far.
    pub fn stays_within(&self, error: f64) -> bool {
        let apart = SAFETY_OF_SURROGATE * (error + self.error);
        let near = SAFETY_OF_SURROGATE * self.change * error.max(self.error);
        self.within >= near.min(apart)
    }
}

impl Ends {
    /// Takes simulated values at corners for ends that are there.
    pub fn hold(&mut self, simulated: impl Fn(&[f64]) -> Option<f64>) {
        let own = |end: usize| if self.is_corner[end] { simulated(&self.extent.places[end]) } else { None };
        let [lower, upper] = [own(0), own(1)];
        self.errors = [lower.map_or(self.errors[0], |_| 0.0), upper.map_or(self.errors[1], |_| 0.0)];
        let Range { lower: low, upper: high } = self.extent.range;
        self.extent.range = Range { lower: lower.unwrap_or(low), upper: upper.unwrap_or(high) };
    }

    /// Of two parts together: the part that is not the outermost may reach further by its error.
    pub fn or(mut self, other: Self) -> Self {
        let ends = |ends: &Self| [-ends.extent.range.lower, ends.extent.range.upper];
        for (end, (own, others)) in ends(&self).into_iter().zip(ends(&other)).enumerate() {
            self.errors[end] = error_of_larger([own, others], [self.errors[end], other.errors[end]]);
            if others > own {
                self.extent.places[end].clone_from(&other.extent.places[end]);
                self.extent.spacing[end].clone_from(&other.extent.spacing[end]);
            }
        }
        let (own, others) = (self.extent.range, other.extent.range);
        self.extent.range = Range { lower: own.lower.min(others.lower), upper: own.upper.max(others.upper) };
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(lower: f64, upper: f64, errors: [f64; 2], is_corner: [bool; 2]) -> Ends {
        let extent = Extent::at(Range { lower, upper }, 0.0, [vec![-1.0], vec![1.0]]);
        Ends { extent, errors, is_corner }
    }

    #[test]
    fn a_corner_has_the_simulated_value() {
        let mut own = ends(0.0, 1.0, [0.1, 0.2], [false, true]);
        own.hold(|xi| Some(if xi[0] > 0.0 { 1.05 } else { 0.3 }));
        assert_eq!((own.extent.range, own.errors), (Range { lower: 0.0, upper: 1.05 }, [0.1, 0.0]));
        let joined = own.or(ends(0.5, 1.0, [0.0, 0.25], [false; 2]));
        // The other part may reach 1.25.
        assert!((joined.errors[1] - 0.2).abs() < 1e-15 && joined.errors[0] == 0.1);
    }

    #[test]
    fn a_place_is_within_where_errors_cannot_lift_it() {
        let rival = |within: f64, change: f64| Rival { within, error: 1e-3, change };
        assert!(rival(5e-3, f64::INFINITY).stays_within(1e-3) && !rival(3e-3, f64::INFINITY).stays_within(1e-3));
        assert!(rival(1e-4, 0.04).stays_within(1e-3) && !rival(1e-4, 0.06).stays_within(1e-3));
        assert!(!rival(3e-3, 36.0).stays_within(1e-3));
    }
}
