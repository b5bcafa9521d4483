//! Symbolic derivatives, memoised, with their sparsity.

use rustc_hash::FxHashMap;

use super::graph::Graph;
use super::node::{Binary, Expr, Node, Unary};
use super::visits::Visits;

/// A sparse matrix of expressions: its nonzero entries by row, columns ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SparseMatrix {
    /// Number of columns.
    pub columns: usize,
    /// For each row, its entries (column, value).
    pub rows: Vec<Vec<(usize, Expr)>>,
}

impl SparseMatrix {
    /// A matrix without entries.
    pub fn zero(rows: usize, columns: usize) -> Self {
        Self { columns, rows: vec![Vec::new(); rows] }
    }

    /// Number of nonzero entries.
    pub fn nonzeros(&self) -> usize {
        self.rows.iter().map(Vec::len).sum()
    }

    /// All entries (row, column, value), row by row.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, Expr)> {
        self.rows
            .iter()
            .enumerate()
            .flat_map(|(row, entries)| entries.iter().map(move |&(column, value)| (row, column, value)))
    }

    /// Adds `value` to an entry.
    pub fn add(&mut self, graph: &mut Graph, row: usize, column: usize, value: Expr) {
        if graph.is_zero(value) {
            return;
        }
        let entries = &mut self.rows[row];
        match entries.binary_search_by_key(&column, |entry| entry.0) {
            Ok(index) => {
                entries[index].1 = graph.add(entries[index].1, value);
                if graph.is_zero(entries[index].1) {
                    entries.remove(index);
                }
            }
            Err(index) => entries.insert(index, (column, value)),
        }
    }
}

impl Graph {
    /// `∂of/∂by`, where `by` is a symbol. At a kink (`abs`, `min`, `max`) the mean of both sides is taken; jumps (of
    /// `sign`, `floor`) have no derivative; a guarded value is assumed to be continuous where its condition changes
    /// sign.
    pub fn derivative(&mut self, of: Expr, by: Expr) -> Expr {
        let mut visits = std::mem::take(&mut self.visits);
        let derivative = self.derivative_along(of, by, &mut visits);
        self.visits = visits;
        derivative
    }

    /// `∂rows/∂by` with its sparsity: only the nodes below a row are visited, so the work grows with the nonzeros.
    pub fn jacobian(&mut self, rows: &[Expr], by: &[Expr]) -> SparseMatrix {
        let column_of: FxHashMap<Expr, usize> =
            by.iter().enumerate().map(|(column, &symbol)| (symbol, column)).collect();
        let mut visits = std::mem::take(&mut self.visits);
        let mut matrix = SparseMatrix::zero(rows.len(), by.len());
        for (row, &of) in rows.iter().enumerate() {
            let columns = self.columns_below(of, &column_of, &mut visits);
            for column in columns {
                let value = self.derivative_along(of, by[column], &mut visits);
                if !self.is_zero(value) {
                    matrix.rows[row].push((column, value));
                }
            }
        }
        self.visits = visits;
        matrix
    }

    /// Columns of the symbols on which `of` depends, ascending.
    fn columns_below(&self, of: Expr, column_of: &FxHashMap<Expr, usize>, visits: &mut Visits) -> Vec<usize> {
        visits.begin(self.len());
        visits.stack.push(of);
        let mut columns = Vec::new();
        while let Some(expr) = visits.stack.pop() {
            if visits.is_first(expr) {
                let node = self.node(expr);
                if matches!(node, Node::Symbol(_)) {
                    columns.extend(column_of.get(&expr));
                }
                visits.stack.extend(node.children());
            }
        }
        columns.sort_unstable();
        columns
    }

    /// Records the derivatives of nodes that depend on `by`; only nodes above those already recorded are visited.
    fn derivative_along(&mut self, of: Expr, by: Expr, visits: &mut Visits) -> Expr {
        let zero = self.constant(0.0);
        let one = self.constant(1.0);
        for &expr in self.not_yet_derived(of, by, visits) {
            let node = self.node(expr);
            if expr == by {
                self.derivatives.insert((expr, by), one);
            } else if node.children().any(|child| self.derivatives.contains_key(&(child, by))) {
                let derivative = self.apply_rule(expr, node, by, zero);
                self.derivatives.insert((expr, by), derivative);
            }
        }
        self.derivatives.get(&(of, by)).copied().unwrap_or(zero)
    }

    /// Nodes below `of` that may depend on `by`, children first, without those below nodes with a known derivative.
    fn not_yet_derived<'v>(&self, of: Expr, by: Expr, visits: &'v mut Visits) -> &'v [Expr] {
        visits.begin(self.len());
        visits.stack.push(of);
        while let Some(expr) = visits.stack.pop() {
            // A node is made after all nodes on which it depends.
            if expr < by || !visits.is_first(expr) || self.derivatives.contains_key(&(expr, by)) {
                continue;
            }
            visits.found.push(expr);
            visits.stack.extend(self.node(expr).children());
        }
        visits.found.sort_unstable();
        &visits.found
    }

    /// The chain rule at one node; the children's derivatives are known, and zero if absent.
    fn apply_rule(&mut self, expr: Expr, node: Node, by: Expr, zero: Expr) -> Expr {
        let known = |graph: &Graph, child: Expr| graph.derivatives.get(&(child, by)).copied().unwrap_or(zero);
        match node {
            Node::Constant(_) | Node::Symbol(_) => zero,
            Node::Unary(function, a) => {
                let da = known(self, a);
                let outer = self.unary_rule(function, expr, a);
                self.mul(outer, da)
            }
            Node::Binary(function, a, b) => {
                let (da, db) = (known(self, a), known(self, b));
                self.binary_rule(function, expr, a, da, b, db)
            }
        }
    }

    /// `f'(a)`, where `value = f(a)`.
    fn unary_rule(&mut self, function: Unary, value: Expr, a: Expr) -> Expr {
        let one = self.constant(1.0);
        match function {
            Unary::Neg => self.constant(-1.0),
            Unary::Sin => self.cos(a),
            Unary::Cos => {
                let sine = self.sin(a);
                self.neg(sine)
            }
            Unary::Tan => {
                let square = self.mul(value, value);
                self.add(one, square)
            }
            Unary::Asin | Unary::Acos => {
                let square = self.mul(a, a);
                let rest = self.sub(one, square);
                let root = self.sqrt(rest);
                let slope = self.div(one, root);
                if function == Unary::Asin { slope } else { self.neg(slope) }
            }
            Unary::Atan => {
                let square = self.mul(a, a);
                let sum = self.add(one, square);
                self.div(one, sum)
            }
            Unary::Sqrt => {
                let half = self.constant(0.5);
                self.div(half, value)
            }
            Unary::Exp => value,
            Unary::Log => self.div(one, a),
            Unary::Abs => self.unary(Unary::Sign, a),
            Unary::Tanh => {
                let square = self.mul(value, value);
                self.sub(one, square)
            }
            Unary::Sign | Unary::Floor => self.constant(0.0),
            Unary::Spline(spline, order) => self.unary(Unary::Spline(spline, order + 1), a),
        }
    }

    fn binary_rule(&mut self, function: Binary, value: Expr, a: Expr, da: Expr, b: Expr, db: Expr) -> Expr {
        match function {
            Binary::Add => self.add(da, db),
            Binary::Sub => self.sub(da, db),
            Binary::Mul => {
                let (left, right) = (self.mul(da, b), self.mul(a, db));
                self.add(left, right)
            }
            // (a/b)' = (a' - (a/b) b') / b
            Binary::Div => {
                let product = self.mul(value, db);
                let numerator = self.sub(da, product);
                self.div(numerator, b)
            }
            // (a^b)' = b a^(b-1) a' + a^b log(a) b'
            Binary::Pow => {
                let one = self.constant(1.0);
                let less = self.sub(b, one);
                let power = self.binary(Binary::Pow, a, less);
                let slope = self.mul(b, power);
                let base_part = self.mul(slope, da);
                if self.is_zero(db) {
                    return base_part;
                }
                let log = self.unary(Unary::Log, a);
                let growth = self.mul(value, log);
                let exponent_part = self.mul(growth, db);
                self.add(base_part, exponent_part)
            }
            // atan2(a, b)' = (b a' - a b') / (a² + b²)
            Binary::Atan2 => {
                let (left, right) = (self.mul(b, da), self.mul(a, db));
                let numerator = self.sub(left, right);
                let (aa, bb) = (self.mul(a, a), self.mul(b, b));
                let square = self.add(aa, bb);
                self.div(numerator, square)
            }
            Binary::Select | Binary::SelectElse => self.binary(function, a, db),
            // max = (a + b + |a - b|)/2 and min = (a + b - |a - b|)/2, differentiated.
            Binary::Min | Binary::Max => {
                let gap = self.sub(a, b);
                let side = self.unary(Unary::Sign, gap);
                let (total, spread) = (self.add(da, db), self.sub(da, db));
                let shift = self.mul(side, spread);
                let doubled = if function == Binary::Max { self.add(total, shift) } else { self.sub(total, shift) };
                self.scale(0.5, doubled)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A derivative built on other derivatives costs only its new nodes, at any depth.
    #[test]
    fn derivatives_visit_only_new_nodes() {
        let mut g = Graph::new();
        let angles: Vec<Expr> = (0..60).map(|link| g.symbol(&format!("q{link}"))).collect();
        let mut tip = g.constant(0.0);
        let mut tips = Vec::new();
        for &angle in &angles {
            let sum = g.add(tip, angle);
            tip = g.sin(sum);
            tips.push(tip);
        }
        g.jacobian(&tips[..59], &angles);
        let mut visits = Visits::default();
        for &angle in &angles[..59] {
            assert!(g.not_yet_derived(tips[59], angle, &mut visits).len() <= 3);
        }
        let chain = (0..60).map(|link| g.cos(tips[link])).collect::<Vec<Expr>>();
        let value = g.derivative(chain[59], angles[59]);
        assert_eq!(value, g.jacobian(&chain, &angles).rows[59][59].1);
    }
}
