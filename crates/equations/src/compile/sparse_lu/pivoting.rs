//! The choice of the next pivot: the cheapest entry that is large enough.

use std::collections::{BTreeMap, BTreeSet};

use symdiff::{Expr, Graph, Stages};

use super::active::{Active, Entry};
use super::ordering::block_order;
use crate::compile::tuning::TUNING;

/// Entries that may be pivots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pivoting<'m> {
    /// Any entry, by cost and size.
    Any,
    /// Entries that cannot vanish wherever the mechanism moves, in a matrix [M Φᵀ; Φ 0] with M positive definite but
    /// for massless coordinates: diagonal entries of M; a derivative of Φ by a massless coordinate or, in a row of Φ
    /// without one, a constant derivative, twice, which eliminates the coordinate and the multiplier together; and,
    /// where all coordinates of its row of Φ are eliminated, the diagonal entry −Φ M⁻¹ Φᵀ of a constraint.
    ///
    /// Bodies that rotate freely need it: each of their Euler parameters, and so each derivative by them, passes
    /// through zero.
    Symmetric {
        /// Whether each coordinate has inertia; as many as there are coordinates.
        massive: &'m [bool],
        /// The first of the coordinates that M couples each coordinate with.
        blocks: &'m [usize],
    },
    /// The diagonal only, the rows before `constraints` first: for quasi-definite matrices, where this order exists
    /// for all numbers.
    Diagonal {
        /// First row of the block that is nearly zero until the others are eliminated.
        constraints: usize,
        /// Entries that are eliminated before, each with the one across the diagonal: a coordinate without inertia and
        /// a constraint that defines it, whose derivative by it cannot vanish.
        pairs: &'m [(usize, usize)],
    },
}

impl Pivoting<'_> {
    fn smallest(self) -> f64 {
        match self {
            Self::Any | Self::Symmetric { .. } => TUNING.singular,
            Self::Diagonal { .. } => TUNING.singular_diagonal,
        }
    }

    fn threshold(self) -> f64 {
        match self {
            Self::Any | Self::Diagonal { .. } => TUNING.threshold,
            Self::Symmetric { .. } => TUNING.threshold_symmetric,
        }
    }

    /// Rows and columns from here on are searched last.
    pub fn first_late(self) -> usize {
        match self {
            Self::Any | Self::Symmetric { .. } => usize::MAX,
            Self::Diagonal { constraints, .. } => constraints,
        }
    }
}

/// The search for pivots and its record of the remaining rows.
pub struct PivotSearch<'m> {
    pivoting: Pivoting<'m>,
    stages: Stages,
    /// The stage whose operations count.
    costly: usize,
    /// For [`Pivoting::Symmetric`], by row: the coordinates that must be eliminated before the constraint. Fill in its
    /// row from other eliminations is small against M and is not waited for; otherwise a chain's multipliers would all
    /// come last, when every pair of them is coupled.
    awaited: Vec<BTreeSet<usize>>,
    /// For [`Pivoting::Symmetric`], by coordinate: the order of its block.
    order: Vec<usize>,
    /// The coordinates left, in that order.
    in_order: BTreeSet<(usize, usize)>,
    /// Constraints that wait for nothing any more.
    ready: BTreeSet<usize>,
    /// The second pivot of a pair, to be taken next.
    second: Option<(usize, usize)>,
    /// Number of pairs that have been taken, for [`Pivoting::Diagonal`].
    paired: usize,
}

impl<'m> PivotSearch<'m> {
    pub fn new(pivoting: Pivoting<'m>, active: &Active, stages: Stages, costly: usize) -> Self {
        let (awaited, order) = match pivoting {
            Pivoting::Symmetric { massive, blocks } => {
                let of = |(row, entries): (usize, &BTreeMap<usize, Entry>)| -> BTreeSet<usize> {
                    let coordinates = entries.range(..massive.len()).map(|(&column, _)| column);
                    coordinates.filter(|_| row >= massive.len()).collect()
                };
                let awaited: Vec<BTreeSet<usize>> = active.rows.iter().enumerate().map(of).collect();
                let order = block_order(blocks, &awaited);
                (awaited, order)
            }
            Pivoting::Any | Pivoting::Diagonal { .. } => (Vec::new(), Vec::new()),
        };
        let in_order = order.iter().enumerate().map(|(row, &order)| (order, row)).collect();
        Self { pivoting, stages, costly, awaited, order, in_order, ready: BTreeSet::new(), second: None, paired: 0 }
    }

    /// The cheapest pivot that is large enough. Where the sparsest columns and rows have none, more are searched;
    /// where no row has one, the threshold is lowered.
    pub fn choose(&mut self, graph: &Graph, active: &Active) -> Option<(usize, usize)> {
        if let Some(second) = self.second.take() {
            return Some(second);
        }
        if let Pivoting::Diagonal { pairs, .. } = self.pivoting
            && let Some(&(row, column)) = pairs.get(self.paired)
        {
            self.paired += 1;
            self.second = Some((column, row));
            return Some((row, column));
        }
        self.stages.update(graph);
        let (row, column) = self.search(active, self.widest(active)).or_else(|| self.search(active, usize::MAX))?;
        if matches!(self.pivoting, Pivoting::Symmetric { .. }) && row != column {
            self.second = Some((column, row));
        }
        self.stop_awaiting(active, row, column);
        Some((row, column))
    }

    /// The search that widens to at most `widest` columns and rows before it lowers the threshold.
    fn search(&self, active: &Active, widest: usize) -> Option<(usize, usize)> {
        let singular = self.pivoting.smallest();
        let is_diagonal = matches!(self.pivoting, Pivoting::Diagonal { .. });
        let mut diagonals: Vec<Diagonals> = Vec::new();
        let mut threshold = self.pivoting.threshold();
        while threshold > singular {
            let mut searched = TUNING.searched;
            for widening in 0.. {
                if is_diagonal && diagonals.len() == widening {
                    diagonals.push(self.diagonals(active, searched));
                }
                let best = match diagonals.get_mut(widening) {
                    Some(diagonals) => diagonals.first_of(active, threshold, singular),
                    None => self.best_of(active, searched, threshold),
                };
                if best.is_some() {
                    return best;
                }
                if searched >= active.sparsest_columns.len().min(widest) {
                    break;
                }
                searched *= TUNING.wider;
            }
            threshold *= 0.1;
        }
        None
    }

    /// Columns and rows that are searched before the threshold is lowered. A diagonal order exists for all numbers, so
    /// that in large matrices none has to be waited for: searching all of them for each pivot would be quadratic.
    fn widest(&self, active: &Active) -> usize {
        match self.pivoting {
            Pivoting::Diagonal { .. } if active.rows.len() > TUNING.rows_searched => TUNING.searched * TUNING.wider,
            _ => usize::MAX,
        }
    }

    /// A row that has been eliminated is no candidate any more.
    pub fn remove(&mut self, row: usize) {
        self.ready.remove(&row);
        if let Some(&order) = self.order.get(row) {
            self.in_order.remove(&(order, row));
        }
    }

    /// A pivot of [`Pivoting::Symmetric`] eliminates a coordinate. Where the coordinate is expressed by the others of a
    /// constraint, the rows that awaited it await those.
    fn stop_awaiting(&mut self, active: &Active, row: usize, column: usize) {
        if self.awaited.is_empty() || !active.columns[row].iter().any(|&other| self.awaited[other].contains(&row)) {
            return;
        }
        let others = if column == row { BTreeSet::new() } else { self.awaited[column].clone() };
        for &constraint in &active.columns[row] {
            if self.awaited[constraint].remove(&row) {
                self.awaited[constraint].extend(others.iter().filter(|&&other| other != row));
                if self.awaited[constraint].is_empty() {
                    self.ready.insert(constraint);
                }
            }
        }
    }

    /// The diagonal entries in the sparsest columns and rows.
    fn diagonals(&self, active: &Active, searched: usize) -> Diagonals {
        let columns = active.sparsest_columns.iter().take(searched);
        let mut indices: Vec<usize> =
            columns.chain(active.sparsest_rows.iter().take(searched)).map(|key| key.2).collect();
        indices.sort_unstable();
        indices.dedup();
        indices.retain(|index| active.rows[*index].contains_key(index));
        let mut by_cost: Vec<(usize, usize, Option<f64>)> =
            indices.into_iter().map(|index| (self.cost(active, index, index), index, None)).collect();
        by_cost.sort_unstable_by_key(|&(cost, index, _)| (cost, index));
        Diagonals { by_cost }
    }

    fn best_of(&self, active: &Active, searched: usize, threshold: f64) -> Option<(usize, usize)> {
        // (order, cost, off the diagonal, row, column): the least is the best, and ties have one outcome everywhere.
        let mut best: Option<(usize, usize, bool, usize, usize)> = None;
        for (row, column) in self.candidates(active, searched) {
            let cost = self.cost(active, row, column);
            let order = if cost == 0 { 0 } else { self.order.get(row).copied().unwrap_or(0) };
            let merit = (order, cost, row != column, row, column);
            let better = best.is_none_or(|least| merit < least);
            if better && size_against_column(active, row, column, self.pivoting.smallest()) >= threshold {
                best = Some(merit);
            }
        }
        best.map(|(_, _, _, row, column)| (row, column))
    }

    /// Entries in the sparsest columns and rows, in the next block and in constraints that are ready.
    fn candidates(&self, active: &Active, searched: usize) -> impl Iterator<Item = (usize, usize)> {
        let in_columns = active
            .sparsest_columns
            .iter()
            .take(searched)
            .flat_map(|&(_, _, column)| active.columns[column].iter().map(move |&row| (row, column)));
        let in_rows = active
            .sparsest_rows
            .iter()
            .take(searched)
            .flat_map(|&(_, _, row)| active.rows[row].keys().map(move |&column| (row, column)));
        let next = self.in_order.first().map(|&(order, _)| order);
        let of_block = self.in_order.iter().take_while(move |&&(order, _)| Some(order) == next).map(|&(_, row)| row);
        let in_block = of_block
            .chain(self.ready.iter().copied())
            .flat_map(|row| active.rows[row].keys().map(move |&column| (row, column)));
        in_columns.chain(in_rows).chain(in_block).filter(|&(row, column)| self.may_be_pivot(active, row, column))
    }

    fn may_be_pivot(&self, active: &Active, row: usize, column: usize) -> bool {
        match self.pivoting {
            Pivoting::Any => true,
            Pivoting::Diagonal { .. } => row == column,
            Pivoting::Symmetric { massive, .. } if row == column => match massive.get(row) {
                Some(massive) => *massive,
                None => self.awaited[row].is_empty(),
            },
            Pivoting::Symmetric { massive, .. } => {
                let is_derivative = row < massive.len() && column >= massive.len();
                let is_constant = |value: Expr| !self.is_costly(value);
                let transposed = active.rows[column].get(&row).filter(|_| is_derivative);
                let mut coordinates = active.rows[column].range(..massive.len()).map(|(&other, _)| other);
                transposed.is_some_and(|transposed| {
                    // A massless coordinate has no other pivot than the constraint that defines it.
                    !massive[row]
                        || coordinates.all(|other| massive[other])
                            && !active.rows[column].contains_key(&column)
                            && is_constant(transposed.value)
                            && is_constant(active.rows[row][&column].value)
                })
            }
        }
    }

    fn is_costly(&self, value: Expr) -> bool {
        self.stages.of(value) == Some(self.costly)
    }

    /// Operations at the costly stage that eliminating with this pivot takes: updates, multipliers, the inverse.
    fn cost(&self, active: &Active, row: usize, column: usize) -> usize {
        let pivot = self.is_costly(active.rows[row][&column].value);
        let others = active.columns[column].iter().filter(|&&other| other != row);
        let right = active.rows[row].iter().filter(|&(&other, _)| other != column);
        let costly_right = right.filter(|(_, entry)| self.is_costly(entry.value)).count();
        let right = active.rows[row].len() - 1;
        let mut cost = 4 * usize::from(pivot);
        for &other in others {
            let multiplier = pivot || self.is_costly(active.rows[other][&column].value);
            cost += usize::from(multiplier) + if multiplier { right } else { costly_right };
        }
        cost
    }
}

/// Diagonal entries by cost and index, with their sizes against their columns where those have been computed.
struct Diagonals {
    by_cost: Vec<(usize, usize, Option<f64>)>,
}

impl Diagonals {
    /// The cheapest that is large enough.
    fn first_of(&mut self, active: &Active, threshold: f64, singular: f64) -> Option<(usize, usize)> {
        for (_, index, size) in &mut self.by_cost {
            if *size.get_or_insert_with(|| size_against_column(active, *index, *index, singular)) >= threshold {
                return Some((*index, *index));
            }
        }
        None
    }
}

/// |entry| over the largest of its column, at the worst pivot sample.
fn size_against_column(active: &Active, row: usize, column: usize, singular: f64) -> f64 {
    let numbers = active.rows[row][&column].numbers;
    (0..TUNING.pivot_samples)
        .map(|sample| {
            let largest = active.columns[column]
                .iter()
                .map(|&other| active.rows[other][&column].numbers[sample].abs())
                .fold(0.0, f64::max);
            if largest > singular && numbers[sample].is_finite() { numbers[sample].abs() / largest } else { 0.0 }
        })
        .fold(f64::INFINITY, f64::min)
}
