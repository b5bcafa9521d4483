//! The elimination, pivot by pivot.

use symdiff::{Graph, SparseMatrix, Stages};

use super::Numbers;
use super::active::Active;
use super::pivoting::{PivotSearch, Pivoting};
use super::solve::Factors;

/// Why a matrix has no factors.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoFactors<Row = usize> {
    /// The rows that are left have no acceptable pivot.
    #[error("the matrix is singular: {} of its rows have no pivot", rows.len())]
    Singular {
        /// Those rows.
        rows: Vec<Row>,
    },
    /// The graph was full before the elimination was done ([`Graph::limit`]).
    #[error("the elimination takes too many operations")]
    TooLong,
}

impl NoFactors {
    /// The same, with its rows replaced by the function `row`.
    pub fn named<Row>(self, row: impl FnMut(usize) -> Row) -> NoFactors<Row> {
        match self {
            Self::Singular { rows } => NoFactors::Singular { rows: rows.into_iter().map(row).collect() },
            Self::TooLong => NoFactors::TooLong,
        }
    }
}

/// Rule for the search for pivots.
pub struct PivotRule<'a> {
    /// Stages of the graph's nodes.
    pub stages: Stages,
    /// The stage at which operations are saved.
    pub costly: usize,
    /// Entries that may be pivots.
    pub pivoting: Pivoting<'a>,
}

/// Factorises a square matrix.
///
/// `numbers` runs over the matrix's entries row by row. `scale` (one factor a row, symmetric) makes entries comparable
/// for the threshold and changes nothing else. The pivots `first` (row, column) come before those that are searched
/// for.
///
/// # Errors
/// Where no entry of the rows left is large enough at every pivot sample, where one of `first` vanishes, and where the
/// graph is full.
pub fn factorise(
    graph: &mut Graph,
    matrix: &SparseMatrix,
    numbers: &[Numbers],
    scale: &[f64],
    first: &[(usize, usize)],
    PivotRule { stages, costly, pivoting }: PivotRule<'_>,
) -> Result<Factors, NoFactors> {
    let size = matrix.rows.len();
    let mut active = Active::new(matrix, numbers, scale, pivoting.first_late());
    let largest = active.largest;
    let mut pivots = Vec::with_capacity(size);
    for &(row, column) in first {
        let numbers = active.rows[row].get(&column).map(|entry| entry.numbers);
        if numbers.is_none_or(|numbers| numbers.iter().any(|number| !number.is_normal())) {
            return Err(NoFactors::Singular { rows: vec![row] });
        }
        pivots.push(active.eliminate(graph, row, column));
        if graph.is_full() {
            return Err(NoFactors::TooLong);
        }
    }
    let mut search = PivotSearch::new(pivoting, &active, stages, costly);
    first.iter().for_each(|&(row, _)| search.remove(row));
    while pivots.len() < size {
        let Some((row, column)) = search.choose(graph, &active) else {
            return Err(NoFactors::Singular { rows: active.sparsest_rows.iter().map(|&(_, _, row)| row).collect() });
        };
        search.remove(row);
        pivots.push(active.eliminate(graph, row, column));
        if graph.is_full() {
            return Err(NoFactors::TooLong);
        }
    }
    Ok(Factors { pivots, growth: active.largest / largest })
}
