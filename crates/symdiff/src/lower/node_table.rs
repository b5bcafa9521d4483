//! Tables by node: what hash maps would be, where nearly all nodes of a graph are looked up.

use crate::expr::Expr;

/// Small numbers of some of a graph's nodes. Memory is touched where a number is put down.
#[derive(Clone, Debug)]
pub(crate) struct NodeTable {
    /// One more than the number; 0 where there is none.
    numbers: Vec<u32>,
}

impl NodeTable {
    /// For a graph of `nodes` nodes.
    pub fn new(nodes: usize) -> Self {
        Self { numbers: vec![0; nodes] }
    }

    /// Nodes of the graph.
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
    /// None of a graph of `nodes` nodes.
    pub fn new(nodes: usize) -> Self {
        Self(vec![false; nodes])
    }

    /// These of a graph of `nodes` nodes.
    pub fn of(nodes: usize, members: impl IntoIterator<Item = Expr>) -> Self {
        let mut set = Self::new(nodes);
        members.into_iter().for_each(|expr| set.0[expr.index()] = true);
        set
    }

    pub fn contains(&self, expr: Expr) -> bool {
        self.0[expr.index()]
    }

    /// Whether the node is new to the set.
    pub fn insert(&mut self, expr: Expr) -> bool {
        !std::mem::replace(&mut self.0[expr.index()], true)
    }
}
