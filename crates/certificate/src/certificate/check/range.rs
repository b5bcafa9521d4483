//! Whether a polynomial with a radius stays between two ends over ξ ∈ [−1, 1]^k.

use std::collections::BTreeMap;

use crate::certificate::tuning::TUNING;
use symdiff::jet::Monomials;
use symdiff::taylor_model::{ModelSpace, up};

/// Splits boxes until all are decided.
pub(super) struct Ranges<'r> {
    monomials: &'r Monomials,
    /// For each axis and monomial, the monomial with one power less of that axis.
    lowered: Vec<Vec<Option<usize>>>,
}

impl<'r> Ranges<'r> {
    pub fn new(space: &'r ModelSpace) -> Self {
        let monomials = space.jets().monomials();
        let all = 0..monomials.len();
        let index: BTreeMap<&[usize], usize> = all.clone().map(|r| (monomials.exponents(r), r)).collect();
        let lower = |axis: usize, r: usize| {
            let mut exponents = monomials.exponents(r).to_vec();
            exponents[axis] = exponents[axis].checked_sub(1)?;
            index.get(exponents.as_slice()).copied()
        };
        let lowered = (0..monomials.variables()).map(|axis| all.clone().map(|r| lower(axis, r)).collect()).collect();
        Self { monomials, lowered }
    }

    /// Whether all values of a model are proven to be between two ends.
    pub fn is_within(&self, model: &[f64], [lower, upper]: [f64; 2]) -> bool {
        let mut open = vec![model.to_vec()];
        for _ in 0..TUNING.most_boxes {
            let Some(next) = open.pop() else { return true };
            let (coefficients, radius) = next.split_at(next.len() - 1);
            let spread = up(coefficients[1..].iter().map(|c| c.abs()).sum::<f64>() + radius[0]);
            let middle = coefficients[0];
            // Written so that NaN is no proof.
            if (middle - spread).next_down() >= lower && (middle + spread).next_up() <= upper {
                continue;
            }
            let is_inside = middle - radius[0] >= lower && middle + radius[0] <= upper;
            let Some(axis) = self.widest(coefficients).filter(|_| is_inside) else { return false };
            open.extend([-1.0, 1.0].map(|side| self.half(&next, axis, side)));
        }
        false
    }

    /// The axis along which a polynomial changes most.
    fn widest(&self, coefficients: &[f64]) -> Option<usize> {
        let change = |axis: usize| -> f64 {
            coefficients.iter().enumerate().map(|(r, c)| c.abs() * self.monomials.exponents(r)[axis] as f64).sum()
        };
        let axes = (0..self.monomials.variables()).map(|axis| (axis, change(axis)));
        axes.filter(|(_, change)| *change > 0.0).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(axis, _)| axis)
    }

    /// The model over one half of its box: ξ = (ξ' + side)/2 along an axis.
    fn half(&self, model: &[f64], axis: usize, side: f64) -> Vec<f64> {
        let count = self.monomials.len();
        let mut half = vec![0.0; model.len()];
        for (r, &c) in model[..count].iter().enumerate().filter(|(_, c)| **c != 0.0) {
            let power = self.monomials.exponents(r)[axis];
            // C(power, j) side^(power − j) / 2^power, exact, from j = power down.
            let (mut to, mut factor) = (Some(r), 0.5_f64.powi(power as i32));
            let mut left = power;
            while let Some(index) = to {
                half[index] += c * factor;
                factor = factor * side * left as f64 / (power - left + 1) as f64;
                (to, left) = (self.lowered[axis][index], left.saturating_sub(1));
            }
        }
        // A sum of at most order + 1 terms, of which each is rounded once.
        let size: f64 = model[..count].iter().map(|c| c.abs()).sum();
        let rounding = (self.monomials.order() + 3) as f64 * f64::EPSILON * size;
        half[count] = up(model[count] + rounding);
        half
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_separate_ends_from_values_beyond_them() {
        let space = ModelSpace::new(2, 3);
        let ranges = Ranges::new(&space);
        let monomials = space.jets().monomials();
        let index =
            |exponents: [usize; 2]| (0..monomials.len()).find(|&r| monomials.exponents(r) == exponents).unwrap();
        let mut model = vec![0.0; space.size()];
        // x³ − x + y² has its ends at x = ∓1/√3: from −2/(3√3) to 1 + 2/(3√3).
        for (exponents, c) in [([3, 0], 1.0), ([1, 0], -1.0), ([0, 2], 1.0)] {
            model[index(exponents)] = c;
        }
        let end = 2.0 / 27.0_f64.sqrt();
        assert!(ranges.is_within(&model, [-end - 1e-9, 1.0 + end + 1e-9]));
        assert!(!ranges.is_within(&model, [-end + 1e-6, 1.0 + end + 1e-9]));
        assert!(!ranges.is_within(&model, [-end - 1e-9, 1.0 + end - 1e-6]));
        *model.last_mut().unwrap() = 1e-3;
        assert!(!ranges.is_within(&model, [-end - 1e-4, 1.0 + end + 1e-4]));
        *model.last_mut().unwrap() = f64::NAN;
        assert!(!ranges.is_within(&model, [-9.0, 9.0]));
    }
}
