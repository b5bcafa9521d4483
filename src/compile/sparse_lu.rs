//! Sparse LU as expressions: the elimination order is chosen once, on numbers; the elimination itself becomes nodes of
//! the graph, and so instructions of the tapes, each evaluated at the stage at which it can change.
//!
//! Order and pivots: Markowitz, *The elimination form of the inverse*, Management Science 3 (1957), with threshold
//! pivoting (Duff, Erisman & Reid, *Direct Methods for Sparse Matrices*, 2nd ed., ch. 7).

use std::collections::{BTreeMap, BTreeSet};

use symdiff::{Expr, Graph, SparseMatrix, Stages};

/// Number of states whose numbers guide the choice of pivots.
pub const PIVOT_SAMPLES: usize = 4;

/// An entry's value at each probe.
pub type Numbers = [f64; PIVOT_SAMPLES];

/// A pivot is at least this large against the largest entry of its column, at every probe.
const THRESHOLD: f64 = 0.1;

/// The same for pivots of [`Pivoting::Symmetric`], which cannot vanish: their order matters more. The corrections lose up to as
/// many digits, and have more than they need.
const THRESHOLD_SYMMETRIC: f64 = 1e-3;

/// Where no pivot passes the threshold, it is lowered down to this; below it the matrix counts as singular.
const SINGULAR: f64 = 1e-11;

/// The same for a quasi-definite matrix, which is never singular: its pivots may be as small as its regularisation.
const SINGULAR_DIAGONAL: f64 = 1e-15;

/// How many of the sparsest columns and rows are searched for a pivot.
const SEARCHED: usize = 4;

/// Which entries may be pivots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pivoting<'m> {
    /// Any entry, by cost and size.
    Any,
    /// What cannot vanish wherever the mechanism goes, in a matrix [M Φᵀ; Φ 0] with M positive definite but for coordinates
    /// without inertia (`heavy` says which have some, and how many coordinates there are): diagonal entries of M; a slope of
    /// Φ that does not change or is by a coordinate without inertia, twice, which takes the coordinate and the multiplier
    /// out together; and, where all coordinates of its row of Φ are gone, the diagonal entry −Φ M⁻¹ Φᵀ of a constraint.
    ///
    /// Bodies that turn freely need it: each of their Euler parameters, and so each slope by them, passes through zero.
    Symmetric {
        #[allow(missing_docs)]
        heavy: &'m [bool],
        /// By coordinate, the first of those that M couples it with.
        blocks: &'m [usize],
    },
    /// The diagonal only, of the rows before `constraints` first: for quasi-definite matrices, where this order exists
    /// whatever the numbers.
    Diagonal {
        /// First row of the block that is nearly zero until the others are eliminated.
        constraints: usize,
    },
}

impl Pivoting<'_> {
    fn smallest(self) -> f64 {
        match self {
            Self::Any | Self::Symmetric { .. } => SINGULAR,
            Self::Diagonal { .. } => SINGULAR_DIAGONAL,
        }
    }

    fn threshold(self) -> f64 {
        match self {
            Self::Any | Self::Diagonal { .. } => THRESHOLD,
            Self::Symmetric { .. } => THRESHOLD_SYMMETRIC,
        }
    }

    /// How rows and columns are sorted for the search: late ones, then by count.
    fn key(self, count: usize, index: usize) -> Key {
        let late = matches!(self, Self::Diagonal { constraints } if index >= constraints);
        (late, count, index)
    }
}

/// One step of the elimination.
#[derive(Clone, Debug)]
pub struct Pivot {
    /// Equation and unknown that are eliminated.
    pub row: usize,
    #[allow(missing_docs)]
    pub column: usize,
    /// 1/pivot.
    pub inverse: Expr,
    /// (row, multiplier): that many times the pivot row is taken off the row.
    pub lower: Vec<(usize, Expr)>,
    /// (column, entry) of the pivot row right of the pivot.
    pub upper: Vec<(usize, Expr)>,
    /// The pivot's magnitude at each probe.
    pub magnitude: Numbers,
}

/// A factorised matrix.
#[derive(Clone, Debug)]
pub struct Factors {
    /// In elimination order.
    pub pivots: Vec<Pivot>,
    /// Largest number met in the elimination over the largest of the matrix, scaled, at the worst probe: so many times the
    /// rounding errors may grow.
    pub growth: f64,
}

/// Why a matrix has no factors.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoFactors {
    /// The rows that are left have no acceptable pivot.
    #[error("the matrix is singular: {} of its rows have no pivot", rows.len())]
    Singular {
        /// Those rows.
        rows: Vec<usize>,
    },
    /// The graph was full before the elimination was done ([`Graph::limit`]).
    #[error("the elimination takes too many operations")]
    TooLong,
}

/// An order of the coordinates of `[M Φᵀ; Φ 0]` by blocks, from 1: blocks are what M couples (bodies), and the one comes next that
/// shares constraints with the fewest others, those of the blocks before it counting as one (minimum degree; Tinney &
/// Walker, Proc. IEEE 55 (1967) 1801). A chain is so taken from an end.
fn block_order(block: &[usize], awaited: &[BTreeSet<usize>]) -> Vec<usize> {
    let n = block.len();
    let mut neighbours: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); n];
    for coordinates in awaited {
        let blocks: BTreeSet<usize> = coordinates.iter().map(|&coordinate| block[coordinate]).collect();
        for &a in &blocks {
            neighbours[a].extend(blocks.iter().filter(|&&b| b != a));
        }
    }
    let mut left: BTreeSet<(usize, usize)> = block.iter().map(|&block| (neighbours[block].len(), block)).collect();
    let mut turn = vec![0; n];
    let mut next = 1;
    while let Some((_, first)) = left.pop_first() {
        turn[first] = next;
        next += 1;
        let around = std::mem::take(&mut neighbours[first]);
        for &a in &around {
            left.remove(&(neighbours[a].len(), a));
            neighbours[a].extend(around.iter().filter(|&&b| b != a));
            neighbours[a].remove(&first);
            left.insert((neighbours[a].len(), a));
        }
    }
    block.iter().map(|&block| turn[block]).collect()
}

/// Whether it is late, number of entries, index.
type Key = (bool, usize, usize);

#[derive(Clone, Copy, Debug)]
struct Entry {
    value: Expr,
    numbers: Numbers,
}

/// What is left to be eliminated.
struct Active<'g> {
    graph: &'g mut Graph,
    stages: Stages,
    /// The stage whose operations count.
    dear: usize,
    rows: Vec<BTreeMap<usize, Entry>>,
    columns: Vec<BTreeSet<usize>>,
    pivoting: Pivoting<'g>,
    /// For [`Pivoting::Symmetric`], by row: the coordinates that a constraint is still waiting for. What eliminating others
    /// adds to its row is small against M, and need not be waited for; otherwise a chain's multipliers would all come last,
    /// and be coupled by then, each with each.
    awaited: Vec<BTreeSet<usize>>,
    /// For [`Pivoting::Symmetric`], by coordinate: when its block's turn comes; and the coordinates left, by that.
    rank: Vec<usize>,
    by_rank: BTreeSet<(usize, usize)>,
    /// Constraints that wait for nothing any more.
    ready: BTreeSet<usize>,
    /// The second pivot of a pair, to be taken next.
    mate: Option<(usize, usize)>,
    /// Largest number of any probe so far.
    largest: f64,
    /// The rows and columns left.
    sparsest_rows: BTreeSet<Key>,
    sparsest_columns: BTreeSet<Key>,
}

/// Factorises a square matrix. `numbers` runs over its entries row by row; `scale` (one a row, symmetric) makes entries
/// comparable for the threshold and changes nothing else; operations at stage `dear` are what is saved.
///
/// # Errors
/// Where no entry of the rows left is large enough at every probe, and where the graph is full.
pub fn factorise<'g>(
    graph: &'g mut Graph,
    matrix: &SparseMatrix,
    numbers: &[Numbers],
    scale: &[f64],
    stages: Stages,
    dear: usize,
    pivoting: Pivoting<'g>,
) -> Result<Factors, NoFactors> {
    let size = matrix.rows.len();
    let mut rows = vec![BTreeMap::new(); size];
    let mut columns = vec![BTreeSet::new(); size];
    let mut largest = 0.0;
    for ((row, column, value), numbers) in matrix.entries().zip(numbers) {
        let numbers = numbers.map(|number| number * scale[row] * scale[column]);
        largest = numbers.iter().fold(largest, |largest: f64, number| largest.max(number.abs()));
        rows[row].insert(column, Entry { value, numbers });
        columns[column].insert(row);
    }
    let sparsest_rows = rows.iter().enumerate().map(|(row, entries)| pivoting.key(entries.len(), row)).collect();
    let sparsest_columns = columns.iter().enumerate().map(|(column, rows)| pivoting.key(rows.len(), column)).collect();
    let awaited = match pivoting {
        Pivoting::Symmetric { heavy, .. } => {
            let of = |(row, entries): (usize, &BTreeMap<usize, Entry>)| -> BTreeSet<usize> {
                let coordinates = entries.range(..heavy.len()).map(|(&column, _)| column);
                coordinates.filter(|_| row >= heavy.len()).collect()
            };
            rows.iter().enumerate().map(of).collect()
        }
        Pivoting::Any | Pivoting::Diagonal { .. } => Vec::new(),
    };
    let rank = match pivoting {
        Pivoting::Symmetric { blocks, .. } => block_order(blocks, &awaited),
        Pivoting::Any | Pivoting::Diagonal { .. } => Vec::new(),
    };
    let by_rank = rank.iter().enumerate().map(|(row, &rank)| (rank, row)).collect();
    let mut active = Active {
        graph,
        stages,
        dear,
        pivoting,
        rank,
        by_rank,
        ready: BTreeSet::new(),
        awaited,
        mate: None,
        largest,
        rows,
        columns,
        sparsest_rows,
        sparsest_columns,
    };
    let mut pivots = Vec::with_capacity(size);
    while pivots.len() < size {
        match active.choose() {
            Some((row, column)) => pivots.push(active.eliminate(row, column)),
            None => {
                return Err(NoFactors::Singular {
                    rows: active.sparsest_rows.iter().map(|&(_, _, row)| row).collect(),
                });
            }
        }
        if active.graph.is_full() {
            return Err(NoFactors::TooLong);
        }
    }
    Ok(Factors { pivots, growth: active.largest / largest })
}

impl Active<'_> {
    /// The cheapest pivot that is large enough. Where the sparsest columns and rows have none, more are searched; where none
    /// has, the threshold is lowered.
    fn choose(&mut self) -> Option<(usize, usize)> {
        if let Some(mate) = self.mate.take() {
            return Some(mate);
        }
        self.stages.update(self.graph);
        let singular = self.pivoting.smallest();
        let mut threshold = self.pivoting.threshold();
        while threshold > singular {
            let mut searched = SEARCHED;
            loop {
                if let Some((row, column)) = self.best_of(searched, threshold) {
                    if matches!(self.pivoting, Pivoting::Symmetric { .. }) && row != column {
                        self.mate = Some((column, row));
                    }
                    self.stop_awaiting(row, column);
                    return Some((row, column));
                }
                if searched >= self.sparsest_columns.len() {
                    break;
                }
                searched *= 8;
            }
            threshold *= 0.1;
        }
        None
    }

    /// A pivot of [`Pivoting::Symmetric`] takes a coordinate out. Where it is expressed by the others of a constraint, what
    /// waited for it waits for those.
    fn stop_awaiting(&mut self, row: usize, column: usize) {
        if self.awaited.is_empty() || !self.columns[row].iter().any(|&other| self.awaited[other].contains(&row)) {
            return;
        }
        let others = if column == row { BTreeSet::new() } else { self.awaited[column].clone() };
        for &constraint in &self.columns[row] {
            if self.awaited[constraint].remove(&row) {
                self.awaited[constraint].extend(others.iter().filter(|&&other| other != row));
                if self.awaited[constraint].is_empty() {
                    self.ready.insert(constraint);
                }
            }
        }
    }

    fn best_of(&self, searched: usize, threshold: f64) -> Option<(usize, usize)> {
        // (rank, cost, off the diagonal, row, column): the least is the best, and ties are decided alike everywhere.
        let mut best: Option<(usize, usize, bool, usize, usize)> = None;
        for (row, column) in self.candidates(searched) {
            let cost = self.cost(row, column);
            let rank = if cost == 0 { 0 } else { self.rank.get(row).copied().unwrap_or(0) };
            let merit = (rank, cost, row != column, row, column);
            let better = best.is_none_or(|least| merit < least);
            if better && self.size_against_column(row, column, self.pivoting.smallest()) >= threshold {
                best = Some(merit);
            }
        }
        best.map(|(_, _, _, row, column)| (row, column))
    }

    /// Entries in the sparsest columns and rows.
    fn candidates(&self, searched: usize) -> impl Iterator<Item = (usize, usize)> {
        let in_columns = self
            .sparsest_columns
            .iter()
            .take(searched)
            .flat_map(|&(_, _, column)| self.columns[column].iter().map(move |&row| (row, column)));
        let in_rows = self
            .sparsest_rows
            .iter()
            .take(searched)
            .flat_map(|&(_, _, row)| self.rows[row].keys().map(move |&column| (row, column)));
        let next = self.by_rank.first().map(|&(rank, _)| rank);
        let of_block = self.by_rank.iter().take_while(move |&&(rank, _)| Some(rank) == next).map(|&(_, row)| row);
        let in_block = of_block
            .chain(self.ready.iter().copied())
            .flat_map(|row| self.rows[row].keys().map(move |&column| (row, column)));
        in_columns.chain(in_rows).chain(in_block).filter(|&(row, column)| self.may_be_pivot(row, column))
    }

    fn may_be_pivot(&self, row: usize, column: usize) -> bool {
        match self.pivoting {
            Pivoting::Any => true,
            Pivoting::Diagonal { .. } => row == column,
            Pivoting::Symmetric { heavy, .. } if row == column => match heavy.get(row) {
                Some(heavy) => *heavy,
                None => self.awaited[row].is_empty(),
            },
            Pivoting::Symmetric { heavy, .. } => {
                let slope = row < heavy.len() && column >= heavy.len();
                let steady = |value: Expr| self.stages.of(value) != Some(self.dear);
                let mate = self.rows[column].get(&row).filter(|_| slope);
                mate.is_some_and(|mate| {
                    !heavy[row]
                        || !self.rows[column].contains_key(&column)
                            && steady(mate.value)
                            && steady(self.rows[row][&column].value)
                })
            }
        }
    }

    /// |entry| over the largest of its column, at the worst probe.
    fn size_against_column(&self, row: usize, column: usize, singular: f64) -> f64 {
        let numbers = self.rows[row][&column].numbers;
        (0..PIVOT_SAMPLES)
            .map(|probe| {
                let largest = self.columns[column]
                    .iter()
                    .map(|&other| self.rows[other][&column].numbers[probe].abs())
                    .fold(0.0, f64::max);
                if largest > singular && numbers[probe].is_finite() { numbers[probe].abs() / largest } else { 0.0 }
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// Operations at the dear stage that eliminating with this pivot takes: updates, multipliers, the inverse.
    fn cost(&self, row: usize, column: usize) -> usize {
        let dear = |value: Expr| self.stages.of(value) == Some(self.dear);
        let pivot = dear(self.rows[row][&column].value);
        let others = self.columns[column].iter().filter(|&&other| other != row);
        let right: Vec<bool> =
            self.rows[row].iter().filter(|&(&other, _)| other != column).map(|(_, entry)| dear(entry.value)).collect();
        let dear_right = right.iter().filter(|&&is_dear| is_dear).count();
        let mut cost = 4 * usize::from(pivot);
        for &other in others {
            let multiplier = pivot || dear(self.rows[other][&column].value);
            cost += usize::from(multiplier) + if multiplier { right.len() } else { dear_right };
        }
        cost
    }

    fn eliminate(&mut self, row: usize, column: usize) -> Pivot {
        self.sparsest_rows.remove(&self.pivoting.key(self.rows[row].len(), row));
        self.sparsest_columns.remove(&self.pivoting.key(self.columns[column].len(), column));
        self.ready.remove(&row);
        if let Some(&rank) = self.rank.get(row) {
            self.by_rank.remove(&(rank, row));
        }
        let mut upper = std::mem::take(&mut self.rows[row]);
        let pivot = upper.remove(&column).expect("the pivot was chosen among the row's entries");
        let one = self.graph.constant(1.0);
        let inverse = self.graph.div(one, pivot.value);
        for &other in upper.keys() {
            self.recount_column(other, |rows| {
                rows.remove(&row);
            });
        }
        let below: Vec<usize> =
            std::mem::take(&mut self.columns[column]).into_iter().filter(|&other| other != row).collect();
        let mut lower = Vec::with_capacity(below.len());
        for other in below {
            self.sparsest_rows.remove(&self.pivoting.key(self.rows[other].len(), other));
            let entry = self.rows[other].remove(&column).expect("columns list the rows that have an entry there");
            let multiplier = self.graph.mul(entry.value, inverse);
            let ratio: Numbers = std::array::from_fn(|probe| entry.numbers[probe] / pivot.numbers[probe]);
            for (&right, above) in &upper {
                self.update(other, right, multiplier, &ratio, above);
            }
            self.sparsest_rows.insert(self.pivoting.key(self.rows[other].len(), other));
            lower.push((other, multiplier));
        }
        Pivot {
            row,
            column,
            inverse,
            lower,
            upper: upper.into_iter().map(|(right, entry)| (right, entry.value)).collect(),
            magnitude: pivot.numbers.map(f64::abs),
        }
    }

    /// entry(row, column) −= multiplier · above
    fn update(&mut self, row: usize, column: usize, multiplier: Expr, ratio: &Numbers, above: &Entry) {
        let product = self.graph.mul(multiplier, above.value);
        let old = self.rows[row].get(&column).copied();
        let value = match old {
            Some(entry) => self.graph.sub(entry.value, product),
            None => self.graph.neg(product),
        };
        let before = old.map_or([0.0; PIVOT_SAMPLES], |entry| entry.numbers);
        let numbers: Numbers = std::array::from_fn(|probe| before[probe] - ratio[probe] * above.numbers[probe]);
        self.largest = numbers.iter().fold(self.largest, |largest, number| largest.max(number.abs()));
        if self.graph.is_zero(value) {
            self.rows[row].remove(&column);
            self.recount_column(column, |rows| {
                rows.remove(&row);
            });
        } else {
            self.rows[row].insert(column, Entry { value, numbers });
            if old.is_none() {
                self.recount_column(column, |rows| {
                    rows.insert(row);
                });
            }
        }
    }

    fn recount_column(&mut self, column: usize, change: impl FnOnce(&mut BTreeSet<usize>)) {
        self.sparsest_columns.remove(&self.pivoting.key(self.columns[column].len(), column));
        change(&mut self.columns[column]);
        self.sparsest_columns.insert(self.pivoting.key(self.columns[column].len(), column));
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn solve_numbers(dense: &[Vec<f64>], right: &[f64]) -> Result<Vec<f64>, NoFactors> {
        solve_by(dense, right, Pivoting::Any).map(|(x, _)| x)
    }

    /// The solution, and the factors.
    fn solve_by(dense: &[Vec<f64>], right: &[f64], pivoting: Pivoting) -> Result<(Vec<f64>, Factors), NoFactors> {
        let mut graph = Graph::new();
        let mut matrix = SparseMatrix::zero(dense.len(), dense.len());
        let mut numbers = Vec::new();
        for (row, values) in dense.iter().enumerate() {
            for (column, &value) in values.iter().enumerate().filter(|(_, value)| **value != 0.0) {
                let expr = graph.constant(value);
                matrix.rows[row].push((column, expr));
                numbers.push([value; PIVOT_SAMPLES]);
            }
        }
        let scale = vec![1.0; dense.len()];
        let factors = factorise(&mut graph, &matrix, &numbers, &scale, Stages::new(&[]), 0, pivoting)?;
        let right: Vec<Expr> = right.iter().map(|&value| graph.constant(value)).collect();
        let x = factors.solve(&mut graph, &right);
        let x = x.into_iter().map(|expr| graph.as_constant(expr).unwrap()).collect();
        Ok((x, factors))
    }

    /// Three coordinates, the last without inertia and defined by the second constraint.
    #[test]
    fn what_has_inertia_or_defines_is_a_pivot() {
        let dense = [
            vec![2.0, 0.5, 0.0, 1.0, 0.3],
            vec![0.5, 3.0, 0.0, 0.7, -0.4],
            vec![0.0, 0.0, 0.0, 0.0, -1.0],
            vec![1.0, 0.7, 0.0, 0.0, 0.0],
            vec![0.3, -0.4, -1.0, 0.0, 0.0],
        ];
        let right = [1.0, 2.0, 3.0, 4.0, 5.0];
        let (x, factors) =
            solve_by(&dense, &right, Pivoting::Symmetric { heavy: &[true, true, false], blocks: &[0, 1, 2] }).unwrap();
        for (row, b) in dense.iter().zip(right) {
            let product: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
            assert!((product - b).abs() < 1e-13);
        }
        let pivots: Vec<(usize, usize)> = factors.pivots.iter().map(|pivot| (pivot.row, pivot.column)).collect();
        let place = pivots.iter().position(|&pivot| pivot == (2, 4)).unwrap();
        assert_eq!(pivots[place + 1], (4, 2), "{pivots:?}");
    }

    #[test]
    fn a_zero_diagonal_is_no_hindrance() {
        let x =
            solve_numbers(&[vec![0.0, 2.0, 0.0], vec![1.0, 0.0, 1.0], vec![0.0, 3.0, 1.0]], &[4.0, 3.0, 7.0]).unwrap();
        assert_eq!(x, [2.0, 2.0, 1.0]);
    }

    #[test]
    fn a_singular_matrix_names_the_rows_left() {
        let singular = solve_numbers(&[vec![1.0, 2.0], vec![2.0, 4.0]], &[1.0, 2.0]).unwrap_err();
        assert!(matches!(singular, NoFactors::Singular { rows } if rows.len() == 1));
    }

    proptest! {
        #[test]
        fn solutions_fulfil_their_equations(
            entries in prop::collection::vec(prop::option::weighted(0.4, -1.0..1.0_f64), 64),
            right in prop::collection::vec(-1.0..1.0_f64, 8),
        ) {
            let dense: Vec<Vec<f64>> = (0..8)
                .map(|row| (0..8).map(|column| entries[8 * row + column].unwrap_or(0.0) + if row == column { 3.0 } else { 0.0 }).collect())
                .collect();
            if let Ok(x) = solve_numbers(&dense, &right) {
                for (row, b) in dense.iter().zip(&right) {
                    let product: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
                    prop_assert!((product - b).abs() < 1e-9);
                }
            }
        }
    }
}
