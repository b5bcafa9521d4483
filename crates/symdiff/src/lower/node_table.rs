//! Tables by node, instead of hash maps, since nearly all nodes of a graph are looked up.

use crate::expr::Expr;

/// Small numbers of some of a graph's nodes. Memory is touched only for the nodes with a number.
#[derive(Clone, Debug)]
pub(crate) struct NodeTable {
    /// The number plus one; 0 if absent.
    numbers: Vec<u32>,
}

impl NodeTable {
    /// An empty table for a graph of `nodes` nodes.
    pub fn new(nodes: usize) -> Self {
        Self { numbers: vec![0; nodes] }
    }

    /// Number of nodes of the graph.
    pub fn nodes(&self) -> usize {
        self.numbers.len()
    }

    pub fn get(&self, expr: Expr) -> Option<u32> {
        self.numbers[expr.index()].checked_sub(1)
    }

    pub fn contains(&self, expr: Expr) -> bool {
        self.numbers[expr.index()] != 0
    }

    pub fn insert(&mut self, expr: Expr, number: u32) {
        self.numbers[expr.index()] = number + 1;
    }

    pub fn remove(&mut self, expr: Expr) {
        self.numbers[expr.index()] = 0;
    }
}

/// Some of a graph's nodes.
#[derive(Clone, Debug)]
pub(crate) struct NodeSet(Vec<bool>);

impl NodeSet {
    /// The empty set, for a graph of `nodes` nodes.
    pub fn new(nodes: usize) -> Self {
        Self(vec![false; nodes])
    }

    /// The set of these nodes, for a graph of `nodes` nodes.
    pub fn of(nodes: usize, members: impl IntoIterator<Item = Expr>) -> Self {
        let mut set = Self::new(nodes);
        members.into_iter().for_each(|expr| set.0[expr.index()] = true);
        set
    }

    pub fn contains(&self, expr: Expr) -> bool {
        self.0[expr.index()]
    }

    /// Adds a node; returns whether it is new to the set.
    pub fn insert(&mut self, expr: Expr) -> bool {
        !std::mem::replace(&mut self.0[expr.index()], true)
    }
}
