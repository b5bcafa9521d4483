//! The box of uncertain parameters and its unit coordinates.
//!
//! Searches, grids and surrogates know points of [−1, 1]^k only, as slices of numbers; a simulation takes a [`Sample`].

use std::ops::Deref;

use serde::{Deserialize, Serialize};

use super::point_set::{PointSet, Points};

/// Values of the k parameters in their units, for one simulation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample(Vec<f64>);

impl From<Vec<f64>> for Sample {
    fn from(values: Vec<f64>) -> Self {
        Self(values)
    }
}

impl FromIterator<f64> for Sample {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}

impl AsRef<[f64]> for Sample {
    fn as_ref(&self) -> &[f64] {
        &self.0
    }
}

impl Deref for Sample {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.0
    }
}

/// k parameters, each known to lie in an interval.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParameterBox {
    /// Intended values of the parameters; anywhere in the box.
    pub nominal: Sample,
    /// Smallest values.
    pub lower: Vec<f64>,
    /// Largest values; none below its `lower`.
    pub upper: Vec<f64>,
    /// Parameters that are one cause together, by their indices; every other one is a cause alone.
    pub zones: Vec<Vec<usize>>,
}

impl ParameterBox {
    /// Number of parameters, k.
    pub fn dimension(&self) -> usize {
        self.lower.len()
    }

    /// The parameters of the cause that one belongs to.
    pub fn cause(&self, parameter: usize) -> Vec<usize> {
        self.zones.iter().find(|zone| zone.contains(&parameter)).cloned().unwrap_or_else(|| vec![parameter])
    }

    /// Middle of a parameter's interval, the paper's (9).
    pub fn midpoint(&self, parameter: usize) -> f64 {
        self.value(parameter, 0.0)
    }

    /// Half the width of a parameter's interval, the paper's (10).
    pub fn half_width(&self, parameter: usize) -> f64 {
        0.5 * self.upper[parameter] - 0.5 * self.lower[parameter]
    }

    /// The parameter at ξ ∈ [−1, 1]: exactly `lower` at −1 and `upper` at 1, never outside them, and where they are
    /// equal that value for every ξ.
    pub fn value(&self, parameter: usize, xi: f64) -> f64 {
        let (lower, upper) = (self.lower[parameter], self.upper[parameter]);
        if lower == upper {
            return lower;
        }
        // Weights, not midpoint + half width · ξ, which misses the ends by rounding.
        let value = 0.5 * (1.0 - xi) * lower + 0.5 * (1.0 + xi) * upper;
        if value < lower {
            lower
        } else if value > upper {
            upper
        } else {
            value
        }
    }

    /// The sample at ξ ∈ [−1, 1]^k.
    pub fn sample(&self, xi: &[f64]) -> Sample {
        xi.iter().enumerate().map(|(parameter, &xi)| self.value(parameter, xi)).collect()
    }

    /// ξ of a sample; 0 along parameters without width.
    pub fn xi(&self, sample: &[f64]) -> Vec<f64> {
        (0..sample.len()).map(|axis| self.axis(axis).xi(sample[axis])).collect()
    }

    /// ξ of many samples.
    pub fn xi_of(&self, samples: Points) -> PointSet {
        let axes: Vec<ParameterAxis> = (0..self.dimension()).map(|axis| self.axis(axis)).collect();
        PointSet::mapped(samples.iter(), axes.len(), |sample, axis| axes[axis].xi(sample[axis]))
    }

    fn axis(&self, parameter: usize) -> ParameterAxis {
        ParameterAxis { middle: self.midpoint(parameter), half: self.half_width(parameter) }
    }

    /// Values of the parameters at many ξ, parameter by parameter; where ξ is outside of \[−1, 1\] by more than
    /// `beyond`, outside of the box as well.
    pub fn continued(&self, xi: Points, beyond: f64) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.dimension() * xi.len());
        for parameter in 0..self.dimension() {
            values.extend(xi.iter().map(|point| match point[parameter] {
                xi if xi.abs() <= 1.0 + beyond => self.value(parameter, xi),
                xi => self.midpoint(parameter) + self.half_width(parameter) * xi,
            }));
        }
        values
    }

    /// Whether a sample lies in the box.
    pub fn contains(&self, sample: &[f64]) -> bool {
        let ends = self.lower.iter().zip(&self.upper);
        sample.iter().zip(ends).all(|(value, (lower, upper))| (lower..=upper).contains(&value))
    }

    /// The samples at many ξ.
    pub fn samples(&self, xi: &[Vec<f64>]) -> Vec<Sample> {
        xi.iter().map(|xi| self.sample(xi)).collect()
    }

    /// Both halves, cut across an axis in its middle.
    pub fn halves(&self, axis: usize) -> [Self; 2] {
        let middle = self.midpoint(axis);
        let mut halves = [self.clone(), self.clone()];
        halves[0].upper[axis] = middle;
        halves[1].lower[axis] = middle;
        halves
    }
}

/// A parameter's interval.
struct ParameterAxis {
    middle: f64,
    /// Half the width.
    half: f64,
}

impl ParameterAxis {
    fn xi(&self, value: f64) -> f64 {
        if self.half > 0.0 { (value - self.middle) / self.half } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_papers_crank_length() {
        let domain = ParameterBox {
            nominal: vec![0.15].into(),
            lower: vec![0.1485],
            upper: vec![0.1515],
            ..ParameterBox::default()
        };
        assert!((domain.midpoint(0) - 0.15).abs() < 1e-16);
        assert!((domain.half_width(0) - 0.0015).abs() < 1e-16);
        let sample = domain.sample(&[0.5]);
        assert!((sample[0] - 0.15 * (1.0 + 0.01 * 0.5)).abs() < 1e-16);
    }

    proptest! {
        #[test]
        fn ends_are_exact_and_nothing_lies_outside(a in -1e3..1e3_f64, b in -1e3..1e3_f64, xi in -1.0..=1.0_f64) {
            let (lower, upper) = (a.min(b), a.max(b));
            let domain = ParameterBox { nominal: vec![a].into(), lower: vec![lower], upper: vec![upper], ..ParameterBox::default() };
            prop_assert_eq!(domain.value(0, -1.0), lower);
            prop_assert_eq!(domain.value(0, 1.0), upper);
            prop_assert!((lower..=upper).contains(&domain.value(0, xi)));
            prop_assert!(domain.contains(&domain.sample(&[xi])) && !domain.contains(&[upper.next_up()]));
            let back = domain.xi(&domain.sample(&[xi]))[0];
            prop_assert!((back - xi).abs() * domain.half_width(0) <= 1e-12 * (1.0 + a.abs().max(b.abs())));
            let certain = ParameterBox { nominal: vec![a].into(), lower: vec![a], upper: vec![a], ..ParameterBox::default() };
            prop_assert_eq!(certain.value(0, xi), a);
            prop_assert_eq!(certain.half_width(0), 0.0);
        }
    }
}
