//! The factors L and U as expressions, and the solution of a linear system with them.

use symdiff::{Expr, Graph};

use super::Numbers;

/// One step of the elimination.
#[derive(Clone, Debug)]
pub struct Pivot {
    /// The equation that is eliminated.
    pub row: usize,
    /// The unknown that is eliminated.
    pub column: usize,
    /// 1/pivot.
    pub inverse: Expr,
    /// (row, multiplier): the multiple of the pivot row that is subtracted from the row.
    pub lower: Vec<(usize, Expr)>,
    /// (column, entry) of the pivot row right of the pivot.
    pub upper: Vec<(usize, Expr)>,
    /// The pivot's magnitude at each pivot sample.
    pub magnitude: Numbers,
}

/// A factorised matrix.
#[derive(Clone, Debug)]
pub struct Factors {
    /// Pivots in elimination order.
    pub pivots: Vec<Pivot>,
    /// Growth factor: the largest scaled number of the elimination over the largest of the matrix, at the worst pivot
    /// sample. Rounding errors may grow by it.
    pub growth: f64,
}

impl Factors {
    /// The solution of `matrix · x = right` as expressions.
    pub fn solve(&self, graph: &mut Graph, right: &[Expr]) -> Vec<Expr> {
        let mut y = right.to_vec();
        for pivot in &self.pivots {
            for &(row, multiplier) in &pivot.lower {
                let product = graph.mul(multiplier, y[pivot.row]);
                y[row] = graph.sub(y[row], product);
            }
        }
        let mut x = vec![graph.constant(0.0); right.len()];
        for pivot in self.pivots.iter().rev() {
            let mut rest = y[pivot.row];
            for &(column, entry) in &pivot.upper {
                let product = graph.mul(entry, x[column]);
                rest = graph.sub(rest, product);
            }
            x[pivot.column] = graph.mul(rest, pivot.inverse);
        }
        x
    }

    /// Entries of L and U, inverses of pivots included.
    pub fn nonzeros(&self) -> usize {
        self.pivots.iter().map(|pivot| 1 + pivot.lower.len() + pivot.upper.len()).sum()
    }

    /// All values of the factors.
    pub fn values(&self) -> impl Iterator<Item = Expr> {
        self.pivots.iter().flat_map(|pivot| {
            let entries = pivot.lower.iter().chain(&pivot.upper).map(|&(_, value)| value);
            entries.chain(std::iter::once(pivot.inverse))
        })
    }

    /// The same factors with every value replaced by `replace`.
    pub fn map(&self, mut replace: impl FnMut(Expr) -> Expr) -> Self {
        let mut pivots = self.pivots.clone();
        for pivot in &mut pivots {
            pivot.inverse = replace(pivot.inverse);
            for (_, value) in pivot.lower.iter_mut().chain(&mut pivot.upper) {
                *value = replace(*value);
            }
        }
        Self { pivots, growth: self.growth }
    }
}
