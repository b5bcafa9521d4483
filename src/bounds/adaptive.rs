//! Which indices a sparse grid takes next: those along which the response still has something to say.
//!
//! What an index has brought to a surrogate is the sum of |c| over its own terms. A candidate is expected to bring no more than
//! any of the indices just below it did, times how fast those fell: along each axis the ratio of the last two steps.
//! That is a guess from smoothness, not a bound: the error of a surrogate is measured by values at other points.

use super::sparse_grid::{Candidate, SparseGrid};

/// Candidates that are expected to bring this share of the largest are taken together.
const BULK: f64 = 0.25;

/// What each index has brought, in the order of [`SparseGrid::indices`]: Σ|c| over its terms, `coefficients` being those of
/// one quantity from the grid's values.
pub fn contributions(grid: &SparseGrid, coefficients: &[f64]) -> Vec<f64> {
    grid.indices().map(|(_, nodes)| coefficients[nodes].iter().map(|c| c.abs()).sum()).collect()
}

/// What each of the grid's candidates may bring, from what its indices have brought.
pub fn expected(grid: &SparseGrid, candidates: &[Candidate], contributions: &[f64]) -> Vec<f64> {
    assert_eq!(grid.indices().len(), contributions.len(), "a contribution for each index");
    let brought = |levels: &[u8]| grid.position(levels).map_or(0.0, |place| contributions[place]);
    let expectation = |candidate: &Candidate| {
        let mut levels = candidate.levels.clone();
        let mut least = f64::INFINITY;
        for axis in 0..levels.len() {
            if levels[axis] == 0 {
                continue;
            }
            levels[axis] -= 1;
            let last = brought(&levels);
            // From the middle alone nothing can be said of a fall.
            let fall = if levels[axis] == 0 { 1.0 } else {
                levels[axis] -= 1;
                let before = brought(&levels);
                levels[axis] += 1;
                if before > last { last / before } else { 1.0 }
            };
            levels[axis] += 1;
            least = least.min(last * fall);
        }
        least
    };
    candidates.iter().map(expectation).collect()
}

/// Places of the candidates to take next, by what they are expected to bring: all with a quarter of the largest or more, the
/// largest first, as far as their nodes fit the `budget`. None if nothing is expected of any, or if one is not a number.
pub fn choose(candidates: &[Candidate], expected: &[f64], budget: usize) -> Vec<usize> {
    assert_eq!(candidates.len(), expected.len(), "an expectation for each candidate");
    let largest = expected.iter().copied().fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..candidates.len()).filter(|&place| expected[place] >= BULK * largest).collect();
    // Equal ones stay in lexicographic order.
    order.sort_by(|&a, &b| expected[b].total_cmp(&expected[a]));
    let mut left = budget;
    let fits = |&place: &usize| {
        let cost = candidates[place].cost;
        let fits = cost <= left;
        left -= if fits { cost } else { 0 };
        fits
    };
    if largest > 0.0 { order.into_iter().filter(fits).collect() } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::super::sparse_transform::{SparseTransform, TransformWork};
    use super::*;

    /// Largest error at scattered points relative to the spread of values there, with a grid grown up to a number of nodes.
    fn error(k: usize, budget: usize, f: impl Fn(&[f64]) -> f64) -> (f64, usize) {
        let mut grid = SparseGrid::new(&vec![5; k]);
        let mut values = vec![f(&grid.sample(0))];
        loop {
            let transform = SparseTransform::new(&grid);
            let mut c = vec![0.0; grid.len()];
            transform.coefficients(&values, &mut c, &mut TransformWork::default());
            let candidates = grid.candidates();
            let expected = if grid.len() == 1 {
                vec![1.0; candidates.len()]
            } else {
                expected(&grid, &candidates, &contributions(&grid, &c))
            };
            let chosen = choose(&candidates, &expected, budget - grid.len());
            if chosen.is_empty() {
                let point = |n: usize| -> Vec<f64> {
                    (0..k).map(|axis| 2.0 * (n as f64 * (axis as f64 + 2.0).sqrt()).fract() - 1.0).collect()
                };
                let points: Vec<Vec<f64>> = (1..2000).map(point).collect();
                let mut found = vec![0.0; points.len()];
                transform.basis().values(&points, &c, &mut found, &mut Default::default());
                let exact: Vec<f64> = points.iter().map(|xi| f(xi)).collect();
                let worst = found.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                let spread = |fold: fn(f64, f64) -> f64| exact.iter().copied().reduce(fold).unwrap();
                return (worst / (spread(f64::max) - spread(f64::min)), grid.len());
            }
            for place in chosen {
                for node in grid.add(&candidates[place].levels) {
                    values.push(f(&grid.sample(node)));
                }
            }
        }
    }

    #[test]
    fn anisotropic_functions_need_few_nodes() {
        let weighted = |xi: &[f64], fall: f64| -> f64 { xi.iter().zip(0..).map(|(xi, i)| xi * fall.powi(i)).sum() };
        for (k, budget, fall) in [(8, 500, 0.6), (20, 3000, 0.8)] {
            let (error, nodes) = error(k, budget, |xi| (0.5 * weighted(xi, fall)).exp());
            assert!(error < 1e-3 && nodes <= budget, "{k} parameters: {error:e} with {nodes} nodes");
        }
        // A peak along a sum, and a response in which most parameters do nothing.
        let (error, _) = error(8, 500, |xi| 1.0 / (3.0 + weighted(xi, 0.5)));
        assert!(error < 1e-3, "{error:e}");
    }

    #[test]
    fn a_choice_is_all_that_matters_and_fits() {
        let candidate = |cost| Candidate { levels: vec![], cost };
        let candidates = [candidate(2), candidate(4), candidate(8), candidate(2)];
        assert_eq!(choose(&candidates, &[0.3, 1.0, 0.5, 0.2], 100), [1, 2, 0]);
        assert_eq!(choose(&candidates, &[0.3, 1.0, 0.5, 0.2], 7), [1, 0]);
        assert_eq!(choose(&candidates, &[0.0; 4], 100), [0_usize; 0]);
        assert_eq!(choose(&[], &[], 100), [0_usize; 0]);
    }
}
