//! Divisions → products with reciprocals, if a reciprocal serves several of them or changes less often than they do.
//!
//! A division takes many times as long as a product. x/y becomes x·(1/y) if y changes less often than x, so that 1/y is
//! computed at y's stage (for a number, when the tape is made), or if y divides something else too. That rounds twice
//! instead of once.

use rustc_hash::FxHashMap;

use super::stages::{Input, Stages};
use crate::expr::{Binary, Expr, Graph, Node};

/// `roots` with reciprocals instead of divisions; symbols change at the stages of `inputs`.
pub fn with_reciprocals(graph: &mut Graph, inputs: &[Input], roots: &[Expr]) -> Vec<Expr> {
    let mut stages = Stages::new(inputs);
    stages.update(graph);
    let mut divided_by: FxHashMap<Expr, usize> = FxHashMap::default();
    for expr in graph.reachable(roots) {
        if let Node::Binary(Binary::Div, _, divisor) = graph.node(expr) {
            *divided_by.entry(divisor).or_default() += 1;
        }
    }
    let one = graph.constant(1.0);
    graph.rebuild(roots, |graph, _, node, image| match node {
        Node::Binary(Binary::Div, a, b) if divided_by[&b] > 1 || stages.of(b) < stages.of(a) => {
            let reciprocal = graph.div(one, image[b.index()]);
            Some(graph.mul(image[a.index()], reciprocal))
        }
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Op, Tape, lower};
    use super::*;

    #[test]
    fn repeated_divisor_is_inverted_once() {
        let mut g = Graph::new();
        let [h, x, y, z] = ["h", "x", "y", "z"].map(|name| g.symbol(name));
        let three = g.constant(3.0);
        let by_number = g.div(x, three);
        let by_step = g.div(y, h);
        let [first, second] = [x, y].map(|a| g.div(a, z));
        let alone = g.div(z, x);
        let roots = [by_number, by_step, first, second, alone];
        let inputs: Vec<Input> = [(h, 0), (x, 1), (y, 1), (z, 1)]
            .into_iter()
            .zip(0..)
            .map(|((symbol, stage), register)| Input { symbol, stage, register })
            .collect();
        let rewritten = with_reciprocals(&mut g, &inputs, &roots);
        let lowered = lower(&g, &inputs, 1, 4, &[rewritten.iter().map(|&root| (root, None)).collect()]);
        let divisions = |tape: &Tape| tape.count(|op| op == Op::Binary(Binary::Div));
        assert_eq!((divisions(&lowered.stages[0]), divisions(&lowered.kernels[0])), (1, 2));
        let value = |symbol: Expr| 0.3 + symbol.index() as f64;
        for (before, after) in g.evaluate(&roots, value).into_iter().zip(g.evaluate(&rewritten, value)) {
            assert!((before - after).abs() <= 2.0 * f64::EPSILON * before.abs(), "{before} {after}");
        }
        // A single division is unchanged.
        assert_eq!(rewritten[4], alone);
    }
}
