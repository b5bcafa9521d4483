//! Ends of an output's range with the error of each, and which of them are a corner's.

use crate::numerics::{Extent, Range, SAFETY_OF_SURROGATE, error_of_larger};

/// An output's range in a part of the box.
#[derive(Clone, Debug)]
pub(super) struct Ends {
    pub extent: Extent,
    /// How far the polynomials' errors move either end.
    pub errors: [f64; 2],
    /// For either end, the corner of the box that it is at, however the polynomials err.
    pub corners: [Option<HeldCorner>; 2],
}

/// A corner of the box at which an output is largest, or least.
#[derive(Clone, Debug)]
pub(super) struct HeldCorner {
    pub xi: Vec<f64>,
    /// By how much values elsewhere may be beyond it.
    pub beyond: f64,
}

/// A point that is examined as a rival of an end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rival {
    /// How far its value is within the end.
    pub within: f64,
    /// How far the polynomials' errors move it.
    pub error: f64,
    /// Largest change of errors on the way to the end's place, as a multiple of the errors.
    pub change: f64,
    /// Largest change of errors on that way, from samples that differ in one parameter only.
    pub along: Option<f64>,
}

impl Rival {
    /// By how much it may be beyond an end that errors move by `error`.
    pub fn beyond(&self, error: f64) -> f64 {
        let apart = SAFETY_OF_SURROGATE * (error + self.error);
        let near = SAFETY_OF_SURROGATE * self.change * error.max(self.error);
        let along = SAFETY_OF_SURROGATE * self.along.unwrap_or(f64::INFINITY);
        let beyond = near.min(apart).min(along) - self.within;
        // An unknown value may be anywhere. All errors get their safety in the end.
        if beyond.is_nan() { f64::INFINITY } else { beyond.max(0.0) / SAFETY_OF_SURROGATE }
    }
}

impl Ends {
    /// Takes simulated values at corners for ends that are there.
    pub fn hold(&mut self, simulated: impl Fn(&[f64]) -> Option<f64>) {
        for end in 0..2 {
            let Some(HeldCorner { xi, beyond }) = &self.corners[end] else { continue };
            let Some(value) = simulated(xi) else { continue };
            self.errors[end] = *beyond;
            self.extent.places[end].clone_from(xi);
            let range = &mut self.extent.range;
            *(if end == 0 { &mut range.lower } else { &mut range.upper }) = value;
        }
    }

    /// Joins the ends of two parts: the part that is not the outermost may reach further by its error.
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

    fn ends(lower: f64, upper: f64, errors: [f64; 2], corner: Option<HeldCorner>) -> Ends {
        let extent = Extent::at(Range { lower, upper }, 0.0, [vec![-1.0], vec![0.9]]);
        Ends { extent, errors, corners: [None, corner] }
    }

    #[test]
    fn a_corner_has_the_simulated_value() {
        let mut own = ends(0.0, 1.0, [0.1, 0.2], Some(HeldCorner { xi: vec![1.0], beyond: 0.01 }));
        own.hold(|xi| Some(if xi[0] > 0.0 { 1.05 } else { 0.3 }));
        assert_eq!((own.extent.range, own.errors), (Range { lower: 0.0, upper: 1.05 }, [0.1, 0.01]));
        assert_eq!(own.extent.places[1], [1.0]);
        let joined = own.or(ends(0.5, 1.0, [0.0, 0.25], None));
        // The other part may reach 1.25.
        assert!((joined.errors[1] - 0.2).abs() < 1e-15 && joined.errors[0] == 0.1);
    }

    #[test]
    fn rivals_exceed_an_end_only_within_their_errors() {
        let beyond =
            |within: f64, change: f64, along: Option<f64>| Rival { within, error: 1e-3, change, along }.beyond(1e-3);
        assert!(beyond(5e-3, f64::INFINITY, None) == 0.0);
        assert!((beyond(3e-3, f64::INFINITY, None) - 5e-4).abs() < 1e-15);
        assert!(beyond(1e-4, 0.04, None) == 0.0 && beyond(1e-4, 0.06, None) > 0.0);
        assert!((beyond(-1e-9, f64::INFINITY, Some(1e-6)) - 1.0005e-6).abs() < 1e-15);
        assert!(beyond(f64::NAN, 0.0, None) == f64::INFINITY);
    }
}
