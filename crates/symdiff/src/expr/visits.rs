//! Nodes visited by a search through the graph.

use super::node::Expr;

/// The nodes that one derivative has to visit, in memory that serves many.
#[derive(Clone, Debug, Default)]
pub(super) struct Visits {
    /// For each node, the last derivative that visited it.
    seen_by: Vec<u32>,
    derivative: u32,
    /// Nodes to be visited,
    pub stack: Vec<Expr>,
    /// and those that were found.
    pub found: Vec<Expr>,
}

impl Visits {
    /// Begins another derivative in a graph of `nodes` nodes.
    pub fn begin(&mut self, nodes: usize) {
        if self.derivative == u32::MAX {
            self.seen_by.fill(0);
            self.derivative = 0;
        }
        self.seen_by.resize(nodes, 0);
        self.derivative += 1;
        self.found.clear();
    }

    /// Marks a node as visited; returns whether this derivative had not visited it.
    pub fn is_first(&mut self, expr: Expr) -> bool {
        std::mem::replace(&mut self.seen_by[expr.index()], self.derivative) != self.derivative
    }
}
