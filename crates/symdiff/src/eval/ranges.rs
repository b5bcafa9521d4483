//! Enclosures of expressions over a box of their symbols, in interval arithmetic.

use rustc_hash::FxHashMap;

use super::enclosed;
use super::interval::Interval;
use crate::expr::{Binary, Expr, Graph, Node, Unary};

/// Expressions that are enclosed over one box after the other.
#[derive(Clone, Debug)]
pub struct Ranges {
    operations: Vec<Operation>,
    /// Indices of the roots among the operations.
    roots: Vec<usize>,
}

/// An operation on the results of earlier ones.
#[derive(Clone, Copy, Debug)]
enum Operation {
    Constant(f64),
    /// Symbol, by its index in the box.
    Symbol(usize),
    /// A symbol that is not in the box.
    Unknown,
    Unary(Unary, usize),
    Square(usize),
    Binary(Binary, usize, usize),
}

impl Ranges {
    /// Prepares `roots` for boxes of `symbols`; any other symbol may be any number.
    pub fn new(graph: &Graph, symbols: &[Expr], roots: &[Expr]) -> Self {
        let mut place_of: FxHashMap<Expr, usize> = FxHashMap::default();
        let mut operations = Vec::new();
        for expr in graph.reachable(roots) {
            operations.push(match graph.node(expr) {
                Node::Constant(bits) => Operation::Constant(f64::from_bits(bits)),
                Node::Symbol(_) => {
                    symbols.iter().position(|&symbol| symbol == expr).map_or(Operation::Unknown, Operation::Symbol)
                }
                Node::Unary(function, a) => Operation::Unary(function, place_of[&a]),
                Node::Binary(Binary::Mul, a, b) if a == b => Operation::Square(place_of[&a]),
                Node::Binary(function, a, b) => Operation::Binary(function, place_of[&a], place_of[&b]),
            });
            place_of.insert(expr, operations.len() - 1);
        }
        Self { operations, roots: roots.iter().map(|root| place_of[root]).collect() }
    }

    /// Encloses the roots over a box, given the interval of each symbol; `values` is working memory.
    pub fn enclose<'v>(
        &'v self,
        symbols: &[Interval],
        values: &'v mut Vec<Interval>,
    ) -> impl ExactSizeIterator<Item = Interval> + 'v {
        values.clear();
        for &operation in &self.operations {
            let value = match operation {
                Operation::Constant(value) => Interval::point(value),
                Operation::Symbol(index) => symbols[index],
                Operation::Unknown => Interval::ENTIRE,
                Operation::Unary(function, a) => enclosed::unary(function, values[a]),
                Operation::Square(a) => values[a].square(),
                Operation::Binary(function, a, b) => enclosed::binary(function, values[a], values[b]),
            };
            values.push(value);
        }
        self.roots.iter().map(|&root| values[root])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn range_contains_a_pulse_between_two_points() {
        let mut graph = Graph::new();
        let t = graph.symbol("t");
        let (centre, width) = (graph.constant(0.5003), graph.constant(1e-5));
        let from_centre = graph.sub(t, centre);
        let scaled = graph.div(from_centre, width);
        let square = graph.mul(scaled, scaled);
        let negative = graph.neg(square);
        let pulse = graph.unary(Unary::Exp, negative);
        let ranges = Ranges::new(&graph, &[t], &[pulse]);
        let mut values = Vec::new();
        let mut over = |a: f64, b: f64| {
            let found: Vec<Interval> = ranges.enclose(&[Interval::new(a, b)], &mut values).collect();
            found[0]
        };
        assert!(over(0.5, 0.501).upper() >= 1.0 && over(0.5, 0.501).upper() < 1.0 + 1e-14);
        assert!(over(0.499, 0.5).upper() < 1e-150);
    }

    #[test]
    fn symbols_outside_the_box_are_unbounded() {
        let mut graph = Graph::new();
        let (t, x) = (graph.symbol("t"), graph.symbol("x"));
        let roots = [graph.sin(x), graph.mul(t, x)];
        let ranges = Ranges::new(&graph, &[t], &roots);
        let mut values = Vec::new();
        let found: Vec<Interval> = ranges.enclose(&[Interval::new(1.0, 2.0)], &mut values).collect();
        assert_eq!(found, [Interval::new(-1.0, 1.0), Interval::ENTIRE]);
    }
}
