//! Values at the nodes of a sparse grid → coefficients of the polynomial through them.
//!
//! Along one axis this is a product of two matrices, triangular in levels: values → surpluses → coefficients
//! (`leja.rs`). For tensor products of those, restricted to a downward-closed set, the restriction of a product is the
//! product of the restrictions as long as all of the first kind are applied before any of the second: every
//! intermediate multi-index is below one of the set. So surpluses are formed along one axis after the other, and then
//! coefficients, each along the lines of nodes that the set has; the nodes with few active axes, which are most, cost
//! next to nothing. (It is the sum of the combination technique's tensor interpolants, without their cancellation.)

use symdiff::{Vectorise, vectorised};

use super::leja::Level;
use super::sparse_basis::{Fibres, LANES, Lanes, SparseBasis};
use super::sparse_grid::SparseGrid;

/// Interpolation on one sparse grid; made once for any number of quantities, and shared by threads.
#[derive(Clone, Debug)]
pub struct SparseTransform {
    basis: SparseBasis,
    levels: Vec<&'static Level>,
}

/// Buffers for [`SparseTransform::coefficients`], reused between calls.
#[derive(Clone, Debug, Default)]
pub struct TransformWork {
    nodes: Vec<Lanes>,
}

impl SparseTransform {
    /// Transform of values at all nodes of a grid.
    pub fn new(grid: &SparseGrid) -> Self {
        let basis = SparseBasis::new(grid);
        let highest = basis.orders().iter().copied().max().unwrap_or(0);
        Self { basis, levels: (1..=highest).map(Level::of).collect() }
    }

    /// Basis of the coefficients.
    pub fn basis(&self) -> &SparseBasis {
        &self.basis
    }

    /// Coefficients of many quantities from their `values` at the nodes, one quantity after the other, in both. The
    /// polynomials have these values at the nodes. Allocates only when `work` is first used.
    pub fn coefficients(&self, values: &[f64], out: &mut [f64], work: &mut TransformWork) {
        assert_eq!(values.len(), out.len(), "as many coefficients as values");
        assert!(values.len().is_multiple_of(self.basis.len()), "a value for each node");
        vectorised(Interpolation { transform: self, values, out, work });
    }

    #[inline(always)]
    fn surpluses(&self, fibres: &Fibres, nodes: &mut [Lanes]) {
        for fibre in fibres.iter() {
            // The highest level first: its predictions are from values.
            for (level, &new) in fibre.iter().enumerate().skip(1).rev() {
                let mut surplus = nodes[new as usize];
                for (&weight, &old) in self.levels[level - 1].prediction.iter().zip(fibre) {
                    let old = &nodes[old as usize];
                    surplus.iter_mut().zip(old).for_each(|(surplus, old)| *surplus -= weight * old);
                }
                nodes[new as usize] = surplus;
            }
        }
    }

    #[inline(always)]
    fn assemble(&self, fibres: &Fibres, nodes: &mut [Lanes]) {
        for fibre in fibres.iter() {
            for (level, &new) in fibre.iter().enumerate().skip(1) {
                let surplus = std::mem::replace(&mut nodes[new as usize], [0.0; LANES]);
                for (&weight, &term) in self.levels[level - 1].cardinal.iter().zip(fibre) {
                    let coefficient = &mut nodes[term as usize];
                    coefficient.iter_mut().zip(&surplus).for_each(|(c, surplus)| *c += weight * surplus);
                }
            }
        }
    }
}

/// [`SparseTransform::coefficients`], compiled for wide vectors.
struct Interpolation<'a> {
    transform: &'a SparseTransform,
    values: &'a [f64],
    out: &'a mut [f64],
    work: &'a mut TransformWork,
}

impl Vectorise for Interpolation<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { transform, values, out, work } = self;
        let count = transform.basis.len();
        let axes = || (0..transform.basis.dimension()).map(|axis| transform.basis.fibres(axis));
        for (values, out) in values.chunks(LANES * count).zip(out.chunks_mut(LANES * count)) {
            work.nodes.clear();
            work.nodes.resize(count, [0.0; LANES]);
            for (lane, line) in values.chunks_exact(count).enumerate() {
                work.nodes.iter_mut().zip(line).for_each(|(node, &value)| node[lane] = value);
            }
            axes().for_each(|fibres| transform.surpluses(fibres, &mut work.nodes));
            axes().for_each(|fibres| transform.assemble(fibres, &mut work.nodes));
            for (lane, line) in out.chunks_exact_mut(count).enumerate() {
                line.iter_mut().zip(&work.nodes).for_each(|(c, node)| *c = node[lane]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::chebyshev::ChebyshevBasis;
    use super::super::point_set::PointSet;
    use super::super::samples::TensorGrid;
    use super::*;
    use proptest::prelude::*;

    fn expand(transform: &SparseTransform, grid: &SparseGrid, f: impl Fn(&[f64]) -> f64) -> Vec<f64> {
        let values: Vec<f64> = (0..grid.len()).map(|index| f(&grid.sample(index))).collect();
        let mut out = vec![0.0; values.len()];
        transform.coefficients(&values, &mut out, &mut TransformWork::default());
        out
    }

    #[test]
    fn powers_have_their_textbook_coefficients() {
        // x⁴ = (3 + 4 C₂ + C₄)/8, and x y² = C₁(x) (1 + C₂(y))/2
        let grid = SparseGrid::tensor(&[4]);
        let c = expand(&SparseTransform::new(&grid), &grid, |x| x[0].powi(4));
        for (c, expected) in c.iter().zip([0.375, 0.0, 0.5, 0.0, 0.125]) {
            assert!((c - expected).abs() < 1e-15);
        }
        let grid = SparseGrid::tensor(&[2, 2]);
        let transform = SparseTransform::new(&grid);
        let c = expand(&transform, &grid, |x| x[0] * x[1] * x[1]);
        for (term, c) in c.iter().enumerate() {
            let expected =
                if [[1, 0].as_slice(), &[1, 2]].contains(&transform.basis().degrees(term)) { 0.5 } else { 0.0 };
            assert!((c - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn full_tensors_converge_as_chebyshev_does() {
        let f = |x: &[f64]| 1.0 / (2.5 + x[0] + 0.3 * x[1] * x[0]);
        let grid = SparseGrid::tensor(&[16, 8]);
        let sparse = SparseTransform::new(&grid);
        let c = expand(&sparse, &grid, f);
        let zeros = ChebyshevBasis::new(&[30, 20], &[31, 21]);
        let samples = zeros.grid();
        let values: Vec<f64> = (0..samples.len()).map(|index| f(&samples.sample(index))).collect();
        let reference = zeros.coefficients(&values, &mut Default::default()).to_vec();
        // In x the coefficients fall by 0.42 a degree or faster.
        for (term, &c) in c.iter().enumerate() {
            let [i, j] = [0, 1].map(|axis| usize::from(sparse.basis().degrees(term)[axis]));
            assert!((c - reference[i * 21 + j]).abs() < 2e-5);
        }
        let points = TensorGrid::full_factorial(&[20, 20]);
        for index in 0..points.len() {
            let xi = points.sample(index);
            assert!((sparse.basis().evaluate(&c, &xi) - f(&xi)).abs() < 2e-5);
        }
    }

    #[test]
    fn nan_reaches_some_coefficient() {
        let grid = SparseGrid::tensor(&[4, 2]);
        let transform = SparseTransform::new(&grid);
        for hole in 0..grid.len() {
            let mut values = vec![1.0; grid.len()];
            values[hole] = f64::NAN;
            let mut out = values.clone();
            transform.coefficients(&values, &mut out, &mut TransformWork::default());
            assert!(out.iter().any(|c| c.is_nan()));
        }
    }

    /// A grid grown by choices among its candidates.
    fn grown() -> impl Strategy<Value = SparseGrid> {
        (prop::collection::vec(0..9_u8, 0..5), prop::collection::vec(0..1000_usize, 0..60)).prop_map(
            |(caps, choices)| {
                let mut grid = SparseGrid::new(&caps);
                for choice in choices {
                    let candidates = grid.candidates();
                    if let Some(chosen) = candidates.get(choice % candidates.len().max(1)) {
                        grid.add(chosen);
                    }
                }
                grid
            },
        )
    }

    proptest! {
        #[test]
        fn values_at_the_nodes_are_reproduced(grid in grown(), seed in prop::collection::vec(-1.0..1.0_f64, 12)) {
            let transform = SparseTransform::new(&grid);
            let count = grid.len();
            let values: Vec<f64> = (0..11 * count).map(|i| seed[i % 12] * seed[i / 12 % 12] + seed[i / 144 % 12]).collect();
            let mut c = vec![0.0; values.len()];
            transform.coefficients(&values, &mut c, &mut TransformWork::default());
            let nodes: Vec<Vec<f64>> = (0..count).map(|index| grid.sample(index)).collect();
            let mut found = vec![0.0; values.len()];
            transform.basis().values(PointSet::of(&nodes).points(), &c, &mut found, &mut Default::default());
            for (found, value) in found.iter().zip(&values) {
                prop_assert!((found - value).abs() < 1e-12, "{} {}", found, value);
            }
            // A quantity's coefficients do not depend on those that share its tile.
            let mut alone = vec![0.0; count];
            transform.coefficients(&values[9 * count..10 * count], &mut alone, &mut TransformWork::default());
            prop_assert_eq!(&alone, &c[9 * count..10 * count]);
        }

        #[test]
        fn polynomials_of_its_space_are_exact(grid in grown(), seed in prop::collection::vec(-1.0..1.0_f64, 17)) {
            let transform = SparseTransform::new(&grid);
            let c: Vec<f64> = (0..grid.len()).map(|t| seed[t % 17]).collect();
            let found = expand(&transform, &grid, |xi| transform.basis().evaluate(&c, xi));
            for (found, c) in found.iter().zip(&c) {
                prop_assert!((found - c).abs() < 1e-12, "{} {}", found, c);
            }
        }
    }
}
