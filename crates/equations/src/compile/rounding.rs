//! How exactly expressions can be computed.

use rustc_hash::FxHashMap;
use symdiff::{Binary, Expr, Graph, Node, Unary};

/// Running error of each expression, in its own unit: a bound of its rounding error for exact symbols, except for
/// products of errors (Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., ch. 3.3). Functions of the
/// standard library count as exact to their last place.
pub fn running_errors(graph: &Graph, exprs: &[Expr], value_of: impl FnMut(Expr) -> f64) -> Vec<f64> {
    let nodes = graph.reachable(exprs);
    let values = graph.evaluate(&nodes, value_of);
    let values: FxHashMap<Expr, f64> = nodes.iter().copied().zip(values).collect();
    let mut errors: FxHashMap<Expr, f64> = FxHashMap::default();
    for expr in nodes {
        let error = match graph.node(expr) {
            Node::Constant(_) | Node::Symbol(_) => 0.0,
            node => inherited(node, &values, &errors) + f64::EPSILON / 2.0 * values[&expr].abs(),
        };
        errors.insert(expr, error);
    }
    exprs.iter().map(|expr| errors[expr]).collect()
}

/// Error of a node due to the errors of its children.
fn inherited(node: Node, values: &FxHashMap<Expr, f64>, errors: &FxHashMap<Expr, f64>) -> f64 {
    match node {
        Node::Binary(Binary::Mul, a, b) => values[&a].abs() * errors[&b] + values[&b].abs() * errors[&a],
        Node::Binary(Binary::Div, a, b) => {
            let quotient = (values[&a] / values[&b]).abs();
            (errors[&a] + quotient * errors[&b]) / values[&b].abs()
        }
        Node::Binary(Binary::Select | Binary::SelectElse, _, b) => errors[&b],
        Node::Unary(Unary::Sqrt, a) => 0.5 * errors[&a] / values[&a].sqrt(),
        // Slopes of at most one, or near it.
        node => node.children().map(|child| errors[&child]).sum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_error_of_a_difference_is_that_of_its_terms() {
        let mut graph = Graph::new();
        let [a, b] = ["a", "b"].map(|name| graph.symbol(name));
        let (cos_a, cos_b) = (graph.cos(a), graph.cos(b));
        let difference = graph.sub(cos_a, cos_b);
        let product = graph.scale(1e3, difference);
        let errors = running_errors(&graph, &[difference, product], |_| 0.0);
        assert_eq!(errors, [f64::EPSILON, 1e3 * f64::EPSILON]);
    }
}
