//! The expression graph: an arena of hash-consed nodes.
//!
//! Equal subexpressions are one node, so common subexpressions cost nothing to find. Children always come before
//! their parents in the arena, so every pass over a graph is a loop over ascending indices and none recurses.

use std::hash::BuildHasher;

use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use rustc_hash::{FxBuildHasher, FxHashMap};

use super::node::{Binary, Expr, Node, Unary};
use super::visits::Visits;
use crate::tuning::TUNING;

/// An arena of expressions. Constant folding and the algebraic identities are applied as nodes are made.
///
/// The identities are those of real algebra (`0 x = 0` even if x could be infinite); none changes the order of
/// floating-point operations otherwise.
#[derive(Clone, Debug)]
pub struct Graph {
    nodes: Vec<Node>,
    /// All nodes by content; the table stores handles only, so that it is small.
    known: HashTable<Expr>,
    names: Vec<String>,
    symbols: FxHashMap<String, Expr>,
    most: Option<usize>,
    pub(crate) derivatives: FxHashMap<(Expr, Expr), Expr>,
    /// Memory that all derivatives share, since it is as large as the graph.
    pub(super) visits: Visits,
}

impl Default for Graph {
    fn default() -> Self {
        Self::new()
    }
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        Self {
            nodes: Vec::with_capacity(TUNING.nodes_at_first),
            known: HashTable::with_capacity(TUNING.nodes_at_first),
            names: Vec::new(),
            symbols: FxHashMap::default(),
            most: None,
            derivatives: FxHashMap::default(),
            visits: Visits::default(),
        }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether the graph has no nodes.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Sets the number of nodes above which the graph is full; it still grows, but its user may check and give up.
    pub fn limit(&mut self, most: Option<usize>) {
        self.most = most;
    }

    /// Whether there are more nodes than the limit, if there is one.
    pub fn is_full(&self) -> bool {
        self.most.is_some_and(|most| self.nodes.len() > most)
    }

    /// Every node but the first `known`, children before parents.
    pub fn exprs_after(&self, known: usize) -> impl Iterator<Item = Expr> + use<> {
        (known as u32..self.nodes.len() as u32).map(Expr)
    }

    /// The node behind a handle.
    pub fn node(&self, expr: Expr) -> Node {
        self.nodes[expr.index()]
    }

    /// The symbol of this name; made if it does not exist.
    pub fn symbol(&mut self, name: &str) -> Expr {
        if let Some(&known) = self.symbols.get(name) {
            return known;
        }
        let position = self.names.len() as u32;
        self.names.push(name.to_owned());
        let expr = self.intern(Node::Symbol(position));
        self.symbols.insert(name.to_owned(), expr);
        expr
    }

    /// Name of a symbol; `None` for any other node.
    pub fn symbol_name(&self, expr: Expr) -> Option<&str> {
        match self.node(expr) {
            Node::Symbol(position) => Some(&self.names[position as usize]),
            _ => None,
        }
    }

    /// A number. Negative zero becomes zero, so that zero is unique.
    pub fn constant(&mut self, value: f64) -> Expr {
        let value = if value == 0.0 { 0.0 } else { value };
        self.intern(Node::Constant(value.to_bits()))
    }

    /// The value of a number's node; `None` for any other node.
    pub fn as_constant(&self, expr: Expr) -> Option<f64> {
        match self.node(expr) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// Whether the node is the number zero.
    pub fn is_zero(&self, expr: Expr) -> bool {
        self.as_constant(expr) == Some(0.0)
    }

    pub(super) fn intern(&mut self, node: Node) -> Expr {
        let Self { nodes, known, .. } = self;
        let hash = |node: &Node| FxBuildHasher.hash_one(node);
        let is_same = |expr: &Expr| nodes[expr.index()] == node;
        match known.entry(hash(&node), is_same, |expr| hash(&nodes[expr.index()])) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(place) => {
                let number = u32::try_from(nodes.len());
                let expr = Expr(number.expect("a graph has fewer than 2^32 nodes: memory ends first"));
                place.insert(expr);
                nodes.push(node);
                expr
            }
        }
    }

    /// `a + b`.
    pub fn add(&mut self, a: Expr, b: Expr) -> Expr {
        self.binary(Binary::Add, a, b)
    }

    /// `a - b`.
    pub fn sub(&mut self, a: Expr, b: Expr) -> Expr {
        self.binary(Binary::Sub, a, b)
    }

    /// `a b`.
    pub fn mul(&mut self, a: Expr, b: Expr) -> Expr {
        self.binary(Binary::Mul, a, b)
    }

    /// `a / b`.
    pub fn div(&mut self, a: Expr, b: Expr) -> Expr {
        self.binary(Binary::Div, a, b)
    }

    /// `-a`.
    pub fn neg(&mut self, a: Expr) -> Expr {
        self.unary(Unary::Neg, a)
    }

    /// `sin a`.
    pub fn sin(&mut self, a: Expr) -> Expr {
        self.unary(Unary::Sin, a)
    }

    /// `cos a`.
    pub fn cos(&mut self, a: Expr) -> Expr {
        self.unary(Unary::Cos, a)
    }

    /// `√a`.
    pub fn sqrt(&mut self, a: Expr) -> Expr {
        self.unary(Unary::Sqrt, a)
    }

    /// `factor · a`.
    pub fn scale(&mut self, factor: f64, a: Expr) -> Expr {
        let factor = self.constant(factor);
        self.mul(factor, a)
    }

    /// The sum of all terms; zero if there are none.
    pub fn sum(&mut self, terms: impl IntoIterator<Item = Expr>) -> Expr {
        let mut total = self.constant(0.0);
        for term in terms {
            total = self.add(total, term);
        }
        total
    }

    /// `Σ aᵢ bᵢ`; both of one length.
    pub fn dot(&mut self, a: &[Expr], b: &[Expr]) -> Expr {
        assert_eq!(a.len(), b.len(), "a dot product is of two vectors of one length");
        let mut total = self.constant(0.0);
        for (&x, &y) in a.iter().zip(b) {
            let product = self.mul(x, y);
            total = self.add(total, product);
        }
        total
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_subexpressions_are_one_node() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        assert_eq!(g.add(x, y), g.add(y, x));
        let (p, q) = (g.mul(x, y), g.mul(y, x));
        assert_eq!(p, q);
        assert_eq!(g.sub(p, q), g.constant(0.0));
    }
}
