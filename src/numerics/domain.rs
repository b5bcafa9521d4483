//! The box of uncertain parameters and its unit coordinates.

/// k parameters, each known to lie in an interval.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParameterBox {
    /// What the parameters are meant to be; anywhere in the box.
    pub nominal: Vec<f64>,
    /// Smallest values.
    pub lower: Vec<f64>,
    /// Largest values; none below its `lower`.
    pub upper: Vec<f64>,
}

impl ParameterBox {
    /// Number of parameters, k.
    pub fn dimension(&self) -> usize {
        self.lower.len()
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

    /// The point at ξ ∈ [−1, 1]^k; `xi` and `out` have k entries.
    pub fn map(&self, xi: &[f64], out: &mut [f64]) {
        for (parameter, (value, &xi)) in out.iter_mut().zip(xi).enumerate() {
            *value = self.value(parameter, xi);
        }
    }

    /// The same, as a point of its own.
    pub fn point(&self, xi: &[f64]) -> Vec<f64> {
        let mut point = vec![0.0; xi.len()];
        self.map(xi, &mut point);
        point
    }

    /// ξ of a point; 0 along what has no width.
    pub fn xi(&self, point: &[f64]) -> Vec<f64> {
        let along = |axis: usize| match self.half_width(axis) {
            half if half > 0.0 => (point[axis] - self.midpoint(axis)) / half,
            _ => 0.0,
        };
        (0..point.len()).map(along).collect()
    }

    /// Whether a point lies in the box.
    pub fn contains(&self, point: &[f64]) -> bool {
        let ends = self.lower.iter().zip(&self.upper);
        point.iter().zip(ends).all(|(value, (lower, upper))| (lower..=upper).contains(&value))
    }

    /// The points at many ξ.
    pub fn points(&self, xi: &[Vec<f64>]) -> Vec<Vec<f64>> {
        xi.iter().map(|xi| self.point(xi)).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_papers_crank_length() {
        let domain = ParameterBox { nominal: vec![0.15], lower: vec![0.1485], upper: vec![0.1515] };
        assert!((domain.midpoint(0) - 0.15).abs() < 1e-16);
        assert!((domain.half_width(0) - 0.0015).abs() < 1e-16);
        let mut point = [0.0];
        domain.map(&[0.5], &mut point);
        assert!((point[0] - 0.15 * (1.0 + 0.01 * 0.5)).abs() < 1e-16);
    }

    proptest! {
        #[test]
        fn ends_are_exact_and_nothing_lies_outside(a in -1e3..1e3_f64, b in -1e3..1e3_f64, xi in -1.0..=1.0_f64) {
            let (lower, upper) = (a.min(b), a.max(b));
            let domain = ParameterBox { nominal: vec![a], lower: vec![lower], upper: vec![upper] };
            prop_assert_eq!(domain.value(0, -1.0), lower);
            prop_assert_eq!(domain.value(0, 1.0), upper);
            prop_assert!((lower..=upper).contains(&domain.value(0, xi)));
            prop_assert!(domain.contains(&domain.point(&[xi])) && !domain.contains(&[upper.next_up()]));
            let back = domain.xi(&domain.point(&[xi]))[0];
            prop_assert!((back - xi).abs() * domain.half_width(0) <= 1e-12 * (1.0 + a.abs().max(b.abs())));
            let certain = ParameterBox { nominal: vec![a], lower: vec![a], upper: vec![a] };
            prop_assert_eq!(certain.value(0, xi), a);
            prop_assert_eq!(certain.half_width(0), 0.0);
        }
    }
}
