//! Passes over whole expressions: reachable nodes, substitution, evaluation.

use rustc_hash::{FxHashMap, FxHashSet};

use super::graph::Graph;
use super::node::{Binary, Expr, Node, Unary};
use crate::eval::functions;

/// A sum of one value under a condition and another one elsewhere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub condition: Expr,
    /// Both summands, and the nodes they guard: used where the condition is positive, and elsewhere.
    pub halves: [(Expr, Expr); 2],
}

impl Graph {
    /// The [choice](Self::select) that `x + y` is; `None` if it is not one.
    pub(crate) fn choice(&self, x: Expr, y: Expr) -> Option<Choice> {
        let half = |wanted: Binary, expr: Expr| match self.node(expr) {
            Node::Binary(function, condition, value) if function == wanted => Some((condition, value)),
            _ => None,
        };
        [(x, y), (y, x)].into_iter().find_map(|(x, y)| {
            let ((condition, a), (same, b)) = (half(Binary::Select, x)?, half(Binary::SelectElse, y)?);
            (condition == same).then_some(Choice { condition, halves: [(x, a), (y, b)] })
        })
    }

    /// `roots` under the assumption that `condition` is positive (`holds`), or that it is not.
    pub fn assume(&mut self, roots: &[Expr], condition: Expr, holds: bool) -> Vec<Expr> {
        let zero = self.constant(0.0);
        self.rebuild(roots, |_, _, node, image| match node {
            Node::Binary(function @ (Binary::Select | Binary::SelectElse), given, value) if given == condition => {
                Some(if holds == (function == Binary::Select) { image[value.index()] } else { zero })
            }
            _ => None,
        })
    }

    /// All nodes that `roots` need, themselves included, children before parents.
    pub fn reachable(&self, roots: &[Expr]) -> Vec<Expr> {
        let Some(last) = roots.iter().max() else { return Vec::new() };
        // A node is made after all nodes that it needs: one pass from the last on finds all. One bit per node.
        let bits = u64::BITS as usize;
        let mut needed = vec![0_u64; last.index() / bits + 1];
        roots.iter().for_each(|root| needed[root.index() / bits] |= 1 << (root.index() % bits));
        let mut found = Vec::new();
        for word in (0..needed.len()).rev() {
            let mut left = needed[word];
            while left != 0 {
                let bit = left.ilog2();
                let expr = Expr((word * bits) as u32 + bit);
                found.push(expr);
                self.node(expr)
                    .children()
                    .for_each(|child| needed[child.index() / bits] |= 1 << (child.index() % bits));
                left = needed[word] & ((1 << bit) - 1);
            }
        }
        found.reverse();
        found
    }

    /// The symbols that `roots` depend on, in the order they were made.
    pub fn symbols_of(&self, roots: &[Expr]) -> Vec<Expr> {
        let mut found = self.reachable(roots);
        found.retain(|&expr| matches!(self.node(expr), Node::Symbol(_)));
        found
    }

    /// The nodes needed by the roots that depend on some symbols.
    pub fn depending_on(&self, roots: &[Expr], symbols: &[Expr]) -> FxHashSet<Expr> {
        let mut found: FxHashSet<Expr> = symbols.iter().copied().collect();
        for expr in self.reachable(roots) {
            if self.node(expr).children().any(|child| found.contains(&child)) {
                found.insert(expr);
            }
        }
        found
    }

    /// Whether an expression changes with a symbol other than by jumps: dependence through `sign`, `floor` or a
    /// condition alone makes it jump, and it is constant between two jumps.
    pub fn changes_steadily(&self, of: Expr, with: &[Expr]) -> bool {
        let mut steadily = FxHashSet::default();
        for expr in self.reachable(&[of]) {
            let changes = match self.node(expr) {
                Node::Constant(_) => false,
                Node::Symbol(_) => with.contains(&expr),
                Node::Unary(Unary::Sign | Unary::Floor, _) => false,
                Node::Binary(Binary::Select | Binary::SelectElse, _, value) => steadily.contains(&value),
                node => node.children().any(|child| steadily.contains(&child)),
            };
            if changes {
                steadily.insert(expr);
            }
        }
        steadily.contains(&of)
    }

    /// `roots` with every key of `replacements` replaced by its value.
    pub fn substitute(&mut self, roots: &[Expr], replacements: &FxHashMap<Expr, Expr>) -> Vec<Expr> {
        self.rebuild(roots, |_, expr, _, _| replacements.get(&expr).copied())
    }

    /// `roots` with every minimum and maximum as a choice by a condition. Where an interval decides the condition, the
    /// derivative is that of one side, and so is its enclosure.
    pub fn with_choices(&mut self, roots: &[Expr]) -> Vec<Expr> {
        self.rebuild(roots, |graph, _, node, image| {
            let Node::Binary(function @ (Binary::Min | Binary::Max), a, b) = node else { return None };
            let (a, b) = (image[a.index()], image[b.index()]);
            let gap = graph.sub(a, b);
            Some(if function == Binary::Max { graph.select(gap, a, b) } else { graph.select(gap, b, a) })
        })
    }

    /// Rebuilds `roots` with nodes replaced, given the images of the nodes below them.
    pub(crate) fn rebuild(
        &mut self,
        roots: &[Expr],
        replaced: impl Fn(&mut Self, Expr, Node, &[Expr]) -> Option<Expr>,
    ) -> Vec<Expr> {
        // By index of the node.
        let mut image = vec![Expr(0); past(roots)];
        for expr in self.reachable(roots) {
            let node = self.node(expr);
            let new = match (replaced(self, expr, node, &image), node) {
                (Some(replacement), _) => replacement,
                (None, Node::Constant(_) | Node::Symbol(_)) => expr,
                (None, Node::Unary(function, a)) => self.unary(function, image[a.index()]),
                (None, Node::Binary(function, a, b)) => self.binary(function, image[a.index()], image[b.index()]),
            };
            image[expr.index()] = new;
        }
        roots.iter().map(|root| image[root.index()]).collect()
    }

    /// Values of `roots` with the symbols' values by `value_of`: one pass, in index order, with the same arithmetic as
    /// the tapes.
    pub fn evaluate(&self, roots: &[Expr], mut value_of: impl FnMut(Expr) -> f64) -> Vec<f64> {
        // By index of the node.
        let mut values = vec![0.0; past(roots)];
        for expr in self.reachable(roots) {
            let value = match self.node(expr) {
                Node::Constant(bits) => f64::from_bits(bits),
                Node::Symbol(_) => value_of(expr),
                Node::Unary(function, a) => functions::unary(function, values[a.index()]),
                // A sum would lose the sign of zero, which instructions preserve.
                Node::Binary(Binary::Add, x, y) if let Some(choice) = self.choice(x, y) => {
                    let [(_, a), (_, b)] = choice.halves;
                    functions::select(values[choice.condition.index()], values[a.index()], values[b.index()])
                }
                Node::Binary(function, a, b) => functions::binary(function, values[a.index()], values[b.index()]),
            };
            values[expr.index()] = value;
        }
        roots.iter().map(|root| values[root.index()]).collect()
    }
}

/// The index after the last of these nodes.
fn past(roots: &[Expr]) -> usize {
    roots.iter().max().map_or(0, |last| last.index() + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_with_jumps_do_not_change_steadily() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let one = g.constant(1.0);
        let holds = g.only_where(x, one);
        let floor = g.unary(Unary::Floor, x);
        let product = g.mul(holds, floor);
        assert!(!g.changes_steadily(product, &[x]));
        let sum = g.add(product, y);
        assert!(!g.changes_steadily(sum, &[x]) && g.changes_steadily(sum, &[x, y]));
        let guarded = g.only_where(y, x);
        assert!(g.changes_steadily(guarded, &[x]) && !g.changes_steadily(guarded, &[y]));
    }

    #[test]
    fn substitution_rebuilds_and_folds() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let product = g.mul(x, y);
        let sum = g.add(product, y);
        let zero = g.constant(0.0);
        let replaced = g.substitute(&[sum], &FxHashMap::from_iter([(x, zero)]));
        assert_eq!(replaced, [y]);
    }
}
