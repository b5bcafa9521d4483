//! The range of a Taylor polynomial in scaled parameters ξ ∈ [−1, 1]^k.

use symdiff::jet::Monomials;

use super::polynomial_range::{PolynomialRange, RangeKind};
use super::range::{Enclosed, Range, least, most};
use super::tensor::{Matrix, Separable, Work};
use super::tuning::TUNING;

/// Bounds polynomials of total degree N in k variables, given by coefficients in the order of [`Monomials`], which is
/// that of jets: Σ c_e ξ₁^e₁ … ξ_k^e_k.
#[derive(Clone, Debug)]
pub struct TaylorRange {
    kind: RangeKind,
    monomials: Monomials,
    /// Whether all powers of a monomial are even: then it lies in [0, 1], otherwise in [−1, 1].
    even: Vec<bool>,
    tensor: Option<Tensor>,
}

/// The same polynomial as a tensor of Chebyshev polynomials of degree N in each variable.
#[derive(Clone, Debug)]
struct Tensor {
    /// Index of each monomial in the tensor of powers.
    indices: Vec<usize>,
    powers: Vec<f64>,
    conversion: Separable,
    work: Work,
    range: PolynomialRange,
}

impl TaylorRange {
    /// Range of polynomials in `variables` variables of total degree `order`.
    pub fn new(variables: usize, order: usize, kind: RangeKind) -> Self {
        let monomials = Monomials::new(variables, order);
        let even = (0..monomials.len()).map(|r| monomials.exponents(r).iter().all(|e| e % 2 == 0)).collect();
        let size = (0..variables).fold(1_usize, |size, _| size.saturating_mul(order + 1));
        let tensor = (size <= TUNING.max_tensor).then(|| {
            let index = |r| monomials.exponents(r).iter().fold(0, |index, e| index * (order + 1) + e);
            Tensor {
                indices: (0..monomials.len()).map(index).collect(),
                powers: vec![0.0; size],
                conversion: Separable::new(vec![chebyshev_of_powers(order); variables]),
                work: Work::default(),
                range: PolynomialRange::new(&vec![order; variables], RangeKind::Tight),
            }
        });
        Self { kind, monomials, even, tensor }
    }

    /// Monomials of the coefficients.
    pub fn monomials(&self) -> &Monomials {
        &self.monomials
    }

    /// Range of the polynomial with these coefficients. Exact for a constant; unknown if any coefficient is infinite or
    /// NaN. The tight range is never wider than the one term by term.
    pub fn range(&mut self, coefficients: &[f64]) -> Range {
        self.enclose(coefficients).0
    }

    /// The same, with how much too wide it may be: NaN if the polynomial is too large to know.
    pub fn enclose(&mut self, coefficients: &[f64]) -> (Range, f64) {
        let terms = self.term_by_term(coefficients);
        let Some(tensor) = &mut self.tensor else { return (terms, f64::NAN) };
        for (&index, &c) in tensor.indices.iter().zip(coefficients) {
            tensor.powers[index] = c;
        }
        let Enclosed { outer, attained } =
            tensor.range.enclose(tensor.conversion.apply(&tensor.powers, &mut tensor.work));
        let range = match self.kind {
            RangeKind::Tight if !terms.lower.is_nan() => {
                Range { lower: most(outer.lower, terms.lower), upper: least(outer.upper, terms.upper) }
            }
            _ => terms,
        };
        (range, Enclosed { outer: range, attained }.excess())
    }

    /// The paper's (8) without its remainder, each power evaluated as a power: even ones are not negative.
    fn term_by_term(&self, coefficients: &[f64]) -> Range {
        assert_eq!(coefficients.len(), self.monomials.len(), "coefficients of another shape");
        let (mut below, mut above) = (0.0, 0.0);
        for (&c, &even) in coefficients.iter().zip(&self.even).skip(1) {
            // Written so that NaN stays so.
            below += if even && c > 0.0 { 0.0 } else { -c.abs() };
            above += if even && c < 0.0 { 0.0 } else { c.abs() };
        }
        let range = Range { lower: coefficients[0] + below, upper: coefficients[0] + above };
        if range.lower.is_finite() && range.upper.is_finite() { range } else { Range::UNKNOWN }
    }
}

/// Column e: Chebyshev coefficients of x^e. x C_j = (C_{j+1} + C_{|j−1|})/2.
fn chebyshev_of_powers(order: usize) -> Matrix {
    let mut columns = vec![vec![0.0; order + 1]; order + 1];
    columns[0][0] = 1.0;
    for e in 0..order {
        for j in 0..=e {
            let c = columns[e][j];
            columns[e + 1][j + 1] += 0.5 * c;
            columns[e + 1][j.abs_diff(1)] += 0.5 * c;
        }
    }
    Matrix::new(order + 1, order + 1, |j, e| columns[e][j])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn even_powers_are_non_negative() {
        // 1 + ξ² in [1, 2], not [0, 2]; 1 − ξ₁ξ₂ in [0, 2].
        let c = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        assert_eq!(TaylorRange::new(2, 2, RangeKind::Interval).range(&c), Range { lower: 1.0, upper: 2.0 });
        let c = [1.0, 0.0, 0.0, 0.0, -1.0, 0.0];
        assert_eq!(TaylorRange::new(2, 2, RangeKind::Interval).range(&c), Range { lower: 0.0, upper: 2.0 });
    }

    #[test]
    fn tight_range_accounts_for_dependence_of_terms() {
        // ξ − ξ²/2 in [−3/2, 1/2]; term by term [−3/2, 1].
        let c = [0.0, 1.0, -0.5];
        assert_eq!(TaylorRange::new(1, 2, RangeKind::Interval).range(&c), Range { lower: -1.5, upper: 1.0 });
        let tight = TaylorRange::new(1, 2, RangeKind::Tight).range(&c);
        assert!((tight.lower + 1.5).abs() < 1e-12 && (0.5..0.503).contains(&tight.upper), "{tight:?}");
    }

    #[test]
    fn ranges_of_nan_are_unknown_and_of_constants_exact() {
        for kind in [RangeKind::Interval, RangeKind::Tight] {
            let mut range = TaylorRange::new(2, 2, kind);
            for hole in 0..6 {
                let mut c = [0.5; 6];
                c[hole] = f64::NAN;
                let unknown = range.range(&c);
                assert!(unknown.lower.is_nan() && unknown.upper.is_nan());
            }
            assert_eq!(range.range(&[0.1, 0.0, 0.0, 0.0, 0.0, 0.0]), Range { lower: 0.1, upper: 0.1 });
            assert_eq!(TaylorRange::new(2, 0, kind).range(&[0.1]), Range { lower: 0.1, upper: 0.1 });
        }
    }

    proptest! {
        #[test]
        fn ranges_enclose(
            (variables, order) in prop_oneof![(1..4_usize, 0..5_usize), (4..6_usize, 0..4_usize)],
            c in prop::collection::vec(-1.0..1.0_f64, 126),
            points in prop::collection::vec(prop::array::uniform5(-1.0..=1.0_f64), 50),
        ) {
            let mut tight = TaylorRange::new(variables, order, RangeKind::Tight);
            let c = &c[..tight.monomials().len()];
            let terms = TaylorRange::new(variables, order, RangeKind::Interval).range(c);
            let range = tight.range(c);
            prop_assert!(terms.lower <= range.lower && range.upper <= terms.upper);
            for point in points {
                let value = tight.monomials().evaluate(c, &point[..variables]);
                prop_assert!(range.lower - 1e-13 <= value && value <= range.upper + 1e-13);
            }
        }
    }
}
