//! Stages at which values can change: inputs carry a stage, 0 the one that changes least often, and a node's stage is
//! the highest of its operands.

use rustc_hash::FxHashMap;

use crate::expr::{Expr, Graph, Node};

/// A symbol's register, and the stage at which its value changes.
#[derive(Clone, Copy, Debug)]
pub struct Input {
    /// A symbol of the graph.
    pub symbol: Expr,
    /// 0 changes least often.
    pub stage: usize,
    /// Register of its value. Two symbols may share one.
    pub register: u32,
}

/// Stage at which each node of a graph changes; grows with the graph.
#[derive(Clone, Debug)]
pub struct Stages {
    given: FxHashMap<Expr, usize>,
    /// By node index; [`UNKNOWN`] if the node depends on a symbol that is no input.
    of: Vec<Option<usize>>,
}

/// Stage of nodes that depend on a symbol that is no input: beyond every stage.
pub(crate) const UNKNOWN: usize = usize::MAX;

impl Stages {
    /// Stages of a graph whose symbols are `inputs`; others are allowed if nobody asks for them.
    pub fn new(inputs: &[Input]) -> Self {
        Self { given: inputs.iter().map(|input| (input.symbol, input.stage)).collect(), of: Vec::new() }
    }

    /// Adds the nodes that are new since the last call.
    pub fn update(&mut self, graph: &Graph) {
        for expr in graph.exprs_after(self.of.len()) {
            let stage = match graph.node(expr) {
                Node::Symbol(_) => Some(self.given.get(&expr).copied().unwrap_or(UNKNOWN)),
                node => node.children().filter_map(|child| self.of[child.index()]).max(),
            };
            self.of.push(stage);
        }
    }

    /// The highest stage among the inputs below a node that has been added; `None` for a constant.
    pub fn of(&self, expr: Expr) -> Option<usize> {
        self.of[expr.index()]
    }
}
