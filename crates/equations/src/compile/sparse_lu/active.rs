//! The active submatrix: the rows and columns not yet eliminated, as expressions and as numbers at the pivot samples.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph, SparseMatrix};

use super::Numbers;
use super::solve::Pivot;
use crate::compile::tuning::TUNING;

/// Whether a row or column is late, its number of entries, its index: the order of the search for pivots.
pub type Key = (bool, usize, usize);

/// An entry, with its scaled numbers.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub value: Expr,
    pub numbers: Numbers,
}

/// Rows and columns not yet eliminated.
pub struct Active {
    pub rows: Vec<BTreeMap<usize, Entry>>,
    /// The rows with an entry in each column.
    pub columns: Vec<BTreeSet<usize>>,
    pub sparsest_rows: BTreeSet<Key>,
    pub sparsest_columns: BTreeSet<Key>,
    /// Largest scaled number of any pivot sample so far.
    pub largest: f64,
    /// Rows and columns from here on are searched last.
    first_late: usize,
}

impl Active {
    /// The whole matrix. `numbers` runs over its entries row by row; `scale` has one factor a row, symmetric.
    pub fn new(matrix: &SparseMatrix, numbers: &[Numbers], scale: &[f64], first_late: usize) -> Self {
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
        let key = |(index, count): (usize, usize)| (index >= first_late, count, index);
        let sparsest_rows = rows.iter().map(BTreeMap::len).enumerate().map(key).collect();
        let sparsest_columns = columns.iter().map(BTreeSet::len).enumerate().map(key).collect();
        Self { rows, columns, sparsest_rows, sparsest_columns, largest, first_late }
    }

    fn row_key(&self, row: usize) -> Key {
        (row >= self.first_late, self.rows[row].len(), row)
    }

    fn column_key(&self, column: usize) -> Key {
        (column >= self.first_late, self.columns[column].len(), column)
    }

    /// Eliminates a row and a column of which the entry is the pivot.
    pub fn eliminate(&mut self, graph: &mut Graph, row: usize, column: usize) -> Pivot {
        self.sparsest_rows.remove(&self.row_key(row));
        self.sparsest_columns.remove(&self.column_key(column));
        let mut upper = std::mem::take(&mut self.rows[row]);
        // Callers choose the pivot among the entries of this row.
        let pivot = upper.remove(&column).expect("the pivot was chosen among the row's entries");
        let one = graph.constant(1.0);
        let inverse = graph.div(one, pivot.value);
        for &other in upper.keys() {
            self.recount_column(other, |rows| {
                rows.remove(&row);
            });
        }
        let below: Vec<usize> =
            std::mem::take(&mut self.columns[column]).into_iter().filter(|&other| other != row).collect();
        let entries: Vec<Entry> = below.iter().map(|&other| self.take(other, column)).collect();
        let lower: Vec<(usize, Expr)> =
            below.iter().zip(&entries).map(|(&other, entry)| (other, graph.mul(entry.value, inverse))).collect();
        let mirrored = self.mirrored(row, column, &upper, &lower, &entries);
        for (&(other, multiplier), entry) in lower.iter().zip(&entries) {
            let ratio: Numbers = std::array::from_fn(|sample| entry.numbers[sample] / pivot.numbers[sample]);
            for (&right, above) in &upper {
                let product = match mirrored.get(&(other, right)) {
                    Some(&of_mirror) => graph.mul(of_mirror, upper[&other].value),
                    None => graph.mul(multiplier, above.value),
                };
                self.update(graph, other, right, product, &ratio, above);
            }
            self.sparsest_rows.insert(self.row_key(other));
        }
        let magnitude = pivot.numbers.map(f64::abs);
        let upper = upper.into_iter().map(|(right, entry)| (right, entry.value)).collect();
        Pivot { row, column, inverse, lower, upper, magnitude }
    }

    /// Takes an entry out of its row, which is not among the sparsest until all of it is known again.
    fn take(&mut self, row: usize, column: usize) -> Entry {
        self.sparsest_rows.remove(&self.row_key(row));
        // `columns` and `rows` gain and lose each entry together.
        self.rows[row].remove(&column).expect("columns list the rows that have an entry there")
    }

    /// Entries below the diagonal whose mirror images are the same expressions, and stay so if both change by the
    /// mirror image's product; each with the factor of the pivot row's entry in that product. A symmetric matrix then
    /// takes half the operations.
    fn mirrored(
        &self,
        row: usize,
        column: usize,
        upper: &BTreeMap<usize, Entry>,
        lower: &[(usize, Expr)],
        entries: &[Entry],
    ) -> FxHashMap<(usize, usize), Expr> {
        let mut mirrored = FxHashMap::default();
        if row != column {
            return mirrored;
        }
        let same = |&index: &usize| upper.get(&lower[index].0).is_some_and(|above| above.value == entries[index].value);
        let symmetric: Vec<(usize, Expr)> = (0..lower.len()).filter(same).map(|index| lower[index]).collect();
        let value = |row: usize, column: usize| self.rows[row].get(&column).map(|entry| entry.value);
        for (index, &(other, _)) in symmetric.iter().enumerate() {
            for &(right, of_mirror) in &symmetric[..index] {
                if value(other, right) == value(right, other) {
                    mirrored.insert((other, right), of_mirror);
                }
            }
        }
        mirrored
    }

    /// entry(row, column) −= `product`, which is `ratio` times the entry `above`.
    fn update(&mut self, graph: &mut Graph, row: usize, column: usize, product: Expr, ratio: &Numbers, above: &Entry) {
        let old = self.rows[row].get(&column).copied();
        let value = match old {
            Some(entry) => graph.sub(entry.value, product),
            None => graph.neg(product),
        };
        let before = old.map_or([0.0; TUNING.pivot_samples], |entry| entry.numbers);
        let numbers: Numbers = std::array::from_fn(|sample| before[sample] - ratio[sample] * above.numbers[sample]);
        self.largest = numbers.iter().fold(self.largest, |largest, number| largest.max(number.abs()));
        if graph.is_zero(value) {
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
        self.sparsest_columns.remove(&self.column_key(column));
        change(&mut self.columns[column]);
        self.sparsest_columns.insert(self.column_key(column));
    }
}
