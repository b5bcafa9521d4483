//! The Chebyshev surrogate: responses at the nodes → coefficients of a tensor polynomial → its values.

use super::samples::TensorGrid;
use super::tensor::{Matrix, Separable, Work, cos_pi};

/// Tensor Chebyshev polynomials of degree nᵢ in parameter i, found from mᵢ > nᵢ nodes along it.
///
/// A polynomial is f(ξ) = Σ c[j₁…j_k] C_j₁(ξ₁) … C_j_k(ξ_k), 0 ≤ jᵢ ≤ nᵢ, its coefficients stored with the last index
/// fastest; the factors (1/2)^p of the paper's (14) are in the coefficients.
#[derive(Clone, Debug)]
pub struct ChebyshevBasis {
    nodes: Vec<usize>,
    pub(super) quadrature: Separable,
}

impl ChebyshevBasis {
    /// The basis with a degree and a number of nodes for each parameter.
    ///
    /// # Panics
    /// If there are not more nodes than the degree: the highest polynomial would be zero, or an alias, on the nodes.
    pub fn new(orders: &[usize], nodes: &[usize]) -> Self {
        assert_eq!(orders.len(), nodes.len(), "each parameter has a degree and a number of nodes");
        let axis = |(&n, &m): (&usize, &usize)| {
            assert!(m > n, "degree {n} needs more than {n} nodes, not {m}");
            // Mehler quadrature, the paper's (16): 2/m Σ_j f(cos θ_j) cos i θ_j, halved for i = 0.
            Matrix::new(n + 1, m, |i, j| {
                let weight = if i == 0 { 1.0 } else { 2.0 };
                weight * cos_pi(i * (2 * j + 1), 2 * m) / m as f64
            })
        };
        let quadrature = Separable::new(orders.iter().zip(nodes).map(axis).collect());
        Self { nodes: nodes.to_vec(), quadrature }
    }

    /// Samples at which the response is needed, in the order in which [`coefficients`](Self::coefficients) takes it.
    pub fn grid(&self) -> TensorGrid {
        TensorGrid::chebyshev_zeros(&self.nodes)
    }

    /// Coefficients of the polynomial for the response `values` at all samples of [`grid`](Self::grid). The result lies
    /// in `work`, which allocates only when first used.
    pub fn coefficients<'a>(&self, values: &[f64], work: &'a mut Work) -> &'a [f64] {
        self.quadrature.apply(values, work)
    }
}

#[cfg(test)]
mod tests {
    use super::super::evaluation::clenshaw;
    use super::*;
    use proptest::prelude::*;

    fn expand(basis: &ChebyshevBasis, f: impl Fn(&[f64]) -> f64) -> Vec<f64> {
        let grid = basis.grid();
        let values: Vec<f64> = (0..grid.len()).map(|index| f(&grid.sample(index))).collect();
        basis.coefficients(&values, &mut Work::default()).to_vec()
    }

    #[test]
    fn powers_have_their_textbook_coefficients() {
        // x³ = (3 C₁ + C₃)/4, x⁴ = (3 + 4 C₂ + C₄)/8
        for m in [5, 6, 9] {
            let basis = ChebyshevBasis::new(&[4], &[m]);
            let cubic = expand(&basis, |x| x[0].powi(3));
            let quartic = expand(&basis, |x| x[0].powi(4));
            for (c, expected) in cubic.iter().zip([0.0, 0.75, 0.0, 0.25, 0.0]) {
                assert!((c - expected).abs() < 1e-15);
            }
            for (c, expected) in quartic.iter().zip([0.375, 0.0, 0.5, 0.0, 0.125]) {
                assert!((c - expected).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn orders_may_differ_and_the_last_index_is_fastest() {
        let basis = ChebyshevBasis::new(&[1, 2, 0], &[2, 4, 1]);
        // 2 + 3 x + 5 x C₂(y)
        let c = expand(&basis, |x| 2.0 + 3.0 * x[0] + 5.0 * x[0] * (2.0 * x[1] * x[1] - 1.0));
        for (c, expected) in c.iter().zip([2.0, 0.0, 0.0, 3.0, 0.0, 5.0]) {
            assert!((c - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn runges_function_converges_at_its_rate() {
        // 1/(1 + 25 x²): error of the interpolant falls as ρ^-n, ρ = (1 + √26)/5 = 1.2198.
        let runge = |x: f64| 1.0 / (1.0 + 25.0 * x * x);
        let error = |n: usize| {
            let basis = ChebyshevBasis::new(&[n], &[n + 1]);
            let c = expand(&basis, |x| runge(x[0]));
            (0..=1000)
                .map(|i| f64::from(i) / 500.0 - 1.0)
                .map(|x| (clenshaw(&c, x) - runge(x)).abs())
                .fold(0.0, f64::max)
        };
        let rate = (error(60) / error(40)).powf(-1.0 / 20.0);
        assert!((rate - 1.2198).abs() < 0.01, "{rate}");
    }

    proptest! {
        #[test]
        fn expansion_restores_coefficients(c in prop::collection::vec(-1.0..1.0_f64, 24), xi in prop::array::uniform3(-1.0..=1.0_f64)) {
            let basis = ChebyshevBasis::new(&[1, 3, 2], &[3, 4, 5]);
            let found = expand(&basis, |x| basis.evaluate(&c, x));
            for (found, c) in found.iter().zip(&c) {
                prop_assert!((found - c).abs() < 1e-14);
            }
            let grid = TensorGrid::new(xi.iter().map(|&x| vec![0.5, x]).collect());
            let value = basis.on(&grid).values(&c)[7];
            prop_assert!((value - basis.evaluate(&c, &xi)).abs() < 1e-14);
        }
    }
}
